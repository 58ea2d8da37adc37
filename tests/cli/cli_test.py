# SPDX-License-Identifier: Apache-2.0
"""cli_test.py PROGRAM BROKEN: the command line, as a user calls it.

BROKEN is the folder of the libraries that no one can use."""
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
import xml.etree.ElementTree

PROGRAM, BROKEN = sys.argv[1:3]
ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
BAD_FILES = os.path.join(ROOT, "tests", "bad_files")

# A wall between start and goal, passed on either side; the vehicle then meets a post.
SCENARIO = """altiplan: 1
environment:
  - box: {min_m: [300, 300, 0], max_m: [310, 700, 1000]}
    id: wall
  - cylinder: {at_m: [700, 500], radius_m: 30}
    id: post
    known: KNOWN
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
vehicle: {radius_m: 2, sensing_m: 300}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100], tolerance_m: 5}
"""
PIPELINE = """altiplan: 1
scenario: scenario.yaml
seed: 3
steps:
  - plan: astar
    with: {cell_m: [50, 50, 50]}
"""
# The goal in a closed shell: a search sees all of the lattice before it gives up.
SEALED = """altiplan: 1
environment:
  - box: {min_m: [800, 400, 50], max_m: [1000, 410, 150]}
  - box: {min_m: [800, 590, 50], max_m: [1000, 600, 150]}
  - box: {min_m: [800, 400, 50], max_m: [810, 600, 150]}
  - box: {min_m: [990, 400, 50], max_m: [1000, 600, 150]}
  - box: {min_m: [800, 400, 50], max_m: [1000, 600, 60]}
  - box: {min_m: [800, 400, 140], max_m: [1000, 600, 150]}
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100]}
"""


def bad_files():
    """The cases of tests/bad_files/expected.tsv: row, file, text replaced, by what, problems."""
    plain = {"n": "\n", "r": "\r", "t": "\t"}

    def unescaped(text):
        return re.sub(rb"\\(?:x(..)|(.))", lambda found: bytes([int(found[1], 16)]) if found[1] else
                      plain.get(found[2].decode(), found[2].decode()).encode(), text.encode())

    cases = []
    with open(os.path.join(BAD_FILES, "expected.tsv"), newline="\n") as table:
        for row, line in enumerate(table, 1):
            if line.strip() and not line.startswith("#"):
                file, before, after, place, key, message = line.rstrip("\n").split("\t")
                if file:
                    cases.append((row, file, unescaped(before), unescaped(after), []))
                cases[-1][4].append(("" if place == "0:0" else place + ": ") +
                                    (key + ": " if key else "") + message)
    return cases


class Cli(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_cli_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "true"))
        self.pipeline = self.write("pipeline.yaml", PIPELINE)
        self.sealed = self.write("sealed.yaml", SEALED)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as stream:
            stream.write(text)
        return self.path(name)

    def read(self, name):
        with open(self.path(name)) as stream:
            return stream.read()

    def call(self, *arguments, code=0, stdout=subprocess.PIPE):
        """What the program printed on stdout and on stderr; it must end with this code."""
        done = subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, stdout=stdout,
                              stderr=subprocess.PIPE, text=True, cwd=self.folder, timeout=250)
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done.stdout, done.stderr

    def result(self, *arguments, code=0):
        out, _ = self.call("run", "--json", *arguments, code=code)
        return json.loads(out)

    # Exit codes.

    def test_exit_codes(self):
        out, err = self.call("run", self.pipeline)
        self.assertIn("pipeline: solved", out)
        self.assertEqual(err, "")
        self.call("run", self.pipeline, "--scenario", self.sealed, code=1)
        self.call(code=2)
        self.call("fly", code=2)
        self.call("run", code=2)
        self.call("run", self.pipeline, "--threads", "0", code=2)
        self.call("run", self.pipeline, "--seed", "-1", code=2)
        for assignment in ("seed", "=3"):
            _, err = self.call("run", self.pipeline, "--set", assignment, code=2)
            self.assertIn("expected KEY=VALUE", err)
        for file in ("nowhere.yaml", "", self.folder):
            out, err = self.call("run", file, code=3)
            self.assertEqual(out, "")
            self.assertTrue(err)
        self.call("describe", "nobody", code=3)
        with open("/dev/full", "w") as full:
            self.call("plugins", code=5, stdout=full)

    def test_a_reader_that_goes_away_ends_every_command_quietly(self):
        self.call("run", self.pipeline, "--out", "read.json")
        for command in (("plugins",), ("plugins", "--json"), ("describe", "astar"), ("schema",),
                        ("explain", self.pipeline), ("run", self.pipeline, "--out", "kept.json"),
                        ("run", "--json", self.pipeline), ("check", "read.json"),
                        ("--log-level", "quiet", "export", "read.json", "--to", "csv"),
                        ("--help",), ("run", "--help"), ("--version",)):
            with self.subTest(command=command):
                read_end, write_end = os.pipe()
                os.close(read_end)
                try:
                    _, err = self.call(*command, code=-signal.SIGPIPE, stdout=write_end)
                finally:
                    os.close(write_end)
                self.assertEqual(err, "")
        self.assertIn('"altiplan": 1', self.read("kept.json"), "files are written all the same")

    def test_a_refused_library_or_a_failed_step_is_4(self):
        refused = self.write("refused.yaml", PIPELINE + "constraints:\n  - gamma: {}\n")
        out, err = self.call("run", refused, "--plugin-path", BROKEN, code=4)
        self.assertEqual(out, "")
        self.assertIn("missing_function_of_a_test", err)
        _, err = self.call("run", refused, code=3)
        self.assertIn("no library offers the constraint 'gamma'", err)
        # alpha always says that it failed
        fails = self.write("fails.yaml", PIPELINE.split("  - plan")[0] + "  - plan: alpha\n")
        self.assertEqual(
            self.result(fails, "--plugin-path", BROKEN, code=4)["status"], "failed")

    def test_help_has_an_example(self):
        for verb in ("run", "validate", "explain", "check", "view", "plugins", "describe", "schema",
                     "new"):
            out, _ = self.call(verb, "--help")
            self.assertIn("Example:\n  altiplan " + verb, out)
        _, err = self.call("--log-level", "loud", "plugins", code=2)
        self.assertIn("--log-level: expected quiet, warning or info, found 'loud'", err)
        self.assertRegex(self.call("--version")[0], r"^\d+\.\d+\.\d+\n$")

    # run

    def test_json_is_the_result_alone(self):
        result = self.result(self.pipeline, "--out", self.path("result.json"))
        self.assertEqual(result, json.loads(self.read("result.json")))
        self.assertEqual(result["status"], "solved")
        self.assertTrue(result["check"]["ok"])
        self.assertGreater(result["metrics"]["length_m"], 800)
        self.assertEqual(self.call("run", self.pipeline, "--json")[1], "")

    def test_out_that_cannot_be_written_is_said_before_planning(self):
        trace = self.path("trace.jsonl")
        for option, place in (("--out", "missing/result.json"), ("--out", self.folder),
                              ("--out", "")):
            _, err = self.call("run", self.pipeline, "--trace", trace, option, place, code=3)
            self.assertIn("--out", err)
            self.assertFalse(os.path.exists(trace), "planning had begun")
        self.call("run", self.pipeline, "--trace", "missing/trace.jsonl", code=3)

    def test_set_of_written_and_unwritten_keys(self):
        written = self.result(self.pipeline, "--set", "steps.0.with.cell_m=[100, 100, 100]")
        before = self.result(self.pipeline)
        self.assertLess(written["metrics"]["expanded"], before["metrics"]["expanded"])
        self.assertEqual(written["overrides"]["set"],
                         {"steps.0.with.cell_m": "[100, 100, 100]"})
        unwritten = self.result(self.pipeline, "--set", "steps.0.with.heuristic=zero")
        self.assertGreater(unwritten["metrics"]["expanded"], before["metrics"]["expanded"])
        self.result(self.pipeline, "--set", "steps.0.within_iterations=5", code=1)
        moved = self.result(self.pipeline, "--set", "scenario.goal.at_m=[900, 600, 100]")
        self.assertEqual(moved["route"][-1], [900, 600, 100])
        taller = self.result(self.pipeline, "--set", "scenario.environment.0.box.max_m=[310, 1000, "
                             "1000]", "--set", "scenario.environment.0.box.min_m=[300, 0, 0]",
                             code=1)
        self.assertIsNone(taller["route"])
        for wrong in ("steps.0.with.weight=1", "steps.1.plan=astar", "steps.0.with.cell_m=text",
                      "scenario.goals={}"):
            out, err = self.call("run", self.pipeline, "--set", wrong, code=3)
            self.assertEqual(out, "")
            self.assertIn("--set " + wrong, err)

    def test_seed_and_scenario(self):
        self.assertEqual(self.result(self.pipeline)["seed"], 3)
        result = self.result(self.pipeline, "--seed", "11")
        self.assertEqual((result["seed"], result["overrides"]), (11, {"seed": 11}))
        result = self.result(self.pipeline, "--scenario", self.sealed, code=1)
        self.assertEqual(result["scenario"], self.sealed)
        self.assertEqual(result["status"], "no_route")
        self.assertIsNone(result["route"])
        self.assertIsNone(result["metrics"]["length_m"])

    def test_the_trace_has_a_line_for_each_expansion(self):
        trace = self.path("trace.jsonl")
        result = self.result(self.pipeline, "--trace", trace)
        lines = [json.loads(line) for line in self.read("trace.jsonl").splitlines()]
        self.assertEqual(lines[0], {"altiplan_trace": 1})
        expansions = [line for line in lines[1:] if line["kind"] == "expanded"]
        self.assertEqual(len(expansions), result["metrics"]["expanded"])
        self.assertEqual(expansions[0]["at"], [100, 500, 100])
        self.assertEqual(result["trace"], trace)

    def test_an_interrupt_ends_the_plan_and_writes_the_result(self):
        trace = self.path("trace.jsonl")
        run = subprocess.Popen(
            [PROGRAM, "run", self.pipeline, "--scenario", self.sealed, "--set",
             "steps.0.with.cell_m=[4, 4, 4]", "--trace", trace, "--out", self.path("result.json")],
            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=self.folder)
        try:
            # Under a name of its own until the run ends.
            while not any(os.path.getsize(file) >= 10000 for file in glob.glob(trace + ".*")):
                self.assertIsNone(run.poll(), "ended by itself")
                time.sleep(0.01)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(timeout=200), 130)
        finally:
            run.kill()
        result = json.loads(self.read("result.json"))
        self.assertEqual(result["status"], "cancelled")
        self.assertEqual(result["steps"][0]["status"], "cancelled")
        self.assertIsNone(result["route"])

    # validate, explain

    def test_validate(self):
        out, err = self.call("validate", self.pipeline, "scenario.yaml")
        self.assertEqual((out, err), (self.pipeline + ": valid\nscenario.yaml: valid\n", ""))
        bad = self.write("bad.yaml", PIPELINE.replace("seed: 3", "sede: 3").replace(
            "50, 50]}", "50, -1]\n          , heuristc: zero}"))
        out, err = self.call("validate", self.pipeline, bad, code=3)
        self.assertEqual(out, self.pipeline + ": valid\n")
        self.assertIn(bad + ":3:1: sede: ", err)
        self.assertIn("did you mean 'seed'", err)
        self.assertIn(bad + ":6:29: steps.0.with.cell_m.2: ", err)
        self.assertIn(bad + ":7:13: steps.0.with.heuristc: ", err)
        later = self.write("later.yaml", PIPELINE.replace("altiplan: 1", "altiplan: 2"))
        _, err = self.call("validate", later, code=3)
        self.assertEqual(err, later + ":1:11: altiplan: expected 1, found 2\n")
        for name in ("''", "{}", "nowhere.yaml", "."):
            nameless = self.write("nameless.yaml", PIPELINE.replace("scenario.yaml", name))
            _, err = self.call("validate", nameless, code=3)
            self.assertEqual(err.count("\n"), 1)
            self.assertIn(nameless + ":2:", err)
        for text in ("altiplan: 1\n---\naltiplan: 1\n", "a: [", "", "altiplan: 1\nsteps: null\n"):
            self.call("validate", self.write("worse.yaml", text), code=3)

    def test_bad_files_are_refused_by_validate_and_run(self):
        sample = bad_files()[::10]
        self.assertGreaterEqual(len(sample), 40)
        self.write("result.json", "before")
        for row, file, before, after, problems in sample:
            for name in ("pipeline.yaml", "scenario.yaml", "ground.asc", "zones.geojson",
                         "study.yaml"):
                with open(os.path.join(BAD_FILES, name), "rb") as stream:
                    text = stream.read()
                if name == file:
                    self.assertTrue(before == b"*" or text.count(before) == 1, row)
                    text = after if before == b"*" else text.replace(before, after)
                with open(self.path(name), "wb") as stream:
                    stream.write(text)
            files = sorted(os.listdir(self.folder))
            for command in (["validate"], ["study", "--out", "result.json"] if file == "study.yaml" else
                            ["run", "--out", "result.json"]):
                with self.subTest(row=row, command=command[0]):
                    read = file if file == "study.yaml" else "pipeline.yaml"
                    out, err = self.call(*command, read, code=3)
                    self.assertEqual(out, "")
                    for problem in problems:
                        self.assertIn(problem, err.replace(self.folder + "/", ""))
                    self.assertEqual(self.read("result.json"), "before")
                    self.assertEqual(sorted(os.listdir(self.folder)), files)

    def test_explain(self):
        out, _ = self.call("explain", self.pipeline, "--json", "--set", "steps.0.with.weight_h=0.2")
        explained = json.loads(out)
        self.assertEqual((explained["notes"], explained["warnings"]), ([], []))
        values = {entry["key"]: entry for entry in explained["parameters"]}
        self.assertEqual(values["steps.0.with.weight_h"]["value"], 0.2)
        self.assertEqual(values["steps.0.with.weight_h"]["from"], "--set steps.0.with.weight_h=0.2")
        self.assertEqual(values["steps.0.with.weight_g"]["from"], "default")
        cell = values["steps.0.with.cell_m"]
        self.assertEqual((cell["value"], cell["unit"]), ([50, 50, 50], "m"))
        self.assertTrue(cell["from"].startswith(self.pipeline + ":6:"), cell)
        self.assertEqual(values["scenario.environment.1.cylinder.radius_m"]["value"], 30)
        self.assertEqual(values["scenario.environment.1.id"]["value"], "post")
        self.assertIs(values["scenario.environment.1.known"]["value"], True)
        self.assertEqual(values["scenario.goal"]["value"],
                         {"at_m": [900, 500, 100], "tolerance_m": 5})
        out, _ = self.call("explain", self.pipeline)
        self.assertRegex(out, r"steps\.0\.with\.weight_g +0\.5 +default\n")

    def test_explain_shows_via_points_moving_obstacles_and_events(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "false") + """via:
  - {at_m: [150, 500, 100], tolerance_m: 20}
moving:
  - sphere: {at_m: [500, 100, 100], radius_m: 10, velocity_mps: [0, 1, 0]}
  - random: {count: 2, radius_m: 5, speed_mps: 3}
    known: false
events:
  - {at_s: 5, id: late, add: {cylinder: {at_m: [500, 900], radius_m: 20}}}
  - {at_s: 9, remove: late}
""")
        out, _ = self.call("explain", self.pipeline, "--json")
        values = {entry["key"]: entry["value"] for entry in json.loads(out)["parameters"]}
        for key, value in (("environment.1.known", False), ("via.0.tolerance_m", 20),
                           ("moving.0.id", "sphere_1"), ("moving.0.sphere.radius_m", 10),
                           ("moving.1.known", False), ("moving.1.random.count", 2),
                           ("events.0.id", "late"), ("events.0.known", False),
                           ("events.0.add", {"cylinder": {"at_m": [500, 900], "radius_m": 20}}),
                           ("events.1.at_s", 9), ("events.1.remove", "late")):
            self.assertEqual(values["scenario." + key], value, key)
        self.assertNotIn("scenario.events.1.known", values)

    # documentation

    def test_the_files_in_the_documentation_are_valid(self):
        shutil.copytree(os.path.join(ROOT, "configs"), self.path("configs"))
        blocks = 0
        for page in ("README.md", "docs/getting-started.md", "docs/files.md"):
            with open(os.path.join(ROOT, page)) as stream:
                files = re.findall(r"```yaml\n(altiplan: 1\n.*?)```", stream.read(), re.DOTALL)
            pipeline = next(text for text in files if "\nsteps:" in text)
            written = [self.write("configs/pipelines/of_a_page.yaml", pipeline)]
            for text in files:
                if text != pipeline:
                    name = re.search(r"\nscenario: (.*)", pipeline).group(1)
                    written.append(self.write("configs/pipelines/" + name, text))
            out, _ = self.call("validate", *written)
            blocks += out.count(": valid\n")
        self.assertGreaterEqual(blocks, 5)

    # check

    def test_check_a_route_from_elsewhere(self):
        around = self.write("route.json", "[[100,500,100],[200,200,100],[600,300,100],"
                            "[900,500,100]]")
        out, _ = self.call("check", "--route", around, "--scenario", "scenario.yaml")
        self.assertTrue(out.startswith("sound: 4 waypoints"), out)
        through = self.write("through.json", "[[100,500,100],[900,500,100]]")
        out, _ = self.call("check", "--route", through, "--scenario", "scenario.yaml", code=1)
        self.assertIn("'post'", out)
        out, _ = self.call("check", "--route", through, "--scenario", "scenario.yaml", "--json",
                           code=1)
        self.assertFalse(json.loads(out)["check"]["ok"])
        for text in ("[]", "[[1,2]]", "{}", "[1", '"text"', '[["a","b","c"]]'):
            route = self.write("wrong.json", text)
            self.call("check", "--route", route, "--scenario", "scenario.yaml", code=3)
        _, err = self.call("check", "scenario.yaml", code=3)
        self.assertEqual(err, "altiplan: scenario.yaml:1: this is not JSON: expected a result of "
                              "altiplan run\n")
        self.call("check", "--route", around, code=2)
        self.call("check", code=2)

    def test_check_a_result_without_a_flight(self):
        self.call("run", self.pipeline, "-o", "result.json")
        out, _ = self.call("check", "result.json")
        self.assertTrue(out.startswith("sound"), out)
        self.assertNotIn("flight", out)
        result = json.loads(self.read("result.json"))
        result["route"] = [result["route"][0], result["route"][-1]]
        self.write("forged.json", json.dumps(result))
        out, _ = self.call("check", "forged.json", code=1)
        self.assertTrue(out.startswith("not sound"), out)
        self.write("scenario.yaml", self.read("scenario.yaml") + "# changed\n")
        _, err = self.call("check", "result.json")
        self.assertIn("scenario.yaml is not the file that the result was made from", err)
        for text in ("{}", "[1", "[]", '{"altiplan": 2}'):
            self.call("check", self.write("wrong.json", text), code=3)

    def test_check_a_flight_against_the_true_world(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "false"))
        flies = self.write("flies.yaml", PIPELINE + "  - fly: apf\n"
                           "    with: {influence_m: 200}\n")
        self.call("run", flies, "--out", "result.json")
        out, _ = self.call("check", "result.json")
        self.assertIn("\nflight sound: ", out)
        self.assertIn("0 collisions, reached the goal", out)

        result = json.loads(self.read("result.json"))
        result["flight"]["track"] = [[0, 100, 500, 100], [60, 900, 500, 100]]
        self.write("forged.json", json.dumps(result))
        out, _ = self.call("check", "forged.json", code=1)
        self.assertIn("flight not sound: 2 points", out)
        self.assertIn("collision: the vehicle touches 'wall'", out)
        verdict = json.loads(self.call("check", "forged.json", "--json", code=1)[0])
        self.assertTrue(verdict["check"]["ok"], "the route is as it was")
        self.assertEqual((verdict["flight"]["collisions"], verdict["flight"]["reached"]),
                         (1, False))

        alone = self.write("alone.yaml", PIPELINE + "  - fly: route\n")
        self.call("run", alone, "--out", "alone.json", code=1)
        out, _ = self.call("check", "alone.json", code=1)
        self.assertIn("1 collision, did not reach the goal", out)
        self.assertIn("collision: the vehicle touches 'post'", out)

    def test_why_a_flight_ended_early_is_printed(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "false"))
        late = self.write("late.yaml", PIPELINE + "  - fly: route\n    max_time_s: 3\n")
        out, _ = self.call("run", late, code=1)
        self.assertIn("flight: did not reach the goal after 3 s,", out)
        self.assertIn("; the flight: timed out after 3 s (max_time_s) at (", out)
        replans = self.write("replans.yaml", PIPELINE + "  - fly: route\n    replan:\n"
                             "      plan: astar\n      within_iterations: 1\n"
                             "      with: {cell_m: [50, 50, 50]}\n")
        out, _ = self.call("run", replans, code=1)
        self.assertRegex(out, r"\n +\d+ s  replan by \S+: timed_out: the budget was used up")

    def test_check_says_where_events_count(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "false") +
                   "events:\n  - {at_s: 20, remove: post}\n")
        self.call("run", self.write("alone.yaml", PIPELINE + "  - fly: route\n"), "--out", "r.json")
        out, _ = self.call("check", "r.json")
        self.assertIn("0 collisions, reached the goal\n  each event was applied at", out)

    # view

    def view(self, *arguments, code=0):
        """As call; there is no Chromium."""
        done = subprocess.run([PROGRAM, "view", *arguments], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, cwd=self.folder, timeout=250,
                              env={**os.environ, "ALTIPLAN_CHROMIUM": "/nowhere"})
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done.stdout, done.stderr

    def scene(self, page):
        found = re.findall(r'<script id="scene" type="application/json">(.*?)</script>',
                           self.read(page), re.DOTALL)
        self.assertEqual(len(found), 1)
        return json.loads(found[0])

    def test_view_makes_a_page(self):
        self.call("run", self.pipeline, "--out", "one.json", "--trace", "trace.jsonl")
        self.call("run", self.pipeline, "--out", "two.json", "--seed", "5", "--set",
                  "steps.0.with.weight_g=0.9")
        self.write("page.html", "before")
        out, err = self.view("one.json", "two.json", "-o", "page.html")
        self.assertRegex(out, r"^page\.html: 0\.\d\d MB: 2 routes, 0 flights, 2 solids\n$")
        self.assertEqual(err, "")
        scene = self.scene("page.html")
        stored = [json.loads(self.read(name)) for name in ("one.json", "two.json")]
        self.assertEqual([result["route"] for result in scene["results"]],
                         [result["route"] for result in stored], "to the last bit")
        self.assertEqual([result["name"] for result in scene["results"]], ["one", "two"])
        self.assertEqual(scene["results"][0]["trace"]["events"],
                         len(self.read("trace.jsonl").splitlines()) - 1)
        self.assertIsNone(scene["results"][1]["trace"])
        self.assertEqual(scene["notes"], [])
        self.assertEqual(sorted(os.listdir(self.folder)), sorted([
            "scenario.yaml", "pipeline.yaml", "sealed.yaml", "one.json", "two.json", "trace.jsonl",
            "page.html"]))

    def test_view_of_no_route_and_of_what_has_changed(self):
        self.call("run", self.pipeline, "--out", "result.json", "--scenario", self.sealed,
                  "--trace", "trace.jsonl", code=1)
        self.view("result.json", "-o", "page.html")
        scene = self.scene("page.html")
        self.assertEqual(len(scene["solids"]), 6)
        self.assertIsNone(scene["results"][0]["route"])
        self.assertEqual(scene["results"][0]["status"], "no_route")
        self.assertTrue(scene["results"][0]["message"])
        whole = self.read("trace.jsonl")
        self.write("trace.jsonl", whole[:len(whole) // 2])
        _, err = self.view("result.json", "-o", "page.html")
        self.assertRegex(err, r"^altiplan: warning: trace\.jsonl:\d+: this is not an event of a "
                              r"search: it is shown up to here\n$")
        os.remove(self.path("trace.jsonl"))
        self.write("sealed.yaml", SEALED + "# changed\n")
        _, err = self.view("result.json", "-o", "page.html")
        self.assertEqual(err, f"altiplan: warning: {self.sealed} is not the file that result.json "
                              "was made from\naltiplan: warning: trace.jsonl: there is no such "
                              "file: the search is not shown\n")
        os.remove(self.sealed)
        self.view("result.json", "-o", "page.html", code=3)

    def test_view_refuses_what_it_cannot_show(self):
        self.call("run", self.pipeline, "--out", "one.json")
        self.call("run", self.pipeline, "--out", "other.json", "--scenario", self.sealed, code=1)
        self.write("page.html", "before")
        before = sorted(os.listdir(self.folder))
        _, err = self.view("one.json", "other.json", "-o", "page.html", code=3)
        self.assertEqual(err, f"altiplan: 'one.json' and 'other.json' are of different worlds: "
                              f"{self.path('scenario.yaml')}, and {self.sealed}\n")
        for wrong in ("nowhere.json", ".", "", "scenario.yaml"):
            out, err = self.view("one.json", wrong, "-o", "page.html", code=3)
            self.assertEqual((out, err.count("\n")), ("", 1), err)
        result = json.loads(self.read("one.json"))
        keys = set(result) - {"version", "plugins", "budget_hit", "reason", "setup_time_s", "route_lonlat"}
        for key in keys:
            damaged = self.write("damaged.json", json.dumps(
                {name: value for name, value in result.items() if name != key}))
            _, err = self.view("damaged.json", "-o", "page.html", code=3)
            self.assertRegex(err, r"^altiplan: damaged\.json: expected a result of ", key)
            for value in (7, "text", [1], {"a": 1}, [[1, 2]], [{}]):
                self.write("damaged.json", json.dumps({**result, key: value}))
                done = subprocess.run([PROGRAM, "view", "damaged.json", "--svg", "damaged.svg"],
                                      capture_output=True, text=True, cwd=self.folder, timeout=60)
                self.assertIn(done.returncode, (0, 3), (key, value, done.stderr))
        os.remove(damaged)
        for option in ("-o", "--png", "--svg"):
            for place in ("missing/page.html", self.folder, ""):
                _, err = self.view("one.json", option, place, code=3)
                self.assertIn(option, err)
        self.view("one.json", code=2)
        self.view("-o", "page.html", code=2)
        self.assertEqual(self.read("page.html"), "before")
        self.assertEqual([name for name in sorted(os.listdir(self.folder))
                          if name != "damaged.svg"], before)

    def test_pictures_without_chromium(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "false"))
        flies = self.write("flies.yaml", PIPELINE + "  - fly: apf\n"
                           "    with: {influence_m: 200}\n")
        self.call("run", flies, "--out", "<result> & co.json")
        out, err = self.view("<result> & co.json", "--png", "picture.png", "--svg", "other.svg")
        self.assertEqual(err, "altiplan: warning: no Chromium was found (ALTIPLAN_CHROMIUM may name "
                              "one): the picture is an SVG from above, picture.svg\n")
        self.assertRegex(out, r"^other\.svg: .*\npicture\.svg: 0\.\d\d MB: 1 route, 1 flight, ")
        self.assertFalse(os.path.exists(self.path("picture.png")))
        self.assertEqual(self.read("picture.svg"), self.read("other.svg"))
        svg = xml.etree.ElementTree.fromstring(self.read("picture.svg"))
        texts = [element.text for element in svg.iter("{http://www.w3.org/2000/svg}text")]
        for text in ("scenario", "Start", "Goal", "N", "<result> & co: solved",
                     "Obstacle, met in flight", "200 m"):
            self.assertIn(text, texts)
        self.assertNotIn("href=\"http", self.read("picture.svg"))

    def test_numbers_of_the_call_are_finite(self):
        self.call("run", self.pipeline, "--out", "result.json")
        tune = ("tune", self.pipeline, "--over", "a=0..1", "--metric", "length_m", "--out", "folder")
        calls = {("run", self.pipeline): ["--patience"],
                 ("view", "result.json", "--png", "picture.png"): ["--cut"],
                 ("export", "result.json", "--to", "csv"): ["--home-altitude"],
                 ("compare", "a.db", "b.db"): ["--tolerance"],
                 ("slurm", "study.yaml"): ["--chunk-minutes"],
                 ("check-plugin", "nowhere.so"): ["--time-limit", "--memory-limit"],
                 tune: ["--penalty", "--wall-s", "--memory-mb"]}
        for call, options in calls.items():
            for option in options:
                for number in ("nan", "inf", "-inf", "1e999", "-nan"):
                    _, err = self.call(*call, f"{option}={number}", code=2)
                    self.assertRegex(err, f"{option}: expected a number from .*, found '{number}'")

    # plugins, describe, schema

    def test_plugins(self):
        out, _ = self.call("plugins", "--strict")
        self.assertIn("planner astar", out)
        listed = json.loads(self.call("plugins", "--json")[0])
        self.assertGreaterEqual(len(listed["libraries"]), 10)
        out, _ = self.call("plugins", "--plugin-path", BROKEN)
        self.assertIn("refused: " + os.path.join(BROKEN, "undefined_symbol.so"), out)
        self.call("plugins", "--strict", "--plugin-path", BROKEN, code=4)

    def test_describe_and_schema(self):
        out, _ = self.call("describe", "astar")
        self.assertIn("planner astar", out)
        self.assertIn("cell_m: 3 numbers [m]", out)
        described = json.loads(self.call("describe", "cylinder", "--json")[0])
        self.assertEqual(described["kind"], "environment")
        _, err = self.call("describe", "asta", code=3)
        self.assertIn("did you mean 'astar'", err)
        schema = json.loads(self.call("schema")[0])
        self.assertEqual(schema["$schema"], "http://json-schema.org/draft-07/schema#")
        self.assertIn("planner_astar", schema["definitions"])
        self.assertNotIn("planner_alpha", schema["definitions"])
        schema = json.loads(self.call("schema", "--plugin-path", BROKEN)[0])
        self.assertIn("planner_alpha", schema["definitions"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
