# SPDX-License-Identifier: Apache-2.0
"""cures_test.py PROGRAM SOURCES: what `altiplan check` says against the mistakes that operators make, and what --fix and
--fix-returns write against them."""
import json
import re
import unittest

from dem_model import METRES
from plan_case import TERRAIN, PlanCase

HOME = (36.60, -84.25)  # where TERRAIN is at 513 m
FLAT = 584


def command(number, lat, lon, height, frame=3, first=0):
    return {"type": "SimpleItem", "command": number, "frame": frame, "autoContinue": True, "AltitudeMode": 1,
            "params": [first, 0, 0, 0 if frame == 2 else None, lat, lon, height]}


class Cures(PlanCase):
    def plan(self, items, home=(*HOME, 513), vehicle=2, rally=(), circle=None):
        for n, one in enumerate(items):
            one["doJumpId"] = n + 1
        self.write(items, plannedHomePosition=list(home), vehicleType=vehicle)
        plan = json.loads((self.folder / "mission.plan").read_text())
        plan["rallyPoints"]["points"] = list(rally)
        if circle:
            plan["geoFence"]["circles"] = [{"version": 1, "inclusion": True, "circle": circle}]
        (self.folder / "mission.plan").write_text(json.dumps(plan))

    def lawn(self, height, frame=3, **keys):
        """Five lines of 400 m, 60 m apart, over ground of 515 to 577 m."""
        items = [command(22, *HOME, height, frame)]
        for line in range(5):
            ends = (-84.24944, -84.24496)
            for lon in ends if line % 2 == 0 else ends[::-1]:
                items.append(command(16, HOME[0] + (50 + 60 * line) / METRES, lon, height, frame))
        self.plan([*items, command(20, 0, 0, 0, 2)], **keys)

    def flat(self, *heights, home=FLAT, landing=0, **keys):
        """An aeroplane's circuit over level ground: heights of its waypoints, or (height, frame)."""
        lat, lon = 47.0, 8.0
        with open(self.folder / "flat.asc", "w") as model:
            model.write(f"ncols 81\nnrows 81\nxllcorner {lon - 0.02}\nyllcorner {lat - 0.02}\ncellsize 0.0005\n")
            model.writelines(" ".join([str(FLAT)] * 81) + "\n" for _ in range(81))
        (self.folder / "flat.prj").write_text('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
                                              'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
        ring = [(0.001, 0.008), (0.0063, 0.008), (0.0063, -0.01), (0, -0.016), (0, -0.01)]
        items = [command(22, lat, lon + 0.0036, 50, first=10)]
        for (north, east), height in zip(ring, heights):
            metres, frame = height if isinstance(height, tuple) else (height, 3)
            items.append(command(16, lat + north, lon + east, metres, frame))
        items.append(command(21, lat, lon, landing))
        self.plan(items, home=(lat, lon, home), vehicle=1, **keys)
        return "--terrain", "flat.asc", "--runway", "90"

    def fix(self, *options):
        """What `check` prints of the mission, what it has written, which passes."""
        out, _ = self.call("mission.plan", *options, "--fix", "fixed.plan", code=1)
        self.assertTrue((self.folder / "fixed.plan").exists(), out)
        self.call("fixed.plan", *options, code=0)
        return out, json.loads((self.folder / "fixed.plan").read_text())

    def heights(self, plan):
        return [one["params"][6] for one in plan["mission"]["items"] if one["command"] in (16, 22)]

    def frames(self, plan):
        return [one["frame"] for one in plan["mission"]["items"] if one["command"] in (16, 22)]

    def test_heights_above_home_in_the_frame_of_the_sea(self):
        self.lawn(100, frame=0)
        out, plan = self.fix("--terrain", TERRAIN)
        self.assertIn("cure: as heights above home this passes: set the frame of items 1 to 11 to relative (3)", out)
        self.assertEqual(self.heights(plan), [100] * 11)
        self.assertEqual(self.frames(plan), [3] * 11)
        self.assertEqual({one["AltitudeMode"] for one in plan["mission"]["items"]}, {1})

    def test_heights_in_the_frame_of_the_sea_that_are_too_low_above_home_as_well(self):
        self.lawn(60, frame=0)
        out, plan = self.fix("--terrain", TERRAIN)
        self.assertRegex(out, r"cure: set the frame of items 1 to 11 to relative \(3\): as heights above home \d+ parts? of the "
                              r"flight fails?, in place of 12")
        self.assertEqual(self.frames(plan), [3] * 11)
        self.assertLess(max(self.heights(plan)), 100)

    def test_one_height_in_the_frame_of_the_sea(self):
        out, plan = self.fix(*self.flat(100, (100, 0), 100, 60, 30))
        self.assertIn("cure: as heights above home this passes: set the frame of item 3 (waypoint) to relative (3)", out)
        self.assertEqual(self.frames(plan), [3] * 6)

    def test_heights_of_the_sea_that_are_a_little_low_are_raised(self):
        self.lawn(600, frame=0)
        out, plan = self.fix("--terrain", TERRAIN, "--min-agl", "40")
        self.assertNotIn("relative", out)
        self.assertEqual(self.frames(plan), [0] * 11)

    def test_a_frame_in_a_file_of_lines(self):
        self.flat(100, 100, 100, 60, 30)
        lines = ["QGC WPL 110", f"0\t1\t0\t16\t0\t0\t0\t0\t47.0\t8.0\t{FLAT}\t1"]
        lines += [f"{n}\t0\t0\t{number}\t0\t0\t0\t0\t{47 + 0.001 * n}\t8.0\t100.0\t1"
                  for n, number in ((1, 22), (2, 16), (3, 16))]
        (self.folder / "m.waypoints").write_text("\n".join(lines) + "\n")
        options = ("--terrain", "flat.asc", "--vehicle", "copter", "--autopilot", "ardupilot")
        self.call("m.waypoints", *options, "--fix", "f.waypoints", code=1)
        fixed = (self.folder / "f.waypoints").read_text().splitlines()
        self.assertEqual(fixed[:2], lines[:2])
        self.assertEqual(fixed[2:], [re.sub(r"^(\d)\t0\t0", r"\1\t0\t3", line) for line in lines[2:]])
        self.call("f.waypoints", *options, code=0)

    def test_a_cure_that_raises_far_says_how_high_that_is(self):
        self.flat(100, 100, 100, 60, 30)
        (self.folder / "m.waypoints").write_text(
            "QGC WPL 110\n" + "".join(f"{n}\t0\t0\t16\t0\t0\t0\t0\t{47 + 0.001 * n}\t8.0\t{height}\t1\n"
                                      for n, height in enumerate((FLAT, 800, 300, 800))))
        options = ("--terrain", "flat.asc", "--vehicle", "copter", "--autopilot", "ardupilot")
        out, _ = self.call("m.waypoints", *options, "--max-agl", "250", code=1)
        self.assertRegex(out, r"cure: raise item 2 \(waypoint\) by \d{3}\.\d m, to \d+ m above the ground")

    def test_heights_between_two_limits(self):
        for height in (60, 120):
            self.lawn(height)
            _, plan = self.fix("--terrain", TERRAIN, "--min-agl", "40", "--max-agl", "120")
            self.assertLess(max(abs(one - height) for one in self.heights(plan)), 70)
        self.lawn(100, frame=0)
        _, plan = self.fix("--terrain", TERRAIN, "--min-agl", "30", "--max-agl", "140")
        self.assertEqual(self.frames(plan), [3] * 11)
        options = self.flat(100, 100, 100, 60, 30)
        self.plan([command(22, 47.0, 8.0, 100, 0), command(16, 47.001, 8.0, 100, 0), command(16, 47.002, 8.0, 100, 0)],
                  home=(47.0, 8.0, 0))
        _, plan = self.fix(*options[:2], "--min-agl", "30", "--max-agl", "120")
        self.assertTrue(all(30 <= height - FLAT <= 120 for height in self.heights(plan)), plan)

    def test_a_home_that_is_off_the_ground(self):
        self.lawn(120, home=(*HOME, 0))
        out, plan = self.fix("--terrain", TERRAIN)
        self.assertRegex(out, r"^fail: .*\n  home: home is at 0 m .*\n    worst at .*\n    cure: set home's altitude to 513 m: "
                              r"then the mission passes\n")
        self.assertNotIn("cure: raise", out)
        self.assertAlmostEqual(plan["mission"]["plannedHomePosition"][2], 513, delta=0.5)
        self.assertEqual(self.heights(plan), [120] * 11)
        self.lawn(60, home=(*HOME, 0))
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, "--min-agl", "40", code=1)
        self.assertRegex(out, r"cure: set home's altitude to 513 m: then \d of 12 violations are left\n")

    def test_a_return_below_the_hills(self):
        points = [(36.6, -84.25, 150), (36.6044, -84.275, 300)]
        self.plan([command(22 if n == 0 else 16, *point) for n, point in enumerate(points)] + [command(20, 0, 0, 0, 2)])
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, "--json", code=1)
        way = [one for one in json.loads(out)["violations"] if one["part"] == "the way home"]
        name, metres = re.search(r"or return higher: (RTL_ALT_M) (\d+)", way[0]["cure"]).groups()
        for less, code in ((0, None), (1, 1)):
            (self.folder / "p.param").write_text(f"{name},{int(metres) - less}\n")
            out, _ = self.call("mission.plan", "--terrain", TERRAIN, "--params", "p.param", "--json", code=code)
            left = [one for one in json.loads(out)["violations"] if one["part"] == "the way home"]
            self.assertEqual(len(left), less, left)

    def test_rally_points_in_the_ground(self):
        out, plan = self.fix(*self.flat(100, 100, 100, 60, 30, rally=[[47.005, 8.0, -30], [47.005, 8.0, 40]]))
        self.assertIn("cure: raise rally point 1 by 30.0 m", out)
        self.assertEqual(plan["rallyPoints"]["points"], [[47.005, 8.0, 0], [47.005, 8.0, 40]])

    def test_landings_off_the_ground(self):
        for height, word in ((-30, "raise"), (100, "lower")):
            out, plan = self.fix(*self.flat(100, 100, 100, 60, 30, landing=height))
            self.assertIn(f"cure: set the altitude of item 7 (landing) to that of the ground: {word} it by "
                          f"{abs(height):.1f} m", out)
            self.assertEqual(plan["mission"]["items"][6]["params"][6], 0)

    def test_outside_a_fence(self):
        circle = {"center": [47.0, 8.0], "radius": 900}
        out, _ = self.call("mission.plan", *self.flat(100, 100, 100, 60, 30, circle=circle), code=1)
        self.assertIn(": outside the fence 'geoFence.circles.0' of 'fence of the mission'", out)

    def test_equal_sentences_are_one(self):
        self.lawn(120)
        plan = json.loads((self.folder / "mission.plan").read_text())
        plan["mission"]["items"][4]["params"][6] = 150
        (self.folder / "mission.plan").write_text(json.dumps(plan))
        (self.folder / "p.param").write_text("FENCE_ENABLE,1\nFENCE_TYPE,1\nFENCE_ALT_MAX,100\n")
        options = ("mission.plan", "--terrain", TERRAIN, "--params", "p.param")
        out, _ = self.call(*options, code=1)
        self.assertEqual(out.count("FENCE_ALT_MAX"), 1, out)
        self.assertRegex(out, r"  items 1 to 12: flies beyond .*, the worst at item 5 \(")
        out, _ = self.call(*options, "--json", code=1)
        self.assertEqual(len(json.loads(out)["violations"]), 12)

    def test_the_place_of_a_failed_return(self):
        points = [(36.6, -84.25, 120), (36.6044, -84.275, 300)]
        self.plan([command(22 if n == 0 else 16, *point) for n, point in enumerate(points)])
        (self.folder / "p.param").write_text("RTL_ALT_M,15\n")
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, "--max-agl", "120", "--returns", "--json", code=1)
        for one in json.loads(out)["returns"]["refused"]:
            if one["rule"] == "ground":
                lon, lat = one["lonlat"]
                self.assertGreater(abs(lon - HOME[1]), 0.001, one)

    def test_after_the_point_of_no_return(self):
        self.plan([command(22, *HOME, 120), command(16, 36.603, -84.25, 120, first=4000), command(16, 36.6, -84.25, 120),
                   command(20, 0, 0, 0, 2)])
        options = ("mission.plan", "--terrain", TERRAIN, "--returns", "--battery", "90", "--power", "160")
        out, _ = self.call(*options, "--json", code=1)
        returns = json.loads(out)["returns"]
        self.assertEqual(len(returns["refused"]), 1, returns["refused"])
        self.assertAlmostEqual(returns["refused"][0]["from_s"], returns["point_of_no_return_s"], delta=1)

    def test_energy_without_an_end(self):
        self.plan([command(22, *HOME, 120), command(16, 36.603, -84.25, 120), command(16, 36.6, -84.25, 120),
                   {"type": "SimpleItem", "command": 177, "frame": 2, "autoContinue": True, "params": [2, -1, 0, 0, 0, 0, 0]},
                   command(20, 0, 0, 0, 2)])
        options = ("mission.plan", "--terrain", TERRAIN, "--returns", "--battery", "90", "--power", "160")
        out, _ = self.call(*options, code=1)
        self.assertIn("more than any battery holds", out)
        self.assertNotIn("inf Wh", out)
        self.assertNotIn("or more of", out)


if __name__ == "__main__":
    unittest.main(argv=["cures_test.py", *__import__("sys").argv[3:]])
