# SPDX-License-Identifier: Apache-2.0
"""flown_routes_test.py TRACK_IN_BAND SOURCES PROGRAM: random routes that `altiplan go` plans from ground to ground over
a real model, flown by the test vehicle: they end where planned, keep what was asked for, and stay in the predicted
band. By night a hundred of a copter, and as many of an aeroplane with take-off and landing.

Heights above the ground are told by a second reader of the model, in which the vehicle lands, too."""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

from band_case import SOURCES, BandCase, parameter_text

sys.path[1:1] = [str(SOURCES / "tests/support"), str(SOURCES / "tests/reference")]

import flavours  # noqa: E402
import geodesy  # noqa: E402
import ground_peer  # noqa: E402
from night import by_day  # noqa: E402

PROGRAM = sys.argv[3]
TERRAIN = SOURCES / "configs/data/jacksboro_fault.tif"
WEST, SOUTH, EAST, NORTH = -84.39, 36.47, -84.10, 36.71
MIN_AGL = 40
MOST_TRIES = 30  # of draws, of which some have no route or no runway
OPTIONS = {"copter": [], "plane": ["--wing", "120", "--speed", "22", "--takeoff", "--land"]}
# Of where it was meant to end. The test vehicle aims below its point, and touches down before it.
MOST_OFF = {"copter": 1.0, "plane": 60.0}
AT_COLUMN = 5.0  # metres beside a copter's take-off and landing
AT_GROUND = 1.0  # metres: an aeroplane lands or rolls


def square(rng, start, goal):
    """A zone on the way, and its corners."""
    share, half = rng.uniform(0.35, 0.65), rng.uniform(50, 120)
    middle = geodesy.offset(start, *(share * way + rng.uniform(-150, 150)
                                     for way in geodesy.vector(start, goal)[:2]))
    corners = [geodesy.offset(middle, north * half, east * half)
               for north, east in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
    ring = [[p.lon, p.lat] for p in corners + corners[:1]]
    zone = {"type": "Feature", "properties": {"name": "square"},
            "geometry": {"type": "Polygon", "coordinates": [ring]}}
    return {"type": "FeatureCollection", "features": [zone]}, corners


class FlownRoutes(BandCase):
    @classmethod
    def setUpClass(cls):
        cls.model = ground_peer.Model(TERRAIN)

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def local(self, position):
        return (*self.model.to_local(position.lon, position.lat), position.alt)

    def on_ground(self, lon, lat):
        return geodesy.Position(lat, lon, self.model.ground(*self.model.to_local(lon, lat)))

    def draw(self, rng, kind, name):
        """Ends, limits, and a zone for every other; None where `go` finds no route for them."""
        folder = self.folder / name
        folder.mkdir(parents=True)
        (folder / "vehicle.param").write_text(
            parameter_text(flavours.parameters(flavours.ARDUPILOT, kind), kind), encoding="utf-8")
        start = self.on_ground(rng.uniform(WEST, EAST), rng.uniform(SOUTH, NORTH))
        away, heading = rng.uniform(900, 2500), rng.uniform(0, 2 * math.pi)
        goal = geodesy.offset(start, away * math.cos(heading), away * math.sin(heading))
        self.max_agl = 120.0 if kind == "copter" and rng.random() < 0.5 else math.inf
        self.wind = (rng.randrange(360), round(rng.uniform(1, 5), 1)) if rng.random() < 0.5 else (0, 0.0)
        options = ["--params", str(folder / "vehicle.param"), "--min-agl", str(MIN_AGL), *OPTIONS[kind]]
        options += ["--max-agl", "120"] if math.isfinite(self.max_agl) else []
        options += ["--wind", f"{self.wind[1]},{self.wind[0]}"] if self.wind[1] else []
        self.zone = None
        if rng.random() < 0.5:
            text, self.zone = square(rng, start, goal)
            (folder / "zone.geojson").write_text(json.dumps(text), encoding="utf-8")
            options += ["--avoid", str(folder / "zone.geojson")]
        run = subprocess.run(
            [PROGRAM, "go", "--terrain", str(TERRAIN), "--from", f"{start.lon:.7f},{start.lat:.7f}", "--to",
             f"{goal.lon:.7f},{goal.lat:.7f}", *options, "-o", str(folder / "out")],
            capture_output=True, text=True, timeout=300, check=False)
        self.assertIn(run.returncode, (0, 1), run.stdout + run.stderr)
        if run.returncode != 0:
            return None
        plan = folder / "route.plan"
        (folder / "out/route.plan").rename(plan)
        words = run.stdout.split("check: --runway ")
        self.runway = words[1].split()[0] if len(words) > 1 else "-"
        return plan

    def planned(self, rng, name, kind):
        for n in range(MOST_TRIES):
            plan = self.draw(rng, kind, f"{name}/{n}")
            if plan:
                return plan
        self.fail(f"no route in {MOST_TRIES} draws")

    def fly_plan(self, plan, kind):
        mission = json.loads(plan.read_text(encoding="utf-8"))["mission"]
        lat, lon, alt = mission["plannedHomePosition"]
        home = {"command": 16, "frame": 0, "params": [0, 0, 0, 0, lat, lon, alt]}
        items = []
        for one in [home, *mission["items"]]:
            p = [math.nan if value is None else value for value in one["params"]]
            items.append({"command": one["command"], "frame": one["frame"], "autocontinue": 1,
                          "x": round(p[4] * 1e7), "y": round(p[5] * 1e7), "z": p[6],
                          **{f"param{i + 1}": p[i] for i in range(4)}})
        heading = "0" if self.runway == "-" else self.runway
        wind = ",".join(str(value) for value in self.wind)
        self.fly(f"--autopilot ardupilot --type {kind} --home {lat},{lon},{alt} --heading {heading} --wind {wind}",
                 items)
        log = self.station.every_step

        def step():
            log()
            here = self.pilot.body.position
            self.pilot.ground = self.on_ground(here.lon, here.lat).alt
        self.station.every_step = step
        self.begin()
        self.assertTrue(self.station.run(2000, lambda: not self.pilot.armed), "did not end")
        return items

    def expect_kept(self, kind, items):
        """The limits, between take-off and landing; near a runway half of the height above it."""
        ends = [geodesy.Position(i["x"] / 1e7, i["y"] / 1e7, i["z"]) for i in (items[0], items[-1])]
        track = [p for _, p in self.track[::10]]
        zone = self.zone and [self.local(p)[:2] for p in self.zone]
        for before, here in zip(track, track[1:], strict=False):
            low, high = self.model.leg(self.local(before), self.local(here))
            need = MIN_AGL
            for end in ends:
                if kind == "copter":
                    need = -0.1 if geodesy.horizontal(here, end) < AT_COLUMN else need
                elif geodesy.horizontal(here, end) < self.runway_m[end is ends[1]]:
                    need = min(need, (here.alt - end.alt) / 2 - AT_GROUND) if high > AT_GROUND else -math.inf
            self.assertGreaterEqual(low, need, here)
            self.assertLessEqual(high, self.max_agl, here)
            if zone:
                x, y = self.local(here)[:2]
                self.assertFalse(zone[0][0] < x < zone[1][0] and zone[0][1] < y < zone[2][1], here)

    def check(self, kind, seed):
        rng = random.Random(f"{kind} route {seed}")
        plan = self.planned(rng, f"{kind}{seed}", kind)
        items = self.fly_plan(plan, kind)
        places = [geodesy.Position(i["x"] / 1e7, i["y"] / 1e7, i["z"]) for i in items]
        # The climb reaches to the second item, the glide from the last but one.
        self.runway_m = [geodesy.horizontal(places[0], places[2]), geodesy.horizontal(places[-1], places[-2])]
        touches = next(p for _, p in self.track[::-1] if p.alt > self.on_ground(p.lon, p.lat).alt + 0.5)
        self.assertLess(geodesy.horizontal(touches, places[-1]), MOST_OFF[kind])
        self.expect_kept(kind, items)
        self.expect_in_band(plan, kind, self.runway, TERRAIN, self.wind[1])

    def test_copter(self):
        for seed in by_day(range(100), 100):
            with self.subTest(seed=seed):
                self.check("copter", seed)

    def test_plane(self):
        for seed in by_day(range(100), 100):
            with self.subTest(seed=seed):
                self.check("plane", seed)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
