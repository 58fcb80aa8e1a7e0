// For three.js: a plug-in for GLTFLoader, and a loader for .lr files.
export {LacedRingExtension} from "./extension.js";
export {geometryOf, LacedRingLoader} from "./loader.js";
