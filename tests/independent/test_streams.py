#!/usr/bin/env python3
"""Tests the readers with hand-made packed streams and LR tables, and with files of `lacedring encode`, unchanged and with one
bit changed, including vertex streams and seams.

    test_streams.py [LACEDRING]      LACEDRING_MESHES: a folder of further meshes, compared corner by corner
"""

import array
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from collections import Counter

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import check_decode
import lr_reader
from gltf_reader import Gltf
from lr_corners import check_corners
from lr_tables_reader import Tables, decode_tables
from mesh_readers import TYPES, Attribute, BadFile, ply_attributes, unpack
from mesh_writers import ply_of_attributes
from packed_reader import decode_packed, read_triangle
from vertex_reader import LATTICE, OCTAHEDRAL, Vertices

LACEDRING = None
FORMATS = ("lean", "packed", "lr", "lr-compact")
ASSETS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "assets")
KINDS = ("sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup")
VERTICES, WIDTH = 1024, 10  # vertices and vertex bits of the packed streams made here
GAP_BITS, WART_BITS, SPLIT_ORDER, COUNT_ORDER = 3, 1, 2, 1


def with_checksum(head, payload):
    """`head`, its checksum and `payload`."""
    checksum = zlib.crc32(array.array("I", payload).tobytes(), zlib.crc32(array.array("I", head).tobytes()))
    return array.array("I", [*head, checksum, *payload])


# --- Packed streams made by hand. A field is a string of bits, lowest bit first. ---


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
    """The bits as bytes, padded with ones."""
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
    """A stream of groups of 16 blocks. A block is a record, or (kind, bytes, own entry or None, entry step). `entry` is the entry of each
    group. `doubles`: (D, runs, ...), or None."""
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
    """The triangles; checks that each read alone is the same."""
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
                ([0x3250524C, VERTICES, 4], [whole[4] | 16, *whole[5:]], "turns after"),
                ([0x3250524C, VERTICES, 4], [*whole[4:], 0], "words after"),
                ([0x3250524C, VERTICES, 4], whole[4:-1], "ends within"), ([0x3250524C, 5, 4], whole[4:], "")):
            with self.assertRaisesRegex(BadFile, why):
                decode_packed(with_checksum(head, payload))
        whole[4] ^= 2
        with self.assertRaisesRegex(BadFile, "checksum"):
            decode_packed(whole)

    def test_turns(self):  # the example of docs/packed-format.md, then the polygon 6 ... 11
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
        # A TURN in a part ends with the part, and a START in it does not change the last begun polygon.
        self.assertEqual(unpacked("11010", (0, 7, 0), record(split, event(0, TURN))),
                         [(0, 7, 3), (0, 1, 3), (1, 2, 3), (3, 7, 4), (4, 7, 6)])
        inside = event(0, START, "111" + vertex(50) + vertex(60) + "1")
        self.assertEqual(unpacked("1101010", (0, 7, 0), record(split, inside, event(3, START, "0"))),
                         [(0, 7, 3), (50, 51, 60), (51, 59, 60), (3, 7, 4), (0, 6, 7), (0, 1, 6), (1, 5, 6)])
        # Two scopes end together: the walk continues with the outer scope's rest.
        outer = event(0, JUMP, golomb(4, 1) + "1" + golomb(3, 2))
        inner = event(0, JUMP, golomb(0, 1) + "1" + golomb(2, 2))
        inside = event(0, START, "10" + golomb(20, 2))
        self.assertEqual(unpacked("1110001", (0, 40, 0), record(outer, inner, inside))[4:],
                         [(42, 62, 61), (6, 40, 39), (6, 39, 7)])
        for size in (1 << 30, (1 << 32) - 5):
            self.refused("size", "1", (50, 90, 0), record(event(0, SPLIT, golomb(size - 3, SPLIT_ORDER))))
            self.refused("size", "1", (50, 90, 0), record(event(0, JUMP, golomb(size - 2, 1) + "0")))
        part = event(0, FAR, "11" + vertex(40) + golomb(1, 2))
        self.refused("after the one around", "1111", (0, 9, 0), record(part, event(0, SPLIT, golomb(0, SPLIT_ORDER))))
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
        self.refused("after the record", "10", (0, 9, 0), record(both))

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
        # A polygon that follows without an event keeps the current reversal; START takes that of the last begun polygon.
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
            unpacked("1010", (0, 5, 0), b"", entry_bits=1)  # for one block
        for bits in range(1, 17):  # the head is padded with ones to a byte
            with self.subTest(bits=bits), self.assertRaisesRegex(BadFile, "filled up|words after|followed by"):
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
        # The last block with an own entry is two blocks before; the block between continues, or is plain.
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


def section(data, i=0):
    """Begin and end of section i of an .lr file."""
    _, _, _, offset, size, _, _ = struct.unpack_from("<HHIQQII", data, 32 + 32 * i)
    return offset, offset + size


def stream_of(data):
    """The connectivity stream of an .lr file, which is its first section."""
    begin, end = section(data)
    return array.array("I", bytes(data[begin:end]))


def sealed(data, i):
    """The .lr file with the checksums of section i and the header set."""
    begin, end = section(data, i)
    struct.pack_into("<I", data, 36 + 32 * i, zlib.crc32(data[begin:end]))
    struct.pack_into("<I", data, 24, zlib.crc32(data[32:32 + 32 * struct.unpack_from("<I", data, 8)[0]]))
    struct.pack_into("<I", data, 28, zlib.crc32(data[:28]))
    return bytes(data)


def damaged(data, word, bit):
    """The .lr file with one bit of its first stream changed, and all checksums set."""
    data = bytearray(data)
    stream, (begin, end) = stream_of(data), section(data)
    stream[word] ^= 1 << bit
    at = {0x5443: 9, 0x4243: 9, 0x3250: 3}.get(stream[0] >> 16, 7)
    stream[at] = zlib.crc32(stream[at + 1:].tobytes(), zlib.crc32(stream[:at].tobytes()))
    data[begin:end] = stream.tobytes()
    return sealed(data, 0), at + 1, len(stream)


class WithProgram(unittest.TestCase):
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

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def encode(self, name, *options, mesh=None):
        self.run_lacedring("encode", mesh or self.path("m.ply"), "-o", self.path("m.lr"), "--format", name, "--resident",
                           *options)
        return self.read("m.lr")


class Encoded(WithProgram):
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
                        self.assertIsNone(check_decode.order_fault(source, mesh))
                        if not weld and kind != "soup":  # has no equal vertices
                            self.assertEqual([source.positions[v] for v in mesh.vertex_order], mesh.positions)

    def same_alone(self, data, count):
        """Checks that triangles of a packed stream read alone are the same: all, or `count` of them."""
        words = stream_of(data)
        _, flat = decode_packed(words)
        triangles = range(len(flat) // 3)
        if len(triangles) > count:
            triangles = random.Random(1).sample(triangles, count)
        for t in triangles:
            self.assertEqual(read_triangle(words, t), tuple(flat[3 * t:3 * t + 3]), t)

    def test_single_triangles(self):
        for kind in KINDS:
            for triangles in (8, 300, 6000):  # 6000 triangles are two groups
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
            different, unseen = 0, []  # a few bits have no effect
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


BITS = ("--positions", "14", "--normals", "9", "--texcoords", "12", "--colors", "8", "--weights", "10")
QUANTIZED = ("POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_1", "WEIGHTS_0")


def attributes_of(points, kind, generator):
    """Attributes of every type and mapping: (name, type, flags of the PLY comment, values by vertex)."""
    def numbers(low, high, count):
        return [[generator.randint(low, high) for _ in range(count)] for _ in points]

    waves = [[math.sin(i / 9 + k) / 2 + 0.5 for k in range(4)] for i in range(len(points))]
    unit = [[x / (math.hypot(*p) or 1) for x in p] for p in points]
    bits = numbers(0, (1 << 32) - 1, 2) if kind == "soup" else [[0x7FC00001, i << 31] for i in range(2)] * len(points)
    return [("POSITION", "d" if kind == "torus" else "f", 0, points), ("NORMAL", "f", 0, unit),
            ("TANGENT", "f", 0, [(*n, generator.choice((1.0, -1.0))) for n in unit]),
            ("TEXCOORD_0", "f", 2, [w[:2] for w in waves]), ("COLOR_0", "B", 1, numbers(0, 255, 4)),
            ("COLOR_1", "f", 0, [w[1:] for w in waves]), ("WEIGHTS_0", "f", 0, waves),
            ("JOINTS_0", "H", 0, numbers(7, 60, 4)), ("i8", "b", 1, numbers(-128, 127, 1)),
            ("i16", "h", 0, numbers(-300, -200, 3)), ("i32", "i", 0, numbers(-1 << 31, (1 << 31) - 1, 3)),
            ("u32", "I", 0, numbers(0, (1 << 32) - 1, 2)), ("f64", "d", 0, [[x / 3 for x in p] for p in points]),
            ("decimals", "f", 0, [[round(p[0], 2), i if i % 50 else 1 / 3] for i, p in enumerate(points)]),
            ("a name", "f", 0, [struct.unpack("<2f", struct.pack("<2I", *b)) for b in bits[:len(points)]]),
            ("16 bytes", "B", 0, numbers(0, 3, 16)), ("17 bytes", "B", 0, numbers(0, 3, 17)),
            ("9 doubles", "d", 0, [[float(x) for x in v] for v in numbers(0, 3, 9)])]


def of_type(attribute):
    """The format character of the values, and the bytes per vertex."""
    code = TYPES[attribute.type]
    return code, attribute.components * struct.calcsize("<" + code)


def corners_of(attributes, indices):
    """The multiset of triangles that are not degenerate, by all attributes at their corners; -0 of a position equals 0."""
    values = []
    for attribute in attributes:
        (code, size), given = of_type(attribute), attribute.values
        if attribute.name == "POSITION":
            given = array.array(code, [x + 0.0 for x in array.array(code, given)]).tobytes()
        values.append([given[i:i + size] for i in range(0, len(given), size)])
    numbers = {}
    number = [numbers.setdefault(value, len(numbers)) for value in zip(*values)]
    corners = iter(indices)
    triangles = [t for t in zip(corners, corners, corners) if len(set(t)) == 3]
    by_values = [tuple(number[v] for v in t) for t in triangles]
    names = list(numbers)
    return Counter(min((names[a], names[b], names[c]), (names[b], names[c], names[a]), (names[c], names[a], names[b]))
                   for a, b, c in by_values)


def cut(indices, generator):
    """An index list cut into charts, and the vertex of each copy."""
    numbers, chart, out = {}, 0, []
    for t in range(0, len(indices), 3):
        chart = generator.randrange(3) if generator.random() < 0.1 else chart
        out += [numbers.setdefault((v, chart), len(numbers)) for v in indices[t:t + 3]]
    return out, [v for v, _ in numbers]


class VertexStreams(WithProgram):
    def make(self, kind, triangles, with_seams=False):
        """Writes a generated mesh with more attributes and returns these. With seams, copies of a vertex have different values."""
        self.generate(kind, triangles)
        mesh = check_decode.read(self.path("m.ply"))
        if with_seams:
            mesh.indices, copies = cut(mesh.indices, random.Random(triangles))
            mesh.positions = [mesh.positions[v] for v in copies]
        columns = attributes_of([unpack(p) for p in mesh.positions], kind, random.Random(1))
        with open(self.path("m.ply"), "wb") as file:
            file.write(ply_of_attributes(columns, mesh.indices))
        return ply_attributes(self.read("m.ply"))

    def streams(self, data):
        """{attribute: header of its vertex stream} of an .lr file."""
        out = {}
        for kind, contents, _, length in lr_reader.sections(data):
            if kind == lr_reader.VERTEX_STREAM:
                words = contents[(length + 7) // 8 * 8:]
                out[contents[:length].decode()] = Vertices(struct.unpack(f"<{len(words) // 4}I", words))
        return out

    def check_values(self, attribute, wanted, order, stream):
        """Compares a decoded attribute: its value i must be the wanted value order[i]."""
        given, codes = wanted.values, TYPES[wanted.type]
        size = wanted.components * struct.calcsize(codes)
        given = b"".join(given[size * v:size * v + size] for v in order)
        self.assertEqual((attribute.name, attribute.components, attribute.normalized, attribute.v_up),
                         (wanted.name, wanted.components, wanted.normalized, wanted.v_up))
        if stream is None or stream.mapping not in (LATTICE, OCTAHEDRAL):
            if attribute.name == "POSITION" and attribute.values != given:  # -0 may have become 0
                pairs = zip(array.array(codes, attribute.values), array.array(codes, given))
                given = array.array(codes, [x if x == y == 0 and math.copysign(1, x) > 0 else y for x, y in pairs]).tobytes()
            self.assertEqual((attribute.type, attribute.values), (wanted.type, given), wanted.name)
            return
        error = max(map(lambda a, b: abs(a - b), array.array("f", attribute.values), array.array(codes, given)))
        self.assertLessEqual(error, stream.largest_error, wanted.name)
        self.assertGreaterEqual(error, 0.999999 * stream.largest_error, wanted.name)

    def check(self, data, wanted):
        """Compares the attributes of an .lr file that keeps the order with the wanted ones and with the program's."""
        mesh, streams = lr_reader.read_lr(data), self.streams(data)
        for attribute, given in zip(mesh.attributes, wanted, strict=True):
            self.check_values(attribute, given, mesh.vertex_order, streams.get(attribute.name))
        self.check_decoded(mesh.attributes, mesh.copies)
        return streams

    def check_decoded(self, attributes, copies=()):
        self.run_lacedring("decode", self.path("m.lr"), "-o", self.path("out.ply"))
        for attribute, decoded in zip(attributes, ply_attributes(self.read("out.ply")), strict=True):
            size = attribute.components * struct.calcsize(TYPES[attribute.type])
            attribute.values = b"".join(attribute.values[size * v:size * v + size]
                                        for v in range(len(attribute.values) // size) if v not in copies)
            self.assertEqual(attribute, decoded)

    def test_every_kind(self):
        mappings = set()
        for i, kind in enumerate(KINDS):
            wanted = self.make(kind, 600 if i % 2 else 4500)  # 4500 triangles are more than 16 blocks
            long = {"17 bytes", "9 doubles"}
            names = {attribute.name for attribute in wanted} - long
            for name in FORMATS if kind == "soup" else (FORMATS[i % 2], FORMATS[2 + i // 2 % 2]):
                for bits in ((), BITS):
                    with self.subTest(kind=kind, format=name, bits=bits):
                        streams = self.check(self.encode(name, "--keep-order", *bits), wanted)
                        self.assertEqual(set(streams), names if bits or name in ("lean", "packed") else set())
                        lossy = {n for n, s in streams.items() if s.mapping in (LATTICE, OCTAHEDRAL)}
                        self.assertEqual(lossy, set(QUANTIZED) if bits else set())
                        mappings |= {stream.mapping for stream in streams.values()}
        self.assertEqual(mappings, set(range(6)))

    def same_attribute(self, data, i):
        """Reads an .lr file here and by the program: both refuse it, or both read the same attribute in section i, which is
        returned. Of the other attributes only POSITION, section 1, is read."""
        with open(self.path("m.lr"), "wb") as file:
            file.write(data)
        result = subprocess.run([LACEDRING, "decode", self.path("m.lr"), "-o", self.path("out.ply")],
                                capture_output=True, text=True)
        try:
            parts = lr_reader.sections(data)
            attribute = lr_reader.Attributes(data).read_all(parts[1:2] + parts[i:i + 1] * (i > 1))[0][-1]
        except BadFile as error:
            self.assertNotIn("checksum", str(error))
            self.assertEqual(result.returncode, 3, f"the program accepts it, but: {error}")
            return None
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(attribute, ply_attributes(self.read("out.ply"))[i - 1])
        return attribute

    def change(self, data, i, name, word, bit):
        """The .lr file with one bit of the vertex stream in section i changed, and all checksums set."""
        data = bytearray(data)
        begin, end = section(data, i)
        begin += (len(name) + 7) // 8 * 8
        stream = array.array("I", bytes(data[begin:end]))
        stream[word] ^= 1 << bit
        stream[3] = zlib.crc32(stream[4:].tobytes(), zlib.crc32(stream[:3].tobytes()))
        data[begin:end] = stream.tobytes()
        return sealed(data, i)

    def test_changed_bits(self):
        generator = random.Random(1)
        cases = (("sphere", 300, 20, ()), ("torus", 300, 20, BITS), ("blob", 4500, 2, BITS))
        for kind, triangles, count, options in cases:
            self.make(kind, triangles)
            data = self.encode("packed", *options)
            streams = self.streams(data)
            different = 0
            for i, (code, contents, _, length) in enumerate(lr_reader.sections(data)):
                name = contents[:length].decode()
                if code != lr_reader.VERTEX_STREAM:
                    continue
                unchanged = self.same_attribute(data, i)
                size = (len(contents) - (length + 7) // 8 * 8) // 4
                for which in range(count):  # half of them in the header and the components
                    word = generator.choice((1, 2, 4, 5, 6, *range(7, 7 + 2 * streams[name].n)))
                    word, bit = word if which < count // 2 else generator.randrange(7, size), generator.randrange(32)
                    with self.subTest(kind=kind, options=options, name=name, word=word, bit=bit):
                        attribute = self.same_attribute(self.change(data, i, name, word, bit), i)
                        different += attribute not in (None, unchanged)
            self.assertGreater(different, 0)

    def check_corners(self, mesh, wanted, indices, streams):
        """Checks that each corner of an .lr file that keeps the order has the vertex of the source, with its values."""
        for attribute, given in zip(mesh.attributes, wanted, strict=True):
            self.check_values(attribute, given, mesh.vertex_order, streams.get(given.name))
        left = set(range(len(indices) // 3))
        for i, corner in enumerate(mesh.corner_order):
            t, first = divmod(corner, 3)
            left.remove(t)
            got = [mesh.vertex_order[v] for v in mesh.indices[3 * i:3 * i + 3]]
            self.assertEqual(got, [indices[3 * t + (first + k) % 3] for k in range(3)], (i, corner))
        for t in left:
            self.assertLess(len(set(indices[3 * t:3 * t + 3])), 3, t)

    def source(self, path):
        """The attributes and indices of a mesh, read from LR tables with resident attributes in the mesh's order."""
        mesh = lr_reader.read_lr(self.encode("lr", "--no-weld", "--keep-order", "--effort", "0", mesh=path))
        place = dict(zip(mesh.vertex_order, range(len(mesh.vertex_order))))
        for attribute in mesh.attributes:
            size = of_type(attribute)[1]
            attribute.values = b"".join(attribute.values[size * place[v]:size * place[v] + size] for v in range(len(place)))
        self.assertIsNone(check_decode.order_fault(check_decode.read(path), mesh))
        indices = [0] * (3 * struct.unpack_from("<I", self.read("m.lr"), 16)[0])  # without degenerate triangles
        for i, corner in enumerate(mesh.corner_order):
            for k in range(3):
                indices[corner // 3 * 3 + (corner + k) % 3] = mesh.vertex_order[mesh.indices[3 * i + k]]
        return mesh.attributes, indices

    def check_seams(self, wanted, indices, path, bits=((),), formats=FORMATS):
        """Checks a mesh with seams, with and without its order. Yields the .lr file of each format without the order."""
        every_corner = corners_of(wanted, indices)
        for name in formats:
            for options in bits:
                with self.subTest(path=path, format=name, bits=options):
                    data = self.encode(name, "--keep-order", "--effort", "0", *options, mesh=path)
                    mesh = lr_reader.read_lr(data)
                    self.check_corners(mesh, wanted, indices, self.streams(data))
                    self.check_decoded(mesh.attributes, mesh.copies)
            with self.subTest(path=path, format=name):
                data = self.encode(name, "--effort", "0", mesh=path)
                mesh = lr_reader.read_lr(data)
                self.assertEqual(corners_of(mesh.attributes, mesh.indices), every_corner)
                yield data

    def test_seams(self):
        kinds = set()
        for i, kind in enumerate(KINDS):
            wanted = self.make(kind, 200 + 180 * (i % 3), with_seams=True)  # the largest has two blocks
            indices = check_decode.read(self.path("m.ply")).indices
            formats = FORMATS[i // 2 % 2::2]
            for data in self.check_seams(wanted, indices, self.path("m.ply"), (((), BITS)[i % 2],), formats):
                parts = lr_reader.sections(data)
                kinds |= {part[0] for part in parts}
                per_copy = dict(zip((a.name for a in wanted), lr_reader.Attributes(data).read_all(parts)[1]))
                equal = {"POSITION", "NORMAL", "f64"}  # computed from positions only
                self.assertEqual({name for name in equal if per_copy[name]}, set())
                self.assertTrue(per_copy["TEXCOORD_0"] and per_copy["COLOR_0"])
        self.assertEqual(kinds, {1, 2, 5, 6, 7, 8, 9})

    def test_assets(self):
        globe = os.path.join(ASSETS, "globe.glb")
        with open(globe, "rb") as file:
            gltf = Gltf(file.read(), ASSETS)
        primitive = gltf.json["meshes"][0]["primitives"][0]
        wanted, indices = self.source(globe)
        self.assertEqual(indices, [v for (v,) in gltf.accessor(primitive["indices"])[0]])
        self.assertEqual([a.name for a in wanted], list(primitive["attributes"]))
        for attribute in wanted:
            values, _ = gltf.accessor(primitive["attributes"][attribute.name], raw_floats=True)
            self.assertEqual(attribute.values, b"".join(struct.pack(f"<{len(v)}I", *v) for v in values), attribute.name)
        for data in self.check_seams(wanted, indices, globe):
            self.assertTrue(any(part[0] == lr_reader.SEAMS for part in lr_reader.sections(data)))
        list(self.check_seams(wanted, indices, globe, bits=(BITS,), formats=("packed",)))
        torus = os.path.join(ASSETS, "cut_torus.ply")
        list(self.check_seams(*self.source(torus), torus, formats=("packed",)))

    def test_real_meshes(self):
        folder = os.environ.get("LACEDRING_MESHES")
        if not folder:
            self.skipTest("LACEDRING_MESHES is not set")
        for name in sorted(os.listdir(folder)):
            if not name.endswith((".obj", ".ply", ".off", ".stl", ".gltf", ".glb")):
                continue
            path = os.path.join(folder, name)
            wanted, indices = self.source(path)
            for form, bits in (("lean", ()), ("lr", ()), ("packed", ()), ("packed", BITS)):
                with self.subTest(name=name, format=form, bits=bits):
                    data = self.encode(form, "--keep-order", "--effort", "0", *bits, mesh=path)
                    mesh = lr_reader.read_lr(data)
                    self.check_corners(mesh, wanted, indices, self.streams(data))
                    self.check_decoded(mesh.attributes, mesh.copies)
                    copies, seams = struct.unpack_from("<I", data, 20)[0], [len(p[1]) for p in lr_reader.sections(data) if p[0] == 9]
                    print(f"{name} {form} {bits[:2]}: {len(indices) // 3} triangles, {copies} copies, {sum(seams)} bytes of seams",
                          flush=True)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        LACEDRING = sys.argv.pop(1)
    unittest.main()
