// Measures sizes, and makes plain glTF files to compare with.

const COMPONENTS = new Map([
  [Int8Array, 5120], [Uint8Array, 5121], [Int16Array, 5122], [Uint16Array, 5123], [Uint32Array, 5125],
  [Float32Array, 5126]
]);
const TYPES = [, "SCALAR", "VEC2", "VEC3", "VEC4"];

/** Numbers of bytes without compression and with gzip. */
export async function sizesOf(bytes) {
  const reader = new Blob([bytes]).stream().pipeThrough(new CompressionStream("gzip")).getReader();
  let gzip = 0;
  for (let part; !(part = await reader.read()).done;) gzip += part.value.length;
  return {bytes: bytes.length, gzip};
}

/**
 * Makes a plain GLB, the uncompressed form of primitives {indices, attributes: [{name, values, components,
 * normalized}]}. Stores an array that several primitives use once. Converts values of types that glTF lacks to floats.
 */
export function plainGlb(primitives) {
  const json = {
    asset: {version: "2.0"},
    scene: 0,
    scenes: [{nodes: [0]}],
    nodes: [{mesh: 0}],
    meshes: [{primitives: []}],
    buffers: [],
    bufferViews: [],
    accessors: []
  };
  const parts = [], known = new Map();
  let size = 0;
  const add = (values, components, normalized, bounds, target) => {
    if (known.has(values)) return known.get(values);
    const array = COMPONENTS.has(values.constructor) ? values : Float32Array.from(values);
    const count = array.length / components, row = components * array.BYTES_PER_ELEMENT;
    const stride = target === 34962 ? Math.ceil(row / 4) * 4 : row;
    let bytes = new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
    if (stride !== row) {
      const padded = new Uint8Array(count * stride);
      for (let i = 0; i < count; i++) padded.set(bytes.subarray(i * row, (i + 1) * row), i * stride);
      bytes = padded;
    }
    json.bufferViews.push(
      {buffer: 0, byteOffset: size, byteLength: bytes.length, target, ...(target === 34962 && {byteStride: stride})});
    json.accessors.push({
      bufferView: json.bufferViews.length - 1,
      componentType: COMPONENTS.get(array.constructor),
      count,
      type: TYPES[components],
      ...(normalized && {normalized}),
      ...bounds
    });
    const pad = -bytes.length & 3;
    parts.push(bytes, new Uint8Array(pad));
    size += bytes.length + pad;
    known.set(values, json.accessors.length - 1);
    return json.accessors.length - 1;
  };
  for (const {indices, attributes} of primitives) {
    const used = {};
    for (const {name, values, components, normalized} of attributes) {
      if (TYPES[components])
        used[name] = add(values, components, normalized, name === "POSITION" ? boundsOf(values) : {}, 34962);
    }
    json.meshes[0].primitives.push({attributes: used, indices: add(indices, 1, false, {}, 34963)});
  }
  json.buffers.push({byteLength: size});
  const text = new TextEncoder().encode(JSON.stringify(json)), length = Math.ceil(text.length / 4) * 4;
  const out = new Uint8Array(28 + length + size),
        words = (...values) => new Uint8Array(Uint32Array.from(values).buffer);
  out.set(words(0x46546c67, 2, out.length, length, 0x4e4f534a));
  out.fill(32, 20, 20 + length).set(text, 20);
  out.set(words(size, 0x004e4942), 20 + length);
  let at = 28 + length;
  for (const part of parts) {
    out.set(part, at);
    at += part.length;
  }
  return out;
}

function boundsOf(values) {
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < values.length; i++) {
    min[i % 3] = Math.min(min[i % 3], values[i]);
    max[i % 3] = Math.max(max[i % 3], values[i]);
  }
  return {min, max};
}

/** Indices in the type that glTF writers use: 16 bits if possible. */
export function smallIndices(indices, vertexCount) {
  return vertexCount <= 65535 ? Uint16Array.from(indices) : indices;
}
