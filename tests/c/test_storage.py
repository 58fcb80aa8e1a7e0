#!/usr/bin/env python3
"""test_storage.py LACEDRING CC HEADERS ASSETS: a C99 program with lacedring_storage.h and lacedring_stored_seams.h alone decodes .lr files in storage
form to the triangles and attributes of `lacedring decode`. It is compiled normally, without vectors (LACEDRING_PLAIN) and sanitized. examples/decode.c
decodes the same files, and resident ones, to the same surface. Both refuse every file with a changed bit."""

import pathlib
import random
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


def faces(vertices, triangles):
    """The triangles as positions, each beginning with its smallest, sorted."""
    turned = []
    for t in triangles:
        corners = [c["v"] for c in t]
        least = corners.index(min(corners))
        turned.append(corners[least:] + corners[:least])
    return sorted(turned), set(vertices)


def check_damage(programs, file, folder):
    """Changes one bit in each of 12 copies of the file."""
    seed = random.randrange(2**32)
    rng = random.Random(seed)
    whole = pathlib.Path(file).read_bytes()
    begin, size = struct.unpack_from("<QQ", whole, 32 + 8)
    for i in range(12):  # of the first section, and of the header and the section table
        bit = rng.randrange(8 * begin, 8 * (begin + size)) if i % 2 else rng.randrange(8 * 64)
        damaged = bytearray(whole)
        damaged[bit // 8] ^= 1 << bit % 8
        pathlib.Path(folder, "damaged.lr").write_bytes(damaged)
        for program in programs:
            if subprocess.run([program, f"{folder}/damaged.lr"], capture_output=True).returncode != 1:
                sys.exit(f"{program} accepts {file} with bit {bit} changed (seed {seed})")


def main():
    lacedring, compiler, headers, assets = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        alone = pathlib.Path(folder, "alone.c")
        alone.write_text('#define LACEDRING_DECODE_IMPLEMENTATION\n#include "lacedring_stored_seams.h"\n')
        subprocess.run([compiler, *FLAGS, "-Os", "-ffreestanding", "-I", headers, "-c", alone, "-o", f"{folder}/alone.o"], check=True)
        for variant, flags in VARIANTS.items():
            subprocess.run([compiler, *FLAGS, *flags, "-I", headers, HERE / "storage.c", "-o", f"{folder}/{variant}", "-lm"], check=True)
        example = HERE.parent.parent / "examples" / "decode.c"
        subprocess.run([compiler, *FLAGS, *VARIANTS["sanitized"], "-I", headers, example, "-o", f"{folder}/example", "-lm"], check=True)
        for mesh, options in [*CASES, *[(mesh, ["--resident", *options]) for mesh, options in CASES]]:
            run = [lacedring, "encode", f"{assets}/{mesh}", "-o", f"{folder}/mesh.lr", "--force", *options]
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
            done = subprocess.run([f"{folder}/example", f"{folder}/mesh.lr"], capture_output=True, text=True)
            if done.returncode != 0 or faces(*surface(done.stdout)) != faces(*wanted):
                sys.exit(f"{mesh} {options}: examples/decode.c: {done.stderr[-2000:] or 'another surface than lacedring decode'}")
            check_damage([f"{folder}/vectors", f"{folder}/example"], f"{folder}/mesh.lr", folder)
            print(f"{mesh} {options}: {len(wanted[0])} vertices, {len(wanted[1])} triangles alike")


if __name__ == "__main__":
    main()
