"""Writers of every mesh format. They write valid and invalid files."""

import base64
import json
import struct


def ply(points, faces, order="<", strips=None, real="float"):
    kind = {"float": "f", "double": "d"}[real]
    name = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = f"ply\nformat {name} 1.0\ncomment x\nelement vertex {len(points)}\nproperty uchar red\n"
    head += "".join(f"property {real} {c}\n" for c in "xyz")
    if strips is None:
        head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nproperty uchar flag\n"
    else:
        head += "element tristrips 1\nproperty list int int vertex_indices\n"
    head = (head + "end_header\n").encode()
    if order == "":
        body = "".join("7 " + " ".join(map(repr, map(float, p))) + "\n" for p in points)
        if strips is None:
            body += "".join(f"{len(f)} {' '.join(map(str, f))} 1\n" for f in faces)
        else:
            body += f"{len(strips)} {' '.join(map(str, strips))}\n"
        return head + body.encode()
    body = b"".join(struct.pack(f"{order}B3{kind}", 7, *p) for p in points)
    if strips is None:
        body += b"".join(struct.pack(f"{order}B{len(f)}iB", len(f), *f, 1) for f in faces)
    else:
        body += struct.pack(f"{order}i{len(strips)}i", len(strips), *strips)
    return head + body


PLY_TYPES = {"f": "float", "d": "double", "b": "char", "B": "uchar", "h": "short", "H": "ushort", "i": "int", "I": "uint"}


def ply_of_attributes(columns, indices):
    """columns: (name, type, flags of the comment, values by vertex), positions first."""
    head, rows, properties = "ply\nformat binary_little_endian 1.0\n", [b""] * len(columns[0][3]), []
    for name, code, flags, values in columns:
        width = len(values[0])
        head += f"comment lacedring attribute {width} {flags} {name}\n"
        properties += [PLY_TYPES[code]] * width
        rows = [row + struct.pack(f"<{width}{code}", *v) for row, v in zip(rows, values)]
    names = ["x", "y", "z", *(f"p{i}" for i in range(3, len(properties)))]
    head += f"element vertex {len(rows)}\n" + "".join(f"property {p} {n}\n" for p, n in zip(properties, names))
    head += f"element face {len(indices) // 3}\nproperty list uchar int vertex_indices\nend_header\n"
    corners = iter(indices)
    return head.encode() + b"".join(rows) + b"".join(struct.pack("<B3i", 3, *t) for t in zip(corners, corners, corners))


def decoded(points, triangles):
    """A PLY file as `lacedring decode` writes it."""
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(triangles)}\nproperty list uchar uint vertex_indices\nend_header\n")
    return (head.encode() + b"".join(struct.pack("<3f", *p) for p in points) +
            b"".join(struct.pack("<B3I", 3, *t) for t in triangles))


def gltf(points, primitives, nodes=None, binary=False, uri=None, sparse=None):
    """primitives: (mode, indices)."""
    blob = b"".join(struct.pack("<3f", *p) for p in points)
    views = [{"buffer": 0, "byteLength": len(blob)}]
    accessors = [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": len(points)}]
    made = []
    for mode, indices in primitives:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 2 * len(indices)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5123, "type": "SCALAR", "count": len(indices)})
        blob += struct.pack(f"<{len(indices)}H", *indices) + bytes(2 * (len(indices) % 2))
        made.append({"attributes": {"POSITION": 0}, "indices": len(accessors) - 1, "mode": mode})
    if sparse is not None:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 4})
        blob += struct.pack("<I", sparse[0])
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 12})
        blob += struct.pack("<3f", *sparse[1])
        accessors[0]["sparse"] = {"count": 1, "indices": {"bufferView": len(views) - 2, "componentType": 5125},
                                  "values": {"bufferView": len(views) - 1}}
    out = {"asset": {"version": "2.0"}, "meshes": [{"primitives": made}], "bufferViews": views, "accessors": accessors,
           "buffers": [{"byteLength": len(blob)}]}
    if nodes is not None:
        out["nodes"] = nodes
        out["scenes"] = [{"nodes": [0]}]
    if binary:
        text = json.dumps(out).encode()
        text += b" " * (-len(text) % 4)
        blob += bytes(-len(blob) % 4)
        return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob)) + struct.pack("<I4s", len(text), b"JSON") +
                text + struct.pack("<I4s", len(blob), b"BIN\0") + blob)
    if uri is None:
        out["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(blob).decode()
        return json.dumps(out).encode()
    out["buffers"][0]["uri"] = uri
    return json.dumps(out).encode(), blob


def flat(triangles):
    return [v for t in triangles for v in t]


def obj(points, faces):
    """faces: tuples of vertex numbers from 0."""
    return ("".join(f"v {x!r} {y!r} {z!r}\n" for x, y, z in points) +
            "".join("f " + " ".join(str(v + 1) for v in f) + "\n" for f in faces)).encode()


def off(points, faces):
    return (f"OFF\n{len(points)} {len(faces)} 0\n" + "".join(f"{x!r} {y!r} {z!r}\n" for x, y, z in points) +
            "".join(f"{len(f)} {' '.join(map(str, f))}\n" for f in faces)).encode()


def stl(points, triangles):
    out = b"solid binary".ljust(80) + struct.pack("<I", len(triangles))
    for t in triangles:
        out += struct.pack("<12fH", 0, 0, 0, *(x for v in t for x in points[v]), 0)
    return out


def stl_text(points, triangles):
    out = "solid a\n"
    for t in triangles:
        corners = "".join("  vertex {!r} {!r} {!r}\n".format(*points[v]) for v in t)
        out += f"facet normal 0 0 1\n outer loop\n{corners} endloop\nendfacet\n"
    return (out + "endsolid a\n").encode()
