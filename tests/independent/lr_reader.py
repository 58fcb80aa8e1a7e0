"""The .lr file and the lean stream, decoded by their documents (docs/lr-file.md, docs/lean-format.md) alone."""

import array
import struct
import zlib

from mesh_readers import BadFile, Mesh, split_keys

TIP_MASK, WART, CLOSE, FLIP = 0x1FFFFFFF, 0x80000000, 0x40000000, 0x20000000


def decode_lean(words):
    """Vertices, and the triangles that are not degenerate, flat. `words`: the whole stream, header included."""
    if len(words) < 8 or words[0] != 0x4E4C524C or words[1] != 1:
        raise BadFile("not a lean stream of version 1")
    vertices, rings2, rings1, verbatim, triangles, checksum = words[2:8]
    payload = words[8:]
    ring_slots = 2 * rings2 + rings1
    if len(payload) != ring_slots + 3 * verbatim:
        raise BadFile(f"the lean stream has {len(payload)} payload words, its header says {ring_slots + 3 * verbatim}")
    if zlib.crc32(payload.tobytes(), zlib.crc32(words[:7].tobytes())) != checksum:
        raise BadFile("the lean stream's checksum is wrong")

    # next(v) of every ring vertex: the one after it, but for the last of a ring
    following = list(range(1, rings2 + rings1 + 1))
    for v in range(rings2):
        for w in (payload[2 * v], payload[2 * v + 1]):
            if w & CLOSE:
                following[v] = w & TIP_MASK
                break
    for v in range(rings2, rings2 + rings1):
        w = payload[v + rings2]
        if w & CLOSE:
            following[v] = w & TIP_MASK

    out = []
    for i in range(ring_slots):
        w = payload[i]
        if w & CLOSE:
            continue
        v = i >> 1 if i < 2 * rings2 else i - rings2
        tip = w & TIP_MASK
        b = following[v]
        if w & WART:
            b = following[b]
        if tip == v or tip == b:
            continue
        first, third = (v, b) if i >= 2 * rings2 or i % 2 == 0 else (b, v)
        if w & FLIP:
            first, third = third, first
        out += (first, tip, third)
    out += payload[ring_slots:]
    if len(out) != 3 * triangles:
        raise BadFile(f"the lean stream has {len(out) // 3} triangles, its header says {triangles}")
    if out and max(out) >= vertices:
        raise BadFile("a vertex of the lean stream is out of range")
    return vertices, out


def read_lr(data):
    header = struct.unpack_from("<8I", data)
    magic, version, count, vertices, _, _, table_crc, header_crc = header
    if magic != 0x4C46524C or version != 1:
        raise BadFile("not an .lr file of version 1")
    if zlib.crc32(data[:28]) != header_crc or zlib.crc32(data[32:32 + 32 * count]) != table_crc:
        raise BadFile("the .lr file's header is damaged")
    lean = None
    positions = None
    for i in range(count):
        kind, crc, offset, size, layout, name_length = struct.unpack_from("<IIQQII", data, 32 + 32 * i)
        contents = data[offset:offset + size]
        if len(contents) != size or zlib.crc32(contents) != crc:
            raise BadFile(f"section {i} of the .lr file is damaged")
        if kind == 1:
            lean = array.array("I", contents)
        elif kind == 2 and contents[:name_length] == b"POSITION":
            width = {6: 12, 7: 24}[layout & 0xFF]
            positions = split_keys(contents[(name_length + 7) // 8 * 8:], width)
    if lean is None or positions is None:
        raise BadFile("the .lr file lacks a stream or positions")
    numbered, indices = decode_lean(lean)
    if numbered != vertices or len(positions) != vertices:
        raise BadFile("the .lr file's parts differ in the number of vertices")
    return Mesh(positions, indices)
