// Converts between three's geometries and the arrays of a mesh file.
import {BufferAttribute, BufferGeometry} from "three";

const NAMES = {
  position: "POSITION",
  normal: "NORMAL",
  tangent: "TANGENT",
  uv: "TEXCOORD_0",
  color: "COLOR_0",
  skinIndex: "JOINTS_0",
  skinWeight: "WEIGHTS_0"
};
const nameOf = (name) => NAMES[name] ?? (/^uv\d$/.test(name) ? `TEXCOORD_${name.slice(2)}` : `_${name}`);

/** The values of an attribute, tightly packed (copied if interleaved). `rows`: only of these vertices. */
function valuesOf({array, itemSize, isInterleavedBufferAttribute, data, offset = 0}, rows) {
  if (!rows && !isInterleavedBufferAttribute) return array;
  const from = isInterleavedBufferAttribute ? data.array : array,
        stride = isInterleavedBufferAttribute ? data.stride : itemSize;
  const count = rows?.length ?? from.length / stride, values = new from.constructor(count * itemSize);
  for (let i = 0; i < count; i++) {
    const at = (rows ? rows[i] : i) * stride + offset;
    for (let k = 0; k < itemSize; k++) values[i * itemSize + k] = from[at + k];
  }
  return values;
}

/**
 * `rows`: the vertices that triangles use, in order of first use (undefined if all are used); `indices`: into these
 * rows.
 */
function usedVertices(indices, count) {
  const number = new Int32Array(count).fill(-1), rows = [];
  for (const v of indices)
    if (number[v] < 0) number[v] = rows.push(v) - 1;
  return rows.length === count ? {indices} : {rows, indices: indices.map((v) => number[v])};
}

/**
 * All attributes of a geometry: {key, target, attribute} with three's name and, for morph targets, the target's
 * number.
 */
function listAttributes({attributes, morphAttributes}) {
  const of = (list, target) => list.map(([key, attribute]) => ({key, target, attribute}));
  return [
    ...of(Object.entries(attributes)),
    ...Object.entries(morphAttributes)
      .flatMap(([key, targets]) => targets.flatMap((attribute, target) => of([[key, attribute]], target)))
  ];
}

/** The name of an attribute (or morph target's attribute) in files. */
const fileNameOf = ({key, target}) => target === undefined ? nameOf(key) : `_${key}_${target}`;

/** All attributes of a geometry, as in files. `rows`: only of these vertices. */
function attributesOf(geometry, rows) {
  return listAttributes(geometry).map((one) => ({
                                        name: fileNameOf(one),
                                        values: valuesOf(one.attribute, rows),
                                        components: one.attribute.itemSize,
                                        normalized: one.attribute.normalized
                                      }));
}

/** A geometry's own arrays, not copied, for plainGlb: it stores arrays that several geometries share once. */
export function plainOf(geometry) {
  return {indices: geometry.index.array, attributes: attributesOf(geometry)};
}

/** The argument of encodeMesh, without vertices that no triangle uses. */
export function sourceOf(geometry) {
  const {rows, indices} = usedVertices(geometry.index.array, geometry.attributes.position.count);
  const attributes = attributesOf(geometry, rows);
  const position = attributes.find(({name}) => name === "POSITION");
  if (!(position.values instanceof Float32Array)) position.values = decoded(geometry.attributes.position, rows);
  return {indices: Uint32Array.from(indices), attributes};
}

/** The floats that an attribute of integers represents. */
function decoded(attribute, rows) {
  const out = new Float32Array(3 * (rows?.length ?? attribute.count));
  for (let i = 0; i < out.length / 3; i++) {
    const v = rows ? rows[i] : i;
    out.set([attribute.getX(v), attribute.getY(v), attribute.getZ(v)], 3 * i);
  }
  return out;
}

/**
 * Makes a geometry from decoded arrays, with three's attribute names and morph targets as in the geometry that was
 * encoded.
 */
export function geometryLike(before, {indices, attributes}) {
  const geometry = new BufferGeometry();
  const wanted = new Map(listAttributes(before).map((one) => [fileNameOf(one), one]));
  for (const {name, values, components, normalized} of attributes) {
    const {key, target} = wanted.get(name);
    const attribute =
      new BufferAttribute(values instanceof Float64Array ? Float32Array.from(values) : values, components, normalized);
    if (target === undefined)
      geometry.setAttribute(key, attribute);
    else
      (geometry.morphAttributes[key] ??= [])[target] = attribute;
  }
  geometry.morphTargetsRelative = before.morphTargetsRelative;
  geometry.setIndex(new BufferAttribute(indices, 1));
  return geometry;
}
