# SPDX-License-Identifier: Apache-2.0
"""slurm_test.py PROGRAM [Scripts | OnSlurm]: studies as job arrays. OnSlurm runs on a Slurm that the
test starts, and ends with 77 where none can be started."""
import os
import shlex
import sys
import time
import unittest

from case import GREEDY, PIPELINE, RUNS, SCENARIO, STUDY, StudyCase
from slurm_cluster import Cluster, Unavailable

CLUSTER = None


class Scripts(StudyCase):
    """What is written, without any Slurm."""

    def setUp(self):
        super().setUp()
        os.mkdir(self.path("bin"))
        self.environment = {**os.environ, "PATH": self.path("bin")}

    def sbatch(self, script):
        """A program in the place of sbatch."""
        with open(self.path("bin/sbatch"), "w") as stream:
            stream.write("#!/bin/sh\n" + script)
        os.chmod(self.path("bin/sbatch"), 0o755)

    def test_dry_run_writes_scripts_and_submits_nothing(self):
        self.sbatch("touch submitted\n")
        out, _ = self.call("slurm", self.study, "--out", "it's 5%.db", "--chunk-minutes", "0.01",
                           "--jobs", "2", "--partition", "short", "--dry-run", "--",
                           "--account=a b")
        folder = self.path("it's 5%.db.slurm")
        self.assertIn(f"{RUNS} runs, about ", out)
        self.assertIn(f"{folder}/array.sbatch\n{folder}/merge.sbatch\n", out)
        array = shlex.split(out.splitlines()[-2])
        self.assertEqual(array[:2], ["sbatch", "--parsable"])
        self.assertIn("--account=a b", array)
        self.assertIn("--partition=short", array)
        self.assertIn(f"--output={folder.replace('%', '%%')}/task-%a.log", array)
        self.assertIn("--dependency=afterok:ARRAY", shlex.split(out.splitlines()[-1]))
        script = self.read("it's 5%.db.slurm/array.sbatch")
        self.assertIn("#SBATCH --cpus-per-task=2\n", script)
        self.assertIn("#SBATCH --mem=9216M\n", script)
        self.assertFalse(os.path.exists(self.path("submitted")))

    def test_the_time_is_estimated_from_stored_runs(self):
        store = self.store("study.db", "--sample", "0.5")
        stored = len(self.runs(store))
        # 100 s for each of the others: 10 tasks of a minute and two processes would take 120 s each.
        self.change(store, "UPDATE runs SET wall_time_s = 100")
        self.call("slurm", self.study, "--out", store, "--chunk-minutes", "2", "--dry-run")
        left = RUNS - stored
        tasks = -(-left * 100 // 120)
        self.assertIn(f"#SBATCH --array=1-{tasks}\n", self.read("study.db.slurm/array.sbatch"))
        self.assertNotIn("sample.db", os.listdir(self.path("study.db.slurm")))
        # Once chosen the number stays, or parts would be of other runs.
        self.call("slurm", self.study, "--out", store, "--chunk-minutes", "30", "--dry-run")
        self.assertIn(f"#SBATCH --array=1-{tasks}\n", self.read("study.db.slurm/array.sbatch"))

    def test_errors_are_named(self):
        self.assertIn("no sbatch on PATH",
                      self.refused("slurm", self.study, "--out", "study.db"))
        self.sbatch("echo 'sbatch: error: invalid account' >&2\nexit 1\n")
        os.symlink("/bin/false", self.path("bin/squeue"))
        _, err = self.call("slurm", self.study, "--out", "study.db", code=3)
        self.assertRegex(err, r"sbatch refused '.*array\.sbatch' \(exit code 1\): sbatch: error: "
                              r"invalid account\n$")
        self.assertNotIn("jobs", os.listdir(self.path("study.db.slurm")))
        self.call("slurm", self.study, code=2)
        _, err = self.call("slurm", self.study, "account", "--out", "study.db", code=2)
        self.assertIn("expected options of sbatch after --, found 'account'", err)
        self.refused("slurm", self.path("nowhere.yaml"), "--out", "study.db")

    def test_a_merge_that_is_refused_takes_the_array_along(self):
        self.sbatch('case "$*" in *merge.sbatch) echo no >&2; exit 1;; esac\necho 17\n')
        os.symlink("/bin/false", self.path("bin/squeue"))
        with open(self.path("bin/scancel"), "w") as stream:
            stream.write('#!/bin/sh\necho "$*" >>cancelled\n')
        os.chmod(self.path("bin/scancel"), 0o755)
        _, err = self.call("slurm", self.study, "--out", "study.db", code=3)
        self.assertIn("merge.sbatch' (exit code 1): no\n", err)
        self.assertEqual(self.read("cancelled"), "17\n")

    def test_another_study_is_refused(self):
        self.call("slurm", self.study, "--out", "study.db", "--dry-run")
        self.write("study.yaml", STUDY.replace("seed: 5", "seed: 6"))
        why = self.refused("slurm", self.study, "--out", "study.db", "--dry-run")
        self.assertIn("sample.db' belongs to another study", why)
        self.assertIn("""their files differ: '"seed": 5' against '"seed": 6'""", why)


class OnSlurm(StudyCase):
    """A study on the Slurm that the test has started."""

    def setUp(self):
        super().setUp()
        if CLUSTER is None:
            self.skipTest("there is no Slurm here")
        self.environment = CLUSTER.environment

    def slow_study(self):
        """Of runs that take a third of a second: five million cells, looked at without a heuristic."""
        self.write("city.yaml", SCENARIO.replace("seed: 1", "cells: [300, 300, 60]").replace(
            "[675, 645, 45]", "[2875, 2845, 45]"))
        self.write("astar.yaml", PIPELINE.replace("{corner: free_box}", "{heuristic: zero}"))
        self.study = self.write("study.yaml", STUDY.replace(GREEDY, "").replace("1..3", "1..6"))

    def submit(self, *options, chunk="0.02"):
        out, _ = self.call("slurm", self.study, "--out", self.path("study.db"), "--chunk-minutes",
                           chunk, *options)
        words = out.split()
        return words[words.index("array") + 1].strip(","), out

    def wait(self, happened, what, patience=150):
        end = time.monotonic() + patience
        while not happened():
            self.assertLess(time.monotonic(), end, (what, CLUSTER.queue(), self.logs()))
            time.sleep(0.1)

    def logs(self):
        folder = self.path("study.db.slurm")
        return {name: self.read("study.db.slurm/" + name) for name in os.listdir(folder)
                if name.endswith(".log")}

    def stored(self):
        """Runs in the shards."""
        folder = self.path("study.db.slurm")
        count = 0
        for name in os.listdir(folder):
            if name.startswith("shard-") and name.endswith(".db"):
                try:
                    count += self.rows(os.path.join(folder, name), "SELECT COUNT(*) FROM runs")[0][0]
                except Exception:  # it is about to be made
                    pass
        return count

    def expect_whole(self, reference):
        self.wait(lambda: not CLUSTER.queue(), "all jobs end")
        self.assertTrue(os.path.exists(self.path("study.db")), self.logs())
        self.assertEqual(self.runs(self.path("study.db")), self.runs(reference))

    def test_an_array_does_the_study(self):
        self.slow_study()
        reference = self.store("reference.db", "--jobs", "2")
        _, out = self.submit()
        self.assertRegex(out, r"submitted: array \d+, then merge \d+; the results will be in .*\n$")
        self.assertRegex(out, r": [2-9]\d* tasks of 1 process, about ")
        why = self.refused("slurm", self.study, "--out", self.path("study.db"))
        self.assertIn("are already queued", why)
        self.expect_whole(reference)
        # A second call finds nothing to do, and loses nothing.
        self.submit()
        self.expect_whole(reference)

    def test_a_cancelled_array_is_gone_on_with(self):
        self.slow_study()
        reference = self.store("reference.db", "--jobs", "2")
        array, _ = self.submit(chunk="0.04")
        self.wait(lambda: self.stored() > 0, "a run is stored")
        CLUSTER.say("scancel", array)
        self.wait(lambda: not CLUSTER.queue(), "all jobs end, the merge too")
        self.assertFalse(os.path.exists(self.path("study.db")))
        before = self.stored()
        self.assertLess(before, RUNS)
        self.submit()
        self.expect_whole(reference)
        # What had been stored was not run again.
        sessions = self.rows(self.path("study.db"), "SELECT session, COUNT(*) FROM runs GROUP BY "
                                                    "session ORDER BY session")
        self.assertGreater(len(sessions), 2, sessions)

    def test_a_requeued_task_resumes(self):
        self.slow_study()
        reference = self.store("reference.db", "--jobs", "2")
        array, _ = self.submit(chunk="0.04")
        self.wait(lambda: self.stored() > 0, "a run is stored")
        task = next(job for job in CLUSTER.running() if job.startswith(array + "_"))
        CLUSTER.say("scontrol", "requeue", task)
        self.wait(lambda: CLUSTER.queue().get(task) == "PENDING", "it waits again")
        self.expect_whole(reference)
        log = self.logs()[f"task-{task.split('_')[1]}.log"]
        self.assertIn("DUE TO JOB REQUEUE", log)

    def test_a_task_out_of_time_queues_itself_again(self):
        self.slow_study()
        reference = self.store("reference.db", "--jobs", "2")
        array, _ = self.submit(chunk="0.04")
        self.wait(lambda: self.stored() > 0, "a run is stored")
        task = next(job for job in CLUSTER.running() if job.startswith(array + "_"))
        # As Slurm does a minute before the time is over.
        CLUSTER.say("scancel", "--batch", "--signal=USR1", task)
        self.expect_whole(reference)
        self.assertIn("out of time: requeued",
                      self.logs()[f"task-{task.split('_')[1]}.log"])

    def test_slurm_says_why_it_refuses(self):
        why = self.refused("slurm", self.study, "--out", self.path("study.db"), "--partition",
                           "nowhere")
        self.assertIn("invalid partition specified", why)
        self.assertEqual(CLUSTER.queue(), {})


def main():
    global CLUSTER
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    if sys.argv[1:] and not any(name.startswith("OnSlurm") for name in sys.argv[1:]):
        unittest.main()
    try:
        with Cluster() as CLUSTER:
            unittest.main()
    except Unavailable as why:
        print(f"skipped: no Slurm can be started here: {why}")
        sys.exit(77)


if __name__ == "__main__":
    main()
