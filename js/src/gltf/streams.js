import {extensionOf, listOf, numberBelow, objectOf, refuse} from "./document.js";

/**
 * A document's description of a stream.
 * @typedef {object} Stream
 * @property {number} view the buffer view of its .lr file
 * @property {number} [partsView] the buffer view of its part codes
 * @property {boolean} ordered
 * @property {number[][]} sets accessors of each vertex set, in the order of the stream's attributes
 * @property {{set: number, indices: number}[]} parts set and index accessor of each part
 */

/** Reads streams and their sets. Stores {stream, set} of each accessor in the map `setOf`. */
function readStreams(extension, accessors, setOf) {
  return listOf(extension, "streams").map(({bufferView, parts, sets, ordered = false}, stream) => {
    if (!Array.isArray(sets) || sets.length === 0 || !sets.every(Array.isArray)) refuse(`stream ${stream} has no sets`);
    if (typeof ordered !== "boolean") refuse(`stream ${stream}: "ordered" is neither true nor false`);
    sets.forEach((numbers, set) => {
      if (numbers.length === 0) refuse(`stream ${stream} has a set without accessors`);
      for (const accessor of numbers) {
        numberBelow(accessors.length, accessor, `an accessor of stream ${stream}`);
        if (setOf.has(accessor)) refuse(`accessor ${accessor} is in two places of sets`);
        setOf.set(accessor, {stream, set});
      }
    });
    return {view: bufferView, partsView: parts, ordered, sets, parts: []};
  });
}

/** Names and numbers of the accessors of a primitive's attributes and morph targets. */
function* attributesOf(primitive) {
  for (const names of [objectOf(primitive, "attributes"), ...listOf(primitive, "targets")])
    yield* Object.entries(names);
}

/** Stream and set of a primitive's accessors; undefined if they are in no set. */
function setOfPrimitive(primitive, setOf) {
  const found = [...attributesOf(primitive)].map(([, accessor]) => setOf.get(accessor));
  if (found.some((one) => one?.stream !== found[0]?.stream || one?.set !== found[0]?.set)) {
    refuse("a primitive has accessors of different sets");
  }
  return found[0];
}

/**
 * Reads a document's description of its streams, and checks that it is consistent.
 * @param {object} json the document; the inner document if it is packed
 * @param {boolean} isPacked whether the document is packed: its primitives do not name their part
 * @returns {{streams: Stream[], positions: Set<number>}} `positions`: accessors of POSITION (displacements of morph
 *   targets included)
 */
export function readDocument(json, isPacked) {
  const accessors = listOf(json, "accessors"), setOf = new Map(), positions = new Set();
  const streams = readStreams(extensionOf(json) ?? {}, accessors, setOf);
  const partOf = new Map();  // index accessor: {stream, part}
  for (const mesh of listOf(json, "meshes")) {
    for (const primitive of listOf(mesh, "primitives")) {
      const extension = extensionOf(primitive), {indices, mode = 4} = primitive;
      if (isPacked && extension) refuse("a primitive of a packed document names its part");
      if (isPacked ? mode !== 4 : !extension) continue;
      const of = setOfPrimitive(primitive, setOf);
      if (!of && isPacked) continue;
      if (!of || mode !== 4) refuse("a primitive has a part but no set, or is no list of triangles");
      numberBelow(accessors.length, indices, "the index accessor of a part");
      if (setOf.has(indices)) refuse(`accessor ${indices} is in a set, and has indices`);
      const {parts} = streams[of.stream];
      const known = partOf.get(indices);
      const part = isPacked ? known?.part ?? parts.length : extension.part;
      // `parts` may be a sparse array until all primitives are read. Below, part numbers are checked to have no gaps.
      numberBelow(2 ** 31, part, "the number of a part");
      if ((known ?? of).stream !== of.stream || (known && known.part !== part))
        refuse(`accessor ${indices} is of two parts`);
      if (!isPacked && extension.stream !== of.stream) refuse("a primitive names another stream than its attributes'");
      partOf.set(indices, {stream: of.stream, part});
      parts[part] ??= {set: of.set, indices};
      if (parts[part].set !== of.set || parts[part].indices !== indices) {
        refuse(`part ${part} of stream ${of.stream} has two sets or index accessors`);
      }
      for (const [name, accessor] of attributesOf(primitive)) {
        if (name === "POSITION") positions.add(accessor);
      }
    }
  }
  streams.forEach(({parts, partsView}, i) => {
    if (parts.length === 0 || Object.keys(parts).length !== parts.length)
      refuse(`stream ${i} has a part without a primitive`);
    if ((partsView !== undefined) !== parts.length > 1)
      refuse(`stream ${i} has part codes for one part, or none for several`);
  });
  return {streams, positions};
}
