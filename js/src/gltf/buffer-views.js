import {extensionOf, listOf, numberBelow, refuse} from "./document.js";
import {decodeFloats} from "./floats.js";
import {inflate} from "./inflate.js";

/** The buffer views of a document, and the bytes of its buffers. */
export class BufferViews {
  #buffers;
  #binaryChunk;
  #loadBuffer;
  #loaded = [];

  /**
   * @param {object} json
   * @param {Uint8Array} [binaryChunk] of a GLB: the bytes of its first buffer
   * @param {(buffer: number) => Promise<Uint8Array>} [loadBuffer] the bytes of a buffer that has a uri
   */
  constructor(json, binaryChunk, loadBuffer) {
    this.list = listOf(json, "bufferViews");
    this.#buffers = listOf(json, "buffers");
    this.#binaryChunk = binaryChunk;
    this.#loadBuffer = loadBuffer;
    this.#checkPlaceholders();
  }

  /** Checks that placeholder buffers have no bytes, and that their views lie inside them. */
  #checkPlaceholders() {
    this.#buffers.forEach((buffer, i) => {
      const extension = extensionOf(buffer);
      if (!extension) return;
      if (extension.placeholder !== true || buffer.uri !== undefined || (i === 0 && this.#binaryChunk)) {
        refuse(`buffer ${i} is no placeholder, or one with bytes`);
      }
    });
    this.list.forEach(({buffer, byteOffset = 0, byteLength}, i) => {
      numberBelow(this.#buffers.length, buffer, `the buffer of buffer view ${i}`);
      numberBelow(2 ** 53, byteOffset, `byteOffset of buffer view ${i}`);
      numberBelow(2 ** 53, byteLength, `byteLength of buffer view ${i}`);
      if (this.#isPlaceholder(buffer) && !(byteOffset + byteLength <= this.#buffers[buffer].byteLength)) {
        refuse(`buffer view ${i} is not in the placeholder, buffer ${buffer}`);
      }
    });
  }

  #isPlaceholder(buffer) {
    return extensionOf(this.#buffers[buffer]) !== undefined;
  }

  isCoded(view) {
    return extensionOf(this.list[view]) !== undefined;
  }

  /** True if a view has no contents: it is not coded, and its buffer is a placeholder. */
  isHollow(view) {
    return !this.isCoded(view) && this.#isPlaceholder(this.list[view].buffer);
  }

  /** The bytes of a buffer, loaded once. */
  #open(buffer) {
    if (this.#isPlaceholder(buffer)) refuse(`buffer ${buffer} is a placeholder, and something is to be read from it`);
    if (buffer === 0 && this.#binaryChunk && this.#buffers[0].uri === undefined) return this.#binaryChunk;
    if (!this.#loadBuffer || this.#buffers[buffer].uri === undefined) refuse(`buffer ${buffer} has no bytes`);
    return this.#loaded[buffer] ??= this.#loadBuffer(buffer);
  }

  async #range({buffer, byteOffset = 0, byteLength}, what) {
    const bytes = await this.#open(numberBelow(this.#buffers.length, buffer, `the buffer of ${what}`));
    numberBelow(bytes.length + 1, byteOffset, `byteOffset of ${what}`);
    numberBelow(bytes.length - byteOffset + 1, byteLength, `byteLength of ${what}`);
    return bytes.subarray(byteOffset, byteOffset + byteLength);
  }

  /** The bytes of a view that is not coded, without copying them. */
  async stored(view) {
    numberBelow(this.list.length, view, "a buffer view");
    if (this.isCoded(view)) refuse(`buffer view ${view} is coded`);
    return this.#range(this.list[view], `buffer view ${view}`);
  }

  /** The decoded bytes of a coded view. */
  async decoded(view) {
    const extension = extensionOf(this.list[view]), size = this.list[view].byteLength;
    const bytes = await this.#range(extension, `the coding of buffer view ${view}`);
    const decode = {__proto__: null, deflate: inflate, floats: decodeFloats}[extension.coding];
    if (!decode) refuse(`buffer view ${view} has an unknown coding`);
    const out = await decode(bytes, size);
    if (out.length !== size) refuse(`buffer view ${view} has ${out.length} bytes decoded, not ${size}`);
    return out;
  }
}
