# SPDX-License-Identifier: Apache-2.0
"""referee_test.py PROGRAM [CASE…]: routes and flights made by hand, judged by altiplan and the referee."""
import json
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import curved
import grazing
import page
import referee
import rules
import scenario as scenarios
import worlds

PROGRAM = os.path.abspath(sys.argv.pop(1))


class Folder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def altiplan(self, *arguments):
        done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=600,
                              check=False)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return done.stdout

    def check(self, scenario, route):
        """(what altiplan says of the route, what the referee finds different)"""
        path = worlds.write(self.folder, "route.json", [[float(v) for v in p] for p in route])
        file = worlds.write(self.folder, "scenario.yaml", scenario)
        told = json.loads(self.altiplan("check", "--route", path, "--scenario", file, "--json"))
        mission = scenarios.of_file(file)
        return told, referee.judge_route(mission, rules.limits_of(mission), np.array(route),
                                         told["check"], told["metrics"], "route")

    def run_of(self, scenario, pipeline):
        worlds.write(self.folder, "scenario.yaml", scenario)
        path = worlds.write(self.folder, "pipeline.yaml",
                            {"altiplan": 1, "scenario": "scenario.yaml", "seed": 1, **pipeline})
        out = os.path.join(self.folder, "result.json")
        self.altiplan("run", path, "--out", out)
        with open(out, encoding="utf-8") as file:
            return json.load(file)


class Grazing(Folder):
    """Past every kind of limit by a hair, on either side."""

    def hold(self, margin, radius):
        for name, scenario, route in grazing.cases(margin, radius, self.folder):
            with self.subTest(name, margin=margin, radius=radius):
                told, differences = self.check(scenario, route)
                self.assertEqual(told["check"]["ok"], margin > 0, told["check"]["violations"])
                self.assertEqual(differences, [])

    def test_a_hair_aside(self):
        self.hold(1e-5, 2.0)

    def test_a_hair_too_near(self):
        self.hold(-1e-5, 2.0)

    def test_a_point_aside(self):
        self.hold(4e-6, 0.0)

    def test_a_point_too_near(self):
        self.hold(-4e-6, 0.0)

    def test_nightly_margins(self):
        if not os.environ.get("ALTIPLAN_NIGHTLY"):
            self.skipTest("by night")
        for margin in (1e-1, 1e-2, 1e-3, 1e-4, 3e-5, 5e-6):
            for radius in (0.0, 0.3, 2.0, 25.0):
                self.hold(margin, radius)
                self.hold(-margin, radius)


class Known(Folder):
    """What an earlier version did wrong, found by the referee."""

    BALL = [{"sphere": {"at_m": [500, 500, 100], "radius_m": 50}}]

    def test_a_vertical_leg_hides_no_turn(self):
        for turn, limit, climb in ((90, 30, 1e-9), (175, 5, 1e-9), (90, 30, 5e-7), (90, 30, 40)):
            with self.subTest(turn=turn, climb=climb):
                route = grazing.bend(turn)
                up = np.array([0, 0, climb])
                route = [*route[:2], route[1] + up, route[2] + up]
                told, differences = self.check(
                    grazing.scenario(route, (), [{"turn_angle": {"max_deg": limit}}]), route)
                self.assertFalse(told["check"]["ok"])
                self.assertAlmostEqual(told["metrics"]["max_turn_deg"], turn)
                self.assertEqual(differences, [])

    def test_searches_hide_no_turn(self):
        """In the city of which straight climbs make the way: what is found keeps the limit."""
        towers = [{"box": {"min_m": [100 * i + 40, 100 * j + 40, 0],
                           "max_m": [100 * i + 90, 100 * j + 90, 260 + 20 * ((i + j) % 3)]}}
                  for i in range(5) for j in range(5)]
        route = [[15, 15, 45], [455, 515, 45]]
        scenario = grazing.scenario(route, towers)
        scenario["volume"] = {"min_m": [0, 0, 0], "max_m": [600, 600, 400]}
        for planner in ("astar", "bidirectional_astar", "dstar_lite", "theta_star", "lazy_theta_star"):
            with self.subTest(planner):
                result = self.run_of(scenario, {
                    "constraints": [{"turn_angle": {"max_deg": 30}}],
                    "steps": [{"plan": planner, "with": {"cell_m": [10, 10, 10]}},
                              {"smooth": "prune"}]})
                self.assertEqual(referee.judge_result(result), [])

    def test_a_radius_is_that_of_the_fillet(self):
        """Cells of 400 m with corners of 90 degrees: no circle of 250 m fits in their halves."""
        route = [[0, 0, 0], [400, 0, 0], [400, 400, 0], [800, 400, 0]]
        told, differences = self.check(
            grazing.scenario(route, (), [{"turn_radius": {"min_m": 250}}]), route)
        self.assertFalse(told["check"]["ok"])
        self.assertAlmostEqual(told["metrics"]["min_radius_m"], 200)
        self.assertEqual(differences, [])

    def test_a_waypoint_in_a_ball(self):
        route = [[300, 500, 100], [450 + 2e-6, 500, 100], [300, 600, 100]]
        told, _ = self.check(grazing.scenario(route, self.BALL), route)
        self.assertFalse(told["check"]["ok"])

    def test_a_solid_that_appears_over_the_vehicle(self):
        route = [[100, 500, 100], [900, 500, 100]]
        for fly in ("apf", "route"):
            for at_s in (15, 14.3):
                with self.subTest(fly=fly, at_s=at_s):
                    result = self.run_of(
                        grazing.scenario(route, [{"box": {"min_m": [0, 900, 0], "max_m": [9, 909, 9]}}],
                                         vehicle={"speed_mps": 20}, events=[
                            {"at_s": at_s, "id": "pop_up",
                             "add": {"cylinder": {"at_m": [400, 500], "radius_m": 40}}}]),
                        {"steps": [{"plan": "rrt_connect"}, {"fly": fly}]})
                    self.assertEqual(referee.judge_result(result), [])
                    self.assertEqual(result["flight"]["status"], "collided")
                    self.assertAlmostEqual(result["flight"]["min_separation_m"], -40, delta=0.1)

    def test_the_page_has_the_least_clearance(self):
        """Beside a ball and far from a cliff, whose slope makes any bound of the ground far too near."""
        with open(os.path.join(self.folder, "ground.asc"), "w", encoding="utf-8") as file:
            file.write("ncols 30\nnrows 30\nxllcenter 500000\nyllcenter 5200000\ncellsize 50\n")
            for row in range(30):
                file.write(" ".join(str(max(0, 200 * (column - 25))) for column in range(30)) + "\n")
        route = [[100, 500, 300], [900, 500, 300]]
        environment = [{"terrain": {"file": "ground.asc", "crs": "EPSG:32632"}},
                       {"sphere": {"at_m": [433, 700, 300], "radius_m": 50}}]
        scenario = grazing.scenario(route, environment)
        scenario["volume"] = {"min_m": [0, 0, 0], "max_m": [1400, 1400, 900]}
        result = self.run_of(scenario, {"steps": [{"plan": "rrt_connect"}]})
        scene = page.scene(PROGRAM, os.path.join(self.folder, "result.json"))
        self.assertEqual(page.profile_differences(scene, result["metrics"]), [])


class Curved(Folder):
    """Routes with turns, and in layers of wind."""

    def hold(self, scenario, route, legs):
        """The same verdict by both; returns it."""
        path = worlds.write(self.folder, "route.json", {"altiplan": 1, "route": self.chords(route[0], legs), "legs": legs})
        file = worlds.write(self.folder, "scenario.yaml", scenario)
        told = json.loads(self.altiplan("check", "--route", path, "--scenario", file, "--json"))
        mission = scenarios.of_file(file)
        self.assertEqual([], referee.judge_curved(mission, rules.limits_of(mission), route, legs,
                                                  told["check"], told["metrics"], "route"))
        return told["check"]["ok"]

    def chain(self, *parts):
        """A route along an arc of 100 m, of straight legs (metres) and turns (degrees, from heading)."""
        route, legs = [[0.0, 0.0, 100.0]], []
        for part in parts:
            at, of = np.array(route[-1]), {"turn_deg": None, "radius_m": None, "heading_deg": None,
                                           "drift_m": None}
            if len(part) == 2:
                heading, length = part
                h = np.radians(heading)
                end = at + length * np.array([np.sin(h), np.cos(h), 0])
            else:
                heading, turn, radius = part
                of.update(turn_deg=turn, radius_m=radius, heading_deg=heading, drift_m=[0, 0])
                h, t = np.radians(90 - heading), np.radians(turn)
                end = at + np.sign(turn) * radius * np.array(
                    [np.sin(h + t) - np.sin(h), np.cos(h) - np.cos(h + t), 0])
            legs.append({"kind": "straight" if len(part) == 2 else "arc", "end": end.tolist(), **of})
            route.append(end.tolist())
        return route, legs

    def chords(self, begin, legs):
        """The points of the file: a turn is written by chords 1e-2 m from it too."""
        points = [begin]
        for leg in curved.legs_of(begin, legs):
            points += leg.points(1e-2)[1:-1].tolist() + [leg.b.tolist()]
        return points

    def test_turns_of_no_length_hide_no_corner(self):
        turned = (90, 90, 100)
        for hidden in ([], [(45, 1e-9, 100)], [(60, 1e-7, 100), (30, -1e-7, 100)], [(45, 1e-6, 100)] * 9,
                       [(45, 1e-4, 1.0)]):
            for corner in (0, 90):
                route, legs = self.chain((90, 200), turned, *hidden, (corner, 200))
                for limits in ({"turn_angle": {"max_deg": 30}}, {"turn_radius": {"min_m": 100}}):
                    with self.subTest(hidden=hidden, corner=corner, limits=limits):
                        is_ok = self.hold(grazing.scenario(route, (), [limits]), route, legs)
                        lengths = [np.radians(turn) * radius for _, turn, radius in hidden]
                        kept = corner == 0 and max(lengths, default=0) < 1e-6
                        self.assertEqual(is_ok, kept)

    def test_a_climb_through_layers(self):
        way = 100 / np.tan(np.radians(8))
        for limit, cut in ((8, False), (8, True), (20, False)):
            route = [[0.0, 0.0, 150.0], [way * 0.75, 0.0, 250.0]]
            if cut:
                route.insert(1, [way * 0.375, 0.0, 200.0])
            scenario = grazing.scenario(
                route, vehicle={"wing": {"airspeed_mps": 20, "bank_deg": 30, "climb_deg": limit,
                                         "sink_deg": limit}},
                wind={"layers": [{"above_m": 0, "from_deg": 270, "speed_mps": 10},
                                 {"above_m": 200, "from_deg": 90, "speed_mps": 10}]})
            legs = [{"kind": "straight", "end": p, "turn_deg": None, "radius_m": None,
                     "heading_deg": None, "drift_m": None} for p in route[1:]]
            with self.subTest(limit=limit, cut=cut):
                self.assertEqual(self.hold(scenario, route, legs), limit == 20)

    def test_searches_in_layers_of_wind(self):
        """A border between the ends: what is found has no corner over the ground."""
        scenario = {
            "altiplan": 1, "volume": {"min_m": [0, 0, 0], "max_m": [3000, 2500, 500]},
            "environment": [{"cylinder": {"at_m": [1500, 1200], "radius_m": 300}},
                            {"box": {"min_m": [800, 200, 0], "max_m": [1100, 1500, 220]}}],
            "vehicle": {"radius_m": 3, "wing": {"airspeed_mps": 20, "bank_deg": 30, "climb_deg": 8,
                                                "sink_deg": 6}},
            "wind": {"layers": [{"above_m": 0, "from_deg": 250, "speed_mps": 5},
                                {"above_m": 200, "from_deg": 280, "speed_mps": 8}]},
            "start": {"at_m": [200, 300, 150], "heading_deg": 200},
            "goal": {"at_m": [2700, 2200, 250], "heading_deg": 10, "tolerance_m": 20}}
        for planner in ("rrt", "rrt_connect", "rrt_star", "hybrid_astar"):
            with self.subTest(planner):
                result = self.run_of(scenario, {
                    "constraints": [{"turn_angle": {"max_deg": 0.1}}],
                    "steps": [{"plan": planner, "within_s": 20}, {"smooth": "shortcut"}]})
                self.assertEqual(referee.judge_result(result), [])


if __name__ == "__main__":
    unittest.main()
