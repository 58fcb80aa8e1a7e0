import {BufferAttribute, BufferGeometry, FileLoader, Loader} from "three";

import {decodeMesh, ready} from "../lacedring.js";

/** Attribute names of three; other names stay, in lower case. */
const NAMES = {
  TEXCOORD_0: "uv",
  COLOR_0: "color",
  JOINTS_0: "skinIndex",
  WEIGHTS_0: "skinWeight"
};
const nameOf = (name) => NAMES[name] ?? name.toLowerCase().replace(/^texcoord_(\d+)$/, "uv$1");

/** Flips v of texture coordinates: in three's own geometries, v = 0 is the lower edge of the image. */
function turnUp(values, components, normalized) {
  const one = values instanceof Float32Array ? 1 : normalized ? 2 ** (8 * values.BYTES_PER_ELEMENT) - 1 : undefined;
  if (one === undefined) return values;
  return values.map((value, i) => (i % components === 1 ? one - value : value));
}

/** Makes a geometry of decodeMesh's result, with bounding box and sphere. Converts 64-bit floats to 32 bits. */
export function geometryOf({indices, attributes, vertexCount}) {
  const geometry = new BufferGeometry();
  for (const {name, components, type, normalized, values, vUp} of attributes) {
    const held = type === "f64" ? Float32Array.from(values) : values;
    const array = name.startsWith("TEXCOORD") && components === 2 && !vUp ? turnUp(held, components, normalized) : held;
    geometry.setAttribute(nameOf(name), new BufferAttribute(array, components, normalized));
  }
  const isSmall = vertexCount < 65536;  // index 65535 (primitive restart) does not occur
  geometry.setIndex(new BufferAttribute(isSmall ? Uint16Array.from(indices) : indices, 1));
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
}

/** Loads .lr files: `await new LacedRingLoader().loadAsync(url)` is a BufferGeometry. */
export class LacedRingLoader extends Loader {
  load(url, onLoad, onProgress, onError = console.error) {
    const loader = new FileLoader(this.manager)
                     .setPath(this.path)
                     .setResponseType("arraybuffer")
                     .setRequestHeader(this.requestHeader)
                     .setWithCredentials(this.withCredentials);
    const fail = (error) => {
      onError(error);
      this.manager.itemError(url);
    };
    loader.load(url, (buffer) => this.parse(new Uint8Array(buffer)).then(onLoad).catch(fail), onProgress, onError);
  }

  /** @returns {Promise<BufferGeometry>} Rejects with an Error of one line if the bytes are invalid. */
  async parse(bytes) {
    await ready;
    return geometryOf(decodeMesh(bytes));
  }
}
