# SPDX-License-Identifier: Apache-2.0
"""airspace_fence_test.py PROGRAM SOURCES: published airspace as the fence of a plan.

The files of ALTIPLAN_TEST_DATA (default SOURCES/../shared/data): each fence fits into PX4 and ArduPilot, and at
random points nothing that a zone closes is open in it."""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", f"{SOURCES}/../shared/data"), "airspace")
POINTS = 100_000
SCENARIO = """altiplan: 1
frame: {{origin_lonlat: [{west}, {south}]}}
environment:
  - hills: {{base_m: 280, cap_m: 300, count: 1, seed: 4, extent_m: {size}}}
  - zones: {{file: {file}}}
volume: {{min_m: [0, 0, 250], max_m: [{size}, {size}, 12000]}}
vehicle: {{radius_m: 5}}
start: {{at_lonlat: {start}, above_ground_m: 60}}
goal: {{at_lonlat: {goal}, above_ground_m: 60, tolerance_m: 2000}}
"""
PLACES = {  # file: the corner of the world in the south-west, its size, start and goal
    "openair_slovenia.txt": ([13.3, 45.4], 230_000, [14.22, 46.13], [14.23, 46.2]),
    "aixm51-gb.xml": ([-3, 51], 300_000, [-1.9, 52.0], [-1.7, 52.05]),
    "ed269-ch.json": ([6, 45.8], 330_000, [7.3, 46.95], [7.36, 46.99]),
}


def inside(ring, lon, lat):
    """Points in longitude and latitude."""
    result = False
    for (x0, y0), (x1, y1) in zip(ring, ring[1:] + ring[:1]):
        if (y0 > lat) != (y1 > lat) and lon < x0 + (lat - y0) / (y1 - y0) * (x1 - x0):
            result = not result
    return result


def boxed(ring):
    xs, ys = zip(*ring)
    return ring, (min(xs), min(ys), max(xs), max(ys))


def closed(rings, lon, lat):
    return any(box[0] <= lon <= box[2] and box[1] <= lat <= box[3] and inside(ring, lon, lat)
               for ring, box in rings)


class Airspace(unittest.TestCase):
    def altiplan(self, *arguments):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600,
                             check=False)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def test_national_files(self):
        if not DATA.is_dir():
            self.skipTest(f"no folder {DATA}")
        for name, (corner, size, start, goal) in PLACES.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as self.folder:
                folder = pathlib.Path(self.folder)
                (folder / "s.yaml").write_text(SCENARIO.format(
                    west=corner[0], south=corner[1], size=size, file=DATA / name, start=start, goal=goal))
                (folder / "p.yaml").write_text(
                    "altiplan: 1\nscenario: s.yaml\nsteps:\n  - plan: astar\n    with: {cell_m: [1000, 1000, 60]}\n")
                self.altiplan("run", "p.yaml", "--out", "r.json")
                _, said = self.altiplan("export", "r.json", "--to", "qgc-plan", "-o", "r.plan")
                self.altiplan("export", "r.json", "--to", "geojson", "-o", "r.geojson")
                self.compare(name, said, json.loads((folder / "r.plan").read_text())["geoFence"],
                             json.loads((folder / "r.geojson").read_text())["features"])

    def compare(self, name, said, fence, features):
        corners = sum(len(zone["polygon"]) for zone in fence["polygons"])
        self.assertLessEqual(corners + len(fence["circles"]), 64, said)
        self.assertLessEqual(4 + sum(2 + 8 * len(zone["polygon"]) for zone in fence["polygons"])
                             + 13 * len(fence["circles"]), 560)
        self.assertFalse(any(zone["inclusion"] for zone in fence["polygons"] + fence["circles"]))
        names = {part for zone in fence["polygons"] + fence["circles"] for part in zone["name"].split(" + ")}
        zones = [boxed(feature["geometry"]["coordinates"][0][:-1]) for feature in features
                 if feature["properties"]["role"] == "keep_out" and feature["properties"]["name"] in names]
        self.assertGreater(len(zones), 3)
        polygons = [boxed([[lon, lat] for lat, lon in zone["polygon"]]) for zone in fence["polygons"]]
        circles = [(zone["circle"]["center"], zone["circle"]["radius"]) for zone in fence["circles"]]
        draw = random.Random(1)
        west, south = (min(box[axis] for _, box in zones) for axis in (0, 1))
        east, north = (max(box[axis] for _, box in zones) for axis in (2, 3))
        met = 0
        for _ in range(POINTS):
            lon, lat = draw.uniform(west, east), draw.uniform(south, north)
            if not closed(zones, lon, lat):
                continue
            met += 1
            if not closed(polygons, lon, lat):
                near = any(self.metres(centre, lon, lat) < radius + 0.1 for centre, radius in circles)
                self.assertTrue(near, f"{name}: {lon}, {lat} is open")
        self.assertGreater(met, 100)
        print(f"{name}: {len(zones)} zones with {sum(len(ring) for ring, _ in zones)} corners, fence of {corners} "
              f"and {len(circles)} circles, {met} points closed; {said.count('left out of the fence')} left out")

    @staticmethod
    def metres(centre, lon, lat):
        """By the geodesic of the circle's middle latitude: flat, as ArduPilot judges it."""
        import math
        middle = math.radians((centre[0] + lat) / 2)
        north = (lat - centre[0]) * (111132.954 - 559.822 * math.cos(2 * middle) + 1.175 * math.cos(4 * middle))
        east = (lon - centre[1]) * (111412.84 * math.cos(middle) - 93.5 * math.cos(3 * middle))
        return math.hypot(north, east)


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
