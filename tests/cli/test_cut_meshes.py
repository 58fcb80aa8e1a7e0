#!/usr/bin/env python3
"""test_cut_meshes.py LACEDRING: meshes cut at seams. Commands join vertices at one position, and keep attributes that differ between the copies."""

import os
import struct

from cli_support import WRONG_USAGE, CliTest, main

import check_decode
import mesh_writers as write
from gltf_reader import Gltf

GLOBE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "assets", "globe.glb")
BITS = ["--positions", "14", "--normals", "10", "--texcoords", "12"]


def glb_corners(path):
    """The sorted triangles of a GLB's first primitive, by the bits of all attributes at their corners."""
    with open(path, "rb") as file:
        gltf = Gltf(file.read(), "")
    primitive = gltf.json["meshes"][0]["primitives"][0]
    columns = [gltf.accessor(primitive["attributes"][name], raw_floats=True)[0] for name in sorted(primitive["attributes"])]
    # A position's -0 is read as 0.
    place = sorted(primitive["attributes"]).index("POSITION")
    columns[place] = [tuple(0 if bits == 1 << 31 else bits for bits in v) for v in columns[place]]
    vertices = list(zip(*columns))
    corners = iter(vertices[v] for (v,) in gltf.accessor(primitive["indices"])[0])
    return sorted(min((a, b, c), (b, c, a), (c, a, b)) for a, b, c in zip(corners, corners, corners))


def textured_obj(points, corners, texture):
    """corners: triangles of (point, texture coordinate)."""
    return (write.obj(points, []) + "".join(f"vt {u!r} {v!r}\n" for u, v in texture).encode() +
            "".join("f " + " ".join(f"{p + 1}/{t + 1}" for p, t in triangle) + "\n" for triangle in corners).encode())


# A square of two triangles with a seam along their common edge, and a triangle beside it without a seam.
POINTS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0)]
CUT = [((0, 0), (1, 1), (2, 2)), ((0, 3), (2, 4), (3, 5)), ((1, 1), (4, 0), (2, 2))]
TEXTURE = [(0, 0), (0.5, 0), (0.5, 1), (0.25, 0), (0.75, 1), (0, 1)]


class Seams(CliTest):
    def encode(self, *options, source=GLOBE):
        """Encodes and returns the path of the .lr file and the report of info on it."""
        path = self.path("-".join(["x", *options]) + ".lr")
        self.ok("encode", source, "-o", path, "--force", *options)
        return path, self.json("info", path, "--json", *(o for o in options if "weld" in o))

    def test_small(self):
        source = self.write("a.obj", textured_obj(POINTS, CUT, TEXTURE))
        figures = {(): (5, 7, 1, 1, 5), ("--weld=position",): (5, 7, 1, 1, 5), ("--no-weld",): (7, 7, 0, 2, 7),
                   ("--weld",): (7, 7, 0, 2, 7)}
        for options, wanted in figures.items():
            with self.subTest(options):
                info = self.json("info", source, *options, "--json")
                names = ("vertices", "copies", "seam_edges", "components", "border_edges")
                self.assertEqual(tuple(info[name] for name in names), wanted)
                mesh, = self.json("stats", source, *options, "--json")["meshes"]
                self.assertEqual(tuple(mesh[name] for name in names), wanted)
                for name in ("lean", "lean_no_warts", "lr", "lr_compact", "packed", "packed_cache"):
                    self.assertEqual(mesh["formats"][name].get("seam_bytes", 0) > 0, wanted[2] > 0, name)
                self.assertTrue(all(entry["ok"] for entry in
                                    self.json("verify", source, *options, "--json")["formats"].values()))
                lr = self.encode(*options, source=source)[1]
                self.assertEqual(tuple(lr[name] for name in names), wanted)
                self.assertEqual((lr["lr"]["vertices"], lr["lr"]["copies"], lr["lr"]["version"]), (*wanted[:2], 4))
                sections = lr["lr"]["sections"]
                self.assertEqual([s["kind"] for s in sections].count("seams"), int(wanted[2] > 0))
                per_copy = {s["name"]: s.get("per_copy", False) for s in sections if "name" in s}
                self.assertEqual(per_copy, {"POSITION": False, "TEXCOORD_0": wanted[2] > 0})

    def test_identical_copies_are_merged_unless_the_order_is_kept(self):
        triangles = [(0, 1, 2), (0, 2, 3)]
        points = [POINTS[v] for t in triangles for v in t]
        source = self.write("a.ply", write.ply(points, [(0, 1, 2), (3, 4, 5)]))
        _, merged = self.encode(source=source)
        self.assertEqual((merged["vertices"], merged["copies"], merged["lr"]["copies"]), (4, 4, 4))
        path, kept = self.encode("--keep-order", source=source)
        self.assertEqual((kept["vertices"], kept["copies"], kept["lr"]["vertices"], kept["lr"]["copies"]), (4, 6, 4, 6))
        out = self.path("out.ply")
        self.ok("decode", path, "-o", out, "--original-order")
        back = check_decode.read(out)
        self.assertEqual(back.indices, [0, 1, 2, 3, 4, 5])
        self.assertEqual([struct.unpack("<3f", p) for p in back.positions], points)

    def test_topology_is_that_of_welded_positions(self):
        """Compares the globe's topology with that of the mesh welded here."""
        source = check_decode.read(GLOBE)
        numbers = {}
        for position in source.positions:
            numbers.setdefault(struct.pack("<3f", *(x + 0.0 for x in struct.unpack("<3f", position))), len(numbers))
        number = [numbers[struct.pack("<3f", *(x + 0.0 for x in struct.unpack("<3f", p)))] for p in source.positions]
        faces = [tuple(number[v] for v in source.indices[i:i + 3]) for i in range(0, len(source.indices), 3)]
        welded = self.write("welded.ply", write.ply([struct.unpack("<3f", p) for p in numbers], faces))
        wanted = self.json("info", welded, "--no-weld", "--json")
        for path in (GLOBE, *(self.encode("--format", form)[0] for form in ("lean", "packed", "lr", "lr-compact"))):
            info = self.json("info", path, "--json")
            for name in ("triangles", "vertices", "components", "shells", "border_edges", "border_loops",
                         "nonmanifold_edges", "closed", "genus", "euler_characteristic", "valence6_percent"):
                self.assertEqual(info[name], wanted[name], (path, name))
            self.assertGreater(info["copies"], info["vertices"])
            self.assertGreater(info["seam_edges"], 0)
        cut = self.json("info", GLOBE, "--no-weld", "--json")
        self.assertGreater(cut["border_edges"], info["border_edges"])

    def test_smaller_than_cut(self):
        for options in ([], BITS):
            for form in ("packed", "lean", "lr", "lr-compact"):
                with self.subTest(options=options, format=form):
                    path, info = self.encode("--format", form, *options)
                    cut, _ = self.encode("--format", form, "--no-weld", *options)
                    self.assertLess(os.path.getsize(path), os.path.getsize(cut))
                    # {attribute: whether it has a value per copy}
                    per_copy = {s["name"]: s["per_copy"] for s in info["lr"]["sections"] if "name" in s}
                    self.assertEqual((per_copy["POSITION"], per_copy["TEXCOORD_0"]), (False, True))

    def test_decoding_gives_every_corner(self):
        wanted, out = glb_corners(GLOBE), self.path("out.glb")
        for options in (["--format", "packed"], ["--format", "lean"], ["--format", "lr"], ["--format", "lr-compact"],
                        ["--keep-order"], ["--no-weld"], ["--weld"]):
            with self.subTest(options):
                path, _ = self.encode(*options)
                self.ok("decode", path, "-o", out, "--force")
                self.assertEqual(glb_corners(out), wanted)
                again, _ = self.encode("--format", "packed", *options[2:], source=path)  # an .lr file as input
                self.ok("decode", again, "-o", out, "--force")
                self.assertEqual(glb_corners(out), wanted)
                self.ok("verify", path)

    def test_positions_of_copies_stay_together_when_quantized(self):
        path, _ = self.encode(*BITS)
        out = self.path("out.glb")
        self.ok("decode", path, "-o", out)
        info, source = self.json("info", out, "--json"), self.json("info", GLOBE, "--json")
        for name in ("triangles", "vertices", "copies", "components", "border_edges"):
            self.assertEqual(info[name], source[name], name)

    def test_minus_zero_is_zero(self):
        points = [(0.0, 0, 0), (1, 0, 0), (1, 1, 0), (-0.0, 0, 0), (1, 1, 0), (0, 1, 0)]
        source = self.write("a.ply", write.ply(points, [(0, 1, 2), (3, 4, 5)]))
        said = self.ok("encode", source, "-o", self.path("a.lr"), "--keep-order").err
        self.assertIn("1 vertices with -0 get the 0 of the vertex that they are joined with", said)
        self.ok("decode", self.path("a.lr"), "-o", self.path("out.ply"), "--original-order")
        self.assertEqual([p for p in check_decode.read(self.path("out.ply")).positions],
                         [struct.pack("<3f", *(x + 0.0 for x in p)) for p in points])
        for options in (["--no-weld"], ["--weld"]):
            self.assertNotIn("with -0", self.ok("encode", source, "-o", self.path("a.lr"), "--force", *options).err)
        self.assertNotIn("with -0", self.ok("info", self.path("a.lr")).err)

    def test_tolerance(self):
        points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 0.125, 0), (1, 1, 0.25), (0, 2, 0)]
        source = self.write("a.ply", write.ply(points, [(0, 1, 2), (3, 4, 5)]))
        # Vertices of one triangle are never joined, at any tolerance.
        for tolerance, vertices in (("0.0625", 6), ("0.125", 5), ("0.25", 4), ("1e-300", 6), ("1e300", 5)):
            info = self.json("info", source, "--weld-tolerance", tolerance, "--json")
            self.assertEqual(info["vertices"], vertices, tolerance)
        said = self.ok("encode", source, "-o", self.path("a.lr"), "--weld-tolerance", "0.25").err
        self.assertIn("--weld-tolerance: 2 vertices move, by 0.25 at most", said)
        self.assertEqual(self.json("info", self.path("a.lr"), "--json")["vertices"], 4)
        self.assertNotIn("--weld-tolerance", self.ok("info", source, "--weld-tolerance", "0.01").err)
        # The vertices of an .lr file are joined, too, and its seams are kept.
        path, before = self.encode()
        joined = self.json("info", path, "--weld-tolerance", "1e-9", "--json")
        self.assertEqual([joined[n] for n in ("vertices", "copies")], [before[n] for n in ("vertices", "copies")])

    def test_wrong_usage(self):
        out = ["-o", self.path("x.lr")]
        for command in (["info", GLOBE], ["stats", GLOBE], ["verify", GLOBE], ["encode", GLOBE, *out],
                        ["report", GLOBE, "-o", self.path("x.html")]):
            for options in (["--no-weld", "--weld"], ["--no-weld", "--weld=position"], ["--weld=none"],
                            ["--no-weld", "--weld-tolerance", "1"], ["--weld", "--weld-tolerance", "1"],
                            ["--weld-tolerance", "0"], ["--weld-tolerance", "-1"], ["--weld-tolerance", "near"],
                            ["--weld-tolerance", "nan"], ["--weld-tolerance"]):
                with self.subTest(command=command[0], options=options):
                    self.fails(*command, *options, codes=(WRONG_USAGE,), mentions=["--weld"])


if __name__ == "__main__":
    main()
