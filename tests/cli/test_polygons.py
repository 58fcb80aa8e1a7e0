#!/usr/bin/env python3
"""test_polygons.py LACEDRING: polygons of every shape in OBJ, OFF and PLY are cut into the same triangles as by
tests/independent, which follows docs/formats-read.md. Shapes are random; LACEDRING_TEST_SEED repeats a run."""

import math
import os
import random
import re
import struct
import unittest

from cli_support import CliTest, main

import mesh_writers as write

SEED = int(os.environ.get("LACEDRING_TEST_SEED") or random.SystemRandom().randrange(1 << 32))


def as_float(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


def star(rng, n):
    """A random star-shaped polygon, which is simple and mostly concave."""
    angles = sorted(rng.random() * 2 * math.pi for _ in range(n))
    return [(r * math.cos(a), r * math.sin(a)) for a in angles for r in [rng.choice((0.2, 0.5, 1)) + rng.random() / 9]]


def tangle(rng, n):
    return [(rng.random(), rng.random()) for _ in range(n)]


def lattice(rng, n):
    """Corners on a small lattice, which coincide, lie on edges, or are flat."""
    return [(rng.randrange(4), rng.randrange(4)) for _ in range(n)]


def keyhole(rng, n):
    outer = [(math.cos(2 * math.pi * i / n), math.sin(2 * math.pi * i / n)) for i in range(n)]
    hole = [(0.3 * x, -0.3 * y) for x, y in outer]
    return outer + [outer[0]] + [hole[0]] + hole[1:] + [hole[0]]


def comb(rng, n):
    teeth = [(i // 2 if i % 2 else i / 2 + 0.25, 1 + rng.random() if i % 2 == 0 else 0.1) for i in range(n)]
    return teeth + [(n, -1), (-1, -1)]


def place(rng, shape):
    """Places a polygon on a random plane in space, or a little off it, at a random size and distance, and rotates its corners."""
    scale = 10.0 ** rng.choice((0, 0, 0, -20, 15))
    axes = [[rng.gauss(0, 1) for _ in range(3)] for _ in range(3)]
    if rng.random() < 0.5:
        axes = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    origin = [rng.choice((0, 0, 1000)) for _ in range(3)]
    height = rng.choice((0, 0, 0.01))
    points = [tuple(as_float(scale * (origin[k] + x * axes[0][k] + y * axes[1][k] + height * rng.random() * axes[2][k]))
                    for k in range(3)) for x, y in shape]
    first = rng.randrange(len(points))
    points = points[first:] + points[:first]
    return points if rng.random() < 0.5 else points[::-1]


def mesh(rng, count):
    points, faces = [], []
    for _ in range(count):
        kind = rng.choice((star, star, tangle, lattice, keyhole, comb))
        polygon = place(rng, kind(rng, rng.randrange(4, 14)))
        faces.append(tuple(range(len(points), len(points) + len(polygon))))
        points += polygon
    return points, faces


class Polygons(CliTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        print(f"LACEDRING_TEST_SEED={SEED}", flush=True)

    def check(self, name, data):
        source = self.write(name, data)
        self.same_triangles(source, self.resident(source))

    def test_every_shape(self):
        rng = random.Random(SEED)
        for i in range(2):
            points, faces = mesh(rng, 40)
            obj = write.obj(points, faces)
            first_faces = obj[obj.index(b"f "):] + obj[:obj.index(b"f ")]
            textured = re.sub(rb"(\d+)", rb"\1/\1", obj[obj.index(b"f "):])
            ply = write.ply(points, faces, "", real="double")
            doubles = write.ply([[x * (1 + 1e-12 * rng.random()) for x in p] for p in points], faces, ">", real="double")
            files = {"a.obj": obj, "b.obj": first_faces, "c.obj": obj[:obj.index(b"f ")] + b"vt 0 1\n" * len(points) + textured,
                     "a.off": write.off(points, faces), "a.ply": write.ply(points, faces), "b.ply": write.ply(points, faces, ">"),
                     "c.ply": ply, "d.ply": doubles}
            for name, data in files.items():
                with self.subTest(round=i, name=name, seed=SEED):
                    self.check(name, data)

    def test_quads(self):
        """All quadrangles on a small lattice."""
        rng = random.Random(SEED)
        points, faces = [], []
        for _ in range(1000):
            faces.append(tuple(range(len(points), len(points) + 4)))
            points += [(rng.randrange(4), rng.randrange(4), rng.choice((0, 0, 0, 1))) for _ in range(4)]
        self.check("quads.ply", write.ply(points, faces))

    def test_notch(self):
        """The notch of a concave pentagon stays empty."""
        text = b"v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n"
        self.check("a.obj", text)
        self.ok("decode", self.path("a.obj-resident.lr"), "-o", self.path("out.obj"))
        with open(self.path("out.obj")) as file:
            lines = [line.split() for line in file]
        points = [tuple(map(float, line[1:4])) for line in lines if line[:1] == ["v"]]
        areas = []
        for line in lines:
            if line[:1] == ["f"]:
                a, b, c = (points[int(word.split("/")[0]) - 1] for word in line[1:])
                areas.append(((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2)
        self.assertGreater(min(areas), 0)
        self.assertEqual(sum(areas), 10)

    def test_large(self):
        """A polygon of many corners, simple or tangled, takes seconds."""
        n = 50000
        rng = random.Random(SEED)
        spiral = [(r * math.cos(a), r * math.sin(a)) for i in range(n) for a in [i / 7] for r in [1 + a]]
        for shape in (star(rng, n), tangle(rng, n), lattice(rng, n), comb(rng, n), spiral + [(0.9 * x, 0.9 * y) for x, y in spiral[::-1]]):
            points = [(x, y, 0) for x, y in shape]
            source = self.write("large.obj", write.obj(points, [tuple(range(len(points)))]))
            self.assertEqual(self.json("info", source, "--json")["triangles"], len(points) - 2)


if __name__ == "__main__":
    main()
