# SPDX-License-Identifier: Apache-2.0
"""scenes_test.py PROGRAM PLUGINS: what `altiplan run` and `altiplan view` make, in headless
Chromium: drawn points are the results'.

PLUGINS is the folder of the tests' own plugins. `scenes_test.py PROGRAM PLUGINS Real.test_ridge`
runs one case; skipped without Chromium."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

from case import Case

PROGRAM, PLUGINS = sys.argv[1:3]
CONFIGS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "configs")
RIDGE = os.path.join(CONFIGS, "pipelines", "ridge_crossing.yaml")
# Beside the README's world: a zone, an obstacle on the move, and one that comes and goes.
MORE = """  - zones:
      list:
        - polygon: {outline_m: [[20000, 6000], [26000, 7000], [25000, 11000], [20500, 10000]],
                    holes_m: [[[22000, 8000], [23000, 8000], [23000, 9000]]]}
          kind: keep_out
          id: reserve
          ceiling_m: 1500
moving:
  - sphere: {at_m: [9000, 20000, 1200], radius_m: 150, velocity_mps: [8, 0, 0]}
    id: balloon
    known: false
events:
  - {at_s: 300, id: pop_up, add: {cylinder: {at_m: [8000, 26000], radius_m: 900}}}
  - {at_s: 900, remove: pop_up}
volume:"""
SMALL = """altiplan: 1
environment: [LAYERS]
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100], tolerance_m: 5}
"""
PLANNED = """altiplan: 1
scenario: scenario.yaml
steps:
  - plan: astar
    with: {cell_m: [50, 50, 50]}
"""


class Real(Case):
    def setUp(self):
        super().setUp()
        self.folder = tempfile.mkdtemp(prefix="altiplan_scenes_")
        self.addCleanup(shutil.rmtree, self.folder)

    def write(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def call(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, *arguments, "--plugin-path", PLUGINS], cwd=self.folder,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done.stdout

    def run_pipeline(self, pipeline, name, *arguments, code=0):
        self.call("run", pipeline, "--out", name, *arguments, code=code)
        with open(os.path.join(self.folder, name), encoding="utf-8") as file:
            return json.load(file)

    def view(self, *arguments):
        self.call("view", *arguments, "-o", "page.html")
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            page = file.read()
        self.browser.open(page)
        self.assertTrue(self.run_js("return altiplan.ready"))
        return page

    def assert_drawn(self, results):
        """What is in the buffers is what was planned and flown, to a centimetre."""
        drawn = self.drawn()
        routes = [(index, result["route"]) for index, result in enumerate(results)
                  if result["route"]]
        self.assertEqual([route["result"] for route in drawn["routes"]],
                         [index for index, _ in routes])
        for shown, (_, route) in zip(drawn["routes"], routes):
            self.assert_points(shown["points"], route)
        tracks = [result["flight"]["track"] for result in results if result["flight"]]
        for shown, track in zip(drawn["tracks"], tracks, strict=True):
            self.assert_points(shown["points"], [point[1:] for point in track])
        return drawn

    def test_ridge(self):
        with open(os.path.join(CONFIGS, "scenarios", "jacksboro_ridge.yaml")) as file:
            scenario = file.read().replace("../data", os.path.join(CONFIGS, "data"))
        self.assertEqual(scenario.count("\nvolume:"), 1)
        scenario = self.write("scenario.yaml", scenario.replace("volume:", MORE))
        results = [
            self.run_pipeline(RIDGE, "one.json", "--scenario", scenario, "--trace", "trace.jsonl"),
            self.run_pipeline(RIDGE, "two.json", "--scenario", scenario,
                              "--set", "steps.0.with.weight_g=0.9")]
        page = self.view("one.json", "two.json")
        self.assertLess(len(page), 4e6)
        drawn = self.assert_drawn(results)
        self.assertEqual(drawn["solids"], 5, "two radars, the site, the zone, the pop-up")
        self.assertEqual([moving["id"] for moving in drawn["moving"]], ["balloon"])
        ground = drawn["ground"]
        self.assertEqual((ground["nx"], ground["ny"]), (398, 343))
        self.assertAlmostEqual(ground["min"], 236, delta=0.01)
        self.assertAlmostEqual(ground["max"], 1076, delta=0.01)
        self.browser.picture(os.environ.get("ALTIPLAN_PICTURES", self.folder) + "/ridge.png")

    def test_a_layer_that_says_only_how_far_it_is(self):
        self.write("scenario.yaml", SMALL.replace("LAYERS", "ball: {}"))
        result = self.run_pipeline(self.write("pipeline.yaml", PLANNED), "result.json")
        self.assertGreater(result["metrics"]["length_m"], 800)
        page = self.view("result.json")
        drawn = self.assert_drawn([result])
        self.assertGreater(drawn["solids"], 1000)
        self.assertIn("ball: drawn as cells of 1.6 x 1.6 x 1.6 m", page)
        self.browser.picture(os.environ.get("ALTIPLAN_PICTURES", self.folder) + "/ball.png")

    def test_a_result_without_a_route(self):
        wall = "{box: {min_m: [400, -1, -1], max_m: [410, 1001, 300]}}"
        self.write("scenario.yaml", SMALL.replace("LAYERS", wall))
        result = self.run_pipeline(self.write("pipeline.yaml", PLANNED), "result.json", code=1)
        self.assertIsNone(result["route"])
        self.view("result.json")
        drawn = self.assert_drawn([result])
        self.assertEqual(drawn["solids"], 1)
        self.assertIn(result["message"], self.text("body"))

    def test_pictures(self):
        """Of the page, as Chromium draws it; and from above, as any program reads it."""
        self.write("scenario.yaml", SMALL.replace("LAYERS", "ball: {}"))
        self.run_pipeline(self.write("pipeline.yaml", PLANNED), "result.json")
        self.call("view", "result.json", "--png", "page.png", "--svg", "above.svg")
        with open(os.path.join(self.folder, "page.png"), "rb") as file:
            header = file.read(24)
        self.assertEqual(struct.unpack(">8s8xII", header), (b"\x89PNG\r\n\x1a\n", 1600, 1000))
        with open(os.path.join(self.folder, "above.svg"), encoding="utf-8") as file:
            svg = file.read()
        self.browser.open("<!DOCTYPE html><script>altiplan = {errors: []}</script>" + svg)
        self.assertEqual(self.run_js("const {x, y, width, height} = document."
                                     "querySelector('svg').getBBox(); const all = document."
                                     "querySelector('svg').viewBox.baseVal; return [x, y, width - "
                                     "all.width, height - all.height].map(Math.round)"),
                         [0, 0, 0, 0], "nothing stands out of the picture")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
