#!/usr/bin/env python3
"""Tests the viewer with failing disks, threads, devices and displays. Usage: test_faults.py LACEDRING FAULTS_LIBRARY"""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import driver
import png
from driver import mesh, run

SOURCES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "shaders")
SOON = 20  # seconds: a limit for what must not hang, long enough for a busy machine
faults = None


class Faults(driver.Scripted):
    def setUp(self):
        self.folder = os.path.join(driver.folder, self.id().split(".")[-1])
        os.mkdir(self.folder)
        self.state = os.path.join(self.folder, "state")

    def path(self, name):
        return os.path.join(self.folder, name)

    def fifo(self, *names):
        path = os.path.join(self.folder, *names)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        os.mkfifo(path)
        return path

    def faulty(self, script, *arguments, code=0, size="480x320", display=None, faults_on=True, **variables):
        """Runs a script with faults; returns the printed states, standard error, and the seconds that it took."""
        with open(self.path("script.txt"), "w") as file:
            file.write(script + "\nclose\n")
        environment = dict(os.environ, DISPLAY=display or driver.display, XDG_STATE_HOME=self.state, **variables)
        environment.pop("WAYLAND_DISPLAY", None)
        if faults_on:
            environment["LD_PRELOAD"] = faults
        begun = time.monotonic()
        done = run("view", *arguments, "--size", size, "--script", file.name, environment=environment, timeout=60)
        seconds = time.monotonic() - begun
        self.assertEqual(done.returncode, code, f"{script}\n{done.stdout[-2000:]}\n{done.stderr[-3000:]}")
        return [json.loads(line) for line in done.stdout.splitlines()], done.stderr, seconds

    def slow(self, script, *arguments, seconds=3600, **options):
        """Runs a script with a disk that delays reads of files slow-*.ply by `seconds`."""
        return self.faulty(script, *arguments, FAULT_SLOW_FILE="-slow.ply", FAULT_SLOW_SECONDS=str(seconds), **options)

    def slow_mesh(self, name=""):
        path = self.path(name + "-slow.ply")
        shutil.copy(mesh("blob", 1000), path)
        return path

    def test_pipes_are_refused_and_not_waited_for(self):
        pipe = self.fifo("pipe.ply")
        states, said, seconds = self.faulty(f"""open {pipe}
            frames 2
            wait error
            print
            open {mesh('torus', 500)}
            wait mesh
            print""")
        self.assertIn("pipe.ply: is not a regular file", states[0]["error"])
        self.assertEqual(states[1]["triangles"], 500)
        self.assertEqual(said, "")
        self.assertLess(seconds, SOON)
        done = run("view", "--script", pipe, timeout=SOON)
        self.assertEqual(done.returncode, 3)
        self.assertIn("pipe.ply: is not a regular file", done.stderr)
        # If the list of recent files is a pipe, it is neither read nor written.
        recent = self.fifo("state", "lacedring", "recent")
        self.faulty("wait mesh", mesh("torus", 500))
        viewer = subprocess.Popen([driver.program, "view", mesh("torus", 500), "--fps", "1000"], cwd=driver.folder,
                                  env=dict(os.environ, DISPLAY=driver.display, XDG_STATE_HOME=self.state))
        time.sleep(3)
        self.assertIsNone(viewer.poll())
        viewer.terminate()
        viewer.wait(SOON)
        self.assertTrue(os.path.exists(recent))

    def test_pipes_among_shaders(self):
        shaders = self.path("glsl")
        shutil.copytree(SOURCES, shaders)
        os.remove(os.path.join(shaders, "draw/surface.frag"))
        self.fifo("glsl", "draw/surface.frag")
        states, _, seconds = self.faulty("wait mesh\nwait shaders\nprint", mesh("torus", 500), "--shaders", shaders)
        self.assertEqual(states[0]["shaders"]["error"], "shaders/draw/surface.frag: cannot be read")
        self.assertLess(seconds, SOON)

    def test_closing_waits_for_no_disk(self):
        slow = self.slow_mesh()
        for script in ("frames 1", "frames 20\nset view wire\nset outlines on", f"frames 5\nopen {slow}\nframes 20"):
            _, said, seconds = self.slow(script, slow)
            self.assertEqual(said, "")
            self.assertLess(seconds, SOON)
        # The viewer does not wait for a folder of shaders on a slow disk either.
        shaders = self.path("glsl")
        shutil.copytree(SOURCES, shaders)
        _, said, seconds = self.faulty("frames 20", "--shaders", shaders, FAULT_SLOW_FILE="/surface.frag")
        self.assertEqual(said, "")
        self.assertLess(seconds, SOON)

    def test_another_file_while_one_is_read_slowly(self):
        slow, torus = self.slow_mesh(), mesh("torus", 500)
        states, said, seconds = self.slow(f"""frames 20
            print
            open {torus}
            frames 2
            wait ready
            print
            open {slow}
            frames 20
            print
            key escape
            frames 2
            print
            set passes 3
            wait optimized
            print""", slow)
        self.assertEqual(said, "")
        self.assertLess(seconds, 2 * SOON)
        self.assertEqual([state["file"] for state in states], ["", torus, torus, torus, torus])
        self.assertEqual([state["busy"] for state in states], [True, False, True, False, False])
        self.assertEqual([state["error"] for state in states], [""] * 5)

    def test_a_slow_file_comes_in_the_end_unless_it_was_replaced(self):
        slow, torus = self.slow_mesh(), mesh("torus", 500)
        states, _, _ = self.slow("wait mesh\nwait settled\nprint", slow, seconds=1)
        self.assertEqual((states[0]["file"], states[0]["error"]), (slow, ""))
        states, _, _ = self.slow(f"frames 5\nopen {torus}\nframes 2\nwait ready\nframes 400\nprint", slow, seconds=1)
        self.assertEqual((states[0]["file"], states[0]["error"]), (torus, ""))

    def test_no_more_than_a_few_files_are_waited_for(self):
        # On a busy machine a reader may be stopped before its thread starts, and then waits for nothing: a few more files.
        script = []
        for i in range(12):
            script += [f"open {self.slow_mesh(str(i))}", "frames 3"]
        states, _, seconds = self.slow("\n".join(script) + "\nframes 3\nprint")
        self.assertIn("11-slow.ply: 8 other files are still being read", states[0]["error"])
        self.assertLess(seconds, SOON)

    def test_closing_waits_for_no_encoder(self):
        big = mesh("blob", 1000000)
        for before in ("frames 30", "wait mesh", "wait mesh\nset view wire\nframes 1",
                       "wait mesh\nset paint corridors\nframes 1"):
            with open(self.path("script.txt"), "w") as file:
                file.write(before + "\nprint\nclose\n")
            viewer = subprocess.Popen([driver.program, "view", big, "--size", "320x200", "--script", file.name],
                                      stdout=subprocess.PIPE, env=dict(os.environ, DISPLAY=driver.display), cwd=driver.folder)
            viewer.stdout.readline()
            begun = time.monotonic()
            self.assertEqual(viewer.wait(SOON), 0)
            viewer.stdout.close()
            self.assertLess(time.monotonic() - begun, 5, before)

    def test_a_system_without_threads(self):
        torus = mesh("torus", 500)
        _, said, _ = self.faulty("frames 1", torus, code=4, FAULT_THREADS="0")
        self.assertEqual(said, "lacedring: view: no thread can be started: Resource temporarily unavailable\n")
        # With only some threads the window stays open and shows the error.
        for threads in ("1", "2", "3"):
            states, said, _ = self.faulty("frames 5\nprint", torus, FAULT_THREADS=threads)
            self.assertEqual(said, "")
            self.assertEqual(states[0]["file"], "")
            self.assertIn("no thread can be started", states[0]["error"])
        states, said, _ = self.faulty("wait mesh\nwait settled\nframes 3\nset paint corridors\nframes 3\nprint", torus,
                                      FAULT_THREADS="5")
        self.assertEqual((said, states[0]["file"]), ("", torus))
        self.assertIn("no thread can be started", states[0]["error"])

    def test_a_window_larger_than_the_device_draws(self):
        torus = mesh("torus", 500)
        script = "wait optimized\nresize 700 500\nframes 3\nprint\nresize 500 400\nframes 3\nprint"
        states, said, _ = self.faulty(script, torus, "--validation", FAULT_IMAGE_LIMIT="600")
        self.assertEqual(said, "")
        self.assertEqual([state["window"] for state in states], [[600, 500], [500, 400]])
        self.assertEqual([state["size"] for state in states], [[600, 500], [500, 400]])
        # A window that the system does not shrink shows only its title.
        states, said, _ = self.faulty(script, torus, "--validation", FAULT_IMAGE_LIMIT="600", FAULT_WINDOW_STAYS="1")
        self.assertEqual(said, "")
        self.assertEqual([state["window"] for state in states], [[700, 500], [500, 400]])
        self.assertEqual([state["size"] for state in states], [[600, 428], [500, 400]])
        self.assertIn("larger than the device draws", states[0]["title"])
        self.assertEqual(states[1]["title"], "torus-500-1.ply - LacedRing")

    def test_a_screen_larger_than_the_device_draws(self):
        server, display = driver.start_display("20000x300")
        try:
            states, said, _ = self.faulty("wait optimized\nresize 20000 100\nframes 3\nprint\nresize 640 200\nframes 3\nprint",
                                          mesh("torus", 500), "--validation", display=display, faults_on=False)
        finally:
            driver.stop(server)
        self.assertEqual(said, "")
        largest = min(20000, states[0]["window"][0])
        self.assertEqual([state["size"] for state in states], [[largest, 100], [640, 200]])

    def test_a_picture_that_does_not_fit_is_scaled(self):
        """A picture of the window's size does not fit the device's memory."""
        screen = self.path("screen")
        os.mkdir(screen)
        server, display = driver.start_display("1200x900", "-fbdir", screen)
        try:
            for memory, size in (("4000", [1200, 900]), ("120", [600, 450])):
                with open(self.path("script.txt"), "w") as file:
                    file.write(f"set ring-line off\nwait ready\nframes 300\nscreenshot {self.path('shot.png')}\nprint\nframes 1000000\n")
                viewer = subprocess.Popen(
                    [driver.program, "view", mesh("torus", 500), "--size", "1200x900", "--device-memory", memory, "--no-panels",
                     "--script", file.name], stdout=subprocess.PIPE, cwd=driver.folder,
                    env=dict(os.environ, DISPLAY=display, XDG_STATE_HOME=self.state))
                try:
                    state = json.loads(viewer.stdout.readline())
                    time.sleep(0.5)
                    width, height, shown = png.read_screen(screen)
                finally:
                    viewer.kill()
                    viewer.communicate()
                self.assertEqual((state["size"], state["window"], state["error"]), (size, [1200, 900], ""))
                self.assertEqual((width, height), (1200, 900))
                drawn = png.read(self.path("shot.png"))
                step = 1200 // size[0]
                far = 0  # pixels at interpolated edges
                for y, row in enumerate(drawn[2]):
                    over = shown[y * step + step // 2]
                    for x in range(size[0]):
                        at = 3 * (x * step + step // 2)
                        far += max(abs(a - b) for a, b in zip(over[at:at + 3], row[3 * x:3 * x + 3])) > 30
                self.assertLess(far, size[0] * size[1] // 100, memory)
        finally:
            driver.stop(server)

    def test_a_display_that_goes_is_one_line(self):
        with open(self.path("script.txt"), "w") as file:
            file.write("set turntable on\nframes 1000000\n")
        for arguments in ([mesh("torus", 500)], [mesh("torus", 500), "--script", file.name], [mesh("blob", 1000000)], []):
            for how, after in ((signal.SIGKILL, 0.1), (signal.SIGKILL, 1.5), (signal.SIGTERM, 0.7)):
                server, display = driver.start_display()
                viewer = subprocess.Popen([driver.program, "view", *arguments, "--size", "480x320"], stderr=subprocess.PIPE,
                                          text=True, cwd=driver.folder,
                                          env=dict(os.environ, DISPLAY=display, XDG_STATE_HOME=self.state))
                try:
                    time.sleep(after)
                    server.send_signal(how)
                    said = viewer.communicate(timeout=SOON)[1]
                finally:
                    viewer.kill()
                    driver.stop(server)
                if said.startswith("lacedring: view: no usable display"):
                    continue  # the viewer had not started
                self.assertEqual((viewer.returncode, said), (4, "lacedring: display: the connection to the X server is lost\n"))


if __name__ == "__main__":
    faults = os.path.abspath(sys.argv.pop(2))
    driver.main()
