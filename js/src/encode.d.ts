import type { Values } from "./lacedring.js";

export { LacedRingError } from "./lacedring.js";

/** The wasm is compiled; rejects with an Error where there is no WebAssembly. encodeMesh waits for it. */
export const ready: Promise<void>;

export interface SourceAttribute {
  /** As in glTF: TANGENT, TEXCOORD_1, JOINTS_0 ... */
  name: string;
  /** Values a vertex, one behind the other. */
  components: number;
  values: Values;
  /** Integers that stand for 0 to 1, or -1 to 1. */
  normalized?: boolean;
  /** Texture coordinates whose v is 0 at the image's lower edge. */
  vUp?: boolean;
}

export interface Source {
  /** Three vertices a triangle; without them, vertices are triangles as they come. */
  indices?: Uint8Array | Uint16Array | Uint32Array;
  /** Three a vertex, finite. */
  positions?: Float32Array | Float64Array;
  normals?: Float32Array;
  texcoords?: Float32Array;
  /** Three or four a vertex. */
  colors?: Float32Array;
  /** Others, or POSITION instead of positions. */
  attributes?: SourceAttribute[];
}

/** Bits to which floats are rounded, 0 for none: 14, 10, 12, 8 and 8 unless told. */
export interface EncodeOptions {
  /** Of POSITION, along the largest extent, 1 to 22. */
  positionBits?: number;
  /** Of NORMAL and TANGENT, of each of two octahedral integers, 2 to 16. */
  normalBits?: number;
  texcoordBits?: number;
  colorBits?: number;
  weightBits?: number;
  /** Rounds nothing. */
  lossless?: boolean;
  /** Streams that are read in place, by a GPU above all; else the storage form, which is smaller. */
  resident?: boolean;
  /** Keeps the way back to the order of vertices and triangles: 4 bytes for each. */
  keepOrder?: boolean;
  /** How long to look for good rings, 0 to 9; 6 unless told. */
  effort?: number;
}

/** The bytes of an .lr file, as `lacedring encode` writes it. Throws LacedRingError. */
export function encodeMesh(mesh: Source, options?: EncodeOptions): Uint8Array;
