#!/usr/bin/env python3
"""test_stored.py LACEDRING: files in storage form, the default of encode, and commands that read them."""

import os
import struct
import zlib

from cli_support import CliTest, WRONG_USAGE, main


class Storage(CliTest):
    def encode(self, mesh, *options):
        path = self.path("x.lr")
        self.ok("encode", mesh, "-o", path, "--force", *options)
        with open(path, "rb") as file:
            return path, file.read()

    def decoded(self, path):
        out = self.path("out.ply")
        self.ok("decode", path, "-o", out, "--force")
        with open(out, "rb") as file:
            return file.read()

    def test_same_mesh(self):
        for mesh in (self.generate("blob", 3000), self.generate("genus", 2000), self.generate("soup", 300)):
            with self.subTest(mesh):
                resident, plain = self.encode(mesh, "--positions", "14", "--resident")
                want = self.decoded(resident)
                stored, small = self.encode(mesh, "--positions", "14")
                (self.assertLessEqual if "soup" in mesh else self.assertLess)(len(small), len(plain))
                self.assertEqual(self.encode(mesh, "--positions", "14", "--storage")[1], small)
                self.assertEqual(self.decoded(stored), want)
                for command in ("verify", "info", "stats"):
                    self.ok(command, stored)
                self.assertEqual(self.encode(stored, "--resident")[1], self.encode(self.path("out.ply"), "--resident")[1])

    def test_reports(self):
        mesh = self.generate("blob", 3000)
        path, small = self.encode(mesh)
        sections = self.json("info", "--json", path)["lr"]["sections"]
        self.assertTrue(sections[0]["stored"])
        self.assertIn("in storage form", self.ok("info", path).out)
        said = self.ok("encode", mesh, "-o", path, "--force").err
        for options in ([], ["--format", "lean"], ["--format", "lr"], ["--format", "lr-compact"]):
            path, plain = self.encode(mesh, "--resident", *options)
            self.assertFalse(any(s["stored"] for s in self.json("info", "--json", path)["lr"]["sections"]))
            if options:
                self.assertEqual(self.encode(mesh, *options)[1], plain)
            else:
                self.assertIn(f"{len(small)} bytes:", said)
                self.assertIn(f"; resident {len(plain)} bytes\n", said)
        for options in (["--storage", "--resident"], ["--storage", "--format", "lean"]):
            self.fails("encode", mesh, "-o", path, "--force", *options, codes=(WRONG_USAGE,))

    def test_damage(self):
        path, good = self.encode(self.generate("blob", 2000))
        for size in range(0, len(good), 211):
            self.refused(path, good[:size])
        for at in range(0, len(good), 173):
            self.refused(path, good[:at] + bytes([good[at] ^ 0x10]) + good[at + 1 :])

    def test_huge_triangle_count(self):
        """A small file with a huge number of triangles."""
        path, good = self.encode(self.generate("blob", 2000))
        words = list(struct.unpack_from("<8I", good))
        words[4] = 0xF0000000
        words[7] = zlib.crc32(struct.pack("<7I", *words[:7]))
        self.refused(path, struct.pack("<8I", *words) + good[32:], "would take more than")

    def test_max_memory(self):
        path, _ = self.encode(self.generate("blob", 20000))
        for command in (["decode", path, "-o", self.path("y.ply")], ["info", path]):
            self.fails(*command, "--max-memory", "1", mentions=["--max-memory"])
            self.ok(*command, "--max-memory", "100")

    def refused(self, path, data, *mentions):
        with open(path, "wb") as file:
            file.write(data)
        self.fails("decode", path, "-o", self.path("y.ply"), "--force", mentions=mentions)
        self.assertFalse(os.path.exists(self.path("y.ply")))


main()
