#!/usr/bin/env python3
"""make_scene.py OUT.gltf|OUT.glb...: writes a scene with every glTF feature that packing could lose.

The bytes are always the same. tests/scene/compare_scenes.py compares the unpacked scene with it.
"""

import math
import sys

from gltf_writer import GltfWriter, data_uri, number, png

POINTS, LINES, LINE_STRIP, TRIANGLES, STRIP, FAN = 0, 1, 3, 4, 5, 6


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


class Grid:
    """columns x rows quads over the unit square, placed by position(u, v)."""

    def __init__(self, columns, rows, position):
        step = 1e-4
        self.positions, self.normals, self.tangents, self.texcoords, self.triangles = [], [], [], [], []
        for row in range(rows + 1):
            for column in range(columns + 1):
                u, v = column / columns, row / rows
                p = position(u, v)
                du = unit(tuple(b - a for a, b in zip(position(u - step, v), position(u + step, v))))
                dv = tuple(b - a for a, b in zip(position(u, v - step), position(u, v + step)))
                self.positions.append(p)
                self.normals.append(unit(cross(du, dv)))
                self.tangents.append((*du, 1.0 if column % 2 else -1.0))
                self.texcoords.append((u, v))
        for row in range(rows):
            for column in range(columns):
                a = row * (columns + 1) + column
                b = a + columns + 1
                self.triangles += [a, a + 1, b + 1, a, b + 1, b]

    def columns(self):
        return {"POSITION": (self.positions, "VEC3", "f", False), "NORMAL": (self.normals, "VEC3", "f", False),
                "TEXCOORD_0": (self.texcoords, "VEC2", "f", False)}


def torus(u, v):
    a, b = 2 * math.pi * u, 2 * math.pi * v
    r = 0.35 + 0.05 * math.sin(5 * a) * math.sin(3 * b)
    return ((0.8 + r * math.cos(b)) * math.cos(a), (0.8 + r * math.cos(b)) * math.sin(a), r * math.sin(b))


def wave(u, v):
    return (2 * u - 1, 2 * v - 1, 0.3 * math.sin(4 * u) * math.cos(3 * v))


def tube(u, v):
    a = 2 * math.pi * u
    return (0.4 * math.sin(a), 2 * v, 0.4 * math.cos(a))


def dome(u, v):
    a, b = 2 * math.pi * u, 0.1 + 2.9 * v
    return (0.9 * math.cos(a) * math.sin(b), 0.9 * math.sin(a) * math.sin(b), -0.9 * math.cos(b))


EXTRAS = {"one": number("1.0"), "small": number("1e-3"), "large": number("12345678901234567890"), "exact": number("0.10000"),
          "negative_zero": number("-0.0"), "exponent": number("1E+2"), "text": "caf\u00e9 \U0001f600 \"quoted\" \\ / \t\u0001",
          "nothing": None, "yes": True, "list": [1, [2, [3, {}]], []], "@": ""}


def extras(name):
    return {"of": name, "nested": {"again": EXTRAS}}


class SceneMaker(GltfWriter):
    def __init__(self):
        super().__init__()
        self.meshes, self.nodes = [], []
        self.materials()
        self.mesh_smooth()
        self.mesh_shared()
        self.mesh_modes()
        self.mesh_morphed()
        self.mesh_skinned()
        self.mesh_quantized()
        self.mesh_interleaved()
        unused = self.accessor([(i, -i) for i in range(5)], "VEC2")
        self.json["accessors"][unused]["extras"] = extras("accessor")
        self.place()

    def mesh(self, name, primitives, **more):
        self.meshes.append({"name": name, "primitives": primitives, "extras": extras(name), **more})

    def materials(self):
        checker = png(8, 8, lambda x, y: (240, 200, 60) if (x + y) % 2 else (40, 90, 20 * x + 20))
        bumps = png(4, 4, lambda x, y: (128 + 20 * (x % 2), 128 - 20 * (y % 2), 250))
        self.json["images"] = [{"bufferView": self.view(checker), "mimeType": "image/png", "name": "checker"},
                               {"uri": data_uri(bumps, "image/png"), "name": "bumps", "extras": extras("image")}]
        self.json["samplers"] = [{"magFilter": 9728, "minFilter": 9987, "wrapS": 10497, "wrapT": 33648}, {"extras": extras("sampler")}]
        self.json["textures"] = [{"source": 0, "sampler": 0}, {"source": 1, "sampler": 1}]
        transform = {"offset": [number("0.50"), 0], "rotation": 0.25, "scale": [3, number("2.0")], "texCoord": 0}
        self.json["materials"] = [
            {"name": "textured", "extras": extras("material"),
             "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": transform}},
                                      "metallicFactor": number("0.10"), "roughnessFactor": 0.5},
             "normalTexture": {"index": 1, "texCoord": 1, "scale": 0.5},
             "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": number("0.30")},
                            "KHR_materials_sheen": {"sheenColorFactor": [0.2, 0.1, number("0.0")], "sheenRoughnessFactor": 0.4}}},
            {"name": "glossy", "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.3, 0.2, 1], "metallicFactor": 0},
             "doubleSided": True, "extensions": {"KHR_materials_ior": {"ior": number("1.40")},
                                                 "KHR_materials_specular": {"specularFactor": 0.5}}},
            {"name": "unlit", "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.5, 0.9, 1]}, "doubleSided": True,
             "extensions": {"KHR_materials_unlit": {}}},
            {"name": "bright", "emissiveFactor": [0.1, 0.3, 0.1], "doubleSided": True,
             "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}},
            {"name": "glass", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.8, 1, 0.5]},
             "doubleSided": True}]

    def mesh_smooth(self):
        grid = Grid(64, 32, torus)
        grid.positions[1] = (grid.positions[1][0], -0.0, grid.positions[1][2])
        texcoords = self.attribute(grid.texcoords, "VEC2")
        self.mesh("smooth", [{"attributes": {"POSITION": self.positions(grid.positions), "NORMAL": self.attribute(grid.normals, "VEC3"),
                                             "TANGENT": self.attribute(grid.tangents, "VEC4"),
                                             "TEXCOORD_0": texcoords, "TEXCOORD_1": texcoords},
                              "indices": self.indices(grid.triangles, limits=True), "material": 0, "mode": TRIANGLES}])

    def mesh_shared(self):
        """Primitives that share some or all of their accessors, also triangles with lines."""
        grid = Grid(12, 12, wave)
        half = len(grid.triangles) // 6 * 3
        shared = {"POSITION": self.positions(grid.positions), "NORMAL": self.attribute(grid.normals, "VEC3"),
                  "TEXCOORD_0": self.attribute(grid.texcoords, "VEC2")}
        back = self.attribute([tuple(-x for x in n) for n in grid.normals], "VEC3")
        quarter = half // 6 * 3
        self.mesh("shared", [
            {"attributes": shared, "indices": self.indices(grid.triangles[:half], "B"), "material": 1, "extras": extras("primitive"),
             "extensions": {"EXAMPLE_anything": {"primitive": EXTRAS},
                            "KHR_materials_variants": {"mappings": [{"material": 2, "variants": [0, 1]}]}}},
            {"attributes": shared, "indices": self.indices(grid.triangles[half:half + quarter], "I"), "material": 2},
            {"attributes": {"POSITION": shared["POSITION"], "NORMAL": back},
             "indices": self.indices(grid.triangles[half + quarter:] + [0, 0, 1]), "material": 3}])
        border = [(x, 3, z) for x, z in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        position = self.positions(border)
        self.mesh("outlined", [{"attributes": {"POSITION": position}, "indices": self.indices([0, 1, 2, 0, 2, 3], "B"), "material": 3},
                               {"attributes": {"POSITION": position}, "indices": self.indices([0, 1, 1, 2, 2, 3, 3, 0], "B"),
                                "mode": LINES, "material": 2}])

    def mesh_modes(self):
        """All primitive modes: triangle lists, strips and fans, points and lines."""
        soup = Grid(6, 4, lambda u, v: (u, v, 0.2 * u * v))
        corners = [soup.positions[v] for v in soup.triangles]
        colors = [(40 * v % 256, 255 - 30 * v % 256, 128, 255) for v in soup.triangles]
        columns, rows = 8, 3
        ribbon = Grid(columns, rows, lambda u, v: (u, v - 1.1, 0.1 * math.sin(6 * u)))
        strip = []
        for row in range(rows):  # the strips of rows are joined by degenerate triangles
            one = [v for c in range(columns + 1) for v in ((row + 1) * (columns + 1) + c, row * (columns + 1) + c)]
            strip += ([strip[-1], one[0]] if strip else []) + one
        fan = [(-0.5, 0.5, 0)] + [(-0.5 + 0.4 * math.cos(a / 2), 0.5 + 0.4 * math.sin(a / 2), 0.1 * a) for a in range(11)]
        zigzag = [(-1 + x / 4, -1 if x % 2 else -0.5, 0.05 * x) for x in range(8)]
        dots = [(-1 + i / 10, -1.2, 0.1 * (i % 3)) for i in range(20)]
        self.mesh("modes", [
            {"attributes": {"POSITION": self.positions(corners), "COLOR_0": self.attribute(colors, "VEC4", "B", normalized=True)},
             "material": 3},
            {"attributes": {"POSITION": self.positions(ribbon.positions), "NORMAL": self.attribute(ribbon.normals, "VEC3")},
             "indices": self.indices(strip, "B"), "mode": STRIP, "material": 1},
            {"attributes": {"POSITION": self.positions(zigzag)}, "mode": STRIP, "material": 2},
            {"attributes": {"POSITION": self.positions(fan)}, "mode": FAN, "material": 1},
            {"attributes": {"POSITION": self.positions(fan)}, "indices": self.indices(range(1, 12)), "mode": LINE_STRIP},
            {"attributes": {"POSITION": self.positions(dots), "COLOR_0": self.attribute([(i / 20, 1, 0) for i in range(20)], "VEC3")},
             "mode": POINTS}])

    def mesh_morphed(self):
        grid = Grid(16, 16, wave)
        count = len(grid.positions)
        changed = {i: (grid.positions[i][0], grid.positions[i][1], 0.5) for i in range(100, 140, 3)}
        moved = {i: (0.1, 0.0, 0.6 * math.sin(i)) for i in range(0, count, 7)}
        turned = [(0.0, 0.05 * math.sin(i), -0.0) for i in range(count)]
        self.mesh("morphed", [
            {"attributes": {"POSITION": self.sparse(grid.positions, changed), "NORMAL": self.attribute(grid.normals, "VEC3")},
             "targets": [{"POSITION": self.sparse(grid.positions, moved, base=False), "NORMAL": self.attribute(turned, "VEC3")},
                         {"POSITION": self.attribute([(0, 0.3 * n[2], 0) for n in grid.normals], "VEC3", limits=True, buffer=1),
                          "NORMAL": self.describe([(0, 0, 0)] * count, "VEC3", "f")}],  # no buffer view: zeros
             "indices": self.indices(grid.triangles), "material": 1}], weights=[number("0.50"), 0.25])
        self.meshes[-1]["extras"]["targetNames"] = ["up", "along"]

    def mesh_skinned(self):
        grid = Grid(16, 16, tube)
        bytes_of_share = [round(255 * min(1.0, max(0.0, p[1] - 0.5))) for p in grid.positions]
        share = [w / 255 for w in bytes_of_share]
        common = {"POSITION": self.positions(grid.positions), "NORMAL": self.attribute(grid.normals, "VEC3")}
        weights = [(255 - w, w, 0, 0) if w < 255 else (255, 0, 0, 0) for w in bytes_of_share]
        joints = [(0 if w < 1 else 1, 1 if 0 < w < 1 else 0, 0, 0) for w in share]
        half = len(grid.triangles) // 6 * 3
        self.mesh("skinned", [
            {"attributes": {**common, "JOINTS_0": self.attribute(joints, "VEC4", "B"),
                            "WEIGHTS_0": self.attribute([tuple(x / 255 for x in w) for w in weights], "VEC4")},
             "indices": self.indices(grid.triangles[:half]), "material": 1},
            {"attributes": {**common, "JOINTS_0": self.attribute(joints, "VEC4", "H"),
                            "WEIGHTS_0": self.attribute(weights, "VEC4", "B", normalized=True)},
             "indices": self.indices(grid.triangles[half:]), "material": 2}])

    def mesh_quantized(self):
        grid = Grid(20, 12, dome)
        self.mesh("quantized", [{"attributes": self.interleaved({
            "POSITION": ([tuple(round(32767 * x) for x in p) for p in grid.positions], "VEC3", "h", True),
            "NORMAL": ([tuple(round(127 * x) for x in n) for n in grid.normals], "VEC3", "b", True),
            "TEXCOORD_0": ([tuple(round(65535 * x) for x in t) for t in grid.texcoords], "VEC2", "H", True)}),
            "indices": self.indices(grid.triangles), "material": 4}])

    def mesh_interleaved(self):
        grid = Grid(10, 8, dome)
        columns = {**grid.columns(), "COLOR_0": ([(0.5 + p[0] / 2, 0.5 + p[1] / 2, 0.8) for p in grid.positions], "VEC3", "f", False),
                   "_TEMPERATURE": ([(20 + 15 * p[2],) for p in grid.positions], "SCALAR", "f", False)}
        self.mesh("interleaved", [{"attributes": self.interleaved(columns), "indices": self.indices(grid.triangles), "material": 1}])

    def node(self, name, **more):
        self.nodes.append({"name": name, **more})
        return len(self.nodes) - 1

    def place(self):
        mesh = {m["name"]: i for i, m in enumerate(self.meshes)}
        turned = [0, 0, math.sin(0.2), math.cos(0.2)]
        instances = {"TRANSLATION": self.accessor([(1.2 * i, 0.3 * i, 0) for i in range(4)], "VEC3"),
                     "ROTATION": self.accessor([(0, math.sin(i / 4), 0, math.cos(i / 4)) for i in range(4)], "VEC4"),
                     "SCALE": self.accessor([(0.4, 0.4, 0.3 + 0.1 * i) for i in range(4)], "VEC3")}
        children = [
            self.node("torus", mesh=mesh["smooth"], translation=[number("-3.0"), 3, 0], extras=extras("node"),
                      extensions={"EXAMPLE_anything": {"node": EXTRAS}}),
            self.node("shared", mesh=mesh["shared"], rotation=turned),
            self.node("outlined", mesh=mesh["outlined"], translation=[0, -3.5, number("-1e-1")]),
            self.node("modes", mesh=mesh["modes"], matrix=[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 3, number("0.0"), 0, 1]),
            self.node("morphed", mesh=mesh["morphed"], translation=[0, 3, 0], weights=[0.75, 0.1]),
            self.node("quantized", mesh=mesh["quantized"], translation=[3, 3, 0], scale=[number("1.10"), 1.1, 1.1]),
            self.node("mirrored", mesh=mesh["interleaved"], translation=[-3, 0, 0], scale=[-0.8, 1, 1]),
            self.node("again", mesh=mesh["interleaved"], translation=[3, -3, 0], rotation=turned),
            self.node("many", mesh=mesh["interleaved"], translation=[-1.5, -3.5, 0],
                      extensions={"EXT_mesh_gpu_instancing": {"attributes": instances}}),
            self.node("perspective", camera=0, translation=[0, 0, 12]),
            self.node("orthographic", camera=1, translation=[0, 0, 12])]
        children += [self.node(kind, extensions={"KHR_lights_punctual": {"light": i}}, translation=[i, 1, 6])
                     for i, kind in enumerate(("sun", "lamp", "torch"))]
        root = self.node("root", children=children, extras=extras("root"))
        tip = self.node("joint 2", translation=[0, 1, 0])
        hip = self.node("joint 1", children=[tip], translation=[-3.5, -4, 0])
        skinned = self.node("skinned", mesh=mesh["skinned"], skin=0)
        alone = self.node("alone", mesh=mesh["shared"])
        identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        above = identity[:13] + [-1] + identity[14:]
        inverse = self.accessor([identity, above], "MAT4")
        times = self.accessor([(0,), (0.5,), (2,)], "SCALAR", limits=True)
        animation = Animation(self)
        animation.channel(self.nodes[tip], times, "rotation", "LINEAR",
                          [(0, 0, 0, 1), (0, 0, math.sin(0.3), math.cos(0.3)), (0, 0, 0, 1)], "VEC4")
        animation.channel(self.nodes[children[1]], times, "translation", "STEP", [(0, 0, 0), (0, 0, 0.5), (0, 0, 1)], "VEC3")
        animation.channel(self.nodes[children[0]], times, "scale", "CUBICSPLINE",
                          [v for s in (1, 0.8, 1.1) for v in ((0, 0, 0), (s, s, 1), (0.1, 0, 0))], "VEC3")
        animation.channel(self.nodes[children[4]], times, "weights", "LINEAR", [(w,) for w in (0, 0, 1, 0.5, 0, 1)], "SCALAR")
        self.json.update({
            "asset": {"version": "2.0", "generator": "make_scene.py", "extras": extras("asset")},
            "scene": 0, "scenes": [{"name": "all", "nodes": [root, hip, skinned], "extras": extras("scene")},
                                   {"name": "other", "nodes": [root, alone]}],
            "nodes": self.nodes, "meshes": self.meshes,
            "skins": [{"joints": [hip, tip], "skeleton": hip, "inverseBindMatrices": inverse, "extras": extras("skin")}],
            "animations": [{"name": "all", "channels": animation.channels, "samplers": animation.samplers, "extras": extras("animation")}],
            "cameras": [{"type": "perspective",
                         "perspective": {"yfov": number("0.80"), "znear": 0.1, "zfar": number("1e2"), "aspectRatio": 1.5}},
                        {"type": "orthographic", "orthographic": {"xmag": number("5.0"), "ymag": 5, "znear": 0.1, "zfar": 50},
                         "extras": extras("camera")}],
            "extensionsUsed": ["EXAMPLE_anything", "KHR_lights_punctual", "KHR_mesh_quantization", "EXT_mesh_gpu_instancing",
                               "KHR_texture_transform", "KHR_materials_variants", "KHR_materials_clearcoat", "KHR_materials_sheen",
                               "KHR_materials_ior", "KHR_materials_specular", "KHR_materials_unlit", "KHR_materials_emissive_strength"],
            "extensionsRequired": ["KHR_mesh_quantization"],
            "extensions": {"EXAMPLE_anything": {"root": EXTRAS},
                           "KHR_materials_variants": {"variants": [{"name": "a"}, {"name": "b"}]},
                           "KHR_lights_punctual": {"lights": [{"type": "directional", "intensity": number("1.50")},
                                                              {"type": "point", "color": [1, 0.5, 0.5], "intensity": 20},
                                                              {"type": "spot", "intensity": 30, "spot": {"outerConeAngle": 0.6}}]}},
            "extras": extras("document")})


class Animation:
    def __init__(self, scene):
        self.scene, self.channels, self.samplers = scene, [], []

    def channel(self, node, times, path, interpolation, values, kind):
        self.samplers.append({"input": times, "output": self.scene.accessor(values, kind), "interpolation": interpolation})
        self.channels.append({"sampler": len(self.samplers) - 1,
                              "target": {"node": self.scene.nodes.index(node), "path": path}, "extras": {"n": number("2.50")}})


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    for path in sys.argv[1:]:
        SceneMaker().write(path)


if __name__ == "__main__":
    main()
