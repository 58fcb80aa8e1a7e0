// The entry point without storage form: decodes lean and packed streams, seams and vertex streams.
import {makeDecoder} from "./decoder.js";

export {LacedRingError} from "./errors.js";
export const {ready, decodeMesh, validate, decodeTriangle} =
  makeDecoder(() => import("./wasm/vertices.js"), () => import("./wasm/vertices-simd.js"));
