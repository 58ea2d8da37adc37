# SPDX-License-Identifier: Apache-2.0
"""smoother_test.py PROGRAM PLUGINS SOURCES: smoothers written in Python do what those of libraries do."""
import unittest

from case import SANITIZED
from script_case import ScriptCase, few_by_day, main

SMOOTHER = """import altiplan

@altiplan.smoother("tested", "A smoother of a test")
class Tested:
    def smooth(self, route, request):
        {body}

@altiplan.planner("tested", "A planner of the same name, in the same file")
class Around:
    def plan(self, request):
        return [request.start, (200, 400, 100), (300, 250, 100), (320, 250, 100), request.goal]
"""
STEPS = "altiplan: 1\nscenario: scenario.yaml\nsteps: [{plan: tested}, {smooth: tested}]\n"


class Smoothers(ScriptCase):
    def smoothed(self, body, *arguments, code=0, head=""):
        """The result of the smoother's step."""
        self.write("tested.py", head + SMOOTHER.format(body=body.replace("\n", "\n        ")))
        result, _ = self.result(self.write("p.yaml", STEPS), *arguments, code=code)
        self.assertEqual(result["steps"][0]["status"], "solved")
        self.assertEqual(self.workers(), [])
        return result["steps"][1]

    def test_a_shorter_route(self):
        step = self.smoothed("assert route[1] == (200, 400, 100) and type(route) is list\n"
                             "return [route[0]] + route[2:], {'dropped': 1}")
        self.assertEqual((step["status"], len(step["route"])), ("solved", 4))
        self.assertEqual(step["counters"], {"expanded": 0, "dropped": 1})

    def test_arrays(self):
        step = self.smoothed("return numpy.delete(route, 1, axis=0)", head="import numpy\n")
        self.assertEqual(len(step["route"]), 4)

    def test_no_better_one(self):
        for body, says in (("return None", "left unchanged"),
                           ("return altiplan.NoRoute('it is straight')", "it is straight")):
            step = self.smoothed(body)
            self.assertEqual((step["status"], len(step["route"])), ("solved", 5))
            self.assertIn(says, step["message"])

    def test_budget(self):
        step = self.smoothed("while not request.budget.spent(): pass\nreturn route",
                             "--set", "steps.1.within_s=0.1")
        self.assertEqual((step["status"], step["budget_hit"]), ("solved", True))

    def test_faults(self):
        for body, says in (("raise ValueError('the attic')", "ValueError: the attic (tested.py:6)"),
                           ("return route[1:]", "first and last points must stay"),
                           ("return route, {'saved': 3.7}", "the counter 'saved': expected a whole number, found 3.7"),
                           ("return route[:1] + [(float('nan'),) * 3] + route[1:]", "all finite"),
                           ("while True: pass", "did not stop within half a second"),
                           ("import ctypes; ctypes.string_at(0)", "crashed (SIGSEGV)")):
            with self.subTest(body=body):
                step = self.smoothed(body, "--set", "steps.1.within_s=0.5")
                self.assertEqual(step["status"], "failed")
                self.assertIn(says, step["message"])

    @unittest.skipIf(SANITIZED, "limits of time")
    def test_a_new_smoother(self):
        self.altiplan("new", "smoother", "drops", "--python")
        done = self.altiplan("check-plugin", "drops.py", "--time-limit", 300, "--jobs", 2, *few_by_day)
        self.assertIn("0 failed", done.stdout)


if __name__ == "__main__":
    main()
