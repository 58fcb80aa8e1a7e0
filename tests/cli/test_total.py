#!/usr/bin/env python3
"""test_total.py LACEDRING: stats --table total, the sizes of whole meshes in all formats."""

import os
import re

from cli_support import CliTest, WRONG_USAGE, main

NAMES = ["raw", "packed", "packed_cache", "storage", "meshopt", "draco"]
KEYS = {"bytes", "bits_per_triangle", "bits_per_vertex", "random_access", "max_error"}
BITS = ["--positions", "12", "--normals", "8", "--texcoords", "10"]


class Total(CliTest):
    def total(self, path, *options):
        """Returns the mesh of the JSON, after checking keys and reasons."""
        document = self.json("stats", "--table", "total", "--json", path, *options)
        mesh, = document["meshes"]
        self.assertIn("lean", mesh["formats"])
        for name in NAMES:
            self.assertNotEqual(name in mesh["total"], name in mesh["absent"], f"{name} is either present or absent")
        self.assertLessEqual(mesh["total"]["storage"]["bytes"], mesh["total"]["packed"]["bytes"])
        compressed = {key for key in ("bytes_zstd", "bytes_brotli") if key not in mesh["absent"]}
        for name, entry in mesh["total"].items():
            self.check_entry(name, entry, compressed)
        for key in {"bytes_zstd", "bytes_brotli"} - compressed:
            self.assertRegex(mesh["absent"][key], r"\Abuilt without lib\w+\Z")
        self.assertRegex(document["versions"]["meshoptimizer"], r"\A\d+\.\d+, index codec 1, vertex codec [01]\Z")
        if "draco" not in document["versions"]:
            self.assertEqual(mesh["absent"]["draco"], "built without libdraco")
        return mesh

    def check_entry(self, name, entry, compressed):
        self.assertEqual(set(entry), KEYS | compressed, name)
        self.assertEqual(entry["random_access"], name in ("raw", "packed", "packed_cache"), name)
        for key in compressed:
            self.assertLess(entry[key], 1.01 * entry["bytes"] + 32, f"{name} {key}")

    def test_sizes(self):
        globe = self.path("globe.glb")  # positions, normals and texture coordinates, with seams
        os.symlink(os.path.join(os.path.dirname(__file__), "..", "..", "assets", "globe.glb"), globe)
        for path in (self.generate("genus", 1000), globe):
            for options in ([], BITS):
                with self.subTest(path, options=options):
                    mesh = self.total(path, *options)
                    attributes = self.json("info", "--json", path)["attributes"]
                    stride = sum(a["components"] * {"f32": 4, "f64": 8, "u8": 1, "u16": 2}[a["type"]] for a in attributes)
                    self.assertEqual(mesh["total"]["raw"]["bytes"], 6 * mesh["triangles"] + stride * mesh["copies"])
                    for name, how in (
                        ("packed", ["--resident"]),
                        ("packed_cache", ["--resident", "--profile", "cache"]),
                        ("storage", []),
                    ):
                        lr = self.path("x.lr")
                        self.ok("encode", path, "-o", lr, "--force", *how, *options)
                        entry = mesh["total"][name]
                        self.assertEqual(entry["bytes"], os.path.getsize(lr))
                        self.assertAlmostEqual(entry["bits_per_vertex"], 8 * entry["bytes"] / mesh["vertices"])
                        self.assertAlmostEqual(entry["bits_per_triangle"], 8 * entry["bytes"] / mesh["triangles"])
                    for name, entry in mesh["total"].items():
                        self.assertEqual(list(entry["max_error"]), [a["name"] for a in attributes])
                        lossless = not options or name == "raw"
                        for attribute, error in entry["max_error"].items():
                            (self.assertEqual if lossless else self.assertGreater)(error, 0, (name, attribute))
                            self.assertLess(error, 0.05)
                    self.assertEqual(mesh["total"]["meshopt"]["max_error"], mesh["total"]["packed"]["max_error"])

    def test_some_attributes(self):
        path = self.generate("blob", 800)
        everything, positions = self.total(path), self.total(path, "--attributes", "POSITION")
        self.assertEqual(list(positions["total"]["packed"]["max_error"]), ["POSITION"])
        self.assertLessEqual(positions["total"]["packed"]["bytes"], everything["total"]["packed"]["bytes"])
        self.assertEqual(positions["total"]["raw"]["bytes"], 6 * positions["triangles"] + 12 * positions["vertices"])

    def test_text(self):
        paths = [self.generate("blob", 800), self.generate("torus", 800)]
        text = self.ok("stats", "--table", "total", *BITS, *paths).out
        for path in paths:
            total = self.total(path, *BITS)["total"]
            for name, entry in total.items():
                row = re.search(rf"^  {name} .*\b{entry['bytes']}\b.*$", text, re.M)
                self.assertTrue(row, f"{name} of {path}: {text}")
                self.assertIn(f"{entry['bits_per_vertex']:.2f}", row[0])
                self.assertIn("yes" if entry["random_access"] else "no", row[0])
        self.assertRegex(text.splitlines()[-1], r"\Amedian of 2 meshes, bits/vertex: raw .*; meshopt over packed \d+\.\d\d \(packed is smaller on 2\)")
        alone = self.ok("stats", "--table", "total", paths[0]).out
        self.assertNotIn("median", alone)

    def test_what_draco_drops(self):
        """Draco joins vertices at one position, so a triangle with two of them is lost. All other formats have sizes."""
        path = self.write("x.obj", b"v 0 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/2 3/1\nf 1/1 3/1 4/2\n")
        mesh = self.total(path, "--no-weld")
        self.assertIn("meshopt", mesh["total"])
        self.assertIn(mesh["absent"]["draco"], ("Draco gives back 1 of 2 triangles", "built without libdraco"))
        self.total(self.generate("soup", 500), "--positions", "10")

    def test_wrong_usage(self):
        path = self.generate("blob", 500)
        for options in (["--positions", "12"], ["--normals", "8", "--table", "sizes"], ["--weights", "8", "--json"],
                        ["--attributes", "POSITION"], ["--table", "total", "--attributes", "NORMAL"],
                        ["--table", "total", "--paper"],
                        ["--table", "total", "--positions", "23"], ["--table", "total", "--normals", "1"]):
            self.fails("stats", path, *options, codes=(WRONG_USAGE,), mentions=["--"])


if __name__ == "__main__":
    main()
