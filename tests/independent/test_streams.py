#!/usr/bin/env python3
"""The readers of the packed stream and the LR tables, by hand-made streams; and what `lacedring encode` writes, whole
and with one bit changed.

    test_streams.py [LACEDRING]
"""

import array
import os
import random
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_decode
import lr_reader
from lr_corners import check_corners
from lr_tables_reader import Tables, decode_tables
from mesh_readers import BadFile
from packed_reader import decode_packed

LACEDRING = None
FORMATS = ("lean", "packed", "lr", "lr-compact")
KINDS = ("sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup")
VERTICES, WIDTH, GAP_BITS = 128, 7, 3


def with_checksum(head, payload):
    """`head` with its checksum behind it, and `payload`."""
    checksum = zlib.crc32(array.array("I", payload).tobytes(), zlib.crc32(array.array("I", head).tobytes()))
    return array.array("I", [*head, checksum, *payload])


# --- Packed streams made by hand. Fields are strings of bits, the first one first. ---


def field(value, width):
    return f"{value:0{width}b}"[::-1] if width else ""


def golomb(value, k):
    u = value + (1 << k)
    n = u.bit_length()
    return "1" * (n - 1 - k) + "0" + field(u - (1 << n - 1), n - 1)


def event(gap, code, rest=""):
    ones, low = divmod(gap, 1 << GAP_BITS)
    return "1" * ones + "0" + field(low, GAP_BITS) + ("1111111" if code == 7 else "1" * code + "0") + rest


def record(a, b, is_reversed, *events):
    bits = field(a, WIDTH) + field(b, WIDTH) + str(is_reversed) + "".join(events)
    bits += "1" * (-len(bits) % 8)
    return int(bits[::-1], 2).to_bytes(len(bits) // 8, "little")


def packed(turns, *blocks):
    """blocks: (length in the directory, record)."""
    def words(data):
        return array.array("I", data + bytes(-len(data) % 4)).tolist()

    directory = struct.pack("<I", 0) + bytes(length for length, _ in blocks)
    records = b"".join(data for _, data in blocks)
    bits = int("0" + turns[::-1], 2).to_bytes((len(turns) + 31) // 32 * 4, "little")
    head = [0x4B50524C, 1, VERTICES, len(turns), len(records), WIDTH | GAP_BITS << 8, 0]
    return with_checksum(head, words(bits) + words(directory) + words(records) + [0, 0])


def unpacked(turns, *blocks):
    blocks = [block if isinstance(block, tuple) else (len(block), block) for block in blocks]
    _, flat = decode_packed(packed(turns, *blocks))
    return [tuple(flat[i:i + 3]) for i in range(0, len(flat), 3)]


class Packed(unittest.TestCase):
    def test_turns(self):  # the document's example, and behind it the polygon 6 ... 11
        corridor = [(0, 5, 1), (1, 5, 4), (1, 4, 2), (2, 4, 3)]
        self.assertEqual(unpacked("1011", record(0, 5, 0)), corridor)
        self.assertEqual(unpacked("1011", record(0, 5, 1)), [(a, x, b) for a, b, x in corridor])
        self.assertEqual(unpacked("10111011", record(0, 5, 0))[4:], [(a + 6, b + 6, x + 6) for a, b, x in corridor])
        with self.assertRaises(BadFile):
            decode_packed(packed("1010", (2, record(0, 5, 0))))

    def test_wart(self):
        self.assertEqual(unpacked("11000", record(0, 6, 0, event(0, 0), event(2, 0))),
                         [(0, 6, 2), (0, 2, 1), (2, 6, 4), (4, 6, 5), (2, 4, 3)])
        for bad in (event(0, 0) + event(1, 7), event(0, 0) + event(1, 1), event(0, 0) + event(0, 0)):
            with self.assertRaises(BadFile):
                unpacked("11000", record(0, 6, 0, bad))
        self.assertEqual(unpacked("1", record(0, 6, 0, event(0, 0))), [(0, 6, 2)])

    def test_split_and_end(self):
        split = event(0, 1, golomb(0, 2))
        self.assertEqual(unpacked("111000", record(0, 7, 0, split)),
                         [(0, 7, 3), (0, 3, 1), (1, 3, 2), (3, 7, 6), (3, 6, 5), (3, 5, 4)])
        self.assertEqual(unpacked("011000", record(0, 7, 0, split)),
                         [(0, 7, 4), (4, 7, 5), (5, 7, 6), (0, 4, 3), (0, 3, 2), (0, 2, 1)])
        self.assertEqual(unpacked("11", record(0, 7, 0, split, event(1, 6))), [(0, 7, 3), (3, 7, 4)])
        # Seventeen edges put aside: (55, 58), which is forgotten, (52, 55) ... (7, 10).
        splits = [event(1 if i else 0, 4, "11" + field(55 - 3 * i, WIDTH)) for i in range(17)]
        ends = [event(1, 6)] + [event(0, 6)] * 15
        self.assertEqual(unpacked("1" * 18, record(0, 58, 0, *splits, *ends))[17], (52, 55, 53))
        for bad in (record(0, 7, 0, event(1, 6)), record(0, 58, 0, *splits, *ends, event(0, 6))):
            with self.assertRaises(BadFile):
                unpacked("1" * 18, bad)

    def test_jump_and_far(self):
        self.assertEqual(unpacked("10", record(0, 9, 0, event(0, 5, golomb(1, 1)))), [(0, 9, 3), (3, 9, 8)])
        self.assertEqual(unpacked("00", record(0, 9, 0, event(0, 5, golomb(1, 1)))), [(0, 9, 6), (0, 6, 5)])
        far = {"10": [(0, 9, 40), (0, 40, 39)], "01": [(0, 9, 40), (40, 9, 8)], "00": [(0, 9, 40), (10, 19, 18)]}
        for bits, triangles in far.items():
            self.assertEqual(unpacked("00", record(0, 9, 0, event(0, 4, bits + field(40, WIDTH)))), triangles)
            with self.assertRaises(BadFile):
                unpacked("10", record(0, 9, 0, event(0, 4, bits + field(40, WIDTH))))
        both = event(0, 4, "11" + field(40, WIDTH))
        self.assertEqual(unpacked("100", record(0, 9, 0, both, event(2, 6))), [(0, 9, 40), (0, 40, 39), (40, 9, 8)])
        self.assertEqual(unpacked("000", record(0, 9, 0, both, event(2, 6))), [(0, 9, 40), (40, 9, 8), (0, 40, 39)])

    def test_start_beside_turn(self):
        def second(*events, is_reversed=0, turns="00"):
            return unpacked(turns, record(10, 20, is_reversed, *events))[-1]

        self.assertEqual(second(event(1, 3, "0")), (10, 19, 20))
        self.assertEqual(second(event(1, 3, "10" + golomb(3, 2))), (21, 26, 25))
        self.assertEqual(second(event(1, 3, "10" + golomb(3, 2)), is_reversed=1), (21, 26, 25))
        self.assertEqual(second(event(1, 3, "110" + golomb(2, 2) + golomb(3, 2)), is_reversed=1), (22, 26, 27))
        self.assertEqual(second(event(1, 3, "111" + field(40, WIDTH) + field(50, WIDTH) + "1")), (40, 49, 50))
        self.assertEqual(second(event(1, 2, "0" + field(0, 2) + golomb(4, 1) + field(40, WIDTH))), (21, 40, 39))
        self.assertEqual(second(event(1, 2, "0" + field(1, 2) + golomb(3, 1) + field(3, WIDTH))), (3, 8, 7))
        self.assertEqual(second(event(1, 2, "1" + field(2, 2) + golomb(1, 1) + field(3, WIDTH))), (9, 2, 3))
        self.assertEqual(second(event(1, 2, "0" + field(3, 2) + golomb(2, 1) + field(3, WIDTH))), (3, 21, 20))
        self.assertEqual(second(event(1, 7)), (10, 18, 19))
        self.assertEqual(second(event(1, 7), event(0, 7)), (10, 19, 18))
        # A polygon that follows by itself is reversed as it is then, but START asks for begun's, which it leaves alone.
        self.assertEqual(unpacked("0000", record(0, 3, 0, event(2, 7), event(1, 3, "0"))),
                         [(0, 3, 2), (0, 2, 1), (4, 6, 7), (4, 6, 7)])

    def test_blocks(self):
        plain = "".join(field(v, WIDTH) for v in (5, 6, 7, 127, 58, 57))
        plain += "1" * (-len(plain) % 8)
        plain = int(plain[::-1], 2).to_bytes(len(plain) // 8, "little")
        self.assertEqual(unpacked("00", (255, plain)), [(5, 6, 7), (127, 58, 57)])
        for bad in (("01", plain), ("00", plain[:-1] + bytes([plain[-1] & 0x7F]))):
            with self.assertRaises(BadFile):
                unpacked(bad[0], (255, bad[1]))
        parts = [record(0, 67, 0), record(0, 40, 1, event(0, 4, "00" + field(50, WIDTH)))]
        data = bytes([*map(len, parts), 0, 0]) + b"".join(parts)
        data += bytes(-len(data) % 8)
        out = unpacked("0" * 65, (160 + len(data) // 8, data))
        self.assertEqual((len(out), out[0], out[63], out[64]), (65, (0, 67, 66), (0, 4, 3), (0, 50, 40)))

# --- LR tables made by hand ---


def tables(slots, vo=(), star=(), isolated=(), copies=(), vertices=None, unit=0):
    ring = len(slots) // (1 if unit else 2)
    used = ring + len(isolated)
    head = [0x4243524C if unit else 0x5443524C, 1, vertices or used, ring, len(vo) // 6, len(star), len(isolated),
            len(copies) // 2, unit]
    return Tables(with_checksum(head, [*slots, *vo, *star, *isolated, *copies]), unit != 0)


class LrTables(unittest.TestCase):
    SPECIAL, IRREGULAR, WART = 1 << 28, 1 << 30, 1 << 31
    CLOSING, BORDER = SPECIAL | WART, SPECIAL | IRREGULAR | 0xFFFFFFF
    TETRAHEDRON = [3, 2 | SPECIAL, 3 | SPECIAL, 0, 1, 0 | SPECIAL, 0 | CLOSING, 2]

    def check(self, made, triangles):
        _, flat, _ = decode_tables(made)
        check_corners(made)
        self.assertEqual(flat, [v for t in triangles for v in t])

    def test_tetrahedron(self):
        triangles = [(0, 3, 1), (2, 0, 1), (2, 1, 3), (0, 2, 3)]
        self.check(tables(self.TETRAHEDRON), triangles)

        def short(left, right):
            return (left & 0x7FFF) << 16 | right & 0x7FFF

        compact = [short(-1, 2), short(2, -1), short(-1, 2), 0x80008000]
        self.check(tables(compact, star=[self.CLOSING, 2], unit=2), triangles)
        compact[3] |= 1
        self.check(tables(compact, star=[9, 9, self.CLOSING, 2], unit=2), triangles)
        self.check(tables(compact, star=[9, 9, 9, 9, self.CLOSING, 2, 0, 0], unit=4), triangles)

    def test_triangle(self):
        slots = [2, self.BORDER, self.SPECIAL, self.BORDER, self.CLOSING, self.BORDER]
        self.check(tables(slots), [(0, 2, 1)])
        slots[0] |= 1 << 29
        self.check(tables(slots), [(1, 2, 0)])

    def test_opposites(self):
        triangles = [(0, 3, 1), (2, 0, 1), (2, 1, 3), (0, 2, 3)]
        slots = list(self.TETRAHEDRON)
        slots[3] = self.IRREGULAR
        self.check(tables(slots, star=[0, 4 * 7 + 2, 4 * 0 + 1]), triangles)
        for star in ([0, 4 * 7 + 1, 1], [0, 0xFFFFFFFF, 1], [0, 4 * 6 + 2, 1], [3, 4 * 7 + 2, 1]):
            with self.assertRaises(BadFile):
                self.check(tables(slots, star=star), triangles)


# --- What the encoder writes ---


def damaged(data, word, bit):
    """An .lr file with one bit of its stream changed and every checksum right again."""
    data = bytearray(data)
    _, _, offset, size, _, _ = struct.unpack_from("<IIQQII", data, 32)  # the stream is the first section
    stream = array.array("I", bytes(data[offset:offset + size]))
    stream[word] ^= 1 << bit
    at = 9 if stream[0] >> 16 in (0x5443, 0x4243) else 7
    stream[at] = zlib.crc32(stream[at + 1:].tobytes(), zlib.crc32(stream[:at].tobytes()))
    data[offset:offset + size] = stream.tobytes()
    struct.pack_into("<I", data, 36, zlib.crc32(stream.tobytes()))
    struct.pack_into("<I", data, 24, zlib.crc32(data[32:32 + 32 * struct.unpack_from("<I", data, 8)[0]]))
    struct.pack_into("<I", data, 28, zlib.crc32(data[:28]))
    return bytes(data), at + 1, len(stream)


class Encoded(unittest.TestCase):
    def setUp(self):
        if LACEDRING is None:
            self.skipTest("no lacedring given")
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def run_lacedring(self, *words):
        result = subprocess.run([LACEDRING, *words], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def generate(self, kind, triangles):
        self.run_lacedring("generate", kind, "-o", self.path("m.ply"), "--triangles", str(triangles))

    def encode(self, name, *options):
        self.run_lacedring("encode", self.path("m.ply"), "-o", self.path("m.lr"), "--format", name, *options)
        with open(self.path("m.lr"), "rb") as file:
            return file.read()

    def wanted(self, numbers, weld=False):
        return check_decode.multiset(check_decode.read(self.path("m.ply")), numbers, weld)[0]

    def test_every_kind(self):
        for kind in KINDS:
            self.generate(kind, 1500)
            for name in FORMATS:
                for weld in (False, True):
                    with self.subTest(kind=kind, format=name, weld=weld):
                        numbers = {}
                        mesh = lr_reader.read_lr(self.encode(name, "--keep-order", *["--weld=position"] * weld))
                        got = check_decode.multiset(mesh, numbers)
                        self.assertIsNone(check_decode.compare(self.wanted(numbers, weld), got[0]))
                        self.assertEqual(got[2], 0)
                        source = check_decode.read(self.path("m.ply"))
                        self.assertIsNone(check_decode.in_order(source, mesh))
                        if not weld and kind != "soup":  # no two vertices of which are equal
                            self.assertEqual([source.positions[v] for v in mesh.vertex_order], mesh.positions)

    def test_changed_bits(self):
        self.generate("genus", 200)
        numbers = {}
        wanted = self.wanted(numbers)
        generator = random.Random(1)
        for name in FORMATS:
            data = self.encode(name)
            _, payload, size = damaged(data, 1, 0)
            different, unseen = 0, []  # a few bits may say the same either way
            for _ in range(150):
                word, bit = generator.randrange(payload, size), generator.randrange(32)
                try:
                    mesh = lr_reader.read_lr(damaged(data, word, bit)[0])
                except BadFile as error:
                    self.assertNotIn("checksum", str(error))
                    continue
                if check_decode.compare(wanted, check_decode.multiset(mesh, numbers)[0]) is None:
                    unseen.append((word, bit))
                else:
                    different += 1
            self.assertLess(len(unseen), 5, (name, unseen))
            self.assertGreater(different, 0, name)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        LACEDRING = sys.argv.pop(1)
    unittest.main()
