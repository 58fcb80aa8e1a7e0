"""The seam section, decoded by its document (docs/seams-format.md) alone."""

import zlib

from mesh_readers import BadFile

MAGIC = 0x3153524C
BLOCK, GROUP, BACK = 512, 32, 64  # elements per block, blocks per group, preceding triangles searched for a parent
MOST_STEPS, MOST = 255, 1 << 24
CONTEXTS = """v0 v1 v2 more many wrap lone left0 left1 left2 right0 right1 right2 right3 right4 half both stepL leave lastR nextR startL
    midL plain seamed seamed2 midR midR2 newR newL newM home""".split()
LEFT, RIGHT = range(2)
ENDLESS = 1 << 40
NEW = None  # in questions: a new copy instead of a position


def require(condition, message):
    if not condition:
        raise BadFile(f"seam section: {message}")


class Private(int):
    """The state of a corner with a private copy; positions are plain integers."""


class Bits:
    """Reads bits [at, end) of the words."""

    def __init__(self, number, at, end):
        self.number, self.at, self.end = number, at, end

    def raw(self, count):
        require(self.at + count <= self.end, "a code crosses its block's end")
        self.at += count
        return self.number >> self.at - count & (1 << count) - 1

    def unary(self):
        ones = 0
        while self.raw(1):
            ones += 1
        require(ones < MOST, "a unary number is too large")
        return ones

    def golomb(self, order):
        width = self.unary() + order
        require(width <= 31, "an Exp-Golomb number is too large")
        return (1 << width) + self.raw(width) - (1 << order)


class Block(Bits):
    """Reads a block's codes."""

    def __init__(self, number, at, end, table):
        super().__init__(number, at, end)
        self.table, self.runs = table, {}

    def flag(self, context):
        likely, k = self.table[context]
        if k == 0:
            return self.raw(1) if self.at < self.end else likely
        if k not in self.runs:
            self.runs[k] = self.run(k)
        if self.runs[k] == 0:
            del self.runs[k]
            return 1 - likely
        self.runs[k] -= 1
        return likely

    def run(self, k):
        if self.at == self.end:
            return ENDLESS
        if k == 7 and not self.raw(1):
            return ENDLESS
        run = self.golomb(5) if k == 7 else (self.unary() << k - 1) + self.raw(k - 1)
        require(run < MOST, "a run is too long")
        return run


class Directory:
    """A directory: by block, its begin and end, and the copies before it."""

    def __init__(self, bits, blocks, widths):
        self.begin, self.before = [0], [0]
        for block in range(blocks):
            if block and block % GROUP == 0:
                require((bits.raw(32), bits.raw(32)) == (self.begin[-1], self.before[-1]), "wrong sums in a directory")
            self.begin.append(self.begin[-1] + bits.raw(widths[0]))
            self.before.append(self.before[-1] + bits.raw(widths[1]))


class Seams:
    """The parts of a section; read_seams decodes them."""

    def __init__(self, data, vertices, triangles):
        require(len(data) % 4 == 0 and len(data) >= 32, "too short")
        words = memoryview(data).cast("I")
        require(words[0] == MAGIC and words[1] == zlib.crc32(data[8:]), "wrong magic or checksum")
        self.homes, self.vertices = words[2], vertices
        widths = data[12:16]
        require(vertices <= self.homes <= vertices + 3 * triangles and self.homes < 1 << 30, "impossible homes")
        require(widths[0] <= 20 and widths[1] <= 17 and widths[2] <= 20 and widths[3] <= 11, "impossible widths")
        self.number, size = int.from_bytes(data, "little"), 8 * len(data)
        entries = [words[4 + i // 8] >> 4 * (i % 8) & 15 for i in range(32)]
        self.table = {name: (entry & 1, entry >> 1) for name, entry in zip(CONTEXTS, entries)}
        bits = Bits(self.number, 256, size)
        self.vertex_blocks = Directory(bits, -(-vertices // BLOCK), widths[0:2])
        self.blocks = Directory(bits, -(-triangles // BLOCK), widths[2:4])
        self.vertex_bits = bits.at
        self.block_bits = self.vertex_bits + self.vertex_blocks.begin[-1]
        end = self.block_bits + self.blocks.begin[-1]
        require(end <= size < end + 32 and self.number >> end == 0, "words or padding do not match")
        self.copies = self.homes + self.blocks.before[-1]
        require(self.copies < 1 << 30, "too many copies")

    def block(self, directory, part, b):
        return Block(self.number, part + directory.begin[b], part + directory.begin[b + 1], self.table)


def read_steps(seams):
    """By vertex: its steps, whether it wraps, and its first copy."""
    steps, wraps, firsts = [], [], []
    first = 0
    for b in range(len(seams.vertex_blocks.begin) - 1):
        require(first == b * BLOCK + seams.vertex_blocks.before[b], "a vertex block makes other copies than it says")
        codes, before = seams.block(seams.vertex_blocks, seams.vertex_bits, b), 0
        for _ in range(b * BLOCK, min((b + 1) * BLOCK, seams.vertices)):
            c = wrap = 0
            if codes.flag(f"v{min(2, before)}"):
                c = 1
                if codes.flag("more"):
                    c = 2
                    while c < MOST_STEPS and codes.flag("many"):
                        c += 1
                    wrap = codes.flag("wrap")
            steps.append(c)
            wraps.append(wrap)
            firsts.append(first)
            first += c + 1 - wrap
            before = c
        require(codes.at == codes.end, "a vertex block has bits after its codes")
    require(first == seams.vertices + seams.vertex_blocks.before[-1], "a vertex block makes other copies than it says")
    require(first == seams.homes, "other homes than the header says")
    return steps, wraps, firsts


class Walk:
    """Decodes the triangles of one block."""

    def __init__(self, codes, triangles, steps, wraps, made):
        self.codes, self.triangles, self.steps, self.wraps, self.made = codes, triangles, steps, wraps, made
        self.states, self.sides = [], []  # by triangle: the states of its vertices; its side
        for i, triangle in enumerate(triangles):
            if not triangle:
                self.sides.append(None)
                self.states.append({})
                continue
            parent, pair = self.parent(i)
            self.sides.append(self.side(triangle, parent))
            self.states.append({})
            if parent is not None:
                self.read_pair(i, parent, pair)
            for w in triangle:
                if w not in self.states[i]:
                    self.read_other(i, w, parent)
        require(codes.at == codes.end, "a block has bits after its codes")

    def parent(self, i):
        for j in range(i - 1, max(0, i - BACK) - 1, -1):
            both = [w for w in self.triangles[i] if w in self.triangles[j]]
            if len(both) >= 2:
                return j, both[:2]
        return None, ()

    def side(self, triangle, parent):
        for a, b in zip(triangle, triangle[1:] + triangle[:1]):
            if b == a + 1:
                return LEFT
            if a == b + 1:
                return RIGHT
        return LEFT if parent is None else self.sides[parent]

    def copy(self, w, state):
        """The home copy of a position; private states as they are."""
        wraps = self.wraps[w] and not isinstance(state, Private) and state == self.steps[w]
        return 0 if wraps else state

    def same(self, w, a, b):
        return isinstance(a, Private) == isinstance(b, Private) and self.copy(w, a) == self.copy(w, b)

    def ask(self, w, questions, current=None):
        """Asks questions, pairs of a position or NEW and a context, in order."""
        left = list(range(self.steps[w] + 1 - self.wraps[w]))
        if current is not None and not isinstance(current, Private):
            left.remove(self.copy(w, current))
        for position, context in questions:
            if position is NEW:
                if self.codes.flag(context):
                    self.made += 1
                    return Private(self.made - 1)
            elif self.copy(w, position) in left:
                if self.codes.flag(context):
                    return position
                left.remove(self.copy(w, position))
        if left and self.codes.flag("home"):
            index = self.codes.raw((len(left) - 1).bit_length())
            require(index < len(left), "no such home copy")
            return left[index]
        private = self.made - 1 - self.codes.golomb(2)
        require(private >= 0, "no such private copy")
        return Private(private)

    def read_pair(self, i, parent, pair):
        left, behind = self.sides[i] == LEFT, self.triangles[parent]
        ends = []
        for w, o in (pair, pair[::-1]):
            state, c = self.states[parent][w], self.steps[w]
            far = 0 if left == (behind[behind.index(w) - 1] == o) else c
            q = 1
            while q < 3 and (i + q >= len(self.triangles) or w in self.triangles[i + q]):
                q += 1
            if left:
                r = 0 if isinstance(state, Private) else abs(far - state)
                x = int(c > 0) if r == 0 else 2 if r < q else 3
            else:
                x = int(c > 0) if self.same(w, state, far) else 2
            ends.append((x, w, state, far, q))
        ends.sort(key=lambda end: end[0])  # stable
        x, y, q = ends[0][0], ends[1][0], ends[0][4]
        if left:
            context = "lone" if x == 0 else "left2" if x > 1 else "left0" if y < 3 else "left1"
        elif 1 in (x, y):
            context = "right0"
        else:
            context = "right4" if x == 2 else "right1" if y == 0 else "right2" if q == 1 else "right3"
        for change, (x, w, state, far, q) in zip(self.changes(context, "half" if x == 0 else "both", ends), ends):
            if change:
                state = self.ask(w, self.change_questions(left, w, x, state, far, q), state)
            self.states[i][w] = state

    def changes(self, context, usual, _ends):
        """Reads which of the two ends change their states."""
        if not self.codes.flag(context):
            return 0, 0
        if self.codes.flag(usual):
            return context != "lone", 1
        return (1, 0) if self.codes.raw(1) else (context == "lone", 1)

    def change_questions(self, left, w, x, state, far, q):
        if not left:
            return [(NEW, "leave")] if x < 2 else [(far, "lastR" if q == 1 else "nextR"), (NEW, "newR")]
        if isinstance(state, Private):
            to = far
        elif state != far:
            to = state + (1 if far > state else -1)
        else:
            to = 0 if self.steps[w] == 0 else 1 if far == 0 else far - 1
        return [(to, "stepL"), (NEW, "newL")]

    def read_other(self, i, w, parent):
        c, ring = self.steps[w], [o for o in (w - 1, w + 1) if o in self.triangles[i]]
        near = c if ring == [w + 1] else 0
        if self.sides[i] == LEFT:
            questions = [(near, "midL" if c > 0 and not ring else "startL"), (NEW, "newL")]
        elif parent is not None and ring:
            for o in ring:
                here, there = (0, c) if o == w - 1 else (c, 0)
                if self.same(o, self.states[i][o], self.steps[o] if o == w - 1 else 0):
                    questions = [(here, "plain"), (NEW, "newR")]
                    break
                questions = [(NEW, "seamed2" if c else "seamed"), (there, "leave")]
        else:
            questions = [(near, "midR2" if c else "midR"), (NEW, "newM" if c else "newR")]
        self.states[i][w] = self.ask(w, questions)


def read_seams(data, triangles, vertices):
    """The copies of corners, a tuple per triangle (() for a slot without one), and the vertex of each copy."""
    seams = Seams(data, vertices, len(triangles))
    steps, wraps, firsts = read_steps(seams)
    out, owners, made = [], {}, 0
    for b in range(len(seams.blocks.begin) - 1):
        require(made == seams.blocks.before[b], "a block makes other copies than it says")
        here = triangles[b * BLOCK:(b + 1) * BLOCK]
        walk = Walk(seams.block(seams.blocks, seams.block_bits, b), here, steps, wraps, made)
        made = walk.made
        for triangle, states in zip(here, walk.states):
            for w in triangle:
                if isinstance(states[w], Private):
                    require(owners.setdefault(states[w], w) == w, "a private copy is of two vertices")
            out.append(tuple(seams.homes + states[w] if isinstance(states[w], Private) else firsts[w] + walk.copy(w, states[w])
                             for w in triangle))
    require(made == seams.blocks.before[-1], "a block makes other copies than it says")
    vertex_of = [v for v in range(vertices) for _ in range(steps[v] + 1 - wraps[v])]
    return out, vertex_of + [owners.get(p, None) for p in range(made)]
