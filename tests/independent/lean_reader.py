"""The lean stream, decoded by its document (docs/lean-format.md) alone."""

import zlib

from mesh_readers import BadFile

TIP_MASK, WART, CLOSE, FLIP = 0x1FFFFFFF, 0x80000000, 0x40000000, 0x20000000


def decode_lean(words):
    """The number of vertices, and a flat list of the triangles that are not degenerate. `words`: the whole stream."""
    vertices, slots = decode_lean_slots(words)
    return vertices, [v for slot in slots for v in slot]


def decode_lean_slots(words):
    """The number of vertices, and the triangle of each slot, () if it has none."""
    if len(words) < 8 or words[0] != 0x4E4C524C or words[1] != 1:
        raise BadFile("not a lean stream of version 1")
    vertices, rings2, rings1, verbatim, triangles, checksum = words[2:8]
    payload = words[8:]
    ring_slots = 2 * rings2 + rings1
    if vertices > TIP_MASK + 1 or rings2 + rings1 > vertices:
        raise BadFile("more vertices than references name, or more ring vertices than vertices")
    if len(payload) != ring_slots + 3 * verbatim:
        raise BadFile(f"the lean stream has {len(payload)} payload words, its header says {ring_slots + 3 * verbatim}")
    if zlib.crc32(payload.tobytes(), zlib.crc32(words[:7].tobytes())) != checksum:
        raise BadFile("the lean stream's checksum is wrong")

    # next(v) of every ring vertex is v + 1, except at the end of a ring.
    following = list(range(1, rings2 + rings1 + 1))
    first = 0
    for v in range(rings2 + rings1):
        slots = payload[2 * v:2 * v + 2] if v < rings2 else payload[v + rings2:v + rings2 + 1]
        closing = [w for w in slots if w & CLOSE]
        if not closing:
            continue
        if closing != [first | CLOSE] or v - first < 2:
            raise BadFile(f"ring vertex {v} does not close its ring as it should")
        following[v] = first
        if first < rings2 <= v:
            raise BadFile("a ring is two-sided and one-sided")
        first = v + 1
    if first != rings2 + rings1:
        raise BadFile("the last ring does not close")

    out = []
    for i in range(ring_slots):
        w = payload[i]
        out.append(())
        if w & CLOSE:
            continue
        v = i >> 1 if i < 2 * rings2 else i - rings2
        left = i >= 2 * rings2 or i % 2 == 0
        tip = w & TIP_MASK
        b = following[v]
        if w == (v if left else b):
            continue  # a slot without a triangle
        if w & WART:
            b = following[b]
        if tip == v or tip == b:
            raise BadFile(f"slot {i} is degenerate, and not as a free one is")
        start, third = (v, b) if left else (b, v)
        if w & FLIP:
            start, third = third, start
        out[i] = (start, tip, third)
    for i in range(ring_slots, len(payload), 3):
        if len(set(payload[i:i + 3])) != 3:
            raise BadFile("a verbatim triangle is degenerate")
        out.append(tuple(payload[i:i + 3]))
    if sum(map(bool, out)) != triangles:
        raise BadFile(f"the lean stream has {sum(map(bool, out))} triangles, its header says {triangles}")
    if max(map(max, filter(None, out)), default=-1) >= vertices:
        raise BadFile("a vertex of the lean stream is out of range")
    return vertices, out
