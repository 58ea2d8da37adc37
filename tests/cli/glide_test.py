# SPDX-License-Identifier: Apache-2.0
"""glide_test.py PROGRAM SOURCES: `altiplan check MISSION --returns --glide RATIO`. A referee of its own flies glides from
places of random missions, at random headings and in random winds: none from a place that passes may hit the ground."""
import itertools
import json
import math
import os
import random
import sys
import unittest

from dem_model import METRES, MODELS, Model, all_models, item, write_ridge
from plan_case import PlanCase

COPTER, PLANE, PX4_PLANE = (3, 2), (3, 1), (12, 1)
GRAVITY = 9.80665


class Glide(PlanCase):
    """A ridge 200 m high, 760 to 910 m east of home, and flights on both sides of it."""

    LAT, LON = 47.0, 8.0
    # At 260 m above home, west of the ridge and beyond it; the last item is home, where it circles.
    WEST = [(16, 100, 0, 200), (16, -100, 500, 200)]
    BEYOND = [(16, 300, 0, 260), (16, 1600, 0, 260)]
    HIGH = {"RTL_ALTITUDE": 260}

    def setUp(self):
        super().setUp()
        write_ridge(self.folder, self.LAT, self.LON)

    def place(self, east, north):
        return [self.LON + east / METRES / math.cos(math.radians(self.LAT)), self.LAT + north / METRES]

    def mission(self, way, vehicle=PLANE, parameters=None):
        """`way`: (command, east of home, north, height above home), or (178, airspeed)."""
        items = [item(n + 1, 178, 0, 0, 0, params=(0, one[1], -1, 0)) if len(one) == 2 else
                 item(n + 1, one[0], *reversed(self.place(*one[1:3])), one[3]) for n, one in enumerate(way)]
        self.write(items, firmwareType=vehicle[0], vehicleType=vehicle[1], plannedHomePosition=[self.LAT, self.LON, 400])
        (self.folder / "p.param").write_text("".join(
            f"{name},{value}\n" for name, value in {**self.HIGH, **(parameters or {})}.items()))

    def judge(self, *options, code, glide=15, json_output=True):
        output = ["--json"] if json_output else []
        return self.call("mission.plan", "--terrain", "ridge.asc", "--params", "p.param", "--returns", "--glide",
                         str(glide), *output, *options, code=code)[0]

    def glides(self, *options, code, glide=15):
        told = json.loads(self.judge(*options, code=code, glide=glide))
        self.assertEqual(told["verdict"], "pass", told["violations"])
        return told["returns"]

    def ditch(self, *features, name="d.geojson"):
        (self.folder / name).write_text(json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {"name": n, **more}, "geometry": {"type": kind, "coordinates": at}}
            for n, kind, at, more in features]}))
        return "--ditch", name

    def point(self, name, east, north):
        return name, "Point", self.place(east, north), {}

    def area(self, name, west, east, south, north, **more):
        ring = [self.place(*at) for at in
                ((west, south), (east, south), (east, north), (west, north), (west, south))]
        return name, "Polygon", [ring], more

    def test_home_is_reached(self):
        self.mission(self.WEST)
        returns = self.glides(code=0)
        glide = returns["glide"]
        self.assertEqual((returns["verdict"], glide["verdict"], glide["refused"]), ("pass", "pass", []))
        self.assertEqual({one["site"] for one in glide["reached"]}, {"home"})
        self.assertEqual(glide["margin_m"], min(one["margin_m"] for one in glide["reached"]))
        # 200 m above home at the least, less than 500 m and a turn away.
        self.assertTrue(100 < glide["margin_m"] < 200 - 500 / 15, glide)
        # In wind, and with more drag, it is lower when it arrives.
        windy = self.glides("--wind", "4", code=0)["glide"]["margin_m"]
        poor = self.glides(code=0, glide=10)["glide"]["margin_m"]
        self.assertTrue(windy < glide["margin_m"] - 10 and poor < glide["margin_m"] - 10, (windy, poor, glide))

    def test_height_is_lost_as_stated(self):
        """Along a straight line from home, twice as far costs the distance by the ratio."""
        margins = []
        for north in (700, 1100):
            self.mission([(16, -300, north, 300), (16, 300, north, 300)], parameters={"RTL_ALTITUDE": 300})
            told = json.loads(self.judge(code=0, glide=20))
            margins.append(min(one["margin_m"] for one in told["returns"]["glide"]["reached"]))
        farther = math.hypot(300, 1100) - math.hypot(300, 700)
        self.assertAlmostEqual(margins[0] - margins[1], farther / 20, delta=3)

    def test_what_another_speed_costs(self):
        """From 9 m/s it dives to 22 m/s, or rises from there."""
        way = [(16, -600, 0, 200), (16, -600, 500, 200)]
        self.mission(way)
        slow = self.glides(code=0)["glide"]["margin_m"]
        self.mission([(178, 22), way[0], (178, 9), way[1]])
        self.assertLess(self.glides(code=0)["glide"]["margin_m"], slow - (22 ** 2 - 9 ** 2) / 2 / 9.80665)

    def test_the_ridge_is_between(self):
        self.mission(self.BEYOND)
        returns = self.glides(code=1)
        glide = returns["glide"]
        # The returns themselves pass.
        self.assertEqual((returns["verdict"], returns["refused"], glide["verdict"]), ("fail", [], "fail"))
        stretch = glide["refused"][0]
        self.assertIn(stretch["rule"], ("ground", "clearance", "glide"))
        self.assertIn("the glide to 'home': ", stretch["message"])
        self.assertEqual(stretch["item"], 2)
        # Home is reached from before the ridge, and then again from none: both are told.
        self.assertTrue(glide["reached"][0]["from_s"] < stretch["from_s"], glide)
        # A field beyond the ridge cures it.
        both = self.ditch(self.point("home", 0, 0), self.point("field", 1500, 100))
        glide = self.glides(*both, code=0)["glide"]
        self.assertEqual({one["site"] for one in glide["reached"]}, {"home", "field"})
        self.assertEqual(self.glides(*self.ditch(self.point("field", 1500, 100)), code=1)["glide"]["verdict"], "fail")

    def test_too_low_to_reach(self):
        self.mission([(16, 100, 0, 60), (16, 100, 1300, 60)], parameters={"RTL_ALTITUDE": 60})
        stretch = self.glides(code=1)["glide"]["refused"][0]
        self.assertEqual((stretch["rule"], stretch["unit"]), ("glide", "m"))
        self.assertRegex(stretch["message"], r"the glide to 'home': ends \d+\.\d m too low")
        self.assertLess(stretch["value"], 0)

    def test_a_zone_on_the_glide(self):
        """Below the flight, and not below all of its band: a glide may sink as little as nothing."""
        self.mission([(16, 100, 1000, 400), (16, 300, 1000, 400)], parameters={"RTL_ALTITUDE": 400})
        self.assertEqual(self.glides(code=0)["glide"]["verdict"], "pass")
        lon, lat = self.place(100, 500)
        self.zones("z.json", self.around(lon, lat, 0.002), 770)
        told = json.loads(self.judge("--airspace", "z.json", code=1))
        self.assertEqual([one["zone"] for one in told["returns"]["glide"]["refused"]], ["Z"], told)
        # And one over the site, in which it would circle.
        self.zones("z.json", self.around(*self.place(0, 60), 0.0002), 800)
        told = json.loads(self.judge("--airspace", "z.json", code=1))
        self.assertTrue(told["returns"]["glide"]["refused"], told)
        # And one below that circle, in which it would come down.
        self.zones("z.json", self.around(*self.place(0, 60), 0.0002), 410)
        glide = json.loads(self.judge("--airspace", "z.json", code=1))["returns"]["glide"]
        self.assertEqual((glide["verdict"], glide["refused"][0]["zone"]), ("fail", "Z"))

    def test_areas_and_kml(self):
        self.mission(self.BEYOND)
        narrow = self.area("strip", 1000, 2000, 100, 110), self.point("home", 0, 0)
        glide = self.glides(*self.ditch(*narrow), code=0)["glide"]
        self.assertEqual({one["site"] for one in glide["reached"]}, {"home", "strip"})
        polygon = " ".join(f"{lon},{lat}" for lon, lat in narrow[0][2][0])
        (self.folder / "d.kml").write_text(
            '<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><name>strip</name><Polygon>'
            f'<outerBoundaryIs><LinearRing><coordinates>{polygon}</coordinates></LinearRing></outerBoundaryIs></Polygon>'
            '</Placemark><Placemark><name>farm</name><Point><coordinates>8,47</coordinates></Point></Placemark>'
            '</Document></kml>')
        glide = self.glides("--ditch", "d.kml", code=0)["glide"]
        self.assertEqual({one["site"] for one in glide["reached"]}, {"farm", "strip"})

    def test_also_while_it_returns_and_circles(self):
        """Its own return is flown without an engine, too: from a rally point far away none reaches a site."""
        self.mission(self.WEST, parameters={"RTL_ALTITUDE": 100})
        told = json.loads(self.judge(*self.ditch(self.point("field", 400, 700)), code=1, glide=6))
        parts = {part["what"]: part["time_s"] for part in told["parts"]}
        circle = [one for one in told["returns"]["glide"]["refused"] if one["to_s"] >= sum(parts["the way home"]) / 2]
        self.assertTrue(circle, told["returns"]["glide"])

    def test_words(self):
        self.mission(self.BEYOND)
        out = self.judge(*self.ditch(self.point("field", 1500, 100)), code=1, json_output=False)
        self.assertRegex(out, r"returns pass: .*\nglide fail: \d part.* of the flight without a site\n"
                              r"  from .* \(item \d \(waypoint\)\) to .*, worst at .*: the glide to 'field': .*\n"
                              r"    worst at .*\n(.*\n)*"
                              r"  from .* to .*: 'field', at least \d+\.\d m above it")
        for file, option in (("c.html", "--certificate"), ("j.xml", "--junit")):
            self.judge(option, file, "--ditch", "d.geojson", code=1)
            self.assertIn("the glide to 'field'", (self.folder / file).read_text())
        self.assertIn("returns fail", (self.folder / "c.html").read_text())
        self.mission(self.WEST)
        out = self.judge(code=0, json_output=False)
        self.assertRegex(out, r"glide pass: a site is reached from every second of the flight, at least \d+\.\d m above it")

    def test_what_is_not_judged(self):
        for way, vehicle, words in (
                ([(22, 0, 0, 100), (16, 100, 0, 200)], COPTER, "how ArduPilot copter comes down without power"),
                ([(84, 0, 0, 200), (16, 400, 0, 200)], (3, 20), "comes down without power"),
                ([(22, 0, 0, 100), (16, -300, 0, 200), (16, -300, 300, 200)], PLANE,
                 "item 1 (take-off): a glide from an aeroplane's take-off or landing")):
            self.mission(way, vehicle)
            glide = json.loads(self.judge("--runway", "270", code=1, glide=30))["returns"]["glide"]
            self.assertNotEqual(glide["verdict"], "pass", glide)
            self.assertIn(words, str(glide["not_judged"]))

    def test_wind_that_no_flight_is_judged_in(self):
        self.mission(self.WEST)
        told = json.loads(self.judge("--wind", "11", code=1))
        self.assertIn("is not judged", str(told["returns"]["glide"]["not_judged"]))
        told = json.loads(self.judge("--wind", "20", code=1))
        stretch = told["returns"]["glide"]["refused"][0]
        self.assertEqual((stretch["value"], stretch["rule"]), (0, "glide"))
        self.assertIn("the wind may be as fast as it flies", stretch["message"])

    def test_bad_values(self):
        self.mission(self.WEST)
        mission = ("mission.plan", "--terrain", "ridge.asc")
        for options, words in ((("--returns", "--glide", "0"), "--glide"), (("--returns", "--glide", "-3"), "--glide"),
                               (("--returns", "--glide", "nan"), "--glide"), (("--returns", "--glide", "x"), "--glide"),
                               (("--glide", "12"), "--returns"), (("--returns", "--ditch", "d.kml"), "--glide")):
            _, err = self.call(*mission, *options, code=2)
            self.assertIn(words, err)
            self.assertLessEqual(err.count("\n"), 2, err)

    def test_bad_sites(self):
        self.mission(self.WEST)
        line = "road", "LineString", [self.place(0, 0), self.place(9, 9)], {}
        crossed = "bow", "Polygon", [[self.place(*at) for at in ((0, 0), (99, 99), (99, 0), (0, 99), (0, 0))]], {}
        for features, words in (((), "found none"), ((line,), "found none"), ((crossed,), "'bow'"),
                                ((self.area("P1", 0, 99, 0, 99, role="keep_out"),), "found the zone 'P1'"),
                                ((self.area("thin", 0, 99, 0, 0),), "without an area, 'thin'"),
                                ((self.point("far", 90000, 0),), "within the elevation model")):
            self.ditch(*features)
            _, err = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--glide", "9", "--ditch",
                               "d.geojson", code=3)
            self.assertIn(words, err)
            self.assertEqual(err.count("\n"), 1, err)
        for file, words in (("none.kml", "--ditch: file not found"), ("mission.plan", "GeoJSON"), ("ridge.asc", "ridge.asc")):
            _, err = self.call("mission.plan", "--terrain", "ridge.asc", "--returns", "--glide", "9", "--ditch", file, code=3)
            self.assertIn(words, err)


class Referee(PlanCase):
    """Random missions over real models, each with some sites, and glides from what passes."""

    @unittest.skipUnless(MODELS.is_dir(), "no test data: set ALTIPLAN_TEST_DATA")
    def test_no_glide_is_passed_that_hits_the_ground(self):
        counts = {"glides": 0, "refused": 0}
        for number in range(3):
            self.judge(Model("N44W072.hgt"), (44.26, -71.33, 0.04), random.Random(f"N44W072.hgt {number}"), counts)
        self.assertGreater(counts["glides"], 100, counts)  # else it tells nothing

    @unittest.skipUnless(MODELS.is_dir() and "ALTIPLAN_GLIDES" in os.environ, "of the night")
    def test_many_glides_over_all_models(self):
        counts = {"glides": 0, "refused": 0}
        models = list(all_models(self.folder))
        for mission in itertools.count():
            for model, place in models:
                if counts["glides"] >= int(os.environ["ALTIPLAN_GLIDES"]):
                    return
                self.judge(model, place, random.Random(f"{model.name} {mission}"), counts)

    def judge(self, model, place, chance, counts):
        lat, lon, far = place

        def somewhere():
            at = lat + chance.uniform(-far, far), lon + chance.uniform(-far, far)
            return *at, model.ground(*at)

        home = min((somewhere() for _ in range(4)), key=lambda at: at[2])
        sites = {f"s{n}": min((somewhere() for _ in range(3)), key=lambda at: at[2]) for n in range(2)}
        (self.folder / "d.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {"name": name}, "geometry": {"type": "Point", "coordinates": [at[1], at[0]]}}
            for name, at in sites.items()]}))
        way = [(*at[:2], at[2] + chance.uniform(100, 500)) for at in (somewhere() for _ in range(5))]
        self.write([item(n + 1, 16, *point, frame=0) for n, point in enumerate(way)], firmwareType=3, vehicleType=1,
                   plannedHomePosition=home)
        ratio, wind = chance.choice((8, 12, 18)), chance.choice((0, 2, 4))
        out, _ = self.call("mission.plan", "--terrain", model.file, *model.crs, "--returns", "--json", "--glide", str(ratio),
                           "--ditch", "d.geojson", "--wind", str(wind), code=None)
        told = json.loads(out)
        glide = told["returns"]["glide"]
        middle = [sum(part["time_s"]) / 2 if None not in part["time_s"] else 1e9 for part in told["parts"]]
        for index, part in enumerate(told["parts"]):
            numbers = [int(words.split()[1]) for words in part["items"]]
            if part["what"] or len(numbers) != 2:
                continue
            a, b = (way[number - 1] for number in numbers)
            begin, end = middle[index - 1], middle[index]
            # Anywhere, and where sites are about to be out of reach; away from cut corners.
            edges = [(edge - begin) / (end - begin) for one in glide["refused"]
                     for edge in (one["from_s"] - 4, one["from_s"] - 9, one["to_s"] + 4, one["to_s"] + 9)]
            for share in [chance.uniform(0.1, 0.9) for _ in range(12)] + [one for one in edges if 0.1 < one < 0.9]:
                second = begin + share * (end - begin)
                if any(one["from_s"] - 3 <= second <= one["to_s"] + 3 for one in glide["refused"]):
                    counts["refused"] += 1
                    continue
                names = {one["site"] for one in glide["reached"] if one["from_s"] <= second <= one["to_s"]}
                self.assertTrue(names, (second, glide))
                at = [p + share * (q - p) for p, q in zip(a, b)]
                # Where two stretches meet either site may be meant.
                misses = [self.miss(model, at, sites[name], ratio, wind, random.Random(second)) for name in names]
                self.assertTrue(None in misses, (model.file, ratio, wind, second, at, names, misses))
                counts["glides"] += 1

    @staticmethod
    def miss(model, at, site, ratio, wind, chance):
        """Turns toward the site, and glides there along a straight line; what goes wrong, or None."""
        east = METRES * math.cos(math.radians(at[0]))
        x, y, z = (at[1] - site[1]) * east, (at[0] - site[0]) * METRES, at[2]
        speed = 12 * (1 - 2.25577e-5 * z) ** -2.128 * chance.uniform(0.98, 1.07)
        from_, strength = chance.uniform(0, 2 * math.pi), wind * chance.choice((1, chance.random()))
        wx, wy = strength * math.cos(from_), strength * math.sin(from_)
        heading, bank, step = chance.uniform(0, 2 * math.pi), 0, 0.2
        steepest = math.radians(chance.uniform(36, 45))
        for _ in range(10000):
            far = math.hypot(x, y)
            if far < 30:
                return None if z > site[2] - 1 else f"{site[2] - z} m too low"
            ux, uy = -x / far, -y / far
            aside = (wx * uy - wy * ux) / speed
            wanted = math.atan2(uy, ux) + math.asin(max(-1, min(1, aside)))
            off = math.remainder(wanted - heading, 2 * math.pi)
            sought = max(-steepest, min(steepest, 2 * off))
            bank += max(-step, min(step, sought - bank))
            heading += GRAVITY * math.tan(bank) / speed * step
            x += (speed * math.cos(heading) + wx) * step
            y += (speed * math.sin(heading) + wy) * step
            z -= speed / ratio * (1 + math.tan(bank) ** 2) * step
            if z < model.ground(site[0] + y / METRES, site[1] + x / east) - 2:
                return f"in the ground {far:.0f} m before the site"
        return "does not arrive"


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
