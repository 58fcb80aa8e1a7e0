"""The storage form of vertex streams, decoded by its document (docs/storage-format.md) alone.

read_stored_vertices returns the integers and values of all vertices, without restoring the vertex stream; so it does not
read the choices of blocks.
"""

from collections import defaultdict

from storage_reader import BitModel, Coded, NumberModel, SymbolModel, require
from stored_places import TextureMap, add_normals
from vertex_order import VertexOrder
from vertex_reader import DECIMALS, LATTICE, OCTAHEDRAL, WORD, Header, map_values, signed

CHUNK = 1 << 16  # vertices per coded part of blocks
PARALLELOGRAMS, MEAN, NEIGHBOR, NONE = range(4)
FROM = 0, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 64, 128, 256, 512
BITS = 0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 5, 6, 7, 8, 9
SIZE = 0, 256, 352, 400, 464, 512, 576, 640, 704, 768, 864, 992, 1120, 1248, 1376
ESCAPE = 15


def rounded(x, k):
    return x + (1 << k - 1) >> k


def unfold(code):
    return -(code + 1 >> 1) if code & 1 else code >> 1


class StoredHeader(Header):
    """The header. `ranges` are (low, F) by component, or None if they are the usual ones."""

    def __init__(self, coded, vertices):
        raw = coded.raw
        layout = raw(23)
        mapping = layout >> 5 & 7
        scale = raw({LATTICE: 32, DECIMALS: 4}.get(mapping, 0))
        error = raw(32 if mapping in (LATTICE, OCTAHEDRAL) else 0)
        super().__init__(vertices, layout, scale, error, 0)
        usual, self.ranges = raw(1), []
        for _ in range(self.n):
            raw(5 + 5)  # first width and usual predictor, which only blocks need
            if not usual:
                self.ranges.append((raw(32), raw(6)))
        require(all(bits <= 32 for _, bits in self.ranges), "a component has more than 32 bits")
        self.rules = [raw(2) for _ in range(self.n)]
        self.by_normal, self.error, self.smooth, self.fine = raw(1), raw(4), raw(5), raw(4)
        require(self.smooth <= 16 and (self.n == 3 or not self.by_normal), "impossible parameters")
        self.by_places = raw(1) if self.n == 2 else 0
        if self.by_places and mapping == OCTAHEDRAL:
            self.by_angle, self.by_area, self.of_vertex = raw(1), raw(1), raw(1)


class Residuals:
    """The models of one component's residuals."""

    def __init__(self):
        self.steps, self.others, self.own = defaultdict(SymbolModel), NumberModel(), 0

    def read(self, coded, expected, fine):
        """fold(r) and the residual's level."""
        step = min(expected // 64, 31)
        low = (step - fine + 1) // 2 if step > fine else 0
        symbol = self.steps[step].read(coded)
        if symbol == ESCAPE:
            return self.others.read(coded), self.own
        level = max(SIZE[symbol] + 128 * low, 128) - 128
        self.own += 3 * (level - self.own) // 16
        return (FROM[symbol] << low) + coded.raw(BITS[symbol] + low), level


def read_residuals(coded, header):
    """The unfolded residuals of each vertex, in stored order."""
    models, out = [Residuals() for _ in range(header.n)], []
    for _ in range(header.vertices):
        codes, levels = [], []
        for c, model in enumerate(models):
            if c == 0:
                expected = model.own
            elif c == 2 and header.n == 3:
                expected = (10 * model.own + 3 * (levels[1] + levels[0])) // 16
            else:
                expected = (model.own + levels[-1]) // 2
            code, level = model.read(coded, expected, header.fine)
            codes.append(unfold(code))
            levels.append(level)
        out.append(codes)
    return out


def read_exceptions(coded, header):
    out, number, word = [], -1, 0x80000000
    distance, other = NumberModel(), BitModel()
    if header.mapping == DECIMALS:
        for _ in range(coded.raw(32)):
            number += 1 + distance.read(coded)
            require(number < header.n * header.vertices, "an exception is out of range")
            word = coded.raw(32) if other.read(coded) else word
            out.append((number, word))
    return out


def surface_normal(corners, values):
    """N: the sum over the corners (x, y, z)."""
    out = [0, 0, 0]
    for x, y, z in corners:
        a = [signed(p - q) for p, q in zip(values[y], values[x])]
        b = [signed(p - q) for p, q in zip(values[z], values[x])]
        for c in range(3):
            u, w = (c + 1) % 3, (c + 2) % 3
            out[c] += a[u] * b[w] - a[w] * b[u]
    return [(x + (1 << 63)) % (1 << 64) - (1 << 63) for x in out]


class Predictor:
    """Computes values from residuals, called by VertexOrder for each vertex. `texture_map` predicts texture coordinates; then
    `values` are kept apart from the differences that are predicted here."""

    def __init__(self, header, residuals, texture_map=None):
        self.header, self.residuals, self.map = header, iter(residuals), texture_map
        self.differences = [None] * header.vertices
        self.values = [None] * header.vertices if texture_map else self.differences
        self.errors = defaultdict(lambda: [0] * header.n)
        self.all_parallelograms = set(header.rules) == {PARALLELOGRAMS}
        self.last = None

    def put(self, v, difference, prediction):
        """`prediction`: that of texture coordinates."""
        self.differences[v] = [x & WORD for x in difference]
        if self.map:
            self.values[v] = [x + y & WORD for x, y in zip(difference, prediction)]
        self.last = v

    def start(self, v, source):
        source = self.last if source is None else source
        zeros = [0] * self.header.n
        before, value = (zeros, zeros) if source is None else (self.differences[source], self.values[source])
        self.put(v, [x + r for x, r in zip(before, next(self.residuals))], [x - y for x, y in zip(value, before)])

    def predicted(self, v, corners):
        header, differences = self.header, self.differences
        plain, moved = [], []
        first, second = corners[0], corners[-1]
        errors = [self.errors[w] for x, y, _ in (first, second) for w in (x, y)] if header.error else ()
        for c, rule in enumerate(header.rules):
            (x1, y1, z1), (x2, y2, z2) = ((differences[w][c] for w in corner) for corner in (first, second))
            p = x1 + y1 - z1
            plain.append(p + rounded(signed(x2 + y2 - z2 - p), 1))
            s = signed(x1 + y1 + x2 + y2 - 4 * plain[c])
            if rule == PARALLELOGRAMS:
                e = sum(error[c] for error in errors)
                moved.append(plain[c] + (rounded(header.error * e + header.smooth * s, 6) if self.all_parallelograms else 0))
            else:
                moved.append({MEAN: plain[c] + rounded(s, 2), NEIGHBOR: x1, NONE: 0}[rule])
        r = next(self.residuals)
        if header.by_normal:
            r = self.by_normal(surface_normal((first, second), differences), r)
        difference = [x + y for x, y in zip(moved, r)]
        self.put(v, difference, self.map.predict(v, corners, self.values) if self.map else None)
        if header.error:
            self.errors[v] = [signed(x - y) for x, y in zip(difference, plain)]

    @staticmethod
    def by_normal(normal, r):
        """The summands of the predictions of the three components."""
        sizes = [abs(x) for x in normal]
        k = sizes.index(max(sizes))
        u, w = (k + 1) % 3, (k + 2) % 3
        h = max(sizes[k].bit_length() - 14, 0)
        cut = [x >> h for x in normal]
        out = [0, 0, 0]
        out[u], out[w], out[k] = r
        if cut[k]:
            top = sum(cut[c] * max(-32767, min(signed(out[c]), 32767)) for c in (u, w))
            down = abs(top) // abs(cut[k])
            out[k] -= down if (top < 0) == (cut[k] < 0) else -down
        return out


def take_part(words, at):
    require(at < len(words) and words[at] < len(words) - at, "a part has not all of its words")
    return words[at + 1:at + 1 + words[at]], at + 1 + words[at]


def check_ranges(header, integers):
    for (low, bits), column in zip(header.ranges, zip(*integers)):
        require(all((x - low & WORD) >> bits == 0 for x in column), "an integer is out of its component's range")


def read_stored_vertices(words, vertices, triangles, positions=None, vertex_of=None):
    """The header, with `integers` and `values` as in read_vertices. `words`: an array of "I"; `triangles` index the stream's
    vertices; `positions`: integers of the file's positions; `vertex_of`: if the stream is of copies, the vertex of each."""
    part, at = take_part(words, 0)
    coded = Coded(part)
    header = StoredHeader(coded, vertices)
    residuals = read_residuals(coded, header)
    header.exceptions = read_exceptions(coded, header)
    coded.finish()
    for _ in range(0, vertices, CHUNK):
        part, at = take_part(words, at)
        Coded(part)
    require(at == len(words), "something lies after the last part")
    texture_map = None
    if header.by_places:
        require(positions is not None, "it is predicted by positions, and these are no integers")
        vertex_of = range(vertices) if vertex_of is None else vertex_of
        require(len(vertex_of) == vertices, "not a position for each vertex")
        if header.mapping != OCTAHEDRAL:
            texture_map = TextureMap(positions, vertex_of)
    predictor = Predictor(header, residuals, texture_map)
    VertexOrder(triangles, vertices).run(predictor)
    header.integers = [tuple(vertex) for vertex in predictor.values]
    if header.by_places and not texture_map:
        header.integers = add_normals(header, header.integers, triangles, positions, vertex_of)
    check_ranges(header, header.integers)
    header.values = map_values(header, header.integers)
    return header
