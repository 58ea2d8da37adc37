#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""faults_test.py PROGRAM FAILING: studies on a machine that fails for a while. FAILING is the library of
failing_calls.cpp."""
import errno
import os
import signal
import struct
import subprocess
import sys
import time
import unittest

from case import AtOnce, StudyCase

FAILING = ""
MAP = "type octile\nheight 8\nwidth 8\nmap\n" + 3 * "........\n" + "..@@@@..\n" + 4 * "........\n"
SCENARIO = """altiplan: 1
environment: [{grid_map: {file: %s.map}}]
vehicle: {radius_m: 0}
start: {at_cell: [0, 0]}
goal: {at_cell: [7, 7]}
level_flight_at_m: 0
"""
PIPELINE = "altiplan: 1\nscenario: one.yaml\nsteps: [{plan: astar}]\n"
STUDY = """altiplan: 1
name: On a bad day
scenarios: [{file: one.yaml}, {file: two.yaml}]
pipelines: [{id: first, file: astar.yaml}, {id: second, file: astar.yaml}]
repetitions: 2
"""
RUNS = 8


class Faults(StudyCase):
    def setUp(self):
        super().setUp()
        self.write("astar.yaml", PIPELINE)
        for name in ("one", "two"):
            self.write(name + ".yaml", SCENARIO % name)
            self.write(name + ".map", MAP)
        self.write("study.yaml", STUDY)
        self.calm = self.runs(self.store("calm.db"))
        self.assertEqual({run[0][2] for run in self.calm.values()}, {"solved"})

    def failing(self, call, number, error, path="", where="", well=0):
        """From now on the program is called so that so many calls fail (-1: all) after some that go
        well."""
        with open(self.path("count"), "wb") as stream:
            stream.write(struct.pack("ii", well, number))
        self.environment = dict(
            os.environ, LD_PRELOAD=FAILING, FAIL_COUNT=self.path("count"), FAIL_CALL=call,
            FAIL_PATH=path, FAIL_ERROR=str(error), FAIL_IN=where)

    def left(self):
        """How many calls go well yet, and how many fail then."""
        with open(self.path("count"), "rb") as stream:
            return struct.unpack("ii", stream.read())

    def study_passes(self, *options):
        """The fault passes within the call: what it says on stderr."""
        out, err = self.call("study", "study.yaml", "--out", "out.db", *options)
        self.assertEqual(self.left()[1], 0, "not all of them failed")
        self.assertIn(f"{RUNS} runs stored, {RUNS} of them new", out)
        self.finished()
        return err

    def study_ends(self, *options):
        """The fault does not pass: what the call says; the next one has what is missing."""
        err = self.call("study", "study.yaml", "--out", "out.db", *options, code=3)[1]
        self.assertIn("repeat the command to continue", err.splitlines()[-1])
        if os.path.exists(self.path("out.db")):
            for name, run in self.runs(self.path("out.db")).items():
                self.assertEqual(run, self.calm[name])
        self.environment = None
        self.call("study", "study.yaml", "--out", "out.db")
        self.finished()
        return err

    def finished(self):
        self.assertEqual(self.runs(self.path("out.db")), self.calm)
        self.assertFalse(os.path.exists(self.path("out.db.work")), "the work folder is left")
        os.remove(self.path("out.db"))

    def test_records_that_cannot_be_read_for_a_while(self):
        for error in (errno.EIO, errno.EMFILE):
            for option, number, where in (("--jobs", 4, "first"), ("--reuse", 3, "")):
                with self.subTest(error=error, where=where):
                    self.failing("open", number, error, ".records", where)
                    self.study_passes(option, 2)

    def test_records_that_cannot_be_read_at_all(self):
        for error, where in ((errno.EIO, "first"), (errno.ENOSPC, "children")):
            with self.subTest(error=error, where=where):
                self.failing("open", -1, error, ".records", where)
                err = self.study_ends("--jobs", 2)
                self.assertIn(".records: cannot be ", err)
                self.assertIn(os.strerror(error), err)

    def test_a_map_that_cannot_be_read_for_a_while(self):
        for number in (1, 3):
            with self.subTest(number=number):
                self.failing("open", number, errno.EIO, "two.map", where="children")
                self.study_passes("--jobs", 2)

    def test_a_map_that_cannot_be_read_at_all(self):
        for error in (errno.EIO, errno.ENOENT):
            with self.subTest(error=error):
                self.failing("open", -1, error, "two.map", where="children")
                err = self.call("study", "study.yaml", "--out", "out.db", code=3)[1]
                self.assertIn("two.map", err)
                self.assertIn("there is no such file" if error == errno.ENOENT
                              else os.strerror(error), err)
                self.assertEqual(len(self.runs(self.path("out.db"))), RUNS // 2, "the others")
                self.study_ends()

    def test_a_scenario_that_cannot_be_read(self):
        self.failing("open", 2, errno.EMFILE, "two.yaml", where="children")
        self.assertIn("two.yaml: cannot be opened: Too many open files", self.study_passes())
        self.failing("open", -1, errno.EMFILE, "two.yaml", where="children")
        self.assertIn("two.yaml: cannot be opened: Too many open files", self.study_ends())

    def test_no_process_for_a_while(self):
        self.failing("fork", 0, errno.EAGAIN, well=1000)
        self.study_passes()
        forks = 1000 - self.left()[0]
        self.failing("fork", 3, errno.EAGAIN, well=forks - 5)
        self.assertIn("cannot start a worker process: Resource temporarily unavailable; trying again",
                      self.study_passes())
        self.failing("fork", -1, errno.EAGAIN, well=forks - 5)
        self.assertIn("cannot start a worker process: Resource temporarily unavailable",
                      self.study_ends())

    def test_planning_loses_nothing_that_is_stored(self):
        self.store("out.db")
        for path in ("two.map", "libaltiplan_planner_astar.so", "libaltiplan.so", "lib/altiplan"):
            with self.subTest(path=path):
                self.failing("open", -1, errno.EMFILE, path)
                err = self.refused("study", "study.yaml", "--out", "out.db")
                self.assertIn("Too many open files", err)
                self.assertIn(path, err)
                self.assertEqual(self.runs(self.path("out.db")), self.calm)

    def test_a_library_is_not_to_blame_for_the_machine(self):
        self.failing("write", -1, errno.EIO, where="children")
        self.call("validate", "astar.yaml")
        self.failing("fork", -1, errno.EAGAIN)
        self.assertIn("cannot be examined: no process: Resource temporarily unavailable",
                      self.refused("validate", "astar.yaml"))
        self.failing("open", -1, errno.EIO, "libaltiplan_planner_astar.so")
        self.assertIn("cannot be opened: Input/output error", self.refused("validate", "astar.yaml"))

    def test_one_call_at_a_time_by_every_name(self):
        self.write("astar.yaml", "altiplan: 1\nscenario: one.yaml\nsteps: [{plan: rrt_star, "
                   "within_s: 2, with: {max_iterations: 100000000}}]\n")
        self.call("study", "study.yaml", "--out", "out.db", "--filter", "nothing", code=3)
        open(self.path("out.db"), "w").close()
        os.link(self.path("out.db"), self.path("hard.db"))
        os.symlink("out.db", self.path("soft.db"))
        first = subprocess.Popen([self.program, "study", "study.yaml", "--out", "out.db"],
                                 cwd=self.folder, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        try:
            while not os.path.getsize(self.path("out.db")):
                self.assertIsNone(first.poll())
                time.sleep(0.01)
            for name in ("hard.db", "soft.db", "out.db"):
                err = self.refused("study", "study.yaml", "--out", name)
                self.assertIn(str(first.pid), err, name)
            first.send_signal(signal.SIGINT)
            self.assertEqual(first.wait(20), 130)
        finally:
            first.kill()
            first.wait()
        self.assertFalse(os.path.exists(self.path("hard.db.work")))


if __name__ == "__main__":
    StudyCase.program, FAILING = map(os.path.abspath, sys.argv[1:3])
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], testRunner=AtOnce(4))
