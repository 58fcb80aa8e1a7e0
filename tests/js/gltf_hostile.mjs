// node gltf_hostile.mjs PACKAGE LACEDRING SCENE... [--runs N] [--seed N]: packs scenes, damages documents and bytes at
// random, and decodes them with the package, which must decode them or throw an error of one line. Exit code 1
// otherwise.
import {execFileSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync} from "node:fs";
import {tmpdir} from "node:os";
import {join, resolve} from "node:path";
import {parseArgs} from "node:util";
import {deflateSync, inflateSync} from "node:zlib";

import {joinGlb, splitGlb} from "./gltf_files.mjs";

const {values, positionals} = parseArgs({
  allowPositionals: true,
  options: {runs: {type: "string", default: "300"}, seed: {type: "string"}},
});
const [packagePath, program, ...scenes] = positionals;
const {EXTENSION, unpackGlb} = await import(resolve(packagePath, "gltf/lacedring-gltf.js"));
const {LacedRingError} = await import(resolve(packagePath, "lacedring.js"));
const seed = Number(values.seed ?? Date.now() % 2 ** 31), LIMITS = {
  maxMemory: 64 << 20
};
let state = seed;

function random(below) {
  state = (state + 0x6d2b79f5) | 0;
  let x = Math.imul(state ^ (state >>> 15), 1 | state);
  x ^= x + Math.imul(x ^ (x >>> 7), 61 | x);
  return ((x ^ (x >>> 14)) >>> 0) % below;
}

const pick = (list) => list[random(list.length)];
const VALUES = [
  0,       1,   2,     3,    -1,         0.5,           1e300,       2 ** 32, 2 ** 31,
  2 ** 53, 255, 65536, "",   "POSITION", "constructor", "__proto__", null,    true,
  false,   [],  {},    [[]], [[0]],      [{}],          "deflate",   "floats"
];
// The members of a document that the extension reads.
const READ = new Set([
  "bufferView", "bufferViews", "buffer",        "buffers", "accessors", "sets",        "part",
  "parts",      "stream",      "streams",       "count",   "coding",    "document",    "indices",
  "byteLength", "byteOffset",  "componentType", "type",    "ordered",   "placeholder", "mode"
]);

const OPTIONS = [
  ["--document", "plain"], ["--document", "packed"], ["--keep-order", "--document", "packed"],
  ["--resident", "--fallback"]
];

/** All places [owner, name] of a document. */
function places(value, out = []) {
  for (const name of Object.keys(value)) {
    out.push([value, name]);
    if (typeof value[name] === "object" && value[name] !== null) places(value[name], out);
  }
  return out;
}

function damageDocument(json) {
  const all = places(json);
  const read = all.filter(([, name]) => READ.has(name) || /^\d+$/.test(name));
  const [owner, name] = pick(random(4) ? read : all);
  const kind = random(6);
  if (kind === 0)
    delete owner[name];
  else if (kind === 1 && typeof owner[name] === "number")
    owner[name] += pick([-1, 1, 2, 10]);
  else if (kind === 2)
    owner[name] = structuredClone(pick(all).reduce((from, key) => from[key]));
  else if (kind === 3 && Array.isArray(owner))
    owner.push(structuredClone(pick(VALUES)));
  else
    owner[name] = structuredClone(pick(VALUES));
}

function damageBytes(bytes) {
  const out = bytes.slice();
  for (let i = 0; i < 1 + random(3); i++) out[random(out.length)] ^= 1 << random(8);
  return random(8) ? out : out.subarray(0, random(out.length));
}

/** Changes the contents of a compressed buffer view, the inner document or part codes, and sets the view's length. */
function damageInside(scene, view) {
  const place = scene.json.bufferViews[view], at = place.byteOffset ?? 0;
  let contents = inflateSync(scene.binary.subarray(at, at + place.byteLength));
  if (view === scene.json.extensions[EXTENSION].document) {
    const inner = JSON.parse(contents);
    for (let i = 0; i < 1 + random(2); i++) damageDocument(inner);
    contents = Buffer.from(JSON.stringify(inner));
  } else {
    contents = damageBytes(contents);
  }
  const deflated = deflateSync(contents);
  const binary = Buffer.concat([scene.binary, Buffer.alloc(-scene.binary.length & 7), deflated]);
  Object.assign(place, {buffer: 0, byteOffset: binary.length - deflated.length, byteLength: deflated.length});
  scene.json.buffers[0].byteLength = binary.length;
  scene.binary = binary;
}

function damaged(source) {
  if (random(4) === 0) return damageBytes(source);
  const scene = splitGlb(source), extension = scene.json.extensions[EXTENSION];
  const inside =
    [extension.document, ...(extension.streams ?? []).map(({parts}) => parts)].filter((view) => view !== undefined);
  if (inside.length > 0 && random(3))
    damageInside(scene, pick(inside));
  else
    for (let i = 0; i < 1 + random(2); i++) damageDocument(scene.json);
  if (random(8) === 0) scene.binary = damageBytes(scene.binary);
  return joinGlb(scene.json, scene.binary);
}

const folder = mkdtempSync(join(tmpdir(), "lacedring-hostile-"));
const counts = {
  decoded: 0,
  refused: 0,
  failed: 0
};
const isOurs = (error) => error instanceof LacedRingError || error.message.startsWith(`${EXTENSION}: `);
try {
  for (const scene of scenes) {
    for (const options of OPTIONS) {
      const file = join(folder, "packed.glb");
      execFileSync(program, ["pack", "--force", ...options, scene, "-o", file], {stdio: "pipe"});
      const source = new Uint8Array(readFileSync(file));
      for (let run = 0; run < Number(values.runs); run++) {
        const before = state, bytes = damaged(source), start = performance.now();
        try {
          await unpackGlb(bytes, async (_, uri) => new Uint8Array(Buffer.from(uri)), {limits: LIMITS});
          counts.decoded++;
        } catch (error) {
          const isGood = isOurs(error) && !error.message.includes("\n") && error.message.length < 300;
          counts[isGood ? "refused" : "failed"]++;
          if (!isGood) console.log(`FAILED ${scene} ${options.join(" ")}, state ${before}: ${error.stack}`);
        }
        const time = performance.now() - start;
        if (time > 5000)
          console.log(`FAILED ${scene} ${options.join(" ")}, state ${before}: ${time.toFixed(0)} ms`, counts.failed++);
      }
    }
  }
} finally {
  rmSync(folder, {recursive: true});
}
console.log(`seed ${seed}: ${JSON.stringify(counts)}`);
process.exit(counts.failed ? 1 : 0);
