# SPDX-License-Identifier: Apache-2.0
"""wind_hours_test.py PROGRAM BROKEN: winds one after another."""
import json
import random

import wind_flight
from case import CliCase, main

SCENARIO = """altiplan: 1
environment:
  - box: {min_m: [1500, 600, 0], max_m: [1700, 1400, 300]}
  - box: {min_m: [3400, 200, 0], max_m: [3500, 1200, 300]}
volume: {min_m: [0, 0, 0], max_m: [6000, 2000, 300]}
vehicle: {radius_m: 2, wing: {airspeed_mps: 20, bank_deg: 30, climb_deg: 10, sink_deg: 10}}
start_time: 2026-05-01T10:00:00Z
start: {at_m: [100, 1000, 100], heading_deg: 90}
goal: {at_m: [5900, 1000, 150]}
wind: %s
%s
"""
PIPELINE = """altiplan: 1
scenario: s.yaml
steps:
  - plan: %s
    within_s: 20
%s
"""


def at(seconds):
    return f"2026-05-01T10:{seconds // 60:02}:{seconds % 60:02}Z"


def hours(*winds):
    """Of (seconds after the start, m/s, direction)."""
    return "{hours: [%s]}" % ", ".join("{from_time: %s, from_deg: %s, speed_mps: %s}" % (at(from_s), degrees, speed)
                                       for from_s, speed, degrees in winds)


class WindHours(CliCase):
    def files(self, wind, more="", planner="hybrid_astar", steps=""):
        self.write("s.yaml", SCENARIO % (wind, more))
        self.write("p.yaml", PIPELINE % (planner, steps))

    def change(self, *pairs):
        """Of the scenario's text: each first one for the second."""
        text = self.read("s.yaml")
        for old, new in pairs:
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("s.yaml", text)

    def last_step(self):
        return self.result("p.yaml")["steps"][-1]

    def test_the_judge(self):
        """A straight leg with 5 m/s behind it for a minute, then 5 m/s ahead."""
        self.files(hours((0, 5, 270), (60, 5, 90)), "objective: {time: {}}")
        self.change(("at_m: [100, 1000, 100]", "at_m: [100, 1900, 100]"),
                    ("at_m: [5900, 1000, 150]", "at_m: [5900, 1900, 100]"))
        self.write("r.csv", "x_m,y_m,z_m\n100,1900,100\n5900,1900,100\n")

        def judged(code=0):
            return json.loads(self.call("check", "--route", "r.csv", "--scenario", "s.yaml", "--json", code=code)[0])
        self.assertAlmostEqual(judged()["cost"], 60 + (5800 - 60 * 25) / 15, 6)
        self.change(("from_deg: 90, speed_mps: 5", "from_deg: 0, speed_mps: 21"))
        self.assertIn("does not hold its course in a wind of 21.00 m/s", json.dumps(judged(code=1)))
        # It is over before that wind blows.
        self.change((at(60), at(240)))
        self.assertAlmostEqual(judged()["cost"], 5800 / 25, 6)

    def test_planners_plan_anew_where_the_wind_changes(self):
        """Flown outside the program by its own rule of winds: each leg as the wind of its time carries it."""
        chance = random.Random(5)
        for planner in ("hybrid_astar", "rrt", "rrt_connect", "rrt_star"):
            with self.subTest(planner=planner):
                winds = [(0, 6, 200)]
                while winds[-1][0] < 200:
                    winds.append((winds[-1][0] + chance.randint(20, 70), chance.uniform(0, 9), chance.uniform(0, 360)))
                self.files(hours(*winds), planner=planner)
                step = self.last_step()
                self.assertTrue(step["accepted"])
                seconds, off_m = wind_flight.fly(step, 20, winds)
                self.assertAlmostEqual(seconds, step["metrics"]["duration_s"], delta=1e-3)
                self.assertLess(off_m, 0.01)

    def test_the_objective_is_counted_in_the_winds_of_its_time(self):
        winds = (0, 9, 270), (100, 9, 90)
        self.files(hours(*winds), "objective: {time: {}}", planner="astar", steps="    with: {cell_m: [200, 200, 50]}")
        self.change((", bank_deg: 30", ""), (", heading_deg: 90", ""))
        step = self.last_step()
        self.assertAlmostEqual(step["cost"], step["metrics"]["duration_s"], delta=1e-6)
        self.assertLessEqual(step["bound"], step["cost"])
        seconds, off_m = wind_flight.fly(step, 20, winds)
        self.assertAlmostEqual(seconds, step["cost"], delta=1e-3)

    def test_a_budget_is_enough_for_each_wind(self):
        self.files(hours((0, 5, 200), (100, 5, 200), (150, 5, 200)), planner="rrt_star", steps="    within_iterations: 6000")
        self.assertTrue(self.last_step()["accepted"])

    def test_a_wind_long_after_the_flight_keeps_no_smoother_from_anything(self):
        steps = "  - smooth: shortcut"
        self.files(hours((0, 5, 200)), planner="rrt", steps=steps)
        alone = self.last_step()["route"]
        self.files(hours((0, 5, 200), (3000, 25, 0)), planner="rrt", steps=steps)
        self.assertEqual(self.last_step()["route"], alone)

    def test_a_wind_that_lets_none_go_on_is_named(self):
        self.files(hours((0, 5, 200), (60, 25, 90)), planner="astar", steps="    with: {cell_m: [200, 200, 50]}")
        self.change((", bank_deg: 30", ""), (", heading_deg: 90", ""))
        step = self.result("p.yaml", code=1)["steps"][-1]
        self.assertEqual(step["route"], [])
        self.assertRegex(step["message"], r"no route: .*wind or climb_angle rules out \d+ of 26 directions.*, from .* on, where the "
                              r"wind changes 60 s after the start")

    def test_refusals(self):
        def refusal(wind, steps="", start="start_time: 2026-05-01T10:00:00Z", goal="[5900, 1000, 150]",
                    radius="radius_m: 2"):
            self.files(wind, steps=steps)
            self.change(("start_time: 2026-05-01T10:00:00Z", start), ("[5900, 1000, 150]", goal), ("radius_m: 2", radius))
            _, said = self.call("run", "p.yaml", code=3)
            self.assertEqual(self.call("validate", "p.yaml", code=3)[1], said)
            return said
        two = hours((0, 5, 0), (60, 5, 90))
        self.assertRegex(refusal(two, start=""),
                         r"s\.yaml:\d+:\d+: (scenario\.)?wind\.hours\.0\.from_time: winds by the hour need the "
                         r"scenario's start_time")
        self.assertIn("no wind is given from start_time to here", refusal(hours((1, 5, 0))))
        self.assertIn("expected hours in ascending order", refusal(hours((0, 5, 0), (0, 5, 90))))
        self.assertIn("wind.hours.0.from_time: expected a time such as",
                      refusal("{hours: [{from_time: noon, from_deg: 0, speed_mps: 1}]}"))
        self.assertIn("expected hours alone, or one wind",
                      refusal(two.replace("{hours", "{from_deg: 1, speed_mps: 1, hours")))
        self.assertIn("expected from_deg and speed_mps, or layers, or grid",
                      refusal("{hours: [{from_time: 2026-05-01T10:00:00Z}]}"))
        self.assertIn("a flight knows one wind, and this one changes",
                      refusal(two, steps="    id: route\n  - fly: route"))
        self.assertIn("a body's attitude knows one wind, and this one changes",
                      refusal(two, radius="body: {box_m: [1, 4, 1]}"))
        self.assertIn("a landing knows one wind, and this one changes",
                      refusal(two, goal="[5900, 1000, 0], landing: {course_deg: 90, height_m: 50}"))


if __name__ == "__main__":
    main()
