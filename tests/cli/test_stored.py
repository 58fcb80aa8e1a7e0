#!/usr/bin/env python3
"""test_stored.py LACEDRING: encode --storage, and what reads its files."""

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
                resident, plain = self.encode(mesh, "--positions", "14")
                want = self.decoded(resident)
                stored, small = self.encode(mesh, "--positions", "14", "--storage")
                self.assertLessEqual(len(small), len(plain))
                self.assertEqual(self.decoded(stored), want)
                self.ok("verify", stored)
                self.ok("info", stored)

    def test_said(self):
        mesh = self.generate("blob", 3000)
        path, _ = self.encode(mesh, "--storage")
        sections = self.json("info", "--json", path)["lr"]["sections"]
        self.assertTrue(sections[0]["stored"])
        self.assertIn("in storage form", self.ok("info", path).out)
        path, _ = self.encode(mesh, "--resident")
        self.assertFalse(any(s["stored"] for s in self.json("info", "--json", path)["lr"]["sections"]))
        for options in (["--storage", "--resident"], ["--storage", "--format", "lean"]):
            self.fails("encode", mesh, "-o", path, "--force", *options, codes=(WRONG_USAGE,))

    def test_damage(self):
        path, good = self.encode(self.generate("blob", 2000), "--storage")
        for size in range(0, len(good), 211):
            self.refused(path, good[:size])
        for at in range(0, len(good), 173):
            self.refused(path, good[:at] + bytes([good[at] ^ 0x10]) + good[at + 1 :])

    def test_bomb(self):
        """A small file that says it has more triangles than a computer holds."""
        path, good = self.encode(self.generate("blob", 2000), "--storage")
        words = list(struct.unpack_from("<8I", good))
        words[4] = 0xF0000000
        words[7] = zlib.crc32(struct.pack("<7I", *words[:7]))
        self.refused(path, struct.pack("<8I", *words) + good[32:], "would take more than")

    def refused(self, path, data, *mentions):
        with open(path, "wb") as file:
            file.write(data)
        self.fails("decode", path, "-o", self.path("y.ply"), "--force", mentions=mentions)
        self.assertFalse(os.path.exists(self.path("y.ply")))


main()
