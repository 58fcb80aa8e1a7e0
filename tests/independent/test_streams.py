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
from packed_reader import decode_packed, read_triangle

LACEDRING = None
FORMATS = ("lean", "packed", "lr", "lr-compact")
KINDS = ("sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup")
VERTICES, WIDTH = 1024, 10  # of the packed streams made here
GAP_BITS, WART_BITS, SPLIT_ORDER, COUNT_ORDER = 3, 1, 2, 1


def with_checksum(head, payload):
    """`head` with its checksum behind it, and `payload`."""
    checksum = zlib.crc32(array.array("I", payload).tobytes(), zlib.crc32(array.array("I", head).tobytes()))
    return array.array("I", [*head, checksum, *payload])


# --- Packed streams made by hand. Fields are strings of bits, the first one first. ---


def field(value, width):
    return f"{value:0{width}b}"[::-1] if width else ""


def rice(value, k):
    return "1" * (value >> k) + "0" + field(value & (1 << k) - 1, k)


def golomb(value, k):
    u = value + (1 << k)
    n = u.bit_length()
    return "1" * (n - 1 - k) + "0" * (n != 32) + field(u - (1 << n - 1), n - 1)


def vertex(v):
    return field(v, WIDTH)


def in_bytes(bits):
    """Filled up with ones."""
    bits += "1" * (-len(bits) % 8)
    return int("0" + bits[::-1], 2).to_bytes(len(bits) // 8, "little")


SPLIT, BESIDE, START, FAR, JUMP, TURN, FLIPS = range(7)


def event(gap, code, rest=""):
    return rice(gap, GAP_BITS) + "1" * code + "0" + rest


def record(*events, entry=None, warts=()):
    if entry is None and not events and not warts:
        return b""
    bits = "" if entry is None else vertex(entry[0]) + vertex(entry[1]) + str(entry[2])
    return in_bytes(bits + golomb(len(events), COUNT_ORDER) + "".join(events) +
                    "".join(rice(gap, WART_BITS) for gap in warts))


PARTED, PLAIN = 1, 2  # kinds of blocks


def parted(*parts, own=None, step=0):
    return PARTED, bytes(map(len, parts)) + bytes(4 - len(parts)) + b"".join(parts), own, step


def plain(*corners):
    return PLAIN, in_bytes("".join(map(vertex, corners))), None, 0


def entry_field(entry):
    return vertex(entry[0]) + vertex(entry[1]) + str(entry[2])


def packed(turns, entry, *blocks, step=40, offset_bits=16, entry_bits=0, table=None, kinds=None, doubles=None,
           change_head=str):
    """Groups of 16 blocks, each a record, or the kind, bytes, entry of its own or None, and entry step. `entry`: of
    each group. `doubles`: (D, runs, ...), or None."""
    data, begins = b"", []
    for first in range(0, len(blocks), 16):
        begins.append(len(data) // 4)
        some = [(0, block, None, 0) if isinstance(block, bytes) else block for block in blocks[first:first + 16]]
        with_kinds = any(kind for kind, *_ in some) if kinds is None else kinds
        head = field(step, 12) + field(offset_bits, 5) + field(entry_bits, 4) + field(GAP_BITS, 3) + field(WART_BITS, 3)
        head += field(SPLIT_ORDER, 2) + field(COUNT_ORDER, 2) + str(int(with_kinds))
        head += "".join(str(int(own is not None)) for _, _, own, _ in some[1:]) + entry_field(entry)
        head += "".join(entry_field(own) for _, _, own, _ in some[1:] if own is not None)
        head += "".join(field(kind, 2) for kind, *_ in some) if with_kinds else ""
        records = b""
        for k, (_, contents, _, _) in enumerate(some):
            records += contents
            head += field(len(records) - (k + 1) * step + (1 << offset_bits) // 2, offset_bits)
        head += "".join(field(steps, entry_bits) for *_, steps in some[1:])
        data += in_bytes(change_head(head)) + records
        data += bytes(-len(data) % 4)
    bits = int("0" + turns[::-1], 2).to_bytes((len(turns) + 31) // 32 * 4, "little")
    payload = array.array("I", bits).tolist() + (begins[1:] if table is None else table) + list(doubles or ())
    vertices = VERTICES | (doubles is not None) << 31
    return with_checksum([0x3250524C, vertices, len(turns)], payload + array.array("I", data).tolist())


def unpacked(turns, entry, *blocks, **options):
    """The triangles, each read by itself, too."""
    words = packed(turns, entry, *blocks, **options)
    _, flat = decode_packed(words)
    out = [tuple(flat[i:i + 3]) for i in range(0, len(flat), 3)]
    if [read_triangle(words, t) for t in range(len(out))] != out:
        raise AssertionError("a triangle read by itself is another one")
    return out


class Packed(unittest.TestCase):
    def refused(self, why, *stream, **options):
        with self.assertRaisesRegex(BadFile, why):
            unpacked(*stream, **options)

    def test_header(self):
        whole = packed("1010", (0, 5, 0), b"")
        self.assertEqual(decode_packed(whole)[0], VERTICES)
        self.assertEqual(decode_packed(with_checksum([0x3250524C, 0, 0], [])), (0, []))
        for head, payload, why in (
                ([0x4B50524C, 1, 4], [0] * 5, "version 1"), ([0x4E4C524C, 1, 4], [0] * 5, "version 2"),
                ([0x3250524C, (1 << 29) + 1, 4], whole[4:], "too many"),
                ([0x3250524C, VERTICES, 1 << 31], [0], "too many"),
                ([0x3250524C, VERTICES, 4], [whole[4] | 16, *whole[5:]], "turns behind"),
                ([0x3250524C, VERTICES, 4], [*whole[4:], 0], "words behind"),
                ([0x3250524C, VERTICES, 4], whole[4:-1], "ends within"), ([0x3250524C, 5, 4], whole[4:], "")):
            with self.assertRaisesRegex(BadFile, why):
                decode_packed(with_checksum(head, payload))
        whole[4] ^= 2
        with self.assertRaisesRegex(BadFile, "checksum"):
            decode_packed(whole)

    def test_turns(self):  # the document's example, and behind it the polygon 6 ... 11
        corridor = [(0, 5, 1), (1, 5, 4), (1, 4, 2), (2, 4, 3)]
        self.assertEqual(unpacked("1010", (0, 5, 0), b""), corridor)
        self.assertEqual(unpacked("1010", (0, 5, 1), b""), [(a, x, b) for a, b, x in corridor])
        self.assertEqual(unpacked("10101010", (0, 5, 0), b"")[4:], [(a + 6, b + 6, x + 6) for a, b, x in corridor])
        self.refused("last triangle", "1011", (0, 5, 0), b"")
        self.assertEqual(unpacked("010", (0, 2, 0), b""), [(0, 2, 1), (3, 5, 4), (6, 8, 7)])
        self.refused("last triangle", "101", (0, 2, 0), b"")
        self.refused("says nothing", "1010", (0, 5, 0), in_bytes(golomb(0, COUNT_ORDER)))
        self.refused("out of range", "10101", (VERTICES - 6, VERTICES - 1, 0), b"")

    def test_wart(self):
        self.assertEqual(unpacked("11001", (0, 6, 0), record(warts=(0, 0))),
                         [(0, 6, 2), (0, 2, 1), (2, 6, 4), (4, 6, 5), (2, 4, 3)])
        self.assertEqual(unpacked("11", (0, 6, 1), record(event(0, FLIPS, "01"), warts=(0,))), [(0, 2, 6), (0, 2, 1)])
        self.assertEqual(unpacked("1", (0, 6, 0), record(warts=(0,))), [(0, 6, 2)])
        self.refused("as large", "110", (0, 3, 0), record(warts=(0,)))
        self.refused("as large", "110", (0, 9, 0), record(event(0, JUMP, golomb(0, 1) + "0"), warts=(0,)))
        self.refused("next to", "111", (0, 9, 0), record(warts=(0, 0)))
        self.refused("last candidate", "110", (0, 9, 0), record(warts=(2,)))
        for between in (event(1, TURN), event(1, JUMP, golomb(0, 1) + "0")):
            self.refused("between", "110", (0, 9, 0), record(between, warts=(0,)))
        self.refused("more than a byte", "110", (0, 9, 0), record(warts=(0,)) + b"\xFF")

    def test_split(self):
        split = event(0, SPLIT, golomb(0, SPLIT_ORDER))
        self.assertEqual(unpacked("110001", (0, 7, 0), record(split)),
                         [(0, 7, 3), (0, 3, 1), (1, 3, 2), (3, 7, 6), (3, 6, 5), (3, 5, 4)])
        self.assertEqual(unpacked("001110", (0, 7, 0), record(split)),
                         [(0, 7, 4), (4, 7, 6), (4, 6, 5), (0, 4, 1), (1, 4, 2), (2, 4, 3)])
        self.assertEqual(unpacked("11", (0, 7, 0), record(split)), [(0, 7, 3), (0, 3, 1)])
        # TURN in the part is forgotten at its end, and START there leaves begun alone.
        self.assertEqual(unpacked("11010", (0, 7, 0), record(split, event(0, TURN))),
                         [(0, 7, 3), (0, 1, 3), (1, 2, 3), (3, 7, 4), (4, 7, 6)])
        inside = event(0, START, "111" + vertex(50) + vertex(60) + "1")
        self.assertEqual(unpacked("1101010", (0, 7, 0), record(split, inside, event(3, START, "0"))),
                         [(0, 7, 3), (50, 51, 60), (51, 59, 60), (3, 7, 4), (0, 6, 7), (0, 1, 6), (1, 5, 6)])
        # Two scopes that end together: the outer one's rest is what counts.
        outer = event(0, JUMP, golomb(4, 1) + "1" + golomb(3, 2))
        inner = event(0, JUMP, golomb(0, 1) + "1" + golomb(2, 2))
        inside = event(0, START, "10" + golomb(20, 2))
        self.assertEqual(unpacked("1110001", (0, 40, 0), record(outer, inner, inside))[4:],
                         [(42, 62, 61), (6, 40, 39), (6, 39, 7)])
        for size in (1 << 30, (1 << 32) - 5):
            self.refused("size", "1", (50, 90, 0), record(event(0, SPLIT, golomb(size - 3, SPLIT_ORDER))))
            self.refused("size", "1", (50, 90, 0), record(event(0, JUMP, golomb(size - 2, 1) + "0")))
        part = event(0, FAR, "11" + vertex(40) + golomb(1, 2))
        self.refused("behind the one around", "1111", (0, 9, 0), record(part, event(0, SPLIT, golomb(0, SPLIT_ORDER))))
        self.refused("fewer triangles", "1100111", (0, 9, 0), record(event(0, JUMP, golomb(1, 1) + "1" + golomb(3, 2))))

    def test_jump_and_far(self):
        self.assertEqual(unpacked("10", (0, 9, 0), record(event(0, JUMP, golomb(1, 1) + "0"))), [(0, 9, 3), (3, 9, 8)])
        self.assertEqual(unpacked("00", (0, 9, 0), record(event(0, JUMP, golomb(1, 1) + "0"))), [(0, 9, 6), (0, 6, 5)])
        self.assertEqual(unpacked("110", (0, 9, 0), record(event(0, JUMP, golomb(3, 1) + "1" + golomb(0, 2)))),
                         [(0, 9, 5), (0, 5, 1), (5, 9, 8)])
        far = {"10": [(0, 9, 40), (0, 40, 39)], "01": [(0, 9, 40), (40, 9, 8)], "00": [(0, 9, 40), (10, 19, 18)]}
        for bits, triangles in far.items():
            one = record(event(0, FAR, bits + vertex(40)))
            self.assertEqual(unpacked("00", (0, 9, 0), one), triangles)
            self.refused("FAR", "10", (0, 9, 0), one)
        both = event(0, FAR, "11" + vertex(40) + golomb(0, 2))
        self.assertEqual(unpacked("100", (0, 9, 0), record(both)), [(0, 9, 40), (0, 40, 39), (40, 9, 8)])
        self.assertEqual(unpacked("000", (0, 9, 0), record(both)), [(0, 9, 40), (40, 9, 8), (0, 40, 39)])
        self.refused("behind the record", "10", (0, 9, 0), record(both))

    def test_start_beside_turn(self):
        def second(*events, is_reversed=0, turns="00"):
            return unpacked(turns, (10, 20, is_reversed), record(*events))[-1]

        self.assertEqual(second(event(1, START, "0")), (10, 19, 20))
        self.assertEqual(second(event(1, START, "10" + golomb(3, 2))), (21, 26, 25))
        self.assertEqual(second(event(1, START, "10" + golomb(3, 2)), is_reversed=1), (21, 26, 25))
        self.assertEqual(second(event(1, START, "110" + golomb(2, 2) + golomb(3, 2)), is_reversed=1), (22, 26, 27))
        self.assertEqual(second(event(1, START, "111" + vertex(40) + vertex(50) + "1")), (40, 49, 50))
        self.assertEqual(second(event(1, BESIDE, "0" + field(0, 2) + golomb(4, 1) + vertex(40))), (21, 40, 39))
        self.assertEqual(second(event(1, BESIDE, "0" + field(1, 2) + golomb(3, 1) + vertex(3))), (3, 8, 7))
        self.assertEqual(second(event(1, BESIDE, "1" + field(2, 2) + golomb(1, 1) + vertex(3))), (9, 2, 3))
        self.assertEqual(second(event(1, BESIDE, "0" + field(3, 2) + golomb(2, 1) + vertex(3))), (3, 21, 20))
        with self.assertRaisesRegex(BadFile, "step"):
            second(event(1, BESIDE, "0" + field(0, 2) + golomb(1 << 30, 1) + vertex(40)))
        self.assertEqual(second(event(1, TURN)), (10, 18, 19))
        self.assertEqual(second(event(1, TURN), event(0, TURN)), (10, 19, 18))
        self.assertEqual(second(event(0, FLIPS, "01")), (10, 18, 19))
        for bad in ((event(1, FLIPS, "01"),), (event(0, TURN), event(0, FLIPS, "01")), (event(2, TURN),),
                    (event(1, 7),)):
            with self.assertRaises(BadFile):
                second(*bad)
        # A polygon that follows by itself is reversed as it is then, but START asks for begun's, which it leaves alone.
        self.assertEqual(unpacked("0100", (0, 3, 0), record(event(2, TURN), event(1, START, "0"))),
                         [(0, 3, 2), (0, 2, 1), (4, 6, 7), (4, 6, 7)])

    def test_blocks(self):
        block = plain(5, 6, 7, 127, 58, 57)
        self.assertEqual(unpacked("00", (0, 0, 0), block), [(5, 6, 7), (127, 58, 57)])
        self.refused("turns", "01", (0, 0, 0), block)
        contents = block[1]
        for wrong in (contents[:-1] + bytes([contents[-1] & 0x7F]), contents + b"\xFF"):
            self.refused("filled up", "00", (0, 0, 0), (PLAIN, wrong, None, 0))
        self.refused("ends within", "00", (0, 0, 0), (PLAIN, contents[:-1], None, 0))
        self.refused("entry for a plain", "00", (0, 1, 0), block)
        self.refused("kind 3", "00", (0, 3, 0), (3, b"", None, 0))
        self.assertEqual(unpacked("0", (0, 2, 0), b"", kinds=True), [(0, 2, 1)])
        second = record(event(0, FAR, "00" + vertex(50)), entry=(0, 40, 1))
        out = unpacked("0" * 65, (0, 67, 0), parted(b"", second))
        self.assertEqual((len(out), out[0], out[63], out[64]), (65, (0, 67, 66), (0, 4, 3), (0, 50, 40)))
        for change in ({0: 1}, {1: 201}, {2: 1}, {-1: 1}, {-2: 1}):
            _, data, *_ = parted(b"", second)
            data = bytearray(data + bytes(1) if -1 in change else data[:3] if -2 in change else data)
            for at, value in change.items():
                data[at] = value
            self.refused("", "0" * 65, (0, 67, 0), (PARTED, bytes(data), None, 0))
        self.refused("parted block are too", "0" * 65, (0, 67, 0), (PARTED, b"", None, 0))
        events = [record(*[event(0, TURN)] * count) for count in range(130)]
        exact, longer = (next(data for data in events if len(data) >= size) for size in (160, 161))
        self.assertEqual((len(exact), len(longer) > 160), (160, True))
        self.assertEqual(len(unpacked("0", (0, 2, 0), exact)), 1)
        self.refused("more than 160", "0", (0, 2, 0), longer)
        self.assertEqual(len(unpacked("0", (0, 2, 0), parted(longer))), 1)

    def test_heads(self):
        for step, offset_bits in ((0, 16), (4095, 16), (0, 1), (1, 2), (0, 0), (7, 5)):
            self.assertEqual(unpacked("1010", (0, 5, 0), b"", step=step, offset_bits=offset_bits)[3], (2, 4, 3))
        other = record(warts=(0,))
        for step, offset_bits in ((len(other), 0), (len(other), 1), (0, 16), (16, 6)):
            self.assertEqual(unpacked("11", (0, 6, 0), other, step=step, offset_bits=offset_bits),
                             [(0, 6, 2), (0, 2, 1)])
        with self.assertRaisesRegex(BadFile, "too many bits"):
            unpacked("1010", (0, 5, 0), b"", offset_bits=17)
        with self.assertRaisesRegex(BadFile, "too many bits"):
            unpacked("1010", (0, 5, 0), b"", entry_bits=1)  # of one block
        for bits in range(1, 17):  # the head is filled up with ones, and only to a byte
            with self.subTest(bits=bits), self.assertRaisesRegex(BadFile, "filled up|words behind|followed by"):
                unpacked("1010", (0, 5, 0), b"", step=0, offset_bits=bits, change_head=lambda head: head + "0")

    def test_doubles(self):
        stream = ("1010", (0, 5, 0), b"")
        own = [(0, 5, 1), (1, 5, 4), (1, 4, 2), (2, 4, 3)]
        high = 1 << 31
        self.assertEqual(unpacked(*stream, doubles=(1, 1, 4, 2)), own + [own[2]])
        self.assertEqual(unpacked(*stream, doubles=(4, 1, 4, high)), own + [(a, c, b) for a, b, c in own])
        self.assertEqual(unpacked(*stream, doubles=(4, 3, 4, 1, 6, 3, 7, 3 | high)),
                         own + own[1:3] + [own[3], (2, 3, 4)])
        for doubles in ((0, 1, 4, 0), (1, 0), (5, 2, 4, 0, 8, 0), (1, 1, 4, 4), (2, 1, 4, 3), (1, 1, 5, 0),
                        (1, 1, 3, 0), (2, 2, 4, 0, 4, 1), (2, 2, 4, 0, 6, 1), (2, 2, 4, 0, 3, 1),
                        (1, 1, 4, (1 << 31) - 1)):
            with self.subTest(doubles=doubles):
                self.refused("double", *stream, doubles=doubles)
        with self.assertRaises(BadFile):
            decode_packed(with_checksum([0x3250524C, 1 << 31, 0], [1, 1, 0, 0]))
        self.assertEqual(unpacked("00", (0, 0, 0), plain(5, 6, 7, 127, 58, 57), doubles=(1, 1, 2, 1 | high))[2:],
                         [(127, 57, 58)])

    def test_links(self):
        turns = "10" * 128
        first = (0, 600, 0)
        then = [(128, 472, 129), (129, 472, 471)]
        self.assertEqual(unpacked(turns + "10", first, b"", (0, b"", None, 8), entry_bits=4)[256:], then)
        self.assertEqual(unpacked(turns + "10", first, b"", (0, b"", None, 9), entry_bits=4)[256], (129, 473, 130))
        self.assertEqual(unpacked(turns + "10", first, b"", (0, b"", None, 0), entry_bits=0)[256:], then)
        self.assertEqual(unpacked(turns + "10", first, b"", (0, b"", None, 0), entry_bits=1)[256], (127, 471, 128))
        own = (300, 900, 1)
        later = record(entry=own)
        for block in ((0, b"", own, 0), parted(b"", *[later] * 3, own=own)):
            out = unpacked(turns * 2 + "10", first, b"", block, (0, b"", None, 8), entry_bits=4)
            self.assertEqual(out[256], (300, 301, 900))
            self.assertEqual(out[512:], [(428, 429, 772), (429, 771, 772)])
        # From the last block with an entry of its own, two blocks before: over one that goes on, too, or a plain one.
        no_turns = "0" * 256
        corners = plain(*(5, 6, 7) * 256)
        long = (0, 900, 0)
        twice = [(257, 645, 258), (258, 645, 644)]
        for step in (8, 15):
            out = unpacked(turns * 2 + "10", long, b"", (0, b"", None, step), (0, b"", None, 9), entry_bits=4)
            self.assertEqual(out[512:], twice)
        self.assertEqual(unpacked(turns + no_turns + "10", long, b"", corners, (0, b"", None, 9), entry_bits=4)[512:],
                         twice)
        self.assertEqual(unpacked(no_turns + "10", (0, 0, 0), corners, (0, b"", own, 0))[255:],
                         [(5, 6, 7), (300, 301, 900), (301, 899, 900)])
        self.refused("from a plain", no_turns + "10", (0, 0, 0), corners, (0, b"", None, 8), entry_bits=4)
        self.refused("from a plain", no_turns * 2 + "10", (0, 0, 0), corners, corners, (0, b"", None, 8), entry_bits=4)
        self.refused("entry step", no_turns + "10", (0, 0, 0), corners, (0, b"", own, 8), entry_bits=4)
        self.refused("entry step", turns + "00", first, b"", (*plain(5, 6, 7, 5, 6, 7)[:3], 8), entry_bits=4)
        self.refused("entry of its own", turns + "00", first, b"", (*plain(5, 6, 7, 5, 6, 7)[:2], own, 0))
        blocks = [b""] + [(0, b"", own, 0)] * 15 + [b""]
        self.assertEqual(unpacked(turns * 16 + "10", first, *blocks)[4096:], [(0, 600, 1), (1, 600, 599)])
        self.refused("table", turns * 16 + "10", first, *blocks, table=[1])


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


def stream_of(data):
    """The stream of an .lr file, which is its first section, and where it begins."""
    _, _, offset, size, _, _ = struct.unpack_from("<IIQQII", data, 32)
    return array.array("I", bytes(data[offset:offset + size])), offset


def damaged(data, word, bit):
    """An .lr file with one bit of its stream changed and every checksum right again."""
    data = bytearray(data)
    stream, offset = stream_of(data)
    stream[word] ^= 1 << bit
    at = {0x5443: 9, 0x4243: 9, 0x3250: 3}.get(stream[0] >> 16, 7)
    stream[at] = zlib.crc32(stream[at + 1:].tobytes(), zlib.crc32(stream[:at].tobytes()))
    data[offset:offset + 4 * len(stream)] = stream.tobytes()
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

    def same_alone(self, data, count):
        """Reads each triangle of a packed stream, or `count` of them, by itself."""
        words, _ = stream_of(data)
        _, flat = decode_packed(words)
        triangles = range(len(flat) // 3)
        if len(triangles) > count:
            triangles = random.Random(1).sample(triangles, count)
        for t in triangles:
            self.assertEqual(read_triangle(words, t), tuple(flat[3 * t:3 * t + 3]), t)

    def test_single_triangles(self):
        for kind in KINDS:
            for triangles in (8, 300, 6000):  # the last in two groups
                self.generate(kind, triangles)
                for options in ((), ("--profile", "cache"), ("--weld=position",)):
                    with self.subTest(kind=kind, triangles=triangles, options=options):
                        self.same_alone(self.encode("packed", *options), 1500)

    def test_changed_bits(self):
        self.generate("genus", 200)
        numbers = {}
        wanted = self.wanted(numbers)
        generator = random.Random(1)
        for name in FORMATS:
            data = self.encode(name)
            _, payload, size = damaged(data, 1, 0)
            different, unseen = 0, []  # a few bits may say the same either way
            for _ in range(300):
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
