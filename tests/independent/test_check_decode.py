#!/usr/bin/env python3
"""The checker checked: every format of the same mesh reads alike, and every kind of damage is seen."""

import array
import base64
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_decode
import lr_reader
from mesh_readers import BadFile, floats_of_words

POINTS = [(0, 0, 0), (1.5, 0, 0), (1, 1, 0.25), (0, 1, 0), (0.1, 0.2, -3e-7), (5, 5, 5)]
FACES = [(0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 2, 3)]  # a quad, two triangles, a degenerate one
TRIANGLES = [(0, 1, 2), (0, 2, 3), (0, 4, 1), (1, 4, 2)]


def ply(points, faces, order="<", strips=None, real="float"):
    kind = {"float": "f", "double": "d"}[real]
    name = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\nformat {name} 1.0\ncomment x\nelement vertex {len(points)}\nproperty uchar red\n"
    head += "".join(f"property {real} {c}\n" for c in "xyz")
    if strips is None:
        head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty uchar flag\n"
    else:
        head += "element tristrips 1\nproperty list int int vertex_indices\n"
    head = (head + "end_header\n").encode()
    if order == "":
        body = "".join("7 " + " ".join(map(repr, map(float, p))) + "\n" for p in points)
        if strips is None:
            body += "".join(f"{len(f)} {' '.join(map(str, f))} 1\n" for f in faces)
        else:
            body += f"{len(strips)} {' '.join(map(str, strips))}\n"
        return head + body.encode()
    body = b"".join(struct.pack(f"{order}B3{kind}", 7, *p) for p in points)
    if strips is None:
        body += b"".join(struct.pack(f"{order}B{len(f)}iB", len(f), *f, 1) for f in faces)
    else:
        body += struct.pack(f"{order}i{len(strips)}i", len(strips), *strips)
    return head + body


def decoded(points, triangles):
    """As `lacedring decode` writes it."""
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n")
    return (head.encode() + b"".join(struct.pack("<3f", *p) for p in points) +
            b"".join(struct.pack("<B3I", 3, *t) for t in triangles))


def gltf(points, primitives, nodes=None, binary=False, uri=None, sparse=None):
    """primitives: (mode, indices)."""
    blob = b"".join(struct.pack("<3f", *p) for p in points)
    views = [{"buffer": 0, "byteLength": len(blob)}]
    accessors = [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(points)}]
    made = []
    for mode, indices in primitives:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 2 * len(indices)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5123, "type": "SCALAR", "count": len(indices)})
        blob += struct.pack(f"<{len(indices)}H", *indices) + bytes(2 * (len(indices) % 2))
        made.append({"attributes": {"POSITION": 0}, "indices": len(accessors) - 1, "mode": mode})
    if sparse is not None:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 4})
        blob += struct.pack("<I", sparse[0])
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 12})
        blob += struct.pack("<3f", *sparse[1])
        accessors[0]["sparse"] = {"count": 1, "indices": {"bufferView": len(views) - 2, "componentType": 5125},
                                  "values": {"bufferView": len(views) - 1}}
    out = {"asset": {"version": "2.0"}, "meshes": [{"primitives": made}], "bufferViews": views, "accessors": accessors,
           "buffers": [{"byteLength": len(blob)}]}
    if nodes is not None:
        out["nodes"] = nodes
        out["scenes"] = [{"nodes": [0]}]
    if binary:
        text = json.dumps(out).encode()
        text += b" " * (-len(text) % 4)
        blob += bytes(-len(blob) % 4)
        return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob)) + struct.pack("<I4s", len(text), b"JSON") +
                text + struct.pack("<I4s", len(blob), b"BIN\0") + blob)
    if uri is None:
        out["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
        return json.dumps(out).encode()
    out["buffers"][0]["uri"] = uri
    return json.dumps(out).encode(), blob


def flat(triangles):
    return [v for t in triangles for v in t]


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
        corners = [(POINTS[a], POINTS[b], POINTS[c]) for a, b, c in TRIANGLES]
        stl = b"solid binary".ljust(80) + struct.pack("<I", len(corners))
        stl += b"".join(struct.pack("<12fH", 0, 0, 0, *flat(t), 0) for t in corners)
        text = "solid a vertex b\n" + "".join(
            "facet normal 0 0 1\n outer loop\n" + "".join(f"  vertex {x!r} {y!r} {z!r}\n" for x, y, z in t) +
            " endloop\nendfacet\n" for t in corners) + "endsolid a\n"
        glb = gltf(POINTS, [(4, flat(TRIANGLES[2:])), (6, [0, 1, 2, 3])], binary=True)
        shifted, blob = gltf([(9, 9, 9)] + POINTS[1:], [(4, flat(TRIANGLES))], uri="a%20b.bin", sparse=(0, POINTS[0]))
        self.write("a b.bin", blob)
        files = {"a.obj": (v + f).encode(), "a.off": f"COFF # x\n\n6 4 0\n{off}\n{off_faces}".encode(), "b.stl": stl,
                 "c.stl": text.encode(), "a.ply": ply(POINTS, FACES), "b.ply": ply(POINTS, FACES, ">"),
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
        cases = {"turned": (POINTS, t[:3] + [(1, 2, 4)], "1 of them turned"), "missing": (POINTS, t[:3], "1 triangles missing"),
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
        self.assertEqual(values[0], 1.0000001192092896)  # a double alone would have rounded this to 1
        self.assertEqual(values[1], 1.0)
        self.assertEqual(values.tobytes()[8:12], b"\1\0\0\0")
        self.assertEqual(values.tobytes()[16:20], b"\0\0\0\x80")
        self.assertEqual(values[5], 0.0)

    def test_lean(self):
        C, F, W = 1 << 30, 1 << 29, 1 << 31
        # A two-sided ring of 0..3 around the tetrahedron-like quad, a one-sided ring of 4..6, one verbatim triangle.
        payload = [2, 1 | F, 3 | W, 2, 0, 2, 0 | C, 0, 5, 5 | F, 4 | C, 6, 5, 4]

        def stream(payload, rings2=4, rings1=3, triangles=None):
            head = [0x4E4C524C, 1, 7, rings2, rings1, 1, triangles]
            head.append(zlib.crc32(array.array("I", payload).tobytes(), zlib.crc32(array.array("I", head).tobytes())))
            return array.array("I", head + payload)

        # 0: (0,2,1); 1: tip 1 == next: degenerate; 2: wart (1, 3, next(2) = 3): degenerate; 3: (2,2,1): degenerate;
        # 4: (2,0,3); 5: (3,2,2): degenerate; 6 closes; 7: (0,0,3): degenerate; 8: (4,5,5): degenerate;
        # 9: (5,5,6) degenerate; 10 closes; the verbatim one
        _, out = lr_reader.decode_lean(stream(payload, triangles=3))
        self.assertEqual(out, [0, 2, 1, 2, 0, 3, 6, 5, 4])
        payload[1] = 3 | F  # right of 0: (1, 3, 0), turned
        payload[2] = 0 | W  # wart at 1: (1, 0, 3)
        payload[7] = 1      # right of 3: (0, 1, 3), next through the left word's CLOSE
        payload[8] = 6 | F  # one-sided: (4, 6, 5) turned
        _, out = lr_reader.decode_lean(stream(payload, triangles=7))
        self.assertEqual(out, [0, 2, 1, 0, 3, 1, 1, 0, 3, 2, 0, 3, 0, 1, 3, 5, 6, 4, 6, 5, 4])
        for damaged in (stream(payload, triangles=6), stream(payload, rings1=2, triangles=7)):
            with self.assertRaises(BadFile):
                lr_reader.decode_lean(damaged)
        damaged = stream(payload, triangles=7)
        damaged[9] ^= 1
        with self.assertRaises(BadFile):
            lr_reader.decode_lean(damaged)


if __name__ == "__main__":
    unittest.main()
