"""Reads glTF and GLB files: the JSON with the text of its numbers, and every accessor bit for bit.

Written from the glTF specification; shares no code with the libraries.
"""

import base64
import json
import os
import re
import struct
import urllib.parse

FORMAT = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
SIZE = {"b": 1, "B": 1, "h": 2, "H": 2, "I": 4, "f": 4}
LARGEST = {"b": 127, "B": 255, "h": 32767, "H": 65535}
SHAPE = {"SCALAR": (1, 1), "VEC2": (2, 1), "VEC3": (3, 1), "VEC4": (4, 1), "MAT2": (2, 2), "MAT3": (3, 3), "MAT4": (4, 4)}  # rows, columns


class Number(str):
    """The text of a JSON number."""


class Scene:
    def __init__(self, path):
        self.folder = os.path.dirname(os.path.abspath(path))
        with open(path, "rb") as file:
            data = file.read()
        text, self.binary = self.chunks(data) if data[:4] == b"glTF" else (data, None)
        self.json = json.loads(text)
        self.exact = json.loads(text, parse_float=Number, parse_int=Number)
        self.files = {}
        self.buffers = [self.buffer(i, b) for i, b in enumerate(self.json.get("buffers", []))]
        self.read = {}

    @staticmethod
    def chunks(data):
        version, length = struct.unpack_from("<II", data, 4)
        assert version == 2 and length == len(data), "GLB header"
        chunks, at = [], 12
        while at < length:
            size, kind = struct.unpack_from("<I4s", data, at)
            assert size % 4 == 0 and at + 8 + size <= length, "GLB chunk"
            chunks.append((kind, data[at + 8:at + 8 + size]))
            at += 8 + size
        assert chunks[0][0] == b"JSON", "the first GLB chunk is not JSON"
        return chunks[0][1], chunks[1][1] if len(chunks) > 1 and chunks[1][0] == b"BIN\0" else None

    def resource(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(re.sub(r"\s", "", uri.split(",", 1)[1]), validate=True)
        if uri not in self.files:
            with open(os.path.join(self.folder, urllib.parse.unquote(uri)), "rb") as file:
                self.files[uri] = file.read()
        return self.files[uri]

    def buffer(self, i, buffer):
        if "uri" in buffer:
            data = self.resource(buffer["uri"])
        else:
            assert i == 0 and self.binary is not None, f"buffer {i} has no bytes"
            data = self.binary
        assert len(data) >= buffer["byteLength"], f"buffer {i} is too short"
        return data[:buffer["byteLength"]]

    def view(self, i):
        view = self.json["bufferViews"][i]
        start = view.get("byteOffset", 0)
        data = self.buffers[view["buffer"]][start:start + view["byteLength"]]
        assert len(data) == view["byteLength"], f"buffer view {i} ends outside its buffer"
        return data

    def elements(self, view, offset, count, kind, shape):
        """`count` tuples, column by column; 32-bit floats are given as their bits."""
        rows, columns = SHAPE[shape]
        component = FORMAT[kind]
        size = SIZE[component]
        column = rows * size + (-rows * size % 4 if columns > 1 else 0)  # columns of matrices are aligned to four bytes
        code = "I" if component == "f" else component
        item = struct.Struct("<" + f"{rows}{code}{column - rows * size}x" * columns)
        data = self.view(view)
        stride = self.json["bufferViews"][view].get("byteStride", item.size)
        assert count == 0 or offset + (count - 1) * stride + item.size <= len(data), f"accessor ends outside buffer view {view}"
        return [item.unpack_from(data, offset + i * stride) for i in range(count)]

    def accessor(self, i):
        """The elements as tuples of integers, 32-bit floats as their bits."""
        if i not in self.read:
            a = self.json["accessors"][i]
            kind, shape, count = a["componentType"], a["type"], a["count"]
            if "bufferView" in a:
                values = self.elements(a["bufferView"], a.get("byteOffset", 0), count, kind, shape)
            else:
                values = [(0,) * (SHAPE[shape][0] * SHAPE[shape][1])] * count
            if "sparse" in a:
                sparse = a["sparse"]
                where, what = sparse["indices"], sparse["values"]
                indices = self.elements(where["bufferView"], where.get("byteOffset", 0), sparse["count"], where["componentType"], "SCALAR")
                changes = self.elements(what["bufferView"], what.get("byteOffset", 0), sparse["count"], kind, shape)
                for (index,), value in zip(indices, changes):
                    values[index] = value
            self.read[i] = values
        return self.read[i]

    def numbers(self, i):
        """The elements as tuples of floats; normalized integers in [-1, 1]."""
        a = self.json["accessors"][i]
        component = FORMAT[a["componentType"]]
        if component == "f":
            return [struct.unpack(f"<{len(v)}f", struct.pack(f"<{len(v)}I", *v)) for v in self.accessor(i)]
        if a.get("normalized"):
            return [tuple(max(x / LARGEST[component], -1.0) for x in v) for v in self.accessor(i)]
        return self.accessor(i)

    def primitives(self):
        """(mesh, primitive, JSON) of every primitive."""
        return [(m, p, primitive) for m, mesh in enumerate(self.json.get("meshes", []))
                for p, primitive in enumerate(mesh["primitives"])]

    def corners(self, primitive):
        """The vertices of a primitive's corners, in order; strips and fans as triangle lists."""
        count = self.json["accessors"][min(primitive["attributes"].values())]["count"]
        order = [v for (v,) in self.accessor(primitive["indices"])] if "indices" in primitive else list(range(count))
        assert all(v < count for v in order), "an index names no vertex"
        mode = primitive.get("mode", 4)
        if mode == 5:
            return [v for i in range(len(order) - 2) for v in (order[i], order[i + 1 + i % 2], order[i + 2 - i % 2])]
        if mode == 6:
            return [v for i in range(1, len(order) - 1) for v in (order[i], order[i + 1], order[0])]
        return order


def columns(primitive):
    """{name: accessor} of a primitive's attributes and morph targets, which are named 0/POSITION, ..."""
    out = dict(primitive["attributes"])
    for t, target in enumerate(primitive.get("targets", [])):
        out.update({f"{t}/{name}": accessor for name, accessor in target.items()})
    return out


def is_triangles(primitive):
    return primitive.get("mode", 4) >= 4
