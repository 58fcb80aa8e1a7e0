#!/usr/bin/env python3
"""Tests the viewer by scripts in a window of Xvfb. Usage: test_view.py LACEDRING"""

import json
import os
import random
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import driver
import png
from driver import mesh, run, without_display

ASSETS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "assets")
WINDOW_LIBRARIES = ("libglfw", "libX11", "libxcb", "libwayland", "libGL.")


class View(driver.Scripted):
    def test_other_commands_load_no_window_library(self):
        torus = mesh("torus", 500)
        trace = dict(without_display(), LD_DEBUG="files")
        for arguments in (["info", torus], ["stats", torus], ["verify", torus],
                          ["encode", torus, "-o", os.path.join(driver.folder, "t.lr")], ["bench", torus, "--no-gpu", "--rounds", "1"]):
            done = run(*arguments, environment=trace)
            self.assertEqual(done.returncode, 0, done.stderr[-500:])
            for library in WINDOW_LIBRARIES:
                self.assertNotIn(library, done.stderr, arguments)
        # Vulkan drivers may load libraries of the window system, but nothing loads the viewer's library.
        for arguments in (["render", torus, "-o", os.path.join(driver.folder, "t.png"), "--size", "64x64"],
                          ["compare", torus, "--size", "64x64", "--path", "compute", "--source", "lean"]):
            done = run(*arguments, environment=trace)
            self.assertEqual(done.returncode, 0, done.stderr[-500:])
            self.assertNotIn("libglfw", done.stderr)

    def test_no_display_is_one_line(self):
        done = run("view", mesh("torus", 500), environment=without_display())
        self.assertEqual(done.returncode, 4)
        self.assertEqual(done.stdout, "")
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        self.assertIn("no usable display", done.stderr)

    def test_wrong_usage_and_wrong_scripts(self):
        self.assertEqual(run("view", "--no-such-option").returncode, 2)
        self.assertEqual(run("view", "--script", os.path.join(driver.folder, "none.txt")).returncode, 3)
        with open(os.path.join(driver.folder, "wrong.txt"), "w") as file:
            file.write("frames 1\nfly away\n")
        done = run("view", "--script", file.name)
        self.assertEqual(done.returncode, 2)
        self.assertIn("wrong.txt:2: no such line: fly", done.stderr)

    def wrong_line(self, line, *why, before=""):
        name = os.path.join(driver.folder, "wrong.txt")
        with open(name, "w") as file:
            file.write(f"{before}{line}\n")
        done = run("view", mesh("torus", 500), "--size", "320x200", "--script", name)
        self.assertEqual((done.returncode, done.stdout), (2, ""), line)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        for text in (f"wrong.txt:{before.count(chr(10)) + 1}: ", *why):
            self.assertIn(text, done.stderr, line)

    def test_invalid_script_lines(self):
        """Unknown words and numbers out of range are errors."""
        self.wrong_line("set path mesh", "mesh shaders", before="frames 1\n")  # the device has no mesh shaders
        for line in ("set warts yes", "set samples 4", "set samples 1.5", "set divider 1.1", "set k -5", "set k nan",
                     "set passes 2x", "set color red", "set view", "set view smooth flat", "wait dinner", "frames", "frames 1e99",
                     "frames 2 3", "resize 0 5", "move inf 2", "click 1 2 both", "drag 1 2 3 4 left now", "key %", "key a alt",
                     "open a b", "minimize now", "ray 1", "camera --up=+Z", "camera --no-such 1"):
            self.wrong_line(line)

    def test_a_script_ends_with_its_last_line(self):
        name = os.path.join(driver.folder, "ends.txt")
        with open(name, "w") as file:
            file.write("wait mesh\nprint\n")
        done = run("view", mesh("torus", 500), "--size", "320x200", "--script", name, timeout=60)
        self.assertEqual((done.returncode, done.stderr, len(done.stdout.splitlines())), (0, "", 1))

    def test_a_script_from_standard_input(self):
        done = subprocess.run([driver.program, "view", mesh("torus", 500), "--size", "320x200", "--script", "-"], text=True,
                              input="wait mesh\nprint\nset k 0\n", capture_output=True, cwd=driver.folder, timeout=120,
                              env=dict(os.environ, DISPLAY=driver.display, XDG_STATE_HOME=driver.folder))
        self.assertEqual(done.returncode, 2)
        self.assertEqual(len(done.stdout.splitlines()), 1)
        self.assertIn("standard input:3: k is a whole number", done.stderr)

    def test_screenshots_are_what_render_draws(self):
        blob = mesh("blob", 3000)
        views = ["smooth", "flat", "class", "ring", "wire", "offsets", "seams", "material"]
        script = ["set panels off", "set ring-line off", "wait tables", "set passes 0", "wait settled", "drag 200 150 260 170", "scroll 250 140 2", "drag 200 150 190 120 middle", "print"]
        for view in views:
            script += [f"set view {view}", f"screenshot {driver.folder}/{view}.png"]
        script += ["set view silhouette", f"screenshot {driver.folder}/silhouette.png"]
        camera = self.view("\n".join(script), blob)[0]["camera"].split()
        for view in views:
            done = run("render", blob, "-o", os.path.join(driver.folder, "r.png"), "--size", "480x320", "--samples", "3",
                       "--view", view, "--seeds", "1", *camera)
            self.assertEqual(done.returncode, 0, done.stderr)
            pixels, largest = png.differences(png.read(f"{driver.folder}/{view}.png"), png.read(f"{driver.folder}/r.png"))
            # The background is computed by the device in one picture and by the CPU in the other.
            self.assertLessEqual(largest, 1, view)
            self.assertLessEqual(pixels, 480 * 320 // 20, view)
        # The silhouette view has lines that the smooth view does not.
        smooth, lines = (png.read(f"{driver.folder}/{view}.png") for view in ("smooth", "silhouette"))
        self.assertGreater(png.differences(smooth, lines)[0], 500)

    def test_split_screen_shows_one_picture(self):
        blob = mesh("blob", 3000)
        states = self.view(f"""set panels off
            wait optimized
            screenshot {driver.folder}/single.png
            set mode split
            set divider 0.4
            screenshot {driver.folder}/split.png
            print
            set source packed
            wait settled
            screenshot {driver.folder}/split2.png
            print
            set mode difference
            wait settled
            print""", blob)
        for state in states:
            self.assertEqual(state["difference"]["pixels"], 0)
            self.assertEqual(state["difference"]["triangles"], 0)
            self.assertGreater(state["difference"]["covered"], 10000)
        single = png.read(f"{driver.folder}/single.png")
        self.assertEqual(png.differences(single, png.read(f"{driver.folder}/split.png")), (0, 0))
        self.assertEqual(png.differences(single, png.read(f"{driver.folder}/split2.png")), (0, 0))

    def test_clicks_hit_what_rays_hit(self):
        random.seed(7)
        script = ["set panels off", "set samples 1", "set ring-line off", "wait tables", "wait settled"]
        for _ in range(1000):
            x, y = random.randrange(100, 380), random.randrange(20, 300)
            script += [f"click {x} {y}", f"ray {x} {y}"]
        script += ["print"]
        lines = self.view("\n".join(script), mesh("blob", 3000))
        hits = [line for line in lines if "ray" in line]
        self.assertEqual(len(hits), 1000)
        self.assertGreater(sum(line["selected"] >= 0 for line in hits), 300)
        self.assertEqual([line for line in hits if line["selected"] != line["ray"]], [])

    def test_operators_of_a_selection(self):
        script = ["set panels off", "wait tables", "wait settled", "click 240 160"]
        for key in "nposlrsolrno":
            script += [f"key {key}", "frames 1", "print"]
        for kind in ("blob", "terrain"):
            states = self.view("\n".join(script), mesh(kind, 2000))
            for state, after, key in zip(states, states[1:], "poslrsolrno"):
                for by_lr, by_table in state["operators"].values():
                    self.assertEqual(by_lr, by_table)
                expected = state["operators"][key][1]
                self.assertEqual(after["corner"], state["corner"] if expected == 0xffffffff else expected)

    def test_bad_files_change_nothing(self):
        torus, sphere = mesh("torus", 500), mesh("sphere", 600)
        bad = []
        for i in range(19):
            bad.append(os.path.join(driver.folder, f"bad{i}.ply"))
            with open(bad[-1], "wb") as file:
                file.write([b"", b"ply\nformat ascii 1.0\nelement vertex 3\n", os.urandom(200)][i % 3])
        states = self.view(f"""wait optimized
            print
            drop {bad[0]}
            wait error
            screenshot {driver.folder}/notice.png now
            print
            drop {' '.join(bad)}
            frames 40
            wait error
            print
            drop {' '.join(bad)} {sphere}
            frames 300
            wait optimized
            print""", torus)
        self.assertEqual([state["file"] for state in states[:3]], [torus] * 3)
        # After `wait error` the picture has the notice: red, in the middle, below the legend.
        red, green, blue = png.read(f"{driver.folder}/notice.png")[2][45][3 * 240:3 * 241]
        self.assertGreater(red, 2 * max(green, blue))
        self.assertEqual(states[0]["error"], "")
        self.assertIn("bad0.ply: ", states[1]["error"])
        self.assertEqual(len(states[1]["error"].splitlines()), 1)
        self.assertNotEqual(states[2]["error"], "")
        self.assertEqual((states[3]["file"], states[3]["error"]), (sphere, ""))

    def test_resizing_and_minimizing(self):
        states = self.view("""wait optimized
            resize 700 500
            print
            minimize
            frames 5
            restore
            frames 3
            resize 321 203
            frames 2
            print
            resize 1000 900
            resize 400 300
            frames 2
            print""", mesh("torus", 500))
        self.assertEqual([state["size"] for state in states], [[700, 500], [321, 203], [400, 300]])

    def test_another_ring(self):
        states = self.view("""wait optimized
            print
            set passes 0
            wait settled
            print
            set ring hybrid
            set k 8
            wait settled
            print
            set seeds 4
            set warts off
            wait settled
            print""", mesh("blob", 3000))
        t0 = [state["t0"] for state in states]
        self.assertLess(t0[0], t0[1])
        self.assertEqual(len(set(t0)), 4, t0)
        for state in states:
            self.assertLess(state["seconds"], 5)

    def test_closing_while_it_encodes(self):
        big = mesh("blob", 300000)
        for before in ("frames 1", "wait mesh", "wait mesh\nset passes 500\nframes 5"):
            begun = time.monotonic()
            self.view(before, big)
            self.assertLess(time.monotonic() - begun, 30)

    def test_panels_help_and_every_path(self):
        states = self.view(f"""wait ready
            set help on
            frames 2
            key escape
            key tab
            key tab
            key v
            key x
            key d
            key d
            set path pull
            frames 2
            set path geometry
            set source packed
            set samples 2
            wait settled
            set paint corridors
            frames 2
            set paint blocks
            frames 2
            set outlines on
            frames 2
            key g
            frames 5
            set paint none
            set turntable on
            frames 5
            set turntable off
            key 7
            key home
            wait settled
            print""", mesh("blob", 3000), "--scale", "2", size="1280x800")
        self.assertEqual(states[0]["error"], "")
        self.assertIn("packed", states[0]["formats"])

    def test_the_ring_lies_over_the_surface_from_the_start(self):
        blob = mesh("blob", 3000)
        states = self.view(f"""set panels off
            wait optimized
            screenshot {driver.folder}/ring-on.png
            print
            key e
            screenshot {driver.folder}/ring-off.png
            print
            set view class
            wait settled
            print
            set samples 1
            wait settled
            print""", blob)
        self.assertEqual([state["ring_line"] for state in states], [True, False, False, False])
        self.assertEqual([state["choices"]["ring-line"] for state in states], ["on", "off", "off", "off"])
        self.assertEqual([state["samples"] for state in states], [3, 3, 3, 1])
        on, off = (png.read(f"{driver.folder}/ring-{name}.png") for name in ("on", "off"))
        self.assertGreater(png.differences(on, off)[0], 3000)
        darker = sum(sum(a) < sum(b) for a, b in zip(on[2], off[2]))
        self.assertGreater(darker, 150)  # differing rows of pixels

    def globe(self):
        """A textured mesh with seams, without the -0 of its file, which would cause a notice."""
        path = os.path.join(driver.folder, "globe.glb")
        with open(os.path.join(ASSETS, "globe.glb"), "rb") as file:
            data = file.read()
        with open(path, "wb") as file:
            file.write(data.replace(b"\0\0\0\x80", b"\0\0\0\0"))
        return path

    def test_materials_are_seen_at_first(self):
        globe = self.globe()
        states = self.view(f"wait optimized\nprint\nopen {mesh('torus', 500)}\nwait optimized\nprint\n"
                           f"set view flat\nopen {globe}\nwait optimized\nprint", globe)
        self.assertEqual([state["choices"]["view"] for state in states], ["material", "smooth", "flat"])

    def test_counts_are_those_of_info(self):
        globe = self.globe()
        for path in (globe, mesh("terrain", 400), mesh("genus", 600)):
            state, = self.view("wait optimized\nprint", path)
            info = json.loads(run("info", path, "--json").stdout)
            self.assertEqual([state[name] for name in ("triangles", "components", "borders", "genus")],
                             [info[name] for name in ("triangles", "components", "border_loops", "genus")])
            self.assertEqual(state["copies"], info["copies"] if info["seam_edges"] else 0)
            self.assertGreaterEqual(state["rings"], state["components"])

    def test_welding_reads_the_file_again(self):
        globe = self.globe()
        states = self.view("""wait optimized
            print
            set weld none
            wait optimized
            print
            set weld position
            wait optimized
            print""", globe)
        self.assertGreater(states[0]["copies"], 0)
        self.assertEqual(states[1]["copies"], 0)
        self.assertEqual(states[0]["copies"], states[2]["copies"])
        self.assertEqual(len({state["camera"] for state in states}), 1)

    def test_a_selection_that_its_panel_would_cover_is_moved(self):
        states = self.view("""wait ready
            click 640 540
            frames 12
            wait settled
            print
            key escape
            click 640 300
            wait settled
            print""", mesh("sphere", 600), size="1280x720")
        legend, box = ({panel["name"]: panel["box"] for panel in states[0]["panels"]}[name] for name in ("legend", "selection"))
        self.assertLessEqual(legend[1] + legend[3], 60)
        self.assertGreater(540, box[1])  # the panel would cover it
        self.assertEqual(states[0]["camera"] != states[1]["camera"], False)  # a visible selection does not move the camera

    def test_screenshot_option(self):
        name = os.path.join(driver.folder, "option.png")
        done = run("view", mesh("torus", 500), "--screenshot", name, "--size", "400x300", "--no-panels", "--validation")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(png.read(name)[:2], (400, 300))
        done = run("view", os.path.join(driver.folder, "none.ply"), "--screenshot", name, "--size", "400x300")
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1)


if __name__ == "__main__":
    driver.main()
