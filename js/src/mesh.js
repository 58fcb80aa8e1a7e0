// Decodes the bytes of an .lr file to typed arrays.
import {ATTRIBUTE, CORNER_ORDER, LEAN, LR, LR_COMPACT, malformed, PACKED, readContainer, SEAMS, TYPES, VERTEX_ORDER, VERTICES} from "./container.js";
import {LacedRingError} from "./errors.js";

const LATTICE = 1, DECIMALS = 4;  // mappings of positions whose integers predict other attributes
/**
 * Most triangles and vertices per byte of the storage form. A triangle takes at least one bit with a probability model,
 * which costs 1/710 bit or more; a vertex takes at least one symbol of 16, which costs 1/1513 bit or more. Counts in
 * headers are checked against these limits before memory is allocated.
 */
const TRIANGLES_A_BYTE = 8 * 710, VERTICES_A_BYTE = 8 * 1514;

/** Default memory limit for a file of `size` bytes, the same as of lacedring's --max-memory. */
function defaultMemory(size) {
  return Math.max(512 * 2 ** 20, 128 * size);
}

/** Removes the words of slots without a triangle. */
function closeRanks(slots) {
  let end = 0;
  for (const vertex of slots) {
    if (vertex !== 0xffffffff) slots[end++] = vertex;
  }
}

/**
 * Decodes one file with an engine. Addresses refer to the engine's memory. Counts are checked before memory is
 * allocated.
 */
class Reader {
  constructor(engine, bytes, limits = {}) {
    this.engine = engine;
    this.bytes = bytes;
    engine.begin(limits.maxMemory ?? defaultMemory(bytes.length));
    this.address = engine.put(bytes);
    this.file = readContainer(bytes, (offset, size) => engine.run("lr_crc", this.address + offset, size, 0));
  }

  /** Decodes the mesh; makes no arrays if `isCheck`. */
  read(isCheck) {
    const {sections, vertices, copies} = this.file;
    const tables = sections.find(({kind}) => kind === LR || kind === LR_COMPACT);
    if (tables)
      throw new LacedRingError("UNSUPPORTED", `lr file: ${tables.what}: not read here; lacedring decode reads them`);
    for (const {kind, perCopy, size, what} of sections) {
      if ((kind === ATTRIBUTE || kind === VERTICES) && (perCopy ? copies : vertices) > VERTICES_A_BYTE * size)
        throw malformed(`${what}: too short for its vertices`, "SIZE");
    }
    const sectionsOf = (...kinds) => sections.filter(({kind}) => kinds.includes(kind));
    const connectivity = sectionsOf(LEAN, PACKED);
    if (connectivity.length !== 1)
      throw malformed(connectivity.length === 0 ? "no connectivity" : "connectivity occurs twice");
    const [seams, vertexOrder, cornerOrder] =
      [SEAMS, VERTEX_ORDER, CORNER_ORDER].map((kind) => this.#only(sectionsOf(kind)));
    if ((seams === undefined) !== (copies === 0)) throw malformed("seams without copies, or copies without seams");
    this.#readConnectivity(connectivity[0], seams);
    if (this.triangleCount > this.file.triangles) throw malformed("more triangles than the input had", "TRIANGLES");
    const vertexCount = seams ? copies : vertices;
    const mesh =
      {vertexCount, triangleCount: this.triangleCount, indices: this.#indices(this.corners, isCheck), attributes: []};
    if (seams) {
      const vertexOf = this.#array(Uint32Array, this.vertexOf, copies, isCheck);
      mesh.surface = {vertexCount: vertices, indices: this.#indices(this.triangles, isCheck), vertexOf};
    }
    for (const section of sectionsOf(ATTRIBUTE, VERTICES))
      mesh.attributes.push(this.#readAttribute(section, mesh.attributes.length === 0, isCheck));
    if (mesh.attributes.length === 0) throw malformed("no POSITION");
    if (vertexOrder) mesh.vertexOrder = this.#readOrder(vertexOrder, vertexCount, vertexCount, 1);
    if (cornerOrder) mesh.cornerOrder = this.#readOrder(cornerOrder, this.triangleCount, this.file.triangles, 3);
    return mesh;
  }

  /** The only section in the list that is not empty, if any. */
  #only(sections) {
    const some = sections.filter(({size}) => size > 0);
    if (some.length > 1) throw malformed(`${some[1].what}: occurs twice`);
    return some[0];
  }

  #array(Type, address, count, isCheck) {
    return isCheck ? undefined : this.engine.array(Type, address, count);
  }

  #indices(address, isCheck) {
    return this.#array(Uint32Array, address, 3 * this.triangleCount, isCheck);
  }

  #call(section, name, ...values) {
    if (!this.engine.has(name))
      throw new LacedRingError(
        "UNSUPPORTED", `lr file: ${section.what}: this module does not read it; "lacedring" does`);
    return this.engine.call(section.what, name, ...values);
  }

  /** Address and number of words of a section. */
  #words(section) {
    if (section.size % 4 !== 0) throw malformed(`${section.what}: no whole number of words`, "SIZE");
    return [this.address + section.offset, section.size / 4];
  }

  /** Sets triangles, triangleCount and corners (the same triangles; with seams, as indices of copies). */
  #readConnectivity(section, seams) {
    const {engine} = this;
    const [slots, slotCount] = section.isStored ? this.#readStoredPacked(section) : this.#readResident(section, seams);
    this.corners = slots;
    if (seams) {
      this.#readSeams(seams, slots, slotCount);
      if (this.triangleCount < slotCount) {
        closeRanks(engine.words(slots, 3 * slotCount));
        closeRanks(engine.words(this.corners, 3 * slotCount));
      }
    }
    this.triangles = slots;
  }

  #checkVertices(section, vertices) {
    if (vertices !== this.file.vertices)
      throw malformed(`${section.what}: another number of vertices than the file has`, "VERTICES");
  }

  #readResident(section, seams) {
    const {engine} = this;
    const [vertices, triangles, slots] =
      this.#call(section, "lr_connectivity_open", ...this.#words(section), section.crc);
    this.#checkVertices(section, vertices);
    const out = engine.take(12 * Math.max(triangles, slots));
    this.#call(section, "lr_connectivity_decode", out);
    this.triangleCount = triangles;
    if (!seams) return [out, triangles];
    if (slots > triangles) engine.run("lr_slots", out);
    return [out, slots];
  }

  #readStoredPacked(section) {
    const {engine, file} = this;
    const most = Math.min(file.triangles, TRIANGLES_A_BYTE * section.size);
    const [vertices, triangles, scratch] =
      this.#call(section, "lr_stored_packed_open", ...this.#words(section), file.vertices, most);
    this.#checkVertices(section, vertices);
    const out = engine.take(12 * triangles), mark = engine.mark;
    this.#call(section, "lr_stored_packed_decode", engine.take(scratch), out);
    engine.release(mark);
    this.triangleCount = triangles;
    return [out, triangles];
  }

  #readSeams(section, slots, slotCount) {
    const {engine, file} = this;
    const words = this.#words(section);
    const [copies, scratch] = section.isStored ?
      this.#call(section, "lr_stored_seams_open", ...words, file.vertices, slotCount, file.copies) :
      this.#call(section, "lr_seams_open", ...words, section.crc, file.vertices, slotCount);
    this.corners = engine.take(12 * slotCount);
    this.vertexOf = engine.take(4 * copies);
    const mark = engine.mark;
    const [made] = this.#call(
      section, section.isStored ? "lr_stored_seams_decode" : "lr_seams_decode", slots, engine.take(scratch),
      this.corners, this.vertexOf);
    engine.release(mark);
    if ((section.isStored ? made : copies) !== file.copies)
      throw malformed(`${section.what}: another number of copies than the file has`, "COPY");
  }

  #readAttribute(section, isFirst, isCheck) {
    const {engine, file} = this;
    const isPosition = section.name === "POSITION";
    if (isPosition !== isFirst && isFirst) throw malformed("the first attribute is not POSITION");
    const count = section.perCopy ? file.copies : file.vertices, mark = engine.mark;
    const made = section.kind === ATTRIBUTE ? this.#readPlain(section, count) :
      section.isStored                      ? this.#readStoredVertices(section, count, isFirst) :
                                              this.#readVertices(section, count, isFirst);
    const [typeName, Type] = TYPES[made.type], {components, normalized} = made;
    if (isFirst) this.#checkPosition(section, made, count);
    let {values} = made, all = count;
    if (this.vertexOf !== undefined && !section.perCopy) {
      const size = components * Type.BYTES_PER_ELEMENT;
      all = file.copies;
      values = engine.take(all * size);
      engine.run("lr_gather", made.values, size, this.vertexOf, all, values);
    }
    const array = this.#array(Type, values, all * components, isCheck);
    const attribute = {name: section.name, components, type: typeName, normalized, values: array, vUp: section.vUp};
    engine.release(this.held ?? mark);
    this.held = undefined;
    return attribute;
  }

  /** An attribute whose values are stored uncompressed. */
  #readPlain(section, count) {
    const {type, components, normalized} = section;
    if (section.size !== count * components * TYPES[type][1].BYTES_PER_ELEMENT)
      throw malformed(`${section.what}: of the wrong size`, "SIZE");
    return {type, components, normalized: normalized && type < 6, values: this.address + section.offset};
  }

  /** Keeps the integers of positions allocated until the file is read, as they may predict other attributes. */
  #hold(integers) {
    this.positions = integers;
    this.held = this.engine.mark;
  }

  #readVertices(section, count, isFirst) {
    const {engine} = this;
    const [components, type, normalized, integers, mapping] = this.#call(
      section, "lr_vertices_open", ...this.#words(section), this.address + section.begin, section.crc, count);
    const predicts = isFirst && integers === 3 && (mapping === LATTICE || mapping === DECIMALS) &&
      this.file.sections.some(({kind, isStored}) => kind === VERTICES && isStored);
    const places = predicts ? engine.take(12 * count) : 0;
    if (predicts) this.#hold(places);
    const values = engine.take(count * components * TYPES[type][1].BYTES_PER_ELEMENT);
    this.#call(section, "lr_vertices_decode", values);
    if (predicts) engine.run("lr_vertices_integers", places);
    return {type, components, normalized: normalized !== 0, values, mapping};
  }

  #readStoredVertices(section, count, isFirst) {
    const {engine, file} = this;
    const [components, type, normalized, integers, mapping, scratch] = this.#call(
      section, "lr_stored_vertices_open", ...this.#words(section), count, this.triangleCount, this.positions ?? 0,
      file.vertices, section.perCopy ? this.vertexOf : 0);
    const places = engine.take(4 * count * integers);
    if (isFirst && integers === 3 && (mapping === LATTICE || mapping === DECIMALS)) this.#hold(places);
    const values = engine.take(count * components * TYPES[type][1].BYTES_PER_ELEMENT);
    this.#call(
      section, "lr_stored_vertices_decode", section.perCopy ? this.corners : this.triangles, this.triangleCount,
      engine.take(scratch), places, values);
    return {type, components, normalized: normalized !== 0, values, mapping};
  }

  /** Checks that POSITION is three floats or doubles per vertex (not per copy), finite when rounded to floats. */
  #checkPosition(section, {type, components, values, mapping}, count) {
    const Type = TYPES[type][1];
    if (components !== 3 || type < 6 || section.perCopy)
      throw malformed("POSITION is not three floats or doubles of each vertex");
    if (mapping === LATTICE) return;  // its values are always finite
    const coordinates = new Type(this.engine.buffer, values, 3 * count);
    for (let i = 0; i < coordinates.length; ++i) {
      if (!Number.isFinite(Math.fround(coordinates[i]))) throw malformed("a coordinate that is not finite");
    }
  }

  /**
   * Reads and checks an order: a permutation of vertices (each = 1), or corners (each = 3) of distinct triangles <
   * range.
   */
  #readOrder(section, count, range, each) {
    const [address, words] = this.#words(section);
    if (words !== count || count > range) throw malformed(`${section.what}: of another size`, "SIZE");
    const order = this.engine.array(Uint32Array, address, words);
    const sorted = order.map((entry) => Math.floor(entry / each)).sort();
    if (sorted.some((entry, i) => entry >= range || (i > 0 && entry === sorted[i - 1])))
      throw malformed(`${section.what}: no permutation`, "ORDER");
    return order;
  }
}

/** Decodes the bytes of a file; only checks them if `isCheck`. */
export function readMesh(engine, bytes, limits, isCheck = false) {
  if (!(bytes instanceof Uint8Array)) throw new TypeError("lacedring: bytes are no Uint8Array");
  return new Reader(engine, bytes, limits).read(isCheck);
}
