#!/usr/bin/env python3
"""test_stored_attributes.py LACEDRING: lr_reader.py reads the same triangles, copies and attributes of files in storage form
as `lacedring decode`, and raises only BadFile for damaged files."""

import array
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lr_reader
from mesh_readers import BadFile, ply_attributes, read_ply, unpack
from mesh_writers import ply_of_attributes
from stored_places import cross, less
from test_streams import BITS, attributes_of, cut
from vertex_reader import DECIMALS, DOUBLES, FLOATS, INTEGERS, LATTICE, OCTAHEDRAL

LACEDRING = None
KINDS = ("sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup")


def normals_by_area(points, indices):
    sums = [[0, 0, 1e-9] for _ in points]
    for t in range(0, len(indices), 3):
        a, b, c = (points[v] for v in indices[t:t + 3])
        normal = cross(less(b, a), less(c, a))
        for v in indices[t:t + 3]:
            sums[v] = [x + y for x, y in zip(sums[v], normal)]
    return [[x / sum(y * y for y in n) ** 0.5 for x in n] for n in sums]


class StoredAttributes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def read_file(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def write_file(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def run_program(self, *arguments):
        result = subprocess.run([LACEDRING, *arguments], capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)

    def mesh(self, kind, triangles, with_seams):
        """Writes m.ply, a mesh with attributes of all mappings."""
        self.run_program("generate", kind, "--triangles", str(triangles), "--seed", "5", "-o", self.path("g.ply"))
        generated = read_ply(self.read_file("g.ply"))
        points, indices, copies = [unpack(p) for p in generated.positions], generated.indices, None
        normals = normals_by_area(points, indices)
        if with_seams:
            indices, copies = cut(indices, random.Random(triangles))
            points, normals = ([of[v] for v in copies] for of in (points, normals))
            normals = [[-x for x in n] if i % 40 == 0 else n for i, n in enumerate(normals)]  # some flipped, so that copies differ
        columns = attributes_of(points, kind, random.Random(1))
        if triangles % 2:
            columns[1] = ("NORMAL", "f", 0, normals)
        if with_seams:  # texture coordinates with a seam at each copy
            columns[3] = ("TEXCOORD_0", "f", 2, [(x + i % 3, y * 2 - z) for i, (x, y, z) in enumerate(points)])
        self.write_file("m.ply", ply_of_attributes(columns, indices))

    def encode(self, *options):
        self.run_program("encode", self.path("m.ply"), "-o", self.path("m.lr"), "--effort", "0", "--storage", "--force", *options)
        return self.read_file("m.lr")

    def check(self, data):
        """Compares with the program, vertex by vertex."""
        self.write_file("m.lr", data)
        self.run_program("decode", self.path("m.lr"), "-o", self.path("d.ply"), "--force")
        wanted, mesh = self.read_file("d.ply"), lr_reader.read_lr(data)
        self.assertEqual(list(mesh.indices), list(read_ply(wanted).indices))
        attributes = ply_attributes(wanted)
        self.assertEqual([a.name for a in mesh.attributes], [a.name for a in attributes])
        for mine, other in zip(mesh.attributes, attributes):
            self.assertEqual(mine, other, mine.name)

    def headers(self, data):
        """The headers of the stored vertex streams."""
        out, read = [], lr_reader.read_stored_vertices

        def keep(*arguments):
            out.append(read(*arguments))
            return out[-1]
        lr_reader.read_stored_vertices = keep
        try:
            self.check(data)
        finally:
            lr_reader.read_stored_vertices = read
        return out

    def test_meshes(self):
        found, kinds = [], set()
        for i, kind in enumerate(KINDS):
            for with_seams in (False, True):
                for options in ((), BITS):
                    with self.subTest(kind=kind, seams=with_seams, options=options):
                        self.mesh(kind, 300 + 77 * i, with_seams)
                        data = self.encode(*options)
                        kinds |= {part[0] for part in lr_reader.sections(data)}
                        found += self.headers(data)
        self.assertLessEqual({lr_reader.STORED_PACKED, lr_reader.STORED_SEAMS, lr_reader.STORED_VERTICES}, kinds)
        print(f"{len(found)} stored vertex streams read")
        self.assertEqual({h.mapping for h in found}, {INTEGERS, LATTICE, OCTAHEDRAL, FLOATS, DECIMALS, DOUBLES})
        self.assertTrue(any(h.exceptions for h in found))
        self.assertEqual({rule for h in found for rule in h.rules}, set(range(4)))
        for name in ("by_normal", "error", "smooth", "by_places"):
            self.assertTrue(any(getattr(h, name) for h in found), name)
        places = [h for h in found if h.by_places]
        self.assertEqual({h.mapping == OCTAHEDRAL for h in places}, {False, True})
        for name in ("by_angle", "by_area", "of_vertex"):
            self.assertEqual({getattr(h, name) for h in places if h.mapping == OCTAHEDRAL}, {0, 1}, name)

    def test_loose_vertices(self):
        """Vertices without triangles, and triangles without neighbors."""
        points = [(i % 7, i % 5, i / 8) for i in range(200)]
        columns = [("POSITION", "f", 0, points), ("COLOR_0", "B", 1, [(i, i // 9) for i in range(200)])]
        self.write_file("m.ply", ply_of_attributes(columns, range(50, 80)))
        self.assertGreater(len(self.headers(self.encode("--positions", "12"))), 0)

    def test_many_copies(self):
        """The tips of a double pyramid, each with 300 triangles and a copy for each: on one side of the ring at most 253 are homes."""
        count = 300
        rim = [(math.cos(i), math.sin(i), 0) for i in (2 * math.pi * k / count for k in range(count))]
        columns = [("POSITION", "f", 0, [(0, 0, 1)] * count + [(0, 0, -1)] * count + rim),
                   ("TEXCOORD_0", "f", 0, [(i / count, i % 7 / 7) for i in range(2 * count)] + [(0, 0)] * count)]
        edges = [(2 * count + i, 2 * count + (i + 1) % count) for i in range(count)]
        self.write_file("m.ply", ply_of_attributes(columns, [v for i, (a, b) in enumerate(edges) for v in (i, a, b, count + i, b, a)]))
        data = self.encode()
        self.assertIn(lr_reader.STORED_SEAMS, [part[0] for part in lr_reader.sections(data)])
        self.check(data)

    def replaced(self, data, number, contents):
        """The file with the contents of a section replaced."""
        count, = struct.unpack_from("<I", data, 8)
        table, body = b"", b""
        for i in range(count):
            kind, coding, _, offset, size, layout, name = struct.unpack_from("<HHIQQII", data, 32 + 32 * i)
            body += bytes(-len(body) % 8)
            own = contents if i == number else data[offset:offset + size]
            table += struct.pack("<HHIQQII", kind, coding, zlib.crc32(own), 32 + 32 * count + len(body), len(own), layout, name)
            body += own
        head = data[:24] + struct.pack("<I", zlib.crc32(table))
        return head + struct.pack("<I", zlib.crc32(head)) + table + body

    def test_other_ranges(self):
        """Streams with unusual ranges, which the encoder does not write: made by hand."""
        self.mesh("genus", 600, False)
        data, tried = self.encode(*BITS), 0
        for i, (kind, contents, _, length) in enumerate(lr_reader.sections(data)):
            if kind != lr_reader.STORED_VERTICES:
                continue
            begin = (length + 7) // 8 * 8
            words = array.array("I", contents[begin:])
            part = words[1:1 + words[0]]
            layout = part[1 + part[0]] & 0x7FFFFF
            before = 23 + {LATTICE: 64, DECIMALS: 4, OCTAHEDRAL: 32}.get(layout >> 5 & 7, 0)  # bits before the flag "usual ranges"
            raw = int.from_bytes(part[1 + part[0]:].tobytes(), "little")
            bits, at, rest = raw & (1 << before) - 1, before + 1, raw >> before + 1
            for _ in range(layout & 31):
                bits |= (rest & 1023) << at | (1 << 31) << at + 10 | 32 << at + 42  # low 2^31, F 32
                rest, at = rest >> 10, at + 48
            bits |= rest << at
            size = 32 * (len(part) - 1 - part[0]) + 38 * (layout & 31)
            for spare in (0, -32):  # the last word may have become superfluous
                more = (size + spare + 31) // 32
                if bits >> 32 * more == 0:
                    changed = array.array("I", [*part[:1 + part[0]], *array.array("I", bits.to_bytes(4 * more, "little"))])
                    changed = array.array("I", [len(changed), *changed, *words[1 + words[0]:]])
                    other = self.replaced(data, i, contents[:begin] + changed.tobytes())
                    try:
                        mine = lr_reader.read_lr(other)
                    except BadFile:
                        continue
                    self.assertEqual(mine.attributes, lr_reader.read_lr(data).attributes)
                    self.check(other)
                    tried += 1
        self.assertGreater(tried, 5)

    def test_damaged(self):
        """Damaged sections may only raise BadFile."""
        generator, refused, tried = random.Random(9), 0, 0
        self.mesh("blob", 301, True)
        data = self.encode(*BITS)
        parts = lr_reader.sections(data)
        for i, (kind, contents, _, length) in enumerate(parts):
            if kind not in (lr_reader.STORED_VERTICES, lr_reader.STORED_SEAMS):
                continue
            begin = (length + 7) // 8 * 8
            for _ in range(12):
                damaged = bytearray(contents)
                for _ in range(generator.choice((1, 1, 4))):
                    end = begin + 40 if generator.random() < 0.5 else len(contents)
                    damaged[generator.randrange(begin, min(end, len(contents)))] ^= 1 << generator.randrange(8)
                if generator.random() < 0.2:
                    del damaged[begin + generator.randrange(len(contents) - begin) // 4 * 4:]
                tried += 1
                with self.subTest(section=i, damaged=damaged.hex()):
                    try:
                        lr_reader.read_lr(self.replaced(data, i, bytes(damaged)))
                    except BadFile:
                        refused += 1
        self.assertGreater(refused, tried // 2)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        LACEDRING = sys.argv.pop(1)
    unittest.main()
