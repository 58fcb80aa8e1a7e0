#!/usr/bin/env python3
"""test_pack.py LACEDRING: glTF scenes packed and unpacked by every option, compared by tests/scene/compare_scenes.py."""

import os
import sys

import cli_support
from cli_support import HERE, CliTest, in_parallel, main

sys.path.insert(0, os.path.join(os.path.dirname(HERE), "scene"))
from compare_scenes import compare, geometry_differences, other_differences
from make_scene import SceneMaker
from scene_reader import Scene

FINE = ["--positions", "16", "--normals", "12", "--texcoords", "16", "--colors", "10", "--weights", "12"]
COARSE = ["--positions", "8", "--normals", "6", "--texcoords", "6", "--colors", "4", "--weights", "6"]


class Pack(CliTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        if not any(line.split()[:1] == ["pack"] for line in cls.help.splitlines()):
            cls.skipTest(cls, "no pack")

    def setUp(self):
        super().setUp()
        for extension in ("glb", "gltf"):
            SceneMaker().write(self.path(f"scene.{extension}"))

    def pack(self, name, source, *options, extension="glb"):
        """pack's report, and the packed and the unpacked file; the scenes in them are compared with the source's."""
        packed, unpacked = self.path(f"{name}-packed.{extension}"), self.path(f"{name}-unpacked.glb")
        report = self.json("pack", source, "-o", packed, "--json", *options)
        self.ok("unpack", packed, "-o", unpacked)
        errors = None if "--lossless" in options else report["max_error"]
        before, after = Scene(source), Scene(unpacked)
        self.assertEqual(compare(before, after, errors, "--keep-order" in options), [], f"{name} {options}")
        if "--fallback" in options:  # what a reader that does not know the extension sees
            plain = Scene(packed)
            self.assertEqual([*geometry_differences(before, plain, errors), *other_differences(before, plain)], [], name)
        return report, packed, unpacked

    def test_options(self):
        """Every set of options, and a table of what it makes of the scene."""
        more = ([], ["--fallback"], ["--keep-order"], ["--fallback", "--keep-order"], ["--document", "plain"], ["--document", "packed"])
        cases = [(source, to, *bits, *options) for source in ("glb", "gltf") for to in ("glb", "gltf")
                 for bits in ([], ["--lossless"], FINE, COARSE) for options in more
                 if to == "glb" or options[:1] != ["--document"]]

        def one(i):
            source, to, *options = cases[i]
            return self.pack(f"{i}", self.path(f"scene.{source}"), *options, extension=to)[0]

        print()
        for case, report in zip(cases, in_parallel(one, range(len(cases)))):
            print(f"{report['bytes_before']:8} {report['bytes_after']:8}  {' '.join(case)}")


if __name__ == "__main__":
    main()
