"""Runs the program in a temporary folder and checks its output; shared by the command-line tests."""

import json
import os
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
INDEPENDENT = os.path.join(os.path.dirname(HERE), "independent")
sys.path.insert(0, INDEPENDENT)

DONE, CHECK_FAILED, WRONG_USAGE, BAD_INPUT, NO_DEVICE = range(5)
KINDS = ["sphere", "torus", "genus", "terrain", "blob", "parts", "moebius", "soup"]

# A sanitized program is ten times slower and takes more memory.
SANITIZED = os.environ.get("LACEDRING_SANITIZED", "0") == "1"

program = None  # path of lacedring


class Outcome:
    def __init__(self, arguments, code, out, err):
        self.arguments, self.code, self.out, self.err = arguments, code, out, err

    def __str__(self):
        return f"{' '.join(self.arguments)}\nexit {self.code}\nstdout: {self.out[:1000]}\nstderr: {self.err[:3000]}"


def run(*arguments, timeout=120, preexec_fn=None):
    result = subprocess.run([program, *arguments], capture_output=True, timeout=timeout, preexec_fn=preexec_fn,
                            restore_signals=preexec_fn is None, stdin=subprocess.DEVNULL)
    return Outcome(arguments, result.returncode, result.stdout.decode("utf-8", "replace"),
                   result.stderr.decode("utf-8", "replace"))


def in_parallel(function, items):
    """Calls function(item) for all items in threads, and raises the first exception."""
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        return list(pool.map(function, items))


def files_below(folder):
    """{path: bytes} of all files of a folder; a failing command may not change them."""
    out = {}
    for at, folders, names in os.walk(folder):
        for name in folders:
            out[os.path.relpath(os.path.join(at, name), folder)] = None
        for name in names:
            with open(os.path.join(at, name), "rb") as file:
                out[os.path.relpath(os.path.join(at, name), folder)] = file.read()
    return out


class CliTest(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.help = run("--help").out

    def setUp(self):
        # The prefix does not end in "-": a random name "0..." would become "-0", which a test searches in messages.
        self._folder = tempfile.TemporaryDirectory(prefix="lacedring_cli_")
        self.folder = self._folder.name

    def tearDown(self):
        self._folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)
        return self.path(name)

    def has_command(self, name):
        return any(line.split()[:1] == [name] for line in self.help.splitlines())

    def ok(self, *arguments, code=DONE):
        outcome = run(*arguments)
        self.assertEqual(outcome.code, code, str(outcome))
        return outcome

    def json(self, *arguments, code=DONE):
        """Returns the JSON document of a command, which must print nothing else."""
        outcome = self.ok(*arguments, code=code)
        try:
            document = json.loads(outcome.out, parse_constant=lambda c: self.fail(f"{c} is no JSON: {outcome}"))
        except ValueError as error:
            self.fail(f"{error}: {outcome}")
        self.assertEqual(document["schema"], 1)
        return document

    def check_error(self, outcome, *mentions, codes=(BAD_INPUT,)):
        self.assertIn(outcome.code, codes, str(outcome))
        self.assertEqual(outcome.out, "", str(outcome))
        self.assertRegex(outcome.err, r"\Alacedring: [^\n]*\S\n\Z", str(outcome))
        for mention in mentions:
            self.assertIn(mention, outcome.err, str(outcome))

    def fails(self, *arguments, mentions=(), codes=(BAD_INPUT,), preexec_fn=None):
        """The command fails with one line on standard error, and leaves the folder as it was."""
        before = files_below(self.folder)
        outcome = run(*arguments, preexec_fn=preexec_fn)
        self.check_error(outcome, *mentions, codes=codes)
        self.assertEqual(sorted(files_below(self.folder)), sorted(before), f"files left or lost: {outcome}")
        self.assertEqual(files_below(self.folder), before, f"files changed: {outcome}")
        return outcome

    def same_triangles(self, source, *targets, options=()):
        """Compares the triangles with tests/independent/check_decode.py, which also decodes targets ending in .lr (resident())."""
        script = os.path.join(INDEPENDENT, "check_decode.py")
        for target in targets:
            option = ["--lr", target] if target.endswith(".lr") else [target]
            result = subprocess.run([sys.executable, "-B", script, source, *option, *options], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def resident(self, source, *options):
        """Encodes to an .lr file without storage form, which the independent checker reads, and returns its path."""
        path = self.path(os.path.basename(source) + "-resident.lr")
        self.ok("encode", source, "-o", path, "--resident", *options)
        return path

    def generate(self, kind, triangles, seed=1, extension=".ply"):
        path = self.path(f"{kind}-{triangles}-{seed}{extension}")
        self.ok("generate", kind, "-o", path, "--triangles", str(triangles), "--seed", str(seed))
        return path


def main():
    global program
    if len(sys.argv) < 2 or sys.argv[1].startswith("-"):
        sys.exit(f"usage: {sys.argv[0]} LACEDRING [unittest options]")
    # Tests import this module by name, so `program` is set in that module.
    sys.modules["cli_support"].program = os.path.abspath(sys.argv.pop(1))
    unittest.main(module="__main__", verbosity=2)
