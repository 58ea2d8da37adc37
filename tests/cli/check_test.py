# SPDX-License-Identifier: Apache-2.0
"""check_test.py PROGRAM BROKEN: `altiplan check`, and what `run` prints of a flight."""
import json
import os
import shutil

import case
from case import CliCase, PIPELINE, SCENARIO


class Check(CliCase):
    def test_check_a_route_from_elsewhere(self):
        around = self.write("route.json", "[[100,500,100],[200,200,100],[600,300,100],"
                            "[900,500,100]]")
        out, _ = self.call("check", "--route", around, "--scenario", "scenario.yaml")
        self.assertTrue(out.startswith("valid: 4 waypoints"), out)
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
        self.assertEqual(err, "altiplan: scenario.yaml:1:1: this is not JSON: expected a result of "
                              "altiplan run\n")
        self.call("check", "--route", around, code=2)
        self.call("check", code=2)

    def test_a_scenario_without_constraints_brings_a_warning(self):
        around = self.write("route.json", "[[100,500,100],[200,200,100],[600,300,100],"
                            "[900,500,100]]")
        note = ("altiplan: warning: the scenario has no constraints: only obstacles, ground, "
                "volume and the vehicle's own limits are checked\n")
        route = ("check", "--route", around, "--scenario", "scenario.yaml")
        self.assertEqual(self.call(*route)[1], note)
        self.assertEqual(self.call("--log-level", "quiet", *route)[1], "")
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "true") +
                   "constraints: [{turn_angle: {max_deg: 5}}]\n")
        out, err = self.call(*route, code=1)
        self.assertIn("turn_angle", out)
        self.assertEqual(err, "")

    def test_check_a_result_without_a_flight(self):
        self.call("run", self.pipeline, "-o", "result.json")
        out, _ = self.call("check", "result.json")
        self.assertTrue(out.startswith("valid"), out)
        self.assertNotIn("flight", out)
        result = json.loads(self.read("result.json"))
        result["route"] = [result["route"][0], result["route"][-1]]
        self.write("forged.json", json.dumps(result))
        out, _ = self.call("check", "forged.json", code=1)
        self.assertTrue(out.startswith("not valid"), out)
        self.write("scenario.yaml", self.read("scenario.yaml") + "# changed\n")
        _, err = self.call("check", "result.json")
        self.assertIn("scenario.yaml has changed since the result was written", err)
        for text in ("{}", "[1", "[]", '{"altiplan": 2}'):
            self.call("check", self.write("wrong.json", text), code=3)

    def test_a_copied_folder_is_judged_by_its_own_files(self):
        os.mkdir(self.path("first"))
        for name in ("scenario.yaml", "pipeline.yaml"):
            shutil.copy(self.path(name), self.path("first"))
        self.call("run", "first/pipeline.yaml", "-o", "first/result.json")
        self.call("check", "first/result.json")
        shutil.copytree(self.path("first"), self.path("second"))
        higher = SCENARIO.replace("KNOWN", "true").replace("[310, 700, 1000]", "[310, 1000, 1000]")
        self.write("second/scenario.yaml", higher.replace("[300, 300, 0]", "[300, 0, 0]"))
        _, err = self.call("check", "first/result.json")
        self.assertEqual(err, "")
        out, err = self.call("check", "second/result.json", code=1)
        self.assertTrue(out.startswith("not valid"), out)
        self.assertEqual(err, f"altiplan: warning: {self.path('second/scenario.yaml')} has changed "
                              "since the result was written\n")
        shutil.rmtree(self.path("second"))
        os.rename(self.path("first"), self.path("third"))
        out, err = self.call("check", "third/result.json")
        self.assertEqual((out[:5], err), ("valid", ""))
        os.mkdir(self.path("alone"))
        shutil.move(self.path("third/result.json"), self.path("alone"))
        self.call("check", "alone/result.json", code=3)
        os.rename(self.path("third"), self.path("first"))
        self.call("check", "alone/result.json")

    def test_check_a_flight_against_the_true_world(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "false"))
        flies = self.write("flies.yaml", PIPELINE + "  - fly: apf\n"
                           "    with: {influence_m: 200}\n")
        self.call("run", flies, "--out", "result.json")
        out, _ = self.call("check", "result.json")
        self.assertIn("\nflight valid: ", out)
        self.assertIn("0 collisions, reached the goal", out)

        result = json.loads(self.read("result.json"))
        result["flight"]["track"] = [[0, 100, 500, 100], [60, 900, 500, 100]]
        self.write("forged.json", json.dumps(result))
        out, _ = self.call("check", "forged.json", code=1)
        self.assertIn("flight not valid: 2 points", out)
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
        self.assertIn("0 collisions, reached the goal\n  each event is applied at", out)


if __name__ == "__main__":
    case.main()
