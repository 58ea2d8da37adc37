# SPDX-License-Identifier: Apache-2.0
"""wing_survey_test.py PROGRAM DATA SOURCES: `altiplan survey --wing` over hills of three models (by day of the first), in still air and in
wind. Rows are measured in models that are read a second time (ground_peer.py): within 5 % of the height of the photos,
with no leg steeper than 10 degrees through the air. What the aeroplane cannot keep as it is flown is refused.

`python3 wing_survey_test.py PROGRAM DATA SOURCES Wing.test_refusals` runs one case."""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import ground_peer

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import by_day  # noqa: E402

PROGRAM, DATA, SOURCES = sys.argv[1:4]
DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", DATA)) / "dem"
JACKSBORO = pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif"
MODELS = by_day([(JACKSBORO, (-84.12125, 36.6554)), (DATA / "N44W072.hgt", (-71.2166667, 44.78125)),
                 (DATA / "bigtujunga.tif", (-118.28954, 34.25279))], 3)  # hills of 70 to 130 m
FIELD = [(-270, -220), (230, -220), (280, 180), (-220, 140)]
ISLAND = [(-30, -30), (30, -25), (10, 30)]
WIND = 4
TURN = 60


class Wing(unittest.TestCase):
    def survey(self, file, place, agl, *options, code=0, after=None, islands=()):
        model = ground_peer.Model(file)
        middle = np.array(model.to_local(*place))
        rings = [[model.to_lonlat(*(middle + p), place) for p in [*ring, ring[0]]] for ring in (FIELD, *islands)]
        with tempfile.TemporaryDirectory() as folder:
            area = pathlib.Path(folder) / "area.geojson"
            area.write_text(json.dumps({"type": "Feature", "properties": {},
                                        "geometry": {"type": "Polygon", "coordinates": rings}}))
            run = subprocess.run(
                [PROGRAM, "survey", area, "--terrain", file, "--camera", "sony_a6000_16mm", "--agl", str(agl), "--wing",
                 str(TURN), "-o", "out", "--json", *options], cwd=folder, capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, code, run.stdout + run.stderr)
            answer = json.loads(run.stdout)
            plan = json.loads((pathlib.Path(folder) / "out/route.plan").read_text())
            if after:
                after(pathlib.Path(folder) / "out")
        return model, answer, plan["mission"]["items"]

    def measured(self, file, place, agl, wind):
        """What the test promises of one survey."""
        model, answer, items = self.survey(file, place, agl, *(["--wind", f"{WIND},270"] if wind else []))
        self.assertEqual(answer["verdict"], "pass")
        self.assertGreaterEqual(answer["coverage"], 0.999)
        height = answer["above_ground_m"]
        gsd = [value / (100 * height / 16 * 23.5 / 6000) for value in answer["gsd_cm"]]
        self.assertGreaterEqual(gsd[0], 0.95)
        self.assertLessEqual(gsd[1], 1.05)
        self.assertNotIn(178, [item["command"] for item in items])  # it has a speed of its own
        self.assertEqual(items[-1]["command"], 17)
        rows, at, is_on, steepest = [], None, False, 0
        speed = math.sqrt(TURN * 9.80665 * math.tan(math.radians(30)))
        for item in items:
            if item["command"] == 206:
                is_on = item["params"][0] > 0
                rows += [[at]] if is_on else []
            else:
                lat, lon, z = item["params"][4:]
                before, at = at, (*model.to_local(lon, lat), z)
                if before:
                    steepest = max(steepest, abs(at[2] - before[2]) /
                                   max(np.linalg.norm(np.subtract(at, before)[:2]), 1))
                if is_on:
                    rows[-1].append(at)
        self.assertFalse(is_on)
        self.assertEqual(len(rows), answer["lines"])
        above = [gap for row in rows for a, b in zip(row, row[1:]) for gap in model.leg(a, b)]
        self.assertGreaterEqual(min(above), 0.95 * height)
        self.assertLessEqual(max(above), 1.05 * height)
        self.assertLessEqual(steepest, 1.02 * math.tan(math.radians(10)) * (1 + (WIND / (speed - WIND) if wind else 0)))
        for row in rows:  # straight, and parallel to the first
            way, first = (np.subtract(r[-1], r[0])[:2] for r in (row, rows[0]))
            sine = (way[0] * first[1] - way[1] * first[0]) / (np.linalg.norm(way) * np.linalg.norm(first))
            self.assertLess(abs(sine), 0.06)
        print(f"| {file.name} | {agl} | {WIND if wind else 0} | {len(rows)} | {answer['planned_s'] / 60:.1f} | "
              f"{100 * gsd[0] - 100:+.1f} to {100 * gsd[1] - 100:+.1f} | {min(above):.1f} to {max(above):.1f} | "
              f"{math.degrees(math.atan(steepest)):.1f} |", file=sys.stderr)
        return answer["planned_s"]

    def test_three_models(self):
        for file, place in MODELS:
            with self.subTest(file.name):
                self.assertLess(self.measured(file, place, 300, False), self.measured(file, place, 300, True))

    def test_islands(self):
        """It turns away before them, and lines up anew behind them."""
        for file, place in MODELS:
            for wind in ([], ["--wind", f"{WIND},270"]):
                with self.subTest(file.name, wind=wind):
                    _, answer, _ = self.survey(file, place, 300, *wind, islands=[ISLAND])
                    self.assertEqual(answer["verdict"], "pass")
                    self.assertGreaterEqual(answer["coverage"], 0.98)

    def flown(self, folder, share, of="both"):
        """A simulated flight of the survey in its wind, all of it held to the scale within a share."""
        pipeline = (folder / "pipeline.yaml").read_text().replace("- plan: hybrid_astar\n",
                                                                  "- plan: hybrid_astar\n    id: route\n")
        gsd = 100 * 300 / 16 * 23.5 / 6000
        (folder / "fly.yaml").write_text(
            f"{pipeline}  - fly: route\nconstraints:\n  - photos: {{sensor_mm: [23.5, 15.6], image_px: [6000, 4000], "
            f"focal_mm: 16, min_gsd_cm: {gsd * (1 - share)}, max_gsd_cm: {gsd * (1 + share)}, applies_to: {of}}}\n")
        run = subprocess.run([PROGRAM, "run", folder / "fly.yaml", "--json"], capture_output=True, check=False)
        return json.loads(run.stdout)["flight"]

    def test_flown_in_wind(self):
        """By the guidance of the simulated aeroplane: the judge holds the whole track to the scale, turns too."""
        flights = []
        for file, place in MODELS:
            with self.subTest(file.name):
                self.survey(file, place, 300, "--wind", f"{WIND},270",
                            after=lambda out: flights.extend([self.flown(out, 0.05), self.flown(out, 0.005, "track")]))
                within, too_narrow = flights[-2:]
                self.assertTrue(within["reached"])
                self.assertEqual(within["check"], {"ok": True, "violations": []})
                self.assertLess(within["cross_track_max_m"], 5)
                self.assertFalse(too_narrow["check"]["ok"])

    def test_refusals(self):
        """As it is flown it lags behind the ground: the judge says so, though the drawn rows keep the scale."""
        _, answer, _ = self.survey(*MODELS[0], 150, code=1)
        self.assertEqual(answer["verdict"], "fail")
        self.assertIn("photos are taken from", answer["flights"][0]["findings"][-1])


if __name__ == "__main__":
    if not DATA.is_dir():
        print("no test data: set ALTIPLAN_TEST_DATA")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
