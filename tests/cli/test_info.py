"""lacedring info: its report on meshes of known topology and volume."""

from cli_support import CliTest, main

import mesh_writers as write

CUBE = [(i & 1, i >> 1 & 1, i >> 2 & 1) for i in range(8)]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
# The contract of the JSON: names may be added, but not removed.
NAMES = {"schema", "file", "triangles", "vertices", "unused_vertices", "components", "shells", "border_edges", "border_loops",
         "nonmanifold_edges", "nonmanifold_vertices", "degenerate_dropped", "flipped", "cut_edges", "orientable", "closed",
         "euler_characteristic", "genus", "handles", "valence6_percent", "max_valence", "smesh", "smesh_reason",
         "closed_shells", "inside_out_shells", "flat_shells", "volume", "attributes"}


def turned(faces):
    return [f[::-1] for f in faces]


def moved(points, by):
    return [tuple(x + by for x in p) for p in points]


class Info(CliTest):
    def info(self, points, faces, **expected):
        """Checks entries of the JSON report, and that the text has the same numbers."""
        source = self.write("a.ply", write.ply(points, faces, real="double"))
        report = self.json("info", source, "--json")
        self.assertEqual(NAMES - set(report), set())
        self.assertEqual({name: report[name] for name in expected}, expected)
        self.assertEqual(report["smesh"], report["smesh_reason"] == "")
        text = self.ok("info", source).out
        lines = {line[2:24].strip(): line[25:] for line in text.splitlines()[1:]}
        self.assertEqual(lines["smesh"][:3], "yes" if report["smesh"] else "no:")
        self.assertIn(report["smesh_reason"], lines["smesh"])
        return lines

    def test_cube(self):
        lines = self.info(CUBE, QUADS, smesh=True, orientable=True, closed=True, volume=1.0, inside_out_shells=0,
                          closed_shells=1, handles=0, border_loops=0, euler_characteristic=2)
        self.assertEqual(lines["volume"], "1")

    def test_inside_out(self):
        lines = self.info(CUBE, turned(QUADS), smesh=False, smesh_reason="clockwise, that is inside out", volume=-1.0,
                          inside_out_shells=1, flipped=0)
        self.assertEqual(lines["volume"], "-1; 1 inside out, or hollows")

    def test_one_face_turned(self):
        self.info(CUBE, turned(QUADS[:1]) + QUADS[1:], smesh=True, volume=1.0, flipped=2)

    def test_hollow(self):
        inner = [tuple(0.25 + 0.5 * x for x in p) for p in CUBE]
        faces = QUADS + [tuple(8 + v for v in f) for f in turned(QUADS)]
        self.info(CUBE + inner, faces, smesh=False, smesh_reason="2 shells", volume=0.875, inside_out_shells=1, closed=True)

    def test_doubles_far_away(self):
        # 2^40 + 1/8 is not a float.
        small = [tuple(0.125 * x for x in p) for p in CUBE]
        self.info(moved(small, 2.0 ** 40), QUADS, smesh=True, volume=0.125 ** 3)

    def test_open(self):
        lines = self.info(CUBE, QUADS[1:], smesh=False, smesh_reason="4 border edges in 1 loop", volume=None, closed=False,
                          closed_shells=0, handles=0)
        self.assertEqual(lines["volume"], "none: no piece of surface is closed")

    def test_one_of_two_is_closed(self):
        lines = self.info(CUBE + moved(CUBE, 2), QUADS + [tuple(8 + v for v in f) for f in QUADS[1:]], smesh=False,
                          volume=None, closed_shells=1, shells=2)
        self.assertEqual(lines["volume"], "none: not all pieces of surface are closed; 1 closed")

    def test_flat(self):
        self.info(CUBE[:3], [(0, 1, 2), (2, 1, 0)], smesh=False, smesh_reason="flat: it bounds no volume", volume=0.0,
                  flat_shells=1)

    def test_moebius(self):
        strip = [(i, (i + 1) % 5, (i + 2) % 5) for i in range(5)]
        self.info(CUBE[:5], strip, smesh=False, orientable=False, handles=None, volume=None)

    def test_no_triangles(self):
        self.info(CUBE, [(0, 0, 1)], smesh=False, smesh_reason="no triangles", volume=None, closed_shells=0)

    def test_volume_of_the_largest(self):
        self.info([tuple(2.0 ** 120 * x for x in p) for p in CUBE], QUADS, volume=2.0 ** 360, closed=True)

    def test_generated(self):
        for kind, smesh, handles in (("sphere", True, 0), ("blob", True, 0), ("torus", False, 1), ("genus", False, 5)):
            report = self.json("info", self.generate(kind, 3000, 3), "--json")
            self.assertEqual((report["smesh"], report["handles"]), (smesh, handles), kind)
            self.assertGreater(report["volume"], 0)


if __name__ == "__main__":
    main()
