// Reads header and section table of .lr files (docs/lr-file.md).
import {LacedRingError} from "./errors.js";

export const LEAN = 1, ATTRIBUTE = 2, VERTEX_ORDER = 3, CORNER_ORDER = 4, LR = 5, LR_COMPACT = 6, PACKED = 7,
             VERTICES = 8, SEAMS = 9;
const NAMES = [
  "", "lean stream", "attribute", "vertex order", "corner order", "LR tables", "LR tables", "packed stream",
  "vertex stream", "seams"
];
const MAGIC = 0x4c46524c, VERSION = 4, HEADER = 32, ENTRY = 32;
const NORMALIZED = 1 << 16, V_UP = 1 << 17, PER_COPY = 1 << 18;

/** Types of attribute values, indexed by their number in a file. */
export const TYPES = [
  ["i8", Int8Array], ["u8", Uint8Array], ["i16", Int16Array], ["u16", Uint16Array], ["i32", Int32Array],
  ["u32", Uint32Array], ["f32", Float32Array], ["f64", Float64Array]
];

export function malformed(message, code = "FILE") {
  return new LacedRingError(code, `lr file: ${message}`);
}

function padded(size) {
  return Math.ceil(size / 8) * 8;
}

/**
 * Reads the header and section table of a file. Checks everything but the contents of sections: checksums, offsets,
 * padding, names. `crc(offset, size)` returns the CRC-32 of bytes of the file.
 * @returns counts of the header, and sections { kind, isStored, offset, size }; attributes also have { name, vUp,
 *   perCopy, type, components, normalized }. Offset and size are those of the contents after the name.
 */
export function readContainer(bytes, crc) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 4 || view.getUint32(0, true) !== MAGIC) throw malformed("not an .lr file", "MAGIC");
  if (bytes.length < HEADER) throw malformed("shorter than its header", "SHORT");
  const [version, count, vertices, triangles, copies, tableCrc, headerCrc] =
    [4, 8, 12, 16, 20, 24, 28].map((at) => view.getUint32(at, true));
  if (version !== VERSION) throw malformed(`version ${version} is not ${VERSION}`, "VERSION");
  if (headerCrc !== crc(0, 28) || (copies !== 0 && copies < vertices)) throw malformed("damaged header", "HEADER");
  let end = HEADER + ENTRY * count;
  if (end > bytes.length) throw malformed("shorter than its section table", "SHORT");
  if (tableCrc !== crc(HEADER, ENTRY * count)) throw malformed("damaged section table", "CHECKSUM");
  const sections = [];
  for (let i = 0; i < count; ++i) {
    const at = HEADER + ENTRY * i;
    const section = readEntry(view, at, i);
    if (section.offset !== padded(end) || section.offset + section.size > bytes.length)
      throw malformed(`section ${i} lies outside the file`, "SIZE");
    if (bytes.subarray(end, section.offset).some((byte) => byte !== 0)) throw malformed(`padding before section ${i}`);
    end = section.offset + section.size;
    if (section.crc !== crc(section.offset, section.size)) throw malformed(`${section.what} is damaged`, "CHECKSUM");
    if (section.nameLength !== undefined) readName(bytes, section, copies);
    sections.push(section);
  }
  if (end !== bytes.length) throw malformed("bytes after the last section", "SIZE");
  return {vertices, triangles, copies, sections};
}

function readEntry(view, at, i) {
  const kind = view.getUint16(at, true), coding = view.getUint16(at + 2, true), layout = view.getUint32(at + 24, true);
  const nameLength = view.getUint32(at + 28, true);
  const large = (from) => view.getUint32(from, true) + view.getUint32(from + 4, true) * 2 ** 32;
  const section = {
    what: `section ${i}, ${NAMES[kind] ?? "unknown"}`,
    kind,
    isStored: coding === 1,
    crc: view.getUint32(at + 4, true),
    offset: large(at + 8),
    size: large(at + 16)
  };
  if (kind === 0 || kind >= NAMES.length) throw malformed(`section ${i}: unknown kind ${kind}`, "KIND");
  if (coding > 1 || (coding === 1 && kind < PACKED))
    throw malformed(`${section.what}: unknown coding ${coding}`, "KIND");
  if (kind !== ATTRIBUTE && kind !== VERTICES) {
    if (layout !== 0 || nameLength !== 0) throw malformed(`${section.what}: it has no layout and no name`);
    return section;
  }
  if (layout >>> 19 !== 0 || (kind === VERTICES && (layout & 0x1ffff) !== 0))
    throw malformed(`${section.what}: unknown attribute layout`);
  section.nameLength = nameLength;
  section.vUp = (layout & V_UP) !== 0;
  section.perCopy = (layout & PER_COPY) !== 0;
  if (kind === ATTRIBUTE) {
    Object.assign(
      section, {type: layout & 255, components: layout >> 8 & 255, normalized: (layout & NORMALIZED) !== 0});
    if (section.type >= TYPES.length || section.components === 0)
      throw malformed(`${section.what}: unknown attribute layout`);
  }
  return section;
}

/** Reads the name at the start of a section's contents; moves offset and size past it. */
function readName(bytes, section, copies) {
  const size = padded(section.nameLength);
  if (size > section.size) throw malformed(`${section.what}: of the wrong size`, "SIZE");
  const name = bytes.subarray(section.offset, section.offset + section.nameLength);
  if (bytes.subarray(section.offset + name.length, section.offset + size).some((byte) => byte !== 0))
    throw malformed(`${section.what}: name not padded with zeros`);
  section.name = new TextDecoder().decode(name);
  section.begin = section.offset;
  section.offset += size;
  section.size -= size;
  if (section.perCopy && copies === 0) throw malformed(`${section.what}: of copies where there are none`);
}
