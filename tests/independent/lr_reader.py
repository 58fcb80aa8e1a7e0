"""The .lr file, read by its document (docs/lr-file.md) alone. The streams in it have a reader each."""

import array
import math
import struct
import zlib

from lean_reader import decode_lean_slots
from lr_corners import check_corners
from lr_tables_reader import Tables, decode_tables
from mesh_readers import TYPES, Attribute, BadFile, Mesh, split_keys
from packed_reader import decode_packed
from seams_reader import read_seams
from storage_reader import read_stored_packed
from stored_seams import read_stored_seams
from stored_vertices import read_stored_vertices
from vertex_reader import DECIMALS, LATTICE, read_vertices

ATTRIBUTE, VERTEX_ORDER, CORNER_ORDER, VERTEX_STREAM, SEAMS = 2, 3, 4, 8, 9
STORAGE = 1 << 16  # added by sections() to the kind of a section in storage form
STORED_PACKED, STORED_VERTICES, STORED_SEAMS = STORAGE + 7, STORAGE + VERTEX_STREAM, STORAGE + SEAMS
NORMALIZED, V_UP, PER_COPY = 1 << 16, 1 << 17, 1 << 18  # bits of an attribute's layout
LAYOUT_BITS = {ATTRIBUTE: 0x7FFFF, VERTEX_STREAM: V_UP | PER_COPY, STORED_VERTICES: V_UP | PER_COPY}  # allowed bits


def tables_in(words, compact):
    tables = Tables(words, compact)
    vertices, _, extra = decode_tables(tables)
    check_corners(tables)
    slots = [()] * (2 * tables.ring + tables.t0)
    for number, (a, b, c), flipped in tables.triangles():
        slots[number] = tuple(extra.get(v, v) for v in ((c, b, a) if flipped else (a, b, c)))
    return vertices, slots, extra


def packed_in(words):
    vertices, flat = decode_packed(words)
    corners = iter(flat)
    return vertices, list(zip(corners, corners, corners)), {}


# Decoders by section kind. Each takes the words of a stream and returns its number of vertices, the triangle of each slot (()
# if it has none), and a dict from the extra vertices of LR tables to their originals, which the triangles name.
DECODERS = {1: lambda words: (*decode_lean_slots(words), {}), 5: lambda words: tables_in(words, False),
            6: lambda words: tables_in(words, True), 7: packed_in,
            STORED_PACKED: lambda words: (*read_stored_packed(words), {})}


SEAM_READERS = {SEAMS: read_seams, STORED_SEAMS: read_stored_seams}


def sections(data):
    """(kind, contents, layout, length of the name) of each section; with STORAGE in kind if it is in storage form."""
    magic, version, count, vertices, _, copies, table_crc, header_crc = struct.unpack_from("<8I", data)
    if magic != 0x4C46524C or version != 4:
        raise BadFile("not an .lr file of version 4")
    if 0 < copies < vertices:
        raise BadFile("the .lr file has fewer copies than vertices")
    if zlib.crc32(data[:28]) != header_crc or zlib.crc32(data[32:32 + 32 * count]) != table_crc:
        raise BadFile("the .lr file's header is damaged")
    end = 32 + 32 * count
    out = []
    for i in range(count):
        kind, coding, crc, offset, size, layout, name_length = struct.unpack_from("<HHIQQII", data, 32 + 32 * i)
        contents = data[offset:offset + size]
        if len(contents) != size or zlib.crc32(contents) != crc:
            raise BadFile(f"section {i} of the .lr file is damaged")
        if offset != end + -end % 8 or any(data[end:offset]):
            raise BadFile(f"section {i} of the .lr file is not where it should be")
        kind += STORAGE * coding
        if kind not in DECODERS and kind not in (*LAYOUT_BITS, VERTEX_ORDER, CORNER_ORDER, *SEAM_READERS):
            raise BadFile(f"section {i} of the .lr file has an unknown kind or coding")
        if layout & ~LAYOUT_BITS.get(kind, 0) or name_length and kind not in LAYOUT_BITS:
            raise BadFile(f"section {i} of the .lr file has bits set that should be 0")
        end = offset + size
        out.append((kind, contents, layout, name_length))
    if end != len(data):
        raise BadFile("something lies after the last section of the .lr file")
    return out


class Attributes:
    """Reads attributes. Storage form needs the connectivity and seams: `slots`, the triangles of vertices; `copy_slots`, those
    of copies; `vertex_of`, the vertex of each copy."""

    def __init__(self, data, slots=(), copy_slots=(), vertex_of=None):
        self.vertices, _, self.copies = struct.unpack_from("<3I", data, 12)
        self.triangles, self.copy_triangles = ([t for t in all_slots if t] for all_slots in (slots, copy_slots))
        self.vertex_of = vertex_of
        self.positions = None  # integers of the first attribute after it is read

    def read_all(self, parts):
        """Reads all attributes in the file's order, each with whether it has a value per copy. `parts`: the file's sections."""
        parts = [part for part in parts if part[0] in LAYOUT_BITS]
        out = [self.read(*part, is_first=i == 0) for i, part in enumerate(parts)]
        per_copy = [layout & PER_COPY != 0 for _, _, layout, _ in parts]
        if not out or (out[0].name, out[0].components, out[0].normalized) != ("POSITION", 3, False) or out[0].type < 6:
            raise BadFile("the first attribute of the .lr file is not POSITION")
        if not all(map(math.isfinite, array.array(TYPES[out[0].type], out[0].values))):
            raise BadFile("a position is not finite")
        if per_copy[0]:
            raise BadFile("copies have positions")
        return out, per_copy

    def read(self, kind, contents, layout, name_length, is_first=False):
        per_copy = layout & PER_COPY != 0
        if per_copy and self.copies == 0:
            raise BadFile("an attribute of copies where there are none")
        vertices = self.copies if per_copy else self.vertices
        begin = (name_length + 7) // 8 * 8
        if len(contents) < begin or any(contents[name_length:begin]):
            raise BadFile("the name of an attribute is not followed by zeros")
        name, values = contents[:name_length].decode("latin-1"), contents[begin:]
        if kind != ATTRIBUTE:
            stream = self.stored(values, vertices, per_copy) if kind == STORED_VERTICES else read_vertices(values)
            if stream.vertices != vertices:
                raise BadFile("a vertex stream of the .lr file has another number of vertices")
            if is_first and stream.n == 3 and stream.mapping in (LATTICE, DECIMALS) and not per_copy:
                self.positions = stream.integers
            return Attribute(name, stream.type, stream.components, stream.normalized, layout & V_UP != 0, stream.values)
        kind, components = layout & 255, layout >> 8 & 255
        if kind >= len(TYPES) or components == 0:
            raise BadFile("an attribute has no values, or an unknown type")
        if len(values) != vertices * components * struct.calcsize("<" + TYPES[kind]):
            raise BadFile("an attribute has not one entry for each vertex")
        return Attribute(name, kind, components, layout & NORMALIZED != 0, layout & V_UP != 0, values)

    def stored(self, values, vertices, per_copy):
        if len(values) % 4:
            raise BadFile("stored vertices that are not a whole number of words")
        triangles = self.copy_triangles if per_copy else self.triangles
        return read_stored_vertices(array.array("I", values), vertices, triangles, self.positions,
                                    self.vertex_of if per_copy else None)


def order(parts, kind):
    """The file's vertex or corner order, or None."""
    found = [array.array("I", contents) for k, contents, _, _ in parts if k == kind and contents]
    if len(found) > 1:
        raise BadFile("an order is there twice")
    return found[0] if found else None


def copies_of(data, parts, slots, vertices):
    """The copy of each corner of the slots, and the vertex of each copy; None without seams."""
    found = [(kind, contents) for kind, contents, _, _ in parts if kind in SEAM_READERS and contents]
    copies, = struct.unpack_from("<I", data, 20)
    if len(found) != (copies > 0):
        raise BadFile("the .lr file has seams without copies, or copies without seams")
    if not found:
        return slots, None
    (kind, contents), = found
    slots, vertex_of = SEAM_READERS[kind](contents, slots, vertices)
    if len(vertex_of) != copies:
        raise BadFile("seams and file have different numbers of copies")
    return slots, vertex_of


def read_lr(data):
    """The mesh of the copies, with extra vertices. `copies` maps extra vertices to the first copies of their originals."""
    parts = sections(data)
    vertices, triangles = struct.unpack_from("<II", data, 12)
    streams = [(kind, contents) for kind, contents, _, _ in parts if kind in DECODERS]
    if len(streams) != 1:
        raise BadFile("the .lr file has not one connectivity section")
    kind, contents = streams[0]
    numbered, slots, extra = DECODERS[kind](array.array("I", contents))
    if numbered != vertices:
        raise BadFile("the .lr file's connectivity has another number of vertices")
    copy_slots, vertex_of = copies_of(data, parts, slots, vertices)
    all_attributes, per_copy = Attributes(data, slots, copy_slots, vertex_of).read_all(parts)
    slots, vertex_of = copy_slots, range(vertices) if vertex_of is None else vertex_of
    for attribute, own in zip(all_attributes, per_copy):
        if not own:
            size = attribute.components * struct.calcsize("<" + TYPES[attribute.type])
            attribute.values = b"".join(attribute.values[size * v:size * v + size] for v in vertex_of)
    positions = split_keys(all_attributes[0].values, {6: 12, 7: 24}[all_attributes[0].type])
    first = {}
    for copy, v in enumerate(vertex_of):
        first.setdefault(v, copy)
    copies = {copy: first[extra[v]] for copy, v in enumerate(vertex_of) if v in extra}
    indices = [v for slot in slots for v in slot]
    if 3 * triangles < len(indices):
        raise BadFile("the .lr file has more triangles than it was made from")
    if any(positions[copy] != positions[original] for copy, original in copies.items()):
        raise BadFile("an extra vertex is not where its original is")
    mesh = Mesh(positions, indices)
    mesh.attributes, mesh.copies = all_attributes, copies
    mesh.vertex_order, mesh.corner_order = (order(parts, kind) for kind in (VERTEX_ORDER, CORNER_ORDER))
    if mesh.vertex_order is not None:
        kept = sorted(v for i, v in enumerate(mesh.vertex_order) if i not in copies)
        if len(mesh.vertex_order) != len(vertex_of) or kept != list(range(len(kept))):
            raise BadFile("the vertex order is no permutation")
        numbers = [set() for _ in range(vertices)]
        for copy, v in enumerate(vertex_of):
            numbers[v].add(mesh.vertex_order[copy])
        if any(not numbers[v] <= numbers[original] for v, original in extra.items()):
            raise BadFile("an extra vertex has not its original's number")
    if mesh.corner_order is not None:
        used = set(corner // 3 for corner in mesh.corner_order)
        if len(used) != len(mesh.corner_order) or 3 * len(used) != len(indices) or any(t >= triangles for t in used):
            raise BadFile("the corner order does not fit the triangles")
    return mesh
