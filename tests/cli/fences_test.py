# SPDX-License-Identifier: Apache-2.0
"""fences_test.py PROGRAM SOURCES: `altiplan check` of a mission's own fence and rally points.

The reported missions are files of ALTIPLAN_TEST_DATA (default SOURCES/../shared/data)."""
import json
import os
import pathlib
import subprocess
import sys
import unittest
import xml.etree.ElementTree

from plan_case import POINTS, PROGRAM, SOURCES, TERRAIN, PlanCase, plan_of

REPORTED = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", f"{SOURCES}/../shared/data"),
                        "reports/04_two_inclusion_fences")
HIGH = [[lon, lat, 1500] for lon, lat, _ in POINTS]
ABOVE_HOME = HIGH[0][2] - 400


def rectangle(low, high):
    """Latitude first, as plans have it."""
    return [[low[1], low[0]], [low[1], high[0]], [high[1], high[0]], [high[1], low[0]]]


WEST = rectangle([-84.45, 36.4], [-84.25, 36.7])
EAST = rectangle([-84.35, 36.4], [-84.1, 36.7])

COPTER = ("--autopilot", "ardupilot", "--vehicle", "copter")

class Fences(PlanCase):
    def plan(self, points, polygons=(), circles=(), rally=()):
        plan = plan_of(points)
        plan["geoFence"]["polygons"] = [{"version": 1, "inclusion": True, "name": name, "polygon": corners}
                                        for name, corners in polygons]
        plan["geoFence"]["circles"] = [{"version": 1, "inclusion": keeps_in, "name": name,
                                        "circle": {"center": centre, "radius": radius}}
                                       for name, keeps_in, centre, radius in circles]
        plan["rallyPoints"]["points"] = list(rally)
        (self.folder / "mission.plan").write_text(json.dumps(plan))

    def violations(self, file="mission.plan"):
        out, _ = self.call(file, "--terrain", TERRAIN, "--json", code=1)
        return json.loads(out)["violations"]

    @unittest.skipUnless(REPORTED.is_dir(), "no test data: set ALTIPLAN_TEST_DATA")
    def test_reported(self):
        for name, code in (("no_fence", 0), ("in_both", 0), ("only_a", 1), ("a_to_b", 1)):
            with self.subTest(name):
                self.call(str(REPORTED / f"{name}.plan"), "--terrain", str(REPORTED / "dem.tif"), code=code)

    @unittest.skipUnless(REPORTED.is_dir(), "no test data: set ALTIPLAN_TEST_DATA")
    def test_go_keeps_in_all_fences(self):
        def go(start, goal):
            return subprocess.run(
                [PROGRAM, "go", "--terrain", REPORTED / "dem.tif", "--from", start, "--to", goal, "--avoid",
                 REPORTED / "only_a.plan"], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(go("8.519,47.405", "8.521,47.405").returncode, 0)
        run = go("8.512,47.405", "8.528,47.405")
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertIn("inside what 'only_a.plan' blocks", run.stdout + run.stderr)

    def test_all_inclusion_fences_must_hold(self):
        fences = [("west", WEST), ("east", EAST)]
        self.plan(HIGH[1:2] + [[-84.28, 36.55, 1500]], fences)  # in both
        self.call("mission.plan", "--terrain", TERRAIN, code=0)
        for points, zone in ((HIGH[:2], "east"), (HIGH[2:], "west")):
            self.plan(points, fences)
            one, = self.violations()
            self.assertEqual((one["layer"], one["zone"]), ("fence of the mission", zone))
            self.assertIn(f"outside the fence '{zone}'", one["message"])
        self.plan(HIGH[2:], [("west", WEST)], [("yard", True, [36.6, -84.2], 20000)])
        self.assertEqual(self.violations()[0]["zone"], "west")

    def test_fences_of_waypoints_must_all_hold(self):
        corners = [(5001, lat, lon) for ring in (WEST, EAST) for lat, lon in ring]
        for points, code in ((HIGH[:2], 1), ([HIGH[1], [-84.28, 36.55, 1500]], 0)):
            lines = ["QGC WPL 110", "0\t1\t0\t16\t0\t0\t0\t0\t36.48\t-84.38\t400\t1"]
            lines += [f"{n + 1}\t0\t0\t16\t0\t0\t0\t0\t{lat}\t{lon}\t{height}\t1"
                      for n, (lon, lat, height) in enumerate(points)]
            lines += [f"{n + 3}\t0\t0\t{command}\t4\t0\t0\t0\t{lat}\t{lon}\t0\t1"
                      for n, (command, lat, lon) in enumerate(corners)]
            (self.folder / "m.waypoints").write_text("\n".join(lines) + "\n")
            self.call("m.waypoints", "--terrain", TERRAIN, *COPTER, code=code)

    def test_rally_points_are_judged_as_places(self):
        hospital = ("hospital", False, [36.60, -84.22], 500)
        good = [36.48, -84.38, ABOVE_HOME]
        cases = (([36.54, -84.30, -300], "above ground", "terrain", ""),
                 ([36.60, -84.22, ABOVE_HOME], "hospital", "fence of the mission", "hospital"),
                 ([36.48, -84.20, ABOVE_HOME], "east", "fence of the mission", "west"),
                 ([10, 10, ABOVE_HOME], "beside the model", None, ""))
        far = HIGH[:1] + [[-84.37, 36.50, 1500]]
        self.plan(far, [("west", WEST)], [hospital], [good, good])
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, code=0)
        self.assertNotIn("rally", out)
        for point, what, layer, zone in cases:
            with self.subTest(what):
                fences = [] if zone == "hospital" else [("west", WEST)]
                self.plan(far, fences, [hospital], [good, point])
                found = self.violations()
                self.assertEqual({(one["rule"], *one["items"]) for one in found},
                                 {("rally", "rally point 2")})
                if layer:
                    self.assertIn((layer, zone), {(one["layer"], one["zone"]) for one in found})

    def test_rally_points_keep_the_limits_of_height(self):
        for height, options, code in ((200, ("--max-agl", "120"), 1), (100, ("--max-agl", "120"), 0),
                                      (100, ("--min-agl", "110"), 1), (200, ("--max-distance", "120"), 1)):
            lines = ["QGC WPL 110", "0\t1\t0\t16\t0\t0\t0\t0\t36.48\t-84.38\t636\t1"]
            lines += [f"{n + 1}\t0\t10\t16\t0\t0\t0\t0\t36.48\t{lon}\t115\t1"
                      for n, lon in enumerate((-84.38, -84.3799))]
            lines.append(f"3\t0\t10\t5100\t0\t0\t0\t0\t36.48\t-84.379\t{height}\t1")
            (self.folder / "m.waypoints").write_text("\n".join(lines) + "\n")
            self.call("m.waypoints", "--terrain", TERRAIN, *COPTER, *options, "--junit", "j.xml", code=code)
            suite = xml.etree.ElementTree.parse(self.folder / "j.xml").getroot()
            self.assertEqual([case.get("name") for case in suite.iter("testcase") if len(case)],
                             ["rally point 1"] * code)

    def test_a_list_of_rally_points_is_no_mission(self):
        (self.folder / "r.txt").write_text("RALLY 36.48 -84.38 100 40 0 0\n")
        _, err = self.call("r.txt", "--terrain", TERRAIN, code=3)
        self.assertIn("it contains only rally points", err)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
