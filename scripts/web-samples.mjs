// node web-samples.mjs PROGRAM FOLDER: packs the page's samples from assets/ to FOLDER, and writes FOLDER/index.json
// with their names and Brotli sizes, since browsers cannot compress with Brotli. If PROGRAM does not exist, copies the
// .glb samples unpacked; the page then encodes them itself.
import {execFileSync} from "node:child_process";
import {copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {dirname, join} from "node:path";
import {fileURLToPath} from "node:url";
import {brotliCompressSync} from "node:zlib";

const SAMPLES = [
  ["Blob", "blob.ply", "blob.lr"], ["Globe", "globe.glb", "globe.packed.glb"],
  ["Materials", "materials.glb", "materials.packed.glb"]
];

const [program, folder] = process.argv.slice(2);
const assets = join(dirname(fileURLToPath(import.meta.url)), "../assets");
const run = (...args) => execFileSync(program, args, {stdio: "pipe"});
const brotli = (path) => brotliCompressSync(readFileSync(path)).length;

rmSync(folder, {recursive: true, force: true});
mkdirSync(folder, {recursive: true});
const index = [];
for (const [label, source, file] of SAMPLES) {
  const from = join(assets, source), to = join(folder, file);
  if (!existsSync(program)) {
    if (!source.endsWith(".glb")) continue;
    copyFileSync(from, join(folder, source));
    index.push({label, file: source});
  } else if (file.endsWith(".lr")) {
    const plain = join(folder, `${file}.glb`);
    run("encode", "--positions", "14", "--normals", "10", from, "-o", to);
    run("decode", to, "-o", plain);
    index.push({label, file, brotli: {plain: brotli(plain), ours: brotli(to)}});
    rmSync(plain);
  } else {
    run("pack", from, "-o", to);
    index.push({label, file, brotli: {plain: brotli(from), ours: brotli(to)}});
  }
}
writeFileSync(join(folder, "index.json"), JSON.stringify(index));
