import type { BufferGeometry, Loader } from "three";
import type { GLTFLoaderPlugin, GLTFParser } from "three/addons/loaders/GLTFLoader.js";
import type { UnpackOptions } from "../gltf/lacedring-gltf.js";
import type { Mesh } from "../lacedring.js";

/** `loader.register((parser) => new LacedRingExtension(parser))`: GLTFLoader reads LACEDRING_mesh_compression. */
export class LacedRingExtension implements GLTFLoaderPlugin {
  constructor(parser: GLTFParser, options?: UnpackOptions);
  readonly name: "LACEDRING_mesh_compression";
  beforeRoot(): Promise<void> | null;
  loadBufferView(index: number): Promise<ArrayBuffer> | null;
}

/** Loads .lr files. Rejects with an Error in one line if a file is damaged. */
export class LacedRingLoader extends Loader<BufferGeometry> {
  parse(bytes: Uint8Array): Promise<BufferGeometry>;
}

/** The geometry of a decoded mesh: three's names of attributes, v of texture coordinates upwards, with bounds. */
export function geometryOf(mesh: Mesh): BufferGeometry;
