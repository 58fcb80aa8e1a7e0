"""The packed stream, decoded by its document (docs/packed-format.md) alone."""

import zlib

from mesh_readers import BadFile

WORD = 0xFFFFFFFF
WART, SPLIT, BESIDE, START, FAR, JUMP, END, TURN = range(8)


class EndOfRecord(Exception):
    pass


class Bits:
    """Fields of a record, from its lowest bit."""

    def __init__(self, record):
        self.rest = int.from_bytes(record, "little")
        self.left = 8 * len(record)

    def take(self, bits):
        if bits > self.left:
            raise BadFile("a record of the packed stream ends within a field")
        value = self.rest & (1 << bits) - 1
        self.rest >>= bits
        self.left -= bits
        return value

    def unary(self, limit=None):
        ones = 0
        while ones != limit:
            if self.left == 0:
                raise EndOfRecord
            if self.take(1) == 0:
                break
            ones += 1
        return ones

    def golomb(self, k):
        """EG(k)."""
        low = self.unary(31 - k) + k
        return (1 << low | self.take(low)) - (1 << k)


class Walk:
    """The state of a record's reader, and what each event does to it."""

    def __init__(self, bits, width):
        self.bits = bits
        self.width = width
        self.a, self.b = bits.take(width), bits.take(width)
        self.reversed = bits.take(1)
        self.begun = (self.a, self.b, self.reversed)
        self.stack = []
        self.finished = False
        self.second = None  # of a wart's two triangles, when the first has just come out
        self.turn_before = 0

    def begin(self, a, b, is_reversed):
        self.a, self.b, self.reversed = a & WORD, b & WORD, is_reversed
        self.begun = (self.a, self.b, is_reversed)
        self.finished = False

    def push(self, a, b):
        self.stack = (self.stack + [(a, b)])[-16:]

    def before(self, event):
        """An event that comes before a triangle."""
        if self.second is not None:
            raise BadFile("an event is between the two triangles of a wart")
        if event == TURN:
            self.reversed ^= 1
            return
        if event == BESIDE:
            turned, place, folded = self.bits.take(1), self.bits.take(2), self.bits.golomb(1)
            step, other = -(folded + 1 >> 1) if folded & 1 else folded >> 1, self.bits.take(self.width)
            near = (self.b, self.a, self.begun[0], self.begun[1])[place] + step
            self.begin(*((near, other) if place in (0, 2) else (other, near)), self.reversed ^ turned)
            self.stack = []
        elif event == START:
            kind = self.bits.unary(3)
            a, b, was_reversed = self.begun
            if kind == 0:
                self.begin(a, b, was_reversed ^ 1)
            elif kind == 3:
                self.begin(self.bits.take(self.width), self.bits.take(self.width), self.bits.take(1))
            else:
                a = b + 1 if kind == 1 else b + self.bits.golomb(2)
                self.begin(a, a + 2 + self.bits.golomb(2), 0 if kind == 1 else was_reversed)
            self.stack = []
        elif not self.stack:
            raise BadFile("END, and nothing on the stack")
        else:
            self.a, self.b = self.stack.pop()
            self.finished = False

    def triangle(self, event, turn):
        """The next triangle: its lowest, middle and highest corner, as the polygon has them."""
        if self.second is not None:
            if event is not None or turn != self.turn_before:
                raise BadFile("the second triangle of a wart is not as it should be")
            out, self.second = self.second, None
            return out
        if self.finished and self.stack:
            self.a, self.b = self.stack.pop()
            self.finished = False
        elif self.finished:
            a, b, was_reversed = self.begun
            self.begin(b + 1, b + 1 + b - a, self.reversed)
            self.begun = (self.a, self.b, was_reversed)
        a, b = self.a, self.b
        if event is None:
            x = a + 1 if turn else b - 1
            self.a, self.b = (x, b) if turn else (a, x)
            self.finished = (self.b - self.a) & WORD == 1
            if self.finished and turn != self.turn_before:
                raise BadFile("the turn of a corridor's last triangle is not that of the one before")
        elif event == WART:
            if (b - a) & WORD < 4:
                raise BadFile("a wart is as large as its polygon")
            x = a + 2 if turn else b - 2
            self.second = (a, a + 1 & WORD, x & WORD) if turn else (x & WORD, b - 1 & WORD, b)
            self.a, self.b = (x, b) if turn else (a, x)
        elif event == JUMP:
            size = 2 + self.bits.golomb(1)
            x = a + size if turn else b - size
            self.a, self.b = (x, b) if turn else (a, x)
        else:
            across = 3
            if event == SPLIT:
                size = 3 + self.bits.golomb(2)
                x = a + size if turn else b - size
            else:
                across, x = self.bits.take(2), self.bits.take(self.width)
                if turn and across != 3:
                    raise BadFile("FAR has a turn that means nothing")
            self.finished = across == 0
            if across == 2 or (across == 3 and not turn):
                self.a, self.b = x, b
            else:
                self.a, self.b = a, x
            if across == 3:
                self.push(*((x, b) if turn else (a, x)))
        self.a &= WORD
        self.b &= WORD
        return a, x & WORD, b


def read_event(bits, gap_bits):
    """A gap and a code, or None behind the last event."""
    left = bits.left
    try:
        gap = bits.unary() << gap_bits
    except EndOfRecord:
        if left >= 8:
            raise BadFile("a record of the packed stream is filled up with more than a byte") from None
        return None
    gap |= bits.take(gap_bits)
    return gap, bits.unary(7)


def walk_record(record, turns, header, out):
    """The triangles of one record, a turn each."""
    width, gap_bits = header
    bits = Bits(record)
    walk = Walk(bits, width)
    at = 0
    event = read_event(bits, gap_bits)
    if event is not None:
        at += event[0]
    for i, turn in enumerate(turns):
        own = None
        while event is not None and at == i:
            if event[1] in (BESIDE, START, END, TURN):
                if own is not None:
                    raise BadFile("an event is behind the one that says where its triangle is")
                walk.before(event[1])
            elif own is not None:
                raise BadFile("two events say where one triangle is")
            else:
                own = event[1]
                corners = walk.triangle(own, turn)
            event = read_event(bits, gap_bits)
            if event is not None:
                at += event[0]
        if own is None:
            corners = walk.triangle(None, turn)
        walk.turn_before = turn
        low, middle, high = corners
        out += (low, middle, high) if walk.reversed else (low, high, middle)
    if event is not None:
        raise BadFile("an event is behind the last triangle of its record")


def decode_block(length, take, turns, header, out):
    """`take(n)` gives the next n bytes of records."""
    n = len(turns)
    if length <= 160:
        walk_record(take(length), turns, header, out)
    elif length < 255:
        data = take(8 * (length - 160))
        at = 4
        for i, size in enumerate(data[:4]):
            part = turns[64 * i:64 * i + 64]
            if size > 160 or (size != 0) != bool(part):
                raise BadFile("the lengths of a block's four records are wrong")
            if part:
                walk_record(data[at:at + size], part, header, out)
            at += size
        if not at <= len(data) < at + 8 or any(data[at:]):
            raise BadFile("a block's four records are not followed by zeros")
    else:
        bits = Bits(take((3 * n * header[0] + 7) // 8))
        out += [bits.take(header[0]) for _ in range(3 * n)]
        if any(turns) or bits.rest != (1 << bits.left) - 1:
            raise BadFile("a plain block has turns, or is not filled up with ones")


def decode_packed(words):
    """Vertices, and all triangles, flat. `words`: the whole stream, header included."""
    if len(words) < 8 or words[0] != 0x4B50524C or words[1] != 1 or words[6] != 0:
        raise BadFile("not a packed stream of version 1")
    vertices, triangles, record_bytes = words[2:5]
    header = (words[5] & 0xFF, words[5] >> 8)
    if not 1 <= header[0] <= 31 or not 3 <= header[1] <= 7:
        raise BadFile("the packed stream's field widths are out of range")
    if zlib.crc32(words[8:].tobytes(), zlib.crc32(words[:7].tobytes())) != words[7]:
        raise BadFile("the packed stream's checksum is wrong")
    blocks = (triangles + 255) // 256
    turn_words = (triangles + 31) // 32
    directory_words = (blocks + 3) // 4 + (blocks + 15) // 16
    at = 8 + turn_words + directory_words
    if len(words) != at + (record_bytes + 3) // 4 + 2:
        raise BadFile("the packed stream's size is not what its header says")
    turn_bits = int.from_bytes(words[8:8 + turn_words].tobytes(), "little")
    if turn_bits >> triangles:
        raise BadFile("there are turns behind the last triangle")
    turns = [bit == "1" for bit in reversed(f"{turn_bits:0{triangles}b}")] if triangles else []
    directory = words[8 + turn_words:at].tobytes()
    if any(directory[len(directory) - -blocks % 4:]):
        raise BadFile("there are lengths behind the last block's")
    records = words[at:].tobytes()
    if any(records[record_bytes:]):
        raise BadFile("there is something behind the last record")

    out = []
    place = 0

    def take(size):
        nonlocal place
        place += size
        if place > record_bytes:
            raise BadFile("a record is behind the last one")
        return records[place - size:place]

    for k in range(blocks):
        group = directory[k // 16 * 20:k // 16 * 20 + 20]
        if k % 16 == 0 and int.from_bytes(group[:4], "little") != place:
            raise BadFile("the records are not without gaps")
        try:
            decode_block(group[4 + k % 16], take, turns[256 * k:256 * k + 256], header, out)
        except EndOfRecord:
            raise BadFile("a record of the packed stream ends within a field") from None
    if place != record_bytes:
        raise BadFile("the records are not as long as the header says")
    if out and max(out) >= vertices:
        raise BadFile("a vertex of the packed stream is out of range")
    corners = iter(out)
    if any(a == b or b == c or c == a for a, b, c in zip(corners, corners, corners)):
        raise BadFile("a triangle of the packed stream is degenerate")
    return vertices, out
