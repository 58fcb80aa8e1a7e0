// node gltf.mjs PACKAGE LACEDRING SCENE...: packs glTF scenes by every option, and compares accessors and images that
// the package unpacks with those of `lacedring unpack`, bit for bit. PACKAGE is the output folder of scripts/build-js.
// Exit code 1: a difference.
import assert from "node:assert/strict";
import {execFileSync} from "node:child_process";
import {mkdtempSync, readFileSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {basename, dirname, join, resolve} from "node:path";
import {deflateSync} from "node:zlib";

import {accessorBytes, makeGlb, readScene} from "./gltf_files.mjs";

const [packagePath, program, ...scenes] = process.argv.slice(2);
const load = (path) => import(resolve(packagePath, path));
const {EXTENSION, unpackGlb} = await load("gltf/lacedring-gltf.js");
const {inflate} = await load("gltf/inflate.js");
const {decodePartCodes} = await load("gltf/part-codes.js");

const OPTIONS = [
  [], ["--lossless"], ["--lossless", "--keep-order"], ["--keep-order", "--document", "packed"], ["--document", "plain"],
  ["--resident", "--document", "packed"], ["--fallback", "--lossless"]
];
const folder = mkdtempSync(join(tmpdir(), "lacedring-gltf-"));
const run = (...args) => execFileSync(program, args, {stdio: "pipe"});

/** Compares the package's plain GLB of a packed file with that of the program. */
async function compare(packed) {
  const files = async (_, uri) => new Uint8Array(
    uri.startsWith("data:") ? Buffer.from(uri.split(",")[1], "base64") :
                              readFileSync(join(dirname(packed), decodeURIComponent(uri))));
  const ours = readScene(await unpackGlb(new Uint8Array(readFileSync(packed)), files));
  run("unpack", "--force", packed, "-o", join(folder, "theirs.glb"));
  const theirs = readScene(new Uint8Array(readFileSync(join(folder, "theirs.glb"))));
  assert(!JSON.stringify(ours.json).includes(EXTENSION), "the extension is still there");
  assert.equal(ours.json.accessors.length, theirs.json.accessors.length);
  ours.json.accessors.forEach((a, i) => {
    const b = theirs.json.accessors[i];
    for (const name of ["componentType", "type", "normalized", "count", "min", "max"]) {
      const [mine, other] = [a[name], b[name]].map((value) => (Array.isArray(value) ? value.map(Math.fround) : value));
      assert.equal(`${mine}`, `${other}`, `accessor ${i}: ${name}`);
    }
    assert(Buffer.compare(accessorBytes(ours, i), accessorBytes(theirs, i)) === 0, `accessor ${i}: values`);
  });
  (ours.json.images ?? []).forEach(({bufferView}, i) => {
    if (bufferView === undefined) return;
    assert.deepEqual(ours.view(bufferView), theirs.view(theirs.json.images[i].bufferView), `image ${i}`);
  });
  for (const name of ["nodes", "skins", "animations", "materials", "meshes"]) {
    assert(JSON.stringify(ours.json[name]) === JSON.stringify(theirs.json[name]), `${name} differ`);
  }
}

/** The part codes of runs [part, triangles], as the extension defines them. */
function encodePartCodes(runs) {
  const bytes = [], recent = [], seen = new Set();
  let expected = 0;
  const put = (value) => {
    for (; value > 127; value >>>= 7) bytes.push((value & 127) | 128);
    bytes.push(value);
  };
  for (const [part, triangles] of runs) {
    const at = recent.indexOf(part);
    if (!seen.has(part)) {
      const d = part - expected;
      put(0);
      put(d < 0 ? -2 * d - 1 : 2 * d);
      expected = part + 1;
    } else {
      put(at >= 0 ? at + 1 : 65 + part);
    }
    if (at >= 0) recent.splice(at, 1);
    seen.add(part);
    recent.unshift(part);
    recent.length = Math.min(recent.length, 64);
    put(triangles - 1);
  }
  return Uint8Array.from(bytes);
}

function testPartCodes() {
  const runs = [];
  for (let i = 0; i < 300; i++) runs.push([(i * 77) % 300, 1 + (i % 200)]);             // parts out of order
  for (let i = 0; i < 2000; i++) runs.push([(i * i * 31 + 7 * i) % 300, 1 + (i % 3)]);  // recent and old parts again
  const merged = runs.filter(([part], i) => i === 0 || part !== runs[i - 1][0]);
  const expected = merged.flatMap(([part, triangles]) => new Array(triangles).fill(part));
  assert.deepEqual([...decodePartCodes(encodePartCodes(merged), expected.length, 300)], expected);
  const invalid = [
    // bytes, triangles, parts
    [[0, 0, 0], 2, 1],
    [[0, 0, 1], 1, 1],
    [[0, 0], 1, 1],
    [[0, 0, 0, 65, 0], 2, 1],
    [[0, 0, 0, 66, 0], 2, 1],
    [[1, 0], 1, 1],
    [[0, 0, 0, 0, 1, 0], 2, 2],
    [[0, 0, 0], 1, 2],
    [[0, 2, 0], 1, 1],
    [[128], 1, 1],
    [[0, 255, 255, 255, 255, 16, 0], 1, 1],
    [[], 1, 1],
  ];
  for (const [bytes, triangles, parts] of invalid) {
    assert.throws(
      () => decodePartCodes(Uint8Array.from(bytes), triangles, parts), /^Error: LACEDRING_mesh_compression: .*$/,
      `${bytes}`);
  }
}

async function testInflate() {
  const bytes = new Uint8Array(300000).map((_, i) => i * i >> 5);
  const deflated = new Uint8Array(deflateSync(bytes));
  assert.deepEqual(await inflate(deflated, bytes.length), bytes);
  await assert.rejects(inflate(deflated, bytes.length - 1), /more than 299999 bytes/);
  await assert.rejects(inflate(deflated.subarray(0, deflated.length - 5), bytes.length), /damaged/);
  await assert.rejects(inflate(new Uint8Array(0), 1), /damaged/);
  const bomb = new Uint8Array(deflateSync(Buffer.alloc(64 << 20)));
  await assert.rejects(inflate(bomb, 1000), /more than 1000 bytes/);
}

/** A scene whose animation has NaN, infinities, subnormal numbers and -0, and quaternions, some not of unit length. */
function animatedScene() {
  const frames = 300, times = [], translations = [], rotations = [];
  for (let i = 0; i < frames; i++) {
    times.push(i / 24);
    translations.push(
      Math.sin(i / 9), i % 50 === 7 ? -0 : i * 1e-42, [NaN, Infinity, -Infinity, 3e38][i % 40] ?? 0.25 * i);
    const a = i / 17, scale = i % 60 === 3 ? 2 : 1;
    rotations.push(
      ...[Math.sin(a) * 0.6, Math.sin(a) * -0.8, i % 45 === 2 ? -0 : 0, Math.cos(a)].map((x) => x * scale));
  }
  const columns =
    [["SCALAR", times], ["VEC3", translations], ["VEC4", rotations], ["VEC3", [0, 0, 0, 1, 0, 0, 0, 1, 0]]];
  const views = columns.map(([, values]) => new Uint8Array(Float32Array.from(values).buffer));
  views.push(new Uint8Array(Uint32Array.of(0, 1, 2).buffer));
  const accessors = columns.map(
    ([type, values], i) =>
      ({bufferView: i, componentType: 5126, type, count: values.length / {SCALAR: 1, VEC3: 3, VEC4: 4}[type]}));
  Object.assign(accessors[0], {min: [0], max: [Math.fround(times.at(-1))]});
  Object.assign(accessors[3], {min: [0, 0, 0], max: [1, 1, 0]});
  accessors.push({bufferView: 4, componentType: 5125, type: "SCALAR", count: 3});
  const channel = (sampler, path) => ({sampler, target: {node: 0, path}});
  return makeGlb(
    {
      asset: {version: "2.0"},
      scene: 0,
      scenes: [{nodes: [0]}],
      nodes: [{mesh: 0}],
      accessors,
      meshes: [{primitives: [{attributes: {POSITION: 3}, indices: 4}]}],
      animations: [{
        samplers: [{input: 0, output: 1}, {input: 0, output: 2}],
        channels: [channel(0, "translation"), channel(1, "rotation")],
      }],
    },
    views);
}

/**
 * A scene of many small meshes of two primitives that share streams, with more parts than the list of recent parts
 * holds.
 */
function crowdScene() {
  const size = 5, accessors = [], views = [], meshes = [];
  const add = (array, accessor) => {
    views.push(new Uint8Array(array.buffer));
    return accessors.push({bufferView: views.length - 1, ...accessor}) - 1;
  };
  for (let mesh = 0; mesh < 150; mesh++) {
    const positions = new Float32Array(3 * size * size);
    const halves = [[], []];
    for (let i = 0; i < size * size; i++) {
      const [x, y] = [i % size, Math.floor(i / size)];
      positions.set([x, y, Math.sin(mesh + i)], 3 * i);
      if (x + 1 < size && y + 1 < size)
        halves[(x + y * mesh) % 2].push(i, i + 1, i + size, i + 1, i + size + 1, i + size);
    }
    const [min, max] =
      [Math.min, Math.max].map((pick) => [0, 1, 2].map((c) => pick(...positions.filter((_, i) => i % 3 === c))));
    const position = add(positions, {componentType: 5126, type: "VEC3", count: size * size, min, max});
    const primitives =
      halves.map((half) => ({
                   attributes: {POSITION: position},
                   indices: add(Uint32Array.from(half), {componentType: 5125, type: "SCALAR", count: half.length})
                 }));
    meshes.push({primitives});
  }
  const nodes = meshes.map((_, mesh) => ({mesh}));
  return makeGlb({asset: {version: "2.0"}, scenes: [{nodes: nodes.map((_, i) => i)}], nodes, accessors, meshes}, views);
}

try {
  testPartCodes();
  await testInflate();
  const [animated, crowd] = ["animated.glb", "crowd.glb"].map((name) => join(folder, name));
  writeFileSync(animated, animatedScene());
  writeFileSync(crowd, crowdScene());
  let count = 0;
  for (const scene of [animated, crowd, ...scenes]) {
    for (const [i, options] of OPTIONS.entries()) {
      const packed = join(folder, `${basename(scene)}.${i}.glb`);
      run("pack", ...options, scene, "-o", packed);
      await compare(packed).catch((error) => {
        error.message = `${basename(scene)}, pack ${options.join(" ")}: ${error.message}`;
        throw error;
      });
      count++;
    }
  }
  const {json} = readScene(new Uint8Array(readFileSync(join(folder, "animated.glb.4.glb"))));
  const codings = json.bufferViews.map((view) => view.extensions?.[EXTENSION]?.coding);
  assert(
    codings.filter((coding) => coding === "floats").length >= 2, `the animation is not coded as floats: ${codings}`);
  console.log(`${count} packed files equal to what lacedring unpack makes of them`);
} finally {
  rmSync(folder, {recursive: true});
}
