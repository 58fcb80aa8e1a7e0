export {decodeMesh, decodeTriangle, LacedRingError, ready, validate} from "./lacedring.js";

export type{Attribute, Mesh, Options, Values} from "./lacedring.js";
