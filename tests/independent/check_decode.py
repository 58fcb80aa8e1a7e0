#!/usr/bin/env python3
"""Checks that a decoded mesh has exactly the triangles of the encoded mesh.

    check_decode.py INPUT OUT.ply             the output of `lacedring decode`
    check_decode.py INPUT --lr FILE.lr        the .lr file itself, decoded here (both may be given)

INPUT is OBJ, PLY, OFF, STL, glTF or GLB. Compares the multisets of oriented triangles, each as the bits of its three
positions, rotated to begin with the smallest. Drops triangles that repeat a vertex of INPUT, and with --weld=position those
that repeat a position, as `encode --weld=position` does. Compares the order of triangles, too, if FILE.lr keeps it, and
checks every c.o of LR tables (lr_corners.py).
Shares no code with lrcore. Prints one line; exits 0 if the multisets are equal, 1 if not or if a file cannot be read.
"""

import argparse
import os
import sys
from collections import Counter

from gltf_reader import read_gltf
from lr_reader import read_lr
from mesh_readers import BadFile, read_obj, read_off, read_ply, read_stl


def read(path):
    with open(path, "rb") as file:
        data = file.read()
    text = data[3:] if data.startswith(b"\xef\xbb\xbf") else data
    extension = os.path.splitext(path)[1].lower()
    if data.startswith(b"LRFL"):
        return read_lr(data)
    if data.startswith(b"glTF") or text.lstrip().startswith(b"{"):
        return read_gltf(data, os.path.dirname(path))
    if text.startswith((b"ply\n", b"ply\r")):
        return read_ply(text)
    readers = {".obj": read_obj, ".off": read_off, ".stl": read_stl}
    if extension not in readers:
        raise BadFile("unknown format")
    return readers[extension](data if extension == ".stl" else text)


def multiset(mesh, numbers, weld_position=False):
    """Counts triangles, each given as one integer made of its positions' numbers. Meshes to compare share `numbers`."""
    of_vertex = [numbers.setdefault(position, len(numbers)) for position in mesh.positions]
    triangles = []
    dropped = 0
    corners = iter(mesh.indices)
    for i, j, k in zip(corners, corners, corners):
        a, b, c = of_vertex[i], of_vertex[j], of_vertex[k]
        if i == j or j == k or k == i or (weld_position and (a == b or b == c or c == a)):
            dropped += 1
            continue
        if a <= b and a <= c:
            if a == c and b > a:  # the smallest twice: (a, a, b) is the first rotation
                a, b, c = a, a, b
        elif b <= c:
            a, b, c = b, c, a
        else:
            a, b, c = c, a, b
        triangles.append(a << 64 | b << 32 | c)
    return Counter(triangles), len(triangles), dropped


def compare(wanted, got):
    if wanted == got:
        return None
    missing, extra = wanted - got, got - wanted
    turned = sum(1 for t in missing if (t >> 64 << 64 | (t & 0xFFFFFFFF) << 32 | t >> 32 & 0xFFFFFFFF) in extra)
    return (f"{sum(missing.values())} triangles missing, {sum(extra.values())} that should not be there, "
            f"{turned} of them reversed")


def order_fault(mesh, decoded):
    """Returns None if each triangle of the .lr file begins with the input's corner that the file's corner order names, else what is wrong."""
    for i, corner in enumerate(decoded.corner_order):
        t, first = divmod(corner, 3)
        wanted = [mesh.indices[3 * t + (first + k) % 3] for k in range(3)]
        if [mesh.positions[v] for v in wanted] != [decoded.positions[v] for v in decoded.indices[3 * i:3 * i + 3]]:
            return f"triangle {i} does not begin with corner {corner} of the input"
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("input")
    parser.add_argument("output", nargs="?")
    parser.add_argument("--lr")
    parser.add_argument("--weld", choices=["position"])
    parser.add_argument("--allow-degenerate", action="store_true", help="in OUT.ply, too: it is an encoder's input")
    options = parser.parse_args()
    if options.output is None and options.lr is None:
        parser.error("nothing to compare with")
    path = options.input
    try:
        numbers = {}
        mesh = read(path)
        wanted, count, dropped = multiset(mesh, numbers, options.weld == "position")
        for path in filter(None, (options.output, options.lr)):
            decoded = read(path)
            got, _, repeated = multiset(decoded, numbers)
            why = compare(wanted, got)
            if why is None and repeated and not options.allow_degenerate:
                why = f"{repeated} degenerate triangles"
            if why is None and decoded.corner_order is not None:
                why = order_fault(mesh, decoded)
            if why is not None:
                print(f"FAIL {options.input}: {path}: {why}")
                return 1
    except (BadFile, OSError, ValueError, KeyError, IndexError, TypeError) as error:
        print(f"FAIL {path}: cannot be read: {type(error).__name__}: {' '.join(str(error).split())}")
        return 1
    except Exception as error:  # such as struct.error; prints one line
        print(f"FAIL {path}: cannot be read: {type(error).__name__}: {error}")
        return 1
    print(f"ok {options.input}: {count} triangles, {dropped} degenerate")
    return 0


if __name__ == "__main__":
    sys.exit(main())
