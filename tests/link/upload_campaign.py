#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""upload_campaign.py ALTIPLAN UPLOAD_PLAN SOURCES [--plans N] [--jobs N] [--seed S] [FILE…]: N plans
with fence and rally points go to vehicles of tests/link/vehicle, of each autopilot in turn, over a
good link and over a bad one, and are read back.

The plans are the missions of shared/data/missions, the FILEs (.plan, .waypoints), routes that are
planned here, one of 800 items, and random ones. What the vehicle stored is compared with what was
sent here, too, apart from the library."""
import argparse
import collections
import concurrent.futures
import json
import math
import os
import random
import statistics
import subprocess
import sys
import tempfile

AUTOPILOTS = ("generic", "ardupilot", "px4")
LINKS = {"good": [],
         "bad": [{"fault": fault, "direction": "both", "probability": 0.2}
                 for fault in ("lose", "double", "reorder")]}
LONG = 800  # items
ROUTES = 12
KINDS = ("mission", "fence", "rally points")
SCENARIO = """altiplan: 1
frame: {{origin_lonlat: [{lon}, {lat}]}}
environment:
  - zones:
      list:
{zones}volume: {{min_m: [0, 0, 0], max_m: [2000, 2000, 300]}}
start: {{at_m: [20, 1000, 100]}}
goal: {{at_m: [1980, 1000, 120], tolerance_m: 5}}
"""
ZONE = ("        - {{id: zone{n}, polygon: {{outline_m: [[{x}, {y}], [{x2}, {y}], [{x2}, {y2}], "
        "[{x}, {y2}]]}}}}\n")
PIPELINE = """altiplan: 1
scenario: scenario.yaml
steps:
  - plan: astar
    with: {cell_m: [40, 40, 40]}
  - smooth: bspline
"""


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("altiplan")
    parser.add_argument("upload_plan")
    parser.add_argument("sources")
    parser.add_argument("files", nargs="*", metavar="FILE")
    parser.add_argument("--plans", type=int, default=200)
    parser.add_argument("--jobs", type=int, default=8)
    parser.add_argument("--seed", type=int, default=1)
    return parser.parse_args()


# Sources of plans.

def missions(options):
    """Files of the folder; the program tells which of them are damaged on purpose."""
    folder = os.path.join(options.sources, "..", "shared", "data", "missions")
    names = sorted(os.listdir(folder)) if os.path.isdir(folder) else []
    return [os.path.join(folder, name) for name in names
            if name.endswith((".plan", ".waypoints", ".txt", ".kml"))]


def planned(options, folder):
    """Routes among keep-out zones, as .plan files with a fence."""
    chance = random.Random(options.seed)
    files = []
    for n in range(ROUTES):
        base = os.path.join(folder, f"route{n}")
        os.mkdir(base)
        zones = ""
        for zone in range(chance.randint(1, 4)):
            x, y = chance.uniform(150, 1500), chance.uniform(0, 1400)
            zones += ZONE.format(n=zone, x=x, y=y, x2=x + chance.uniform(50, 300), y2=y + 500)
        place = {"lon": chance.uniform(-170, 170), "lat": chance.uniform(-60, 60)}
        for name, text in (("scenario.yaml", SCENARIO.format(zones=zones, **place)),
                           ("pipeline.yaml", PIPELINE)):
            with open(os.path.join(base, name), "w", encoding="utf-8") as file:
                file.write(text)
        result, plan = (os.path.join(base, name) for name in ("result.json", "route.plan"))
        done = [subprocess.run([options.altiplan, *command], capture_output=True, text=True,
                               check=False)
                for command in (["run", os.path.join(base, "pipeline.yaml"), "-o", result],
                                ["export", result, "--to", "qgc-plan", "--takeoff", "--land", "-o",
                                 plan])]
        if done[-1].returncode == 0:
            files.append(plan)
    return files


def sources_of(options, folder):
    """What each plan is made from; the rest are random, of 1 to 120 items."""
    files = missions(options) + options.files + planned(options, folder)
    chance = random.Random(options.seed + 1)
    chosen = [str(LONG)] + files[:max(0, options.plans - 1)]
    return chosen + [str(chance.randint(1, 120)) for _ in range(options.plans - len(chosen))]


# One upload.

class Damaged(Exception):
    pass


class Case:
    def __init__(self, options, number, source, link, folder):
        self.options, self.number, self.source, self.link = options, number, source, link
        self.autopilot = AUTOPILOTS[number % len(AUTOPILOTS)]
        self.base = os.path.join(folder, f"{number}_{link}")

    def run(self):
        """(items, seconds, differences)"""
        vehicle = self.start()
        try:
            port = vehicle.stdout.readline().split()[1]
            done = subprocess.run(
                [self.options.upload_plan, f"udp:127.0.0.1:{port}", str(self.number), self.source],
                capture_output=True, text=True, check=False)
        finally:
            vehicle.kill()
            vehicle.wait()
            vehicle.stdout.close()
        if done.returncode != 0:
            if self.link == "good" and not self.source.isdigit() and "heartbeat" not in done.stderr:
                raise Damaged(done.stderr)
            return 0, 0.0, [done.stderr.strip()]
        report = json.loads(done.stdout)
        found = report["differences"] + self.compare(report["sent"])
        return sum(len(items) for items in report["sent"]), report["seconds"], found

    def start(self):
        program = os.path.join(self.options.sources, "tests", "link", "vehicle", "vehicle.py")
        command = [sys.executable, program, "--listen", "udpin", "127.0.0.1:0", "--autopilot",
                   self.autopilot, "--seed", str(self.number), "--log", self.base + ".jsonl"]
        if LINKS[self.link]:
            command += ["--give-up", "30", "--faults", json.dumps(LINKS[self.link])]
        return subprocess.Popen(command, stdout=subprocess.PIPE, text=True)

    def stored(self):
        """The items of each kind that were stored last."""
        plans = [[], [], []]
        with open(self.base + ".jsonl", encoding="utf-8") as file:
            for line in file:
                if '"stored"' in line:
                    entry = json.loads(line)
                    plans[entry["kind"]] = entry["items"]
        os.remove(self.base + ".jsonl")
        return plans

    def compare(self, sent):
        found = []
        for kind, (before, after) in enumerate(zip(sent, self.stored())):
            if kind == 0 and self.autopilot == "ardupilot":
                after = after[1:]
            if len(before) != len(after):
                found.append(f"stored {len(after)} of {len(before)} items of the {KINDS[kind]}")
            for n, (a, b) in enumerate(zip(before, after)):
                if not same(a, b, kind, self.autopilot == "ardupilot"):
                    found.append(f"{KINDS[kind]} {n}: stored {b}, sent {a}")
        return found


def same(sent, stored, kind, rounds):
    """Places and commands are equal; the rest, too, but for what ArduPilot does not store."""
    if (sent[0], *sent[3:5]) != (stored[0], *stored[3:5]):
        return False
    # What was left to the autopilot is its choice.
    numbers = [(a, b or 0.0) for a, b in zip(sent[5:], stored[5:]) if a is not None]
    if not rounds:
        return sent[1:3] == stored[1:3] and all(math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-6)
                                                for a, b in numbers)
    # Centimetres, of floats that are no finer than a millimetre.
    return (kind == 1 or sent[1] % 3 == stored[1] % 3 or sent[1] == stored[1]) and \
        all(abs(a - b) <= 0.011 for a, b in numbers)


# The campaign.

def run_all(options, folder):
    chosen = sources_of(options, folder)
    cases = [Case(options, number, source, link, folder)
             for link in LINKS for number, source in enumerate(chosen)]
    damaged, figures = set(), collections.defaultdict(list)
    differences = 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for case, future in [(case, pool.submit(case.run)) for case in cases]:
            try:
                items, seconds, found = future.result()
            except Damaged:
                damaged.add(case.source)
                continue
            if case.source in damaged:
                continue
            figures[case.link].append((items, seconds))
            for line in found:
                print(f"plan {case.number} ({case.source}, {case.autopilot}, {case.link} link): "
                      f"{line}", flush=True)
            differences += bool(found)
    print(f"{len(damaged)} files are not plans: {sorted(map(os.path.basename, damaged))}")
    for link, done in figures.items():
        seconds = sorted(each[1] for each in done)
        print(f"{link} link: {len(done)} plans, {sum(each[0] for each in done)} items; "
              f"seconds: median {statistics.median(seconds):.2f}, most {seconds[-1]:.2f}")
    print(f"{differences} plans came back with differences")
    return differences


def main():
    options = arguments()
    with tempfile.TemporaryDirectory(prefix="altiplan_uploads_") as folder:
        return int(run_all(options, folder) > 0)


if __name__ == "__main__":
    sys.exit(main())
