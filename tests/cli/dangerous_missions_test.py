# SPDX-License-Identifier: Apache-2.0
"""dangerous_missions_test.py PROGRAM SOURCES: missions that look harmless on a map, and are not flown so. Each is a
row: who flies it, its items in metres east and north of home, what is around it; none may pass."""
import json
import math
import sys
import unittest

from plan_case import PlanCase

LON, LAT, GROUND = 8.0, 47.0, 400.0
VEHICLES = {"ArduPilot copter": (3, 2), "ArduPilot plane": (3, 1), "ArduPilot VTOL": (3, 20),
            "PX4 copter": (12, 2), "PX4 plane": (12, 1), "PX4 VTOL": (12, 20)}
COPTER, PLANE, VTOL, PX4_COPTER, PX4_PLANE, PX4_VTOL = VEHICLES
WGS84 = ('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
         'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')


def lonlat(x, y):
    return LON + x / (111320 * math.cos(math.radians(LAT))), LAT + y / 111320


def to(number, x, y, height, *params, frame=3):
    lon, lat = lonlat(x, y)
    return number, frame, [*params, 0, 0, 0, 0][:4] + [lat, lon, height]


def do(number, *params):
    return number, 2, [*params, 0, 0, 0, 0][:4] + [0, 0, 0]


def way(x, y, height=50, *params):
    return to(16, x, y, height, *params)


def off(height=50):
    return to(22, 0, 0, height)


HOME, UP = do(20), to(84, 0, 0, 50)
SECOND = [off(), way(400, 0), to(21, 400, 0, 0), do(211, 1), do(93, 5), off(), way(800, 0)]
# Name, vehicle, items, zone (west, south, east, north, floor, ceiling), parameters, rule or words of the refusal.
MISSIONS = [
    ("a return from a jump that jumps for ever", PLANE, [way(0, 0, 100), way(800, 0, 100), do(177, 3, -1)],
     (300, -60, 500, 60, 600, 900), {}, "jumps from jump to jump"),
    ("a home where nobody knows", COPTER, [do(179, 1), way(200, 0), way(300, 0)], None, {}, "sets its home there"),
    ("no home of a plane is at 0, 0, 0", PLANE, [way(0, 0, 100), do(179), way(900, 0, 100), HOME], None, {}, "clearance"),
    ("a home in the air after a climb above the ground", COPTER,
     [off(), to(16, 300, 0, 30, frame=10), to(179, 100, 0, 5, frame=10),
      way(300, 0)], None, {}, "a home at a height above the ground"),
    ("a landing from a height that nobody knows", COPTER, [to(21, 300, 0, 50)], (280, -20, 320, 20, 460, 2000), {},
     "the height from which it sinks"),
    ("a take-off of a plane that flies", PLANE,
     [way(0, 0), way(600, 0), to(22, 0, 0, 200), way(600, 800, 200)], None, {}, "a take-off in flight"),
    ("a take-off of a VTOL that flies", VTOL, [UP, way(900, 0), to(84, 0, 0, 100), way(1800, 0, 100), HOME],
     None, {}, "a take-off in flight"),
    ("a wait on a circle", COPTER,
     [off(), to(18, 300, 0, 50, 1, 0, 100), (19, 3, [10, 0, 0, 0, 0, 0, 0]), way(0, 0)], None, {},
     "where on its circle"),
    ("a VTOL that speeds up past its first item", VTOL, [UP, way(40, 0), way(40, 900), HOME],
     (120, -60, 180, 60, 0, 2000), {}, "transition"),
    ("the same with PX4", PX4_VTOL, [to(84, 40, 0, 50), way(40, 600), way(0, 0), to(85, 0, 0, 0)],
     (150, -60, 230, 60, 0, 2000), {}, "transition"),
    ("a VTOL that points away from its way", VTOL, [UP, way(900, 0), way(900, 900), HOME], None, {"HEADING": 180},
     "where it points"),
    ("a VTOL that speeds up nobody knows where to", VTOL, [UP, HOME], None, {}, "where it points"),
    ("a corner before a landing, cut", PLANE, [way(-1200, 0, 100), way(0, 0, 100), to(21, 0, 1200, 0)],
     (-60, 20, -25, 55, 0, 2000), {}, "landing"),
    ("a corner before a landing, overshot", PLANE, [way(-1200, 0, 100), way(0, 0, 100), to(21, -1200, 200, 0)],
     (15, 30, 60, 90, 0, 2000), {}, "landing"),
    ("the same with PX4", PX4_PLANE,
     [to(22, 300, 0, 50), way(2000, 0, 100), way(2000, -1500, 100), to(21, 500, -1500, 0)],
     (1955, -1490, 1985, -1465, 0, 2000), {}, "landing"),
    ("items that are reached from afar", PX4_COPTER,
     [off(), way(0, 400, 50, 0, 500), way(400, 400, 50, 0, 500), way(800, 400, 50, 0, 500), way(1200, 0)],
     (380, 60, 420, 120, 0, 2000), {}, "clearance"),
    ("heights that follow the ground", PLANE, [way(0, 0, 100), way(900, 0, 100), HOME], None,
     {"TERRAIN_FOLLOW": 1}, "TERRAIN_FOLLOW"),
    ("heights that are shifted", PLANE, [way(0, 0, 100), way(900, 0, 100), HOME], None, {"ALT_OFFSET": -80},
     "ALT_OFFSET"),
    ("climbs that are not ramps", PLANE, [way(0, 0, 100), way(2000, 0, 200), HOME], None,
     {"FLIGHT_OPTIONS": 1 << 14}, "FLIGHT_OPTIONS"),
    ("a VTOL that takes off as a plane", VTOL, [UP, way(900, 0), HOME], None, {"Q_OPTIONS": 2}, "Q_OPTIONS"),
    ("a return above the ground", COPTER, [off(), way(400, 0), HOME], None, {"RTL_ALT_TYPE": 1}, "RTL_ALT_TYPE"),
    ("a return to a landing", PX4_COPTER,
     [off(), way(400, 0), HOME, do(189), to(21, 100, 100, 0)], None, {"RTL_TYPE": 1}, "RTL_TYPE"),
    ("a second flight after a landing", COPTER, SECOND, (550, -50, 650, 50, 0, 2000), {"MIS_OPTIONS": 4}, "clearance"),
    ("the same with parameters nobody knows", COPTER, SECOND, (550, -50, 650, 50, 0, 2000), {}, "clearance"),
    ("a second flight behind a condition", COPTER, SECOND[:3] + [do(112, 5)] + SECOND[5:],
     (550, -50, 650, 50, 0, 2000), {"MIS_OPTIONS": 4}, "clearance"),
    ("a jump behind a landing", COPTER, SECOND[:3] + [do(177, 1, 2)], None, {"MIS_OPTIONS": 4}, "a jump behind its landing"),
    ("a landing on the way, within a zone", COPTER, SECOND, (390, -10, 410, 10, 0, GROUND + 30), {}, "the landing"),
    ("the autopilot's own ceiling", COPTER, [off(), way(100, 0, 150)], None, {"FENCE_ENABLE": 1}, "FENCE_ALT_MAX"),
    ("the autopilot's own circle", COPTER, [off(), way(400, 0)], None, {"FENCE_ENABLE": 1}, "FENCE_RADIUS"),
    ("the same, switched on in flight", COPTER, [off(), do(207, 1), way(400, 0)], None, {}, "FENCE_RADIUS"),
    ("the same with PX4", PX4_COPTER, [off(), way(400, 0)], None, {"GF_MAX_HOR_DIST": 300}, "GF_MAX_HOR_DIST"),
    ("no arming with a landing that is not used", PLANE,
     [way(0, 0, 100), do(189), way(900, 900, 80), to(21, 900, 2000, 0)], None, {"RTL_AUTOLAND": 0}, "RTL_AUTOLAND"),
    ("more than is stored", COPTER, [off()] + [way(10 + n, 0) for n in range(1400)], None, {}, "SD card"),
    ("more than most store", PX4_COPTER, [off()] + [way(10 + n, 0) for n in range(600)], None, {}, "most store 500"),
    ("more jumps than are run", COPTER, [off()] + [way(90, 0), do(177, 2, 1)] * 16, None, {}, "some boards run 15"),
    ("a spline", COPTER, [off(), to(82, 200, 0, 50), to(82, 300, 100, 50), way(500, 0)], None, {}, "spline"),
    ("a climb on the same course", PLANE, [way(0, 0, 100), way(900, 0, 100), do(30, 1), way(1800, 0, 200)], None, {},
     "replace it by waypoints"),
    ("a corner on the way home, with items behind", PLANE,
     [way(-1500, 0, 100), way(0, 0, 100), HOME, way(1500, 0, 100)], (-60, 15, -30, 45, 0, 2000), {}, "clearance"),
    ("a way on after many rounds", PLANE,
     [way(0, 0, 100), way(1500, 0, 100), do(177, 1, 10), way(1500, 1500, 100)], (1400, 600, 1650, 700, 0, 2000), {},
     "item 2 (waypoint)\", \"item 4"),
    ("a jump for ever that PX4 ends", PX4_COPTER,
     [off(), way(200, 0), way(300, 0), do(177, 2, -1), way(600, 0)], (400, -50, 500, 50, 0, 2000), {}, "inside what"),
    ("an item that an aeroplane has just passed", PLANE,
     [way(0, 0, 100), way(900, 0, 100), do(177, 2, -1)], (800, 90, 1000, 400, 0, 2000), {}, "just passed"),
    ("a counted jump ahead in a loop for ever", COPTER,
     [off(), way(200, 0), do(177, 5, 5), way(200, 800), way(400, 0), do(177, 2, -1)], (150, 700, 250, 900, 0, 2000), {},
     "clearance"),
    ("an order that is lost", COPTER,
     [off(20), way(50, 0, 20), do(203), do(178, 1, 10), way(50, 0, 20), way(700, 0, 20)], None, {"WP_SPD": 2},
     "may be lost"),
    ("a fence that 1.5 turns on", COPTER, [off(), do(207, 1.5), way(600, 0)], None, {}, "FENCE_RADIUS"),
    ("an engine that -1 stops", PLANE, [way(-900, 0, 100), do(223, -1), way(900, 0, 100)], None, {}, "engine"),
    ("a rate of climb that no copter flies", COPTER, [off(), do(178, 2, 30), way(100, 0, 90)], None, {}, "rate of climb"),
    ("a VTOL that slows down beyond its landing", PX4_VTOL,
     [to(84, 300, 0, 50), way(900, 0), to(85, 1500, 0, 0)], (1520, -30, 1560, 30, 0, 2000), {}, "change to hover"),
    ("a return before anything is flown", VTOL, [HOME, way(600, 0), way(0, 600)], None, {}, "the mission ends before"),
    ("a jump that repeats -2 times", COPTER, [off(), way(200, 0), do(177, 2, -2), way(600, 0)],
     (400, -50, 500, 50, 0, 2000), {}, "clearance"),
    ("a jump ahead for ever in a loop that ends", COPTER,
     [off(), way(200, 0), do(177, 5, -1), way(200, 300), do(177, 2, 3), way(600, 0)], (400, -50, 500, 50, 0, 2000),
     {}, "clearance"),
    ("a home behind a condition", COPTER, [off(), way(200, 0), do(112, 20), to(179, 100, 0, 5), way(400, 0), HOME], None,
     {}, "a condition lets it set its home"),
    ("a fence about a new home", COPTER, [off(), to(179, 100, 0, 5, frame=0), way(380, 0)], None, {"FENCE_ENABLE": 1},
     "set anew"),
    ("an altitude of 0 above the ground", COPTER, [off(), way(100, 0), to(16, 300, 0, 0, frame=10)], None, {},
     "keeps the height above the ground"),
    ("a VTOL that takes off as a copter", PX4_VTOL, [off(), way(600, 0), to(85, 0, 0, 0)], None, {}, "as a copter"),
    ("a return that is no landing", PX4_VTOL, [to(84, 300, 0, 50), way(900, 0), HOME], None, {}, "without a landing"),
    ("a return along the mission", PX4_VTOL, [to(84, 300, 0, 50), way(900, 0), HOME, to(85, 0, 0, 0)], None,
     {"RTL_TYPE": 4}, "RTL_TYPE"),
    ("a landing start", PLANE, [way(0, 0, 100), do(189), way(900, 900, 80), to(21, 900, 2000, 0)], None, {},
     "RTL_AUTOLAND"),
    ("a speed that ends with the mission", PLANE,
     [way(-1500, 0, 100), do(178, 0, 9), way(0, 0, 100), HOME], None, {"MIN_GROUNDSPEED": 22}, "MIN_GROUNDSPEED"),
    ("an aeroplane that hovers", PLANE, [way(0, 0, 100), way(600, 0, 100)], None, {"Q_ENABLE": 1}, "--vehicle vtol"),
    ("a long wait above home", COPTER, [off(), way(100, 0), HOME], None, {"RTL_LOIT_TIME": 600000}, "RTL_LOIT_TIME"),
    ("parameters in small letters", COPTER, [off(), way(100, 0), HOME], (30, -50, 60, 50, GROUND + 55, GROUND + 90),
     {"rtl_alt": 6000}, "clearance"),
    ("a gate at an item", PX4_COPTER, [off(), way(100, 0), to(4501, 100, 0, 50), way(200, 0)], None, {}, "a gate so near"),
    ("a VTOL that does not arm", VTOL, [UP, way(900, 0), way(1200, 0), to(85, 1215, 0, 0)], None, {}, "does not arm"),
    ("a VTOL that cannot brake", VTOL, [UP, way(900, 0), way(1200, 0), to(85, 1230, 0, 0)], None, {}, "can slow down"),
    ("jumps within jumps", COPTER,
     [off(), way(100, 0), way(200, 0), do(177, 2, 5), way(300, 0), do(177, 2, 5), HOME], None, {},
     "differs between versions"),
    ("a turn at the first item", PLANE, [way(1000, 0, 100), way(-500, 0, 100), HOME], (1010, 20, 1060, 110, 0, 2000),
     {}, "clearance"),
    ("a landing in the air", PLANE, [way(-1200, 0, 100), way(0, 0, 100), to(21, 0, 1200, 12)], None, {},
     "ends 12.0 m above the ground"),
    ("wind", PLANE, [way(-1500, 0, 100), way(0, 0, 100), way(0, 1500, 100), HOME], (70, 20, 100, 120, 0, 2000),
     {"WIND": 4}, "clearance"),
]


HOMES = {"a corner on the way home, with items behind": (0, 1500), "wind": (-1500, -900), "no wind": (-1500, -900)}


class Dangerous(PlanCase):
    def setUp(self):
        super().setUp()
        n, cell = 121, 0.0005
        (self.folder / "flat.asc").write_text(
            f"ncols {n}\nnrows {n}\nxllcorner {LON - n / 2 * cell}\nyllcorner {LAT - n / 2 * cell}\n"
            f"cellsize {cell}\n" + "\n".join(" ".join([str(GROUND)] * n) for _ in range(n)) + "\n")
        (self.folder / "flat.prj").write_text(WGS84)

    def arguments(self, name, vehicle, items, zone, parameters):
        arguments = ["mission.plan", "--terrain", "flat.asc", "--json"]
        firmware, kind = VEHICLES[vehicle]
        lon, lat = lonlat(*HOMES.get(name, (0, 0)))
        self.write([{"type": "SimpleItem", "command": number, "frame": frame, "doJumpId": n + 1,
                     "autoContinue": True, "params": params} for n, (number, frame, params) in enumerate(items)],
                   firmwareType=firmware, vehicleType=kind, plannedHomePosition=[lat, lon, GROUND])
        if zone:
            west, south, east, north, floor, ceiling = zone
            self.zones("zones.json", [list(lonlat(*p)) for p in (
                (west, south), (east, south), (east, north), (west, north), (west, south))], ceiling, floor=floor)
            arguments += ["--airspace", "zones.json"]
        parameters = dict(parameters)
        if wind := parameters.pop("WIND", None):
            arguments += ["--wind", str(wind)]
        if vehicle == VTOL:
            arguments += ["--runway", str(parameters.pop("HEADING", 90))]
        if parameters:
            (self.folder / "p.param").write_text("".join(f"{k},{v}\n" for k, v in parameters.items()))
            arguments += ["--params", "p.param"]
        return arguments

    def test_none_passes(self):
        for name, vehicle, items, zone, parameters, words in MISSIONS:
            with self.subTest(name):
                arguments = self.arguments(name, vehicle, items, zone, parameters)
                answer = json.loads(self.call(*arguments, code=1)[0])
                said = json.dumps(answer["violations"])
                self.assertIn(words, said)

    def test_the_last_round_counts(self):
        """A zone that is closed when a jump leads there again and again."""
        for repeats, code in ((2, 0), (30, 1), (-1, 1)):
            arguments = self.arguments("", COPTER, [off(), way(300, 0), way(0, 0), do(177, 2, repeats)], None, {})
            self.zones("hours.json", [list(lonlat(*p)) for p in (
                (100, -50), (200, -50), (200, 50), (100, 50), (100, -50))], 2000,
                schedule={"startTime": "10:20:00Z", "endTime": "11:00:00Z"})
            self.call(*arguments, "--airspace", "hours.json", "--start-time", "2026-05-01T10:00:00Z", code=code)

    def test_what_is_like_them_and_harmless_passes(self):
        for name, vehicle, items, zone, parameters in (
                ("a jump back twice", COPTER, [off(), way(200, 0), way(300, 0), do(177, 2, 2), HOME], None, {}),
                ("a corner before a landing", PLANE,
                 [way(-1200, 0, 100), way(0, 0, 100), to(21, 0, 1200, 0)], None, {"RTL_AUTOLAND": 1}),
                ("a landing at a height that is a little off", PLANE,
                 [way(-1200, 0, 100), way(0, 0, 100), to(21, 0, 1200, 9)], None, {}),
                ("low, and places within each other's reach", PX4_COPTER, [off(4), way(20, 0, 4), to(21, 20.4, 0, -1)],
                 None, {}),
                ("a VTOL", VTOL, [UP, way(900, 0), way(900, 900), HOME], None, {}),
                ("a second flight", COPTER, SECOND, (550, 50, 650, 90, 0, 2000), {"MIS_OPTIONS": 4}),
                ("none after a landing that ends it", COPTER, SECOND, (550, -50, 650, 50, 0, 2000), {"MIS_OPTIONS": 0}),
                ("none where it disarms", COPTER, SECOND, (550, -50, 650, 50, 0, 2000),
                 {"MIS_OPTIONS": 4, "DISARM_DELAY": 5}),
                ("a fence that is wide", COPTER, [off(), way(200, 0)], None, {"FENCE_ENABLE": 1}),
                ("no wind", PLANE, [way(-1500, 0, 100), way(0, 0, 100), way(0, 1500, 100), HOME],
                 (70, 20, 100, 120, 0, 2000), {})):
            with self.subTest(name):
                self.call(*self.arguments(name, vehicle, items, zone, parameters), code=0)

    def test_old_and_new_name_of_a_parameter(self):
        arguments = self.arguments("", COPTER, [off(), way(200, 0), HOME], None, {"RTL_ALT": 6000, "RTL_ALT_M": 15})
        self.assertIn("RTL_ALT_M: expected it or its older name RTL_ALT", self.call(*arguments, code=3)[1])

    def test_what_follows_the_end_of_a_file(self):
        arguments = self.arguments("", COPTER, [off(), way(200, 0), HOME], None, {})
        with open(self.folder / "mission.plan", "ab") as file:
            file.write(b"\n \0\0")
        self.assertIn("mission.plan:2:2: expected JSON, found a byte of value 0", self.call(*arguments, code=3)[1])

    def test_what_a_ground_station_shows_and_what_is_flown(self):
        arguments = self.arguments("", COPTER, [off(), way(200, 0), way(300, 0), HOME], None, {})
        file = self.folder / "mission.plan"
        plan = json.loads(file.read_text())
        height = plan["mission"]["items"][1]["params"][6]
        for keys, words in (
                ({"Altitude": height + 70}, f"is not flown as QGroundControl shows it: its Altitude is {height + 70:.1f} m"),
                ({"Altitude": 50, "AltitudeMode": 3, "AMSLAltAboveTerrain": height + 9}, "its AMSLAltAboveTerrain is"),
                ({"Altitude": height, "AltitudeMode": 2}, "its AltitudeMode is 2, but its frame is 3, which is flown"),
                ({"Altitude": height, "AltitudeMode": 1, "AMSLAltAboveTerrain": None}, ""),
                ({"Altitude": height, "AltitudeMode": 0}, "")):
            with self.subTest(keys):
                plan["mission"]["items"][1].update(keys)
                file.write_text(json.dumps(plan))
                out, _ = self.call(*arguments, code=None)
                self.assertIn(words, out)
                self.assertEqual("as QGroundControl shows it" in out, bool(words))
                for key in keys:
                    del plan["mission"]["items"][1][key]

    def test_items_of_one_number(self):
        arguments = self.arguments("", COPTER, [off(), way(200, 0), way(300, 0), do(177, 2, 2)], None, {})
        file = self.folder / "mission.plan"
        plan = json.loads(file.read_text())
        plan["mission"]["items"][2]["doJumpId"] = 2
        file.write_text(json.dumps(plan))
        self.assertIn("several items of that number", self.call(*arguments, code=1)[0])

    def test_a_return_of_px4_to_a_rally_point(self):
        items = [to(22, 300, 0, 50), way(1500, 0, 150), HOME, way(1500, -500, 60), to(21, 1500, -1500, 0)]
        arguments = self.arguments("", PX4_PLANE, items, None, {"RTL_TYPE": 0})
        file = self.folder / "mission.plan"
        plan = json.loads(file.read_text())
        lon, lat = lonlat(1500, 300)
        plan["rallyPoints"] = {"points": [[lat, lon, 60]], "version": 2}
        file.write_text(json.dumps(plan))
        self.call(*arguments, "--max-agl", "165", code=0)
        self.assertIn("the height above ground is 160.00 m", self.call(*arguments, "--max-agl", "155", code=1)[0])

    def test_parameters_with_which_nothing_flies(self):
        for parameter, value in (("WP_SPD", 0), ("NAVL1_PERIOD", 0), ("ROLL_LIMIT_DEG", 90), ("AIRSPEED_CRUISE", -5)):
            vehicle = COPTER if parameter == "WP_SPD" else PLANE
            items = [off(), way(200, 0)] if vehicle == COPTER else [way(0, 0), way(900, 0), HOME]
            _, err = self.call(*self.arguments("", vehicle, items, None, {parameter: value}), code=3)
            self.assertIn(parameter, err)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=0)
