// Opens a mesh file: makes a model for three, and measures sizes and times.
import {decodeMesh, ready} from "lacedring";
import {EXTENSION, splitGltf, unpackGlb} from "lacedring/gltf/lacedring-gltf.js";
import {geometryOf, LacedRingExtension} from "lacedring/three/lacedring-three.js";
import {DoubleSide, Group, Mesh, MeshStandardMaterial} from "three";
import {GLTFLoader} from "three/addons/loaders/GLTFLoader.js";

import {geometryLike, plainOf, sourceOf} from "./arrays.js";
import {encode} from "./encoder.js";
import {plainGlb, sizesOf, smallIndices} from "./sizes.js";

const LARGE = 200000;  // meshes with more triangles are encoded with less effort

/**
 * The kind of a file: "glb", "packed" (glTF with our extension), "gltf" or "lr". Throws an Error of one line for other
 * files.
 */
function kindOf(bytes) {
  const text = String.fromCharCode(...bytes.subarray(0, 4));
  const isGlb = text === "glTF", isJson = /^(\uFEFF|ï»¿)?\s*\{/.test(text);
  if (text === "LRFL") return "lr";
  if (!isGlb && !isJson) throw new Error("it is not an .lr, .glb or .gltf file");
  const {json} = splitGltf(bytes);
  if (json.extensionsUsed?.includes?.(EXTENSION)) return "packed";
  if (json.buffers?.some?.(({uri}) => uri && !uri.startsWith("data:")))
    throw new Error("its data are in other files: open a .glb, or a .gltf that contains its data");
  const other = json.extensionsRequired?.find?.((name) => /meshopt|draco/i.test(name));
  if (other) throw new Error(`it is compressed with ${other}: open the uncompressed file`);
  return isGlb ? "glb" : "gltf";
}

/** Calls a function up to five times within a quarter of a second. Returns the first result and the median time. */
function timed(call) {
  const times = [], begin = performance.now();
  let result;
  do {
    const start = performance.now(), made = call();
    times.push(performance.now() - start);
    result ??= made;
  } while (times.length < 5 && performance.now() - begin < 250);
  return {result, ms: times.sort((a, b) => a - b)[times.length >> 1]};
}

function plainMaterial(geometry) {
  const hasColors = geometry.attributes.color !== undefined;
  const material = new MeshStandardMaterial({roughness: 0.75, metalness: 0, side: DoubleSide, vertexColors: hasColors});
  material.userData.isPlain = !hasColors;
  return material;
}

async function openLr(bytes) {
  const {result: mesh, ms} = timed(() => decodeMesh(bytes));
  const plain = plainGlb([{indices: smallIndices(mesh.indices, mesh.vertexCount), attributes: mesh.attributes}]);
  const geometry = geometryOf(mesh);
  if (!geometry.attributes.normal) geometry.computeVertexNormals();
  const object = new Group().add(new Mesh(geometry, plainMaterial(geometry)));
  return {object, animations: [], plain, ours: [bytes], ourName: ".lr file", decodeMs: ms};
}

/** Loads a glTF as a scene of three; `decode` decodes its streams. */
async function load(bytes, decode) {
  const loader = new GLTFLoader().register((parser) => new LacedRingExtension(parser, {decodeMesh: decode}));
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const {scene, scenes, animations} = await loader.parseAsync(buffer, "");
  const object = scene ?? scenes[0];
  if (!object) throw new Error("it has no triangles");
  object.traverse(({geometry, isMesh}) => {
    if (isMesh && !geometry.index)
      geometry.setIndex(Array.from({length: geometry.attributes.position.count}, (_, i) => i));
  });
  return {object, animations};
}

/** Bytes of the images in a plain GLB. */
function imageBytes(plain) {
  const {images = [], bufferViews} = splitGltf(plain).json;
  return images.reduce((sum, {bufferView}) => sum + (bufferViews?.[bufferView]?.byteLength ?? 0), 0);
}

async function openPacked(bytes) {
  let decodeMs = 0;
  const scene = await load(bytes, (stream, options) => {
    const {result, ms} = timed(() => decodeMesh(stream, options));
    decodeMs += ms;
    return result;
  });
  const plain = await unpackGlb(bytes);
  return {...scene, plain, ours: [bytes], ourName: "packed glTF", decodeMs, images: imageBytes(plain)};
}

/** Encodes each geometry of a scene and replaces it by the decoded one. Calls `progress(done, of)` before each. */
async function openPlain(bytes, {isLossless, progress}) {
  const scene = await load(bytes);
  const users = new Map();  // geometry: the meshes that use it
  scene.object.traverse((mesh) => {
    if (mesh.isMesh) users.set(mesh.geometry, [...users.get(mesh.geometry) ?? [], mesh]);
  });
  if (users.size === 0) throw new Error("it has no triangles");
  const plain = plainGlb([...users.keys()].map(plainOf)), ours = [];
  let decodeMs = 0, encodeMs = 0;
  for (const [geometry, meshes] of users) {
    progress(ours.length, users.size);
    const source = sourceOf(geometry), effort = source.indices.length / 3 > LARGE ? 3 : 6;
    const made = await encode(source, {lossless: isLossless, weightBits: 0, effort});
    const {result, ms} = timed(() => decodeMesh(made.bytes));
    ours.push(made.bytes);
    decodeMs += ms;
    encodeMs += made.ms;
    const drawn = geometryLike(geometry, result);
    geometry.dispose();
    meshes.forEach((mesh) => {
      mesh.geometry = drawn;
    });
  }
  return {
    ...scene,
    plain,
    ours,
    ourName: users.size === 1 ? "as an .lr file" : `as ${users.size} .lr files`,
    decodeMs,
    encodeMs,
    whole: bytes.length
  };
}

/**
 * Opens a file. Resolves to {object, animations, kind, triangles, vertices, plain, ours, ourName, decodeMs, encodeMs,
 * whole, images}. `plain`, `ours`: sizes {bytes, gzip} of plain glTF and of our format; `whole`: bytes of the opened
 * plain file; `images`: bytes of its images. Rejects with an Error of one line if the file is damaged or not a mesh.
 */
export async function open(bytes, options) {
  await ready;
  const kind = kindOf(bytes);
  const opened = await (
    kind === "lr"       ? openLr(bytes) :
      kind === "packed" ? openPacked(bytes) :
                          openPlain(bytes, options));
  const geometries = new Set();
  opened.object.traverse(({isMesh, geometry}) => {
    if (isMesh) geometries.add(geometry);
  });
  if (geometries.size === 0) throw new Error("it has no triangles");
  let triangles = 0, vertices = 0;
  for (const {index, attributes} of geometries) {
    triangles += index.count / 3;
    vertices += attributes.position.count;
  }
  const [plain, ...ours] = await Promise.all([opened.plain, ...opened.ours].map(sizesOf));
  const sum = (name) => ours.reduce((total, sizes) => total + sizes[name], 0);
  return {...opened, kind, triangles, vertices, plain, ours: {bytes: sum("bytes"), gzip: sum("gzip")}};
}
