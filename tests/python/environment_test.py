# SPDX-License-Identifier: Apache-2.0
"""environment_test.py PROGRAM PLUGINS SOURCES: layers written in Python are those of scenarios and files."""
import unittest

import numpy
from case import SANITIZED, by_day
from script_case import ScriptCase, few_by_day, main

import altiplan

HEAD = """{head}import altiplan

@altiplan.parameters
class Params:
    top_m: float = altiplan.parameter(80.0, unit="m", doc="a height")

@altiplan.environment("tested", "A layer of a test", Params)
class Tested:
    def __init__(self, params):
        self.params = params

    def build(self, site):
        {body}
"""
SCENARIO = """altiplan: 1
environment:
  {layers}
volume: {{min_m: [0, 0, 0], max_m: [1000, 1000, 200]}}
vehicle: {{radius_m: 2}}
start: {{at_m: [100, 500, 100]}}
goal: {{at_m: [900, 500, 100], tolerance_m: 5}}
"""
SOLIDS = {"box": "{min_m: [300, 300, 0], max_m: [310, 700, 90]}",
          "cylinder": "{at_m: [700, 500], radius_m: 30, floor_m: 20}",
          "sphere": "{at_m: [500, 500, 80], radius_m: 40}",
          "prism": "{outline_m: [[100, 100], [200, 120], [150, 200]], ceiling_m: 120}"}
IN_PYTHON = """return [{"box": {"min_m": (300, 300, 0), "max_m": [310, 700, self.params.top_m + 10]}},
    {"cylinder": {"at_m": (700, 500), "radius_m": 30, "floor_m": 20}},
    {"sphere": {"at_m": (500, 500, 80), "radius_m": 40}},
    {"prism": {"outline_m": [(100, 100), (200, 120), (150, 200)], "ceiling_m": 120}}]"""
GROUND = "return altiplan.Ground([[0, 10, 20], [5, 60, 5], [30, 20, 10]], (500, 400), (0, 0))"
WRONG = {  # what build does: what is said
    "return None": "TypeError: build: expected a list of solids, Ground or Cells, found NoneType",
    "return [3]": "TypeError: solid 0: expected a dict such as",
    "return [{'box': {}, 'sphere': {}}]": "TypeError: solid 0: expected a dict such as",
    "return [{'cube': {}}]": "solid 0: expected one of sphere, cylinder, box, prism, found 'cube'",
    "return [{'box': {'min_m': (0, 0, 0)}}]": "solid 0.box: the key 'max_m' is missing",
    "return [{'sphere': {'at_m': (0, 0, 0), 'radius_m': 5, 'radius': 5}}]": "unknown key",
    "return [{'sphere': {'at_m': (0, 0, 0), 'radius_m': float('nan')}}]": "expected a finite number",
    "return [{'sphere': {'at_m': (0, 0, 0), 'radius_m': object()}}]": "found object",
    "return [{'sphere': {'at_lonlat': (7, 50, 10), 'radius_m': 5}}]": "the world has no geographic position",
    "return altiplan.Ground([[1, 2]], 10)": "expected 2 posts or more along each axis",
    "return altiplan.Ground([[1, 2], [1]], 10)": "expected rows of the same length",
    "return altiplan.Ground([1, 2], 10)": "heights: expected numbers in 2 dimensions",
    "return altiplan.Ground([[1, 2], [1, float('nan')]], 10)": "expected a finite number at each post",
    "return altiplan.Ground([[1, 2], [1, 2]], 0)": "spacings above 0",
    "return altiplan.Ground([[1, 2], [1, 2]], (1, 2, 3))": "spacing_m: expected 2 numbers, found 3",
    "return altiplan.Cells([[[True]]], -1)": "cell_m: expected edges above 0",
    "return altiplan.Cells([[[-1, 0.5]]], 1)": "blocked: expected True or False, or 1 or 0",
    "return altiplan.Ground([[1, 2], [1, 1e300]], 10)": "expected a finite number at each post",
    "return altiplan.Ground([[1, 2], [1, 2]], None)": "spacing_m: expected 2 numbers, or one",
    "return [{'sphere': {'at_m': (0, 0, 0), 'radius_m': 10**400}}]": "expected a finite number",
    "raise ValueError('a\\n\x1b[31mb')": "ValueError: a  [31mb",
    "return altiplan.Cells([[True]], 1)": "blocked: expected numbers in 3 dimensions",
    "site.world.clearance([(1, 2)])": "expected points of 3 numbers",
    "site.to_local([(7, 50)])": "the world has no geographic position",
    "import os; os._exit(3)": "ended its process with exit code 3",
    "import ctypes; ctypes.string_at(0)": "crashed (SIGSEGV)",
    "raise ValueError('the attic')": "threw: ValueError: the attic (tested.py:13)",
}


class Layers(ScriptCase):
    def layer(self, body, head=""):
        self.write("tested.py", HEAD.format(body=body.replace("\n", "\n        "), head=head))

    def world(self, *layers, **more):
        """A world of these layers, as YAML."""
        file = self.write("s.yaml", SCENARIO.format(layers="\n  ".join(f"- {one}" for one in layers)))
        return altiplan.World(file, plugin_path=[self.folder], **more)

    def expect_equal(self, one, other):
        random = numpy.random.default_rng(1)
        low, high = numpy.array([-200, -200, -50]), numpy.array([1200, 1200, 250])
        a, b = (random.uniform(low, high, (2000, 3)) for _ in range(2))
        numpy.testing.assert_array_equal(one.clearance(a), other.clearance(a))
        numpy.testing.assert_array_equal(one.ground(a[:, :2]), other.ground(a[:, :2]))
        for radius in (0, 10):
            blocked = one.legs_blocked(a, a + (b - a) / 5, radius)
            numpy.testing.assert_array_equal(blocked, other.legs_blocked(a, a + (b - a) / 5, radius))
            self.assertTrue(blocked.any() and not blocked.all())

    def test_solids_are_those_of_a_scenario(self):
        self.layer(IN_PYTHON)
        self.expect_equal(self.world("tested: {}"),
                          self.world(*(f"{kind}: {keys}" for kind, keys in SOLIDS.items())))
        self.assertEqual(self.workers(), [])

    def test_ground_is_that_of_a_file(self):
        self.layer(GROUND)
        self.write("g.asc", "ncols 3\nnrows 3\nxllcenter 0\nyllcenter 0\ndx 500\ndy 400\n"
                   "30 20 10\n5 60 5\n0 10 20\n")
        self.expect_equal(self.world("tested: {}"), self.world("terrain: {file: g.asc, crs: EPSG:32632}"))

    def test_cells(self):
        self.layer("blocked = numpy.zeros((4, 3, 2), bool)\nblocked[1, 2, 0] = blocked[3, 0, 1] = True\n"
                   "return altiplan.Cells(blocked, (100, 200, 50), (50, 0, 10))", head="import numpy\n")
        self.expect_equal(self.world("tested: {}"), self.world(
            "box: {min_m: [150, 400, 10], max_m: [250, 600, 60]}",
            "box: {min_m: [350, 0, 60], max_m: [450, 200, 110]}"))
        self.layer("return altiplan.Cells([[[0, 1], [1, 0]]], 100)")  # without numpy
        numpy.testing.assert_array_equal(self.world("tested: {}").clearance(
            [(50, 50, 150), (50, 50, 50), (50, 150, 50)]) < 0, [True, False, True])

    def test_the_site(self):
        self.layer("assert site.volume == [(0.0, 0.0, 0.0), (1000.0, 1000.0, 200.0)], site.volume\n"
                   "assert site.start == (100, 500, 100) and site.vehicle['radius_m'] == 2\n"
                   "assert site.start_time_s is None and site.world.layers == ['box', 'g'], site.world.layers\n"
                   "assert site.world.clearance([(305, 500, 50)])[0] < 0\n"
                   "(x, y), = site.to_local([(9, 46)])\nheight, = site.world.ground([(500, 400)])\n"
                   "return [{'sphere': {'at_m': (500, 400, height), 'radius_m': 1 + site.rng.random()}}]")
        self.write("g.asc", "ncols 3\nnrows 3\nxllcenter 500000\nyllcenter 5000000\ndx 500\ndy 400\n"
                   "30 20 10\n5 60 5\n0 10 20\n")
        layers = (f"box: {SOLIDS['box']}", "terrain: {file: g.asc, crs: EPSG:32632}\n    id: g",
                  "tested: {}")
        worlds = [self.world(*layers) for _ in range(2)]
        at = [(500, 400, 65)]
        self.assertTrue(60 < 65 - worlds[0].clearance(at)[0] < 62.0001)
        self.assertEqual(worlds[0].clearance(at), worlds[1].clearance(at))

    def test_wrong_layers(self):
        pipeline = self.write("p.yaml", "altiplan: 1\nscenario: s.yaml\nsteps: [{plan: rrt}]\n")
        self.write("s.yaml", SCENARIO.format(layers="- tested: {}"))
        for body, says in by_day(WRONG.items(), 2):
            with self.subTest(body=body):
                self.layer(body)
                is_of_the_files = "geographic" in says
                done = self.altiplan("run", pipeline, code=3 if is_of_the_files else 4)
                self.assertIn(says, done.stderr)
                self.assertIn("environment.0.tested", done.stderr)
                self.assertEqual(self.workers(), [])

    def test_parameters(self):
        self.layer("raise ValueError(self.params.top_m)")
        with self.assertRaisesRegex(altiplan.Error, "expected a number"):
            self.world("tested: {top_m: high}")
        with self.assertRaisesRegex(altiplan.Error, "ValueError: 7.0"):
            self.world("tested: {top_m: 7}")

    def test_a_run_and_its_page(self):
        self.layer(IN_PYTHON)
        self.write("s.yaml", SCENARIO.format(layers="- tested: {}"))
        pipeline = self.write("p.yaml", "altiplan: 1\nscenario: s.yaml\nsteps:\n"
                              "  - {plan: astar, with: {cell_m: [50, 50, 50]}}\n")
        result, _ = self.result(pipeline, "--out", "r.json")
        self.assertEqual(result["status"], "solved")
        self.altiplan("view", "r.json", "--out", "page.html")
        self.assertIn("tested", (self.folder / "page.html").read_text())

    @unittest.skipIf(SANITIZED, "limits of time")
    def test_a_new_environment(self):
        self.altiplan("new", "environment", "poles", "--python")
        done = self.altiplan("check-plugin", "poles.py", "--time-limit", 300, "--jobs", 2, *few_by_day)
        self.assertIn("0 failed", done.stdout)

    @unittest.skipIf(SANITIZED, "limits of time")
    def test_ground_and_cells_keep_the_contract(self):
        for body in by_day([GROUND, "return altiplan.Cells([[[0, 1], [1, 0]]], 100)", IN_PYTHON], 3):
            self.layer(body)
            done = self.altiplan("check-plugin", "tested.py", "--time-limit", 300, "--jobs", 2, *few_by_day or ["--rounds", 5])
            self.assertIn("0 failed", done.stdout)


if __name__ == "__main__":
    main()
