#!/usr/bin/env python3
"""test_pack_bad.py LACEDRING: packed scenes with one wrong field in the extension, and scenes that cannot be packed. Each is refused in
one line with exit code 3, and nothing is written; or the change does no harm, and the output can be read."""

import copy
import json
import os
import struct
import sys
import zlib

from cli_support import BAD_INPUT, DONE, HERE, CliTest, in_parallel, main, run

sys.path.insert(0, os.path.join(os.path.dirname(HERE), "scene"))
from make_scene import SceneMaker
from scene_reader import Scene

EXTENSION = "LACEDRING_mesh_compression"
REMOVED = object()
WRONG = [REMOVED, -1, 1.5, 0, 1, 2, 7, 2**31, 2**32 - 1, 2**32, 2**64 - 1, 10**30, "0", "", None, True, [], {}, [0], [[0]], {"a": 0}]


def split(glb):
    size = struct.unpack_from("<I", glb, 12)[0]
    return json.loads(glb[20:20 + size]), glb[28 + size:]


def join(document, binary):
    text = document if isinstance(document, bytes) else json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    binary += bytes(-len(binary) % 4)
    return (struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(binary)) + struct.pack("<I4s", len(text), b"JSON") + text +
            struct.pack("<I4s", len(binary), b"BIN\0") + binary)


class Packed:
    """A packed GLB whose document, plain or compressed, can be replaced."""

    def __init__(self, glb):
        self.outer, self.binary = split(glb)
        self.document = self.outer
        number = self.outer["extensions"][EXTENSION].get("document")
        self.view = None if number is None else self.outer["bufferViews"][number]
        if self.view:
            at = self.view["byteOffset"]
            self.document = json.loads(zlib.decompress(self.binary[at:at + self.view["byteLength"]]))

    def with_document(self, document):
        if not self.view:
            return join(document, self.binary)
        outer, packed = copy.deepcopy(self.outer), zlib.compress(json.dumps(document).encode())
        binary = self.binary[:self.view["byteOffset"]] + packed
        outer["bufferViews"][outer["extensions"][EXTENSION]["document"]]["byteLength"] = len(packed)
        outer["buffers"][0]["byteLength"] = len(binary)
        return join(outer, binary)


def paths_below(value, path=()):
    """The paths of a value and of all values in it; of long lists only the first three and the last."""
    yield path
    if isinstance(value, dict):
        for key in value:
            yield from paths_below(value[key], path + (key,))
    elif isinstance(value, list):
        for i in sorted({0, 1, 2, len(value) - 1} & set(range(len(value)))):
            yield from paths_below(value[i], path + (i,))


def extension_paths(document):
    """The paths of the extension's fields, and of fields that streams repeat or that the extension depends on."""
    for path in paths_below(document):
        if EXTENSION in path or (len(path) == 3 and path[0] == "accessors" and path[2] in ("count", "type", "componentType")):
            yield path
        elif path[:1] in (("bufferViews",), ("buffers",)) and len(path) <= 3:
            yield path
        elif len(path) >= 5 and path[0] == "meshes" and path[4] in ("indices", "attributes", "mode"):
            yield path


def mutated(document, path, value):
    out = copy.deepcopy(document)
    at = out
    for key in path[:-1]:
        at = at[key]
    if value is REMOVED:
        del at[path[-1]]
    else:
        at[path[-1]] = value
    return out


class PackBad(CliTest):
    def setUp(self):
        super().setUp()
        SceneMaker().write(self.path("scene.glb"))

    def packed(self, *options):
        path = self.path("good.glb")
        self.ok("pack", self.path("scene.glb"), "-o", path, "--force", *options)
        with open(path, "rb") as file:
            return file.read()

    def check(self, case):
        """Unpacks or packs bytes: fails with one line and no output, or writes an output that can be read."""
        name, command, data = case
        source, target = self.write(f"{name}.glb", data), self.path(f"{name}.out.glb")
        outcome = run(command, source, "-o", target)
        self.assertIn(outcome.code, (DONE, BAD_INPUT), f"{name}: {outcome}")
        if outcome.code == BAD_INPUT:
            self.check_error(outcome)
            self.assertFalse(os.path.exists(target), f"{name}: written although refused")
        else:
            Scene(target)
            os.remove(target)
        os.remove(source)
        return outcome.code

    def check_all(self, cases):
        """Checks all cases and returns how many were refused."""
        return sum(code == BAD_INPUT for code in in_parallel(self.check, cases))

    def test_wrong_fields(self):
        for options in (["--document", "plain"], ["--document", "packed"], ["--document", "plain", "--keep-order"]):
            packed = Packed(self.packed(*options))
            changes = [(path, wrong) for path in extension_paths(packed.document) for wrong in WRONG][::12]
            cases = [(f"f{i}", "unpack", packed.with_document(mutated(packed.document, *change))) for i, change in enumerate(changes)]
            refused = self.check_all(cases)
            print(f"{' '.join(options)}: {refused} of {len(cases)} refused")
            self.assertGreater(refused, len(cases) // 2)

    def test_damaged_bytes(self):
        """Files cut short, and files with a damaged byte."""
        cases = []
        for options in (["--document", "plain"], ["--document", "packed"]):
            good = self.packed(*options)
            step = len(good) // 60
            for at in range(0, len(good), step):
                cases.append((f"c{len(cases)}", "unpack", good[:at]))
                cases.append((f"c{len(cases)}", "unpack", good[:at] + bytes([good[at] ^ 0x41]) + good[at + 1:]))
        self.assertGreater(self.check_all(cases), len(cases) // 2)

    def test_wrong_packed_documents(self):
        """Packed documents that are not JSON, or are packed scenes themselves."""
        packed = Packed(self.packed("--document", "packed"))
        cases = []
        for text in (b"", b"{", b"[]", b"7", b"{}", b"[" * 100000, json.dumps(packed.outer).encode(), bytes(10**8)):
            outer, data = copy.deepcopy(packed.outer), zlib.compress(text)
            binary = packed.binary[:packed.view["byteOffset"]] + data
            outer["bufferViews"][0]["byteLength"] = len(data)
            outer["buffers"][0]["byteLength"] = len(binary)
            cases.append((f"o{len(cases)}", "unpack", join(outer, binary)))
        self.check_all(cases)
        self.fails("unpack", self.write("deep.glb", cases[6][2]), "-o", self.path("x.glb"), mentions=["packed document"])

    def test_broken_rules(self):
        """Rules that a change of one or two fields breaks."""
        def refused(says, change, *options):
            packed = Packed(self.packed("--document", "plain", *options))
            document = copy.deepcopy(packed.document)
            change(document, document["extensions"][EXTENSION]["streams"][0])
            source = self.write("rule.glb", packed.with_document(document))
            self.fails("unpack", source, "-o", self.path("x.glb"), mentions=[says])
            self.fails("info", source, mentions=[says])

        def placeholder(document):
            return next(b for b in document["buffers"] if EXTENSION in b.get("extensions", {}))

        refused("ordered", lambda d, s: s.update(ordered=True))
        refused("ordered", lambda d, s: s.update(ordered=0))
        refused("ordered", lambda d, s: s.pop("ordered"), "--keep-order")
        refused("ordered", lambda d, s: s.update(ordered=False), "--keep-order")
        refused("placeholder", lambda d, s: placeholder(d).update(uri="data:application/octet-stream;base64,AAAA"))
        refused("placeholder", lambda d, s: placeholder(d)["extensions"][EXTENSION].update(placeholder=False))
        refused("placeholder", lambda d, s: d["buffers"][0].update(extensions={EXTENSION: {"placeholder": True}}))
        refused("placeholder", lambda d, s: placeholder(d).update(byteLength=3))
        refused("KHR_draco", lambda d, s: d["extensionsUsed"].append("KHR_draco_mesh_compression"))
        refused("is coded", lambda d, s: d["bufferViews"][s["bufferView"]].update(
            extensions={EXTENSION: {"buffer": 0, "byteLength": 8, "coding": "deflate"}}))
        plain = next(i for i, a in enumerate(Packed(self.packed("--document", "plain")).document["accessors"]) if "bufferView" in a)
        refused(f"accessor {plain}", lambda d, s: d["accessors"][plain].update(bufferView=s["bufferView"]))
        refused("image 0", lambda d, s: d.update(images=[{"bufferView": s["bufferView"], "mimeType": "image/png"}]))
        # Attribute names in a stream may differ from the document's.
        packed = Packed(self.packed("--document", "plain"))
        for mesh in packed.document["meshes"]:
            for primitive in mesh["primitives"]:
                if "NORMAL" in primitive["attributes"]:
                    primitive["attributes"]["_RENAMED"] = primitive["attributes"].pop("NORMAL")
        self.ok("unpack", self.write("renamed.glb", packed.with_document(packed.document)), "-o", self.path("fine.glb"))

    def test_commands_refuse_damaged_scenes(self):
        """Damaged packed scenes in commands that read meshes."""
        good = self.packed()
        cases = []
        for at in range(0, len(good), len(good) // 12):
            for data in (good[:at], good[:at] + bytes([good[at] ^ 0x41]) + good[at + 1:]):
                cases += [(command, self.write(f"d{len(cases)}.glb", data)) for command in ("info", "verify", "stats")]

        def check(case):
            outcome = run(*case)
            self.assertIn(outcome.code, (DONE, BAD_INPUT), str(outcome))
            if outcome.code == BAD_INPUT:
                self.check_error(outcome)
            return outcome.code

        self.assertGreater(sum(code == BAD_INPUT for code in in_parallel(check, cases)), len(cases) // 2)

    def test_scenes_that_pack_cannot_read(self):
        """Scenes that pack cannot read."""
        with open(self.path("scene.glb"), "rb") as file:
            document, binary = split(file.read())
        changes = []
        for path in paths_below(document):
            wanted = (path[:1] == ("accessors",) and len(path) <= 3) or (path[:1] == ("bufferViews",) and len(path) <= 3) or (
                path[:1] == ("meshes",) and 4 <= len(path) <= 6)
            if wanted:
                changes += [(path, wrong) for wrong in WRONG]
        cases = [(f"s{i}", "pack", join(mutated(document, *change), binary))
                 for i, change in enumerate(changes[::30])]
        self.assertGreater(self.check_all(cases), 10)
        lost = {**document, "buffers": [{"byteLength": 12, "uri": "missing.bin"}]}
        self.fails("pack", self.write("lost.glb", join(lost, b"")), "-o", self.path("x.glb"), mentions=["missing.bin"])
        self.packed()
        self.fails("pack", self.path("good.glb"), "-o", self.path("x.glb"), mentions=["packed already"])


if __name__ == "__main__":
    main()
