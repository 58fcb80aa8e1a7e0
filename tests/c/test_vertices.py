#!/usr/bin/env python3
"""test_vertices.py LACEDRING CC HEADERS: compiles lacedring_vertices.h with and without vectors (LACEDRING_PLAIN); with AVX2 it
decodes eight blocks at once. Both accept the same streams and mutations, report the same fault at the same position, and decode the
same values, which vertex_reader.py (docs/vertex-format.md) confirms."""

import array
import math
import os
import pathlib
import random
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "independent"))
from mesh_readers import BadFile  # noqa: E402
from vertex_reader import read_vertices  # noqa: E402

MAGIC = b"LRV1"
ROWS, COLUMNS = 51, 45  # 2295 vertices: 17 whole blocks, and a part of one
MANY = 150  # mutations of each stream
READ = 2  # of the accepted and of the refused mutations, read in Python
FLAGS = ["-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror", "-g"]
VARIANTS = {"lanes": ["-O2"], "plain": ["-O2", "-DLACEDRING_PLAIN"],
            "sanitized": ["-O1", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"]}


def grid(rng):
    """A PLY file of a bent sheet, with attributes of one to four values per vertex."""
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {ROWS * COLUMNS}"]
    head += [f"property float {name}" for name in ("x", "y", "z", "nx", "ny", "nz", "s", "t", "confidence")]
    head += [f"property uchar {name}" for name in ("red", "green", "blue", "alpha")]
    head += [f"element face {2 * (ROWS - 1) * (COLUMNS - 1)}", "property list uchar int vertex_indices", "end_header"]
    body = b""
    for i in range(ROWS * COLUMNS):
        x, y = i % COLUMNS / 10, i // COLUMNS / 10
        slope = math.cos(x) * 0.7
        length = math.hypot(1, slope)
        values = (x, y + rng.gauss(0, 0.01), math.sin(x), -slope / length, 0, 1 / length, x / 9, y / 9, rng.random())
        body += struct.pack("<9f4B", *values, *(max(0, min(255, int(c * 40 + rng.gauss(0, 2)))) for c in (x, y, x, 9)))
    for i in range((ROWS - 1) * COLUMNS):
        if i % COLUMNS == COLUMNS - 1:
            continue
        for face in ((i, i + 1, i + COLUMNS), (i + 1, i + COLUMNS + 1, i + COLUMNS)):
            body += struct.pack("<B3i", 3, *face)
    return "\n".join(head).encode() + b"\n" + body


def streams_of(path):
    """The vertex streams of an .lr file, from one magic number to the next. The last two words of a stream are 0, and its checksum
    shows where it ends."""
    words = array.array("I", path.read_bytes())
    magic = int.from_bytes(MAGIC, "little")
    begins = [i for i, word in enumerate(words) if word == magic] + [len(words)]
    for begin, behind in zip(begins, begins[1:]):
        for end in range(behind, begin + 9, -1):
            if words[end - 1] == words[end - 2] == 0 and checksum(words[begin:end]) == words[begin + 3]:
                yield words[begin:end]
                break
        else:
            sys.exit(f"{path.name}: a stream without an end")


def checksum(words):
    return zlib.crc32(words[4:].tobytes(), zlib.crc32(words[:3].tobytes()))


def mutated(words, rng):
    out = array.array("I", words)
    for _ in range(rng.choice((1, 1, 1, 2))):
        at = rng.randrange(len(out))
        kind = rng.randrange(4)
        if kind < 2:
            out[at] ^= 1 << rng.randrange(32)
        elif kind == 2:
            out[at] = rng.choice((0, 1, 0x80000000, 0xFFFFFFFF, rng.getrandbits(32)))
        else:
            out[at] = out[rng.randrange(len(out))]
    out[3] = checksum(out)
    return out


def decoded(words):
    """The line that the C programs must print; None if the stream is refused."""
    try:
        values = read_vertices(words.tobytes()).values
    except BadFile:
        return None
    total = 0
    for byte in values:
        total = 31 * total + byte & 0xFFFFFFFF
    return str(total)


def main():
    lacedring, compiler, headers = sys.argv[1:]
    seed = int(os.environ.get("LACEDRING_SEED", "20261127"))
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        mesh = folder / "grid.ply"
        mesh.write_bytes(grid(rng))
        streams = []
        for i, bits in enumerate(([], ["--positions", "12", "--normals", "9", "--texcoords", "11", "--colors", "6"])):
            out = folder / f"{i}.lr"
            subprocess.run([lacedring, "encode", "--resident", mesh, "-o", out, *bits], check=True, capture_output=True)
            streams += streams_of(out)
        kinds = {(words[2] & 31, words[2] >> 5 & 7) for words in streams}
        if not {1, 2, 3, 4} <= {n for n, _ in kinds} or not {0, 1, 2, 3} <= {mapping for _, mapping in kinds}:
            sys.exit(f"too few kinds of streams: {sorted(kinds)}")
        streams = [out for words in streams for out in [words] + [mutated(words, rng) for _ in range(MANY)]]
        given = b"".join(struct.pack("<I", len(words)) + words.tobytes() for words in streams)
        lines = {}
        for name, options in VARIANTS.items():
            program = folder / name
            subprocess.run([compiler, *FLAGS, *options, "-I", headers, HERE / "vertices.c", "-o", program, "-lm"],
                           check=True)
            done = subprocess.run([program], input=given, capture_output=True)
            if done.returncode != 0:
                sys.exit(f"{name}: exit {done.returncode} (seed {seed}): {done.stderr.decode()[-2000:]}")
            lines[name] = done.stdout.decode().splitlines()
            if len(lines[name]) != len(streams):
                sys.exit(f"{name}: {len(lines[name])} lines for {len(streams)} streams (seed {seed})")
        accepted = []
        for i, (words, *said) in enumerate(zip(streams, *lines.values())):
            if len(set(said)) != 1:
                sys.exit(f"stream {i} (seed {seed}): {dict(zip(lines, said))}")
            if not said[0].startswith("no "):
                accepted.append((i, words, said[0]))
        for i, words, line in rng.sample(accepted, min(READ, len(accepted))):
            if decoded(words) != line:
                sys.exit(f"stream {i} (seed {seed}): the C decoder says {line}, the document {decoded(words)}")
        refused = [words for words, line in zip(streams, lines["plain"]) if line.startswith("no ")]
        for words in rng.sample(refused, min(READ, len(refused))):
            if decoded(words) is not None:
                sys.exit(f"a stream that is refused is sound by the document (seed {seed})")
        print(f"{len(streams)} streams alike, {len(accepted)} of them accepted")
        if not len(streams) // 20 < len(accepted) < len(streams):
            sys.exit("mutations are all refused, or none is")


if __name__ == "__main__":
    main()
