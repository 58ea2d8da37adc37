# SPDX-License-Identifier: Apache-2.0
"""survey_item_test.py PROGRAM SOURCES: surveys written as QGroundControl's survey item, made again and judged.

`python3 survey_item_test.py PROGRAM SOURCES Item.test_round_trip` runs one case."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
LON, LAT = 8.0, 47.0
WGS84 = ('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
         'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
AREAS = {"quadrilateral": [(0, 0), (300, 30), (340, 260), (-20, 220)],
         "rectangle": [(0, 0), (280, 130), (200, 310), (-80, 180)],
         "triangle": [(0, 0), (260, 20), (120, 240)],
         "hexagon, clockwise": [(0, 0), (-60, 120), (20, 260), (200, 280), (320, 150), (240, 10)]}
CONCAVE = [(0, 0), (300, 30), (100, 100), (-20, 220)]
ISLAND = [(100, 80), (160, 90), (150, 150), (105, 150)]


class Item(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout

    def model(self, slope=0.0):
        """Ground that rises to the east by so many metres a metre."""
        count, cell = 81, 0.0005
        rows = " ".join(f"{400 + slope * n * cell * 75_900:.3f}" for n in range(count))
        (self.folder / "model.asc").write_text(
            f"ncols {count}\nnrows {count}\nxllcorner {LON - count / 2 * cell}\nyllcorner {LAT - count / 2 * cell}\n"
            f"cellsize {cell}\n" + (rows + "\n") * count)
        (self.folder / "model.prj").write_text(WGS84)
        return "model.asc"

    def survey(self, name, terrain, *rings, place=(LON, LAT), options=()):
        coordinates = [[[place[0] + x / 75_900, place[1] + y / 111_320] for x, y in [*ring, ring[0]]] for ring in rings]
        (self.folder / "area.geojson").write_text(json.dumps(
            {"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": coordinates}}))
        return self.call("survey", "area.geojson", "--terrain", terrain, "--camera", "sony_a6000_16mm", "--gsd-cm", "2",
                         "-o", name, *options)

    def written(self, name):
        """The parts of the plan, which has its items in the order of their numbers."""
        items = json.loads((self.folder / name / "survey.plan").read_text())["mission"]["items"]
        first, speed, survey, home, last = items
        self.assertEqual([each["command"] for each in (first, speed, home, last)], [22, 178, 16, 21])
        commands = survey["TransectStyleComplexItem"]["Items"]
        self.assertEqual([first["doJumpId"], speed["doJumpId"], *(each["doJumpId"] for each in commands),
                          home["doJumpId"], last["doJumpId"]], list(range(1, len(commands) + 5)))
        return survey

    def made_again(self, name):
        answer = json.loads(self.call("check", f"{name}/survey.plan", "--survey", "--json"))
        self.assertLessEqual(answer["items_differ_m"], 0.1)
        return answer

    def test_round_trip(self):
        terrain = self.model()
        for n, (kind, ring) in enumerate(AREAS.items()):
            with self.subTest(kind):
                name = f"out{n}"
                self.assertIn("at one height above home: pass", self.survey(name, terrain, ring))
                survey = self.written(name)
                camera = survey["TransectStyleComplexItem"]["CameraCalc"]
                self.assertAlmostEqual(camera["AdjustedFootprintSide"], 36, 6)
                self.assertAlmostEqual(camera["AdjustedFootprintFrontal"], 20, 6)
                self.assertEqual(len(survey["polygon"]), len(ring))
                self.made_again(name)
                height = camera["DistanceToSurface"]
                self.assertAlmostEqual(height, 81.7021, 3)
                self.call("check", f"{name}/survey.plan", "--terrain", terrain, "--min-agl", str(0.95 * height),
                          "--max-agl", str(1.05 * height))
                shown = json.loads(self.call("check", f"{name}/survey.plan", "--survey", "--terrain", terrain, "--json"))
                self.assertGreater(shown["coverage"], 0.99)

    def test_a_slope_is_followed(self):
        """By the autopilot: one height above home is too much off."""
        terrain = self.model(slope=0.05)
        self.assertIn("at one height above the ground: pass", self.survey("out", terrain, AREAS["quadrilateral"]))
        commands = self.written("out")["TransectStyleComplexItem"]["Items"]
        self.assertEqual({each["frame"] for each in commands if each["command"] == 16}, {10})
        self.made_again("out")

    def test_what_it_cannot_say(self):
        terrain = self.model()
        area = AREAS["quadrilateral"]
        for n, (rings, options, words) in enumerate((
                ([CONCAVE], (), "it flies across the corners of a concave area"),
                ([area, ISLAND], (), "it knows no islands"),
                ([area], ("--flight-minutes", "7"), "it is one flight"),
                ([area], ("--wing", "40", "--scale-tolerance", "20"), "it knows no turns of an aeroplane"))):
            with self.subTest(words):
                name = f"out{n}"
                self.assertIn("no survey.plan, of QGroundControl's survey item: " + words,
                              self.survey(name, terrain, *rings, options=options))
                self.assertFalse((self.folder / name / "survey.plan").exists())

    def test_hills_that_it_cannot_follow(self):
        said = self.survey("out", TERRAIN, AREAS["quadrilateral"], place=(-84.25, 36.60))
        self.assertRegex(said, "no survey.plan.*the height above ground is")
        self.assertFalse((self.folder / "out/survey.plan").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
