# SPDX-License-Identifier: Apache-2.0
"""arena_test.py PROGRAM: the database of `altiplan report --arena`, queried as Planner Arena does."""
import csv
import os
import re
import sqlite3
import statistics
import subprocess
import sys
import unittest

from case import RUNS, STUDY, StudyCase

# The columns that OMPL's own databases have, with their types.
EXPERIMENTS = [("id", "INTEGER"), ("name", "VARCHAR(512)"), ("totaltime", "REAL"),
               ("timelimit", "REAL"), ("memorylimit", "REAL"), ("runcount", "INTEGER"),
               ("version", "VARCHAR(128)"), ("hostname", "VARCHAR(1024)"), ("cpuinfo", "TEXT"),
               ("date", "DATETIME"), ("seed", "VARCHAR(24)"), ("setup", "TEXT")]
CONFIGS = [("id", "INTEGER"), ("name", "VARCHAR(512)"), ("settings", "TEXT")]
ENUMS = [("name", "VARCHAR(512)"), ("value", "INTEGER"), ("description", "TEXT")]
RUN_COLUMNS = [("id", "INTEGER"), ("experimentid", "INTEGER"), ("plannerid", "INTEGER"),
               ("approximate_solution", "BOOLEAN"), ("correct_solution", "BOOLEAN"),
               ("graph_states", "INTEGER"), ("memory", "REAL"), ("solution_clearance", "REAL"),
               ("solution_length", "REAL"), ("solution_segments", "INTEGER"),
               ("solution_smoothness", "REAL"), ("solved", "BOOLEAN"), ("status", "ENUM"),
               ("time", "REAL")]
PROGRESS = [("runid", "INTEGER"), ("time", "REAL"), ("iterations", "INTEGER"), ("evaluations", "INTEGER"),
            ("best_cost", "REAL")]
REFERENCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "..", "shared",
                         "data", "benchmark", "ompl_empty_schema.db")


class Arena(StudyCase):
    def arena(self, *stores):
        self.write_arena(0, *stores)
        database = sqlite3.connect(self.path("arena.db"))
        database.row_factory = sqlite3.Row
        self.addCleanup(database.close)
        return database

    def write_arena(self, code, *stores, out="arena.db"):
        done = subprocess.run([self.program, "report", *stores, "--arena", self.path(out)],
                              capture_output=True, text=True, timeout=60)
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def columns(self, database, table):
        return [tuple(row)[1:3] for row in database.execute(f"PRAGMA table_info({table})")]

    def joined(self, database):
        """Runs with the columns that Planner Arena adds: it reads whole tables, joins by ids, and
        writes blanks for underscores."""
        tables = {name: [dict(row) for row in database.execute(f"SELECT * from {name}")]
                  for name in ("experiments", "plannerConfigs", "enums", "runs", "progress")}
        planners = {row["id"]: re.sub("geometric_|control_", "", row["name"], count=1)
                    for row in tables["plannerConfigs"]}
        self.assertEqual(len(set(planners.values())), len(planners))
        hidden = {"id", "totaltime", "timelimit", "memorylimit", "runcount", "hostname", "cpuinfo",
                  "date", "seed", "setup"}
        experiments = {row["id"]: {("experiment" if key == "name" else key.replace("_", " ")): value
                                   for key, value in row.items() if key not in hidden}
                       for row in tables["experiments"]}
        rows = []
        for run in tables["runs"]:
            row = {key.replace("_", " "): value for key, value in run.items()}
            more = {"planner": planners[run["plannerid"]], **experiments[run["experimentid"]]}
            self.assertFalse(set(row) & set(more), "a join would rename a column")
            rows.append({**row, **more})
        return tables, rows

    def test_schema(self):
        database = self.arena(self.store("study.db", "--sample", "0.4"))
        self.assertEqual(self.columns(database, "experiments")[:12], EXPERIMENTS)
        self.assertEqual(self.columns(database, "experiments")[12:],
                         [("environment_0_city_seed", "REAL")])
        self.assertEqual(self.columns(database, "plannerConfigs"), CONFIGS)
        self.assertEqual(self.columns(database, "enums"), ENUMS)
        self.assertEqual(self.columns(database, "runs")[:len(RUN_COLUMNS)], RUN_COLUMNS)
        self.assertEqual(self.columns(database, "progress"), PROGRESS)
        for name, _ in self.columns(database, "runs"):
            self.assertRegex(name, "^[a-z][a-z0-9_]*$")
        self.assertEqual(database.execute("PRAGMA foreign_key_check").fetchall(), [])
        if os.path.exists(REFERENCE):
            reference = sqlite3.connect(f"file:{REFERENCE}?mode=ro", uri=True)
            self.addCleanup(reference.close)
            for table in ("experiments", "plannerConfigs", "enums", "runs", "progress"):
                columns = self.columns(reference, table)
                self.assertEqual(self.columns(database, table)[:len(columns)], columns)
                keys = reference.execute(f"PRAGMA foreign_key_list({table})").fetchall()
                self.assertEqual([tuple(row) for row in
                                  database.execute(f"PRAGMA foreign_key_list({table})")], keys)

    def test_it_is_what_planner_arena_reads(self):
        tables, rows = self.joined(self.arena(self.store("study.db")))
        self.assertEqual(len(rows), RUNS)
        # One problem with a parameter, which it offers for grouping.
        self.assertEqual({row["experiment"] for row in rows}, {"city"})
        parameter = list(tables["experiments"][0])[12:]
        self.assertEqual(parameter, ["environment_0_city_seed"])
        self.assertEqual({row["environment 0 city seed"] for row in rows}, {1, 2, 3})
        self.assertEqual({row["planner"] for row in rows}, {"octile", "greedy"})
        self.assertEqual(len({row["version"] for row in rows}), 1)
        self.assertRegex(rows[0]["version"], r"^altiplan \d+\.\d+\.\d+$")
        statuses = {row["value"]: row["description"] for row in tables["enums"]
                    if row["name"] == "status"}
        self.assertEqual({statuses[row["status"]] for row in rows}, {"Exact solution"})
        self.assertEqual(tables["progress"], [])
        for row in rows:
            self.assertEqual((row["solved"], row["correct solution"],
                              row["approximate solution"]), (1, 1, 0))
            self.assertGreater(row["time"], 0)
            self.assertGreater(row["memory"], 0)
            self.assertGreater(row["solution length"], 800)
            self.assertEqual(row["solution segments"], row["steps prune waypoints"] - 1)
            self.assertEqual(row["solution length"], row["steps prune length m"])
        experiment = tables["experiments"][0]
        self.assertEqual(experiment["runcount"], 2)
        self.assertEqual(experiment["seed"], "5")
        self.assertRegex(experiment["date"], r"^\d{4}-\d\d-\d\d \d\d:\d\d:\d\d$")
        settings = tables["plannerConfigs"][1]["settings"]
        self.assertIn("steps.0.with.weight_g = 0.3\n", settings)
        self.assertIn("step = plan astar (route)\nstep = smooth prune (prune)\n", settings)

    def test_progress_is_that_of_the_traces(self):
        self.write("study.yaml", STUDY.split("pipelines:")[0] + "pipelines:\n  - {id: octile, file: astar.yaml}\n"
                   "  - {id: star, file: astar.yaml, set: {steps.0: [{plan: rrt_star, id: route}]}}\n"
                   "budget: {iterations: 3000}\n")
        database = self.arena(self.store("study.db", "--traces"))
        rows = database.execute("SELECT plannerid, runid, progress.time, iterations, best_cost, solved FROM "
                                "progress JOIN runs ON runs.id = runid ORDER BY runid, progress.time").fetchall()
        self.assertTrue(rows)
        self.assertEqual({row["plannerid"] for row in rows}, {2})
        for before, row in zip(rows, rows[1:]):
            if before["runid"] == row["runid"]:
                self.assertLess(row["best_cost"], before["best_cost"])
                self.assertGreater(row["iterations"], before["iterations"])
        first = database.execute("SELECT first_route_s, plannerid, id FROM runs WHERE first_route_s NOT NULL")
        firsts = {row["id"]: row["first_route_s"] for row in first}
        self.assertEqual(set(firsts), {row["runid"] for row in rows})
        for run, time in firsts.items():
            self.assertEqual(min(row["time"] for row in rows if row["runid"] == run), time)

    def test_it_says_what_the_table_says(self):
        store = self.store("study.db")
        _, rows = self.joined(self.arena(store))
        self.call("report", store, "-o", self.path("page"))
        with open(self.path("page/runs.csv"), newline="") as stream:
            table = list(csv.DictReader(stream))
        self.assertEqual(len(table), len(rows))
        pairs = {"length_m": "solution length", "expanded": "graph states", "plan_time_s": "time",
                 "min_clearance_m": "solution clearance", "peak_memory_mb": "memory",
                 "setup_time_s": "setup time s"}
        for ours, theirs in pairs.items():
            for planner in ("octile", "greedy"):
                self.assertEqual(
                    statistics.median(float(row[ours]) for row in table
                                      if row["pipeline"] == planner),
                    statistics.median(row[theirs] for row in rows if row["planner"] == planner))

    def test_views_name_the_best(self):
        store = self.store("study.db")
        self.change(store, "UPDATE runs SET outcome = 'timed_out' WHERE pipeline = 1 AND "
                           "repetition = 1")
        database = self.arena(store)
        best = [tuple(row) for row in database.execute(
            "SELECT plannerid, avg_solved FROM bestPlannerConfigs")]
        self.assertEqual(best, [(2, 1.0), (1, 0.5)])
        best = database.execute("SELECT experimentid, plannerid, avg_solved FROM "
                                "bestPlannerConfigsPerExperiment").fetchall()
        self.assertEqual(len(best), 6)
        statuses = database.execute(
            "SELECT description, COUNT(*) FROM runs JOIN enums ON enums.name = 'status' AND value = "
            "status GROUP BY status ORDER BY status").fetchall()
        self.assertEqual([tuple(row) for row in statuses],
                         [("Timeout", 3), ("Exact solution", 9)])

    def test_names_that_planner_arena_would_change(self):
        self.write("study.yaml", STUDY.replace("octile", "geometric_one").replace("greedy", "one"))
        _, rows = self.joined(self.arena(self.store("study.db", "--sample", "0.2")))
        self.assertEqual({row["planner"] for row in rows}, {"geometric-one", "one"})

    def test_it_is_replaced_whole_or_not_at_all(self):
        store = self.store("study.db", "--sample", "0.2")
        for _ in range(2):
            self.arena(store)
        before = self.rows(self.path("arena.db"), "SELECT * FROM runs")
        for name, words in self.spoilt().items():
            why = self.write_arena(3, self.path(name))
            self.assertIn(name, why)
            if name != "nowhere.db":
                self.assertIn(words, why)
        self.assertEqual(self.rows(self.path("arena.db"), "SELECT * FROM runs"), before)
        self.assertIn("--arena", self.write_arena(3, store, out="no/arena.db"))


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
