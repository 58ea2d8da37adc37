# SPDX-License-Identifier: Apache-2.0
"""export_test.py PROGRAM SOURCES: altiplan export and imported missions, as a user calls them.

Written files are read by independent readers: GDAL's ogr2ogr (skipped without it), Python's XML and
JSON modules, and ground_station.py."""
import csv
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import ground_station

PROGRAM, SOURCES = sys.argv[1:3]
SCENARIO = os.path.join(SOURCES, "configs", "scenarios", "jacksboro_ridge.yaml")
FORMATS = {"qgc-plan": "plan", "waypoints": "waypoints", "kml": "kml", "geojson": "geojson",
           "gpx": "gpx", "csv": "csv"}
KML = "{http://www.opengis.net/kml/2.2}"
SPEED = 178  # MAV_CMD_DO_CHANGE_SPEED: slower near obstacles
GPX = "{http://www.topografix.com/GPX/1/1}"


def altiplan(*arguments):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=600,
                          check=False)
    return done.returncode, done.stdout, done.stderr


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


class Flight(unittest.TestCase):
    """The example flight of the README, planned once."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.result = os.path.join(cls.folder, "result.json")
        pipeline = os.path.join(SOURCES, "configs", "pipelines", "ridge_crossing.yaml")
        code, _, err = altiplan("run", pipeline, "--out", cls.result)
        assert code == 0, err
        cls.route = json.loads(text_of(cls.result))["route_lonlat"]

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def export(self, to, *options):
        code, out, err = altiplan("export", self.result, "--to", to, *options)
        self.assertEqual(code, 0, err)
        self.assertIn("read back and judged: valid", err)
        return out

    def file(self, name, text):
        path = os.path.join(self.folder, name)
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
        return path

    def hold(self, points, places=7):
        """The points equal the route's to 1e-7 degrees and 1 cm."""
        self.assertEqual(len(points), len(self.route))
        for (lon, lat, height), (x, y, z) in zip(points, self.route):
            self.assertLessEqual(abs(lon - x), 1.01 * 10**-places)
            self.assertLessEqual(abs(lat - y), 1.01 * 10**-places)
            self.assertLessEqual(abs(height - z), 0.01)


class Export(Flight):
    def test_format_by_the_file(self):
        for to, extension in FORMATS.items():
            path = os.path.join(self.folder, f"by_extension.{extension}")
            self.assertEqual(altiplan("export", self.result, "-o", path)[0], 0)
            self.assertEqual(text_of(path), self.export(to))
        for options in ((), ("-o", os.path.join(self.folder, "route.dat"))):
            code, out, err = altiplan("export", self.result, *options)
            self.assertEqual((code, out), (2, ""))
            self.assertIn("--to is required, or an output file (-o) that ends in one of .plan, ", err)

    def test_plan(self):
        for altitude, frame, mode in (("sea", 0, 2), ("ground", 10, 4), ("home", 3, 1)):
            with self.subTest(altitude):
                plan = ground_station.plan(self.export("qgc-plan", "--altitude", altitude))
                items = plan["mission"]["items"]
                self.assertEqual([item["doJumpId"] for item in items],
                                 list(range(1, len(items) + 1)))
                items = [item for item in items if item["command"] != SPEED]
                self.assertEqual({item["frame"] for item in items}, {frame})
                self.assertEqual({item["AltitudeMode"] for item in items}, {mode})
                home = plan["mission"]["plannedHomePosition"]
                above = {"sea": 0, "home": home[2]}
                if altitude in above:
                    self.hold([(i["params"][5], i["params"][4], i["params"][6] + above[altitude])
                               for i in items])
                else:  # the scenario starts 200 m above ground, and ends there
                    self.assertAlmostEqual(items[0]["Altitude"], 200, 2)
                    self.assertGreaterEqual(min(item["Altitude"] for item in items), 150)

    def test_waypoints(self):
        for altitude in ("sea", "home"):
            rows = ground_station.waypoints(self.export("waypoints", "--altitude", altitude))
            self.assertEqual(rows[0][1:4], [1, 0, 16])  # home
            above = rows[0][10] if altitude == "home" else 0
            self.hold([(row[9], row[8], row[10] + above) for row in rows[1:]
                       if row[3] != SPEED])

    def test_commands(self):
        plan = ground_station.plan(self.export("qgc-plan", "--takeoff", "--land"))
        commands = [item["command"] for item in plan["mission"]["items"]]
        self.assertIn(SPEED, commands)
        self.assertEqual([c for c in commands if c != SPEED],
                         [22] + [16] * (len(self.route) - 1) + [21])
        rows = ground_station.waypoints(self.export("waypoints", "--takeoff", "--land"))
        self.assertEqual([row[3] for row in rows[1:]], commands)

    def test_xml(self):
        line = xml.etree.ElementTree.fromstring(self.export("kml")).find(f".//{KML}LineString")
        self.assertEqual(line.find(f"{KML}altitudeMode").text, "absolute")
        self.hold([tuple(map(float, p.split(",")))
                   for p in line.find(f"{KML}coordinates").text.split()])
        root = xml.etree.ElementTree.fromstring(self.export("gpx"))
        self.assertEqual(root.get("version"), "1.1")
        self.hold([(float(p.get("lon")), float(p.get("lat")), float(p.find(f"{GPX}ele").text))
                   for p in root.iter(f"{GPX}rtept")])
        ground = xml.etree.ElementTree.fromstring(self.export("kml", "--altitude", "ground"))
        self.assertEqual(ground.find(f".//{KML}altitudeMode").text, "relativeToGround")

    def test_tables(self):
        rows = list(csv.DictReader(self.export("csv", "--altitude", "home").splitlines()))
        self.assertEqual({row["altitude_frame"] for row in rows}, {"home"})
        self.hold([(float(r["longitude_deg"]), float(r["latitude_deg"]), float(r["z_m"]))
                   for r in rows])
        line = json.loads(self.export("geojson"))["features"][0]
        self.assertEqual(line["properties"]["altitude_frame"], "sea")
        self.hold(line["geometry"]["coordinates"])

    def test_flight(self):
        track = json.loads(text_of(self.result))["flight"]["track"]
        rows = list(csv.DictReader(self.export("csv", "--flight").splitlines()))
        self.assertEqual(len(rows), len(track))
        for row, (t, x, y, z) in zip(rows, track):
            for key, value in (("time_s", t), ("x_m", x), ("y_m", y), ("z_m", z)):
                self.assertAlmostEqual(float(row[key]), value, 3)

    def test_fewer_items(self):
        code, out, err = altiplan("export", self.result, "--to", "qgc-plan", "--max-items", "30")
        self.assertEqual(code, 0, err)
        self.assertEqual(len(ground_station.plan(out)["mission"]["items"]), 30)
        self.assertIn("points dropped", err)
        path = os.path.join(self.folder, "never.plan")
        code, out, err = altiplan("export", self.result, "--to", "qgc-plan", "--max-items", "2",
                                  "-o", path)
        self.assertEqual((code, out), (1, ""))
        self.assertIn("not written", err)
        self.assertFalse(os.path.exists(path))

    def test_wrong_usage(self):
        for options in (("--to", "shp"), ("--to", "gpx", "--altitude", "ground"), (),
                        ("--to", "kml", "--altitude", "home"), ("--to", "csv", "--land"),
                        ("--to", "kml", "--altitude", "flight-level"),
                        ("--to", "kml", "--max-items", "1")):
            code, out, err = altiplan("export", self.result, *options)
            self.assertEqual((code, out), (2, ""), options)
            self.assertNotEqual(err, "")
        code, _, err = altiplan("export", self.file("no.json", "[1]"), "--to", "kml")
        self.assertEqual(code, 3)
        self.assertIn("expected a result of format 1", err)
        code, _, err = altiplan("export", self.result, "--to", "kml", "-o",
                                os.path.join(self.folder, "none", "a.kml"))
        self.assertEqual(code, 3)
        self.assertIn("cannot write", err)

    def test_check_takes_every_format(self):
        for to, ending in FORMATS.items():
            for altitude in ("sea", "ground", "home"):
                if (to, altitude) in (("gpx", "ground"), ("gpx", "home"), ("kml", "home")):
                    continue
                path = os.path.join(self.folder, f"{altitude}.{ending}")
                self.export(to, "--altitude", altitude, "-o", path)
                code, out, err = altiplan("check", "--route", path, "--scenario", SCENARIO)
                self.assertEqual(code, 0, f"{to} {altitude}: {out} {err}")
                self.assertIn(f"valid: {len(self.route)} waypoints", out)

    def test_check_judges_what_others_wrote(self):
        rows = [line.split(",") for line in self.export("csv").splitlines()]
        column = rows[0].index("z_m")
        for row in rows[10:20]:
            row[column] = "100"
        path = self.file("low.csv", "\n".join(map(",".join, rows)))
        code, out, _ = altiplan("check", "--route", path, "--scenario", SCENARIO)
        self.assertEqual(code, 1)
        self.assertIn("not valid", out)


@unittest.skipUnless(shutil.which("ogr2ogr"), "no ogr2ogr (Debian: gdal-bin)")
class ByGdal(Flight):
    def lines(self, name, text, *layer):
        path = self.file(name, text)
        done = subprocess.run(
            ["ogr2ogr", "-f", "GeoJSON", "-lco", "COORDINATE_PRECISION=12", "--config",
             "GPX_ELE_AS_25D", "YES", path + ".out", path, *layer],
            capture_output=True, text=True, timeout=600, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        return [feature["geometry"]["coordinates"] for feature in
                json.loads(text_of(path + ".out"))["features"]
                if feature["geometry"]["type"] == "LineString"]

    def test_route_is_the_same(self):
        for to, name, layer in (("kml", "r.kml", ()), ("gpx", "r.gpx", ("routes",)),
                                ("geojson", "r.geojson", ())):
            with self.subTest(to):
                found = self.lines(name, self.export(to), *layer)
                self.assertEqual(len(found), 1)
                self.hold(found[0])


ZONES = """altiplan: 1
name: A town with zones
frame: {origin_lonlat: [25.0, 60.0]}
environment:
  - zones:
      list:
        - {id: mast, cylinder: {at_m: [2000, 2000], radius_m: 300}, ceiling_m: 900}
        - {id: plant & <park>, polygon: {outline_m: [[3000, 500], [3500, 500], [3500, 1200]]}}
        - {id: county, kind: keep_in,
           polygon: {outline_m: [[-500, -500], [5500, -500], [5500, 5500], [-500, 5500]]}}
volume: {min_m: [0, 0, 0], max_m: [5000, 5000, 400]}
vehicle: {radius_m: 5}
start: {at_m: [500, 500, 100]}
goal: {at_m: [4500, 4500, 100], tolerance_m: 5}
"""
PIPELINE = """altiplan: 1
scenario: town.yaml
steps:
  - plan: astar
    with: {cell_m: [100, 100, 50]}
"""


class Zones(Flight):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.result = os.path.join(cls.folder, "result.json")
        for name, text in (("town.yaml", ZONES), ("p.yaml", PIPELINE)):
            with open(os.path.join(cls.folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        code, _, err = altiplan("run", os.path.join(cls.folder, "p.yaml"), "--out", cls.result)
        assert code == 0, err
        cls.route = json.loads(text_of(cls.result))["route_lonlat"]

    def test_zones_go_out_and_come_back(self):
        code, out, err = altiplan("export", self.result, "--to", "qgc-plan")
        self.assertEqual(code, 0, err)
        self.assertIn("zone 'mast' is in the fence at every height", err)
        fence = ground_station.plan(out)["geoFence"]
        self.assertEqual([p["inclusion"] for p in fence["polygons"]], [False, True])
        self.assertEqual(len(fence["circles"]), 1)
        root = xml.etree.ElementTree.fromstring(self.export("kml"))
        names = [p.find(f"{KML}name").text for p in root.iter(f"{KML}Placemark")]
        self.assertEqual(names, ["route", "mast", "plant & <park>", "county"])
        for name, text in (("z.plan", out), ("z.kml", self.export("kml"))):
            self.file(name, text)
            back = ZONES[:ZONES.index("      list:")] + f"      file: {name}\n" + \
                ZONES[ZONES.index("volume:"):ZONES.index("start:")] + \
                f"mission: {name}\ngoal: {{tolerance_m: 5}}\n"
            path = self.file("back.yaml", back)
            code, out, err = altiplan("check", "--route", os.path.join(self.folder, name),
                                      "--scenario", path)
            self.assertEqual(code, 0, out + err)
            code, out, _ = altiplan("explain", os.path.join(self.folder, "p.yaml"), "--scenario",
                                    path)
            self.assertEqual(code, 0)
            self.assertIn("2 keep-out and 1 keep-in zones", out)
            self.assertIn(name + ": " + ("mission.items.0" if name == "z.plan" else "point 1"), out)

    def test_a_fence_file_of_its_own(self):
        fence = os.path.join(self.folder, "fence.waypoints")
        _, _, err = altiplan("export", self.result, "--to", "waypoints", "--fence", fence)
        self.assertIn("in the fence at every height", err)
        rows = [line.split("\t") for line in text_of(fence).splitlines()]
        self.assertEqual([row[3] for row in rows[1:]], ["5004", "5002", "5002", "5002"] + 4 * ["5001"])
        self.assertEqual([int(float(row[4])) for row in rows[1:]], [300, 3, 3, 3, 4, 4, 4, 4])
        back = ZONES[:ZONES.index("      list:")] + "      file: fence.waypoints\n" + ZONES[ZONES.index("volume:"):]
        _, out, _ = altiplan("explain", os.path.join(self.folder, "p.yaml"), "--scenario", self.file("b.yaml", back))
        self.assertIn("2 keep-out and 1 keep-in zones", out)


WING = """altiplan: 1
frame: {origin_lonlat: [25.0, 60.0]}
environment:
  - zones:
      list:
        - {id: mast, cylinder: {at_m: [2000, 2000], radius_m: 600}}
volume: {min_m: [0, 0, 0], max_m: [5000, 5000, 900]}
vehicle:
  radius_m: 5
  wing: {airspeed_mps: 20, bank_deg: 30, climb_deg: 8, sink_deg: 8}
start: {at_m: [500, 500, 300], heading_deg: 180}
goal: {at_m: [3500, 3500, 300], tolerance_m: 5}
"""


class Turns(unittest.TestCase):
    """A route of an aeroplane: a turn, and a straight leg that passes the zone."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        cls.scenario = os.path.join(cls.folder, "wing.yaml")
        cls.result = os.path.join(cls.folder, "result.json")
        with open(cls.scenario, "w", encoding="utf-8") as file:
            file.write(WING)
        pipeline = os.path.join(cls.folder, "p.yaml")
        with open(pipeline, "w", encoding="utf-8") as file:
            file.write("altiplan: 1\nscenario: wing.yaml\nsteps:\n  - plan: hybrid_astar\n")
        code, _, err = altiplan("run", pipeline, "--out", cls.result)
        assert code == 0, err
        cls.turns = sum(leg["kind"] == "arc" for leg in json.loads(text_of(cls.result))["legs"])
        assert cls.turns > 1

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_every_format_takes_points(self):
        for to, ending in FORMATS.items():
            path = os.path.join(self.folder, f"points.{ending}")
            code, _, err = altiplan("export", self.result, "--to", to, "-o", path)
            self.assertEqual(code, 0, err)
            self.assertIn("read back and judged: valid", err)
            self.assertIn("within 0.5 m of them", err)

    def test_loiters(self):
        code, out, err = altiplan("export", self.result, "--to", "qgc-plan", "--arcs", "loiter")
        self.assertEqual(code, 0, err)
        plan = ground_station.plan(out)["mission"]
        self.assertEqual(plan["vehicleType"], 1)
        loiters = [item for item in plan["items"] if item["command"] == 31]
        self.assertGreater(len(loiters), 0)
        self.assertIn(f" and {len(loiters)} loiter", err)
        for item in loiters:
            self.assertEqual((item["params"][0], item["params"][3]), (1, 1))
            self.assertGreaterEqual(abs(item["params"][1]), 70.6)
        code, out, err = altiplan("export", self.result, "--to", "waypoints", "--arcs", "loiter")
        self.assertEqual(code, 0, err)
        rows = ground_station.waypoints(out)
        self.assertEqual([row[4:8] for row in rows if row[3] == 31],
                         [item["params"][:4] for item in loiters])

    def test_wrong_usage(self):
        for options in (("--to", "kml", "--arcs", "loiter"),
                        ("--to", "qgc-plan", "--arcs", "loiter", "--altitude", "ground"),
                        ("--to", "qgc-plan", "--arcs", "circles")):
            code, out, err = altiplan("export", self.result, *options)
            self.assertEqual((code, out), (2, ""), options)
            self.assertIn("arcs", err)

    def test_check_reads_circles(self):
        """Straight, a climbing turn to the left, straight: as others write it."""
        path = os.path.join(self.folder, "turn.waypoints")
        rows = ["QGC WPL 110", "0\t1\t0\t16\t0\t0\t0\t0\t60\t25\t0\t1",
                "1\t0\t0\t16\t0\t0\t0\t0\t60.0044878\t25.0089610\t300\t1",
                "2\t0\t0\t31\t1\t-100\t0\t1\t60.0044878\t25.0300000\t320\t1",
                "3\t0\t0\t16\t0\t0\t0\t0\t60.0200000\t25.0317932\t320\t1"]
        with open(path, "w", encoding="utf-8") as file:
            file.write("\n".join(rows) + "\n")
        code, out, err = altiplan("check", "--route", path, "--scenario", self.scenario,
                                  "--log-level", "info")
        self.assertEqual(code, 1, err)  # it ends elsewhere, and begins with another heading
        self.assertIn("1 loiters read as circles", err)
        self.assertIn("4 waypoints", out)
        for leg in (1, 2):
            self.assertNotIn(f"waypoint {leg}, turn_radius", out)
        self.assertNotIn("climb", out)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
