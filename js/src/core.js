// The smallest entry point: decodes lean and packed streams, but no vertex streams, seams or files in storage form.
import {makeDecoder} from "./decoder.js";

export {LacedRingError} from "./errors.js";
export const {ready, decodeMesh, validate, decodeTriangle} =
  makeDecoder(() => import("./wasm/core.js"), () => import("./wasm/core-simd.js"));
