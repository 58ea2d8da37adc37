# SPDX-License-Identifier: Apache-2.0
"""The task `cover` on maps of AC300: coverage_test.py PROGRAM CONFIGS DATA [MAPS]. Each tour is measured by Shapely
(strips with round ends) and by its own sum of legs, and compared with the published costs."""
import csv
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

try:
    from shapely.geometry import LineString, Polygon
    from shapely.ops import unary_union
except ImportError:
    print("skipped: needs python3-shapely")
    sys.exit(77)

SCENARIO = """altiplan: 1
vehicle: {speed_mps: 3, acceleration_mps2: 1}
%stask: {cover: {outline_m: %s, holes_m: %s, spacing_m: 3, closed: true%s}}
"""


def rings(file):
    blocks = file.read_text().strip().split("\n\n")
    return [[[float(v) for v in line.split()] for line in block.splitlines()] for block in blocks]


def seconds(points):
    lengths = [math.dist(p, q) for p, q in zip(points, points[1:])]
    return sum(2 * math.sqrt(m) if m < 9 else m / 3 + 3 for m in lengths)


def flights_of(points):
    """Seconds of each flight from where the tour begins and back there."""
    times, begun = [], 0
    for n in range(1, len(points)):
        if points[n] == points[0]:
            times.append(seconds(points[begun:n + 1]))
            begun = n
    return times


class Tour:
    """A tour of a map as the program plans it, and how it does."""

    def __init__(self, program, pipeline, folder, start="", more=""):
        self.outline = rings(folder / "outer_polygon")[0]
        self.holes = rings(folder / "holes")
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as scenario:
            scenario.write(SCENARIO % (start, self.outline, self.holes, more))
            scenario.flush()
            done = subprocess.run([program, "run", str(pipeline), "--scenario", scenario.name, "--json"],
                                  capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr or done.stdout[:500]
        self.result = json.loads(done.stdout)
        self.points = [p[:2] for p in self.result["route"]]
        self.time_s = self.result["metrics"]["time_s"]

    def check(self):
        """Coverage, islands, time, ends; returns the share that is covered."""
        line = LineString(self.points)
        free = Polygon(self.outline).difference(unary_union([Polygon(h) for h in self.holes]))
        covered = free.intersection(line.buffer(1.5, resolution=64)).area / free.area
        inside = max(line.intersection(Polygon(h).buffer(-1e-6)).length for h in self.holes)
        assert covered >= 0.9999, covered
        assert inside == 0, inside
        assert abs(seconds(self.points) - self.time_s) < 1e-3, (seconds(self.points), self.time_s)
        assert self.points[0] == self.points[-1]
        task = self.result["task"]
        assert task["bound_s"] <= self.time_s + 1e-6, task
        return covered


def main():
    program, configs, data = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
    data = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", data)) / "survey"
    if not data.is_dir():
        print("no test data: set ALTIPLAN_TEST_DATA")
        sys.exit(77)
    pipeline = configs / "pipelines/cover.yaml"
    published = list(csv.DictReader((data / "published_costs.csv").open()))
    count = int(sys.argv[4]) if len(sys.argv) > 4 else len(published)
    some = published[:: max(1, len(published) // count)]
    closed = []
    for row in some:
        folder = data / "maps" / row["instance"]
        tour = Tour(program, pipeline, folder)
        covered = tour.check()
        closed.append((tour.time_s, float(row["unc_closed_tour_s"])))
        corner = Tour(program, pipeline, folder, "start: {at_m: [0, 0, 0]}\n")
        corner.check()
        if row["eth_our_bcd_s"]:
            assert corner.time_s < float(row["eth_our_bcd_s"]), row
        several = Tour(program, pipeline, folder, more=", capacity_s: 1200")
        several.check()
        flights = several.result["task"]["flights"]
        assert max(flights) <= 1200 + 1e-6, flights
        flown = flights_of(several.points)
        assert len(flown) == len(flights) and all(abs(a - b) < 1e-3 for a, b in zip(flown, flights)), (flown, flights)
        print("%-10s %7.1f of %7.1f s, bound %7.1f, from the corner %7.1f, %d flights %7.1f of %7.1f, covered %.4f %%"
              % (row["instance"], tour.time_s, closed[-1][1], tour.result["task"]["bound_s"], corner.time_s,
                 len(flights), sum(flights), float(row["unc_cap1200_sum_s"]), 100 * covered), flush=True)
        assert sum(flights) <= 1.01 * float(row["unc_cap1200_sum_s"]), row
    mean, best = (sum(column) / len(column) for column in zip(*closed))
    print("mean %.1f s, published %.1f s" % (mean, best))
    assert mean <= best
    assert sum(own <= other for own, other in closed) >= 0.9 * len(closed)
    assert all(own <= 1.01 * other for own, other in closed)


main()
