// From the bytes of a file to a model and figures.
import { DoubleSide, Group, Mesh, MeshStandardMaterial } from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
import { decodeMesh, ready } from "lacedring";
import { EXTENSION, splitGltf, unpackGlb } from "lacedring/gltf/lacedring-gltf.js";
import { LacedRingExtension, geometryOf } from "lacedring/three/lacedring-three.js";
import { geometryLike, plainOf, sourceOf } from "./arrays.js";
import { encode } from "./encoder.js";
import { plainGlb, sizesOf, smallIndices } from "./sizes.js";

const LARGE = 200000;  // triangles for which good rings are looked for less long

/** "glb", "packed" (glTF of ours), "gltf" or "lr". Throws an Error of one line for anything else. */
function kindOf(bytes) {
  const text = String.fromCharCode(...bytes.subarray(0, 4));
  const isGlb = text === "glTF", isJson = /^(\uFEFF|ï»¿)?\s*\{/.test(text);
  if (text === "LRFL") return "lr";
  if (!isGlb && !isJson) throw new Error("it is no .lr, .glb or .gltf file");
  const { json } = splitGltf(bytes);
  if (json.extensionsUsed?.includes?.(EXTENSION)) return "packed";
  if (json.buffers?.some?.(({ uri }) => uri && !uri.startsWith("data:"))) throw new Error("its data lie in other files: drop a .glb, or a .gltf with its data inside");
  const other = json.extensionsRequired?.find?.((name) => /meshopt|draco/i.test(name));
  if (other) throw new Error(`${other}: another program has compressed it; drop the plain file`);
  return isGlb ? "glb" : "gltf";
}

/** The first call of a function beside how long it takes: the median of up to five calls in a quarter of a second. */
function timed(call) {
  const times = [], begin = performance.now();
  let result;
  do {
    const start = performance.now(), made = call();
    times.push(performance.now() - start);
    result ??= made;
  } while (times.length < 5 && performance.now() - begin < 250);
  return { result, ms: times.sort((a, b) => a - b)[times.length >> 1] };
}

function plainMaterial(geometry) {
  const hasColors = geometry.attributes.color !== undefined;
  const material = new MeshStandardMaterial({ roughness: 0.75, metalness: 0, side: DoubleSide, vertexColors: hasColors });
  material.userData.isPlain = !hasColors;
  return material;
}

async function openLr(bytes) {
  const { result: mesh, ms } = timed(() => decodeMesh(bytes));
  const plain = plainGlb([{ indices: smallIndices(mesh.indices, mesh.vertexCount), attributes: mesh.attributes }]);
  const geometry = geometryOf(mesh);
  if (!geometry.attributes.normal) geometry.computeVertexNormals();
  const object = new Group().add(new Mesh(geometry, plainMaterial(geometry)));
  return { object, animations: [], plain, ours: [bytes], ourName: ".lr file", decodeMs: ms };
}

/** three's scene of a glTF; decodeMesh is asked for streams. */
async function load(bytes, decode) {
  const loader = new GLTFLoader().register((parser) => new LacedRingExtension(parser, { decodeMesh: decode }));
  const buffer = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);
  const { scene, scenes, animations } = await loader.parseAsync(buffer, "");
  const object = scene ?? scenes[0];
  if (!object) throw new Error("there are no triangles in it");
  object.traverse(({ geometry, isMesh }) => {
    if (isMesh && !geometry.index) geometry.setIndex(Array.from({ length: geometry.attributes.position.count }, (_, i) => i));
  });
  return { object, animations };
}

/** Bytes of the images in a plain GLB. */
function imageBytes(plain) {
  const { images = [], bufferViews } = splitGltf(plain).json;
  return images.reduce((sum, { bufferView }) => sum + (bufferViews?.[bufferView]?.byteLength ?? 0), 0);
}

async function openPacked(bytes) {
  let decodeMs = 0;
  const scene = await load(bytes, (stream, options) => {
    const { result, ms } = timed(() => decodeMesh(stream, options));
    decodeMs += ms;
    return result;
  });
  const plain = await unpackGlb(bytes);
  return { ...scene, plain, ours: [bytes], ourName: "packed glTF", decodeMs, images: imageBytes(plain) };
}

/** Encodes each geometry of a scene and puts what it decodes to in its place. `progress(done, of)` is called before each. */
async function openPlain(bytes, { isLossless, progress }) {
  const scene = await load(bytes);
  const users = new Map();  // geometry: the meshes that have it
  scene.object.traverse((mesh) => { if (mesh.isMesh) users.set(mesh.geometry, [...users.get(mesh.geometry) ?? [], mesh]); });
  if (users.size === 0) throw new Error("there are no triangles in it");
  const plain = plainGlb([...users.keys()].map(plainOf)), ours = [];
  let decodeMs = 0, encodeMs = 0;
  for (const [geometry, meshes] of users) {
    progress(ours.length, users.size);
    const source = sourceOf(geometry), effort = source.indices.length / 3 > LARGE ? 3 : 6;
    const made = await encode(source, { lossless: isLossless, weightBits: 0, effort });
    const { result, ms } = timed(() => decodeMesh(made.bytes));
    ours.push(made.bytes);
    decodeMs += ms;
    encodeMs += made.ms;
    const drawn = geometryLike(geometry, result);
    geometry.dispose();
    meshes.forEach((mesh) => { mesh.geometry = drawn; });
  }
  return { ...scene, plain, ours, ourName: users.size === 1 ? "as an .lr file" : `as ${users.size} .lr files`, decodeMs, encodeMs, whole: bytes.length };
}

/**
 * Opens a file. Resolves to {object, animations, triangles, vertices, plain, ours, ourName, decodeMs, encodeMs, whole, images}: `plain` and
 * `ours` are sizes {bytes, gzip}. Rejects with an Error of one line: the file is damaged, or is no mesh.
 */
export async function open(bytes, options) {
  await ready;
  const kind = kindOf(bytes);
  const opened = await (kind === "lr" ? openLr(bytes) : kind === "packed" ? openPacked(bytes) : openPlain(bytes, options));
  const geometries = new Set();
  opened.object.traverse(({ isMesh, geometry }) => { if (isMesh) geometries.add(geometry); });
  if (geometries.size === 0) throw new Error("there are no triangles in it");
  let triangles = 0, vertices = 0;
  for (const { index, attributes } of geometries) {
    triangles += index.count / 3;
    vertices += attributes.position.count;
  }
  const [plain, ...ours] = await Promise.all([opened.plain, ...opened.ours].map(sizesOf));
  const sum = (name) => ours.reduce((total, sizes) => total + sizes[name], 0);
  return { ...opened, kind, triangles, vertices, plain, ours: { bytes: sum("bytes"), gzip: sum("gzip") } };
}
