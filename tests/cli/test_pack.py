#!/usr/bin/env python3
"""test_pack.py LACEDRING: glTF scenes packed and unpacked by every option, compared by tests/scene/compare_scenes.py."""

import base64
import json
import os
import struct
import subprocess
import sys

import cli_support
from cli_support import DONE, HERE, NO_DEVICE, CliTest, in_parallel, main, run

sys.path.insert(0, os.path.join(os.path.dirname(HERE), "scene"))
from compare_scenes import compare, geometry_differences, other_differences
from make_scene import SceneMaker
from scene_reader import Scene

FINE = ["--positions", "16", "--normals", "12", "--texcoords", "16", "--colors", "10", "--weights", "12"]
COARSE = ["--positions", "8", "--normals", "6", "--texcoords", "6", "--colors", "4", "--weights", "6"]


class Pack(CliTest):
    def setUp(self):
        super().setUp()
        for extension in ("glb", "gltf"):
            SceneMaker().write(self.path(f"scene.{extension}"))

    def pack(self, name, source, *options, extension="glb"):
        """Packs and unpacks, compares both scenes with the source, and returns pack's report and the two files."""
        packed, unpacked = self.path(f"{name}-packed.{extension}"), self.path(f"{name}-unpacked.glb")
        report = self.json("pack", source, "-o", packed, "--json", *options)
        self.ok("unpack", packed, "-o", unpacked)
        errors = None if "--lossless" in options else report["max_error"]
        before, after = Scene(source), Scene(unpacked)
        self.assertEqual(compare(before, after, errors, "--keep-order" in options), [], f"{name} {options}")
        if "--fallback" in options:  # as a reader without the extension sees it
            plain = Scene(packed)
            self.assertEqual([*geometry_differences(before, plain, errors), *other_differences(before, plain)], [], name)
        return report, packed, unpacked

    def test_options(self):
        """Packs the scene by every set of options, and prints a table of the sizes."""
        more = ([], ["--resident"], ["--fallback"], ["--keep-order"], ["--fallback", "--keep-order", "--resident"], ["--document", "plain"],
                ["--document", "packed"])
        cases = [(source, to, *bits, *options) for source in ("glb", "gltf") for to in ("glb", "gltf")
                 for bits in ([], ["--lossless"], FINE, COARSE) for options in more
                 if to == "glb" or options[:1] != ["--document"]]

        def one(i):
            source, to, *options = cases[i]
            return self.pack(f"{i}", self.path(f"scene.{source}"), *options, extension=to)[0]

        print()
        for case, report in zip(cases, in_parallel(one, range(len(cases)))):
            print(f"{report['bytes_before']:8} {report['bytes_after']:8}  {' '.join(case)}")

    def test_data_beside_packed_triangles(self):
        """Data beside the packed triangles: lines that share positions and have their own colors, morph targets of integers, whose
        bounds glTF requires, and matrices of small integers, whose columns are padded."""
        parts = [struct.pack("<12f", 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0), struct.pack("<6H", 0, 1, 2, 2, 1, 3), struct.pack("<12f", *[0.5] * 12),
                 struct.pack("<4H", 0, 1, 2, 3), struct.pack("<16b", *[1, 2, 3, 0] * 4), bytes(range(1, 13)) * 20]
        views, data = [], b""
        for part in parts:
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(part)})
            data += part
        views[4]["byteStride"] = 4
        kinds = [(5126, 4, "VEC3"), (5123, 6, "SCALAR"), (5126, 4, "VEC3"), (5123, 4, "SCALAR"), (5120, 4, "VEC3"), (5121, 20, "MAT3")]
        accessors = [{"bufferView": i, "componentType": t, "count": n, "type": shape} for i, (t, n, shape) in enumerate(kinds)]
        accessors[0].update(min=[0, 0, 0], max=[1, 1, 0])
        accessors[4].update(min=[1, 2, 3], max=[1, 2, 3])
        primitives = [{"attributes": {"POSITION": 0}, "indices": 1, "targets": [{"POSITION": 4}]},
                      {"attributes": {"POSITION": 0, "COLOR_0": 2}, "indices": 3, "mode": 1}]
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        source = self.write("neighbors.gltf", json.dumps({
            "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
            "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "meshes": [{"primitives": primitives}],
            "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(data), "uri": uri}]}).encode())
        for document in ("plain", "packed"):
            packed, plain = self.path(f"{document}.glb"), self.path(f"{document}.gltf")
            self.ok("pack", source, "-o", packed, "--lossless", "--document", document)
            self.ok("unpack", packed, "-o", plain)
            with open(plain, encoding="utf-8") as file:
                out = json.load(file)
            with open(self.path(f"{document}.bin"), "rb") as file:
                binary = file.read()
            self.assertEqual((out["accessors"][4]["min"], out["accessors"][4]["max"]), ([1, 2, 3], [1, 2, 3]))
            matrices = out["bufferViews"][out["accessors"][5]["bufferView"]]
            self.assertEqual(binary[matrices["byteOffset"]:matrices["byteOffset"] + matrices["byteLength"]], parts[5])
            lines = out["bufferViews"][out["accessors"][0]["bufferView"]]
            self.assertEqual(binary[lines["byteOffset"]:lines["byteOffset"] + lines["byteLength"]], parts[0])

    def test_other_commands_read_packed_scenes(self):
        """Commands that read meshes print the same for a packed scene as for the unpacked one."""
        commands = [["info"], ["stats"], ["verify"]]
        if self.has_command("compare"):
            commands.append(["compare", "--path", "compute", "--size", "96x64"])

        def said(command, path):
            outcome = run(*command, path, "--json")
            if command[0] == "compare" and outcome.code == NO_DEVICE:
                return None
            self.assertEqual(outcome.code, DONE, str(outcome))
            report = json.loads(outcome.out)
            for mesh in [report, *report.get("meshes", [])]:
                mesh.pop("file", None)
            return report, outcome.err.replace(path, "")

        def one(case):
            extension, *options = case
            name = "-".join(case)
            _, packed, unpacked = self.pack(name, self.path("scene.glb"), *options, extension=extension)
            if "--fallback" in options and extension == "gltf":
                os.remove(self.path(f"{name}-packed.fallback.bin"))  # readers of the streams do not open it
            for command in commands[:None if case == ("glb",) else 3]:
                of_packed, of_unpacked = said(command, packed), said(command, unpacked)
                if command == ["info"]:
                    streams = of_packed[0].pop("packed")
                    self.assertEqual(sum(streams["streams"]), streams["bytes"])
                    self.assertLess(0, streams["bytes"])
                self.assertEqual(of_packed, of_unpacked, f"{command} {case}")

        in_parallel(one, [("glb",), ("glb", "--document", "packed"), ("glb", "--fallback"), ("glb", "--keep-order"), ("gltf",),
                          ("gltf", "--fallback")])
        with open(self.path("glb-packed.glb"), "rb") as file:
            piped = json.loads(subprocess.run([cli_support.program, "info", "-", "--json"], stdin=file, capture_output=True, check=True).stdout)
        named = self.json("info", self.path("glb-packed.glb"), "--json")
        self.assertEqual({**piped, "file": ""}, {**named, "file": ""})
        self.assertIn("packed scene", self.ok("info", self.path("glb-packed.glb")).out)
        self.ok("encode", self.path("glb-packed.glb"), "-o", self.path("x.lr"))
        self.ok("encode", self.path("glb-unpacked.glb"), "-o", self.path("y.lr"))
        with open(self.path("x.lr"), "rb") as x, open(self.path("y.lr"), "rb") as y:
            self.assertEqual(x.read(), y.read())

    def test_buffers_outside_the_folder(self):
        """The buffers of a packed scene must be in its folder, unless others are allowed."""
        os.mkdir(self.path("in"))
        self.ok("pack", self.path("scene.glb"), "-o", self.path("in/s.gltf"))
        os.rename(self.path("in/s.bin"), self.path("s.bin"))
        with open(self.path("in/s.gltf"), encoding="utf-8") as file:
            document = json.load(file)
        document["buffers"][0]["uri"] = "../s.bin"
        self.write("in/s.gltf", json.dumps(document).encode())
        self.fails("info", self.path("in/s.gltf"), mentions=["../s.bin"])
        self.ok("info", self.path("in/s.gltf"), "--allow-outside")

    def test_memory(self):
        """The memory limit of plain scenes holds for packed ones, too."""
        self.ok("generate", "genus", "-o", self.path("g.glb"), "--triangles", "20000")
        self.ok("pack", self.path("g.glb"), "-o", self.path("p.glb"))
        self.fails("info", self.path("p.glb"), "--max-memory", "1", mentions=["MiB"])
        self.ok("info", self.path("p.glb"), "--max-memory", "16")


if __name__ == "__main__":
    main()
