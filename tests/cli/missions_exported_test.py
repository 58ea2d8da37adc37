# SPDX-License-Identifier: Apache-2.0
"""missions_exported_test.py PROGRAM SOURCES: `altiplan export` and `upload` of a mission."""
import csv
import datetime
import json
import re
import subprocess
import sys
import unittest
import xml.etree.ElementTree
import zipfile

from plan_case import POINTS, PROGRAM, TERRAIN, PlanCase, item, plan_of

KML = "{http://www.opengis.net/kml/2.2}"
WPML = "{http://www.dji.com/wpmz/1.0.2}"
GPX = "{http://www.topografix.com/GPX/1/1}"


class Missions(PlanCase):
    def setUp(self):
        super().setUp()
        plan = plan_of([[lon, lat, height + 300] for lon, lat, height in POINTS])
        plan["mission"]["items"][2]["params"][1] = 7  # an acceptance radius
        plan["mission"]["items"].insert(2, {
            "type": "SimpleItem", "command": 178, "frame": 2, "doJumpId": 9, "autoContinue": True,
            "params": [1, 6, -1, 0, 0, 0, 0]})
        plan["geoFence"]["circles"] = [
            {"circle": {"center": [36.58, -84.29], "radius": 20000}, "inclusion": True, "version": 1}]
        plan["rallyPoints"]["points"] = [[36.49, -84.37, 200]]
        self.plan = plan
        (self.folder / "mission.plan").write_text(json.dumps(plan))

    def altiplan(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=600, check=False)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def test_a_plan_keeps_its_commands_fence_and_rally_points(self):
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "other.plan")
        other = json.loads((self.folder / "other.plan").read_text())
        for ours, theirs in zip(other["mission"]["items"], self.plan["mission"]["items"], strict=True):
            self.assertEqual(ours["command"], theirs["command"])
            self.assertEqual(ours["frame"], theirs["frame"])
            self.assertEqual(ours["params"], theirs["params"])
        for key in ("firmwareType", "vehicleType"):
            self.assertEqual(other["mission"][key], self.plan["mission"][key])
        self.assertEqual(other["geoFence"]["circles"][0]["circle"],
                         self.plan["geoFence"]["circles"][0]["circle"])
        self.assertEqual(other["rallyPoints"]["points"], self.plan["rallyPoints"]["points"])

    def test_other_formats(self):
        _, err = self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "m.waypoints")
        self.assertIn("fence and rally points are left out", err)
        lines = (self.folder / "m.waypoints").read_text().splitlines()
        self.assertEqual([line.split("\t")[3] for line in lines[1:]],
                         ["16", "16", "16", "178", "16", "16"])  # home first
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "m.geojson")
        features = json.loads((self.folder / "m.geojson").read_text())["features"]
        line = next(f for f in features if f["geometry"]["type"] == "LineString")
        for here, (lon, lat, height) in zip(line["geometry"]["coordinates"], POINTS, strict=True):
            self.assertAlmostEqual(here[0], lon, 7)
            self.assertAlmostEqual(here[1], lat, 7)
            self.assertAlmostEqual(here[2], height + 300, 2)

    def test_what_does_not_pass_is_not_written(self):
        low = [item([lon, lat, height - 300], n + 1) for n, (lon, lat, height) in enumerate(POINTS)]
        self.plan["mission"]["items"] = low
        (self.folder / "mission.plan").write_text(json.dumps(self.plan))
        for call in (["export", "mission.plan", "-o", "other.plan"],
                     ["upload", "mission.plan", "--to", "udp:127.0.0.1:1"]):
            out, err = self.altiplan(*call, "--terrain", TERRAIN, "--min-agl", "50", code=1)
            self.assertIn("fail", out + err)
        self.assertFalse((self.folder / "other.plan").exists())

    def test_one_time(self):
        """The mission's time is the gate's, in whatever form it is asked for."""
        self.plan["mission"]["items"][0]["command"] = 22
        (self.folder / "mission.plan").write_text(json.dumps(self.plan))
        out, _ = self.altiplan("check", "mission.plan", "--terrain", TERRAIN, "--json")
        answer = json.loads(out)
        words = "{:.1f} to {:.1f} min".format(*(seconds / 60 for seconds in answer["time_s"]))
        self.assertIsNone(answer["metrics"]["duration_s"])  # along drawn lines
        out, _ = self.altiplan("check", "mission.plan", "--terrain", TERRAIN, "--certificate", "c.html")
        self.assertIn(words, out)
        self.assertIn(words, (self.folder / "c.html").read_text())
        self.assertIn(words, self.altiplan("info", "mission.plan", "--terrain", TERRAIN)[0])
        self.assertIn("as if over level ground", self.altiplan("info", "mission.plan")[0])
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "-o", "m.csv")
        rows = list(csv.DictReader((self.folder / "m.csv").read_text().splitlines()))
        self.assertEqual(len(rows), len(POINTS))
        for row, earlier in zip(rows[1:], rows):
            self.assertLess(float(earlier["time_s"]), float(row["time_s"]))
        self.assertAlmostEqual(float(rows[-1]["time_s"]), answer["time_s"][0], 2)
        self.assertAlmostEqual(float(rows[-1]["latest_s"]), answer["time_s"][1], 2)

    def archive(self, entry):
        with zipfile.ZipFile(self.folder / "m.kmz") as archive:
            return xml.etree.ElementTree.fromstring(archive.read(entry))

    def test_each_format_has_the_speeds_and_times_that_are_judged(self):
        """Those of the gate: the copter's own (WP_SPD), then DO_CHANGE_SPEED."""
        (self.folder / "v.param").write_text("WP_SPD,9\n")
        options = ("--terrain", TERRAIN, "--start-time", "2026-05-01T10:00:00Z")
        begun = datetime.datetime(2026, 5, 1, 10, tzinfo=datetime.timezone.utc)

        def export(to, out, *more):
            return self.altiplan("export", "mission.plan", *options, *more, "--to", to, "-o", out)[1]

        def clock(text):
            return (datetime.datetime.fromisoformat(text.replace("Z", "+00:00")) - begun).total_seconds()

        for more, own in (((), 10), (("--params", "v.param"), 9)):
            export("csv", "m.csv", *more)
            times = [float(row["time_s"]) for row in csv.DictReader((self.folder / "m.csv").read_text().splitlines())]
            speeds = [own, 6, 6, 6]  # on the way from each point; the last keeps its own
            err = export("wpml", "m.kmz", *more)
            self.assertIn("speeds and times, if written, are those of the fastest flight", err)
            for entry in ("wpmz/waylines.wpml", "wpmz/template.kml"):
                found = [float(one.text) for one in self.archive(entry).iter(f"{WPML}waypointSpeed")]
                self.assertEqual(found, speeds, entry)
                self.assertEqual(float(self.archive(entry).find(f".//{WPML}autoFlightSpeed").text), own)
            export("litchi", "m_litchi.csv", *more)
            rows = csv.DictReader((self.folder / "m_litchi.csv").read_text().splitlines())
            self.assertEqual([float(row["speed(m/s)"]) for row in rows], speeds)
            export("kmz", "m.kmz", *more)
            found = {"kmz": [clock(one.text) for one in self.archive("doc.kml").iter(f"{KML}when")]}
            export("gpx", "m.gpx", *more)
            gpx = xml.etree.ElementTree.fromstring((self.folder / "m.gpx").read_text())
            found["gpx"] = [clock(one.text) for one in gpx.iter(f"{GPX}time")]
            export("geojson", "m.geojson", *more)
            line, = (one for one in json.loads((self.folder / "m.geojson").read_text())["features"]
                     if one["geometry"]["type"] == "LineString")
            found["geojson"] = line["properties"]["times_s"]
            export("czml", "m.czml", *more)
            position = json.loads((self.folder / "m.czml").read_text())[1]["position"]
            found["czml"] = [clock(position["epoch"]) + at for at in position["cartographicDegrees"][::4]]
            for to, each in found.items():
                self.assertEqual(len(each), len(times), to)
                for here, there in zip(each, times):
                    self.assertLessEqual(abs(here - there), 0.51, to)

    def test_circles_are_as_slow_and_as_late_as_judged(self):
        """The copter circles at less than its speed, and is at its points in order."""
        self.plan["mission"]["items"][1].update(command=18)
        self.plan["mission"]["items"][1]["params"][:4] = [2, 0, 40, 1]
        (self.folder / "mission.plan").write_text(json.dumps(self.plan))
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "--to", "litchi", "-o", "m.csv")
        rows = list(csv.DictReader((self.folder / "m.csv").read_text().splitlines()))
        speeds = [float(row["speed(m/s)"]) for row in rows]
        self.assertGreater(len(rows), 20)
        self.assertEqual(speeds[0], 10)
        self.assertEqual(set(speeds[2:-5]), {7.071})  # √(WP_ACC / 2 · 40 m)
        self.assertEqual(speeds[-2:], [6, 6])
        self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "--to", "czml", "-o", "m.czml")
        times = json.loads((self.folder / "m.czml").read_text())[1]["position"]["cartographicDegrees"][::4]
        self.assertEqual(times, sorted(set(times)))

    def test_formats_of_copters_warn_of_others(self):
        """Of a mission as of a result, by the vehicle that the file names."""
        for vehicle, warns in ((1, True), (20, True), (2, False)):
            self.plan["mission"]["vehicleType"] = vehicle
            self.plan["mission"]["items"] = plan_of([[lon, lat, 2500] for lon, lat, _ in POINTS])["mission"]["items"]
            self.plan["mission"]["items"][-1]["command"] = 17
            (self.folder / "mission.plan").write_text(json.dumps(self.plan))
            for to in ("wpml", "litchi", "kml", "kmz", "gpx", "geojson", "czml", "mcap"):
                _, err = self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "--to", to, "-o", "out")
                told = f"warning: what flies {to} are copters, no aeroplanes" in err
                self.assertEqual(told, warns and to in ("wpml", "litchi"), f"{vehicle} {to}: {err}")

    def test_view(self):
        """The page shows the flown line with the verdict of `check`, whose violations are on it."""
        self.plan["mission"]["items"][0]["command"] = 22
        (self.folder / "mission.plan").write_text(json.dumps(self.plan))
        for code, limits in ((0, []), (1, ["--min-agl", "400"])):
            verdict, _ = self.altiplan("check", "mission.plan", "--terrain", TERRAIN, *limits, code=code)
            self.altiplan("view", "mission.plan", "--terrain", TERRAIN, *limits, "-o", "page.html",
                          "--svg", "top.svg")
            page = (self.folder / "page.html").read_text()
            scene = json.loads(re.search(r'<script id="scene" type="application/json">(.*?)</script>',
                                         page, re.DOTALL)[1])
            self.assertEqual(scene["title"], verdict.splitlines()[0])
            result, = scene["results"]
            self.assertEqual(result["status"], "rejected" if code else "solved")
            self.assertAlmostEqual(result["route"][1][2] - result["route"][0][2],
                                   POINTS[0][2] + 300 - 400, 0)  # the climb from home
            self.assertEqual(bool(result["check"]["violations"]), bool(code))
            for violation in result["check"]["violations"]:
                self.assertIn(violation["message"], verdict)
                self.assertLess(violation["at"], len(result["route"]))
        self.altiplan("view", "mission.plan", "-o", "page.html", code=2)
        self.altiplan("view", "mission.plan", "--terrain", TERRAIN, "--mp4", "film.mp4", code=2)
        _, err = self.altiplan("edit", "mission.plan", code=2)
        self.assertIn("add --terrain DEM", err)

    def test_options(self):
        _, err = self.altiplan("export", "mission.plan", "-o", "other.plan", code=2)
        self.assertIn("mission.plan is a mission: add --terrain DEM", err)
        _, err = self.altiplan("export", "mission.plan", "--terrain", TERRAIN, "--land", "-o", "other.plan",
                               code=2)
        self.assertIn("which has its own items", err)


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
