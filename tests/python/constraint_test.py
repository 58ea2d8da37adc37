# SPDX-License-Identifier: Apache-2.0
"""constraint_test.py PROGRAM PLUGINS SOURCES: constraints written in Python hold for plans and judgements."""
import unittest

import altiplan
from case import SANITIZED
from script_case import ScriptCase, few_by_day, main

HEAD = """import altiplan

@altiplan.parameters
class Params:
    edge_m: float = altiplan.parameter(400.0, unit="m", doc="a border")

@altiplan.constraint("tested", "A constraint of a test", Params)
class Tested:
    def __init__(self, params):
        self.edge_m = params.edge_m
    {body}
"""
NORTH = """def admits(self, leg):
    return max(leg.start[1], leg.end[1]) <= 500.001"""  # past the wall's southern end alone
WAYPOINTS = """def violations(self, points, request):
    assert request.goal == (900, 500, 100) and request.world.clearance(points[:1])[0] > 0
    return [(len(points) - 1, len(points), 3, 'too many points')] if len(points) > 3 else []"""
TIGHT = """def tighten(self, request):
    assert request.limits["min_clearance_m"] == 2, request.limits
    return {"min_clearance_m": 20, "altitude": [{"max_m": 150}, {"above_ground": True, "min_m": 1}],
            "max_turn": 1.0, "max_climb": 0.5, "min_leg_m": 5, "max_leg_m": 1e5, "max_route_m": 1e5,
            "max_descent": 0.4, "min_ground_clearance_m": 0, "min_turn_radius_m": 1,
            "max_turn_in_space": None}"""
FAULTS = {  # what admits does: what the result says
    "raise ValueError('the attic')": "threw: ValueError: the attic (tested.py:12)",
    "import os; os._exit(3)": "ended its process with exit code 3",
    "import ctypes; ctypes.string_at(0)": "crashed (SIGSEGV)",
    "import os; os.write(3, b'x' * 100)": "writes to the descriptor",
    "return leg.nothing": "threw: AttributeError",
    "return None": "TypeError: admits: expected True or False, found NoneType",
    "return 'no'": "TypeError: admits: expected True or False, found str",
    "yield False": "TypeError: admits: expected True or False, found generator",
}
LIMITS = {  # what tighten returns: what is said
    "3": "TypeError: tighten: expected a dict of limits, found int",
    "{'max_speed': 3}": "there is no limit 'max_speed': expected altitude, min_clearance_m",
    "{'max_leg_m': 'far'}": "max_leg_m: expected a number, found str",
    "{'max_leg_m': float('nan')}": "max_leg_m: expected a finite number, found nan",
    "{'max_climb': 10}": "max_climb: expected radians from 0 to 1.5708, found 10",
    "{'max_leg_m': -1}": "max_leg_m: expected metres from 0, found -1",
    "{'altitude': [{'top_m': 3}]}": "altitude: expected dicts of above_ground, min_m, max_m",
}


class Constraints(ScriptCase):
    def constraint(self, body):
        """Writes a constraint with these methods, and a pipeline that plans under it."""
        self.write("tested.py", HEAD.format(body=body.replace("\n", "\n    ")))
        return self.write("p.yaml", "altiplan: 1\nscenario: scenario.yaml\nconstraints: [{tested: {}}]\n"
                          "steps:\n  - {plan: astar, with: {cell_m: [50, 50, 50]}}\n")

    def test_legs(self):
        free, _ = self.result(self.pipeline)
        held, _ = self.result(self.constraint(NORTH))
        self.assertEqual((free["status"], held["status"]), ("solved", "solved"))
        self.assertLessEqual(max(point[1] for point in held["route"]), 500.001)
        north = [(100, 500, 100), (300, 800, 100), (900, 500, 100)]
        check = altiplan.check(north, self.folder / "p.yaml", plugin_path=[self.folder])
        self.assertEqual({one.constraint for one in check.violations}, {"tested"})
        self.assertEqual([one.at for one in check.violations], [0, 1])
        self.assertEqual(self.workers(), [])

    def test_the_leg(self):
        pipeline = self.constraint(
            "def admits(self, leg):\n"
            "    assert len(leg.start) == len(leg.end) == 3 and len(leg.before or (1, 2, 3)) == 3\n"
            "    assert leg.world.layers in (['wall'], [])\n"
            "    return not leg.world.legs_blocked([leg.start], [leg.end], 60)[0]")
        held, _ = self.result(pipeline)
        self.assertGreaterEqual(held["metrics"]["min_clearance_m"], 60 - 1e-6)

    def test_routes(self):
        pipeline = self.constraint(WAYPOINTS)
        judged = altiplan.check([(100, 500, 100), (200, 800, 100), (400, 800, 100), (900, 500, 100)],
                                pipeline, plugin_path=[self.folder])
        one, = judged.violations
        self.assertEqual((one.constraint, one.at, one.value, one.limit, one.message),
                         ("tested", 3, 4, 3, "too many points"))
        self.assertTrue(altiplan.check([(100, 500, 100), (300, 800, 100), (900, 500, 100)], pipeline,
                                       plugin_path=[self.folder]))

    def test_limits_are_those_of_libraries(self):
        held, _ = self.result(self.constraint(TIGHT))
        same, _ = self.result(self.write("q.yaml", """altiplan: 1
scenario: scenario.yaml
constraints:
  - clearance: {min_m: 20}
  - altitude: {max_m: 150}
  - turn_angle: {max_deg: 57.29577951308232}
steps:
  - {plan: astar, with: {cell_m: [50, 50, 50]}}
"""))
        self.assertEqual((held["status"], same["status"]), ("solved", "solved"))
        self.assertAlmostEqual(held["metrics"]["length_m"], same["metrics"]["length_m"], 6)
        self.assertGreaterEqual(held["metrics"]["min_clearance_m"], 20 - 1e-6)

    def test_a_refused_start_is_named_once(self):
        pipeline = self.constraint("def admits(self, leg):\n"
                                   "    return min(leg.start[0], leg.end[0]) > 300")
        text = pipeline.read_text().replace("]}}", "]}, else: [{plan: theta_star}]}")
        pipeline.write_text(text)
        held, _ = self.result(pipeline, code=1)
        said = [step["message"].count("the constraint 'tested' refuses the start itself; ")
                for step in held["steps"]]
        self.assertEqual((held["status"], said), ("no_route", [1, 0]))

    def test_nothing_is_loosened(self):
        held, _ = self.result(self.constraint("def tighten(self, request):\n"
                                              "    return {'min_clearance_m': 0, 'max_climb': 1.5}"))
        free, _ = self.result(self.pipeline)
        self.assertEqual(held["route"], free["route"])

    def test_faults(self):
        for body, says in FAULTS.items():
            with self.subTest(body=body):
                pipeline = self.constraint(f"def admits(self, leg):\n    {body}")
                result, _ = self.result(pipeline, code=4)
                self.assertEqual(result["status"], "failed")
                self.assertIn(says, result["message"])
                self.assertIn("the constraint 'tested' ", result["message"])
                self.assertNotIn("threw: threw", result["message"])
                self.assertEqual(self.workers(), [])

    def test_one_that_never_answers(self):
        pipeline = self.constraint("def admits(self, leg):\n    while True: pass")
        result, _ = self.result(pipeline, "--timeout", "1", code=4)
        self.assertEqual(result["reason"], "never_stopped")
        self.expect_no_workers()

    def test_wrong_limits(self):
        for returned, says in LIMITS.items():
            with self.subTest(returned=returned):
                pipeline = self.constraint(f"def tighten(self, request):\n    return {returned}")
                done = self.altiplan("run", pipeline, code=4)
                self.assertIn(says, done.stdout + done.stderr)

    def test_a_place_by_longitude_and_latitude(self):
        pipeline = self.constraint("def admits(self, leg):\n"
                                   "    (x, y), = leg.world.to_local([(8, 47.001)])\n"
                                   "    assert abs(x) < 1 and 111 < y < 112, (x, y)\n    return True")
        frame = "scenario.frame={crs: local, origin_lonlat: [8, 47]}"
        self.assertEqual(self.result(pipeline, "--set", frame)[0]["status"], "solved")
        result, _ = self.result(pipeline, code=4)
        self.assertIn("the world has no geographic position", result["message"])

    def test_wrong_violations(self):
        for returned, says in (("None", "violations: expected a list"), ("[3]", "expected (at, value, limit, message), found 3"),
                               ("[(99, 1, 2, 'x')]", "expected the index of one of"),
                               ("[(0, 'one', 2, 'x')]", "value: expected a number, found str")):
            with self.subTest(returned=returned):
                pipeline = self.constraint(
                    f"def violations(self, points, request):\n    return {returned}")
                result, _ = self.result(pipeline, code=4)
                self.assertIn(says, result["message"])

    def test_wrong_classes(self):
        for body, says in (("def nothing(self): pass", "needs a method tighten or admits or violations"),
                           ("applies_to = 'all'\n" + NORTH, "applies_to: expected 'both', 'route' or")):
            done = self.altiplan("run", self.constraint(body), code=4)
            self.assertIn(says, done.stdout + done.stderr)

    def test_a_track_alone(self):
        pipeline = self.constraint("applies_to = 'track'\ndef admits(self, leg): return False")
        self.assertEqual(self.result(pipeline)[0]["status"], "solved")

    @unittest.skipIf(SANITIZED, "limits of time")
    def test_a_new_constraint(self):
        self.altiplan("new", "constraint", "border", "--python")
        done = self.altiplan("check-plugin", "border.py", "--time-limit", 300, "--jobs", 2, *few_by_day)
        self.assertIn("0 failed", done.stdout)
        (self.folder / "border.py").rename(self.folder / "edge.py")
        done = self.altiplan("check-plugin", "edge.py", "--only", "^library/", code=4)
        self.assertIn("expected border.py, after the plugin's name", done.stdout)


if __name__ == "__main__":
    main()
