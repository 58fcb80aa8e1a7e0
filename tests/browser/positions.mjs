// node positions.mjs LACEDRING GLTFPACK MESH...: prints a table of the bytes of meshes of positions, lossless, as .lr
// files in storage form and as files of gltfpack -noq -c (document and buffers), plain and compressed by brotli.
import {execFileSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {basename, join} from "node:path";
import {brotliCompressSync, constants} from "node:zlib";

const [lacedring, gltfpack, ...meshes] = process.argv.slice(2);
const folder = mkdtempSync(join(tmpdir(), "lacedring-positions-"));
const [whole, alone, ours, theirs] =
  ["whole.glb", "alone.glb", "ours.lr", "theirs.glb"].map((name) => join(folder, name));

/** Runs a program; if it fails, the error has its output. */
const run = (...command) => execFileSync(command[0], command.slice(1), {stdio: "pipe"});

/** Writes the GLB with POSITION as its only attribute. */
function keepPositions(from, to) {
  const data = readFileSync(from);
  const end = 20 + data.readUInt32LE(12);
  const json = JSON.parse(data.subarray(20, end));
  for (const mesh of json.meshes) {
    for (const primitive of mesh.primitives) primitive.attributes = {POSITION: primitive.attributes.POSITION};
  }
  const text = Buffer.from(JSON.stringify(json));
  const padded = Buffer.concat([text, Buffer.alloc(-text.length & 3, " ")]);
  const head = Buffer.from(data.subarray(0, 20));
  head.writeUInt32LE(20 + padded.length + data.length - end, 8);
  head.writeUInt32LE(padded.length, 12);
  writeFileSync(to, Buffer.concat([head, padded, data.subarray(end)]));
}

function sizes(file) {
  const data = readFileSync(file);
  return [data.length, brotliCompressSync(data, {params: {[constants.BROTLI_PARAM_QUALITY]: 11}}).length];
}

const median = (values) => {
  const sorted = values.toSorted((a, b) => a - b);
  return (sorted[Math.floor((sorted.length - 1) / 2)] + sorted[Math.floor(sorted.length / 2)]) / 2;
};

console.log("| mesh | .lr | brotli | gltfpack | brotli | .lr / gltfpack | brotli |");
console.log("|:--|--:|--:|--:|--:|--:|--:|");
const ratios = [[], []];
try {
  for (const mesh of meshes) {
    run(lacedring, "encode", "--effort", "0", mesh, "-o", ours);
    run(lacedring, "decode", ours, "-o", whole);
    keepPositions(whole, alone);
    run(lacedring, "encode", alone, "-o", ours);
    run("node", gltfpack, "-noq", "-c", "-i", alone, "-o", theirs);
    const [a, b] = [sizes(ours), sizes(theirs)];
    ratios.forEach((list, k) => list.push(a[k] / b[k]));
    const row = [...a, ...b].map((n) => n.toLocaleString("en-US"));
    console.log(`| ${[basename(mesh), ...row, ...ratios.map((list) => list.at(-1).toFixed(2))].join(" | ")} |`);
  }
} finally {
  rmSync(folder, {recursive: true});
}
console.log(`| median | | | | | ${ratios.map((list) => median(list).toFixed(2)).join(" | ")} |`);
