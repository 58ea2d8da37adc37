# SPDX-License-Identifier: Apache-2.0
"""Worlds of 200 million cells, of four million boxes, and an elevation model of 400 million posts:
planned through, sound, in little memory. By day the boxes are an eighth, and the posts a quarter of that.

python3 large_worlds_test.py PROGRAM
"""
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY  # noqa: E402

PROGRAM = sys.argv[1]
MOST_BYTES = 1 << 30

PIPELINE = """altiplan: 1
scenario: scenario.yaml
seed: 3
steps:
  - plan: astar
    with: {with}
"""
SCENARIO = """altiplan: 1
environment:
  - {layer}
vehicle: {{radius_m: {radius}}}
start: {{at_m: {start}}}
goal: {{at_m: {goal}}}
{more}
"""


class LargeWorlds(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="altiplan_large_")
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def run_in(self, layer, start, goal, radius=0, more="", settings="{}", most=MOST_BYTES):
        """The result of a run whose process stayed below so many bytes."""
        self.write("scenario.yaml", SCENARIO.format(layer=layer, radius=radius, start=start,
                                                    goal=goal, more=more))
        self.write("pipeline.yaml", PIPELINE.replace("{with}", settings))
        out = os.path.join(self.folder, "result.json")
        with open(os.path.join(self.folder, "said"), "w+", encoding="utf-8") as said:
            child = subprocess.Popen(
                [PROGRAM, "run", os.path.join(self.folder, "pipeline.yaml"), "--out", out],
                stdout=said, stderr=said)
            _, status, usage = os.wait4(child.pid, 0)
            child.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            self.assertEqual(child.returncode, 0, said.read())
        self.assertLess(usage.ru_maxrss * 1024, most)
        with open(out, encoding="utf-8") as file:
            result = json.load(file)
        self.assertEqual(result["status"], "solved")
        self.assertTrue(result["check"]["ok"])
        self.assertEqual(result["route"][0], start)
        self.assertEqual(result["route"][-1], goal)
        return result

    def test_city(self):
        start, goal = [0.5, 0.5, 1.5], [999.5, 999.5, 1.5]
        result = self.run_in("city: {generate: simple, cells: [1000, 1000, 200], cell_m: 1}",
                             start, goal)
        self.assertGreater(result["steps"][0]["counters"]["expanded"], 1000)
        straight = math.dist(start, goal)
        self.assertGreater(result["metrics"]["length_m"], straight)
        self.assertLess(result["metrics"]["length_m"], 1.1 * straight)

    def test_wall_with_a_hole(self):
        """Two walls across the world, each with one free voxel."""
        holes = {400: (420, 110), 600: (580, 60)}
        with open(os.path.join(self.folder, "walls.3dmap"), "w", encoding="utf-8") as file:
            file.write("voxel 1000 1000 200\n")
            for x, hole in holes.items():
                for y in range(1000):
                    file.write("".join(f"{x} {y} {z}\n" for z in range(200) if (y, z) != hole))
        result = self.run_in("voxel_map: {file: walls.3dmap}", [300.5, 500.5, 90.5],
                             [700.5, 500.5, 90.5], settings="{corner: free_box}")
        route = result["route"]
        crossed = set()
        for a, b in zip(route, route[1:]):
            for k in range(21):
                cell = tuple(int(p + k / 20 * (q - p)) for p, q in zip(a, b))
                if cell[0] in holes:
                    self.assertEqual(cell[1:], holes[cell[0]])
                    crossed.add(cell[0])
        self.assertEqual(crossed, set(holes))

    def test_checkerboard(self):
        """Four million blocked voxels, none beside another: a box each."""
        edge = 200 if NIGHTLY else 100
        with open(os.path.join(self.folder, "checkerboard.3dmap"), "w", encoding="utf-8") as file:
            file.write(f"voxel {edge} {edge} {edge}\n")
            file.writelines(f"{x} {y} {z}\n" for x in range(edge) for y in range(edge)
                            for z in range((x + y + 1) % 2, edge, 2))
        result = self.run_in("voxel_map: {file: checkerboard.3dmap}", [0.5, 0.5, 0.5],
                             [edge - 0.5, edge - 0.5, edge - 1.5], most=(300 if NIGHTLY else 100) << 20)
        self.assertEqual(result["metrics"]["min_clearance_m"], 0)

    def test_part_of_an_elevation_model(self):
        """20,000 x 20,000 posts, 800 MB of zeros that the file system need not store."""
        posts = 20000 if NIGHTLY else 10000
        middle = 5 * posts
        with open(os.path.join(self.folder, "flat.img"), "wb") as file:
            file.truncate(posts * posts * 2)
        self.write("flat.hdr", f"ENVI\nsamples = {posts}\nlines = {posts}\nbands = 1\n"
                               "header offset = 0\nfile type = ENVI Standard\ndata type = 2\n"
                               "interleave = bsq\nbyte order = 0\n"
                               "map info = {UTM, 1, 1, 400000, 5400000, 10, 10, 32, North, WGS-84}")
        result = self.run_in("terrain: {file: flat.img}", [middle, middle, 200],
                             [middle + 4000, middle + 4000, 200], radius=2,
                             more=f"volume: {{min_m: [{middle - 1000}, {middle - 1000}, 0], "
                                  f"max_m: [{middle + 5000}, {middle + 5000}, 900]}}",
                             settings="{cell_m: [100, 100, 50]}", most=128 << 20)
        self.assertEqual(result["metrics"]["min_ground_clearance_m"], 200)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:])
