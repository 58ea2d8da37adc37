#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""study_test.py PROGRAM PLUGINS: `altiplan study` as a user calls it."""

import pathlib
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM, PLUGINS = "", ""

SCENARIO = """altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 1000]}
start: {at_m: [100, 500, 500]}
goal: {at_m: [900, 500, 500]}
"""
PIPELINE = "altiplan: 1\nscenario: s.yaml\nsteps: [{plan: told, with: {does: %s}}]\n"


class StudyCase(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory()
        self.addCleanup(self._folder.cleanup)
        self.folder = pathlib.Path(self._folder.name)
        self.write("s.yaml", SCENARIO)
        self.write("p.yaml", PIPELINE % "straight")
        self.write("n.yaml", PIPELINE % "no_route")
        self.study()

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")

    def study(self, more="", repetitions=2, radii="1..5"):
        self.write("study.yaml", f"""altiplan: 1
name: Of a test
scenarios: [{{file: s.yaml, set: {{vehicle.radius_m: {radii}}}}}]
pipelines: [{{id: straight, file: p.yaml}}, {{id: none, file: n.yaml}}]
repetitions: {repetitions}
{more}""")

    def call(self, *words, expect=0, store="out.db"):
        out = ["--out", store] if store else []
        done = subprocess.run(
            [PROGRAM, "study", "study.yaml", *out, "--plugin-path", PLUGINS, *map(str, words)],
            cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def rows(self, store="out.db"):
        with sqlite3.connect(self.folder / store) as database:
            self.assertEqual(database.execute("PRAGMA integrity_check").fetchall(), [("ok",)])
            return database.execute(
                "SELECT pipelines.name, scenarios.name, repetition, seed, outcome, place FROM runs "
                "JOIN pipelines ON pipelines.id = pipeline JOIN scenarios ON scenarios.id = scenario "
                "ORDER BY 1, 2, 3").fetchall()


class Study(StudyCase):
    def test_every_run_has_its_outcome(self):
        said = self.call("--jobs", 2)
        self.assertIn("20 runs stored, 20 of them new", said)
        rows = self.rows()
        self.assertEqual(len(rows), 20)
        self.assertEqual({(row[0], row[4]) for row in rows},
                         {("straight", "solved"), ("none", "no_route")})
        seeds = {}
        for row in rows:
            seeds.setdefault((row[1], row[2]), set()).add(row[3])
        self.assertTrue(all(len(of_pair) == 1 for of_pair in seeds.values()))
        self.assertEqual(len(set.union(*seeds.values())), 10)
        self.assertFalse((self.folder / "out.db.work").exists(), "nothing is left lying about")

    def test_a_claim_made_after_runs_says_so(self):
        claims = "claims: [{id: all, that: share(straight.solved), is: '%s'}%s]\n"
        self.study(claims % (">= 0.9", ""))
        self.assertNotIn("after", self.call("--filter", "s\\[radius_m=[12]\\]"))
        said = self.call()
        self.assertIn("5 of 5 pairs counted; repetitions are equal and count once.\n", said)
        self.study(claims % (">= 0.3", ", {id: more, that: share(none.solved), is: <= 0.9}"))
        for _ in range(2):
            said = self.call()
            self.assertRegex(said, "claim all: Holds: .* count once. Changed after 20 runs.")
            self.assertRegex(said, "claim more: Holds: .* count once. Added after 20 runs.")
            self.assertIn("with Holm's correction over all 2 that have an interval all decided ones stay decided.", said)
        self.study(claims % (">= 0.9", ""))
        self.assertIn("Changed after 20 runs.", self.call())
        self.assertNotIn("after", self.call("--fresh"))

    def test_what_is_stored_is_not_run_again(self):
        self.call("--filter", "straight")
        self.assertEqual(len(self.rows()), 10)
        self.assertIn("20 runs stored, 10 of them new", self.call())
        self.assertIn("20 runs stored, 0 of them new", self.call("--resume"))
        self.study(repetitions=3)
        self.assertIn("30 runs stored, 10 of them new", self.call())
        self.assertIn("30 runs stored, 30 of them new", self.call("--fresh"))

    def test_what_has_changed_is_run_again(self):
        self.call()
        self.write("p.yaml", PIPELINE % "straight" + "# a comment\n")
        self.assertIn("0 of them new", self.call())
        self.write("p.yaml", PIPELINE % "no_route")
        said = self.call()
        self.assertIn("10 stored runs out of date", said)
        self.assertIn("20 runs stored, 10 of them new", said)
        self.assertEqual({row[4] for row in self.rows()}, {"no_route"})

    def test_another_study_is_refused(self):
        self.call()
        self.study(radii="3..7")
        said = self.call(expect=3)
        self.assertIn("contains 8 runs that this study does not have", said)
        self.assertEqual(len(self.rows()), 20)

    def test_shards_are_the_whole(self):
        for shard in (1, 2, 3):
            self.call("--shard", f"{shard}/3", store=f"{shard}.db")
        together = [row for shard in (1, 2, 3) for row in self.rows(f"{shard}.db")]
        self.call()
        self.assertEqual(sorted(together), self.rows())

    def test_reuse_is_marked_and_changes_nothing_else(self):
        self.call(store="one.db")
        self.call("--reuse", 7)
        self.assertGreater(max(row[5] for row in self.rows()), 1)
        self.assertEqual([row[:5] for row in self.rows()], [row[:5] for row in self.rows("one.db")])

    def test_sample_and_dry_run(self):
        said = self.call("--dry-run")
        self.assertIn("2 pipelines x 5 scenarios x 2 repetitions = 20 runs", said)
        self.assertFalse((self.folder / "out.db").exists())
        self.assertIn("to do 20", self.call("--dry-run", store=None))
        self.assertIn("--out is required", self.call(store=None, expect=2))
        self.call("--sample", "20%")
        self.assertEqual(len(self.rows()), 4)
        self.assertIn("selected 20, stored 4, to do 16", self.call("--dry-run"))

    def test_a_dry_run_of_very_many_runs_checks_some(self):
        self.study(radii="1..700")
        said = self.call("--dry-run", store=None)
        self.assertIn("2 pipelines x 700 scenarios x 2 repetitions = 2800 runs\n  selected 2800", said)
        self.assertRegex(said, r"\n  not checked: the files of \d{3} runs\n")
        self.assertRegex(said, r"per run, from \d trial runs?\)")

    def test_claims_that_so_few_runs_cannot_decide(self):
        self.study("claims: [{id: long, that: mean(straight.length_m), is: '>= 5'}]\n")
        said = self.call("--dry-run")
        self.assertIn("claim long will be undecided: too few scenarios: at least 10 for 95 %", said)
        self.assertEqual(said.count("will be"), 1)
        said = self.call("--dry-run", "--filter", "^none ")
        self.assertIn("claim long will have no data: no selected pair has runs of straight", said)
        self.study("claims: [{id: often, that: share(straight.solved), is: '>= 0.9'}]\n", repetitions=1,
                   radii="1..40")
        self.assertNotIn("claim", self.call("--dry-run"))
        self.assertNotIn("claim", self.call("--dry-run", "--shard", "1/8"), "the shards decide together")
        said = self.call("--dry-run", "--sample", "50%")
        self.assertIn("claim often cannot hold: too few scenarios: 35 would do for 95 %", said)

    def test_gate(self):
        self.study("claims: [{id: c, that: share(straight.solved), is: '>= 0.5'}]\n")
        self.assertIn("claim c: Holds", self.call("--gate"))
        self.study("claims: [{id: c, that: share(none.solved), is: '>= 0.5'}]\n")
        self.assertIn("claim c: Fails", self.call("--gate", expect=1))
        self.call()

    def test_one_parent_at_a_time(self):
        self.write("p.yaml", (PIPELINE % "never_stops").replace("with:", "within_s: 2, with:"))
        first = subprocess.Popen([PROGRAM, "study", "study.yaml", "--out", "out.db", "--plugin-path",
                                  PLUGINS], cwd=self.folder, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        try:
            while len(list(self.folder.glob("out.db.work/*"))) < 2:  # the lock, and a worker's file
                self.assertIsNone(first.poll())
                time.sleep(0.01)
            self.assertIn(str(first.pid), self.call(expect=3))
            first.send_signal(signal.SIGINT)
            self.assertEqual(first.wait(20), 130)
        finally:
            first.kill()
            first.wait()
        self.write("p.yaml", PIPELINE % "straight")
        self.call()
        self.assertEqual(len(self.rows()), 20)

    def test_a_file_that_changes_on_the_way_ends_the_call(self):
        def pipeline(seconds):
            self.write("p.yaml", "altiplan: 1\nscenario: s.yaml\nsteps: [{plan: outlaw, with: "
                                 "{does: takes_its_time}, within_s: %s}]\n" % seconds)
        pipeline(0.2)
        first = subprocess.Popen([PROGRAM, "study", "study.yaml", "--out", "out.db", "--plugin-path",
                                  PLUGINS], cwd=self.folder, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.PIPE, text=True)
        while not (self.folder / "out.db").exists():
            self.assertIsNone(first.poll())
            time.sleep(0.01)
        pipeline(0.3)
        self.assertIn("have changed since the runs were planned", first.communicate(timeout=600)[1])
        self.assertEqual(first.returncode, 3)
        pipeline(0.2)
        self.call()
        self.assertEqual({row[4] for row in self.rows()}, {"solved", "no_route"})
        self.assertEqual(len(self.rows()), 20)

    def test_bad_calls(self):
        for words, said, code in (
                (("--jobs", 0), "--jobs", 2), (("--reuse", 0), "--reuse", 2),
                (("--shard", "3/2"), "expected I/N", 2), (("--sample", "0"), "expected a fraction", 2),
                (("--sample", "200%"), "expected a fraction", 2),
                (("--fresh", "--resume"), "--fresh", 2),
                (("--filter", "("), "expected a regular expression", 3),
                (("--shard", "4294967297/4294967298"), "expected I/N", 2),
                (("--filter", "nothing"), "no run is left", 3)):
            self.assertIn(said, self.call(*words, expect=code), words)
        self.assertFalse((self.folder / "out.db").exists())
        self.assertIn("--out", self.call(expect=3, store="no/folder/out.db"))
        self.write("text.db", "no database, " * 100)
        self.assertIn("not a database", self.call(expect=3, store="text.db"))
        self.study("claims: [{id: c, that: median(strait.length_m), is: < 1}]\n")
        self.assertIn("did you mean 'straight'", self.call(expect=3))


if __name__ == "__main__":
    PROGRAM, PLUGINS = sys.argv[1:3]
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
