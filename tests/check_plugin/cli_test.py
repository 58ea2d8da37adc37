# SPDX-License-Identifier: Apache-2.0
"""cli_test.py PROGRAM PLUGINS: `altiplan check-plugin` as a user calls it.

PLUGINS is the folder of the plugins broken on purpose. Each test leaves nothing in TMPDIR."""
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

PROGRAM, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:3])
TUNERS = os.path.join(PLUGINS, "tuners.so")
PLANNERS = os.path.join(PLUGINS, "planners.so")
POINTS = "^tuner/asks_nothing/points_lie_in_the_space$"


class CheckPlugin(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_cli_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.scratch = os.path.join(self.folder, "tmp")
        os.mkdir(self.scratch)
        path = os.path.dirname(PROGRAM) + os.pathsep + os.environ["PATH"]
        self.environment = {**os.environ, "TMPDIR": self.scratch, "PATH": path}

    def tearDown(self):
        self.assertEqual(os.listdir(self.scratch), [])

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as stream:
            stream.write(text)
        return self.path(name)

    def run_it(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, "check-plugin", *arguments], cwd=self.folder, text=True,
                              env=self.environment, stdin=subprocess.DEVNULL, errors="replace",
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=600)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def test_list(self):
        names = self.run_it(TUNERS, "--list").stdout.split()
        self.assertEqual(names[:3],
                         ["library/manifest", "library/exports_one_symbol", "library/loads"])
        self.assertEqual(len(names), len(set(names)))
        self.assertIn("tuner/sound/searches_in_turns", names)
        one = self.run_it(TUNERS, "--list", "--only", "sound/searches").stdout.split()
        self.assertEqual(one, ["tuner/sound/searches_in_turns"])

    def test_list_without_the_clock(self):
        def timed(*more):
            names = self.run_it(PLANNERS, "--list", "--only", "^planner/sound/", *more)
            return [n for n in names.stdout.split() if "deadlines" in n or "in_time" in n]
        self.assertEqual(len(timed()), 2)
        self.assertEqual(timed("--untimed"), [])

    def test_only(self):
        said = self.run_it(TUNERS, "--only", "^nothing$", code=2).stderr
        self.assertIn("no test of " + TUNERS + " has a name that matches '^nothing$'", said)
        self.assertIn("expected a regular expression, found '('",
                      self.run_it(TUNERS, "--only", "(", code=2).stderr)

    def test_files_that_are_none(self):
        self.assertIn("no such file", self.run_it(self.path("none.so"), code=3).stderr)
        self.assertIn("not a file", self.run_it(self.folder, code=3).stderr)
        text = self.write("text.so", "so far, so good\n")
        said = self.run_it(text, code=4).stdout
        self.assertIn("FAILED  library/manifest", said)
        self.assertEqual(self.run_it(text, "--list").stdout.split(),
                         ["library/manifest", "library/exports_one_symbol"])
        self.run_it(self.write("empty.so", ""), code=4)

    def test_a_library_cut_off(self):
        with open(TUNERS, "rb") as stream:
            whole = stream.read()
        for share in (0.3, 0.9):
            with open(self.path("part.so"), "wb") as stream:
                stream.write(whole[:int(share * len(whole))])
            self.assertIn("FAILED  library/manifest", self.run_it(self.path("part.so"), code=4).stdout)

    def test_sets(self):
        for text, place, words in (
                ("- unit_m: no\n", ":1:", "unit_m"), ("- volum: {}\n", ":1:", "volum"),
                ("- with: {}\n  iterations: -1\n", ":2:", "iterations"), ("a: [\n", "", "")):
            sets = self.write("sets.yaml", text)
            said = self.run_it(TUNERS, "--sets", sets, code=3).stderr
            self.assertIn(sets + place, said)
            self.assertIn(words, said)
        sets = self.write("sets.yaml", "- plugin: other\n")
        self.assertIn("a parameter set is for 'other'",
                      self.run_it(TUNERS, "--sets", sets, code=3).stderr)
        self.run_it(TUNERS, "--sets", self.path("none.yaml"), code=3)

    def test_parameters_that_do_not_fit(self):
        sets = self.write("sets.yaml", "- with: {nonsense: 3}\n")
        done = self.run_it(TUNERS, "--sets", sets, "--only", "^tuner/sound/", code=3)
        self.assertIn("sets.yaml:1:10: nonsense: unknown key", done.stderr)
        self.assertIn("0 failed", done.stdout)

    def test_scratch_folder_by_a_relative_path(self):
        self.environment["TMPDIR"] = "tmp"
        self.run_it(TUNERS, "--only", "^tuner/sound/searches")
        self.environment["TMPDIR"] = "nowhere"
        done = self.run_it(TUNERS, "--only", "^tuner/sound/searches", code=3)
        self.assertIn("TMPDIR: folder not found: nowhere", done.stderr)

    def test_input_is_left_alone(self):
        command = f"'{PROGRAM}' check-plugin '{TUNERS}' --only ^tuner/sound/ > out; cat"
        done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=self.environment,
                              input="of the next command", text=True, capture_output=True)
        self.assertEqual(done.stdout, "of the next command")

    def test_several_sets(self):
        sets = self.write("sets.yaml", "- plugin: sound\n- plugin: sound\n  unit_m: 20\n")
        names = self.run_it(TUNERS, "--sets", sets, "--list", "--only", "/sound/.*turns").stdout
        self.assertEqual(names.split(),
                         ["tuner/sound/%d/searches_in_turns" % n for n in (0, 1)])
        self.run_it(TUNERS, "--sets", sets, "--only", "/sound/.*turns")

    def test_json(self):
        for only, code in (("^tuner/sound/", 0), ("^tuner/(sound|prints)/", 4)):
            told = json.loads(self.run_it(TUNERS, "--json", "--only", only, code=code).stdout)
            states = [test["status"] for test in told["tests"]]
            self.assertEqual(told["failed"], states.count("failed"))
            self.assertEqual(told["passed"], states.count("passed"))
            self.assertEqual(told["skipped"], states.count("skipped"))
            self.assertEqual(told["failed"] > 0, code == 4)
            for test in told["tests"]:
                self.assertEqual(test["status"] == "failed", bool(test["findings"]))
        self.assertEqual(told["library"], TUNERS)

    def test_junit(self):
        out = self.path("verdicts.xml")
        told = json.loads(self.run_it(TUNERS, "--json", "--junit", out, "--only",
                                      "^tuner/(sound|prints)/", code=4).stdout)
        root = xml.etree.ElementTree.parse(out).getroot()
        self.assertEqual(len(list(root.iter("testcase"))), len(told["tests"]))
        self.assertEqual(len(list(root.iter("failure"))), told["failed"])
        suites = list(root.iter("testsuite"))
        self.assertEqual({suite.get("name") for suite in suites}, {"tuner/sound", "tuner/prints"})
        self.assertEqual(sum(int(suite.get("tests")) for suite in suites), len(told["tests"]))
        self.assertEqual(sum(int(suite.get("failures")) for suite in suites), told["failed"])

    def test_junit_that_cannot_be_written_is_said_first(self):
        began = time.monotonic()
        done = self.run_it(PLANNERS, "--junit", self.path("no/verdicts.xml"), code=3)
        self.assertIn("--junit", done.stderr)
        self.assertEqual(done.stdout, "")
        self.assertLess(time.monotonic() - began, 5)

    def test_here(self):
        self.run_it(TUNERS, "--here", "--only", "sound/searches_in_turns")
        self.assertIn("FAILED", self.run_it(TUNERS, "--here", "--only", POINTS, code=4).stdout)
        self.assertIn("--here runs one test",
                      self.run_it(TUNERS, "--here", "--only", "^tuner/sound/", code=2).stderr)

    def test_numbers_out_of_range(self):
        for option, values in (("--seed", ("-1", "x")), ("--rounds", ("0", "1.5", "x")),
                               ("--jobs", ("0", "x")), ("--time-limit", ("0", "nan", "x")),
                               ("--memory-limit", ("0", "nan", "x"))):
            for value in values:
                self.assertIn(option, self.run_it(TUNERS, option, value, code=2).stderr)
        self.run_it(code=2)

    def test_equal_seeds_give_equal_verdicts(self):
        def said(seed):
            told = self.run_it(TUNERS, "--json", "--seed", seed, "--only", "^tuner/unequal/", code=4)
            return [(t["name"], t["findings"]) for t in json.loads(told.stdout)["tests"]]
        self.assertEqual(said("3"), said("3"))
        self.assertNotEqual(said("3"), said("4"))

    def test_time_limit(self):
        began = time.monotonic()
        done = self.run_it(PLANNERS, "--rounds", "1", "--time-limit", "1.5", "--only",
                           "never_returns/possible", code=4)
        self.assertIn("did not end within 2 s", done.stdout)
        self.assertLess(time.monotonic() - began, 20)

    def test_the_first_hang_ends_the_run(self):
        began = time.monotonic()
        done = self.run_it(PLANNERS, "--rounds", "1", "--time-limit", "2", "--jobs", "1", "--json",
                           "--untimed", "--only", "^planner/never_returns/", code=4)
        tests = json.loads(done.stdout)["tests"]
        [hung] = [test for test in tests if test["status"] == "failed"]
        left = [test for test in tests if test["skipped"] and "not run after" in test["skipped"]]
        self.assertGreater(len(left), 5)
        self.assertEqual({test["skipped"] for test in left},
                         {"not run after %s, which did not end" % hung["name"]})
        self.assertLess(time.monotonic() - began, 20)

    def test_memory_limit(self):
        done = self.run_it(PLANNERS, "--rounds", "1", "--memory-limit", "200", "--only",
                           "hoards/possible", code=4)
        self.assertIn("used more than 200 MB", done.stdout)

    def test_log_level(self):
        only = ("--only", "sound/searches_in_turns")
        self.assertNotIn("searches_in_turns", self.run_it(TUNERS, *only).stdout)
        self.assertIn("searches_in_turns",
                      self.run_it(TUNERS, *only, "--log-level", "info").stdout)

    def test_again(self):
        """The line that shows a failure again, as a shell runs it."""
        for library, only in ((TUNERS, POINTS),
                              (TUNERS, "^tuner/depends_on_address/same_answers"),
                              (TUNERS, "^tuner/prints/writes_nothing"),
                              (PLANNERS, "^planner/leaves_process/possible")):
            spaced = os.path.join(self.folder, "a 'place'")
            os.makedirs(spaced, exist_ok=True)
            here = shutil.copy(library, spaced)
            told = json.loads(self.run_it(here, "--json", "--rounds", "2", "--seed", "5", "--only",
                                          only, code=4).stdout)["tests"]
            self.assertEqual(len(told), 1)
            done = subprocess.run(told[0]["again"], shell=True, cwd="/", env=self.environment,
                                  text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                  timeout=600)
            self.assertEqual(done.returncode, 4, told[0]["again"] + done.stdout + done.stderr)
            self.assertIn(told[0]["findings"][0]["contract"], done.stdout)

    def processes(self):
        """Those that have this test's TMPDIR above them."""
        mine = []
        for entry in os.listdir("/proc"):
            try:
                with open("/proc/%s/environ" % entry, "rb") as stream:
                    if self.scratch.encode() in stream.read():
                        mine.append(entry)
            except OSError:
                pass
        return mine

    def test_interrupt(self):
        for only in ("never_returns/possible", "^planner/"):
            run = subprocess.Popen([PROGRAM, "check-plugin", PLANNERS, "--rounds", "1", "--only", only],
                                   env=self.environment, stdin=subprocess.DEVNULL, text=True,
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            deadline = time.monotonic() + 30
            while len(self.processes()) < 2 and time.monotonic() < deadline:
                time.sleep(0.05)
            run.send_signal(signal.SIGINT)
            began = time.monotonic()
            said = run.communicate(timeout=600)[1]
            self.assertLess(time.monotonic() - began, 10)
            self.assertEqual(run.returncode, 130, said)
            self.assertIn("interrupted", said)
            self.assertEqual(self.processes(), [])
            self.assertEqual(os.listdir(self.scratch), [])


if __name__ == "__main__":
    del sys.argv[1:3]
    unittest.main()
