#!/usr/bin/env python3
"""test_bad_input.py LACEDRING: damaged files, hostile counts, unwritable outputs. The program may not crash, hang, print more
than one line, or leave a file behind. Damage is random; LACEDRING_TEST_SEED repeats a run."""

import json
import os
import random
import resource
import signal
import struct
import zlib

from cli_support import BAD_INPUT, DONE, SANITIZED, WRONG_USAGE, CliTest, in_parallel, main, run

import check_decode
import mesh_writers as write

SEED = int(os.environ.get("LACEDRING_TEST_SEED") or random.SystemRandom().randrange(1 << 32))
CUTS = 25 if SANITIZED else 200  # per format: lengths to which a file is cut
FLIPS = 25 if SANITIZED else 200

POINTS = [(0.0, 0.0, 0.0), (1.5, 0.0, 0.0), (1.0, 1.0, 0.25), (0.0, 1.0, 0.0), (0.1, 0.2, -3e-7)]
TRIANGLES = [(0, 1, 2), (0, 2, 3), (0, 4, 1), (1, 4, 2)]
NAN, INFINITE = float("nan"), float("inf")


def grid(n):
    points = [(0.1 * x, 0.1 * y, 0.01 * x * y) for y in range(n + 1) for x in range(n + 1)]
    triangles = []
    for y in range(n):
        for x in range(n):
            v = y * (n + 1) + x
            triangles += [(v, v + 1, v + n + 2), (v, v + n + 2, v + n + 1)]
    return points, triangles


def samples():
    """{name: bytes} of a small file in every format."""
    points, triangles = grid(5)
    flat = write.flat(triangles)
    return {"a.obj": write.obj(points, triangles), "a.off": write.off(points, triangles),
            "binary.stl": write.stl(points, triangles), "ascii.stl": write.stl_text(points, triangles),
            "little.ply": write.ply(points, triangles), "big.ply": write.ply(points, triangles, ">"),
            "ascii.ply": write.ply(points, triangles, ""), "strip.ply": write.ply(points, [], strips=flat),
            "a.glb": write.gltf(points, [(4, flat)], binary=True, sparse=(2, (7, 8, 9))),
            "a.gltf": write.gltf(points, [(4, flat), (5, flat)], nodes=[{"mesh": 0, "scale": [-1, 2, 3]}])}


class Damage(CliTest):
    """Cut and changed files are refused, or read as a mesh that all commands can use."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        print(f"LACEDRING_TEST_SEED={SEED}", flush=True)

    def setUp(self):
        super().setUp()
        self.random = random.Random(SEED)
        self.count = 0

    def try_file(self, name, data, label, may_pass):
        """Encodes (or decodes) the damaged file in a folder of its own."""
        folder = self.path(label.replace(" ", "-"))
        os.mkdir(folder)
        source = os.path.join(folder, name)
        with open(source, "wb") as file:
            file.write(data)
        is_lr = name.endswith(".lr")
        target = os.path.join(folder, "out.ply" if is_lr else "out.lr")
        outcome = run("decode" if is_lr else "encode", source, "-o", target)
        try:
            if outcome.code == DONE:
                self.assertTrue(may_pass, f"accepted: {outcome}")
                self.assertEqual(sorted(os.listdir(folder)), sorted([name, os.path.basename(target)]), str(outcome))
            else:
                self.check_error(outcome, source)
                self.assertEqual(os.listdir(folder), [name], f"left behind: {outcome}")
        except AssertionError as error:
            raise AssertionError(f"{name}, {label} (LACEDRING_TEST_SEED={SEED}): {error}") from None
        return outcome.code, target

    def places(self, size, count):
        return sorted({0, 1, size - 1} | {self.random.randrange(size) for _ in range(count)})

    def test_truncated(self):
        jobs = []
        for name, data in samples().items():
            text = name in ("a.obj", "a.off", "ascii.ply", "ascii.stl")
            for at in self.places(len(data), CUTS):
                # Cutting may remove digits of the last number, and an OBJ may end with any line.
                may_pass = name == "a.obj" or (text and at > len(data) - 8)
                jobs.append((name, data[:at], f"{name} cut at {at}", may_pass))
        in_parallel(lambda job: self.try_file(*job), jobs)

    def test_flipped(self):
        jobs = []
        for name, data in samples().items():
            for i in range(FLIPS):
                damaged = bytearray(data)
                where = [self.random.randrange(len(data)) for _ in range(self.random.choice((1, 1, 1, 4, 20)))]
                for at in where:
                    damaged[at] = self.random.choice((damaged[at] ^ 1 << self.random.randrange(8), 0, 255, 45, 57, 32))
                jobs.append((name, bytes(damaged), f"{name} change {i} at {where[0]}", True))
        results = in_parallel(lambda job: self.try_file(*job), jobs)
        self.assertTrue(any(code == BAD_INPUT for code, _ in results))
        self.assertTrue(any(code == DONE for code, _ in results))
        for code, target in results[::7]:  # every seventh file is used further, if it was accepted
            if code == DONE:
                self.ok("verify", target)

    def make_lr(self, form, *options):
        stored = form == "packed" and not options  # a soup has no storage form
        source = self.generate("blob" if stored else "soup", 300, 2)
        lr = self.path("-".join(("good", form, *options)) + ".lr")
        self.ok("encode", source, "-o", lr, "--format", form, *options)
        with open(lr, "rb") as file:
            return lr, file.read()

    def test_lr_truncated_and_flipped(self):
        # The last form has uncompressed attributes.
        for form in (("lean",), ("packed",), ("packed", "--resident"), ("lr",)):
            self.truncate_and_flip(*form)

    def truncate_and_flip(self, form, *options):
        lr, data = self.make_lr(form, *options)
        form = "-".join((form, *options))
        clean = self.path(f"clean-{form}.ply")
        self.ok("decode", lr, "-o", clean)
        with open(clean, "rb") as file:
            expected = file.read()
        jobs = [("a.lr", data[:at], f"{form} cut at {at}", False) for at in self.places(len(data), CUTS)]
        jobs += [("a.lr", data + bytes(extra), f"{form} with {extra} bytes more", False) for extra in (1, 4, 32)]
        in_parallel(lambda job: self.try_file(*job), jobs)
        jobs = []
        for i in range(2 * FLIPS):
            damaged = bytearray(data)
            at = self.random.randrange(len(data)) if i >= 64 else i  # first every byte of the header
            damaged[at] ^= 1 << self.random.randrange(8)
            jobs.append(("a.lr", bytes(damaged), f"{form} byte {at} changed, {i}", True))
        for (code, target), job in zip(in_parallel(lambda job: self.try_file(*job), jobs), jobs):
            if code == DONE:  # the byte was padding between sections
                with open(target, "rb") as file:
                    self.assertEqual(file.read(), expected, f"{job[2]} (LACEDRING_TEST_SEED={SEED})")

    def test_lr_forged(self):
        """Files with wrong numbers and valid checksums are refused, or decode as the format says."""
        _, data = self.make_lr("lean")
        jobs = []
        for change in (1, -1, 1000, 1 << 29, 1 << 31):
            for word in range(2, 7):  # counts in the stream's header
                jobs.append(("a.lr", forge(data, LEAN, lambda w: change_word(w, word, change)),
                             f"count {word} {change:+}", False))
            for word in (1, 6):  # vertices and exceptions of the vertex stream
                jobs.append(("a.lr", forge(data, VERTICES, lambda w: change_word(w, word, change)),
                             f"vertex stream's count {word} {change:+}", False))
        for i in range(FLIPS):
            at = self.random.randrange(1 << 30)
            bit = self.random.choice((0, 1, 3, 5, 10, 20, 28, 29, 30, 31))
            jobs.append(("a.lr", forge(data, LEAN, lambda w: change_word(w, 8 + at % (len(w) - 8), 1 << bit)),
                         f"payload word {at} plus bit {bit}, {i}", True))
            jobs.append(("a.lr", forge(data, VERTICES, lambda w: change_word(w, 7 + at % (len(w) - 7), 1 << bit)),
                         f"vertex stream's word {at} plus bit {bit}, {i}", True))
        for (code, target), job in zip(in_parallel(lambda job: self.try_file(*job), jobs), jobs):
            if code == DONE:
                numbers = {}
                with open(target, "rb") as file:
                    ours = check_decode.multiset(check_decode.read_ply(file.read()), numbers)
                theirs = check_decode.multiset(check_decode.read_lr(job[1]), numbers)
                self.assertEqual(ours[0], theirs[0], f"{job[2]} (LACEDRING_TEST_SEED={SEED})")
        section_table = 32
        for offset, value in ((8, 2 ** 32 - 1), (8, 2 ** 27), (12, 0), (12, 2 ** 32 - 1), (section_table + 8, 2 ** 63),
                              (section_table + 16, 2 ** 64 - 1), (section_table + 16, 4), (section_table, 99),
                              (section_table + 2, 1), (section_table + 34, 1), (section_table + 24, 1 << 17),
                              (section_table + 28, 1), (section_table + 56, 0x306), (section_table + 56, 1 << 16),
                              (section_table + 56, 1 << 18), (section_table + 60, 2 ** 32 - 1)):
            damaged = bytearray(data)
            size = {2: 2, 8: 8, 16: 8}.get((offset - section_table) % 32, 4) if offset >= section_table else 4
            damaged[offset:offset + size] = value.to_bytes(size, "little")
            self.try_file("a.lr", seal(damaged), f"field {offset} {value}", False)


def change_word(words, at, change):
    words[at] = (words[at] + change) % (1 << 32)


LEAN, VERTICES = 1, 8  # section kinds


def forge(data, wanted, edit):
    """Edits the words of the stream of section kind `wanted`, and sets all checksums."""
    data = bytearray(data)
    at = {LEAN: 7, VERTICES: 3}[wanted]  # word of the stream's checksum
    found = 0
    for i in range(struct.unpack_from("<I", data, 8)[0]):
        kind, _, _, offset, size, _, name_length = struct.unpack_from("<HHIQQII", data, 32 + 32 * i)
        if kind != wanted:
            continue
        found += 1
        begin = offset + (name_length + 7) // 8 * 8
        words = list(struct.unpack_from(f"<{(offset + size - begin) // 4}I", data, begin))
        edit(words)
        behind = struct.pack(f"<{len(words) - at - 1}I", *words[at + 1:])
        words[at] = zlib.crc32(behind, zlib.crc32(struct.pack(f"<{at}I", *words[:at])))
        struct.pack_into(f"<{len(words)}I", data, begin, *words)
        struct.pack_into("<I", data, 32 + 32 * i + 4, zlib.crc32(data[offset:offset + size]))
    assert found == 1, "not one stream of that kind"
    return seal(data)


def seal(data):
    count = struct.unpack_from("<I", data, 8)[0]
    struct.pack_into("<I", data, 24, zlib.crc32(data[32:32 + 32 * min(count, 1000)]))
    struct.pack_into("<I", data, 28, zlib.crc32(data[:28]))
    return bytes(data)


class Wrong(CliTest):
    """Files with one error. The message names the file and the place."""

    def check_memory(self):
        """Hostile counts are refused before memory is allocated for them."""
        if not SANITIZED:
            self.assertLess(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss, 600 * 1024)

    def refused(self, name, data, *mentions, label=""):
        with self.subTest(name=name, label=label or data[:60], mentions=mentions):
            source = self.write(name, data)
            self.fails("encode", source, "-o", self.path("out.lr"), mentions=[source, *mentions])
            os.remove(source)

    def test_no_such_file(self):
        os.mkdir(self.path("folder.ply"))
        self.write("empty.ply", b"")
        self.write("empty.lr", b"")
        self.write("text.txt", b"hello\n")
        self.write("text.lr", b"hello\n")
        self.write("noise.obj", bytes(random.Random(1).randrange(256) for _ in range(2000)))
        for name in ("missing.ply", "missing.lr", "folder.ply", "empty.ply", "empty.lr", "text.txt", "text.lr", "noise.obj"):
            source = self.path(name)
            for arguments in (["info"], ["info", "--json"], ["stats"], ["stats", "--json"], ["verify"], ["verify", "--json"],
                              ["bench"], ["bench", "--json"], ["encode", "-o", self.path("out.lr")]):
                with self.subTest(name=name, arguments=arguments):
                    self.fails(arguments[0], source, *arguments[1:], mentions=[source])
            self.fails("decode", source, "-o", self.path("out.ply"), mentions=[source])
        good = self.generate("torus", 100)
        self.fails("decode", good, "-o", self.path("out.ply"), mentions=[good, "not an .lr file: it looks like a PLY file"])
        outcome = run("stats", good, self.path("missing.ply"), "--json")  # the good file is still reported
        self.assertEqual((outcome.code, len(json.loads(outcome.out)["meshes"])), (BAD_INPUT, 1), str(outcome))
        self.assertRegex(outcome.err, r"\Alacedring: [^\n]*missing.ply: [^\n]*\n\Z")

    def test_not_finite(self):
        for bad in (NAN, INFINITE, -INFINITE):
            points = POINTS[:2] + [(1, bad, 3)] + POINTS[3:]
            for name, data in {"a.obj": write.obj(points, TRIANGLES), "a.off": write.off(points, TRIANGLES),
                               "a.stl": write.stl(points, TRIANGLES), "b.stl": write.stl_text(points, TRIANGLES),
                               "a.ply": write.ply(points, TRIANGLES), "b.ply": write.ply(points, TRIANGLES, ">"),
                               "c.ply": write.ply(points, TRIANGLES, ""),
                               "d.ply": write.ply(points, TRIANGLES, real="double"),
                               "a.glb": write.gltf(points, [(4, write.flat(TRIANGLES))], binary=True)}.items():
                self.refused(name, data, "vertex")
        huge = write.obj(POINTS, TRIANGLES).replace(b"1.5", b"1e999")
        self.refused("a.obj", huge, "line 2")
        huge = write.ply([(1e39, 0, 0)] + POINTS[1:], TRIANGLES, real="double")
        self.refused("a.ply", huge, "vertex 0: the position is beyond the range of floats")
        huge = write.gltf([(1e38, 0, 0)] + POINTS[1:], [(4, write.flat(TRIANGLES))], nodes=[{"mesh": 0, "scale": [9, 9, 9]}])
        self.refused("a.gltf", huge)

    def test_indices_out_of_range(self):
        for v in (len(POINTS), 4000000, -1):
            triangles = TRIANGLES + [(0, 1, v)]
            self.refused("a.off", write.off(POINTS, triangles), "line")
            for order in ("", "<", ">"):
                self.refused("a.ply", write.ply(POINTS, triangles, order), "face 4")
            self.refused("b.ply", write.ply(POINTS, [], "<", strips=[0, 1, v - 1 if v < 0 else v, 2]), "strip 0")
            if v == len(POINTS):
                self.refused("a.glb", write.gltf(POINTS, [(4, [0, 1, v])], binary=True), "mesh 0")
        obj = write.obj(POINTS, TRIANGLES)
        for line in (b"f 1 2 6", b"f 1 2 0", b"f 1 2 -6", b"f 1 2 99999999999999999999", b"f 1/0 2 3", b"f 1//x 2 3", b"f a b c",
                     b"f 1 2 3.5", b"f 1 2 \\ 3", b"fo 1 2 6"):
            self.refused("a.obj", obj + line + b"\n", "line 10")
        # References to normals or texture coordinates are errors only if the file has any.
        for line, there in ((b"f 1/2 2 3", b"vt 0 0\n"), (b"f 1//2 2 3", b"vn 0 0 1\n"), (b"f 1/1/-3 2 3", b"vn 0 0 1\nvt 0 0\n")):
            self.refused("a.obj", obj + line + b"\n" + there, "line 10")
            self.ok("info", self.write("good.obj", obj + line + b"\n"))
        self.refused("a.obj", write.obj(POINTS, []), "no triangles")
        self.refused("a.obj", b"v 1 2\n", "line 1")

    def test_counts(self):
        many = [b"4294967295", b"4294967296", b"18446744073709551615", b"99999999999999999999999", b"-1", b"1e9", b"x"]
        for order in ("", "<", ">"):
            ply = write.ply(POINTS, TRIANGLES, order)
            for count in many + [b"6", b"400000000"]:
                self.refused("a.ply", ply.replace(b"vertex 5", b"vertex " + count), "")
            for count in many + [b"5", b"400000000"]:
                self.refused("a.ply", ply.replace(b"face 4", b"face " + count), "")
            for bad in ((b"end_header\n", b""), (b"float y", b"floot y"), (b"property float z\n", b""),
                        (b"list uchar", b"list float"), (b"list uchar int", b"list uchar double")):
                self.refused("a.ply", ply.replace(*bad, 1))
        off = write.off(POINTS, TRIANGLES)
        for count in many + [b"6", b"400000000"]:
            self.refused("a.off", off.replace(b"5 4 0", count + b" 4 0"))
            self.refused("a.off", off.replace(b"5 4 0", b"5 " + count + b" 0"))
        for count in (b"4", b"1000000", b"18446744073709551615", b"-3"):
            self.refused("a.off", off.replace(b"\n3 0 1 2\n", b"\n" + count + b" 0 1 2\n"), "line")
        stl = write.stl(POINTS, TRIANGLES)
        for count in (5, 1000, 2 ** 31, 2 ** 32 - 1):
            self.refused("a.stl", stl[:80] + struct.pack("<I", count) + stl[84:])
        text = write.stl_text(POINTS, TRIANGLES)
        for old, new in ((b"endfacet", b"facet"), (b"outer", b"inner"), (b"1.5", b"x"), (b"endsolid", b"end"),
                         (b"normal 0 0 1", b"normal"), (b"normal 0 0 1", b"normal 0 0"), (b"normal 0 0 1", b"")):
            self.refused("a.stl", text.replace(old, new, 1), "line")
        self.check_memory()

    def test_gltf(self):
        flat = write.flat(TRIANGLES)
        good = json.loads(write.gltf(POINTS, [(4, flat)], nodes=[{"mesh": 0, "children": [1]}, {"mesh": 0}], sparse=(0, (1, 2, 3))))
        self.ok("verify", self.write("good.gltf", json.dumps(good).encode()))
        changes = [("accessors/0/count", 10 ** 9), ("accessors/0/count", 6), ("accessors/0/count", -1),
                   ("accessors/0/componentType", 5125), ("accessors/0/type", "VEC2"), ("accessors/0/type", "VEC9"),
                   ("accessors/0/byteOffset", 4), ("accessors/0/bufferView", 99),
                   ("accessors/1/componentType", 5126), ("accessors/1/type", "VEC3"), ("accessors/1/count", 10 ** 12),
                   ("accessors/0/sparse/count", 99), ("accessors/0/sparse/count", -1),
                   ("accessors/0/sparse/indices/bufferView", 99), ("accessors/0/sparse/values/byteOffset", 10 ** 6),
                   ("bufferViews/0/buffer", 3), ("bufferViews/0/byteOffset", 10 ** 9), ("bufferViews/0/byteLength", 10 ** 9),
                   ("bufferViews/0/byteStride", 4), ("bufferViews/1/byteLength", 1), ("buffers/0/byteLength", 10 ** 9),
                   ("meshes/0/primitives/0/mode", 99), ("meshes/0/primitives/0/mode", 1),
                   ("meshes/0/primitives/0/indices", 99), ("meshes/0/primitives/0/attributes/POSITION", 99),
                   ("nodes/1/children", [0]), ("nodes/0/children", [5]), ("nodes/0/children", [0]), ("nodes/0/mesh", 9),
                   ("nodes/0/matrix", [1, 2, 3]), ("scene", 9), ("scenes/0/nodes", [7]), ("meshes", []), ("nodes", [3]),
                   ("buffers/0/uri", "missing.bin"), ("buffers/0/uri", "sub/missing.bin"), ("buffers/0/uri", "."),
                   ("buffers/0/uri", "data:application/octet-stream;base64,AAAA"), ("buffers/0/uri", "/etc"),
                   ("extensionsRequired", ["FOO_folded_geometry"]),
                   ("bufferViews/0/extensions", {"EXT_meshopt_compression": {"buffer": 0}})]
        for where, value in changes:
            document = json.loads(json.dumps(good))
            at = document
            *path, last = where.split("/")
            for step in path:
                at = at[int(step)] if isinstance(at, list) else at[step]
            at[int(last) if isinstance(at, list) else last] = value
            mentions = ["missing.bin"] if "missing.bin" in str(value) else []
            self.refused("a.gltf", json.dumps(document).encode(), *mentions, label=f"{where} = {value}")
        for data in (b"{", b"{}", b"{ not json", b"[]{", b'{"asset":{"version":"2.0"}}', b"{" * 100000, b'{"a":' * 100000):
            self.refused("a.gltf", data)
        glb = write.gltf(POINTS, [(4, flat)], binary=True)
        for at, value in ((4, 1), (4, 3), (8, 11), (8, len(glb) + 4), (8, 2 ** 32 - 1), (12, 0), (12, 2 ** 32 - 1),
                          (16, 0x12345678)):
            self.refused("a.glb", glb[:at] + struct.pack("<I", value) + glb[at + 4:])
        self.check_memory()


class Output(CliTest):
    def test_unwritable(self):
        mesh = self.generate("blob", 2000)
        lr = self.path("a.lr")
        self.ok("encode", mesh, "-o", lr)
        self.write("file", b"a file, not a folder")
        for name in ("folder", "folder.ply", "folder.lr"):
            os.mkdir(self.path(name))
            self.write(name + "/inside", b"")
        long = "x" * 300
        for bad in ("missing/out", "file/out", "folder", long):
            for command, extension in ((["encode", mesh], ".lr"), (["decode", lr], ".ply"), (["decode", lr], ".glb"),
                                       (["generate", "sphere"], ".obj")):
                out = self.path(bad if bad == "folder" and extension == ".lr" else bad + extension)
                if bad == "folder" and extension not in (".ply", ".lr"):
                    continue
                with self.subTest(bad=bad[:20], command=command[0], extension=extension):
                    self.fails(*command, "-o", out, mentions=[out], codes=(WRONG_USAGE, BAD_INPUT))
        for name in ("out.xyz", "out", "out.stl"):
            self.fails("decode", lr, "-o", self.path(name), codes=(WRONG_USAGE, BAD_INPUT))

    def test_notes_come_after_success(self):
        """Dropped degenerate triangles are reported, but not beside an error, which is one line."""
        soup = self.generate("soup", 1000)
        self.fails("encode", soup, "-o", self.path("missing/out.lr"), mentions=["missing/out.lr"])

    def test_failed_write_leaves_the_old_file(self):
        mesh = self.generate("blob", 20000)
        lr = self.path("a.lr")
        self.ok("encode", mesh, "-o", lr)
        old = self.write("old.ply", b"precious")

        def small_files():  # writes fail half-way, as on a full disk
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (65536, 65536))

        for command in (["decode", lr, "-o", old], ["decode", lr, "-o", self.path("new.obj")],
                        ["decode", lr, "-o", self.path("new.glb")], ["encode", mesh, "-o", self.path("new.lr")],
                        ["generate", "sphere", "-o", old, "--triangles", "20000"]):
            with self.subTest(command):
                self.fails(*command, mentions=[command[command.index("-o") + 1]], codes=(BAD_INPUT,), preexec_fn=small_files)

    def test_read_only_folder(self):
        if os.geteuid() == 0:
            self.skipTest("root may write everywhere")
        mesh = self.generate("blob", 200)
        os.mkdir(self.path("closed"))
        os.chmod(self.path("closed"), 0o555)
        self.fails("encode", mesh, "-o", self.path("closed/out.lr"), mentions=["closed"])

    def test_unreadable_input(self):
        if os.geteuid() == 0:
            self.skipTest("root may read everything")
        mesh = self.generate("blob", 200)
        os.chmod(mesh, 0)
        outcome = run("info", mesh)
        self.check_error(outcome, mesh)


if __name__ == "__main__":
    main()
