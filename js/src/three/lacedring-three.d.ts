import type {BufferGeometry, Loader} from "three";
import type {GLTFLoaderPlugin, GLTFParser} from "three/addons/loaders/GLTFLoader.js";
import type {UnpackOptions} from "../gltf/lacedring-gltf.js";
import type {Mesh} from "../lacedring.js";

/** Lets GLTFLoader read LACEDRING_mesh_compression: `loader.register((parser) => new LacedRingExtension(parser))`. */
export class LacedRingExtension implements GLTFLoaderPlugin {
  constructor(parser: GLTFParser, options?: UnpackOptions);
  readonly name: "LACEDRING_mesh_compression";
  beforeRoot(): Promise<void>|null;
  loadBufferView(index: number): Promise<ArrayBuffer>|null;
}

/** Loads .lr files. Rejects with an Error of one line if a file is damaged. */
export class LacedRingLoader extends Loader<BufferGeometry> {
  parse(bytes: Uint8Array): Promise<BufferGeometry>;
}

/** Makes a geometry of a decoded mesh, with three's attribute names, v = 0 at the lower edge of images, and bounds. */
export function geometryOf(mesh: Mesh): BufferGeometry;
