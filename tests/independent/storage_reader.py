"""The storage form of packed streams, decoded by its document (docs/storage-format.md) alone.

read_stored_packed returns the triangles, without restoring the packed stream.
"""

from collections import defaultdict

from mesh_readers import BadFile
from packed_reader import double
from vertex_reader import Bits

WORD = 0xFFFFFFFF
HIGH = 1 << 31  # in the number of runs: triangles are flipped
SCALE = 1 << 15  # the ranges of a model's symbols fill [0, SCALE)
LOWEST = 1 << 31  # the smallest state
LEFT, RIGHT = range(2)
MOST_VERTICES, MOST_TRIANGLES = 1 << 29, WORD // 3


def require(condition, message):
    if not condition:
        raise BadFile(f"stored stream: {message}")


class Coded:
    """The symbols and raw bits of a coded part."""

    def __init__(self, words):
        require(len(words) >= 1 and 4 <= words[0] < len(words), "the coded part is too short")
        self.symbols, self.at = words[1:words[0] + 1], 4
        self.states = [self.symbols[i] | self.symbols[i + 1] << 32 for i in (0, 2)]
        require(min(self.states) >= LOWEST, "a state is too small")
        raw = words[words[0] + 1:].tobytes()
        self.rest, self.left = Bits(raw), 8 * len(raw)

    def place(self):
        """A number in the range of the next symbol, in [0, SCALE)."""
        return self.states[0] % SCALE

    def advance(self, begin, end):
        """Takes a symbol of the given range, and switches to the other state."""
        state = self.states.pop(0)
        state = (end - begin) * (state // SCALE) + state % SCALE - begin
        if state < LOWEST:
            require(self.at < len(self.symbols), "the symbols end too early")
            state = state << 32 | self.symbols[self.at]
            self.at += 1
        self.states.append(state)

    def raw(self, count):
        require(count <= self.left, "the raw bits end too early")
        self.left -= count
        return self.rest.take(count)

    def finish(self):
        require(self.states == [LOWEST, LOWEST] and self.at == len(self.symbols), "symbols are left")
        require(self.left < 32 and self.rest.take(32) == 0, "raw bits are left")


class BitModel:
    def __init__(self):
        self.zero, self.seen = SCALE // 2, 0

    def read(self, coded):
        bit = int(coded.place() >= self.zero)
        coded.advance(*((self.zero, SCALE) if bit else (0, self.zero)))
        self.learn(bit)
        return bit

    def learn(self, bit):
        self.seen = min(self.seen + 1, 48)
        target = 32 if bit else SCALE - 32
        self.zero += (target - self.zero) * ((1 << 17) // (2 * self.seen + 3)) >> 16


class SymbolModel:
    def __init__(self):
        self.counts = [1] * 16
        self.interval = self.wait = 6
        self.make_ranges()

    def make_ranges(self):
        factor = ((SCALE - 16) << 16) // sum(self.counts)
        self.begins = [s + (sum(self.counts[:s]) * factor >> 16) for s in range(16)] + [SCALE]

    def read(self, coded):
        place = coded.place()
        symbol = max(s for s in range(16) if self.begins[s] <= place)
        coded.advance(*self.begins[symbol:symbol + 2])
        self.counts[symbol] += 4
        self.wait -= 1
        if self.wait == 0:
            self.wait = self.interval = min(self.interval + self.interval // 2, 64)
            if sum(self.counts) > 2048:
                self.counts = [(count + 1) // 2 for count in self.counts]
            self.make_ranges()
        return symbol


class NumberModel(SymbolModel):
    def read(self, coded):
        bits = super().read(coded)
        if bits == 15:
            bits += coded.raw(5)
        require(bits <= 32, "a number has more than 32 bits")
        return bits if bits < 2 else 1 << bits - 1 | coded.raw(bits - 1)


MODELS = {**dict.fromkeys("ABCDFIJP", BitModel), **dict.fromkeys("EHNO", NumberModel), **dict.fromkeys("GM", SymbolModel)}


class Steps:
    """Decodes the steps in order. An entry of `open` is an edge (a, b, side), or None after it was closed."""

    def __init__(self, coded, vertices, flips):
        self.coded, self.vertices, self.flips = coded, vertices, flips
        self.models = {name: kind() for name, kind in MODELS.items()}
        self.turn_models = defaultdict(BitModel)  # models of K and L
        self.open = []
        self.triangles_of = defaultdict(int)  # by vertex: its number of triangles
        self.ring_edges = set()  # v, if the edge (v, v + 1) has a triangle
        self.seen = 0
        self.root, self.side = (0, 0), LEFT
        self.on, self.entered, self.flipped = None, False, 0  # of the preceding step: the edge to continue across, ...

    def read(self, name):
        return self.models[name].read(self.coded)

    def vertex(self):
        return self.coded.raw(self.vertices.bit_length())

    def step(self):
        """The next triangle."""
        a, b = self.on or self.edge()
        if self.flips:
            self.flipped = self.read("I" if self.flipped else "J")
        x = self.third_vertex(a, b)
        require(max(a, b, x) < self.vertices, "a vertex is out of range")
        require(a != b and b != x and x != a, "a triangle is degenerate")
        for v in (a, b, x):
            self.triangles_of[v] += 1
        self.ring_edges.update(v for v, w in ((a, x), (x, b), (a, b)) if w == v + 1)
        self.seen = max(self.seen, a + 1, b + 1, x + 1)
        return (a, x, b) if (self.side == RIGHT) ^ self.flipped else (a, b, x)

    def edge(self):
        """The edge of a step that does not continue from the preceding one."""
        while self.open and self.open[-1] is None:  # empty places count only under open edges
            self.open.pop()
        if not self.open or self.read("A" if self.entered else "B"):
            return self.tree()
        at = len(self.open) - 1
        if self.read("C" if self.entered else "D"):
            above = self.read("E") + 1
            require(above <= at, "there are not so many open edges")
            at -= above
            if self.read("F"):
                del self.open[at + 1:]
        require(self.open[at] is not None, "an edge is entered twice")
        a, b, self.side = self.open[at]
        self.open[at] = None
        if at == len(self.open) - 1:
            self.open.pop()
        return a, b

    def tree(self):
        how = self.read("G")
        if how == 0:
            self.side ^= 1
        elif how == 1:
            self.root, self.side = (self.seen, self.seen + self.read("H") & WORD), LEFT
        else:
            require(how == 2, "a tree has an unknown begin")
            self.root, self.side = (self.vertex(), self.vertex()), self.coded.raw(1)
        return self.root

    def turn_model(self, letter, a, b):
        r, s = a in self.ring_edges, max(b - 1, 0) in self.ring_edges
        p, q = (min(self.triangles_of[v], 9) for v in (a, b))
        return self.turn_models[letter, r, s, p, q]

    def third_vertex(self, a, b):
        """Returns x, and opens the edges that the step may continue across."""
        self.on = None
        if self.turn_model("K", a, b).read(self.coded):
            self.entered = False
            if (b - a) & WORD == 2:
                return a + 1
            low = self.turn_model("L", a, b).read(self.coded)
            x = a + 1 if low else (b - 1) & WORD
            self.on = (x, b) if low else (a, x)
            return x
        fork = self.read("M")
        first, second, between, near_a = (fork >> i & 1 for i in range(4))
        if between:
            distance = self.read("N" if first and second else "O")
            x = (a + distance if near_a else b - distance) & WORD
        else:
            require(not near_a, "a fork has a bit that means nothing")
            x = self.vertex()
        edges = [(a, x)] * first + [(x, b)] * second
        if first and second:
            p = x - a if x > a else WORD
            q = b - x if b > x else WORD
            if (p <= q) ^ self.read("P"):  # (a, x) is first
                edges.reverse()
        self.open += [(*edge, self.side) for edge in edges]
        self.entered = bool(edges)
        return x


def read_doubles(words, own, triangles):
    """Appends the doubles to the own triangles. `words`: the numbers of doubles and runs, then two words per run."""
    count, firsts, begins = words[0], words[2::2], words[3::2]
    require(1 <= count <= min(own, MOST_TRIANGLES - own), "there are no doubles, or too many")
    require(firsts[0] == own, "doubles do not follow own triangles")
    for first, end, begin in zip(firsts, [*firsts[1:], own + count], begins):
        at = begin & ~HIGH
        require(first < end and at + end - first <= own, "a run of doubles is empty, or of no own triangles")
        triangles += [double(triangle, begin) for triangle in triangles[at:at + end - first]]


def read_stored_packed(words):
    """The number of vertices, and the corners of each triangle, doubles last. `words`: the section, an array of "I"."""
    require(len(words) >= 3, "too short")
    vertices, own, runs = words[0], words[1], words[2] & ~HIGH
    require(vertices <= MOST_VERTICES and own <= MOST_TRIANGLES, "too many vertices or triangles")
    begin = 3 + (2 + 2 * runs if runs else 0)
    require(begin < len(words), "shorter than its header says")
    require(not runs or words[4] == runs, "its two numbers of runs differ")
    coded = Coded(words[begin:])
    steps = Steps(coded, vertices, words[2] >= HIGH)
    triangles = [steps.step() for _ in range(own)]
    require(steps.on is None, "the last step goes on")
    coded.finish()
    if runs:
        read_doubles(words[3:begin], own, triangles)
    return vertices, triangles
