// A wasm module with its memory: addresses are handed out one behind the other and taken back all at once.
import { LacedRingError, errorOf } from "./errors.js";

const PAGE = 65536;
/** Memory that is kept for the next file, in bytes: an engine that grew beyond is left to the garbage collector. */
const KEPT = 64 * 1024 * 1024;

/** A module with one function, which has an i8x16 constant: valid where there is SIMD. */
const SIMD_PROBE = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10,
  1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

/**
 * Compiles one of two variants of a module. Each loader imports a script whose default export is the wasm in base64; only
 * the script that is needed is loaded.
 */
export async function compile(loadScalar, loadSimd) {
  if (typeof WebAssembly !== "object") throw new LacedRingError("UNSUPPORTED", "lacedring: there is no WebAssembly here");
  const { default: text } = await (WebAssembly.validate(SIMD_PROBE) ? loadSimd() : loadScalar());
  return WebAssembly.compile(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
}

export class Engine {
  #exports;
  #heap;  // first byte that is not the module's
  #top;
  #most = Infinity;  // bytes that may be handed out

  constructor(module) {
    this.#exports = new WebAssembly.Instance(module, {}).exports;
    this.#heap = this.#top = Math.ceil(this.#exports.__heap_base.value / 16) * 16;
  }

  has(name) {
    return name in this.#exports;
  }

  /** The memory; not to be held while memory is taken, which may move it. */
  get buffer() {
    return this.#exports.memory.buffer;
  }

  /** Begins a file, which may take so many bytes of memory. */
  begin(most) {
    this.#top = this.#heap;
    this.#most = this.#heap + most;
  }

  /** Is memory larger than what is kept? */
  get isLarge() {
    return this.buffer.byteLength > KEPT;
  }

  /** Bytes in use, for release. */
  get mark() {
    return this.#top;
  }

  release(mark) {
    this.#top = mark;
  }

  /** The address of so many bytes, a multiple of 16. Throws LIMIT. */
  take(bytes) {
    const address = this.#top, end = address + Math.ceil(bytes / 16) * 16;
    if (!(end <= this.#most))
      throw new LacedRingError("LIMIT", `lr file: it would take more than ${Math.floor((this.#most - this.#heap) / 2 ** 20)} MiB of memory`);
    const missing = end - this.buffer.byteLength;
    if (missing > 0) {
      try {
        this.#exports.memory.grow(Math.ceil(missing / PAGE));
      } catch {
        throw new LacedRingError("LIMIT", `lr file: there is no memory for ${end} bytes`);
      }
    }
    this.#top = end;
    return address;
  }

  /** The address of a copy of bytes. */
  put(bytes) {
    const address = this.take(bytes.length);
    new Uint8Array(this.buffer, address, bytes.length).set(bytes);
    return address;
  }

  /** A typed array of its own of `count` numbers at an address. */
  array(Type, address, count) {
    return new Type(new Type(this.buffer, address, count));
  }

  /** A view of `count` words; not to be held while memory is taken. */
  words(address, count) {
    return new Uint32Array(this.buffer, address, count);
  }

  /** Calls a function and returns what it returns. A trap, which no input should make, is an error like others. */
  run(name, ...values) {
    try {
      return this.#exports[name](...values) >>> 0;
    } catch (error) {
      throw new LacedRingError("TRAP", `lr file: ${name}: ${error.message}`);
    }
  }

  /** Calls a function that returns a status, and returns the words of its result. `what` names the part of the file. */
  call(what, name, ...values) {
    const status = this.run(name, ...values);
    const result = this.words(this.run("lr_result"), 10);
    if (status !== 0) throw errorOf(status, what, result[8] + result[9] * 2 ** 32);
    return result.slice();
  }
}
