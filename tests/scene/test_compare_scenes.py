#!/usr/bin/env python3
"""compare_scenes.py accepts a scene with vertices and triangles in another order, and finds every single change."""

import json
import os
import random
import struct
import tempfile
import unittest

from compare_scenes import compare
from gltf_writer import GltfWriter, number
from make_scene import SceneMaker
from scene_reader import FORMAT, SHAPE, Number, Scene, columns, is_triangles


def spelled(value):
    """JSON for GltfWriter, numbers as their text."""
    if isinstance(value, dict):
        return {key: spelled(v) for key, v in value.items()}
    if isinstance(value, list):
        return [spelled(v) for v in value]
    return number(value) if isinstance(value, Number) else value


class Copy:
    """A scene that can be changed: its JSON, and the elements of every accessor. write() gives each accessor its own buffer view."""

    def __init__(self, scene, shuffle=None):
        self.json = spelled(scene.exact)
        self.values = [list(scene.accessor(i)) for i in range(len(self.json["accessors"]))]
        self.images = [scene.view(image["bufferView"]) if "bufferView" in image else None for image in scene.json["images"]]
        self.used = {}  # by accessor: a vertex that a triangle uses
        if shuffle:
            self.shuffle(scene, shuffle)

    def shuffle(self, scene, rng):
        """Shuffles vertices and triangles, makes triangle lists of strips and fans, and adds indices."""
        vertices = {a for _, _, p in scene.primitives() if is_triangles(p) for a in columns(p).values()}
        orders = {}  # by number of vertices: accessors used together get the same order
        for a in vertices:
            order = orders.setdefault(len(self.values[a]), rng.sample(range(len(self.values[a])), len(self.values[a])))
            self.values[a] = [self.values[a][old] for old in order]
        done = set()
        for m, p, primitive in scene.primitives():
            if primitive["attributes"]["POSITION"] not in vertices or primitive.get("indices") in done:
                continue
            corners = scene.corners(primitive)
            place = {old: new for new, old in enumerate(orders[scene.json["accessors"][primitive["attributes"]["POSITION"]]["count"]])}
            corners = [place[v] for v in corners]
            ours = self.json["meshes"][m]["primitives"][p]
            if is_triangles(primitive):
                triangles = [corners[i:i + 3] for i in range(0, len(corners), 3) if len(set(corners[i:i + 3])) == 3]
                rng.shuffle(triangles)
                corners = [v for t in triangles for turn in [rng.randrange(3)] for v in t[turn:] + t[:turn]]
                self.used.update({accessor: corners[0] for accessor in columns(primitive).values()})
                ours["mode"] = number("4") if primitive.get("mode", 4) > 4 else ours.get("mode", number("4"))
                if "mode" not in primitive:
                    del ours["mode"]
            if "indices" not in primitive:
                ours["indices"] = number(str(len(self.values)))
                self.json["accessors"].append({"componentType": number("5123"), "type": "SCALAR"})
                self.values.append([])
            index = int(ours["indices"].strip("@"))
            done.add(index)
            self.values[index] = [(v,) for v in corners]

    def write(self, path):
        writer = GltfWriter()
        writer.json = self.json
        self.json["bufferViews"] = []
        for accessor, values in zip(self.json["accessors"], self.values):
            component = FORMAT[int(accessor["componentType"].strip("@"))]
            rows, width = SHAPE[accessor["type"]]
            item = struct.Struct(f"<{rows * width}{'I' if component == 'f' else component}")
            for name in ("sparse", "byteOffset"):
                accessor.pop(name, None)
            padding = -item.size % 4 if rows > 1 else 0
            accessor["count"] = len(values)
            accessor["bufferView"] = writer.view(b"".join(item.pack(*v) + b"\0" * padding for v in values),
                                                 stride=item.size + padding if padding else None)
        for image, data in zip(self.json["images"], self.images):
            if data is not None:
                image["bufferView"] = writer.view(data)
        writer.write(path)
        return Scene(path)


def add(values, element, component=0, bits=1):
    """Changes low bits of one component of one element."""
    row = list(values[element])
    row[component] ^= bits
    values[element] = tuple(row)


class CompareScenes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="lacedring_scene_")
        self.addCleanup(folder.cleanup)
        self.path = lambda name: os.path.join(folder.name, name)
        SceneMaker().write(self.path("source.glb"))
        self.source = Scene(self.path("source.glb"))

    def differences(self, change, shuffle=True, **options):
        copy = Copy(self.source, random.Random(5) if shuffle else None)
        change(copy)
        return compare(self.source, copy.write(self.path("copy.glb")), **options)

    def primitive(self, name, index=0):
        mesh, = (m for m in self.source.json["meshes"] if m["name"] == name)
        return mesh["primitives"][index]

    def test_same(self):
        SceneMaker().write(self.path("source.gltf"))
        both = Scene(self.path("source.gltf"))
        self.assertEqual(compare(self.source, both, keep_order=True), [])
        self.assertEqual(compare(both, self.source, {"POSITION": 1e-5}), [])
        self.assertEqual(self.differences(lambda copy: None), [])
        self.assertEqual(self.differences(lambda copy: None, errors={}), [])
        self.assertEqual(self.differences(lambda copy: None, shuffle=False, keep_order=True), [])
        self.assertNotEqual(self.differences(lambda copy: None, keep_order=True), [])
        self.assertNotEqual(self.differences(lambda copy: None, keep_order=True, errors={}), [])

    def test_values(self):
        smooth, morphed, modes = self.primitive("smooth"), self.primitive("morphed"), self.primitive("modes")
        outlined = self.primitive("outlined", 1)
        accessors = [*columns(smooth).values(), *columns(morphed).values(), *columns(modes).values(),
                     self.primitive("skinned")["attributes"]["JOINTS_0"], self.primitive("skinned", 1)["attributes"]["WEIGHTS_0"],
                     *self.primitive("quantized")["attributes"].values(), *self.primitive("interleaved")["attributes"].values(),
                     self.primitive("shared", 2)["attributes"]["NORMAL"], smooth["indices"], morphed["indices"], outlined["indices"],
                     self.source.json["skins"][0]["inverseBindMatrices"],
                     *(s[name] for s in self.source.json["animations"][0]["samplers"] for name in ("input", "output"))]
        for accessor in accessors:
            with self.subTest(accessor=accessor):
                self.assertNotEqual(self.differences(lambda copy: add(copy.values[accessor], copy.used.get(accessor, 1))), [])

    def test_every_accessor_of_the_others(self):
        for _, _, primitive in self.source.primitives():
            if not is_triangles(primitive):
                for accessor in columns(primitive).values():
                    self.assertNotEqual(self.differences(lambda copy: add(copy.values[accessor], 2)), [])

    def test_triangles(self):
        index = self.primitive("smooth")["indices"]

        def flip(copy):
            copy.values[index][0:2] = reversed(copy.values[index][0:2])

        def lose(copy):
            del copy.values[index][-3:]

        def double(copy):
            copy.values[index] += copy.values[index][:3]

        for change in (flip, lose, double):
            for errors in (None, {"POSITION": 1e-4}):
                self.assertNotEqual(self.differences(change, errors=errors), [], change.__name__)

    def test_json(self):
        def image(copy):
            copy.images[0] = copy.images[0][:-1] + b"\0"

        def accessor(copy):
            copy.json["accessors"].append({"componentType": number("5121"), "type": "SCALAR"})
            copy.values.append([(0,)])

        changes = {
            "number": lambda copy: copy.json["extras"]["nested"]["again"].update(one=number("1")),
            "text": lambda copy: copy.json["extras"]["nested"]["again"].update(one="1.0"),
            "escape": lambda copy: copy.json["extras"]["nested"]["again"].update(text="cafe"),
            "lost": lambda copy: copy.json["nodes"][0].pop("extras"),
            "added": lambda copy: copy.json["nodes"][0].update(more=None),
            "order": lambda copy: copy.json["nodes"].reverse(),
            "instances": lambda copy: copy.json["nodes"][8].pop("extensions"),
            "material": lambda copy: copy.json["meshes"][0]["primitives"][0].update(material=number("1")),
            "mode": lambda copy: copy.json["meshes"][0]["primitives"][0].update(mode=number("5")),
            "count": lambda copy: copy.values[copy_of_times].pop(),
            "uri": lambda copy: copy.json["images"][1].update(uri="a.png"),
            "image": image, "accessor": accessor}
        copy_of_times = self.source.json["animations"][0]["samplers"][0]["input"]
        for name, change in changes.items():
            with self.subTest(name):
                self.assertNotEqual(self.differences(change), [])

    def test_quantized(self):
        rng = random.Random(9)
        smooth = self.primitive("smooth")["attributes"]

        def move(copy, most=1e-3, one=0.0):
            values = copy.values[smooth["POSITION"]]
            for i, row in enumerate(values):
                floats = struct.unpack("<3f", struct.pack("<3I", *row))
                moved = [x + rng.uniform(-most, most) + (one if i == 7 else 0) for x in floats]
                values[i] = struct.unpack("<3I", struct.pack("<3f", *moved))

        self.assertEqual(self.differences(move, errors={"POSITION": 1e-3}), [])
        self.assertEqual(self.differences(move, shuffle=False, errors={"POSITION": 1e-3}, keep_order=True), [])
        self.assertNotEqual(self.differences(move), [])
        for errors in ({"POSITION": 8e-4}, {"NORMAL": 1e-3}, {}):
            self.assertNotEqual(self.differences(move, errors=errors), [])
        for shuffle in (True, False):
            self.assertNotEqual(self.differences(lambda copy: move(copy, one=0.01), shuffle, errors={"POSITION": 1e-3},
                                                 keep_order=not shuffle), [])


if __name__ == "__main__":
    unittest.main()
