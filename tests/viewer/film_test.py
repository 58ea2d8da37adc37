# SPDX-License-Identifier: Apache-2.0
"""film_test.py PROGRAM PLUGINS: the films of `altiplan view --mp4`, with Chromium; without ffmpeg only
their frames.

`film_test.py PROGRAM PLUGINS Film.test_frames` runs one case; skipped without Chromium."""
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
if not shutil.which("chromium"):
    print("skipped: needs Debian's chromium (tools/setup ci)")
    sys.exit(SKIPPED)

PROGRAM, PLUGINS = sys.argv[1:3]
HANGS_S = 120
SCENARIO = """altiplan: 1
name: Past a post
environment:
  - cylinder: {at_m: [500, 520], radius_m: 30}
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
vehicle: {speed_mps: 10}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100], tolerance_m: 5}
"""
PIPELINE = """altiplan: 1
scenario: scenario.yaml
steps:
  - plan: astar
    with: {cell_m: [50, 50, 50]}
  - fly: route
"""
# Keeps what it is given, as the film.
KEEPS = """#!/usr/bin/python3
import sys
frames = sys.stdin.buffer.read()
with open(sys.argv[-1], "wb") as film:
    film.write(frames)
"""
REFUSES = """#!/bin/sh
echo "Unknown encoder 'libx264'" >&2
echo "and more" >&2
exit 1
"""


class Film(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="altiplan_film_")
        for name, text in (("scenario.yaml", SCENARIO), ("pipeline.yaml", PIPELINE)):
            with open(os.path.join(cls.folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        subprocess.run([PROGRAM, "run", "pipeline.yaml", "--out", "result.json"], check=True,
                       cwd=cls.folder, capture_output=True)
        os.mkdir(os.path.join(cls.folder, "tmp"))
        os.mkdir(os.path.join(cls.folder, "bin"))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def read(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()

    def tearDown(self):
        self.assertEqual(os.listdir(self.path("tmp")), [])

    def stand_in(self, text):
        """An ffmpeg that is found before any other."""
        with open(self.path("bin/ffmpeg"), "w", encoding="utf-8") as file:
            file.write(text)
        os.chmod(self.path("bin/ffmpeg"), 0o755)
        return {**self.environment(), "PATH": self.path("bin") + ":" + os.environ["PATH"]}

    def environment(self):
        return {**os.environ, "TMPDIR": self.path("tmp")}

    def view(self, *options, environment, code=0):
        done = subprocess.run([PROGRAM, "view", "result.json", "--mp4", "film.mp4", *options],
                              cwd=self.folder, capture_output=True, text=True, timeout=HANGS_S,
                              env=environment)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stdout, done.stderr

    def test_frames(self):
        """Each is a picture, and they differ while the vehicle moves."""
        out, err = self.view("--mp4-seconds", "1", environment=self.stand_in(KEEPS))
        self.assertEqual((out, err), (out, ""))
        self.assertRegex(out, r"^film\.mp4: \d+\.\d\d MB: 1 s\n$")
        frames = self.read("film.mp4").split(b"\xff\xd8\xff\xe0")[1:]
        self.assertEqual(len(frames), 25)
        for frame in frames:
            size = re.search(rb"\xff\xc0\x00\x11\x08(....)", frame, re.DOTALL)[1]
            self.assertEqual((int.from_bytes(size[2:]), int.from_bytes(size[:2])), (1280, 720))
        self.assertEqual(len(set(frames[4:22])), 18)

    def test_an_encoder_that_fails(self):
        with open(self.path("film.mp4"), "w", encoding="utf-8") as file:
            file.write("before")
        _, err = self.view("--mp4-seconds", "1", environment=self.stand_in(REFUSES), code=3)
        self.assertEqual(err, f"altiplan: '{self.path('bin/ffmpeg')}' did not make the film: "
                              "Unknown encoder 'libx264'\n")
        self.assertEqual(self.read("film.mp4"), b"before")

    def test_an_interruption(self):
        """While Chromium draws the frames."""
        environment = self.stand_in(KEEPS.replace("frames = ", "open('%s', 'w').close()\nframes = " %
                                                  self.path("begun")))
        call = subprocess.Popen([PROGRAM, "view", "result.json", "--mp4", "other.mp4"],
                                cwd=self.folder, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, env=environment)
        self.addCleanup(call.stderr.close)
        self.addCleanup(call.kill)
        end = time.monotonic() + HANGS_S
        while not os.path.exists(self.path("begun")):
            self.assertIsNone(call.poll(), "ended by itself")
            self.assertLess(time.monotonic(), end)
            time.sleep(0.05)
        call.send_signal(signal.SIGINT)
        self.assertEqual(call.wait(timeout=HANGS_S), 130)
        self.assertFalse(os.path.exists(self.path("other.mp4")))

    @unittest.skipUnless(shutil.which("ffmpeg") and shutil.which("ffprobe"), "needs Debian's ffmpeg")
    def test_the_film(self):
        self.view("--mp4-seconds", "2", environment=self.environment())
        done = subprocess.run(["ffprobe", "-v", "error", "-of", "json", "-show_streams",
                               self.path("film.mp4")], capture_output=True, check=True)
        [stream] = json.loads(done.stdout)["streams"]
        self.assertEqual([stream[key] for key in ("codec_name", "pix_fmt", "width", "height",
                                                  "nb_frames", "avg_frame_rate")],
                         ["h264", "yuv420p", 1280, 720, "50", "25/1"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
