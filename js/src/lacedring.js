// The main entry point: decodes everything but LR tables.
import {makeDecoder} from "./decoder.js";

export {LacedRingError} from "./errors.js";
export {decodeMeshAsync} from "./pool.js";
export const {ready, decodeMesh, validate, decodeTriangle} =
  makeDecoder(() => import("./wasm/storage.js"), () => import("./wasm/storage-simd.js"));
