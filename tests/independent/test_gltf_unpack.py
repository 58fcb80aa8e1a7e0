#!/usr/bin/env python3
"""test_gltf_unpack.py LACEDRING: packed scenes, decoded by gltf_unpack.py and by `lacedring unpack`, have the same values."""

import math
import os
import subprocess
import sys
import tempfile
import unittest
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(os.path.dirname(HERE), "scene")]
from gltf_unpack import FRONT, PackedScene, compare, extension_of, part_codes, varints
from gltf_writer import GltfWriter
from make_scene import Grid, SceneMaker, wave
from mesh_readers import BadFile

program = sys.argv.pop(1) if len(sys.argv) > 1 else None


def patchwork():
    """A grid of 150 interleaved parts, so that codes of parts used long ago occur, and an animation long enough to be coded."""
    scene, grid, parts = GltfWriter(), Grid(40, 40, wave), 150
    attributes = {"POSITION": scene.positions(grid.positions), "NORMAL": scene.attribute(grid.normals, "VEC3")}
    corners = [[] for _ in range(parts)]
    for quad in range(1600):
        corners[quad * quad * 7 % 1601 % parts] += grid.triangles[6 * quad:6 * quad + 6]
    primitives = [{"attributes": attributes, "indices": scene.indices(some)} for some in corners if some]
    times = [(i / 30,) for i in range(200)]
    turns = [(math.sin(t / 3) * 0.6, -math.cos(t / 2) * 0.8, math.sin(t) * 0.1, math.cos(t)) for t, in times]
    turns = [tuple(x / math.sqrt(sum(y * y for y in q)) for x in q) for q in turns]
    paths = {"rotation": (turns, "VEC4"), "translation": ([(t, t * t, 1e-30 * t) for t, in times], "VEC3")}
    time = scene.accessor(times, "SCALAR", limits=True)
    scene.json.update({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "animations": [{"samplers": [{"input": time, "output": scene.accessor(*values)} for values in paths.values()],
                        "channels": [{"sampler": i, "target": {"node": 0, "path": path}} for i, path in enumerate(paths)]}]})
    return scene


class GltfUnpack(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def run_program(self, *arguments):
        result = subprocess.run([program, *arguments], capture_output=True, text=True, timeout=120)
        self.assertEqual(result.returncode, 0, result.stderr)

    def packed_and_unpacked(self, source, name, *options):
        packed, unpacked = (os.path.join(self.folder, f"{kind}-{name}") for kind in ("packed", "unpacked"))
        self.run_program("pack", source, "-o", packed, *options)
        self.run_program("unpack", packed, "-o", unpacked)
        return packed, unpacked

    def test_scenes(self):
        # Most cases are resident, because this reader takes ten times as long for the storage form.
        cases = ([], ["--resident", "--lossless", "--document", "plain"], ["--keep-order", "--document", "plain"],
                 ["--resident", "--keep-order", "--document", "packed"], ["--resident", "--document", "packed"])
        for kind, scene in (("scene", SceneMaker()), ("patchwork", patchwork())):
            source = os.path.join(self.folder, f"{kind}.glb")
            scene.write(source)
            for i, options in enumerate(cases):
                with self.subTest(scene=kind, options=options):
                    packed, unpacked = self.packed_and_unpacked(source, f"{kind}-{i}.glb", *options)
                    self.assertEqual(compare(packed, unpacked), [])
            for i, options in enumerate((["--resident"], ["--resident", "--fallback"])):
                with self.subTest(scene=kind, options=options, to="gltf"):
                    self.assertEqual(compare(*self.packed_and_unpacked(source, f"{kind}-{i}.gltf", *options)), [])

    def test_features_occur(self):
        """The scenes have every kind of code, and the comparison finds changed values."""
        source = os.path.join(self.folder, "patchwork.glb")
        patchwork().write(source)
        packed, unpacked = self.packed_and_unpacked(source, "p.glb", "--resident", "--document", "plain")
        scene = PackedScene(packed)
        numbers = varints(zlib.decompress(scene.view(scene.streams[0]["parts"])))
        kinds = set()
        for code in numbers:
            kinds.add("new" if code == 0 else "lately" if code <= FRONT else "other")
            next(numbers)
            if code == 0:
                next(numbers)
        self.assertEqual(kinds, {"new", "lately", "other"})
        heads = [scene.buffers[0][coded.get("byteOffset", 0)] for coded in map(extension_of, scene.json["bufferViews"])
                 if coded and coded["coding"] == "floats"]
        self.assertIn(4 + 128, heads)  # coded quaternions
        self.assertIn(3, heads)
        _, exact = self.packed_and_unpacked(source, "q.glb", "--resident", "--lossless")
        self.assertNotEqual(compare(packed, exact), [])
        self.assertEqual(compare(packed, unpacked), [])

    def test_part_codes(self):
        codes = [0, 0, 1, 0, 0, 0, 2, 0, 1, 4]  # parts 0, 0, 1, 0, then the last part five more times
        self.assertEqual(part_codes(zlib.compress(bytes(codes)), 9, 2), [0, 0, 1, 0, 0, 0, 0, 0, 0])
        for bad in (codes[:-1], [*codes, 1, 0], [0, 2, 8], [1, 0], [0, 0, 0, 67, 7], [0, 0, 0, 65, 7], [0, 0, 0, 0, 1, 7]):
            with self.assertRaises(BadFile, msg=bad):
                part_codes(zlib.compress(bytes(bad)), 9, 2)


if __name__ == "__main__":
    unittest.main()
