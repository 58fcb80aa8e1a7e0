#!/usr/bin/env python3
"""test_storage.py LACEDRING CC HEADERS ASSETS: a C99 program with lacedring_storage.h alone decodes .lr files in storage
form to the triangles and positions of `lacedring decode`: as it is, without vectors (LACEDRING_PLAIN) and sanitized."""

import pathlib
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
FLAGS = ["-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror", "-g"]
VARIANTS = {"vectors": ["-O2"], "plain": ["-O2", "-DLACEDRING_PLAIN"],
            "sanitized": ["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]}
CASES = [("blob.ply", ["--positions", "14"]), ("cut_torus.ply", ["--positions", "10"]), ("blob.ply", ["--positions", "20"])]


def surface(text):
    """The vertices, as they are when rounded to 32-bit floats, and the triangles of an OBJ."""
    vertices, triangles = [], []
    for line in text.splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append(struct.pack("<3f", *map(float, rest[:3])))
        elif word == "f":
            triangles.append([int(corner.split("/")[0]) for corner in rest])
    return vertices, triangles


def main():
    lacedring, compiler, headers, assets = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        alone = pathlib.Path(folder, "alone.c")
        alone.write_text('#define LACEDRING_DECODE_IMPLEMENTATION\n#include "lacedring_storage.h"\n')
        subprocess.run([compiler, *FLAGS, "-Os", "-ffreestanding", "-I", headers, "-c", alone, "-o", f"{folder}/alone.o"], check=True)
        for variant, flags in VARIANTS.items():
            subprocess.run([compiler, *FLAGS, *flags, "-I", headers, HERE / "storage.c", "-o", f"{folder}/{variant}", "-lm"], check=True)
        for mesh, options in CASES:
            run = [lacedring, "encode", f"{assets}/{mesh}", "-o", f"{folder}/mesh.lr", "--storage", "--force", *options]
            subprocess.run(run, check=True, capture_output=True)
            subprocess.run([lacedring, "decode", f"{folder}/mesh.lr", "-o", f"{folder}/mesh.obj", "--force"], check=True, capture_output=True)
            wanted = surface(pathlib.Path(folder, "mesh.obj").read_text())
            outputs = set()
            for variant in VARIANTS:
                done = subprocess.run([f"{folder}/{variant}", f"{folder}/mesh.lr"], capture_output=True, text=True)
                if done.returncode != 0:
                    sys.exit(f"{mesh} {options} {variant}: {done.stderr[-2000:]}")
                if surface(done.stdout) != wanted:
                    sys.exit(f"{mesh} {options} {variant}: another surface than lacedring decode")
                outputs.add(done.stdout)
            if len(outputs) != 1:
                sys.exit(f"{mesh} {options}: variants differ")
            print(f"{mesh} {options}: {len(wanted[0])} vertices, {len(wanted[1])} triangles alike")


if __name__ == "__main__":
    main()
