// For three.js: its GLTFLoader's plug-in, and a loader for .lr files.
export { LacedRingExtension } from "./extension.js";
export { LacedRingLoader, geometryOf } from "./loader.js";
