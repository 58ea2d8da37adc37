# SPDX-License-Identifier: Apache-2.0
"""earth_test.py PROGRAM SOURCES: one mission over one ground, given in many coordinate systems, at
places all over the Earth, has one verdict, with the figures of GeodSolve; and zones as files may
draw them."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY, by_day  # noqa: E402

PROGRAM = sys.argv[1]
HEIGHT = 30  # of the ground, metres

# Longitude, latitude, a national system.
PLACES = [(5.4, 52.1, 28992), (19.0, 52.0, 2180), (15.0, 62.0, 3006), (8.3, 46.9, 2056),
          (172.5, -43.5, 2193), (179.9995, -17.0, 3832), (-179.98, 51.9, 3338), (-150, 64, 3338),
          (15.6, 78.2, 25833), (24.0, 79.9, 25835), (-45, 70, 3413), (166.7, -77.9, 3031),
          (-60, -62, 3031), (-70, -53, 32719), (0.001, 0.001, 4087), (103.8, 1.3, 3414),
          (-74, 40.7, 2263), (-122.4, 37.8, 7131), (139.7, 35.7, 6677), (25.1, 58.9, 3301)]


def item(lon, lat, height):
    return {"type": "SimpleItem", "command": 16, "frame": 0, "autoContinue": True, "doJumpId": 1,
            "params": [0, 0, 0, None, lat, lon, height]}


def plan_of(points, circles=(), polygons=(), firmware=12):
    items = [item(*point) for point in points]
    for n, one in enumerate(items):
        one["doJumpId"] = n + 1
    lon, lat, _ = points[0]
    return {"fileType": "Plan", "groundStation": "QGroundControl", "version": 1,
            "mission": {"version": 2, "firmwareType": firmware, "vehicleType": 2, "cruiseSpeed": 15,
                        "hoverSpeed": 5, "plannedHomePosition": [lat, lon, HEIGHT],
                        "items": items},
            "geoFence": {"version": 2, "circles": [
                {"version": 1, "inclusion": inclusion,
                 "circle": {"center": [lat, lon], "radius": radius}}
                for lon, lat, radius, inclusion in circles], "polygons": list(polygons)},
            "rallyPoints": {"version": 2, "points": []}}


def geodesic(*arguments, lines):
    run = subprocess.run(["GeodSolve", "-p", "9", *arguments], input=lines, capture_output=True,
                         text=True, check=True)
    return [[float(word) for word in line.split()] for line in run.stdout.splitlines()]


def end_of(lon, lat, bearing, metres):
    found = geodesic(lines=f"{lat} {lon} {bearing} {metres}\n")[0]
    return found[1], found[0]


@unittest.skipUnless(shutil.which("GeodSolve") and shutil.which("gdal_create"),
                     "needs geographiclib-tools and gdal-bin")
class Earth(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def model(self, lon, lat, code, half_m=4000):
        """A flat model about the place; none where the system does not hold it."""
        corners = [end_of(lon, lat, bearing, half_m * 1.5) for bearing in (45, 135, 225, 315)]
        if code == 4326:
            near = [x - 360 * round((x - lon) / 360) for x, _ in corners]
            xs, ys = near, [y for _, y in corners]
            steps = 100
        else:
            run = subprocess.run(
                ["gdaltransform", "-s_srs", "EPSG:4326", "-t_srs", f"EPSG:{code}"],
                input="".join(f"{x} {y}\n" for x, y in corners), capture_output=True, text=True)
            numbers = [line.split() for line in run.stdout.splitlines()]
            if run.returncode or any("inf" in line or len(line) < 2 for line in numbers):
                return None
            xs = [float(line[0]) for line in numbers]
            ys = [float(line[1]) for line in numbers]
            steps = 100
            if max(xs) - min(xs) > 1e6:  # over the edge of its map
                return None
        file = self.folder / f"{code}.tif"
        subprocess.run(["gdal_create", "-q", "-ot", "Float32", "-outsize", str(steps), str(steps),
                        "-burn", str(HEIGHT), "-a_srs", f"EPSG:{code}", "-a_ullr", str(min(xs)),
                        str(max(ys)), str(max(xs)), str(min(ys)), str(file)], check=True)
        return file

    def check(self, plan, model, *options, expect=None):
        file = self.folder / "mission.plan"
        file.write_text(json.dumps(plan))
        run = subprocess.run([PROGRAM, "check", str(file), "--terrain", str(model), "--json",
                              *options], capture_output=True, text=True, timeout=600)
        self.assertIn(run.returncode, (0, 1), run.stderr)
        found = json.loads(run.stdout)
        self.assertEqual(found["verdict"] == "pass", run.returncode == 0)
        if expect:
            self.assertEqual(found["verdict"], expect, run.stdout)
        return found

    def test_one_verdict_in_every_system(self):
        """By night every place in every system; by day every fourth place in two."""
        judged = 0
        for n, (lon, lat, national) in by_day(enumerate(PLACES), 4, 1):
            zone = int((lon + 180) // 6) % 60 + 1
            utm = (32600 if lat >= 0 else 32700)
            codes = [4326, 3857, utm + zone, utm + zone % 60 + 1, 3413 if lat > 0 else 3031, national]
            start = (lon, lat)
            goal = end_of(lon, lat, 60, 1500)
            middle = end_of(lon, lat, 60, 750)
            centre = end_of(*middle, 150, 400)  # of a circle beside the leg
            points = [(*start, HEIGHT + 50), (*goal, HEIGHT + 50)]
            codes = list(dict.fromkeys(codes))
            for code in codes if NIGHTLY else {codes[n % len(codes)], codes[(n + 2) % len(codes)]}:
                model = self.model(lon, lat, code)
                if model is None:
                    continue
                with self.subTest(place=(lon, lat), code=code):
                    out = self.check(plan_of(points, [(*centre, 396, False)]), model, expect="pass")
                    self.assertAlmostEqual(out["metrics"]["length_m"], 1500, delta=0.01)
                    self.assertAlmostEqual(out["metrics"]["min_ground_clearance_m"], 50, delta=0.01)
                    self.check(plan_of(points, [(*centre, 403, False)]), model, expect="fail")
                    far = end_of(*middle, 330, 100)
                    self.check(plan_of(points, [(*far, 770, True)]), model, expect="pass")
                    self.check(plan_of(points, [(*far, 745, True)]), model, expect="fail")
                    self.check(plan_of(points), model, "--max-distance", "50.3", expect="pass")
                    self.check(plan_of(points), model, "--max-distance", "49.9", expect="fail")
                    judged += 1
        self.assertGreater(judged, 85 if NIGHTLY else 6)

    def test_long_legs_are_the_autopilots(self):
        leg = [(8.8684, 47, 100), (9.1316, 47, 100)]
        middle = geodesic("-i", lines=f"47 {leg[0][0]} 47 {leg[1][0]}\n")[0]
        lon, lat = end_of(leg[0][0], 47, middle[0], middle[2] / 2)
        self.assertGreater(lat, 47.00007)
        for code in by_day((4326, 32632, 3857, 3035), 3):
            model = self.model(9, 47, code, 15000)
            for firmware, on in ((12, lat), (3, 47)):
                for square in (lat, 47):
                    plan = plan_of(leg, [(lon, square, 3, False)], firmware=firmware)
                    self.check(plan, model, expect="fail" if square == on else "pass")

    def test_long_legs_low_over_flat_ground_pass(self):
        model = self.model(10, 45, 4326, 32000)
        start = end_of(10, 45, 240, 30000)
        leg = [(*start, HEIGHT + 20), (*end_of(*start, 60, 60000), HEIGHT + 20)]
        for firmware in (3, 12):
            self.check(plan_of(leg, firmware=firmware), model, "--min-agl", "19", expect="pass")
            self.check(plan_of(leg, firmware=firmware), model, "--min-agl", "21", expect="fail")

    def test_between_opposite_meridians_either_way_is_judged(self):
        model = self.folder / "pole.tif"
        subprocess.run(["gdal_create", "-q", "-ot", "Float32", "-outsize", "100", "100", "-burn",
                        str(HEIGHT), "-a_srs", "EPSG:3413", "-a_ullr", "-9000", "9000", "9000",
                        "-9000", str(model)], check=True)
        leg = [(-90, 89.98, HEIGHT + 100), (90, 89.98, HEIGHT + 100)]
        for lon in (0, 180):
            self.check(plan_of(leg, [(lon, 89.98, 100, False)], firmware=3), model, expect="fail")
            self.check(plan_of(leg, [(lon, 89.98, 100, False)]), model, expect="pass")
        self.check(plan_of(leg, [(0, 90, 100, False)]), model, expect="fail")

    def test_heights_above_the_ellipsoid(self):
        model = self.model(5.4, 52.1, 4326)
        high = self.folder / "high.tif"
        subprocess.run(["gdal_translate", "-q", "-a_srs", "EPSG:4979", str(model), str(high)],
                       check=True)
        points = [(5.4, 52.1, 50), (5.41, 52.1, 50)]
        plain = self.check(plan_of(points), model)
        found = self.check(plan_of(points), high)
        # EGM96 there: the geoid is 43 m above the ellipsoid, so that the ground is that much lower.
        raised = (found["metrics"]["min_ground_clearance_m"]
                  - plain["metrics"]["min_ground_clearance_m"])
        self.assertAlmostEqual(raised, 43.3, delta=1)
        self.assertTrue(any("EGM96" in note for note in found["notes"]))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
