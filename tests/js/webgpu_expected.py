#!/usr/bin/env python3
"""webgpu_expected.py FILE...: decodes resident .lr files with the readers of tests/independent and writes FILE.json: the triangle of each
slot, the copies of its corners, the integers and floats of vertex streams, and the opposites of LR tables. If FILE ends in .hex, it is a golden
stream (tests/golden); FILE.json then has its words and slots."""

import array
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "independent"))
from lr_corners import Corners  # noqa: E402
from lr_reader import DECODERS, SEAMS, VERTEX_STREAM, copies_of, sections  # noqa: E402
from lr_tables_reader import Tables  # noqa: E402
from vertex_reader import DECIMALS, FLOATS, LATTICE, OCTAHEDRAL, read_vertices, signed  # noqa: E402

MAGICS = {0x4E4C524C: 1, 0x5443524C: 5, 0x3250524C: 7}  # from magic numbers to section kinds of .lr files


def direction(vertex, largest):
    x, y = signed(vertex[0]), signed(vertex[1])
    z = largest - abs(x) - abs(y)
    if z < 0:
        x, y = ((largest - abs(y)) * (-1 if x < 0 else 1), (largest - abs(x)) * (-1 if y < 0 else 1))
    return x, y, z


def attribute(contents, name_length):
    stream = read_vertices(contents[(name_length + 7) // 8 * 8:])
    out = {"integers": [x for vertex in stream.integers for x in vertex]}
    if stream.mapping in (LATTICE, FLOATS, DECIMALS):
        out["floats"] = array.array("I", stream.values).tolist()
    if stream.mapping == OCTAHEDRAL:
        out["directions"] = [x for vertex in stream.integers for x in direction(vertex, stream.largest)]
    return out


def operators(tables):
    """The vertex and opposite of each corner; None for numbers that are not corners."""
    corners = Corners(tables)
    vertex, opposite = ([None] * (4 * (2 * tables.ring + tables.t0)) for _ in range(2))
    for t, triangle, _ in tables.triangles():
        for i, v in enumerate(triangle):
            vertex[4 * t + i], opposite[4 * t + i] = v, corners.opposite(4 * t + i)
    return {"vertex": vertex, "opposite": opposite}


def connectivity(words, kind, out):
    vertices, out["slots"], _ = DECODERS[kind](words)
    out["vertices"] = vertices
    if kind == 5:
        out["operators"] = operators(Tables(words, False))
    return vertices, out["slots"]


def lr_file(data):
    parts = sections(data)
    out = {"attributes": [attribute(contents, length) for kind, contents, _, length in parts if kind == VERTEX_STREAM]}
    (kind, contents), = [(kind, contents) for kind, contents, _, _ in parts if kind in DECODERS]
    vertices, slots = connectivity(array.array("I", contents), kind, out)
    if any(kind == SEAMS and contents for kind, contents, _, _ in parts):
        out["copies"], out["vertex_of"] = copies_of(data, parts, slots, vertices)
    return out


def golden(text):
    _, count, *numbers = text.split()  # "words", their number, the words, and further sections
    words = array.array("I", (int(word, 16) for word in numbers[:int(count)]))
    out = {"words": words.tolist(), "attributes": []}
    connectivity(words, MAGICS[words[0]], out)
    return out


def main():
    for name in sys.argv[1:]:
        path = pathlib.Path(name)
        out = golden(path.read_text()) if path.suffix == ".hex" else lr_file(path.read_bytes())
        pathlib.Path(name + ".json").write_text(json.dumps(out))


main()
