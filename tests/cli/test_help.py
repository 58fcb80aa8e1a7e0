#!/usr/bin/env python3
"""test_help.py LACEDRING: the help of every command."""

import os
import re
import shlex
import subprocess

import cli_support
from cli_support import DONE, HERE, CliTest, main

DOCS = os.path.join(os.path.dirname(os.path.dirname(HERE)), "docs")
# Options that mean something else, or something more, in another command.
DIFFERENT = {"--output", "--resident", "--keep-order", "--path", "--source", "--no-gpu", "--output-format", "--no-warts", "--seeds"}


def options_of(text):
    """{name: description} of a help's options."""
    found = {}
    for names, description in re.findall(r"^  (-\S.*?)(?:  +|\n {34})(\S.*(?:\n {34}.*)*)$", text, re.MULTILINE):
        name = re.findall(r"--[a-z0-9-]+", names)[0]
        found[name] = re.sub(r"\s+", " ", description)
    return found


class Help(CliTest):
    def commands(self):
        listed = re.findall(r"^  ([a-z]+) +\S", self.help, re.MULTILINE)
        self.assertIn("encode", listed)
        return listed

    def test_every_help(self):
        """What the command does, its usage, its options, an example and a document, on one screen."""
        texts = {}
        for command in self.commands():
            with self.subTest(command):
                text = self.ok(command, "--help").out
                self.assertRegex(text, rf"\Alacedring {command}: [a-z][^\n]+\n\nUsage: lacedring {command} [^\n]+ \[OPTIONS\]\n\n")
                self.assertIn(f"\nExample: lacedring {command} ", text)
                more = re.search(r"\nMore in (.+)\n\Z", text)
                self.assertTrue(more, text)
                for path in more[1].split(" and "):
                    self.assertTrue(os.path.isfile(os.path.join(os.path.dirname(DOCS), path)), path)
                self.assertLessEqual(len(text.splitlines()), 50)
                self.assertLessEqual(max(map(len, text.splitlines())), 110)
                self.assertNotRegex(text, r"\{|\}|TEXT|UINT|FLOAT|REQUIRED|  $")
                texts[command] = options_of(text)
                self.assertIn("--help", texts[command])
        said = {}
        for command, options in texts.items():
            for name, description in options.items():
                if name not in DIFFERENT:
                    words = re.sub(r" \(default [^)]*\)|\d+", "", description)
                    self.assertEqual(words, said.setdefault(name, words), f"{name} of {command}")

    def test_examples(self):
        """Every example runs as it is printed."""
        for name, kind in (("bunny.ply", "blob"), ("kitten.glb", "torus"), ("scene.glb", "blob")):
            self.ok("generate", kind, "-o", self.path(name), "--triangles", "300")
        names = [name for name in self.commands() if name != "view"]  # which needs a display
        names.sort(key=lambda name: name in ("decode", "unpack"))  # they read what others have written
        quicker = {"compare": ["--path", "compute", "--source", "lean", "--size", "64x48"],
                   "bench": ["--no-gpu"] if self.has_command("render") else []}
        for command in names:
            with self.subTest(command):
                example = re.search(r"\nExample: lacedring (.+)\n", self.ok(command, "--help").out)[1]
                done = subprocess.run([cli_support.program, *shlex.split(example), *quicker.get(command, [])], cwd=self.folder, capture_output=True, text=True,
                                      timeout=60, check=False)
                self.assertEqual(done.returncode, DONE, done.stderr)


if __name__ == "__main__":
    main()
