# SPDX-License-Identifier: Apache-2.0
"""formats_test.py PROGRAM SOURCES: routes in the formats of DJI, Litchi, Google Earth, Cesium and ROS.

Each file is read by Python's zipfile, xml, json, csv and struct alone, and its positions, heights and times
compared with the route and with the times of altiplan's own table."""
import csv
import io
import json
import os
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree
import zipfile

PROGRAM, SOURCES = sys.argv[1:3]
TERRAIN = os.path.join(SOURCES, "configs", "data", "jacksboro_fault.tif")
KML = "{http://www.opengis.net/kml/2.2}"
WPML = "{http://www.dji.com/wpmz/1.0.2}"
GPX = "{http://www.topografix.com/GPX/1/1}"
START = 1777629600  # 2026-05-01T10:00:00Z


def altiplan(*arguments, code=0):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, timeout=600, check=False)
    err = done.stderr.decode()
    assert done.returncode == code, f"{arguments}: {done.returncode}, not {code}: {err}"
    return done.stdout, err


def tree_of(data):
    return xml.etree.ElementTree.fromstring(data)


def mcap_records(data):
    """(opcode, content) of each record of a file without chunks, by https://mcap.dev/spec."""
    magic = b"\x89MCAP0\r\n"
    assert data.startswith(magic) and data.endswith(magic)
    at = len(magic)
    while at < len(data) - len(magic):
        opcode, size = struct.unpack_from("<BQ", data, at)
        yield opcode, data[at + 9:at + 9 + size]
        at += 9 + size
    assert at == len(data) - len(magic)


class Cdr:
    """Little-endian CDR, whose values are aligned to their size from behind the encapsulation."""

    def __init__(self, data):
        assert data[:4] == b"\0\1\0\0"
        self.data, self.at = data[4:], 0

    def next(self, code):
        size = struct.calcsize(code)
        self.at += -self.at % size
        value, = struct.unpack_from("<" + code, self.data, self.at)
        self.at += size
        return value

    def header(self):
        seconds = self.next("i") + self.next("I") * 1e-9
        size = self.next("I")
        frame = self.data[self.at:self.at + size]
        self.at += size
        return seconds, frame


class Formats(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp()
        scenario = os.path.join(cls.folder, "timed.yaml")
        with open(os.path.join(SOURCES, "configs", "scenarios", "jacksboro_ridge.yaml"), encoding="utf-8") as file:
            text = file.read().replace("../data/", os.path.join(SOURCES, "configs", "data") + "/")
        with open(scenario, "w", encoding="utf-8") as file:
            file.write(text + "start_time: 2026-05-01T10:00:00Z\n")
        cls.result = os.path.join(cls.folder, "result.json")
        altiplan("run", os.path.join(SOURCES, "configs", "pipelines", "ridge_crossing.yaml"), "--scenario",
                 scenario, "--out", cls.result)
        with open(cls.result, encoding="utf-8") as file:
            cls.json = json.load(file)
        cls.route = cls.json["route_lonlat"]
        table = csv.DictReader(io.StringIO(altiplan("export", cls.result, "--to", "csv")[0].decode()))
        cls.times = [float(row["time_s"]) for row in table]
        plan = json.loads(altiplan("export", cls.result, "--to", "qgc-plan")[0])
        cls.home = plan["mission"]["plannedHomePosition"]  # latitude, longitude, height above sea level
        cls.speeds = []  # on the way to each point
        speed = plan["mission"]["cruiseSpeed"]
        for item in plan["mission"]["items"]:
            if item["command"] == 178:
                speed = item["params"][1]
            else:
                cls.speeds.append(speed)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def export(self, to, *options):
        out, err = altiplan("export", self.result, "--to", to, *options)
        self.assertIn("read back and judged: valid", err)
        return out, err

    def equal(self, points, places=7, metres=0.0011):
        self.assertEqual(len(points), len(self.route))
        for here, there in zip(points, self.route):
            for axis in range(2):
                self.assertLessEqual(abs(here[axis] - there[axis]), 0.51 * 10**-places)
            self.assertLessEqual(abs(here[2] - there[2]), metres)

    def equal_times(self, times, seconds=0.0011):
        self.assertEqual(len(times), len(self.times))
        for here, there in zip(times, self.times):
            self.assertLessEqual(abs(here - there), seconds)

    def test_wpml(self):
        out, err = self.export("wpml")
        self.assertIn(f"take off at {self.home[2]:.1f} m above sea level", err)
        with zipfile.ZipFile(io.BytesIO(out)) as archive:
            self.assertIsNone(archive.testzip())
            self.assertEqual(archive.namelist(), ["wpmz/template.kml", "wpmz/waylines.wpml"])
            template, waylines = (tree_of(archive.read(name)) for name in archive.namelist())
        lat, lon, ellipsoid = map(float, template.find(f".//{WPML}takeOffRefPoint").text.split(","))
        self.assertAlmostEqual(lat, self.home[0], 7)
        self.assertAlmostEqual(lon, self.home[1], 7)
        ground = float(template.find(f".//{WPML}takeOffRefPointAGLHeight").text)
        self.assertAlmostEqual(ground, self.home[2], 3)
        self.assertTrue(-33 < ellipsoid - ground < -28)  # the geoid in Tennessee, by EGM96
        folder, = waylines.iter(f"{KML}Folder")
        self.assertEqual(folder.find(f"{WPML}executeHeightMode").text, "relativeToStartPoint")
        points, speeds = [], []
        for number, mark in enumerate(folder.iter(f"{KML}Placemark")):
            self.assertEqual(int(mark.find(f"{WPML}index").text), number)
            self.assertEqual(mark.find(f".//{WPML}waypointTurnMode").text,
                             "toPointAndStopWithDiscontinuityCurvature")
            lon, lat = map(float, mark.find(f"{KML}Point/{KML}coordinates").text.split(","))
            points.append([lon, lat, ground + float(mark.find(f"{WPML}executeHeight").text)])
            speeds.append(float(mark.find(f"{WPML}waypointSpeed").text))
        self.equal(points)
        self.assertEqual(speeds[:-1], self.speeds[1:])
        self.assertEqual(waylines.find(f".//{WPML}finishAction").text, "noAction")

    def test_litchi(self):
        out, err = self.export("litchi")
        self.assertIn(f"take off at {self.home[2]:.1f} m above sea level", err)
        self.assertIn("Litchi flies legs of at most 1,999 m", err)
        self.assertIn("Litchi flies at most 15 m/s", err)
        rows = list(csv.DictReader(io.StringIO(out.decode())))
        self.assertEqual(len(rows[0]), 46)
        self.equal([[float(row["longitude"]), float(row["latitude"]),
                     self.home[2] + float(row["altitude(m)"])] for row in rows])
        self.assertEqual({row["altitudemode"] for row in rows}, {"0"})  # above the place of take-off
        self.assertEqual([float(row["speed(m/s)"]) for row in rows][:-1], self.speeds[1:])

    def test_kmz(self):
        with zipfile.ZipFile(io.BytesIO(self.export("kmz")[0])) as archive:
            self.assertIsNone(archive.testzip())
            self.assertEqual(archive.namelist(), ["doc.kml"])
            root = tree_of(archive.read("doc.kml"))
        line = root.find(f".//{KML}LineString/{KML}coordinates").text.split()
        self.equal([list(map(float, place.split(","))) for place in line])
        marks = [mark for mark in root.iter(f"{KML}Placemark") if mark.find(f"{KML}Point") is not None]
        self.equal([list(map(float, mark.find(f"{KML}Point/{KML}coordinates").text.split(",")))
                    for mark in marks])
        self.assertEqual([mark.find(f"{KML}name").text for mark in marks],
                         [str(n + 1) for n in range(len(marks))])
        self.equal_times([float(mark.find(f".//{KML}Data[@name='time_s']/{KML}value").text)
                          for mark in marks])
        self.equal_times([self.seconds(mark.find(f"{KML}TimeStamp/{KML}when").text) for mark in marks], 0.5)

    def test_gpx(self):
        points = list(tree_of(self.export("gpx")[0]).iter(f"{GPX}rtept"))
        self.equal([[float(p.get("lon")), float(p.get("lat")), float(p.find(f"{GPX}ele").text)] for p in points])
        self.equal_times([self.seconds(p.find(f"{GPX}time").text) for p in points], 0.5)

    @staticmethod
    def seconds(text):
        date = subprocess.run(["date", "-u", "-d", text, "+%s"], capture_output=True, text=True, check=True)
        return int(date.stdout) - START

    def test_czml(self):
        document, route = json.loads(self.export("czml")[0])
        self.assertEqual((document["id"], document["version"]), ("document", "1.0"))
        numbers = route["position"]["cartographicDegrees"]
        self.assertEqual(self.seconds(route["position"]["epoch"]), 0)
        self.equal_times(numbers[::4])
        geoid = [h - z for h, (_, _, z) in zip(numbers[3::4], self.route)]
        self.assertTrue(all(-33 < undulation < -28 for undulation in geoid), geoid)
        self.equal([[lon, lat, h - undulation]
                    for lon, lat, h, undulation in zip(numbers[1::4], numbers[2::4], numbers[3::4], geoid)])
        begin, end = route["availability"].split("/")
        self.assertEqual(self.seconds(begin), 0)
        self.assertLess(abs(self.seconds(end) - numbers[-4]), 1.001)
        self.assertEqual(document["clock"]["interval"], route["availability"])

    def test_mcap(self):
        data = self.export("mcap")[0]
        records = list(mcap_records(data))
        self.assertEqual([opcode for opcode, _ in records], [1, 3, 4, 5, 15, 2])
        contents = dict(records)
        self.assertIn(b"nav_msgs/msg/Path", contents[3])
        self.assertIn(b"MSG: geometry_msgs/Quaternion", contents[3])
        self.assertIn(b"/plan", contents[4])
        _, _, log_time, _ = struct.unpack_from("<HIQQ", contents[5])
        self.assertEqual(log_time, START * 10**9)
        cdr = Cdr(contents[5][22:])
        self.assertEqual(cdr.header(), (START, b"map\0"))
        points, times = [], []
        for _ in range(cdr.next("I")):
            seconds, frame = cdr.header()
            self.assertEqual(frame, b"map\0")
            times.append(seconds - START)
            points.append([cdr.next("d") for _ in range(3)])
            x, y, z, w = (cdr.next("d") for _ in range(4))
            self.assertEqual((x, y), (0, 0))
            self.assertAlmostEqual(z * z + w * w, 1, 12)
        self.assertEqual(cdr.at, len(cdr.data))
        self.equal_times(times)
        self.assertEqual(len(points), len(self.json["route"]))
        for here, there in zip(points, self.json["route"]):
            for value, expected in zip(here, there):
                self.assertAlmostEqual(value, expected, 3)

    def test_what_they_cannot_say(self):
        for to, options, words in (
                ("wpml", ["--altitude", "sea"], "wpml only has heights above the place of take-off: give --altitude home"),
                ("litchi", ["--altitude", "ground"], "litchi only has heights above the place of take-off"),
                ("czml", ["--altitude", "ground"], "czml only has heights above sea level: give --altitude sea"),
                ("wpml", ["--takeoff"], "--takeoff and --land need qgc-plan or waypoints")):
            _, err = altiplan("export", self.result, "--to", to, *options, code=2)
            self.assertIn(words, err)
        _, err = altiplan("export", self.result, "--to", "dwg", code=2)
        self.assertIn("mcap", err)

    def file(self, name, data):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as file:
            file.write(data)
        return path

    def test_they_are_read_as_missions(self):
        """What is written is checked, shown and converted like the plan of the same route."""
        for to, ending in (("wpml", ".kmz"), ("kmz", ".kmz"), ("czml", ".czml"), ("gpx", ".gpx")):
            with self.subTest(to):
                path = self.file(to + ending, self.export(to)[0])
                out, _ = altiplan("check", path, "--terrain", TERRAIN)
                self.assertIn(f"pass: ", out.decode())
                self.assertIn(f"{len(self.route)} waypoints", out.decode())
                self.assertIn(": mission", altiplan("info", path)[0].decode())
                back, _ = altiplan("export", path, "--terrain", TERRAIN, "--to", "geojson")
                line = next(feature for feature in json.loads(back)["features"]
                            if feature["geometry"]["type"] == "LineString")
                self.equal(line["geometry"]["coordinates"], places=6.9, metres=0.003)
        path = self.file("litchi.csv", self.export("litchi")[0])
        _, err = altiplan("check", path, "--terrain", TERRAIN, code=3)
        self.assertIn("relative to home, and the file has no home position", err)

    def test_times_of_a_mission(self):
        """CZML and MCAP of a mission have the earliest times of the gate's table."""
        path = self.file("mission.gpx", self.export("gpx")[0])
        table, _ = altiplan("export", path, "--terrain", TERRAIN, "--to", "csv")
        times = [float(row["time_s"]) for row in csv.DictReader(io.StringIO(table.decode()))]
        out, err = altiplan("export", path, "--terrain", TERRAIN, "--to", "czml")
        self.assertIn("times, if written, are those of the fastest flight", err)
        numbers = json.loads(out)[1]["position"]["cartographicDegrees"]
        self.assertEqual(len(numbers) // 4, len(times))
        for here, there in zip(numbers[::4], times):
            self.assertAlmostEqual(here, there, 2)

    def test_lines_become_plans(self):
        """A line without commands is judged as the plan that it becomes."""
        path = self.file("line.kml", self.export("kml")[0])
        plan = os.path.join(self.folder, "line.plan")
        altiplan("export", path, "--terrain", TERRAIN, "--takeoff", "-o", plan)
        with open(plan, encoding="utf-8") as file:
            items = json.load(file)["mission"]["items"]
        self.assertEqual([item["command"] for item in items], [22] + [16] * (len(self.route) - 1))
        altiplan("check", plan, "--terrain", TERRAIN)
        _, err = altiplan("export", path, "--terrain", TERRAIN, "--takeoff", "--vehicle", "plane", "-o",
                          os.path.join(self.folder, "plane.plan"), code=1)
        self.assertIn("flown as a plan: fail", err)
        self.assertIn("where an aeroplane takes off depends on its runway", err)
        self.assertFalse(os.path.exists(os.path.join(self.folder, "plane.plan")))

    def test_zones_with_hours_need_a_speed(self):
        """That of the file is not read: a slow flight would meet what is closed later."""
        zone = self.file("z.json", json.dumps({"features": [{
            "identifier": "Z", "country": "USA", "name": "Z", "type": "COMMON", "restriction": "PROHIBITED", "reason": [],
            "zoneAuthority": [], "geometry": [{
                "uomDimensions": "M", "lowerLimit": 0, "lowerVerticalReference": "AMSL", "upperLimit": 9000,
                "upperVerticalReference": "AMSL", "horizontalProjection": {
                    "type": "Circle", "center": self.route[-1][:2], "radius": 100}}],
            "applicability": [{"startDateTime": "2026-05-01T12:00:00Z", "endDateTime": "2026-05-01T23:00:00Z",
                               "permanent": "NO"}]}]}).encode())
        options = ("--terrain", TERRAIN, "--airspace", zone, "--start-time", "2026-05-01T10:00:00Z")
        for to, name in (("wpml", "h.kmz"), ("czml", "h.czml")):
            path = self.file(name, self.export(to)[0])
            _, err = altiplan("check", path, *options, code=3)
            self.assertIn("its own speeds and times are not read: give --speed M/S", err)
            altiplan("check", path, *options, "--speed", "60", code=0)
            altiplan("check", path, *options, "--speed", "1", code=1)
            altiplan("check", path, *options[:4], code=1)

    def test_a_climb_before_the_first_point(self):
        with zipfile.ZipFile(io.BytesIO(self.export("wpml")[0])) as archive:
            files = {name: archive.read(name).decode() for name in archive.namelist()}
        high = io.BytesIO()
        with zipfile.ZipFile(high, "w") as archive:
            for name, text in files.items():
                archive.writestr(name, re.sub(r"(<wpml:takeOffSecurityHeight>)[^<]*", r"\g<1>1400", text))
        path = self.file("high.kmz", high.getvalue())
        _, err = altiplan("check", path, "--terrain", TERRAIN, code=3)
        self.assertIn("DJI climbs to the takeOffSecurityHeight of 1400 m first", err)

    def test_a_template_that_contradicts_the_waylines(self):
        """DJI Pilot makes the waylines anew from it: what passes may not be what is flown."""
        with zipfile.ZipFile(io.BytesIO(self.export("wpml")[0])) as archive:
            template, waylines = (archive.read(name).decode() for name in archive.namelist())
        first = template.index("<Placemark>")
        height = re.search(r"<wpml:height>(.*?)</wpml:height>", template)[1]
        lon = re.search(r"<coordinates>(.*?),", template)[1]
        last = template.rindex("<Placemark>")
        globally = re.sub(r"<wpml:height>.*?</wpml:height>", "", template).replace("useGlobalHeight>0<", "useGlobalHeight>1<")
        above_sea = re.sub(r"<wpml:height>(.*?)</wpml:height>",
                           lambda found: f"<wpml:height>{float(found[1]) + self.home[2]:.3f}</wpml:height>", template)
        mode = "<wpml:heightMode>{}</wpml:heightMode>"
        relative, egm96 = mode.format("relativeToStartPoint"), mode.format("EGM96")
        area = template[:first] + template[template.index("</Folder>"):]
        for name, changed, words in (
                ("aside", template.replace(f"<coordinates>{lon}", f"<coordinates>{float(lon) + 1e-4:.7f}", 1),
                 "point 1 is 9.0 m away from that of the waylines"),
                ("lower", template.replace(f"<wpml:height>{height}", f"<wpml:height>{float(height) - 3:.3f}", 1),
                 "point 1 is 3.0 m away"),
                ("fewer", template[:last] + template[template.index("</Folder>"):], f"{len(self.route) - 1} points there, "),
                ("level", globally, "m away"), ("sea", template.replace(relative, egm96), "m away"),
                ("ground", template.replace(relative, mode.format("aboveGroundLevel")), "its heights count from elsewhere"),
                ("turns", template.replace(">toPointAndStopWithDiscontinuityCurvature<", ">coordinateTurn<"),
                 "how DJI flies the globalWaypointTurnMode 'coordinateTurn'"),
                ("end", template.replace(">noAction<", ">goHome<"), "how DJI flies the finishAction 'goHome'"),
                ("same", template, ""), ("same_at_sea", above_sea.replace(relative, egm96), ""), ("area", area, "")):
            with self.subTest(name):
                self.assertTrue(changed != template or name == "same")
                archive = io.BytesIO()
                with zipfile.ZipFile(archive, "w") as made:
                    made.writestr("wpmz/template.kml", changed)
                    made.writestr("wpmz/waylines.wpml", waylines)
                path = self.file(name + ".kmz", archive.getvalue())
                _, err = altiplan("check", path, "--terrain", TERRAIN, code=3 if words else 0)
                self.assertIn(words, err)
                self.assertEqual("template.kml, from which DJI Pilot makes the waylines anew" in err, bool(words))

    def test_damaged_files(self):
        whole = {"w.kmz": self.export("wpml")[0], "m.mcap": self.export("mcap")[0],
                 "l.csv": self.export("litchi")[0], "c.czml": self.export("czml")[0]}
        scenario = os.path.join(self.folder, "timed.yaml")
        for name, data in whole.items():
            for cut in (10, len(data) // 3, len(data) - 5):
                path = self.file(name, data[:cut])
                done = subprocess.run([PROGRAM, "check", "--route", path, "--scenario", scenario],
                                      capture_output=True, text=True, timeout=600, check=False)
                if name == "m.mcap" and cut == len(data) - 5:
                    continue  # behind the message
                self.assertEqual(done.returncode, 3, f"{name} {cut} {done.stdout} {done.stderr}")
                self.assertIn(name, done.stderr)
        curved = whole["l.csv"].split(b"\n")
        curved[2] = b",".join(b"20" if n == 4 else cell for n, cell in enumerate(curved[2].split(b",")))
        path = self.file("curved.csv", b"\n".join(curved))
        _, err = altiplan("check", "--route", path, "--scenario", scenario, code=3)
        self.assertIn("how Litchi flies the curvesize '20' is not judged", err)
        waylines = zipfile.ZipFile(io.BytesIO(whole["w.kmz"])).read("wpmz/waylines.wpml")
        for old, new, words in (
                (b">toPointAndStopWithDiscontinuityCurvature<", b">coordinateTurn<", "how DJI flies the waypointTurnMode"),
                (b">noAction<", b">goHome<", "how DJI flies the finishAction 'goHome' is not judged"),
                (b">relativeToStartPoint<", b">realTimeFollowSurface<", "expected the executeHeightMode"),
                (b"<wpml:executeHeight>", b"<wpml:executeHeight>x", "expected a number")):
            archive = io.BytesIO()
            with zipfile.ZipFile(archive, "w") as changed:
                changed.writestr("wpmz/waylines.wpml", waylines.replace(old, new))
            path = self.file("changed.kmz", archive.getvalue())
            _, err = altiplan("check", path, "--terrain", TERRAIN, code=3)
            self.assertIn(words, err)
        template = zipfile.ZipFile(io.BytesIO(whole["w.kmz"])).read("wpmz/template.kml")
        archive = io.BytesIO()
        with zipfile.ZipFile(archive, "w") as changed:
            changed.writestr("wpmz/template.kml", template.replace(
                b"<wpml:takeOffRefPoint>", b"<wpml:takeOffRefPoint>x"))
            changed.writestr("wpmz/waylines.wpml", waylines)
        path = self.file("changed.kmz", archive.getvalue())
        _, err = altiplan("check", path, "--terrain", TERRAIN, code=3)
        self.assertIn("changed.kmz/template.kml:", err)


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
