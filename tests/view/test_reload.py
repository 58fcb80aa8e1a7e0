#!/usr/bin/env python3
"""Tests editing shaders while the viewer draws with them. Usage: test_reload.py LACEDRING"""

import json
import os
import shutil
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import driver
import png
from driver import mesh, run

SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "shaders")
ALBEDO = "vec3 albedo = vec3(0.62, 0.60, 0.565);"
RED = "vec3 albedo = vec3(0.90, 0.05, 0.05);"


class Reload(driver.Scripted):
    def setUp(self):
        self.folder = os.path.join(driver.folder, self.id().split(".")[-1])
        self.shaders = os.path.join(self.folder, "glsl")  # any name works
        shutil.copytree(SOURCES, self.shaders)

    def edited(self, name, old, new):
        """Script lines that replace a shader by an edited one, and wait until the viewer has noticed."""
        with open(os.path.join(SOURCES, name)) as file:
            text = file.read()
        self.assertIn(old, text)
        made = os.path.join(self.folder, f"{len(os.listdir(self.folder))}-{os.path.basename(name)}")
        with open(made, "w") as file:
            file.write(text.replace(old, new, 1))
        return f"copy {made} {self.shaders}/{name}\nwait shaders"

    def mended(self, name):
        return f"copy {SOURCES}/{name} {self.shaders}/{name}\nwait shaders"

    def script(self, *lines, **options):
        states = self.view("\n".join(("set panels off", "wait optimized", "wait shaders") + lines), mesh("blob", 3000),
                           "--shaders", self.shaders, **options)
        self.assertTrue(all(state["shaders"]["folder"] == self.shaders for state in states))
        return [state["shaders"] for state in states]

    def shot(self, name):
        return f"screenshot {self.folder}/{name}.png"

    def differences(self, a, b):
        return png.differences(*(png.read(f"{self.folder}/{name}.png") for name in (a, b)))

    def test_unchanged_sources_are_what_was_built_in(self):
        first, forced = self.script("print", "key f5", "wait shaders", "print")
        self.assertGreater(first["compiled"], 20)
        self.assertEqual((first["replaced"], first["reloads"], first["error"]), (0, 0, ""))
        self.assertEqual(forced["compiled"], 2 * first["compiled"])
        self.assertEqual((forced["replaced"], forced["reloads"], forced["error"]), (0, 1, ""))

    def test_an_edit_is_drawn_and_taken_back(self):
        red, back = self.script(
            self.shot("before"), self.edited("draw/surface.frag", ALBEDO, RED), self.shot("red"), "print",
            self.mended("draw/surface.frag"), self.shot("after"), "print")
        self.assertEqual((red["replaced"], red["reloads"], red["error"]), (1, 1, ""))
        self.assertEqual((back["replaced"], back["reloads"], back["error"]), (0, 2, ""))
        self.assertEqual(red["compiled"] + 1, back["compiled"])
        pixels, largest = self.differences("before", "red")
        self.assertGreater(pixels, 10000)
        self.assertGreater(largest, 50)
        self.assertEqual(self.differences("before", "after"), (0, 0))

    def test_errors_keep_the_picture(self):
        broken, closed, other, mended = self.script(
            self.shot("before"), self.edited("draw/surface.frag", ALBEDO, "vec3 albedo = vec3(0.62, 0.60"), "frames 3",
            self.shot("notice") + " now", "print", "key escape", "frames 3", self.shot("closed"), "print",
            self.edited("draw/line.frag", "void main", "void mine"), "print",
            self.mended("draw/surface.frag"), self.mended("draw/line.frag"), self.shot("after"), "print")
        self.assertRegex(broken["error"], r"^shaders/draw/surface\.frag:71: ")  # the line of the next statement
        self.assertEqual((broken["replaced"], broken["reloads"]), (0, 0))
        self.assertEqual(closed["error"], "")
        # One notice at the top of the window lists all errors; the picture does not change.
        self.assertEqual(len(other["error"].splitlines()), 2)
        pixels, _ = self.differences("before", "notice")
        self.assertGreater(pixels, 1000)
        below = [png.read(f"{self.folder}/{name}.png")[2][120:] for name in ("before", "notice")]
        self.assertEqual(*below)
        self.assertEqual(self.differences("before", "closed"), (0, 0))
        self.assertEqual((mended["error"], mended["replaced"], mended["reloads"]), ("", 0, 0))
        self.assertEqual(self.differences("before", "after"), (0, 0))

    def test_an_edit_of_what_is_included(self):
        start, moved, wrong = self.script(
            "set view ring", "wait settled", "print", self.shot("before"),
            self.edited("draw/surface_vertex.glsl", "vec3(0.045, 0.085, 0.50)", "vec3(0.9, 0.9, 0.0)"), self.shot("other"),
            "print", self.edited("draw/surface_vertex.glsl", "v.clip = clip;", "v.clap = clip;"), "print")
        # Only shaders that include it are compiled.
        including = moved["compiled"] - start["compiled"]
        self.assertGreaterEqual(including, 4)
        self.assertLess(including, 10)
        self.assertEqual((moved["reloads"], moved["error"]), (1, ""))
        self.assertGreater(self.differences("before", "other")[0], 1000)
        self.assertIn("shaders/draw/surface_vertex.glsl:33: ", wrong["error"])
        self.assertEqual(wrong["reloads"], 1)

    def test_another_interface_is_refused(self):
        cases = [("draw/surface.frag", "layout(binding = 3,", "layout(binding = 5,", "binding 5 is new"),
                 ("draw/surface.frag", "layout(location = 1) out uint", "uint", "output 1 is missing"),
                 ("shared.h", "mat4 view_from_world;", "vec4 more; mat4 view_from_world;", "binding 0 is declared otherwise"),
                 ("shared.h", "LR_COMPUTE_GROUP 128u", "LR_COMPUTE_GROUP 32u", "the workgroup's size")]
        lines = [self.shot("before")]
        for name, old, new, _ in cases:
            lines += [self.edited(name, old, new), "print", "key escape", "set decode on", "frames 2", "set decode off",
                      self.mended(name), "print"]
        states = self.script(*lines, self.shot("after"))
        for (*_, why), wrong, right in zip(cases, states[::2], states[1::2]):
            self.assertIn(why, wrong["error"])
            self.assertIn("built anew", wrong["error"])
            self.assertEqual((right["error"], right["reloads"]), ("", 0))
        self.assertEqual(self.differences("before", "after"), (0, 0))

    def test_edits_while_everything_moves(self):
        lines = ["set outlines on", "wait tables", "set mode split", "set decode on", "set turntable on"]
        for i in range(4):
            lines += [self.edited("draw/surface.frag", ALBEDO, RED.replace("0.05", f"0.{i}")), "frames 5"]
            lines += [self.edited("decode/lean_decode.comp", "void main() {", f"void main() {{ // {i}\n"), "frames 2"]
            lines += [self.edited("viewer/compose.comp", "void main() {", "void main() { nothing"), "frames 2"]
            lines += [self.mended("viewer/compose.comp"), f"set path {('pull', 'geometry', 'compute', 'compute')[i]}",
                      f"set source {('lean', 'packed')[i % 2]}", "frames 4", "key f5", "frames 1"]
        lines += ["set decode off", "set turntable off", self.mended("draw/surface.frag"), "wait settled", "print"]
        states = self.script(*lines)
        self.assertGreaterEqual(states[-1]["reloads"], 4)  # edits within a short time are one reload
        self.assertEqual((states[-1]["error"], states[-1]["replaced"]), ("", 0))

    def test_index_buffers_are_made_anew(self):
        """An edited decoder or rotating pass, which works in place, decodes the index buffer again, without loading a mesh."""
        store, nothing = "indices[to] = uvec4(t0, t1.x);", "indices[to] = uvec4(0u);"
        rotated, none = "indices[at] = uvec4(t0, t1.x);", "indices[at] = uvec4(0u);"
        for mode in ("single", "split"):
            states = self.script(
                f"set mode {mode}", self.shot("before"),
                self.edited("decode/lean_decode.comp", store, nothing), self.shot("decoded"), self.mended("decode/lean_decode.comp"),
                self.shot("after"), self.edited("decode/rotate.comp", rotated, none), self.shot("rotated"),
                self.mended("decode/rotate.comp"), self.shot("later"), "print")
            self.assertEqual((states[0]["error"], states[0]["reloads"], states[0]["replaced"]), ("", 4, 0))
            for wrong, right in (("decoded", "after"), ("rotated", "later")):
                self.assertGreater(self.differences("before", wrong)[0], 1000, mode)
                self.assertEqual(self.differences("before", right), (0, 0), mode)

    def test_the_build_s_own_folder_is_watched_and_left_alone(self):
        states = self.view("wait shaders\nwait shaders\nprint\nkey f5\nwait shaders\nprint", mesh("torus", 500))
        self.assertEqual(os.path.realpath(SOURCES), states[0]["shaders"]["folder"])
        self.assertEqual(states[1]["shaders"]["replaced"], 0)
        self.assertEqual(states[1]["shaders"]["error"], "")

    def test_without_sources(self):
        """An installed program has no shader sources; --shaders must be a folder."""
        programs = os.path.join(self.folder, "bin")
        os.mkdir(programs)
        for name in ("lacedring", "lacedring-view"):
            shutil.copy(os.path.join(os.path.dirname(driver.program), name), programs)
        whole, driver.program = driver.program, os.path.join(programs, "lacedring")
        try:
            states = self.view("key f5\nframes 2\nprint", mesh("torus", 500))
            self.view("wait shaders", code=2)
        finally:
            driver.program = whole
        self.assertEqual((states[0]["shaders"]["folder"], states[0]["error"]), ("", ""))
        self.assertIn("--shaders", states[0]["note"])
        done = run("view", "--shaders", os.path.join(self.folder, "none"))
        self.assertEqual((done.returncode, done.stdout), (3, ""))
        self.assertEqual(len(done.stderr.splitlines()), 1)

    def test_a_folder_that_goes_and_comes_back(self):
        script = os.path.join(self.folder, "script")
        with open(script, "w") as file:
            file.write("wait optimized\n" + "wait shaders\nprint\n" * 300 + "close\n")
        viewer = subprocess.Popen(
            [driver.program, "view", mesh("torus", 500), "--shaders", self.shaders, "--script", script],
            stdout=subprocess.PIPE, stdin=subprocess.DEVNULL, cwd=driver.folder, env=dict(os.environ, DISPLAY=driver.display))
        try:
            told = (json.loads(line)["shaders"] for line in viewer.stdout)
            self.assertEqual(next(told)["error"], "")
            os.rename(self.shaders, self.shaders + "-away")
            gone = next(state for state in told if state["error"] != "")
            self.assertIn(".comp: cannot be read", gone["error"])
            self.assertIn("more", gone["error"].splitlines()[-1])
            os.rename(self.shaders + "-away", self.shaders)
            back = next(state for state in told if state["error"] == "")
            self.assertEqual((back["replaced"], back["reloads"]), (0, 0))
        finally:
            viewer.terminate()
            viewer.communicate()


if __name__ == "__main__":
    driver.main()
