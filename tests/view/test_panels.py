#!/usr/bin/env python3
"""The viewer's panels are inside the window, do not overlap, and cut off no text. Usage: test_panels.py LACEDRING"""

import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import driver
from driver import mesh, run

SIDES = {"choices", "numbers", "bar"}  # panels beside the picture; the others are over it
OVER_ALL = {"help", "error"}
LONG = "/" + "/".join(["a-folder-with-a-long-name"] * 9) + "/no-such-file.ply"


def overlap(a, b):
    return min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0]) > 0.5 and min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1]) > 0.5


class Panels(driver.Scripted):
    def check(self, state, drawer=False):
        """Checks that panels are inside the window, show whole lines and do not overlap. Returns their boxes by name."""
        width, height = state["size"]
        boxes = {}
        for panel in state["panels"]:
            x, y, w, h = panel["box"]
            where = f"{panel} in {width}x{height}"
            self.assertGreaterEqual(min(x, y), 0, where)
            self.assertLessEqual(x + w, width + 0.5, where)
            self.assertLessEqual(y + h, height + 0.5, where)
            self.assertLessEqual(panel["hidden"][0], 1, "clipped on its right: " + where)
            if "/" not in panel["name"]:  # names with / are lists inside a panel
                boxes[panel["name"]] = panel["box"]
        for a in boxes:
            for b in boxes:
                if a < b and not (OVER_ALL & {a, b}):
                    self.assertFalse(overlap(boxes[a], boxes[b]), f"{a} and {b}: {boxes} in {width}x{height}")
        return boxes

    def hidden_below(self, state, name):
        return next(panel["hidden"][1] for panel in state["panels"] if panel["name"] == name)

    def test_everything_fits(self):
        script = ["wait ready", "frames 2", "print"]
        for line in ("set view class", "set view ring", "set view offsets", "set mode split", "set mode difference",
                     "set mode single", "set paint corridors", "set source packed", "set source plain", "set source lean"):
            script += [line, "wait settled", "frames 2", "print"]
        script += ["set paint none", "set view class", "click {middle}", "wait tables", "frames 3", "print"]
        for size, scale in (("1280x720", 1), ("2560x1440", 2)):
            middle = " ".join(str(int(x) // 2) for x in size.split("x"))
            lines = script if scale == 1 else script[:5] + script[-8:]  # shorter, because large pictures take long
            states = self.view("\n".join(lines).replace("{middle}", middle), mesh("sphere", 600), "--scale", str(scale),
                               size=size)
            for state in states:
                boxes = self.check(state)
                self.assertLessEqual(SIDES, set(boxes))
                for name in SIDES:
                    self.assertEqual(self.hidden_below(state, name), 0, f"{name} of {size} needs scrolling")
            self.assertIn("legend", self.check(states[0]))  # the legend of the ring
            self.assertIn("legend", self.check(states[1]))
            self.assertLessEqual({"legend", "selection"}, set(self.check(states[-1])))

    def test_narrow_windows(self):
        script = f"""wait ready
            set view class
            click {{middle}}
            wait tables
            frames 3
            print
            set choices on
            frames 3
            print
            set numbers on
            frames 3
            print
            set numbers off
            set help on
            frames 3
            print
            set help off
            open {LONG}
            frames 20
            wait error
            frames 3
            print"""
        for size in ("640x480", "320x240"):
            width, height = map(int, size.split("x"))
            states = self.view(script.replace("{middle}", f"{width // 2} {height // 2}"), mesh("sphere", 600), size=size)
            names = [set(self.check(state)) for state in states]
            self.assertFalse({"choices", "numbers"} & names[0])
            self.assertIn("selection", names[0])
            self.assertIn("choices", names[1])
            self.assertIn("numbers", names[2])
            self.assertIn("help", names[3])
            self.assertIn("error", names[4])

    def test_without_a_mesh_and_with_a_long_error(self):
        states = self.view(f"""frames 3
            print
            open {LONG}
            frames 20
            wait error
            frames 3
            print""", size="1280x720")
        self.assertEqual(set(self.check(states[0])), SIDES)
        self.assertEqual(set(self.check(states[1])), SIDES | {"error"})

    def test_numbers_are_those_of_stats(self):
        torus = mesh("torus", 600)
        state, = self.view("wait ready\nprint", torus)
        # The numbers are also measured if another ring is requested before.
        again, = self.view("wait mesh\nset passes 3\nwait ready\nprint", torus)
        self.assertEqual(again["formats"], state["formats"])
        stats = json.loads(run("stats", torus, "--json").stdout)["meshes"][0]["formats"]
        self.assertEqual(state["formats"], {name: entry["bytes"] for name, entry in stats.items()})


if __name__ == "__main__":
    driver.main()
