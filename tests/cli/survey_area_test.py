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


def polygon(place, *rings):
    def text(ring):
        corners = " ".join("{:.8f},{:.8f},0".format(*lonlat(place, *p)) for p in [*ring, ring[0]])
        return f"<LinearRing><coordinates>{corners}</coordinates></LinearRing>"
    inner = "".join(f"<innerBoundaryIs>{text(ring)}</innerBoundaryIs>" for ring in rings[1:])
    return f"<Polygon><outerBoundaryIs>{text(rings[0])}</outerBoundaryIs>{inner}</Polygon>"


def document(**geometries):
    marks = (f"<Placemark><name>{name}</name>{geometry}</Placemark>" for name, geometry in geometries.items())
    return f'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>{"".join(marks)}</Document></kml>'


def kml(place, *rings):
    return document(field=polygon(place, *rings))


def moved(ring, x, y):
    return [(px + x, py + y) for px, py in ring]


def line(place, *points):
    corners = " ".join("{:.8f},{:.8f}".format(*lonlat(place, *p)) for p in points)
    return f"<LineString><coordinates>{corners}</coordinates></LineString>"


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
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def write(self, text, name="field.kml"):
        (self.folder / name).write_text(text)
        return name

    def survey(self, area, terrain, *options):
        """One whose plan passes where it may be 5 % off the height of its photos, and no more."""
        out, _ = self.call("survey", area, "--terrain", terrain, *CAMERA, "-o", "out", "--json", *options)
        answer = json.loads(out)
        self.assertEqual(answer["verdict"], "pass", answer)
        height = answer["above_ground_m"]
        self.assertAlmostEqual(height, 81.7021, 3)  # 2 cm * 6000 px * 16 mm / 23.5 mm
        self.call("check", "out/route.plan", "--terrain", terrain, "--min-agl", str(0.95 * height), "--max-agl",
                  str(1.05 * height))
        self.assertGreaterEqual(answer["gsd_cm"][0], 1.9)
        self.assertLessEqual(answer["gsd_cm"][1], 2.1)
        self.assertGreater(answer["coverage"], 0.99)
        self.call("check", "out/result.json")
        self.assertNotIn("judged now", (self.folder / "out/page.html").read_text())
        checked = self.shown("out/route.plan", terrain)
        self.assertEqual(checked["lines"], answer["lines"])
        self.assertAlmostEqual(checked["coverage"], answer["coverage"], 3)
        self.assertEqual(sorted(file.name for file in (self.folder / "out").iterdir()),
                         ["page.html", "pipeline.yaml", "result.json", "route.plan", "scenario.yaml"])
        return answer

    def shown(self, plan, terrain):
        return json.loads(self.call("check", plan, "--survey", "--terrain", terrain, "--json")[0])

    def lines(self, place, plan="route.plan"):
        """Of the plan, along which the camera is on: metres from the place; and the items."""
        items = json.loads((self.folder / "out" / plan).read_text())["mission"]["items"]
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

    def test_several_areas(self):
        east = moved(FIELD, 900, 0)
        areas = self.write(document(west=polygon(RIDGE, FIELD, ISLAND), east=polygon(RIDGE, east),
                                    middle=polygon(RIDGE, moved(FIELD, 450, 0))))
        answer = self.survey(areas, TERRAIN)
        lines, _ = self.lines(RIDGE)
        middles = [sum(p[0] for p in line) / len(line) for line in lines]
        legs = [(a, b) for line in lines for a, b in zip(line, line[1:])]
        for ring in (FIELD, east, moved(FIELD, 450, 0)):
            places = [(x, y) for x in range(0, 1250, 10) for y in range(0, 240, 10) if is_within((x, y), ring)
                      and not is_within((x, y), ISLAND)]
            missed = [p for p in places if min(distance(p, a, b) for a, b in legs) > 18.2]
            self.assertLess(len(missed), 3, missed)
        self.assertGreater(answer["area_m2"], 3 * 65_000)
        # Each is flown at once, and the middle one is not left for last.
        fields = [min(range(3), key=lambda n, x=x: abs(x - 165 - 450 * n)) for x in middles]
        self.assertEqual([n for i, n in enumerate(fields) if i == 0 or fields[i - 1] != n].count(1), 1, fields)

    def test_areas_that_are_wrong_are_named(self):
        camera = ["--terrain", TERRAIN, *CAMERA]
        both = self.write(document(west=polygon(RIDGE, FIELD), pond=polygon(RIDGE, moved(FIELD, 200, 0))))
        self.refused("the area 'west' and the area 'pond' overlap", both, *camera)
        tiny = self.write(document(west=polygon(RIDGE, FIELD), pond=polygon(RIDGE, [(400, 0), (405, 0), (405, 5)])))
        out, _ = self.call("survey", tiny, *camera, code=1)
        self.assertIn("the area 'pond' is too small", out)
        shutil.rmtree(self.folder / "field")
        flat = self.write(document(west=polygon(RIDGE, FIELD), pond=polygon(RIDGE, [(400, 0), (405, 0), (410, 0)])))
        self.refused("'pond'", flat, *camera)
        far = self.write(document(west=polygon(RIDGE, FIELD), pond=polygon((-83, 36.6), FIELD)))
        self.refused("'pond', corner 1", far, *camera)

    def test_several_flights(self):
        area = self.write(document(west=polygon(RIDGE, FIELD, ISLAND), east=polygon(RIDGE, moved(FIELD, 450, 0))))
        home = lonlat(RIDGE, -60, 100)
        out, _ = self.call("survey", area, "--terrain", TERRAIN, *CAMERA, "--from", "{:.7f},{:.7f}".format(*home),
                           "--flight-minutes", "10", "--battery", "60", "--power", "300", "-o", "out", "--json")
        answer = json.loads(out)
        self.assertEqual(answer["verdict"], "pass")
        self.assertGreater(answer["coverage"], 0.99)
        flights = answer["flights"]
        self.assertGreater(len(flights), 1)
        self.assertLess(len(flights), 8)
        self.assertEqual(sorted(file.name for file in (self.folder / "out").glob("*.plan")),
                         [f"route-{n + 1}.plan" for n in range(len(flights))])
        all_lines, shares = [], []
        for n, flight in enumerate(flights):
            self.assertEqual(flight["verdict"], "pass")
            self.assertLessEqual(flight["time_s"][1], 600)
            self.assertLessEqual(flight["max_wh"], 48)
            lines, items = self.lines(RIDGE, f"route-{n + 1}.plan")
            all_lines += lines
            for item in (items[0], items[-1]):
                self.assertAlmostEqual(item["params"][4], home[1], 6)
                self.assertAlmostEqual(item["params"][5], home[0], 6)
            self.call("check", f"out/route-{n + 1}.plan", "--terrain", TERRAIN)
            shares.append(self.shown(f"out/route-{n + 1}.plan", TERRAIN)["coverage"])
        self.assertEqual(len(all_lines), answer["lines"])
        self.assertLess(max(shares), answer["coverage"])
        self.assertGreater(sum(shares), answer["coverage"])  # photos overlap
        text, _ = self.call("survey", area, "--terrain", TERRAIN, *CAMERA, "--flight-minutes", "11")
        self.assertIn("route-1.plan: check: pass", text)
        # Half a minute brings no photo home.
        out, _ = self.call("survey", area, "--terrain", TERRAIN, *CAMERA, "--flight-minutes", "0.5", code=1)
        self.assertIn("no flight", out)

    def test_a_copter_in_wind(self):
        area = self.write(kml(RIDGE, FIELD))
        calm = self.survey(area, TERRAIN)
        shutil.rmtree(self.folder / "out")
        windy = self.survey(area, TERRAIN, "--wind", "6,270")
        self.assertAlmostEqual(windy["planned_s"], calm["planned_s"], 3)  # its speed is that over the ground

    def test_along_a_line(self):
        corners = [(0, 0), (400, 100), (700, -150)]
        self.write(document(cable=line(RIDGE, *corners)), "line.kml")
        coordinates = [lonlat(RIDGE, *p) for p in corners]
        self.write(json.dumps({"type": "Feature", "properties": {},
                               "geometry": {"type": "LineString", "coordinates": coordinates}}), "line.geojson")
        legs = list(zip(corners, corners[1:]))
        home = "{:.7f},{:.7f}".format(*lonlat(RIDGE, -60, 100))
        for file in ("line.kml", "line.geojson"):
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            out, _ = self.call("survey", file, "--terrain", TERRAIN, "--camera", "a6000_16", "--agl", "80", "--offset",
                               "30", "--offset", "-30", "--from", home, "-o", "out", "--json")
            answer = json.loads(out)
            self.assertEqual(answer["verdict"], "pass")
            self.assertAlmostEqual(answer["above_ground_m"], 80, 9)
            self.assertIsNone(answer["coverage"])
            lines, items = self.lines(RIDGE)
            self.assertEqual(len(lines), 2)
            self.assertEqual([items[0]["command"], items[-1]["command"]], [22, 21])
            self.assertEqual(items[0]["params"][4:6], items[-1]["params"][4:6])
            for flown in lines:
                for p in flown:
                    self.assertGreater(min(distance(p, a, b) for a, b in legs), 29.5)
                    self.assertLess(min(distance(p, a, b) for a, b in legs), 40)  # beyond the corner
            self.call("check", "out/route.plan", "--terrain", TERRAIN, "--min-agl", "76", "--max-agl", "84")
        out, _ = self.call("survey", "line.kml", "--terrain", TERRAIN, *CAMERA, "--width", "150", "--json")
        answer = json.loads(out)
        self.assertEqual((answer["verdict"], answer["lines"]), ("pass", 5))  # 36 m apart at most
        self.assertGreater(answer["coverage"], 0.99)
        self.refused("has areas, not a line", self.write(kml(RIDGE, FIELD)), "--terrain", TERRAIN, *CAMERA, "--width",
                     "50", left=["line", "out"])

    def test_a_battery(self):
        area = self.write(kml(RIDGE, FIELD))
        for wh, most in ((500, 1), (40, 4)):
            out, _ = self.call("survey", area, "--terrain", TERRAIN, *CAMERA, "--battery", str(wh), "--power", "300",
                               "-o", f"out{wh}")
            flights = len(list((self.folder / f"out{wh}").glob("*.plan")))
            self.assertLessEqual(flights, most)
            self.assertGreater(flights, most / 4)
            self.assertEqual(out.count("check: pass"), flights, out)
            self.assertEqual(out.count("Wh that may be used"), flights, out)

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

    def refused(self, said, *arguments, code=3, left=()):
        _, err = self.call("survey", *arguments, code=code)
        self.assertIn(said, err)
        self.assertEqual(err.replace("Run with --help for more information.\n", "").strip().count("\n"), 0, err)
        self.assertEqual(sorted(file.name for file in self.folder.iterdir() if file.is_dir()), list(left))

    def test_check_computes_what_photos_show(self):
        area = self.write(kml(RIDGE, FIELD))
        whole = self.survey(area, TERRAIN)["coverage"]
        plan = json.loads((self.folder / "out/route.plan").read_text())
        items = plan["mission"]["items"]
        on = [item for item in items if item["command"] == 206 and item["params"][0] > 0]
        for item in on[:3]:  # lines without photos; a photo shows 60 m to the sides, lines are 36 m apart
            item["params"][0] = 0
        self.write(json.dumps(plan), "less.plan")
        self.assertLess(self.shown("less.plan", TERRAIN)["coverage"], whole - 0.02)
        for item in items:
            if item["command"] == 206:
                item["params"][0] *= 5  # each photo shows 80 m of the 100 m between two
        self.write(json.dumps(plan), "less.plan")
        self.assertLess(self.shown("less.plan", TERRAIN)["coverage"], 0.85)
        for key, value, said in (("across_m", 0, "across_m: expected a positive number"),
                                 ("areas", [], "areas: expected one or more"),
                                 ("areas", 5, "expected areas with outline")):
            damaged = json.loads(json.dumps(plan))
            damaged["altiplan"]["survey"][key] = value
            self.write(json.dumps(damaged), "damaged.plan")
            _, err = self.call("check", "damaged.plan", "--survey", "--terrain", TERRAIN, code=3)
            self.assertIn("damaged.plan: altiplan.survey: " + said, err)
        del plan["altiplan"]
        self.write(json.dumps(plan), "plain.plan")
        _, err = self.call("check", "plain.plan", "--survey", "--terrain", TERRAIN, code=3)
        self.assertIn("plain.plan: expected a survey that altiplan survey has written", err)

    def test_check_computes_what_surveys_of_qgroundcontrol_show(self):
        area = self.write(kml(RIDGE, FIELD))
        whole = self.survey(area, TERRAIN)["coverage"]
        plan = json.loads((self.folder / "out/route.plan").read_text())
        del plan["altiplan"]
        items = plan["mission"]["items"]
        camera = {"version": 2, "CameraName": "a6000", "SensorWidth": 23.5, "SensorHeight": 15.6, "ImageWidth": 6000,
                  "ImageHeight": 4000, "FocalLength": 16, "Landscape": True, "AdjustedFootprintSide": 36,
                  "AdjustedFootprintFrontal": 20, "DistanceToSurface": 81.7, "DistanceMode": 2}
        style = {"version": 2, "HoverAndCapture": False, "CameraCalc": camera, "Items": items[2:-1]}
        survey = {"type": "ComplexItem", "complexItemType": "survey", "version": 5, "TransectStyleComplexItem": style,
                  "polygon": [lonlat(RIDGE, *p)[::-1] for p in FIELD]}
        plan["mission"]["items"] = [*items[:2], survey, items[-1]]
        self.write(json.dumps(plan), "qgc.plan")
        self.assertAlmostEqual(self.shown("qgc.plan", TERRAIN)["coverage"], whole, 3)
        camera["Landscape"] = False  # 80 m across, which neighbours 36 m apart share
        self.write(json.dumps(plan), "qgc.plan")
        self.assertGreater(self.shown("qgc.plan", TERRAIN)["coverage"], 0.9)
        camera["FocalLength"] = 64  # 20 m across: gaps between the lines
        self.write(json.dumps(plan), "qgc.plan")
        self.assertLess(self.shown("qgc.plan", TERRAIN)["coverage"], 0.6)
        for change, said in ((lambda: style.update(HoverAndCapture=True), "(HoverAndCapture) are not counted"),
                             (lambda: camera.pop("Landscape"), "expected a survey of QGroundControl"),
                             (lambda: camera.update(Landscape=True, FocalLength=0), "expected positive SensorWidth"),
                             (lambda: camera.pop("SensorWidth"), "expected a camera with SensorWidth")):
            style["HoverAndCapture"] = False
            change()
            self.write(json.dumps(plan), "qgc.plan")
            _, err = self.call("check", "qgc.plan", "--survey", "--terrain", TERRAIN, code=3)
            self.assertIn("qgc.plan: mission.items.2", err)
            self.assertIn(said, err)

    def test_errors_say_what_was_expected(self):
        area = self.write(kml(RIDGE, FIELD))
        terrain = ["--terrain", TERRAIN]
        self.refused("sony_a6000_16mm", area, *terrain, "--camera", "brownie", "--gsd-cm", "2")
        self.refused("which 4 have", area, *terrain, "--camera", "sony", "--gsd-cm", "2")
        for gsd in ("0", "nan", "2cm"):
            self.refused(f"found '{gsd}'", area, *terrain, *CAMERA[:2], "--gsd-cm", gsd, code=2)
        speck = self.write(kml(RIDGE, [(0, 0), (0.2, 0), (0.2, 0.2)]), "speck.kml")
        self.refused("speck.kml: corner 3: expected a way of 1 m or more", speck, *terrain, *CAMERA)
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
        pin = self.write(document(mast="<Point><coordinates>-84.2,36.6,0</coordinates></Point>"), "pin.kml")
        self.refused("pin.kml: expected polygons, which may have holes, or one line", pin, *terrain, *CAMERA)
        lines = self.write(document(a=line(RIDGE, (0, 0), (9, 9)), b=line(RIDGE, (0, 9), (9, 0))), "lines.kml")
        self.refused("lines.kml: expected one LineString", lines, *terrain, *CAMERA)
        self.refused("--gsd-cm or --agl is required", area, *terrain, *CAMERA[:2], code=2)
        self.refused("missing.kml", "missing.kml", *terrain, *CAMERA)
        wing = ["--wing", "60"]
        self.refused("an aeroplane's plan ends in a circle", area, *terrain, *CAMERA, *wing, "--flight-minutes", "9",
                     code=2)
        cable = self.write(document(a=line(RIDGE, (0, 0), (300, 9))), "cable.kml")
        self.refused("cable.kml has a line, which a copter follows", cable, *terrain, *CAMERA, *wing)
        self.refused("0.8 s, which takes the camera 1 s", area, *terrain, *CAMERA, "--speed", "25")
        self.refused("is not less than the speed", area, *terrain, *CAMERA, "--wind", "12,90")
        self.refused("found '5'", area, *terrain, *CAMERA, "--wind", "5", code=2)
        cut = self.write(kml(RIDGE, FIELD, [(16.5, 100), (310, 110), (313, 130), (18.5, 120)]), "cut.kml")
        self.refused("cut the area into 2 parts", cut, *terrain, *CAMERA)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
