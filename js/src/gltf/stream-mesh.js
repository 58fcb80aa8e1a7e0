// Splits a decoded .lr file into vertex sets and index lists.
import {refuse} from "./document.js";

/** Array types by component type of glTF. */
const COMPONENTS = {
  __proto__: null,
  5120: Int8Array,
  5121: Uint8Array,
  5122: Int16Array,
  5123: Uint16Array,
  5125: Uint32Array,
  5126: Float32Array,
};
const SHAPES = {
  __proto__: null,
  SCALAR: 1,
  VEC2: 2,
  VEC3: 3,
  VEC4: 4,
  MAT2: 4,
  MAT3: 9,
  MAT4: 16
};

/** The mesh's triangles, sorted by their number in the source. */
function sortTriangles(cornerOrder) {
  const numbers = cornerOrder.map((entry) => Math.floor(entry / 3)), order = cornerOrder.map((_, i) => i);
  const end = numbers.reduce((most, number) => Math.max(most, number), 0) + 1;
  // Most of the source's triangles were degenerate: sorts rather than allocating a table of all numbers.
  if (end > 16 * order.length) return order.sort((a, b) => numbers[a] - numbers[b]);
  const none = 0xffffffff, from = new Uint32Array(end).fill(none);
  order.forEach((i) => from[numbers[i]] = i);
  return from.filter((i) => i !== none);
}

/**
 * The set of each vertex and its index in the set, for a stream that keeps the order. There, the vertices of a set are
 * consecutive.
 */
function placeInOrder({vertexCount, vertexOrder}, counts) {
  if (counts.some((count) => count === undefined)) refuse("an ordered stream, and a set without a count");
  const all = counts.reduce((sum, count) => sum + count, 0);
  if (all !== vertexCount) refuse(`${vertexCount} vertices of a stream, where its accessors have ${all}`);
  const setAt = new Uint32Array(vertexCount), firstOf = [];
  let first = 0;
  counts.forEach((count, set) => {
    firstOf.push(first);
    setAt.fill(set, first, first += count);
  });
  const setOf = vertexOrder.map((number) => setAt[number]);
  return {setOf, place: vertexOrder.map((number, v) => number - firstOf[setOf[v]]), counts};
}

/**
 * The set of each vertex and its index in the set, for a stream that does not keep the order. A vertex belongs to the
 * set of its triangles.
 */
function placeByTriangles({vertexCount, indices}, stream, partOf) {
  const none = 0xffffffff, setOf = new Uint32Array(vertexCount).fill(none), place = new Uint32Array(vertexCount);
  indices.forEach((v, i) => {
    const {set} = stream.parts[partOf[Math.floor(i / 3)]];
    if (setOf[v] !== none && setOf[v] !== set) refuse("a vertex of two sets");
    setOf[v] = set;
  });
  const counts = stream.sets.map(() => 0);
  setOf.forEach((set, v) => {
    if (set === none) refuse("a vertex is in no triangle");
    place[v] = counts[set]++;
  });
  return {setOf, place, counts};
}

/**
 * Splits a decoded mesh into the vertex sets and the parts of its stream.
 * @param {object} mesh the result of decodeMesh
 * @param {import("./streams.js").Stream} stream
 * @param {Uint32Array} [partOf] part of each triangle; undefined if there is one part
 * @param {(number | undefined)[]} counts number of vertices in each set according to the document, if it gives one
 * @returns {{rows: (Uint32Array | undefined)[], parts: Uint32Array[]}} for each set, the mesh's vertices in it
 *   (undefined: all, in order); for each part, its triangles as indices into the set. Throws an Error of one line.
 */
export function splitMesh(mesh, stream, partOf, counts) {
  const {vertexCount, indices, vertexOrder, cornerOrder} = mesh;
  const isOrdered = vertexOrder?.length > 0 && cornerOrder?.length > 0;
  if (isOrdered !== stream.ordered) refuse("the document and the stream differ about the order");
  if (partOf === undefined && stream.sets.length > 1) refuse("a set without a part");
  const check = (count, set) => {
    if ((counts[set] ?? count) !== count) refuse(`${count} vertices of a set, where its accessors have ${counts[set]}`);
  };
  if (!isOrdered && !partOf) {
    check(vertexCount, 0);
    return {rows: [undefined], parts: [indices]};
  }
  const places = isOrdered ? placeInOrder(mesh, counts) : placeByTriangles(mesh, stream, partOf);
  const {setOf, place} = places;
  places.counts.forEach(check);
  const rows = places.counts.map((count) => new Uint32Array(count));
  setOf.forEach((set, v) => rows[set][place[v]] = v);

  const triangles = isOrdered ? sortTriangles(cornerOrder) : undefined;
  const corners = stream.parts.map(() => 0);
  if (partOf)
    partOf.forEach((part) => corners[part] += 3);
  else
    corners[0] = indices.length;
  const parts = corners.map((count) => new Uint32Array(count));
  corners.fill(0);
  for (let i = 0; i < indices.length / 3; i++) {
    const from = triangles ? triangles[i] : i, part = partOf ? partOf[from] : 0;
    const first = isOrdered ? cornerOrder[from] % 3 : 0;  // the triangle's first corner was this corner in the source
    for (let c = 0; c < 3; c++) {
      const v = indices[3 * from + c];
      if (setOf[v] !== stream.parts[part].set) refuse("a triangle with a vertex of another set");
      parts[part][corners[part] + (first + c) % 3] = place[v];
    }
    corners[part] += 3;
  }
  return {rows, parts};
}

/** The values of an attribute at the vertices `rows`, tightly packed. */
export function valuesOf({values, components}, rows) {
  if (!rows) return values;
  const out = new values.constructor(rows.length * components);
  let at = 0;
  for (const row of rows) {
    for (let c = 0; c < components; c++) out[at++] = values[row * components + c];
  }
  return out;
}

/** The values in an accessor's component type; floats may become integers if that is exact. */
export function asComponents(values, accessor, attribute) {
  const Type = COMPONENTS[accessor.componentType];
  if (SHAPES[accessor.type] !== attribute.components || !Type || attribute.vUp)
    refuse(`${attribute.name} does not fit its accessor`);
  const isFloat = values instanceof Float32Array;
  if (!isFloat && (accessor.normalized ?? false) !== attribute.normalized) {
    refuse(`${attribute.name} is normalized in the stream or in its accessor, not in both`);
  }
  if (values instanceof Type) return values;
  if (!isFloat || Type === Uint32Array) refuse(`${attribute.name} has another type than its accessor`);
  const out = Type.from(values);
  if (!values.every((value, i) => out[i] === value))
    refuse(`${attribute.name} has values that its accessor's type cannot hold`);
  return out;
}

/** Indices into a set of `elements` vertices, in the component type of their accessor. */
export function asIndices(indices, accessor, elements) {
  const Type = COMPONENTS[accessor.componentType];
  const isIndex = accessor.type === "SCALAR" && [Uint8Array, Uint16Array, Uint32Array].includes(Type);
  if (!isIndex) refuse("a part's accessor is not of indices");
  const end = 256 ** Type.BYTES_PER_ELEMENT - 1;
  if (elements > end && !indices.every((v) => v < end)) refuse("a part's accessor does not hold its indices");
  return Type === Uint32Array ? indices : Type.from(indices);
}
