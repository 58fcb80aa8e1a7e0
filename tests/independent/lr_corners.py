"""c.o, the opposite of a corner, from LR tables by the rules of docs/lr-tables.md, and a check of all corners."""

from collections import Counter

from lr_tables_reader import BORDER, NULL, REDUNDANT, TRIANGLE, WART
from mesh_readers import BadFile

START, TIP, END = range(3)


def corner(s, role):
    return 4 * s + (role if s % 2 == 0 else 2 - role)


def after(c):
    return c - 2 if c % 4 == 2 else c + 1


def before(c):
    return c + 2 if c % 4 == 0 else c - 1


class Corners:
    def __init__(self, tables):
        self.tables = tables

    def is_wart(self, s):
        return self.tables.kind[s] == TRIANGLE and self.tables.flags[s] & WART != 0

    def at(self, v, s):
        """The slot at v on the side of s."""
        return 2 * v + s % 2

    def canonical(self, s, role):
        """The corner of a slot's triangle. If the slot is a redundant first copy, the corner is of the second copy."""
        while self.tables.kind[s] == REDUNDANT:
            s, role = self.at(self.tables.next[s >> 1], s), (TIP, END, START)[role]
        return NULL if self.tables.kind[s] == BORDER else corner(s, role)

    def across_ring_edge(self, s):
        """The corner opposite to the ring edge (v, v.n) on the side of s."""
        if self.is_wart(s):
            return self.canonical(self.at(self.tables.next[s >> 1], s), END)
        return self.canonical(s, TIP)

    def ends_at(self, v, s):
        """The slot whose triangle ends at v, on the side of s."""
        once = self.tables.previous[v]
        twice = self.at(self.tables.previous[once], s)
        return twice if self.is_wart(twice) else self.at(once, s)

    def has_tip(self, s, v):
        return self.tables.kind[s] != BORDER and self.tables.tip[s] == v

    def opposite_in_slot(self, s, role):
        tables = self.tables
        v, tip, end = s >> 1, tables.tip[s], tables.end(s)
        if role == TIP:
            if self.is_wart(s):
                return self.canonical(self.at(tables.next[v], s), START)
            return self.across_ring_edge(s ^ 1)
        if s in tables.opposites:
            return tables.opposites[s][0 if role == START else 1]
        behind = self.at(tables.previous[v], s)
        if not self.is_wart(s) and (self.is_wart(behind) or tables.kind[behind] == REDUNDANT):  # a T2's second copy
            if role == END:
                return self.across_ring_edge(behind ^ 1)
            if self.is_wart(behind):
                return corner(behind, TIP)
            if tables.next[end] == tip:  # three ring edges
                return self.across_ring_edge(self.at(end, s) ^ 1)
        if role == START:
            if end < tables.ring and self.has_tip(self.at(end, s), tip):
                return self.canonical(self.at(end, s), END)
            if tip < tables.ring and self.has_tip(self.ends_at(tip, s), end):
                return self.canonical(self.ends_at(tip, s), START)
        else:
            if self.has_tip(self.ends_at(v, s), tip):
                return self.canonical(self.ends_at(v, s), START)
            if tip < tables.ring and self.has_tip(self.at(tip, s), v):
                return self.canonical(self.at(tip, s), END)
        return NULL  # a border

    def opposite(self, c):
        t = c >> 2
        if t >= 2 * self.tables.ring:
            return self.tables.vo[6 * (t - 2 * self.tables.ring) + 3 + c % 4]
        return self.opposite_in_slot(t, c % 4 if t % 2 == 0 else 2 - c % 4)


def check_corners(tables):
    """Checks that c.o of all corners joins neighboring triangles, that each vertex has one fan, and that C is valid."""
    corners = Corners(tables)
    vertex = {4 * t + i: v for t, triangle, _ in tables.triangles() for i, v in enumerate(triangle)}
    opposite = {c: corners.opposite(c) for c in vertex}
    uses, borders = Counter(), Counter()
    for c, o in opposite.items():
        edge = vertex[after(c)], vertex[before(c)]
        uses[tuple(sorted(edge))] += 1
        if o == NULL:
            borders[edge] += 1
        elif o == c or opposite.get(o) != c or edge != (vertex[before(o)], vertex[after(o)]):
            raise BadFile(f"corner {c} does not face corner {o}")
    for a, b in borders:
        if (b, a) in borders and uses[min(a, b), max(a, b)] == 2:
            raise BadFile(f"two neighbors at the edge {a}, {b} do not know of each other")
    for i, c in enumerate(tables.isolated):
        if vertex.get(c) != tables.ring + i:
            raise BadFile(f"corner {c} is not one of isolated vertex {tables.ring + i}")
    count = Counter(vertex.values())
    for v, c in {v: c for c, v in vertex.items()}.items():
        fan = {c}
        for turn in (after, before):
            o = opposite[turn(c)]
            while o != NULL and turn(o) not in fan:
                fan.add(turn(o))
                o = opposite[turn(turn(o))]
        if len(fan) != count[v]:
            raise BadFile(f"the triangles of vertex {v} are not one fan")
