#!/usr/bin/env python3
"""test_hubs.py LACEDRING: vertices with very many triangles, many triangles at one position, huge coordinates. Baselines that
would take quadratic time are absent with the reason; nothing hangs or fails."""

from cli_support import CliTest, in_parallel, main, run

import mesh_writers as write

ORDERS = {"strip_restart", "strip_degenerate", "meshopt_index_codec", "meshlets"}
REASON = "quadratic in a vertex's triangles"


def points(count, scale=1.0):
    return [(scale * (i % 101), scale * (i * i % 103), scale * (i % 7)) for i in range(count)]


def shape(kind, n):
    """Points and triangles of a fan, triangles around one edge, one triangle n times, or separate triangles at one position."""
    if kind == "fan":
        return points(n + 2), [(0, i + 1, i + 2) for i in range(n)]
    if kind == "book":
        return points(n + 2), [(0, 1, i + 2) if i % 2 else (1, 0, i + 2) for i in range(n)]
    if kind == "same":
        return points(3), [(0, 1, 2)] * n
    return [((0, 0, 0), (1, 0, 0), (0, 1, 0))[i % 3] for i in range(3 * n)], [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(n)]


class Hubs(CliTest):
    def make(self, kind, n):
        return self.write(f"{kind}-{n}.ply", write.ply(*shape(kind, n)))

    def no_gpu(self, command):
        return ["--no-gpu"] if "--no-gpu" in run(command, "--help").out else []

    def check_stats(self, source):
        mesh = self.json("stats", source, "--json")["meshes"][0]
        self.assertEqual(set(mesh["absent"]), ORDERS)
        for name, reason in mesh["absent"].items():
            self.assertIn(REASON, reason, name)
        self.assertIsNone(mesh["best_order"])
        self.assertLessEqual({"lean", "lr", "lr_compact", "packed", "packed_cache", "winged_edge", "squad"},
                             set(mesh["formats"]))
        text = self.ok("stats", source).out
        self.assertRegex(text, rf"meshlets +absent: .*{REASON}")
        self.assertNotIn("best order", text)
        row = self.ok("stats", source, "--table", "packed").out.splitlines()[2]
        self.assertIn(" - |", row)

    def check_verify(self, source):
        verdict = self.json("verify", source, "--json")
        self.assertEqual(set(verdict["absent"]), ORDERS)
        self.assertTrue(all(entry["ok"] for entry in verdict["formats"].values()), verdict)
        self.assertIn("absent: ", self.ok("verify", source).out)

    def check_report(self, source):
        page = source + ".html"
        self.ok("report", source, "-o", page, "--no-gpu")
        with open(page, encoding="utf-8") as file:
            self.assertIn("absent: meshoptimizer takes time quadratic", file.read())

    def test_quadratic_baselines_are_absent_with_the_reason(self):
        sources = [self.make(kind, 4000) for kind in ("fan", "book", "same")]
        for check in (self.check_stats, self.check_verify, self.check_report):
            in_parallel(check, sources)

    def test_bench(self):
        mesh = self.json("bench", self.make("fan", 4000), "--rounds", "1", "--operators", "--json",
                         *self.no_gpu("bench"))["meshes"][0]
        self.assertNotIn("strips", mesh["construct"])
        self.assertNotIn("meshopt_index_codec", mesh["decode_cpu"])
        self.assertIsNone(mesh["construct_ratio"]["strips_over_lean"])
        self.assertLessEqual({"strips", "meshopt_index_codec", "squad_operators"}, set(mesh["absent"]))
        self.assertEqual(set(mesh["operators"]), {"corner_table", "winged_edge", "lr", "lr_compact"})
        self.assertIn("strips absent: ", self.ok("bench", self.make("same", 4000), "--rounds", "1", *self.no_gpu("bench")).out)

    def test_many_triangles_at_one_position(self):
        mesh = self.json("stats", self.make("pile", 4000), "--no-weld", "--json")["meshes"][0]
        self.assertEqual(set(mesh["absent"]), {"meshlets"})
        self.assertIn("at one place, and 4000 are", mesh["absent"]["meshlets"])
        self.assertIsNotNone(mesh["best_order"])

    def test_ordinary_meshes_have_all_baselines(self):
        for kind in ("blob", "soup", "parts"):
            mesh = self.json("stats", self.generate(kind, 20000), "--json")["meshes"][0]
            self.assertEqual(mesh["absent"], {}, kind)
            self.assertGreater(mesh["best_order"]["acmr_fifo32"], 0.5)
        self.assertEqual(self.json("verify", self.generate("blob", 20000), "--json")["absent"], {})

    def test_hundred_thousand_triangles_take_seconds(self):
        """A hundred thousand triangles take seconds; quadratic work would take minutes."""
        n = 100000
        for kind in ("fan", "book", "same"):
            source = self.make(kind, n)
            self.ok("stats", source)
            self.ok("verify", source)
        fan = self.make("fan", n)
        self.assertIn("Draco takes time quadratic", self.ok("stats", "--table", "total", fan).out)
        self.ok("bench", "--no-gpu", "--rounds", "1", fan)

    def test_large_coordinates(self):
        for scale in (1e10, 1e20, 1e30):
            grid = [(scale * x, scale * y, scale * (x * y % 5)) for y in range(21) for x in range(21)]
            faces = []
            for y in range(20):
                for x in range(20):
                    v = 21 * y + x
                    faces += [(v, v + 1, v + 22), (v, v + 22, v + 21)]
            source = self.write(f"large-{scale:g}.ply", write.ply(grid, faces))
            verdict = self.json("verify", source, "--json")
            self.assertIn("meshlets", verdict["formats"])
            self.assertTrue(all(entry["ok"] for entry in verdict["formats"].values()), verdict)
        source = self.write("double.ply", write.ply([(3e38, 0, 0), (0, -3e38, 0), (0, 0, 3e38), (0, 0, 0)],
                                                    [(0, 1, 2), (0, 2, 3)], real="double"))
        self.ok("verify", source)


if __name__ == "__main__":
    main()
