// Converts glTF files with LACEDRING_mesh_compression to plain glTF, for any loader.
export {EXTENSION} from "./document.js";
export {splitGltf, unpackGlb} from "./glb.js";
export {unpackGltf} from "./unpack.js";
