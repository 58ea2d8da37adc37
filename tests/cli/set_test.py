# SPDX-License-Identifier: Apache-2.0
"""set_test.py PROGRAM SOURCES: altiplan set changes values in place, and nothing else."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
CONFIGS = pathlib.Path(SOURCES) / "configs"


class Set(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for part in ("pipelines/ridge_crossing.yaml", "scenarios/jacksboro_ridge.yaml",
                     "data/jacksboro_fault.tif"):
            (self.folder / part).parent.mkdir(exist_ok=True)
            shutil.copy(CONFIGS / part, self.folder / part)
        self.pipeline = self.folder / "pipelines/ridge_crossing.yaml"
        self.scenario = self.folder / "scenarios/jacksboro_ridge.yaml"

    def call(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, capture_output=True,
                              text=True, timeout=600, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def result(self, *arguments):
        self.call("run", self.pipeline, "--out", "r.json", *arguments)
        text = (self.folder / "r.json").read_text()
        return json.loads(text)["route"]

    def test_both_files(self):
        before = [self.pipeline.read_text(), self.scenario.read_text()]
        changes = ["steps.0.with.weight_g=0.6", "scenario.goal.at_m=[22000, 22500]",
                   "scenario.environment.1.radar.range_m=3400"]
        said = self.call("set", self.pipeline, *changes)
        self.assertEqual(said.count("written"), 2, said)
        after = [self.pipeline.read_text(), self.scenario.read_text()]
        self.assertEqual(after[0], before[0].replace("weight_g: 0.5", "weight_g: 0.6"))
        self.assertEqual(after[1], before[1].replace("[23000, 23500]", "[22000, 22500]").replace(
            "range_m: 3500", "range_m: 3400"))
        self.assertEqual(self.call("set", self.pipeline, *changes), "")  # as it is

    def test_a_run_is_the_same_as_with_overrides(self):
        changes = ["scenario.goal.at_m=[22000, 22500]", "scenario.vehicle.radius_m=8"]
        expected = self.result(*[word for change in changes for word in ("--set", change)])
        self.call("set", self.scenario, *[change.removeprefix("scenario.") for change in changes])
        self.assertEqual(self.result(), expected)

    def test_a_layer_is_added_and_another_removed(self):
        changes = ["scenario.environment.4={cylinder: {at_m: [12000, 9000], radius_m: 900}}",
                   "~scenario.environment.1"]
        expected = self.result(*[word for change in changes for word in ("--set", change)])
        stored = json.loads((self.folder / "r.json").read_text())["overrides"]["set"]
        self.assertEqual(stored, changes)
        self.call("check", "r.json")  # with the same overrides
        lines = self.scenario.read_text().splitlines()
        self.call("set", self.pipeline, *changes)
        left = self.scenario.read_text().splitlines()
        self.assertEqual(len(left), len(lines) + 1 - len(set(lines) - set(left)))
        self.assertEqual(self.result(), expected)

    def test_nothing_is_written_if_anything_is_wrong(self):
        before = [self.pipeline.read_bytes(), self.scenario.read_bytes()]
        for changes, sentence in (
                (["steps.0.with.weight_g=0.6", "steps.0.with.weight_x=1"], "weight_x"),
                (["scenario.goal.at_m=[1]"], "scenario.goal.at_m=[1]"),
                (["steps.9.with.weight_g=1"], "is not an index of this list"),
                (["weight_g"], "expected KEY=VALUE")):
            said = self.call("set", self.pipeline, *changes, code=3)
            self.assertIn(sentence, said)
        self.assertEqual([self.pipeline.read_bytes(), self.scenario.read_bytes()], before)
        study = CONFIGS / "studies/quick.yaml"
        self.assertIn("expected a pipeline or a scenario", self.call("set", study, "a=1", code=3))
        self.call("set", self.folder / "none.yaml", "a=1", code=3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
