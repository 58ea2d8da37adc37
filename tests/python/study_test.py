# SPDX-License-Identifier: Apache-2.0
"""study_test.py PROGRAM PLUGINS SOURCES: studies run from Python, and their databases as tables."""
import csv
import json
import os
import pathlib
import pickle
import signal
import sqlite3
import subprocess
import threading
import time
import unittest

import case
from case import HANGS_S, PLUGINS, PROGRAM, PythonCase, untimed

import altiplan

try:
    import pandas
except ImportError:
    pandas = None

STUDY = """altiplan: 1
name: Two cell sizes
scenarios:
  - {file: scenario.yaml, set: {vehicle.radius_m: [2, 3]}}
  - file: scenario.yaml
    id: shut
    set: {goal.at_m: [[305, 500, 100]]}
pipelines:
  - {id: fine, file: fine.yaml}
  - {id: coarse, file: pipeline.yaml, set: {steps.0.with.heuristic: euclidean}}
metrics: [{name: length_m}, {name: expanded}]
claims:
  - {id: shorter, that: median(fine.length_m / coarse.length_m), is: <= 1}
"""


class StudyCase(PythonCase):
    def setUp(self):
        super().setUp()
        self.file = self.write("study.yaml", STUDY)
        self.write("fine.yaml", case.PIPELINE.replace("[50, 50, 50]", "[25, 25, 50]"))
        self.store = self.folder / "s.db"


class Runs(StudyCase):
    def test_what_the_program_stores(self):
        subprocess.run([PROGRAM, "study", self.file, "--out", self.folder / "p.db"], check=True,
                       stdout=subprocess.DEVNULL, timeout=HANGS_S)
        study = altiplan.study(self.file, self.store, jobs=2)
        self.assertEqual((study.name, study.planned, study.path),
                         ("Two cell sizes", 6, str(self.store)))
        self.assertEqual(repr(study), "<altiplan.Study 'Two cell sizes': 6 of 6 runs>")

        def keys(path):
            with sqlite3.connect(path) as store:
                return store.execute("SELECT key, outcome FROM runs ORDER BY key").fetchall()

        self.assertEqual(keys(self.store), keys(self.folder / "p.db"))

    def test_the_same_call_goes_on(self):
        def stored(**named):
            return repr(altiplan.study(self.file, self.store, **named))

        self.assertIn(": 2 of 6", stored(filter="fine .*[23]. #"))
        self.assertIn(": 2 of 6", stored(filter="fine .*[23]. #"))
        self.assertEqual(altiplan.Study(self.store).runs().session.tolist() if pandas else [1, 1],
                         [1, 1])  # of the first call
        self.assertIn(": 6 of 6", stored(sample=1.0, reuse=3))
        self.assertIn(": 3 of 6", stored(fresh=True, shard="1/2", traces=True))

    def test_results(self):
        study = altiplan.study(self.file, self.store)
        statuses = {study.result(run).status for run in range(1, 7)}
        self.assertEqual(statuses, {"solved", "invalid_problem"})
        for none in (0, 7, 2**62):
            self.assertRaises(KeyError, study.result, none)
        self.assertRaises(TypeError, study.result, "1")
        self.assertEqual(pickle.loads(pickle.dumps(study)).result(1).to_json(), study.result(1).to_json())

    def test_the_same_result_each_way(self):
        """Of a random planner, a smoother and a flight: by a study, the program, and altiplan.run."""
        pipeline = self.write("random.yaml", """altiplan: 1
scenario: scenario.yaml
steps:
  - {plan: rrt_star, within_iterations: 500, with: {range_m: 100}}
  - smooth: prune
  - fly: route
""")
        file = self.write("study.yaml", "altiplan: 1\nscenarios: [{file: scenario.yaml}]\n"
                          "pipelines: [{id: random, file: random.yaml}]\nrepetitions: 2\n")
        study = altiplan.study(file, self.store)
        routes = []
        for run in (1, 2):
            result_of_study = study.result(run)
            stored = result_of_study.to_dict()
            seed = result_of_study.seed
            subprocess.run([PROGRAM, "run", pipeline, f"--seed={seed}", "--out", self.folder / "c.json"],
                           check=True, stdout=subprocess.DEVNULL, timeout=HANGS_S)
            result = altiplan.run(pipeline, seed=seed, out=self.folder / "p.json")
            by_program, by_python = ((self.folder / name).read_text() for name in ("c.json", "p.json"))
            self.assertEqual(untimed(by_python), untimed(by_program))
            self.assertEqual(result.to_json(), by_python)
            self.assertEqual(result_of_study.route.points.tolist(), result.route.points.tolist())
            self.assertEqual([step.route and step.route.points.tolist() for step in result_of_study.steps],
                             [step.route and step.route.points.tolist() for step in result.steps])
            self.assertEqual(result_of_study.flight.metrics.length_m, result.flight.metrics.length_m)
            # A study writes to no folder, and says which scenario it gives the pipeline.
            plain = json.loads(by_program)
            self.assertEqual(plain.pop("folder"), str(self.folder))
            self.assertEqual(stored["overrides"].pop("scenario"), str(self.scenario))
            self.assertEqual(untimed(json.dumps(stored)), untimed(json.dumps(plain)))
            routes.append(stored["steps"][0]["route"])
        self.assertNotEqual(*routes)

    def test_refused(self):
        with self.assertRaisesRegex(altiplan.Error, "did you mean 'metrics'") as caught:
            altiplan.study(self.write("study.yaml", STUDY.replace("metrics", "metrix")), self.store)
        error = caught.exception
        self.assertEqual((error.file, error.line, error.key), (str(self.file), 11, "metrix"))
        self.assertEqual(len(error.problems), 1)
        self.assertFalse(self.store.exists())
        for wrong in (self.folder / "none.db", self.folder, self.file, self.write("empty.db", "")):
            self.assertRaises(altiplan.Error, altiplan.Study, wrong)
        with sqlite3.connect(self.folder / "other.db") as store:
            store.execute("CREATE TABLE study(name, value)")
        self.assertRaisesRegex(altiplan.Error, "not a database of a study", altiplan.Study,
                               self.folder / "other.db")
        self.assertRaisesRegex(altiplan.Error, "none.db: No such file or directory$", altiplan.Study,
                               self.folder / "none.db")
        with sqlite3.connect(self.folder / "old.db") as store:
            store.execute(f"PRAGMA application_id = {0x616C7470}")
            store.execute("PRAGMA user_version = 1")
        self.assertRaisesRegex(altiplan.Error, "old.db is of version 1 of the store; this program supports version 2: "
                               "run the study again with another out, or use the program of that version$",
                               altiplan.Study, self.folder / "old.db")

    def test_arguments(self):
        for expected, named in [
                (TypeError, {"jobs": 1.5}), (ValueError, {"jobs": 0}), (ValueError, {"reuse": -1}),
                (TypeError, {"sample": "5%"}), (ValueError, {"sample": 0}),
                (ValueError, {"sample": float("nan")}), (TypeError, {"filter": 3}),
                (ValueError, {"filter": "a\0"}), (altiplan.Error, {"filter": "("}), (altiplan.Error, {"filter": "nothing"}),
                (altiplan.Error, {"shard": "3/2"}), (altiplan.Error, {"shard": "--help"}),
                (TypeError, {"plugin_path": "/"}), (TypeError, {"unknown": 1})]:
            with self.subTest(**named):
                self.assertRaises(expected, altiplan.study, self.file, self.store, **named)
        for wrong in (None, 3, b"s.db"):
            self.assertRaises(TypeError, altiplan.study, wrong, self.store)
            self.assertRaises(TypeError, altiplan.study, self.file, wrong)
            self.assertRaises(TypeError, altiplan.Study, wrong)

    def test_in_threads(self):
        stores = [self.folder / f"{i}.db" for i in range(3)]
        threads = [threading.Thread(target=altiplan.study, args=(self.file, store))
                   for store in stores]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual([repr(altiplan.Study(store))[-9:] for store in stores], ["f 6 runs>"] * 3)

    def test_ctrl_c(self):
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)
        self.write("pipeline.yaml", "altiplan: 1\nscenario: scenario.yaml\nsteps:\n"
                   "  - {plan: told, within_s: 50, with: {does: waits}}\n")
        file = self.write("study.yaml", "altiplan: 1\nscenarios: [{file: scenario.yaml}]\n"
                          "pipelines: [{id: waits, file: pipeline.yaml}]\n")
        began = time.monotonic()
        timer = threading.Timer(1.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        self.assertRaises(KeyboardInterrupt, altiplan.study, file, self.store, plugin_path=[PLUGINS])
        timer.join()
        self.assertLess(time.monotonic() - began, HANGS_S / 2)
        running = [pathlib.Path(entry, "cmdline") for entry in os.scandir("/proc")
                   if entry.name.isdigit()]
        for command in running:
            try:
                self.assertNotIn(str(file).encode(), command.read_bytes())
            except OSError:
                pass  # it has ended

    def test_what_it_needs(self):
        self.python("import altiplan, sys; altiplan.study(*sys.argv[1:])\n"
                    "assert 'pandas' not in sys.modules", self.file, self.store)


@unittest.skipIf(pandas is None, "no pandas")
class Tables(StudyCase):
    def setUp(self):
        super().setUp()
        self.study = altiplan.study(self.file, self.store)

    def test_one_row_per_run(self):
        runs = self.study.runs()
        self.assertEqual(len(runs), 6)
        self.assertEqual(list(runs.columns[:7]), ["run", "scenario", "pipeline", "repetition", "seed",
                                                  "outcome", "message"])
        radii = runs["scenario.vehicle.radius_m"]
        self.assertEqual(sorted(radii.dropna()), [2, 2, 3, 3])
        self.assertEqual(set(runs["steps.0.with.heuristic"][runs.pipeline == "coarse"]), {"euclidean"})
        self.assertTrue(runs["steps.0.with.heuristic"][runs.pipeline == "fine"].isna().all())
        self.assertEqual(runs.solved.dtype, bool)
        self.assertEqual(runs.solved.sum(), 4)
        self.assertEqual(set(runs.outcome[~runs.solved]), {"invalid_problem"})
        self.assertTrue(runs.length_m[~runs.solved].isna().all())
        lengths = runs[runs.solved].groupby("pipeline").length_m.median()
        self.assertLess(lengths["fine"], lengths["coarse"])

    def test_as_the_reports(self):
        page = pathlib.Path(self.study.report(self.folder / "report"))
        self.assertTrue(page.is_file())
        with open(page.parent / "runs.csv", encoding="utf-8", newline="") as stream:
            expected = list(csv.DictReader(stream))
        runs = self.study.runs()
        self.assertEqual(len(expected), len(runs))
        for row, (_, run) in zip(expected, runs.iterrows()):
            for name, text in row.items():
                if name == "store":
                    continue
                if isinstance(run[name], str):
                    self.assertEqual(run[name], text)
                elif text == "":
                    self.assertTrue(pandas.isna(run[name]), name)
                else:
                    self.assertAlmostEqual(float(run[name]) / (float(text) or 1),
                                           1 if float(text) else 0, places=9)

    def test_tables(self):
        tables = self.study.tables()
        self.assertLessEqual({"success", "success-pairs", "metrics", "verdicts", "scenarios",
                              "pairs-length_m"}, set(tables))
        success = tables["success"]
        self.assertEqual(success.pipeline.tolist(), ["fine", "coarse"])
        self.assertEqual((success.runs.tolist(), success.runs.dtype.kind), ([3, 3], "i"))
        self.assertEqual(success.share.tolist(), [2 / 3, 2 / 3])
        self.assertTrue((success["interval from"] < success.share).all() and (success.share < success["interval to"]).all())
        self.assertEqual(success["of valid problems"].tolist(), [1, 1])
        self.assertLess(success["their interval from"].max(), 1)
        verdict = tables["verdicts"].iloc[0]
        self.assertEqual((verdict.claim, verdict.claimed), ("shorter", "<= 1"))
        texts = {"metric", "pipeline", "against", "better", "other outcomes", "scenario", "claim", "that",
                 "claimed", "verdict", "stated"}
        for name, table in tables.items():
            for column in set(table.columns) - texts:
                if "solved" not in column or name != "scenarios":  # "1/1"
                    self.assertIn(table[column].dtype.kind, "if", (name, column))
        lengths = tables["metrics"].set_index(["metric", "pipeline"]).loc["Length, m"]
        runs = self.study.runs()
        for name, values in runs[runs.solved].groupby("pipeline").length_m:
            self.assertAlmostEqual(lengths.loc[name, "median"], values.median(), delta=1e-8)
        self.assertEqual(len(tables["scenarios"]), 3)
        self.assertEqual(self.study.figures()["success"].share.round(3).tolist(), [0.667, 0.667])

    def test_a_report_of_now(self):
        self.assertEqual(self.study.figures()["success"].runs.tolist(), [3, 3])
        altiplan.study(self.file, self.store, fresh=True, filter="[23]. #")
        self.assertEqual(self.study.figures()["success"].runs.tolist(), [2, 2])
        self.assertEqual(len(self.study.runs()), 4)

    def test_nothing_stored(self):
        with sqlite3.connect(self.store) as store:
            store.execute("DELETE FROM run_values")
            store.execute("DELETE FROM runs")
        self.assertEqual(len(self.study.runs()), 0)
        self.assertNotIn("pairs-length_m", self.study.figures())

    def test_html(self):
        page = self.study._repr_html_()
        self.assertRegex(page, '^<iframe [^>]*srcdoc="&lt;!DOCTYPE html&gt;')
        self.assertEqual(page.count('"'), 4)
        self.assertIn("Two cell sizes", page)

    def test_a_database_that_has_gone(self):
        self.store.unlink()
        for call in (self.study.runs, self.study.tables, self.study._repr_html_, self.study.__repr__):
            self.assertRaises(altiplan.Error, call)

    def test_reading_only(self):
        os.chmod(self.store, 0o444)
        self.assertEqual(json.loads(self.study.runs().to_json(orient="records"))[0]["repetition"], 0)


if __name__ == "__main__":
    case.main()
