// Makes the decoding functions of an entry point from its wasm module.
import {compile, Engine} from "./engine.js";
import {LacedRingError} from "./errors.js";
import {readMesh} from "./mesh.js";

/** Makes the functions. Each loader imports one variant of the wasm module, without or with SIMD. */
export function makeDecoder(loadScalar, loadSimd) {
  let module, engine;
  const ready = compile(loadScalar, loadSimd).then((compiled) => void (module = compiled));
  ready.catch(() => {});  // callers that await `ready` get the error; avoids an unhandled rejection

  function newEngine() {
    if (!module) throw new LacedRingError("NOT_READY", "lacedring: wait for `ready` first");
    return new Engine(module);
  }

  function read(bytes, {limits} = {}, isCheck) {
    const using = engine ?? newEngine();
    engine = undefined;  // not reused after a trap
    try {
      const mesh = readMesh(using, bytes, limits, isCheck);
      if (!using.isLarge) engine = using;
      return mesh;
    } catch (error) {
      if (error.code !== "TRAP" && !using.isLarge) engine = using;
      throw error;
    }
  }

  const streams = new WeakMap();

  /** Makes an engine with a checked lean or packed stream. */
  function open(stream) {
    const opened = newEngine();
    if (!(stream instanceof Uint8Array) || stream.length % 4 !== 0)
      throw new LacedRingError("SIZE", "stream: no whole number of words");
    opened.begin(Infinity);
    const address = opened.put(stream), crc = opened.run("lr_crc", address, stream.length, 0);
    const [, triangles, slots] = opened.call("stream", "lr_connectivity_open", address, stream.length / 4, crc);
    const mark = opened.mark;
    opened.call("stream", "lr_connectivity_decode", opened.take(12 * triangles));
    opened.release(mark);
    return {opened, slots};
  }

  return {
    ready,
    decodeMesh: (bytes, options) => read(bytes, options, false),
    validate: (bytes, options) => void read(bytes, options, true),
    decodeTriangle(stream, t) {
      if (!streams.has(stream)) streams.set(stream, open(stream));
      const {opened, slots} = streams.get(stream);
      if (!(t >= 0 && t < slots)) throw new RangeError(`lacedring: there is no triangle ${t}`);
      opened.run("lr_triangle", t);
      return [...opened.words(opened.run("lr_result"), 3)];
    },
  };
}
