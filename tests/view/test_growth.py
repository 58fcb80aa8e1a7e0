#!/usr/bin/env python3
"""Tests the viewer's growing ring, turntable pictures and limit of pictures, by scripts in a window of Xvfb.
Usage: test_growth.py LACEDRING"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import driver
import png
from driver import mesh, run

# Lighting keeps the ratios of red, green and blue of these colors (shaders/viewer/compose_shared.h).
ORANGE, YELLOW, CREAM, GRAY, BLUE, BLACK = (222, 112, 48), (255, 214, 60), (247, 234, 200), (168, 172, 180), \
    (24, 96, 220), (24, 24, 28)


def nearest(pixel):
    """The color of a lit pixel; None if it is too dark."""
    r, g, b = pixel
    if max(pixel) < 60:
        return None
    shares = [channel / max(pixel) for channel in pixel]
    return min((ORANGE, YELLOW, CREAM, GRAY, BLUE),
               key=lambda color: sum((s - c / max(color)) ** 2 for s, c in zip(shares, color)))


def counts(name, background):
    """Counts pixels by color where the picture differs from the background."""
    out = {}
    picture = png.read(name)
    for row, behind in zip(picture[2], background[2]):
        for i in range(0, len(row), 3):
            pixel = tuple(row[i:i + 3])
            if pixel == tuple(behind[i:i + 3]):
                continue
            color = nearest(pixel)
            out[color] = out.get(color, 0) + 1
    return out


class Growth(driver.Scripted):
    def background(self):
        """The picture without a mesh."""
        name = os.path.join(driver.folder, "background.png")
        self.view(f"set panels off\nframes 3\nscreenshot {name}")
        return png.read(name)

    def shots(self, model, stages, *lines):
        script = ["set panels off", "wait optimized", "set passes 0", "wait settled", *lines, "set speed 30", "set paint growth"]
        for stage in stages:
            script += [f"set growth {stage}", f"screenshot {driver.folder}/growth-{stage}.png", "print"]
        return self.view("\n".join(script), model)

    def test_colors_follow_the_expander(self):
        behind = self.background()
        states = self.shots(mesh("torus", 500), (0, 1, 60, 1000000))
        _, end = states[0]["growth"]
        self.assertEqual(end, 248)  # a ring of 250 vertices has 248 steps
        seen = [counts(f"{driver.folder}/growth-{stage}.png", behind) for stage in (0, 1, 60, 1000000)]
        gray = [each.get(GRAY, 0) for each in seen]
        orange = [each.get(ORANGE, 0) for each in seen]
        # Nothing is settled at first, and everything at last.
        self.assertGreater(gray[0], 10000)
        self.assertEqual([seen[0].get(c, 0) for c in (ORANGE, YELLOW, CREAM, BLUE)], [0, 0, 0, 0])
        self.assertGreater(gray[0], gray[2])
        self.assertGreater(gray[2], gray[3])
        self.assertLess(orange[2], orange[3])
        self.assertGreater(seen[2].get(BLUE, 0), 30)
        self.assertLess(seen[3].get(BLUE, 0), 30)  # no front at the end
        # Each side is about half of the surface.
        self.assertGreater(seen[3][ORANGE] + seen[3].get(YELLOW, 0), seen[3][CREAM] // 2)
        self.assertGreater(seen[3][CREAM], (seen[3][ORANGE] + seen[3].get(YELLOW, 0)) // 2)

    def test_another_seed_grows_elsewhere(self):
        blob = mesh("blob", 3000)
        pictures = []
        for lines in ((), ("set seeds 40", "wait settled"), ("set seeds 40", "set seed 5", "wait settled"),
                      ("set ring hybrid", "set k 1", "wait settled")):
            self.shots(blob, (300,), *lines)
            pictures.append(png.read(f"{driver.folder}/growth-300.png"))
        for i in range(len(pictures)):
            for j in range(i):
                self.assertGreater(png.differences(pictures[i], pictures[j])[0], 500, (i, j))

    def test_the_ring_begins_at_the_selected_corner(self):
        states = self.view("""set panels off
            wait ready
            set passes 0
            wait settled
            key b
            frames 2
            print
            click 240 160
            key b
            wait settled
            print
            key g
            set growth 1
            wait settled
            click 240 160
            print
            key escape
            key b
            wait settled
            print""", mesh("blob", 3000))
        self.assertEqual([state["start"] for state in states], [None, states[1]["corner"], states[1]["corner"], None])
        self.assertEqual(states[0]["t0"], states[3]["t0"])
        self.assertNotEqual(states[0]["t0"], states[1]["t0"])

    def test_growing_restarts_with_another_seed_and_stays_where_it_stands_still(self):
        states = self.view("""wait optimized
            set passes 0
            wait settled
            set speed 60
            key g
            frames 20
            print
            set seeds 8
            wait optimized
            set speed 100000
            wait settled
            print
            set growth 77
            set seeds 3
            wait settled
            print
            set seed 2
            wait settled
            print
            set passes 2
            wait settled
            print""", mesh("blob", 1000))
        self.assertGreater(states[0]["growth"][0], 10)
        self.assertLess(states[0]["growth"][0], 30)
        self.assertEqual(states[1]["growth"][0], states[1]["growth"][1])
        self.assertEqual([state["growth"][0] for state in states[2:]], [77, 77, 77])

    def test_each_paint_and_selection_changes_the_picture(self):
        blob = mesh("blob", 3000)
        names = [f"{driver.folder}/paint-{i}.png" for i in range(6)]
        self.view(f"""set panels off
            wait tables
            wait settled
            screenshot {names[0]}
            click 240 160
            screenshot {names[1]}
            set paint corridors
            screenshot {names[2]}
            key escape
            screenshot {names[3]}
            set paint growth
            set growth 100
            screenshot {names[4]}
            set paint none
            screenshot {names[5]}""", blob)
        pictures = [png.read(name) for name in names]
        self.assertEqual(png.differences(pictures[0], pictures[5]), (0, 0))
        for i in range(5):
            self.assertGreater(png.differences(pictures[i], pictures[i + 1])[0], 20, i)

    def test_turntable_pictures(self):
        blob = mesh("blob", 3000)
        folder = os.path.join(driver.folder, "turn")
        states = self.view(f"""wait optimized
            set passes 0
            wait settled
            print
            set ring-line off
            turntable-png {folder} 8
            print
            set panels off
            wait settled
            screenshot {driver.folder}/panelless.png""", blob)
        self.assertEqual(states[0]["camera"], states[1]["camera"])
        self.assertEqual(sorted(os.listdir(folder)), [f"{i:03}.png" for i in range(8)])
        pictures = [png.read(os.path.join(folder, f"{i:03}.png")) for i in range(8)]
        self.assertEqual(png.differences(pictures[0], png.read(f"{driver.folder}/panelless.png")), (0, 0))
        for i in range(8):
            self.assertGreater(png.differences(pictures[i], pictures[(i + 1) % 8])[0], 1000)
        rendered = os.path.join(driver.folder, "quarter.png")
        done = run("render", blob, "-o", rendered, "--size", "480x320", "--samples", "3", "--seeds", "1", "--optimize", "0",
                   "--camera-azimuth-angle", "90", *states[0]["camera"].split())
        self.assertEqual(done.returncode, 0, done.stderr)
        pixels, largest = png.differences(pictures[2], png.read(rendered))
        self.assertLessEqual(largest, 1)  # only the background differs, as in test_view.py
        self.assertLessEqual(pixels, 480 * 320 // 20)

    def test_turntable_that_is_stopped(self):
        states = self.view("""wait optimized
            set passes 0
            wait settled
            print
            key t shift
            frames 6
            key escape
            frames 2
            print""", mesh("torus", 500))
        self.assertIn("stopped: ", states[1]["note"])
        self.assertIn(" of 90 pictures in turntable-1", states[1]["note"])
        written = os.listdir(os.path.join(driver.folder, "turntable-1"))
        self.assertTrue(3 <= len(written) <= 9, written)
        self.assertEqual(states[0]["camera"], states[1]["camera"])
        for name in written:
            self.assertEqual(png.read(os.path.join(driver.folder, "turntable-1", name))[:2], (480, 320))

    def test_turntable_where_nothing_can_be_written(self):
        torus = mesh("torus", 500)
        blocked = os.path.join(driver.folder, "blocked")
        os.makedirs(os.path.join(blocked, "001.png"))
        for folder, why in ((os.path.join(torus, "below"), torus), (blocked, "001.png")):
            with open(os.path.join(driver.folder, "blocked.txt"), "w") as file:
                file.write(f"wait settled\nturntable-png {folder} 3\nclose\n")
            done = run("view", torus, "--size", "320x200", "--script", file.name)
            self.assertEqual(done.returncode, 3, done.stderr)
            self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
            self.assertIn(why, done.stderr)
        for line in ("turntable-png", "turntable-png x 0", "turntable-png x y"):
            with open(os.path.join(driver.folder, "wrong.txt"), "w") as file:
                file.write(line + "\n")
            self.assertEqual(run("view", torus, "--script", file.name).returncode, 2, line)

    def test_cap_of_pictures(self):
        torus = mesh("torus", 500)
        states = self.view("print\nset fps 120\nprint\nset fps 0\nprint", torus, "--fps", "30")
        self.assertEqual([state["fps"] for state in states], [30, 120, 0])
        self.assertEqual(self.view("print", torus)[0]["fps"], 60)
        self.assertEqual(run("view", "--fps", "-1").returncode, 2)


if __name__ == "__main__":
    driver.main()
