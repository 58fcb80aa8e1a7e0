/**
 * Resolves when the wasm is compiled; rejects with an Error if there is no WebAssembly. Await it before calling
 * decodeMesh, validate or decodeTriangle.
 */
export const ready: Promise<void>;

export type Values = Int8Array|Uint8Array|Int16Array|Uint16Array|Int32Array|Uint32Array|Float32Array|Float64Array;

export interface Attribute {
  /** As in glTF: POSITION, NORMAL, TEXCOORD_0 ... */
  name: string;
  /** Values per vertex. */
  components: number;
  type: "i8"|"u8"|"i16"|"u16"|"i32"|"u32"|"f32"|"f64";
  /** Integers represent 0 to 1, or -1 to 1 if signed. */
  normalized: boolean;
  /** vertexCount * components values, vertex by vertex. */
  values: Values;
  /** Texture coordinates with v = 0 at the image's lower edge (glTF: at the upper edge). */
  vUp: boolean;
}

export interface Mesh {
  vertexCount: number;
  triangleCount: number;
  /** Three vertices per triangle. */
  indices: Uint32Array;
  attributes: Attribute[];
  /**
   * Only if the file has seams: the mesh's vertices are then copies of a surface's vertices. `indices`: the same
   * triangles as vertices of the surface; `vertexOf`: the surface's vertex of each copy.
   */
  surface?: {vertexCount: number; indices: Uint32Array; vertexOf: Uint32Array};
  /** Only if the file keeps the order of its source: the number that each vertex had in the source. */
  vertexOrder?: Uint32Array;
  /**
   * Only if the file keeps the order: for each triangle 3 t + k, if its first corner was corner k of the source's
   * triangle t.
   */
  cornerOrder?: Uint32Array;
}

export interface Options {
  /** maxMemory: bytes that decoding may allocate. Default: the larger of 512 MiB and 128 times the file's size. */
  limits?: {maxMemory?: number};
}

/**
 * The error that decoders throw for invalid bytes. `code` is the kind of fault: CHECKSUM, SIZE, LIMIT, UNSUPPORTED ...
 */
export class LacedRingError extends Error {
  code: string;
  constructor(code: string, message: string);
}

/** Decodes the bytes of an .lr file, resident or in storage form. The caller owns the arrays. Throws LacedRingError. */
export function decodeMesh(bytes: Uint8Array, options?: Options): Mesh;

/** Makes the checks of decodeMesh, but no arrays. Throws LacedRingError. */
export function validate(bytes: Uint8Array, options?: Options): void;

/**
 * Decodes the three vertices of slot `t` of a lean or packed stream, without decoding the others. The first call for an
 * array checks and copies the whole stream; the copy lives as long as the array, and later changes to the array are
 * ignored. Throws LacedRingError, or a RangeError if there is no such slot.
 */
export function decodeTriangle(stream: Uint8Array, t: number): [number, number, number];

/** Runs decodeMesh in a worker; only in the entry point "lacedring". `bytes` are copied and stay usable. */
export function decodeMeshAsync(bytes: Uint8Array, options?: Options): Promise<Mesh>;
