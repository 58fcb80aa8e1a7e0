export { LacedRingError, decodeMesh, decodeTriangle, ready, validate } from "./lacedring.js";
export type { Attribute, Mesh, Options, Values } from "./lacedring.js";
