# SPDX-License-Identifier: Apache-2.0
"""survey_area_test.py PROGRAM SOURCES: `altiplan survey`, photos of an area without YAML.

`python3 survey_area_test.py PROGRAM SOURCES Survey.test_an_island` runs one case."""
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", f"{SOURCES}/../shared/data"))
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
RIDGE = (-84.25, 36.60)
FIELD = [(0, 0), (300, 0), (330, 240), (30, 220)]
ISLAND = [(100, 80), (160, 90), (150, 150), (105, 150)]
CAMERA = ["--camera", "sony_a6000_16mm", "--gsd-cm", "2"]


def lonlat(place, x, y):
    lon, lat = place
    return lon + x / 111_320 / math.cos(math.radians(lat)), lat + y / 111_320


def kml(place, *rings):
    def text(ring):
        corners = " ".join("{:.8f},{:.8f},0".format(*lonlat(place, *p)) for p in [*ring, ring[0]])
        return f"<LinearRing><coordinates>{corners}</coordinates></LinearRing>"
    inner = "".join(f"<innerBoundaryIs>{text(ring)}</innerBoundaryIs>" for ring in rings[1:])
    return ('<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>field</name><Polygon>'
            f"<outerBoundaryIs>{text(rings[0])}</outerBoundaryIs>{inner}</Polygon></Placemark></Document></kml>")


def is_within(p, ring):
    inside = False
    for (ax, ay), (bx, by) in zip(ring, ring[1:] + ring[:1]):
        if (ay > p[1]) != (by > p[1]) and p[0] < (bx - ax) * (p[1] - ay) / (by - ay) + ax:
            inside = not inside
    return inside


def distance(p, a, b):
    (px, py), (ax, ay), (bx, by) = p, a, b
    along = (bx - ax) ** 2 + (by - ay) ** 2
    t = max(0, min(1, ((px - ax) * (bx - ax) + (py - ay) * (by - ay)) / along)) if along else 0
    return math.hypot(ax + t * (bx - ax) - px, ay + t * (by - ay) - py)


class Survey(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def write(self, text, name="field.kml"):
        (self.folder / name).write_text(text)
        return name

    def survey(self, area, terrain, *options):
        """One whose plan passes where it may be 5 % off the height of its photos, and no more."""
        out, _ = self.call("survey", area, "--terrain", terrain, *CAMERA, "-o", "out", "--json", *options)
        answer = json.loads(out)
        self.assertEqual(answer["verdict"], "pass")
        height = answer["above_ground_m"]
        self.assertAlmostEqual(height, 81.7021, 3)  # 2 cm * 6000 px * 16 mm / 23.5 mm
        self.call("check", "out/route.plan", "--terrain", terrain, "--min-agl", str(0.95 * height), "--max-agl",
                  str(1.05 * height))
        self.assertGreaterEqual(answer["gsd_cm"][0], 1.9)
        self.assertLessEqual(answer["gsd_cm"][1], 2.1)
        self.assertGreater(answer["coverage"], 0.99)
        self.assertEqual(sorted(file.name for file in (self.folder / "out").iterdir()),
                         ["page.html", "pipeline.yaml", "result.json", "route.plan", "scenario.yaml"])
        return answer

    def lines(self, place):
        """Of the plan, along which the camera is on: metres from the place; and the items."""
        items = json.loads((self.folder / "out/route.plan").read_text())["mission"]["items"]
        lines, at, is_on = [], None, False
        for item in items:
            if item["command"] == 206:
                is_on = item["params"][0] > 0
                self.assertEqual(item["params"][2], 1)
                lines += [[at]] if is_on else []
            elif item["command"] in (16, 21, 22):
                lat, lon = item["params"][4:6]
                at = ((lon - place[0]) * 111_320 * math.cos(math.radians(place[1])), (lat - place[1]) * 111_320)
                if is_on:
                    lines[-1].append(at)
        self.assertFalse(is_on)
        return lines, items

    def test_an_island(self):
        area = self.write(kml(RIDGE, FIELD, ISLAND))
        answer = self.survey(area, TERRAIN)
        self.assertAlmostEqual(answer["spacing_m"], 36, 3)
        self.assertAlmostEqual(answer["trigger_m"], 20, 3)
        lines, items = self.lines(RIDGE)
        self.assertEqual(len(lines), answer["lines"])
        self.assertEqual([item["command"] for item in items[:2]], [22, 178])
        self.assertEqual(items[-1]["command"], 21)
        flown = [p for line in lines for p in line]
        legs = [(a, b) for line in lines for a, b in zip(line, line[1:])]
        for a, b in zip(flown, flown[1:]):
            for n in range(21):
                p = (a[0] + n / 20 * (b[0] - a[0]), a[1] + n / 20 * (b[1] - a[1]))
                if (a, b) in legs:
                    self.assertFalse(is_within(p, ISLAND), p)
        missed = [p for p in ((x, y) for x in range(0, 330, 5) for y in range(0, 240, 5))
                  if is_within(p, FIELD) and not is_within(p, ISLAND) and
                  min(distance(p, a, b) for a, b in legs) > 18.2]
        # Beside the island is what a vehicle of 1 m that stays 3 m clear cannot be over.
        self.assertLess(len(missed), 5, missed)
        self.call("run", "out/pipeline.yaml", "--out", "again.json")
        routes = [json.loads((self.folder / name).read_text())["route"] for name in ("again.json", "out/result.json")]
        self.assertEqual(*routes)

    def test_from_beside_the_area(self):
        area = self.write(kml(RIDGE, FIELD))
        home = lonlat(RIDGE, -60, 100)
        self.survey(area, TERRAIN, "--from", "{:.7f},{:.7f}".format(*home))
        _, items = self.lines(RIDGE)
        for item in (items[0], items[-1]):
            self.assertAlmostEqual(item["params"][4], home[1], 6)
            self.assertAlmostEqual(item["params"][5], home[0], 6)

    def test_a_camera_of_ones_own_and_geojson(self):
        self.write("sensor_mm: [23.5, 15.6]\nimage_px: [6000, 4000]\nfocal_mm: 16\nmin_interval_s: 4\n", "mine.yaml")
        ring = [lonlat(RIDGE, *p) for p in [*FIELD, FIELD[0]]]
        area = self.write(json.dumps({"type": "Feature", "properties": {},
                                      "geometry": {"type": "Polygon", "coordinates": [ring]}}), "area.geojson")
        out, _ = self.call("survey", area, "--terrain", TERRAIN, "--camera", "mine.yaml", "--gsd-cm", "2")
        self.assertIn("photos: mine, 81.702 m above ground", out)
        self.assertIn("5 m/s", out)  # 20 m between photos, 4 s each
        self.assertIn("check: pass", out)
        speeds = [item["params"][1] for item in
                  json.loads((self.folder / "area/route.plan").read_text())["mission"]["items"]
                  if item["command"] == 178]
        self.assertEqual(speeds, [5])

    def test_a_battery(self):
        area = self.write(kml(RIDGE, FIELD))
        for wh, code, said in ((20, 1, "flights or more"), (500, 0, "1 flight or more")):
            out, _ = self.call("survey", area, "--terrain", TERRAIN, *CAMERA, "--battery", str(wh), "--power", "300",
                               code=code)
            self.assertIn(said, out)
            self.assertIn("check: " + ("fail" if code else "pass"), out)

    @unittest.skipUnless(DATA.is_dir(), "no test data: set ALTIPLAN_TEST_DATA")
    def test_mountains(self):
        for model, place in (("davosdorf.tif", (9.83, 46.82)), ("N44W072.hgt", (-71.31, 44.28))):
            with self.subTest(model):
                shutil.rmtree(self.folder / "out", ignore_errors=True)
                self.survey(self.write(kml(place, FIELD, ISLAND)), str(DATA / "dem" / model))

    def test_areas_that_cannot_be_flown(self):
        tiny = self.write(kml(RIDGE, [(0, 0), (10, 0), (10, 10)]), "tiny.kml")
        area = self.write(kml(RIDGE, FIELD, ISLAND))
        house = "{:.7f},{:.7f}".format(*lonlat(RIDGE, 130, 120))
        for said, arguments in (("too small", [tiny]), ("outside the islands", [area, "--from", house])):
            out, _ = self.call("survey", *arguments, "--terrain", TERRAIN, *CAMERA, code=1)
            self.assertIn("no route", out)
            self.assertIn(said, out)

    def refused(self, said, *arguments, code=3):
        _, err = self.call("survey", *arguments, code=code)
        self.assertIn(said, err)
        self.assertEqual(err.replace("Run with --help for more information.\n", "").strip().count("\n"), 0, err)
        self.assertEqual(list(self.folder.glob("*/")), [])

    def test_errors_say_what_was_expected(self):
        area = self.write(kml(RIDGE, FIELD))
        terrain = ["--terrain", TERRAIN]
        self.refused("sony_a6000_16mm", area, *terrain, "--camera", "brownie", "--gsd-cm", "2")
        self.refused("which 4 have", area, *terrain, "--camera", "sony", "--gsd-cm", "2")
        for gsd in ("0", "nan", "2cm"):
            self.refused(f"found '{gsd}'", area, *terrain, *CAMERA[:2], "--gsd-cm", gsd, code=2)
        self.refused("--max-agl: 60 m is below the 85.79 m", area, *terrain, *CAMERA, "--max-agl", "60")
        self.refused("--sidelap", area, *terrain, *CAMERA, "--sidelap", "20")
        self.write("sensor_mm: [23.5, 15.6]\nimage_px: [6000, 4000]\nfocal: 16\n", "bad.yaml")
        _, err = self.call("survey", area, *terrain, "--camera", "bad.yaml", "--gsd-cm", "2", code=3)
        self.assertIn("bad.yaml:3", err)
        self.assertIn("focal_mm", err)
        crossing = self.write(kml(RIDGE, [(0, 0), (300, 200), (300, 0), (0, 200)]), "crossing.kml")
        self.refused("crossing.kml", crossing, *terrain, *CAMERA)
        beyond = self.write(kml((-83, 36.6), FIELD), "beyond.kml")
        self.refused("beyond.kml: corner 1", beyond, *terrain, *CAMERA)
        line = self.write('<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><LineString><coordinates>'
                          "-84.2,36.6,0 -84.1,36.6,0</coordinates></LineString></Placemark></kml>", "line.kml")
        self.refused("line.kml: expected one polygon", line, *terrain, *CAMERA)
        self.refused("missing.kml", "missing.kml", *terrain, *CAMERA)
        cut = self.write(kml(RIDGE, FIELD, [(16.5, 100), (310, 110), (313, 130), (18.5, 120)]), "cut.kml")
        self.refused("cut the area into 2 parts", cut, *terrain, *CAMERA)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
