// Reads the first primitive of a plain GLB.
import {readFileSync} from "node:fs";

const TYPES = {
  5120: Int8Array,
  5121: Uint8Array,
  5122: Int16Array,
  5123: Uint16Array,
  5125: Uint32Array,
  5126: Float32Array
};
const COMPONENTS = {
  SCALAR: 1,
  VEC2: 2,
  VEC3: 3,
  VEC4: 4
};

/** { indices, attributes: { NAME: { values, components, normalized } } }, values tightly packed. */
export function readGlb(file) {
  const data = readFileSync(file), length = data.readUInt32LE(12),
        json = JSON.parse(data.toString("utf8", 20, 20 + length)), begin = 28 + length;
  const read = (index) => {
    const {bufferView, byteOffset = 0, componentType, type, count, normalized = false} = json.accessors[index];
    const view = json.bufferViews[bufferView], Type = TYPES[componentType], components = COMPONENTS[type],
          size = components * Type.BYTES_PER_ELEMENT;
    const stride = view.byteStride ?? size, bytes = new Uint8Array(count * size);
    for (let i = 0; i < count; ++i) {
      const at = begin + (view.byteOffset ?? 0) + byteOffset + i * stride;
      bytes.set(data.subarray(at, at + size), i * size);
    }
    return {values: new Type(bytes.buffer), components, normalized};
  };
  const [{attributes, indices}] = json.meshes[0].primitives;
  return {
    indices: read(indices).values,
    attributes: Object.fromEntries(Object.entries(attributes).map(([name, index]) => [name, read(index)]))
  };
}
