#!/usr/bin/env python3
"""test_tables.py LACEDRING: stats --table, the paper's tables as Markdown and in the JSON."""

import os

from cli_support import CliTest, WRONG_USAGE, main

TABLES = {"packed": 11, "table1": 16, "lean": 10, "storage": 10, "seeds": 13}  # columns


def table_of(text):
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line]
    return rows[0], rows[2:]


class Tables(CliTest):
    def test_one_row_per_mesh(self):
        paths = [self.generate(kind, 2000, 2) for kind in ("blob", "parts", "soup")]
        for table, columns in TABLES.items():
            with self.subTest(table):
                head, rows = table_of(self.ok("stats", "--table", table, *paths).out)
                self.assertEqual(len(head), columns)
                self.assertEqual({len(row) for row in rows}, {columns})
                names = [os.path.splitext(os.path.basename(path))[0] for path in paths]
                self.assertEqual([row[0] for row in rows], names + (["mean"] if table == "seeds" else ["mean", "median"]))
                _, alone = table_of(self.ok("stats", "--table", table, paths[0]).out)
                self.assertEqual(len(alone), 1)
        self.fails("stats", paths[0], "--table", "table2", codes=(WRONG_USAGE,))

    def test_tables_equal_the_json(self):
        path = self.generate("blob", 5000, 3)
        mesh = self.json("stats", "--paper", path, "--json")["meshes"][0]
        head, (row,) = table_of(self.ok("stats", "--paper", "--table", "table1", path).out)
        n, formats, compact = mesh["triangles"], mesh["formats"], mesh["lr_compact_ring"]
        self.assertEqual(float(row[1]), n)
        self.assertEqual(row[3], str(mesh["lr_ring"]["isolated"]))
        self.assertEqual(row[4], f"{100 * mesh['lr_ring']['t0'] / n:.2f}")
        self.assertEqual(row[7], f"{formats['lr']['references_per_triangle']:.3f}")
        self.assertEqual(row[9], str(formats["lr_compact"]["k"]))
        self.assertEqual(row[13], f"{100 * compact['long'] / n:.2f}")
        self.assertEqual(row[15], f"{formats['lr_compact']['bits_per_triangle']:.2f}")
        # Section 8: 32 (m_r + 6 n_0 + 3 n_i + n_l + m_i) bits, and the header.
        words = (mesh["vertices"] - compact["isolated"] + 6 * compact["t0"] + 3 * compact["irregular"] + compact["long"] +
                 compact["isolated"])
        self.assertEqual(formats["lr_compact"]["bytes"], 40 + 4 * words)

    def test_offsets(self):
        path = self.generate("blob", 5000, 3)
        mesh = self.json("stats", path, "--table", "offsets", "--json")["meshes"][0]
        self.assertEqual([entry["k"] for entry in mesh["by_period"]], [1, 32, None])
        for entry in mesh["by_period"]:
            self.assertEqual(sum(entry["offset_bits"]) + entry["tip_isolated"] + entry["t0"], mesh["triangles"])
        head, rows = table_of(self.ok("stats", path, "--table", "offsets").out)
        self.assertEqual(head[1:], ["k = 1", "k = 32", "k = inf"])
        for column in (1, 2, 3):
            self.assertAlmostEqual(sum(float(row[column]) for row in rows), 100, delta=0.1)

    def test_periods(self):
        path = self.generate("terrain", 3000, 3)
        mesh = self.json("stats", path, "--table", "periods", "--seeds", "1", "--ring", "expander", "--json")["meshes"][0]
        self.assertEqual(mesh["by_period"][0]["k"], 1)
        depth_first = mesh["by_period"][-1]
        self.assertIsNone(depth_first["k"])
        for name in ("lean", "lr"):
            self.assertAlmostEqual(depth_first[f"{name}_references_per_triangle"],
                                   mesh["formats"][name]["references_per_triangle"])
        self.assertAlmostEqual(depth_first["lean_acmr_fifo32"], mesh["formats"]["lean"]["acmr_fifo32"])
        head, rows = table_of(self.ok("stats", path, "--table", "periods").out)
        self.assertEqual([row[0] for row in rows],
                         ["1", "2", "4", "8", "16", "32", "64", "128", "256", "512", "1024", "inf"])
        self.assertEqual({len(row) for row in rows}, {len(head)})

    def test_seeds(self):
        path = self.generate("blob", 3000, 3)
        mesh = self.json("stats", path, "--table", "seeds", "--json")["meshes"][0]
        self.assertEqual([entry["seeds"] for entry in mesh["by_seeds"]], [1, 4, 16, 64])
        references = [entry["lr_references_per_triangle"] for entry in mesh["by_seeds"]]
        self.assertLessEqual(references[-1], references[0])


if __name__ == "__main__":
    main()
