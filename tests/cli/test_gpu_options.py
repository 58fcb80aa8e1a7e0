#!/usr/bin/env python3
"""test_gpu_options.py LACEDRING: options without effect, devices without a feature, blank comparisons, and progress. Needs a
renderer and a Vulkan device."""

import os
import pty
import select
import subprocess
import time

import cli_support
from cli_support import DONE, NO_DEVICE, WRONG_USAGE, CliTest, main


def on_a_terminal(*arguments, timeout=300):
    """Runs the program with standard error on a terminal. Returns exit code, standard output and the terminal's text."""
    ours, theirs = pty.openpty()
    process = subprocess.Popen([cli_support.program, *arguments], stdout=subprocess.PIPE, stderr=theirs, stdin=subprocess.DEVNULL)
    os.close(theirs)
    said, end = b"", time.monotonic() + timeout
    while time.monotonic() < end:
        if not select.select([ours], [], [], 1)[0]:
            continue
        try:
            got = os.read(ours, 65536)
        except OSError:  # the other end is closed
            break
        if not got:
            break
        said += got
    out = process.communicate(timeout=timeout)[0]
    os.close(ours)
    return process.returncode, out.decode(), said.decode()


def obj(points, triangles):
    lines = [f"v {x} {y} {z}" for x, y, z in points] + [f"f {a} {b} {c}" for a, b, c in triangles]
    return ("\n".join(lines) + "\n").encode()


class GpuOptions(CliTest):
    def setUp(self):
        super().setUp()
        if not self.has_command("render"):
            self.skipTest("built without a renderer")

    def usage(self, *arguments, says):
        self.fails(*arguments, mentions=[says], codes=(WRONG_USAGE,))

    def same_picture(self, *arguments):
        """Whether render draws the same picture with all options as with those before "--"."""
        pictures = []
        plain = arguments[:arguments.index("--")]
        for options in (plain, [a for a in arguments if a != "--"]):
            self.ok("render", *options, "-o", self.path("a.png"), "--size", "200x150", "--samples", "1")
            with open(self.path("a.png"), "rb") as file:
                pictures.append(file.read())
        return pictures[0] == pictures[1]

    def test_render(self):
        mesh, out = self.generate("blob", 600), self.path("x.png")
        render = ("render", mesh, "-o", out)
        for path in ("pull", "geometry", "mesh"):
            self.usage(*render, "--source", "plain", "--path", path, says="--source plain goes with --path compute only")
        self.usage(*render, "--crease", "30", says="--crease applies only with --view silhouette")
        for option in (("--ring", "hybrid"), ("--k", "5"), ("--seeds", "3"), ("--random-seed", "4"), ("--optimize", "3")):
            for view in ("smooth", "flat", "wire", "silhouette"):
                self.usage(*render, "--source", "plain", "--view", view, *option, says=option[0] + " applies only with --source lean")
        for choice in (("--source", "plain"), ("--source", "packed"), ("--source", "plain", "--view", "wire")):
            self.usage(*render, *choice, "--no-warts", says="--no-warts applies only with --source lean")
        for source in ("plain", "lean", "packed"):
            self.usage(*render, "--source", source, "--positions", "12", says="--positions applies only with --source packed_vertices")
        self.usage("compare", mesh, "--source", "lean,packed", "--positions", "12",
                   says="--positions applies only with --source packed_vertices")
        for bits in ("0", "23"):
            self.usage(*render, "--source", "packed_vertices", "--positions", bits, says="--positions")
        self.usage("bench", mesh, "--positions", "17", says="--positions")
        self.usage(*render, "--k", "5", says="--k applies only with --ring hybrid")
        self.usage(*render, "--ring", "expander", "--k", "5", says="--k applies only with --ring hybrid")
        self.usage(*render, "--random-seed", "5", "--seeds", "1", says="--random-seed applies only with several --seeds")
        self.usage(*render, "--random-seed", "5", "--seeds", "1", "--optimize", "0", says="--random-seed applies only")
        self.assertFalse(os.path.exists(out))

    def test_every_option_of_render_has_an_effect(self):
        mesh = self.generate("blob", 3000)
        for arguments in (("--view", "silhouette", "--", "--crease", "5"), ("--source", "plain", "--view", "class", "--", "--no-warts"),
                          ("--source", "plain", "--view", "offsets", "--", "--no-warts"),
                          ("--source", "plain", "--view", "ring", "--", "--no-warts"),
                          ("--source", "packed", "--view", "ring", "--", "--ring", "hybrid"),
                          ("--source", "packed_vertices", "--", "--positions", "6"),
                          ("--source", "plain", "--view", "class", "--", "--optimize", "4"),
                          ("--view", "ring", "--ring", "hybrid", "--", "--k", "3"),
                          ("--view", "class", "--seeds", "1", "--optimize", "2", "--", "--random-seed", "9"),
                          ("--view", "class", "--seeds", "40", "--", "--random-seed", "9")):
            self.assertFalse(self.same_picture(mesh, *arguments), arguments)

    def test_no_gpu(self):
        mesh, out = self.generate("torus", 200), self.path("x.html")
        for options in (("--size", "100x100"), ("--up", "+Z"), ("--camera-position=1,2,3",), ("--camera-focal-point=1,2,3",),
                        ("--camera-azimuth-angle", "3"), ("--camera-elevation-angle", "3"), ("--camera-zoom-factor", "2"),
                        ("--camera-view-angle", "40"), ("--device", "x"), ("--device-memory", "100"), ("--validation",)):
            name = options[0].partition("=")[0]
            self.usage("report", mesh, "-o", out, "--no-gpu", *options, says=f"{name} has no effect with --no-gpu")
            if name.startswith("--device") or name == "--validation":
                self.usage("bench", mesh, "--no-gpu", *options, says=f"{name} has no effect with --no-gpu")
        for options in (("--page", "8"), ("--levels", "1"), ("--scratch", self.folder), ("--sample", "10")):
            self.usage("bench", mesh, "--no-gpu", *options, says=f"{options[0]} requires --resident")

    def test_the_viewer(self):
        mesh, picture = self.generate("torus", 200), self.path("x.png")
        self.usage("view", "--screenshot", picture, says="--screenshot requires MESH")
        self.usage("view", mesh, "--screenshot", picture, "--fps", "30", says="--fps has no effect with --screenshot")
        self.usage("view", mesh, "--screenshot", picture, "--no-panels", "--scale", "2",
                   says="--scale has no effect with --screenshot and --no-panels")

    def test_devices_by_name(self):
        mesh = self.generate("torus", 200)
        render = ("render", mesh, "-o", self.path("x.png"), "--size", "32x32", "--json")
        device = self.json(*render)["device"]
        os.remove(self.path("x.png"))
        self.assertEqual(self.json(*render, "--device", device["name"][:5].upper())["device"], device)
        if device["driver"].startswith("llvmpipe"):
            for name in ("lavapipe", "LAVAPIPE", "llvmpipe"):
                self.assertEqual(self.json(*render, "--device", name)["device"], device)
        os.remove(self.path("x.png"))
        for command in (render, ("compare", mesh), ("bench", mesh, "--rounds", "1"), ("report", mesh, "-o", self.path("x.html"))):
            self.fails(*command, "--device", "no such device", codes=(NO_DEVICE,),
                       mentions=[device["name"], 'not named "no such device"'])

    def test_missing_device_features_are_reported(self):
        mesh, out = self.generate("blob", 60000), self.path("x.png")
        skipped = {s["path"] for s in self.json("compare", self.generate("torus", 200), "--size", "32x32", "--source", "lean", "--json")["skipped"]}
        if "mesh" in skipped:
            for source in ("lean", "packed"):
                self.fails("render", mesh, "-o", out, "--source", source, "--path", "mesh", codes=(NO_DEVICE,), mentions=["mesh shaders"])
        for memory in ("1", "40"):
            self.fails("render", mesh, "-o", out, "--device-memory", memory, codes=(NO_DEVICE,), mentions=["left"])
            self.fails("compare", mesh, "--device-memory", memory, codes=(NO_DEVICE,), mentions=["left"])
        self.fails("bench", self.generate("torus", 200), "--rounds", "1", "--device-memory", "1", codes=(NO_DEVICE,), mentions=["left"])
        self.fails("render", mesh, "-o", out, "--samples", "8", "--size", "8192x8192", codes=(NO_DEVICE,), mentions=["the device draws at most"])
        # The default number of samples is the largest possible.
        report = self.json("render", mesh, "-o", out, "--size", "8000x8", "--json")
        self.assertIn(report["samples"], (4, 9))
        # A report counts the pictures that cannot be drawn.
        said = self.ok("report", self.generate("torus", 200), "-o", self.path("x.html"), "--device-memory", "1").err
        self.assertIn("no pictures: ", said)

    def test_packed_vertices(self):
        """The picture of a quantized source equals that of the encoded file, by every path."""
        mesh = self.generate("parts", 900)
        same = ("--size", "80x60", "--samples", "1", "--json")
        self.ok("encode", mesh, "-o", self.path("x.lr"), "--positions", "9", "--keep-order")
        self.ok("decode", self.path("x.lr"), "-o", self.path("y.ply"), "--original-order")
        renders = [(self.path("y.ply"), "--source", "plain"), (mesh, "--source", "packed_vertices", "--positions", "9"),
                   (mesh, "--source", "packed_vertices", "--positions", "9", "--path", "pull")]
        pictures = []
        for number, (file, *options) in enumerate(renders):
            self.json("render", file, "-o", self.path(f"{number}.png"), *options, *same)
            with open(self.path(f"{number}.png"), "rb") as picture:
                pictures.append(picture.read())
        self.assertEqual(pictures[1], pictures[2])
        self.assertEqual(pictures[0], pictures[1])
        document = self.json("compare", mesh, "--source", "packed_vertices", "--path", "compute", "--positions", "9", "--size", "80x60",
                             "--json")
        self.assertEqual([(r["source"], r["pixels_different"], r["vertices_equal_cpu"]) for r in document["results"]],
                         [("packed_vertices", 0, True)])

    def test_blank_comparisons_are_reported(self):
        triangle = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
        far = [(i * 1e-6, j * 1e-6, 0) for i in range(50) for j in range(50)] + [(1, 0, 0), (1, 1e-7, 0), (0, 1e-7, 0)]
        specks = [(50 * i + j + 1, 50 * i + j + 2, 50 * i + j + 51) for i in range(49) for j in range(49)]
        inside = [(0.3, 0.3, 0.3)] + [(0.3 + 1e-3 * ((i * 7) % 11), 0.3 + 1e-3 * (i % 5), 0.3) for i in range(60)]
        cube = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        shell = [(1, 2, 4), (1, 4, 3), (5, 7, 8), (5, 8, 6), (1, 5, 6), (1, 6, 2), (3, 4, 8), (3, 8, 7), (1, 3, 7), (1, 7, 5),
                 (2, 6, 8), (2, 8, 4)]
        hidden = [(9 + i, 9 + j, 9 + k) for i in range(30) for j in range(i + 1, 40) for k in range(j + 1, 46)][:14000]
        meshes = {"coinciding": obj(triangle, [(1, 2, 3)] * 2000),
                  "line": obj([(i, 0, 0) for i in range(4)], [(1, 2, 3), (2, 4, 3)]),
                  "needle": obj([(0, 0, 0), (1, 0, 0), (0.5, 1e-6, 0)], [(1, 2, 3)]),
                  "specks": obj(far, specks + [(2501, 2502, 2503)]),
                  "hidden": obj(cube + inside, shell + hidden)}
        for name, data in meshes.items():
            path = self.write(name + ".obj", data)
            # One or two paths suffice: test_gpu compares blank pictures by every path.
            text = self.ok("compare", path, "--size", "80x60", "--path", "compute", "--source", "lean").out
            self.assertIn("nothing to be seen", text.splitlines()[-1], name)
            self.assertNotIn("DIFFERENT", text)
            paths = "compute,pull" if name == "hidden" else "compute"
            document = self.json("compare", path, "--size", "80x60", "--path", paths, "--source", "lean,packed", "--json")
            self.assertIs(document["blank"], True, name)
            self.assertNotIn("diff", document)
            for result in document["results"]:
                self.assertIs(result["blank"], True)
                self.assertIs(result["indices_equal_cpu"], True)
                for key in ("pixels_different", "triangle_ids_different"):
                    self.assertEqual(result[key], 0)
        blob = self.generate("blob", 2000)
        self.assertIn("the same pictures", self.ok("compare", blob, "--size", "80x60", "--path", "compute").out)
        self.assertIs(self.json("compare", blob, "--size", "80x60", "--path", "compute", "--json")["blank"], False)

    def test_messages_of_validation_fail_a_bench(self):
        self.ok("bench", self.generate("torus", 200), "--rounds", "1", "--validation")

    def test_progress_is_printed_on_terminals_only(self):
        mesh = self.generate("blob", 2000)
        for arguments in (("compare", mesh, "--size", "160x120", "--source", "lean,packed"), ("bench", mesh, "--rounds", "20", "--operators")):
            code, out, said = on_a_terminal(*arguments)
            self.assertEqual(code, DONE, said)
            self.assertIn("[", said, arguments)
            self.assertNotIn("\n", said)
            self.assertTrue(said.endswith(" \r"), repr(said[-80:]))  # erased
            for part in said.split("\r"):
                self.assertRegex(part, r"\A(?:[a-z ,_()]+ \[=* *\] \d+/\d+| *)\Z")
            self.assertNotIn("\r", out)
        outcome = self.ok("compare", mesh, "--size", "160x120", "--path", "compute")
        self.assertEqual(outcome.err, "")
        # An error begins on a new line.
        bad = self.write("bad.obj", b"v 0 0 0\nf 1 1 1\n")
        code, _, said = on_a_terminal("bench", mesh, bad, "--rounds", "1")
        self.assertNotEqual(code, DONE)
        self.assertIn("lacedring: " + bad, said.split("\r")[-2] if said.endswith("\r\n") else said)


if __name__ == "__main__":
    main()
