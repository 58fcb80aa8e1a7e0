// Reads and writes plain GLB files; shares no code with the package.

const pad = (size) => Math.ceil(size / 4) * 4;
const SIZES = {
  5120: 1,
  5121: 1,
  5122: 2,
  5123: 2,
  5125: 4,
  5126: 4
};
const SHAPES = {
  SCALAR: 1,
  VEC2: 2,
  VEC3: 3,
  VEC4: 4,
  MAT2: 4,
  MAT3: 9,
  MAT4: 16
};

/** A GLB of a document without buffers and the contents of its buffer views. */
export function makeGlb(json, views) {
  let size = 0;
  json.bufferViews = views.map(({length}) => {
    const view = {buffer: 0, byteOffset: size, byteLength: length};
    size = pad(size + length);
    return view;
  });
  json.buffers = [{byteLength: size}];
  return joinGlb(json, Buffer.concat(views.flatMap((view) => [view, Buffer.alloc(-view.length & 3)])));
}

export function joinGlb(json, binary) {
  const text = Buffer.from(JSON.stringify(json)), length = pad(text.length), rest = pad(binary.length);
  const words = (...values) => Buffer.from(Uint32Array.from(values).buffer);
  const head = words(0x46546c67, 2, 28 + length + rest, length, 0x4e4f534a);
  return new Uint8Array(Buffer.concat([
    head, text, Buffer.alloc(length - text.length, " "), words(rest, 0x004e4942), binary,
    Buffer.alloc(rest - binary.length)
  ]));
}

export function splitGlb(bytes) {
  const data = Buffer.from(bytes.buffer, bytes.byteOffset, bytes.length), end = 20 + data.readUInt32LE(12);
  return {json: JSON.parse(data.subarray(20, end)), binary: bytes.subarray(end + 8)};
}

/** The document of a GLB, and the contents of its buffer views. */
export function readScene(bytes) {
  const {json, binary} = splitGlb(bytes);
  const view = (i) => {
    const {byteOffset = 0, byteLength} = json.bufferViews[i];
    return binary.subarray(byteOffset, byteOffset + byteLength);
  };
  return {json, view};
}

/** The tightly packed values of an accessor, without its sparse values. */
export function accessorBytes({json, view}, i) {
  const {bufferView, byteOffset = 0, componentType, type, count} = json.accessors[i];
  const size = SIZES[componentType] * SHAPES[type], out = new Uint8Array(count * size);
  if (bufferView === undefined) return out;
  const bytes = view(bufferView), stride = json.bufferViews[bufferView].byteStride ?? size;
  for (let row = 0, at = byteOffset; row < count; row++, at += stride)
    out.set(bytes.subarray(at, at + size), row * size);
  return out;
}
