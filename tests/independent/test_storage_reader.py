#!/usr/bin/env python3
"""test_storage_reader.py LACEDRING: storage_reader.py reads the triangles that `lacedring decode` writes for the same mesh's
resident stream, and raises BadFile for damaged streams."""

import array
import os
import random
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import lr_reader
from mesh_readers import BadFile, read_ply
from storage_reader import read_stored_packed

LACEDRING = None
KINDS = ("sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup")
SIZES = (300, 700, 1500, 3000)
LARGE = (("genus", 12000), ("terrain", 12000))
SEED = 20261


class TestStorageReader(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def run_program(self, *arguments):
        subprocess.run([LACEDRING, *arguments], check=True, capture_output=True)

    def encode(self, mesh, name, *options):
        self.run_program("encode", mesh, "-o", self.path(name), "--effort", "0", *options)
        with open(self.path(name), "rb") as file:
            return file.read()

    def stored(self, mesh):
        """The words of the mesh's stored packed stream, or None if it has no storage form."""
        kind, contents, *_ = lr_reader.sections(self.encode(mesh, "stored.lr", "--storage"))[0]
        return array.array("I", contents) if kind == lr_reader.STORED_PACKED else None

    def check(self, mesh):
        """Compares the triangles; returns the stored words, or None."""
        words = self.stored(mesh)
        if words is None:
            return None
        self.encode(mesh, "resident.lr", "--resident")
        self.run_program("decode", self.path("resident.lr"), "-o", self.path("decoded.ply"), "--force")
        with open(self.path("decoded.ply"), "rb") as file:
            decoded = read_ply(file.read())
        vertices, triangles = read_stored_packed(words)
        self.assertEqual(vertices, len(decoded.positions))
        self.assertEqual([v for triangle in triangles for v in triangle], list(decoded.indices))
        return words

    def generate(self, kind, triangles):
        mesh = self.path(f"{kind}{triangles}.ply")
        self.run_program("generate", kind, "--triangles", str(triangles), "--seed", str(triangles % 7), "-o", mesh)
        return mesh

    def test_generated(self):
        stored = []
        for kind, size in [*((kind, size) for kind in KINDS for size in SIZES), *LARGE]:
            with self.subTest(kind=kind, triangles=size):
                if self.check(self.generate(kind, size)) is not None:
                    stored.append(kind)
        print(f"{len(stored)} stored streams read, of {len(set(stored))} kinds")
        self.assertGreaterEqual(len(set(stored)), len(KINDS) - 1)  # soup may have no storage form
        self.assertGreaterEqual(len(stored), len(KINDS) * len(SIZES) * 2 // 3)

    def test_doubles(self):
        """Some triangles of a torus are repeated, as they are or flipped."""
        self.encode(self.generate("torus", 1000), "torus.lr")
        self.run_program("decode", self.path("torus.lr"), "-o", self.path("torus.obj"))
        with open(self.path("torus.obj"), encoding="ascii") as file:
            lines = [line for line in file if line.startswith(("v ", "f "))]
        faces = [line for line in lines if line.startswith("f ")]
        turned = [f"f {p} {r} {q}\n" for _, p, q, r in map(str.split, faces[400:440])]
        with open(self.path("doubles.obj"), "w", encoding="ascii") as file:
            file.writelines([*lines, *faces[100:160], *turned])
        words = self.check(self.path("doubles.obj"))
        self.assertIsNotNone(words)
        self.assertGreater(words[2] & 0x7FFFFFFF, 0, "no doubles")

    def test_empty_places(self):
        """An empty place on the stack of open edges counts until a step looks for an edge below it. The same words are in
        tests/lrcore/test_packed_storage.cpp; no encoder writes them."""
        words = array.array("I", (16, 5, 0, 6, 0xC1EE17F8, 0, 0x984031FC, 0, 0xD6D3F968, 0x86A11B54, 0x2C940))
        self.assertEqual(read_stored_packed(words), (16, [(0, 10, 5), (0, 5, 2), (2, 5, 3), (0, 2, 11), (5, 10, 7)]))

    def test_damaged(self):
        generator = random.Random(SEED)
        refused = tried = 0
        for kind in ("terrain", "genus", "parts", "moebius"):
            words = self.stored(self.generate(kind, 2000))
            self.assertIsNotNone(words, kind)
            data = words.tobytes()
            for length in range(0, len(words), 5):  # prefixes of the stream may only raise BadFile
                with self.assertRaises(BadFile):
                    read_stored_packed(words[:length])
            for _ in range(100):
                damaged = bytearray(data)
                for _ in range(generator.choice((1, 1, 4))):
                    at = generator.randrange(min(len(data), 28) if generator.random() < 0.3 else len(data))
                    damaged[at] ^= 1 << generator.randrange(8)
                tried += 1
                with self.subTest(kind=kind, damaged=bytes(damaged).hex()):
                    try:
                        read_stored_packed(array.array("I", bytes(damaged)))
                    except BadFile:
                        refused += 1
        self.assertGreater(refused, tried * 9 // 10)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        LACEDRING = sys.argv.pop(1)
    unittest.main()
