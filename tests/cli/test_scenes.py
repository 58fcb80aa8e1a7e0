#!/usr/bin/env python3
"""test_scenes.py LACEDRING: scenes of several primitives, mirrored and instanced nodes, attributes that differ."""

import json
import struct
from collections import Counter

from cli_support import DONE, NO_DEVICE, CliTest, main, run

import mesh_readers
import mesh_writers as write

FLOAT, U16, I8 = 5126, 5123, 5120
CUBE = [(i & 1, i >> 1 & 1, i >> 2 & 1) for i in range(8)]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
QUICK = {"index_u32", "index_u16", "strip_restart", "strip_degenerate", "lean", "lr", "packed"}


class Scene:
    """Builds a glTF scene, written as a GLB."""

    def __init__(self):
        self.bin = b""
        self.document = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "meshes": [], "nodes": [],
                         "scene": 0, "scenes": [{"nodes": []}]}

    def accessor(self, rows, kind=FLOAT):
        rows = [tuple(row) if isinstance(row, (tuple, list)) else (row,) for row in rows]
        code = {FLOAT: "f", U16: "H", I8: "b"}[kind]
        data = b"".join(struct.pack(f"<{len(row)}{code}", *row) for row in rows)
        self.document["bufferViews"].append({"buffer": 0, "byteOffset": len(self.bin), "byteLength": len(data)})
        self.bin += data + b"\0" * (-len(data) % 4)
        self.document["accessors"].append({"bufferView": len(self.document["bufferViews"]) - 1, "componentType": kind,
                                           "count": len(rows), "type": ["", "SCALAR", "VEC2", "VEC3", "VEC4"][len(rows[0])]})
        return len(self.document["accessors"]) - 1

    def mesh(self, primitives, name=None):
        self.document["meshes"].append({"primitives": primitives, **({"name": name} if name else {})})
        return len(self.document["meshes"]) - 1

    def node(self, root=True, **node):
        self.document["nodes"].append(node)
        if root:
            self.document["scenes"][0]["nodes"].append(len(self.document["nodes"]) - 1)
        return len(self.document["nodes"]) - 1

    def glb(self):
        document = {**self.document, "buffers": [{"byteLength": len(self.bin)}]}
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        return (b"glTF" + struct.pack("<II", 2, 28 + len(text) + len(self.bin)) + struct.pack("<I", len(text)) + b"JSON" +
                text + struct.pack("<I", len(self.bin)) + b"BIN\0" + self.bin)


def cube_corners():
    """Positions, normals, texture coordinates and indices of a cube whose sides share no vertices."""
    points, normals, texture, indices = [], [], [], []
    for quad in QUADS:
        a, b, c = (CUBE[v] for v in quad[:3])
        e, f = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        normal = (e[1] * f[2] - e[2] * f[1], e[2] * f[0] - e[0] * f[2], e[0] * f[1] - e[1] * f[0])
        first = len(points)
        points += [CUBE[v] for v in quad]
        normals += [normal] * 4
        texture += [(0, 0), (1, 0), (1, 1), (0, 1)]
        indices += [first, first + 1, first + 2, first, first + 2, first + 3]
    return points, normals, texture, indices


def sample():
    """The bytes of a scene, and the positions of its placed triangles, computed here."""
    scene = Scene()
    points, normals, texture, indices = cube_corners()
    positions, directions, coordinates = scene.accessor(points), scene.accessor(normals), scene.accessor(texture)
    half = [scene.accessor(part, U16) for part in (indices[:12], indices[12:])]  # both share the vertices
    strip = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (0, 2, 0)]
    cube = scene.mesh([{"attributes": {"POSITION": positions, "NORMAL": directions, "TEXCOORD_0": coordinates},
                        "indices": i} for i in half], "cube")
    band = scene.mesh([{"attributes": {"POSITION": scene.accessor(strip)}, "mode": 5},
                       {"attributes": {"POSITION": positions}, "mode": 0}])
    scene.node(mesh=cube)
    child = scene.node(root=False, mesh=cube, translation=[4, 0, 0])
    scene.node(scale=[-2, 1, 1], children=[child])
    scene.node(mesh=band, extensions={"EXT_mesh_gpu_instancing": {"attributes": {
        "TRANSLATION": scene.accessor([(0, 8, 0), (0, 16, 0), (8, 16, 0)])}}})
    scene.document["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]

    def triangles(at, order):
        corners = [at(points[v]) for v in indices]
        return [tuple(corners[3 * t + k] for k in order) for t in range(len(indices) // 3)]

    placed = triangles(lambda p: p, (0, 1, 2)) + triangles(lambda p: (-2 * (p[0] + 4), p[1], p[2]), (0, 2, 1))
    for x, y in ((0, 8), (0, 16), (8, 16)):
        moved = [(p[0] + x, p[1] + y, p[2]) for p in strip]
        placed += [tuple(moved[v] for v in t) for t in ((0, 1, 2), (1, 3, 2), (2, 3, 4))]
    return scene.glb(), placed


def rotated(triangle):
    a, b, c = (tuple(float(x) + 0 for x in p) for p in triangle)
    return min((a, b, c), (b, c, a), (c, a, b))


class Scenes(CliTest):
    def setUp(self):
        super().setUp()
        data, self.placed = sample()
        self.scene = self.write("scene.glb", data)

    def test_info(self):
        report = self.json("info", self.scene, "--json")
        with self.subTest("primitives have mesh, mode, counts and placements"):
            rows = [[p[name] for name in ("mesh", "primitive", "name", "mode", "triangles", "vertices", "copies", "placed")]
                    for p in report["primitives"]]
            self.assertEqual(rows, [[0, 0, "cube", "triangles", 4, 8, 8, 2], [0, 1, "cube", "triangles", 8, 8, 16, 2],
                                    [1, 0, "", "strip", 3, 5, 5, 3]])
            self.assertEqual(self.json("info", self.scene, "--no-weld", "--json")["primitives"][0]["vertices"], 8)
        with self.subTest("primitives have all their attributes, the joined mesh those of all"):
            self.assertEqual([[a["name"] for a in p["attributes"]] for p in report["primitives"]],
                             [["POSITION", "NORMAL", "TEXCOORD_0"]] * 2 + [["POSITION"]])
            self.assertEqual([a["name"] for a in report["attributes"]], ["POSITION", "NORMAL"])
        with self.subTest("the sum of the primitives"):
            self.assertEqual(report["sum"], {"primitives": 3, "triangles": 15, "placed_triangles": 33, "vertices": 21, "copies": 29})
            self.assertEqual(report["triangles"], 33)
        outcome = self.ok("info", self.scene)
        with self.subTest("the text has a line per primitive and their sum"):
            self.assertRegex(outcome.out, r"\n +1 +0 +strip +3 +5 +5 +3  POSITION\n")
            self.assertRegex(outcome.out, r"\n +sum +15 +21 +29 +7  33 triangles where they are placed\n\Z")
        with self.subTest("notes name what is joined or made"):
            self.assertIn("1 primitive without normals (made from its triangles)", outcome.err)
            self.assertIn("3 primitives (joined into one)", outcome.err)

    def test_stats(self):
        mesh, = self.json("stats", self.scene, "--json")["meshes"]
        with self.subTest("the joined mesh and its primitives have triangles and formats"):
            self.assertEqual(mesh["triangles"], 33)
            self.assertIn("lr_compact", mesh["formats"])
            self.assertEqual([(p["mesh"], p["primitive"], p["triangles"]) for p in mesh["primitives"]],
                             [(0, 0, 4), (0, 1, 8), (1, 0, 3)])
        with self.subTest("bits per triangle follow from the bytes"):
            for part in [*mesh["primitives"], mesh["sum"]]:
                self.assertEqual(set(part["formats"]), QUICK)
                for name, entry in part["formats"].items():
                    self.assertAlmostEqual(entry["bits_per_triangle"], 8 * entry["bytes"] / part["triangles"], msg=name)
        with self.subTest("the sum adds up the primitives"):
            self.assertEqual(mesh["sum"]["triangles"], 15)
            for name in QUICK:
                for key in ("bytes", "seam_bytes"):
                    self.assertEqual(mesh["sum"]["formats"][name][key],
                                     sum(p["formats"][name][key] for p in mesh["primitives"]), name)
            self.assertEqual(mesh["sum"]["formats"]["index_u32"]["bytes"], 15 * 12)
            self.assertGreater(mesh["primitives"][1]["formats"]["packed"]["seam_bytes"], 0)
        with self.subTest("the text has the primitives, except with --table"):
            text = self.ok("stats", self.scene).out
            self.assertIn("3 primitives, each by itself", text)
            self.assertRegex(text, r"\n +sum, bytes +180 ")
            for table in ("table1", "total", "packed"):
                self.assertNotIn("by itself", self.ok("stats", "--table", table, self.scene).out)

    def test_many_primitives(self):
        scene = Scene()
        corners = scene.accessor([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
        for number in range(40):
            scene.node(mesh=scene.mesh([{"attributes": {"POSITION": corners}}], f"{'long' * 40}{number}"), translation=[0, 0, number])
        path = self.write("many.glb", scene.glb())
        for command in ("info", "stats"):
            text = self.ok(command, path).out
            self.assertIn("and 16 more", text)
            self.assertLess(max(map(len, text.splitlines())), 240)
        names = {p["name"] for p in self.json("info", path, "--json")["primitives"]}
        self.assertEqual(names, {"long" * 20 + "..."})
        self.assertEqual(len(self.json("verify", path, "--json")["primitives"]), 40)

    def test_verify(self):
        for options in ((), ("--no-weld",), ("--weld",), ("--weld-tolerance", "0.001")):
            verdict = self.json("verify", self.scene, *options, "--json")
            self.assertTrue(all(entry["ok"] for entry in verdict["formats"].values()), options)
            self.assertEqual(verdict["attributes"], {"ok": True, "why": ""})
            self.assertEqual(verdict["primitives"],
                             [{"mesh": m, "primitive": p, "name": name, "ok": True, "why": ""}
                              for m, p, name in ((0, 0, "cube"), (0, 1, "cube"), (1, 0, ""))])
        self.assertRegex(self.ok("verify", self.scene).out, r"\nattributes +ok\nprimitives +ok: 3, ")

    def test_degenerate_primitive(self):
        scene = Scene()
        corners = scene.accessor([(0, 0, 0), (1, 0, 0), (0, 1, 0)])
        scene.node(mesh=scene.mesh([{"attributes": {"POSITION": corners}},
                                    {"attributes": {"POSITION": corners}, "indices": scene.accessor([0, 1, 1], U16)}]))
        path = self.write("flat.glb", scene.glb())
        self.assertEqual([p["triangles"] for p in self.json("info", path, "--json")["primitives"]], [1, 1])
        mesh, = self.json("stats", path, "--json")["meshes"]
        self.assertEqual([p["triangles"] for p in mesh["primitives"]], [1, 0])
        self.assertEqual(mesh["primitives"][1]["formats"]["index_u32"]["bytes"], 0)
        self.assertEqual(mesh["sum"]["formats"]["index_u32"], mesh["primitives"][0]["formats"]["index_u32"])
        self.assertTrue(all(p["ok"] for p in self.json("verify", path, "--json")["primitives"]))

    def test_joined_mesh_has_the_placed_triangles(self):
        """Compares the triangles of an .lr file with those computed here: mirrored nodes, instances, strips."""
        lr, ply = self.path("a.lr"), self.path("a.ply")
        said = self.ok("encode", self.scene, "-o", lr).err
        self.assertRegex(said, r"not kept: [^\n]* \(lacedring pack keeps scenes\)\n")
        self.ok("decode", lr, "-o", ply)
        with open(ply, "rb") as file:
            mesh = mesh_readers.read_ply(file.read())
        corners = iter([struct.unpack("<3f", mesh.positions[v]) for v in mesh.indices])
        found = Counter(map(rotated, zip(corners, corners, corners)))
        self.assertEqual(found, Counter(map(rotated, self.placed)))

    def test_compare(self):
        if not self.has_command("compare"):
            self.skipTest("built without Vulkan")
        outcome = run("compare", self.scene, "--size", "160x120", "--path", "compute", "--json")
        if outcome.code == NO_DEVICE:
            self.skipTest(outcome.err)
        self.assertEqual(outcome.code, DONE, str(outcome))
        self.assertEqual(json.loads(outcome.out)["scene"], {"primitives": 3, "placed": 7, "mirrored": 2, "triangles": 33,
                                                           "ok": True, "why": ""})
        alone = self.write("one.ply", write.ply(CUBE, QUADS))
        outcome = run("compare", alone, "--size", "160x120", "--path", "compute", "--json")
        self.assertEqual(outcome.code, DONE, str(outcome))
        self.assertNotIn("scene", json.loads(outcome.out))

    def test_other_formats_have_no_primitives(self):
        single = Scene()
        single.node(mesh=single.mesh([{"attributes": {"POSITION": single.accessor([(0, 0, 0), (1, 0, 0), (0, 1, 0)])}}]))
        for path in (self.write("one.ply", write.ply(CUBE, QUADS)), self.write("one.glb", single.glb())):
            self.assertNotIn("primitives", self.json("info", path, "--json"))
            self.assertNotIn("primitives", self.json("stats", path, "--json")["meshes"][0])
            self.assertNotIn("primitives", self.json("verify", path, "--json"))
            self.assertNotIn("primitives", self.ok("info", path).out)
            self.assertNotIn("lacedring pack", self.ok("encode", path, "-o", self.path("o.lr"), "--force").err)
        obj = self.write("two.obj", write.obj(CUBE, QUADS) + b"usemtl a\ng b\n")
        self.assertNotIn("lacedring pack", self.ok("encode", obj, "-o", self.path("o.lr"), "--force").err)

    def test_skin(self):
        scene = Scene()
        attributes = {"POSITION": scene.accessor([(0, 0, 0), (1, 0, 0), (0, 1, 0)]),
                      "JOINTS_0": scene.accessor([(0, 0, 0, 0)] * 3, U16), "WEIGHTS_0": scene.accessor([(1.0, 0, 0, 0)] * 3)}
        scene.node(mesh=scene.mesh([{"attributes": attributes}]), skin=0)
        scene.document["skins"] = [{"joints": [0]}]
        lr = self.path("s.lr")
        self.assertRegex(self.ok("encode", self.write("skin.glb", scene.glb()), "-o", lr).err,
                         r"not kept: 1 skin \(lacedring pack keeps scenes\)\n")
        self.assertIn("lacedring pack keeps scenes", self.ok("decode", lr, "-o", self.path("s.glb")).err)
        self.assertNotIn("pack", self.ok("decode", lr, "-o", self.path("s.ply")).err)

    def test_memory(self):
        """Attributes that the joined mesh does not have count as memory, too."""
        scene = Scene()
        count = 1 << 17
        scene.document["accessors"].append({"componentType": FLOAT, "count": count, "type": "VEC3"})
        scene.document["accessors"].append({"componentType": FLOAT, "count": count, "type": "VEC4"})
        indices = scene.accessor([0, 1, 2], U16)
        scene.node(mesh=scene.mesh([{"attributes": {"POSITION": 0, f"_{n}": 1}, "indices": indices} for n in range(8)]))
        path = self.write("empty.glb", scene.glb())
        self.ok("encode", path, "-o", self.path("o.lr"), "--max-memory", "20")
        self.fails("info", path, "--max-memory", "20", mentions=["--max-memory"])


if __name__ == "__main__":
    main()
