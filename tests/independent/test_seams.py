#!/usr/bin/env python3
"""test_seams.py WRITE_SEAMS C_SEAMS: seams_reader.py and lacedring_seams.h accept the same seam sections of small meshes, valid
and mutated, as the library, and decode the same copies."""

import array
import subprocess
import sys

from mesh_readers import BadFile
from seams_reader import read_seams

EMPTY = (0xFFFFFFFF,) * 3  # a slot without a triangle


def main():
    written = subprocess.run(sys.argv[1:2], check=True, capture_output=True).stdout
    done = subprocess.run(sys.argv[2:3], input=written, capture_output=True)
    if done.returncode != 0:
        sys.exit(f"C: exit {done.returncode}: {(done.stdout + done.stderr).decode()[-2000:]}")
    words = array.array("I", written)
    at = sections = accepted = 0

    def take(count):
        nonlocal at
        at += count
        return words[at - count:at]

    while at < len(words):
        vertices, count, size = take(3)
        corners = take(3 * count)
        section = take(size).tobytes()
        triangles = [tuple(corners[i:i + 3]) for i in range(0, 3 * count, 3)]
        triangles = [() if triangle == EMPTY else triangle for triangle in triangles]
        sound = take(1)[0]
        wanted = take(3 * count) if sound else None
        try:
            read, _ = read_seams(section, triangles, vertices)
            copies = array.array("I", [copy for triangle in read for copy in triangle or EMPTY])
        except BadFile as error:
            copies, why = None, error
        if copies != wanted:
            sys.exit(f"section {sections}: {'other copies' if copies and sound else why if sound else 'not refused'}")
        sections += 1
        accepted += sound
    print(f"{sections} sections alike, {accepted} of them accepted")
    if not sections // 4 < accepted < sections:
        sys.exit("mutations are all refused, or none is")


if __name__ == "__main__":
    main()
