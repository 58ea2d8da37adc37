# SPDX-License-Identifier: Apache-2.0
"""wind_grid_test.py PROGRAM SOURCES: wind by the cells of a file that GDAL wrote (skipped without its programs).

`python3 wind_grid_test.py PROGRAM SOURCES WindGrid.test_a_geotiff` runs one case."""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
SCENARIO = """altiplan: 1
environment: [{box: {min_m: [0, 0, -20], max_m: [10, 10, -10]}}]
%s
volume: {min_m: [0, 0, 0], max_m: [2000, 1500, 200]}
vehicle: {radius_m: 2, %s}
start: {at_m: START}
goal: {at_m: GOAL}
wind: {%s}
objective: {%s}
"""
WING = "wing: {airspeed_mps: 20}"
COPTER = "speed_mps: 12, energy: {measured: {level: [{airspeed_mps: 0, power_w: 300}, " \
    "{airspeed_mps: 10, power_w: 250}, {airspeed_mps: 30, power_w: 2500}], mass_kg: 2, efficiency: 0.7}}"
PIPELINE = """altiplan: 1
scenario: s.yaml
steps:
  - plan: astar
    with: {cell_m: [100, 100, 50]}
"""


def grib(*levels):
    """Of bands u, v by turns: section 4.1 of GRIB2, templates 4.0, momentum at pairs of an hour of the forecast of
    1970-01-01 and a height above the ground."""
    return ["-of", "GRIB", "-co", "DISCIPLINE=0", "-co", "PDS_PDTN=0"] + [
        option for n, (hour, height) in enumerate(levels) for band, parameter in ((2 * n + 1, 2), (2 * n + 2, 3))
        for option in ("-co", f"BAND_{band}_PDS_TEMPLATE_NUMBERS=2 {parameter} 2 0 96 0 0 0 1 0 0 0 {hour} 103 0 0 0 0 "
                              f"{height} 255 0 0 0 0 0")]


GRIB = grib((0, 10))


@unittest.skipUnless(shutil.which("gdal_translate"), "GDAL's programs are not installed")
class WindGrid(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        (self.folder / "p.yaml").write_text(PIPELINE)

    def gdal(self, *arguments):
        subprocess.run(arguments, cwd=self.folder, check=True, capture_output=True, timeout=120)

    def grid(self, name, *bands, corner=(0, 0), cell=500, options=(), system=()):
        """A file of these rows from the north."""
        files = [f"{n}.asc" for n in range(len(bands))]
        for file, rows in zip(files, bands):
            (self.folder / file).write_text(
                f"ncols {len(rows[0])}\nnrows {len(rows)}\nxllcorner {corner[0]}\nyllcorner {corner[1]}\n"
                f"cellsize {cell}\n" + "\n".join(" ".join(map(str, row)) for row in rows) + "\n")
        self.gdal("gdalbuildvrt", "-overwrite", "-q", *system, "-separate", "w.vrt", *files)
        self.gdal("gdal_translate", "-q", *options, "w.vrt", name)

    def altiplan(self, *arguments, code=0):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def scenario(self, wind, vehicle=WING, objective="time: {}", frame=""):
        self.text = SCENARIO % (frame, vehicle, wind, objective)
        self.between((50, 750, 100), (1950, 750, 100))

    def between(self, start, goal):
        (self.folder / "s.yaml").write_text(self.text.replace("START", str(list(start))).replace(
            "GOAL", str(list(goal))))

    def route(self):
        return json.loads((self.folder / "r.json").read_text())["steps"][-1]["route"]

    def cost(self, *points, code=0):
        """Of the route as judged."""
        self.between(points[0], points[-1])
        rows = "\n".join(",".join(map(str, point)) for point in points)
        (self.folder / "r.csv").write_text("x_m,y_m,z_m\n" + rows + "\n")
        said = self.altiplan("check", "--route", "r.csv", "--scenario", "s.yaml", "--json", code=code)
        return json.loads(said[:said.rindex("}") + 1])["cost"]

    def test_a_geotiff(self):
        self.grid("w.tif", [[5, -5, 0, 10], [0, 0, 0, 0], [0, 0, 0, 0]], [[0] * 4] * 3)
        self.scenario("grid: w.tif")
        self.assertAlmostEqual(self.cost((50, 1400, 100), (1950, 1400, 100)),
                               450 / 25 + 500 / 15 + 500 / 20 + 450 / 30, 6)
        self.assertAlmostEqual(self.cost((50, 700, 100), (1950, 700, 100)), 1900 / 20, 6)

    def test_a_geotiff_of_a_local_system(self):
        self.grid("w.tif", [[5, -5, 0, 10]] * 3, [[0] * 4] * 3)
        self.gdal("gdal_translate", "-q", "-mo", "AREA_OR_POINT=Point", "w.tif", "point.tif")
        for name, unit in (("local", 'LOCAL_CS["x",UNIT["metre",1]]'), ("feet", 'LOCAL_CS["x",UNIT["foot",0.3048]]')):
            self.gdal("gdal_translate", "-q", "-a_srs", unit, "w.tif", f"{name}.tif")
        for name in ("point", "local"):
            self.scenario(f"grid: {name}.tif")
            self.assertAlmostEqual(self.cost((50, 750, 100), (1950, 750, 100)),
                                   450 / 25 + 500 / 15 + 500 / 20 + 450 / 30, 6)
        self.scenario("grid: feet.tif")
        self.assertIn("is not in longitudes and latitudes", self.altiplan("run", "p.yaml", code=3))

    def test_a_leg_through_a_cell_that_is_too_windy_is_refused(self):
        self.grid("w.tif", [[0, 0, -21, 0]] + [[0] * 4] * 2, [[0] * 4] * 3)
        self.scenario("grid: w.tif")
        self.cost((50, 1400, 100), (1950, 1400, 100), code=1)
        self.cost((50, 900, 100), (1950, 900, 100))

    def test_grib(self):
        """One cell of it about the origin is wind from one direction."""
        east, north = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 10, 11, 12]], [[0] * 4, [0, -6, 0, 0], [0] * 4]
        self.grid("w.grb2", east, north, corner=(8, 47), cell=0.25, options=GRIB, system=("-a_srs", "EPSG:4326"))
        frame = "frame: {crs: local, origin_lonlat: [8.3, 47.3]}"
        ends = (50, 700, 100), (1950, 900, 100)
        self.scenario("grid: w.grb2", frame=frame)
        of_grid = self.cost(*ends)
        self.scenario(f"from_deg: 315, speed_mps: {math.hypot(6, 6)}", frame=frame)
        self.assertAlmostEqual(of_grid, self.cost(*ends), delta=0.02)  # east turns by 0.02 degrees
        self.scenario("grid: w.grb2, bands: [2, 1]", frame=frame)
        self.assertIn("band 2 is VGRD, expected UGRD", self.altiplan("run", "p.yaml", code=3))

    def test_borders_that_are_not_straight_over_the_volume_are_refused(self):
        """Meridians converge: by 300 km x 300 km tan(latitude) / (radius of the Earth) = 15 km in a corner."""
        frame = "frame: {crs: local, origin_lonlat: [8, 47]}"
        for cell, half_km, code in ((0.25, 20, 0), (0.01, 20, 0), (0.25, 100, 0), (0.01, 30, 3), (0.25, 300, 3)):
            with self.subTest(cell=cell, half_km=half_km):
                count = round(10 / cell) if half_km > 50 else round(1.2 / cell)
                self.grid("w.tif", *[[[0] * count] * count] * 2, corner=(8 - count * cell / 2, 47 - count * cell / 2),
                          cell=cell, system=("-a_srs", "EPSG:4326"))
                self.scenario("grid: w.tif", frame=frame)
                scenario = self.folder / "s.yaml"
                half = half_km * 1000
                scenario.write_text(scenario.read_text().replace(
                    "{min_m: [0, 0, 0], max_m: [2000, 1500, 200]}",
                    f"{{min_m: [-{half}, -{half}, 0], max_m: [{half}, {half}, 200]}}"))
                (self.folder / "r.csv").write_text("x_m,y_m,z_m\n50,750,100\n1950,750,100\n")
                said = self.altiplan("check", "--route", "r.csv", "--scenario", "s.yaml", code=code)
                self.assertEqual("wind.grid: " in said and "the volume is too large for its cells" in said, code == 3)

    def test_layers_of_grids(self):
        """A leg is timed by the cells of the layer that it is in; a layer without a grid may be among them."""
        none = [[0] * 4] * 3
        self.grid("low.tif", [[5, -5, 0, 10]] * 3, none)
        self.grid("high.tif", none, none, [[-5, 0, 5, 2]] * 3, none)
        self.scenario("layers: [{above_m: 0, grid: low.tif}, {above_m: 80, from_deg: 90, speed_mps: 4}, "
                      "{above_m: 120, grid: high.tif, bands: [3, 4]}]")
        for height, winds in ((50, (5, -5, 0, 10)), (100, (-4, -4, -4, -4)), (150, (-5, 0, 5, 2))):
            self.assertAlmostEqual(self.cost((50, 750, height), (1950, 750, height)),
                                   sum(run / (20 + wind) for run, wind in zip((450, 500, 500, 450), winds)), 6)
        # Up by 140 m in 1900: through the borders of layers at x = 50 + 1900 (50 / 140) and 50 + 1900 (90 / 140).
        first, second = 50 + 1900 * 50 / 140, 50 + 1900 * 90 / 140
        self.assertAlmostEqual(
            self.cost((50, 750, 30), (1950, 750, 170)),
            450 / 25 + (first - 500) / 15 + (second - first) / 16 + (1500 - second) / 25 + 450 / 22, 6)

    def test_grib_of_hours_and_heights(self):
        rows = [[[n] * 4] * 3 for n in range(8)]
        self.grid("w.grb2", *rows, corner=(8, 47), cell=0.25, options=grib((0, 10), (0, 80), (6, 10), (6, 80)),
                  system=("-a_srs", "EPSG:4326"))
        frame = "frame: {crs: local, origin_lonlat: [8.3, 47.3]}"

        def said(wind, code=3, more=""):
            self.scenario(wind, frame=frame + more)
            return self.altiplan("run", "p.yaml", code=code)
        self.assertIn("has 8 bands: give bands, the numbers of those toward east and north of one height and hour",
                      said("grid: w.grb2"))
        self.assertRegex(said("layers: [{above_m: 0, grid: w.grb2, bands: [1, 4]}]"),
                         r"s\.yaml:\d+:\d+: (scenario\.)?wind\.layers\.0\.grid: .*two heights, 10-HTGL and 80-HTGL")
        self.assertIn("two hours, 0 and 21600", said("grid: w.grb2, bands: [1, 6]"))
        layers = "layers: [{above_m: 0, grid: w.grb2, bands: [1, 2]}, {above_m: 80, grid: w.grb2, bands: [7, 8]}]"
        self.assertNotIn("other hours", said(layers, code=0))
        later = said(layers, 0, "\nstart_time: 1970-01-01T05:00:00Z")
        self.assertIn("wind.layers.0.grid: the wind is of 1970-01-01T00:00:00Z, the flight starts at "
                      "1970-01-01T05:00:00Z: wind.hours has winds of other hours", later)
        self.assertNotIn("wind.layers.1.grid", later)
        (self.folder / "r.csv").write_text("x_m,y_m,z_m\n50,750,100\n1950,750,100\n")
        self.assertIn("wind.layers.0.grid: the wind is of 1970-01-01T00:00:00Z",
                      self.altiplan("check", "--route", "r.csv", "--scenario", "s.yaml"))

    def test_grib_by_the_hour(self):
        rows = [[[n] * 4] * 3 for n in (5, 0, -5, 0)]
        self.grid("w.grb2", *rows, corner=(8, 47), cell=0.25, options=grib((0, 10), (3, 10)),
                  system=("-a_srs", "EPSG:4326"))
        frame = "frame: {crs: local, origin_lonlat: [8.3, 47.3]}\nstart_time: 1970-01-01T02:00:00Z"
        hours = "hours: [{from_time: 1970-01-01T00:00:00Z, grid: w.grb2, bands: [1, 2]}, " \
            "{from_time: 1970-01-01T02:00:40Z, grid: w.grb2, bands: [3, 4]}]"
        ends = (50, 750, 100), (1950, 750, 100)
        self.scenario(hours, frame=frame)
        self.assertAlmostEqual(self.cost(*ends), 40 + (1900 - 40 * 25) / 15, delta=0.02)
        self.assertNotIn("the wind is of", self.altiplan("run", "p.yaml"))
        self.scenario(hours.replace("bands: [3, 4]", "bands: [1, 2]").replace("02:00:40", "04:30:40"), frame=frame)
        self.assertIn("wind.hours.1.grid: the wind is of 1970-01-01T00:00:00Z, and is to blow from "
                      "1970-01-01T04:30:40Z on", self.altiplan("run", "p.yaml"))
        self.scenario(hours.replace("bands: [3, 4]", "bands: [3, 2]"), frame=frame)
        self.assertRegex(self.altiplan("run", "p.yaml", code=3), r"wind\.hours\.1\.grid: .*two hours")

    def test_routes_take_the_wind_behind(self):
        self.grid("w.tif", [[8] * 4, [-8] * 4, [-8] * 4], [[0] * 4] * 3)
        self.scenario("grid: w.tif", COPTER, "energy: {}")
        self.altiplan("run", "p.yaml", "-o", "r.json")
        route = self.route()
        self.assertGreater(max(y for _, y, _ in route), 1000)
        self.scenario("from_deg: 0, speed_mps: 0", COPTER, "energy: {}")
        self.altiplan("run", "p.yaml", "-o", "r.json")
        route = self.route()
        self.assertEqual({y for _, y, _ in route}, {750})

    def test_refusals(self):
        def refusal(wind):
            self.scenario(wind)
            return self.altiplan("run", "p.yaml", code=3)
        self.grid("small.tif", [[0] * 3] * 3, [[0] * 3] * 3)
        self.assertIn("does not cover the volume", refusal("grid: small.tif"))
        self.grid("fast.tif", [[200] * 4] * 3, [[0] * 4] * 3)
        self.assertIn("has no wind of up to 150 m/s", refusal("grid: fast.tif"))
        self.grid("utm.tif", [[0] * 4] * 3, [[0] * 4] * 3, system=("-a_srs", "EPSG:32632"))
        self.assertIn("is not in longitudes and latitudes", refusal("grid: utm.tif"))
        self.grid("lonlat.tif", [[0] * 4] * 3, [[0] * 4] * 3, corner=(8, 47), cell=0.25,
                  system=("-a_srs", "EPSG:4326"))
        self.assertIn("no place on the Earth", refusal("grid: lonlat.tif"))
        system = 'GEOGCS["x",DATUM["x",SPHEROID["x",%s,298]],PRIMEM["x",%s],UNIT["x",%s]]'
        degree = math.radians(1)
        for name, values in (("paris", (6378137, 2.33722917, degree)), ("grad", (6378137, 0, math.pi / 200)),
                             ("radian", (6378137, 0, 1)), ("moon", (1737400, 0, degree))):
            self.gdal("gdal_translate", "-q", "-a_srs", system % values, "lonlat.tif", f"{name}.tif")
            self.assertIn("is not in degrees of the Earth from Greenwich", refusal(f"grid: {name}.tif"))
        for system in ('GEOGCS["x",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],PRIMEM["Greenwich",0],'
                       'UNIT["grad",0.015707963267949]]', "EPSG:4807"):
            self.gdal("gdal_translate", "-q", "-a_srs", system, "lonlat.tif", "hidden.tif")
            self.assertIn("is not in degrees of the Earth from Greenwich", refusal("grid: hidden.tif"))
        self.gdal("gdal_translate", "-q", "-a_srs", "+proj=longlat +R=6371229", "lonlat.tif", "sphere.tif")
        self.assertIn("no place on the Earth", refusal("grid: sphere.tif"))
        self.gdal("gdal_translate", "-q", "-b", "1", "lonlat.tif", "one.tif")
        self.assertIn("has one band, expected two", refusal("grid: one.tif"))
        self.assertIn("bands are the same twice", refusal("grid: small.tif, bands: [1, 1]"))
        for name, said, options in (("scaled.tif", "band 1 has a scale or an offset", ("-a_scale", "10")),
                                    ("moved.tif", "band 1 has a scale or an offset", ("-a_offset", "1")),
                                    ("complex.tif", "holds complex numbers", ("-ot", "CFloat32")),
                                    ("large.tif", "has more than 4000000 cells", ("-outsize", "3000", "2000"))):
            self.gdal("gdal_translate", "-q", *options, "small.tif", name)
            self.assertIn(said, refusal(f"grid: {name}"))
        self.gdal("gdal_translate", "-q", "--config", "GDAL_TIFF_INTERNAL_MASK", "YES", "-mask", "1", "-b", "1", "-b", "2",
                  "small.tif", "masked.tif")
        self.assertIn("band 1 has a mask", refusal("grid: masked.tif"))
        self.gdal("gdal_translate", "-q", "-of", "VRT", "small.tif", "knots.vrt")
        knots = self.folder / "knots.vrt"
        knots.write_text(knots.read_text().replace("<ColorInterp>Gray", "<UnitType>kt</UnitType><ColorInterp>Gray"))
        self.gdal("gdal_translate", "-q", "knots.vrt", "knots.tif")
        self.assertIn("band 1 is in 'kt', expected m/s", refusal("grid: knots.tif"))
        self.assertIn("has no band 3", refusal("grid: small.tif, bands: [1, 3]"))
        (self.folder / "none.tif").write_text("nothing")
        self.assertIn("none.tif", refusal("grid: none.tif"))
        self.assertIn("expected from_deg and speed_mps, or layers, or grid",
                      refusal("grid: small.tif, from_deg: 3, speed_mps: 3"))
        self.assertIn("expected bands with grid", refusal("bands: [1, 2]"))
        self.assertIn("wind.layers: expected at least 1", refusal("grid: small.tif, layers: []"))
        self.assertIn("expected from_deg and speed_mps, or grid", refusal("layers: [{above_m: 0}]"))
        self.assertIn("expected from_deg and speed_mps, or grid",
                      refusal("layers: [{above_m: 0, grid: small.tif, from_deg: 3, speed_mps: 3}]"))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]] + sys.argv[3:])
