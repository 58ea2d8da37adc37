# SPDX-License-Identifier: Apache-2.0
"""zones_test.py PROGRAM SOURCES: names, limits and roles of zones from a file through an export, and
back from it to a verdict."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

from plan_case import TERRAIN, item, plan_of

PROGRAM = sys.argv[1]
FRAME = "frame: {origin_lonlat: [25, 60]}\n"
# A keep-in zone around a named keep-out zone that begins 150 m above the sea.
ZONES = FRAME + """altiplan: 1
environment:
  - zones:
      list:
        - {id: county, kind: keep_in, ceiling_m: 900,
           polygon: {outline_lonlat: [[25, 60], [25.1, 60], [25.1, 60.05], [25, 60.05]]}}
        - {id: hospital, floor_m: 150, ceiling_m: 400,
           polygon: {outline_lonlat: [[25.04, 60.02], [25.05, 60.02], [25.05, 60.03], [25.04, 60.03]]}}
        - {id: mast, cylinder: {at_lonlat: [25.08, 60.04], radius_m: 100}}
volume: {min_m: [0, 0, 0], max_m: [6000, 6000, 800]}
start: {at_lonlat: [25.01, 60.01, 100]}
goal: {at_lonlat: [25.09, 60.01, 100], tolerance_m: 5}
"""


SCENARIO = FRAME + """altiplan: 1
environment:
  - zones: {file: FILE}
    id: fence
volume: {min_m: [-9000, -9000, 0], max_m: [9000, 9000, 2000]}
start: {at_lonlat: [25.03, 60.025, HEIGHT]}
goal: {at_lonlat: [25.06, 60.025, HEIGHT], tolerance_m: 5}
"""
GPX = """<gpx version="1.1"><rte><rtept lat="60.025" lon="25.03"><ele>HEIGHT</ele></rtept>
<rtept lat="60.025" lon="25.06"><ele>HEIGHT</ele></rtept></rte></gpx>
"""


class Zones(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.write("zones.yaml", ZONES)
        self.write("pipeline.yaml", "altiplan: 1\nscenario: zones.yaml\nsteps:\n"
                   "  - plan: theta_star\n    with: {cell_m: [100, 100, 50]}\n")
        self.call("run", "pipeline.yaml", "--out", "result.json")

    def write(self, name, text):
        (self.folder / name).write_text(text)

    def call(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=600)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def verdict(self, file, height, code):
        """On the straight leg past 'hospital' among the zones of the file."""
        self.write("read.yaml", SCENARIO.replace("FILE", file).replace("HEIGHT", str(height)))
        self.write("leg.gpx", GPX.replace("HEIGHT", str(height)))
        return self.call("check", "leg.gpx", "--scenario", "read.yaml", code=code)[0]

    def test_a_start_in_a_zone_names_it(self):
        inside = ZONES.replace("start: {at_lonlat: [25.01, 60.01, 100]}",
                               "start: {at_lonlat: [25.045, 60.025, 200]}")
        self.write("zones.yaml", inside)
        run = subprocess.run([PROGRAM, "run", "pipeline.yaml"], cwd=self.folder,
                             capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, 1, run.stdout + run.stderr)
        self.assertRegex(run.stdout, r"the start .* cannot be flown: lies up to .*: 'hospital'")

    def test_a_map_is_read_back_as_it_was_written(self):
        for file in ("map.kml", "map.geojson"):
            with self.subTest(file):
                self.call("export", "result.json", "-o", file)
                self.verdict(file, 120, code=0)  # below its floor
                self.assertIn("'hospital' of 'fence'", self.verdict(file, 300, code=1))
                self.verdict(file, 410, code=0)  # above its ceiling
                self.assertIn("outside the fence 'county'", self.verdict(file, 950, code=1))  # above the county's

    def test_a_plan_keeps_the_names_of_its_fence(self):
        self.call("export", "result.json", "-o", "route.plan")
        fence = json.loads((self.folder / "route.plan").read_text())["geoFence"]
        self.assertEqual([zone.get("name") for zone in fence["polygons"] + fence["circles"]],
                         ["county", "hospital", "mast"])

    def test_a_verdict_names_the_zone_of_a_fence(self):
        plan = plan_of([])
        plan["mission"]["items"] = [item(point, n + 1) for n, point in
                                    enumerate([[-84.38, 36.48, 1500], [-84.20, 36.66, 1500]])]
        circle = {"center": [36.57, -84.29], "radius": 500}
        plan["geoFence"]["circles"] = [
            {"version": 1, "inclusion": False, "circle": circle, "name": "hospital"}]
        self.write("mission.plan", json.dumps(plan))
        verdict, _ = self.call("check", "mission.plan", "--terrain", TERRAIN, code=1)
        self.assertIn("'hospital' of 'fence of the mission'", verdict)
        told, _ = self.call("check", "mission.plan", "--terrain", TERRAIN, "--json", "--junit", "j.xml",
                            code=1)
        one, = json.loads(told)["violations"]
        self.assertEqual([one[key] for key in ("rule", "unit", "layer", "zone")],
                         ["clearance", "m", "fence of the mission", "hospital"])
        failure, = xml.etree.ElementTree.parse(self.folder / "j.xml").getroot().iter("failure")
        self.assertEqual(failure.get("type"), "clearance")
        self.assertRegex(failure.text, r"value -\d.* m, limit \d+(\.5)? m, layer fence of the mission, zone hospital")

    def test_airspace_is_read_as_that_of_a_first_route(self):
        self.write("mission.plan", json.dumps(plan_of([[-84.30, 36.60, 1500], [-84.29, 36.60, 1500]])))

        def square(west):
            return [[36.59, west], [36.59, west + 0.05], [36.61, west + 0.05], [36.61, west]]
        fence = plan_of([])
        fence["geoFence"]["polygons"] = [{"version": 1, "inclusion": True, "polygon": square(-84.32)}]
        check = ("check", "mission.plan", "--terrain", TERRAIN, "--airspace")
        self.write("fence.plan", json.dumps(fence))
        self.call(*check, "fence.plan")
        fence["geoFence"]["polygons"].append({"version": 1, "inclusion": True, "polygon": square(-84.20)})
        self.write("fence.plan", json.dumps(fence))
        self.call(*check, "fence.plan", code=1)  # an autopilot stays in both
        ring = [[lon, lat] for lat, lon in square(-84.32)]
        for floor, code in ((1600, 0), (1400, 1)):
            self.write("limits.geojson", json.dumps({"type": "FeatureCollection", "features": [
                {"type": "Feature", "properties": {"floor_m": floor, "ceiling_m": 1700},
                 "geometry": {"type": "Polygon", "coordinates": [[*ring, ring[0]]]}}]}))
            self.call(*check, "limits.geojson", code=code)

    def test_airspace_without_an_area_is_refused(self):
        points = [[-84.38, 36.48, 1500], [-84.20, 36.66, 1500]]
        self.write("mission.plan", json.dumps(plan_of(points)))
        prison = {"type": "Feature", "properties": {"name": "prison"},
                  "geometry": {"type": "Point", "coordinates": [-84.29, 36.57]}}
        for features, words in (([prison], "points and lines without a width: 'prison at -84.29, 36.57'"),
                                ([{**prison, "geometry": None}], "1 features without an area skipped"),
                                ([], "0 features without an area skipped")):
            self.write("zones.geojson", json.dumps({"type": "FeatureCollection", "features": features}))
            _, err = self.call("check", "mission.plan", "--terrain", TERRAIN, "--airspace", "zones.geojson",
                               code=3)
            self.assertIn("zones.geojson: contains no zone: ", err)
            self.assertIn(words, err)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
