#!/usr/bin/env python3
"""test_scene.py LACEDRING C_SCENE: the C interface unpacks packed scenes to the same bytes as the command line."""

import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "scene"))
from make_scene import SceneMaker


def main():
    lacedring, c_scene = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        scene, packed, plain = (os.path.join(folder, name) for name in ("scene.glb", "packed.glb", "plain.glb"))
        SceneMaker().write(scene)
        for options in ([], ["--document", "packed"], ["--document", "plain"], ["--lossless", "--keep-order"]):
            subprocess.run([lacedring, "pack", scene, "-o", packed, *options], check=True, capture_output=True)
            subprocess.run([lacedring, "unpack", packed, "-o", plain], check=True, capture_output=True)
            subprocess.run([c_scene, packed, plain], check=True)


if __name__ == "__main__":
    main()
