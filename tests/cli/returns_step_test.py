# SPDX-License-Identifier: Apache-2.0
"""returns_step_test.py PROGRAM SOURCES: the step `returns` of pipelines says what `altiplan export` and `altiplan check
--returns` say of its route."""
import json
import os
import pathlib
import random
import sqlite3
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
CONFIGS = pathlib.Path(SOURCES) / "configs"
TERRAIN = CONFIGS / "data/jacksboro_fault.tif"

COPTER = "vehicle: {radius_m: 1, speed_mps: 12, climb_mps: 3, sink_mps: 2}"
WITH_BATTERY = """vehicle:
  radius_m: 1
  speed_mps: 12
  energy: {capacity_wh: CAPACITY, reserve: 0.2, power_w: 300}"""
WING = "vehicle: {radius_m: 2, wing: {airspeed_mps: 18, bank_deg: 30, climb_deg: 8, sink_deg: 8}}"
VTOL = "vehicle: {type: vtol, radius_m: 2, wing: {airspeed_mps: 18, bank_deg: 30, climb_deg: 8, sink_deg: 8}}"


def scenario(vehicle, start=(4000, 5000), goal=(11500, 10000), height=60, more="", clearance=30):
    return f"""altiplan: 1
environment:
  - terrain: {{file: {TERRAIN}}}
volume: {{min_m: [1000, 3000, 200], max_m: [16000, 18000, 1200]}}
{vehicle}
start: {{at_m: [{start[0]}, {start[1]}], above_ground_m: {height}}}
goal: {{at_m: [{goal[0]}, {goal[1]}], above_ground_m: {height}}}
constraints:
  - ground_clearance: {{min_m: {clearance}}}
{more}"""


def pipeline(returns="ardupilot", params=None, after="", plan="theta_star", cell="[200, 200, 40]"):
    return (f"altiplan: 1\nscenario: s.yaml\nsteps:\n  - plan: {plan}\n    with: {{cell_m: {cell}}}\n"
            f"  - returns: {returns}\n" + (f"    params: {params}\n" if params else "") + after)


class Step(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *arguments, codes=(0,)):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600,
                             check=False)
        self.assertIn(run.returncode, codes, run.stdout + run.stderr)
        return run

    def run_step(self, world, steps, parameters=None):
        (self.folder / "s.yaml").write_text(world)
        (self.folder / "p.yaml").write_text(steps)
        if parameters:
            (self.folder / "a.param").write_text("".join(f"{name},{value}\n" for name, value in parameters.items()))
        code = self.call("run", "p.yaml", "-o", "r.json", codes=(0, 1)).returncode
        result = json.loads((self.folder / "r.json").read_text())
        step = next((one for one in result["steps"] if one["verb"] == "returns"), None)
        return result, step, code

    def checked(self, autopilot, hovers, parameters=None):
        """What the two commands say of the route in r.json; None if it cannot be exported."""
        options = ("--params", "a.param") if parameters else ()
        ends = ("--takeoff", "--land") if hovers else ()
        if self.call("export", "r.json", "--autopilot", autopilot, *options, *ends, "-o", "r.plan",
                     codes=(0, 1, 2)).returncode != 0:
            return None
        told = self.call("check", "r.plan", "--scenario", "s.yaml", "--returns", "--json", *options, codes=(0, 1))
        return json.loads(told.stdout)["returns"]

    def expect_same(self, world, autopilot="ardupilot", parameters=None, hovers=True):
        result, step, code = self.run_step(world, pipeline(autopilot, "a.param" if parameters else None), parameters)
        if step is None:
            return None  # no route
        returns = step["returns"]
        self.assertEqual(returns, self.checked(autopilot, hovers, parameters), step["message"])
        passes = returns is not None and returns["verdict"] == "pass"
        self.assertEqual((result["status"], step["status"], step["accepted"], code),
                         ("solved", "solved", True, 0) if passes else ("rejected", "rejected", False, 1))
        self.assertTrue(step["message"] or passes)
        return returns

    def test_the_example(self):
        """It passes as it is, and fails at the autopilot's own height."""
        example = (CONFIGS / "pipelines/returns.yaml").read_text().replace("../", str(CONFIGS) + "/")
        (self.folder / "p.yaml").write_text(example)
        self.assertIn("accepted", self.call("run", "p.yaml").stdout)
        (self.folder / "q.yaml").write_text("".join(
            line for line in example.splitlines(True) if "params:" not in line))
        told = self.call("run", "q.yaml", codes=(1,)).stdout
        self.assertIn("flies into the ground", told)

    def test_copters(self):
        verdicts = [self.expect_same(scenario(COPTER), autopilot, parameters)["verdict"]
                    for autopilot, parameters in (("ardupilot", None), ("ardupilot", {"RTL_ALT_M": 320}), ("px4", None),
                                                  ("px4", {"RTL_RETURN_ALT": 320}))]
        self.assertEqual(verdicts, ["fail", "pass", "fail", "pass"])

    def test_a_battery_and_the_wind(self):
        """The scenario's, which are those of check."""
        low = {"RTL_ALT_M": 320}
        for capacity, verdict in ((260, "pass"), (200, "fail")):
            world = scenario(WITH_BATTERY.replace("CAPACITY", str(capacity)), more="wind: {from_deg: 250, speed_mps: 4}\n")
            returns = self.expect_same(world, parameters=low)
            self.assertEqual(returns["verdict"], verdict, returns["refused"])
            self.assertGreater(returns["point_of_no_return_s"], 0)
            self.assertEqual({one["rule"] for one in returns["refused"]}, set() if verdict == "pass" else {"energy"})

    def test_an_aeroplane(self):
        """Its mission has neither take-off nor landing without a runway."""
        world = scenario(WING, height=250, more="wind: {from_deg: 250, speed_mps: 3}\n", clearance=80)
        self.assertEqual(self.expect_same(world, hovers=False)["verdict"], "fail")

    def test_what_is_not_judged_is_no_success(self):
        returns = self.expect_same(scenario(COPTER), parameters={"FS_THR_ENABLE": 4})  # SmartRTL
        self.assertEqual(returns["verdict"], "not_judged")
        self.assertIn("not judged", json.loads((self.folder / "r.json").read_text())["message"])

    def test_what_changes_in_flight(self):
        """Zones that open after their horizon_s, events, obstacles that planners do not know."""
        high = {"RTL_ALT_M": 320}
        ball = "{sphere: {at_m: [9000, 9000, 700], radius_m: 40%s}%s}"
        events = f"events:\n  - {{at_s: 200, id: pop_up, add: {ball % ('', '')}}}\n"
        moving = f"moving:\n  - {ball % (', velocity_mps: [5, 0, 0]', ', known: false')}\n"
        for more, what in ((events, "events"), (moving, "moving obstacles")):
            returns = self.expect_same(scenario(COPTER, more=more), parameters=high)
            self.assertEqual((returns["verdict"], what in str(returns["not_judged"])), ("not_judged", True), returns)
        zones = "  - zones: {%slist: [{cylinder: {at_m: [15000, 17000], radius_m: 300}%s}]}\nvolume"
        opens = ", from: '2026-05-01T12:00:00Z'"
        always = "horizon_s: 0, ", ""  # whatever the horizon
        for given, verdict in ((("", opens), "not_judged"), (("horizon_s: 20000, ", opens), "pass"), (always, "pass")):
            world = scenario(COPTER, more="start_time: 2026-05-01T10:00:00Z\n").replace("volume", zones % given, 1)
            returns = self.expect_same(world, parameters={"RTL_ALT_M": 320, "WP_SPD": 2})
            self.assertEqual(returns["verdict"], verdict, returns)

    def test_a_route_that_is_no_mission(self):
        result, step, code = self.run_step(
            scenario(VTOL, height=250, clearance=80).replace("ground_clearance: {min_m: 80}", "ground_clearance: {min_m: 240}"),
            pipeline())
        self.assertEqual((result["status"], step["returns"], code), ("rejected", None, 1))
        self.assertIn("fails as the mission of ArduPilot", step["message"])

    def test_a_flight_does_not_make_up_for_it(self):
        result, step, code = self.run_step(scenario(COPTER), pipeline(after="  - fly: route\n"))
        self.assertEqual((result["flight"]["status"], result["status"], step["status"], code),
                         ("solved", "rejected", "rejected", 1))
        self.assertIn("r: rejected", self.shown())
        told = json.loads(self.call("check", "r.json", "--json", codes=(1,)).stdout)
        self.assertEqual(told["returns"], {"returns": step["returns"]})
        self.assertTrue(told["check"]["ok"] and told["flight"]["check"]["ok"])
        self.assertIn("returns fail: ", self.call("check", "r.json", codes=(1,)).stdout)

    def shown(self):
        """What the page says of the run."""
        self.call("view", "r.json", "-o", "page.html")
        page = (self.folder / "page.html").read_text()
        at = page.index('"results":')
        status = page.index('"status":"', at) + len('"status":"')
        return "r: " + page[status:page.index('"', status)]

    def test_a_study_counts_it(self):
        (self.folder / "s.yaml").write_text(scenario(COPTER))
        (self.folder / "a.param").write_text("RTL_ALT_M,320\n")
        (self.folder / "low.yaml").write_text(pipeline())
        (self.folder / "high.yaml").write_text(pipeline(params="a.param"))
        (self.folder / "study.yaml").write_text(
            "altiplan: 1\nscenarios: [{id: s, file: s.yaml}]\n"
            "pipelines: [{id: low, file: low.yaml}, {id: high, file: high.yaml}]\n")
        self.call("study", "study.yaml", "-o", "db.sqlite")
        rows = sqlite3.connect(self.folder / "db.sqlite").execute("select outcome from runs order by 1").fetchall()
        self.assertEqual(rows, [("rejected",), ("solved",)])

    def test_random_routes(self):
        """ALTIPLAN_ROUTES of them (default 3): the same verdicts, in all figures."""
        verdicts = []
        for seed in range(int(os.environ.get("ALTIPLAN_ROUTES", "3"))):
            rng = random.Random(seed)
            at = [(rng.randint(1500, 15500), rng.randint(3500, 17500)) for _ in range(2)]
            battery = WITH_BATTERY.replace("CAPACITY", str(rng.randint(40, 400)))
            vehicle, hovers = rng.choice([(COPTER, True), (battery, True), (WING, False)])
            autopilot = rng.choice(["ardupilot", "px4"])
            name = "RTL_RETURN_ALT" if autopilot == "px4" else "RTL_ALT_M" if hovers else "RTL_ALTITUDE"
            parameters = rng.choice([None, {name: rng.randint(15, 600)}])
            more = f"wind: {{from_deg: {rng.randint(0, 359)}, speed_mps: {rng.randint(0, 4)}}}\n"
            with self.subTest(seed=seed):
                returns = self.expect_same(scenario(vehicle, *at, rng.choice([60, 120, 250]), more), autopilot,
                                           parameters, hovers)
                verdicts.append(returns["verdict"] if returns else "no mission")
        if "ALTIPLAN_ROUTES" in os.environ:
            print({one: verdicts.count(one) for one in sorted(set(verdicts))}, file=sys.stderr)
            self.assertIn("pass", verdicts)
            self.assertIn("fail", verdicts)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
