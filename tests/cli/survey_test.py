# SPDX-License-Identifier: Apache-2.0
"""Surveys of QGroundControl made again: survey_test.py PROGRAM DATA. Of saved plans, and of the cases of its rule, on
both of its planes, commands are equal and waypoints within 0.1 m; what was changed is found."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", sys.argv[2])) / "survey"


def check(file):
    done = subprocess.run([sys.argv[1], "check", str(file), "--survey", "--json"], capture_output=True, text=True,
                          check=False)
    return done.returncode, json.loads(done.stdout) if done.stdout else done.stderr


def check_json(plan):
    with tempfile.NamedTemporaryFile("w", suffix=".plan") as file:
        json.dump(plan, file)
        file.flush()
        return check(file.name)


def plan_of(case, made):
    """The plan that the ground station saves of a case."""
    given = case["input"]
    points, place, items = iter(made["points"]), -1, []
    for number, command in enumerate(made["commands"]):
        params = [0, 0, 1, 0, None, None, None]
        if command == 16:
            place += 1
            params = [4 if given["HoverAndCapture"] else 0, 0, 0, None, *next(points), 50]
        elif command == 206:
            begins = made["kinds"][place] == "E" or place == 0
            params = [given["AdjustedFootprintFrontal"] if begins else 0, 0, 1, 0, 0, 0, 0]
        items.append({"type": "SimpleItem", "command": command, "params": params, "frame": 3, "autoContinue": True,
                      "doJumpId": number + 1})
    camera = {"version": 2, "CameraName": "Manual (no camera specs)", "DistanceMode": 1, "DistanceToSurface": 50,
              "AdjustedFootprintSide": given["AdjustedFootprintSide"],
              "AdjustedFootprintFrontal": given["AdjustedFootprintFrontal"]}
    style = {"version": 2, "Items": items, "CameraCalc": camera}
    style.update({key: given[key] for key in ("TurnAroundDistance", "CameraTriggerInTurnAround", "HoverAndCapture",
                                              "Refly90Degrees")})
    item = {"type": "ComplexItem", "complexItemType": "survey", "version": 5, "TransectStyleComplexItem": style}
    item.update({key: given[key] for key in ("polygon", "angle", "entryLocation", "flyAlternateTransects")})
    return {"fileType": "Plan", "groundStation": "QGroundControl", "version": 1, "mission": {"items": [item]}}


@unittest.skipUnless(DATA.is_dir(), "no test data: set ALTIPLAN_TEST_DATA")
class Surveys(unittest.TestCase):
    def setUp(self):
        self.cases = json.loads((DATA / "qgc_rule_cases.json").read_text())

    def test_saved_plans(self):
        plans = sorted((DATA / "plans").glob("*.plan"))
        self.assertEqual(len(plans), 3)
        for plan in plans:
            with self.subTest(plan.name):
                code, answer = check(plan)
                self.assertEqual(code, 0)
                self.assertLess(answer["items_differ_m"], 1e-3)
                self.assertGreater(answer["coverage"], 0.5)

    def test_cases(self):
        self.assertEqual(len(self.cases), 36)
        for case in self.cases:
            for plane in ("sphere", "ellipsoid"):
                with self.subTest(case=case["id"], plane=plane):
                    code, answer = check_json(plan_of(case, case[plane]))
                    self.assertEqual(code, 0, answer)
                    self.assertLess(answer["items_differ_m"], 0.1)
                    self.assertLessEqual(answer["coverage"], 1)

    def test_without_a_distance_of_lines(self):
        for distance in (0, None):
            plan = plan_of(self.cases[0], self.cases[0]["sphere"])
            camera = plan["mission"]["items"][0]["TransectStyleComplexItem"]["CameraCalc"]
            camera["AdjustedFootprintSide"] = distance
            if distance is None:
                del camera["AdjustedFootprintSide"]
            code, said = check_json(plan)
            self.assertEqual(code, 3)
            self.assertIn("AdjustedFootprintSide", said)

    def test_what_was_changed_is_found(self):
        plan = plan_of(self.cases[0], self.cases[0]["sphere"])
        items = plan["mission"]["items"][0]["TransectStyleComplexItem"]["Items"]
        items[2]["params"][4] += 1e-5  # 1.1 m
        code, answer = check_json(plan)
        self.assertEqual(code, 1)
        self.assertAlmostEqual(answer["items_differ_m"], 1.11, 1)
        items[1]["params"][0] = 11
        code, answer = check_json(plan)
        self.assertEqual(code, 1)
        self.assertIsNone(answer["items_differ_m"])
        self.assertIn("trigger", answer["surveys"][0]["problem"])
        del items[3]
        self.assertEqual(check_json(plan)[0], 1)

    def test_errors_name_the_key(self):
        plan = plan_of(self.cases[0], self.cases[0]["sphere"])
        survey = plan["mission"]["items"][0]
        survey["entryLocation"] = 7
        code, answer = check_json(plan)
        self.assertNotIn(code, (0, 1))
        self.assertIn("mission.items.0.entryLocation", answer)
        plan["mission"]["items"] = []
        self.assertIn("expected a survey", check_json(plan)[1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
