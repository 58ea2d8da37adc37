# SPDX-License-Identifier: Apache-2.0
"""planner_test.py PROGRAM PLUGINS SOURCES: planners written in Python do what those of libraries do."""
import contextlib
import json
import sqlite3
import unittest

import case
from case import SANITIZED, SOURCES
from script_case import AROUND, STEP, ScriptCase, few_by_day, main

import altiplan

PARAMETERS = """yes: bool = altiplan.parameter(True, doc='a switch')
count: int = altiplan.parameter(3, at_least=1, at_most=9, doc='a count')
step_m: float = altiplan.parameter(50, unit='m', above=0, doc='a length')
word: str = altiplan.parameter('near', choices=('near', 'far'), doc='a word')
text: str = altiplan.parameter('', doc='a text')
at_m: Tuple[float, float, float] = altiplan.parameter((1, 2, 3), unit='m', doc='a point')
many: List[float] = altiplan.parameter([1, 2], at_least=0, min_items=1, doc='numbers')
maybe: Optional[float] = altiplan.parameter(None, doc='perhaps a number')
file: Optional[Path] = altiplan.parameter(None, doc='perhaps a file')"""
TYPES = "from pathlib import Path\nfrom typing import List, Optional, Tuple\n"
SHOWN = """parameters
  yes: true or false, default true
      a switch
  count: integer, 1 … 9, default 3
      a count
  step_m: number [m], > 0, default 50
      a length
  word: word, near, far, default "near"
      a word
  text: text
      a text
  at_m: 3 numbers [m], default [1, 2, 3]
      a point
  many: list of number, ≥ 0, 1 or more, default [1, 2]
      numbers
  maybe: number
      perhaps a number
  file: path
      perhaps a file
"""
REFUSED = {  # what a pipeline gives: the position in it, and what is said
    "count: 10": "tested.yaml:5:34: steps.0.with.count: expected from 1 to 9, found 10",
    "step_m: 0": "steps.0.with.step_m: expected more than 0 m, found 0",
    "step_m: wide": "steps.0.with.step_m: expected a number, found 'wide'",
    "stp_m: 3": "steps.0.with.stp_m: unknown key; did you mean 'step_m'?",
    "word: fear": "expected one of near, far; found 'fear' (did you mean 'near'?)",
    "many: []": "steps.0.with.many: ",
    "at_m: [1, 2]": "steps.0.with.at_m: ",
    "yes: 1": "expected true or false",
}


class Parameters(ScriptCase):
    def test_described(self):
        self.planner("return None", parameters=PARAMETERS, head=TYPES)
        self.assertIn(SHOWN, self.altiplan("describe", "tested").stdout)
        told = json.loads(self.altiplan("describe", "tested", "--json").stdout)
        self.assertEqual(told["parameters"][2]["min_itself_allowed"], False)
        self.assertIn("planner tested", self.altiplan("plugins").stdout)
        schema = self.altiplan("schema").stdout
        self.assertIn("a count", schema)

    def test_refused(self):
        self.planner("return None", parameters=PARAMETERS, head=TYPES)
        for given, says in REFUSED.items():
            pipeline = self.write("tested.yaml", STEP.format(step=f"{{plan: tested, with: {{{given}}}}}"))
            self.assertIn(says, self.altiplan("validate", pipeline, code=3).stderr)

    def test_passed_on(self):
        self.planner("raise ValueError(str(self.params))", parameters=PARAMETERS, head=TYPES)
        pipeline = self.write("p.yaml", STEP.format(
            step="{plan: tested, with: {at_m: [4, 5, 6], many: [7], maybe: 8, word: far, file: p.yaml}}"))
        result, _ = self.result(pipeline, "--set", "steps.0.with.step_m=9", code=4)
        self.assertIn("Params(yes=True, count=3, step_m=9.0, word='far', text='', "
                      "at_m=(4.0, 5.0, 6.0), many=[7.0], maybe=8.0, file=PosixPath(",
                      result["steps"][0]["message"])

    def test_required(self):
        pipeline = self.planner("return None", parameters="n: int = altiplan.parameter(doc='a count')")
        self.assertIn("'n' is missing", self.altiplan("validate", pipeline, code=3).stderr)
        self.assertIn("n: integer, required", self.altiplan("describe", "tested").stdout)


class Plans(ScriptCase):
    def counters(self, body, *arguments, **more):
        """The counters of a plan."""
        result, _ = self.result(self.planner(body, **more), *arguments)
        return result["steps"][0]["counters"]

    def test_a_route(self):
        result, said = self.result(self.planner(f"return {AROUND}"))
        self.assertEqual((result["status"], said), ("solved", ""))
        self.assertEqual(result["route"][1], [300, 250, 100])

    def test_numpy_in_and_out(self):
        body = "assert type(request.start).__name__ == 'ndarray'\n" \
               "open_ = request.world.legs_ok(request.start[None], request.goal[None])\n" \
               "assert not open_.any() and open_.shape == (1,)\n" \
               f"return numpy.array({AROUND})"
        result, _ = self.result(self.planner(body, head="import numpy\n"))
        self.assertEqual(result["status"], "solved")

    def test_the_request(self):
        self.assertEqual(self.counters(
            "v = request\n"
            "assert (v.start, v.goal) == ((100.0, 500.0, 100.0), (900.0, 500.0, 100.0)), v.start\n"
            "assert v.volume == [(0.0, 0.0, 0.0), (1000.0, 1000.0, 200.0)], v.volume\n"
            "assert v.goal_tolerance_m == 5 and v.vehicle['radius_m'] == 2 and v.threads == 1\n"
            "assert v.limits['min_clearance_m'] == 2 and v.limits['max_leg_m'] is None, v.limits\n"
            "assert v.world.layers == ['wall'], 'unknown layers are hidden'\n"
            "assert v.wind == [] and v.world.violations([]) == ['it has no points']\n"
            "assert v.start_velocity is v.goal_heading is v.level_m is None\n"
            "assert v.budget.max_iterations > 10**18 and v.budget.seconds_left == float('inf')\n"
            f"return {AROUND}, {{'mine': 7}}"), {"expanded": 0, "mine": 7})

    def test_the_world_answers_as_the_package(self):
        points = [(100.0, 500.0, 100.0), (305.0, 500.0, 50.0), (1.0, 2.0, 3.0)]
        world = altiplan.World(self.scenario, known=True)
        body = f"points = {points}\nask = request.world\n" \
               "raise ValueError(repr((ask.clearance(points), ask.ground([(1, 2)]), " \
               "ask.legs_blocked(points, points[1:] + points[:1], 2), ask.clearance([]), " \
               "ask.legs_ok(points, points[::-1]), ask.leg_ok(points[0], points[2]), " \
               "ask.violations([points[0], points[1]]))))"
        result, _ = self.result(self.planner(body), code=4)
        message = result["steps"][0]["message"]
        answers = eval(message.partition("ValueError: ")[2].rpartition(" (tested.py")[0],
                       {"nan": float("nan"), "inf": float("inf")})
        self.assertEqual(answers[0], world.clearance(points).tolist())
        self.assertTrue(answers[1][0] != answers[1][0])
        self.assertEqual(answers[2], world.legs_blocked(points, points[1:] + points[:1], 2).tolist())
        self.assertEqual(answers[3:6], ([], [True, False, True], True))
        self.assertEqual(len(answers[6]), len(altiplan.check(points[:2], self.scenario).violations))

    def test_the_same_seed_gives_the_same_route(self):
        pipeline = self.planner("x = 250 + 20 * request.rng.random()\n"
                                "return [request.start, (300, x, 100), (320, x, 100), request.goal]")
        routes = [self.result(pipeline, "--seed", seed)[0]["route"] for seed in (1, 1, 2)]
        self.assertEqual(routes[0], routes[1])
        self.assertNotEqual(routes[0], routes[2])

    def test_no_route(self):
        for body, says, proved in (("return None", "found no route", False),
                                   ("return altiplan.NoRoute('a wall')", "a wall", False),
                                   ("raise altiplan.NoRoute('a wall', proved=True)", "a wall", True)):
            result, _ = self.result(self.planner(body), code=1)
            step = result["steps"][0]
            self.assertEqual((step["status"], step["message"], step["proved"]),
                             ("no_route", says, proved))

    def test_budgets(self):
        self.planner("while not request.budget.spent(): pass")
        for limit, reason in (("within_s: 0.1", "deadline"), ("within_iterations: 30", "iterations")):
            pipeline = self.write("p.yaml", STEP.format(step=f"{{plan: tested, {limit}}}"))
            step = self.result(pipeline, code=1)[0]["steps"][0]
            self.assertEqual((step["status"], step["reason"], step["budget_hit"]),
                             ("timed_out", reason, True))
        self.assertEqual(step["counters"]["expanded"], 30)
        step = self.result(self.folder / "tested.yaml", "--timeout", "0.1", code=1)[0]["steps"][0]
        self.assertEqual((step["status"], step["reason"]), ("timed_out", "deadline"))

    def test_a_search_that_ends_with_its_iterations(self):
        self.planner("for n in range(30): assert not request.budget.spent()")
        pipeline = self.write("p.yaml", STEP.format(step="{plan: tested, within_iterations: 30}"))
        self.assertEqual(self.result(pipeline, code=1)[0]["status"], "no_route")

    def test_threads_may_ask(self):
        result, _ = self.result(self.planner(
            "from concurrent.futures import ThreadPoolExecutor\n"
            "def ask(n):\n    request.budget.spent()\n"
            "    return len(request.world.clearance([request.start] * n))\n"
            "with ThreadPoolExecutor(8) as pool:\n"
            f"    assert list(pool.map(ask, range(300))) == list(range(300))\nreturn {AROUND}"))
        self.assertEqual(result["status"], "solved", result["message"])

    @unittest.skipIf(SANITIZED, "limits of time")
    def test_a_plan_costs_little(self):
        pipeline = self.planner(f"return {AROUND}")
        times = [altiplan.run(pipeline, plugin_path=[self.folder]).steps[0].time_s for _ in range(9)]
        self.assertLess(sorted(times)[4], 0.01)  # one millisecond where nothing else runs

    def test_helpers_beside_it(self):
        self.write("helper.py", "X = 250\n")
        result, _ = self.result(self.planner(
            "return [request.start, (300, helper.X, 100), (320, helper.X, 100), request.goal]",
            head="import helper\n"))
        self.assertEqual(result["status"], "solved")
        self.assertFalse((self.folder / "__pycache__").exists())


class Commands(ScriptCase):
    @unittest.skipIf(SANITIZED, "limits of memory")
    def test_a_study_beside_astar(self):
        self.planner(f"return {AROUND}")
        self.planner("while True: pass", name="hangs")
        self.planner("import ctypes; ctypes.string_at(0)", name="crashes")
        # The child has left the group before the planner returns, so that it is found.
        self.planner("import os, time\nends, begins = os.pipe()\nif os.fork() == 0:\n    os.setsid()\n"
                     "    os.write(begins, b'1')\n    time.sleep(100)\nos.read(ends, 1)\n"
                     f"return {AROUND}", name="forks")
        self.planner("kept = []\nwhile True: kept.append(bytearray(1 << 20))", name="hoards")
        expected = {"astar_alone": "solved", "tested": "solved", "hangs": "failed",
                    "crashes": "failed", "forks": "failed", "hoards": "out_of_memory"}
        files = {**{name: f"{name}.yaml" for name in expected}, "astar_alone": "pipeline.yaml"}
        study = self.write("study.yaml", "altiplan: 1\nname: s\nscenarios: [{file: scenario.yaml}]\n"
                           "budget: {time_s: 2, memory_mb: 300}\npipelines:\n" + "".join(
                               f"  - {{id: {name}, file: {file}}}\n" for name, file in files.items()))
        self.altiplan("study", study, "--out", "s.db")
        with contextlib.closing(sqlite3.connect(self.folder / "s.db")) as store:
            outcomes = dict(store.execute("SELECT p.name, r.outcome FROM runs r "
                                          "JOIN pipelines p ON p.id = r.pipeline"))
            self.assertEqual(outcomes, expected, list(store.execute("SELECT message FROM runs")))
        self.assertEqual(self.workers(), [])

    def test_a_tuning(self):
        self.planner("return [request.start, (300, self.params.y_m, 100), (320, self.params.y_m, 100), "
                     "request.goal]", parameters="y_m: float = altiplan.parameter(50.0, doc='a detour')")
        pipeline = self.write("p.yaml", STEP.format(step="{plan: tested, with: {y_m: 90}}"))
        self.altiplan("tune", pipeline, "--over", "steps.0.with.y_m=50..350", "--metric", "length_m",
                      "--out", "tuned", "--tuner", "random_search", "--evaluations", "8")
        rows = (self.folder / "tuned/evaluations.csv").read_text().splitlines()
        self.assertEqual(len(rows), 1 + 1 + 8)
        failed = [float(row.split(",")[2]) > 298 for row in rows[1:]]  # there the wall begins
        self.assertEqual([",inf," in row for row in rows[1:]], failed)
        tuned = self.result(self.folder / "tuned/tuned.yaml")[0]
        self.assertLess(tuned["metrics"]["length_m"],
                        self.result(pipeline)[0]["metrics"]["length_m"])
        self.expect_no_workers()

    def test_it_replans_in_flight(self):
        self.planner("for y in (500, 200, 800):\n"
                     "    via = (550, y, 150)\n"
                     "    if request.world.legs_ok([request.start, via], [via, request.goal]) == [True] * 2:\n"
                     "        return [request.start, via, request.goal]")
        self.write("free.yaml", case.SCENARIO.replace("[310, 700, 1000]", "[310, 310, 1000]") + """events:
  - {at_s: 3, add: {sphere: {at_m: [600, 500, 150], radius_m: 100}}, id: pop_up, known: true}
""")
        for replan in ("tested", "{plan: tested}"):
            flies = self.write("flies.yaml", STEP.format(step="plan: tested").replace("scenario.y", "free.y")
                               + f"  - fly: route\n    replan: {replan}\n")
            result, _ = self.result(flies)
            flight = result["flight"]
            self.assertEqual((flight["status"], flight["collisions"]), ("solved", 0), flight["message"])
            self.assertEqual([(each["step"], each["status"]) for each in flight["replans"]],
                             [("tested", "solved")])
            self.assertGreater(max(abs(y - 500) for _, _, y, _ in flight["track"]), 250)
        self.expect_no_workers()

    def test_no_file_of_python_starts_no_python(self):
        self.planner(f"return {AROUND}")
        self.environment["ALTIPLAN_PYTHON"] = "/bin/false"  # would be noticed
        self.assertEqual(self.result(self.pipeline)[0]["status"], "solved")

    def test_the_package_finds_it(self):
        pipeline = self.planner(f"return {AROUND}")
        self.assertEqual(altiplan.run(pipeline, plugin_path=[self.folder]).status, "solved")
        step = altiplan.plan(self.scenario, "tested", plugin_path=[self.folder], step_m=3)
        self.assertEqual(step.status, "solved")
        self.assertEqual(self.workers(), [])

    def test_the_example_of_the_readme(self):
        readme = (SOURCES / "framework/python/README.md").read_text()
        self.write("my_planner.py", next(code for code in readme.split("```python\n")
                                         if "@altiplan.planner" in code).partition("```")[0])
        pipeline = self.write("p.yaml", STEP.format(step="{plan: my_planner}"))
        result, _ = self.result(pipeline, code=1)
        self.assertEqual(result["steps"][0]["message"], "something is in the way")

    @unittest.skipIf(SANITIZED, "limits of time")
    def test_a_new_planner(self):
        self.altiplan("new", "planner", "bends", "--python")
        text = (self.folder / "bends.py").read_text()
        self.assertLess(len(text.splitlines()), 40)
        done = self.altiplan("check-plugin", "bends.py", "--time-limit", 300, "--jobs", 2, *few_by_day)
        self.assertIn("0 failed", done.stdout)
        pipeline = self.write("p.yaml", STEP.format(step="{plan: bends}"))
        self.assertEqual(self.result(pipeline)[0]["status"], "solved")
        done = self.altiplan("new", "planner", "bends", "--python", code=2)
        self.assertIn("taken by the planner", done.stderr)
        self.altiplan("new", "tuner", "bends2", "--python", code=2)


if __name__ == "__main__":
    main()
