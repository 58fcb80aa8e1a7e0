import type {Values} from "./lacedring.js";

export {LacedRingError} from "./lacedring.js";

/** Resolves when the wasm is compiled; rejects with an Error if there is no WebAssembly. Await it before encodeMesh. */
export const ready: Promise<void>;

export interface SourceAttribute {
  /** As in glTF: TANGENT, TEXCOORD_1, JOINTS_0 ... */
  name: string;
  /** Values per vertex. */
  components: number;
  values: Values;
  /** Integers represent 0 to 1, or -1 to 1 if signed. */
  normalized?: boolean;
  /** Texture coordinates with v = 0 at the image's lower edge (glTF: at the upper edge). */
  vUp?: boolean;
}

export interface Source {
  /** Three vertices per triangle; without indices, every three successive vertices are a triangle. */
  indices?: Uint8Array|Uint16Array|Uint32Array;
  /** Three per vertex, finite. */
  positions?: Float32Array|Float64Array;
  normals?: Float32Array;
  texcoords?: Float32Array;
  /** Three or four per vertex. */
  colors?: Float32Array;
  /** Further attributes. May hold POSITION if `positions` is absent. */
  attributes?: SourceAttribute[];
}

/** Bits to which floats are rounded; 0: lossless. Defaults: 14, 10, 12, 8 and 8. */
export interface EncodeOptions {
  /** POSITION: bits along the largest extent, 1 to 22. */
  positionBits?: number;
  /** NORMAL and TANGENT: bits of each of two octahedral integers, 2 to 16. */
  normalBits?: number;
  texcoordBits?: number;
  colorBits?: number;
  weightBits?: number;
  /** Rounds nothing: overrides all bits above. */
  lossless?: boolean;
  /** Writes streams that can be read in place, for example by a GPU. Default: the storage form, which is smaller. */
  resident?: boolean;
  /** Stores the original order of vertices and triangles: 4 bytes for each. */
  keepOrder?: boolean;
  /** Effort of the search for good rings, 0 to 9 (default 6): larger takes longer and gives smaller files. */
  effort?: number;
}

/** Returns the bytes of an .lr file, the same as `lacedring encode` writes. Throws LacedRingError. */
export function encodeMesh(mesh: Source, options?: EncodeOptions): Uint8Array;
