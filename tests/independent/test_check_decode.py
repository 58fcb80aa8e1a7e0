#!/usr/bin/env python3
"""Tests of check_decode.py: it reads every format of a mesh the same, and finds every kind of damage."""

import array
import os
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from lean_reader import decode_lean
from mesh_readers import BadFile, floats_of_words
from mesh_writers import decoded, flat, gltf, ply, stl, stl_text

POINTS = [(0, 0, 0), (1.5, 0, 0), (1, 1, 0.25), (0, 1, 0), (0.1, 0.2, -3e-7), (5, 5, 5)]
FACES = [(0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 2, 3)]  # a quad, two triangles, a degenerate one
TRIANGLES = [(0, 1, 2), (0, 2, 3), (0, 4, 1), (1, 4, 2)]


class CheckDecode(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()

    def tearDown(self):
        self.folder.cleanup()

    def write(self, name, data):
        path = os.path.join(self.folder.name, name)
        with open(path, "wb") as file:
            file.write(data)
        return path

    def check(self, source, target, expected=0, *options):
        script = os.path.join(os.path.dirname(os.path.abspath(__file__)), "check_decode.py")
        result = subprocess.run([sys.executable, "-B", script, source, target, *options], capture_output=True, text=True)
        self.assertEqual(result.returncode, expected, result.stdout + result.stderr)
        self.assertEqual(result.stdout.count("\n"), 1)
        self.assertEqual(result.stderr, "")
        return result.stdout

    def test_formats_agree(self):
        out = self.write("out.ply", decoded(POINTS[::-1], [tuple(5 - v for v in t[1:] + t[:1]) for t in TRIANGLES]))
        v = "".join("v " + " ".join(map(repr, map(float, p))) + " \\\n1\n" for p in POINTS)
        f = "f 1/1 2/1 3/1 4/1\nf -6/1 5//1 -5/1/1 # comment\nf 2 5 3\nf 3 3 4\n"
        off = "".join(f"{x!r} {y!r} {z!r} 255 0 0\n" for x, y, z in POINTS)
        off_faces = "".join(f"{len(t)}  {' '.join(map(str, t))} 9 9 9\n" for t in FACES)
        glb = gltf(POINTS, [(4, flat(TRIANGLES[2:])), (6, [0, 1, 2, 3])], binary=True)
        shifted, blob = gltf([(9, 9, 9)] + POINTS[1:], [(4, flat(TRIANGLES))], uri="a%20b.bin", sparse=(0, POINTS[0]))
        self.write("a b.bin", blob)
        files = {"a.obj": (v + f).encode(), "a.off": f"COFF # x\n\n6 4 0\n{off}\n{off_faces}".encode(), "b.stl": stl(POINTS, TRIANGLES),
                 "c.stl": stl_text(POINTS, TRIANGLES).replace(b"solid a", b"solid a vertex b", 1), "a.ply": ply(POINTS, FACES), "b.ply": ply(POINTS, FACES, ">"),
                 "c.ply": ply(POINTS, FACES, ""), "a.glb": glb, "b.gltf": shifted,
                 "d.ply": ply(POINTS, [], "<", strips=[1, 2, 0, 3, -1, 0, 4, 1, -1, 1, 4, 2]),
                 "e.ply": ply(POINTS, [], "", strips=[1, 2, 0, 3, -1, 0, 4, 1, -1, 1, 4, 2]),
                 "c.gltf": gltf(POINTS, [(5, [1, 2, 0, 3]), (4, flat(TRIANGLES[2:]))])}
        for name, data in files.items():
            with self.subTest(name):
                self.check(self.write(name, data), out)

    def test_doubles_stay_doubles(self):
        points = [(0.1, 0.2, 0.3), (1, 0, 0), (0, 1, 0)]
        source = self.write("a.ply", ply(points, [(0, 1, 2)], real="double"))
        self.check(source, self.write("b.ply", ply(points, [(1, 2, 0)], real="double", order="")))
        self.check(source, self.write("c.ply", decoded(points, [(0, 1, 2)])), 1)

    def test_transforms(self):
        nodes = [{"translation": [1, 2, 3], "children": [1, 2]}, {"mesh": 0, "scale": [-2, 1, 1]},
                 {"mesh": 0, "rotation": [0, 0, 1, 0]}]
        source = self.write("a.gltf", gltf(POINTS[:3], [(4, [0, 1, 2])], nodes))
        points = [(1 - 2 * x, 2 + y, 3 + z) for x, y, z in POINTS[:3]] + [(1 - x, 2 - y, 3 + z) for x, y, z in POINTS[:3]]
        self.check(source, self.write("b.ply", decoded(points, [(0, 2, 1), (3, 4, 5)])))
        self.check(source, self.write("c.ply", decoded(points, [(0, 1, 2), (3, 4, 5)])), 1)

    def test_damage_is_seen(self):
        source = self.write("a.ply", ply(POINTS, FACES))
        t = TRIANGLES
        moved = [(0, 0, 1e-45)] + POINTS[1:]
        negative = [(-0.0, 0, 0)] + POINTS[1:]
        cases = {"turned": (POINTS, t[:3] + [(1, 2, 4)], "1 of them reversed"), "missing": (POINTS, t[:3], "1 triangles missing"),
                 "extra": (POINTS, t + t[:1], "1 that should not"), "moved": (moved, t, "3 triangles missing"),
                 "sign": (negative, t, "3 triangles missing"), "degenerate": (POINTS, t + [(2, 2, 3)], "1 degenerate triangles")}
        for name, (points, triangles, why) in cases.items():
            with self.subTest(name):
                self.assertIn(why, self.check(source, self.write("out.ply", decoded(points, triangles)), 1))
        good = decoded(POINTS, t)
        self.check(source, self.write("short.ply", good[:-1]), 1)
        self.check(source, os.path.join(self.folder.name, "missing.ply"), 1)
        self.check(source, self.write("out.ply", good))

    def test_weld(self):
        points = POINTS[:3] + [POINTS[0]]
        source = self.write("a.ply", ply(points, [(0, 1, 2), (0, 3, 1)]))
        out = self.write("b.ply", decoded(points, [(0, 1, 2)]))
        self.check(source, out, 1)
        self.check(source, out, 0, "--weld=position")
        self.check(source, self.write("c.ply", decoded(points, [(3, 1, 2), (1, 3, 0)])))

    def test_rounding(self):
        words = [b"1.00000005960464477539062500000001", b"1.000000059604644775390625", b"1e-45", b"0.1", b"-0", b"1e-60"]
        values = floats_of_words(words)
        self.assertEqual(values[0], 1.0000001192092896)  # rounding through a double would give 1
        self.assertEqual(values[1], 1.0)
        self.assertEqual(values.tobytes()[8:12], b"\1\0\0\0")
        self.assertEqual(values.tobytes()[16:20], b"\0\0\0\x80")
        self.assertEqual(values[5], 0.0)

    def test_lean(self):
        C, F, W = 1 << 30, 1 << 29, 1 << 31
        # A two-sided ring of vertices 0 to 3, a one-sided ring of 4 to 6, and one verbatim triangle.
        payload = [2, 1, 1, 2, 0, 3, 0 | C, 0, 4, 5, 4 | C, 6, 5, 4]

        def stream(payload, rings2=4, rings1=3, triangles=None):
            head = [0x4E4C524C, 1, 7, rings2, rings1, 1, triangles]
            head.append(zlib.crc32(array.array("I", payload).tobytes(), zlib.crc32(array.array("I", head).tobytes())))
            return array.array("I", head + payload)

        # Slot 0: (0,2,1); 4: (2,0,3); 6 and 10 close rings; the others have no triangle; then the verbatim triangle.
        _, out = decode_lean(stream(payload, triangles=3))
        self.assertEqual(out, [0, 2, 1, 2, 0, 3, 6, 5, 4])
        payload[1] = 3 | F  # right of 0: (1, 3, 0), flipped
        payload[2] = 0 | W  # wart at 1: (1, 0, 3)
        payload[7] = 1      # right of 3: (0, 1, 3), next through the left word's CLOSE
        payload[8] = 6 | F  # one-sided: (4, 6, 5), flipped
        _, out = decode_lean(stream(payload, triangles=7))
        self.assertEqual(out, [0, 2, 1, 0, 3, 1, 1, 0, 3, 2, 0, 3, 0, 1, 3, 5, 6, 4, 6, 5, 4])
        for damaged in (stream(payload, triangles=6), stream(payload, rings1=2, triangles=7)):
            with self.assertRaises(BadFile):
                decode_lean(damaged)
        damaged = stream(payload, triangles=7)
        damaged[9] ^= 1
        with self.assertRaises(BadFile):
            decode_lean(damaged)


if __name__ == "__main__":
    unittest.main()
