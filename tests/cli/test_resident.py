#!/usr/bin/env python3
"""test_resident.py LACEDRING: `bench --resident`. Tests the paging, which is the same in every run, not the times."""

import os
import resource

from cli_support import BAD_INPUT, WRONG_USAGE, CliTest, main

STRUCTURES = ("corner_table", "squad", "lr", "lr_compact")
OPERATORS = {"vertex", "opposite", "valence", "normal"}
ARGUMENTS = ("--resident", "--rounds", "1", "--sample", "100", "--json")


class Resident(CliTest):
    def setUp(self):
        super().setUp()
        if "--no-gpu" in self.ok("bench", "--help").out:
            self.arguments = (*ARGUMENTS, "--no-gpu")
        else:
            self.arguments = ARGUMENTS

    def measure(self, path, *options):
        return self.json("bench", path, *self.arguments, *options)["meshes"][0]["resident"]

    def cells(self, structure):
        self.assertEqual(set(structure), {"resident_bytes", "scan", "random", "contour"})
        self.assertEqual(set(structure["scan"]), OPERATORS)
        self.assertEqual(set(structure["random"]), OPERATORS)
        return [*structure["scan"].values(), *structure["random"].values(), structure["contour"]]

    def check_structure(self, structure, limit, size, whole):
        """A structure within its limit is read once; a much larger one is paged by the operators that read all of it."""
        self.assertLessEqual(structure["resident_bytes"], limit)
        self.assertEqual(structure["resident_bytes"], min(limit, whole(size)))
        cells = self.cells(structure)
        for cell in cells:
            self.assertGreater(cell["ns_per_op"], 0)
        if size <= limit:
            self.assertEqual([cell["pages_per_op"] for cell in cells], [0] * 9)
        elif 2 * limit < size:
            for kind in ("valence", "normal"):
                self.assertGreater(structure["scan"][kind]["pages_per_op"], 0, kind)
                self.assertGreater(structure["random"][kind]["pages_per_op"], 0, kind)

    def test_levels(self):
        path = self.generate("blob", 20000)
        resident = self.measure(path, "--levels", "1.25,0.5,0.25")
        self.assertEqual(resident["sample"], 100)
        self.assertGreater(resident["contour_triangles"], 100)
        sizes = {name: resident["structures"][name]["bytes"] for name in STRUCTURES}
        self.assertEqual(list(sizes.values()), sorted(sizes.values(), reverse=True))
        page = resident["page_bytes"]
        levels = resident["levels"]
        limits = [level["limit_bytes"] for level in levels]
        self.assertEqual(limits, sorted(set(limits), reverse=True))
        # Three given levels, the sizes of both LR tables, and half of one.
        self.assertEqual(len(limits), 6)
        whole = lambda bytes: -(-bytes // page) * page
        rounded = lambda bytes: max(8 * page, whole(bytes))
        self.assertEqual(limits[0], rounded(int(1.25 * sizes["corner_table"])))
        self.assertEqual(limits[3:5], [rounded(sizes["lr"]), rounded(sizes["lr_compact"])])
        for level in levels:
            limit = level["limit_bytes"]
            self.assertAlmostEqual(level["corner_tables"], limit / sizes["corner_table"])
            self.assertEqual(set(level["structures"]), set(STRUCTURES))
            for name in STRUCTURES:
                with self.subTest(structure=name, limit=limit):
                    self.check_structure(level["structures"][name], limit, sizes[name], whole)

        again = self.measure(path, "--levels", "1.25,0.5,0.25", "--scratch", self.folder)
        self.assertEqual(os.listdir(self.folder), [os.path.basename(path)])  # scratch files are removed
        for one, other in zip(levels, again["levels"]):
            for name in STRUCTURES:
                pages = [[cell["pages_per_op"] for cell in self.cells(level["structures"][name])] for level in (one, other)]
                self.assertEqual(*pages)

    def test_awkward_meshes(self):
        """Borders, non-manifold edges, degenerate triangles. The program compares the structures' results with each other."""
        for kind in ("terrain", "moebius", "soup", "parts"):
            with self.subTest(kind):
                resident = self.measure(self.generate(kind, 2000), "--levels", "0.25")
                self.assertEqual(set(resident["structures"]), set(STRUCTURES))
        one = self.write("one.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 2\n")
        self.assertEqual(self.measure(one)["contour_triangles"], 8)

    def test_errors(self):
        path = self.generate("sphere", 1000)
        self.fails("bench", path, *self.arguments, "--scratch", self.path("missing"), mentions=["missing", "scratch"])
        self.fails("bench", path, *self.arguments, "--scratch", path, mentions=["scratch"])
        small = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))
        self.fails("bench", path, *self.arguments, mentions=["scratch", "large"], preexec_fn=small)
        empty = self.write("empty.obj", b"v 0 0 0\nv 1 0 0\nf 1 2 2\n")
        self.fails("bench", empty, *self.arguments, codes=(BAD_INPUT,))
        self.fails("bench", path, "--scratch", self.folder, codes=(WRONG_USAGE,))
        self.fails("bench", path, *self.arguments, "--levels", "much", codes=(WRONG_USAGE,))
        self.assertEqual(self.json("bench", path, "--rounds", "1", "--json", *self.arguments[5:])["meshes"][0]["resident"], {})


if __name__ == "__main__":
    main()
