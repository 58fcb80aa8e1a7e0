"""The LR tables, standard and bit-efficient, read by their document (docs/lr-tables.md) alone."""

import zlib

from mesh_readers import BadFile

NULL = 0xFFFFFFFF
TIP_MASK, SPECIAL, FLIP, IRREGULAR, WART = 0x0FFFFFFF, 1 << 28, 1 << 29, 1 << 30, 1 << 31
TRIANGLE, REDUNDANT, CLOSING, BORDER = range(4)


class Tables:
    """Slot s = 2 v + side has kind[s], tip[s], flags[s] (FLIP, WART) and, if irregular, opposites[s] = (start, end)."""

    def __init__(self, words, compact):
        magic = 0x4243524C if compact else 0x5443524C
        if len(words) < 10 or words[0] != magic or words[1] != 1:
            raise BadFile("not LR tables of version 1")
        self.vertices, self.ring, self.t0, extra, isolated, copies, self.unit = words[2:9]
        if self.unit not in (range(2, 4097, 2) if compact else (0,)):
            raise BadFile("the LR tables have a wrong unit")
        if zlib.crc32(words[10:].tobytes(), zlib.crc32(words[:9].tobytes())) != words[9]:
            raise BadFile("the LR tables' checksum is wrong")
        arrays = []
        at = 10
        for size in (self.ring * (1 if compact else 2), 6 * self.t0, extra, isolated, 2 * copies):
            arrays.append(words[at:at + size])
            at += size
        if at != len(words):
            raise BadFile("the LR tables' size is not what their header says")
        slots, self.vo, self.extra, self.isolated, copies = arrays
        self.copies = dict(zip(copies[::2], copies[1::2]))
        if 2 * len(self.copies) != len(copies):
            raise BadFile("a vertex of the LR tables is copied twice")
        self.kind, self.tip, self.flags, self.opposites = [], [], [], {}
        if compact:
            for v, word in enumerate(slots):
                self.add_compact(v, word)
        else:
            for word in slots:
                self.add_word(word, word & TIP_MASK, word & TIP_MASK)
        self.link_rings()
        self.check_pairs()

    def add_slot(self, kind, tip, flags):
        self.kind.append(kind)
        self.tip.append(tip)
        self.flags.append(flags)

    def add_word(self, word, index, tip):
        """Adds a slot by its standard word. index: where an irregular slot's tip and opposites begin in the extra words; None if `tip` is its tip."""
        s = len(self.kind)
        if word & SPECIAL:
            kinds = {0: REDUNDANT, WART: CLOSING, IRREGULAR: BORDER}
            kind = kinds.get(word & (IRREGULAR | WART))
            if kind is None:
                raise BadFile(f"slot {s} is not valid")
            self.add_slot(kind, tip, 0)
        elif word & IRREGULAR and index is not None:
            if index + 3 > len(self.extra):
                raise BadFile(f"slot {s} has no record")
            self.opposites[s] = (self.extra[index + 1], self.extra[index + 2])
            self.add_slot(TRIANGLE, self.extra[index], word & (FLIP | WART))
        else:
            self.add_slot(TRIANGLE, tip, word & (FLIP | WART))

    def add_compact(self, v, word):
        if not (word >> 31 and word >> 15 & 1):
            for half in (word >> 16, word & 0xFFFF):
                offset = half & 0x7FFF
                wart = half >> 15
                tip = (v + offset - (offset >> 14 << 15)) % self.ring
                kind = {0: BORDER, 2: REDUNDANT}.get(offset, TRIANGLE) if not wart else TRIANGLE
                self.add_slot(kind, tip, WART if wart else 0)
            return
        at = ((word & 0x7FFF) | (word >> 16 & 0x7FF) << 15) * self.unit
        pair = self.extra[at:at + 2]
        if len(pair) < 2:
            raise BadFile(f"ring vertex {v} has no record")
        at += 2
        for side, entry in enumerate(pair):
            wart, irregular = word >> 30 - side & 1, word >> 28 - side & 1
            flags = 0 if entry & SPECIAL else entry & (IRREGULAR | WART)
            if flags != wart << 31 | irregular << 30:
                raise BadFile(f"ring vertex {v} and its record differ in flags")
            self.add_word(entry, None, entry & TIP_MASK)
            if irregular:
                if at + 2 > len(self.extra):
                    raise BadFile(f"ring vertex {v} has no whole record")
                self.opposites[len(self.kind) - 1] = (self.extra[at], self.extra[at + 1])
                at += 2

    def link_rings(self):
        """Finds v.n and v.p; a ring ends at a closing slot. Then makes closing slots redundant."""
        self.next = list(range(1, self.ring + 1))
        self.previous = list(range(-1, self.ring - 1))
        first = 0
        for v in range(self.ring):
            if self.kind[2 * v + 1] == CLOSING:
                raise BadFile("a closing slot is on the right")
            if self.kind[2 * v] != CLOSING:
                continue
            if self.tip[2 * v] != first or v - first < 2:
                raise BadFile("a closing slot does not name its ring's first vertex")
            if self.kind[2 * first] != TRIANGLE or self.tip[2 * first] != v:
                raise BadFile("a ring does not begin after its closing slot")
            self.next[v], self.previous[first] = first, v
            first = v + 1
        if first != self.ring:
            raise BadFile("the last ring does not close")
        for s, kind in enumerate(self.kind):
            after = self.next[self.next[s >> 1]]
            if kind == CLOSING:
                self.kind[s], self.tip[s] = REDUNDANT, after
            elif kind == REDUNDANT and self.tip[s] != after:
                raise BadFile(f"slot {s} is redundant, and its tip is not two further")

    def check_pairs(self):
        """Checks that a first copy of a T2, or a T0w in its place, is followed by the second copy, or is in a ring of three copies."""
        for s, kind in enumerate(self.kind):
            if kind == REDUNDANT or (kind == TRIANGLE and self.flags[s] & WART):
                v, behind = s >> 1, 2 * self.next[s >> 1] + s % 2
                third = 2 * self.next[behind >> 1] + s % 2
                whole = kind == self.kind[behind] == REDUNDANT and self.next[third >> 1] == v
                if whole and self.kind[third] == TRIANGLE:
                    continue
                if self.kind[behind] != TRIANGLE or self.flags[behind] & WART or self.tip[behind] != v:
                    raise BadFile(f"after slot {s} is not the second copy of a T2")

    def end(self, s):
        """The vertex at which a slot's triangle ends."""
        after = self.next[s >> 1]
        return self.next[after] if self.flags[s] & WART else after

    def triangles(self):
        """(number, three vertices, flipped) of all canonical triangles, ordered by number."""
        for s, kind in enumerate(self.kind):
            if kind == TRIANGLE:
                v, end = s >> 1, self.end(s)
                yield s, ((v, self.tip[s], end) if s % 2 == 0 else (end, self.tip[s], v)), self.flags[s] & FLIP != 0
        for i in range(self.t0):
            a, b, c = self.vo[6 * i:6 * i + 3]
            yield 2 * self.ring + i, (a & 0x7FFFFFFF, b, c), a >> 31 == 1


def decode_tables(tables):
    """The number of vertices, a flat list of triangles, and a dict from copies to originals."""
    triangles = list(tables.triangles())
    used = tables.ring + len(tables.isolated)
    for _, corners, _ in triangles:
        if max(corners) >= used or len({tables.copies.get(v, v) for v in corners}) != 3:
            raise BadFile("a triangle of the LR tables is degenerate or has a vertex out of range")
    if used > tables.vertices:
        raise BadFile("the LR tables have more vertices in use than vertices")
    if any(copy >= used or original >= used or original in tables.copies for copy, original in tables.copies.items()):
        raise BadFile("a copy of the LR tables is none")
    out = []
    for _, (a, b, c), flipped in triangles:
        out += (c, b, a) if flipped else (a, b, c)
    return tables.vertices, out, tables.copies
