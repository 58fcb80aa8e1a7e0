"""Reads PNG files of 8 bits per channel, and the contents of an Xvfb screen, without libraries."""

import struct
import zlib


def read(path):
    """Width, height, and a list of rows with 3 bytes per pixel."""
    with open(path, "rb") as file:
        data = file.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n", path
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and color in (2, 6), (depth, color)
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    step = 3 if color == 2 else 4
    raw = zlib.decompress(packed)
    stride = width * step
    rows, previous = [], bytearray(stride)
    for y in range(height):
        kind = raw[y * (stride + 1)]
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if kind == 1:
            for i in range(step, stride):
                row[i] = (row[i] + row[i - step]) & 255
        elif kind == 2:
            row = bytearray((a + b) & 255 for a, b in zip(row, previous))
        elif kind == 3:
            for i in range(stride):
                row[i] = (row[i] + ((row[i - step] if i >= step else 0) + previous[i]) // 2) & 255
        elif kind == 4:
            for i in range(stride):
                a, b, c = row[i - step] if i >= step else 0, previous[i], previous[i - step] if i >= step else 0
                p = a + b - c
                pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
                row[i] = (row[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
        previous = row
        rows.append(bytes(row) if step == 3 else bytes(v for i, v in enumerate(row) if i % 4 != 3))
    return width, height, rows


def read_screen(folder):
    """The screen of an Xvfb with the option -fbdir FOLDER (an XWD file of 32 bits per pixel), as from read()."""
    with open(f"{folder}/Xvfb_screen0", "rb") as file:
        data = file.read()
    header = struct.unpack(">20I", data[:80])
    size, width, height, big_endian, bits, stride, colors = (header[i] for i in (0, 4, 5, 7, 11, 12, 19))
    assert bits == 32 and big_endian == 0, header
    rows = []
    for y in range(height):
        at = size + 12 * colors + y * stride
        row = bytearray(3 * width)
        for channel in range(3):
            row[channel::3] = data[at + 2 - channel:at + 4 * width:4]
        rows.append(bytes(row))
    return width, height, rows


def differences(a, b):
    """The number of different pixels, and the largest difference of a channel."""
    assert a[:2] == b[:2], (a[:2], b[:2])
    pixels = largest = 0
    for left, right in zip(a[2], b[2]):
        if left == right:
            continue
        for i in range(0, len(left), 3):
            if left[i:i + 3] != right[i:i + 3]:
                pixels += 1
                largest = max(largest, *(abs(left[i + j] - right[i + j]) for j in range(3)))
    return pixels, largest
