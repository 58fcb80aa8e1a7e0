// node webgpu-pictures.mjs LACEDRING [--times N] [MESH...]: draws meshes with web/gpu in headless Chromium from the
// stream in the vertex stage, from the expanded index buffer, and from the indices that LACEDRING decodes. No pixel may
// differ. Without MESH it draws assets/ and tests the example page. --times prints bytes and milliseconds, the minimum
// of N. Exit code 1: a pixel differs or the console has an error.
import {execFileSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {basename, dirname, join, resolve} from "node:path";
import {fileURLToPath} from "node:url";

import {FOLDERS, serve} from "../../scripts/web.mjs";
import {Page, WEBGPU} from "../browser/chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url)), assets = join(here, "../../assets");
const work = mkdtempSync(join(tmpdir(), "lacedring-webgpu-"));
const program = resolve(process.argv[2]), args = process.argv.slice(3);
const times = args[0] === "--times" ? Number(args.splice(0, 2)[1]) : 0;
const run = (...options) => execFileSync(program, options, {stdio: "pipe"});

/** The indices of a GLB that the program wrote: u32. */
function indicesOf(glb) {
  const data = readFileSync(glb), end = 20 + data.readUInt32LE(12), json = JSON.parse(data.subarray(20, end));
  const {bufferView, byteOffset = 0, count, componentType} = json.accessors[json.meshes[0].primitives[0].indices];
  const at = end + 8 + (json.bufferViews[bufferView].byteOffset ?? 0) + byteOffset;
  const Type = {5121: Uint8Array, 5123: Uint16Array, 5125: Uint32Array}[componentType];
  return Uint32Array.from(
    new Type(data.buffer.slice(data.byteOffset + at, data.byteOffset + at + Type.BYTES_PER_ELEMENT * count)));
}

let failed = 0;
function fail(text) {
  failed++;
  console.log(`FAILED ${text}`);
}

/** Encodes a mesh, draws it by every path, and reports. */
async function compare(page, mesh, format, options, views) {
  const name = `${basename(mesh)}-${format}.lr`, file = join(work, name);
  run("encode", "--resident", "--force", "--format", format, ...options, mesh, "-o", file);
  run("decode", "--force", file, "-o", join(work, "decoded.glb"));
  writeFileSync(`${file}.indices`, indicesOf(join(work, "decoded.glb")));
  const result = await page.evaluate(`pictures("/data/${name}", ${JSON.stringify({views, times})})`);
  for (const {view, covered, different} of result.views) {
    const wrong = covered < 1000 || Object.values(different).some((pixels) => pixels > 0);
    const text = `${name}, ${view}: ${covered} pixels covered; different: ${
      Object.entries(different).map(([path, n]) => `${path} ${n}`).join(", ")}`;
    wrong ? fail(text) : console.log(text);
  }
  if (format !== "lr" && !times && views.includes("flat")) {
    const {covered, different, floats, error} = await page.evaluate(`picturesGl2("/data/${name}")`);
    const text =
      `${name}, WebGL2: ${covered} pixels covered; different: ${different} pixels, ${floats} positions; error ${error}`;
    covered < 1000 || different || floats || error ? fail(text) : console.log(text);
  }
  if (!times) return;
  for (const [what, ms] of Object.entries(result.times)) console.log(`  ${what}: ${ms} ms`);
  for (const [what, {list, plain}] of Object.entries(result.bytes)) {
    const total = list.reduce((sum, [, bytes]) => sum + bytes, 0);
    console.log(
      `  ${what}: ${total} bytes (${list.map(([part, bytes]) => `${part} ${bytes}`).join(", ")}); plain ${plain}`);
  }
}

/** Tests the example page: both paths draw something in each view, and unsupported files are refused in one line. */
async function checkPage(page, host) {
  run("encode", join(work, "blob.ply"), "-o", join(work, "stored.lr"));
  writeFileSync(join(work, "garbage.lr"), Buffer.alloc(100, "garbage"));
  const shown = (expression) => page.evaluate(`idle().then(() => ${expression})`);
  const error = `document.getElementById("error").hidden ? "" : document.getElementById("error").textContent`;
  await page.show(800, 600);
  for (const [name, expected] of [
         ["stored.lr", "--resident"], ["garbage.lr", "not an .lr file"], ["missing.lr", "404"]]) {
    await page.open(`${host}/gpu/?file=/data/${name}`);
    const told = await shown(error);
    if (!told.includes(expected) || told.includes("\n")) fail(`the page says of ${name}: ${told}`);
  }
  page.problems = page.problems.filter((problem) => !problem.includes("404"));  // the request of missing.lr
  await page.open(`${host}/gpu/?file=/data/blob.ply-packed.lr`);
  for (const [path, view] of [["pull", "smooth"], ["pull", "ring"], ["expand", "flat"], ["expand", "classes"]]) {
    await page.evaluate(
      `["${path}", "${view}"].forEach((value) => document.querySelector(\`[value=\${value}]\`).click())`);
    const told = await shown(error);
    if (told) fail(`the page says of ${path}, ${view}: ${told}`);
    const size = (await page.screenshot()).length;
    if (size < 30000) fail(`the page shows little of ${path}, ${view}: ${size} bytes of PNG`);
  }
  await page.open(`${host}/gpu/webgl2.html?file=/data/blob.ply-packed.lr`);
  const told = await shown(error), size = (await page.screenshot()).length;
  if (told || size < 20000) fail(`the page in WebGL2 says: ${told}; ${size} bytes of PNG`);
  if (process.env.SCREENSHOT) writeFileSync(process.env.SCREENSHOT, await page.screenshot());
}

const server = await serve({...FOLDERS, tests: here, data: work});
const page = new Page(WEBGPU);
try {
  const host = `http://127.0.0.1:${server.address().port}`;
  await page.open(`${host}/tests/webgpu-pictures.html`);
  await page.evaluate("open_()");
  for (const mesh of args) {
    for (const format of ["packed", "lean"])
      await compare(page, mesh, format, ["--positions", "14"], times ? ["flat"] : ["smooth", "flat"]);
  }
  if (args.length === 0) {
    const views = ["smooth", "flat", "ring", "classes"], blob = join(work, "blob.ply");
    run("generate", "blob", "-o", blob, "--triangles", "2500");
    await compare(page, blob, "packed", ["--positions", "12"], views);
    await compare(page, join(assets, "globe.glb"), "packed", ["--normals", "10"], ["smooth"]);
    await compare(page, join(assets, "cut_torus.ply"), "lean", [], ["flat", "classes"]);
    await compare(page, blob, "lr", [], [...views, "outlines"]);
    await checkPage(page, host);
  }
  page.problems.filter((problem) => !problem.includes("GPU stall due to ReadPixels")).forEach(fail);
} finally {
  await page.close();
  server.close();
  rmSync(work, {recursive: true});
}
process.exit(failed ? 1 : 0);
