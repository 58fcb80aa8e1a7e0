#!/usr/bin/env python3
"""test_storage.py LACEDRING CC HEADERS ASSETS: a C99 program with lacedring_storage.h and lacedring_stored_seams.h alone decodes .lr files in storage
form to the triangles and attributes of `lacedring decode`. It is compiled normally, without vectors (LACEDRING_PLAIN) and sanitized."""

import pathlib
import struct
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
FLAGS = ["-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror", "-g"]
VARIANTS = {"vectors": ["-O2"], "plain": ["-O2", "-DLACEDRING_PLAIN"],
            "sanitized": ["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]}
CASES = [("blob.ply", ["--positions", "14"]), ("cut_torus.ply", ["--positions", "10"]), ("blob.ply", ["--positions", "20"]),
         ("globe.glb", ["--positions", "14", "--normals", "10", "--texcoords", "12"])]
ATTRIBUTES = ["v", "vt", "vn"]  # in the order of the numbers of a corner


def surface(text):
    """The vertices of an OBJ, rounded to 32-bit floats, and its triangles as the values of their corners."""
    values, triangles = {word: [] for word in ATTRIBUTES}, []
    for line in text.splitlines():
        word, *rest = line.split() or [""]
        if word in values:
            values[word].append(struct.pack(f"<{len(rest)}f", *map(float, rest)))
        elif word == "f":
            numbers = [dict(zip(ATTRIBUTES, corner.split("/"))) for corner in rest]
            triangles.append([{word: values[word][int(n) - 1] for word, n in corner.items() if n} for corner in numbers])
    return values["v"], triangles


def main():
    lacedring, compiler, headers, assets = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        alone = pathlib.Path(folder, "alone.c")
        alone.write_text('#define LACEDRING_DECODE_IMPLEMENTATION\n#include "lacedring_stored_seams.h"\n')
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
                vertices, triangles = surface(done.stdout)
                if triangles != wanted[1] or set(vertices) != set(wanted[0]):
                    sys.exit(f"{mesh} {options} {variant}: another surface than lacedring decode")
                outputs.add(done.stdout)
            if len(outputs) != 1:
                sys.exit(f"{mesh} {options}: variants differ")
            print(f"{mesh} {options}: {len(wanted[0])} vertices, {len(wanted[1])} triangles alike")


if __name__ == "__main__":
    main()
