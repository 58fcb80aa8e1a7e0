#!/usr/bin/env python3
"""test_shown.py ROOT: a document shows each file in examples/, line by line, or links to it.

A document shows a file by <!-- examples/NAME --> and the code block after it."""

import pathlib
import re
import sys


def main():
    root = pathlib.Path(sys.argv[1])
    wrong, shown, linked = [], set(), set()
    for document in [root / "README.md", *sorted((root / "docs").glob("*.md"))]:
        linked |= set(re.findall(r"\]\((?:\.\./)?(examples/[^)]+)\)", document.read_text()))
        for match in re.finditer(r"<!-- (examples/\S+) -->\n```\w+[^\n]*\n(.*?)```", document.read_text(), re.DOTALL):
            shown.add(match[1])
            if not (root / match[1]).exists() or (root / match[1]).read_text() != match[2]:
                wrong.append(f"{document.relative_to(root)}: {match[1]} is not the file")
    for path in sorted((root / "examples").iterdir()):
        name = str(path.relative_to(root))
        if path.name != "CMakeLists.txt" and name not in shown | linked:
            wrong.append(f"{name}: no document shows it or links to it")
    lines = (root / "examples/encode.cpp").read_text().count("\n")
    if lines > 12:
        wrong.append(f"examples/encode.cpp: {lines} lines, not the 12 that a newcomer reads")
    print("\n".join(wrong) or f"{len(shown)} examples are shown as they are")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
