import {listOf, refuse} from "./document.js";
import {memoryLimit, unpackGltf} from "./unpack.js";

const GLB = 0x46546c67, JSON_CHUNK = 0x4e4f534a, BINARY_CHUNK = 0x004e4942;

/** Splits a GLB or .gltf file into the document and the binary chunk (GLB only). Throws an Error of one line. */
export function splitGltf(bytes) {
  const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const parse = (text) => {
    try {
      return listOf({list: [JSON.parse(new TextDecoder().decode(text))]}, "list")[0];
    } catch {
      return refuse("the document is not JSON");
    }
  };
  if (bytes.length < 4 || data.getUint32(0, true) !== GLB) return {json: parse(bytes)};
  if (bytes.length < 20 || data.getUint32(4, true) !== 2 || data.getUint32(8, true) > bytes.length)
    refuse("a damaged GLB");
  const chunk = (at, type) => {
    if (at + 8 > data.getUint32(8, true) || data.getUint32(at + 4, true) !== type) return undefined;
    const end = at + 8 + data.getUint32(at, true);
    return end > data.getUint32(8, true) ? refuse("a damaged GLB") : bytes.subarray(at + 8, end);
  };
  const text = chunk(12, JSON_CHUNK) ?? refuse("a GLB without a document");
  return {json: parse(text), binaryChunk: chunk(20 + text.length, BINARY_CHUNK)};
}

function writeGlb(json, binary) {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const padded = Math.ceil(text.length / 4) * 4, size = 20 + padded + (binary.length > 0 ? 8 + binary.length : 0);
  const out = new Uint8Array(size), data = new DataView(out.buffer);
  [GLB, 2, size, padded, JSON_CHUNK].forEach((word, i) => data.setUint32(4 * i, word, true));
  out.fill(32, 20, 20 + padded);
  out.set(text, 20);
  if (binary.length > 0) {
    data.setUint32(20 + padded, binary.length, true);
    data.setUint32(24 + padded, BINARY_CHUNK, true);
    out.set(binary, 28 + padded);
  }
  return out;
}

/**
 * Converts a glTF file with LACEDRING_mesh_compression to a plain GLB, for loaders without a plug-in for the extension.
 * @param {Uint8Array} bytes of a .glb or .gltf file
 * @param {(buffer: number, uri: string) => Promise<Uint8Array>} [loadBuffer] loads the bytes of a buffer that has a
 *   uri. Uris of images stay as they are.
 * @param {object} options as of unpackGltf
 * @returns {Promise<Uint8Array>} Rejects with an Error of one line. Untrusted input is safe.
 */
export async function unpackGlb(bytes, loadBuffer, options) {
  const source = splitGltf(bytes);
  const {json, views} = await unpackGltf(source.json, source.binaryChunk, loadBuffer, options);
  const loaded = [];
  const open = (buffer) => loaded[buffer] ??= buffer === 0 && source.binaryChunk ?
    source.binaryChunk :
    loadBuffer?.(buffer, json.buffers[buffer].uri) ?? refuse(`buffer ${buffer} has no bytes`);
  const most = Math.min(memoryLimit(options?.limits, bytes.length), 2 ** 32 - 2 ** 16);
  let size = 0;
  const pieces = [];
  for (const [i, view] of listOf(json, "bufferViews").entries()) {
    const {byteOffset = 0, byteLength} = view;
    const piece = views[i] ?? (await open(view.buffer)).subarray(byteOffset, byteOffset + byteLength);
    if (piece.length !== byteLength) refuse(`buffer view ${i} is not in its buffer`);
    Object.assign(view, {buffer: 0, byteOffset: size});
    pieces.push(piece);
    size = Math.ceil((size + byteLength) / 8) * 8;
    if (size > most) refuse(`the plain file has more than ${most} bytes`);
  }
  const binary = new Uint8Array(size);
  pieces.forEach((piece, i) => binary.set(piece, json.bufferViews[i].byteOffset));
  if (size > 0)
    json.buffers = [{byteLength: size}];
  else
    delete json.buffers;
  return writeGlb(json, binary);
}
