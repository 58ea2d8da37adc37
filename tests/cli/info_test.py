# SPDX-License-Identifier: Apache-2.0
"""info_test.py PROGRAM SOURCES: `altiplan info`, what a file holds."""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile

PROGRAM, SOURCES = sys.argv[1:3]
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
OPENAIR = """AC R
AN Test
AL 300m MSL
AH 900m MSL
DP 46:10:00 N 008:10:00 E
DP 46:20:00 N 008:10:00 E
DP 46:20:00 N 008:20:00 E
"""


class Info(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def info(self, *files, code=0):
        run = subprocess.run([PROGRAM, "info", *files], cwd=self.folder, capture_output=True,
                             text=True, timeout=600)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout if code == 0 else run.stdout + run.stderr

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def test_a_sequence_of_buildings(self):
        faces = [[3, 2, 1, 0], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
        corners = [[x, y, z] for z in (0, 9000) for x, y in ((0, 0), (8000, 0), (8000, 8000), (0, 8000))]
        lines = [{"type": "CityJSON", "version": "2.0", "CityObjects": {}, "vertices": [],
                  "metadata": {"referenceSystem": "https://www.opengis.net/def/crs/EPSG/0/2056"},
                  "transform": {"scale": [0.001] * 3, "translate": [2600000, 1200000, 400]}},
                 {"type": "CityJSONFeature", "id": "house", "vertices": corners,
                  "CityObjects": {"house": {"type": "Building", "geometry": [
                      {"type": "Solid", "lod": "1", "boundaries": [[[face] for face in faces]]}]}}}]
        file = self.write("bern.city.jsonl", "".join(json.dumps(line) + "\n" for line in lines))
        out = self.info(file)
        self.assertIn("city model", out)
        self.assertIn("1 prisms", out)

    def test_names_may_be_in_capitals(self):
        area = ("<kml><Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>8,46 8.1,46 8.1,46.1 8,46"
                "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>")
        self.assertIn("1 keep-out zone", self.info(self.write("AREA.KML", area)))
        solid = ("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                 "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n")
        self.assertIn("4 triangles", self.info(self.write("ROCK.OBJ", solid)))

    def test_a_table_of_litchi_is_a_mission(self):
        table = self.write("litchi.csv", "latitude,longitude,altitude(m),altitudemode\n46,8,50,0\n46.1,8,60,0\n")
        self.assertIn("2 items: 2 waypoints", self.info(table))
        line = ("<kml><Placemark><LineString><altitudeMode>absolute</altitudeMode><coordinates>8,46,900 8.1,46,900"
                "</coordinates></LineString></Placemark></kml>")
        self.assertIn("2 items: 2 waypoints", self.info(self.write("waylines.wpml", line)))

    def test_an_elevation_model(self):
        out = self.info(TERRAIN)
        for said in (": elevation model\n", "403 x 344 posts", "236 to 1076 m, no voids",
                     "in EPSG:4326 (WGS 84): x -84.4", "longitude -84.4133 to -84.0783",
                     "- terrain: {file: ", "volume: {min_m: [0, 0, 236]", "cell_m: [200, 200, 30]"):
            self.assertIn(said, out)

    def model(self, west, south=-18, cell=0.1):
        rows = "\n".join(" ".join(str(100 + row * column % 7) for column in range(31))
                         for row in range(31))
        return self.write("model.asc", f"ncols 31\nnrows 31\nxllcorner {west}\nyllcorner {south}\n"
                          f"cellsize {cell}\n{rows}\n")

    def go(self, *arguments):
        run = subprocess.run([PROGRAM, "go", "--terrain", "model.asc", "-o", "out", *arguments],
                             cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, 3, run.stdout + run.stderr)
        return run.stderr

    def test_a_model_across_the_antimeridian(self):
        said = self.info(self.model(178.45))
        self.assertIn("x 178.500000 to 181.500000,", said)
        self.assertRegex(said, "longitude 178\\.5[0-9]* to 181\\.[45][0-9]*,")
        self.assertRegex(said, "scale error at most 0\\.[0-9]+ %")
        said = self.go("--from", "12,-16", "--to", "179,-16")
        self.assertIn("covers longitude 178.5 to 181.5 and latitude -17.95 to -14.95", said)
        self.model(270)
        said = self.go("--from", "-88,-16", "--to", "271.5,-16")
        self.assertIn("--to: expected a longitude from -180 to 180, found 271.5: give -88.5", said)

    def test_a_model_of_the_world(self):
        rows = "\n".join(" ".join(str(100 + column // 9) for column in range(360)) for _ in range(180))
        self.write("model.asc", f"ncols 360\nnrows 180\nxllcorner -180\nyllcorner -90\ncellsize 1\n{rows}\n")
        said = self.info("model.asc")
        for words in ("360 x 180 posts", "longitude -179.5 to 179.5, latitude -89.5 to 89.5",
                      "not read whole, but about a flight: "):
            self.assertIn(words, said)
        for lon in (-170.3, -8.2, 8.2, 170.3):
            line = json.dumps({"type": "Feature", "properties": {}, "geometry": {
                "type": "LineString", "coordinates": [[lon, 46, 300], [lon + 0.01, 46, 300]]}})
            run = subprocess.run([PROGRAM, "check", self.write("m.geojson", line), "--terrain", "model.asc", "--crs",
                                  "EPSG:4326", "--json"],
                                 cwd=self.folder, capture_output=True, text=True, timeout=600)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            above = json.loads(run.stdout)["metrics"]["min_ground_clearance_m"]
            self.assertLess(abs(200 - (lon + 180) // 9 - above), 2)
        said = self.go("--from", "8,89.9", "--to", "8.1,46", "--crs", "EPSG:4326")
        self.assertIn("longitude 8, latitude 89.9 is outside the elevation model", said)

    def test_a_coordinate_system_is_asked_for_only_where_it_is_the_cause(self):
        said = self.info(self.model(500000, 5000000, 25), code=3)
        self.assertIn("the file names no coordinate system: give --crs EPSG:CODE", said)
        broken = self.write("model.asc", pathlib.Path(self.folder / self.model(8)).read_text()
                            .replace("\n100 101", "\n100 x"))
        said = self.info(broken, code=3)
        self.assertNotIn("--crs", said)
        said = self.info("--crs", "EPSG:32632", TERRAIN, code=3)
        self.assertIn("has its own coordinate system (WGS 84), but crs is EPSG:32632", said)

    def test_json(self):
        found = json.loads(self.info("--json", TERRAIN, self.write("zones.txt", OPENAIR)))
        self.assertEqual([one["kind"] for one in found], ["elevation model", "published airspace"])
        self.assertTrue(any("403 x 344 posts" in fact for fact in found[0]["facts"]))

    def test_what_it_suggests_is_a_scenario(self):
        lines = self.info(TERRAIN).split("in a scenario:\n")[1].splitlines()
        text = "altiplan: 1\n" + "\n".join(line[4:] for line in lines) + """
start: {at_lonlat: [-84.38, 36.48], above_ground_m: 60}
goal: {at_lonlat: [-84.2, 36.6], above_ground_m: 60}
"""
        self.write("scenario.yaml", text)
        run = subprocess.run([PROGRAM, "validate", "scenario.yaml"], cwd=self.folder, text=True,
                             capture_output=True, timeout=600)
        self.assertEqual(run.returncode, 0, run.stderr)

    def test_airspace(self):
        out = self.info(self.write("zones.txt", OPENAIR))
        for said in ("zones.txt: published airspace", "OpenAir: 1 zones", "keep out (closed): 1 R",
                     "lower limits: 1 above sea level", "0 zones with hours",
                     "longitude 8.166667 to 8.333333", '- zones: {file: "zones.txt"}'):
            self.assertIn(said, out)

    def test_features(self):
        ring = [[8, 46], [8.1, 46], [8.1, 46.1], [8, 46]]

        def features(**properties):
            return json.dumps({"type": "FeatureCollection", "features": [
                {"type": "Feature", "properties": properties,
                 "geometry": {"type": "Polygon", "coordinates": [ring]}}]})
        out = self.info(self.write("zones.geojson", features(floor_m=100)))
        self.assertIn("zones.geojson: zones", out)
        self.assertIn("floor_property: floor_m", out)
        self.assertIn("the property 'floor_m' is read as metres above sea level", out)
        self.assertIn("buildings", self.info(self.write("town.geojson", features(height=9))))

    def test_maps_and_missions(self):
        out = self.info(self.write("a.map", "type octile\nheight 2\nwidth 3\nmap\n..@\n...\n"))
        self.assertIn("a.map: grid map", out)
        self.assertIn("3 x 2 x 1 cells of its own", out)
        line = "1\t0\t3\t16\t0\t0\t0\t0\t46.1\t8.1\t50\t1\n"
        home = "0\t1\t0\t16\t0\t0\t0\t0\t46\t8\t400\t1\n"
        out = self.info(self.write("m.waypoints", "QGC WPL 110\n" + home + line))
        for said in ("m.waypoints: mission", "1 item: 1 waypoints", "50 to 50 m above home",
                     'mission: "m.waypoints"'):
            self.assertIn(said, out)

    def check(self, name, *options, code):
        run = subprocess.run([PROGRAM, "check", name, "--terrain", TERRAIN, "--json", *options], cwd=self.folder,
                             capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stderr if code == 3 else json.loads(run.stdout)

    def test_why_there_is_no_route(self):
        def kml(text):
            return f"<kml xmlns:gx='g' xmlns:wpml='w'><Document>{text}</Document></kml>"

        def gpx(text):
            return f"<gpx>{text}</gpx>"

        def czml(*positions):
            packets = [{"id": str(n), "position": position} for n, position in enumerate(positions)]
            return json.dumps([{"id": "document", "version": "1.0"}, *packets])

        def point(name, lon):
            return f'<{name} lat="36.6" lon="{lon}"><ele>1500</ele></{name}>'
        track = "<Placemark><gx:Track><gx:coord>-84.3 36.6 1500</gx:coord></gx:Track></Placemark>"
        line = ("<Placemark><LineString><altitudeMode>absolute</altitudeMode><coordinates>-84.3,36.6,1500 "
                "-84.2,36.6,1500</coordinates></LineString></Placemark>")
        spot = "<Placemark><Point><coordinates>-84.3,36.6</coordinates></Point></Placemark>"
        flown = {"cartographicDegrees": [0, -84.3, 36.6, 1500, 9, -84.2, 36.6, 1500]}
        places = [[-84.3, 36.6, 1500], [-84.2, 36.6, 1500]]
        route = f'<rte>{point("rtept", -84.3)}{point("rtept", -84.29)}</rte>'
        pieces = "".join(f'<trkseg>{point("trkpt", west)}{point("trkpt", west + 0.01)}</trkseg>' for west in (-84.3, -84.2))
        for name, text, said in (
                ("track.kml", kml(track), "a gx:Track records a flight"),
                ("line_and_track.kml", kml(line + track), "a gx:Track records a flight"),
                ("template.kml", kml("<wpml:templateType>waypoint</wpml:templateType>" + spot), "a template of DJI"),
                ("lines.geojson", json.dumps({"type": "MultiLineString", "coordinates": [places, places[::-1]]}),
                 "expected one LineString as the route, found more"),
                ("two.czml", czml(flown, flown), "expected one packet with positions"),
                ("curve.czml", czml({**flown, "interpolationAlgorithm": "LAGRANGE", "interpolationDegree": 5}),
                 "found the interpolation LAGRANGE"),
                ("both.gpx", gpx(route + f"<trk>{pieces}</trk>"), "expected one rte or trk as the route, found 2"),
                ("pieces.gpx", gpx(f"<trk>{pieces}</trk>"), "expected a trk of one piece"),
                ("places.gpx", gpx(point("wpt", -84.3) * 2), "found places (wpt) alone: 2")):
            with self.subTest(name):
                self.assertIn(said, self.check(self.write(name, text), code=3))
                self.assertIn(said, self.info(name))
        for name, text, said in (
                ("twice.kml", kml(line.replace("</altitudeMode>", "</altitudeMode><altitudeMode>clampToGround"
                                               "</altitudeMode>")), "expected one element 'altitudeMode', found more"),
                ("offset.kml", kml(line.replace("<LineString>", "<LineString><gx:altitudeOffset>-1400"
                                                "</gx:altitudeOffset>")), "a gx:altitudeOffset is not read"),
                ("ring.kml", kml(line + line.replace("LineString", "LinearRing")), "a LinearRing by itself"),
                ("twice.gpx", gpx(route.replace("</ele>", "</ele><ele>9</ele>")), "expected one element 'ele'")):
            with self.subTest(name):
                self.assertIn(said, self.check(self.write(name, text), code=3))
        with zipfile.ZipFile(self.folder / "two.kmz", "w") as archive:
            archive.writestr("a.kml", kml(line))
            archive.writestr("b.kml", kml(line))
        self.assertIn("expected one .kml in the archive, found more", self.check("two.kmz", code=3))
        for options in ([], ["--agl", "50"]):
            self.assertIn("a template of DJI", self.check("template.kml", *options, code=3))
        one = self.check(self.write("one.gpx", gpx(f'<rte>{point("rtept", -84.3)}</rte>')), code=1)
        self.assertEqual(one["verdict"], "not_judged")
        self.assertEqual(self.check(self.write("bare.geojson", json.dumps(
            {"type": "LineString", "coordinates": places})), code=0)["metrics"]["waypoints"], 2)

    def test_a_text_in_parts_is_one(self):
        for between in ("<!-- a -->", "<?b?>", "<![CDATA[ ]]>"):
            with self.subTest(between):
                line = f"<coordinates>-84.3,36.6,1500 -84.25{between.strip() if '?' in between else ''},36.6,1500 {between} -84.2,36.6,1500</coordinates>"
                text = f"<kml><Placemark><LineString><altitudeMode>abs{between if '!--' in between else ''}olute</altitudeMode>{line}</LineString></Placemark></kml>"
                checked = self.check(self.write("parts.kml", text), code=0)
                self.assertEqual(checked["metrics"]["waypoints"], 3)
        ring = "-84.26,36.55,0 -84.24,36.55,0 <!-- c --> -84.24,36.65,0 -84.26,36.65,0 -84.26,36.55,0"
        self.write("zone.kml", "<kml><Placemark><Polygon><outerBoundaryIs><LinearRing><coordinates>" + ring +
                   "</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></kml>")
        failed = self.check("parts.kml", "--airspace", "zone.kml", code=1)
        self.assertEqual({each["layer"] for each in failed["violations"]}, {"zone.kml"})

    def test_a_mission_from_south_to_north(self):
        def rows(summit):
            return "\n".join(" ".join("400" if summit and (row, column) == (40, 50) else "100" for column in range(101))
                             for row in range(101))
        self.write("north.asc", f"ncols 101\nnrows 101\nxllcorner 27\nyllcorner 53\ncellsize 0.01\n{rows(False)}\n")
        self.write("summit.asc", f"ncols 101\nnrows 101\nxllcorner 27\nyllcorner 53\ncellsize 0.01\n{rows(True)}\n")
        self.write("north.gpx", '<gpx><rte><rtept lat="53.05" lon="27.505"><ele>300</ele></rtept>'
                   '<rtept lat="53.95" lon="27.505"><ele>300</ele></rtept></rte></gpx>')
        run = subprocess.run([PROGRAM, "check", "north.gpx", "--terrain", "north.asc", "--terrain", TERRAIN, "--crs",
                              "EPSG:4326", "--json"], cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
        over = subprocess.run([PROGRAM, "check", "north.gpx", "--terrain", "summit.asc", "--crs", "EPSG:4326"],
                              cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(over.returncode, 1, "the summit is cut")
        notes = json.loads(run.stdout)["notes"]
        self.assertTrue(any(note.startswith("terrain: ") for note in notes))
        self.assertFalse(any(note.startswith("terrain 2: ") for note in notes), "a model of another region is read")

    def test_how_a_mission_is_flown(self):
        lines = ["0\t1\t0\t16\t0\t0\t0\t0\t46\t8\t400\t1", "1\t0\t3\t22\t0\t0\t0\t0\t46\t8\t50\t1",
                 "2\t0\t3\t16\t0\t0\t0\t0\t46.1\t8\t80\t1", "3\t0\t3\t18\t1\t0\t50\t0\t46.1\t8\t80\t1"]
        out = self.info(self.write("m.waypoints", "\n".join(["QGC WPL 110", *lines, ""])))
        self.assertRegex(out, r"length 11\.1\d\d km")  # 0.1 degrees of latitude
        # 11.1 km at 10 m/s, and the take-off.
        minutes = re.search(r"flown by ArduPilot copter: ([\d.]+) to ([\d.]+) min, \d+ to 80 m above home", out)
        self.assertTrue(18.2 < float(minutes[1]) < float(minutes[2]) < 24, out)
        self.assertIn("item 3 (loiter) PX4 copter refuses", out)

    def test_files_of_other_kinds(self):
        out = self.info("none.tif", self.write("word.dat", "word"), TERRAIN, code=3)
        self.assertIn("altiplan: none.tif: there is no such file", out)
        self.assertIn("altiplan: word.dat: expected an elevation model", out)
        self.assertIn("studies read it", self.info(self.write("a.map.scen", "version 1\n"), code=3))
        self.assertIn("is a VRT", self.info(self.write("a.vrt", "<VRTDataset/>"), code=3))
        self.assertIn("403 x 344 posts", out)  # the others are read all the same


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
