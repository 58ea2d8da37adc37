# SPDX-License-Identifier: Apache-2.0
"""fewest_items_test.py PROGRAM SOURCES: routes as the fewest items that pass as an autopilot flies them."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
WING = """altiplan: 1
frame: {origin_lonlat: [25.0, 60.0]}
environment:
  - zones:
      list:
        - {id: mast, cylinder: {at_m: [2000, 2000], radius_m: 600}}
volume: {min_m: [0, 0, 0], max_m: [5000, 5000, 900]}
vehicle:
  radius_m: 5
  wing: {airspeed_mps: 20, bank_deg: 30, climb_deg: 8, sink_deg: 8}
start: {at_m: [500, 500, 300], heading_deg: 180}
goal: {at_m: [3500, 3500, 300], loiter: {radius_m: 80}}
"""
TO_PLAN = ("--to", "qgc-plan")


def items_of(text):
    return json.loads(text)["mission"]["items"]


class Fewest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *arguments, code=0):
        run = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True, timeout=600,
                             check=False)
        self.assertEqual(run.returncode, code, run.stdout + run.stderr)
        return run.stdout, run.stderr

    def wing(self):
        (self.folder / "wing.yaml").write_text(WING)
        (self.folder / "p.yaml").write_text("altiplan: 1\nscenario: wing.yaml\nsteps:\n  - plan: hybrid_astar\n")
        self.call("run", "p.yaml", "--out", "r.json")

    def test_turns_are_flown_by(self):
        self.wing()
        dense = items_of(self.call("export", "r.json", *TO_PLAN)[0])
        out, err = self.call("export", "r.json", *TO_PLAN, "--autopilot", "ardupilot")
        few = items_of(out)
        self.assertGreater(len(dense), 100)
        self.assertLessEqual(len(few), 12)
        self.assertIn(f"{len(few)} items in place of {len(dense)}: pass as ArduPilot plane flies them", err)
        self.assertEqual([item["command"] for item in few], [16] * (len(few) - 1) + [17])  # circles at the goal
        self.assertEqual(few[0]["params"][4:], dense[0]["params"][4:])
        self.assertAlmostEqual(json.loads(out)["geoFence"]["circles"][0]["circle"]["radius"], 600, 1)
        _, err = self.call("export", "r.json", *TO_PLAN, "--autopilot", "ardupilot", "--max-items", "3", code=1)
        self.assertIn(f"not written: {len(few)} items are the fewest found that pass, more than --max-items 3", err)

    def test_a_route_too_near_to_an_obstacle_is_refused(self):
        """The vehicle is flown beside its legs: 6.4 m from a radar are not enough."""
        self.call("run", os.path.join(SOURCES, "configs", "pipelines", "ridge_crossing.yaml"), "--out", "r.json")
        out, err = self.call("export", "r.json", *TO_PLAN, "--takeoff", "--land", "--autopilot", "ardupilot",
                             "-o", "few.plan", code=1)
        self.assertIn("flown as a plan: fail: not written", err)
        self.assertIn("'ridge_radar', where 7.50 m of clearance are needed", err)
        self.assertNotIn("restricted_site", err)  # which the planner does not know
        self.assertFalse((self.folder / "few.plan").exists())

    def test_what_does_not_go_together(self):
        self.wing()
        _, err = self.call("export", "r.json", "--to", "kml", "--autopilot", "px4", code=2)
        self.assertIn("--autopilot with a result needs qgc-plan or waypoints", err)


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
