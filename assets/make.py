#!/usr/bin/env python3
"""make.py: writes cut_torus.ply, globe.glb and materials.glb into this folder. The same bytes on every run of one Python."""

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


def png(width, height, color):
    """color(x, y): three or four bytes."""
    channels = len(color(0, 0))
    rows = b"".join(b"\0" + b"".join(bytes(color(x, y)) for x in range(width)) for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = struct.pack(">IIBBBBB", width, height, 8, 6 if channels == 4 else 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def texture():
    """A picture of 256 by 128: a grid of meridians and parallels over bands of color, as PNG."""
    def color(x, y):
        if x % 16 == 0 or y % 16 == 0:
            return 40, 40, 48
        band = 0.5 + 0.5 * math.sin(y / 128 * 4 * math.pi + math.sin(x / 256 * 6 * math.pi))
        return int(70 + 150 * band), int(120 + 60 * (1 - band)), int(90 + 120 * (y / 128))

    return png(256, 128, color)


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
    write_glb("globe.glb", document, binary)


def write_glb(name, document, binary):
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    (HERE / name).write_bytes(
        struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON") + text +
        struct.pack("<I4s", len(binary), b"BIN\0") + binary)


def sphere(columns, rows):
    """Corners with normals and texture coordinates, and triangles."""
    corners, triangles = [], []
    for j in range(rows + 1):
        for i in range(columns + 1):
            turn, tilt = 2 * math.pi * (i % columns) / columns, math.pi * j / rows
            ring = 0.0 if j in (0, rows) else math.sin(tilt)
            n = (ring * math.cos(turn), math.cos(tilt), -ring * math.sin(turn))
            corners.append((*n, *n, i / columns, j / rows))
    for j in range(rows):
        for i in range(columns):
            a = j * (columns + 1) + i
            b = a + columns + 1
            triangles += [(a, b, b + 1)] * (j < rows - 1) + [(a, b + 1, a + 1)] * (j > 0)
    return corners, triangles


def materials():
    """Five spheres on a board, each of another material: all that a picture with materials has to show."""
    parts, accessors = [], []

    def add(data, kind, component, count, **more):
        accessors.append({"bufferView": len(parts), "componentType": component, "count": count, "type": kind, **more})
        parts.append(data)
        return len(accessors) - 1

    def floats(rows, kind, **more):
        return add(b"".join(struct.pack(f"<{len(r)}f", *r) for r in rows), kind, 5126, len(rows), **more)

    corners, triangles = sphere(32, 16)
    ball = {"POSITION": floats([c[:3] for c in corners], "VEC3", min=[-1, -1, -1], max=[1, 1, 1]),
            "NORMAL": floats([c[3:6] for c in corners], "VEC3"), "TEXCOORD_0": floats([c[6:] for c in corners], "VEC2")}
    ball_indices = add(b"".join(struct.pack("<3H", *t) for t in triangles), "SCALAR", 5123, 3 * len(triangles))
    board = {"POSITION": floats([(-4, -1.02, -2.6), (-4, -1.02, 2.6), (4, -1.02, 2.6), (4, -1.02, -2.6)], "VEC3",
                                min=[-4, -1.02, -2.6], max=[4, -1.02, 2.6]),
             "NORMAL": floats([(0, 1, 0)] * 4, "VEC3"),
             "TEXCOORD_1": floats([(0, 0), (0, 2.6), (4, 2.6), (4, 0)], "VEC2"),
             "COLOR_0": add(bytes((255, 235, 200, 255, 200, 235, 255, 255, 255, 200, 235, 255, 220, 255, 220, 255)), "VEC4",
                            5121, 4, normalized=True)}
    board_indices = add(struct.pack("<6H", 0, 1, 2, 0, 2, 3), "SCALAR", 5123, 6)

    def bump(x, y):
        u, v = x / 64 * 2 * math.pi * 4, y / 64 * 2 * math.pi * 4
        slope = (-0.6 * math.cos(u) * math.cos(v), 0.6 * math.sin(u) * math.sin(v))  # of the height, v falling
        size = math.sqrt(slope[0] ** 2 + slope[1] ** 2 + 1)
        return tuple(round(127.5 + 127.5 * c / size) for c in (slope[0], slope[1], 1))

    def checks(x, y):
        return (225, 120, 40) if (x // 16 + y // 16) % 2 else (245, 235, 215)

    def holes(x, y):
        away = math.hypot(x % 16 - 7.5, y % 16 - 7.5)
        return 60, 150, 70, max(0, min(255, round(128 + 60 * (away - 5))))

    def glow(x, y):
        return (255, 190, 90) if (x % 32 in range(12, 20)) else (0, 0, 0)

    def rough(x, y):
        return 255 - 2 * y, 40 + 3 * y, 255

    images = []
    for picture in (bump, checks, holes, glow, rough):
        images.append({"bufferView": len(parts), "mimeType": "image/png"})
        parts.append(png(64, 64, picture))
    views, binary = [], b""
    for data in parts:
        views.append({"buffer": 0, "byteOffset": len(binary), "byteLength": len(data)})
        binary += data + b"\0" * (-len(data) % 4)

    def texture_of(number, **more):
        return {"index": number, **more}

    tiled = {"extensions": {"KHR_texture_transform": {"scale": [2, 1]}}}
    look = [
        {"name": "hammered gold", "normalTexture": texture_of(0, scale=0.8, **tiled), "occlusionTexture": texture_of(4),
         "pbrMetallicRoughness": {"baseColorFactor": [1, 0.76, 0.33, 1], "metallicRoughnessTexture": texture_of(4)}},
        {"name": "checked plastic",
         "pbrMetallicRoughness": {"baseColorTexture": texture_of(1, **tiled), "metallicFactor": 0, "roughnessFactor": 0.25}},
        {"name": "leaves", "alphaMode": "MASK", "doubleSided": True,
         "pbrMetallicRoughness": {"baseColorTexture": texture_of(2, **tiled), "metallicFactor": 0, "roughnessFactor": 0.8}},
        {"name": "lamp", "emissiveFactor": [1, 1, 1], "emissiveTexture": texture_of(3),
         "pbrMetallicRoughness": {"baseColorFactor": [0.03, 0.03, 0.04, 1], "metallicFactor": 0, "roughnessFactor": 0.5}},
        {"name": "mist", "alphaMode": "BLEND",
         "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 0.9, 0.45], "metallicFactor": 0, "roughnessFactor": 0.1}},
        {"name": "board", "doubleSided": True,
         "pbrMetallicRoughness": {"baseColorTexture": texture_of(1, texCoord=1), "metallicFactor": 0, "roughnessFactor": 0.9}}]
    places = [(-2.4, 0, -1), (0, 0, -1.2), (2.4, 0, -1), (-1.2, 0, 1.2), (1.2, 0, 1.2)]
    nodes = [{"mesh": k, "translation": list(at)} for k, at in enumerate(places)] + [{"mesh": 5}]
    write_glb("materials.glb", {
        "asset": {"version": "2.0", "generator": "LacedRing assets/make.py"}, "extensionsUsed": ["KHR_texture_transform"],
        "scene": 0, "scenes": [{"nodes": list(range(6))}], "nodes": nodes,
        "meshes": [{"primitives": [{"attributes": ball, "indices": ball_indices, "material": k}]} for k in range(5)] +
                  [{"primitives": [{"attributes": board, "indices": board_indices, "material": 5}]}],
        "materials": look, "samplers": [{}, {"wrapS": 33648, "wrapT": 33648}],
        "textures": [{"source": k, "sampler": 1 if k == 4 else 0} for k in range(5)], "images": images,
        "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(binary)}]}, binary)


if __name__ == "__main__":
    cut_torus()
    globe()
    materials()
