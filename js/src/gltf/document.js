// Access to the JSON of a glTF file and to the extension's objects in it. Values come from JSON.parse and are
// untrusted.

export const EXTENSION = "LACEDRING_mesh_compression";

/** Throws an Error of one line: the file is invalid. */
export function refuse(message) {
  throw new Error(`${EXTENSION}: ${message}`);
}

const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** The objects in owner[name]; [] if absent. */
export function listOf(owner, name) {
  const list = owner[name] ?? [];
  if (!Array.isArray(list) || !list.every(isObject)) refuse(`"${name}" is not a list of objects`);
  return list;
}

/** The object in owner[name]; {} if absent. */
export function objectOf(owner, name) {
  const object = owner[name] ?? {};
  if (!isObject(object)) refuse(`"${name}" is not an object`);
  return object;
}

/** The extension's object in `owner`; undefined if it has none. */
export function extensionOf(owner) {
  const extension = objectOf(owner, "extensions")[EXTENSION];
  if (extension !== undefined && !isObject(extension)) refuse("its value is not an object");
  return extension;
}

/** Checks that `value` is an integer in [0, end); returns it. */
export function numberBelow(end, value, what) {
  if (!Number.isInteger(value) || value < 0 || value >= end) refuse(`${what} is missing or not a number below ${end}`);
  return value;
}

export function removeExtension(owner) {
  if (!extensionOf(owner)) return;
  delete owner.extensions[EXTENSION];
  if (Object.keys(owner.extensions).length === 0) delete owner.extensions;
}

/** Removes the extension from the document. */
export function removeAllExtensions(json) {
  const primitives = listOf(json, "meshes").flatMap((mesh) => listOf(mesh, "primitives"));
  [json, ...primitives, ...listOf(json, "bufferViews"), ...listOf(json, "buffers")].forEach(removeExtension);
  for (const name of ["extensionsUsed", "extensionsRequired"]) {
    if (!Array.isArray(json[name])) continue;
    json[name] = json[name].filter((other) => other !== EXTENSION);
    if (json[name].length === 0) delete json[name];
  }
}
