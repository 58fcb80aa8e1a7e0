"""Cuts polygons into triangles as docs/formats-read.md defines it, with exact numbers, in O(n^3)."""

import math
from fractions import Fraction


def sign(x):
    return (x > 0) - (x < 0)


def turn(a, b, c):
    """1: a, b, c are counterclockwise; 0: collinear; -1: clockwise."""
    left, right = (a[0] - c[0]) * (b[1] - c[1]), (a[1] - c[1]) * (b[0] - c[0])
    if abs(left - right) > 1e-15 * (abs(left) + abs(right)):
        return sign(left - right)
    a, b, c = ([Fraction(x) for x in p] for p in (a, b, c))
    return sign((a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0]))


def project(points):
    """Projects the polygon to a plane, counterclockwise; None if it has no area."""
    largest = max(abs(x) for p in points for x in p)
    scale = 1 - math.frexp(largest)[1]  # a power of two: scaling is exact
    points = [[math.ldexp(x, scale) for x in p] for p in points]
    points = [[x if abs(x) >= 2.0 ** -400 else 0.0 for x in p] for p in points]
    normal = [0.0, 0.0, 0.0]
    origin = points[0]
    for i in range(2, len(points)):
        a = [points[i - 1][k] - origin[k] for k in range(3)]
        b = [points[i][k] - origin[k] for k in range(3)]
        normal[0] += a[1] * b[2] - a[2] * b[1]
        normal[1] += a[2] * b[0] - a[0] * b[2]
        normal[2] += a[0] * b[1] - a[1] * b[0]
    axis = max((2, 1, 0), key=lambda k: abs(normal[k]))  # of equal components, z before y before x
    if normal[axis] == 0:
        return None
    u, v = (axis + 1) % 3, (axis + 2) % 3
    if normal[axis] < 0:
        u, v = v, u
    return [(p[u], p[v]) for p in points]


class Ring:
    def __init__(self, points):
        n = len(points)
        self.points = points
        self.left = list(range(n))
        self.changes = [0] * n
        self.blockers = {i for i in range(n) if turn(points[i - 1], points[i], points[(i + 1) % n]) <= 0}
        self.refused = [set(), set()]  # corners refused by rules 1 and 3

    def neighbors(self, corner):
        at = self.left.index(corner)
        return self.left[at - 1], self.left[(at + 1) % len(self.left)]

    def key(self, corner):
        a, c = (self.points[i] for i in self.neighbors(corner))
        u, v = c[0] - a[0], c[1] - a[1]
        square = u * u + v * v
        return math.frexp(square)[1] if square > 0 else -10000, -self.changes[corner], corner

    def is_empty(self, corner, may_be_touched):
        before, after = self.neighbors(corner)
        a, b, c = (self.points[i] for i in (before, corner, after))
        for blocker in self.blockers:
            p = self.points[blocker]
            inside = [turn(a, b, p), turn(b, c, p), turn(c, a, p)]
            if min(inside) < 0:
                continue
            if may_be_touched:
                if min(inside) > 0:
                    return False
            elif p == b:
                ends = [self.points[i] for i in self.neighbors(blocker)]
                if any(turn(a, b, q) > 0 and turn(b, c, q) > 0 for q in ends):
                    return False
            elif p != a and p != c:
                return False
        return True

    def next_ear(self):
        turns = {}
        for corner in self.left:
            a, c = self.neighbors(corner)
            turns[corner] = turn(self.points[a], self.points[corner], self.points[c])
        order = sorted(self.left, key=self.key)
        for rule in range(4):
            for corner in order:
                if turns[corner] < 0 or (turns[corner] == 0) != (rule == 1):
                    continue
                if rule % 2 == 1:
                    return corner
                if corner in self.refused[rule // 2]:
                    continue
                if self.is_empty(corner, rule == 2):
                    return corner
                self.refused[rule // 2].add(corner)
        return None

    def cut_off(self, corner):
        a, c = self.neighbors(corner)
        self.left.remove(corner)
        self.blockers.discard(corner)
        for neighbor in (a, c):
            self.changes[neighbor] += 1
            for refused in self.refused:
                refused.discard(neighbor)
        return tuple(sorted((a, corner, c)))


def fan(corners):
    return [(corners[0], corners[i - 1], corners[i]) for i in range(2, len(corners))]


def cut(points):
    """The triangles of a polygon with the given corners in space, as corner numbers."""
    plane = project(points)
    whole = fan(range(len(points)))
    if plane is None or all(turn(*(plane[i] for i in triangle)) >= 0 for triangle in whole):
        return whole
    ring = Ring(plane)
    out = []
    while len(ring.left) > 3:
        ear = ring.next_ear()
        if ear is None:
            break
        out.append(ring.cut_off(ear))
    return out + fan(ring.left)
