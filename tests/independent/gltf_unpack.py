#!/usr/bin/env python3
"""gltf_unpack.py PACKED UNPACKED: decodes a glTF with LACEDRING_mesh_compression and compares it with the output of `unpack`.

Written from docs/gltf/LACEDRING_mesh_compression alone; shares no code with the libraries. Exit code 1: they differ.
"""

import json
import math
import os
import struct
import sys
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "scene")]
from lr_reader import read_lr
from mesh_readers import TYPES, BadFile
from scene_reader import FORMAT, SHAPE, SIZE, Scene

EXTENSION = "LACEDRING_mesh_compression"
MASK, FRONT = 0xFFFFFFFF, 64


def extension_of(value):
    return value.get("extensions", {}).get(EXTENSION)


def inflate(data, most):
    stream = zlib.decompressobj()
    out = stream.decompress(data, most + 1)
    if len(out) > most or not stream.eof or stream.unused_data:
        raise BadFile(f"no whole zlib stream of at most {most} bytes")
    return out


def unfold(code):
    return code >> 1 ^ (MASK if code & 1 else 0)


def varints(data):
    value = shift = 0
    for byte in data:
        if shift > 28 or shift == 28 and byte > 15:
            raise BadFile("a number of more than 32 bits")
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            yield value
            value = shift = 0
    if shift:
        raise BadFile("half a number")


def part_codes(data, triangles, parts):
    """The part of each triangle."""
    numbers = varints(inflate(data, 15 * triangles))
    out, lately, seen, expected = [], [], set(), 0
    try:
        for code in numbers:
            if code == 0:
                part = expected + unfold(next(numbers)) & MASK
                if part in seen:
                    raise BadFile(f"part {part} is not a new one")
                seen.add(part)
                expected = part + 1 & MASK
            elif code <= FRONT:
                if code > len(lately):
                    raise BadFile("a part after the list of those used lately")
                part = lately.pop(code - 1)
            else:
                part = code - FRONT - 1
                if part in lately:
                    raise BadFile(f"part {part} is in the list of those used lately")
            if part not in seen or part >= parts:
                raise BadFile(f"part {part} had no run, or does not exist")
            lately = [part, *lately[:FRONT - 1]]
            more = next(numbers)
            if more >= triangles - len(out):
                raise BadFile("more triangles than the stream has")
            out += [part] * (more + 1)
    except StopIteration:
        raise BadFile("half a run of triangles") from None
    if len(out) != triangles or len(seen) != parts:
        raise BadFile("not a part for each triangle, or parts without triangles")
    return out


def rank(bits):
    return bits ^ (MASK if bits >> 31 else 1 << 31)


def float_of(bits):
    return struct.unpack("<f", struct.pack("<I", bits))[0]


def float_bits(value):
    """The bits of the nearest float; None if it is not finite."""
    try:
        bits, = struct.unpack("<I", struct.pack("<f", value))
    except OverflowError:
        return None
    return bits if math.isfinite(float_of(bits)) else None


def decode_floats(data, size):
    head, packed = struct.unpack_from("<II", data)
    width, quaternions = head & 127, head >> 7 & 1
    if head > 255 or not 1 <= width <= 16 or quaternions and width != 4 or size % (4 * width) or 8 + packed > len(data):
        raise BadFile("floats: a damaged header")
    rows = size // (4 * width)
    base = rows if quaternions else 0
    lengths = inflate(data[8:8 + packed], base + rows * width)
    if len(lengths) != base + rows * width or max(lengths[base:], default=0) > 32 or max(lengths[:base], default=0) > 7:
        raise BadFile("floats: lengths that are not valid")
    bits, left = int.from_bytes(data[8 + packed:], "little"), 8 * (len(data) - 8 - packed)
    stack = []  # decoded rows, as bits of floats
    for i in range(rows):
        codes = []
        for c in range(width):
            length = lengths[base + c * rows + i]
            below = max(length - 1, 0)
            left -= below
            codes.append(bits & (1 << below) - 1 | (1 << below if length else 0))
            bits >>= below
        rest = lengths[i] if quaternions else None
        row = [0] * width
        for c in range(width):
            if rest is not None and c == rest & 3:
                continue
            expected = 0
            if i == 1:
                expected = stack[0][c]
            elif i > 1:
                expected = float_bits(2 * float_of(stack[-1][c]) - float_of(stack[-2][c]))
                if expected is None:
                    expected = stack[-1][c]
            row[c] = rank(expected) + unfold(codes[c]) & MASK
            row[c] ^= 1 << 31 if row[c] >> 31 else MASK
        if rest is not None:
            over = 1.0
            for c in range(4):
                if c != rest & 3:
                    over -= float_of(row[c]) ** 2
            root = math.sqrt(over) if 0 < over < math.inf else 0.0
            value = rank(float_bits(-root if rest & 4 else root)) + unfold(codes[rest & 3]) & MASK
            row[rest & 3] = value ^ (1 << 31 if value >> 31 else MASK)
        stack.append(row)
    if bits or not 0 <= left < 8:
        raise BadFile("floats: too few bits, or too many")
    return b"".join(struct.pack(f"<{width}I", *row) for row in stack)


class PackedScene(Scene):
    """A packed glTF with the interface of Scene: accessor() and view() return decoded data."""

    def __init__(self, path):
        super().__init__(path)
        extension = extension_of(self.json)
        self.is_document_packed = "document" in extension
        if self.is_document_packed:
            self.json = json.loads(zlib.decompress(Scene.view(self, extension["document"])))
            self.buffers = [self.buffer(i, b) for i, b in enumerate(self.json.get("buffers", []))]
            extension = extension_of(self.json)
            if "document" in extension:
                raise BadFile("a packed document in a packed document")
        self.streams = extension["streams"]
        self.set_of = {}  # by accessor: its stream and set
        for s, stream in enumerate(self.streams):
            for number, accessors in enumerate(stream["sets"]):
                for accessor in accessors:
                    if self.set_of.setdefault(accessor, (s, number)) != (s, number) or accessors.count(accessor) != 1:
                        raise BadFile(f"accessor {accessor} is there twice")
        self.find_parts()
        for number, stream in enumerate(self.streams):
            self.decode(stream, self.parts[number])

    def buffer(self, i, buffer):
        if (extension_of(buffer) or {}).get("placeholder"):
            if "uri" in buffer or i == 0:
                raise BadFile("a placeholder with bytes")
            return b""
        return super().buffer(i, buffer)

    def view(self, i):
        view = self.json["bufferViews"][i]
        coded = extension_of(view)
        if coded is None:
            return super().view(i)
        start, size = coded.get("byteOffset", 0), view["byteLength"]
        data = self.buffers[coded["buffer"]][start:start + coded["byteLength"]]
        decoders = {"deflate": inflate, "floats": decode_floats}
        out = decoders[coded["coding"]](data, size)
        if len(data) != coded["byteLength"] or len(out) != size:
            raise BadFile(f"buffer view {i} has not the size that it should have")
        return out

    def set_of_primitive(self, primitive):
        accessors = [a for names in (primitive["attributes"], *primitive.get("targets", [])) for a in names.values()]
        sets = {self.set_of.get(a) for a in accessors}
        return sets.pop() if len(sets) == 1 else None

    def find_parts(self):
        """Sets self.parts: for each stream, {part: (set, index accessor)}."""
        self.parts = [{} for _ in self.streams]
        self.compressed = []  # compressed primitives
        numbers = {}
        for _, _, primitive in self.primitives():
            extension, of = extension_of(primitive), self.set_of_primitive(primitive)
            if self.is_document_packed:
                if extension is not None:
                    raise BadFile("a packed document says which part a primitive has")
                if of is None or primitive.get("mode", 4) != 4:
                    continue
                stream, indices = of[0], primitive["indices"]
                part = numbers.setdefault((stream, indices), len(self.parts[stream]))
            elif extension is None:
                continue
            else:
                stream, part, indices = extension["stream"], extension["part"], primitive["indices"]
                if of is None or stream != of[0] or primitive.get("mode", 4) != 4:
                    raise BadFile("a primitive does not fit its stream")
            if self.parts[stream].setdefault(part, (of[1], indices)) != (of[1], indices):
                raise BadFile(f"part {part} of stream {stream} has two sets or index accessors")
            self.compressed.append(primitive)
        all_indices = [indices for parts in self.parts for _, indices in parts.values()]
        if len(set(all_indices)) != len(all_indices) or self.set_of.keys() & set(all_indices):
            raise BadFile("an index accessor is there twice")
        if any(sorted(parts) != list(range(len(parts))) or not parts for parts in self.parts):
            raise BadFile("a part without a primitive")

    def decode(self, stream, parts):
        mesh = read_lr(Scene.view(self, stream["bufferView"]))
        triangles = list(zip(*[iter(mesh.indices)] * 3))
        if (len(parts) > 1) != ("parts" in stream):
            raise BadFile("part codes of one part, or none of several")
        part_of = [0] * len(triangles)
        if len(parts) > 1:
            part_of = part_codes(Scene.view(self, stream["parts"]), len(triangles), len(parts))
        kept = [v for v in range(len(mesh.positions)) if v not in mesh.copies]  # without extra vertices
        is_ordered = bool(mesh.vertex_order and mesh.corner_order)
        if is_ordered != stream.get("ordered", False):
            raise BadFile("the document and the stream differ about its order")
        sets = stream["sets"]
        if is_ordered:
            number = mesh.vertex_order
            kept.sort(key=lambda v: number[v])
            turned = []
            for triangle, part, entry in zip(triangles, part_of, mesh.corner_order):
                k = entry % 3
                turned.append((entry, tuple(number[mesh.copies.get(triangle[(i - k) % 3], triangle[(i - k) % 3])] for i in range(3)), part))
            turned.sort()
            triangles, part_of = [t for _, t, _ in turned], [p for _, _, p in turned]
            counts = [self.json["accessors"][accessors[0]]["count"] for accessors in sets]
            owner = [s for s, count in enumerate(counts) for _ in range(count)]
        else:
            new = {v: i for i, v in enumerate(kept)}
            triangles = [tuple(new[mesh.copies.get(v, v)] for v in triangle) for triangle in triangles]
            owner = [None] * len(kept)
            for triangle, part in zip(triangles, part_of):
                for v in triangle:
                    owner[v] = parts[part][0]
        if len(owner) != len(kept) or None in owner:
            raise BadFile("a vertex of no set")
        vertices = [[] for _ in sets]  # by set: vertices of the file
        place = []
        for v, s in enumerate(owner):
            place.append(len(vertices[s]))
            vertices[s].append(kept[v])
        indices = {part: [] for part in parts}
        for triangle, part in zip(triangles, part_of):
            if any(owner[v] != parts[part][0] for v in triangle):
                raise BadFile("a triangle with another set's vertex")
            indices[part] += [(place[v],) for v in triangle]
        for accessors, of in zip(sets, vertices):
            if len(accessors) != len(mesh.attributes):
                raise BadFile("a set with another number of accessors than attributes")
            for accessor, attribute in zip(accessors, mesh.attributes):
                self.put(accessor, self.values(self.json["accessors"][accessor], attribute, of))
        for part, (_, accessor) in parts.items():
            if max(indices[part])[0] >= 256 ** SIZE[FORMAT[self.json["accessors"][accessor]["componentType"]]] - 1:
                raise BadFile(f"accessor {accessor} does not hold its indices")
            self.put(accessor, indices[part])

    @staticmethod
    def values(accessor, attribute, vertices):
        """Elements as in Scene: 32-bit floats are given as their bits."""
        rows, columns = SHAPE[accessor["type"]]
        kind, stored = FORMAT[accessor["componentType"]], TYPES[attribute.type]
        if rows * columns != attribute.components or stored not in (kind, "f") or attribute.v_up:
            raise BadFile("an attribute does not fit its accessor")
        if stored != "f" and accessor.get("normalized", False) != attribute.normalized:
            raise BadFile("an attribute is normalized and its accessor not, or the other way round")
        code = "I" if kind == "f" else stored
        elements = list(struct.Struct(f"<{attribute.components}{code}").iter_unpack(attribute.values))
        if stored != kind:
            elements = [tuple(int(x) for x in element) for element in elements]
            struct.pack(f"<{len(elements) * attribute.components}{kind}", *(x for element in elements for x in element))
        return [elements[v] for v in vertices]

    def put(self, accessor, values):
        a = self.json["accessors"][accessor]
        if self.is_document_packed and "count" not in a:
            a["count"] = len(values)
        if a["count"] != len(values):
            raise BadFile(f"accessor {accessor} has another count than its stream")
        self.read[accessor] = values


def check_bounds(scene, accessor):
    a, values = scene.json["accessors"][accessor], scene.numbers(accessor)
    if a["componentType"] != 5126:  # the bounds are integers
        values = scene.accessor(accessor)
    for name, pick in (("min", min), ("max", max)):
        told = [struct.unpack("<f", struct.pack("<f", x))[0] for x in a[name]]
        if told != [pick(column) for column in zip(*values)]:
            raise BadFile(f"accessor {accessor} has wrong bounds")


def compare(packed, unpacked):
    """Returns the differences, one line each. Also checks the fallback's data and the bounds of positions."""
    mine, theirs, out = PackedScene(packed), Scene(unpacked), []
    for scene in (theirs,) if mine.is_document_packed else (mine, theirs):
        for primitive in mine.compressed:
            check_bounds(scene, primitive["attributes"]["POSITION"])
    required = EXTENSION in mine.json.get("extensionsRequired", [])
    fallback = None if required else Scene(packed)
    if len(mine.json["accessors"]) != len(theirs.json["accessors"]):
        out.append("another number of accessors")
    for i, (a, b) in enumerate(zip(mine.json["accessors"], theirs.json["accessors"])):
        if any(a.get(key) != b.get(key) for key in ("componentType", "type", "normalized", "count")):
            out.append(f"accessor {i} is described otherwise")
        elif mine.accessor(i) != theirs.accessor(i):
            out.append(f"accessor {i} has other values")
        if i in mine.set_of or any(i == indices for parts in mine.parts for _, indices in parts.values()):
            if required == ("bufferView" in a) or "sparse" in a:
                out.append(f"accessor {i} has a view and no fallback, or the other way round")
            if fallback and fallback.accessor(i) != mine.accessor(i):
                out.append(f"accessor {i} has another fallback")
    for i, (a, b) in enumerate(zip(mine.json.get("images", []), theirs.json.get("images", []))):
        if "bufferView" in a and mine.view(a["bufferView"]) != theirs.view(b["bufferView"]):
            out.append(f"image {i} has other bytes")
    for (mesh, number, a), (_, _, b) in zip(mine.primitives(), theirs.primitives()):
        if any(a.get(key) != b.get(key) for key in ("attributes", "targets", "indices")):
            out.append(f"mesh {mesh}: primitive {number} has other accessors")
    if EXTENSION in json.dumps(theirs.json):
        out.append("the extension is still there")
    return out


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    differences = compare(*sys.argv[1:])
    for line in differences:
        print(line)
    sys.exit(1 if differences else 0)


if __name__ == "__main__":
    main()
