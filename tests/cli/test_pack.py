#!/usr/bin/env python3
"""test_pack.py LACEDRING: glTF scenes packed and unpacked by every option, compared by tests/scene/compare_scenes.py."""

import os
import sys

import cli_support
from cli_support import HERE, CliTest, in_parallel, main

sys.path.insert(0, os.path.join(os.path.dirname(HERE), "scene"))
from compare_scenes import compare  # noqa: E402
from make_scene import SceneMaker  # noqa: E402
from scene_reader import Scene  # noqa: E402

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

    def pack(self, name, source, *options):
        """pack's report, the packed and the unpacked file, whose scene is compared with the source's."""
        packed, unpacked = self.path(f"{name}-packed.glb"), self.path(f"{name}-unpacked.glb")
        report = self.json("pack", source, "-o", packed, "--json", *options)
        self.ok("unpack", packed, "-o", unpacked)
        errors = None if "--lossless" in options else report["max_error"]
        keep_order = "--keep-order" in options
        self.assertEqual(compare(Scene(source), Scene(unpacked), errors, keep_order), [], f"{name} {options}")
        return report, packed, unpacked

    def test_options(self):
        cases = {f"{extension} {' '.join((*bits, *more))}".strip(): (extension, *bits, *more)
                 for extension in ("glb", "gltf") for bits in ([], ["--lossless"], FINE, COARSE)
                 for more in ([], ["--fallback"], ["--keep-order"], ["--fallback", "--keep-order"])}

        def one(case):
            extension, *options = cases[case]
            name = "".join(c if c.isalnum() else "_" for c in case)
            return case, self.pack(name, self.path(f"scene.{extension}"), *options)[0]

        print()
        for case, report in in_parallel(one, cases):
            print(f"{report['bytes_before']:8} {report['bytes_after']:8}  {case}")


if __name__ == "__main__":
    main()
