# SPDX-License-Identifier: Apache-2.0
"""check_plan_outputs_test.py PROGRAM SOURCES: what `altiplan check PLAN --terrain …` writes and says."""
import json
import pathlib
import re
import sys
import unittest
import xml.etree.ElementTree

from plan_case import POINTS, TERRAIN, PlanCase, item, plan_of


class CheckPlanOutputs(PlanCase):
    def test_outputs_are_kept_apart(self):
        self.write([item(point, n + 1) for n, point in enumerate(POINTS)])
        terrain = self.folder / "dem.tif"
        terrain.write_bytes(pathlib.Path(TERRAIN).read_bytes())
        for options in (["--junit", "dem.tif"], ["--certificate", "./mission.plan"],
                        ["--junit", "a.out", "--certificate", "./a.out"]):
            _, err = self.call("mission.plan", "--terrain", "dem.tif", *options, code=3)
            self.assertIn("already read or written", err)
        self.assertEqual(terrain.read_bytes(), pathlib.Path(TERRAIN).read_bytes())

    def test_fix_writes_what_passes(self):
        low = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        low[2][2] = 500
        self.check(low, "--min-agl", "150", "--fix", "fixed.plan", code=1)
        before = json.loads((self.folder / "mission.plan").read_text())
        after = json.loads((self.folder / "fixed.plan").read_text())
        self.call("fixed.plan", "--terrain", TERRAIN, "--min-agl", "150", code=0)
        self.assertGreater(after["mission"]["items"][2]["params"][6], 500)
        for plan in (before, after):
            plan["mission"]["items"][2]["params"][6] = 0
        self.assertEqual(before, after)  # all else is kept

    def test_fix_keeps_the_place_of_what_it_raises(self):
        low = [[lon + 1.23e-9, lat + 1.23e-9, 1500] for lon, lat, _ in POINTS]
        low[2][2] = 500
        self.check(low, "--min-agl", "150", "--fix", "fixed.plan", code=1)
        after = json.loads((self.folder / "fixed.plan").read_text())["mission"]["items"][2]
        self.assertEqual(after["params"][4:6], [low[2][1], low[2][0]])

    def test_fix_of_waypoints_moves_aside(self):
        lines = ["QGC WPL 110", "0\t1\t0\t16\t0\t0\t0\t0\t36.48\t-84.38\t400\t1"]
        for n, (lon, lat, _) in enumerate(POINTS):
            lines.append(f"{n + 1}\t0\t0\t16\t0\t0\t0\t0\t{lat:.7f}\t{lon:.7f}\t1500\t1")
        (self.folder / "m.waypoints").write_text("\n".join(lines) + "\n")
        self.zones("z.json", self.around(*POINTS[2][:2]), 100000)
        options = ("--terrain", TERRAIN, "--airspace", "z.json", "--autopilot", "ardupilot", "--vehicle", "copter")
        out, _ = self.call("m.waypoints", *options, "--fix", "f.waypoints", code=1)
        self.assertRegex(out, r"cure: move item 3 \(waypoint\) by [0-9.]+ m (to the|toward) ")
        self.call("f.waypoints", *options, code=0)
        fixed = (self.folder / "f.waypoints").read_text().splitlines()
        changed = [n for n, line in enumerate(fixed) if line != lines[n]]
        self.assertEqual(changed, [4])

    def test_fix_writes_nothing_that_fails(self):
        ring = self.around(-84.3, 36.55, 1)
        self.zones("z.json", ring, 100000)
        _, err = self.check(POINTS, "--airspace", "z.json", "--fix", "f.plan", code=1)
        self.assertIn("f.plan: not written", err)
        self.assertFalse((self.folder / "f.plan").exists())

    def test_certificate_and_junit(self):
        low = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        low[2][2] = 500
        self.check(low, "--min-agl", "150", "--certificate", "c.html", "--junit", "j.xml", code=1)
        page = (self.folder / "c.html").read_text()
        self.assertEqual(page.count("<svg"), 2)  # map and profile
        for words in ("fail</span>: mission.plan", "SHA-256", "data:image/png", ">4</text>", "raise item 3 (waypoint)", "<svg",
                      "none given: not judged", "lowest above ground", "36.600000 N, 84.220000 W"):
            self.assertIn(words, page)
        suite = xml.etree.ElementTree.parse(self.folder / "j.xml").getroot()
        self.assertEqual(suite.get("tests"), "3")  # three ways
        failed = [case.get("name") for case in suite.iter("testcase") if len(case)]
        self.assertEqual(len(failed), int(suite.get("failures")))
        self.assertIn("item 2 (waypoint) to item 3 (waypoint)", failed)

    def test_what_is_left_out_is_said(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        out, _ = self.check(high, code=0)
        self.assertIn("not judged: airspace (--airspace), limits of height", out)
        self.zones("z.json", self.around(8, 47), 3000)
        out, _ = self.check(high, "--airspace", "z.json", "--min-agl", "10", code=0)
        self.assertNotIn("note: not judged", out)

    def test_no_verdict_leaves_no_old_one(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        self.check(high, "--junit", "j.xml", code=0)
        (self.folder / "mission.plan").write_text("{")
        self.call("mission.plan", "--terrain", TERRAIN, "--junit", "j.xml", code=3)
        suite = xml.etree.ElementTree.parse(self.folder / "j.xml").getroot()
        self.assertEqual(suite.get("errors"), "1")
        self.assertIn("is not valid JSON", next(suite.iter("error")).get("message"))

    def test_json(self):
        low = [[lon, lat, 300] for lon, lat, _ in POINTS]
        out, _ = self.check(low, "--min-agl", "50", "--json", code=1)
        found = json.loads(out)
        self.assertEqual(found["verdict"], "fail")
        self.assertEqual(found["plan"], "mission.plan")
        for violation in found["violations"]:
            self.assertTrue(violation["items"][0].startswith("item "), violation)
            self.assertIn(violation["item"], (1, 2, 3, 4))
            self.assertLess(violation["value"], violation["limit"])
            self.assertEqual(len(violation["lonlat"]), 2)

    def test_bad_input(self):
        _, err = self.call("missing.plan", "--terrain", TERRAIN, code=3)
        self.assertIn("missing.plan", err)
        (self.folder / "mission.plan").write_text(json.dumps(plan_of(POINTS)))
        _, err = self.call("mission.plan", "--terrain", "missing.tif", code=3)
        self.assertIn("missing.tif", err)
        (self.folder / "z.json").write_text("{")
        _, err = self.call("mission.plan", "--terrain", TERRAIN, "--airspace", "z.json", code=3)
        self.assertRegex(err, r"^altiplan: /[^:]*/z.json:1:2: is not valid JSON: .*\n$")
        _, err = self.call("mission.plan", "--airspace", "zones.json", code=2)
        self.assertIn("--terrain", err)
        self.call("--terrain", TERRAIN, code=2)
        outside = [[lon + 40, lat, 1500] for lon, lat, _ in POINTS]
        _, err = self.check(outside, code=3)
        self.assertIn("no position of the mission is within the elevation model: item 1", err)
        swapped = [[lat, lon, 1500] for lon, lat, _ in POINTS]
        _, err = self.check(swapped, code=3)
        self.assertIn("are swapped", err)
        _, err = self.check(POINTS, "--start-time", "2026-05-02", code=2)
        self.assertIn("--start-time: expected a time such as", err)
        _, err = self.call("mission.plan", code=2)
        self.assertIn("is a mission: add --terrain DEM", err)
        _, err = self.check(POINTS, "--min-agl", "120", "--max-agl", "120", code=2)
        self.assertIn("--min-agl: expected less than --max-agl", err)
        twice = json.dumps(plan_of(POINTS)).replace('"command": 16', '"command": 17, "command": 16')
        (self.folder / "mission.plan").write_text(twice)
        _, err = self.call("mission.plan", "--terrain", TERRAIN, code=3)
        self.assertIn('the key "command" is given twice', err)
        (self.folder / "mission.plan").write_text("{}")
        self.call("mission.plan", "--terrain", TERRAIN, code=3)


    def test_a_landing_that_is_flown_to_is_raised_with_the_item_before(self):
        points = [[-84.38, 36.48, 1500], [-84.30, 36.54, 1500], [-84.22, 36.60, 650]]
        landing = dict(item([-84.20, 36.66, 0], 4), command=21)
        self.write([*(item(p, n + 1) for n, p in enumerate(points)), landing])
        options = ("mission.plan", "--terrain", TERRAIN, "--min-agl", "100")
        out, _ = self.call(*options, "--fix", "fixed.plan", code=1)
        self.assertRegex(out, r"item 3 \(waypoint\) to item 4 \(landing\): .*\n.*\n"
                              r" +cure: raise item 3 \(waypoint\) by ")
        self.call("fixed.plan", *options[1:], code=0)
        after = json.loads((self.folder / "fixed.plan").read_text())["mission"]["items"]
        self.assertEqual(after[3], landing)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
