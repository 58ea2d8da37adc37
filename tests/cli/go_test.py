# SPDX-License-Identifier: Apache-2.0
"""go_test.py PROGRAM SOURCES: `altiplan go`, a first route without YAML.

`python3 go_test.py PROGRAM SOURCES Go.test_a_wing` runs one case."""
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import by_day, by_night  # noqa: E402

PROGRAM, SOURCES = sys.argv[1:3]
DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", f"{SOURCES}/../shared/data"))
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
ENDS = ["--from", "-84.38,36.48", "--to", "-84.20,36.62"]
NEAR = ["--from", "-84.32,36.52", "--to", "-84.28,36.57"]  # within WALL and without
VALLEY = ["--from", "-84.38,36.48", "--to", "-84.36,36.50"]
UTM = ('PROJCS["WGS 84 / UTM zone 11N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,'
       '298.257223563]],PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],'
       'PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],'
       'PARAMETER["central_meridian",-117],PARAMETER["scale_factor",0.9996],'
       'PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]')


def grid(columns, rows, west, south, cell, void=lambda i, j: False):
    """Hills as an ESRI ASCII grid."""
    def height(i, j):
        return -9999 if void(i, j) else round(400 + 100 * math.sin(i / 4) * math.cos(j / 5), 1)
    head = (f"ncols {columns}\nnrows {rows}\nxllcorner {west}\nyllcorner {south}\n"
            f"cellsize {cell}\nNODATA_value -9999\n")
    return head + "\n".join(" ".join(str(height(i, j)) for i in range(columns))
                            for j in range(rows)) + "\n"


def box(west, south, size):
    return [[west, south], [west + size, south], [west + size, south + size], [west, south + size],
            [west, south]]


# Four sides around a place, so that a search soon knows that there is no way.
WALL = [[[x, y], [x + wide, y], [x + wide, y + high], [x, y + high], [x, y]] for x, y, wide, high in (
    (-84.34, 36.51, 0.04, 0.004), (-84.34, 36.526, 0.04, 0.004), (-84.34, 36.51, 0.004, 0.02),
    (-84.304, 36.51, 0.004, 0.02))]


class Go(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=600)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def route(self, file):
        return json.loads((self.folder / file).read_text())["route"]

    def go(self, *options, folder):
        """A route that the judge accepts, that its files give again, and whose plan passes."""
        out, _ = self.call("go", *options)
        self.assertEqual([word for line in out.splitlines() if (word := line.split(":")[0]) != "items"],
                         ["terrain", "volume", "heights", "planner", "route", "written", "check"])
        self.assertIn("check: pass", out)
        self.assertEqual(sorted(file.name for file in (self.folder / folder).iterdir()),
                         ["page.html", "pipeline.yaml", "result.json", "route.plan",
                          "scenario.yaml"])
        self.call("run", f"{folder}/pipeline.yaml", "--out", "again.json")
        self.assertEqual(self.route("again.json"), self.route(f"{folder}/result.json"))
        return out

    def refused(self, said, *options, code=3):
        _, err = self.call("go", *options, code=code)
        self.assertIn(said, err)
        self.assertEqual(list(self.folder.glob("*/")), [])

    def test_a_copter(self):
        for folder in ("jacksboro_fault", "jacksboro_fault_2"):  # none is overwritten
            out = self.go("--terrain", TERRAIN, *ENDS, folder=folder)
            self.assertIn("planner: theta_star", out)
            self.call("check", f"{folder}/route.plan", "--terrain", TERRAIN, "--min-agl", "50")
        _, err = self.call("go", "--terrain", TERRAIN, *ENDS, "-o", "jacksboro_fault", code=3)
        self.assertIn("exists already", err)

    def test_how_a_copter_is_flown(self):
        out = self.go("--terrain", TERRAIN, *ENDS, "-o", "plain", folder="plain")
        self.assertRegex(out, r"; flown in \d+\.\d min, up to \d+\.\d{3} km from the start")
        ran = json.loads((self.folder / "plain/result.json").read_text())["metrics"]
        self.assertGreater(ran["time_s"], ran["length_m"] / 10 + 4)
        steep = math.degrees(math.asin(1.5 / 10))
        if ran["max_climb_deg"] > steep + 0.1:
            self.assertRegex(out, r"\d+\.\d degrees (down|up) at \d+\.\d m/s")
        wh = 300 * ran["time_s"] / 3600
        out = self.go("--terrain", TERRAIN, *ENDS, "--battery", str(2 * wh), "--power", "300", "-o", "much", folder="much")
        self.assertRegex(out, rf"min, {wh:.1f} Wh of {1.6 * wh:.1f} Wh that may be used \(battery {2 * wh:.1f} Wh, reserve 20 %\)")
        out, _ = self.call("go", "--terrain", TERRAIN, *ENDS, "--battery", str(1.2 * wh), "--power", "300", "-o", "little",
                           code=1)
        self.assertIn("Wh of the battery may be used", out)
        _, err = self.call("go", "--terrain", TERRAIN, *ENDS, "--battery", "90", code=2)
        self.assertIn("--power", err)

    def test_a_band_above_ground(self):
        self.go("--terrain", TERRAIN, *ENDS, "--max-agl", "120", "-o", "low", folder="low")
        self.call("check", "low/route.plan", "--terrain", TERRAIN, "--min-agl", "50", "--max-agl",
                  "120")

    def test_no_planner_is_much_shorter_within_a_band(self):
        steep = DATA / "dem/elev_vinschgau.tif"
        pairs = [(TERRAIN, "-84.31,36.48", "-84.136,36.70")]
        if steep.is_file():
            pairs.append((str(steep), "10.73,46.55", "10.75,46.78"))
        for terrain, start, goal in by_day(pairs, 2):
            def length(*options):
                folder = f"{len(list(self.folder.iterdir()))}"
                self.call("go", "--terrain", terrain, "--from", start, "--to", goal, "--max-agl",
                          "120", "-o", folder, *options)
                result = json.loads((self.folder / folder / "result.json").read_text())
                return result["metrics"]["length_m"]
            chosen = length()
            for planner in ("astar", "lazy_theta_star"):
                self.assertLess(chosen, 1.01 * length("--planner", planner), (terrain, planner))

    def test_a_flight_may_be_off_by_what_its_route_keeps(self):
        self.go("--terrain", TERRAIN, *ENDS, "--max-agl", "120", "-o", "first", folder="first")
        text = (self.folder / "first/scenario.yaml").read_text()
        for constraint in ("ground_clearance: {min_m: 53, applies_to: route}",
                           "altitude: {datum: ground, max_m: 117, applies_to: route}",
                           "clearance: {min_m: 3, applies_to: route}",
                           "ground_clearance: {min_m: 50, applies_to: track}",
                           "altitude: {datum: ground, max_m: 120, applies_to: track}"):
            self.assertIn("  - " + constraint, text)

    @by_night
    def test_a_wing(self):
        out = self.go("--terrain", TERRAIN, *ENDS, "--wing", "80", "--via", "-84.30,36.58,150",
                      "-o", "wing", folder="wing")
        self.assertIn("wing with turns of 80 m", out)
        self.assertIn("check: pass, flown by ArduPilot plane, ", out)
        self.call("check", "wing/route.plan", "--terrain", TERRAIN, "--min-agl", "50")

    def test_a_wing_whose_circle_at_the_goal_would_be_too_low(self):
        out, _ = self.call("go", "--terrain", TERRAIN, *VALLEY, "--wing", "80", "-o", "higher")
        self.assertIn("circle: around the goal at", out)
        self.assertIn("check: pass, flown by ArduPilot plane", out)

    def zones(self, file, *rings, **properties):
        (self.folder / file).write_text(json.dumps({
            "type": "FeatureCollection", "features": [{
                "type": "Feature", "geometry": {"type": "Polygon", "coordinates": [ring]},
                "properties": properties} for ring in rings]}))

    def test_speed_climb_and_wind(self):
        ends = ["--terrain", TERRAIN, *ENDS]
        slow, _ = self.call("go", *ends, "-o", "slow")
        fast, _ = self.call("go", *ends, "--speed", "15", "--climb", "2", "--wind", "8,270", "-o", "fast")
        self.assertIn("15 m/s, wind of 8 m/s from 270 deg", fast)
        scenario = (self.folder / "fast/scenario.yaml").read_text()
        self.assertIn("speed_mps: 15, climb_mps: 2, sink_mps: 2", scenario)
        self.assertIn("wind: {from_deg: 270, speed_mps: 8}", scenario)
        items = json.loads((self.folder / "fast/route.plan").read_text())["mission"]["items"]
        self.assertEqual([(one["command"], one["params"][1]) for one in items[:2]], [(22, 0), (178, 15)])
        minutes = [float(re.search(r"check: pass, .*? to ([0-9.]+) min", out)[1]) for out in (slow, fast)]
        self.assertLess(minutes[1], 0.75 * minutes[0])
        (self.folder / "less.param").write_text("AIRSPEED_MIN,18\nAIRSPEED_CRUISE,-5\n")
        (self.folder / "p.param").write_text("AIRSPEED_MIN,18\nAIRSPEED_CRUISE,22\nAIRSPEED_MAX,30\n")
        wing = ["--wing", "80", "--speed", "22"]
        out, _ = self.call("go", "--terrain", TERRAIN, *VALLEY, *wing, "--wind", "5,0", "-o", "unknown", code=1)
        self.assertIn("minimum airspeed, 9 m/s, is not judged: give its parameters (--params)", out)
        out, _ = self.call("go", "--terrain", TERRAIN, *VALLEY, *wing, "--params", "p.param", "-o", "wing")
        self.assertIn("check: pass", out)
        for options, code, said in ((["--wing", "30", "--speed", "40"], 3, "take a bank of 80 degrees"),
                                    (["--wind", "12,3"], 3, "not less than the speed, 10 m/s"),
                                    (["--wind", "12"], 2, "expected M/S,DEGREES"),
                                    (["--wind", "3,361"], 2, "expected M/S,DEGREES"),
                                    (["--params", "none.param"], 3, "none.param"),
                                    (["--wing", "80", "--speed", "22", "--params", "less.param"], 3,
                                     "less.param:2: parameter AIRSPEED_CRUISE: expected more than 0")):
            _, err = self.call("go", *ends, *options, "-o", "none", code=code)
            self.assertIn(said, err)
        self.assertFalse((self.folder / "none").exists())

    def test_zones_at_their_hours(self):
        self.zones("wall.geojson", *WALL, **{"from": "2026-05-01T10:00:00Z",
                                            "until": "2026-05-01T18:00:00Z"})
        options = ["--terrain", TERRAIN, *NEAR, "--avoid", "wall.geojson"]
        out, _ = self.call("go", *options, code=1)
        self.assertIn("no route: ", out)
        _, err = self.call("go", *options, "--start-time", "2026-05-01T20:00:00Z")
        self.assertIn("warning: 'wall.geojson' (zones) holds nothing here", err)

    def test_zones_that_do_and_do_not_count(self):
        far = box(-80.3, 36.54, 0.01)
        self.zones("two.geojson", box(-84.3, 36.54, 0.01), far)
        options = ["--terrain", TERRAIN, *ENDS, "--avoid"]
        out, err = self.call("go", *options, "two.geojson")
        self.assertIn("zones: two.geojson: 1 zones outside the bounds dropped", out)
        self.assertNotIn("warning", err)
        self.zones("swapped.geojson", [[y, x] for x, y in box(-84.3, 36.54, 0.01)])
        self.zones("far.geojson", far)
        self.zones("empty.geojson")
        _, err = self.call("go", *options, "far.geojson")
        self.assertIn("warning: 'far.geojson' (zones) holds nothing here", err)
        self.assertIn("they cover longitude -80.3 to -80.29 and latitude 36.54", err)
        self.call("go", *ENDS, "--terrain", TERRAIN, "-o", "plain")
        for command in (["go", *options, "swapped.geojson"],
                        ["check", "plain/route.plan", "--terrain", TERRAIN, "--airspace", "swapped.geojson"]):
            _, err = self.call(*command, code=3)
            self.assertIn("swapped.geojson: its zones lie here only with longitude and latitude exchanged", err)
        _, err = self.call("go", *options, "empty.geojson", code=3)
        self.assertIn("empty.geojson: contains no zone", err)

    def test_why_there_is_no_route(self):
        self.zones("wall.geojson", *WALL, name="Wall")
        self.zones("ring.geojson", box(-84.39, 36.47, 0.02), name="Prison")
        for options, said in (
                ([*ENDS, "--avoid", "wall.geojson", "ring.geojson"], r"reason: the start lies in 'Prison'"),
                ([*NEAR, "--avoid", "wall.geojson"], r"reason: the zones close every way: without them a route of "
                                                     r"6\.6\d* km is found, which enters 'Wall'\n"),
                ([*NEAR, "--min-agl", "50", "--max-agl", "52"],
                 r"reason: --max-agl is too low: up to 78 m a route of ")):
            out, _ = self.call("go", "--terrain", TERRAIN, *options, code=1)
            self.assertRegex(out, said)
        out, _ = self.call("go", "--terrain", TERRAIN, "--from", "-84.31,36.48", "--to",
                           "-84.25,36.54", "--max-agl", "120", "--planner", "rrt_star", code=1)
        self.assertIn("reason: --planner rrt_star: without it a route of ", out)
        self.assertEqual(sorted(file.name for file in (self.folder / "jacksboro_fault").iterdir()),
                         ["pipeline.yaml", "result.json", "scenario.yaml"])

    def test_tiles_in_a_folder_and_voids(self):
        (self.folder / "tiles").mkdir()
        for name, west in (("west", 8.0), ("east", 8.06)):
            text = grid(60, 60, west, 46.0, 0.001, lambda i, j: 10 < i < 14 and 30 < j < 50)
            (self.folder / "tiles" / f"{name}.asc").write_text(text)
        out = self.go("--terrain", "tiles", "--from", "8.012,46.02", "--to", "8.11,46.04",
                      "-o", "both", folder="both")
        self.assertIn("and 1 tile more", out)
        self.assertIn("filled from their neighbours", out)
        self.assertIn("read as EPSG:4326", out)
        self.assertIn("../tiles/west.asc", (self.folder / "both/scenario.yaml").read_text())
        _, err = self.call("go", "--terrain", "tiles/west.asc", "tiles/east.asc", "--from",
                           "8.012,46.021", "--to", "8.025,46.021")
        self.assertIn(" m of the route, with the start, lie over voids of the model", err)

    def test_a_tile_of_another_country(self):
        """It must not give the frame, in which the others would be resampled, each by itself."""
        for name, west in (("west", 8.0), ("east", 8.06)):
            (self.folder / f"{name}.asc").write_text(grid(60, 60, west, 46.0, 0.001))
        (self.folder / "utm.asc").write_text(grid(120, 90, 400000, 3790000, 30))
        (self.folder / "utm.prj").write_text(UTM)
        out = self.go("--terrain", "west.asc", "east.asc", "utm.asc", "--from", "8.012,46.02",
                      "--to", "8.11,46.04", "-o", "out", folder="out")
        self.assertIn("and 1 tile more, read as EPSG:4326; frame: EPSG:4326", out)

    def test_a_projected_model(self):
        (self.folder / "utm.asc").write_text(grid(120, 90, 400000, 3790000, 30))
        (self.folder / "utm.prj").write_text(UTM)
        self.go("--terrain", "utm.asc", "--from", "-118.080,34.252", "--to", "-118.055,34.268",
                folder="utm")
        self.call("check", "utm/route.plan", "--terrain", "utm.asc", "--min-agl", "50")

    def test_a_swiss_model(self):
        """Its projection does not give degrees back to the last digit; its sides are no parallels."""
        model = DATA / "dem/davosdorf.tif"
        if not model.exists():
            self.skipTest("no test data: set ALTIPLAN_TEST_DATA")
        ends = ["--from", "9.80155,46.8021", "--to", "9.85405,46.8343"]
        self.go("--terrain", str(model), *ends, "--via", "9.8128,46.8274", folder="davosdorf")
        _, err = self.call("go", "--terrain", str(model), "--from", "9.79105,46.81822", *ends[2:],
                           code=3)
        self.assertIn("but not all of that", err)

    def test_points_that_are_no_good(self):
        terrain = ["--terrain", TERRAIN]
        for given, said in (("36.48,-84.38", "-84.38,36.48 is inside: give longitude first\n"),
                            ("84.38,36.48", "-84.38,36.48 is inside"),
                            ("-84,38", "covers longitude -84.41333 to -84.07833 and latitude 36.4"),
                            ("-84.38,36.48,20", "--from: 20 m above ground is below --min-agl")):
            self.refused(said, *terrain, "--from", given, *ENDS[2:])
        for given in ("-84.38", "-84.38,36.48,1,1", "-84.38, 36.48", "x,y", "nan,36"):
            self.refused("expected LON,LAT", *terrain, "--from", given, *ENDS[2:], code=2)
        self.refused("--to: expected a way of 1 m or more from --from", *terrain, *ENDS[:2], "--to", "-84.38,36.48")
        self.refused("expected a time such as", *terrain, *ENDS, "--start-time", "2026-13-01")
        self.refused("from 0.0 to 10000.0", *terrain, *ENDS, "--min-agl", "100000", code=2)
        self.refused("from 1.0 to 5000.0", *terrain, *ENDS, "--wing", "30000", code=2)
        self.refused("leaves no height", *terrain, *ENDS, "--min-agl", "90", "--max-agl", "80")

    def test_files_that_are_no_good(self):
        (self.folder / "tiles.vrt").write_text("<VRTDataset/>")
        (self.folder / "word.dat").write_text("word")
        self.refused("is a VRT", "--terrain", "tiles.vrt", *ENDS)
        self.refused("--terrain: word.dat: expected an elevation model", "--terrain", "word.dat",
                     *ENDS)
        self.refused("--avoid: none.json", "--terrain", TERRAIN, *ENDS, "--avoid", "none.json")
        self.refused("--avoid: word.dat: expected zones: published airspace", "--terrain", TERRAIN,
                     *ENDS, "--avoid", "word.dat")
        self.zones("bow.geojson", [[-84.3, 36.5], [-84.2, 36.6], [-84.2, 36.5], [-84.3, 36.6],
                                   [-84.3, 36.55]])
        self.refused("--avoid: bow.geojson: features.0 ('0'): a ring must end where it starts", "--terrain",
                     TERRAIN, *ENDS, "--avoid", "bow.geojson")
        self.refused("no_planner", "--terrain", TERRAIN, *ENDS, "--planner", "no_planner")


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
