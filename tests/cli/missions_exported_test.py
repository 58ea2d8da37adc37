# SPDX-License-Identifier: Apache-2.0
"""missions_exported_test.py PROGRAM SOURCES: `altiplan export` and `upload` of a mission."""
import csv
import json
import re
import subprocess
import sys
import unittest

from plan_case import POINTS, PROGRAM, TERRAIN, PlanCase, item, plan_of


class Missions(PlanCase):
    def setUp(self):
        super().setUp()
        plan = plan_of([[lon, lat, height + 300] for lon, lat, height in POINTS])
        plan["mission"]["items"][2]["params"][1] = 7  # an acceptance radius
        plan["mission"]["items"].insert(2, {
            "type": "SimpleItem", "command": 178, "frame": 2, "doJumpId": 9, "autoContinue": True,
            "params": [1, 6, -1, 0, 0, 0, 0]})
        plan["geoFence"]["circles"] = [
            {"circle": {"center": [36.58, -84.29], "radius": 20000}, "inclusion": True, "version": 1}]
        plan["rallyPoints"]["points"] = [[36.49, -84.37, 200]]
        self.plan = plan
        (self.folder / "mission.plan").write_text(json.dumps(plan))

    def altiplan(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=600, check=False)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def test_a_plan_keeps_its_commands_fence_and_rally_points(self):
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "other.plan")
        other = json.loads((self.folder / "other.plan").read_text())
        for ours, theirs in zip(other["mission"]["items"], self.plan["mission"]["items"], strict=True):
            self.assertEqual(ours["command"], theirs["command"])
            self.assertEqual(ours["frame"], theirs["frame"])
            self.assertEqual(ours["params"], theirs["params"])
        for key in ("firmwareType", "vehicleType"):
            self.assertEqual(other["mission"][key], self.plan["mission"][key])
        self.assertEqual(other["geoFence"]["circles"][0]["circle"],
                         self.plan["geoFence"]["circles"][0]["circle"])
        self.assertEqual(other["rallyPoints"]["points"], self.plan["rallyPoints"]["points"])

    def test_other_formats(self):
        _, err = self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "m.waypoints")
        self.assertIn("fence and rally points are left out", err)
        lines = (self.folder / "m.waypoints").read_text().splitlines()
        self.assertEqual([line.split("\t")[3] for line in lines[1:]],
                         ["16", "16", "16", "178", "16", "16"])  # home first
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "m.geojson")
        features = json.loads((self.folder / "m.geojson").read_text())["features"]
        line = next(f for f in features if f["geometry"]["type"] == "LineString")
        for here, (lon, lat, height) in zip(line["geometry"]["coordinates"], POINTS, strict=True):
            self.assertAlmostEqual(here[0], lon, 7)
            self.assertAlmostEqual(here[1], lat, 7)
            self.assertAlmostEqual(here[2], height + 300, 2)

    def test_what_does_not_pass_is_not_written(self):
        low = [item([lon, lat, height - 300], n + 1) for n, (lon, lat, height) in enumerate(POINTS)]
        self.plan["mission"]["items"] = low
        (self.folder / "mission.plan").write_text(json.dumps(self.plan))
        for call in (["export", "mission.plan", "-o", "other.plan"],
                     ["upload", "mission.plan", "--to", "udp:127.0.0.1:1"]):
            out, err = self.altiplan(*call, "--terrain", TERRAIN, "--min-agl", "50", code=1)
            self.assertIn("fail", out + err)
        self.assertFalse((self.folder / "other.plan").exists())

    def test_one_time(self):
        """The mission's time is the gate's, in whatever form it is asked for."""
        self.plan["mission"]["items"][0]["command"] = 22
        (self.folder / "mission.plan").write_text(json.dumps(self.plan))
        out, _ = self.altiplan("check", "mission.plan", "--terrain", TERRAIN, "--json")
        answer = json.loads(out)
        words = "{:.1f} to {:.1f} min".format(*(seconds / 60 for seconds in answer["time_s"]))
        self.assertIsNone(answer["metrics"]["duration_s"])  # along drawn lines
        out, _ = self.altiplan("check", "mission.plan", "--terrain", TERRAIN, "--certificate", "c.html")
        self.assertIn(words, out)
        self.assertIn(words, (self.folder / "c.html").read_text())
        self.assertIn(words, self.altiplan("info", "mission.plan", "--terrain", TERRAIN)[0])
        self.assertIn("as if over level ground", self.altiplan("info", "mission.plan")[0])
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "m.csv")
        rows = list(csv.DictReader((self.folder / "m.csv").read_text().splitlines()))
        self.assertEqual(len(rows), len(POINTS))
        for row, earlier in zip(rows[1:], rows):
            self.assertLess(float(earlier["time_s"]), float(row["time_s"]))
        self.assertAlmostEqual(float(rows[-1]["time_s"]), answer["time_s"][0], 2)
        self.assertAlmostEqual(float(rows[-1]["latest_s"]), answer["time_s"][1], 2)
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "m.geojson")
        self.assertNotIn("times_s", (self.folder / "m.geojson").read_text())

    def test_view(self):
        """The page shows the flown line with the verdict of `check`, whose violations are on it."""
        self.plan["mission"]["items"][0]["command"] = 22
        (self.folder / "mission.plan").write_text(json.dumps(self.plan))
        for code, limits in ((0, []), (1, ["--min-agl", "400"])):
            verdict, _ = self.altiplan("check", "mission.plan", "--terrain", TERRAIN, *limits, code=code)
            self.altiplan("view", "mission.plan", "--terrain", TERRAIN, *limits, "-o", "page.html",
                          "--svg", "top.svg")
            page = (self.folder / "page.html").read_text()
            scene = json.loads(re.search(r'<script id="scene" type="application/json">(.*?)</script>',
                                         page, re.DOTALL)[1])
            self.assertEqual(scene["title"], verdict.splitlines()[0])
            result, = scene["results"]
            self.assertEqual(result["status"], "rejected" if code else "solved")
            self.assertAlmostEqual(result["route"][1][2] - result["route"][0][2],
                                   POINTS[0][2] + 300 - 400, 0)  # the climb from home
            self.assertEqual(bool(result["check"]["violations"]), bool(code))
            for violation in result["check"]["violations"]:
                self.assertIn(violation["message"], verdict)
                self.assertLess(violation["at"], len(result["route"]))
        self.altiplan("view", "mission.plan", "-o", "page.html", code=2)
        self.altiplan("view", "mission.plan", "--terrain", TERRAIN, "--mp4", "film.mp4", code=2)
        _, err = self.altiplan("edit", "mission.plan", code=2)
        self.assertIn("add --terrain DEM", err)

    def test_options(self):
        _, err = self.altiplan("export", "mission.plan", "-o", "other.plan", code=2)
        self.assertIn("mission.plan is a mission: add --terrain DEM", err)
        _, err = self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "--land", "-o", "other.plan",
                               code=2)
        self.assertIn("which has its own items", err)


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
