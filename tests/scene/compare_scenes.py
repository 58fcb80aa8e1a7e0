#!/usr/bin/env python3
"""compare_scenes.py SOURCE UNPACKED [--lossless | --errors JSON] [--keep-order]: checks that packing lost nothing of a glTF scene.

The JSON must be equal, including the text of numbers, except the description of buffers (json_differences). Triangles are compared
as a multiset of oriented triangles with all attributes and morph targets at their corners: bit for bit, or within errors per
component, {"POSITION": x, "POSITION of morph targets": y, ...} (default 0; an accessor of several names has the largest error).
Lines and points that share accessors with triangles are compared likewise, everything else bit for bit. Exit code 1: a difference.
"""

import argparse
import collections
import itertools
import json
import sys

from scene_reader import Scene, columns, is_triangles


def reshaped(scene):
    """The accessors whose count and bounds may change: those of triangle primitives, and indices of primitives that share them."""
    vertices = {a for _, _, primitive in scene.primitives() if is_triangles(primitive) for a in columns(primitive).values()}
    return vertices | {primitive["indices"] for _, _, primitive in scene.primitives()
                       if "indices" in primitive and vertices & set(columns(primitive).values())}


def json_differences(source, unpacked):
    """Compares both documents without the description of buffers, with the modes of `unpacked` adapted to the source."""
    a, b = source.exact, unpacked.exact
    known = len(a.get("accessors", []))
    free = reshaped(source)
    new = {}
    for m, p, primitive in source.primitives():
        try:
            theirs = unpacked.json["meshes"][m]["primitives"][p]
        except (LookupError, TypeError):
            continue  # reported below
        if is_triangles(primitive) and "indices" not in primitive and "indices" in theirs:
            new[(m, p)] = theirs["indices"]
    added = range(known, len(unpacked.json.get("accessors", [])))
    if set(new.values()) != set(added):
        yield f"accessors {list(added)} are new, of which primitives without indices have {sorted(set(new.values()))}"

    def without(value, path):
        """The value without the parts that may differ."""
        if isinstance(value, list):
            return [without(v, (*path, i)) for i, v in enumerate(value[:known] if path == ("accessors",) else value)]
        if not isinstance(value, dict):
            return value
        dropped = set()
        if path == ():
            dropped = {"buffers", "bufferViews"}
        elif path[0] == "images" and len(path) == 2:
            dropped = {"bufferView"}
        elif path[0] == "accessors" and len(path) == 2:
            dropped = {"bufferView", "byteOffset", "sparse"} | ({"count", "min", "max"} if path[1] in free else set())
        elif path[0] == "meshes" and len(path) == 4 and (path[1], path[3]) in new:
            dropped = {"indices"}
        kept = {key: without(v, (*path, key)) for key, v in value.items() if key not in dropped}
        if path[:1] == ("meshes",) and len(path) == 4 and kept.get("mode") in ("5", "6"):
            kept["mode"] = type(kept["mode"])("4")
        return kept

    yield from differences(without(a, ()), without(b, ()), "")


def differences(a, b, path):
    if type(a) is not type(b):
        yield f"{path or '/'}: {a!r:.80} is {b!r:.80}"
    elif isinstance(a, dict):
        for key in sorted({*a, *b}):
            if key not in a or key not in b:
                yield f"{path}/{key}: only in {'the source' if key in a else 'the unpacked file'}"
            else:
                yield from differences(a[key], b[key], f"{path}/{key}")
    elif isinstance(a, list):
        if len(a) != len(b):
            yield f"{path}: {len(a)} elements, not {len(b)}"
        for i, (x, y) in enumerate(zip(a, b)):
            yield from differences(x, y, f"{path}/{i}")
    elif a != b:
        yield f"{path}: {a!r:.80} is {b!r:.80}"


def vertices(scene, primitive, exact):
    """A row for each vertex, of the values of all columns."""
    read = scene.accessor if exact else scene.numbers
    accessors = columns(primitive)
    return [tuple(itertools.chain(*row)) for row in zip(*(read(accessors[name]) for name in sorted(accessors)))]


def triangles(scene, primitive, rows):
    """Corners as rows, degenerate triangles left out."""
    corners = iter(scene.corners(primitive))
    return [(rows[a], rows[b], rows[c]) for a, b, c in zip(corners, corners, corners) if len({a, b, c}) == 3]


def first_corner(t):
    """The triangle rotated to begin with its smallest corner."""
    return min(t, t[1:] + t[:1], t[2:] + t[:2])


def lossless_differences(ours, theirs, keep_order):
    # Merging equal vertices makes triangles with two of them degenerate.
    ours, theirs = ([first_corner(t) for t in ts if len(set(t)) == 3] for ts in (ours, theirs))
    if keep_order and ours != theirs:
        yield "triangles differ or have another order"
    missing = collections.Counter(ours) - collections.Counter(theirs)
    extra = collections.Counter(theirs) - collections.Counter(ours)
    if missing or extra:
        yield f"{missing.total()} triangles missing, {extra.total()} extra"


class Tolerance:
    """The largest allowed difference of each component of a row."""

    def __init__(self, scene, primitive, errors):
        accessors = columns(primitive)
        self.limits, self.position = [], None
        allowed = collections.defaultdict(float)
        for _, _, other in scene.primitives():
            if is_triangles(other):
                for name, accessor in columns(other).items():
                    kind = f"{name.split('/')[1]} of morph targets" if "/" in name else name
                    allowed[accessor] = max(allowed[accessor], errors.get(kind, 0.0))
        for name in sorted(accessors):
            error = allowed[accessors[name]]
            values = scene.numbers(accessors[name])
            if name == "POSITION":
                self.position = len(self.limits)
            for component in zip(*values):
                largest = max(map(abs, component))
                self.limits.append(error * 1.0001 + (1e-6 * largest if error else 0.0))  # the reported error and the values are rounded

    def close(self, a, b, times=1):
        return all(abs(x - y) <= times * limit for x, y, limit in zip(a, b, self.limits))

    def same(self, s, t):
        return any(all(map(self.close, s, t[turn:] + t[:turn])) for turn in range(3))

    def collapsed(self, t):
        """Whether two corners are so close that they may have become one."""
        return any(self.close(t[i], t[i - 1], 2) for i in range(3))

    def cells(self, t, cell, spread):
        """The cells of the grid that may contain the centroid."""
        at = self.position
        centroid = [sum(corner[at + i] for corner in t) / 3 for i in range(3)]
        ranges = [{int((x - spread) // cell), int((x + spread) // cell)} for x in centroid]
        return itertools.product(*ranges)


def quantized_differences(ours, theirs, tolerance, keep_order):
    """A perfect matching of the triangles, pairs being those equal within the tolerance."""
    if keep_order:
        left = iter(theirs)
        candidate = next(left, None)
        for i, t in enumerate(ours):
            if candidate is not None and tolerance.same(t, candidate):
                candidate = next(left, None)
            elif not tolerance.collapsed(t):
                yield f"triangle {i} is not the next one"
                return
        if candidate is not None:
            yield "extra triangles"
        return
    error = max(tolerance.limits[tolerance.position:tolerance.position + 3])
    cell = 2.5 * error or 1e-6
    grid = collections.defaultdict(list)
    for j, t in enumerate(theirs):
        for key in tolerance.cells(t, cell, 0.0):
            grid[key].append(j)
    edges = [[j for key in tolerance.cells(t, cell, error) for j in grid.get(key, ()) if tolerance.same(t, theirs[j])] for t in ours]
    partner = match(edges)
    missing = [i for i, t in enumerate(ours) if i not in partner and not tolerance.collapsed(t)]
    extra = len(theirs) - len(partner)
    if missing or extra:
        yield f"{len(missing)} triangles missing, {extra} extra, of {len(ours)}"


def match(edges):
    """A largest matching {left: right} of a bipartite graph given as the right neighbors of each left node."""
    left_of, right_of = {}, {}
    for start in range(len(edges)):
        came_from, stack, free = {}, [start], None
        while stack and free is None:
            node = stack.pop()
            for right in edges[node]:
                if right not in came_from:
                    came_from[right] = node
                    if right not in left_of:
                        free = right
                        break
                    stack.append(left_of[right])
        while free is not None:  # flips the augmenting path
            node = came_from[free]
            left_of[free] = node
            right_of[node], free = free, right_of.get(node)
    return right_of


def geometry_differences(source, unpacked, errors=None, keep_order=False):
    exact = errors is None
    for (m, p, ours), (_, _, theirs) in zip(source.primitives(), unpacked.primitives()):
        where = f"/meshes/{m}/primitives/{p}"
        if sorted(columns(ours)) != sorted(columns(theirs)):
            continue  # reported by json_differences
        rows = [vertices(scene, primitive, exact) for scene, primitive in ((source, ours), (unpacked, theirs))]
        tolerance = None if exact else Tolerance(source, ours, errors)
        if not is_triangles(ours):
            before, after = [rows[0][v] for v in source.corners(ours)], [rows[1][v] for v in unpacked.corners(theirs)]
            if len(before) != len(after) or not (before == after if exact else all(map(tolerance.close, before, after))):
                yield f"{where}: lines or points differ"
            continue
        both = triangles(source, ours, rows[0]), triangles(unpacked, theirs, rows[1])
        if keep_order and exact and rows[0] != rows[1]:
            yield f"{where}: vertices differ or have another order"
        found = (lossless_differences(*both, keep_order) if exact else
                 quantized_differences(*both, tolerance, keep_order))
        yield from (f"{where}: {difference}" for difference in found)


def other_differences(source, unpacked):
    free = reshaped(source)
    for i in range(len(source.json.get("accessors", []))):
        if i not in free and source.accessor(i) != unpacked.accessor(i):
            yield f"/accessors/{i}: values differ"
    for i, (ours, theirs) in enumerate(zip(source.json.get("images", []), unpacked.json.get("images", []))):
        if "bufferView" in ours and ("bufferView" not in theirs or
                                     source.view(ours["bufferView"]) != unpacked.view(theirs["bufferView"])):
            yield f"/images/{i}: bytes differ"


def compare(source, unpacked, errors=None, keep_order=False):
    """All differences, as text. errors: {attribute: largest error of a component}; None: lossless."""
    found = list(json_differences(source, unpacked))
    if any(len(source.json.get(name, [])) > len(unpacked.json.get(name, [])) for name in ("accessors", "meshes")):
        return found
    return found + list(geometry_differences(source, unpacked, errors, keep_order)) + list(other_differences(source, unpacked))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source")
    parser.add_argument("unpacked")
    parser.add_argument("--lossless", action="store_true", help="the default")
    parser.add_argument("--errors", metavar="JSON", type=json.loads)
    parser.add_argument("--keep-order", action="store_true")
    options = parser.parse_args()
    found = compare(Scene(options.source), Scene(options.unpacked), options.errors, options.keep_order)
    for difference in found[:20]:
        print(difference)
    if len(found) > 20:
        print(f"and {len(found) - 20} more")
    sys.exit(1 if found else 0)


if __name__ == "__main__":
    main()
