"""The packed stream, version 2, decoded by its document (docs/packed-format.md) alone.

decode_packed decodes and validates a whole stream; read_triangle finds one triangle of a valid stream.
"""

import zlib
from bisect import bisect_right

from mesh_readers import BadFile

WORD = 0xFFFFFFFF
MAGIC, MAGIC_1 = 0x3250524C, 0x4B50524C
SPLIT, BESIDE, START, FAR, JUMP, TURN, FLIPS = range(7)
THIRD_VERTEX = (SPLIT, FAR, JUMP)  # events that name a triangle's third vertex
PARTED, PLAIN = 1, 2  # kinds of blocks; kind 0 is a single record
HIGH = 1 << 31  # in the word of vertices: there are doubles; in a run: its doubles are flipped
HEAD_BYTES = 192  # a group's head has at most 32 + 15 + 16 * 59 + 2 * 16 + 16 * 16 + 15 * 12 bits


class Bits:
    """Reads fields of a byte string, from its lowest bit."""

    def __init__(self, data):
        self.rest = int.from_bytes(data, "little")
        self.left = 8 * len(data)

    def take(self, bits):
        if bits > self.left:
            raise BadFile("the packed stream ends within a field")
        value = self.rest & (1 << bits) - 1
        self.rest >>= bits
        self.left -= bits
        return value

    def unary(self, limit=None):
        ones = 0
        while ones != limit and self.take(1):
            ones += 1
        return ones

    def rice(self, k):
        high = self.unary()
        if high > 31:
            raise BadFile("a Rice code of the packed stream has more than 31 ones")
        return high << k | self.take(k)

    def golomb(self, k):
        """Exponential Golomb code of order k."""
        low = self.unary(31 - k) + k
        return (1 << low | self.take(low)) - (1 << k)

    def entry(self, width):
        return self.take(width), self.take(width), self.take(1)

    def only_ones(self):
        return self.rest == (1 << self.left) - 1


class Header:
    """The stream's header and the positions of its parts. `triangles`, `doubles`, `runs`: the numbers of own triangles,
    of doubles, and of runs of doubles."""

    def __init__(self, words):
        if len(words) >= 1 and words[0] == MAGIC_1:
            raise BadFile("a packed stream of version 1, which is not read any more; version 2 is")
        if len(words) < 4 or words[0] != MAGIC:
            raise BadFile("not a packed stream of version 2")
        self.vertices, self.triangles = words[1] & ~HIGH, words[2]
        if self.vertices > 1 << 29 or self.triangles > WORD // 3:
            raise BadFile("the packed stream has too many vertices or triangles")
        self.width = max((self.vertices - 1).bit_length(), 1) if self.vertices else 1
        self.blocks = (self.triangles + 255) // 256
        self.groups = (self.blocks + 15) // 16
        self.table = 4 + (self.triangles + 31) // 32
        self.first_group = self.table + max(self.groups - 1, 0)
        self.doubles = self.runs = 0
        self.first_run = self.first_group
        if words[1] & HIGH:
            self.first_run += 2
            if len(words) < self.first_run:
                raise BadFile("the packed stream is shorter than its header says")
            self.doubles, self.runs = words[self.first_group:self.first_run]
            if not 1 <= self.doubles <= min(self.triangles, WORD // 3 - self.triangles) or self.runs == 0:
                raise BadFile("the packed stream has no doubles, too many, or no runs of them")
            self.first_group = self.first_run + 2 * self.runs
        if len(words) < self.first_group:
            raise BadFile("the packed stream is shorter than its header says")


class Head:
    """A group's head. `data` begins with it; `blocks` are the group's."""

    def __init__(self, data, blocks, width):
        bits = Bits(data[:HEAD_BYTES])
        self.width = width
        step, offset_bits, self.entry_bits = bits.take(12), bits.take(5), bits.take(4)
        if offset_bits > 16 or self.entry_bits > (12 if blocks > 1 else 0):
            raise BadFile("a group's head has fields of too many bits")
        self.gap_bits, self.wart_bits, self.split_order, self.count_order = (bits.take(n) for n in (3, 3, 2, 2))
        has_kinds = bits.take(1)
        self.own = [0] + [bits.take(1) for _ in range(blocks - 1)]
        self.entries = [bits.entry(width) for _ in range(1 + sum(self.own))]
        self.kinds = [bits.take(2) if has_kinds else 0 for _ in range(blocks)]
        offsets = [bits.take(offset_bits) - (1 << offset_bits) // 2 for _ in range(blocks)]
        self.steps = [0] + [bits.take(self.entry_bits) for _ in range(blocks - 1)]
        fill = bits.left % 8
        if bits.take(fill) != (1 << fill) - 1:
            raise BadFile("a group's head is not filled up with ones")
        size = min(len(data), HEAD_BYTES) - bits.left // 8
        # The records of block k are bytes places[k] to places[k + 1] of the group.
        self.places = [size] + [size + (k + 1) * step + offset for k, offset in enumerate(offsets)]

    def entry(self, k):
        """The entry of block k, which is not plain: its own, or derived from the last preceding block with an own entry."""
        last = max((j for j in range(k + 1) if self.own[j]), default=0)
        a, b, is_reversed = self.entries[sum(self.own[:last + 1])]
        distance = k - last
        if distance == 0:
            return a, b, is_reversed
        to = a + 128 * distance + self.steps[k] - (1 << self.entry_bits) // 2
        return to & WORD, to + (b - a) - 256 * distance & WORD, is_reversed

    def check_blocks(self):
        """Checks the fields of blocks by their kind."""
        if self.kinds[0] == PLAIN and any(self.entries[0]):
            raise BadFile("a group's head has an entry for a plain block")
        for k, kind in enumerate(self.kinds):
            if kind > PLAIN:
                raise BadFile("a block is of kind 3")
            if kind == PLAIN and self.own[k]:
                raise BadFile("a plain block has an entry of its own")
            if self.steps[k] and (kind == PLAIN or self.own[k]):
                raise BadFile("a block that is plain or has its own entry has an entry step that is not 0")
            if kind != PLAIN and self.kinds[0] == PLAIN and not any(self.own[:k + 1]):
                raise BadFile("a block goes on from a plain one")


def read_event(bits, head, triangles):
    """Gap, code, and the numbers that belong to the code."""
    gap, code = bits.rice(head.gap_bits), bits.unary(7)
    if code == SPLIT:
        size = 3 + bits.golomb(head.split_order)
        if size >= 1 << 30:
            raise BadFile("SPLIT has a size of 2^30 or more")
        return gap, code, (size, size - 1)
    if code == BESIDE:
        turned, place, folded = bits.take(1), bits.take(2), bits.golomb(1)
        if folded >= 1 << 30:
            raise BadFile("BESIDE has a step of 2^30 or more")
        return gap, code, (turned, place, -(folded + 1 >> 1) if folded & 1 else folded >> 1, bits.take(head.width))
    if code == START:
        kind = bits.unary(3)
        if kind == 3:
            return gap, code, (kind, *bits.entry(head.width))
        return gap, code, (kind, *(bits.golomb(2) for _ in range(kind)))
    if code == FAR:
        across, x = bits.take(2), bits.take(head.width)
        return gap, code, (across, x, 1 + bits.golomb(2) if across == 3 else 0)
    if code == JUMP:
        size = 2 + bits.golomb(1)
        if size >= 1 << 30:
            raise BadFile("JUMP has a size of 2^30 or more")
        return gap, code, (size, 1 + bits.golomb(2) if bits.take(1) else 0)
    if code == TURN:
        return gap, code, ()
    if code == FLIPS:
        return gap, code, (bits.take(triangles),)
    raise BadFile("an event of the packed stream has code 7")


class Record:
    """A record: its entry, its events (triangle, code, numbers), and its warts as ranks among the candidates."""

    def __init__(self, data, entry, head, triangles):
        bits = Bits(data)
        self.entry = bits.entry(head.width) if entry is None else entry
        self.events, self.warts = [], []
        if entry is not None and not data:
            return
        at = 0
        for i in range(bits.golomb(head.count_order)):
            gap, code, numbers = read_event(bits, head, triangles)
            at += gap + (i > 0 and self.events[-1][1] in THIRD_VERTEX)
            if at >= triangles:
                raise BadFile("an event is after the last triangle of its record")
            if code == FLIPS and (i or at):
                raise BadFile("FLIPS is not the first event, or not at the first triangle")
            self.events.append((at, code, numbers))
        rank = -1
        while not bits.only_ones():
            rank += 1 + bits.rice(head.wart_bits)
            self.warts.append(rank)
        if bits.left >= 8:
            raise BadFile("a record of the packed stream is filled up with more than a byte")
        if entry is not None and not self.events and not self.warts:
            raise BadFile("a record of the packed stream that says nothing has bytes")


# --- All triangles, in turn ---


class Walk:
    """The state of a record's reader, changed by events and turns."""

    def __init__(self, entry, triangles):
        self.a, self.b, self.reversed = self.begun = entry
        self.triangles = triangles
        self.finished = False
        self.scopes = []  # (end, a, b, reversed)

    def close_scopes(self, i):
        """Closes the scopes that end at triangle i; true if there are any."""
        count = len(self.scopes)
        while self.scopes and self.scopes[-1][0] == i:
            _, self.a, self.b, self.reversed = self.scopes.pop()
            self.finished = False
        return len(self.scopes) != count

    def open_scope(self, i, code, count, a, b):
        end = i + count + 1
        if self.scopes and end > self.scopes[-1][0]:
            raise BadFile("a scope ends after the one around it")
        if end < self.triangles:
            self.scopes.append((end, a & WORD, b & WORD, self.reversed))
        elif code != SPLIT:
            raise BadFile("FAR or JUMP has a part that ends after the record")

    def begin(self, a, b, is_reversed):
        self.a, self.b, self.reversed = a & WORD, b & WORD, is_reversed
        if not self.scopes:
            self.begun = self.a, self.b, is_reversed
        self.finished = False

    def before(self, code, numbers):
        """Applies an event that precedes a triangle."""
        a, b, was_reversed = self.begun
        if code == TURN:
            self.reversed ^= 1
        elif code == BESIDE:
            turned, place, step, other = numbers
            near = (self.b, self.a, a, b)[place] + step
            self.begin(*((near, other) if place in (0, 2) else (other, near)), self.reversed ^ turned)
        elif code == START:
            kind = numbers[0]
            if kind == 0:
                self.begin(a, b, was_reversed ^ 1)
            elif kind == 3:
                self.begin(*numbers[1:])
            else:
                first = b + 1 if kind == 1 else b + numbers[1]
                self.begin(first, first + 2 + numbers[-1], 0 if kind == 1 else was_reversed)

    def follow(self):
        """If the walk is finished, begins the polygon after the last begun one. Returns whether it was finished."""
        if not self.finished:
            return False
        if self.scopes:
            raise BadFile("a part has fewer triangles than its scope")
        a, b, was_reversed = self.begun
        self.begin(b + 1, b + 1 + b - a, self.reversed)
        self.begun = self.a, self.b, was_reversed
        return True

    def third_vertex(self, i, turn, code, numbers):
        """x of triangle i, named by an event."""
        a, b = self.a, self.b
        self.finished = False
        if code == FAR:
            across, x, count = numbers
            if turn and across != 3:
                raise BadFile("the turn of a FAR that goes on one way only is not 0")
            self.finished = across == 0
            low_first = turn if across == 3 else across != 2
        else:
            size, count = numbers
            x = a + size if turn else b - size
            low_first = turn if count else not turn
        low, high = (a, x), (x, b)
        if count:
            self.open_scope(i, code, count, *(high if low_first else low))
        self.a, self.b = (v & WORD for v in (low if low_first else high))
        return x

    def step(self, turn, required_last):
        """x of a triangle that no event names."""
        x = self.a + 1 if turn else self.b - 1
        if turn:
            self.a = x & WORD
        else:
            self.b = x & WORD
        self.finished = (self.b - self.a) & WORD == 1
        if self.finished and turn != required_last:
            raise BadFile("the turn of a corridor's last triangle is not the one that it should have")
        return x


def wart_triangles(record, turns):
    """The triangles of the record that have warts."""
    candidates = [i for i, turn in enumerate(turns) if i + 1 == len(turns) or turns[i + 1] == turn]
    if record.warts and record.warts[-1] >= len(candidates):
        raise BadFile("a wart is after the last candidate")
    warts = [candidates[rank] for rank in record.warts]
    if any(j - i < 2 for i, j in zip(warts, warts[1:])):
        raise BadFile("two warts are next to each other")
    return set(warts)


def walk_record(record, turns, out):
    """Appends the triangles of one record. `turns`: by triangle."""
    walk = Walk(record.entry, len(turns))
    warts = wart_triangles(record, turns)
    flips = record.events[0][2][0] if record.events and record.events[0][1] == FLIPS else 0
    events = iter(record.events)
    event = next(events, None)
    for i, turn in enumerate(turns):
        special = walk.close_scopes(i)
        while event is not None and event[0] == i and event[1] not in THIRD_VERTEX:
            walk.before(*event[1:])
            special = True
            event = next(events, None)
        special |= walk.follow()
        a, b = walk.a, walk.b
        own = event is not None and event[0] == i
        if own:
            x = walk.third_vertex(i, turn, *event[1:])
            event = next(events, None)
        else:
            x = walk.step(turn, 1 - turns[i - 1] if i else 0)
        low, middle, high = a, x, b
        if i in warts:
            if own or (b - a) & WORD < 4:
                raise BadFile("a wart is as large as its polygon, or an event gives its third vertex")
            middle = a + 2 if turn else b - 2
        elif i - 1 in warts:
            if own or special:
                raise BadFile("an event, a scope's end or a polygon's begin is between the triangles of a wart")
            low, middle, high = (a - 1, a, a + 1) if turn else (b - 1, b, b + 1)
        low, middle, high = low & WORD, middle & WORD, high & WORD
        out += (low, middle, high) if walk.reversed ^ flips >> i & 1 else (low, high, middle)


def parts(data):
    """The records of a parted block, each of 64 triangles."""
    at = 4
    for size in data[:4]:
        yield data[at:at + size]
        at += size


def decode_parted(data, entry, turns, head, out):
    sizes = data[:4]
    if len(data) != 4 + sum(sizes) or any(size > 200 for size in sizes):
        raise BadFile("the records of a parted block are too long, or not all that it has")
    for i, part in enumerate(parts(data)):
        some = turns[64 * i:64 * i + 64]
        if some:
            walk_record(Record(part, entry if i == 0 else None, head, len(some)), some, out)
        elif part:
            raise BadFile("a parted block has a record without triangles")


def decode_group(data, turns, width, out):
    """Returns the number of bytes of the group, without padding of its last word."""
    head = Head(data, (len(turns) + 255) // 256, width)
    head.check_blocks()
    for k, kind in enumerate(head.kinds):
        some = turns[256 * k:256 * k + 256]
        begin, end = head.places[k:k + 2]
        if not begin <= end <= len(data):
            raise BadFile("a block's records end before they begin, or after the end of the packed stream")
        block = data[begin:end]
        if kind == PLAIN:
            bits = Bits(block)
            out += [bits.take(width) for _ in range(3 * len(some))]
            if any(some) or bits.left >= 8 or not bits.only_ones():
                raise BadFile("a plain block has turns, or is not filled up with ones to a byte")
        elif kind == PARTED:
            decode_parted(block, head.entry(k), some, head, out)
        elif len(block) > 160:
            raise BadFile("a record of more than 160 bytes is not in a parted block")
        else:
            walk_record(Record(block, head.entry(k), head, len(some)), some, out)
    return head.places[-1]


def double(corners, own):
    """The corners of a double, from those of its own triangle. `own`: the run's second word."""
    p, q, r = corners
    return (p, r, q) if own & HIGH else (p, q, r)


def decode_doubles(words, header, out):
    """Appends the doubles to the own triangles."""
    firsts, owns = (words[header.first_run + i:header.first_group:2] for i in range(2))
    ends = [*firsts[1:], header.triangles + header.doubles]
    if header.runs and (firsts[0] != header.triangles or any(first >= end for first, end in zip(firsts, ends))):
        raise BadFile("the runs of doubles do not follow one another from the last own triangle to the last double")
    for first, end, own in zip(firsts, ends, owns):
        begin = own & ~HIGH
        if begin + end - first > header.triangles:
            raise BadFile("a double is of a triangle that is no own one")
        for t in range(begin, begin + end - first):
            out += double(out[3 * t:3 * t + 3], own)


def decode_packed(words):
    """The number of vertices, and a flat list of all triangles, doubles last. `words`: the whole stream."""
    header = Header(words)
    if zlib.crc32(words[4:].tobytes(), zlib.crc32(words[:3].tobytes())) != words[3]:
        raise BadFile("the packed stream's checksum is wrong")
    count = header.triangles
    turn_bits = int.from_bytes(words[4:header.table].tobytes(), "little")
    if turn_bits >> count:
        raise BadFile("there are turns after the last triangle")
    turns = [int(bit) for bit in reversed(f"{turn_bits:0{count}b}")] if count else []
    data = words[header.first_group:].tobytes()
    out = []
    at = 0
    for g in range(header.groups):
        if g and 4 * words[header.table + g - 1] != at:
            raise BadFile("the packed stream's groups are not where its table says")
        end = at + decode_group(data[at:at + (1 << 18)], turns[4096 * g:4096 * g + 4096], header.width, out)
        at = (end + 3) // 4 * 4
        if any(data[end:at]):
            raise BadFile("a group of the packed stream is not followed by zeros up to a word")
    if len(data) != at:
        raise BadFile("the packed stream has words after its last group")
    if out and max(out) >= header.vertices:
        raise BadFile("a vertex of the packed stream is out of range")
    corners = iter(out)
    if any(a == b or b == c or c == a for a, b, c in zip(corners, corners, corners)):
        raise BadFile("a triangle of the packed stream is degenerate")
    decode_doubles(words, header, out)
    return header.vertices, out


# --- One triangle ---


class Turns:
    """The turns of a record as bits, with rank queries (popcounts)."""

    def __init__(self, words, first, count):
        self.bits = int.from_bytes(words[4 + first // 32:4 + (first + count + 31) // 32].tobytes(), "little")
        same = ~(self.bits ^ self.bits >> 1)
        self.candidates = same & (1 << count - 1) - 1 | 1 << count - 1

    def turn(self, i):
        return self.bits >> i & 1

    def ones(self, begin, end):
        return (self.bits >> begin & (1 << end - begin) - 1).bit_count()

    def is_wart(self, i, warts):
        """Whether triangle i is a candidate whose rank is in `warts`."""
        return bool(self.candidates >> i & 1) and (self.candidates & (1 << i) - 1).bit_count() in warts


class Jump:
    """The state at triangle `at`, advanced by popcounts. Of scopes it only keeps whether one is open."""

    def __init__(self, entry, turns):
        self.a, self.b, self.reversed = entry
        self.begun = entry
        self.turns = turns
        self.at = 0
        self.finished = self.scope = False

    def polygon(self, skipped):
        """Begins the polygon after the last begun one, or `skipped` polygons later."""
        a, b, was_reversed = self.begun
        corners = b - a + 1
        self.a, self.b = a + corners * (skipped + 1), b + corners * (skipped + 1)
        self.begun = self.a, self.b, was_reversed
        self.finished = False

    def turns_only(self, to):
        ones = self.turns.ones(self.at, to)
        self.a += ones
        self.b -= to - self.at - ones
        self.at = to

    def move(self, to):
        """Advances to triangle `to`; no event is at `at` or between. `finished` may remain set there."""
        while self.at < to:
            if self.finished:
                size = (self.begun[1] - self.begun[0] - 1) & WORD
                if size == 0:
                    raise BadFile("a polygon has no triangle")
                whole = (to - self.at - 1) // size  # whole polygons before triangle to - 1
                self.polygon(whole)
                self.at += whole * size
            left = (self.b - self.a - 1) & WORD
            if left == 0:
                raise BadFile("a polygon has no triangle")
            last = self.at + left
            self.turns_only(min(to, last))
            self.finished = self.at == last

    def begin(self, a, b, is_reversed):
        self.a, self.b, self.reversed = a, b, is_reversed
        if not self.scope:
            self.begun = a, b, is_reversed
        self.finished = False

    def before(self, code, numbers):
        begun = self.begun
        if code == TURN:
            self.reversed ^= 1
        elif code == START and numbers[0] == 0:
            self.begin(begun[0], begun[1], begun[2] ^ 1)
        elif code == START and numbers[0] == 1:
            self.begin(begun[1] + 1, begun[1] + 3 + numbers[1], 0)
        elif code == START and numbers[0] == 2:
            self.begin(begun[1] + numbers[1], begun[1] + numbers[1] + 2 + numbers[2], begun[2])
        elif code == START:
            self.begin(*numbers[1:])
        elif code == BESIDE:
            turned, place, step, other = numbers
            ends = ((self.b + step, other), (other, self.a + step), (begun[0] + step, other), (other, begun[1] + step))
            self.begin(*ends[place], self.reversed ^ turned)

    def third_vertex(self, code, numbers):
        """x of triangle `at`, the edge that the walk continues across, and the rest and the part's triangles, or None and 0."""
        turn, a, b = self.turns.turn(self.at), self.a, self.b
        if code == FAR:
            across, x, count = numbers
            low_first = turn == 1 if across == 3 else across != 2
        else:
            size, count = numbers
            x = a + size if turn else b - size
            low_first = (turn == 1) == (count > 0)
        edges = [(a, x), (x, b)] if low_first else [(x, b), (a, x)]
        return x, edges[0], edges[1] if count else None, count


def find_record(words, header, t):
    """The record of triangle t, its first triangle, and its number of triangles; in a plain block only t's vertices."""
    block = t // 256
    group, k = divmod(block, 16)
    start = header.first_group + (words[header.table + group - 1] if group else 0)
    data = words[start:start + (1 << 16)].tobytes()
    head = Head(data, min(header.blocks - 16 * group, 16), header.width)
    record = data[head.places[k]:head.places[k + 1]]
    first = 256 * block
    if head.kinds[k] == PLAIN:
        bits = Bits(record)
        bits.take(3 * header.width * (t - first))
        return [bits.take(header.width) for _ in range(3)], None, None
    entry = head.entry(k)
    count = min(header.triangles - first, 256)
    if head.kinds[k] == PARTED:
        part = (t - first) // 64
        record = list(parts(record))[part]
        first += 64 * part
        count = min(header.triangles - first, 64)
        if part:
            entry = None
    return Record(record, entry, head, count), first, count


def read_triangle(words, t):
    """Triangle t of a valid stream, by the document's "Reading one triangle"."""
    header = Header(words)
    if t >= header.triangles + header.doubles:
        raise BadFile("the packed stream has no such triangle")
    if t >= header.triangles:
        run = bisect_right(range(header.runs), t, key=lambda i: words[header.first_run + 2 * i]) - 1
        first, own = words[header.first_run + 2 * run:header.first_run + 2 * run + 2]
        return double(read_triangle(words, (own & ~HIGH) + t - first), own)
    record, first, count = find_record(words, header, t)
    if first is None:
        return tuple(record)
    target = t - first
    turns = Turns(words, first, count)
    state = Jump(record.entry, turns)
    middle = None
    flip = 0
    for at, code, numbers in record.events:
        if at > target:
            break
        if code == FLIPS:
            flip = numbers[0] >> target & 1
        if at < state.at:
            continue  # the part ends before the triangle
        state.move(at)
        if code not in THIRD_VERTEX:
            state.before(code, numbers)
            continue
        if state.finished:
            state.polygon(0)
        x, edge, rest, part = state.third_vertex(code, numbers)
        if at == target:
            middle = x
            break
        end = at + part + 1
        if rest is not None and end <= target:
            (state.a, state.b), state.at, state.finished = rest, end, False
        else:
            (state.a, state.b), state.at, state.finished = edge, at + 1, code == FAR and numbers[0] == 0
            state.scope |= rest is not None and end < count
    state.move(target)
    if middle is None and state.finished:
        state.polygon(0)
    low, high, turn = state.a, state.b, turns.turn(target)
    if middle is None:
        middle = low + 1 if turn else high - 1
        if turns.is_wart(target, record.warts):
            middle = low + 2 if turn else high - 2
        elif target and turns.is_wart(target - 1, record.warts):
            low, middle, high = (low - 1, low, low + 1) if turn else (high - 1, high, high + 1)
    low, middle, high = low & WORD, middle & WORD, high & WORD
    return (low, middle, high) if state.reversed ^ flip else (low, high, middle)
