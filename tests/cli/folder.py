# SPDX-License-Identifier: Apache-2.0
"""Base of the tests of input, output and interruptions: a folder of files.

The arguments of each test are PROGRAM, PLUGINS and FAULTS: PLUGINS is the folder of the plugins that
misbehave, FAULTS the library that makes system calls fail ("" for none). Each call has a time limit,
because the defects tested for would make it hang."""
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import unittest

PROGRAM, PLUGINS, FAULTS = sys.argv[1:4]
HANGS_S = 60

SCENARIO = """altiplan: 1
environment:
  - box: {min_m: [300, 300, 0], max_m: [310, 700, 1000]}
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
frame: {origin_lonlat: [24.9, 60.2]}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100], tolerance_m: 5}
"""
PIPELINE = """altiplan: 1
scenario: scenario.yaml
steps:
  - plan: astar
    with: {cell_m: [50, 50, 50]}
"""
STUDY = """altiplan: 1
scenarios: [{file: scenario.yaml}]
pipelines: [{id: it, file: pipeline.yaml}]
"""
KINDS = {"pipe": "is a pipe", "socket": "is a socket", "device": "is a device",
         "folder": "is a folder"}


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_files_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("scenario.yaml", SCENARIO)
        self.write("pipeline.yaml", PIPELINE)
        self.write("study.yaml", STUDY)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return name

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def names(self):
        return sorted(os.listdir(self.folder))

    def make(self, kind, name):
        """Creates something other than a regular file under that name."""
        if os.path.lexists(self.path(name)):
            os.remove(self.path(name))
        if kind == "pipe":
            os.mkfifo(self.path(name))
        elif kind == "socket":
            here = os.getcwd()
            os.chdir(self.folder)  # the path of a socket has a length limit
            try:
                with socket.socket(socket.AF_UNIX) as made:
                    made.bind(name)
            finally:
                os.chdir(here)
        elif kind == "device":
            os.symlink("/dev/zero", self.path(name))  # a link, since creating a device needs root
        else:
            os.mkdir(self.path(name))
        return name

    def remove(self, name):
        if os.path.isdir(self.path(name)):
            os.rmdir(self.path(name))
        else:
            os.remove(self.path(name))

    def call(self, *arguments, code=0, **more):
        done = subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, cwd=self.folder,
                              capture_output=True, text=True, timeout=HANGS_S, **more)
        self.assertEqual(done.returncode, code, (arguments, done.stdout[-1000:], done.stderr))
        return done.stdout, done.stderr

    def result(self, name="result.json", *arguments):
        self.call("run", "pipeline.yaml", "--out", name, *arguments)
        return name

    def refused(self, said, *arguments):
        """Checks that the call ends with 3 and one line on stderr."""
        _, err = self.call(*arguments, code=3)
        self.assertIn(said, err, arguments)
        self.assertEqual(len(err.splitlines()), 1, (arguments, err))


def main():
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
