// Compares every attribute and index that the npm package decodes with lacedring decode; tests refusals, errors and
// memory.
import assert from "node:assert/strict";
import {createHash} from "node:crypto";
import {readFileSync} from "node:fs";
import {join} from "node:path";
import test from "node:test";

import {encode, lacedring, root, sources, VARIANTS, work} from "./files.mjs";
import {readGlb} from "./glb.mjs";

const memories = [];
const {Instance} = WebAssembly;
WebAssembly.Instance = function(...args) {
  const made = new Instance(...args);
  memories.push(made.exports.memory);
  return made;
};
const {LacedRingError, ready, decodeMesh, decodeMeshAsync, decodeTriangle, validate} =
  await import(join(root, "build/js/lacedring.js"));
await ready;
const files = sources();

/** Compares values as numbers, because glTF files have other types for some attributes. */
function sameValues(ours, theirs, vUp, what) {
  assert.equal(ours.length, theirs.length, what);
  for (let i = 0; i < ours.length; ++i) {
    const value = Math.fround(vUp && i % 2 === 1 ? 1 - ours[i] : ours[i]);
    if (!Object.is(value, Math.fround(theirs[i]))) assert.equal(value, theirs[i], `${what}, value ${i}`);
  }
}

for (const source of files) {
  for (const variant of Object.keys(VARIANTS)) {
    test(`${source.split("/").pop()}, ${variant}`, () => {
      const {file, bytes} = encode(source, variant), mesh = decodeMesh(bytes);
      lacedring("decode", file, "--force", "-o", `${file}.glb`);
      const glb = readGlb(`${file}.glb`);
      assert.deepEqual(mesh.indices, Uint32Array.from(glb.indices));
      assert.equal(mesh.triangleCount, glb.indices.length / 3);
      const names = Object.keys(glb.attributes);
      for (const {name, values, vUp, components} of mesh.attributes) {
        assert.equal(values.length, mesh.vertexCount * components);
        const theirs = glb.attributes[name] ?? glb.attributes[`_${name}`];
        if (theirs && theirs.components === components)
          sameValues(values, theirs.values, vUp && /^TEXCOORD/.test(name), name);
      }
      assert.ok(mesh.attributes.length >= names.length);
      if (mesh.surface) {
        mesh.indices.forEach((copy, i) => assert.equal(mesh.surface.vertexOf[copy], mesh.surface.indices[i]));
      }
      if (variant === "stored, order kept") checkOrder(file, mesh);
      validate(bytes);
    });
  }
}

/** Checks that vertexOrder and cornerOrder restore the output of lacedring decode --original-order. */
function checkOrder(file, {vertexCount, indices, vertexOrder, cornerOrder}) {
  assert.deepEqual(vertexOrder.slice().sort(), Uint32Array.from({length: vertexCount}, (_, i) => i));
  lacedring("decode", file, "--original-order", "--force", "-o", `${file}.glb`);
  const {indices: original} = readGlb(`${file}.glb`),
                  triangles = [...cornerOrder.keys()].sort((a, b) => cornerOrder[a] - cornerOrder[b]);
  triangles.forEach((i, t) => {
    for (let k = 0; k < 3; ++k)
      assert.equal(vertexOrder[indices[3 * i + k]], original[3 * t + (cornerOrder[i] + k) % 3]);
  });
}

// The hash changes if lacedring encode chooses another order.
test("decoded bytes have the stored hash", () => {
  const hash = createHash("sha256");
  for (const variant of Object.keys(VARIANTS)) {
    const mesh = decodeMesh(encode(join(root, "assets/globe.glb"), variant).bytes);
    for (const array of [mesh.indices, ...mesh.attributes.map(({values}) => values)])
      hash.update(new Uint8Array(array.buffer));
  }
  assert.equal(hash.digest("hex"), "45e8a43927cd026780ba74fde089e00a3d5d81fb9959b9efc0bc61e42255eb29");
});

test("without SIMD the arrays are the same", async () => {
  const {validate: isValid} = WebAssembly;
  WebAssembly.validate = () => false;
  const scalar = await import(join(root, "build/js/lacedring.js") + "?scalar");
  await scalar.ready;
  WebAssembly.validate = isValid;
  for (const source of files) {
    for (const variant of Object.keys(VARIANTS)) {
      const {bytes} = encode(source, variant);
      assert.deepEqual(scalar.decodeMesh(bytes), decodeMesh(bytes));
    }
  }
});

test("modules of fewer formats decode theirs and refuse others", async () => {
  const vertices = await import(join(root, "build/js/vertices.js")),
        core = await import(join(root, "build/js/core.js"));
  await Promise.all([vertices.ready, core.ready]);
  const resident = encode(files.at(-1), "resident").bytes, stored = encode(files.at(-1), "stored").bytes;
  assert.deepEqual(vertices.decodeMesh(resident), decodeMesh(resident));
  assert.throws(() => vertices.decodeMesh(stored), {name: "LacedRingError", code: "UNSUPPORTED"});
  assert.throws(() => core.decodeMesh(resident), {name: "LacedRingError", code: "UNSUPPORTED"});
});

test("a worker decodes the same arrays", async () => {
  const {bytes} = encode(files[0], "stored"), expected = decodeMesh(bytes);
  const meshes = await Promise.all([1, 2, 3].map(() => decodeMeshAsync(bytes)));
  for (const mesh of meshes) assert.deepEqual(mesh, expected);
  await assert.rejects(decodeMeshAsync(bytes.subarray(0, 100)), LacedRingError);
});

test("single triangles equal those of the mesh", () => {
  for (const format of ["lean", "packed"]) {
    for (const source of files.slice(3, 9)) {
      const {bytes} = encode(source, format, ["--format", format, "--resident"]),
            words = new Uint32Array(bytes.buffer, 0, bytes.length / 4 | 0);
      const {indices, surface} = decodeMesh(bytes), stream = bytes.slice(words[10], words[10] + words[12]), list = [];
      for (let t = 0; list.length < indices.length; ++t) {
        const triangle = decodeTriangle(stream, t);
        if (triangle[0] !== triangle[1]) list.push(...triangle);
      }
      assert.deepEqual(Uint32Array.from(list), surface?.indices ?? indices);
      assert.throws(() => decodeTriangle(stream, indices.length), RangeError);
    }
  }
});

test("malformed bytes and wrong arguments are refused", () => {
  const tables = encode(files[3], "lr", ["--format", "lr"]).bytes, {bytes} = encode(files[3], "stored");
  assert.throws(() => decodeMesh(tables), {name: "LacedRingError", code: "UNSUPPORTED", message: /LR tables/});
  assert.throws(() => decodeMesh(new Uint8Array(readFileSync(join(root, "assets/globe.glb")))), {code: "MAGIC"});
  assert.throws(() => decodeMesh(new Uint8Array(0)), {code: "MAGIC"});
  assert.throws(() => decodeMesh(bytes, {limits: {maxMemory: 10000}}), {code: "LIMIT"});
  for (let size = 4; size < bytes.length; size += 97)
    assert.throws(() => decodeMesh(bytes.subarray(0, size)), LacedRingError);
  const apart = new Uint8Array(bytes.length + 3).subarray(3);  // bytes need no alignment
  apart.set(bytes);
  assert.deepEqual(decodeMesh(apart), decodeMesh(bytes));
});

test("memory does not grow over 100 loads", () => {
  const {bytes} = encode(files[0], "stored");
  const size = () => memories.reduce((sum, {buffer}) => sum + buffer.byteLength, 0);
  decodeMesh(bytes);
  const before = [memories.length, size()];
  for (let i = 0; i < 100; ++i) decodeMesh(bytes);
  assert.deepEqual([memories.length, size()], before);
});
