# SPDX-License-Identifier: Apache-2.0
"""zone_options_test.py PROGRAM SOURCES: `--permission` and `--buffer` of `go` and `check`.

`python3 zone_options_test.py PROGRAM SOURCES Permission.test_a_route_through_it` runs one case."""
import json
import math
import subprocess
import sys
import unittest

from plan_case import PROGRAM, TERRAIN, PlanCase, item, plan_of

ENDS = ("--from", "-84.38,36.48", "--to", "-84.20,36.62")
METRES = 6371008.8 * math.pi / 180


def box(west, south, width, height):
    return [[west, south], [west + width, south], [west + width, south + height],
            [west, south + height], [west, south]]


def zone(identifier, name, restriction, ring, ceiling=9000):
    geometry = {"uomDimensions": "M", "lowerLimit": 0, "lowerVerticalReference": "AGL",
                "upperLimit": ceiling, "upperVerticalReference": "AMSL",
                "horizontalProjection": {"type": "Polygon", "coordinates": [ring]}}
    return {"identifier": identifier, "country": "USA", "name": name, "type": "COMMON",
            "restriction": restriction, "reason": ["OTHER"], "zoneAuthority": [],
            "applicability": [{"permanent": "YES"}], "geometry": [geometry]}


RIVER = zone("USR1", "River", "REQ_AUTHORISATION", box(-84.5, 36.54, 0.5, 0.02))
PLANT = zone("USP2", "Plant", "PROHIBITED", box(-84.29, 36.53, 0.02, 0.02))


class ZoneOptions(PlanCase):
    def setUp(self):
        super().setUp()
        self.airspace("zones.json", RIVER, PLANT)
        self.airspace("plant.json", PLANT)

    def airspace(self, name, *features):
        (self.folder / name).write_text(json.dumps({"title": "test", "features": features}))

    def run_it(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                             timeout=600)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def go(self, *options, code=0):
        return self.run_it("go", "--terrain", TERRAIN, *ENDS, *options, code=code)

    def searched(self, folder):
        """The verdict in the scenario of the search, whose limits of height are narrower."""
        run = subprocess.run([PROGRAM, "check", "route.plan", "--scenario", "scenario.yaml"],
                             cwd=self.folder / folder, capture_output=True, text=True, timeout=600)
        self.assertNotIn("clearance are needed", run.stdout)
        return run.stdout

    def judge(self, plan, *options, code=0):
        return self.call(plan, "--terrain", TERRAIN, *options, code=code)[0]


class Permission(ZoneOptions):
    def test_a_route_through_it(self):
        out, _ = self.go("--avoid", "zones.json", "-o", "shut", code=1)
        self.assertIn("which enters 'USR1 (River)'", out)
        for called in ("USR1", "River"):
            with self.subTest(called):
                out, _ = self.go("--avoid", "zones.json", "--permission", called, "-o", called)
                self.assertIn("zones: zones.json: open by a permission: 'USR1 (River)'\n", out)
                self.assertIn("keep out (closed): 1 PROHIBITED", out)
        self.assertIn("note: zones.json: open by a permission: 'USR1 (River)'\n", self.searched("USR1"))
        self.run_it("run", "USR1/pipeline.yaml", "--out", "again.json")
        route = [json.loads((self.folder / file).read_text())["route"]
                 for file in ("again.json", "USR1/result.json")]
        self.assertEqual(*route)
        self.judge("USR1/route.plan", "--airspace", "zones.json", code=1)
        out = self.judge("USR1/route.plan", "--airspace", "zones.json", "--permission", "River",
                         "--certificate", "verdict.html")
        self.assertIn("note: zones.json: open by a permission: 'USR1 (River)'\n", out)
        page = (self.folder / "verdict.html").read_text()
        self.assertRegex(page, "permission had.*for .*River")
        self.assertRegex(page, "open by a permission: .*USR1 .River.")

    def test_names_that_open_nothing(self):
        self.airspace("none.json", zone("USR3", "River", "PROHIBITED", box(-84.2, 36.5, 0.01, 0.01)))
        self.write([item([-84.38, 36.48, 900], 1), item([-84.38, 36.49, 900], 2)])
        for called, said in (("Rivr", "no zone is called 'Rivr'; did you mean 'River'?"),
                             ("usr", "no zone is called 'usr'; did you mean 'USR1 (River)'?"),
                             ("forest", "no zone is called 'forest'; a permission is taken by 'USR1 (River)'"),
                             ("Plant", "no permission opens 'USP2 (Plant)' (PROHIBITED): it stays closed")):
            for command in (("go", *ENDS, "--avoid"), ("check", "mission.plan", "--airspace")):
                _, err = self.run_it(*command, "zones.json", "--terrain", TERRAIN, "--permission",
                                     called, code=2)
                self.assertIn("--permission: " + said, err)
        self.assertEqual(list(self.folder.glob("*/")), [])
        self.go("--permission", "River", code=2)  # without zones
        _, err = self.go("--avoid", "missing.json", "--permission", "River", code=3)
        self.assertIn("--avoid: missing.json: there is no such file", err)
        # An identifier that is another zone's name opens neither; said in full, that zone alone.
        self.airspace("names.json", RIVER, zone("USR9", "USR1", "REQ_AUTHORISATION", box(-84.2, 36.5, 0.01, 0.01)))
        _, err = self.run_it("check", "mission.plan", "--airspace", "names.json", "--terrain", TERRAIN, "--permission",
                             "USR1", code=2)
        self.assertIn("--permission: 'USR1' may be 'USR1 (River)', 'USR9 (USR1)': name each zone that you", err)
        out, _ = self.run_it("check", "mission.plan", "--airspace", "names.json", "--terrain", TERRAIN, "--permission",
                             "USR1 (River)")
        self.assertIn("open by a permission: 'USR1 (River)'\n", out)
        # Of two zones of one name the one that takes a permission is opened, the other is not.
        self.go("--avoid", "zones.json", "none.json", "--permission", "River", "-o", "both")
        scenario = (self.folder / "both/scenario.yaml").read_text()
        self.assertEqual(scenario.count("permitted"), 1)

    def test_all_without_a_name(self):
        high = [item([-84.30, 36.52, 1500], 1), item([-84.30, 36.58, 1500], 2)]
        self.write(high)
        options = ("--terrain", TERRAIN, "--airspace", "zones.json")
        self.call("mission.plan", *options, code=1)
        for arguments in (("mission.plan", *options, "--permission"),
                          ("--permission", "mission.plan", *options),
                          ("mission.plan", "--permission", *options),
                          ("mission.plan", *options, "--permission", "all"),
                          ("mission.plan", *options, "--permission=River")):
            out, _ = self.call(*arguments, code=0)
            self.assertIn("open by a permission: 'USR1 (River)'", out)
        through = [item([-84.28, 36.52, 1500], 1), item([-84.28, 36.58, 1500], 2)]
        self.write(through)
        out, _ = self.call("mission.plan", *options, "--permission", code=1)
        self.assertIn("'USP2 (Plant)' of 'zones.json'", out)


class WithoutOptions(ZoneOptions):
    def test_a_copter_leaves_its_line_at_a_corner_beside_a_zone(self):
        self.airspace("corner.json", zone("USP9", "Corner", "PROHIBITED",
                                          box(-84.294769, 36.546443, 0.01391, 0.006612)))
        self.assertIn("check: pass", self.go("--avoid", "corner.json")[0])


class Buffer(ZoneOptions):
    def nearest(self, folder):
        """Metres between the route and the plant, on a sphere about it."""
        plan = json.loads((self.folder / folder / "route.plan").read_text())
        points = [one["params"][4:6] for one in plan["mission"]["items"] if one["command"] == 16]
        scale = math.cos(math.radians(36.54))
        route = [((lon + 84.28) * METRES * scale, (lat - 36.54) * METRES) for lat, lon in points]
        half = (0.01 * METRES * scale, 0.01 * METRES)
        nearest = math.inf
        for (x0, y0), (x1, y1) in zip(route, route[1:]):
            count = 1 + int(math.hypot(x1 - x0, y1 - y0))
            for n in range(count + 1):
                x, y = (x0 + (x1 - x0) * n / count, y0 + (y1 - y0) * n / count)
                nearest = min(nearest, math.hypot(max(abs(x) - half[0], 0), max(abs(y) - half[1], 0)))
        return nearest

    def test_a_route_keeps_it(self):
        self.go("--avoid", "plant.json", "-o", "plain")
        self.assertLess(self.nearest("plain"), 200)
        out, _ = self.go("--avoid", "plant.json", "--buffer", "200", "-o", "wide")
        self.assertIn("zones: plant.json: 200 m are kept from each of them\n", out)
        self.assertGreater(self.nearest("wide"), 200)
        self.judge("wide/route.plan", "--airspace", "plant.json", "--buffer", "200", "--min-agl", "50")
        self.assertIn("note: plant.json: 200 m are kept from each of them\n", self.searched("wide"))
        out = self.judge("plain/route.plan", "--airspace", "plant.json", "--buffer", "200", code=1)
        self.assertRegex(out, r"\(\d+(\.\d+)? m from a zone's border, from which 200 m are kept\), where "
                              r".*: 'USP2 \(Plant\)' of 'plant.json'")
        out, _ = self.run_it("check", "--route", "plain/route.plan", "--scenario", "wide/scenario.yaml",
                             code=1)
        self.assertIn("of clearance are needed: 'USP2 (Plant)' of 'plant.json'\n", out)

    def test_why_there_is_no_route(self):
        self.airspace("near.json", zone("USP4", "Camp", "PROHIBITED", box(-84.379, 36.48, 0.01, 0.01)))
        out, _ = self.go("--avoid", "near.json", "--buffer", "100", code=1)
        self.assertIn("reason: the start lies within --buffer, 100 m, of 'USP4 (Camp)'\n", out)
        fence = {"version": 2, "circles": [], "polygons": [
            {"version": 1, "inclusion": True, "name": "County", "polygon": [[36.45, -84.41], [36.45, -84.25],
                                                                            [36.65, -84.25], [36.65, -84.41]]}]}
        (self.folder / "fence.plan").write_text(json.dumps(dict(plan_of([]), geoFence=fence)))
        out, _ = self.go("--avoid", "fence.plan", code=1)
        self.assertIn("reason: the goal lies outside 'County'\n", out)
        # A gap of 450 m.
        self.airspace("gap.json", zone("USP5", "West", "PROHIBITED", box(-84.6, 36.54, 0.3, 0.01)),
                      zone("USP6", "East", "PROHIBITED", box(-84.295, 36.54, 0.3, 0.01)))
        self.go("--avoid", "gap.json", "--buffer", "100", "-o", "through")
        out, _ = self.go("--avoid", "gap.json", "--buffer", "300", "-o", "shut", code=1)
        self.assertRegex(out, r"reason: --buffer 300 is too much: without it a route of \d+\.\d+ km is "
                              r"found, which comes nearer to 'USP5 \(West\)', 'USP6 \(East\)'")

    def test_a_mission_keeps_it_inside_its_fence(self):
        plan = {"version": 1, "inclusion": True, "polygon": [[36.4, -84.4], [36.4, -84.2], [36.5, -84.2],
                                                             [36.5, -84.4]]}
        self.write([item([-84.38, 36.4995, 1500], 1), item([-84.37, 36.4995, 1500], 2)])  # 56 m
        mission = json.loads((self.folder / "mission.plan").read_text())
        mission["geoFence"]["polygons"] = [plan]
        (self.folder / "mission.plan").write_text(json.dumps(mission))
        self.judge("mission.plan")
        self.judge("mission.plan", "--buffer", "40")
        out = self.judge("mission.plan", "--buffer", "70", code=1)
        self.assertIn("from which 70 m are kept", out)
        self.assertIn("of 'fence of the mission'", out)
        _, err = self.call("mission.plan", "--terrain", TERRAIN, "--buffer", "-1", code=2)
        self.assertIn("--buffer: expected a number", err)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
