"""Collects the buffers and the JSON of a glTF file, and writes it as .glb or as .gltf."""

import base64
import json
import re
import struct
import zlib

COMPONENT = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


def number(text):
    """A number with a given text, for instance 1e-3."""
    return f"@@{text}@@"


def png(width, height, pixel):
    """A PNG file of 8-bit RGB; pixel(x, y) gives three bytes."""
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width)) for y in range(height))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def data_uri(data, kind):
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"


def bounds(values):
    return {"min": [min(column) for column in zip(*values)], "max": [max(column) for column in zip(*values)]}


class GltfWriter:
    """Buffer 0 is written as the GLB's binary chunk or a .bin file beside the .gltf, buffer 1 as a data URI."""

    def __init__(self):
        self.buffers = [bytearray(), bytearray()]
        self.json = {"accessors": [], "bufferViews": []}

    def view(self, data, target=None, stride=None, buffer=0):
        """Appends a buffer view; returns its index."""
        bytes_so_far = self.buffers[buffer]
        bytes_so_far += b"\0" * (-len(bytes_so_far) % 4)
        view = {"buffer": buffer, "byteOffset": len(bytes_so_far), "byteLength": len(data)}
        if stride:
            view["byteStride"] = stride
        if target:
            view["target"] = target
        bytes_so_far += data
        self.json["bufferViews"].append(view)
        return len(self.json["bufferViews"]) - 1

    def describe(self, values, kind, component, normalized=False, limits=False, **more):
        """Appends an accessor of values at the buffer view in `more`; returns its index and the stored values."""
        item = struct.Struct(f"<{WIDTH[kind]}{component}")
        stored = [item.unpack(item.pack(*value)) for value in values]
        accessor = {"componentType": COMPONENT[component], "count": len(values), "type": kind, **more}
        if normalized:
            accessor["normalized"] = True
        if limits:
            accessor.update(bounds(stored))
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def accessor(self, values, kind, component="f", normalized=False, limits=False, target=None, buffer=0):
        """An accessor with a buffer view of its own. Vertex attributes are padded to four bytes."""
        item = struct.Struct(f"<{WIDTH[kind]}{component}")
        padding = -item.size % 4 if target == ARRAY_BUFFER else 0
        data = b"".join(item.pack(*value) + b"\0" * padding for value in values)
        stride = item.size + padding if target == ARRAY_BUFFER else None
        return self.describe(values, kind, component, normalized, limits, bufferView=self.view(data, target, stride, buffer))

    def attribute(self, values, kind, component="f", normalized=False, limits=False, buffer=0):
        return self.accessor(values, kind, component, normalized, limits, ARRAY_BUFFER, buffer)

    def positions(self, values):
        return self.attribute(values, "VEC3", limits=True)

    def indices(self, corners, component="H", limits=False):
        return self.accessor([(v,) for v in corners], "SCALAR", component, False, limits, ELEMENT_ARRAY_BUFFER)

    def interleaved(self, columns):
        """One buffer view for several attributes {name: (values, kind, component, normalized)}; returns {name: accessor}."""
        items = {name: struct.Struct(f"<{WIDTH[kind]}{component}") for name, (_, kind, component, _) in columns.items()}
        offsets, stride = {}, 0
        for name, item in items.items():
            offsets[name] = stride
            stride += item.size + -item.size % 4
        count = len(next(iter(columns.values()))[0])
        data = bytearray(stride * count)
        for name, (values, *_) in columns.items():
            for i, value in enumerate(values):
                items[name].pack_into(data, i * stride + offsets[name], *value)
        view = self.view(data, ARRAY_BUFFER, stride)
        return {name: self.describe(values, kind, component, normalized, name == "POSITION", bufferView=view,
                                    byteOffset=offsets[name])
                for name, (values, kind, component, normalized) in columns.items()}

    def sparse(self, values, changes, kind="VEC3", base=True):
        """A sparse accessor of f32 values with the changes {element: value}; without base, the others are zero."""
        width = WIDTH[kind]
        order = sorted(changes)
        more = {"sparse": {"count": len(order),
                           "indices": {"bufferView": self.view(struct.pack(f"<{len(order)}H", *order)), "byteOffset": 0,
                                       "componentType": COMPONENT["H"]},
                           "values": {"bufferView": self.view(b"".join(struct.pack(f"<{width}f", *changes[i])
                                                                       for i in order))}}}
        if base:
            more["bufferView"] = self.view(b"".join(struct.pack(f"<{width}f", *value) for value in values), ARRAY_BUFFER, 4 * width)
        else:
            values = [(0,) * width] * len(values)
        return self.describe([changes.get(i, value) for i, value in enumerate(values)], kind, "f", limits=True, **more)

    def text(self, document, **options):
        return re.sub(r'"@@(.*?)@@"', r"\1", json.dumps(document, **options)).encode()

    def write(self, path):
        for buffer in self.buffers:
            buffer += b"\0" * (-len(buffer) % 4)
        document = {**self.json, "buffers": [{"byteLength": len(self.buffers[0])}]}
        if self.buffers[1]:
            document["buffers"].append({"byteLength": len(self.buffers[1]),
                                        "uri": data_uri(self.buffers[1], "application/octet-stream")})
        if path.endswith(".glb"):
            text = self.text(document, ensure_ascii=False, separators=(",", ":"))
            text += b" " * (-len(text) % 4)
            binary = bytes(self.buffers[0])
            data = (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON") +
                    text + struct.pack("<I4s", len(binary), b"BIN\0") + binary)
        else:
            bin_path = path.removesuffix(".gltf") + ".bin"
            with open(bin_path, "wb") as file:
                file.write(self.buffers[0])
            document["buffers"][0]["uri"] = re.split(r"[/\\]", bin_path)[-1]
            data = self.text(document, indent=1)
        with open(path, "wb") as file:
            file.write(data)
