# SPDX-License-Identifier: Apache-2.0
"""check_plan_test.py PROGRAM SOURCES: `altiplan check PLAN --terrain …`, without a scenario."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
# Longitude, latitude, metres above sea level: north-east over the ridges.
POINTS = [[-84.38, 36.48, 800], [-84.30, 36.54, 900], [-84.22, 36.60, 800], [-84.20, 36.66, 900]]


def item(point, number):
    lon, lat, height = point
    return {"type": "SimpleItem", "command": 16, "frame": 0, "doJumpId": number, "autoContinue": True,
            "params": [0, 0, 0, None, lat, lon, height]}


def plan_of(points):
    fence = {"version": 2, "circles": [], "polygons": []}
    return {"fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
            "geoFence": fence, "rallyPoints": {"version": 2, "points": []},
            "mission": {"version": 2, "firmwareType": 3, "vehicleType": 2, "cruiseSpeed": 15,
                        "hoverSpeed": 5, "plannedHomePosition": [36.48, -84.38, 400],
                        "items": [item(point, n + 1) for n, point in enumerate(points)]}}


class CheckPlan(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check(self, points, *options, code):
        (self.folder / "mission.plan").write_text(json.dumps(plan_of(points)))
        return self.call("mission.plan", "--terrain", TERRAIN, *options, code=code)

    def call(self, *arguments, code):
        run = subprocess.run([PROGRAM, "check", *arguments], cwd=self.folder, capture_output=True,
                             text=True, timeout=60)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def test_a_plan_high_above_the_ground_passes(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        out, _ = self.check(high, "--min-agl", "100", code=0)
        self.assertRegex(out, r"^pass: mission.plan, 4 waypoints, [0-9.]+ km, at least [0-9.]+ m")

    def test_what_cures_a_plan_makes_it_pass(self):
        low = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        low[2][2] = 500
        for bounds in (["--min-agl", "150"], ["--min-agl", "150", "--max-agl", "1300"]):
            points = [list(point) for point in low]
            out, _ = self.check(points, *bounds, code=1)
            self.assertIn("fail: mission.plan", out)
            self.assertIn("mission.items.2 (-84.220000, 36.600000)", out)
            cures = re.findall(r"cure: (raise|lower) mission\.items\.(\d) by ([0-9.]+) m", out)
            self.assertTrue(cures, out)
            word, number, by = cures[0]
            self.assertEqual((word, number), ("raise", "2"))
            points[2][2] += float(by) - 0.2
            self.check(points, *bounds, code=1)  # it is the least
            points[2][2] += 0.2
            self.check(points, *bounds, code=0)

    def test_zones_count_at_their_hours(self):
        ring = [[-84.31, 36.52], [-84.25, 36.52], [-84.25, 36.56], [-84.31, 36.56], [-84.31, 36.52]]
        zone = {"title": "test", "features": [{
            "identifier": "Z1", "country": "USA", "name": "Z1", "type": "COMMON",
            "restriction": "PROHIBITED", "reason": ["OTHER"], "zoneAuthority": [],
            "applicability": [{"startDateTime": "2022-01-01T00:00:00Z",
                               "endDateTime": "2030-01-01T00:00:00Z", "permanent": "NO",
                               "schedule": [{"day": ["SAT"], "startTime": "17:00:00Z",
                                             "endTime": "23:00:00Z"}]}],
            "geometry": [{"uomDimensions": "M", "lowerLimit": 0, "lowerVerticalReference": "AGL",
                          "upperLimit": 3000, "upperVerticalReference": "AMSL",
                          "horizontalProjection": {"type": "Polygon", "coordinates": [ring]}}]}]}
        (self.folder / "zones.json").write_text(json.dumps(zone))
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        zones = ("--airspace", "zones.json", "--start-time")
        out, _ = self.check(high, *zones, "2022-06-18T18:00:00Z", code=1)  # a Saturday
        self.assertIn("'zones.json'", out)
        self.check(high, *zones, "2022-06-18T12:00:00Z", code=0)

    def test_json(self):
        low = [[lon, lat, 300] for lon, lat, _ in POINTS]
        out, _ = self.check(low, "--min-agl", "50", "--json", code=1)
        found = json.loads(out)
        self.assertFalse(found["passed"])
        self.assertEqual(found["plan"], "mission.plan")
        for violation in found["violations"]:
            self.assertTrue(violation["items"][0].startswith("mission.items."), violation)
            self.assertEqual(len(violation["items"]), len(violation["lonlat"]))

    def test_bad_input(self):
        _, err = self.call("missing.plan", "--terrain", TERRAIN, code=3)
        self.assertIn("missing.plan", err)
        (self.folder / "mission.plan").write_text(json.dumps(plan_of(POINTS)))
        _, err = self.call("mission.plan", "--terrain", "missing.tif", code=3)
        self.assertIn("missing.tif", err)
        _, err = self.call("mission.plan", "--airspace", "zones.json", code=2)
        self.assertIn("--terrain", err)
        self.call("--terrain", TERRAIN, code=2)
        outside = [[lon + 40, lat, 1500] for lon, lat, _ in POINTS]
        out, _ = self.check(outside, code=1)
        self.assertIn("no ground", out)
        (self.folder / "mission.plan").write_text("{}")
        self.call("mission.plan", "--terrain", TERRAIN, code=3)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
