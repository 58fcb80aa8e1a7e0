#!/usr/bin/env python3
"""test_refusals.py LACEDRING: inputs that the program must not read, files that it must not overwrite, and losses that it must report."""

import json
import os
import re
import shlex
import signal
import socket
import struct
import subprocess
import time
import unittest

import cli_support
from cli_support import BAD_INPUT, DONE, WRONG_USAGE, CliTest, main, run

import mesh_writers as write

POINTS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)]
TRIANGLES = [(0, 1, 2), (0, 2, 3)]


def shell(command, **more):
    """Runs a shell command, in which $L is the program."""
    environment = dict(os.environ, L=cli_support.program)
    return subprocess.run(["bash", "-c", command], capture_output=True, text=True, env=environment, timeout=120, **more)


class Inputs(CliTest):
    def test_only_regular_files(self):
        """Every command refuses pipes, devices, sockets and files of /proc at once, without waiting."""
        os.mkfifo(self.path("pipe.ply"))
        os.symlink("pipe.ply", self.path("link.ply"))
        with socket.socket(socket.AF_UNIX) as server:
            server.bind(self.path("socket.ply"))
            names = [self.path("pipe.ply"), self.path("link.ply"), self.path("socket.ply"), "/dev/zero", "/dev/null", "/dev/tty",
                     "/proc/self/status", "/proc/self/mem", "/proc/kmsg", self.folder]
            for name in names:
                for command in (["info", name], ["stats", name], ["encode", name, "-o", self.path("x.lr")],
                                ["decode", name, "-o", self.path("x.ply")], ["verify", name]):
                    with self.subTest(command=command):
                        started = time.monotonic()
                        self.check_error(run(*command, timeout=20), name)
                        self.assertLess(time.monotonic() - started, 10)
        self.assertFalse(os.path.exists(self.path("x.lr")))

    def test_gltf_stays_in_its_folder(self):
        os.mkdir(self.path("inner"))
        self.write("secret.bin", struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
        document = json.loads(write.gltf(POINTS, [(4, [0, 1, 2])]))
        document["accessors"][0].update(bufferView=len(document["bufferViews"]), count=3, byteOffset=0)
        document["accessors"][0].pop("sparse", None)
        document["bufferViews"].append({"buffer": 1, "byteLength": 36})
        for uri in ("../secret.bin", "%2e%2e/secret.bin", self.path("secret.bin"), "link.bin"):
            if uri == "link.bin":
                os.symlink("../secret.bin", self.path("inner/link.bin"))
            document["buffers"][1:] = [{"uri": uri, "byteLength": 36}]
            source = self.write("inner/a.gltf", json.dumps(document).encode())
            with self.subTest(uri=uri):
                self.fails("encode", source, "-o", self.path("x.lr"), mentions=["leaves the folder"])
                self.ok("info", "--allow-outside", source)

    def test_memory_limit(self):
        document = json.loads(write.gltf(POINTS, [(4, [0, 1, 2] * 1000)]))
        document["nodes"] = [{"mesh": 0}] * 20000
        document["scenes"] = [{"nodes": list(range(20000))}]
        bomb = self.write("bomb.gltf", json.dumps(document).encode())
        self.fails("info", bomb, mentions=["20000000 triangles", "--max-memory"])
        blob = self.generate("blob", 20000)
        self.fails("encode", blob, "-o", self.path("x.lr"), "--max-memory", "1", mentions=["--max-memory"])
        self.ok("encode", blob, "-o", self.path("x.lr"), "--max-memory", "100")
        self.fails("verify", self.path("x.lr"), "--max-memory", "1", mentions=["--max-memory"])
        self.fails("info", blob, "--max-memory", "0", codes=(WRONG_USAGE,))

    def test_standard_input(self):
        ply = self.generate("blob", 500)
        with open(ply, "rb") as file:
            data = file.read()
        for name, content, options in (("ply", data, []), ("obj", write.obj(POINTS, TRIANGLES), ["--input-format", "obj"]),
                                       ("glb", write.gltf(POINTS, [(4, [0, 1, 2])], binary=True), [])):
            with self.subTest(name):
                out = subprocess.run([cli_support.program, "info", "--json", "-", *options], input=content, capture_output=True)
                self.assertEqual(out.returncode, DONE, out.stderr)
                self.assertEqual(json.loads(out.stdout)["file"], "standard input")
        out = subprocess.run([cli_support.program, "info", "-"], input=write.obj(POINTS, TRIANGLES), capture_output=True, text=False)
        self.assertEqual(out.returncode, BAD_INPUT)
        self.assertRegex(out.stderr.decode(), r"\Alacedring: standard input: [^\n]*not recogni[sz]ed[^\n]*\n\Z")
        out = shell(f"$L encode '{ply}' -o - | $L decode - -o - --output-format ply | $L verify - && "
                    f"$L encode '{ply}' -o - | $L info -")
        self.assertEqual(out.returncode, DONE, out.stderr)
        self.assertIn("version 4", out.stdout)
        out = shell("$L generate torus --triangles 300 -o - --output-format glb | $L stats --json -")
        self.assertEqual(json.loads(out.stdout)["meshes"][0]["components"], 1)
        out = shell("yes | head -c 3000000 | $L info - --max-memory 1")
        self.assertEqual(out.returncode, BAD_INPUT, out.stderr)
        self.fails("decode", self.path("missing.lr"), "-o", "-", codes=(WRONG_USAGE,), mentions=["--output-format"])
        self.fails("generate", "torus", "-o", "-", codes=(WRONG_USAGE,), mentions=["--output-format"])


class Outputs(CliTest):
    def test_inputs_are_never_overwritten(self):
        mesh = self.generate("blob", 500)
        lr = self.path("a.lr")
        self.ok("encode", mesh, "-o", lr)
        os.symlink(mesh, self.path("link.lr"))
        os.link(mesh, self.path("hard.lr"))
        os.symlink(lr, self.path("link.ply"))
        os.mkdir(self.path("sub"))
        for command in (["encode", mesh, "-o", mesh], ["encode", mesh, "-o", self.path("link.lr")],
                        ["encode", mesh, "-o", self.path("hard.lr")], ["encode", mesh, "-o", self.path("sub/../" + os.path.basename(mesh))],
                        ["decode", lr, "-o", self.path("link.ply")], ["encode", lr, "-o", lr]):
            with self.subTest(command):
                self.fails(*command, mentions=["--force"], codes=(WRONG_USAGE,))
        self.ok("encode", lr, "-o", lr, "--force")
        self.ok("verify", lr)
        # A glTF's buffer is an input, too.
        document = json.loads(write.gltf(POINTS, [(4, [0, 1, 2])]))
        self.write("own.lr", write.gltf(POINTS, [(4, [0, 1, 2])], binary=True)[20 + struct.unpack_from(
            "<I", write.gltf(POINTS, [(4, [0, 1, 2])], binary=True), 12)[0] + 8:])
        document["buffers"] = [{"uri": "own.lr", "byteLength": document["buffers"][0]["byteLength"]}]
        gltf = self.write("beside.gltf", json.dumps(document).encode())
        self.fails("encode", gltf, "-o", self.path("own.lr"), mentions=["is an input"], codes=(WRONG_USAGE,))

    def test_extensions(self):
        mesh = self.generate("blob", 500)
        lr = self.path("a.lr")
        self.ok("encode", mesh, "-o", lr)
        for name in ("b.obj", "b.PLY", "b.glb", "b.gltf", "b.png", "b.json"):
            self.fails("encode", mesh, "-o", self.path(name), mentions=["--force"], codes=(WRONG_USAGE,))
        for name in ("b", "b.foo", "b.lr.bak", "b.LR"):
            self.ok("encode", mesh, "-o", self.path(name))
        self.ok("encode", mesh, "-o", self.path("b.obj"), "--force")
        for name in ("b.stl", "b.off", "b.gltf", "b.lr", "b.foo", "b"):
            self.fails("decode", lr, "-o", self.path("new-" + name), codes=(WRONG_USAGE,))

    def test_links(self):
        lr = self.path("x.lr")
        self.ok("encode", self.generate("blob", 500), "-o", lr)
        os.symlink("b.ply", self.path("a.ply"))
        os.symlink("a.ply", self.path("b.ply"))
        outcome = run("decode", lr, "-o", self.path("a.ply"))
        self.check_error(outcome, "links")
        self.assertTrue(os.path.islink(self.path("a.ply")))
        os.mkdir(self.path("folder"))
        os.symlink("folder/target.ply", self.path("good.ply"))  # its target does not exist yet
        self.ok("decode", lr, "-o", self.path("good.ply"))
        self.assertTrue(os.path.islink(self.path("good.ply")))
        self.assertTrue(os.path.isfile(self.path("folder/target.ply")))

    def test_permissions_stay_and_no_temporary_file_is_left(self):
        lr, out = self.path("x.lr"), self.path("x.ply")
        self.ok("encode", self.generate("blob", 500), "-o", lr)
        self.write("x.ply", b"old")
        os.chmod(out, 0o640)
        self.ok("decode", lr, "-o", out)
        self.assertEqual(os.stat(out).st_mode & 0o777, 0o640)
        self.assertEqual([name for name in os.listdir(self.folder) if name.startswith(".")], [])

    def test_devices_and_descriptors(self):
        mesh = self.generate("blob", 500)
        self.ok("encode", mesh, "-o", "/dev/null")
        out = shell(f"$L encode '{mesh}' -o /dev/stdout | $L info -")
        self.assertEqual(out.returncode, DONE, out.stderr)
        out = shell(f"exec 7> '{self.path('by-number')}'; $L encode '{mesh}' -o /dev/fd/7 && $L info '{self.path('by-number')}'")
        self.assertEqual(out.returncode, DONE, out.stderr)
        outcome = run("encode", mesh, "-o", "/dev/full")
        self.check_error(outcome, "/dev/full")

    def test_several_inputs(self):
        good = [self.generate("blob", 500), self.generate("torus", 300), self.generate("sphere", 200)]
        bad = self.write("bad.obj", b"v 0 0\n")
        out = self.path("out")
        outcome = run("encode", good[0], bad, *good[1:], "-o", out + "/")
        self.assertEqual(outcome.code, BAD_INPUT, str(outcome))
        self.assertEqual(sum(line.startswith("lacedring: ") for line in outcome.err.splitlines()), 1, str(outcome))
        made = [os.path.join(out, os.path.splitext(os.path.basename(path))[0] + ".lr") for path in good]
        self.assertEqual(sorted(os.listdir(out)), sorted(os.path.basename(path) for path in made))
        self.ok("decode", *made, "-o", self.path("back") + "/", "--output-format", "ply")
        for path in good:
            self.same_triangles(path, os.path.join(self.path("back"), os.path.basename(path)))
        self.fails("encode", *good, "-o", self.path("one.lr"), mentions=["FOLDER/"], codes=(WRONG_USAGE,))
        os.mkdir(self.path("elsewhere"))
        twin = self.write("elsewhere/" + os.path.basename(good[0]), b"a file of the same name")
        outcome = run("encode", good[0], twin, "-o", out + "/")
        self.check_error(outcome, "two inputs", codes=(WRONG_USAGE,))
        # The good files are still reported.
        outcome = run("stats", "--json", "--optimize", "0", good[0], bad, good[1])
        self.assertEqual(outcome.code, BAD_INPUT, str(outcome))
        self.assertEqual([mesh["file"] for mesh in json.loads(outcome.out)["meshes"]], good[:2])
        self.assertRegex(outcome.err, r"\Alacedring: [^\n]*bad.obj[^\n]*\n\Z")
        outcome = run("stats", "--json", bad)
        self.check_error(outcome, "bad.obj")


class Streams(CliTest):
    """With standard streams that are closed or full, the exit code is still the command's."""

    def test_standard_error(self):
        mesh = self.generate("blob", 500)
        for where in ("2>&-", "2>/dev/full", "2> >(true)"):
            with self.subTest(where):
                self.assertEqual(shell(f"$L info '{self.path('missing.ply')}' {where}").returncode, BAD_INPUT)
                self.assertEqual(shell(f"$L nonsense {where}").returncode, WRONG_USAGE)
                self.assertEqual(shell(f"$L encode '{mesh}' -o '{self.path('o.lr')}' {where}").returncode, DONE)
                self.ok("verify", self.path("o.lr"))
                os.remove(self.path("o.lr"))
                self.assertEqual(shell(f"$L generate blob -o '{self.path('g.ply')}' {where}").returncode, DONE)

    def test_standard_output(self):
        mesh = self.generate("blob", 500)
        for where in (">&-", ">/dev/full"):
            for command in (f"info '{mesh}'", f"info --json '{mesh}'", f"stats '{mesh}'", f"verify '{mesh}'", "--version", "-V",
                            "--help", "help", "info --help", f"encode '{mesh}' -o -"):
                with self.subTest(command=command, where=where):
                    out = shell(f"$L {command} {where}")
                    self.assertEqual(out.returncode, BAD_INPUT, out.stderr)
                    self.assertRegex(out.stderr, r"(?:\A|\n)lacedring: standard output: [^\n]+\n\Z")
        # A file that is opened with the number of a closed stream gets no other output.
        self.assertEqual(shell(f"$L encode '{mesh}' -o '{self.path('o.lr')}' >&- 2>&-").returncode, DONE)
        self.ok("verify", self.path("o.lr"))
        self.assertEqual(shell(f"$L encode '{mesh}' -o '{self.path('o.lr')}' <&- >&- 2>&-").returncode, DONE)
        self.ok("verify", self.path("o.lr"))

    def test_all_standard_streams_closed(self):
        self.assertEqual(shell(f"$L info '{self.path('missing.ply')}' <&- >&- 2>&-").returncode, BAD_INPUT)
        self.assertEqual(shell("$L info - <&-").returncode, BAD_INPUT)


class Usage(CliTest):
    def wrong(self, *arguments, mentions=()):
        outcome = run(*arguments)
        self.check_error(outcome, *mentions, codes=(WRONG_USAGE,))

    def test_unknown_commands(self):
        for name, nearest in (("stat", "stats"), ("inof", "info"), ("Stats", "stats"), ("encdoe", "encode"), ("decodee", "decode")):
            self.wrong(name, "x.ply", mentions=[f"'{name}'", f"'{nearest}'"])
        self.wrong("info", "x.ply", "--jsno", mentions=["info has no option --jsno; nearest is '--json'"])
        self.wrong("info", "x.ply", "--wled=position", mentions=["--wled; nearest is '--weld'"])
        self.wrong("info", "x.ply", "--velocity", mentions=["info has no option --velocity ("])
        self.wrong("frobnicate", mentions=["unknown command 'frobnicate'"])
        self.wrong("x" * 1000, mentions=["unknown command"])
        self.wrong("a\nb", mentions=["unknown command 'a b'"])
        self.wrong(mentions=["command"])
        if not self.has_command("render"):
            self.wrong("render", "x.ply", "-o", "x.png", mentions=["built without Vulkan"])

    def test_help_and_version(self):
        for arguments in (["help"], ["--help"], ["-h"]):
            self.assertIn("encode", self.ok(*arguments).out)
        self.assertEqual(self.ok("help", "encode").out, self.ok("encode", "--help").out)
        self.assertEqual(self.ok("-V").out, self.ok("--version").out)
        self.wrong("help", "nonsense", mentions=["nonsense"])

    def test_weld_takes_its_value_either_way(self):
        mesh = self.write("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv -0 1 0\nv 1 0 -0\nv 1 1 0\nf 1 2 3\nf 5 6 4\n")
        for arguments in (["--weld", "position"], ["--weld=position"]):
            self.assertEqual(self.json("info", "--json", *arguments, mesh)["vertices"], 4)
            self.assertEqual(self.json("info", "--json", mesh, *arguments)["vertices"], 4)
        self.assertEqual(self.json("info", "--json", "--weld", mesh)["vertices"], 4)
        self.assertEqual(self.json("info", "--json", "--weld", "attributes", mesh)["vertices"], 4)
        self.wrong("info", "--weld=nonsense", mesh)

    def test_numbers(self):
        """A number that an option does not take: the message names the option, the value and what is allowed."""
        whole, real = "a whole number from", "a number"
        cases = [(["generate", "blob", "-o", "x.ply"], [("--triangles", "0", whole), ("--seed", None, whole)]),
                 (["encode", "x.ply", "-o", "x.lr"],
                  [("--k", "0", whole), ("--seeds", "1e6", whole), ("--random-seed", None, whole), ("--optimize", "1e6", whole),
                   ("--effort", "10", whole), ("--threads", "0", whole), ("--positions", "23", whole), ("--normals", "1", whole),
                   ("--max-memory", "0", whole), ("--weld-tolerance", "0", real + " above 0")]),
                 (["bench", "x.ply", "--resident"],
                  [("--rounds", "0", whole), ("--seeds", "0", whole), ("--sample", "1e9", whole), ("--page", "5", "0, 4, 8"),
                   ("--levels", "1,1001", real + " from 0 to 1000")])]
        if self.has_command("render"):
            cases.append((["render", "x.ply", "-o", "x.png"],
                          [("--samples", "9", whole), ("--crease", "181", real + " from 0 to 180"), ("--device-memory", "0", whole),
                           ("--camera-zoom-factor", "0", real + " above 0"), ("--camera-view-angle", "179", real + " above 0 and below 179"),
                           ("--size", "0x5", "WIDTHxHEIGHT"), ("--up", "W", "X, Y or Z"), ("--camera-position", "1,2", "three numbers")]))
        for command, options in cases:
            for option, outside, allowed in options:
                for value in ("-5", outside, "1.5", "abc", "9" * 400, "0x10", "nan", "1e400"):
                    if value is None or (value == "1.5" and allowed.startswith(real)):
                        continue
                    shown = value.split(",")[-1] if option == "--levels" else value
                    shown = shown if len(shown) <= 40 else shown[:40] + "..."
                    self.wrong(*command, f"{option}={value}", mentions=[f"{option}: '{shown}' is not {allowed}"])

    def test_whole_numbers_with_an_exponent(self):
        files = set()
        for number in ("2500", "2.5e3", "25E2", "+2500", "250e+1", "02500"):
            path = self.path(number + ".ply")
            self.ok("generate", "blob", "-o", path, "--triangles", number)
            with open(path, "rb") as file:
                files.add(file.read())
        self.assertEqual(len(files), 1)
        self.wrong("generate", "sphere", "-o", "x.ply", "--triangles", "1073741824", mentions=["--triangles 1073741824: "])

    def test_options_without_effect(self):
        mesh, lr = self.generate("blob", 300), self.path("x.lr")
        for options in (["--profile", "cache", "--format", "lean"], ["--profile", "small", "--format", "lr"], ["--k", "5"], ["--k", "5", "--format", "lr"],
                        ["--k", "5", "--format", "lean"], ["--no-warts"], ["--no-warts", "--format", "packed"],
                        ["--no-warts", "--format", "lr-compact"], ["--optimize", "3", "--format", "lr-compact"],
                        ["--k", "5", "--format", "lr-compact", "--ring", "expander"],
                        ["--random-seed", "7", "--seeds", "1", "--optimize", "0"]):
            self.fails("encode", mesh, "-o", lr, *options, mentions=[options[0]], codes=(WRONG_USAGE,))
        for options in (["--profile", "cache"], ["--profile", "cache", "--format", "packed"], ["--k", "5", "--ring", "hybrid"],
                        ["--k", "5", "--ring", "hybrid", "--format", "lean"], ["--no-warts", "--format", "lean"],
                        ["--k", "5", "--format", "lr-compact"], ["--no-warts", "--format", "lr"], ["--random-seed", "7"]):
            self.ok("encode", mesh, "-o", lr, *options)
        for options in (["--paper", "--optimize", "3"], ["--table", "periods", "--ring", "hybrid"],
                        ["--table", "seeds", "--seeds", "4"], ["--table", "offsets", "--paper"]):
            self.wrong("stats", mesh, *options, mentions=["--"])
        self.fails("decode", lr, "-o", self.path("y.ply"), "--output-format", "ply", codes=(WRONG_USAGE,))

    def test_no_exceptions_in_messages(self):
        for arguments in (["generate", "blob", "-o", "x.ply", "--triangles", "1e-6"], ["info", "--optimize"], ["stats"],
                          ["encode", "x.ply"], ["encode", "x.ply", "-o", "y.lr", "--format", "leen"]):
            self.wrong(*arguments)


class Advice(CliTest):
    """An error of using the wrong command names the right one, or what the command takes."""

    def test_scenes_are_gltf(self):
        mesh, lr, out = self.write("a.ply", write.ply(POINTS, TRIANGLES)), self.path("a.lr"), self.path("out.glb")
        self.ok("encode", mesh, "-o", lr)
        for command in ("pack", "unpack"):
            self.fails(command, mesh, "-o", out, mentions=["is no glTF", "lacedring encode"])
            self.fails(command, lr, "-o", out, mentions=["is an .lr file", "lacedring decode"])

    def test_outputs_by_extension(self):
        mesh, lr = self.write("a.ply", write.ply(POINTS, TRIANGLES)), self.path("a.lr")
        self.ok("encode", mesh, "-o", lr)
        for options in ([], ["--force"]):
            self.fails("decode", lr, "-o", self.path("a.stl"), *options, mentions=[".glb, .ply or .obj"], codes=(WRONG_USAGE,))


class Notes(CliTest):
    def test_losses_are_reported(self):
        document = json.loads(write.gltf(POINTS, [(4, [0, 1, 2])]))
        document.update(materials=[{}, {}], textures=[{}], skins=[{"joints": [0]}], animations=[{}], images=[{"uri": "../x.png"}])
        gltf = self.write("a.gltf", json.dumps(document).encode())
        outcome = self.ok("encode", gltf, "-o", self.path("a.lr"))
        first = outcome.err.splitlines()[0]
        for what in ("not kept", "2 materials", "1 texture", "1 image", "1 skin", "1 animation"):
            self.assertIn(what, first)
        self.assertEqual(self.json("info", "--json", gltf)["triangles"], 1)  # standard output is the document only
        self.assertIn("not used here: 2 materials", self.ok("info", gltf).err)
        # An error is one line, without the notes.
        self.fails("encode", gltf, "-o", self.path("missing/a.lr"), mentions=["missing/a.lr"])

    def test_control_characters_of_names_are_not_printed(self):
        named = write.ply(POINTS, TRIANGLES).replace(b"uchar red", b"uchar \x1b[31mred\x07")
        mesh, lr = self.write("named.ply", named), self.path("named.lr")
        self.ok("encode", mesh, "-o", lr)
        for path in (mesh, lr):
            out = self.ok("info", path).out
            self.assertIn("?[31mred?", out)
            self.assertNotIn("\x1b", out)

    def test_no_way_of_welding_loses_anything(self):
        mesh = self.write("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 1\nf 1/1 2/1 3/1\nf 2/2 4/1 3/2\n")
        for options in ((), ("--weld",), ("--weld=position",), ("--no-weld",)):
            self.assertEqual(self.ok("info", *options, mesh).err, "")

    def writers(self):
        """Commands that write a file, each with a pattern of the line that says so; BYTES stands for the file's size."""
        mesh, lr, glb, packed = self.generate("blob", 300), self.path("a.lr"), self.path("a.glb"), self.path("p.glb")
        out = [(["generate", "blob", "--triangles", "300", "-o", mesh], r"300 triangles, 152 vertices, BYTES bytes"),
               (["encode", mesh, "-o", lr], r"300 triangles, 152 vertices, BYTES bytes: .*"),
               (["decode", lr, "-o", glb], r"300 triangles, 152 vertices, BYTES bytes"),
               (["decode", lr, "-o", self.path("a.ply")], r"300 triangles, 152 vertices, BYTES bytes"),
               (["pack", glb, "-o", packed], r"1 primitive, 300 triangles, BYTES bytes, before \d+ bytes; geometry .*; largest error: .*"),
               (["pack", glb, "-o", packed, "--json"], r"1 primitive, 300 triangles, BYTES bytes, .*"),
               (["unpack", packed, "-o", self.path("u.glb")], r"1 primitive, 300 triangles, BYTES bytes; packed \d+ bytes"),
               (["report", mesh, "--no-gpu", "-o", self.path("a.html")], r"1 mesh, BYTES bytes; no pictures: .*")]
        if self.has_command("render"):
            render = ["render", mesh, "--size", "64x48", "-o", self.path("a.png")]
            line = r"64x48 pixels, BYTES bytes; 300 triangles, lean smooth, covers [\d.]+ % of the picture; .*"
            out += [(render, line), ([*render, "--json"], line)]
        return out

    def test_what_was_written(self):
        """One line a file on standard error, in one form, with --json and - as output, too."""
        for command, line in self.writers():
            with self.subTest(command):
                outcome = self.ok(*command)
                path = command[command.index("-o") + 1]
                self.assertRegex(outcome.err, rf"\A{re.escape(path)}: {line.replace('BYTES', str(os.path.getsize(path)))}\n\Z")
                self.assertEqual(outcome.out == "", "--json" not in command)
                if "--json" in command:
                    continue
                to = "-o - --output-format ply" if command[0] in ("generate", "decode") else "-o -"
                words = [word for word in command if word not in ("-o", path)]
                done = shell(f"$L {shlex.join(words)} {to} 2>&1 >'{self.path('out')}'")
                self.assertEqual(done.returncode, DONE)
                self.assertRegex(done.stdout, rf"\Astandard output: {line.replace('BYTES', str(os.path.getsize(self.path('out'))))}\n\Z")

    def test_quiet(self):
        """--quiet leaves standard error to errors, in every command that says anything else there."""
        mesh = self.write("m.obj", b"usemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nf 1 1 2\n")
        commands = [(command, line) for command, line in self.writers()]
        commands += [([name, mesh, *options], None) for name, *options in (("info",), ("stats",), ("verify",))]
        commands += [(["encode", mesh, "-o", self.path("m.lr")], None)]
        if self.has_command("compare"):
            commands.append((["compare", mesh, "--path", "compute", "--source", "lean", "--size", "64x48"], None))
        for command, _ in commands:
            with self.subTest(command):
                for quiet in ("--quiet", "-q"):
                    self.assertEqual(self.ok(*command, quiet).err, "")
        self.fails("info", "--quiet", self.path("missing.ply"), mentions=["missing.ply"])
        if self.has_command("view"):
            self.fails("view", "--quiet", codes=(WRONG_USAGE,), mentions=["--quiet"])
        # The page does not tell how it was asked for.
        pages = []
        for options in ([], ["--quiet"]):
            self.ok("report", mesh, "--no-gpu", "-o", self.path("m.html"), *options)
            with open(self.path("m.html"), "rb") as file:
                pages.append(file.read())
        self.assertEqual(pages[0], pages[1])

    def test_quiet_on_a_terminal(self):
        """The same of progress bars, which only a terminal gets."""
        mesh = self.generate("blob", 1000000)  # optimizing takes much longer than the half second after which a bar appears
        for options, shows in (([], True), (["--quiet"], False)):
            terminal, other = os.openpty()
            encode = subprocess.Popen([cli_support.program, "encode", mesh, "-o", self.path("m.lr"), "--effort", "9", "--resident", *options], stderr=other)
            os.close(other)
            said = b""
            try:
                while block := os.read(terminal, 65536):
                    said += block
            except OSError:  # nobody writes to it any more
                pass
            os.close(terminal)
            self.assertEqual(encode.wait(timeout=60), DONE)
            self.assertEqual(b"optimizing the ring [" in said, shows, said[:300])
            if not shows:
                self.assertEqual(said, b"")

    def test_encode_says_what_it_wrote(self):
        mesh = self.write("m.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\nf 1 1 2\nf 1 2 2\n")
        lr = self.path("m.lr")
        outcome = self.ok("encode", mesh, "-o", lr, "--format", "packed")
        self.assertIn("2 degenerate triangles dropped", outcome.err)
        size = os.path.getsize(lr)
        self.assertRegex(outcome.err, rf"m.lr: 2 triangles, 4 vertices, {size} bytes: {8 * size / 2:.2f} bits per triangle, {8 * size / 4:.2f} per "
                                      r"vertex; connectivity (\d+) bytes, .*; lossless; resident \d+ bytes\n")
        words = outcome.err.split()
        connectivity = int(words[words.index("connectivity") + 1])
        self.assertIn(f"{8 * connectivity / 2:.2f} bits per triangle", outcome.err)
        only = self.write("only.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 2\n")
        self.fails("encode", only, "-o", self.path("only.lr"), mentions=["degenerate"])
        self.ok("info", only)

    def test_info_lists_the_sections_of_an_lr_file(self):
        mesh = self.generate("soup", 500)
        for form, kind in (("lean", "lean"), ("packed", "packed"), ("lr", "lr"), ("lr-compact", "lr_compact")):
            for keep in (False, True):
                lr = self.path("x.lr")
                self.ok("encode", mesh, "-o", lr, "--format", form, *(["--keep-order"] if keep else []))
                told = self.json("info", "--json", lr)["lr"]
                self.assertEqual((told["format"], told["version"], told["bytes"]), (kind, 4, os.path.getsize(lr)))
                self.assertEqual((told["vertex_order"], told["corner_order"]), (keep, keep))
                kinds = [section["kind"] for section in told["sections"]]
                attribute = "vertices" if form in ("lean", "packed") else "attribute"
                self.assertEqual(kinds, [kind, attribute] + (["vertex_order", "corner_order"] if keep else []))
                self.assertEqual(told["sections"][1]["name"], "POSITION")
                text = self.ok("info", lr).out
                self.assertIn("the input's order is kept" if keep else "the input's order is not kept", text)
        self.assertEqual(self.json("stats", "--json", "--optimize", "0", lr)["meshes"][0]["lr"]["format"], "lr_compact")
        self.assertNotIn("lr", self.json("info", "--json", mesh))

    def test_quantizing(self):
        mesh, lr, back = self.generate("blob", 3000), self.path("x.lr"), self.path("x.ply")
        sizes = []
        for options in ([], ["--positions", "14"], ["--positions", "10", "--format", "lr"]):
            outcome = self.ok("encode", mesh, "-o", lr, "--force", *options)
            sizes.append(os.path.getsize(lr))
            section = self.json("info", "--json", lr)["lr"]["sections"][1]
            self.assertEqual((section["kind"], section["name"]), ("vertices", "POSITION"))
            self.assertEqual("lossless" in outcome.err, not options)
            if options:
                self.assertIn(f"largest error: POSITION {section['max_error']:.3g}", outcome.err)
            self.ok("decode", lr, "-o", back, "--force")
        self.assertLess(sizes[1], sizes[0])
        self.assertIn("largest error", self.ok("info", lr).out)
        # Bits without effect are reported.
        texts = self.write("t.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n")
        outcome = self.ok("encode", texts, "-o", lr, "--force", "--positions", "20")
        self.assertIn("POSITION stays lossless: that is smaller", outcome.err)
        for options in (["--positions", "0"], ["--positions", "23"], ["--normals", "1"], ["--normals", "17"], ["--weights", "x"]):
            self.fails("encode", mesh, "-o", lr, *options, mentions=[options[0]], codes=(WRONG_USAGE,))

    def test_original_order_restores_first_corners(self):
        """--original-order restores the input's index list, with the same first corner of each triangle."""
        triangles = [(0, 1, 2), (3, 0, 2), (2, 2, 1), (1, 0, 3), (2, 1, 3)]
        mesh = self.write("m.obj", write.obj(POINTS, triangles))
        for form in ("lean", "packed", "lr", "lr-compact"):
            lr, back = self.path("m.lr"), self.path("m-back.obj")
            self.ok("encode", mesh, "-o", lr, "--keep-order", "--format", form)
            self.ok("decode", lr, "-o", back, "--original-order")
            with open(back, encoding="ascii") as file:
                faces = [tuple(int(v) - 1 for v in line.split()[1:]) for line in file if line.startswith("f ")]
            self.assertEqual(faces, [t for t in triangles if len(set(t)) == 3], form)


class Faults(CliTest):
    """With killed processes and full disks, an output is complete, the old file, or absent."""

    def commands(self):
        mesh = self.generate("blob", 60000)
        lr = self.path("in.lr")
        self.ok("encode", mesh, "-o", lr, "--optimize", "0")
        out = [(["encode", mesh, "--optimize", "0", "-o"], "out.lr"), (["decode", lr, "-o"], "out.ply"),
               (["decode", lr, "-o"], "out.glb"), (["decode", lr, "-o"], "out.obj"),
               (["generate", "blob", "--triangles", "60000", "-o"], "gen.ply"), (["report", mesh, "--no-gpu", "--optimize", "0", "-o"], "out.html")]
        if self.has_command("render"):
            out += [(["render", mesh, "--size", "160x120", "-o"], "out.png")]
        return out

    def test_kill(self):
        for command, name in self.commands():
            path = self.path(name)
            started = time.monotonic()
            self.ok(*command, path)
            took = time.monotonic() - started
            with open(path, "rb") as file:
                whole = file.read()
            for i in range(6):
                with self.subTest(command=command, i=i):
                    self.write(name, b"old")
                    process = subprocess.Popen([cli_support.program, *command, path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
                    time.sleep(took * (0.4 + 0.12 * i))
                    process.send_signal(signal.SIGKILL)
                    process.wait()
                    with open(path, "rb") as file:
                        self.assertIn(file.read(), (b"old", whole))
            os.remove(path)

    def test_full_disk(self):
        """Files are limited to 20,000 bytes: writes fail half-way, as on a full disk."""
        import resource
        commands = self.commands()

        def small_files():
            signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
            resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))

        for command, name in commands:
            with self.subTest(command):
                self.write(name, b"old")
                self.fails(*command, self.path(name), mentions=[name], preexec_fn=small_files)

    def test_little_memory(self):
        """With 12 to 64 MiB of memory, a command writes the whole output, or prints one line and keeps the old file."""
        import resource
        codes = set()
        for command, name in self.commands():
            if command[0] == "render":  # the driver may crash without memory
                continue
            self.write(name, b"old")
            for mebibytes in (64, 48, 32, 24, 20, 16, 12):
                with self.subTest(command=command, mebibytes=mebibytes):
                    def little_memory(size=mebibytes << 20):
                        resource.setrlimit(resource.RLIMIT_DATA, (size, size))
                    outcome = cli_support.run(*command, self.path(name), preexec_fn=little_memory)
                    codes.add(outcome.code)
                    if outcome.code != 0:
                        self.fails(*command, self.path(name), mentions=["not enough memory"], preexec_fn=little_memory)
        self.assertEqual(codes, {0, 3})


if __name__ == "__main__":
    main()
