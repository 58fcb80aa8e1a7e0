#!/usr/bin/env python3
"""test_cli.py LACEDRING: the commands with valid input, as docs/command-line.md describes them."""

import json
import os
import struct
import unittest

from cli_support import DONE, KINDS, NO_DEVICE, WRONG_USAGE, CliTest, in_parallel, main, run

import mesh_writers as write

FORMATS = ["index_u32", "index_u16", "strip_restart", "strip_degenerate", "winged_edge", "corner_table", "squad", "lr",
           "lr_compact", "lean", "lean_no_warts", "packed", "packed_cache", "meshopt_index_codec", "meshlets"]
NUMBER = (int, float)
POINTS = [(0.0, 0.0, 0.0), (1.5, 0.0, 0.0), (1.0, 1.0, 0.25), (0.0, 1.0, 0.0), (0.1, 0.2, -3e-7), (5.0, 5.0, 5.0)]
FACES = [(0, 1, 2, 3), (0, 4, 1), (1, 4, 2), (2, 2, 3)]
TRIANGLES = [(0, 1, 2), (0, 2, 3), (0, 4, 1), (1, 4, 2)]


class Usage(CliTest):
    def test_help(self):
        for command in ("info", "stats", "encode", "decode", "verify", "bench", "generate"):
            self.assertTrue(self.has_command(command), command)
            outcome = self.ok(command, "--help")
            self.assertEqual(outcome.err, "")
            self.assertIn("--", outcome.out)
        self.assertRegex(self.ok("--version").out, r"\A\d+\.\d+\.\d+\n\Z")

    def test_wrong_usage(self):
        mesh = self.generate("sphere", 100)
        out = self.path("out.lr")
        cases = [[], ["frobnicate"], ["--frobnicate"], ["info"], ["info", mesh, "--frobnicate"], ["info", mesh, mesh],
                 ["stats"], ["stats", mesh, "--ring", "square"], ["encode", mesh], ["encode", "-o", out],
                 ["encode", mesh, "-o", out, "--format", "zip"], ["encode", mesh, "-o", out, "--seeds", "many"],
                 ["encode", mesh, "-o", out, "--weld=color"], ["decode", mesh], ["verify"], ["bench"], ["generate"],
                 ["generate", "sphere"], ["generate", "teapot", "-o", self.path("a.ply")],
                 ["generate", "sphere", "-o", self.path("a.ply"), "--triangles", "some"],
                 ["generate", "sphere", "-o", self.path("a.ply"), "--triangles", "-5"],
                 ["generate", "sphere", "-o", self.path("a.ply"), "--triangles", "1000000000000000000"],
                 ["generate", "sphere", "-o", self.path("a.xyz")], ["generate", "sphere", "-o", self.path("noextension")]]
        for arguments in cases:
            with self.subTest(arguments):
                self.fails(*arguments, codes=(WRONG_USAGE,))


class Generate(CliTest):
    def test_deterministic(self):
        for kind in KINDS:
            with self.subTest(kind):
                files = []
                for i, (extension, seed) in enumerate([(".ply", 3), (".ply", 3), (".ply", 4)]):
                    path = self.path(f"{i}{extension}")
                    self.ok("generate", kind, "-o", path, "--triangles", "1500", "--seed", str(seed))
                    with open(path, "rb") as file:
                        files.append(file.read())
                self.assertEqual(files[0], files[1])
                self.assertEqual(files[0] == files[2], kind in ("sphere", "torus", "moebius"))

    def test_sizes_and_formats(self):
        def check(kind):
            for triangles in (1, 500, 8000):
                ply = self.generate(kind, triangles, 2)
                report = self.json("info", ply, "--json")
                self.assertLessEqual(report["triangles"], max(triangles + max(64, triangles // 50), 400))
                if triangles > 1:
                    self.assertGreaterEqual(report["triangles"], 0.97 * triangles)
                others = [self.generate(kind, triangles, 2, extension) for extension in (".obj", ".glb")]
                self.same_triangles(ply, *others, options=["--allow-degenerate"])

        in_parallel(check, KINDS)

    def test_overwrites(self):
        path = self.write("a.ply", b"something else")
        self.ok("generate", "torus", "-o", path, "--triangles", "100")
        self.assertEqual(self.json("info", path, "--json")["triangles"], 100)
        self.assertEqual(os.listdir(self.folder), ["a.ply"])


class RoundTrip(CliTest):
    def round_trip(self, source, *options):
        base = os.path.splitext(source)[0]
        lr = base + ".lr"
        self.ok("encode", source, "-o", lr, *options)
        weld = [o for o in options if o.startswith("--weld")]
        outputs = [base + "-out" + extension for extension in (".ply", ".obj", ".glb")]
        for output in outputs:
            self.ok("decode", lr, "-o", output)
        if not weld:
            self.same_triangles(source, *outputs, self.resident(source, *options))
        self.ok("verify", lr)
        return lr

    def test_generated(self):
        def check(item):
            kind, triangles, seed = item
            source = self.generate(kind, triangles, seed)
            if triangles <= 400:
                self.round_trip(source, "--format", "lean")
            lr = self.round_trip(source)
            verdict = self.json("verify", source, "--json")
            self.assertEqual(verdict["file"], source)
            for name in ("index_u32", "strip_restart", "lean", "lean_no_warts"):
                self.assertIn(name, verdict["formats"])
            for name, entry in verdict["formats"].items():
                self.assertIn(name, FORMATS)
                self.assertIs(entry["ok"], True, f"{name}: {entry}")
            self.assertIn("why", entry)
            again = self.path(f"{kind}-{triangles}-{seed}-again.lr")
            self.ok("encode", source, "-o", again, "--format", "packed", "--seeds", "0", "--optimize", "auto")
            with open(lr, "rb") as a, open(again, "rb") as b:
                self.assertEqual(a.read(), b.read(), f"{kind}: encoding twice gives two files")

        in_parallel(check, [(k, n, s) for k in KINDS for n, s in ((1, 1), (50, 2), (400, 3), (3000, 4))])

    def test_lr_tables_and_packed(self):
        def check(item):
            kind, form, *options = item
            source = self.generate(kind, 3000, 2)
            name = "-".join(item)
            lr, out, ordered = (self.path(name + end) for end in (".lr", ".ply", "-ordered.ply"))
            self.ok("encode", source, "-o", lr, "--format", form, "--keep-order", *options)
            self.ok("decode", lr, "-o", out)
            self.ok("decode", lr, "-o", ordered, "--original-order")
            self.same_triangles(source, out, ordered)
            self.ok("verify", lr)
            self.assertEqual(self.json("info", lr, "--json")["vertices"], self.json("info", source, "--json")["vertices"])

        forms = [("lr",), ("lr", "--ring", "hybrid", "--k", "40"), ("lr-compact", "--k", "40"), ("lr-compact",), ("packed",),
                 ("packed", "--ring", "expander"), ("packed", "--profile", "cache"), ("packed", "--profile", "cache", "--optimize", "2")]
        # Each form with three kinds of mesh and each kind with three forms. The unit tests combine all.
        in_parallel(check, [(k, *f) for i, k in enumerate(KINDS) for j, f in enumerate(forms) if (i + j) % len(KINDS) < 3])

    def test_threads(self):
        """Files are the same for any number of threads; commands without threads refuse the option."""
        source, files = self.generate("blob", 3000, 1), []
        for threads in ("1", "3"):
            out = self.path(f"{threads}.lr")
            self.ok("encode", source, "-o", out, "--threads", threads)
            self.ok("decode", out, "-o", self.path("out.ply"), "--threads", threads, "--force")
            with open(out, "rb") as file:
                files.append(file.read())
        self.assertEqual(files[0], files[1])
        self.fails("encode", source, "-o", self.path("no.lr"), "--threads", "0", codes=(WRONG_USAGE,))
        self.fails("generate", "blob", "-o", self.path("no.ply"), "--threads", "2", codes=(WRONG_USAGE,))

    def test_orient(self):
        quads = [(i, i + 1, i + 11, i + 10) for i in range(0, 80) if i % 10 != 9]
        faces = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
        turned = [f if i % 7 != 3 else (f[0], f[2], f[1]) for i, f in enumerate(faces)]
        points = [(float(i % 10), float(i // 10), 0.0) for i in range(90)]
        source, lr, out = self.write("turned.ply", write.ply(points, turned)), self.path("turned.lr"), self.path("turned-out.ply")
        for form in ("lean", "packed", "lr"):
            with self.subTest(form):
                said = self.ok("encode", source, "-o", lr, "--format", form, "--force").err
                self.assertNotIn("reversed", said)
                self.ok("decode", lr, "-o", out, "--force")
                self.same_triangles(source, out)
                as_it_is = os.path.getsize(lr)
                said = self.ok("encode", source, "-o", lr, "--format", form, "--orient", "--keep-order", "--force").err
                self.assertIn(f"{len(range(3, len(faces), 7))} triangles reversed by --orient", said)
                self.ok("decode", lr, "-o", out, "--original-order", "--force")
                self.assertEqual(self.json("info", out, "--json")["flipped"], 0)
                self.same_triangles(self.write("straight.ply", write.ply(points, faces)), out)
                self.ok("encode", source, "-o", lr, "--format", form, "--orient", "--force")
                self.assertLessEqual(os.path.getsize(lr), as_it_is)

    def test_only_degenerate_triangles(self):
        source = self.write("flat.ply", write.ply(POINTS, [(0, 0, 1), (2, 2, 2)]))
        self.ok("verify", source)
        self.assertEqual(self.json("stats", source, "--json")["meshes"][0]["degenerate_dropped"], 2)

    def test_more_than_65536_vertices(self):
        self.round_trip(self.generate("blob", 140000, 1))  # more than 65,536 vertices

    def test_input_formats(self):
        shifted, blob = write.gltf([(9, 9, 9)] + POINTS[1:], [(4, write.flat(TRIANGLES))], uri="a%20b.bin",
                                   sparse=(0, POINTS[0]))
        self.write("a b.bin", blob)
        turned = [{"translation": [0.1, 2, 3], "children": [1, 2], "rotation": [0.5, -0.5, 0.1, 0.7], "scale": [2, 1.1, 3]},
                  {"mesh": 0, "scale": [-2, 0.3, 1]},
                  {"mesh": 0, "matrix": [0.3, 0.1, 0, 0, 0, 2, 0.7, 0, 1, 0, 1.3, 0, 7, 8, 9, 1]}]
        with_slashes = write.obj(POINTS, []) + b"vt 0 0\nvt 1 0\nvn 0 0 1\n"
        with_slashes += b"f 1/1/1 2/2/1 3/1/1 -3/2/-1 \\\n# five\nf 1//1 5//1 2//1\nf 2/1 5/2 3/2\nf 3 3 4\n"
        files = {"a.obj": write.obj(POINTS, FACES), "b.obj": with_slashes, "a.off": write.off(POINTS, FACES),
                 "b.off": write.off(POINTS, FACES).replace(b"OFF", b"OFF # comment\n", 1),
                 "b.stl": write.stl(POINTS, TRIANGLES), "c.stl": write.stl_text(POINTS, TRIANGLES),
                 "a.ply": write.ply(POINTS, FACES), "b.ply": write.ply(POINTS, FACES, ">"),
                 "c.ply": write.ply(POINTS, FACES, ""), "f.ply": write.ply(POINTS, FACES, real="double"),
                 "d.ply": write.ply(POINTS, [], "<", strips=[1, 2, 0, 3, -1, 0, 4, 1, -1, 1, 4, 2]),
                 "e.ply": write.ply(POINTS, [], ">", strips=[1, 2, 0, 3, -1, 0, 4, 1, -1, 1, 4, 2]),
                 "a.glb": write.gltf(POINTS, [(4, write.flat(TRIANGLES[2:])), (6, [0, 1, 2, 3])], binary=True),
                 "b.gltf": shifted, "c.gltf": write.gltf(POINTS, [(5, [1, 2, 0, 3]), (4, write.flat(TRIANGLES[2:]))]),
                 "d.gltf": write.gltf(POINTS, [(4, write.flat(TRIANGLES))], nodes=turned)}
        for name, data in files.items():
            with self.subTest(name):
                source = self.write(name, data)
                self.ok("verify", source)
                lr = self.path("out.lr")
                self.ok("encode", source, "-o", lr)
                self.ok("decode", lr, "-o", self.path("out.ply"))
                self.same_triangles(source, self.path("out.ply"), self.resident(source))

    def test_wrong_extension(self):
        for name, data in {"a.obj": write.ply(POINTS, FACES), "b.ply": write.gltf(POINTS, [(4, write.flat(TRIANGLES))]),
                           "c.off": write.stl(POINTS, TRIANGLES)}.items():
            self.assertGreaterEqual(self.json("info", self.write(name, data), "--json")["triangles"], 4)

    def test_weld(self):
        # Three vertices per triangle, as exporters without shared vertices write.
        points = [POINTS[v] for t in TRIANGLES for v in t]
        source = self.write("a.ply", write.ply(points, [(i, i + 1, i + 2) for i in range(0, len(points), 3)]))
        self.assertEqual(self.json("info", source, "--no-weld", "--json")["components"], 4)
        self.round_trip(source, "--no-weld")
        for options in ((), ("--weld",), ("--weld=position",)):
            self.assertEqual(self.json("info", source, *options, "--json")["components"], 1)
            lr = self.round_trip(source, *options)
            self.assertEqual(self.json("info", lr, "--json")["vertices"], 5)
            self.same_triangles(source, self.resident(source, *options))


class Json(CliTest):
    def check_counts(self, mesh):
        for key in ("triangles", "vertices", "components", "border_edges", "border_loops", "nonmanifold_edges",
                    "degenerate_dropped"):
            self.assertIsInstance(mesh[key], int, key)
            self.assertGreaterEqual(mesh[key], 0, key)
        self.assertIsInstance(mesh["file"], str)
        self.assertIsInstance(mesh["valence6_percent"], NUMBER)
        for key in ("ring_vertices", "isolated", "t0", "t0_wart", "t2", "irregular"):
            self.assertIsInstance(mesh["ring"][key], int, key)

    def check_format_names(self, mesh):
        absent = mesh.get("absent", {})
        for name in ("index_u32", "strip_restart", "strip_degenerate", "lean", "lean_no_warts"):
            self.assertIn(name, mesh["formats"])
        for name in list(mesh["formats"]) + list(absent):
            self.assertIn(name, FORMATS)
        for name, reason in absent.items():
            self.assertNotIn(name, mesh["formats"])
            self.assertTrue(reason, f"absent without a reason: {name}")

    def check_format(self, name, entry, encoded):
        for key in ("bytes", "bits_per_triangle", "references_per_triangle", "acmr_fifo32", "atvr_fifo32"):
            self.assertIsInstance(entry[key], NUMBER, f"{name} {key}")
            self.assertGreaterEqual(entry[key], 0, f"{name} {key}")
        self.assertIsInstance(entry["bytes"], int, name)
        self.assertAlmostEqual(entry["bits_per_triangle"], 8 * entry["bytes"] / encoded, places=6, msg=name)
        if "ring" in entry:
            self.assertIn(entry["ring"], ("expander", "hybrid", "optimized"), name)
            self.assertIn("k", entry, name)
            self.assertIn("passes", entry, name)

    def check_stats(self, mesh):
        """The keys and types of one mesh's entry, and the sizes that follow from others."""
        encoded = mesh["triangles"] - mesh["degenerate_dropped"]
        self.check_counts(mesh)
        self.check_format_names(mesh)
        for name, entry in mesh["formats"].items():
            self.check_format(name, entry, encoded)
        lean = mesh["formats"]["lean"]
        words = lean["references_per_triangle"] * encoded
        self.assertAlmostEqual(lean["bytes"], 32 + 4 * words, delta=0.01, msg="lean is a header and its references")
        self.assertLessEqual(words, 3.05 * mesh["triangles"] + 1, "lean has at most three references per triangle")

    def check_closed(self, mesh):
        """A mesh of one closed manifold component."""
        self.assertEqual((mesh["components"], mesh["border_edges"], mesh["border_loops"]), (1, 0, 0))
        self.assertEqual((mesh["nonmanifold_edges"], mesh["degenerate_dropped"]), (0, 0))
        self.assertEqual(mesh["formats"]["index_u32"]["bytes"], 12 * mesh["triangles"])
        self.assertEqual(mesh["formats"]["index_u16"]["bytes"], 6 * mesh["triangles"])
        self.assertAlmostEqual(mesh["formats"]["index_u32"]["references_per_triangle"], 3)
        self.assertEqual(mesh["ring"]["ring_vertices"] + mesh["ring"]["isolated"], mesh["vertices"])
        self.assertLess(mesh["formats"]["lean"]["references_per_triangle"], 1.35)

    def test_stats(self):
        paths = [self.generate(kind, 1000, 5) for kind in KINDS]
        document = self.json("stats", *paths, "--json")
        self.assertEqual([mesh["file"] for mesh in document["meshes"]], paths, "an entry per file, in order")
        for mesh in document["meshes"]:
            with self.subTest(mesh["file"]):
                self.check_stats(mesh)
        meshes = dict(zip(KINDS, document["meshes"]))
        for kind in ("sphere", "torus", "genus", "blob"):
            with self.subTest(closed=kind):
                self.check_closed(meshes[kind])
        with self.subTest("counts of kinds with known topology"):
            self.assertEqual(meshes["torus"]["valence6_percent"], 100)
            self.assertGreaterEqual(meshes["terrain"]["border_loops"], 3)
            self.assertGreater(meshes["parts"]["components"], 50)
            self.assertGreater(meshes["soup"]["nonmanifold_edges"], 5)
            self.assertGreater(meshes["soup"]["degenerate_dropped"], 2)

    def test_stats_options(self):
        path = self.generate("blob", 3000)
        for options in (["--paper"], ["--ring", "expander"], ["--ring", "hybrid"], ["--ring", "hybrid", "--k", "50"],
                        ["--k", "auto"], ["--paper", "--ring", "expander"], ["--seeds", "3"], ["--weld"], ["--weld=position"]):
            with self.subTest(options):
                self.check_stats(self.json("stats", path, *options, "--json")["meshes"][0])

    def test_index_u16_is_absent_beyond_65536_vertices(self):
        mesh = self.json("stats", self.generate("sphere", 140000), "--json")["meshes"][0]
        self.assertNotIn("index_u16", mesh["formats"])
        self.assertIn("index_u16", mesh["absent"])

    def test_text_output_has_lines(self):
        path = self.generate("terrain", 500)
        for command in ("info", "stats", "verify"):
            self.assertIn("\n", self.ok(command, path).out)

    def test_hybrid_ring(self):
        formats = self.json("stats", self.generate("blob", 3000), "--ring", "hybrid", "--k", "50", "--json")["meshes"][0]["formats"]
        for name in ("lean", "lr", "lr_compact"):
            self.assertEqual((formats[name]["ring"], formats[name]["k"]), ("hybrid", 50), name)

    def test_bench_operators(self):
        mesh = self.json("bench", self.generate("genus", 2000), "--operators", "--rounds", "1", "--json")["meshes"][0]
        self.assertEqual(set(mesh["operators"]), {"corner_table", "winged_edge", "squad", "lr", "lr_compact"})
        for structure in mesh["operators"].values():
            self.assertEqual(set(structure), {"vertex", "opposite", "valence", "normal", "contour"})
            for entry in structure.values():
                self.assertGreater(entry["ns_per_op"], 0)

    def check_bench_times(self, mesh):
        self.assertTrue(mesh["peak_bytes"])
        for key in ("construct", "decode_cpu", "unpack", "restore"):
            self.assertTrue(mesh[key], key)
            for name, entry in mesh[key].items():
                self.assertGreater(entry["seconds"], 0, name)
                self.assertGreater(entry["mtri_per_s"], 0, name)
        for name in ("vertices", "meshopt_vertex_codec"):
            self.assertGreater(mesh["decode_cpu"][name]["mvert_per_s"], 0, name)
        self.assertGreater(mesh["decode_cpu_ratio"]["meshopt_vertex_codec_over_vertices"], 0)

    def check_bench_names(self, mesh, rivals):
        self.assertEqual(set(mesh["construct"]), {"corner_table", "ring", "lean_encode", "lean", "strips", "ring_hybrid",
                                                  "lr", "lr_compact", "squad", "optimize", "packed_encode",
                                                  "packed_cache_encode", "packed"})
        self.assertEqual(set(mesh["decode_cpu"]), {"lean", "copy", "packed", "packed_2_threads", "packed_cache",
                                                   "meshopt_index_codec", "vertices", "meshopt_vertex_codec"})
        self.assertEqual(set(mesh["unpack"]), {"lacedring"} | rivals)
        self.assertEqual(set(mesh["restore"]), {"lacedring", "lacedring_decoded", "lacedring_arrays"} | (rivals & {"draco"}))

    def check_bench_sizes(self, mesh, rivals):
        self.assertEqual(mesh["position_bits"], 14)
        for name, entry in [*mesh["unpack"].items(), *mesh["restore"].items()]:
            self.assertGreater(entry["bytes"], 0, name)
        for name, entry in mesh["restore"].items():
            self.assertAlmostEqual(entry["ns_per_triangle"], 1e9 * entry["seconds"] / 2000, msg=name)
        for key in ("unpack_ratio", "restore_ratio"):
            self.assertEqual("draco" in rivals, mesh[key]["draco_over_lacedring"] is not None, key)

    def test_bench(self):
        path = self.generate("blob", 2000)
        document = self.json("bench", path, "--json")
        self.assertEqual(len(document["meshes"]), 1)
        mesh = document["meshes"][0]
        self.assertEqual((mesh["file"], mesh["triangles"]), (path, 2000))
        for key in ("construct", "decode_cpu", "unpack", "restore", "decode_gpu", "draw", "operators", "peak_bytes"):
            self.assertIsInstance(mesh[key], dict, key)
        rivals = {"draco", "draco_smallest"} - set(mesh["absent"])  # a build may lack Draco
        with self.subTest("every step has a time and a rate"):
            self.check_bench_times(mesh)
        with self.subTest("the steps and rivals are the documented ones"):
            self.check_bench_names(mesh, rivals)
        with self.subTest("unpacked and restored files have sizes and ratios"):
            self.check_bench_sizes(mesh, rivals)
        if mesh["decode_gpu"]:
            with self.subTest("the device's decoding has a rate and a ratio"):
                self.assertGreater(mesh["decode_gpu"]["vertices"]["mvert_per_s"], 0)
                self.assertGreater(mesh["decode_gpu_ratio"]["packed_vertices_over_packed"], 0)


class Pictures(CliTest):
    """Skipped if the program was built without a renderer. Without a Vulkan device the exit code is 4."""

    def setUp(self):
        super().setUp()
        if not self.has_command("render"):
            self.skipTest("built without a renderer")

    def device_or_skip(self, outcome):
        if outcome.code == NO_DEVICE:
            self.check_error(outcome, codes=(NO_DEVICE,))
            self.skipTest("no usable Vulkan device")

    def test_render(self):
        mesh = self.generate("blob", 2000)
        picture = self.path("out.png")
        outcome = run("render", mesh, "-o", picture, "--size", "96x64")
        self.device_or_skip(outcome)
        self.assertEqual(outcome.code, DONE, str(outcome))
        with open(picture, "rb") as file:
            data = file.read()
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", data[16:24]), (96, 64))
        for bad in (["--size", "0x0"], ["--size", "large"], ["--view", "xray"], ["--source", "thin-air"]):
            with self.subTest(bad):
                self.fails("render", mesh, "-o", self.path("bad.png"), *bad, codes=(WRONG_USAGE,))
        self.fails("render", self.path("missing.ply"), "-o", self.path("bad.png"), mentions=["missing.ply"])
        self.fails("render", mesh, "-o", self.path("no/folder/bad.png"), codes=(2, 3))
        self.fails("render", mesh, "-o", self.path("bad.png"), "--device", "no such device", codes=(NO_DEVICE,))

    def test_compare(self):
        mesh = self.generate("soup", 600)
        outcome = run("compare", mesh, "--size", "320x240", "--json")
        self.device_or_skip(outcome)
        self.assertEqual(outcome.code, DONE, str(outcome))
        document = json.loads(outcome.out)
        with self.subTest("the document names file, device, size and views"):
            self.assertEqual((document["schema"], document["file"], document["size"]), (1, mesh, [320, 240]))
            for key in ("name", "driver", "api"):
                self.assertTrue(document["device"][key], key)
            self.assertGreaterEqual(document["views"], 6)
            self.assertIsInstance(document["skipped"], list)
            self.assertEqual({r["source"] for r in document["results"]}, {"lean", "packed", "packed_vertices"})
        for result in document["results"]:
            with self.subTest(source=result["source"], path=result["path"]):
                self.check_equal_pictures(result)

    def check_equal_pictures(self, result):
        self.assertTrue(result["source"] and result["path"])
        for key in ("pixels_different", "max_channel_difference", "triangle_ids_different"):
            self.assertEqual(result[key], 0, key)
        self.assertIs(result["indices_equal_cpu"], True)
        self.assertIs(result.get("vertices_equal_cpu"), True if result["source"] == "packed_vertices" else None)
        self.assertGreater(result["covered_pixels"], 0)
        for key in ("raw_pixels_different", "raw_max_channel_difference"):
            self.assertIsInstance(result[key], NUMBER, key)


if __name__ == "__main__":
    main()
