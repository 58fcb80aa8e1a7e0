#!/usr/bin/env python3
"""test_layers.py ROOT: who may include whom. Folders depend downwards only; lrcore on the language's own headers alone, and
its decoders on nothing of rings and corner tables."""

import pathlib
import re
import sys

# In the order in which data flows: each may include itself and those before it.
LAYERS = ["lrcore", "lrio", "lrlab", "shaders", "renderer", "app"]
CORE = ["include", "base", "topology", "ring", "codec"]
# What decoding and validating is made of: no encoder, nothing of CORE between base and codec.
DECODERS = ["codec/lean/lean_format.h", "codec/lean/lean_stream.h", "codec/lean/lean_stream.cpp",
            "codec/packed/packed_format.h", "codec/packed/packed_stream.h", "codec/packed/record.h", "codec/packed/record.cpp",
            "codec/packed/decode.cpp", "codec/packed/validate.cpp", "codec/tables/lr_format.h", "codec/tables/lr_table.h",
            "codec/tables/compact_lr.h", "codec/tables/lr_stream.h", "codec/tables/lr_stream.cpp", "codec/tables/operators.h",
            "codec/tables/fan.h", "codec/tables/stream_header.h", "codec/tables/validate.cpp"]
# The standard headers that a freestanding-minded library wants. <thread> is for those who ask for threads.
STANDARD = {"algorithm", "array", "atomic", "bit", "cassert", "cmath", "compare", "concepts", "cstddef", "cstdint", "cstring",
            "functional", "limits", "memory", "new", "numeric", "optional", "queue", "span", "string", "string_view", "system_error",
            "tuple", "type_traits", "utility", "variant", "vector"}
THREADS = "codec/packed/decode.cpp"


def includes(path):
    """(line number, header, whether it is in quotes)"""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = re.match(r'\s*#\s*include\s*([<"])([^>"]+)', line)
        if found:
            yield number, found[2], found[1] == '"'


def check_core(inside, header, quoted):
    if inside.startswith("include/"):
        return None if header in ("stddef.h", "stdint.h", pathlib.Path(inside).name) else "C without a library"
    if not quoted:
        return None if header in STANDARD or (header == "thread" and inside == THREADS) else "lrcore needs no such header"
    below = header.removeprefix("lrcore/").split("/")[0]
    if below not in CORE or CORE.index(below) > CORE.index(inside.split("/")[0]):
        return f"lrcore/{inside.split('/')[0]} is below {below}"
    if inside in DECODERS and below not in ("include", "base") and header.removeprefix("lrcore/") not in DECODERS:
        return "decoders need no encoder"
    return None


def main():
    root = pathlib.Path(sys.argv[1])
    wrong = []
    for depth, layer in enumerate(LAYERS):
        files = [p for p in sorted((root / layer).rglob("*")) if p.suffix in (".cpp", ".h")]
        for path in files:
            name = path.relative_to(root)
            for number, header, quoted in includes(path):
                first = header.split("/")[0]
                why = None
                if quoted and first in LAYERS and LAYERS.index(first) > depth:
                    why = f"{layer} is below {first}"
                elif quoted and first == "tests":
                    why = "tests are above everything"
                elif layer == "lrcore":
                    why = check_core(str(path.relative_to(root / layer)), header, quoted)
                if why:
                    wrong.append(f"{name}:{number}: {header}: {why}")
            if layer == "lrcore":
                for number, line in enumerate(path.read_text().splitlines(), 1):
                    if re.search(r"\bthrow\b", line.split("//")[0]):
                        wrong.append(f"{name}:{number}: lrcore throws nothing")
    for name in DECODERS:
        if not (root / "lrcore" / name).exists():
            wrong.append(f"{sys.argv[0]}: no file lrcore/{name}")
    print("\n".join(wrong) or "no include goes upwards")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
