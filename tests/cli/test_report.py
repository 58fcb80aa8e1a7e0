#!/usr/bin/env python3
"""test_report.py LACEDRING: the page of `report` is well-formed and self-contained, has the numbers of stats, and a browser shows it."""

import base64
import html
import html.parser
import os
import re
import shutil
import struct
import subprocess
import tempfile
import zlib

import cli_support
from cli_support import BAD_INPUT, CliTest, NO_DEVICE, WRONG_USAGE, main, run

VOID = {"meta", "img", "br", "wbr", "link", "hr", "input"}
SVG_LEAVES = {"line"}  # elements written <line .../>
HOSTILE = "a\"><img src=x onerror=alert(1)>&amp;'\n\u202e\x01 \udcff.ply"  # \udcff is a byte that is no UTF-8
VIEWS = ["The mesh", "The ring and its triangles", "Order along the ring"]


class Page(html.parser.HTMLParser):
    """Checks that tags balance, and collects tags, texts, tables and images."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.problems, self.tags, self.images, self.ids = [], [], [], [], []
        self.tables, self.cell = [], None
        self.text = []
        self.feed(text)
        self.close()
        if self.open:
            self.problems.append(f"never closed: {self.open}")

    def note(self, tag, attributes):
        attributes = dict(attributes)
        self.tags.append((tag, attributes))
        if "id" in attributes:
            self.ids.append(attributes["id"])
        if tag == "img":
            self.images.append(attributes)
        return attributes

    def handle_startendtag(self, tag, attrs):
        self.note(tag, attrs)
        if tag not in SVG_LEAVES:
            self.problems.append(f"<{tag}/>")

    def handle_starttag(self, tag, attrs):
        attributes = self.note(tag, attrs)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "table":
            self.tables.append((attributes.get("class"), []))
        elif tag == "tr":
            self.tables[-1][1].append([])
        elif tag in ("td", "th"):
            self.cell = []

    def handle_endtag(self, tag):
        if not self.open or self.open[-1] != tag:
            self.problems.append(f"</{tag}> in {self.open[-3:]}")
        else:
            self.open.pop()
        if tag in ("td", "th"):
            self.tables[-1][1][-1].append("".join(self.cell).strip())
            self.cell = None

    def handle_data(self, data):
        self.text.append(data)
        if self.cell is not None:
            self.cell.append(data)

    def tables_of(self, kind):
        return [rows for name, rows in self.tables if name == kind]

    def words(self):
        return re.sub(r"\s+", " ", "".join(self.text))


def read_png(data):
    """(width, height, rows of bytes), RGB of 8 bits."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, body, head = 8, b"", None
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        chunk = data[at + 8:at + 8 + size]
        assert zlib.crc32(kind + chunk) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0]
        head = struct.unpack(">IIBBBBB", chunk) if kind == b"IHDR" else head
        body += chunk if kind == b"IDAT" else b""
        at += 12 + size
    width, height, depth, color = head[:4]
    assert depth == 8 and color in (2, 6), head
    step = 3 if color == 2 else 4
    raw, before, rows = zlib.decompress(body), bytes(width * step), []
    for y in range(height):
        line = raw[y * (width * step + 1):(y + 1) * (width * step + 1)]
        row = bytearray(line[1:])
        kind = line[0]
        for i in range(len(row) if kind else 0):
            a, b = (row[i - step] if i >= step else 0), before[i]
            c = before[i - step] if i >= step else 0
            if kind == 4:
                p = a + b - c
                near = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            else:
                near = (0, a, b, (a + b) // 2)[kind]
            row[i] = (row[i] + near) & 255
        rows.append(bytes(row))
        before = row
    return width, height, rows


def colors(png):
    width, height, rows = png
    step = len(rows[0]) // width
    return {row[i:i + 3] for row in rows for i in range(0, len(row), step)}


class Report(CliTest):
    def page(self, *arguments):
        self.ok("report", *arguments, "-o", self.path("out.html"))
        with open(self.path("out.html"), encoding="utf-8") as file:  # must be UTF-8
            text = file.read()
        page = Page(text)
        self.assertEqual(page.problems, [])
        self.assertTrue(text.startswith("<!DOCTYPE html>\n<html lang=\"en\">"))
        self.assertEqual(len(page.ids), len(set(page.ids)), "ids are unique")
        self.check_self_contained(text, page)
        return page

    def check_self_contained(self, text, page):
        style = text[text.index("<style>"):text.index("</style>")]
        for word in ("url(", "@import", "http:", "https:"):
            self.assertNotIn(word, style)
        for tag, attributes in page.tags:
            self.assertNotIn(tag, ("script", "link", "iframe", "object", "embed", "base", "form"))
            for name, value in attributes.items():
                self.assertFalse(name.startswith("on"), f"<{tag} {name}>")
                if name in ("href", "src", "srcset", "data", "xlink:href", "poster", "background", "action"):
                    self.assertRegex(value, r"\A(data:image/png;base64,|#)", f"<{tag} {name}>")
                    if value.startswith("#"):
                        self.assertIn(value[1:], page.ids)
        self.assertNotRegex(text, r"https?:")
        policy = [a["content"] for t, a in page.tags if a.get("http-equiv") == "Content-Security-Policy"]
        self.assertEqual(len(policy), 1)
        self.assertIn("default-src 'none'", policy[0])

    def check_numbers(self, rows, mesh):
        """Compares the size table with stats --json."""
        body = {row[0]: row[1:] for row in rows[1:]}
        self.assertEqual([row[0] for row in rows[1:]], [*mesh["formats"], *mesh["absent"]])
        base = mesh["formats"]["index_u32"]["bytes"]
        for name, entry in mesh["formats"].items():
            with self.subTest(format=name):
                self.check_row(name, body[name], entry, base)
        for name, reason in mesh["absent"].items():
            self.assertEqual(body[name], [f"absent: {reason}"])

    def check_row(self, name, row, entry, base):
        bits, size, references, share, acmr, atvr, deflated, ring, what = row
        self.assertEqual(size, f"{entry['bytes']:,}")
        self.assertEqual(bits, f"{entry['bits_per_triangle']:.3f}")
        self.assertEqual(references, f"{entry['references_per_triangle']:.3f}" if references else "")
        self.assertEqual(references == "", entry["references_per_triangle"] == 0)
        self.assertEqual(share, f"{100 * entry['bytes'] / base:.1f}\xa0%")
        self.assertEqual(acmr, f"{entry['acmr_fifo32']:.3f}")
        self.assertEqual(atvr, f"{entry['atvr_fifo32']:.3f}")
        self.assertEqual(deflated, f"{entry['bytes_deflated']:,}" if "bytes_deflated" in entry else "")
        self.assertEqual(ring == "", "ring" not in entry)
        if "ring" in entry:
            self.assertIn("expander" if entry["k"] is None else f"hybrid, k = {entry['k']}", ring)
            self.assertEqual(f", {entry['passes']} pass" in ring, entry["passes"] != 0)
        baseline = name not in ("lean", "lean_no_warts", "lr", "lr_compact", "packed", "packed_cache")
        self.assertEqual(what.startswith("baseline"), baseline)

    def check_offsets(self, rows, mesh):
        self.assertEqual(len(rows[0]), 4)
        for i, entry in enumerate(mesh["by_period"], 1):
            shares = [float(row[i]) for row in rows[1:]]
            bits = [100 * count / mesh["triangles"] for count in entry["offset_bits"]]
            expected = [*bits[1:len(shares) - 1], *(100 * entry[n] / mesh["triangles"] for n in ("tip_isolated", "t0"))]
            self.assertEqual([f"{share:.2f}" for share in shares], [f"{share:.2f}" for share in expected])
            self.assertEqual(sum(bits[len(shares) - 1:]), 0)

    def stats(self, *arguments):
        return self.json("stats", *arguments, "--table", "offsets", "--json")["meshes"]

    def test_numbers_are_those_of_stats(self):
        for path, *options in ((self.generate("blob", 3000, 3),), (self.generate("parts", 2000, 3), "--weld"),
                               (self.generate("soup", 800, 3), "--ring", "hybrid", "--optimize", "3", "--seeds", "2")):
            with self.subTest(path):
                page = self.page("--no-gpu", path, *options)
                mesh, = self.stats(path, *options)
                self.check_numbers(*page.tables_of("sizes"), mesh)
                self.check_offsets(*page.tables_of("offsets"), mesh)
                self.assertEqual(page.tables_of("overview"), [], "one mesh has no overview")
                self.check_summary(page.words(), mesh)
                self.check_command(page.words(), options)

    def check_summary(self, words, mesh):
        share = 100 * mesh["ring"]["t0"] / mesh["triangles"]
        for text in (f"{mesh['triangles']:,} triangles", f"{mesh['vertices']:,} vertices",
                     f"{mesh['ring']['isolated']:,} isolated; T0 {share:.2f} %",
                     f"ACMR {mesh['best_order']['acmr_fifo32']:.3f}"):
            self.assertIn(text, words)

    def check_command(self, words, options):
        for text in ("No pictures: ", run("--version").out.strip(),
                     " ".join(["lacedring report --output", self.path("out.html")]), *options):
            self.assertIn(text, words)

    def test_the_shown_command_makes_the_same_page(self):
        path = self.path("-it's $(a) mesh.ply")
        os.rename(self.generate("sphere", 100), path)
        arguments = ["--no-gpu", "--weld", "--k", "5", "--ring=hybrid", "--output=-a page.html", "--", os.path.basename(path)]
        command = [cli_support.program, "report", *arguments]
        subprocess.run(command, cwd=self.folder, check=True, capture_output=True)
        with open(self.path("-a page.html"), "rb") as file:
            first = file.read()
        os.remove(self.path("-a page.html"))
        shown = re.search(r"<dt>Command</dt><dd><code><bdi>(.*?)</bdi>", first.decode()).group(1)
        self.assertTrue(html.unescape(shown).startswith("lacedring report "))
        subprocess.run(["sh", "-c", "lacedring() { \"$PROGRAM\" \"$@\"; }; " + html.unescape(shown)], cwd=self.folder,
                       check=True, capture_output=True, env={**os.environ, "PROGRAM": cli_support.program})
        with open(self.path("-a page.html"), "rb") as file:
            self.assertEqual(file.read(), first)

    def test_several_meshes(self):
        paths = [self.generate("sphere", 500), self.generate("terrain", 700), self.generate("torus", 600)]
        os.mkdir(self.path("other"))
        paths.append(shutil.copy(paths[0], self.path("other")))  # two files of one name have their folders
        page = self.page("--no-gpu", *paths)
        overview, = page.tables_of("overview")
        self.assertEqual([row[0] for row in overview[2:]],
                         [paths[0], "terrain-700-1.ply", "torus-600-1.ply", paths[3], "median"])
        for rows, line, mesh in zip(page.tables_of("sizes"), overview[2:], self.stats(*paths), strict=False):
            self.check_numbers(rows, mesh)
            bits = [f"{mesh['formats'][n]['bits_per_triangle']:.2f}" for n in (
                "index_u32", "strip_restart", "meshopt_index_codec", "packed", "packed_cache", "lean", "lr", "lr_compact")]
            self.assertEqual(line[1:-2], [f"{mesh['triangles']:,}", f"{mesh['components']:,}", *bits])
        self.assertEqual([i for i in page.ids if i.startswith("mesh-")], [f"mesh-{i}" for i in (1, 2, 3, 4)])
        self.assertEqual(len(page.tables_of("sizes")), 4)

    def test_hostile_name(self):
        path = self.path(HOSTILE)
        os.rename(self.generate("sphere", 200), path)
        page = self.page("--no-gpu", path)
        self.assertEqual(page.images, [])
        shown = HOSTILE.replace("\n", "\u240a").replace("\x01", "\u2401").replace("\udcff", "\ufffd")
        self.assertIn(shown, "".join(page.text))

    def test_pictures(self):
        if not self.has_command("render"):
            self.assertNotIn("--size", self.ok("report", "--help").out)
            return
        page = self.page(self.generate("torus", 800), self.generate("blob", 800), "--size", "200x150")
        self.assertEqual(len(page.images), 6)
        pictures = []
        for image in page.images:
            self.assertEqual((image["width"], image["height"]), ("200", "150"))
            self.assertRegex(image["alt"], r"\A(torus|blob)-800-1\.ply: \w+")
            png = read_png(base64.b64decode(image["src"].partition(",")[2], validate=True))
            self.assertEqual(png[:2], (200, 150))
            self.assertGreater(len(colors(png)), 500, image["alt"])
            pictures.append(png)
        self.assertEqual(len({b"".join(rows) for _, _, rows in pictures}), 6, "no two are the same")
        words = page.words()
        for view in VIEWS:
            self.assertIn(view, words)
        self.assertRegex(words, r"Device\s*[^;]+Vulkan 1\.\d+\.\d+; 9 samples per pixel")
        # The page is the same, byte for byte, when it is made again.
        os.rename(self.path("out.html"), self.path("first.html"))
        page = self.page(self.path("torus-800-1.ply"), self.path("blob-800-1.ply"), "--size", "200x150")
        with open(self.path("first.html"), "rb") as a, open(self.path("out.html"), "rb") as b:
            self.assertTrue(a.read() == b.read())
        self.fails("report", self.path("torus-800-1.ply"), "-o", self.path("x.html"), "--device", "no such",
                   codes=(NO_DEVICE,))

    def test_camera(self):
        if not self.has_command("render"):
            self.assertNotIn("--camera-position", self.ok("report", "--help").out)
            return
        torus = self.generate("torus", 400)
        cameras = [(), ("--up", "+Z"), ("--camera-azimuth-angle", "40", "--camera-zoom-factor", "1.5"),
                   ("--camera-position=0,0,9", "--camera-focal-point=0,0,0")]
        pages = [self.page(torus, "--size", "200x150", *camera) for camera in cameras]
        self.assertEqual(len({page.images[0]["src"] for page in pages}), len(cameras), "no two are the same")
        # The picture equals that of render.
        self.ok("render", torus, "-o", self.path("render.png"), "--size", "200x150", *cameras[1])
        with open(self.path("render.png"), "rb") as file:
            rendered = read_png(file.read())
        shown = read_png(base64.b64decode(pages[1].images[0]["src"].partition(",")[2]))
        different = sum(a != b for p, q in zip(rendered[2], shown[2]) for a, b in zip(p, q))
        self.assertLess(different, 200 * 150 // 50)
        self.assertIn("--up +Z", pages[1].words())
        self.fails("report", torus, "-o", self.path("x.html"), "--up", "sideways", codes=(WRONG_USAGE,))
        self.fails("report", torus, "-o", self.path("x.html"), "--camera-position=1,1,1", "--camera-focal-point=1,1,1",
                   codes=(WRONG_USAGE,))

    def test_what_cannot_be_drawn_is_counted(self):
        flat = self.write("point.obj", b"v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n")
        page = self.page(flat)
        self.assertEqual(page.images, [])
        self.assertIn("No pictures: ", page.words())

    def test_one_bad_file_among_good_ones(self):
        good, bad = self.generate("sphere", 200), self.write("bad.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n")
        out, alone = self.path("some.html"), self.path("alone.html")
        result = run("report", bad, good, self.path("missing.ply"), "--no-gpu", "-o", out)
        self.assertEqual(result.code, BAD_INPUT)
        self.assertEqual(len(result.err.splitlines()), 3, result)  # a line for each bad file, and one for the page
        with open(out, encoding="utf-8") as file:
            left_out = re.findall("Not in it: <code><bdi>([^<]*)</bdi></code> .([^)]*)", file.read())
        self.assertEqual(left_out, [(bad, "line 4: the header has no end_header"),
                                    (self.path("missing.ply"), "No such file or directory")])
        self.ok("report", good, "--no-gpu", "-o", alone)
        with open(alone, encoding="utf-8") as file:
            self.assertFalse("Not in it" in file.read())

    def test_errors(self):
        good = self.generate("sphere", 200)
        bad = self.write("bad.ply", b"ply\nformat ascii 1.0\nelement vertex 3\n")
        out = self.write("kept.html", b"what was there before")
        self.fails("report", bad, "--no-gpu", "-o", out, mentions=("bad.ply",))
        self.fails("report", good, "--no-gpu", "-o", self.path("no/such/folder.html"), mentions=("no/such",))
        self.fails("report", good, "--no-gpu", "-o", self.folder)
        self.fails("report", good, codes=(WRONG_USAGE,))
        self.fails("report", "-o", out, codes=(WRONG_USAGE,))
        self.fails("report", good, "-o", out, "--weld=color", codes=(WRONG_USAGE,))
        if self.has_command("render"):
            self.fails("report", good, "-o", out, "--size", "0x0", codes=(WRONG_USAGE,))


class Browser(CliTest):
    def browse(self, page, size, *options):
        """A picture of the page by headless Chromium, and the browser's log."""
        chromium = shutil.which("chromium")
        self.assertIsNotNone(chromium, "chromium is missing: scripts/install-deps installs it")
        picture = self.path(f"shot-{size}.png")
        profile = tempfile.mkdtemp(prefix="profile-", dir=self.folder)
        # The browser has no network because its proxy does not exist. Failed requests of the page are in its console.
        result = subprocess.run(
            [chromium, "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-component-update", "--disable-sync", "--hide-scrollbars",
             "--proxy-server=127.0.0.1:9", f"--user-data-dir={profile}", "--enable-logging=stderr", "--v=0",
             f"--window-size={size}", f"--screenshot={picture}", *options,
             "file://" + page], capture_output=True, timeout=60)
        log = result.stderr.decode("utf-8", "replace")
        self.assertEqual(result.returncode, 0, log)
        with open(picture, "rb") as file:
            return read_png(file.read()), log

    def test_a_browser_shows_it(self):
        page = self.path("page.html")
        self.ok("report", self.generate("torus", 800), self.generate("parts", 600), "-o", page)
        shots = [self.browse(page, size, *options) for size, *options in (
            ("1280,1000",), ("400,900", "--blink-settings=preferredColorScheme=0"))]
        for (width, height, rows), log in shots:
            self.assertNotRegex(log, r"CONSOLE")
            self.assertGreater(len(colors((width, height, rows))), 60)
            # The margin is empty; text and charts are in the upper part.
            self.assertEqual(len({rows[y][:9] for y in range(height)}), 1)
        light, dark = (rows[0][0] for (_, _, rows), _ in shots)
        self.assertGreater(light, 240)
        self.assertLess(dark, 40)

    def test_it_fits_its_window(self):
        """Nothing scrolls sideways on a laptop; on a phone the tables alone do, inside the page."""
        page = self.path("page.html")
        self.ok("report", self.generate("soup", 3000), self.generate("parts", 600), "--no-gpu", "-o", page)
        with open(page, encoding="utf-8") as file:
            text = re.sub(r"<meta http-equiv=[^>]*>", "", file.read())  # it forbids scripts
        # As wide as counts of large meshes make it.
        text = re.sub(r'(<td class="strong">[^<]*</td><td>)[\d,]+', r"\g<1>123,456,789", text).replace("<td>3,000</td>", "<td>30,000,000</td>")
        measure = """<script>
            const beyond = [...document.querySelectorAll("body *")].filter((e) => !e.closest(".wide") && e.getBoundingClientRect().right > innerWidth);
            const scrolls = [...document.querySelectorAll(".wide")].filter((e) => e.scrollWidth > e.clientWidth);
            parent.postMessage([innerWidth, document.documentElement.scrollWidth, beyond.length, scrolls.length], "*");
            </script>"""
        self.write("measured.html", (text + measure).encode())
        widths = (1100, 1200, 1440, 390)
        frames = "".join(f'<iframe src="measured.html" style="width:{width}px;height:800px;border:0"></iframe>' for width in widths)
        listen = '<pre></pre><script>onmessage = (e) => { document.querySelector("pre").textContent += e.data + ";"; }</script>'
        wrapper = self.write("wrapper.html", f"<body>{listen}{frames}</body>".encode())
        dom = subprocess.run([shutil.which("chromium"), "--headless", "--no-sandbox", "--disable-gpu", "--no-first-run",
                              f"--user-data-dir={tempfile.mkdtemp(prefix='profile-', dir=self.folder)}", "--virtual-time-budget=5000",
                              "--dump-dom", "file://" + wrapper], capture_output=True, text=True, timeout=60, check=True).stdout
        measured = {int(line.split(",")[0]): line for line in re.search("<pre>(.*?);</pre>", dom)[1].split(";")}
        self.assertEqual(sorted(measured), sorted(widths), dom)
        for width, line in measured.items():
            _, page_width, beyond, scrolls = map(int, line.split(","))
            self.assertLessEqual(page_width, width, line)
            self.assertEqual(beyond, 0, line)
            if width >= 1100:
                self.assertEqual(scrolls, 0, line)

    def test_the_console_reports_a_failed_request(self):
        self.ok("report", self.generate("torus", 200), "--no-gpu", "-o", self.path("page.html"))
        with open(self.path("page.html"), encoding="utf-8") as file:
            text = file.read()
        for name, bad in (("image", "<img src='http://127.0.0.1:9/x.png' alt=''>"), ("script", "<script>let x = 1</script>")):
            changed = self.write(f"{name}.html", text.replace("<main>", f"<main>{bad}").encode())
            self.assertRegex(self.browse(changed, "300,200")[1], r"CONSOLE.*Content Security Policy")


if __name__ == "__main__":
    main()
