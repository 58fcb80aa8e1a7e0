#!/usr/bin/env python3
"""test_layers.py ROOT: checks includes. A file may include files of its own folder and of folders before it in the README's table.
lrcore may include standard headers only, and its decoders nothing of rings and corner tables."""

import pathlib
import re
import sys

LAYERS = ["lrcore", "lrio", "lrlab", "shaders", "renderer", "app"]  # folders whose files are checked
SOURCES = {".cpp", ".h", ".hpp", ".glsl", ".comp", ".vert", ".frag", ".geom", ".mesh"}
CORE = ["base", "topology", "ring", "codec"]
# By public header of lrcore: the folder of its declarations. LRIO has those of lrio.
PUBLIC = {"base.hpp": "base", "corner_walks.hpp": "base", "lacedring_decode.h": "base", "topology.hpp": "topology", "ring.hpp": "ring", "streams.hpp": "codec",
          "operators.hpp": "codec", "vertices.hpp": "codec", "lacedring_vertices.h": "base", "seams.hpp": "codec", "lacedring_seams.h": "base",
          "lacedring_storage.h": "base", "lacedring_stored_seams.h": "base", "lacedring.hpp": "codec", "lacedring.h": "codec"}
LRIO = {"file.hpp", "materials.hpp", "mesh.hpp", "mesh_files.hpp", "primitives.hpp", "scene.h", "scene.hpp", "surface.hpp", "lr_file.hpp"}
# The files that decode and validate. They may include each other and, of the rest of lrcore, only base.
DECODERS = {"lacedring/streams.hpp", "lacedring/operators.hpp", "lacedring/corner_walks.hpp", "lacedring/base.hpp", "lacedring/lacedring_decode.h", "lacedring/vertices.hpp",
            "lacedring/lacedring_vertices.h", "lacedring/seams.hpp", "lacedring/lacedring_seams.h",
            "lacedring/lacedring_storage.h", "lacedring/lacedring_stored_seams.h", *("lrcore/codec/" + name for name in (
                "stream_view.cpp", "decode_slot.h", "lean/lean_format.h", "lean/lean_stream.cpp", "packed/packed_format.h", "packed/packed_c.h",
                "packed/packed_stream.cpp", "packed/decode.cpp", "tables/lr_stream.cpp", "tables/tables_decode.h",
                "tables/stream_header.h", "tables/validate.cpp", "vertices/vertex_stream.cpp", "seams/seam_section.cpp"))}
# The standard headers that lrcore may include. <thread> is for callers that request threads.
STANDARD = {"algorithm", "array", "atomic", "bit", "cassert", "cmath", "compare", "concepts", "cstddef", "cstdint", "cstring",
            "exception", "functional", "iterator", "limits", "memory", "new", "numeric", "optional", "queue", "span", "string", "string_view", "system_error",
            "tuple", "type_traits", "unordered_map", "utility", "variant", "vector"}
THREADS = "lrcore/base/parallel.cpp"
VECTORS = "lrcore/base/compiler.h"  # may include emmintrin.h for SSE2


def includes(path):
    """(line number, header, whether it is in quotes) of each include."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = re.match(r'\s*#\s*include\s*([<"])([^>"]+)', line)
        if found:
            yield number, found[2], found[1] == '"'


def folders_of_readme(root):
    """The folders of the README's table, in order. "lrcore/base, topology" stands for lrcore/base and lrcore/topology."""
    text = (root / "README.md").read_text()
    rows = text[text.index("| folder | what |"):].split("\n\n")[0].splitlines()[2:]
    out, parent = [], ""
    for row in rows:
        for name in row.split("|")[1].strip().split(", "):
            if "/" in name:
                parent = name.rpartition("/")[0]
            elif not (root / name).is_dir():
                name = f"{parent}/{name}"
            out.append(name)
    return out


def place_of(name, folders):
    """The number of a file's folder in the table; None if it has none. A folder with subfolders in the table has only its own files."""
    for i, folder in enumerate(folders):
        parent = any(other.startswith(folder + "/") for other in folders)
        if name.rpartition("/")[0] == folder or (not parent and name.startswith(folder + "/")):
            return i
    return None


def owner_of(header):
    """The path of a header in quotes below the repository's root; public headers get their folder."""
    folder, _, name = header.partition("/")
    return ("lrio/" if name in LRIO else "lrcore/include/") + header if folder == "lacedring" else header


def folder_of(name):
    """The folder in CORE of a file of lrcore. `name`: the path in its #include."""
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
    folders = folders_of_readme(root)
    for folder in folders:
        if not (root / folder).is_dir():
            wrong.append(f"README.md: no folder {folder}")
    if CORE != [folder.removeprefix("lrcore/") for folder in folders if folder.startswith("lrcore/")][1:]:
        wrong.append(f"README.md: lrcore's folders are not {', '.join(CORE)}")
    for layer in LAYERS:
        for path in sorted(p for p in (root / layer).rglob("*") if p.suffix in SOURCES):
            name = str(path.relative_to(root))
            as_included = name.split("include/")[-1]
            seen.add(as_included)
            place = place_of(name, folders)
            if place is None:
                wrong.append(f"{name}: its folder is not in the README's table")
                continue
            for number, header, quoted in includes(path):
                owner = place_of(owner_of(header), folders) if quoted else None
                why = None
                if layer == "lrcore":
                    why = check_core(as_included, header, quoted)
                elif header.startswith("tests/"):
                    why = "tests are above everything"
                elif owner is not None and owner > place:
                    why = f"{folders[place]} is below {folders[owner]}"
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
