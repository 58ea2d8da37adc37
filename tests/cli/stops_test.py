# SPDX-License-Identifier: Apache-2.0
"""stops_test.py PROGRAM SOURCES: what a vehicle does at the places of a task, from the scenario to the mission.

`python3 stops_test.py PROGRAM SOURCES Stops.test_the_mission` runs one case."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
SCENARIO = """altiplan: 1
environment:
  - terrain: {file: %s}
    id: hills
%s
vehicle: {radius_m: 1, speed_mps: 10, acceleration_mps2: 2, climb_mps: 2.5, sink_mps: 1.5%s}
start: {at_lonlat: [-84.2500, 36.6000], above_ground_m: 60}
task:
  visit:
    closed: true
    stops:
      - {at_lonlat: [-84.2480, 36.6010], above_ground_m: 60, hold_s: 30}
      - {at_lonlat: [-84.2450, 36.6020], above_ground_m: 60, land: true, hold_s: 8, drop: true}
      - {at_lonlat: [-84.2460, 36.5990], above_ground_m: 60, drop: true}
      - {at_lonlat: [-84.2490, 36.5980], above_ground_m: 60}
"""
PIPELINE = """altiplan: 1
steps:
  - plan: astar
  - smooth: prune
"""
WAYPOINT, LAND, TAKE_OFF, DELAY, GRIPPER = 16, 21, 22, 93, 211


class Stops(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "pipeline.yaml").write_text(PIPELINE)

    def call(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout, done.stderr

    def run_in(self, layers="", vehicle="", code=0):
        """Plans among more layers, with more keys of the vehicle."""
        (self.folder / "scenario.yaml").write_text(SCENARIO % (TERRAIN, layers, vehicle))
        return self.call("run", "pipeline.yaml", "--scenario", "scenario.yaml", "-o", "result.json", code=code)

    def check(self, *options, code=0):
        return self.call("check", "stops.plan", "--terrain", TERRAIN, "--min-agl", "20", *options, code=code)[0]

    def items(self):
        return json.loads((self.folder / "stops.plan").read_text())["mission"]["items"]

    def test_the_mission(self):
        out = self.run_in()[0]
        self.assertIn("stops: waits 30 s at", out)
        self.assertIn("lands for 8 s and drops its cargo at", out)
        messages = self.call("export", "result.json", "--takeoff", "--land", "-o", "stops.plan")[1]
        self.assertIn("MIS_OPTIONS 4", messages)
        items = self.items()
        self.assertEqual([(each["command"], each["params"][0]) for each in items], [
            (TAKE_OFF, 0), (WAYPOINT, 30), (WAYPOINT, 0), (LAND, 0), (DELAY, 8), (GRIPPER, 1), (TAKE_OFF, 0),
            (WAYPOINT, 1), (GRIPPER, 1), (WAYPOINT, 0), (WAYPOINT, 0), (LAND, 0)])
        self.assertEqual(items[5]["params"][1], 0)  # release
        landing, again = items[3]["params"], items[6]["params"]
        self.assertEqual(landing[4:6], again[4:6])
        self.assertAlmostEqual(again[6] - landing[6], 60, places=2)
        for name in ("wpml", "litchi", "kml"):  # whose places would have one on the ground
            err = self.call("export", "stops.plan", "--terrain", TERRAIN, "--to", name, "-o", "positions", code=3)[1]
            self.assertIn("item 4 is a landing on the way", err)
        passed = self.check()
        self.assertIn("takes off again with MIS_OPTIONS 4 alone", passed)
        self.assertNotIn("is not flown", passed)
        self.call("export", "result.json", "--takeoff", "--land", "-o", "stops.waypoints")
        world = (self.folder / "scenario.yaml").read_text()
        for vehicle, code in (("vehicle: {type: copter, ", 0), ("vehicle: {", 1)):  # the format does not say
            (self.folder / "type.yaml").write_text(world.replace("vehicle: {", vehicle))
            self.call("check", "stops.waypoints", "--autopilot", "ardupilot", "--scenario", "type.yaml", code=code)
        lines = (self.folder / "stops.waypoints").read_text().splitlines()[2:]  # after home
        self.assertEqual([int(line.split("\t")[3]) for line in lines], [each["command"] for each in items])

    def test_whether_a_mission_does_the_task(self):
        self.run_in()
        self.call("export", "result.json", "--takeoff", "--land", "-o", "stops.plan")
        plan = json.loads((self.folder / "stops.plan").read_text())
        items = plan["mission"]["items"]

        def check(changed, code=1, *options):
            plan["mission"]["items"] = changed
            (self.folder / "changed.plan").write_text(json.dumps(plan))
            return "".join(self.call("check", "changed.plan", "--scenario", "scenario.yaml", *options, code=code))

        def without(*numbers):
            return [item for n, item in enumerate(items) if n not in numbers]

        # Commands: take-off, place, place, landing, delay, drop, take-off, place, drop, place, end, landing.
        there, back = items[:2], items[10:]
        backwards = there[:1] + items[9:10] + items[7:9] + items[2:7] + there[1:] + back
        for sound in (items, backwards):
            self.assertIn("pass: ", check(sound, 0))
        for changed, said in ((without(9), "does not come to place 4 of the task's 4"),
                              (without(4), "waits 0 s of 8 at place 2"), (without(5), "drops nothing at place 2"),
                              (without(3, 4, 5, 6), "does not land at place 2"),
                              (items[:4] + items[5:6] + items[4:5] + items[6:], "drops its cargo before it has waited"),
                              (without(10, 11), "does not end where it begins")):
            with self.subTest(said):
                self.assertIn(said, check(changed))
        jump = {**items[4], "command": 177, "params": [11, 1, 0, 0, 0, 0, 0]}  # over places 3 and 4
        self.assertIn("is not judged of jumps", check(items[:7] + [jump] + items[7:]))
        # In the air it neither lands nor waits on the ground; a circle is not at its middle, nor a take-off at its.
        for changed, said in ((items[:2] + [items[2]] + items[4:6] + [items[3]] + items[6:], "at place 2 of the task's 4"),
                              (items[:4] + [items[6]] + items[4:6] + items[7:], "at place 2 of the task's 4"),
                              (items[:9] + [{**items[9], "command": 18, "params": [1, 0, 60, 0, *items[9]["params"][4:]]}]
                               + items[10:], "does not come to place 4"),
                              (items[:9] + [{**items[9], "command": 22}] + items[10:], "does not come to place 4"),
                              (items[:7] + [{**items[9], "command": 17, "params": [0, 0, 0, 0, *items[9]["params"][4:]]}] + items[7:], "does not come to place 3"),
                              (items[:2] + [items[5]] + items[2:], "commands its gripper 3 times")):
            with self.subTest([item["command"] for item in changed]):
                self.assertIn(said, check(changed))
        wide = [{**item, "params": [item["params"][0], 90, *item["params"][2:]]} if item["command"] == 16 else item
                for item in items]
        self.assertIn("is not judged of acceptance radii above 10 m", check(wide, 1, "--autopilot", "px4"))
        (self.folder / "own.param").write_text("WP_RADIUS_M,20\n")
        self.assertIn("is not judged of acceptance radii", check(items, 1, "--params", "own.param"))
        (self.folder / "own.param").write_text("MIS_OPTIONS,0\n")  # the flight ends at the landing
        self.assertIn("waits 0 s of 8 at place 2", check(items, 1, "--params", "own.param"))
        # Positions alone neither wait nor land; the run's own result tells by its stops.
        self.assertIn("waits 0 s of 30 at place 1", "".join(
            self.call("check", "--route", "stops.plan", "--scenario", "scenario.yaml", code=1)))
        self.call("check", "result.json")
        result = json.loads((self.folder / "result.json").read_text())
        told = json.loads((self.folder / "result.json").read_text())
        told["task"]["stops"][1]["drops"] = False
        (self.folder / "told.json").write_text(json.dumps(told))
        self.assertIn("its stops are not the task's", "".join(self.call("check", "told.json", code=1)))
        at = next(n for n, leg in enumerate(result["legs"]) if leg.get("hold_s"))
        del result["legs"][at], result["route"][at + 1]  # the first wait
        (self.folder / "result.json").write_text(json.dumps(result))
        self.assertIn("task: the route does not stop after pass 0 of the task", "".join(self.call("check", "result.json", code=1)))

    def test_the_fewest_items_keep_them(self):
        self.run_in()
        self.call("export", "result.json", "--autopilot", "ardupilot", "--takeoff", "--land", "-o", "stops.plan")
        self.assertEqual([each["command"] for each in self.items()],
                         [TAKE_OFF, WAYPOINT, WAYPOINT, LAND, DELAY, GRIPPER, TAKE_OFF, WAYPOINT, GRIPPER, WAYPOINT,
                          WAYPOINT, LAND])
        self.check()
        refused = self.call("export", "result.json", "--autopilot", "px4", "--to", "qgc-plan", "--takeoff",
                            "--land", code=1)[1]
        self.assertIn("PX4 copter takes off at the first position of a mission alone", refused)

    def test_parameters_that_end_it(self):
        self.run_in()
        self.call("export", "result.json", "--takeoff", "--land", "-o", "stops.plan")
        for parameters, ends in (("MIS_OPTIONS,4", False), ("MIS_OPTIONS,0", True),
                                 ("MIS_OPTIONS,4\nDISARM_DELAY,5", True), ("MIS_OPTIONS,4\nDISARM_DELAY,0", False)):
            with self.subTest(parameters):
                (self.folder / "own.param").write_text(parameters + "\n")
                said = self.check("--params", "own.param")
                self.assertEqual("the flight ends before it" in said, ends, said)

    def test_time_and_bound(self):
        self.run_in()
        result = json.loads((self.folder / "result.json").read_text())
        task = result["task"]
        self.assertAlmostEqual(task["time_s"], result["metrics"]["time_s"], places=6)
        self.assertAlmostEqual(task["bound_s"], task["time_s"], places=6)
        self.assertEqual([(each["hold_s"], each["lands"], each["drops"]) for each in task["stops"]],
                         [(30, False, False), (8, True, True), (1, False, True)])

    def test_a_landing_that_is_blocked(self):
        for what, layer in (
                ("zone", "  - zones: {list: [{polygon: {outline_lonlat: [[-84.2455, 36.6016], [-84.2445, 36.6016], "
                         "[-84.2445, 36.6024], [-84.2455, 36.6024]]}, ceiling_m: 520}]}\n    id: below"),
                ("building", "  - cylinder: {at_lonlat: [-84.2450, 36.6020], radius_m: 5, ceiling_m: 510}\n"
                             "    id: below")):
            with self.subTest(what):
                said = "".join(self.run_in(layer, code=1))
                self.assertIn("the landing after pass 1 of the task: its way down passes too close to 'below'", said)

    def test_what_cannot_be_done(self):
        said = self.run_in(vehicle=", wing: {airspeed_mps: 15}", code=3)[1]
        self.assertRegex(said, r"scenario\.yaml:12:\d+: task\.visit\.stops\.0\.hold_s: an aeroplane cannot wait")
        self.run_in()
        for options, words in ((("--to", "kml"), "the route waits"),
                               (("--to", "qgc-plan", "--max-items", "4"), "--max-items does not keep")):
            self.assertIn(words, self.call("export", "result.json", *options, code=1)[1])

    def test_passes_are_not_thinned(self):
        (self.folder / "scenario.yaml").write_text(
            (SCENARIO % (TERRAIN, "", "")).replace(", hold_s: 30", "").replace(", land: true, hold_s: 8, drop: true", "")
            .replace(", drop: true", ""))
        self.call("run", "pipeline.yaml", "--scenario", "scenario.yaml", "-o", "result.json")
        said = self.call("export", "result.json", "--to", "qgc-plan", "--max-items", "4", code=1)[1]
        self.assertIn("a task's passes are flown as they are", said)
        self.call("export", "result.json", "--autopilot", "ardupilot", "--takeoff", "-o", "stops.plan")
        self.assertEqual(len(self.items()), 6)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
