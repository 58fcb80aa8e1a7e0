"""Runs viewer scripts on a display of Xvfb in a temporary folder; shared by the viewer's tests."""

import json
import os
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

program = None
display = None
folder = None


def run(*arguments, environment=None, timeout=120):
    variables = dict(os.environ, DISPLAY=display)
    variables.pop("WAYLAND_DISPLAY", None)
    variables["XDG_STATE_HOME"] = folder
    if environment is not None:
        variables = environment
    return subprocess.run([program, *arguments], capture_output=True, timeout=timeout, env=variables, cwd=folder,
                          stdin=subprocess.DEVNULL, text=True, errors="replace")


def without_display():
    return {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}


def mesh(kind, triangles, seed=1):
    name = os.path.join(folder, f"{kind}-{triangles}-{seed}.ply")
    if not os.path.exists(name):
        made = run("generate", kind, "-o", name, "--triangles", str(triangles), "--seed", str(seed))
        assert made.returncode == 0, made.stderr
    return name


class Scripted(unittest.TestCase):
    def view(self, script, *arguments, code=0, size="480x320"):
        """Runs a script with validation and returns the printed lines."""
        with tempfile.NamedTemporaryFile("w", dir=folder, suffix=".txt", delete=False) as file:
            file.write(script + "\nclose\n")
        done = run("view", *arguments, "--size", size, "--validation", "--script", file.name)
        self.assertEqual(done.returncode, code, f"{script}\n{done.stdout[-2000:]}\n{done.stderr[-3000:]}")
        if code == 0:
            self.assertEqual(done.stderr, "")
        return [json.loads(line) for line in done.stdout.splitlines()]


def start_display(size="1600x1200", *options):
    """Starts Xvfb on a free display number; returns its process and name."""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", f"{size}x24", "-nolisten", "tcp", *options],
                              pass_fds=[write], stderr=subprocess.DEVNULL)
    os.close(write)
    with os.fdopen(read) as file:
        number = file.readline().strip()
    if not number:
        sys.exit("Xvfb does not start")
    return server, ":" + number


def stop(server):
    server.kill()
    server.wait()


def main():
    """Runs the tests of the calling file on their own display and in their own folder."""
    global program, display, folder
    program = os.path.abspath(sys.argv.pop(1))
    server, display = start_display()  # fails without Xvfb
    try:
        with tempfile.TemporaryDirectory() as folder:
            outcome = unittest.main(exit=False, verbosity=2 if "-v" in sys.argv else 1)
    finally:
        server.terminate()
        server.wait()
    sys.exit(0 if outcome.result.wasSuccessful() else 1)
