# SPDX-License-Identifier: Apache-2.0
"""runway_test.py PROGRAM SOURCES: take-offs and landings that `altiplan go` plans, for each autopilot.

`python3 runway_test.py PROGRAM SOURCES Runway.test_into_the_wind` runs one case."""
import json
import math
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
WEST, SOUTH, CELL, SIZE = 8.0, 46.5, 0.0005, 240  # 9.2 by 13.4 km
START, GOAL = (8.03, 46.53), (8.07, 46.58)
ENDS = ["--from", "8.03,46.53", "--to", "8.07,46.58"]
EAST_M = 111_320 * math.cos(math.radians(46.55))
NORTH_M = 111_150


def place(course_deg, ahead, beside=0, origin=GOAL):
    """Longitude and latitude, metres ahead of the origin on a course, and to its right."""
    a = math.radians(course_deg)
    east = ahead * math.sin(a) + beside * math.cos(a)
    north = ahead * math.cos(a) - beside * math.sin(a)
    return origin[0] + east / EAST_M, origin[1] + north / NORTH_M


def metres_between(a, b):
    return math.hypot((a[0] - b[0]) * EAST_M, (a[1] - b[1]) * NORTH_M)


class Runway(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.model("flat.asc")

    def model(self, name, hill=None, top=0):
        """A plain of 400 m, with a hill of 400 m across at a place."""
        def height(i, j):
            p = (WEST + (i + 0.5) * CELL, SOUTH + (j + 0.5) * CELL)
            off = metres_between(p, hill) if hill else 1e9
            return round(400 + max(0, top * (1 - off / 400)), 1)
        head = (f"ncols {SIZE}\nnrows {SIZE}\nxllcorner {WEST}\nyllcorner {SOUTH}\n"
                f"cellsize {CELL}\nNODATA_value -9999\n")
        (self.folder / name).write_text(head + "\n".join(
            " ".join(str(height(i, j)) for i in range(SIZE)) for j in reversed(range(SIZE))) + "\n")

    def call(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=300)
        self.assertEqual(run.returncode, code, " ".join(arguments) + "\n" + run.stdout + run.stderr)
        return run.stdout + run.stderr

    def go(self, folder, *options, model="flat.asc", code=0, vehicle=("--wing", "60", "--speed", "15")):
        return self.call("go", "--terrain", model, "--crs", "EPSG:4326", *ENDS, *vehicle, *options, "-o",
                         folder, code=code)

    def check(self, folder, *options, model="flat.asc", code=0):
        return self.call("check", f"{folder}/route.plan", "--terrain", model, "--crs", "EPSG:4326",
                         "--min-agl", "50", *options, code=code)

    def mission(self, folder):
        return json.loads((self.folder / folder / "route.plan").read_text())["mission"]

    def items(self, folder):
        return self.mission(folder)["items"]

    def test_into_the_wind(self):
        out = self.go("wind", "--land", "--wind", "4,250")
        self.assertIn("landing: course 250 degrees, 4.0 m/s of wind from ahead and 0.0 m/s", out)
        self.assertIn("an aborted landing is not judged", out)
        self.assertIn("check: pass, flown by ArduPilot plane", out)
        items = self.items("wind")
        entry, fix, touch = items[-3:]
        self.assertEqual([one["command"] for one in items[-3:]], [16, 16, 21])
        at = [(one["params"][5], one["params"][4]) for one in items]
        self.assertLess(metres_between(at[-1], GOAL), 0.1)
        self.assertAlmostEqual(touch["params"][6], 400, delta=0.1)
        self.assertEqual(entry["params"][6], fix["params"][6])
        glide = metres_between(at[-2], at[-1])
        self.assertAlmostEqual(math.degrees(math.atan2(fix["params"][6] - 400, glide)), 5, delta=0.1)
        self.assertLess(metres_between(at[-2], place(250, -glide)), 5)
        self.check("wind", "--wind", "4")
        result = json.loads((self.folder / "wind/result.json").read_text())
        self.assertAlmostEqual(result["route"]["waypoints"][-1][2] if isinstance(result["route"], dict)
                               else result["route"][-1][2], 400, delta=0.1)
        self.call("check", "wind/result.json")
        self.call("run", "wind/pipeline.yaml", "--out", "again.json")
        again = json.loads((self.folder / "again.json").read_text())
        self.assertEqual(again["route"], result["route"])
        self.assertEqual(again["metrics"]["length_m"], result["metrics"]["length_m"])

    def test_a_hill_before_the_runway(self):
        self.model("hill.asc", place(250, -600), 60)
        out = self.go("hill", "--land", "--wind", "4,250", model="hill.asc")
        self.assertIn("landing: course 2", out)
        self.assertNotIn("course 250 degrees", out)
        self.check("hill", "--wind", "4", model="hill.asc")
        out = self.go("none", "--land", "--wind", "4,250", "--runway", "250", model="hill.asc", code=1)
        self.assertRegex(out, r"no route: --runway: landing on 250 degrees does not pass: the landing: "
                              r"(goes through the ground|keeps off the ground by less).*, at \(")
        self.assertFalse((self.folder / "none").exists())
        self.go("flat", "--land", "--wind", "4,250")
        self.assertIn("the landing", self.check("flat", "--wind", "4", model="hill.asc", code=1))

    def test_a_zone_across_the_approach(self):
        ring = [place(250, -500, -80), place(250, -500, 80), place(250, -400, 80), place(250, -400, -80)]
        (self.folder / "zone.geojson").write_text(json.dumps({
            "type": "FeatureCollection", "features": [{
                "type": "Feature", "properties": {"name": "Moor"},
                "geometry": {"type": "Polygon", "coordinates": [[list(p) for p in ring + ring[:1]]]}}]}))
        out = self.go("zone", "--land", "--wind", "4,250", "--avoid", "zone.geojson")
        self.assertNotIn("course 250 degrees", out)
        self.assertIn("check: pass", out)
        out = self.go("none", "--land", "--runway", "250", "--avoid", "zone.geojson", code=1)
        self.assertRegex(out, r"landing on 250 degrees does not pass: .*'Moor'")

    def test_from_ground_to_ground(self):
        (self.folder / "p.param").write_text("RTL_AUTOLAND,2\n")
        out = self.go("both", "--takeoff", "--land", "--runway", "90", "--params", "p.param")
        self.assertIn("take-off: course 90 degrees; climbs to 60 m above the runway within", out)
        self.assertIn("landing: course 90 degrees", out)
        self.assertNotIn("without DO_LAND_START", out)
        items = self.items("both")
        self.assertEqual([one["command"] for one in items[:3]], [22, 178, 16])
        self.assertEqual([one["command"] for one in items[-4:]], [189, 16, 16, 21])
        self.check("both", "--runway", "90", "--params", "p.param")
        self.assertIn("not judged", self.check("both", "--params", "p.param", code=1))
        self.assertIn("RTL_AUTOLAND", self.check("both", "--runway", "90", code=1))
        self.call("run", "both/pipeline.yaml", "--out", "again.json")
        self.model("ridge.asc", place(90, 500, 0, START), 60)
        out = self.go("ridge", "--takeoff", "--runway", "90", model="ridge.asc", code=1)
        self.assertRegex(out, r"take-off on 90 degrees does not pass: .*, at \(")
        self.assertIn("the climb", self.check("both", "--runway", "90", "--params", "p.param",
                                              model="ridge.asc", code=1))

    def test_an_aeroplanes_speed(self):
        out = self.go("speed", "--land")
        first, speed = self.items("speed")[:2]
        self.assertEqual([first["command"], speed["command"]], [16, 178])
        self.assertEqual(speed["params"][:2], [0, 15])  # through the air
        self.assertNotIn("--speed: ", out)
        out = self.go("fast", "--land", vehicle=("--wing", "80", "--speed", "25"))
        self.assertIn("--speed: ArduPilot plane flies from 9 to 22 m/s", out)
        self.assertIn("is ignored: it is not from AIRSPEED_MIN to AIRSPEED_MAX, 9 to 22 m/s", self.check("fast"))

    def test_the_circle_at_its_end(self):
        """A hill rises under the circle, but not under the way to its centre."""
        self.model("hill.asc", place(45, 250), 200)
        out = self.go("circle", model="hill.asc")
        self.assertRegex(out, r"circle: around the goal at \d+ m above its ground: lower it does not pass")
        self.assertIn("check: pass", out)
        end = self.items("circle")[-1]
        self.assertEqual(end["command"], 17)
        self.assertGreater(end["params"][6], 400 + 60 + 5)
        self.check("circle", model="hill.asc")
        self.assertIn("no circle around the goal passes", self.go("low", "--max-agl", "70",
                                                                  model="hill.asc", code=1))

    def test_a_vtol(self):
        straight = math.degrees(math.atan2((GOAL[0] - START[0]) * EAST_M, (GOAL[1] - START[1]) * NORTH_M))
        for name, firmware in (("ardupilot", 3), ("px4", 12)):
            vehicle = ("--vtol", "60", "--speed", "15", "--autopilot", name)
            out = self.go(name, vehicle=vehicle)
            self.assertIn("take-off: straight up to 60 m above the ground, then within 300 m on wings", out)
            self.assertRegex(out, r"check: pass, flown by (ArduPilot|PX4) VTOL")
            mission = self.mission(name)
            self.assertEqual((mission["firmwareType"], mission["vehicleType"]), (firmware, 20))
            items = mission["items"]
            self.assertEqual([one["command"] for one in (*items[:3], items[-1])], [84, 178, 16, 85])
            self.assertEqual((items[0]["frame"], items[0]["params"][6]), (3, 60))
            self.assertLess(metres_between(items[-1]["params"][5:3:-1], GOAL), 0.1)
            self.assertAlmostEqual(items[-1]["params"][6], 400, delta=0.1)
            brakes = metres_between(items[-2]["params"][5:3:-1], GOAL)
            self.assertGreaterEqual(brakes, 299)
            heading = out.split("check: --runway ")[1].split()[0] if name == "ardupilot" else "0"
            self.check(name, "--runway", heading)
            self.call("check", f"{name}/result.json")
        self.assertIn("depends on where it points", self.check("ardupilot", code=1))
        away = str((straight + 30) % 360)
        self.assertIn("depends on where it points", self.check("ardupilot", "--runway", away, code=1))
        # A hill on the way on which it changes to wings, and one before the landing.
        for hill in (place(straight, 150, 0, START), place(straight, -150)):
            self.model("hill.asc", hill, 90)
            self.go("hill", vehicle=vehicle, model="hill.asc")
            self.check("hill", model="hill.asc")
            self.check(name, model="hill.asc", code=1)
            shutil.rmtree(self.folder / "hill")

    def test_px4(self):
        out = self.go("copter", "--autopilot", "px4", vehicle=())
        self.assertIn("check: pass, flown by PX4 copter", out)
        mission = self.mission("copter")
        self.assertEqual((mission["firmwareType"], mission["vehicleType"]), (12, 2))
        self.assertTrue(all(one["params"][1] == 2 for one in mission["items"] if one["command"] == 16))
        self.check("copter")
        self.assertIn("(MIS_TKO_LAND_REQ): add --land", self.go("none", "--autopilot", "px4", code=3))
        out = self.go("plane", "--autopilot", "px4", "--takeoff", "--land")
        self.assertIn("check: pass, flown by PX4 plane", out)
        self.assertEqual(self.mission("plane")["firmwareType"], 12)
        (self.folder / "p.params").write_text("1\t1\tMIS_TKO_LAND_REQ\t0\t6\n")
        out = self.go("circle", "--autopilot", "px4", "--params", "p.params")
        self.assertIn("check: pass, flown by PX4 plane", out)

    def test_what_contradicts_itself(self):
        for options, said in ((["--runway", "90"], "--runway: give --takeoff, --land or both"),
                              (["--land", "--runway", "400"], "--runway"),
                              (["--vtol", "60"], "--vtol: without --wing and --copter"),
                              (["--autopilot", "other"], "--autopilot"),
                              (["--land", "--to", "8.07,46.58,60"], "--to")):
            self.assertIn(said, self.go("none", *options, code=2))
        self.assertFalse((self.folder / "none").exists())
        out = self.call("go", "--terrain", "flat.asc", "--crs", "EPSG:4326", *ENDS, "--land", "-o", "copter")
        self.assertIn("check: pass", out)
        self.assertEqual(self.items("copter")[-1]["command"], 21)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
