# SPDX-License-Identifier: Apache-2.0
"""commands_test.py PROGRAM BROKEN: the command line, as a user calls it.

BROKEN is the folder of the unusable libraries."""
import glob
import json
import os
import re
import shutil
import signal
import subprocess
import time

import case
from case import BROKEN, CliCase, PIPELINE, PROGRAM, SCENARIO, by_day

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
BAD_FILES = os.path.join(ROOT, "tests", "bad_files")


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


class Cli(CliCase):
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
            for command in (("plugins",), ("describe", "astar"), ("--help",), ("run", self.pipeline)):
                _, err = self.call(*command, code=3, stdout=full)
                self.assertEqual(err, "altiplan: cannot write to stdout\n")

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
        self.assertIn("no library provides the constraint 'gamma'", err)
        # alpha always reports that it failed
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

    def test_table(self):
        out, _ = self.call("run", self.pipeline)
        head, row = out.splitlines()[1:3]
        self.assertLessEqual(max(len(head), len(row)), 110)
        self.assertEqual(head.split()[:7], ["step", "plugin", "status", "length_km", "points",
                                            "turn_d", "radius_m"])
        metrics = self.result(self.pipeline)["metrics"]
        self.assertEqual(row.split()[6], f"{metrics['min_radius_m']:.1f}")

    def test_a_budget_that_ended_a_step_is_named(self):
        steps = (PIPELINE.split("  - plan")[0] + "  - plan: rrt_star\n"
                 "    with: {max_iterations: 1000000000}\n")
        ended = self.write("ended.yaml", steps + "    within_iterations: 3000\n")
        out, _ = self.call("run", ended)
        self.assertIn("\n  the budget ended 'rrt_star': a larger one may give a better route\n", out)
        ended = self.write("ended.yaml", steps + "    within_s: 0.5\n")
        out, _ = self.call("run", ended)
        self.assertIn("\n  the budget of 0.5 s ended 'rrt_star': more time may give a better route\n",
                      out)
        self.assertNotIn("the budget", self.call("run", self.pipeline)[0])

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
        for wrong in ("steps.0.with.weight=1", "steps.2.plan=astar", "steps.0.with.cell_m=text",
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
            # The trace has a temporary name until the run ends.
            while not any(os.path.getsize(file) >= 10000 for file in glob.glob(trace + ".*")):
                self.assertIsNone(run.poll(), "ended by itself")
                time.sleep(0.01)
            run.send_signal(signal.SIGINT)
            self.assertEqual(run.wait(timeout=600), 130)
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

    def test_what_a_planner_cannot_minimise_is_refused_before_the_run(self):
        # Of an objective that needs the world, validate knows with --build alone what it depends on.
        objective = "objective: {weighted: {of: [length: {}, curvature: {}]}}\n"
        bad = self.write("bad.yaml", PIPELINE.replace("steps:", objective + "steps:"))
        for command in (["validate"], ["validate", "--build"], ["run"]):
            out, err = self.call(*command, bad, code=3)
            self.assertEqual(out, "")
            self.assertRegex(err, r"^%s:6:\d+: steps\.0\.plan: the planner 'astar' minimises costs of legs"
                             % re.escape(bad))
        study = self.write("study.yaml", "altiplan: 1\nscenarios: [{file: scenario.yaml}]\n"
                           "pipelines: [{id: good, file: pipeline.yaml}, {id: bad, file: bad.yaml}]\nrepetitions: 2\n")
        for command in (["validate"], ["study", "--out", self.path("store")]):
            out, err = self.call(*command, study, code=3)
            self.assertEqual(out, "")
            self.assertEqual(err.count("minimises costs of legs"), 1, err)
            self.assertIn("bad.yaml:6:", err)
        self.assertFalse(os.path.exists(self.path("store")))

    def test_bad_files_are_refused_by_validate_and_run(self):
        sample = bad_files()[::10]
        self.assertGreaterEqual(len(sample), 40)
        self.write("result.json", "before")
        for row, file, before, after, problems in by_day(sample, 4):
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

    def test_a_mission_in_place_of_a_pipeline_is_told_what_takes_it(self):
        self.write("m.plan", '{"fileType": "Plan", "mission": {"items": [{"params": [null]}]}}')
        for command in (["run"], ["validate"], ["explain"]):
            _, error = self.call(*command, self.path("m.plan"), code=3)
            self.assertIn("m.plan: is a mission, expected a YAML file: `altiplan check` judges", error)

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

    def test_explain_prints_the_notes_before_a_volume_that_is_refused(self):
        self.write("hill.asc", "ncols 3\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 100\n"
                               "1 2 3\n4 5 6\n")
        self.write("scenario.yaml", """altiplan: 1
environment:
  - terrain: {file: hill.asc, crs: "EPSG:32632"}
start: {at_m: [10, 10, 100]}
goal: {at_m: [190, 90, 100]}
""")
        out, err = self.call("explain", self.pipeline, code=3)
        self.assertIn("no layer bounds the volume from below on z", err)
        self.assertIn("\nterrain: 3 x 2 posts of 100.0 x 100.0 m", out)
        self.assertIn("\nterrain: x 0 to 200 m, y 0 to 100 m; longitude 4.", out)
        self.call("explain", self.pipeline, "--json", code=3)

    def test_a_layer_beside_the_volume_is_named_with_both_ranges(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "true").replace(
            "at_m: [700, 500], radius", "at_m: [7000, 500], radius"))
        _, err = self.call("run", self.pipeline)
        self.assertIn("'post' (cylinder) at x 6970 to 7030, y 470 to 530, ", err)
        self.assertIn(" does not touch the volume at x 0 to 1000, y 0 to 1000, z 0 to 200 m: ", err)

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

    def test_the_files_of_the_reference_are_valid(self):
        shutil.copytree(os.path.join(ROOT, "configs"), self.path("configs"))
        with open(os.path.join(ROOT, "docs/reference/files.md")) as stream:
            files = re.findall(r"```yaml\n(altiplan: 1\n.*?)```", stream.read(), re.DOTALL)
        pipeline = next(text for text in files if "\nsteps:" in text)
        written = [self.write("configs/pipelines/of_a_page.yaml", pipeline)]
        for text in files:
            if text != pipeline:
                name = re.search(r"\nscenario: (.*)", pipeline).group(1)
                written.append(self.write("configs/pipelines/" + name, text))
        out, _ = self.call("validate", *written)
        self.assertGreaterEqual(out.count(": valid\n"), 2)

    def test_a_former_option_is_refused_with_the_present_one(self):
        for option in (["--patience", "5"], ["--patience=5"]):
            _, err = self.call("run", self.pipeline, *option, code=2)
            self.assertEqual(err, "altiplan: --patience is now --timeout\n")

    def test_numbers_of_the_call_are_finite(self):
        self.call("run", self.pipeline, "--out", "result.json")
        tune = ("tune", self.pipeline, "--over", "a=0..1", "--metric", "length_m", "--out", "folder")
        calls = {("run", self.pipeline): ["--timeout"],
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
    case.main()
