#!/usr/bin/env python3
"""make.py: writes cut_torus.ply and globe.glb into this folder. The same bytes on every run of one Python."""

import json
import math
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).parent


def cut_torus():
    """A torus of 96 by 48 squares with two windows cut out: one handle, two border loops."""
    around, across = 96, 48
    positions, number, triangles = [], {}, []

    def vertex(i, j):
        key = (i % around, j % across)
        if key not in number:
            number[key] = len(positions)
            u, v = 2 * math.pi * key[0] / around, 2 * math.pi * key[1] / across
            radius = 0.38 + 0.05 * math.cos(3 * u)
            out = 1 + radius * math.cos(v)
            positions.append((out * math.cos(u), out * math.sin(u), radius * math.sin(v)))
        return number[key]

    for i in range(around):
        for j in range(across):
            if (10 <= i < 22 and 4 <= j < 14) or (56 <= i < 80 and 40 <= j < 46):
                continue
            a, b, c, d = vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)
            triangles += [(a, b, c), (a, c, d)]
    header = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(positions)}\nproperty float x\nproperty float y\n"
              f"property float z\nelement face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n")
    body = b"".join(struct.pack("<3f", *p) for p in positions) + b"".join(struct.pack("<B3i", 3, *t) for t in triangles)
    (HERE / "cut_torus.ply").write_bytes(header.encode() + body)


def texture():
    """A picture of 256 by 128: a grid of meridians and parallels over bands of color, as PNG."""
    rows = b""
    for y in range(128):
        rows += b"\0"
        for x in range(256):
            line = x % 16 == 0 or y % 16 == 0
            band = 0.5 + 0.5 * math.sin(y / 128 * 4 * math.pi + math.sin(x / 256 * 6 * math.pi))
            color = (40, 40, 48) if line else (int(70 + 150 * band), int(120 + 60 * (1 - band)), int(90 + 120 * (y / 128)))
            rows += bytes(color)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 256, 128, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def globe():
    """A sphere of 64 by 32 sectors with normals, texture coordinates (a seam from pole to pole) and a texture."""
    columns, rows = 64, 32
    positions, normals, texcoords, triangles = [], [], [], []
    for j in range(rows + 1):
        for i in range(columns + 1):
            pole = j in (0, rows)
            u, v = (i + 0.5 if pole else i) / columns, j / rows
            turn, tilt = 2 * math.pi * (i % columns) / columns, math.pi * v
            ring = 0.0 if pole else math.sin(tilt)
            n = (ring * math.cos(turn), math.cos(tilt), -ring * math.sin(turn))
            positions.append(n)
            normals.append(n)
            texcoords.append((min(u, 1.0), v))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b = a + columns + 1
            if j < rows - 1:
                triangles.append((a, b, b + 1))
            if j > 0:
                triangles.append((a, b + 1, a + 1))
    used = sorted({v for t in triangles for v in t})
    new = {v: k for k, v in enumerate(used)}
    pack = [b"".join(struct.pack(f"<{len(x[0])}f", *x[v]) for v in used) for x in (positions, normals, texcoords)]
    pack += [b"".join(struct.pack("<3H", *(new[v] for v in t)) for t in triangles), texture()]
    views, offset, binary = [], 0, b""
    for k, data in enumerate(pack):
        view = {"buffer": 0, "byteOffset": offset, "byteLength": len(data)}
        if k < 4:
            view["target"] = 34963 if k == 3 else 34962
        views.append(view)
        binary += data + b"\0" * (-len(data) % 4)
        offset = len(binary)
    low = [min(struct.unpack("<f", struct.pack("<f", positions[v][k]))[0] for v in used) for k in range(3)]
    high = [max(struct.unpack("<f", struct.pack("<f", positions[v][k]))[0] for v in used) for k in range(3)]
    document = {
        "asset": {"version": "2.0", "generator": "LacedRing assets/make.py"},
        "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "globe"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0, "roughnessFactor": 0.7}}],
        "textures": [{"source": 0, "sampler": 0}], "samplers": [{"wrapS": 10497, "wrapT": 33071}],
        "images": [{"bufferView": 4, "mimeType": "image/png"}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(used), "type": "VEC3", "min": low, "max": high},
            {"bufferView": 1, "componentType": 5126, "count": len(used), "type": "VEC3"},
            {"bufferView": 2, "componentType": 5126, "count": len(used), "type": "VEC2"},
            {"bufferView": 3, "componentType": 5123, "count": 3 * len(triangles), "type": "SCALAR"}],
        "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    (HERE / "globe.glb").write_bytes(
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON") + text +
        struct.pack("<I4s", len(binary), b"BIN\0") + binary)


if __name__ == "__main__":
    cut_torus()
    globe()
