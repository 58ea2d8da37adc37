# SPDX-License-Identifier: Apache-2.0
"""resuming_test.py PROGRAM PLUGINS: `altiplan tune` after it was killed or interrupted."""
import os
import random
import signal
import subprocess
import time

import case
from case import PIPELINE, SCENARIO, TuneCase, X


class Resuming(TuneCase):
    def start(self, *words, **options):
        return subprocess.Popen(self.arguments(*words, **options), cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                start_new_session=True)

    def slow(self):
        self.write("p.yaml", PIPELINE.replace("      x: 0.9 ", "      slow_s: 0.01\n      x: 0.9 "))

    def test_killed_at_any_moment(self):
        self.slow()
        words = (*X, "--hold-out", "scenarios/s.yaml[start.at_m=[[100,200,500],[100,400,500]]]",
                 "--jobs", 2)
        self.tune(*words, out="calm")
        kills = 0
        draw = random.Random(7)
        for _ in range(200):
            process = self.start(*words, out="killed")
            try:
                process.wait(timeout=draw.uniform(0.02, 0.25))
            except subprocess.TimeoutExpired:
                process.kill()
                kills += 1
                process.communicate()
                continue
            said = process.communicate()[0]
            self.assertEqual(process.returncode, 0, said)
            break
        else:  # a slow machine, or sanitizers
            self.tune(*words, out="killed")
        self.assertGreater(kills, 0)
        self.assertEqual(self.results("killed"), self.results("calm"))

    def test_interrupted(self):
        self.slow()
        process = self.start(*X)
        log = self.path("out", "runs.log")
        while not os.path.exists(log):
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        said = process.communicate()[0]
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("interrupted", said)
        self.assertNotIn("tuned.yaml", os.listdir(self.path("out")))
        self.tune(*X)
        self.tune(*X, out="calm")
        self.assertEqual(self.results("out"), self.results("calm"))

    def test_interrupted_before_the_first_run(self):
        process = self.start(*X, "--tuner", "moody", "--set-tuner", "does=ponders", size=())
        lock = self.path("out", "work", "lock")
        while not (os.path.exists(lock) and os.path.getsize(lock)):
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        said = process.communicate(timeout=60)[0]
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("interrupted", said)

    def test_one_call_at_a_time(self):
        process = self.start(*X, "--tuner", "moody", "--set-tuner", "does=ponders", size=())
        lock = self.path("out", "work", "lock")
        while not (os.path.exists(lock) and os.path.getsize(lock)):
            self.assertIsNone(process.poll())
            time.sleep(0.01)
        said = self.refused(*X)
        process.kill()
        process.communicate()
        self.assertIn(f"in use by another process: {process.pid} on ", said)
        self.assertNotIn("study", said)

    def test_finished_is_finished(self):
        self.tune(*X)
        before = self.results("out")
        self.assertIn("0 new runs in", self.tune(*X))
        self.assertEqual(self.results("out"), before)

    def test_a_torn_log_is_mended(self):
        self.tune(*X)
        before = self.results("out")
        log = before["runs.log"].encode()
        for size in (len(log) - 5, len(log) // 2, 1):
            with open(self.path("out", "runs.log"), "wb") as stream:
                stream.write(log[:size])
            self.tune(*X)
            self.assertEqual(self.results("out"), before)
        spoilt = log.replace(b"solved", b"solvex", 1)
        with open(self.path("out", "runs.log"), "wb") as stream:
            stream.write(spoilt)
        self.assertIn("1 line damaged: running its run again", self.tune(*X))
        self.assertEqual(self.results("out"), before)

    def test_more_evaluations(self):
        self.tune(*X, "--evaluations", 7)
        self.assertEqual(len(self.evaluations()), 8)
        self.tune(*X, "--evaluations", 13)
        self.tune(*X, "--evaluations", 13, out="calm")
        self.assertEqual(self.results("out"), self.results("calm"))

    def test_another_tuning_is_refused(self):
        self.tune(*X)
        said = self.refused(*X, "--seed", 4)
        self.assertIn('"--seed (0 before, 4 now)'[1:], said)
        self.assertIn("--fresh", said)
        self.assertIn("--metric", self.refused(*X, metric="expanded"))
        self.assertIn("--over", self.refused("--over", "steps.0.with.x=0..0.5"))
        self.assertIn("--tuner", self.refused(*X, "--set-tuner", "inertia=0.5"))
        self.write("scenarios/s.yaml", SCENARIO + "# changed\n")
        self.assertIn("the content of " + self.path("scenarios/s.yaml"), self.refused(*X))
        self.tune(*X, "--fresh")

    def test_a_folder_of_something_else_is_left_alone(self):
        os.mkdir(self.path("out"))
        self.write("out/thesis.txt", "years of work")
        for fresh in ((), ("--fresh",)):
            self.assertIn("contains 'thesis.txt' and no tuning", self.refused(*X, *fresh))
        self.assertEqual(os.listdir(self.path("out")), ["thesis.txt"])
        self.assertIn("--out", self.refused(*X, out="p.yaml"))


if __name__ == "__main__":
    case.main()
