import type {Mesh, Options} from "../lacedring.js";

export const EXTENSION: "LACEDRING_mesh_compression";

export interface UnpackOptions {
  /** Default: decodeMesh of "lacedring". Use decodeMeshAsync to decode in a worker. */
  decodeMesh?: (bytes: Uint8Array, options: Options) => Mesh | Promise<Mesh>;
  limits?: Options["limits"];
}

/** Loads the bytes of a buffer that has a uri. */
export type LoadBuffer = (buffer: number, uri: string) => Promise<Uint8Array>;

/** Splits a .glb or .gltf file into the document and the binary chunk (.glb only). */
export function splitGltf(bytes: Uint8Array): {json: object; binaryChunk?: Uint8Array};

/**
 * Turns `json` into plain glTF, in place. `views`: bytes of buffer views, undefined for views that still use their
 * buffer.
 */
export function unpackGltf(json: object, binaryChunk?: Uint8Array, loadBuffer?: LoadBuffer, options?: UnpackOptions):
  Promise<{json: object; views: (Uint8Array | undefined)[]}>;

/** Converts a .glb or .gltf file to a plain GLB. */
export function unpackGlb(bytes: Uint8Array, loadBuffer?: LoadBuffer, options?: UnpackOptions): Promise<Uint8Array>;
