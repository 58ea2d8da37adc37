# SPDX-License-Identifier: Apache-2.0
"""Missions for `altiplan check PLAN --terrain …`; the tests are called with PROGRAM SOURCES."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY, by_day, by_night  # noqa: E402, F401

PROGRAM, SOURCES = sys.argv[1:3]
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
# Longitude, latitude, metres above sea level: north-east over the ridges.
POINTS = [[-84.38, 36.48, 800], [-84.30, 36.54, 900], [-84.22, 36.60, 800], [-84.20, 36.66, 900]]


def item(point, number):
    """The first leaves its yaw to the autopilot, as waypoints may."""
    lon, lat, height = point
    return {"type": "SimpleItem", "command": 16, "frame": 0, "doJumpId": number, "autoContinue": True,
            "params": [0, 0, 0, None if number == 1 else 0, lat, lon, height]}


def plan_of(points):
    fence = {"version": 2, "circles": [], "polygons": []}
    return {"fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
            "geoFence": fence, "rallyPoints": {"version": 2, "points": []},
            "mission": {"version": 2, "firmwareType": 3, "vehicleType": 2, "cruiseSpeed": 15,
                        "hoverSpeed": 5, "plannedHomePosition": [36.48, -84.38, 400],
                        "items": [item(point, n + 1) for n, point in enumerate(points)]}}


class PlanCase(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def check(self, points, *options, code):
        (self.folder / "mission.plan").write_text(json.dumps(plan_of(points)))
        return self.call("mission.plan", "--terrain", TERRAIN, *options, code=code)

    def call(self, *arguments, code):
        """`code` None: that of either verdict."""
        run = subprocess.run([PROGRAM, "check", *arguments], cwd=self.folder, capture_output=True,
                             text=True, timeout=600)
        self.assertIn(run.returncode, (0, 1) if code is None else (code,), run.stdout + run.stderr)
        return run.stdout, run.stderr

    def write(self, items, **keys):
        plan = plan_of([])
        plan["mission"].update(keys, items=items)
        (self.folder / "mission.plan").write_text(json.dumps(plan))

    def zones(self, name, ring, ceiling, datum="AMSL", schedule=None, floor=None):
        """A zone of ED-269 from the ground up, or from a floor above sea level."""
        times = {"startDateTime": "2022-01-01T00:00:00Z", "endDateTime": "2030-01-01T00:00:00Z",
                 "permanent": "NO"}
        if schedule:
            times["schedule"] = [dict(schedule, day=["ANY"])]
        feature = {"identifier": "Z", "country": "USA", "name": "Z", "type": "COMMON",
                   "restriction": "PROHIBITED", "reason": ["OTHER"], "zoneAuthority": [],
                   "applicability": [times], "geometry": [{
                       "uomDimensions": "M", "lowerLimit": floor or 0, "lowerVerticalReference": "AGL" if floor is None else "AMSL",
                       "upperLimit": ceiling, "upperVerticalReference": datum,
                       "horizontalProjection": {"type": "Polygon", "coordinates": [ring]}}]}
        (self.folder / name).write_text(json.dumps({"title": "test", "features": [feature]}))

    def around(self, lon, lat, by=0.002):
        return [[lon - by, lat - by], [lon + by, lat - by], [lon + by, lat + by],
                [lon - by, lat + by], [lon - by, lat - by]]
