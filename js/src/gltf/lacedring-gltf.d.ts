import type { Mesh, Options } from "../lacedring.js";

export const EXTENSION: "LACEDRING_mesh_compression";

export interface UnpackOptions {
  /** decodeMesh of "lacedring" unless given; decodeMeshAsync decodes in a worker. */
  decodeMesh?: (bytes: Uint8Array, options: Options) => Mesh | Promise<Mesh>;
  limits?: Options["limits"];
}

/** The bytes of a buffer that has a uri. */
export type LoadBuffer = (buffer: number, uri: string) => Promise<Uint8Array>;

/** The document and the binary chunk of a .glb or .gltf file. */
export function splitGltf(bytes: Uint8Array): { json: object; binaryChunk?: Uint8Array };

/** Makes `json` a plain glTF. `views`: the bytes of its buffer views, undefined where they lie in the view's buffer. */
export function unpackGltf(json: object, binaryChunk?: Uint8Array, loadBuffer?: LoadBuffer, options?: UnpackOptions):
  Promise<{ json: object; views: (Uint8Array | undefined)[] }>;

/** A plain GLB of a .glb or .gltf file. */
export function unpackGlb(bytes: Uint8Array, loadBuffer?: LoadBuffer, options?: UnpackOptions): Promise<Uint8Array>;
