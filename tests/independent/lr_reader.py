"""The .lr file, read by its document (docs/lr-file.md) alone. The streams in it have a reader each."""

import array
import struct
import zlib

from lean_reader import decode_lean
from lr_corners import check_corners
from lr_tables_reader import Tables, decode_tables
from mesh_readers import BadFile, Mesh, split_keys
from packed_reader import decode_packed

ATTRIBUTE, VERTEX_ORDER, CORNER_ORDER = 2, 3, 4


def tables_in(words, compact):
    tables = Tables(words, compact)
    out = decode_tables(tables)
    check_corners(tables)
    return out


# Each takes all words of a stream and returns its vertices, its triangles, flat, and a dict from copies to originals.
DECODERS = {1: lambda words: (*decode_lean(words), {}), 5: lambda words: tables_in(words, False),
            6: lambda words: tables_in(words, True), 7: lambda words: (*decode_packed(words), {})}


def sections(data):
    """(kind, contents, layout, length of the name) of each section."""
    magic, version, count, _, _, zero, table_crc, header_crc = struct.unpack_from("<8I", data)
    if magic != 0x4C46524C or version != 2 or zero != 0:
        raise BadFile("not an .lr file of version 2")
    if zlib.crc32(data[:28]) != header_crc or zlib.crc32(data[32:32 + 32 * count]) != table_crc:
        raise BadFile("the .lr file's header is damaged")
    end = 32 + 32 * count
    out = []
    for i in range(count):
        kind, crc, offset, size, layout, name_length = struct.unpack_from("<IIQQII", data, 32 + 32 * i)
        contents = data[offset:offset + size]
        if len(contents) != size or zlib.crc32(contents) != crc:
            raise BadFile(f"section {i} of the .lr file is damaged")
        if offset != end + -end % 8 or any(data[end:offset]):
            raise BadFile(f"section {i} of the .lr file is not where it should be")
        end = offset + size
        out.append((kind, contents, layout, name_length))
    if end != len(data):
        raise BadFile("something lies behind the last section of the .lr file")
    return out


def order(parts, kind):
    """What the file keeps of the order of the mesh that it was made from, or None."""
    found = [array.array("I", contents) for k, contents, _, _ in parts if k == kind and contents]
    if len(found) > 1:
        raise BadFile("an order is there twice")
    return found[0] if found else None


def read_lr(data):
    parts = sections(data)
    vertices, triangles = struct.unpack_from("<II", data, 12)
    if any(kind not in DECODERS and kind not in (ATTRIBUTE, VERTEX_ORDER, CORNER_ORDER) for kind, *_ in parts):
        raise BadFile("the .lr file has a section of unknown kind")
    streams = [(kind, contents) for kind, contents, _, _ in parts if kind in DECODERS]
    attributes = [part[1:] for part in parts if part[0] == ATTRIBUTE]
    if len(streams) != 1 or not attributes:
        raise BadFile("the .lr file has not one stream, or no attribute")
    contents, layout, name_length = attributes[0]
    if contents[:name_length] != b"POSITION":
        raise BadFile("the first attribute of the .lr file is not POSITION")
    positions = split_keys(contents[(name_length + 7) // 8 * 8:], {0x306: 12, 0x307: 24}[layout])
    kind, contents = streams[0]
    numbered, indices, copies = DECODERS[kind](array.array("I", contents))
    if 3 * triangles < len(indices):
        raise BadFile("the .lr file has more triangles than it was made from")
    if numbered != vertices or len(positions) != vertices:
        raise BadFile("the .lr file's parts differ in the number of vertices")
    if any(positions[copy] != positions[original] for copy, original in copies.items()):
        raise BadFile("a copy is not where its original is")
    mesh = Mesh(positions, [copies.get(v, v) for v in indices])
    mesh.vertex_order, mesh.corner_order = (order(parts, kind) for kind in (VERTEX_ORDER, CORNER_ORDER))
    if mesh.vertex_order is not None:
        kept = sorted(v for i, v in enumerate(mesh.vertex_order) if i not in copies)
        if len(mesh.vertex_order) != vertices or kept != list(range(len(kept))):
            raise BadFile("the vertex order is no permutation")
        if any(mesh.vertex_order[copy] != mesh.vertex_order[original] for copy, original in copies.items()):
            raise BadFile("a copy has not its original's number")
    if mesh.corner_order is not None:
        used = set(corner // 3 for corner in mesh.corner_order)
        if len(used) != len(mesh.corner_order) or 3 * len(used) != len(indices) or any(t >= triangles for t in used):
            raise BadFile("the corner order does not fit the triangles")
    return mesh
