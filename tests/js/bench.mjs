// node bench.mjs PROGRAM PACKAGES BITS ROUNDS MESH...: times decoding from bytes to typed arrays in node and headless
// Chromium, compared with meshoptimizer and Draco. Meshes have positions of BITS bits and triangles only. PROGRAM is
// lacedring, PACKAGES the output of scripts/node-packages.
import {execFileSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {createRequire} from "node:module";
import {tmpdir} from "node:os";
import {basename, dirname, extname, join} from "node:path";
import {fileURLToPath} from "node:url";

import {serve} from "../../scripts/web.mjs";
import {Page} from "../browser/chromium.mjs";

import {bench} from "./bench-core.js";

const [program, packages, bits, rounds, ...files] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url)), root = join(here, "../.."),
      modules = join(packages, "node_modules");
const require = createRequire(join(packages, "package.json"));
const lacedring = await import(join(root, "build/js/lacedring.js"));
const {MeshoptDecoder, MeshoptEncoder} = await import(join(modules, "meshoptimizer/index.js"));
const draco3d = require("draco3d");
const encoderModule = await draco3d.createEncoderModule({});
await Promise.all([lacedring.ready, MeshoptDecoder.ready, MeshoptEncoder.ready]);
const libraries = {
  lacedring,
  meshopt: MeshoptDecoder,
  draco: await draco3d.createDecoderModule({})
};
const work = mkdtempSync(join(tmpdir(), "lacedring-bench-"));

function encode(source, name, ...options) {
  const out = join(work, name);
  execFileSync(program, ["encode", source, "--positions", bits, ...options, "--force", "-o", out], {stdio: "ignore"});
  return new Uint8Array(readFileSync(out));
}

/** Writes a PLY file of positions and triangles. */
function writePly(name, positions, indices) {
  const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${
                   positions.length / 3}\nproperty float x\nproperty float y\nproperty float z\n` +
    `element face ${indices.length / 3}\nproperty list uchar uint vertex_indices\nend_header\n`;
  const faces = new DataView(new ArrayBuffer(13 * (indices.length / 3)));
  for (let t = 0; t < indices.length / 3; ++t) {
    faces.setUint8(13 * t, 3);
    for (let k = 0; k < 3; ++k) faces.setUint32(13 * t + 1 + 4 * k, indices[3 * t + k], true);
  }
  const file = join(work, name);
  writeFileSync(file, Buffer.concat([Buffer.from(header), Buffer.from(positions.buffer), Buffer.from(faces.buffer)]));
  return file;
}

/**
 * meshoptimizer's buffers as gltfpack writes them: vertices of four 16-bit integers in an order that suits its codecs.
 */
function encodeMeshopt(positions, indices) {
  const ordered = indices.slice(), [remap, count] = MeshoptEncoder.reorderMesh(ordered, true, true);
  let low = [Infinity, Infinity, Infinity], extent = 0;
  positions.forEach((x, i) => low[i % 3] = Math.min(low[i % 3], x));
  positions.forEach((x, i) => extent = Math.max(extent, x - low[i % 3]));
  const vertices = new Uint16Array(4 * count);
  for (let v = 0; v < remap.length; ++v) {
    if (remap[v] === 0xffffffff) continue;
    for (let c = 0; c < 3; ++c)
      vertices[4 * remap[v] + c] = Math.round((positions[3 * v + c] - low[c]) / extent * (2 ** bits - 1));
  }
  return {
    vertexCount: count,
    vertices: MeshoptEncoder.encodeVertexBuffer(new Uint8Array(vertices.buffer), count, 8),
    indices: MeshoptEncoder.encodeIndexBuffer(new Uint8Array(ordered.buffer), ordered.length, 4)
  };
}

function encodeDraco(positions, indices) {
  const encoder = new encoderModule.Encoder(), builder = new encoderModule.MeshBuilder(),
        mesh = new encoderModule.Mesh();
  builder.AddFacesToMesh(mesh, indices.length / 3, indices);
  builder.AddFloatAttributeToMesh(mesh, encoderModule.POSITION, positions.length / 3, 3, positions);
  encoder.SetAttributeQuantization(encoderModule.POSITION, Number(bits));
  const data = new encoderModule.DracoInt8Array(), size = encoder.EncodeMeshToDracoBuffer(mesh, data);
  return Uint8Array.from({length: size}, (_, i) => data.GetValue(i));
}

const page = new Page(), served = {};
const server =
  await serve({tests: here, package: join(root, "build/js"), packages: modules}, 0, {files: served, isolated: true});
console.log(`positions of ${bits} bits; milliseconds, least (median) of ${
  rounds} rounds; "x" are ratios of medians, above 1 where LacedRing is faster`);
console.log(
  "| mesh | where | resident | stored | meshoptimizer | Draco | resident/meshopt x | resident/Draco x | stored/Draco x |\n|---|---|---|---|---|---|---|---|---|");
try {
  await page.open(`http://127.0.0.1:${server.address().port}/tests/bench.html`);
  for (const file of files) {
    const name = basename(file, extname(file));
    const all = lacedring.decodeMesh(encode(file, "all.lr", "--resident"));
    const plain = writePly("plain.ply", all.attributes[0].values, all.indices);
    const mesh = {
      triangleCount: all.triangleCount,
      resident: encode(plain, "resident.lr", "--resident"),
      stored: encode(plain, "stored.lr"),
      ...encodeMeshopt(all.attributes[0].values, all.indices),
      draco: encodeDraco(all.attributes[0].values, all.indices)
    };
    for (const part of ["resident", "stored", "indices", "vertices", "draco"]) served[`${name}.${part}`] = mesh[part];
    const counts = {vertexCount: mesh.vertexCount, triangleCount: mesh.triangleCount};
    const results = {
      node: bench(libraries, mesh, Number(rounds)),
      Chromium: await page.evaluate(`run(${JSON.stringify(name)}, ${JSON.stringify(counts)}, ${rounds})`)
    };
    console.log(`| ${name}: bytes | | ${mesh.resident.length} | ${mesh.stored.length} | ${
      mesh.indices.length + mesh.vertices.length} | ${mesh.draco.length} | | | |`);
    for (const [where, {resident, stored, meshoptimizer, draco}] of Object.entries(results)) {
      const show = ({least, median}) => `${least.toFixed(2)} (${median.toFixed(2)})`,
            ratio = (a, b) => (b.median / a.median).toFixed(2);
      console.log(`| ${name} | ${where} | ${[resident, stored, meshoptimizer, draco].map(show).join(" | ")} | ${
        ratio(resident, meshoptimizer)} | ${ratio(resident, draco)} | ${ratio(stored, draco)} |`);
    }
  }
} finally {
  await page.close();
  server.close();
  rmSync(work, {recursive: true, force: true});
}
