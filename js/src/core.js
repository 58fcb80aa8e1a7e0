// The package without vertex streams, seams and storage form: lean and packed streams.
import { makeDecoder } from "./decoder.js";

export { LacedRingError } from "./errors.js";
export const { ready, decodeMesh, validate, decodeTriangle } = makeDecoder(() => import("./wasm/core.js"), () => import("./wasm/core-simd.js"));
