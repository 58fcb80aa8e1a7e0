"""Predictions of normals and texture coordinates from positions (docs/storage-format.md, By places)."""

import math
import struct

from vertex_reader import WORD, signed

MOST = 1 << 20


def places_of(positions, vertex_of):
    """The positions of the stream's vertices."""
    columns = []
    for column in zip(*positions):
        column = [signed(x) for x in column]
        least = min(column)
        columns.append([x - least for x in column])
    h = max(max(map(max, columns), default=0).bit_length() - 20, 0)
    places = list(zip(*([x >> h for x in column] for column in columns)))
    return [places[v] for v in vertex_of]


def less(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def square(vector):
    """The squared length in doubles, of components rounded to floats."""
    x, y, z = struct.unpack("<3f", struct.pack("<3f", *vector))
    return x * x + y * y + z * z


class TextureMap:
    def __init__(self, positions, vertex_of):
        self.places = places_of(positions, vertex_of)

    def predict(self, v, corners, values):
        first, second = (self.extend(v, corner, values) for corner in (corners[0], corners[-1]))
        return [p + (signed(q - p) + 1 >> 1) for p, q in zip(first, second)]

    def extend(self, v, corner, values):
        """The prediction of one corner."""
        x, y, z = corner
        at = self.places[x]
        e, f, g = (less(self.places[w], at) for w in (y, v, z))
        height = square(cross(e, g))
        a = c = 65536
        if height:
            c = math.floor(min(65536 * math.sqrt(square(cross(e, f)) / height) + 0.5, MOST))
            a = int(max(-MOST, min(float(65536 * dot(f, e) + c * dot(g, e)) / float(dot(e, e)), MOST)))
        return [p + (a * signed(q - p) - c * signed(r - p) + (1 << 15) >> 16)
                for p, q, r in zip(values[x], values[y], values[z])]


def angle(d, e, length):
    c = dot(d, e)
    shorter, longer = sorted((length, float(abs(c))))
    i = math.floor(4096 * (shorter / longer) + 0.5)
    a = math.floor(16384 * math.atan(i / 4096) / math.pi + 0.5)
    acute = a if abs(c) >= length else 8192 - a
    return 16384 - acute if c < 0 else acute


def normal_sums(header, triangles, places, owner):
    """The sums of normals by owner of each corner: a copy or a vertex."""
    sums = {}
    for triangle in triangles:
        corners = [places[v] for v in triangle]
        normal = cross(less(corners[1], corners[0]), less(corners[2], corners[1]))
        if not any(normal):
            continue
        length = math.sqrt(square(normal))
        if not header.by_area:
            by = 32768 / length
            added = [int(x * by) for x in normal]
        else:
            added = normal
        for k, v in enumerate(triangle):
            weight = 1
            if header.by_angle:
                weight = angle(less(corners[k - 2], corners[k]), less(corners[k - 1], corners[k]), length)
            sums[owner[v]] = [x + weight * y for x, y in zip(sums.get(owner[v], (0, 0, 0)), added)]
    return sums


def octahedral(vector, most):
    vector = [(x + (1 << 63)) % (1 << 64) - (1 << 63) for x in vector]
    sizes = [abs(x) for x in vector]
    h = max(max(sizes).bit_length() - 32, 0)
    sizes = [x >> h for x in sizes]
    total = sum(sizes)
    if total == 0:
        return 0, 0
    x, y = (math.floor(most * size / total + 0.5) for size in sizes[:2])
    if vector[2] < 0:
        x, y = most - y, most - x
    return -x if vector[0] < 0 else x, -y if vector[1] < 0 else y


def turn_over(x, y, most):
    across, up = most + 1 - abs(y), most + 1 - abs(x)
    return -across if x < 0 else across, -up if y < 0 else up


def add_normals(header, differences, triangles, positions, vertex_of):
    """The integers of normals."""
    owner = vertex_of if header.of_vertex else range(header.vertices)
    sums = normal_sums(header, triangles, places_of(positions, vertex_of), owner)
    out = []
    for copy, difference in enumerate(differences):
        x, y = octahedral(sums.get(owner[copy], (0, 0, 0)), header.largest)
        down = abs(x) + abs(y) > header.largest
        if down:
            x, y = turn_over(x, y, header.largest)
        x, y = signed(x + difference[0]), signed(y + difference[1])
        if down:
            x, y = turn_over(x, y, header.largest)
        out.append((x & WORD, y & WORD))
    return out
