// Encodes arrays of a mesh to an .lr file. The wasm is the C++ library, far larger than the decoders.
import {compile} from "./engine.js";
import {LacedRingError} from "./errors.js";

export {LacedRingError};

// By ComponentType of the C++ library.
const ARRAYS = [Int8Array, Uint8Array, Int16Array, Uint16Array, Int32Array, Uint32Array, Float32Array, Float64Array];
const FLOATS = 6;     // the first type of floats
const NOT_FOUND = 8;  // EBADF: all WASI functions return it here

/** Default and largest numbers of bits for attributes of floats. The defaults are those of `lacedring pack`. */
const BITS = {
  positionBits: [14, 22],
  normalBits: [10, 16],
  texcoordBits: [12, 22],
  colorBits: [8, 22],
  weightBits: [8, 22]
};

let module;
const loader = () => import("./wasm/encode.js");

/** Resolves when the wasm is compiled; rejects with an Error. */
export const ready = compile(loader, loader).then((compiled) => void (module = compiled));
ready.catch(() => {});  // callers that await `ready` get the error; avoids an unhandled rejection

function wrong(message) {
  return new LacedRingError("ARGUMENT", `encodeMesh: ${message}`);
}

/** Makes a new instance; returns its exports. */
function instantiate() {
  if (!module) throw new LacedRingError("NOT_READY", "lacedring: wait for `ready` first");
  const outOfMemory = () => {
    throw new LacedRingError("LIMIT", "encodeMesh: the mesh does not fit into memory");
  };
  const imports = {lacedring: {outOfMemory}, wasi_snapshot_preview1: {}};
  for (const {module: from, name} of WebAssembly.Module.imports(module)) imports[from][name] ??= () => NOT_FOUND;
  const {exports} = new WebAssembly.Instance(module, imports);
  exports._initialize();
  return exports;
}

/** Copies a typed array to an address of the wasm memory. */
function write({memory}, address, {buffer, byteOffset, byteLength}) {
  new Uint8Array(memory.buffer, address >>> 0, byteLength).set(new Uint8Array(buffer, byteOffset, byteLength));
}

/** Collects and checks the attributes given by short names (normals, ...) and in `attributes`, POSITION first. */
function attributesOf({positions, normals, texcoords, colors, attributes = []}) {
  const count = positions?.length / 3;
  const short =
    [
      ["POSITION", positions, 3], ["NORMAL", normals, 3], ["TEXCOORD_0", texcoords, 2],
      ["COLOR_0", colors, colors?.length / count]
    ].filter(([, values]) => values)
      .map(([name, values, components]) => ({name, values, components}));
  const all = [...short, ...attributes];
  const first = all.findIndex(({name}) => name === "POSITION");
  if (first < 0) throw wrong("there are no positions");
  all.unshift(...all.splice(first, 1));
  const vertices = all[0].values?.length / 3;
  const seen = new Set();
  for (const attribute of all) {
    const {name, values, components} = attribute;
    const type = ARRAYS.findIndex((Type) => values instanceof Type);
    if (type < 0) throw wrong(`${name}: its values are no typed array`);
    if (!(Number.isInteger(components) && components >= 1 && components <= 255))
      throw wrong(`${name}: ${components} components`);
    if (!Number.isInteger(vertices) || values.length !== vertices * components)
      throw wrong(`${name}: ${values.length} values are not ${components} for each vertex`);
    if (seen.has(name)) throw wrong(`${name} occurs twice`);
    seen.add(name);
    attribute.type = type;
  }
  if (all[0].type < FLOATS || all[0].components !== 3) throw wrong("positions are three floats a vertex");
  return {vertices, all};
}

/** Indices as 32-bit numbers; if there are none, 0, 1, 2, ... */
function indicesOf(indices, vertices) {
  if (!indices) return Uint32Array.from({length: vertices}, (_, i) => i);
  if (![Uint8Array, Uint16Array, Uint32Array].some((Type) => indices instanceof Type))
    throw wrong("indices are no array of unsigned integers");
  return Uint32Array.from(indices);
}

function bitsOf(options) {
  return Object.entries(BITS).map(([name, [usual, most]]) => {
    const bits = options.lossless ? 0 : options[name] ?? usual;
    const least = name === "normalBits" ? 2 : 1;
    if (bits !== 0 && !(Number.isInteger(bits) && bits >= least && bits <= most))
      throw wrong(`${name}: ${least} to ${most}, or 0 for lossless`);
    return bits;
  });
}

/**
 * Encodes a mesh to the same bytes as `lacedring encode`; takes about 10 microseconds per triangle. Merges vertices
 * with the same position; seams keep attributes that differ at their corners. See encode.d.ts. Throws LacedRingError.
 */
export function encodeMesh(mesh, options = {}) {
  const {vertices, all} = attributesOf(mesh);
  const indices = indicesOf(mesh.indices, vertices);
  if (indices.length === 0 || indices.length % 3 !== 0) throw wrong(`${indices.length} indices are no triangles`);
  const bits = bitsOf(options), effort = options.effort ?? 6;
  if (!(Number.isInteger(effort) && effort >= 0 && effort <= 9)) throw wrong("effort: 0 to 9");
  const encoder = instantiate();
  try {
    write(encoder, encoder.indices(indices.length, vertices), indices);
    for (const {name, type, components, normalized = false, vUp = false, values} of all) {
      const text = new TextEncoder().encode(name);
      encoder.addAttribute(type, components, normalized, vUp, text.length);
      write(encoder, encoder.name(), text);
      write(encoder, encoder.values(), values);
    }
    const isGood = encoder.encode(...bits, effort, Boolean(options.keepOrder), Boolean(options.resident));
    const result = new Uint8Array(encoder.memory.buffer, encoder.result() >>> 0, encoder.resultBytes() >>> 0).slice();
    if (!isGood) throw wrong(new TextDecoder().decode(result));
    return result;
  } catch (error) {
    if (error instanceof LacedRingError) throw error;
    throw new LacedRingError("TRAP", `encodeMesh: ${error.message}`);
  }
}
