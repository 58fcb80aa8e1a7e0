/** The wasm is compiled; rejects with an Error where there is no WebAssembly. Everything below waits for it. */
export const ready: Promise<void>;

export type Values = Int8Array | Uint8Array | Int16Array | Uint16Array | Int32Array | Uint32Array | Float32Array | Float64Array;

export interface Attribute {
  /** As in glTF: POSITION, NORMAL, TEXCOORD_0 ... */
  name: string;
  /** Values a vertex, one behind the other. */
  components: number;
  type: "i8" | "u8" | "i16" | "u16" | "i32" | "u32" | "f32" | "f64";
  /** Integers that stand for 0 to 1, or -1 to 1. */
  normalized: boolean;
  /** vertexCount * components. */
  values: Values;
  /** Texture coordinates whose v is 0 at the image's lower edge; glTF's is 0 at the upper one. */
  vUp: boolean;
}

export interface Mesh {
  vertexCount: number;
  triangleCount: number;
  /** Three vertices a triangle. */
  indices: Uint32Array;
  attributes: Attribute[];
  /** Where the file has seams: vertices above are copies, and these are the triangles of the surface's vertices. vertexOf: the vertex of each copy. */
  surface?: { vertexCount: number; indices: Uint32Array; vertexOf: Uint32Array };
  /** Where the file keeps the order of its source: the number that each vertex had. */
  vertexOrder?: Uint32Array;
  /** Likewise: 3 t + k where a triangle was the source's triangle t, and its first corner is corner k of that. */
  cornerOrder?: Uint32Array;
}

export interface Options {
  /** maxMemory: bytes that decoding may take; unless given the larger of 512 MiB and 128 times the file. */
  limits?: { maxMemory?: number };
}

/** What decoders throw, whatever the bytes are. `code` is the kind of fault: CHECKSUM, SIZE, LIMIT, UNSUPPORTED ... */
export class LacedRingError extends Error {
  code: string;
  constructor(code: string, message: string);
}

/** Decodes the bytes of an .lr file, resident or in storage form. The arrays are the caller's. Throws LacedRingError. */
export function decodeMesh(bytes: Uint8Array, options?: Options): Mesh;

/** Checks all that decodeMesh does, and makes no arrays. Throws LacedRingError. */
export function validate(bytes: Uint8Array, options?: Options): void;

/**
 * Three vertices of slot `t` of a lean or packed stream, without decoding the others. The first call for an array checks the
 * whole stream and keeps a copy, as long as the array lives: later changes to it are not seen. Throws LacedRingError, or a
 * RangeError where there is no such slot.
 */
export function decodeTriangle(stream: Uint8Array, t: number): [number, number, number];

/** As decodeMesh, in a worker (of "lacedring" alone). The bytes stay the caller's. */
export function decodeMeshAsync(bytes: Uint8Array, options?: Options): Promise<Mesh>;
