#!/usr/bin/env python3
"""test_layers.py ROOT: who may include whom. Folders depend downwards only; lrcore on the language's own headers alone, and
its decoders on nothing of rings and corner tables."""

import pathlib
import re
import sys

# In the order in which data flows: each may include itself and those before it.
LAYERS = ["lrcore", "lrio", "lrlab", "shaders", "renderer", "app"]
CORE = ["base", "topology", "ring", "codec"]
# The folder whose declarations a public header of lrcore has. Those of lrio are in LRIO.
PUBLIC = {"base.hpp": "base", "lacedring_decode.h": "base", "topology.hpp": "topology", "ring.hpp": "ring", "streams.hpp": "codec",
          "operators.hpp": "codec", "vertices.hpp": "codec", "lacedring_vertices.h": "base", "seams.hpp": "codec", "lacedring_seams.h": "base",
          "lacedring_storage.h": "base", "lacedring_stored_seams.h": "base", "lacedring.hpp": "codec", "lacedring.h": "codec"}
LRIO = {"file.hpp", "mesh.hpp", "mesh_files.hpp", "primitives.hpp", "scene.h", "scene.hpp", "surface.hpp", "lr_file.hpp"}
# Decoding and validating: these files include each other, and nothing else of lrcore but base.
DECODERS = {"lacedring/streams.hpp", "lacedring/operators.hpp", "lacedring/base.hpp", "lacedring/lacedring_decode.h", "lacedring/vertices.hpp",
            "lacedring/lacedring_vertices.h", "lacedring/seams.hpp", "lacedring/lacedring_seams.h",
            "lacedring/lacedring_storage.h", "lacedring/lacedring_stored_seams.h", *("lrcore/codec/" + name for name in (
                "stream_view.cpp", "decode_slot.h", "lean/lean_format.h", "lean/lean_stream.cpp", "packed/packed_format.h", "packed/packed_c.h",
                "packed/packed_stream.cpp", "packed/decode.cpp", "tables/lr_stream.cpp", "tables/tables_decode.h",
                "tables/stream_header.h", "tables/validate.cpp", "vertices/vertex_stream.cpp", "seams/seam_section.cpp"))}
# The standard headers that a freestanding-minded library wants. <thread> is for those who ask for threads.
STANDARD = {"algorithm", "array", "atomic", "bit", "cassert", "cmath", "compare", "concepts", "cstddef", "cstdint", "cstring",
            "exception", "functional", "iterator", "limits", "memory", "new", "numeric", "optional", "queue", "span", "string", "string_view", "system_error",
            "tuple", "type_traits", "unordered_map", "utility", "variant", "vector"}
THREADS = "lrcore/base/parallel.cpp"
VECTORS = "lrcore/base/compiler.h"  # emmintrin.h, where the compiler has SSE2


def includes(path):
    """(line number, header, whether it is in quotes)"""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = re.match(r'\s*#\s*include\s*([<"])([^>"]+)', line)
        if found:
            yield number, found[2], found[1] == '"'


def layer_of(header):
    """The layer that a header in quotes belongs to."""
    folder, _, name = header.partition("/")
    return ("lrio" if name in LRIO else "lrcore") if folder == "lacedring" else folder


def folder_of(name):
    """The folder of CORE that a file of lrcore, named as it is included, belongs to."""
    folder, _, rest = name.partition("/")
    return PUBLIC.get(rest) if folder == "lacedring" else rest.split("/")[0]


def check_core(name, header, quoted):
    if name.endswith(("/lacedring_decode.h", "/lacedring_vertices.h", "/lacedring_seams.h", "/lacedring_storage.h",
                      "/lacedring_stored_seams.h")):
        return None if header in ("stddef.h", "stdint.h", "string.h", "math.h", "immintrin.h", "emmintrin.h", "lacedring_decode.h",
                                  "lacedring_vertices.h", "lacedring_seams.h", "lacedring_storage.h") else "C without a library"
    if name.endswith("/lacedring.h"):
        return None if header in ("stddef.h", "stdint.h", "string.h") or header.endswith("lacedring_decode.h") else "C without a library"
    if not quoted:
        allowed = header in STANDARD or (header == "thread" and name == THREADS) or (header == "emmintrin.h" and name == VECTORS)
        return None if allowed else "lrcore needs no such header"
    folder, included = folder_of(name), folder_of(header)
    if included not in CORE or CORE.index(included) > CORE.index(folder):
        return f"lrcore's {folder} is below {header}"
    if name in DECODERS and header not in DECODERS and included != "base":
        return "decoders need no encoder"
    return None


def main():
    root = pathlib.Path(sys.argv[1])
    wrong, seen = [], set()
    for depth, layer in enumerate(LAYERS):
        for path in sorted(p for p in (root / layer).rglob("*") if p.suffix in (".cpp", ".h", ".hpp")):
            name = str(path.relative_to(root))
            as_included = name.split("include/")[-1]
            seen.add(as_included)
            for number, header, quoted in includes(path):
                owner = layer_of(header) if quoted else None
                why = None
                if owner in LAYERS and LAYERS.index(owner) > depth:
                    why = f"{layer} is below {owner}"
                elif owner == "tests":
                    why = "tests are above everything"
                elif layer == "lrcore":
                    why = check_core(as_included, header, quoted)
                if why:
                    wrong.append(f"{name}:{number}: {header}: {why}")
            if layer == "lrcore":
                for number, line in enumerate(path.read_text().splitlines(), 1):
                    if re.search(r"\bthrow\b", line.split("//")[0]):
                        wrong.append(f"{name}:{number}: lrcore throws nothing")
    for name in sorted((DECODERS | {"lacedring/" + header for header in (*PUBLIC, *LRIO)}) - seen):
        wrong.append(f"{sys.argv[0]}: no file {name}")
    print("\n".join(wrong) or "no include goes upwards")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
