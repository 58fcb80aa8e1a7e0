// node page.test.mjs LACEDRING [--keep FOLDER]: tests the page in headless Chromium. It draws its sample and chosen
// files (.lr, packed and plain .glb), prints one line if a file cannot be shown, and frees the memory of earlier files.
// --keep writes screenshots of the page, large and small, light and dark. Exit code 1: a failure.
import assert from "node:assert/strict";
import {execFileSync, spawnSync} from "node:child_process";
import {mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join, resolve} from "node:path";
import {fileURLToPath} from "node:url";

import {FOLDERS, serve} from "../../scripts/web.mjs";
import {Page} from "../browser/chromium.mjs";

const SIZES = {
  large: [1280, 800],
  small: [390, 844]
};
const root = join(dirname(fileURLToPath(import.meta.url)), "../..");
const [program, , keep] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "lacedring-page-"));
const asset = (name) => join(root, "assets", name), made = (name) => join(folder, name);
const run = (...args) => execFileSync(program, args, {stdio: "pipe"});

/** Counts the pixels of the canvas that are not background, after the next frame. */
const COVERED = `new Promise((done) => { page.viewer.draw(); requestAnimationFrame(() => {
  const { width, height } = canvas, copy = new OffscreenCanvas(width, height).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  done(copy.getImageData(0, 0, width, height).data.filter((value, i) => i % 4 === 3 && value > 0).length);
}); })`;
const text = (id) => page.evaluate(`document.getElementById("${id}").textContent`);
const number = async (id) => Number((await text(id)).replaceAll(",", ""));

/** Chooses a file and waits until it or its error is shown. */
async function choose(file) {
  await page.evaluate(`window.shownBefore = page.count`);
  await page.choose(`document.getElementById("file")`, [resolve(file)]);
  await page.evaluate(
    `new Promise((done) => { const look = () => page.count > shownBefore ? done() : setTimeout(look, 20); look(); })`);
}

/** Chooses a valid file, and checks that it is shown with the right numbers. */
async function checkShown(file, {kind, triangles, most}) {
  await choose(file);
  assert.equal(
    await page.evaluate(`document.getElementById("error").hidden || document.getElementById("error").textContent`),
    true, file);
  assert.match(await text("ourName"), kind);
  assert.match(await text("numbers"), new RegExp(`^triangles${triangles}vertices`));
  const [plain, ours] = [await number("plainBytes"), await number("ourBytes")];
  assert(ours > 0 && ours < most * plain, `${file}: ${ours} of ${plain} bytes`);
  assert(await page.evaluate(COVERED) > 10000, `${file}: hardly anything is drawn`);
}

async function checkError(name, bytes, expected) {
  writeFileSync(made(name), bytes);
  const before = await text("summary");
  await choose(made(name));
  const line = await text("error");
  assert.match(line, expected);
  assert(line.startsWith(`${name}: `) && !line.includes("\n") && line.length < 160, line);
  assert.equal(await text("summary"), before);  // the shown file stays
}

function damaged(file) {
  const bytes = readFileSync(file);
  for (let i = 200; i < 400; i++) bytes[i] ^= 0x5a;
  return bytes;
}

async function checkErrors() {
  await checkError("damaged.lr", damaged(made("blob.lr")), /lr file/);
  await checkError("damaged.glb", damaged(made("globe.glb")), /./);
  await checkError("cut.lr", readFileSync(made("blob.lr")).subarray(0, 1000), /lr file/);
  await checkError("cut.glb", readFileSync(asset("globe.glb")).subarray(0, 5000), /damaged GLB/);
  await checkError("empty.lr", "", /it is not an .lr, .glb or .gltf file/);
  await checkError("text.txt", "not a mesh", /it is not an .lr, .glb or .gltf file/);
  await checkError(
    "other.gltf", `{"asset": {"version": "2.0"}, "buffers": [{"uri": "other.bin", "byteLength": 4}]}`,
    /in other files/);
  await checkError("points.gltf", `{"asset": {"version": "2.0"}}`, /no triangles/);
}

async function checkRing() {
  const [withRing, without] = [
    await page.evaluate(`page.viewer.lines`),
    await page.evaluate(`document.getElementById("ring").click(), page.viewer.lines`)
  ];
  assert(withRing > 100 && without === 0, `${withRing} lines with the ring, ${without} without`);
  await page.evaluate(`document.getElementById("ring").click()`);
}

/** Checks that memory does not grow with the number of files. */
async function checkMemory() {
  const files = [made("blob.lr"), made("globe.glb"), asset("materials.glb")];
  const load = async (count) => {
    for (let i = 0; i < count; i++) await choose(files[i % files.length]);
    const {objects, arrays} = await page.memory();
    return objects + arrays;
  };
  const before = await load(5), after = await load(21);
  console.log(
    `memory: ${(before / 2 ** 20).toFixed(1)} MiB after 5 files, ${(after / 2 ** 20).toFixed(1)} MiB after 26`);
  assert(after < before + 4 * 2 ** 20, "memory grows");
}

const packages = spawnSync(join(root, "scripts/node-packages"), {stdio: ["ignore", "ignore", "inherit"]});
if (packages.status !== 0) process.exit(packages.status ?? 1);
run("encode", "--positions", "14", asset("blob.ply"), "-o", made("blob.lr"));
run("pack", asset("globe.glb"), "-o", made("globe.glb"));
execFileSync("node", [join(root, "scripts/web-samples.mjs"), program, made("samples")]);
const server = await serve({...FOLDERS, samples: made("samples")}), page = new Page();
try {
  await page.open(`http://127.0.0.1:${server.address().port}/`);
  await page.evaluate("page.started");
  await page.show(640, 700);  // small and without animation, because it is drawn in software
  await page.evaluate(`document.getElementById("turn").checked && document.getElementById("turn").click()`);
  assert.equal(await text("name"), "Blob");
  assert(await page.evaluate(COVERED) > 10000, "the sample is not drawn");
  await checkRing();
  await checkShown(made("globe.glb"), {kind: /^packed glTF$/, triangles: "3,968", most: 0.5});
  await checkShown(asset("globe.glb"), {kind: /^as an .lr file$/, triangles: "3,968", most: 0.1});
  await checkShown(asset("materials.glb"), {kind: /^as \d+ .lr files$/, triangles: "962", most: 0.5});
  await checkShown(made("blob.lr"), {kind: /^.lr file$/, triangles: "12,000", most: 0.2});
  assert.deepEqual(page.problems, []);
  await checkErrors();
  await checkMemory();
  if (keep) {
    mkdirSync(keep, {recursive: true});
    await page.evaluate(
      `document.querySelector("#samples button").click(), new Promise((done) => setTimeout(done, 1000))`);
    for (const [name, size] of Object.entries(SIZES)) {
      for (const scheme of ["light", "dark"]) {
        await page.show(...size, scheme);
        await page.evaluate(COVERED);
        writeFileSync(join(keep, `${name}-${scheme}.png`), await page.screenshot());
      }
    }
  }
} finally {
  await page.close();
  server.close();
  rmSync(folder, {recursive: true});
}
console.log("page: all good");
