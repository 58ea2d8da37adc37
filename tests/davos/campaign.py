# SPDX-License-Identifier: Apache-2.0
"""Aeroplanes between random loiter circles over the Davos elevation model, by the program alone.

Draws pairs of circles that fit, plans between them with each planner, writes each accepted route as
a mission and has it judged again as it was written. With --bench, flies them too. Prints shares,
lengths and times with 95 % intervals, and fails if a route that was accepted is refused as written.
"""
import argparse
import json
import math
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tempfile

SIDE = 5580, 4940  # metres, of the model
RADIUS = 80
PLANNERS = "hybrid_astar", "rrt_star"
# What a polyline with corners in place of turns may violate, as check says.
CORNERS = {"turn_radius", "climb_angle", "start_heading", "goal_heading", "start", "goal"}


def scenario(terrain, ends, wind, margin):
    """Circles at `ends`: (x, y, sense)."""
    airspeed = 20
    bank = math.degrees(math.atan(airspeed ** 2 / (9.80665 * RADIUS)))

    def end(x, y, sense):
        return {"at_m": [x, y], "above_ground_m": 85,
                "loiter": {"radius_m": round(1.01 * RADIUS * (1 + wind / airspeed) ** 2, 1),
                           "sense": sense}}
    return {
        "altiplan": 1, "environment": [{"terrain": {"file": str(terrain)}}],
        "volume": {"min_m": [0, 0, 1500], "max_m": [*SIDE, 3100]},
        "vehicle": {"radius_m": 1,
                    "wing": {"airspeed_mps": airspeed, "bank_deg": bank, "climb_deg": 8.6,
                             "sink_deg": 8.6}},
        **({"wind": {"from_deg": 250, "speed_mps": wind}} if wind else {}),
        "start": end(*ends[0]), "goal": end(*ends[1]),
        "constraints": [
            {"altitude": {"min_m": 50 + margin, "max_m": 120 - margin, "datum": "ground",
                          "applies_to": "route"}},
            {"altitude": {"min_m": 50, "max_m": 120, "datum": "ground", "applies_to": "track"}}],
    }


def pipeline(planner, seconds, radius):
    step = {"plan": planner, "id": "route", "within_s": seconds, "with": {"radius_m": radius}}
    if planner == "rrt_star":
        step["with"]["max_iterations"] = 100_000_000
    return {"altiplan": 1, "scenario": "scenario.yaml", "steps": [step]}


class Campaign:
    def __init__(self, arguments, folder):
        self.arguments = arguments
        self.program = arguments.program.resolve()
        self.folder = folder

    def call(self, *arguments):
        return subprocess.run([self.program, *arguments], cwd=self.folder, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE)

    def write(self, name, content):
        (self.folder / name).write_text(json.dumps(content))  # JSON is YAML

    def run(self, planner):
        self.write(f"{planner}.yaml", pipeline(planner, self.arguments.seconds,
                                               self.arguments.radius))
        ran = self.call("run", f"{planner}.yaml", "-o", f"{planner}.json", "--seed", "1")
        if ran.returncode not in (0, 1):
            sys.exit(f"{planner}: exit code {ran.returncode}: {ran.stderr}")
        return json.loads((self.folder / f"{planner}.json").read_text())

    def judged_as_written(self, planner, arcs):
        """The judge's answer to the result's route, written as a mission and read back: export
        judges turns that are written as points along the turns, and check reports their corners."""
        written = self.call("export", f"{planner}.json", "--to", "qgc-plan", "--arcs", arcs,
                            "-o", f"{arcs}.plan")
        if written.returncode != 0:
            return f"not written: {written.stderr}"
        judged = self.call("check", "--route", f"{arcs}.plan", "--scenario", "scenario.yaml",
                           "--json")
        if judged.returncode not in (0, 1):
            return judged.stderr
        found = {violation["constraint"] for violation
                 in json.loads(judged.stdout)["check"]["violations"]}
        return "" if found <= CORNERS else str(found)


def wilson(count, total):
    z = 1.96
    middle = (count + z * z / 2) / (total + z * z)
    half = z / (total + z * z) * math.sqrt(count * (total - count) / total + z * z / 4)
    return f"{count}/{total} = {count / total:.3f} [{middle - half:.3f}, {middle + half:.3f}]"


def median_interval(values):
    """The median with its order statistics at 95 %."""
    ordered = sorted(values)
    n = len(ordered)
    off = 0.98 * math.sqrt(n)
    low, high = ordered[max(0, int(n / 2 - off))], ordered[min(n - 1, math.ceil(n / 2 + off))]
    return f"{statistics.median(ordered):.4f} [{low:.4f}, {high:.4f}]"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=pathlib.Path)
    parser.add_argument("sources", type=pathlib.Path)
    parser.add_argument("--pairs", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=2)
    parser.add_argument("--wind", type=float, default=0)
    parser.add_argument("--margin", type=float, default=0)
    parser.add_argument("--radius", type=float, default=RADIUS, help="of turns, metres")
    parser.add_argument("--bench", type=pathlib.Path, help="altiplan-bench: flies the routes")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    data = os.environ.get("ALTIPLAN_TEST_DATA", arguments.sources / "../shared/data")
    arguments.terrain = pathlib.Path(data).resolve() / "dem/davosdorf.tif"
    if not arguments.terrain.exists():
        print(f"skipped: no {arguments.terrain} (ALTIPLAN_TEST_DATA)")
        return 77
    with tempfile.TemporaryDirectory() as folder:
        return compare(pathlib.Path(folder), random.Random(arguments.seed), arguments)


def compare(folder, rng, arguments):
    solved = {planner: {} for planner in PLANNERS}
    times = {planner: [] for planner in PLANNERS}
    refused = []
    drawn = pair = 0
    while pair < arguments.pairs:
        drawn += 1
        ends = [(rng.uniform(200, SIDE[0] - 200), rng.uniform(200, SIDE[1] - 200),
                 rng.choice(("left", "right"))) for _ in range(2)]
        here = folder / f"{pair:04}"
        here.mkdir(exist_ok=True)
        campaign = Campaign(arguments, here)
        campaign.write("scenario.yaml", scenario(arguments.terrain, ends, arguments.wind,
                                                 arguments.margin))
        for planner in PLANNERS:
            result = campaign.run(planner)
            step = result["steps"][0]
            if step["status"] == "invalid_problem":
                break
            if result["status"] == "solved":
                solved[planner][pair] = result["metrics"]["length_m"]
                times[planner].append(step["time_s"])
                for arcs in ("loiter", "points"):
                    if why := campaign.judged_as_written(planner, arcs):
                        refused.append((pair, planner, arcs, why))
        else:
            pair += 1
    print(f"{pair} pairs of circles that fit, of {drawn} drawn")
    for planner in PLANNERS:
        print(f"{planner}: solved {wilson(len(solved[planner]), pair)}, "
              f"median time {statistics.median(times[planner]):.3f} s")
    both = sorted(set(solved[PLANNERS[0]]) & set(solved[PLANNERS[1]]))
    print(f"length {PLANNERS[1]} / {PLANNERS[0]}, {len(both)} pairs: "
          + median_interval([solved[PLANNERS[1]][n] / solved[PLANNERS[0]][n] for n in both]))
    for planner in PLANNERS if arguments.bench else ():
        results = [folder / f"{n:04}" / f"{planner}.json" for n in solved[planner]]
        flown = subprocess.run([arguments.bench.resolve(), "wing-flights", *results], text=True,
                               stdout=subprocess.PIPE, check=True)
        print(f"{planner}:\n{flown.stdout}")
    for pair, planner, arcs, why in refused:
        print(f"refused as written: pair {pair}, {planner}, --arcs {arcs}: {why}")
    print(f"{len(refused)} routes refused as written")
    return 1 if refused else 0


if __name__ == "__main__":
    sys.exit(main())
