"""Readers of OBJ, PLY, OFF and STL that share no code with the libraries.

Every reader returns a Mesh: a bytes object per vertex with the bits of its position (three little-endian floats, or doubles
if a PLY file has doubles), and a flat list of vertex numbers, three per triangle, in the file's orientation. Corners that are
the same vertex by the rules of the file's format have the same number.
"""

import array
import re
import struct
import sys
from dataclasses import dataclass
from fractions import Fraction

from polygons import cut

assert sys.byteorder == "little"


class BadFile(ValueError):
    pass


class Mesh:
    def __init__(self, positions, indices):
        self.positions = positions
        self.indices = indices
        self.vertex_order = self.corner_order = None  # only of .lr files that keep the order
        # Only .lr files have attributes, with an entry per vertex, and copies, a dict from copies to originals.
        self.attributes, self.copies = None, {}


TYPES = "bBhHiIfd"  # format characters of struct, by the number of an attribute's type


@dataclass
class Attribute:
    name: str
    type: int
    components: int
    normalized: bool
    v_up: bool
    values: bytes  # tightly packed, little-endian


def split_keys(buffer, size=12):
    return [buffer[i:i + size] for i in range(0, len(buffer), size)]


def nearest_float(word):
    """The 32-bit float nearest to a decimal (ties to even), by exact arithmetic."""
    exact = Fraction(word.decode())
    first = array.array("f", [float(word)])
    bits = int.from_bytes(first.tobytes(), "little")
    best = None
    for candidate in (bits - 1, bits, bits + 1):
        if candidate & 0x7FFFFFFF >= 0x7F800000 or candidate < 0:
            continue
        value = struct.unpack("<f", struct.pack("<I", candidate))[0]
        score = (abs(Fraction(value) - exact), candidate & 1)
        if best is None or score < best[0]:
            best = (score, value)
    return best[1]


def floats_of_words(words):
    """Decimals as an array of 32-bit floats, rounded once. Rounding by way of a double differs only at exact ties."""
    doubles = array.array("d", map(float, words))
    out = array.array("f", doubles)
    bits = array.array("Q", doubles.tobytes())
    for i, b in enumerate(bits):
        exponent = b >> 52 & 0x7FF
        if b & 0x1FFFFFFF == 0x10000000 or (exponent < 900 and b << 1 & 0xFFFFFFFFFFFFFFFF):
            out[i] = nearest_float(words[i])
    return out


def unpack(key):
    """The coordinates of a position, from its bits."""
    return struct.unpack("<3f" if len(key) == 12 else "<3d", key)


def add_polygon(corners, keys, out, vertex=lambda corner: corner):
    """Adds the triangles of a polygon. `keys` are positions, vertex(corner) is a corner's index in them."""
    if len(corners) == 3:
        out += corners
    elif len(corners) > 3:
        for triangle in cut([unpack(keys[vertex(corner)]) for corner in corners]):
            out += [corners[i] for i in triangle]


def strip(corners, out):
    for i in range(2, len(corners)):
        if i % 2 == 0:
            out += (corners[i - 2], corners[i - 1], corners[i])
        else:
            out += (corners[i - 2], corners[i], corners[i - 1])


# --- OBJ ---


COMMENT = re.compile(rb"(?<!1\.)#.*|#(?!(?i:IND|INF|QNAN|SNAN)).*")  # "1.#IND" is a number


def obj_statements(data):
    """The words of each statement. Joins lines that end with a backslash, and removes comments."""
    words = []
    for line in data.splitlines():
        text = COMMENT.sub(b"", line)
        joined = text == line and re.search(rb"\\[ \t\v\f]*$", line)
        words += (text[:joined.start()] if joined else text).split()
        if not joined:
            yield words
            words = []
    yield words


def read_obj(data):
    words = []
    faces = []
    counts = [0, 0, 0]  # of v, vt, vn so far
    for parts in obj_statements(data):
        if not parts:
            continue
        keyword = parts[0]
        if keyword == b"v":
            words += parts[1:4]
            counts[0] += 1
        elif keyword == b"vt":
            counts[1] += 1
        elif keyword == b"vn":
            counts[2] += 1
        elif keyword in (b"f", b"fo"):
            corners = []
            for part in parts[1:]:
                corner = []
                for which, number in enumerate(part.split(b"/")[:3]):
                    i = int(number) if number else None
                    corner.append(None if i is None else i - 1 if i > 0 else counts[which] + i)
                corners.append(tuple(corner + [None] * (3 - len(corner))))
            faces.append(corners)
    keys = split_keys(floats_of_words(words).tobytes())
    numbers = {}
    positions = []
    indices = []
    triangles = []
    for corners in faces:
        add_polygon(corners, keys, triangles, lambda corner: corner[0])
    for v, vt, vn in triangles:
        # References are ignored if the file has no texture coordinates or normals at all.
        corner = (v, vt if counts[1] else None, vn if counts[2] else None)
        number = numbers.get(corner)
        if number is None:
            number = numbers[corner] = len(positions)
            positions.append(keys[v])
        indices.append(number)
    return Mesh(positions, indices)


# --- OFF ---


def off_vertices(lines, count, width, by_line):
    """The first three words of each vertex, and the lines after the vertices."""
    if by_line:
        if len(lines) < count or any(len(line) < width for line in lines[:count]):
            raise BadFile("a vertex is not on one line")
        return [word for line in lines[:count] for word in line[:3]], lines[count:]
    words = []
    while len(words) < count * width:
        words += lines[0]
        lines = lines[1:]
    if len(words) != count * width:
        raise BadFile("a vertex ends within a line")
    return [word for i in range(0, len(words), width) for word in words[i:i + 3]], lines


def off_faces(lines, count, by_line):
    faces = []
    at = 0
    for _ in range(count):
        words = list(lines[at])
        while len(words) < 1 + int(words[0]):  # continues in the next line
            at += 1
            words += lines[at]
        faces.append([int(word) for word in words[1:1 + int(words[0])]])
        at += 1
    if not by_line and at != len(lines):
        raise BadFile("something follows the faces")
    return faces


def read_off(data):
    lines = []
    for line in data.splitlines():
        line = line.split(b"#")[0].split()
        if line:
            lines.append(line)
    prefixes = []
    header = re.fullmatch(rb"((?:ST|C|N|4|n|S)*)OFF(\d*)", lines[0][0])
    if header:
        prefixes = re.findall(rb"ST|C|N|4|n|S", header.group(1))
        if b"4" in prefixes or b"n" in prefixes or b"BINARY" in lines[0]:
            raise BadFile("this kind of OFF is not read")
        lines[0] = ([header.group(2)] if header.group(2) else []) + lines[0][1:]
        if not lines[0]:
            del lines[0]
    if len(lines[0]) > 1:
        counts, lines = lines[0][:2], lines[1:]
    else:
        counts, lines = lines[0] + lines[1][:1], lines[2 if len(lines[1]) > 1 else 3:]
    vertices, faces = map(int, counts)
    base = 3 + 3 * prefixes.count(b"N") + 2 * prefixes.count(b"ST")
    colored = b"C" in prefixes
    for by_line, width in ((True, base + 3 * colored), (False, base + 4 * colored), (False, base + 3 * colored)):
        try:
            words, rest = off_vertices(lines, vertices, width, by_line)
            polygons = off_faces(rest, faces, by_line)
            break
        except (BadFile, IndexError):
            if not by_line and width == base + 3 * colored:
                raise
    keys = split_keys(floats_of_words(words).tobytes())
    indices = []
    for corners in polygons:
        add_polygon(corners, keys, indices)
    return Mesh(keys, indices)


# --- STL ---


def read_stl(data):
    unmarked = data[3:] if data.startswith(b"\xef\xbb\xbf") else data
    words = unmarked[:512].split()
    text = bool(words) and words[0].lower() == b"solid" and not any(c < 9 for c in unmarked[:512])
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        text = False
    if text:
        numbers = []
        for line in unmarked.splitlines():
            parts = line.split()
            for i, part in enumerate(parts):
                if part.lower() == b"vertex" and parts[0].lower() not in (b"solid", b"endsolid"):
                    numbers += parts[i + 1:i + 4]
        corners = split_keys(floats_of_words(numbers).tobytes())
    else:
        count = struct.unpack_from("<I", data, 80)[0]
        corners = []
        for t in range(count):
            at = 84 + 50 * t + 12
            corners += (data[at:at + 12], data[at + 12:at + 24], data[at + 24:at + 36])
    numbers = {}  # -0 and 0 are the same position
    indices = [numbers.setdefault(tuple(x + 0.0 for x in unpack(corner)), len(numbers)) for corner in corners]
    positions = {}
    for number, corner in zip(indices, corners):
        positions.setdefault(number, corner)
    return Mesh(list(positions.values()), indices)


# --- PLY ---

PLY_TYPES = {"char": "b", "int8": "b", "uchar": "B", "uint8": "B", "short": "h", "int16": "h", "ushort": "H",
             "uint16": "H", "int": "i", "int32": "i", "uint": "I", "uint32": "I", "float": "f", "float32": "f",
             "double": "d", "float64": "d"}


class PlyElement:
    def __init__(self, name, count):
        self.name = name
        self.count = count
        self.properties = []  # (name, type, count type or None)


def ply_header(data):
    end = b"\r\n" if data[3:5] == b"\r\n" else data[3:4]
    elements = []
    order = None
    at = 0
    while True:
        stop = data.find(end, at)
        if stop < 0:
            raise BadFile("the PLY header does not end")
        words = data[at:stop].decode("latin-1").split()
        at = stop + len(end)
        if not words:
            continue
        if words[0] == "format":
            order = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}[words[1]]
        elif words[0] == "element":
            elements.append(PlyElement(words[1], int(words[2])))
        elif words[0] == "property" and words[1] == "list":
            elements[-1].properties.append((words[4], PLY_TYPES[words[3]], PLY_TYPES[words[2]]))
        elif words[0] == "property":
            elements[-1].properties.append((words[2], PLY_TYPES[words[1]], None))
        elif words[0] == "end_header":
            return elements, order, at


class AsciiRows:
    """Reads the values of an element from the words of the file, or from one line per element."""

    def __init__(self, data, at, by_line):
        self.by_line = by_line
        self.words = [line.split() for line in data[at:].splitlines() if line.strip()] if by_line else data[at:].split()
        self.at = 0

    def scalars(self, element, wanted):
        width = len(element.properties)
        if self.by_line:
            lines = self.words[self.at:self.at + element.count]
            self.at += element.count
            if any(len(line) < width for line in lines):
                raise BadFile("a line is too short")
            return [[line[i] for line in lines] for i in wanted]
        block = self.words[self.at:self.at + width * element.count]
        self.at += width * element.count
        return [block[i::width] for i in wanted]

    def rows(self, element):
        words, at = self.words, self.at
        for i in range(element.count):
            if self.by_line:
                words, at = self.words[self.at + i], 0
            row = []
            for _, kind, count_type in element.properties:
                if count_type is None:
                    row.append(words[at])
                    at += 1
                else:
                    n = int(words[at])
                    if at + 1 + n > len(words):
                        raise BadFile("a list is too short")
                    row.append([int(w) if kind not in "fd" else w for w in words[at + 1:at + 1 + n]])
                    at += 1 + n
            yield row
        self.at = self.at + element.count if self.by_line else at


class BinaryRows:
    def __init__(self, data, at, order):
        self.data, self.at, self.order = data, at, order

    def scalars(self, element, wanted):
        row = struct.Struct(self.order + "".join(kind for _, kind, _ in element.properties))
        stop = self.at + row.size * element.count
        columns = list(zip(*row.iter_unpack(self.data[self.at:stop]))) if element.count else []
        self.at = stop
        return [list(columns[i]) if columns else [] for i in wanted]

    def rows(self, element):
        data, at, order = self.data, self.at, self.order
        if len(element.properties) == 1 and element.properties[0][2] is not None:
            # If all are triangles, the common case, one call unpacks all.
            _, kind, count_type = element.properties[0]
            row = struct.Struct(order + count_type + "3" + kind)
            stop = at + row.size * element.count
            if stop <= len(data):
                all_rows = list(row.iter_unpack(data[at:stop]))
                if all(r[0] == 3 for r in all_rows):
                    self.at = stop
                    for r in all_rows:
                        yield [r[1:]]
                    return
        for _ in range(element.count):
            row = []
            for _, kind, count_type in element.properties:
                n = 1
                if count_type is not None:
                    n = struct.unpack_from(order + count_type, data, at)[0]
                    at += struct.calcsize(count_type)
                values = struct.unpack_from(f"{order}{n}{kind}", data, at)
                at += struct.calcsize(f"{order}{n}{kind}")
                row.append(values if count_type is not None else values[0])
            yield row
        self.at = at


def ply_positions(columns, kinds, is_text):
    if all(kind == "d" for kind in kinds):
        flat = array.array("d", bytes(24 * len(columns[0])))
        for i in range(3):
            flat[i::3] = array.array("d", map(float, columns[i]))
        return split_keys(flat.tobytes(), 24)
    flat = array.array("f", bytes(12 * len(columns[0])))
    for i in range(3):
        if is_text and kinds[i] == "f":
            flat[i::3] = floats_of_words(columns[i])
        else:
            flat[i::3] = array.array("f", map(float, columns[i]))
    return split_keys(flat.tobytes())


def read_ply(data):
    elements, order, at = ply_header(data)
    if order != "":
        return read_ply_elements(elements, BinaryRows(data, at, order), False)
    # Elements are read by line if there are as many lines; the rest of a line is skipped.
    lines = sum(1 for line in data[at:].splitlines() if line.strip())
    if lines == sum(element.count for element in elements if element.properties):
        try:
            return read_ply_elements(elements, AsciiRows(data, at, True), True)
        except (BadFile, IndexError, ValueError):
            pass
    return read_ply_elements(elements, AsciiRows(data, at, False), True)


def read_ply_elements(elements, source, is_text):
    positions = None
    polygons = []  # with the triangles of strips
    for element in elements:
        names = [name for name, _, _ in element.properties]
        if not names:
            continue
        if element.name == "vertex":
            xyz = [names.index(axis) for axis in "xyz"]
            if all(count_type is None for _, _, count_type in element.properties):
                columns = source.scalars(element, xyz)
            else:
                rows = list(source.rows(element))
                columns = [[row[i] for row in rows] for i in xyz]
            positions = ply_positions(columns, [element.properties[i][1] for i in xyz], is_text)
            continue
        lists = [i for i, (name, _, count_type) in enumerate(element.properties)
                 if name in ("vertex_indices", "vertex_index") and count_type is not None]
        for row in source.rows(element):
            if not lists or element.name not in ("face", "tristrips"):
                continue
            corners = row[lists[0]]
            if element.name == "face":
                polygons.append(corners)
                continue
            piece = []
            for v in list(corners) + [-1]:
                if v == -1:
                    triangles = []
                    strip(piece, triangles)
                    polygons += [triangles[i:i + 3] for i in range(0, len(triangles), 3)]
                    piece = []
                else:
                    piece.append(v)
    if positions is None:
        raise BadFile("the PLY file has no vertices")
    indices = []
    for corners in polygons:
        if corners and (max(corners) >= len(positions) or min(corners) < 0):
            raise BadFile("a PLY index is out of range")
        add_polygon(corners, positions, indices)
    return Mesh(positions, indices)


def ply_attributes(data):
    """The attributes of a binary PLY file of `lacedring decode`, whose comments name the properties of each."""
    elements, order, at = ply_header(data)
    vertex = elements[0]
    if vertex.name != "vertex" or order != "<" or any(count_type is not None for _, _, count_type in vertex.properties):
        raise BadFile("not a PLY file of lacedring's")
    kinds = "".join(kind for _, kind, _ in vertex.properties)
    row = struct.calcsize("<" + kinds)
    rows = data[at:at + row * vertex.count]
    out = []
    for components, flags, name in re.findall(rb"^comment lacedring attribute (\d+) (\d+) (.*)$", data[:at], re.M):
        kind, kinds = kinds[:int(components)], kinds[int(components):]
        if len(kind) != int(components) or len(set(kind)) != 1 or int(flags) > 3:
            raise BadFile("the PLY file's comments do not fit its properties")
        begin = row - struct.calcsize("<" + kind + kinds)
        values = b"".join(rows[i:i + struct.calcsize("<" + kind)] for i in range(begin, len(rows), row))
        out.append(Attribute(name.decode("latin-1"), TYPES.index(kind[0]), len(kind), int(flags) % 2 == 1,
                             int(flags) > 1, values))
    if kinds:
        raise BadFile("the PLY file has a property that no comment tells of")
    return out
