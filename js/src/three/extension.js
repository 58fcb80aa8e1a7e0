import {EXTENSION} from "../gltf/document.js";
import {unpackGltf} from "../gltf/unpack.js";

// GLTFLoader creates its handlers of these extensions from the outer document, before the inner document can be read.
const HANDLERS = ["KHR_materials_unlit", "KHR_texture_transform", "KHR_mesh_quantization"];

/**
 * Lets three's GLTFLoader read glTF files with LACEDRING_mesh_compression:
 *
 *     loader.register((parser) => new LacedRingExtension(parser));
 *
 * Decodes streams, coded buffer views and a packed document before the loader reads any node. Does not use fallbacks.
 */
export class LacedRingExtension {
  name = EXTENSION;
  #parser;
  #options;
  #views = [];

  /**
   * @param {object} parser of GLTFLoader
   * @param {object} [options] of unpackGltf: decodeMesh, limits
   */
  constructor(parser, options) {
    this.#parser = parser;
    this.#options = options;
    const {json} = parser;
    if (this.#isDocumentPacked() && Array.isArray(json.extensionsUsed))
      json.extensionsUsed = [...json.extensionsUsed, ...HANDLERS];
  }

  #isDocumentPacked() {
    return this.#parser.json.extensions?.[EXTENSION]?.document !== undefined;
  }

  beforeRoot() {
    const {extensionsUsed} = this.#parser.json;
    return Array.isArray(extensionsUsed) && extensionsUsed.includes(EXTENSION) ? this.#unpack() : null;
  }

  async #unpack() {
    const parser = this.#parser, {json} = parser, isPacked = this.#isDocumentPacked();
    const binary = parser.extensions.KHR_binary_glTF?.body;
    const load = async (buffer) => new Uint8Array(await parser.getDependency("buffer", buffer));
    this.#views = (await unpackGltf(json, binary && new Uint8Array(binary), load, this.#options)).views;
    if (!isPacked) return;
    for (const name of [json.extensionsRequired ?? []].flat()) {
      if (!parser.extensions[name]) console.warn(`THREE.GLTFLoader: Unknown extension "${name}".`);
    }
    parser._invokeAll((plugin) => plugin._markDefs?.());  // again, as the outer document had no nodes to mark
  }

  loadBufferView(index) {
    const bytes = this.#views[index];
    if (!bytes) return null;
    const {buffer, byteOffset, byteLength} = bytes;
    return Promise.resolve(
      byteLength === buffer.byteLength ? buffer : buffer.slice(byteOffset, byteOffset + byteLength));
  }
}
