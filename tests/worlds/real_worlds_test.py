# SPDX-License-Identifier: Apache-2.0
"""Worlds that others made: loaded, a route planned, judged, viewed and exported in each.

python3 real_worlds_test.py PROGRAM SOURCES
reads the files of ALTIPLAN_TEST_DATA (default SOURCES/../shared/data); exits with 77 where they are
absent.
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
DATA = os.path.abspath(os.environ.get("ALTIPLAN_TEST_DATA",
                                      os.path.join(SOURCES, "..", "shared", "data")))

# name: layers, vehicle's radius, volume or None for the layers' own, cell, start, goal, constraints;
# each leads around or over something.
CITY = os.path.join(DATA, "city")
VOXELS = os.path.join(DATA, "voxel3d")
WORLDS = {
    "octomap_building": dict(
        layers=f"- octomap: {{file: {VOXELS}/geb079.bt}}", radius=0.1,
        start="[-5, 0, 1]", goal="[25, 0.5, 1]"),
    "octomap_arena": dict(
        layers=f"- octomap: {{file: {VOXELS}/mbzirc_challenge3.bt, unknown: free}}", radius=0.1,
        start="[-25, -15, 5]", goal="[30, 18, 5]"),
    "octomap_labyrinth": dict(
        layers=f"- octomap: {{file: {VOXELS}/laberynth.bt, unknown: free}}", radius=0.05,
        start="[8.2, -2.9, 1.25]", goal="[8.2, 2.75, 1.25]"),
    "berlin": dict(
        layers=f"- city: {{file: {CITY}/berlin_buildings.geojson, levels_property: levels, "
               "default_height_m: 15}", radius=1.5, cell="[4, 4, 3]", position=True,
        volume="{min_m: [-20, -20, 0], max_m: [920, 880, 14]}",
        start="[5, 860, 10]", goal="[880, 20, 10]"),
    "brussels": dict(
        layers=f"- city: {{file: {CITY}/brussels_place_saint_jean.geojson}}", radius=1.5,
        cell="[4, 4, 3]", position=True,
        volume="{min_m: [-20, -20, 0], max_m: [300, 280, 30]}",
        start="[-10, -10, 10]", goal="[290, 270, 10]"),
    "new_york": dict(
        layers=f"- city: {{file: {CITY}/ny_buildings.geojson}}", radius=1, cell="[2, 2, 2]",
        position=True, volume="{min_m: [-10, -10, 0], max_m: [110, 90, 9]}",
        start="[-5, -5, 3]", goal="[105, 85, 3]"),
    "the_hague": dict(
        layers=f"- city: {{file: {CITY}/DH_01_subs.city.json}}", radius=1, cell="[2, 2, 2]",
        volume="{min_m: [-10, -10, 0], max_m: [95, 385, 12]}",
        start="[-5, -5, 6]", goal="[88, 378, 6]"),
    "san_francisco": dict(
        layers=f"- city: {{file: {CITY}/sf_colliders.csv}}", radius=2, cell="[5, 5, 5]",
        position=True, volume="{min_m: [-440, -310, 0], max_m: [470, 600, 60]}",
        start="[-2, -2, 10]", goal="[450, 580, 40]"),
    # Below the controlled airspace of Helsinki (from 50 m on), around what is closed at any height.
    "finland": dict(
        layers=f"""- zones: {{file: {CITY}/finland_rajoitukset.geojson, clip: true}}
    id: restricted
  - zones:
      file: {CITY}/finland_valvottu.geojson
      type_property: type
      types: [{{is: L, floor_m: 50}}]
      clip: true
    id: controlled
  - zones:
      file: {CITY}/finland_sup.geojson
      from_property: timeBegin
      until_property: timeEnd
      clip: true
    id: temporary
  - zones: {{file: {CITY}/finland_lennatyspaikat.geojson}}
    id: sites""",
        more="frame: {origin_lonlat: [24.7, 60.0]}\nstart_time: 2019-06-20T05:00:00Z\n",
        radius=2, cell="[300, 300, 20]", position=True,
        volume="{min_m: [0, 0, 0], max_m: [33000, 44000, 120]}",
        start="{at_lonlat: [24.73, 60.12, 100]}", goal="{at_lonlat: [25.0, 60.3, 40]}"),
}


FORMATS = {"qgc-plan": "plan", "waypoints": "waypoints", "kml": "kml", "geojson": "geojson",
           "gpx": "gpx", "csv": "csv"}


def point(text):
    return text if text.startswith("{") else f"{{at_m: {text}}}"


def altiplan(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=600,
                          check=False)


class RealWorlds(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as out:
            out.write(text)
        return self.path(name)

    def expect(self, done, code=0):
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def plan(self, world):
        volume = f"volume: {world['volume']}\n" if "volume" in world else ""
        cell = f"    with: {{cell_m: {world['cell']}}}\n" if "cell" in world else ""
        self.write("scenario.yaml",
                   f"altiplan: 1\nenvironment:\n  {world['layers']}\n{volume}"
                   f"vehicle: {{radius_m: {world['radius']}}}\nstart: {point(world['start'])}\n"
                   f"goal: {point(world['goal'])}\n" + world.get("more", ""))
        pipeline = self.write("pipeline.yaml", "altiplan: 1\nscenario: scenario.yaml\nsteps:\n"
                              f"  - plan: astar\n{cell}  - smooth: prune\n")
        self.expect(altiplan("run", pipeline, "--out", self.path("result.json")))
        with open(self.path("result.json"), encoding="utf-8") as result:
            return json.load(result)

    def hold(self, name):
        world = WORLDS[name]
        result = self.plan(world)
        straight = sum((a - b) ** 2 for a, b in zip(result["route"][0], result["route"][-1])) ** 0.5
        self.assertGreater(result["metrics"]["length_m"], 1.0001 * straight, "nothing in the way")
        self.expect(altiplan("check", self.path("result.json")))
        self.view()
        self.export(result, "position" in world)

    def view(self):
        page = self.path("page.html")
        done = self.expect(altiplan("view", self.path("result.json"), "-o", page))
        self.assertIn("1 route", done.stdout)
        with open(page, encoding="utf-8") as file:
            self.assertIn('"altiplan_scene"', file.read())

    def export(self, result, has_position):
        for to, extension in FORMATS.items():
            file = self.path("route." + extension)
            done = altiplan("export", self.path("result.json"), "--to", to, "-o", file)
            if not has_position and to != "csv":
                self.expect(done, 3)
                self.assertIn("not georeferenced", done.stderr)
                self.assertFalse(os.path.exists(file))
                continue
            self.expect(done)
            self.assertIn(f"{len(result['route'])} points", done.stderr)
            self.expect(altiplan("check", "--route", file, "--scenario",
                                 self.path("scenario.yaml")))


for each in WORLDS:
    setattr(RealWorlds, f"test_{each}", lambda self, name=each: self.hold(name))

if __name__ == "__main__":
    if not os.path.isdir(CITY):
        print("no test data: set ALTIPLAN_TEST_DATA")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
