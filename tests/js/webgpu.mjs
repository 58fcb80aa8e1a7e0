// node webgpu.mjs LACEDRING: tests shaders/include/*.wgsl in headless Chromium. Every triangle, attribute value, copy
// and operator of files of LACEDRING and of the golden streams must equal that of the readers in tests/independent;
// damaged streams must neither hang nor lose the device. Exit code 1 otherwise.
import {execFileSync} from "node:child_process";
import {copyFileSync, mkdtempSync, readdirSync, readFileSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join, resolve} from "node:path";
import {fileURLToPath} from "node:url";

import {FOLDERS, serve} from "../../scripts/web.mjs";
import {Page, WEBGPU} from "../browser/chromium.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const GOLDEN = join(here, "../golden"), ASSETS = join(here, "../../assets");
const program = resolve(process.argv[2]), work = mkdtempSync(join(tmpdir(), "lacedring-webgpu-"));
const run = (...args) => execFileSync(program, args, {stdio: "pipe"});

const QUANTIZED = ["--positions", "12", "--normals", "8", "--texcoords", "10"];
// Meshes, and the options of encode.
const FORMATS = [
  ["lean"], ["packed"], ["packed", "--profile", "cache", ...QUANTIZED], ["lean", "--no-weld", ...QUANTIZED],
  ["lr", "--positions", "14"]
];
const KINDS = ["sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup"];

/** Writes the files to check into `work`; returns their names. */
function files() {
  const meshes = KINDS.map((kind, i) => {
    const mesh = join(work, `${kind}.ply`);
    run("generate", kind, "-o", mesh, "--triangles", String(i === 4 ? 9000 : 1000), "--seed", String(i + 1));
    return mesh;
  });
  meshes.push(...["globe.glb", "materials.glb", "cut_torus.ply"].map((name) => join(ASSETS, name)));
  return meshes.flatMap((mesh) => FORMATS.map(([format, ...options], i) => {
    const name = `${mesh.split("/").at(-1)}-${i}.lr`;
    run("encode", "--resident", "--effort", "0", "--format", format, ...options, mesh, "-o", join(work, name));
    return name;
  }));
}

/** Copies the golden streams of the formats into `work`; returns their names. */
function goldenStreams() {
  const names = readdirSync(GOLDEN).filter((name) => !/^file-|lr-compact/.test(name));
  names.forEach((name) => copyFileSync(join(GOLDEN, name), join(work, name)));
  return names;
}

/** Constants of an include, by name. */
function constants(name, pattern) {
  const text = readFileSync(join(FOLDERS.shaders, name), "utf8");
  return new Map([...text.matchAll(pattern)].map(([, key, value]) => [key, value.replace(/[ui]$/, "")]));
}

/** Names of constants that differ between WGSL and GLSL. */
function differentConstants() {
  return ["lacedring", "lacedring_vertices", "lacedring_seams", "lacedring_operators"].flatMap((name) => {
    const glsl = constants(`${name}.glsl`, /^#define (LR_\w+) (0x[0-9a-f]+u?|\d+u?)\b/gm);
    const wgsl = constants(`${name}.wgsl`, /^const (LR_\w+) = (0x[0-9a-f]+[ui]?|\d+[ui]?);/gm);
    if (wgsl.size < 5) return [`${name}: no constants`];
    return [...wgsl].filter(([key, value]) => glsl.get(key) !== value).map(([key]) => key);
  });
}

/** The shaders in docs/webgpu.md, each with the names of its includes. */
function shownShaders() {
  const text = readFileSync(join(here, "../../docs/webgpu.md"), "utf8");
  return [...text.matchAll(/```wgsl ([\w ]+)\n(.*?)```/gs)].map(([, names, code]) => [names.split(" "), code]);
}

let failed = 0;
function fail(text) {
  failed++;
  console.log(`FAILED ${text}`);
}

const server = await serve({...FOLDERS, tests: here, data: work});
const page = new Page(WEBGPU);
try {
  differentConstants().forEach((name) => fail(`${name} differs from GLSL`));
  const names = [...files(), ...goldenStreams()];
  execFileSync("python3", ["-B", join(here, "webgpu_expected.py"), ...names.map((name) => join(work, name))]);
  await page.open(`http://127.0.0.1:${server.address().port}/tests/webgpu.html`);
  await page.evaluate("open_()");
  if (shownShaders().length < 3) fail("docs/webgpu.md shows no shaders");
  for (const [names, code] of shownShaders()) {
    for (const message of await page.evaluate(`compile(${JSON.stringify(names)}, ${JSON.stringify(code)})`))
      fail(`docs/webgpu.md: ${message}`);
  }
  let values = 0, slots = 0;
  for (const name of names) {
    const result = await page.evaluate(`check("/data/${name}")`);
    result.problems.slice(0, 5).forEach((problem) => fail(`${name}: ${problem}`));
    values += result.values;
    slots += result.slots;
  }
  for (const [i, name] of ["soup.ply-1.lr", "globe.glb-2.lr", "torus.ply-0.lr", "moebius.ply-4.lr"].entries()) {
    const slowest = await page.evaluate(`damage("/data/${name}", 25, ${i})`);
    const {wrong, refused} = await page.evaluate(`changeFile("/data/${name}", 500, ${i})`);
    wrong.slice(0, 3).forEach((problem) => fail(`${name}, changed: ${problem}`));
    if (refused < 50 || refused === 500) fail(`${name}: ${refused} of 500 changed files are refused`);
    if (slowest > 20000) fail(`${name}, damaged: ${Math.round(slowest)} ms`);
  }
  page.problems.forEach(fail);
  console.log(`${names.length} files, 100 damaged ones, 2,000 changed ones, ${
    slots.toLocaleString("en-US")} triangles, ${values.toLocaleString("en-US")} integers compared`);
} finally {
  await page.close();
  server.close();
  rmSync(work, {recursive: true});
}
process.exit(failed ? 1 : 0);
