# SPDX-License-Identifier: Apache-2.0
"""fences_test.py PROGRAM SOURCES: `altiplan check` of a mission's own fence.

The reported missions are files of ALTIPLAN_TEST_DATA (default SOURCES/../shared/data)."""
import json
import os
import pathlib
import subprocess
import sys
import unittest

from plan_case import POINTS, PROGRAM, SOURCES, TERRAIN, PlanCase, plan_of

REPORTED = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", f"{SOURCES}/../shared/data"),
                        "reports/04_two_inclusion_fences")
HIGH = [[lon, lat, 1500] for lon, lat, _ in POINTS]


def rectangle(low, high):
    """Latitude first, as plans have it."""
    return [[low[1], low[0]], [low[1], high[0]], [high[1], high[0]], [high[1], low[0]]]


WEST = rectangle([-84.45, 36.4], [-84.25, 36.7])
EAST = rectangle([-84.35, 36.4], [-84.1, 36.7])


class Fences(PlanCase):
    def plan(self, points, polygons=(), circles=()):
        plan = plan_of(points)
        plan["geoFence"]["polygons"] = [{"version": 1, "inclusion": True, "name": name, "polygon": corners}
                                        for name, corners in polygons]
        plan["geoFence"]["circles"] = [{"version": 1, "inclusion": keeps_in, "name": name,
                                        "circle": {"center": centre, "radius": radius}}
                                       for name, keeps_in, centre, radius in circles]
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
                 REPORTED / "only_a.plan"], cwd=self.folder, capture_output=True, text=True, timeout=60)
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
            self.assertIn(f"'{zone}' of 'fence of the mission'", one["message"])
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
            self.call("m.waypoints", "--terrain", TERRAIN, code=code)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
