# SPDX-License-Identifier: Apache-2.0
"""What the tests of `altiplan tune` begin with: mostly a planner whose route is the longer the further its
parameters are from what the scenario likes best. Their arguments are PROGRAM and PLUGINS."""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:3])
SANITIZED = bool(os.environ.get("ALTIPLAN_SANITIZED"))

SCENARIO = """altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 1000]}
start: {at_m: [100, 300, 500]}
goal: {at_m: [900, 300, 500]}
"""
PIPELINE = """# SPDX-License-Identifier: Apache-2.0
altiplan: 1
scenario: scenarios/s.yaml    # where it is flown
seed: 3
steps:
  - plan: tunable
    id: route
    with:
      # x comes first.
      x: 0.9        # of course
      list: [0.1, 0.2]
"""
X = ("--over", "steps.0.with.x=0..1")
SMALL = ("--set-tuner", "particles=4", "--set-tuner", "iterations=5")
FILES = {"settings.json", "runs.log", "evaluations.csv", "convergence.svg", "summary.json",
         "tuned.yaml"}


class TuneCase(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_tune_")
        self.addCleanup(shutil.rmtree, self.folder)
        os.mkdir(self.path("scenarios"))
        self.write("scenarios/s.yaml", SCENARIO)
        self.write("p.yaml", PIPELINE)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as stream:
            stream.write(text)

    def read(self, *names):
        with open(self.path(*names), encoding="utf-8") as stream:
            return stream.read()

    def arguments(self, *words, out="out", metric="length_m", size=SMALL):
        return [PROGRAM, "tune", "p.yaml", "--metric", metric, "--out", out, "--plugin-path",
                PLUGINS, *map(str, words), *size]

    def tune(self, *words, expect=0, **options):
        done = subprocess.run(self.arguments(*words, **options), cwd=self.folder, text=True,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=600)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def refused(self, *words, expect=3, **options):
        """The one sentence of a call that ends at once."""
        done = subprocess.run(self.arguments(*words, **options), cwd=self.folder, text=True,
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=600)
        self.assertEqual((done.returncode, done.stdout), (expect, ""), done.stdout + done.stderr)
        if expect != 2:  # there a hint at --help follows
            self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
        return done.stderr

    def evaluations(self, out="out"):
        with open(self.path(out, "evaluations.csv"), newline="", encoding="utf-8") as stream:
            return list(csv.DictReader(stream))

    def summary(self, out="out"):
        return json.loads(self.read(out, "summary.json"))

    def results(self, out):
        """Every byte of a finished tuning; tuned.yaml is called from its own folder. What a kill left
        beside the files does not count."""
        return {name: self.read(out, name) for name in os.listdir(self.path(out))
                if not name.endswith(".partial")}


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
