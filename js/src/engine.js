// A wasm instance and a stack allocator for its memory: allocates addresses in ascending order, frees them all at once.
import {errorOf, LacedRingError} from "./errors.js";

const PAGE = 65536;
/** An engine with more bytes of memory than this is not kept for the next file. */
const KEPT = 64 * 1024 * 1024;

/** A module with one function that uses an i8x16 constant: valid only if the machine has SIMD. */
const SIMD_PROBE = new Uint8Array(
  [0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11]);

/**
 * Compiles the variant of a module that the machine supports. Each loader imports a script whose default export is the
 * wasm in base64; only one of them is called.
 */
export async function compile(loadScalar, loadSimd) {
  if (typeof WebAssembly !== "object")
    throw new LacedRingError("UNSUPPORTED", "lacedring: there is no WebAssembly here");
  const {default: text} = await (WebAssembly.validate(SIMD_PROBE) ? loadSimd() : loadScalar());
  return WebAssembly.compile(Uint8Array.from(atob(text), (c) => c.charCodeAt(0)));
}

export class Engine {
  #exports;
  #heap;             // first byte after the module's own data
  #top;              // first free byte
  #most = Infinity;  // addresses must stay below this

  constructor(module) {
    this.#exports = new WebAssembly.Instance(module, {}).exports;
    this.#heap = this.#top = Math.ceil(this.#exports.__heap_base.value / 16) * 16;
  }

  has(name) {
    return name in this.#exports;
  }

  /** The memory's ArrayBuffer. Allocation may replace it, so do not keep it across take() or put(). */
  get buffer() {
    return this.#exports.memory.buffer;
  }

  /** Frees everything, for a file that may allocate at most `most` bytes. */
  begin(most) {
    this.#top = this.#heap;
    this.#most = this.#heap + most;
  }

  /** True if the engine has too much memory to be kept for the next file. */
  get isLarge() {
    return this.buffer.byteLength > KEPT;
  }

  /** The current allocation state; release(mark) returns to it. */
  get mark() {
    return this.#top;
  }

  release(mark) {
    this.#top = mark;
  }

  /** Allocates bytes; returns their address, a multiple of 16. Throws LIMIT. */
  take(bytes) {
    const address = this.#top, end = address + Math.ceil(bytes / 16) * 16;
    if (!(end <= this.#most))
      throw new LacedRingError(
        "LIMIT", `lr file: it would take more than ${Math.floor((this.#most - this.#heap) / 2 ** 20)} MiB of memory`);
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

  /** Copies bytes into the memory; returns their address. Throws LIMIT. */
  put(bytes) {
    const address = this.take(bytes.length);
    new Uint8Array(this.buffer, address, bytes.length).set(bytes);
    return address;
  }

  /** Returns a copy of `count` numbers at an address. */
  array(Type, address, count) {
    return new Type(new Type(this.buffer, address, count));
  }

  /** A view of `count` words. Do not keep it across take() or put(). */
  words(address, count) {
    return new Uint32Array(this.buffer, address, count);
  }

  /** Calls a wasm function; returns its result. Throws TRAP if it traps, which no input should cause. */
  run(name, ...values) {
    try {
      return this.#exports[name](...values) >>> 0;
    } catch (error) {
      throw new LacedRingError("TRAP", `lr file: ${name}: ${error.message}`);
    }
  }

  /**
   * Calls a wasm function that returns a status; returns the words of its result. `what`: part of the file, for
   * errors.
   */
  call(what, name, ...values) {
    const status = this.run(name, ...values);
    const result = this.words(this.run("lr_result"), 10);
    if (status !== 0) throw errorOf(status, what, result[8] + result[9] * 2 ** 32);
    return result.slice();
  }
}
