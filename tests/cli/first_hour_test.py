# SPDX-License-Identifier: Apache-2.0
"""first_hour_test.py PROGRAM SOURCES: what a newcomer's first files and calls meet."""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
TERRAIN = str(pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif")
SCENARIO = """altiplan: 1
environment:
  - terrain: {{file: {terrain}}}
frame: {{crs: auto}}
volume: {volume}
start: {{at_lonlat: {start}, above_ground_m: 60}}
goal: {{at_lonlat: {goal}, above_ground_m: 60}}
constraints:
  - climb_angle: {{max_deg: {climb}}}
"""
PIPELINE = """altiplan: 1
scenario: s.yaml
steps:
  - plan: astar
    with: {cell_m: CELL}
"""


class FirstHour(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *arguments, code):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, capture_output=True, text=True,
                              timeout=600, check=False)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def run_with(self, code, cell="[100, 100, 20]", volume="{floor_m: 200, ceiling_m: 1500}",
                 start="[-84.38, 36.48]", goal="[-84.30, 36.50]", climb=60):
        (self.folder / "s.yaml").write_text(SCENARIO.format(
            terrain=TERRAIN, volume=volume, start=start, goal=goal, climb=climb))
        (self.folder / "p.yaml").write_text(PIPELINE.replace("CELL", cell))
        return self.call("run", "p.yaml", "--out", "r.json", "--log-level", "info", code=code)

    def test_floor_and_ceiling_alone(self):
        self.run_with(0)
        said = self.run_with(3, volume="{floor_m: 200}")
        self.assertIn("no layer bounds the volume from above on z: give volume.ceiling_m", said)
        self.assertIn("expected min_m, or floor_m", self.run_with(
            3, volume="{floor_m: 200, min_m: [0, 0, 0], max_m: [9000, 9000, 1500]}"))

    def test_a_corridor_is_cut_to_the_ground(self):
        said = self.run_with(0, volume="{floor_m: 200, ceiling_m: 1500, corridor_m: 4000}")
        self.assertRegex(said, r"volume: cut to the ground at x 0 to \d+, y 0 to \d+ m")
        said = self.run_with(0, volume="{floor_m: 200, ceiling_m: 1500, corridor_m: 1000}")
        self.assertNotIn("volume: cut", said)

    def test_frame_auto_is_a_model_s_own_where_lengths_are_right(self):
        self.assertIn("frame: EPSG:4326, affine", self.run_with(0))

    def test_swapped_axes_are_recognised(self):
        said = self.run_with(3, start="[36.48, -84.38]")
        self.assertIn("start: longitude 36.48, latitude -84.38 is outside the elevation model, and "
                      "[-84.38, 36.48] is inside: give longitude first", said)
        said = self.run_with(3, goal="[-80, 38]")
        self.assertRegex(said, r"goal: longitude -80, latitude 38 is outside the elevation model, which covers "
                               r"longitude -84.4\d* to -84.0\d*, latitude 36.4\d* to 36.7")

    def test_a_point_outside_the_volume(self):
        volume = "{min_m: [0, 0, 200], max_m: [4000, 9000, 1500]}"
        self.assertIn("goal: longitude -84.3, latitude 36.5 is outside the volume, which covers longitude",
                      self.run_with(3, volume=volume))

    def test_cells_too_large_or_too_high(self):
        said = self.run_with(3, cell="[100000, 100000, 1000]")
        self.assertIn("cell_m: a cell of 100000 x 100000 m is larger than the volume of", said)
        self.assertIn("expected three numbers, found '100'; did you mean [100, 100, 100]?",
                      self.run_with(3, cell="100"))
        said = self.run_with(1, climb=1)
        self.assertIn("climb_angle rules out 18 of 26 directions (with cells at most 1.74 m high 2)", said)

    def test_validate_builds_on_request(self):
        self.run_with(0)
        self.assertEqual(self.call("validate", "--build", "p.yaml", "s.yaml", code=0).count("can be built"), 2)
        self.run_with(3, start="[36.48, -84.38]")
        self.call("validate", "s.yaml", code=0)
        self.assertIn("give longitude first", self.call("validate", "--build", "s.yaml", code=3))

    def test_a_trace_is_bounded(self):
        self.run_with(0)
        text = (self.folder / "p.yaml").read_text().replace("cell_m", "weight_h: 0, cell_m")
        (self.folder / "p.yaml").write_text(text)
        said = self.call("run", "p.yaml", "--trace", "t.jsonl", "--trace-limit", "1", code=0)
        self.assertRegex(said, r"the trace is full at 1 MB: \d+ events are left out; --trace-limit sets")
        self.assertLess((self.folder / "t.jsonl").stat().st_size, 1_001_000)

    def test_a_time_out_names_the_key_to_change(self):
        self.run_with(0)
        text = (self.folder / "p.yaml").read_text().replace("- plan: astar", "- plan: astar\n    within_s: 0.001")
        text = text.replace("cell_m: [100, 100, 20]", "weight_h: 0, cell_m: [40, 40, 20]")
        # The planner's own look at the clock and the watchdog race: either may end it.
        for within_s in (0.0001, 0.001, 0.003):
            (self.folder / "p.yaml").write_text(text.replace("within_s: 0.001", f"within_s: {within_s}"))
            said = self.call("run", "p.yaml", code=1)
            self.assertIn(f"steps.0.within_s is {within_s:g} s", said)

    def test_files_in_a_folder_that_does_not_exist(self):
        (self.folder / "routes").mkdir()
        said = self.run_with(0)
        self.assertTrue(json.loads((self.folder / "r.json").read_text()), said)
        said = self.call("run", "p.yaml", "--out", "route/r.json", code=3)
        self.assertIn("did you mean 'routes'?", said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
