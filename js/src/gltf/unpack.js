import {decodeMesh as decodeAtOnce, ready} from "../lacedring.js";

import {BufferViews} from "./buffer-views.js";
import {extensionOf, listOf, numberBelow, objectOf, refuse, removeAllExtensions} from "./document.js";
import {inflate} from "./inflate.js";
import {decodePartCodes} from "./part-codes.js";
import {asComponents, asIndices, splitMesh, valuesOf} from "./stream-mesh.js";
import {readDocument} from "./streams.js";

const ARRAY_BUFFER = 34962, ELEMENT_ARRAY_BUFFER = 34963;
const OTHERS = ["EXT_meshopt_compression", "KHR_meshopt_compression", "KHR_draco_mesh_compression"];

async function decodeWhenReady(bytes, options) {
  await ready;
  return decodeAtOnce(bytes, options);
}

/** Bytes of memory that decoding may take. The default is that of lacedring's --max-memory. */
export function memoryLimit(limits, fileBytes) {
  return limits?.maxMemory ?? Math.max(2 ** 29, 128 * fileBytes);
}

/** Counts memory against a limit. */
class Budget {
  constructor(most) {
    this.left = this.most = most;
  }

  take(bytes) {
    this.left -= bytes;
    if (!(this.left >= 0))
      refuse(`decoding takes more than the ${Math.round(this.most / 2 ** 20)} MiB that are allowed`);
  }
}

/** Replaces the packed document by its inner document, in the same object. */
async function openDocument(json, binaryChunk, most) {
  const bytes = await new BufferViews(json, binaryChunk).stored(extensionOf(json).document);
  const text = await inflate(bytes, most);
  let inner;
  try {
    inner = JSON.parse(new TextDecoder("utf-8", {fatal: true, ignoreBOM: true}).decode(text));
  } catch {
    refuse("the packed document is not JSON");
  }
  inner = objectOf({document: inner ?? 0}, "document");
  if (extensionOf(inner)?.document !== undefined) refuse("a packed document in a packed document");
  for (const name of Object.keys(json)) delete json[name];
  Object.assign(json, inner);
}

/** Calls use(view) for each reference to a buffer view by an accessor or an image. */
function forEachReference(json, use) {
  listOf(json, "accessors").forEach((accessor, i) => {
    use(accessor.bufferView, `accessor ${i}`, i);
    if (accessor.sparse === undefined) return;
    const sparse = objectOf(accessor, "sparse");
    for (const name of ["indices", "values"]) use(objectOf(sparse, name).bufferView, `accessor ${i}`);
  });
  listOf(json, "images").forEach(({bufferView}, i) => use(bufferView, `image ${i}`));
}

/**
 * Numbers of buffer views that decoded values may reuse: views of streams, without contents, or used by a fallback
 * only.
 */
function freeViews(json, views, streams) {
  const hollow = new Set(), kept = new Set(), fallback = new Set();
  const ofStreams = streams.flatMap(({view, partsView}) => (partsView === undefined ? [view] : [view, partsView]));
  for (const view of ofStreams) {
    if (hollow.has(view)) refuse(`buffer view ${view} is of two streams`);
    hollow.add(view);
  }
  views.list.forEach((_, i) => {
    if (views.isHollow(i)) hollow.add(i);
  });
  const decoded = new Set(streams.flatMap(({sets, parts}) => [...sets.flat(), ...parts.map(({indices}) => indices)]));
  forEachReference(json, (view, what, accessor) => {
    if (view === undefined) return;
    if (hollow.has(view)) refuse(`${what} refers to buffer view ${view}, which is a stream's or has no contents`);
    (decoded.has(accessor) ? fallback : kept).add(view);
  });
  const isFree = (view) => Number.isInteger(view) && views.list[view] && !kept.has(view);
  return [...hollow, ...fallback].filter(isFree).sort((a, b) => a - b);
}

/** Pads each vertex to a multiple of 4 bytes, as glTF requires. */
function padRows(values, components) {
  const bytes = new Uint8Array(values.buffer, values.byteOffset, values.byteLength);
  const stride = components * values.BYTES_PER_ELEMENT, padded = Math.ceil(stride / 4) * 4;
  if (padded === stride) return {bytes, stride};
  const out = new Uint8Array(bytes.length / stride * padded);
  for (let from = 0, to = 0; from < bytes.length; from += stride, to += padded)
    out.set(bytes.subarray(from, from + stride), to);
  return {bytes: out, stride: padded};
}

/** Sets min and max of an accessor of positions; removes them if a value is not finite (possible in displacements). */
function putBounds(accessor, values, components) {
  const min = new Array(components).fill(Infinity), max = new Array(components).fill(-Infinity);
  let isFinite = values.length > 0;
  for (let c = 0; c < components; c++) {
    for (let i = c; i < values.length; i += components) {
      const value = values[i];
      if (value < min[c]) min[c] = value;
      if (value > max[c]) max[c] = value;
      isFinite &&= value - value === 0;
    }
  }
  if (isFinite)
    Object.assign(accessor, {min, max});
  else
    delete accessor.min, delete accessor.max;
}

/**
 * Decodes a stream. Returns {number, count, bytes} of each accessor; attributes also have {values, components,
 * stride}.
 */
async function decodeStream(stream, json, views, decodeMesh, budget) {
  const file = await views.stored(stream.view);
  const mesh = await decodeMesh(file, {limits: {maxMemory: budget.left}});
  const {indices, attributes, vertexCount} = mesh;
  // The indices and attributes are in memory twice: as decoded, and as split into sets.
  budget.take(
    2 * (indices.byteLength + attributes.reduce((sum, {values}) => sum + values.byteLength, 0)) + 16 * vertexCount);
  const triangles = indices.length / 3;
  const partOf = stream.parts.length === 1 ?
    undefined :
    decodePartCodes(
      await inflate(await views.stored(stream.partsView), 15 * triangles), triangles, stream.parts.length);
  const counts = stream.sets.map(([first]) => json.accessors[first].count);
  counts.forEach((count) => count === undefined || numberBelow(2 ** 32, count, "the count of a set's accessors"));
  const {rows, parts} = splitMesh(mesh, stream, partOf, counts);
  const out = [];
  stream.sets.forEach((numbers, set) => {
    if (numbers.length !== attributes.length)
      refuse(`${numbers.length} accessors of a set for ${attributes.length} attributes`);
    numbers.forEach((number, i) => {
      const {components} = attributes[i];
      const values = asComponents(valuesOf(attributes[i], rows[set]), json.accessors[number], attributes[i]);
      out.push({number, count: values.length / components, values, components, ...padRows(values, components)});
    });
  });
  stream.parts.forEach((part, i) => {
    const values = asIndices(parts[i], json.accessors[part.indices], rows[part.set]?.length ?? vertexCount);
    out.push({
      number: part.indices,
      count: values.length,
      bytes: new Uint8Array(values.buffer, values.byteOffset, values.byteLength)
    });
  });
  return out;
}

/**
 * Decodes a glTF document with LACEDRING_mesh_compression to plain glTF. A document without the extension stays as it
 * is.
 * @param {object} json the document, as JSON.parse returns it. Modified: becomes the plain document (the inner one if
 *   packed)
 * @param {Uint8Array} [binaryChunk] of a GLB
 * @param {(buffer: number, uri: string) => Promise<Uint8Array>} [loadBuffer] loads the bytes of a buffer that has a uri
 * @param {object} [options]
 * @param {function} [options.decodeMesh] default: decodeMesh of "lacedring"; decodeMeshAsync decodes in a worker
 * @param {{maxMemory?: number}} [options.limits] bytes of memory for decoding; default: the larger of 512 MiB and 128
 *   times the binary chunk
 * @returns {Promise<{json: object, views: (Uint8Array | undefined)[]}>} `json`, and the bytes of its buffer views;
 *   undefined for views that still use their buffer. Placeholder buffers have no bytes. Rejects with an Error of one
 *   line. Untrusted input is safe.
 */
export async function unpackGltf(json, binaryChunk, loadBuffer, {decodeMesh = decodeWhenReady, limits} = {}) {
  const budget = new Budget(memoryLimit(limits, binaryChunk?.length ?? 0));
  const isPacked = extensionOf(json)?.document !== undefined;
  if (isPacked) await openDocument(json, binaryChunk, Math.floor(budget.left / 32));
  if ([json.extensionsUsed].flat().some((name) => OTHERS.includes(name)))
    refuse("another compression of meshes is beside it");
  const views =
    new BufferViews(json, binaryChunk, loadBuffer && ((buffer) => loadBuffer(buffer, json.buffers[buffer].uri)));
  const {streams, positions} = readDocument(json, isPacked);
  const free = freeViews(json, views, streams);
  const contents = await Promise.all(views.list.map((view, i) => {
    if (!views.isCoded(i)) return undefined;
    budget.take(2 * view.byteLength);
    return views.decoded(i);
  }));
  const decoded = [];
  for (const stream of streams) decoded.push(...await decodeStream(stream, json, views, decodeMesh, budget));
  for (const {number, count, values, components, bytes, stride} of decoded) {
    const accessor = json.accessors[number];
    if ((accessor.count ?? count) !== count) refuse(`accessor ${number} has another count than its stream`);
    for (const name of ["byteOffset", "sparse"]) delete accessor[name];
    accessor.count = count;
    if (positions.has(number)) putBounds(accessor, values, components);
    accessor.bufferView = free.shift() ?? views.list.length;
    views.list[accessor.bufferView] = {
      buffer: 0,
      byteLength: bytes.length,
      ...(stride && {byteStride: stride}),
      target: stride ? ARRAY_BUFFER : ELEMENT_ARRAY_BUFFER,
    };
    contents[accessor.bufferView] = bytes;
  }
  for (const view of free) {  // unused views stay, so that the numbers of the views after them do not change
    views.list[view] = {buffer: 0, byteLength: 4};
    contents[view] = new Uint8Array(4);
  }
  if (views.list.length > 0) json.bufferViews = views.list;
  removeAllExtensions(json);
  return {json, views: contents};
}
