"""Small scenes whose packed form has several streams, sets and parts, coded views and placeholders."""

import math
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "scene"))
from gltf_writer import GltfWriter  # noqa: E402


def grid(size, at=0.0):
    points = [(at + x, y * 0.5, 0.1 * ((x * x + y) % 5)) for y in range(size) for x in range(size)]
    cells = [y * size + x for y in range(size - 1) for x in range(size - 1)]
    return points, [v for c in cells for v in (c, c + 1, c + size, c + 1, c + size + 1, c + size)]


def normals(count):
    return [(math.sin(i * 0.3), 0.0, math.cos(i * 0.3)) for i in range(count)]


def colors(count):
    return [(i % 256, 7, 255 - i % 256) for i in range(count)]


def scene_of(meshes, **more):
    """The members of a document with one node per mesh. A mesh is a list of primitives."""
    return {"asset": {"version": "2.0"}, "meshes": [{"primitives": primitives} for primitives in meshes],
            "nodes": [{"mesh": i} for i in range(len(meshes))], "scenes": [{"nodes": list(range(len(meshes)))}], "scene": 0, **more}


def two_sets(w):
    """Two meshes of two parts each, which touch and so are one stream."""
    meshes = []
    for at in (0, 3):
        points, corners = grid(4, at)
        attributes = {"POSITION": w.positions(points), "NORMAL": w.attribute(normals(16), "VEC3")}
        half = len(corners) // 6 * 3
        meshes.append([{"attributes": attributes, "indices": w.indices(part)} for part in (corners[:half], corners[half:])])
    return scene_of(meshes)


def kinds(w):
    """Streams of three kinds: with seams, of integers, and with a morph target."""
    points, corners = grid(3)
    cut = [points[v] for v in corners]  # triangles share no vertices: all edges are seams
    seams = {"attributes": {"POSITION": w.positions(cut), "COLOR_0": w.attribute(colors(len(cut)), "VEC3", "B", True)},
             "indices": w.indices(range(len(cut)), "B")}
    integers = [tuple(round(20 * x) for x in p) for p in points]
    quantized = {"attributes": {"POSITION": w.attribute(integers, "VEC3", "h", limits=True)}, "indices": w.indices(corners, "I")}
    moved = [(0.0, 0.25 * (i % 3), 0.0) for i in range(9)]
    morphed = {"attributes": {"POSITION": w.positions(points)}, "targets": [{"POSITION": w.positions(moved)}], "indices": w.indices(corners)}
    return scene_of([[seams, quantized], [morphed]], extensionsUsed=["KHR_mesh_quantization"], extensionsRequired=["KHR_mesh_quantization"])


def animated(w):
    """Coded views of times, translations, rotations and other values, and points, which need the order of vertices."""
    points, corners = grid(3)
    positions = w.positions(points)
    times = w.accessor([(0.1 * i,) for i in range(60)], "SCALAR", limits=True)
    places = w.accessor([(math.sin(i), 0.5 * i, 1.0) for i in range(60)], "VEC3")
    turns = w.accessor([(0.0, math.sin(0.1 * i), 0.0, math.cos(0.1 * i)) for i in range(60)], "VEC4")
    w.accessor([(i % 4, 0, 0, 0) for i in range(100)], "VEC4", "B")
    samplers = [{"input": times, "output": places}, {"input": times, "output": turns}]
    channels = [{"sampler": i, "target": {"node": 0, "path": path}} for i, path in enumerate(("translation", "rotation"))]
    return scene_of([[{"attributes": {"POSITION": positions}, "indices": w.indices(corners)},
                      {"attributes": {"POSITION": positions}, "mode": 0}]],
                    animations=[{"samplers": samplers, "channels": channels}])


def scene_seeds():
    with tempfile.TemporaryDirectory() as folder:
        for make in (two_sets, kinds, animated):
            writer = GltfWriter()
            writer.json.update(make(writer))
            path = pathlib.Path(folder) / "scene.glb"
            writer.write(str(path))
            yield make.__name__, path.read_bytes()
