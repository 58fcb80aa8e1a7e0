"""The order of vertices in stored vertex streams (docs/storage-format.md, The order of vertices)."""

from collections import defaultdict, deque


def opposite_corners(triangles):
    """The opposite corner of each corner that has one."""
    whole = [len(set(triangle)) == 3 for triangle in triangles]
    opposite = {}
    for t in range(1, len(triangles)):
        here, before = triangles[t], triangles[t - 1]
        if whole[t] and whole[t - 1] and len(set(here) & set(before)) == 2:
            own, = (3 * t + k for k in range(3) if here[k] not in before)
            other, = (3 * t - 3 + k for k in range(3) if before[k] not in here)
            if other not in opposite:
                opposite[own], opposite[other] = other, own
    left = defaultdict(list)  # by edge: its opposite corners
    for t, triangle in enumerate(triangles):
        for k in range(3):
            if whole[t] and 3 * t + k not in opposite:
                left[frozenset(triangle) - {triangle[k]}].append(3 * t + k)
    for corners in left.values():
        for a, b in zip(corners[::2], corners[1::2]):
            opposite[a], opposite[b] = b, a
    return opposite


class VertexOrder:
    def __init__(self, triangles, vertices):
        self.triangles, self.vertices = triangles, vertices
        self.opposite = opposite_corners(triangles)
        self.complete = [len(set(triangle)) < 3 for triangle in triangles]
        self.known = [False] * vertices
        self.corners = defaultdict(list)  # by vertex: a stack of its corners
        self.stack, self.queues = [], (deque(), deque())

    def run(self, visitor):
        """Calls visitor.start(v, source vertex or None) or visitor.predicted(v, [(x, y, z), ...]), with one or two predictions."""
        for t, triangle in enumerate(self.triangles):
            if self.complete[t]:
                continue
            source = ([None] + [v for v in triangle if self.known[v]])[-1]
            for v in triangle:
                if not self.known[v]:
                    visitor.start(v, source)
                    self.known[v], source = True, v
            self.finish(t)
            self.grow(visitor)
        for v in range(self.vertices):
            if not self.known[v]:
                visitor.start(v, None)

    def finish(self, t):
        self.complete[t] = True
        self.stack.append(t)

    def grow(self, visitor):
        while True:
            while self.stack:
                t = self.stack.pop()
                for corner in range(3 * t, 3 * t + 3):
                    self.look_across(corner)
            v = self.next_vertex()
            if v is None:
                return
            corners = self.corners[v][::-1]
            visitor.predicted(v, [self.around(corner) for corner in corners[:2]])
            self.known[v] = True
            for corner in corners:
                self.complete[corner // 3] = True
            for corner in corners:
                t, k = divmod(corner, 3)
                self.look_across(3 * t + (k + 1) % 3)
                self.look_across(3 * t + (k + 2) % 3)

    def next_vertex(self):
        twice, once = self.queues[1], self.queues[0]
        if twice:
            return twice.popleft()
        while once:
            v = once.popleft()
            if not self.known[v]:
                return v
        return None

    def vertex(self, corner):
        return self.triangles[corner // 3][corner % 3]

    def around(self, corner):
        """x, y and z as in the document."""
        triangle, k = self.triangles[corner // 3], corner % 3
        return triangle[(k + 1) % 3], triangle[(k + 2) % 3], self.vertex(self.opposite[corner])

    def look_across(self, corner):
        across = self.opposite.get(corner)
        if across is None or self.complete[across // 3]:
            return
        v = self.vertex(across)
        if self.known[v]:
            self.finish(across // 3)
            return
        self.corners[v].append(across)
        if len(self.corners[v]) <= 2:
            self.queues[len(self.corners[v]) - 1].append(v)
