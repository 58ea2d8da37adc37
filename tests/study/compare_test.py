# SPDX-License-Identifier: Apache-2.0
"""compare_test.py PROGRAM: two stores of one study."""
import os
import sys
import unittest

from case import PIPELINE, SCENARIO, RUNS, STUDY, StudyCase


class Compare(StudyCase):
    VALUE = ("UPDATE run_values SET value = value * {by} WHERE quantity = (SELECT id FROM quantities "
             "WHERE name = '{name}')")

    def test_two_runs_of_one_program_are_the_same(self):
        out, err = self.call("compare", self.store("a.db"), self.store("b.db", "--jobs", "2"),
                             "--metric", "length_m", "--metric", "expanded", "--gate")
        self.assertEqual(err, "")
        self.assertIn(f"{RUNS} pairs of runs; 0 runs only in the first, 0 only in the second", out)
        self.assertNotIn("differ", out)
        self.assertEqual(out.count(" same\n"), 4, out)
        self.assertIn("nothing is worse", out)

    def test_a_longer_route_does_not_pass_the_gate(self):
        self.write("study.yaml", STUDY.replace("1..3", "1..6"))
        before, after = self.store("a.db"), self.store("b.db")
        self.change(after, self.VALUE.format(by=1.08, name="length_m"))
        out, _ = self.call("compare", before, after, "--metric", "length_m", "--gate", code=1)
        self.assertIn("different values of metrics that do not depend on time: "
                      f"{2 * RUNS}\n", out)
        self.assertIn(" 6 scenarios ", out)
        self.assertEqual(out.count("WORSE"), 2, out)
        self.assertIn("x 1.08 [1.08, 1.08]", out)
        self.assertEqual(out.splitlines()[-1], "the second is worse: beyond the tolerance: length_m of octile, length_m of "
                         "greedy")
        self.call("compare", before, after, "--metric", "length_m")
        out, _ = self.call("compare", before, after, "--metric", "length_m", "--gate",
                           "--tolerance", "10")
        self.assertEqual(out.count("within tolerance"), 2, out)
        out, _ = self.call("compare", after, before, "--metric", "length_m", "--gate")
        self.assertEqual(out.count("better"), 2, out)

    def test_three_scenarios_are_enough_only_where_no_clock_decides(self):
        before, after = self.store("a.db"), self.store("b.db")
        for name in ("length_m", "plan_time_s"):
            self.change(after, self.VALUE.format(by=1.08, name=name))
        out, _ = self.call("compare", before, after, "--metric", "plan_time_s", "--gate")
        self.assertEqual(out.count("unclear, too few scenarios: at least 6 for 95 %\n"), 2, out)
        out, _ = self.call("compare", before, after, "--metric", "length_m", "--gate", code=1)
        self.assertEqual(out.count("WORSE"), 2, out)

    def test_the_last_line_tells_what_differs(self):
        self.write("study.yaml", STUDY.replace("1..3", "1..8"))
        before, after = self.store("a.db"), self.store("b.db")
        chosen = ("--metric", "length_m", "--metric", "plan_time_s")
        self.change(after, self.VALUE.format(by=100, name="plan_time_s"))
        out, _ = self.call("compare", before, after, *chosen)
        self.assertTrue(out.splitlines()[-1].startswith("the second is worse: beyond the tolerance: plan_time_s of "), out)
        self.assertTrue(out.splitlines()[-1].endswith("; only times or memory differ"), out)
        out, _ = self.call("compare", before, after, "--metric", "plan_time_s")
        self.assertNotIn("only times", out)
        self.change(after, self.VALUE.format(by=1.001, name="length_m"))
        out, _ = self.call("compare", before, after, *chosen)
        self.assertNotIn("only times", out)

    def test_what_changed_is_told(self):
        before = self.store("a.db")
        self.write("astar.yaml", PIPELINE.replace("free_box", "any"))
        self.write("city.yaml", SCENARIO.replace("645, 45", "645, 46"))
        out, _ = self.call("compare", before, self.store("b.db"), "--metric", "length_m")
        self.assertIn(f"inputs differ: {RUNS} pairs\n", out)
        for name in ("astar.yaml", "city.yaml"):
            self.assertEqual(out.count(f"  '{self.path(name)}' has changed since\n"), 1, out)

    def test_a_lost_success_does_not_pass_the_gate(self):
        before, after = self.store("a.db"), self.store("b.db")
        self.change(after, "UPDATE runs SET outcome = 'crashed', message = 'astar: SIGSEGV' WHERE "
                           "pipeline = 1 AND scenario = 2 AND repetition = 1")
        out, _ = self.call("compare", before, after, "--metric", "length_m", "--gate", code=1)
        self.assertIn("newly failing: 1\n  octile city[seed=2] #1: solved, then crashed: astar: "
                      "SIGSEGV\n", out)
        self.assertEqual(out.splitlines()[-1], "the second is worse: newly failing: octile city[seed=2] #1")
        out, _ = self.call("compare", after, before, "--metric", "length_m", "--gate")
        self.assertIn("newly solved: 1\n  octile city[seed=2] #1: crashed, then solved\n", out)

    def test_other_studies(self):
        before = self.store("a.db")
        self.write("study.yaml", STUDY.replace("seed: 5", "seed: 6"))
        self.assertIn("no run in common", self.refused("compare", before, self.store("b.db")))
        self.write("study.yaml", STUDY.replace("repetitions: 2", "repetitions: 1"))
        fewer = self.store("c.db")
        out, _ = self.call("compare", before, fewer, "--gate", "--metric", "length_m", code=1)
        self.assertIn("6 pairs of runs; 6 runs only in the first, 0 only in the second", out)
        self.assertIn("nothing is worse; 6 runs of the first cannot be compared", out)
        self.call("compare", before, fewer, "--metric", "length_m")
        self.call("compare", fewer, before, "--gate", "--metric", "length_m")

    def test_wrong_input(self):
        good = self.store("a.db")
        self.assertIn("no run has a value named 'lenght_m'; did you mean 'length_m'?",
                      self.refused("compare", good, good, "--metric", "lenght_m"))
        for name, words in self.spoilt().items():
            for pair in ((good, self.path(name)), (self.path(name), good)):
                why = self.refused("compare", *pair)
                self.assertIn(name, why)
                if name != "nowhere.db":
                    self.assertIn(words, why)
        self.call("compare", good, code=2)
        self.call("compare", good, good, "--tolerance", "-1", code=2)


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
