# SPDX-License-Identifier: Apache-2.0
"""metrics_test.py PROGRAM: objectives as metrics of runs, studies, claims, reports and tuning."""
import csv
import io
import json
import os
import sys
import unittest

from case import StudyCase

RASTER = """ncols 4
nrows 4
xllcorner 0
yllcorner 0
cellsize 200
1 2 3 4
5 6 7 8
8 7 6 5
4 3 2 1
"""
RISK = "{file: maps/risk.asc, elsewhere: 1}"
METRICS = f"metrics: [{{exposure: {RISK}, id: risk}}, {{length: {{}}}}]\n"


class Metrics(StudyCase):
    def setUp(self):
        super().setUp()
        os.makedirs(self.path("maps"))
        self.write("maps/risk.asc", RASTER)

    def result(self, *words, code=0):
        self.call("run", self.path("astar.yaml"), "--out", self.path("result.json"), *words, code=code)
        return json.loads(self.read("result.json"))

    def test_every_step_and_the_run_are_measured(self):
        self.write("astar.yaml", self.read("astar.yaml") + "  - fly: route\n" + METRICS)
        self.write("city.yaml", self.read("city.yaml") + "metrics: [altitude: {}]\n")
        result = self.result()
        accepted = next(s for s in result["steps"] if s["id"] == "prune")
        for name in ("risk", "length", "altitude"):
            self.assertGreater(accepted["metrics"][name], 0)
            self.assertEqual(result["metrics"][name], accepted["metrics"][name])
            # The flight follows the route in steps of a second.
            self.assertAlmostEqual(result["flight"]["metrics"][name] / accepted["metrics"][name], 1,
                                   delta=0.05)
        self.assertEqual(accepted["metrics"]["length"], accepted["metrics"]["length_m"])
        out, _ = self.call("run", self.path("astar.yaml"))
        self.assertIn(f"risk of the route: {accepted['metrics']['risk']:.6g}", out)
        # As the objective it costs the same.
        again = self.result("--set", f"objective.exposure={RISK}")
        self.assertEqual(again["cost"], again["metrics"]["risk"])
        self.assertLess(again["metrics"]["risk"], result["metrics"]["risk"])
        out, _ = self.call("check", "--scenario", self.path("city.yaml"), "--route",
                           self.route_of(result), "--json")
        self.assertAlmostEqual(json.loads(out)["metrics"]["altitude"] / result["metrics"]["altitude"],
                               1, delta=1e-9)
        both = self.result("--set", f"objective.weighted.of=[{{exposure: {RISK}, weight: 2}}, "
                           "{length: {}, weight: 0.5}]")
        self.assertAlmostEqual(
            both["cost"] / (2 * both["metrics"]["risk"] + 0.5 * both["metrics"]["length"]), 1, 9)
        none = self.result("--set", "steps.0.within_iterations=0", code=1)
        self.assertIsNone(none["metrics"]["risk"])

    def route_of(self, result):
        rows = "".join("%r,%r,%r\n" % tuple(point) for point in result["route"])
        return self.write("route.csv", "x_m,y_m,z_m\n" + rows)

    def test_names(self):
        steps = self.read("astar.yaml")
        taken = [name for name in self.result()["metrics"]] + ["setup_time_s", "solved", "reached"]
        for metrics, at, expected in (
                ("{exposre: {}}", "metrics.0", "did you mean 'exposure'?"),
                ("{length: {}}, {length: {}}", "metrics.1", "a metric 'length' already"),
                ("{length: {}, id: Risk}", "metrics.0", "expected lower-case letters"),
                ("{length: {far: 1}}", "metrics.0.length.far", "unknown key"),
                ("{exposure: {file: no.asc}}", "metrics.0.exposure.file", "not found"),
                *((f"{{length: {{}}, id: {name}}}", "metrics.0", f"a value '{name}' already")
                  for name in taken)):
            with self.subTest(metrics=metrics):
                self.write("astar.yaml", f"{steps}metrics: [{metrics}]\n")
                said = self.refused("validate", self.path("astar.yaml"))
                self.assertIn("astar.yaml:8:", said)
                self.assertIn(at + ": ", said)
                self.assertIn(expected, said)

    def test_a_study_measures_every_pipeline(self):
        # In a folder of its own: paths are relative to the file that names them.
        os.makedirs(self.path("studies"))
        text = self.read("study.yaml").replace("file: ", "file: ../").replace(
            "  - {name: plan_time_s}\n", "  - {exposure: {file: ../maps/risk.asc, elsewhere: 1}, id: risk}\n"
            "  - {length: {}}\n")
        claims = ("claims:\n  - {id: same, that: min(octile.length / octile.length_m), is: 0.999..1.001}\n"
                  "  - {id: of_step, that: min(octile.steps.route.risk / octile.risk), is: '>= 1'}\n")
        self.study = self.write("studies/study.yaml", text + claims)
        store = self.store("metrics.db")
        out, _ = self.call("report", store, "-o", self.path("report"))
        self.assertIn("all 2 claims hold", out)
        rows = list(csv.DictReader(io.StringIO(self.read("report/runs.csv"))))
        self.assertEqual(len(rows), 12)
        for row in rows:
            self.assertAlmostEqual(float(row["length"]), float(row["length_m"]), places=6)
            self.assertGreater(float(row["steps.route.risk"]), 0)
        self.assertIn("pairs-risk.svg", self.read("report/index.html"))
        front = list(csv.DictReader(io.StringIO(self.read("report/figures/pareto-risk-length.csv"))))
        self.assertEqual([point["pipeline"] for point in front], ["octile", "greedy"])
        self.assertIn("1", [point["non_dominated"] for point in front])
        self.assertIn("reference point", self.read("report/index.html"))
        self.assertIn("hypervolume lost", self.read("report/tables/pareto-risk-length.md"))
        command = next(line for line in self.read("report/index.html").split("\n") if "metrics.0" in line)
        self.assertIn(self.path("maps/risk.asc"), command)

    def test_wrong_metrics_of_a_study(self):
        study = self.read("study.yaml")
        for metric, expected in (
                ("{name: risk}", "study.yaml:13:6: metrics.2.name: no run has a value 'risk'"),
                ("{exposre: {}}", "did you mean 'exposure'?"),
                ("{length: {}}, {length: {}}", "a metric 'length' already"),
                ("{better: lower}", "expected one objective plugin"),
                ("{length: {}, id: expanded}", "a value 'expanded' already")):
            with self.subTest(metric=metric):
                listed = "".join(f"  - {one}\n" for one in metric.replace("}, {", "}|{").split("|"))
                self.write("study.yaml", study.replace("  - {name: plan_time_s}\n", listed))
                said = self.refused("study", self.study, "--out", self.path("no.db"))
                self.assertIn("study.yaml:1", said)
                self.assertIn(expected, said)
        # Of the scenario, by its name alone.
        self.write("city.yaml", self.read("city.yaml") + "metrics: [{altitude: {}, id: risk}]\n")
        self.write("study.yaml", study.replace("plan_time_s", "risk"))
        self.call("validate", self.study)


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
