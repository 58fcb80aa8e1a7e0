// Decodes everything in an .lr file with shaders/include/*.wgsl in compute shaders, and compares every integer with the
// readers of tests/independent.
import {createBuffer, Kernel, openDevice, readBuffer} from "/gpu/gpu.js";
import {crc32, readLr} from "/gpu/lr-file.js";
import {LacedRingError} from "/lacedring/errors.js";

const NULL = 0xffffffff, GUARD = 0xdeadbeef;
const include = async (name) => (await fetch(`/shaders/${name}.wgsl`)).text();

let device;
window.open_ = async () => {
  device = await openDevice();
  device.addEventListener("uncapturederror", ({error}) => console.error(error.message));
};

/** Compiles a shader joined from includes and a text; returns the compiler's messages. */
window.compile = async (names, text) => {
  const includes = await Promise.all(names.map(include));
  const {messages} = await device.createShaderModule({code: includes.join("") + text}).getCompilationInfo();
  return messages.map(({message, lineNum}) => `line ${lineNum}: ${message}`);
};

const kernels = new Map();
/** Returns the kernel of a name, created once. */
async function kernel(name, ...parts) {
  if (!kernels.has(name)) kernels.set(name, await Kernel.create(device, ...parts));
  return kernels.get(name);
}

/** A buffer of `words` words, filled with a value that no decoder writes. */
function output(words) {
  return createBuffer(device, "output", 4 * words, new Uint32Array(words).fill(GUARD));
}

async function read(buffer, words) {
  const out = await readBuffer(device, buffer);
  buffer.destroy();
  return out.subarray(0, words);
}

const STREAM = {
  words: ["read", "u32"],
  result: ["write", "u32"]
};
const WORDS = "fn lr_stream_word(i: u32) -> u32 { return words[i]; }";
const PUT3 = "fn put3(at: u32, v: vec3u) { result[at] = v.x; result[at + 1u] = v.y; result[at + 2u] = v.z; }";
const RUNS = {
  lean: ["lacedring", `${WORDS} ${PUT3} fn run(i: u32) { put3(3u * i, lr_lean_triangle(lr_lean_layout(), i)); }`],
  packed: ["lacedring", `${WORDS} ${PUT3} fn run(i: u32) { put3(3u * i, lr_packed_triangle(lr_packed_layout(), i)); }`],
  quads: [
    "lacedring", `${WORDS} ${PUT3} fn run(i: u32) {
    let p = lr_packed_layout();
    let count = min(lr_packed_triangles(p) - 4u * i, 4u);
    lr_packed_triangles_of_quad(p, 4u * i, count);
    for (var j = 0u; j < count; j++) { put3(12u * i + 3u * j, lr_packed_quad[j]); }
  }`
  ],
  lr: [
    "lacedring_operators", `fn lr_table_word(i: u32) -> u32 { return words[i]; }
  fn run(c: u32) {
    let lr = lr_op_layout();
    let at = 8u * c;
    if ((c & 3u) == 3u) { return; }
    result[at] = u32(lr_is_canonical(lr, c / 4u));
    result[at + 1u] = lr_canonical(lr, c);
    result[at + 2u] = lr_vertex(lr, c);
    result[at + 3u] = lr_opposite(lr, c);
    result[at + 4u] = lr_left(lr, c);
    result[at + 5u] = lr_right(lr, c);
    result[at + 6u] = lr_swing(lr, c);
    result[at + 7u] = lr_swing_back(lr, c);
  }`
  ],
  stars: [
    "lacedring_operators", `fn lr_table_word(i: u32) -> u32 { return words[i]; }
  fn run(v: u32) {
    let lr = lr_op_layout();
    result[3u * v] = lr_corner(lr, v);
    result[3u * v + 1u] = lr_star_first(lr, v);
    result[3u * v + 2u] = lr_valence(lr, v);
  }`
  ],
};

/** Runs a kernel over a stream with `invocations` invocations, each of which writes `each` words. */
async function runOver(name, stream, invocations, each, words = each * invocations) {
  const [file, code] = RUNS[name];
  const compiled = await kernel(name, STREAM, await include(file) + code);
  const source = createBuffer(device, name, stream.byteLength, stream), result = output(words);
  compiled.run({words: source, result}, invocations);
  const out = await read(result, words);
  source.destroy();
  return out;
}

/** Collects differences, the first of each kind. */
class Check {
  problems = [];
  values = 0;

  equal(what, got, expected) {
    this.values += expected.length;
    if (got.length !== expected.length)
      return this.problems.push(`${what}: ${got.length} values, not ${expected.length}`);
    const at = expected.findIndex((value, i) => value !== null && (value >>> 0) !== got[i]);
    if (at >= 0) this.problems.push(`${what}: value ${at} is ${got[at]}, not ${expected[at]}`);
  }
}

/**
 * The expected slots as a flat list. A slot without a triangle must have two equal vertices in `got`, whose value is
 * taken.
 */
function flat(check, what, slots, got) {
  return slots.flatMap((slot, i) => {
    if (slot.length === 3) return slot;
    if (got[3 * i] !== got[3 * i + 1]) check.problems.push(`${what}: slot ${i} is not degenerate`);
    return [null, null, null];
  });
}

async function checkTriangles(check, file, expected) {
  for (const name of file.kind === "packed" ? ["packed", "quads"] : [file.kind]) {
    const invocations = name === "quads" ? Math.ceil(file.slots / 4) : file.slots;
    const got = await runOver(name, file.stream, invocations, 3, 3 * file.slots);
    check.equal(name, got, flat(check, name, expected.slots, got));
  }
}

const next = (c) => (c % 4 === 2 ? c - 2 : c + 1), previous = (c) => (c % 4 === 0 ? c + 2 : c - 1);

async function checkOperators(check, file, {vertex, opposite}) {
  const across = (c) => opposite[c] ?? NULL, turn = (c, by) => (across(by(c)) === NULL ? NULL : by(across(by(c))));
  const got = await runOver("lr", file.stream, 4 * file.slots, 8);
  const ofCorner =
    (c, v) => [1, c, v, across(c), across(next(c)), across(previous(c)), turn(c, next), turn(c, previous)];
  check.equal("operators", got, vertex.flatMap((v, c) => (v === null ? Array(8).fill(null) : ofCorner(c, v))));
  const canonical = (c) => got[8 * c + 1];
  for (let c = 0; c < vertex.length; c++) {  // corners of a T2's first copy map to the second's
    if (c % 4 === 3 || vertex[c] !== null || canonical(c) === NULL) continue;
    if (vertex[canonical(c)] !== got[8 * c + 2])
      check.problems.push(`corner ${c} is of another vertex than its canonical number`);
  }
  const stars = await runOver("stars", file.stream, file.vertices, 3);
  const count = new Uint32Array(file.vertices), border = new Uint8Array(file.vertices);
  vertex.forEach((v, c) => {
    if (v === null) return;
    count[v] += 1;
    if (turn(c, next) === NULL) border[v] = 1;
  });
  for (let v = 0; v < file.vertices; v++) {
    const [corner, first, valence] = stars.subarray(3 * v, 3 * v + 3);
    const right = count[v] === 0 ?
      corner === NULL && first === NULL :
      vertex[corner] === v && vertex[first] === v && (border[v] === 1) === (turn(first, previous) === NULL);
    if (!right || valence !== count[v] + border[v]) check.problems.push(`the star of vertex ${v} is wrong`);
  }
}

const VERTEX = {
  ...STREAM,
  floats: ["write", "u32"],
  directions: ["write", "i32"]
};
const vertexCode = (n) => `const LR_VERTEX_COMPONENTS = ${n}u;
fn lr_vertex_word(i: u32) -> u32 { return words[i]; }
var<private> wanted: u32;
var<private> head: LrVertexLayout;
fn lr_vertex_put(i: u32) {
  if (wanted != 0xffffffffu && wanted != i) { return; }
  for (var c = 0u; c < ${n}u; c++) {
    let at = ${n}u * i + c;
    result[at] = lr_vertex_value[c];
    if (head.mapping == 1u || head.mapping == 3u || head.mapping == 4u) { floats[at] = lr_vertex_float(head, at, lr_vertex_value[c]); }
  }
  if (head.mapping == 2u) {
    let d = lr_vertex_direction(head, lr_vertex_value[0], lr_vertex_value[${Math.min(n - 1, 1)}]);
    for (var c = 0u; c < 3u; c++) { directions[3u * i + c] = d[c]; }
  }
}`;
const BLOCKS = "fn run(i: u32) { wanted = 0xffffffffu; head = lr_vertex_layout(); lr_vertex_block(head, i, 128u); }";
const SINGLE =
  "fn run(i: u32) { wanted = i; head = lr_vertex_layout(); lr_vertex_block(head, i / 128u, i % 128u + 1u); }";

/** Checks all blocks, with the mapping as a pipeline constant, then single vertices, with the mapping of the header. */
async function checkVertices(check, {name, words, integers, count, mapping}, expected) {
  const text = await include("lacedring_vertices");
  for (const alone of [false, true]) {
    const what = `${name}${alone ? ", each alone" : ""}`, constants = alone ? {} : {LR_VERTEX_MAPPING: mapping};
    const compiled = await kernel(
      `vertices ${integers} ${alone ? "alone" : mapping}`, VERTEX,
      text + vertexCode(integers) + (alone ? SINGLE : BLOCKS), constants);
    const source = createBuffer(device, name, words.byteLength, words);
    const [result, floats, directions] = [integers, integers, 3].map((n) => output(n * count));
    compiled.run({words: source, result, floats, directions}, alone ? count : Math.ceil(count / 128));
    check.equal(`${what}: integers`, await read(result, integers * count), expected.integers);
    if (expected.floats) check.equal(`${what}: floats`, await read(floats, integers * count), expected.floats);
    if (expected.directions) check.equal(`${what}: directions`, await read(directions, 3 * count), expected.directions);
    source.destroy();
  }
}

const SEAMS = {
  words: ["read", "u32"],
  indices: ["read", "u32"],
  homes: ["write", "u32"],
  copies: ["write", "u32"],
  vertex_of: ["write", "u32"],
  sizes: ["uniform", "vec4u"]
};
const SEAM_CODE = `fn lr_seam_word(i: u32) -> u32 { return words[i]; }
fn lr_seam_put_home(v: u32, value: u32) { homes[v] = value; }
fn lr_seam_home(v: u32) -> u32 { return homes[v]; }
fn lr_seam_vertex(k: u32) -> u32 { return indices[k]; }
fn lr_seam_copy(k: u32) -> u32 { return copies[k]; }
fn lr_seam_put_copy(k: u32, value: u32) { copies[k] = value; }
fn lr_seam_put_vertex(copy: u32, v: u32) { vertex_of[copy] = v; }
fn run(i: u32) {
  let seams = lr_seam_layout(sizes.x, sizes.y);
  if (sizes.z == 0u) { lr_seam_vertex_block(seams, i); } else { lr_seam_triangle_block(seams, i); }
}`;

async function checkSeams(check, file, expected) {
  const compiled = await kernel("seams", SEAMS, await include("lacedring_seams") + SEAM_CODE);
  const indices = Uint32Array.from(expected.slots.flatMap((slot) => (slot.length ? slot : [0, 0, 0])));
  const buffers = {
    words: createBuffer(device, "seams", file.seams.byteLength + 8, file.seams),
    indices: createBuffer(device, "indices", indices.byteLength, indices),
    homes: output(file.vertices + 1),
    copies: output(indices.length),
    vertex_of: output(file.copies)
  };
  for (const [second, count] of [[0, file.vertices], [1, file.slots]]) {
    const sizes = device.createBuffer({size: 16, usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST});
    device.queue.writeBuffer(sizes, 0, new Uint32Array([file.vertices, file.slots, second, 0]));
    compiled.run({...buffers, sizes}, Math.ceil(count / 512));
  }
  check.equal(
    "copies", await read(buffers.copies, indices.length),
    expected.copies.flatMap((copies) => (copies.length ? copies : [0, 0, 0])));
  check.equal("vertices of copies", await read(buffers.vertex_of, file.copies), expected.vertex_of);
}

const MAGICS = {
  0x4e4c524c: "lean",
  0x5443524c: "lr",
  0x3250524c: "packed"
};
/** A stream in the form that readLr returns. */
function golden({words, slots, vertices}) {
  return {kind: MAGICS[words[0]], stream: Uint32Array.from(words), slots: slots.length, vertices, attributes: []};
}

/** Compares a file or golden stream with FILE.json. Returns { problems, values, slots }. */
window.check = async (url) => {
  const expected = await (await fetch(`${url}.json`)).json(), check = new Check();
  const file = expected.words ? golden(expected) : readLr(new Uint8Array(await (await fetch(url)).arrayBuffer()));
  if (file.slots !== expected.slots.length) check.problems.push(`${file.slots} slots, not ${expected.slots.length}`);
  if (file.kind === "lr") {
    await checkOperators(check, file, expected.operators);
  } else {
    await checkTriangles(check, file, expected);
  }
  if (file.seams) await checkSeams(check, file, expected);
  const streams = file.attributes.filter(({words}) => words);
  if (streams.length !== expected.attributes.length) check.problems.push("another number of vertex streams");
  for (const [i, stream] of streams.entries()) await checkVertices(check, stream, expected.attributes[i]);
  return {problems: check.problems, values: check.values, slots: file.slots};
};

/** SplitMix32: returns a function that gives random numbers below a bound. */
function random(seed) {
  return (bound) => {
    seed = seed + 0x9e3779b9 | 0;
    let z = Math.imul(seed ^ seed >>> 16, 0x21f0aaad);
    z = Math.imul(z ^ z >>> 15, 0x735a2d97);
    return ((z ^ z >>> 15) >>> 0) % bound;
  };
}

/**
 * Decodes a file's streams with flipped bits or random words. Every shader must terminate, and the device must not be
 * lost. Returns the milliseconds of the slowest.
 */
window.damage = async (url, trials, seed) => {
  const file = readLr(new Uint8Array(await (await fetch(url)).arrayBuffer())), below = random(seed);
  const expected = await (await fetch(`${url}.json`)).json();
  let slowest = 0;
  const damaged = (words, first) => {
    const out = words.slice();
    for (let k = 0; k <= below(20); k++) {
      const at = first + below(out.length - first);
      out[at] = below(2) ? out[at] ^ 1 << below(32) : below(2 ** 32);
    }
    return out;
  };
  for (let trial = 0; trial < trials; trial++) {
    const start = performance.now(), check = new Check();
    const stream = damaged(file.stream, file.kind === "packed" ? 3 : 7);
    if (file.kind === "lr") {
      await runOver("lr", stream, 4 * file.slots, 8);
      await runOver("stars", stream, file.vertices, 3);
    } else {
      await runOver(file.kind, stream, file.slots, 3);
      if (file.kind === "packed") await runOver("quads", stream, Math.ceil(file.slots / 4), 12);
    }
    if (file.seams) await checkSeams(check, {...file, seams: damaged(file.seams, 2)}, expected);
    const {words, ...position} = file.attributes[0];
    await checkVertices(check, {...position, words: damaged(words, 4)}, expected.attributes[0]);
    slowest = Math.max(slowest, performance.now() - start);
  }
  return slowest;
};

/** The file with one word changed and valid checksums. */
function changed(bytes, below) {
  const out = bytes.slice(), view = new DataView(out.buffer);
  const at = 4 * below(below(2) ? out.length >> 2 : Math.min(100, out.length >> 2));
  view.setUint32(at, below(2) ? view.getUint32(at, true) ^ 1 << below(32) : below(2 ** 32), true);
  const count = Math.min(view.getUint32(8, true), out.length - 32 >> 5);
  for (let i = 0; i < count; i++) {
    const entry = 32 + 32 * i, offset = view.getUint32(entry + 8, true);
    view.setUint32(entry + 4, crc32(out.subarray(offset, offset + view.getUint32(entry + 16, true))), true);
  }
  view.setUint32(24, crc32(out.subarray(32, 32 + 32 * count)), true);
  view.setUint32(28, crc32(out.subarray(0, 28)), true);
  return below(20) === 0 ? out.subarray(0, below(out.length)) : out;
}

/**
 * Reads changed files: each must be refused with an Error of one line, or need no more memory than its bytes justify.
 * Returns failures.
 */
window.changeFile = async (url, trials, seed) => {
  const bytes = new Uint8Array(await (await fetch(url)).arrayBuffer()), below = random(seed), wrong = [];
  let refused = 0;
  for (let trial = 0; trial < trials; trial++) {
    try {
      const {slots, vertices, copies} = readLr(changed(bytes, below));
      if (slots > 64 * bytes.length || vertices > 256 * bytes.length || copies > 256 * bytes.length)
        wrong.push(`trial ${trial}: ${slots} ${vertices} ${copies}`);
    } catch (error) {
      refused++;
      if (![Error, LacedRingError].includes(error.constructor) || error.message.includes("\n"))
        wrong.push(`trial ${trial}: ${error}`);
    }
  }
  return {wrong, refused};
};
