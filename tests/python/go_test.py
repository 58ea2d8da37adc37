# SPDX-License-Identifier: Apache-2.0
"""go_test.py PROGRAM PLUGINS SOURCES: from an elevation model to a picture in five lines, as `altiplan go`."""
import json
import re

import case
from case import SOURCES, PythonCase

import altiplan

DEM = SOURCES / "configs/data/jacksboro_fault.tif"
START, GOAL = (-84.38, 36.48), (-84.32, 36.54)


def square(around, half):
    x, y = around
    return [[x - half, y - half], [x + half, y - half], [x + half, y + half], [x - half, y + half],
            [x - half, y - half]]


class Go(PythonCase):
    def setUp(self):
        super().setUp()
        self.out = self.folder / "first"

    def test_the_route_is_that_of_the_program(self):
        result = altiplan.go(DEM, START, GOAL, self.out, max_agl=120)
        self.assertEqual(result.status, "solved")
        written = json.loads((self.out / "result.json").read_text())
        self.assertEqual(result.to_dict()["route"], written["route"])
        for name in ("page.html", "route.plan", "scenario.yaml", "pipeline.yaml"):
            self.assertTrue((self.out / name).is_file(), name)

    def test_places_zones_and_an_aeroplane(self):
        over = (-84.34, 36.50, 90)
        result = altiplan.go([DEM], (*START, 80), (*GOAL, 80), self.out, via=[over], wing=150,
                             planner="hybrid_astar")
        self.assertEqual(result.status, "solved", result.message)
        self.assertIn("hybrid_astar", [step.plugin for step in result.steps])
        scenario = (self.out / "scenario.yaml").read_text()
        self.assertRegex(scenario, re.compile(r"via:.*36\.5", re.DOTALL))

    def test_no_route_is_a_result(self):
        wall = self.folder / "wall.geojson"
        wall.write_text(json.dumps({"type": "FeatureCollection", "features": [
            {"type": "Feature", "properties": {"name": "wall"}, "geometry": {
                "type": "Polygon", "coordinates": [square(START, 0.02), square(START, 0.01)]}}]}))
        result = altiplan.go(DEM, START, GOAL, self.out, avoid=wall)
        self.assertEqual(result.status, "no_route", result.message)
        self.assertIsNone(result.route)

    def test_what_is_refused(self):
        self.out.mkdir()
        (self.out / "mine.txt").write_text("kept")
        with self.assertRaisesRegex(altiplan.Error, "first"):
            altiplan.go(DEM, START, GOAL, self.out)
        self.assertEqual([one.name for one in self.out.iterdir()], ["mine.txt"])
        other = self.folder / "other"
        with self.assertRaisesRegex(altiplan.Error, "none.tif"):
            altiplan.go(self.folder / "none.tif", START, GOAL, other)
        for start, kind in (((1,), ValueError), ("1,2", ValueError), ((1, "2"), TypeError),
                            ((1, float("nan")), ValueError), (None, ValueError), ((True, 2), TypeError)):
            with self.assertRaisesRegex(kind, "^start: expected"):
                altiplan.go(DEM, start, GOAL, other)
        with self.assertRaisesRegex(TypeError, "max_agl: expected a number, found str"):
            altiplan.go(DEM, START, GOAL, other, max_agl="120")
        with self.assertRaises(altiplan.Error):
            altiplan.go(DEM, START, GOAL, other, min_agl=-1)
        self.assertFalse(other.exists())


if __name__ == "__main__":
    case.main()
