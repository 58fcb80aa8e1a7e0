// node encode.test.mjs PACKAGE LACEDRING: encodeMesh writes the same bytes as `lacedring encode` for the same arrays,
// and refuses invalid ones with an error of one line. PACKAGE is the output folder of scripts/build-js. Exit code 1: a
// difference.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {join, resolve} from "node:path";

import {makeGlb} from "./gltf_files.mjs";

const [packagePath, program] = process.argv.slice(2);
const load = (path) => import(resolve(packagePath, path));
const {LacedRingError, decodeMesh, ready} = await load("lacedring.js");
const {encodeMesh, ready: encoderReady} = await load("encode.js");
const folder = mkdtempSync(join(tmpdir(), "lacedring-encode-"));

/** Returns a function that gives random numbers from 0 to 1. */
function randomNumbers(seed) {
  return () => {
    seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
    return seed / 2 ** 32;
  };
}

/**
 * A sphere of n by 2 n quads with seams at a meridian and the poles. Some triangles are flipped, doubled or
 * degenerate.
 */
function sphere(n) {
  const positions = [], normals = [], texcoords = [], colors = [], tags = [], indices = [];
  for (let i = 0; i <= n; i++) {
    for (let j = 0; j <= 2 * n; j++) {
      const u = (j % (2 * n)) / (2 * n), [a, b] = [Math.PI * i / n, 2 * Math.PI * u];
      const s = i === 0 || i === n ? 0 : Math.sin(a);
      const p = [s * Math.cos(b), Math.cos(a), s * Math.sin(b)];
      positions.push(...p.map((x) => 3 * x));
      normals.push(...p);
      texcoords.push(j / (2 * n), i / n);
      colors.push(i * 9, j * 5, 30, 255);
      tags.push(i * 1000 + j);
      if (i < n && j < 2 * n) {
        const v = i * (2 * n + 1) + j, w = v + 2 * n + 1;
        indices.push(v, w, v + 1, v + 1, w, w + 1);
      }
    }
  }
  indices.push(...indices.slice(60, 120), 5, 5, 6);
  [indices[0], indices[1]] = [indices[1], indices[0]];
  return {
    indices: Uint32Array.from(indices),
    attributes: [
      {name: "COLOR_0", components: 4, values: Uint8Array.from(colors), normalized: true},
      {name: "NORMAL", components: 3, values: Float32Array.from(normals)},
      {name: "POSITION", components: 3, values: Float32Array.from(positions)},
      {name: "TEXCOORD_0", components: 2, values: Float32Array.from(texcoords)},
      {name: "_TAG", components: 1, values: Float32Array.from(tags)}
    ]
  };
}

function soup(triangles, vertices, random) {
  return {
    indices: Uint16Array.from({length: 3 * triangles}, () => random() * vertices),
    positions: Float32Array.from({length: 3 * vertices}, () => Math.round(random() * 8) - 4)
  };
}

const TYPES = [, "SCALAR", "VEC2", "VEC3", "VEC4"],
      COMPONENTS = new Map([[Uint8Array, 5121], [Uint16Array, 5123], [Uint32Array, 5125], [Float32Array, 5126]]);

/** Writes a mesh as a GLB. The program reads its attributes in alphabetical order. */
function writeGlb(path, {indices, positions, attributes = [{name: "POSITION", components: 3, values: positions}]}) {
  const views = [], accessors = [];
  const add = ({values, components, normalized}) => {
    views.push(Buffer.from(values.buffer, values.byteOffset, values.byteLength));
    return accessors.push({
      bufferView: views.length - 1,
      componentType: COMPONENTS.get(values.constructor),
      count: values.length / components,
      type: TYPES[components],
      ...(normalized && {normalized})
    }) -
      1;
  };
  const used = Object.fromEntries(attributes.map((attribute) => [attribute.name, add(attribute)]));
  const primitive = {attributes: used, indices: add({values: indices, components: 1})};
  writeFileSync(
    path,
    makeGlb(
      {
        asset: {version: "2.0"},
        scene: 0,
        scenes: [{nodes: [0]}],
        nodes: [{mesh: 0}],
        meshes: [{primitives: [primitive]}],
        accessors
      },
      views));
}

const ROUNDED = ["--positions", "14", "--normals", "10", "--texcoords", "12", "--colors", "8", "--weights", "8"];
const OPTIONS = [
  [{}, ROUNDED], [{lossless: true}, []], [{lossless: true, resident: true, effort: 0}, ["--resident", "--effort", "0"]],
  [
    {positionBits: 10, normalBits: 0, texcoordBits: 0, colorBits: 0, weightBits: 0, keepOrder: true, effort: 9},
    ["--positions", "10", "--keep-order", "--effort", "9"]
  ]
];

function compare(what, mesh, file) {
  for (const [options, flags] of OPTIONS) {
    const ours = encodeMesh(mesh, options), path = join(folder, "theirs.lr");
    execFileSync(program, ["encode", "--force", ...flags, file, "-o", path], {stdio: "pipe"});
    const theirs = readFileSync(path);
    assert(
      Buffer.compare(ours, theirs) === 0,
      `${what}, ${JSON.stringify(options)}: ${ours.length} bytes are not those ${theirs.length}`);
    assert(decodeMesh(ours).triangleCount > 0);
  }
}

function testBytes() {
  const file = join(folder, "mesh.glb");
  for (const [what, mesh] of [
         ["sphere", sphere(24)], ["soup", soup(300, 60, randomNumbers(1))],
         ["two triangles", soup(2, 6, randomNumbers(5))]]) {
    writeGlb(file, mesh);
    compare(what, mesh, file);
  }
  const {indices, positions} = soup(200, 100, randomNumbers(3)), doubles = Float64Array.from(positions, (x) => x / 3);
  const ply = join(folder, "mesh.ply"),
        rows = Array.from({length: 100}, (_, v) => doubles.subarray(3 * v, 3 * v + 3).join(" "));
  const faces = Array.from({length: 200}, (_, t) => `3 ${indices.subarray(3 * t, 3 * t + 3).join(" ")}`);
  writeFileSync(ply, [
    "ply", "format ascii 1.0", "element vertex 100", "property double x", "property double y", "property double z",
    "element face 200", "property list uchar int vertex_indices", "end_header", ...rows, ...faces, ""
  ].join("\n"));
  compare("doubles", {indices, positions: doubles}, ply);
}

function testErrors() {
  const positions = Float32Array.of(0, 0, 0, 1, 0, 0, 0, 1, 0), indices = Uint32Array.of(0, 1, 2);
  const wrong = [
    [{}, {}, /there are no positions/],
    [{positions: [0, 0, 0]}, {}, /POSITION: its values are no typed array/],
    [{positions: positions.subarray(1)}, {}, /POSITION: 8 values/],
    [{positions: Int32Array.from(positions)}, {}, /three floats/],
    [{positions, indices: Uint32Array.of(0, 1)}, {}, /2 indices are no triangles/],
    [{positions, indices: Uint32Array.of(0, 1, 3)}, {}, /index 2 names no vertex/],
    [{positions, indices: [0, 1, 2]}, {}, /unsigned integers/],
    [{positions, indices: Uint32Array.of(1, 1, 1)}, {}, /all are degenerate/],
    [{positions: positions.map((x, i) => (i === 4 ? NaN : x)), indices}, {}, /vertex 1: the position is not finite/],
    [{positions: Float64Array.from(positions, (x) => x * 1e300)}, {}, /vertex 1/],
    [{positions, normals: positions.subarray(3)}, {}, /NORMAL: 6 values/],
    [{positions, attributes: [{name: "POSITION", components: 3, values: positions}]}, {}, /POSITION occurs twice/],
    [{positions, attributes: [{name: "A", components: 0, values: positions}]}, {}, /0 components/],
    [{positions}, {positionBits: 23}, /positionBits: 1 to 22/],
    [{positions}, {normalBits: 1}, /normalBits: 2 to 16/],
    [{positions}, {effort: 10}, /effort: 0 to 9/],
  ];
  for (const [mesh, options, text] of wrong) {
    assert.throws(
      () => encodeMesh(mesh, options),
      (error) => error instanceof LacedRingError && text.test(error.message) && !error.message.includes("\n"),
      `${text}`);
  }
  assert.equal(decodeMesh(encodeMesh({positions})).triangleCount, 1);  // works after errors; without indices
}

/** Encodes random numbers: an error, or a file with all triangles that are not degenerate. */
function testRandomMeshes() {
  const random = randomNumbers(11), odd = [0, -0, 1e-45, -1e38, 3e38, NaN, Infinity, 1, 1, 1];
  for (let run = 0; run < 150; run++) {
    const vertices = 1 + Math.floor(random() * 40),
          {indices} = soup(1 + Math.floor(random() * 60), vertices + (random() < 0.1 ? 1 : 0), random);
    const values = (components) => Float32Array.from(
      {length: components * vertices},
      () => (random() < 0.02 ? odd[Math.floor(random() * odd.length)] : Math.round(random() * 5)));
    const mesh = {indices, positions: values(3), normals: values(3), texcoords: values(2), colors: values(4)};
    const expected = indices.filter((_, i) => i % 3 === 0 && new Set(indices.subarray(i, i + 3)).size === 3).length;
    try {
      assert.equal(decodeMesh(encodeMesh(mesh, {lossless: run % 2 === 0})).triangleCount, expected);
    } catch (error) {
      assert(error instanceof LacedRingError && error.code === "ARGUMENT", error.stack);
    }
  }
}

/** Exhausting memory throws a JavaScript error. */
async function testMemory() {
  const {default: text} = await load("wasm/encode.js");
  const outOfMemory = () => {
    throw new Error("out of memory");
  };
  const stubs = new Proxy({}, {get: () => () => 8});
  const {instance} = await WebAssembly.instantiate(
    Buffer.from(text, "base64"), {lacedring: {outOfMemory}, wasi_snapshot_preview1: stubs});
  instance.exports._initialize();
  assert.throws(() => instance.exports.indices(0x3fffffff, 1), /out of memory/);
}

try {
  assert.throws(() => encodeMesh({positions: new Float32Array(9)}), {code: "NOT_READY"});
  await Promise.all([ready, encoderReady]);
  testBytes();
  testErrors();
  testRandomMeshes();
  await testMemory();
} finally {
  rmSync(folder, {recursive: true});
}
console.log("encodeMesh: all good");
