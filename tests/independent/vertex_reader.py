"""The vertex stream, decoded by its document (docs/vertex-format.md) alone."""

import math
import struct
import zlib

from mesh_readers import TYPES, BadFile

WORD = 0xFFFFFFFF
MAGIC = 0x3156524C
BLOCK, GROUP = 128, 16  # vertices per block, blocks per group
INTEGERS, LATTICE, OCTAHEDRAL, FLOATS, DECIMALS, DOUBLES = range(6)
ALLOWED = {INTEGERS: range(6), DOUBLES: (7,)}  # by mapping: allowed types; other mappings: 6
SCALES = {LATTICE: range(0x00800000, 0x73800000), DECIMALS: range(10)}  # header word 4; for other mappings: 0
INFINITY = 0x7F800000  # bits of a float


def require(condition, message):
    if not condition:
        raise BadFile(f"vertex stream: {message}")


class Bits:
    """A cursor over the bits of a byte string, lowest first. Bits after the end of the string are 0."""

    def __init__(self, data):
        self.data = data
        self.place = 0

    def take(self, bits):
        """Reads a number of at most 32 bits."""
        place = self.place
        self.place = place + bits
        return int.from_bytes(self.data[place >> 3:(place >> 3) + 5], "little") >> (place & 7) & (1 << bits) - 1

    def zeros(self):
        """Reads at most 24 zeros and the one that ends them; returns the number of zeros."""
        place = self.place
        window = int.from_bytes(self.data[place >> 3:(place >> 3) + 4], "little") >> (place & 7) & 0x1FFFFFF
        require(window, "more than 24 zeros before a one, or the stream ends")
        zeros = (window & -window).bit_length() - 1
        self.place = place + zeros + 1
        return zeros


def signed(x):
    """Reduces x modulo 2^32, to two's complement."""
    return (x + 0x80000000 & WORD) - 0x80000000


def quarter(x):
    """The document's q(x)."""
    return signed(x + 2) >> 2


def as_float(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def float_bits(integer):
    """Maps an ordered integer to the bits of its float."""
    return integer ^ (0x80000000 if integer >> 31 else WORD)


class Header:
    """The description of a stream's values: words 1, 2, 4, 5 and 6."""

    def __init__(self, vertices, layout, scale, error, exceptions):
        self.vertices, self.scale = vertices, scale
        self.n, self.mapping, self.type = layout & 31, layout >> 5 & 7, layout >> 8 & 15
        self.normalized, self.octahedral_bits, self.width = bool(layout >> 12 & 1), layout >> 13 & 31, layout >> 18 & 31
        require(1 <= self.n <= 16 and layout >> 23 == 0, "invalid number of integers, or unused bits are set")
        require(self.mapping <= DOUBLES and self.type in ALLOWED.get(self.mapping, (6,)), "invalid mapping or type")
        require(not self.normalized or self.mapping == INTEGERS, "floats are normalized")
        octahedral = self.mapping == OCTAHEDRAL
        require(2 <= self.octahedral_bits <= 16 and self.n in (2, 3) if octahedral else self.octahedral_bits == 0,
                "invalid octahedral layout")
        self.largest = (1 << self.octahedral_bits - 1) - 1 if octahedral else 0  # the document's M
        require(self.mapping != DOUBLES or self.n % 2 == 0, "doubles with an odd number of integers")
        self.components = {OCTAHEDRAL: self.n + 1, DOUBLES: self.n // 2}.get(self.mapping, self.n)  # components of the attribute
        require(self.scale in SCALES.get(self.mapping, (0,)), "step or digits out of range")
        require(error < (INFINITY if self.mapping in (LATTICE, OCTAHEDRAL) else 1), "invalid largest error")
        require(exceptions == 0 or self.mapping == DECIMALS, "exceptions without decimals")
        self.largest_error = as_float(error)


class Vertices(Header):
    """The parts of a stream before the data. read_vertices adds `integers`, a tuple of n unsigned 32-bit integers per vertex,
    and `values`, the attribute's bytes. `table` and `data` are the first words of these parts.
    """

    def __init__(self, words):
        require(len(words) >= 7 and words[0] == MAGIC, "too short, or wrong magic")
        vertices, layout, _, scale, error, exceptions = words[1:7]
        super().__init__(vertices, layout, scale, error, exceptions)
        self.blocks = (self.vertices + BLOCK - 1) // BLOCK
        self.groups = (self.blocks + GROUP - 1) // GROUP
        self.group_words = 1 + ((GROUP - 1) * self.width + 31) // 32
        listed = 7 + 2 * self.n
        self.table = listed + 2 * exceptions
        self.data = self.table + self.groups * self.group_words
        require(len(words) >= self.data + 2, "shorter than the header says")
        require(all(bits >> 16 == 0 and bits & 63 <= 32 for bits in words[8:listed:2]), "invalid component")
        # A tuple for each component: low, F, first width, usual predictor.
        self.columns = [(words[i], words[i + 1] & 63, words[i + 1] >> 6 & 31, words[i + 1] >> 11)
                        for i in range(7, listed, 2)]
        places = words[listed:self.table:2]
        require(all(a < b for a, b in zip(places, places[1:])), "exceptions do not increase")
        require(not places or places[-1] < self.n * self.vertices, "an exception is out of range")
        self.exceptions = list(zip(places, words[listed + 1:self.table:2]))


def read_width(bits, width):
    """Reads a component's width in a run, relative to the previous run's. Returns it, and whether residuals have bits."""
    if not bits.take(1):
        return width, True
    if not bits.take(1):
        return width, False
    if not bits.take(1):
        width += 1
    elif not bits.take(1):
        width -= 1
    else:
        width = bits.take(5)
    require(0 <= width <= 31, "a width is out of range")
    return width, True


def read_plane(bits, last):
    """Reads a run's plane (axis, a, b), or None. `last`: the last plane in the block."""
    if not bits.take(1):
        return None
    if not bits.take(1):
        return last
    plane = bits.take(2), bits.take(3) - 4, bits.take(3) - 4
    require(plane[0] != 3, "a plane has axis 3")
    return plane


def read_residuals(bits, count, widths, coded):
    """Reads the residuals of a run of `count` vertices, without the plane's part. `coded`: the components with bits."""
    residuals = [[0] * len(widths) for _ in range(count)]
    lows = [[bits.take(widths[c]) for c in coded] for _ in range(count)]
    for vertex, low in zip(residuals, lows):
        for i, c in enumerate(coded):
            code = (bits.zeros() << widths[c]) + low[i]
            require(code <= WORD, "a code has more than 32 bits")
            vertex[c] = -(code + 1 >> 1) if code & 1 else code >> 1
    return residuals


def read_block(bits, columns, count):
    """Returns the integers of a block of `count` vertices."""
    predictors = [bits.take(5) if bits.take(1) else usual for _, _, _, usual in columns]
    weights = [((p & 7) - 2, (p >> 3) - 2) for p in predictors]
    run = 4 << bits.take(2)
    vertex = [low + bits.take(first_bits) & WORD for low, first_bits, _, _ in columns]
    out = [tuple(vertex)]
    widths = [width for _, _, width, _ in columns]
    d1, d2 = [0] * len(columns), [0] * len(columns)
    plane, given = None, (0, 0, 0)
    for first in range(0, count - 1, run):
        if len(columns) == 3 and first % 16 == 0:
            plane = read_plane(bits, given)
            given = plane or given
        codes = [read_width(bits, width) for width in widths]
        widths = [width for width, _ in codes]
        coded = [c for c, (_, has_bits) in enumerate(codes) if has_bits]
        for step in read_residuals(bits, min(run, count - 1 - first), widths, coded):
            if plane:
                axis, a, b = plane
                step[axis] += quarter(a * step[(axis + 1) % 3] + b * step[(axis + 2) % 3])
            for c, (alpha, beta) in enumerate(weights):
                step[c] += quarter(alpha * d1[c] + beta * d2[c])
                vertex[c] = vertex[c] + step[c] & WORD
            d2, d1 = d1, step  # not reduced modulo 2^32; quarter() does that
            out.append(tuple(vertex))
    return out


def read_integers(data, words, header):
    """Returns the integers of all vertices. `data` and `words` are the same stream."""
    bits, end = Bits(data[4 * header.data:]), 32 * (len(words) - header.data - 2)
    out = []
    for group in range(header.groups):
        begin, table = bits.place, header.table + group * header.group_words
        require(32 * words[table] == begin, f"group {group} does not begin where the table says")
        fields = int.from_bytes(data[4 * table + 4:4 * (table + header.group_words)], "little")
        for block in range(group * GROUP, min((group + 1) * GROUP, header.blocks)):
            if block % GROUP:
                place = begin + (fields & (1 << header.width) - 1)
                require(bits.place == place, f"block {block} does not begin where the table says")
                fields >>= header.width
            out += read_block(bits, header.columns, min(BLOCK, header.vertices - block * BLOCK))
            require(bits.place <= end, f"block {block} is not complete")
        require(fields == 0, f"bits after the last field of group {group} are set")
        require(bits.take(-bits.place % 32) == 0, f"bits after the last block of group {group} are set")
    require(bits.place == end and not any(words[-2:]), "the last group is not followed by two words 0 and the end")
    for (low, first_bits, _, _), column in zip(header.columns, zip(*out)):
        require(all((x - low & WORD) >> first_bits == 0 for x in column), "an integer is out of its component's range")
    return out


def require_range(values, low, high):
    require(all(low <= x <= high for x in values), f"an integer is not from {low} to {high}")


def octahedral_values(vertex, largest):
    x, y = signed(vertex[0]), signed(vertex[1])
    require_range((x, y), -largest, largest)
    require_range(vertex[2:], 0, 1)
    z = largest - abs(x) - abs(y)
    if z < 0:  # x and y are not 0 then
        x, y = (largest - abs(y)) * (-1 if x < 0 else 1), (largest - abs(x)) * (-1 if y < 0 else 1)
    length = math.sqrt(x * x + y * y + z * z)
    return [x / length, y / length, z / length] + [-1.0 if third else 1.0 for third in vertex[2:]]


def map_values(header, integers):
    """Returns the attribute's bytes; raises BadFile if an integer is invalid for the mapping or type."""
    flat = [i for vertex in integers for i in vertex]
    code = TYPES[header.type]
    if header.mapping == INTEGERS:
        is_signed, bits = code.islower(), 8 * struct.calcsize("<" + code)
        values = [signed(i) for i in flat] if is_signed else flat
        require_range(values, *((-1 << bits - 1, (1 << bits - 1) - 1) if is_signed else (0, (1 << bits) - 1)))
    elif header.mapping == LATTICE:
        fraction = header.scale & 0x7FFFFF | 0x800000  # has as many trailing zeros as the fraction; 23 if that is 0
        limit, step = fraction & -fraction, as_float(header.scale)  # products then have at most 24 bits
        values = [signed(i) for i in flat]
        require_range(values, 1 - limit, limit - 1)
        values = [i * step for i in values]
    elif header.mapping == OCTAHEDRAL:
        values = [x for vertex in integers for x in octahedral_values(vertex, header.largest)]
    elif header.mapping == FLOATS:
        code, values = "I", [float_bits(i) for i in flat]
    elif header.mapping == DECIMALS:
        values = bytearray(struct.pack(f"<{len(flat)}f", *(signed(i) / 10**header.scale for i in flat)))
        for place, bits in header.exceptions:
            struct.pack_into("<I", values, 4 * place, bits)
        return bytes(values)
    else:
        code, values = "Q", [float_bits(high) << 32 | low for high, low in zip(flat[::2], flat[1::2])]
    return struct.pack(f"<{len(values)}{code}", *values)


def read_vertices(data):
    """Decodes and validates a whole stream, given as bytes."""
    require(len(data) % 4 == 0, "not a whole number of words")
    words = struct.unpack(f"<{len(data) // 4}I", data)
    out = Vertices(words)
    require(zlib.crc32(data[16:], zlib.crc32(data[:12])) == words[3], "wrong checksum")
    out.integers = read_integers(data, words, out)
    out.values = map_values(out, out.integers)
    return out
