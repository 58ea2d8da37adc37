# SPDX-License-Identifier: Apache-2.0
"""What the tests of studies share: a folder with a small study in it, and the program's calls."""
import concurrent.futures
import io
import os
import pathlib
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import by_day  # noqa: E402, F401

# Buildings drawn anew by each seed.
SCENARIO = """altiplan: 1
environment:
  - city: {generate: simple, seed: 1}
vehicle: {radius_m: 0}
start: {at_m: [15, 25, 45]}
goal: {at_m: [675, 645, 45]}
"""
PIPELINE = """altiplan: 1
scenario: city.yaml
steps:
  - plan: astar
    id: route
    with: {corner: free_box}
  - smooth: prune
"""
GREEDY = "  - {id: greedy, file: astar.yaml, set: {steps.0.with.weight_g: 0.3}}\n"
STUDY = f"""altiplan: 1
name: Two in three cities
seed: 5
scenarios:
  - {{file: city.yaml, set: {{environment.0.city.seed: 1..3}}}}
pipelines:
  - {{id: octile, file: astar.yaml}}
{GREEDY}repetitions: 2
metrics:
  - {{name: length_m}}
  - {{name: expanded}}
  - {{name: plan_time_s}}
"""
RUNS = 12


class AtOnce:
    """A runner of so many tests at a time, for those that wait more than they work."""

    def __init__(self, count):
        self.count = count

    def run(self, suite):
        def run_alone(test):
            said = io.StringIO()
            return unittest.TextTestRunner(said).run(test), said.getvalue()

        result = unittest.TestResult()
        with concurrent.futures.ThreadPoolExecutor(self.count) as pool:
            for of_one, said in pool.map(run_alone, tests_in(suite)):
                if not of_one.wasSuccessful():
                    print(said)
                result.testsRun += of_one.testsRun
                result.failures += of_one.failures
                result.errors += of_one.errors
        print(result)
        return result


def tests_in(suite):
    for part in suite:
        if isinstance(part, unittest.TestSuite):
            yield from tests_in(part)
        else:
            yield part


class StudyCase(unittest.TestCase):
    program = None

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_study_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.environment = None
        self.write("city.yaml", SCENARIO)
        self.write("astar.yaml", PIPELINE)
        self.study = self.write("study.yaml", STUDY)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as stream:
            stream.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name)) as stream:
            return stream.read()

    def call(self, *arguments, code=0):
        """What the program printed on stdout and on stderr; it must end with this code."""
        done = subprocess.run([self.program, *map(str, arguments)], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, cwd=self.folder, timeout=600,
                              env=self.environment)
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done.stdout, done.stderr

    def refused(self, *arguments):
        """The one sentence on stderr of a call that a wrong file ends."""
        out, err = self.call(*arguments, code=3)
        self.assertEqual(out, "")
        self.assertEqual(err.count("\n"), 1, err)
        return err

    def store(self, name, *options):
        """A store of the study."""
        self.call("study", self.study, "--out", self.path(name), *options)
        return self.path(name)

    def rows(self, store, sql, *values):
        database = sqlite3.connect(store)
        self.addCleanup(database.close)
        return database.execute(sql, values).fetchall()

    def change(self, store, sql, *values):
        database = sqlite3.connect(store)
        database.execute(sql, values)
        database.commit()
        database.close()

    def killed_while_it_writes(self, store, copy):
        """A copy of the store with its journal, as kill -9 leaves them in the middle of a write."""
        database = sqlite3.connect(self.path(store), isolation_level=None)
        database.execute("PRAGMA cache_size = 1")
        database.execute("BEGIN")
        database.execute("UPDATE runs SET message = 'half written'")
        for number in range(500):
            database.execute("INSERT INTO quantities(name) VALUES(?)", (str(number) + 500 * "y",))
        for suffix in "", "-journal":
            shutil.copy(self.path(store + suffix), self.path(copy + suffix))
        database.execute("ROLLBACK")
        database.close()
        return self.path(copy)

    def runs(self, store):
        """All that no clock decides, by the runs' names."""
        runs = {}
        for row in self.rows(
                store, "SELECT runs.id, pipelines.name, scenarios.name, repetition, runs.key, seed, "
                "outcome, message FROM runs JOIN pipelines ON pipelines.id = pipeline JOIN "
                "scenarios ON scenarios.id = scenario"):
            values = self.rows(
                store, "SELECT name, value FROM run_values JOIN quantities ON quantities.id = "
                "quantity WHERE run = ? AND name NOT LIKE '%time_s' AND name NOT LIKE '%memory_mb' "
                "ORDER BY name", row[0])
            name = f"{row[1]} {row[2]} #{row[3]}"
            self.assertNotIn(name, runs)
            runs[name] = (row[4:], values)
        return runs

    def spoilt(self):
        """Files that are no stores, by what is said of them."""
        self.write("notes.db", "Nothing of a database, and long enough to be looked at.\n" * 40)
        sqlite3.connect(self.path("other.db")).execute("CREATE TABLE t(x)").connection.close()
        newer = self.store("newer.db", "--sample", "0.1")
        self.change(newer, "PRAGMA user_version = 99")
        cut = self.store("cut.db", "--sample", "0.1")
        os.truncate(cut, os.path.getsize(cut) // 2)
        return {"nowhere.db": "no such", "notes.db": "not a database", "other.db": "not of altiplan",
                "newer.db": "version 99", "cut.db": "damaged"}
