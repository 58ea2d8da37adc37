# SPDX-License-Identifier: Apache-2.0
"""Base of the tests of the Python package: a folder with a scenario and a pipeline.

The arguments of each test are PROGRAM, PLUGINS, the folder of the plugins of tests, and SOURCES."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY, by_day, by_night  # noqa: E402, F401

PROGRAM, PLUGINS = sys.argv[1:3]
SOURCES = pathlib.Path(sys.argv[3])
PIPELINES = SOURCES / "configs/pipelines"
SANITIZED = bool(os.environ.get("ALTIPLAN_SANITIZED"))  # limits of time and memory are not the same
HANGS_S = 600 if SANITIZED else 120  # longer than anything takes that ends at all
UNHURRIED = {"steps.0.within_s": HANGS_S}  # of PIPELINES, whose searches have seconds

# A wall between start and goal that can be passed on either side, and a post that is seen in flight.
SCENARIO = """altiplan: 1
environment:
  - box: {min_m: [300, 300, 0], max_m: [310, 700, 1000]}
    id: wall
  - cylinder: {at_m: [700, 900], radius_m: 30}
    id: post
    known: false
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
vehicle: {radius_m: 2}
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


def untimed(text):
    """A result without its wall times."""
    return re.sub(r'("\w*time_s": )[-+.e0-9]+', r"\1 0", text)


class PythonCase(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="altiplan_python_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.scenario = self.write("scenario.yaml", SCENARIO)
        self.pipeline = self.write("pipeline.yaml", PIPELINE)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return self.folder / name

    def rogue(self, does, more=""):
        """A pipeline with a planner that misbehaves."""
        return self.write(f"{does}.yaml", f"altiplan: 1\nscenario: scenario.yaml\nsteps:\n"
                          f"  - {{plan: rogue, with: {{does: {does}}}{more}}}\n")

    def python(self, code, *arguments, code_expected=0, **more):
        """What a script prints, in a process of its own; fails unless it ends with this code."""
        done = subprocess.run([sys.executable, "-c", code, *map(str, arguments)], text=True,
                              cwd=self.folder, capture_output=True, timeout=HANGS_S, **more)
        self.assertEqual(done.returncode, code_expected, done.stdout + done.stderr)
        return done.stdout


def main():
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
