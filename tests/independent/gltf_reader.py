"""A glTF and GLB reader: all triangles of the default scene, node transforms applied, nodes depth first.

The arithmetic is fixed, so that two programs get the same bits: doubles, in the order written here, rounded to 32-bit
floats once at the end. An identity transform does not change the file's floats.
"""

import array
import base64
import json
import os
import struct
import urllib.parse

from mesh_readers import BadFile, Mesh, split_keys, strip

IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
COMPONENT = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
LARGEST = {"b": 127.0, "B": 255.0, "h": 32767.0, "H": 65535.0}


def multiply(a, b):
    out = []
    for column in range(4):
        v = b[4 * column:4 * column + 4]
        for row in range(4):
            out.append(((a[row] * v[0] + a[4 + row] * v[1]) + a[8 + row] * v[2]) + a[12 + row] * v[3])
    return out


def local_matrix(node):
    if "matrix" in node:
        return [float(x) for x in node["matrix"]]
    if not any(key in node for key in ("translation", "rotation", "scale")):
        return [float(x) for x in IDENTITY]
    t = [float(v) for v in node.get("translation", (0, 0, 0))]
    x, y, z, w = (float(v) for v in node.get("rotation", (0, 0, 0, 1)))
    s = [float(v) for v in node.get("scale", (1, 1, 1))]
    return [(1 - 2 * (y * y + z * z)) * s[0], 2 * (x * y + z * w) * s[0], 2 * (x * z - y * w) * s[0], 0.0,
            2 * (x * y - z * w) * s[1], (1 - 2 * (x * x + z * z)) * s[1], 2 * (y * z + x * w) * s[1], 0.0,
            2 * (x * z + y * w) * s[2], 2 * (y * z - x * w) * s[2], (1 - 2 * (x * x + y * y)) * s[2], 0.0,
            t[0], t[1], t[2], 1.0]


def determinant(m):
    return ((m[0] * (m[5] * m[10] - m[6] * m[9]) + m[1] * (m[6] * m[8] - m[4] * m[10])) +
            m[2] * (m[4] * m[9] - m[5] * m[8]))


class Gltf:
    def __init__(self, data, folder):
        self.folder = folder
        self.binary = None
        if data[:4] == b"glTF":
            at = 12
            text = None
            while at + 8 <= struct.unpack_from("<I", data, 8)[0]:
                size, kind = struct.unpack_from("<I4s", data, at)
                chunk = data[at + 8:at + 8 + size]
                if kind == b"JSON":
                    text = chunk
                elif kind == b"BIN\0" and self.binary is None:
                    self.binary = chunk
                at += 8 + size
        else:
            text = data
        self.json = json.loads(text.decode("utf-8-sig"))
        self.buffers = [self.buffer(i, b) for i, b in enumerate(self.json.get("buffers", []))]

    def buffer(self, i, description):
        uri = description.get("uri")
        if uri is None:
            if i != 0 or self.binary is None:
                raise BadFile("a glTF buffer has no bytes")
            return self.binary
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        with open(os.path.join(self.folder, urllib.parse.unquote(uri)), "rb") as file:
            return file.read()

    def elements(self, view_index, offset, count, kind, width):
        """`count` tuples of `width` values."""
        view = self.json["bufferViews"][view_index]
        item = struct.Struct(f"<{width}{kind}")
        stride = view.get("byteStride", item.size) or item.size
        start = view.get("byteOffset", 0) + offset
        data = self.buffers[view["buffer"]]
        if stride == item.size:
            return list(item.iter_unpack(data[start:start + count * item.size]))
        return [item.unpack_from(data, start + i * stride) for i in range(count)]

    def accessor(self, index, raw_floats=False):
        """The accessor's tuples; normalized integers are doubles. With raw_floats, 32-bit floats are given as their bits."""
        a = self.json["accessors"][index]
        kind, width, count = COMPONENT[a["componentType"]], WIDTH[a["type"]], a["count"]
        read_kind = "I" if raw_floats and kind == "f" else kind
        if "bufferView" in a:
            values = self.elements(a["bufferView"], a.get("byteOffset", 0), count, read_kind, width)
        else:
            values = [(0,) * width] * count
        if "sparse" in a:
            s = a["sparse"]
            where = self.elements(s["indices"]["bufferView"], s["indices"].get("byteOffset", 0), s["count"],
                                  COMPONENT[s["indices"]["componentType"]], 1)
            what = self.elements(s["values"]["bufferView"], s["values"].get("byteOffset", 0), s["count"], read_kind, width)
            for (i,), value in zip(where, what):
                values[i] = value
        if a.get("normalized") and kind in LARGEST:
            values = [tuple(max(v / LARGEST[kind], -1.0) for v in value) for value in values]
        return values, kind

    def instances(self):
        nodes = self.json.get("nodes", [])
        if not nodes:
            return [(m, IDENTITY) for m in range(len(self.json.get("meshes", [])))]
        if self.json.get("scenes"):
            roots = self.json["scenes"][self.json.get("scene", 0)].get("nodes", [])
        else:
            children = {c for node in nodes for c in node.get("children", [])}
            roots = [i for i in range(len(nodes)) if i not in children]
        out = []
        stack = [(root, None) for root in reversed(roots)]
        while stack:
            index, parent = stack.pop()
            node = nodes[index]
            matrix = local_matrix(node)
            if parent is not None:
                matrix = multiply(parent, matrix)
            if "mesh" in node:
                out.append((node["mesh"], IDENTITY if "skin" in node else matrix))  # a skinned mesh is placed by its joints only
            stack += [(child, matrix) for child in reversed(node.get("children", []))]
        return out

    def positions(self, accessor, m):
        identity = m == IDENTITY
        values, kind = self.accessor(accessor, raw_floats=identity)
        if identity and kind == "f":
            flat = array.array("I")
            for value in values:
                flat.extend(value)
            return split_keys(flat.tobytes())
        flat = array.array("f")
        for x, y, z in values:
            if not identity:
                x, y, z = (((m[r] * x + m[4 + r] * y) + m[8 + r] * z) + m[12 + r] for r in range(3))
            flat.extend((x, y, z))
        return split_keys(flat.tobytes())

    def read(self):
        positions = []
        indices = []
        for mesh, matrix in self.instances():
            mirrored = determinant(matrix) < 0
            for primitive in self.json["meshes"][mesh]["primitives"]:
                mode = primitive.get("mode", 4)
                if mode < 4 or "POSITION" not in primitive["attributes"]:
                    continue
                first = len(positions)
                positions += self.positions(primitive["attributes"]["POSITION"], matrix)
                if "indices" in primitive:
                    values, _ = self.accessor(primitive["indices"])
                    corners = [first + v for (v,) in values]
                else:
                    corners = list(range(first, len(positions)))
                triangles = []
                if mode == 4:
                    triangles = corners
                elif mode == 5:
                    strip(corners, triangles)
                else:
                    for i in range(2, len(corners)):
                        triangles += (corners[i - 1], corners[i], corners[0])
                if mirrored:
                    triangles = [v for t in range(0, len(triangles), 3)
                                 for v in (triangles[t], triangles[t + 2], triangles[t + 1])]
                indices += triangles
        return Mesh(positions, indices)


def read_gltf(data, folder):
    return Gltf(data, folder).read()
