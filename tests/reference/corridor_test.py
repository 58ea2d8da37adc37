# SPDX-License-Identifier: Apache-2.0
"""corridor_test.py PROGRAM DATA: `altiplan survey` 30 m beside a power line over mountains. Its plan, between the items
where the camera goes on and off, is measured by a model read a second time (ground_peer.py): everywhere 29 to 31 m from
the line, corners too, and within 5 % of its height above the ground.

`python3 corridor_test.py PROGRAM DATA Corridor.test_davos` runs one case."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np

import ground_peer

PROGRAM = sys.argv[1]
DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", sys.argv[2])) / "dem"
AGL = 60
# Metres from the first mast: bends of 10 to 115 degrees to both sides, and spans that are shorter than the offset.
MASTS = [(0, 0), (380, 90), (700, -160), (712, -150), (718, -132), (560, 420), (900, 640), (905, 655), (1300, 700)]


def distance(places, line):
    """Of each place from the line, seen from above."""
    nearest = np.full(len(places), np.inf)
    for a, b in zip(line, line[1:]):
        share = np.clip((places - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        nearest = np.minimum(nearest, np.linalg.norm(places - a - share[:, None] * (b - a), axis=1))
    return nearest


class Corridor(unittest.TestCase):
    def corridor(self, name, middle, offset):
        model = ground_peer.Model(DATA / name)
        masts = np.array(MASTS, float) - np.mean(MASTS, axis=0) + model.to_local(*middle)
        coordinates = [model.to_lonlat(*mast, middle) for mast in masts]
        with tempfile.TemporaryDirectory() as folder:
            line = pathlib.Path(folder) / "line.geojson"
            line.write_text(json.dumps({"type": "Feature", "properties": {},
                                        "geometry": {"type": "LineString", "coordinates": coordinates}}))
            run = subprocess.run(
                [PROGRAM, "survey", line, "--terrain", DATA / name, "--camera", "sony_a6000_16mm", "--agl", str(AGL),
                 "--offset", str(offset), "-o", "out", "--json"],
                cwd=folder, capture_output=True, text=True, check=False)
            self.assertEqual(run.returncode, 0, run.stdout + run.stderr)
            self.assertEqual(json.loads(run.stdout)["verdict"], "pass")
            plan = json.loads((pathlib.Path(folder) / "out/route.plan").read_text())
        line, passed, is_on = np.array([model.to_local(*c) for c in coordinates]), [], False
        for item in plan["mission"]["items"]:
            if item["command"] == 206:
                if is_on:
                    break
                is_on = True
                passed = passed[-1:]
            elif item["command"] in (16, 22):
                lat, lon, height = item["params"][4:]
                self.assertEqual(item["frame"], 0)
                passed.append((*model.to_local(lon, lat), height))
        away, above = [], []
        for a, b in zip(passed, passed[1:]):
            share = np.linspace(0, 1, 200)[:, None]
            away.append(distance((1 - share) * a[:2] + share * np.array(b[:2]), line))
            above += model.leg(a, b)
        away = np.concatenate(away)
        length = sum(np.linalg.norm(np.subtract(b, a)[:2]) for a, b in zip(passed, passed[1:]))
        print(f"{name} at {offset:+} m: {length:.0f} m, {len(passed)} waypoints, "
              f"{away.min():.3f} to {away.max():.3f} m beside the line, "
              f"{min(above):.2f} to {max(above):.2f} m above ground", file=sys.stderr)
        self.assertGreater(length, 1700)
        self.assertGreaterEqual(away.min(), 29)
        self.assertLessEqual(away.max(), 31)
        self.assertGreaterEqual(min(above), 0.95 * AGL)
        self.assertLessEqual(max(above), 1.05 * AGL)
        ends = [np.linalg.norm(np.subtract(passed[i][:2], line[i])) for i in (0, -1)]
        self.assertLess(max(ends), 31)  # it is the whole line

    def test_davos(self):
        self.corridor("davosdorf.tif", (9.83, 46.82), 30)
        self.corridor("davosdorf.tif", (9.83, 46.82), -30)

    def test_white_mountains(self):
        self.corridor("N44W072.hgt", (-71.31, 44.28), 30)

    def test_big_tujunga(self):
        self.corridor("bigtujunga.tif", ground_peer.Model(DATA / "bigtujunga.tif").somewhere, -30)


if __name__ == "__main__":
    if not DATA.is_dir():
        print("no test data: set ALTIPLAN_TEST_DATA")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
