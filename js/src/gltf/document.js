// The JSON of a glTF file and what the extension says in it. Values are as JSON.parse made them and may be anything.

export const EXTENSION = "LACEDRING_mesh_compression";

/** Refuses the asset, in one line. */
export function refuse(message) {
  throw new Error(`${EXTENSION}: ${message}`);
}

const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** The objects in owner[name]; [] where it is absent. */
export function listOf(owner, name) {
  const list = owner[name] ?? [];
  if (!Array.isArray(list) || !list.every(isObject)) refuse(`"${name}" is not a list of objects`);
  return list;
}

/** The object in owner[name]; {} where it is absent. */
export function objectOf(owner, name) {
  const object = owner[name] ?? {};
  if (!isObject(object)) refuse(`"${name}" is not an object`);
  return object;
}

/** The extension's object at a place of the document; undefined: it has none. */
export function extensionOf(owner) {
  const extension = objectOf(owner, "extensions")[EXTENSION];
  if (extension !== undefined && !isObject(extension)) refuse("its value is not an object");
  return extension;
}

/** An integer from 0 to below `end`. */
export function numberBelow(end, value, what) {
  if (!Number.isInteger(value) || value < 0 || value >= end) refuse(`${what} is missing or not a number below ${end}`);
  return value;
}

export function removeExtension(owner) {
  if (!extensionOf(owner)) return;
  delete owner.extensions[EXTENSION];
  if (Object.keys(owner.extensions).length === 0) delete owner.extensions;
}

/** Takes the extension out of the document, where nothing refers to it any more. */
export function removeAllExtensions(json) {
  const primitives = listOf(json, "meshes").flatMap((mesh) => listOf(mesh, "primitives"));
  [json, ...primitives, ...listOf(json, "bufferViews"), ...listOf(json, "buffers")].forEach(removeExtension);
  for (const name of ["extensionsUsed", "extensionsRequired"]) {
    if (!Array.isArray(json[name])) continue;
    json[name] = json[name].filter((other) => other !== EXTENSION);
    if (json[name].length === 0) delete json[name];
  }
}
