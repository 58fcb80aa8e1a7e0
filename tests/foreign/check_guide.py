#!/usr/bin/env python3
"""Compiles the code of docs/engine-guide.md: ```glsl STAGE blocks with glslangValidator, ```cpp blocks with a C++ compiler.

    check_guide.py GUIDE GLSLANG_VALIDATOR GLSL_FOLDER COMPILER INCLUDE_FOLDER...
"""
import pathlib
import re
import subprocess
import sys
import tempfile

STAGES = {"vert", "geom", "comp", "mesh", "frag", "rchit"}


def main():
    guide, validator, glsl_folder, compiler, *include_folders = sys.argv[1:]
    text = pathlib.Path(guide).read_text(encoding="utf-8")
    seen, failed = set(), 0
    with tempfile.TemporaryDirectory() as folder:
        for match in re.finditer(r"^```(\w.*)\n((?:.*\n)*?)```$", text, re.MULTILINE):
            language, _, stage = match[1].partition(" ")
            line = text.count("\n", 0, match.start()) + 1
            source = pathlib.Path(folder, f"line{line}.{stage or language}")
            source.write_text(match[2], encoding="utf-8")
            if language == "glsl":
                command = [validator, "-V", "--quiet", "--target-env", "vulkan1.3", f"-I{glsl_folder}", "-S", stage,
                           "-o", f"{source}.spv", str(source)]
            elif language == "cpp":
                command = [compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", *(f"-I{folder}" for folder in include_folders),
                           str(source)]
            else:
                sys.exit(f"{guide}:{line}: neither glsl STAGE nor cpp: {match[1]}")
            seen.add(stage or language)
            result = subprocess.run(command, capture_output=True, text=True, check=False)
            if result.returncode != 0:
                failed += 1
                print(f"{guide}:{line}: does not compile\n{result.stdout}{result.stderr}")
    missing = (STAGES | {"cpp"}) - seen
    if missing:
        print(f"{guide}: no example of {', '.join(sorted(missing))}")
    sys.exit(1 if failed or missing else 0)


main()
