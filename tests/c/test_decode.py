#!/usr/bin/env python3
"""test_decode.py CC HEADERS: a C99 program with lacedring_decode.h alone accepts the same golden streams and mutations of them as
the readers in tests/independent, and decodes the same triangles."""

import array
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
from lean_reader import decode_lean  # noqa: E402
from mesh_readers import BadFile  # noqa: E402
from packed_reader import decode_packed  # noqa: E402

LARGEST_OBJECT = 18 * 1024  # bytes, at -Os, symbols included
PACKED = 0x3250524C  # magic
FLAGS = ["-std=c99", "-pedantic-errors", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]


def golden(path):
    """The stream of a golden file: a line "words N", then N words."""
    name, count, *words = path.read_text().split()
    assert name == "words"
    return array.array("I", (int(word, 16) for word in words[:int(count)]))


def with_checksum(words, packed):
    header = 4 if packed else 8
    if len(words) >= header:
        words[header - 1] = zlib.crc32(words[header:].tobytes(), zlib.crc32(words[:header - 1].tobytes()))
    return words


def mutated(words, rng):
    out = array.array("I", words)
    for _ in range(rng.choice((1, 1, 1, 2, 5))):
        at = rng.randrange(len(out))
        kind = rng.randrange(5)
        if kind == 0:
            out[at] ^= 1 << rng.randrange(32)
        elif kind == 1:
            out[at] = rng.choice((0, 1, 0x1FFFFFFF, 0x20000000, 0x40000000, 0x80000000, 0xFFFFFFFF))
        elif kind == 2:
            out[at] = out[rng.randrange(len(out))]
        elif kind == 3:
            out[at] = (out[at] + rng.choice((-1, 1))) & 0xFFFFFFFF
        else:
            out = out[:rng.randrange(len(out))] if rng.random() < 0.1 else out
            if not out:
                return out
    return out if rng.random() < 0.05 else with_checksum(out, words[0] == PACKED)


def expected(words):
    try:
        decode = decode_packed if words[:1] == array.array("I", [PACKED]) else decode_lean
        return " ".join(map(str, decode(words)[1]))
    except BadFile:
        return None


def main():
    compiler, headers = sys.argv[1:]
    seed = int(os.environ.get("LACEDRING_SEED", "20261126"))
    rng = random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        alone = pathlib.Path(folder, "alone.c")
        alone.write_text('#define LACEDRING_DECODE_IMPLEMENTATION\n#include "lacedring_decode.h"\n')
        subprocess.run([compiler, *FLAGS, "-Os", "-ffreestanding", "-I", headers, "-c", alone, "-o", f"{folder}/alone.o"], check=True)
        size = os.path.getsize(f"{folder}/alone.o")
        if size > LARGEST_OBJECT:
            sys.exit(f"the decoder's object has {size} bytes, more than {LARGEST_OBJECT}")
        program = f"{folder}/decode"
        subprocess.run([compiler, *FLAGS, "-O1", "-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all", "-I", headers,
                        HERE / "decode.c", "-o", program], check=True)
        streams = []
        for path in sorted((HERE.parent / "golden").glob("*-*.hex")):
            if path.name.startswith("file-") or "-lr" in path.name:
                continue
            words = golden(path)
            # Packed streams have thousands of triangles and take long in Python.
            many = 1500 if len(words) < 1000 and words[0] != PACKED else 20 if words[0] != PACKED else 150
            streams += [words] + [mutated(words, rng) for _ in range(many)]
        given = b"".join(struct.pack("<I", len(words)) + words.tobytes() for words in streams)
        done = subprocess.run([program], input=given, capture_output=True)
        if done.returncode != 0:
            sys.exit(f"exit {done.returncode} (seed {seed}): {done.stderr.decode()[-2000:]}")
        lines = done.stdout.decode().splitlines()
        if len(lines) != len(streams):
            sys.exit(f"{len(lines)} lines for {len(streams)} streams")
        accepted = 0
        for i, (words, line) in enumerate(zip(streams, lines)):
            wanted = expected(words)
            accepted += wanted is not None
            if (wanted is None) != line.startswith("no ") or (wanted is not None and line.strip() != wanted):
                sys.exit(f"stream {i} (seed {seed}): the C decoder says {line[:60]}, the document {str(wanted)[:60]}")
        print(f"{len(streams)} streams alike, {accepted} of them accepted; the object has {size} bytes")
        if not len(streams) // 20 < accepted < len(streams):
            sys.exit("mutations are all refused, or none is")


if __name__ == "__main__":
    main()
