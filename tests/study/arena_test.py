# SPDX-License-Identifier: Apache-2.0
"""arena_test.py PROGRAM: the database of `altiplan report --arena`, queried as Planner Arena does, and those of
OMPL, read."""
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
                              capture_output=True, text=True, timeout=600)
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


OMPL = """
CREATE TABLE experiments(id INTEGER PRIMARY KEY, name VARCHAR(512), totaltime REAL, timelimit REAL, memorylimit REAL,
  runcount INTEGER, version VARCHAR(128), hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME, seed VARCHAR(24), setup TEXT);
CREATE TABLE plannerConfigs(id INTEGER PRIMARY KEY, name VARCHAR(512), settings TEXT);
CREATE TABLE enums(name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY (name, value));
CREATE TABLE runs(id INTEGER PRIMARY KEY, experimentid INTEGER, plannerid INTEGER, approximate_solution BOOLEAN,
  correct_solution BOOLEAN, solution_length REAL, solution_segments INTEGER, solved BOOLEAN, status ENUM, time REAL,
  best_cost REAL, note VARCHAR(99));
CREATE TABLE progress(runid INTEGER, time REAL, iterations INTEGER, best_cost REAL, PRIMARY KEY (runid, time));
INSERT INTO experiments VALUES(7, 'city[seed=1]', 9, 20, 900, 4, 'OMPL 1.5.2', 'there', 'cpu', '2023-11-05 03:54:37', '42', '');
INSERT INTO plannerConfigs VALUES(1, 'geometric_RRT', 'range = 1'), (2, 'geometric_RRT', 'range = 2'), (3, 'geometric_RRTstar', '');
INSERT INTO enums VALUES('status', 1, 'Invalid start'), ('status', 4, 'Timeout'), ('status', 5, 'Approximate solution'),
  ('status', 6, 'Exact solution');
INSERT INTO runs VALUES
  (1, 7, 1, 0, 1, 900.5, 4, 1, 6, 0.5, NULL, 'x'), (2, 7, 1, 1, 1, 800, 3, 1, 5, 20, NULL, 'x'),
  (3, 7, 2, 0, 0, 700, 3, 1, 6, 1, NULL, 'x'), (4, 7, 2, 0, 0, NULL, NULL, 0, 4, 20, NULL, 'x'),
  (5, 7, 2, 0, 0, NULL, NULL, 0, 1, 0, NULL, 'x'), (6, 7, 3, 0, 1, 850, 9, 1, 6, 20, 850, 'x');
INSERT INTO progress VALUES(6, 1, 100, NULL), (6, 2, 200, 950), (6, 3, 300, 850), (1, 0.2, 7, NULL);
"""


class Benchmarks(StudyCase):
    """Databases of OMPL, read by `altiplan report`."""

    def benchmark(self, sql="", name="ompl.db"):
        database = sqlite3.connect(self.path(name))
        database.executescript(OMPL + sql)
        database.close()
        return self.path(name)

    def reported(self, *files):
        self.call("report", *files, "-o", self.path("page"))
        with open(self.path("page/runs.csv"), newline="") as stream:
            return list(csv.DictReader(stream))

    def refused_report(self, *files):
        return self.refused("report", *files, "-o", self.path("none"))

    def test_alone(self):
        rows = self.reported(self.benchmark())
        self.assertEqual([(row["pipeline"], row["repetition"], row["outcome"], row["message"]) for row in rows],
                         [("geometric_RRT", "0", "solved", ""),
                          ("geometric_RRT", "1", "no_route", "Approximate solution"),
                          ("geometric_RRT (2)", "0", "rejected", "Invalid solution"),
                          ("geometric_RRT (2)", "1", "timed_out", "Timeout"),
                          ("geometric_RRT (2)", "2", "invalid_problem", "Invalid start"),
                          ("geometric_RRTstar", "0", "solved", "")])
        self.assertEqual({row["seed"] for row in rows}, {"42"})
        self.assertEqual((rows[0]["length_m"], rows[0]["waypoints"], rows[0]["plan_time_s"], rows[0]["cost"]),
                         ("900.5", "5", "0.5", "900.5"))
        self.assertNotIn("note", rows[0])
        with open(self.path("page/tables/anytime.csv"), newline="") as stream:
            times = {row["pipeline"]: row for row in csv.DictReader(stream)}
        self.assertEqual([times["geometric_RRTstar"][name] for name in
                          ("first route, s", "to 5 %, s", "evaluations to 5 %")], ["2", "3", "300"])
        self.assertEqual([times["geometric_RRT"][name] for name in ("runs", "first route, s", "runs to 5 %")],
                         ["2", "", "0"], "one of two has a route")
        with open(self.path("page/figures/anytime-time.csv"), newline="") as stream:
            shares = {row["pipeline"]: float(row["with_a_route"]) for row in csv.DictReader(stream)}
        self.assertEqual(shares["geometric_RRT"], 0.5, "its progress has no costs: it has a route when it ends")

    def test_no_command_repeats_their_runs(self):
        self.reported(self.benchmark("INSERT INTO enums VALUES('status', 7, 'Crash');"
                                     "UPDATE runs SET status = 7 WHERE id = 4;"))
        failures = self.read("page/index.html").partition("Unexplained failures")[2].partition("</table>")[0]
        self.assertIn("city[seed=1] #1", failures)
        self.assertNotIn("altiplan replay", failures)

    def test_two_of_one_experiment(self):
        """Their runs of one planner are further repetitions; limits of time that differ are none."""
        other = self.benchmark("UPDATE experiments SET timelimit = 1;", "other.db")
        rows = self.reported(self.benchmark(), other)
        keys = [(row["pipeline"], row["repetition"]) for row in rows if row["pipeline"] == "geometric_RRT"]
        self.assertEqual(sorted(keys), [("geometric_RRT", str(n)) for n in range(4)])

    def test_costs_that_are_no_lengths_are_not_mixed(self):
        rows = self.reported(self.benchmark("UPDATE runs SET best_cost = 3 WHERE id = 6;"))
        self.assertEqual([row["cost"] for row in rows], ["", "", "", "", "", "3"])

    def test_beside_a_study(self):
        rows = self.reported(self.store("study.db", "--filter", "seed=1"), self.benchmark())
        self.assertEqual({row["scenario"] for row in rows}, {"city[seed=1]"})
        self.assertEqual({row["pipeline"] for row in rows},
                         {"octile", "greedy", "geometric_RRT", "geometric_RRT (2)", "geometric_RRTstar"})
        with open(self.path("page/tables/pairs-length_m.csv"), newline="") as stream:
            pairs = [row for row in csv.DictReader(stream)
                     if {row["pipeline"], row["against"]} == {"octile", "geometric_RRT"}]
        self.assertEqual([row["both solved"] for row in pairs], ["1"])

    def test_what_is_exported_is_read_again(self):
        store = self.store("study.db")
        before = self.reported(store)
        self.call("report", store, "--arena", self.path("arena.db"))
        again = self.reported(self.path("arena.db"))
        for name in ("pipeline", "outcome", "length_m", "plan_time_s", "expanded", "waypoints", "min_clearance_m"):
            self.assertEqual(sorted(row[name] for row in again), sorted(row[name] for row in before), name)
        self.assertEqual(len({row["scenario"] for row in again}), 3)

    def test_refused(self):
        store = self.store("study.db", "--filter", "seed=2")
        why = self.refused_report(store, self.benchmark("UPDATE experiments SET name = 'Car';"))
        self.assertIn("none of its experiments has the name of a scenario of the study; the first is 'Car'", why)
        self.assertIn("run 1 is of no experiment or planner",
                      self.refused_report(self.benchmark("DELETE FROM plannerConfigs WHERE id = 1;", "b.db")))
        self.assertIn("it has no runs", self.refused_report(self.benchmark("DELETE FROM runs;", "c.db")))
        self.assertIn("'time' is 'soon', expected a number",
                      self.refused_report(self.benchmark("UPDATE runs SET time = 'soon';", "d.db")))
        for n, time_s in enumerate(("-1", "9e999")):
            self.assertIn("the time of run 1 is none: expected seconds from 0",
                          self.refused_report(self.benchmark(f"UPDATE runs SET time = {time_s};", f"f{n}.db")))
        self.assertIn("no columns 'solved' and 'time'", self.refused_report(
            self.benchmark("ALTER TABLE runs RENAME COLUMN time TO when_;", "e.db")))

    def test_files_of_others(self):
        folder = os.path.join(os.environ.get("ALTIPLAN_TEST_DATA", ""), "benchmark")
        if not os.path.isdir(folder):
            self.skipTest("no test data")
        rows = self.reported(os.path.join(folder, "ompl_car_1.5.2.db"))
        solved = {name: sum(row["outcome"] == "solved" for row in rows if row["pipeline"] == name)
                  for name in ("control_RGRRT", "control_RRT", "control_KPIECE1")}
        self.assertEqual((len(rows), solved), (60, {"control_RGRRT": 20, "control_RRT": 19, "control_KPIECE1": 3}))
        rows = self.reported(os.path.join(folder, "ompl_progress.db"))
        self.assertEqual(len(rows), 80)
        self.assertTrue(os.path.exists(self.path("page/figures/anytime-time.svg")))
        self.assertIn("no columns 'solved' and 'time'",
                      self.refused_report(os.path.join(folder, "ompl_empty_schema.db")))


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
