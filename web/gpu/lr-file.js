// Reads .lr files (docs/lr-file.md) with resident sections, which a GPU can use unchanged. Checks sizes of streams, so
// that no count in a damaged file allocates too much memory. WebGPU keeps shaders inside their buffers.
import {ATTRIBUTE, LEAN, LR, LR_COMPACT, malformed, PACKED, readContainer, SEAMS, TYPES, VERTICES} from "../lacedring/container.js";

const KINDS = {
  [LEAN]: "lean",
  [LR]: "lr",
  [PACKED]: "packed"
};

const CRC_TABLE = Uint32Array.from({length: 256}, (_, i) => {
  for (let k = 0; k < 8; k++) i = i & 1 ? i >>> 1 ^ 0xedb88320 : i >>> 1;
  return i;
});

/** CRC-32, as in zlib. */
export function crc32(bytes) {
  let crc = 0xffffffff;
  for (let i = 0; i < bytes.length; i++) crc = crc >>> 8 ^ CRC_TABLE[(crc ^ bytes[i]) & 255];
  return ~crc >>> 0;
}

function require(condition, message) {
  if (!condition) throw malformed(message);
}

/**
 * Reads a file. `bytes`: a Uint8Array.
 * Returns { kind: "lean", "packed" or "lr", stream, slots, vertices, triangles, copies, seams, attributes }. stream and
 * seams are Uint32Arrays (seams is undefined if there are none). slots is the number of triangles to draw, degenerate
 * ones included. attributes is a list of { name, perCopy, count, components, bytes }. A vertex stream also has { words,
 * mapping, integers }, an uncompressed attribute of 32-bit floats a Float32Array `values`; other types have neither.
 * Throws an Error of one line.
 */
export function readLr(bytes) {
  bytes = bytes.byteOffset % 4 === 0 ? bytes : bytes.slice();
  const {sections, vertices, triangles, copies} =
    readContainer(bytes, (offset, size) => crc32(bytes.subarray(offset, offset + size)));
  const file = {vertices, triangles, copies, attributes: []};
  for (const section of sections) {
    if (section.isStored) throw new Error("This file is in storage form; write it with `lacedring encode --resident`.");
    readSection(file, section, bytes.subarray(section.offset, section.offset + section.size));
  }
  require(file.stream, "no connectivity");
  const copyCount = checkConnectivity(file);
  require(copies === 0 || (file.seams && copies <= copyCount), "impossible number of copies");
  const position = file.attributes.find(({name}) => name === "POSITION");
  require(position && position.components === 3 && !position.perCopy, "no positions");
  if (!position.values && !(position.mapping >= 1 && position.mapping <= 4 && position.mapping !== 2))
    throw new Error("The positions of this file are 64-bit floats, which a GPU cannot draw.");
  return file;
}

function wordsOf(contents) {
  require(contents.length % 4 === 0, "not a whole number of words");
  return new Uint32Array(contents.buffer, contents.byteOffset, contents.length / 4);
}

function readSection(file, {kind, name, perCopy, type, components}, contents) {
  if (kind === LR_COMPACT)
    throw new Error("Bit-efficient LR tables are not drawn here; write the file with --format lr, lean or packed.");
  if (kind in KINDS) {
    require(!file.stream, "two sections of connectivity");
    Object.assign(file, {kind: KINDS[kind], stream: wordsOf(contents)});
  } else if (kind === SEAMS && contents.length > 0) {
    file.seams = wordsOf(contents);
  } else if (kind === ATTRIBUTE || kind === VERTICES) {
    const attribute = {name, perCopy, count: perCopy ? file.copies : file.vertices, bytes: contents.length};
    if (kind === VERTICES)
      readVertexStream(attribute, contents);
    else
      readValues(attribute, contents, TYPES[type][0], components);
    file.attributes.push(attribute);
  }
}

function readValues(attribute, values, type, components) {
  attribute.components = components;
  if (type === "f32") {
    require(values.length === 4 * components * attribute.count, "an attribute with the wrong number of values");
    attribute.values = new Float32Array(values.buffer, values.byteOffset, values.length / 4);
  } else if (type === "f64" && attribute.name === "POSITION") {
    throw new Error("The positions of this file are 64-bit floats, which a GPU cannot draw.");
  }
}

function readVertexStream(attribute, contents) {
  const words = wordsOf(contents);
  require(words.length >= 9 && words[0] === 0x3156524c, "not a vertex stream");
  const n = words[2] & 31, blocks = Math.ceil(words[1] / 128),
        groupWords = 1 + Math.ceil(15 * (words[2] >>> 18 & 31) / 32);
  const data = 7 + 2 * n + 2 * words[6] + Math.ceil(blocks / 16) * groupWords;
  require(n >= 1 && n <= 16 && words[1] === attribute.count, "a vertex stream with the wrong number of vertices");
  require(
    data + 2 <= words.length && blocks * (n + 2) <= 32 * (words.length - data), "a vertex stream that is too short");
  const mapping = words[2] >>> 5 & 7;
  Object.assign(attribute, {words, mapping, components: mapping === 2 ? n + 1 : n, integers: n});
}

/** Checks the stream's header against its size; sets file.slots. Returns the largest possible number of copies. */
function checkConnectivity(file) {
  const w = file.stream, {kind} = file;
  if (kind === "lean") {
    require(
      w.length >= 8 && w[0] === 0x4e4c524c && w.length === 8 + 2 * w[3] + w[4] + 3 * w[5],
      "a lean stream of the wrong size");
    file.slots = 2 * w[3] + w[4] + w[5];
  } else if (kind === "lr") {
    require(
      w.length >= 10 && w[0] === 0x5443524c && w.length === 10 + 2 * w[3] + 6 * w[4] + w[5] + w[6] + 2 * w[7],
      "LR tables of the wrong size");
    file.slots = 2 * w[3] + w[4];
  } else {
    require(w.length >= 4 && w[0] === 0x3250524c, "not a packed stream");
    const table = 4 + Math.ceil(w[2] / 32), doubles = table + Math.max(Math.ceil(w[2] / 4096), 1) - 1;
    const more = w[1] >>> 31 ? w[doubles] : 0;
    require(
      doubles + (w[1] >>> 31 ? 2 + 2 * w[doubles + 1] : 0) <= w.length && more <= w[2],
      "a packed stream that is too short");
    file.slots = w[2] + more;
  }
  require(
    file.vertices === (kind === "packed" ? w[1] & 0x7fffffff : w[2]), "connectivity with the wrong number of vertices");
  require(!file.seams || (file.seams.length >= 8 && file.seams[0] === 0x3153524c), "not a seam section");
  return file.vertices + 3 * file.slots;
}
