# SPDX-License-Identifier: Apache-2.0
"""Base of the command-line tests: a folder with a scenario and pipelines.

The arguments of each test are PROGRAM and BROKEN, the folder of the unusable libraries."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import by_day, by_night  # noqa: E402, F401

PROGRAM, BROKEN = sys.argv[1:3]

# A wall between start and goal that can be passed on either side, and a post behind it.
SCENARIO = """altiplan: 1
environment:
  - box: {min_m: [300, 300, 0], max_m: [310, 700, 1000]}
    id: wall
  - cylinder: {at_m: [700, 500], radius_m: 30}
    id: post
    known: KNOWN
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
vehicle: {radius_m: 2, sensing_m: 300}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100], tolerance_m: 5}
"""
PIPELINE = """altiplan: 1
scenario: scenario.yaml
seed: 3
steps:
  - plan: astar
    with: {cell_m: [50, 50, 50]}
"""
# The goal in a closed shell: a search expands the whole lattice before it fails.
SEALED = """altiplan: 1
environment:
  - box: {min_m: [800, 400, 50], max_m: [1000, 410, 150]}
  - box: {min_m: [800, 590, 50], max_m: [1000, 600, 150]}
  - box: {min_m: [800, 400, 50], max_m: [810, 600, 150]}
  - box: {min_m: [990, 400, 50], max_m: [1000, 600, 150]}
  - box: {min_m: [800, 400, 50], max_m: [1000, 600, 60]}
  - box: {min_m: [800, 400, 140], max_m: [1000, 600, 150]}
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100]}
"""


class CliCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_cli_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "true"))
        self.pipeline = self.write("pipeline.yaml", PIPELINE)
        self.sealed = self.write("sealed.yaml", SEALED)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as stream:
            stream.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name)) as stream:
            return stream.read()

    def call(self, *arguments, code=0, stdout=subprocess.PIPE):
        """The program's output on stdout and on stderr; fails unless it ends with this code."""
        done = subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, stdout=stdout,
                              stderr=subprocess.PIPE, text=True, cwd=self.folder, timeout=600)
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done.stdout, done.stderr

    def result(self, *arguments, code=0):
        out, _ = self.call("run", "--json", *arguments, code=code)
        return json.loads(out)


def main():
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
