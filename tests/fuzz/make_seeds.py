#!/usr/bin/env python3
"""Writes the seeds of every fuzz target: make_seeds.py STREAM_SEEDS_PROGRAM FOLDER makes FOLDER/TARGET/NAME.

Streams come from the program (stream_seeds.cpp), mesh files from this script, and former failures from regressions/TARGET.
"""

import json
import pathlib
import shutil
import struct
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "independent"))
import mesh_writers as w  # noqa: E402
from scene_seeds import scene_seeds  # noqa: E402

FORMATS = ["any", "gltf", "obj", "off", "ply", "stl"]  # in the order of MeshFormat

TETRAHEDRON = ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)])
QUADS = ([(x * 0.5, y * 1e-3, 0.25) for y in range(3) for x in range(3)],
         [(0, 1, 4, 3), (1, 2, 5, 4), (3, 4, 7, 6), (4, 5, 8, 7)])
STRIP = [0, 1, 2, 3, 4, 5, -1, 6, 7, 8]


def grid(size):
    points = [(x, y, (x * y) % 3) for y in range(size) for x in range(size)]
    cells = [y * size + x for y in range(size - 1) for x in range(size - 1)]
    return points, [t for c in cells for t in ((c, c + 1, c + size), (c + 1, c + size + 1, c + size))]


def gltf_with(attributes, indices, primitive=None, accessor=None, **more):
    """A GLB of one primitive: attributes are NAME: (componentType, type, count, bytes, stride), indices 16-bit or None."""
    blob, views, accessors, named = b"", [], [], {}
    for name, (component, kind, count, data, stride) in attributes.items():
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(data)})
        if stride:
            views[-1]["byteStride"] = stride
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind, "count": count,
                          "normalized": component != 5126})
        blob += data + bytes(-len(data) % 4)
        named[name] = len(accessors) - 1
    made = {"attributes": named, **(primitive or {})}
    if indices is not None:
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 2 * len(indices)})
        accessors.append({"bufferView": len(views) - 1, "componentType": 5123, "type": "SCALAR", "count": len(indices)})
        blob += struct.pack(f"<{len(indices)}H", *indices) + bytes(2 * (len(indices) % 2))
        made["indices"] = len(accessors) - 1
    accessors[0].update(accessor or {})
    text = json.dumps({"asset": {"version": "2.0"}, "meshes": [{"primitives": [made]}], "bufferViews": views,
                       "accessors": accessors, "buffers": [{"byteLength": len(blob)}], **more},
                      separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(blob), len(text), 0x4e4f534a) + text +
            struct.pack("<II", len(blob), 0x004e4942) + blob)


# A tetrahedron compressed by meshoptimizer (positions, also for the exponential filter; indices; four normals for the octahedral filter)
# and, with texture coordinates, by Draco (edgebreaker and sequential).
MESHOPT = {name: bytes.fromhex(data) for name, data in {
    "plain": "a00000013c000000ffff013c0000007e7d0000010f000000ffff010f0000007e7d00000103000000ff01030000007e" + 64 * "0",
    "exponential": "a000013c000000403f000130000000ca00010f000000403f000130000000ca00010300000040000130000000ca" + 40 * "0" +
                   3 * "0000008e",
    "triangles": "e1fe0e1203f004007687566778a9866589689801690000",
    "indices": "d100080202040806040402060c00000000",
    "octahedral": "a0010f000000fe96013f000000fefd91" + 64 * "0" + "7f7f"}.items()}
DRACO = {name: bytes.fromhex("445241434f0202" + data) for name, data in {
    "edgebreaker": "0101000000040401030000012f010110ff02664002ff00000000000100090300000201030902000102010101000303011001"
                   "300300508224910400000000ff0000000000000000000000000000000000803f08010101000303012001200300f0830b0600"
                   "0000003f00000000000000000000000000803f06",
    "sequential": "0100000004040100020100010301020302000301020009030000030902000102020001010003030120012003002084888101"
                  "00000000ff00000000010100030301300110030028826401000000003f0000000000000000000000000000000000803f0800"
                  "000000000000000000803f06"}.items()}


def compressed_gltf(views, accessors, primitive, blob, name, **more):
    """A GLB of one primitive whose data is `blob`; a placeholder is buffer 1."""
    text = json.dumps({"asset": {"version": "2.0"}, "meshes": [{"primitives": [primitive]}], "bufferViews": views,
                       "accessors": accessors, "extensionsRequired": [name],
                       "buffers": [{"byteLength": len(blob)}, {"byteLength": 999}], **more}, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    blob += bytes(-len(blob) % 4)
    return (struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(blob), len(text), 0x4e4f534a) + text +
            struct.pack("<II", len(blob), 0x004e4942) + blob)


def meshopt_gltf(positions, indices, name="EXT_meshopt_compression"):
    blob, views = b"", []
    for data, count, stride, mode, kind in ((positions, 4, 12, "ATTRIBUTES", positions), (indices, 12, 2, indices.upper(), "plain"),
                                            ("octahedral", 4, 4, "ATTRIBUTES", "octahedral")):
        extension = {"buffer": 0, "byteOffset": len(blob), "byteLength": len(MESHOPT[data]), "byteStride": stride,
                     "count": count, "mode": mode, "filter": "NONE" if kind == "plain" else kind.upper()}
        views.append({"buffer": 1, "byteLength": count * stride, "extensions": {name: extension}})
        blob += MESHOPT[data]
    accessors = [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4},
                 {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": 12},
                 {"bufferView": 2, "componentType": 5120, "type": "VEC3", "count": 4, "normalized": True}]
    views[2]["byteStride"] = 4
    return compressed_gltf(views, accessors, {"attributes": {"POSITION": 0, "NORMAL": 2}, "indices": 1}, blob, name)


def draco_gltf(method):
    name, data = "KHR_draco_mesh_compression", DRACO[method]
    accessors = [{"componentType": 5126, "type": "VEC3", "count": 4}, {"componentType": 5123, "type": "SCALAR", "count": 12},
                 {"componentType": 5126, "type": "VEC2", "count": 4}]
    primitive = {"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1,
                 "extensions": {name: {"bufferView": 0, "attributes": {"POSITION": 0, "TEXCOORD_0": 1}}}}
    return compressed_gltf([{"buffer": 0, "byteLength": len(data)}], accessors, primitive, data, name)


def gltf_seeds():
    points, triangles = TETRAHEDRON
    flat = w.flat(triangles)
    turned = [{"children": [1, 2], "rotation": [0, 0, 0.6, 0.8], "scale": [1, 2, -1]},
              {"mesh": 0, "translation": [1, 2, 3]},
              {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]}]
    yield "json", w.gltf(points, [(4, flat)])
    yield "glb", w.gltf(points, [(4, flat)], binary=True)
    yield "nodes", w.gltf(points, [(4, flat)], nodes=turned)
    yield "strips", w.gltf(QUADS[0], [(5, [0, 1, 2, 3, 4, 5, 6]), (6, [0, 1, 4, 3, 6])], binary=True)
    yield "sparse", w.gltf(points, [(4, flat), (4, flat[:3])], sparse=(2, (0.5, 0.5, 0.5)))
    yield "points", w.gltf(points, [(0, [0, 1]), (4, flat)])
    position = struct.pack("<12f", *w.flat(points))
    interleaved = b"".join(struct.pack("<3f4B", *p, 1, 2, 3, 255) for p in points)
    yield "unindexed", gltf_with({"POSITION": (5126, "VEC3", 3, position[:36], 0)}, None)
    yield "attributes", gltf_with(
        {"POSITION": (5126, "VEC3", 4, position, 12), "NORMAL": (5120, "VEC3", 4, bytes(range(16)), 4),
         "TEXCOORD_0": (5123, "VEC2", 4, bytes(range(16)), 0), "COLOR_0": (5121, "VEC4", 4, bytes(16), 0),
         "_ID": (5125, "SCALAR", 4, bytes(16), 0)}, flat)
    yield "quantized", gltf_with({"POSITION": (5122, "VEC3", 4, bytes(range(32)), 8)}, flat,
                                 extensionsUsed=["KHR_mesh_quantization"],
                                 extensionsRequired=["KHR_mesh_quantization"],
                                 nodes=[{"mesh": 0, "scale": [0.5, 0.5, 0.5]}], scenes=[{"nodes": [0]}], scene=0)
    yield "strided", gltf_with({"POSITION": (5126, "VEC3", 4, interleaved, 16)}, flat)
    yield "meshopt", meshopt_gltf("plain", "triangles")
    yield "meshopt-filters", meshopt_gltf("exponential", "indices", "KHR_meshopt_compression")
    for method in DRACO:
        yield "draco-" + method, draco_gltf(method)
    moved = {"index": 1, "texCoord": 1, "extensions": {"KHR_texture_transform": {"offset": [1, 2], "rotation": 1, "scale": [3, 4]}}}
    yield "materials", gltf_with(
        {"POSITION": (5126, "VEC3", 4, position, 0), "TEXCOORD_1": (5126, "VEC2", 4, position[:32], 0),
         "COLOR_0": (5121, "VEC4", 4, bytes(range(16)), 0)}, flat, {"material": 0},
        materials=[{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1], "metallicFactor": 0.5, "roughnessFactor": 0.5,
                                             "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": moved},
                    "normalTexture": {"index": 0, "scale": 2}, "occlusionTexture": {"index": 1, "strength": 0.5},
                    "emissiveTexture": {"index": 2}, "emissiveFactor": [1, 1, 0], "alphaMode": "MASK", "alphaCutoff": 0.25,
                    "doubleSided": True, "extensions": {"KHR_materials_unlit": {}, "KHR_materials_emissive_strength":
                                                        {"emissiveStrength": 2}}}],
        textures=[{"source": 0, "sampler": 0}, {"source": 1}, {"extensions": {"KHR_texture_basisu": {"source": 0}}}],
        samplers=[{"wrapS": 33071, "wrapT": 33648, "magFilter": 9728}],
        images=[{"uri": "data:image/png;base64,iVBORw0KGgo="}, {"bufferView": 0, "mimeType": "image/png"}])
    yield "no-view", gltf_with({"POSITION": (5126, "VEC3", 4, position, 0)}, flat, accessor={"min": [0], "max": [1]})


def obj_seeds():
    yield "plain", w.obj(*TETRAHEDRON)
    yield "quads", w.obj(*QUADS)
    yield "corners", (b"# x\nmtllib a.mtl\no b\nv 0 0 0\nv 1 0 0 1.0\nv 0 1 0\nvt 0 0\nvt 1 0.5 0\nvn 0 0 1\nvn 0 0 -1\ng c\n"
                      b"usemtl d\ns off\nf 1/1/1 2/2/1 3/1/2\nf -1//-1 -2//-2 -3//1\nf 1/1 2/2 3/\nl 1 2\n")
    yield "colors", b"v 0 0 0 1 0 0\nv 1 0 0 0 1 0\r\nv 0 1e-3 .5 0 0 1\nf 1 2 \\\n3\n"
    yield "before", b"f 1 2 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 9 9 9\n"


def off_seeds():
    yield "plain", w.off(*TETRAHEDRON)
    yield "quads", w.off(*QUADS)
    yield "headless", b"3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n"
    yield "colors", b"COFF # c\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0.5 0 0 1\n3 0 1 2\n"
    yield "all", (b"STCNOFF\n4 1 0\n0 0 0 0 0 1 1 2 3 0 0\n1 0 0 0 0 1 4 5 6 1 0\n1 1 0 0 0 1 7 8 9 1 1\n"
                  b"0 1 0 0 0 1 1 2 3 0 1\n4 0 1 2 3\n")


def ply_seeds():
    for name, order in (("text", ""), ("little", "<"), ("big", ">")):
        yield name, w.ply(*QUADS, order=order)
        yield name + "-strips", w.ply(QUADS[0], None, order=order, strips=STRIP, real="double")
    yield "decoded", w.decoded(*TETRAHEDRON)
    yield "names", (b"ply\nformat ascii 1.0\nobj_info x\ncomment lacedring attribute 3 0 POSITION\n"
                    b"comment lacedring attribute 2 0 TEXCOORD_0\ncomment lacedring attribute 1 0 we%20ight\n"
                    b"comment lacedring attribute 3 1 COLOR_0\nelement vertex 3\nproperty float x\nproperty float y\n"
                    b"property float z\nproperty float s\nproperty float t\nproperty double we\nproperty uchar red\n"
                    b"property uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar uint vertex_indices\n"
                    b"property list int float texcoord\nend_header\n0 0 0 0 0 1 9 9 9\n1 0 0 1 0 2 9 9 9\n0 1 0 0 1 3 9 9 9\n"
                    b"3 0 1 2 2 0.5 0.5\n")
    yield "other", (b"ply\r\nformat ascii 1.0\r\nelement material 1\r\nproperty int a\r\nelement vertex 3\r\nproperty float x\r\n"
                    b"property float y\r\nproperty float z\r\nproperty float nx\r\nproperty float ny\r\nproperty float nz\r\n"
                    b"element face 1\r\nproperty list uchar int vertex_index\r\nend_header\r\n7\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n"
                    b"0 1 0 0 0 1\r\n3 0 1 2\r\n")


def stl_seeds():
    yield "binary", w.stl(*TETRAHEDRON)
    yield "text", w.stl_text(*TETRAHEDRON)
    yield "two-solids", w.stl_text(*TETRAHEDRON) + w.stl_text(TETRAHEDRON[0], TETRAHEDRON[1][:1])


def regressions():
    """Inputs that once failed. A file NAME.hex has the bytes as hexadecimal digits."""
    for path in sorted((HERE / "regressions").glob("*/*")):
        data = path.read_bytes()
        yield path.parent.name, path.stem, bytes.fromhex(data.decode()) if path.suffix == ".hex" else data


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    subprocess.run([program, folder], check=True)

    def write(target, name, data):
        (folder / target).mkdir(exist_ok=True)
        (folder / target / name).write_bytes(data)

    for name, data in scene_seeds():
        write("scene", name, data)
    scenes = sorted(path for path in (folder / "scene").iterdir())
    subprocess.run([program, folder, *scenes], check=True)
    for number, (target, seeds) in enumerate({"gltf": gltf_seeds, "obj": obj_seeds, "off": off_seeds, "ply": ply_seeds,
                                              "stl": stl_seeds}.items()):
        for name, data in seeds():
            write(target, name, data)
            if target == "gltf":
                write("scene", name, data)
            options = bytes([0x40 + number, number, 1, number % 4, 1, 255, 0, FORMATS.index(target), 0])
            write("chain_mesh", f"{target}-{name}", data + options)
    for name, data in (("grid-ply", w.decoded(*grid(12))), ("grid-off", w.off(*grid(6)))):
        write("chain_mesh", name, data + bytes([0x42, 3, 2, 2, 1, 255, 0, FORMATS.index("any"), 0]))
    for target, name, data in regressions():
        write(target, f"regression-{name}", data)


if __name__ == "__main__":
    main()
