# SPDX-License-Identifier: Apache-2.0
"""returns_test.py PROGRAM SOURCES: `altiplan check MISSION --returns`. A referee of its own flies the plainest return,
straight from a place of the mission to home, over models of ALTIPLAN_TEST_DATA that it reads itself: what it finds in
the ground must be among the refused."""
import itertools
import json
import math
import os
import random
import subprocess
import sys
import unittest

from dem_model import METRES, MODELS, Model, all_models, item, write_ridge
from plan_case import NIGHTLY, PlanCase

COPTER, PLANE, PX4_COPTER, PX4_PLANE = (3, 2), (3, 1), (12, 2), (12, 1)


class Returns(PlanCase):
    """A ridge 200 m high east of home, and missions beyond it."""

    LAT, LON = 47.0, 8.0

    def setUp(self):
        super().setUp()
        write_ridge(self.folder, self.LAT, self.LON)

    def returns(self, vehicle, way, *options, parameters=None, rally=(), home=None, fence=None, code=None):
        """`way`: (command, east of home, north, height above home), (178, airspeed), or another order and its parameters."""
        items = [item(n + 1, one[0], 0, 0, 0, frame=2,
                      params=(*one[1:], 0, 0, 0, 0)[:4] if one[0] != 178 else (0, one[1], -1, 0)) if len(one) < 4 else
                 item(n + 1, one[0], self.LAT + one[2] / METRES,
                      self.LON + one[1] / METRES / math.cos(math.radians(self.LAT)), one[3])
                 for n, one in enumerate(way)]
        self.write(items, firmwareType=vehicle[0], vehicleType=vehicle[1],
                   plannedHomePosition=home or [self.LAT, self.LON, 400])
        plan = json.loads((self.folder / "mission.plan").read_text())
        plan["rallyPoints"]["points"] = [
            [self.LAT + north / METRES, self.LON + east / METRES / math.cos(math.radians(self.LAT)), height]
            for east, north, height in rally]
        (self.folder / "mission.plan").write_text(json.dumps(plan))
        if parameters:
            (self.folder / "p.param").write_text("".join(f"{name},{value}\n" for name, value in parameters.items()))
            options = (*options, "--params", "p.param")
        out, _ = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--json", *options, code=code)
        return json.loads(out)

    # Over the ridge at 260 m above home, and down to 60 m beyond it.
    def beyond(self, take_off=True):
        return ([(22, 0, 0, 260)] if take_off else []) + [(16, 300, 0, 260), (16, 1600, 0, 260), (16, 1900, 0, 60)]

    def test_a_copter_whose_return_is_lower_than_the_ridge(self):
        told = self.returns(COPTER, self.beyond(), code=1)
        self.assertEqual(told["verdict"], "pass", told["violations"])
        returns = told["returns"]
        self.assertEqual(returns["verdict"], "fail")
        worst = returns["worst"]
        self.assertEqual(worst["item"], 4)
        begins, ends = (sum(told["parts"][n]["time_s"]) / 2 for n in (2, 3))
        self.assertTrue(begins < worst["time_s"] <= ends, (begins, worst, ends))
        self.assertIsNone(returns["point_of_no_return_s"])
        self.assertEqual([one["rule"] for one in returns["refused"]], ["ground"])
        self.assertAlmostEqual(returns["refused"][0]["value"], 60 - 200, delta=20)
        self.assertEqual(returns["parameters"]["RTL_ALT_M"], 15)

    def test_a_return_over_a_void(self):
        """The mission flies around a void, its return over it: what is unknown is no depth below the ground."""
        lines = (self.folder / "ridge.asc").read_text().splitlines()
        for row in range(6 + 25, 6 + 29):
            lines[row] = " ".join("-9999" if 46 <= n < 50 else height for n, height in enumerate(lines[row].split()))
        (self.folder / "ridge.asc").write_text("\n".join(lines) + "\n")
        told = self.returns(COPTER, [(22, 0, 0, 100), (16, 0, 700, 100), (16, 600, 700, 100), (16, 600, 300, 100)], code=1)
        self.assertEqual(told["verdict"], "pass", told["violations"])
        self.assertIn("passes over a void", told["returns"]["refused"][0]["message"])

    def test_heights_above_a_void(self):
        """Closed as high ground, it is no ground to be above: nor is a flight above that height over known ground."""
        lines = (self.folder / "ridge.asc").read_text().splitlines()
        for row in range(6 + 5, 6 + 25):
            lines[row] = " ".join("-9999" if 20 <= n < 50 else height for n, height in enumerate(lines[row].split()))
        (self.folder / "ridge.asc").write_text("\n".join(lines) + "\n")

        def verdicts(frame, height, north, code):
            east = 1 / METRES / math.cos(math.radians(self.LAT))
            way = [(22, 0, north), (16, 100, north), (16, 100, north + 200), (16, 0, north + 200)]
            self.write([item(n + 1, command, self.LAT + y / METRES, self.LON + x * east, height, frame=frame)
                        for n, (command, x, y) in enumerate(way)], firmwareType=3, vehicleType=2,
                       plannedHomePosition=[self.LAT + north / METRES, self.LON, 400])
            out, _ = self.call("mission.plan", "--terrain", "ridge.asc", "--json", "--max-agl", "20000", code=code)
            return json.loads(out)

        for frame, height in ((10, 60), (0, 10100)):
            told = verdicts(frame, height, 500, 1)
            self.assertEqual(told["verdict"], "fail")
            self.assertIn("where the ground is unknown", str(told["violations"]))
            verdicts(frame, height, -500, 0)

    def test_a_return_that_is_slower_than_the_mission(self):
        """What closes until it is home counts, not what closes within twice the mission's time."""
        way = [(22, 0, 0, 60), (178, 20), (16, 100, -700, 260), (16, -1000, -700, 260)]
        slow = {"WP_SPD": 0.3, "RTL_ALT_M": 15}
        lon, lat = self.LON - 500 / METRES / math.cos(math.radians(self.LAT)), self.LAT - 350 / METRES
        for begins, code in (("10:45", 1), ("15:00", 0)):
            self.zones("z.json", self.around(lon, lat, 0.001), 2000, schedule={"startTime": f"{begins}:00Z",
                                                                                       "endTime": "23:00:00Z"})
            told = self.returns(COPTER, way, "--airspace", "z.json", "--start-time", "2026-05-01T10:00:00Z",
                                parameters=slow, code=code)
            self.assertEqual(told["verdict"], "pass", told["violations"])
            self.assertLess(told["time_s"][1], 900)
            self.assertEqual(told["returns"]["verdict"], "fail" if code else "pass", told["returns"])

    def test_a_return_height_that_is_high_enough(self):
        for parameters in ({"RTL_ALT": 23000}, {"RTL_ALT_M": 230}):
            told = self.returns(COPTER, self.beyond(), parameters=parameters, code=0)
            self.assertEqual((told["returns"]["verdict"], told["returns"]["worst"]), ("pass", None))

    def test_the_least_return_height_that_cures(self):
        self.returns(COPTER, self.beyond(), "--fix-returns", "cure.param", code=1)
        name, height = (self.folder / "cure.param").read_text().strip().split(",")
        self.assertEqual(name, "RTL_ALT_M")
        # The ridge is 200 m above home, which is beside the model's posts.
        self.assertTrue(195 <= int(height) <= 215, height)
        for more, code in ((0, 0), (-1, 1)):
            self.returns(COPTER, self.beyond(), parameters={name: int(height) + more}, code=code)
        # By the name and unit that the parameters have.
        self.returns(COPTER, self.beyond(), "--fix-returns", "old.param", parameters={"RTL_ALT": 1500}, code=1)
        self.assertEqual((self.folder / "old.param").read_text(), f"RTL_ALT,{height}00\n")
        # Below a ceiling none does.
        (self.folder / "cure.param").unlink()
        out, err = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--max-agl", "200", "--fix-returns",
                             "cure.param", code=1)
        self.assertIn("not written: the mission itself fails, which no return cures (item 1 (take-off): ", err)
        self.assertFalse((self.folder / "cure.param").exists())
        self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--max-agl", "270", "--fix-returns",
                  "cure.param", code=1)
        self.assertTrue((self.folder / "cure.param").exists())

    def test_rally_points_that_cure(self):
        """Where no return height does: below a ceiling, which the flight over the ridge keeps."""
        for vehicle in (COPTER, PX4_COPTER, PLANE):
            with self.subTest(vehicle=vehicle):
                way = self.beyond() if vehicle != PLANE else [(16, 300, 0, 260), (16, 1300, 0, 260), (16, 2400, 0, 260)]
                limits = ("--max-agl", "270") if vehicle != PLANE else ()
                told = self.returns(vehicle, way, *limits, "--fix-returns", "cured.plan", code=1)
                self.assertEqual(told["returns"]["verdict"], "fail")
                cured = json.loads((self.folder / "cured.plan").read_text())
                points = cured["rallyPoints"]["points"]
                self.assertGreaterEqual(len(points), 1)
                self.assertLessEqual(len(points), 3)
                out, _ = self.call("cured.plan", "--terrain", "ridge.asc", *limits, "--returns", "--json", code=0)
                self.assertEqual(json.loads(out)["returns"]["verdict"], "pass")
                # None is needless, and all else is as it was.
                for n in range(len(points)):
                    fewer = json.loads(json.dumps(cured))
                    del fewer["rallyPoints"]["points"][n]
                    (self.folder / "fewer.plan").write_text(json.dumps(fewer))
                    self.call("fewer.plan", "--terrain", "ridge.asc", *limits, "--returns", code=1)
                before = json.loads((self.folder / "mission.plan").read_text())
                del before["rallyPoints"], cured["rallyPoints"]
                self.assertEqual(cured, before)

    def test_cures_of_an_aeroplane_that_takes_off(self):
        """A return from its take-off is not judged before nor after: what is refused is cured all the same."""
        way = [(22, 0, 0, 60), (16, -700, 300, 120), (16, -700, 900, 190), (16, 0, 900, 260), (16, 1500, 600, 260),
               (16, 1500, -600, 260), (16, 0, -900, 260), (16, -300, 0, 200)]
        for file in ("cure.param", "cured.plan"):
            told = self.returns(PLANE, way, "--runway", "270", "--fix-returns", file, code=1)
            self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", "fail"), told)
        unjudged = told["returns"]["not_judged"]
        for mission, parameters in (("mission.plan", ("--params", "cure.param")), ("cured.plan", ())):
            out, _ = self.call(mission, "--terrain", "ridge.asc", "--returns", "--json", "--runway", "270", *parameters,
                               code=1)
            returns = json.loads(out)["returns"]
            self.assertEqual((returns["verdict"], returns["refused"]), ("not_judged", []))
            self.assertEqual(returns["not_judged"], unjudged)
        out, _ = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--runway", "270", "--fix-returns",
                           "cure.param", code=1)
        self.assertIn("fixed: cure.param leaves no return refused of those judged: RTL_ALTITUDE", out)
        _, err = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--runway", "270", "--params",
                           "cure.param", "--fix-returns", "other.param", code=1)
        self.assertIn("other.param: not written", err)

    def test_a_return_path_that_cures(self):
        """Of the mission's own items, where failsafes fly along it: the first below passes with one marker, an aeroplane's
        with two."""
        plane = [(16, 300, 0, 260), (16, 1400, 0, 260), (16, 2000, 0, 260), (16, 2300, 300, 160), (16, 2300, -400, 150),
                 (21, 2300, -1400, 0)]
        copter = self.beyond() + [(16, 1900, 200, 260), (16, 1900, 300, 60), (21, 1900, 400, 0)]
        for vehicle, way, parameters, markers, limits in (
                (COPTER, copter, {"FS_THR_ENABLE": 6}, [188], ()),
                (PLANE, plane, {"RTL_AUTOLAND": 4}, [188, 189], ()), (PLANE, plane, {"RTL_AUTOLAND": 2}, [189], ())):
            with self.subTest(parameters=parameters):
                told = self.returns(vehicle, way, *limits, "--fix-returns", "cured.plan", parameters=parameters, code=1)
                self.assertNotEqual(told["returns"]["verdict"], "pass")
                cured = json.loads((self.folder / "cured.plan").read_text())
                items = cured["mission"]["items"]
                self.assertEqual([one["command"] for one in items if one["command"] in (188, 189)], markers)
                self.assertEqual([one["doJumpId"] for one in items], list(range(1, len(items) + 1)))
                out, _ = self.call("cured.plan", "--terrain", "ridge.asc", "--params", "p.param", *limits, "--returns",
                                   "--json", code=0)
                self.assertEqual(json.loads(out)["returns"]["verdict"], "pass")
                # All else is as it was.
                before = json.loads((self.folder / "mission.plan").read_text())
                cured["mission"]["items"] = [one for one in items if one["command"] not in (188, 189)]
                for number, one in enumerate(cured["mission"]["items"], 1):
                    one["doJumpId"] = number
                self.assertEqual(cured, before)

    def test_no_rally_points_for_what_is_not_judged(self):
        """Of a VTOL no return is judged: that is said, and nothing written."""
        self.returns((12, 22), self.beyond(), code=1)
        _, err = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--fix-returns", "cured.plan", code=1)
        self.assertIn("cured.plan: not written: found no rally points", err)
        self.assertFalse((self.folder / "cured.plan").exists())

    def test_what_a_cure_is_written_to(self):
        self.returns(COPTER, self.beyond(), code=1)
        check = ("--terrain", "ridge.asc", "--returns", "--fix-returns")
        for mission, file, says in (("mission.plan", "cure.waypoints", "expected a name that ends in .param"),
                                    ("mission.plan", "cure", "expected a name that ends in .param"),
                                    ("mission.waypoints", "cure.plan", "rally points are added to a .plan, found")):
            (self.folder / "mission.waypoints").write_text("QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t47\t8\t400\t1\n")
            _, err = self.call(mission, *check, file, code=3)
            self.assertIn(says, err)
            self.assertFalse((self.folder / file).exists())

    def test_a_rally_point_beyond_the_ridge(self):
        told = self.returns(COPTER, self.beyond(), rally=[(1900, 60, 20)], code=0)
        self.assertEqual(told["returns"]["verdict"], "pass", told["returns"])
        # One that is farther away than its limit does not help, one nearby in the ridge's shadow harms.
        told = self.returns(COPTER, self.beyond(), rally=[(1900, 60, 20)], parameters={"RALLY_LIMIT_KM": 0.02}, code=1)
        self.assertEqual(told["returns"]["verdict"], "fail")

    def test_words(self):
        self.returns(COPTER, self.beyond(), code=1)
        out, _ = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", code=1)
        self.assertRegex(out, r"returns fail: 1 part of the flight without a way home\n"
                              r"  from \d+ min \d+ s \(item 4 \(waypoint\)\) to .*: a return's way home: flies into "
                              r"the ground, up to 1\d\d\.\d m below its surface")
        for file, option in (("c.html", "--certificate"), ("j.xml", "--junit")):
            self.call("mission.plan", "--terrain", "ridge.asc", "--returns", option, file, code=1)
            self.assertIn("flies into the ground", (self.folder / file).read_text())

    def test_an_aeroplane_whose_return_flies_into_the_hill(self):
        way = [(16, 300, 0, 260), (16, 1400, 0, 260), (16, 2000, 0, 260), (20, 0, 0, 0)]
        told = self.returns(PLANE, way, code=1)
        self.assertEqual(told["returns"]["verdict"], "fail")
        self.assertEqual(told["returns"]["refused"][0]["rule"], "ground")
        told = self.returns(PLANE, way, parameters={"RTL_ALTITUDE": 260}, code=0)
        self.assertEqual(told["returns"]["verdict"], "pass", told["returns"])

    def test_an_aeroplane_above_its_return_height(self):
        """It sinks on a line to home, as high above the ridge as far from home; from little above, at once."""
        way = [(16, 2400, -300, 500), (16, 2400, 300, 500)]
        self.assertEqual(self.returns(PLANE, way)["returns"]["verdict"], "pass")
        for parameters in ({"ALT_SLOPE_MIN": 0}, {"ALT_SLOPE_MIN": 450}, {"RTL_ALTITUDE": 20}):
            told = self.returns(PLANE, way, parameters=parameters)
            self.assertEqual(told["returns"]["verdict"], "fail", parameters)

    def test_an_aeroplane_that_flies_fast_for_a_while(self):
        """Beside the ridge: it turns there at that speed, though the mission ends at another."""
        slow = [(16, 400, -200, 150), (16, 400, 500, 150), (16, 0, 600, 150)]
        fast = [slow[0], (178, 22), slow[1], (178, 12), slow[2]]
        self.assertEqual(self.returns(PLANE, slow, parameters={"RTL_ALTITUDE": 150}, code=0)["verdict"], "pass")
        told = self.returns(PLANE, fast, parameters={"RTL_ALTITUDE": 150}, code=1)
        self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", "fail"), told)

    def test_an_aeroplane_with_a_rally_point(self):
        # Beyond the ridge its own height counts; at 70 m it circles clear of the ridge.
        way = [(16, 300, 0, 260), (16, 1300, 0, 260), (16, 2000, 0, 260)]
        told = self.returns(PLANE, way, rally=[(2000, 300, 260)], code=0)  # it ends with a return to the rally point
        self.assertEqual(told["returns"]["verdict"], "pass", told["returns"])

    AUTO_RTL = {"FS_THR_ENABLE": 6}
    # Return paths on both sides of the ridge; the first is flown by the mission, too.
    BEYOND = [(188,), (16, 1900, 200, 60), (189,), (21, 1900, 300, 0)]
    AT_HOME = [(188,), (16, 100, -100, 100), (189,), (21, 0, -200, 0)]

    def test_a_copter_that_joins_a_return_path(self):
        way = self.beyond() + self.BEYOND + self.AT_HOME
        told = self.returns(COPTER, way, parameters=self.AUTO_RTL, code=0)
        self.assertEqual(told["returns"]["verdict"], "pass", told["returns"])
        self.assertEqual(told["returns"]["parameters"]["FS_THR_ENABLE"], 6)
        # Another failsafe returns home at 15 m: it counts as well, and so does the one that none changes.
        for parameters in ({**self.AUTO_RTL, "BATT_FS_LOW_ACT": 2}, {"RTL_ALT_M": 15}):
            told = self.returns(COPTER, way, parameters=parameters, code=1)
            self.assertEqual(told["returns"]["refused"][0]["rule"], "ground", told["returns"])
        # The landing that a return path lacks is joined in its place, and home where there is neither.
        told = self.returns(COPTER, self.beyond() + [(189,), (21, 1900, 300, 0)] + self.AT_HOME[1:],
                            parameters=self.AUTO_RTL)
        self.assertNotIn("the way home", str(told["returns"]["refused"]))
        told = self.returns(COPTER, self.beyond() + [(21, 1900, 300, 0)], parameters=self.AUTO_RTL, code=1)
        self.assertIn("the way home", str(told["returns"]["refused"]))

    def test_a_return_path_through_the_ridge(self):
        """On the way to it, and along it."""
        lands = self.beyond() + [(21, 1900, 300, 0)]
        told = self.returns(COPTER, lands + self.AT_HOME, parameters=self.AUTO_RTL, code=1)
        self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", "fail"), told)
        self.assertIn("the way back to the mission: flies into the ground", told["returns"]["refused"][0]["message"])
        path = [(188,), (16, 1900, 200, 60), (16, 100, 200, 60), (189,), (21, 0, 0, 0)]
        told = self.returns(COPTER, lands + path, parameters=self.AUTO_RTL, code=1)
        self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", "fail"), told)
        self.assertIn("the way along the mission: flies into the ground", str(told["returns"]["refused"]))

    def test_a_return_path_through_a_zone(self):
        lon = self.LON + 2300 / METRES / math.cos(math.radians(self.LAT))
        self.zones("z.json", self.around(lon, self.LAT + 200 / METRES, 0.001), 900)
        lands = self.beyond() + self.BEYOND[:3]
        for path, code in (([(21, 1900, 300, 0)], 0), ([(16, 2600, 200, 60), (21, 2600, 100, 0)], 1)):
            told = self.returns(COPTER, [*lands, (21, 1900, 300, 0), self.BEYOND[0], (16, 1900, 190, 60), *path,
                                         *self.AT_HOME], "--airspace", "z.json", parameters=self.AUTO_RTL, code=code)
            self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", "fail" if code else "pass"), told)

    def test_a_return_path_that_does_not_land(self):
        way = [(22, 0, 0, 60), (16, -300, 0, 60), (21, -300, 100, 0), (188,), (16, -200, 100, 60), (16, -100, 100, 60)]
        told = self.returns(COPTER, way, parameters=self.AUTO_RTL, code=1)
        self.assertIn("ends in the air", str(told["returns"]["refused"]))
        # Where the mission is on it already, too; and one that waits for its pilot.
        told = self.returns(COPTER, way[:2] + way[3:], parameters=self.AUTO_RTL, code=1)
        self.assertIn("ends in the air", str(told["returns"]["refused"]))
        self.assertGreater(told["returns"]["refused"][-1]["to_s"], sum(told["parts"][-1]["time_s"]) / 2 - 1)
        told = self.returns(COPTER, way[:2] + way[3:5] + [(17, -100, 100, 60), (21, -100, 0, 0)],
                            parameters=self.AUTO_RTL, code=1)
        self.assertIn("stays here for ever", str(told["returns"]["refused"]))

    def test_an_aeroplane_that_joins_the_mission(self):
        way = [(16, 300, 0, 260), (16, 1400, 0, 260), (16, 2000, 0, 260), (188,), (16, 2300, 300, 160), (189,),
               (16, 2300, -400, 150), (21, 2300, -1400, 0)]
        for parameters, verdict in (
                ({"RTL_AUTOLAND": 4, "FS_SHORT_ACTN": 0}, "pass"), ({"RTL_AUTOLAND": 2}, "pass"), ({"RTL_AUTOLAND": 3}, "fail"),
                ({"RTL_AUTOLAND": 1}, "fail"), ({"RTL_AUTOLAND": 1, "RTL_ALTITUDE": 260}, "pass"),
                ({"RTL_AUTOLAND": 3, "RTL_ALTITUDE": 260}, "pass"),
                ({"RTL_AUTOLAND": 2.4}, "pass"), ({"RTL_AUTOLAND": 2, "FS_LONG_ACTN": 4}, "not_judged"),
                ({"RTL_AUTOLAND": 2, "BATT_FS_LOW_ACT": 2}, "not_judged")):
            with self.subTest(parameters):
                told = self.returns(PLANE, way, parameters=parameters)
                self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", verdict), told)
        # A path on the other side of the ridge is reached through it.
        way[4:5] = [(16, 300, 300, 100), (16, 300, 1200, 230), (16, 2300, 1200, 230)]
        told = self.returns(PLANE, way, parameters={"RTL_AUTOLAND": 4}, code=1)
        self.assertIn("the way back to the mission: ", str(told["returns"]["refused"]))

    def test_a_copters_own_return_begins_anew(self):
        """A failsafe during it climbs once more, and chooses its place from there."""
        way = [(22, 0, 0, 30), (16, -400, 0, 30), (20, 0, 0)]
        for climb, verdict in ((0, "pass"), (20, "fail")):
            told = self.returns(COPTER, way, "--max-agl", "60", parameters={"RTL_CLIMB_MIN_M": climb})
            self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", verdict), told["returns"])
        self.assertEqual(told["returns"]["refused"][0]["item"], 3)

    def test_an_aeroplane_waits_on_its_circle_for_its_height(self):
        """Before it joins its landing: 300 m take it more than a minute."""
        way = [(16, -300, 300, 60), (16, -300, 900, 60), (189,), (16, -300, -100, 60), (21, -300, -1000, 0)]
        needed = []
        for height in (60, 360):
            told = self.returns(PLANE, way, "--battery", "1", "--power", "120", "--reserve", "0",
                                parameters={"RTL_AUTOLAND": 1, "RTL_ALTITUDE": height})
            needed.append(max(one["value"] for one in told["returns"]["refused"] if one["rule"] == "energy"))
        self.assertGreater(needed[1] - needed[0], 120 / 60)

    def test_px4_returns_in_a_cone(self):
        way = [(22, 0, 0, 60), (16, 60, 0, 60), (16, 60, 60, 5), (16, 20, 0, 5)]
        told = self.returns(PX4_COPTER, way, code=0)
        self.assertEqual(told["returns"]["verdict"], "pass", told["returns"])
        for name in ("RTL_CONE_ANG", "RTL_MIN_DIST", "RTL_RETURN_ALT"):
            self.assertIn(name, told["returns"]["parameters"])
        # It climbs 30 m; a ceiling of 20 m is kept where the cone is as wide as the flight.
        low = [(22, 0, 0, 12), (16, 30, 0, 12), (16, 60, 0, 12)]
        ceiling = "--max-agl", "20"
        self.assertEqual(self.returns(PX4_COPTER, low, *ceiling, code=1)["returns"]["verdict"], "fail")
        wide = {"RTL_CONE_ANG": 80, "RTL_MIN_DIST": 100, "NAV_ACC_RAD": 2}
        self.assertEqual(self.returns(PX4_COPTER, low, *ceiling, parameters=wide, code=0)["returns"]["verdict"], "pass")

    def test_a_return_across_a_zone(self):
        way = [(22, 0, 0, 50), (16, 0, 500, 50), (16, 500, 500, 50)]
        lon = self.LON + 250 / METRES / math.cos(math.radians(self.LAT))
        self.zones("z.json", self.around(lon, self.LAT + 250 / METRES, 0.0008), 900)
        told = self.returns(COPTER, way, "--airspace", "z.json", code=1)
        self.assertEqual((told["verdict"], told["returns"]["verdict"]), ("pass", "fail"), told)
        self.assertEqual([one["zone"] for one in told["returns"]["refused"]], ["Z"])
        self.assertEqual(told["returns"]["worst"]["item"], 3)

    def test_a_fence_that_the_return_climbs_out_of(self):
        way = [(22, 0, 0, 20), (16, 0, 200, 20)]
        fence = {"FENCE_ENABLE": 1, "FENCE_TYPE": 2, "FENCE_RADIUS": 190}
        told = self.returns(COPTER, way, parameters=fence, code=1)
        self.assertEqual(told["returns"]["verdict"], "fail")
        told = self.returns(COPTER, way, parameters={**fence, "FENCE_RADIUS": 300}, code=0)
        self.assertEqual(told["returns"]["verdict"], "pass")

    def test_what_is_not_modelled_is_not_judged(self):
        for vehicle, way, parameters, words in [
                (COPTER, self.beyond(), {"RTL_ALT_TYPE": 1}, "RTL_ALT_TYPE"),
                (COPTER, self.beyond(), {"FS_THR_ENABLE": 4, "RTL_ALT_M": 260}, "FS_THR_ENABLE 4"),
                (COPTER, self.beyond(), {"BATT2_FS_CRT_ACT": 1, "RTL_ALT_M": 260}, "BATT2_FS_CRT_ACT 1"),
                (PLANE, self.beyond(False), {"FS_LONG_ACTN": 2, "RTL_ALTITUDE": 260}, "FS_LONG_ACTN 2"),
                (COPTER, self.beyond() + [(21, 1900, 300, 0)] + self.AT_HOME[:2] + [(177, 6, 1)] + self.AT_HOME[2:],
                 self.AUTO_RTL, "jumps"),
                (COPTER, [(22, 0, 0, 60), (16, -300, 0, 60), (21, -300, 100, 0), (189,), (179, 1), (16, -300, -100, 60),
                          (21, 0, -200, 0)], self.AUTO_RTL, "whether it sets its home where it joins the mission"),
                (PX4_COPTER, self.beyond(), {"RTL_TYPE": 2, "RTL_RETURN_ALT": 250}, "RTL_TYPE"),
                (PX4_COPTER, self.beyond() + self.LANDING, {"RTL_TYPE": 4, "RTL_RETURN_ALT": 250}, "RTL_TYPE 4"),
                (PX4_COPTER, self.beyond() + self.LANDING, {"RTL_TYPE": 5, "RTL_RETURN_ALT": 250}, "RTL_TYPE 5"),
                (PX4_COPTER, self.beyond() + [(189, 0)] + self.LANDING, {"RTL_TYPE": 3}, "mission's landing"),
                (PX4_COPTER, self.beyond()[:2] + [(178, 3)] + self.beyond()[2:] + self.LANDING, {"RTL_TYPE": 2}, "speed"),
                (PX4_COPTER, self.beyond()[:2] + [(177, 2, 1)] + self.beyond()[2:] + self.LANDING, {"RTL_TYPE": 2}, "jump"),
                (PX4_PLANE, [(22, 300, 0, 260)] + self.beyond(False) + [(21, 1900, 1200, 0)], {"RTL_TYPE": 4}, "RTL_TYPE 4"),
                (PX4_PLANE, [(22, 300, 0, 260)] + self.beyond(False) + [(21, 1900, 1200, 0)], {}, "landing"),
                (PLANE, self.beyond(False) + [(189, 0, 0, 0), (21, 1900, 300, 0)], {"RTL_AUTOLAND": 2}, "landing"),
                ((3, 20), [(84, 0, 0, 260)] + self.beyond(False) + [(85, 2900, 0, 0)], {}, "VTOL")]:
            told = self.returns(vehicle, way, parameters=parameters, code=1)
            self.assertEqual(told["returns"]["verdict"], "not_judged", (words, told["returns"]))
            self.assertIn(words, str(told["returns"]["not_judged"]), told["violations"])

    LANDING = [(21, 1900, 0, 0)]

    def test_the_types_of_px4s_returns(self):
        """To home and safe points, whichever is nearer; 2 along the mission. To a landing of the mission a copter
        sinks on its whole way, once it has climbed: not judged."""
        low, high = {}, {"RTL_RETURN_ALT": 260}
        home_side, beyond = [(100, 100, 0)], [(1900, 100, 0)]
        for type_of, way, parameters, rally, verdict in [
                (0, self.LANDING, low, (), "fail"), (3, self.LANDING, low, (), "not_judged"), (3, [], low, (), "fail"),
                (3, [], high, (), "pass"), (3, [], low, beyond, "pass"), (2, self.LANDING, low, (), "pass"),
                (1, self.LANDING, high, (), "not_judged"), (1, self.LANDING, low, home_side, "not_judged"),
                (1, [], low, (), "fail"), (1, [], low, beyond, "fail"), (1, [], low, [(1900, 100, 0), (5, 0, 0)], "fail"),
                # At a safe point alone; some versions know no such type.
                (5, self.LANDING, low, beyond, "fail"), (5, self.LANDING, high, beyond, "pass")]:
            told = self.returns(PX4_COPTER, self.beyond() + way, parameters={"RTL_TYPE": type_of, **parameters},
                                rally=rally, code=0 if verdict == "pass" else 1)
            self.assertEqual(told["verdict"], "pass", told["violations"])
            self.assertEqual(told["returns"]["verdict"], verdict, (type_of, way, parameters, rally, told["returns"]))

    def test_what_px4s_parameters_have_it_do_otherwise(self):
        high = {"RTL_TYPE": 0, "RTL_RETURN_ALT": 260}
        self.assertEqual(self.returns(PX4_COPTER, self.beyond(), parameters=high, code=0)["returns"]["verdict"], "pass")
        for name, value in [("NAV_RCL_ACT", 3), ("NAV_DLL_ACT", 1), ("COM_LOW_BAT_ACT", 2), ("NAV_ACC_RAD", 80)]:
            told = self.returns(PX4_COPTER, self.beyond(), parameters={**high, name: value}, code=1)
            self.assertEqual(told["returns"]["verdict"], "not_judged")
            self.assertIn(name, str(told["returns"]["not_judged"]))
        wing = [(22, 300, 0, 260)] + self.beyond(False) + [(21, 1900, 1200, 0)]
        for name, value in [("RTL_LAND_DELAY", 0), ("NAV_LOITER_RAD", 25)]:
            told = self.returns(PX4_PLANE, wing, parameters={"RTL_TYPE": 0, "RTL_RETURN_ALT": 300, name: value}, code=1)
            self.assertIn(name, str(told["returns"]["not_judged"]))
        for name, value in [("MPC_XY_VEL_ALL", 1), ("MPC_Z_VEL_MAX_DN", 0.2)]:
            told = self.returns(PX4_COPTER, self.beyond(), parameters={**high, name: value}, code=1)
            self.assertIn(name, str(told))

    def test_a_copter_in_a_wind_as_fast_as_itself_is_not_judged(self):
        high = {"RTL_ALT_M": 260}
        self.assertEqual(self.returns(COPTER, self.beyond(), "--wind", "9", parameters=high, code=0)["verdict"], "pass")
        told = self.returns(COPTER, self.beyond(), "--wind", "10", parameters=high, code=1)
        self.assertEqual(told["verdict"], "not_judged", told["violations"])

    def test_px4_is_no_faster_than_its_maximum(self):
        fast = self.returns(PX4_COPTER, self.beyond(), parameters={"RTL_RETURN_ALT": 260}, code=0)["returns"]
        for name in "MPC_XY_CRUISE", "MPC_XY_VEL_MAX":
            slow = self.returns(PX4_COPTER, self.beyond(), "--battery", "90", "--power", "200",
                                parameters={"RTL_RETURN_ALT": 260, name: 1}, code=1)
            self.assertIn("energy", str(slow["violations"]) + str(slow["returns"]["refused"]), (name, fast))

    def test_the_nearest_item_beyond_a_ridge(self):
        """PX4 holds before it returns along a mission, and then flies to the nearest item, the ridge or not."""
        way = [(22, 0, 0, 60), (16, 700, -900, 60), (16, 700, 900, 60), (16, 700, 900, 260), (16, 1100, 900, 260),
               (16, 1100, 0, 60), (21, 1100, -200, 0)]
        told = self.returns(PX4_COPTER, way, parameters={"RTL_TYPE": 2}, code=1)
        self.assertEqual(told["verdict"], "pass", told["violations"])
        self.assertEqual({one["item"] for one in told["returns"]["refused"]}, {3}, told["returns"]["refused"])
        self.assertEqual({one["part"] for one in told["returns"]["refused"]}, {"the way back to the mission"})

    def test_a_mission_that_is_refused_has_no_returns(self):
        told = self.returns(PX4_COPTER, [(22, 0, 0, 50), (82, 300, 0, 50)], code=1)
        self.assertEqual(told["returns"]["verdict"], "not_judged")

    def test_each_rule_that_refuses_a_stretch_is_named(self):
        lon = self.LON + 500 / METRES / math.cos(math.radians(self.LAT))
        self.zones("z.json", self.around(lon, self.LAT, 0.001), 500)
        options = "--airspace", "z.json", "--battery", "60", "--power", "360"
        told = self.returns(COPTER, self.beyond(), *options, code=1)
        last = told["returns"]["refused"][-1]
        self.assertEqual((last["rule"], [(one["rule"], one["layer"]) for one in last["others"]]),
                         ("ground", [("energy", ""), ("clearance", "z.json")]))
        out, _ = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", *options, code=1)
        self.assertRegex(out, "flies into the ground.*; also: needs .* Wh .*; also: the way home: lies up to .* 'z.json'")
        alone = self.returns(COPTER, self.beyond(), code=1)["returns"]["refused"][-1]
        self.assertEqual((alone["rule"], alone.get("others")), ("ground", None))

    def test_a_battery_that_ends_before_the_way_home(self):
        way = [(22, 0, 0, 50), (16, 0, 900, 50), (16, 0, 100, 50)]

        def returns(wh, code, *more):
            return self.returns(COPTER, way, "--battery", str(wh), "--power", "360", *more, code=code)["returns"]

        plenty = returns(100, 0)
        self.assertGreater(plenty["point_of_no_return_s"], 150)  # the end of the flight
        # 0.1 Wh a second: 240 s with the reserve, of which the climb takes 20, and the landing about 50.
        few = returns(30, 1)
        self.assertEqual([one["rule"] for one in few["refused"]], ["energy"])
        self.assertAlmostEqual(few["refused"][0]["limit"], 24)
        self.assertTrue(20 < few["point_of_no_return_s"] < 110, few)
        self.assertAlmostEqual(few["point_of_no_return_s"], few["refused"][0]["from_s"], delta=1)
        more = returns(30, 0, "--reserve", "0")
        self.assertGreater(more["point_of_no_return_s"], few["point_of_no_return_s"])
        _, err = self.call("mission.plan", "--terrain", "ridge.asc", "--battery", "30", "--power", "360", code=2)
        self.assertIn("--returns", err)

    def test_a_wait_counts_where_it_is(self):
        """On the way to a place where it waits for ten minutes it has not waited yet."""
        battery = "--battery", "60", "--power", "360", "--reserve", "0"
        for way in ([(22, 0, 0, 50), (16, 0, 900, 50), (19, 0, 1000, 50), (16, 0, 100, 50)],
                    [(22, 0, 0, 50), (16, 0, 900, 50), (16, 0, 1000, 50), (93, 0, 0, 0), (16, 0, 100, 50)]):
            items = [item(n + 1, command, self.LAT + north / METRES if north else 0, self.LON if north else 0, z,
                          params=(600 if command in (19, 93) else 0, 0, 0, 0)) for n, (command, _, north, z) in enumerate(way)]
            items[0]["params"][4:6] = [self.LAT, self.LON]
            self.write(items, firmwareType=3, vehicleType=2, plannedHomePosition=[self.LAT, self.LON, 400])
            out, _ = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--json", *battery, code=1)
            told = json.loads(out)
            arrived = next(sum(one["time_s"]) / 2 for one in told["parts"]
                           if one["items"] == ["item 2 (waypoint)", one["items"][-1]] and one["items"][-1].startswith("item 3"))
            # It has 600 s: at its place it waits beyond that, not before.
            self.assertAlmostEqual(told["returns"]["point_of_no_return_s"], arrived - 600, delta=5)

    def scenario(self, vehicle):
        (self.folder / "s.yaml").write_text(
            "altiplan: 1\nmission: mission.plan\nenvironment: [terrain: {file: ridge.asc}]\n"
            "volume: {floor_m: 0, ceiling_m: 3000}\nvehicle: %s\n" % vehicle)
        return "s.yaml"

    def test_the_battery_of_a_declared_vehicle(self):
        """As by --battery and --power, from the least to the greatest power of what the autopilot flies."""
        way = [(22, 0, 0, 50), (16, 0, 900, 50), (16, 0, 100, 50)]
        by_options = self.returns(COPTER, way, "--battery", "30", "--power", "360", "--reserve", "0.1", code=1)
        energy = by_options["energy"]
        self.assertAlmostEqual(energy["usable_wh"], 27)
        self.assertAlmostEqual(energy["min_wh"], by_options["time_s"][0] / 10)
        self.assertAlmostEqual(energy["max_wh"], by_options["time_s"][1] / 10)
        self.assertAlmostEqual(energy["farthest_m"], 900, delta=2)

        def declared(power, code, vehicle=COPTER):
            scenario = self.scenario("{energy: {capacity_wh: 37.5, usable: 0.8, reserve: 0.1, %s}}" % power)
            self.returns(vehicle, way, code=0)
            out, _ = self.call("mission.plan", "--scenario", scenario, "--returns", "--json", code=code)
            return json.loads(out)

        told = declared("power_w: 360", 1)
        for key in ("usable_wh", "min_wh", "max_wh"):
            self.assertAlmostEqual(told["energy"][key], energy[key], places=3)
        self.assertAlmostEqual(told["returns"]["point_of_no_return_s"], by_options["returns"]["point_of_no_return_s"],
                               delta=0.1)
        less, more = (declared("multirotor: {mass_kg: %s}" % mass, code) for mass, code in ((1.5, 0), (4, 1)))
        # Of 1.5 kg hover takes 176 W, a climb of 2.5 m/s 194 W.
        self.assertTrue(130 / 3600 * told["time_s"][0] < less["energy"]["min_wh"] < 176 / 3600 * told["time_s"][0])
        self.assertTrue(190 / 3600 * told["time_s"][1] < less["energy"]["max_wh"] < 200 / 3600 * told["time_s"][1])
        self.assertEqual([one["rule"] for one in more["violations"]], ["energy"])
        self.assertLess(more["returns"]["point_of_no_return_s"], told["returns"]["point_of_no_return_s"])
        unknown = declared("measured: {mass_kg: 1, level: [{airspeed_mps: 0, power_w: 99}, {airspeed_mps: 9, power_w: 99}]}",
                           1)  # it flies at 10 m/s
        self.assertEqual(unknown["returns"]["verdict"], "not_judged")
        self.assertNotIn("energy", unknown)
        out, _ = self.call("mission.plan", "--scenario", self.scenario(
            "{energy: {capacity_wh: 900, multirotor: {mass_kg: 1.5}}}"), "--returns", "--certificate", "c.html", code=0)
        self.assertRegex(out, r"  energy: \d+\.\d to \d+\.\d Wh of 720\.0 Wh that may be used \(battery 900\.0 Wh, reserve "
                              r"20 %\), up to 0\.\d{3} km from home")
        certificate = (self.folder / "c.html").read_text()
        self.assertIn("of 720.0 Wh that may be used", certificate)
        self.assertIn("point of no return", certificate)

    def test_a_page_with_the_reach_of_home(self):
        """Of a mission: ways home on the scenario's battery, its point of no return, and what `check` says."""
        way = [(22, 0, 0, 50), (16, 0, 900, 50), (16, 0, 100, 50)]
        self.returns(COPTER, way, code=0)
        scenario = self.scenario("{energy: {capacity_wh: 30, power_w: 360}}")
        told = json.loads(self.call("mission.plan", "--scenario", scenario, "--returns", "--json", code=1)[0])

        def view(*options):
            return subprocess.run([sys.argv[1], "view", "mission.plan", "-o", "page.html", *options], cwd=self.folder,
                                  capture_output=True, text=True, timeout=600)

        run = view("--scenario", scenario, "--reach")
        self.assertEqual(run.returncode, 0, run.stderr)
        page = (self.folder / "page.html").read_text()
        scene = json.loads(page[page.index('{"altiplan_scene"'):].split("</script>")[0])
        self.assertIn("a line every 5 Wh, to 24 Wh", scene["basemap"]["name"])
        last = next(one["at"] for one in scene["numbered"] if one["number"] == "point of no return")
        share = (told["returns"]["point_of_no_return_s"] - sum(told["parts"][0]["time_s"]) / 2) / (
            sum(told["parts"][1]["time_s"]) / 2 - sum(told["parts"][0]["time_s"]) / 2)
        home = next(one["at"] for one in scene["numbered"] if one["number"] == 1)
        self.assertAlmostEqual(last[1] - home[1], 900 * share, delta=20)
        notes = " ".join(scene["notes"])
        for words in ("energy: ", "returns fail: ", "point of no return: ", "of 24.0 Wh that may be used"):
            self.assertIn(words, notes)
        for options, code, words in ((("--terrain", "ridge.asc", "--reach"), 2, "needs --scenario"),
                                     (("--scenario", self.scenario("{}"), "--reach"), 3, "battery is not known")):
            run = view(*options)
            self.assertEqual(run.returncode, code, run.stderr)
            self.assertIn(words, run.stderr)

    def test_a_mission_that_takes_more_than_the_battery(self):
        told = self.returns(COPTER, [(22, 0, 0, 50), (16, 0, 900, 50), (16, 0, 100, 50)], "--battery", "10", "--power",
                            "360", code=1)
        self.assertEqual(told["verdict"], "fail")
        violation, = told["violations"]
        self.assertEqual((violation["rule"], violation["unit"], violation["limit"]), ("energy", "Wh", 8))

    def test_the_battery_of_an_aeroplane_that_circles_at_home(self):
        """What it takes counts until its circle there: how long it circles is the pilot's."""
        way = [(16, 300, 600, 260), (16, -600, 600, 260), (16, -600, 0, 260), (20, 0, 0, 0)]
        told = self.returns(PLANE, way, "--battery", "60", "--power", "100", parameters={"RTL_ALTITUDE": 260}, code=0)
        self.assertIsNone(told["time_s"][1])
        at_home = next(one["time_s"][1] for one in told["parts"] if one["what"] == "the way home")
        self.assertAlmostEqual(told["energy"]["max_wh"], at_home * 100 / 3600, places=3)
        self.assertTrue(told["energy"]["circles_at_home"])
        self.returns(PLANE, way, "--battery", "6", "--power", "100", parameters={"RTL_ALTITUDE": 260}, code=1)
        # A circle that nothing ends on the way there takes more than any battery holds.
        told = self.returns(PLANE, way[:2] + [(17, -600, 300, 260)] + way[2:], "--battery", "60", "--power", "100", code=1)
        self.assertIsNone(told["energy"]["max_wh"])

    def test_an_aeroplanes_take_off_is_not_judged(self):
        way = [(22, 0, 0, 60), (16, -600, 300, 60), (16, -600, -300, 60)]
        told = self.returns(PLANE, way, "--runway", "270", parameters={"RTL_ALTITUDE": 60}, code=1)
        self.assertEqual(told["returns"]["verdict"], "not_judged", told["returns"])
        self.assertIn("item 1 (take-off): a return from an aeroplane's take-off or landing", told["returns"]["not_judged"])

    def test_the_option_needs_a_mission(self):
        _, err = self.call("--returns", "mission.plan", code=2)
        self.assertIn("is a mission: add --terrain", err)


class Referee(PlanCase):
    """Random missions over real models."""

    SAMPLES = 19  # of a leg
    # The middle of what is flown over, and how far (degrees) it reaches.
    PLACES = [("N44W072.hgt", 44.26, -71.33, 0.05), ("srtmgl3_boulder_co.asc", 40.15, -105.5, 0.045)]
    KINDS = [(COPTER, {"RTL_ALT_M": 60}), (COPTER, {"RTL_ALT_M": 300}), (PLANE, {"RTL_ALTITUDE": 150}),
             (PLANE, {"RTL_ALTITUDE": 500}), (PX4_COPTER, {"RTL_RETURN_ALT": 90}),
             (PX4_PLANE, {"RTL_TYPE": 0, "RTL_RETURN_ALT": 200}), (PX4_COPTER, {"RTL_TYPE": 2, "RTL_RETURN_ALT": 30})]

    @unittest.skipUnless(MODELS.is_dir(), "no test data: set ALTIPLAN_TEST_DATA")
    def test_no_return_is_passed_that_hits_the_ground(self):
        counts = {"hits": 0, "seconds": 0, "refused": 0}
        for number, (name, *place) in enumerate(self.PLACES):
            model = Model(name)
            for kind, (vehicle, parameters) in enumerate(3 * self.KINDS):
                if not NIGHTLY and (kind > 7 or kind % 2 != number):  # by day each kind once
                    continue
                self.judge(model, place, vehicle, parameters, random.Random(f"{name} {kind}"), counts)
        enough = 300 if NIGHTLY else 100
        self.assertGreater(counts["hits"], enough, counts)  # else it tells nothing
        self.assertGreater(counts["seconds"] - counts["refused"], enough, counts)

    @unittest.skipUnless(MODELS.is_dir() and "ALTIPLAN_SECONDS" in os.environ, "of the night")
    def test_many_seconds_over_all_models(self):
        self.SAMPLES = 250
        counts = {"hits": 0, "seconds": 0, "refused": 0}
        models = list(all_models(self.folder))
        for mission in itertools.count():
            for model, place in models:
                if counts["seconds"] >= int(os.environ["ALTIPLAN_SECONDS"]):
                    self.assertGreater(counts["hits"], 0.1 * counts["seconds"], counts)
                    return
                vehicle, parameters = self.KINDS[mission % len(self.KINDS)]
                self.judge(model, place, vehicle, parameters, random.Random(f"{model.name} {mission}"), counts)

    def judge(self, model, place, vehicle, parameters, chance, counts):
        lat, lon, far = place

        def somewhere():
            return lat + chance.uniform(-far, far), lon + chance.uniform(-far, far)

        home = min((somewhere() for _ in range(4)), key=lambda at: model.ground(*at))  # in a valley
        home = [*home, model.ground(*home)]
        east = METRES * math.cos(math.radians(lat))
        way = []
        for _ in range(5):
            at = somewhere()
            way.append((*at, model.ground(*at) + chance.uniform(60, 250)))
        items = [item(n + 2, 16, *point, frame=0) for n, point in enumerate(way)]
        if vehicle[1] == 2:
            items.insert(0, item(1, 22, home[0], home[1], 120))
        elif vehicle[0] == 12:
            items.insert(0, item(1, 22, home[0] + 0.005, home[1], 120))
            lat, lon, z = way[-1]
            items.append(item(9, 21, lat + (z - model.ground(lat, lon)) / math.tan(math.radians(4)) / METRES, lon, 0))
        type_of = parameters.get("RTL_TYPE", 0)
        if type_of == 2:
            items.append(item(9, 21, way[-1][0] + 0.001, way[-1][1], 0))
        self.write(items, firmwareType=vehicle[0], vehicleType=vehicle[1], plannedHomePosition=home)
        (self.folder / "p.param").write_text("".join(f"{name},{value}\n" for name, value in parameters.items()))
        arguments = ["mission.plan", "--terrain", model.file, *model.crs, "--params", "p.param", "--returns", "--json"]
        told = self.told(arguments)
        above = list(parameters.values())[-1]
        parts = [part for part in told["parts"] if part["what"] == "" and len(part["items"]) == 2]
        middle = [sum(part["time_s"]) / 2 if None not in part["time_s"] else 1e9 for part in told["parts"]]
        for part in parts:
            index = told["parts"].index(part)
            begin, end = middle[index - 1] if index else 0, middle[index]
            numbers = [int(words.split()[1]) for words in part["items"]]
            if min(numbers) < 2 or max(numbers) > len(way) + 1:
                continue
            a, b = (way[number - 2] for number in numbers)
            for n in range(self.SAMPLES):
                share = 0.1 + 0.8 * (n + 1) / (self.SAMPLES + 1)  # away from cut corners
                at = [p + share * (q - p) for p, q in zip(a, b)]
                if vehicle == PX4_PLANE:  # its ramp ends before the item
                    at[2] = max(at[2], b[2]) if b[2] < a[2] else at[2]
                second = begin + share * (end - begin)
                is_refused = any(one["from_s"] - 5 <= second <= one["to_s"] + 5 for one in told["returns"]["refused"])
                if type_of == 2:
                    hits = any(self.is_in_ground(model, at, to, east) for to in self.joined(at, way, b, home, east))
                else:
                    hits = self.hits(model, at, home, vehicle, home[2] + above, east)
                counts["seconds"] += 1
                counts["refused"] += is_refused
                counts["hits"] += hits
                self.assertTrue(is_refused or not hits, (model.file, vehicle, parameters, second, at, told["returns"]))

    def told(self, arguments):
        run = subprocess.run([sys.argv[1], "check", *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=600)
        self.assertIn(run.returncode, (0, 1), run.stderr)
        return json.loads(run.stdout)

    @staticmethod
    def joined(at, way, end, home, east):
        """The next item, and the nearest one where no other is almost as near: none flies to the others. To its landing
        it flies level first."""
        items = [[*home[:2], home[2] + 120], *way, [way[-1][0] + 0.001, way[-1][1], home[2]]]
        metres = sorted((math.dist((one[0] * METRES, one[1] * east, one[2]), (at[0] * METRES, at[1] * east, at[2])), n)
                        for n, one in enumerate(items))
        items[-1][2] = at[2]
        return [end] + ([items[metres[0][1]]] if metres[1][0] > 1.05 * metres[0][0] + 20 else [])

    @staticmethod
    def is_in_ground(model, at, to, east):
        length = math.dist((at[0] * METRES, at[1] * east), (to[0] * METRES, to[1] * east))
        return any(at[2] + s * (to[2] - at[2]) < model.ground(at[0] + s * (to[0] - at[0]), at[1] + s * (to[1] - at[1])) - 2
                   for s in (n * 10 / length for n in range(1, int(length / 10) - 1)))

    def hits(self, model, at, home, vehicle, target, east):
        north, west = (home[0] - at[0]) * METRES, (home[1] - at[1]) * east
        length = math.hypot(north, west)
        for n in range(1, int(length / 10)):
            along = 10 * n
            if vehicle == PLANE:  # it climbs by up to 5 m/s at 12 m/s, or sinks on a line
                z = min(target, at[2] + along * 5.75 / 10) if at[2] < target else at[2] + along / length * (target - at[2])
            else:
                z = max(at[2], target)
                if vehicle == COPTER and at[2] < target:
                    z = max(at[2], min(target, home[2] + 3 * length))
            share = along / length
            if z < model.ground(at[0] + share * (home[0] - at[0]), at[1] + share * (home[1] - at[1])) - 2:
                return True
        return False


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
