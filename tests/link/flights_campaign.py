# SPDX-License-Identifier: Apache-2.0
"""flights_campaign.py PROGRAM SOURCES [--flights N] [--kills N] [--jobs N] [--speedup X]: the experiment
of configs/pipelines/semi_physical.yaml with random targets and threats, simulated and then flown with
the vehicle of tests/link/vehicle; and a flight that is killed at random times under command."""
import argparse
import json
import math
import os
import random
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

from flown_case import Vehicle

SPEED, STEP = 22.0, 1.0
SCENARIO = """altiplan: 1
frame: {{origin_lonlat: [8.0, 47.0]}}
environment:
  - cylinder: {{at_m: [{known_x:.0f}, {known_y:.0f}], radius_m: {known_r:.0f}}}
    id: known
volume: {{min_m: [-3000, -5000, 400], max_m: [9000, 5000, 900]}}
vehicle: {{wing: {{airspeed_mps: 22, bank_deg: 35}}, sensing_m: 1000}}
start: {{at_m: [700, 0, 600]}}
goal: {{at_m: [5500, 0, 600]}}
events:
{events}
"""


def scenario(seed):
    """A known threat beside the route, a target in flight, and threats that appear ahead of it."""
    numbers = random.Random(seed)
    side = numbers.choice((-1, 1))
    target_x, target_y = numbers.uniform(2600, 3600), side * numbers.uniform(600, 1500)
    at = numbers.uniform(20, 45)
    events = [f"  - {{at_s: {at:.0f}, visit: {{at_m: [{target_x:.0f}, {target_y:.0f}, 600], "
              "within_m: 60}}"]
    x = 700 + SPEED * at
    for number in range(numbers.randint(1, 2)):
        share = numbers.uniform(0.45, 0.6) if number == 0 else numbers.uniform(0.2, 0.4)
        towards = (x, 0) if number == 0 else (5500, 0)
        other = (target_x, target_y)
        place = [a + share * (b - a) for a, b in zip(towards, other)]
        place[1] += numbers.uniform(-150, 150)
        events.append(f"  - {{at_s: {at + 2:.0f}, add: {{cylinder: {{at_m: [{place[0]:.0f}, "
                      f"{place[1]:.0f}], radius_m: {numbers.uniform(60, 150):.0f}}}}}, "
                      f"id: pop_up_{number}}}")
    return SCENARIO.format(known_x=numbers.uniform(1500, 4000),
                           known_y=-side * numbers.uniform(500, 900),
                           known_r=numbers.uniform(100, 250), events="\n".join(events))


def place_at(flight, at_s):
    """Position of the track at a time."""
    track = flight["track"]
    return next((point[1:] for point in track if point[0] >= at_s - 1e-6), track[-1][1:])


class Campaign:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.pipeline = os.path.join(options.sources, "configs/pipelines/semi_physical.yaml")

    def path(self, name):
        return os.path.join(self.folder, name)

    def vehicle(self, name):
        program = os.path.join(self.options.sources, "tests/link/vehicle/vehicle.py")
        return Vehicle(program, self.path(f"{name}.jsonl"), "--type", "plane", "--autopilot",
                       "ardupilot", "--speedup", str(self.options.speedup))

    def planned(self, seed):
        """The simulated result: its file, None where the flight is not solved."""
        name, result = self.path(f"{seed}.yaml"), self.path(f"{seed}.json")
        with open(name, "w", encoding="utf-8") as file:
            file.write(scenario(seed))
        done = subprocess.run([self.options.program, "run", self.pipeline, "--scenario", name,
                               "-o", result], capture_output=True, text=True, check=False)
        return (result, done.returncode, done.stdout + done.stderr)

    def command(self, result, vehicle, out):
        return [self.options.program, "fly", result, "--link", vehicle.address, "--arm",
                "--command", "-o", out]

    def fly(self, seed):
        result, code, words = self.planned(seed)
        if not os.path.exists(result):
            return {"seed": seed, "words": words}
        with open(result, encoding="utf-8") as file:
            simulated = json.load(file)["flight"]
        vehicle = self.vehicle(f"flight_{seed}")
        out = self.path(f"{seed}.flown.json")
        began = time.monotonic()
        with open(self.path(f"{seed}.out"), "w", encoding="utf-8") as words:
            process = subprocess.Popen(self.command(result, vehicle, out), stdout=words,
                                       stderr=words)
            _, _, usage = os.wait4(process.pid, 0)
        wall = time.monotonic() - began
        vehicle.end()
        with open(out, encoding="utf-8") as file:
            flown = json.load(file)["flight"]
        return {"seed": seed, "simulated": simulated, "simulated_code": code, "flown": flown,
                "cpu": usage.ru_utime + usage.ru_stime, "wall": wall}

    def kill(self, number):
        """The vehicle's last mode after the process was killed under command."""
        numbers = random.Random(number)
        result, _, _ = self.planned(number)
        vehicle = self.vehicle(f"kill_{number}")
        process = subprocess.Popen(self.command(result, vehicle, self.path(f"k{number}.json")),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        is_commanded = vehicle.wait(lambda: vehicle.modes()[-1:] == ["GUIDED"], 60)
        time.sleep(numbers.uniform(0, 5) * 10 / self.options.speedup)
        before = vehicle.modes()[-1]
        process.send_signal(signal.SIGKILL)
        process.wait()
        held = vehicle.wait(lambda: vehicle.modes()[-1] in ("HOLD", "AUTO"), 20)
        modes = vehicle.modes()
        vehicle.end()
        return is_commanded, before, held, modes[-1]


def report_flights(flights):
    flown = [each for each in flights if "flown" in each]
    solved = [each for each in flown if each["flown"]["status"] == "solved"]
    returned = [each for each in flown if each["flown"]["handovers"] and
                each["flown"]["handovers"][-1]["to"] == "route" and each["flown"]["reached"]]
    entered = [each for each in flown if each["flown"]["collisions"]]
    # Where the field leads from the target straight to the goal, nothing is handed back.
    print(f"solved {len(solved)}/{len(flights)}, in simulation "
          f"{sum(each.get('simulated_code') == 0 for each in flights)}; handed back to the route "
          f"before the goal {len(returned)}")
    print(f"threats entered {len(entered)}: seeds {[each['seed'] for each in entered]}")
    seconds = sum(each["flown"]["track"][-1][0] for each in flown)
    cpu = sum(each["cpu"] for each in flown)
    print(f"load {100 * cpu / seconds:.2f} % of a core by the vehicle's time "
          f"({cpu:.1f} s of CPU in {seconds:.0f} s of flight)")
    latency = [each["flown"]["counters"].get("command_latency_p99_us", 0) for each in flown]
    print(f"command latency p99: median {statistics.median(latency) / 1000:.2f} ms, "
          f"worst {max(latency) / 1000:.2f} ms")
    errors, same = [], 0
    for each in flown:
        pairs = list(zip(each["simulated"]["handovers"], each["flown"]["handovers"]))
        same += [s["to"] for s, _ in pairs] == [f["to"] for f in each["flown"]["handovers"]]
        errors += [math.dist(place_at(each["simulated"], s["at_s"]),
                             place_at(each["flown"], f["at_s"])) for s, f in pairs]
    within = sum(error <= SPEED * STEP for error in errors)
    print(f"hand-overs as in simulation in {same}/{len(flown)} flights; {within} of {len(errors)} "
          f"within a step ({SPEED * STEP:.0f} m), median {statistics.median(errors):.0f} m")
    for each in flights:
        if each not in solved:
            message = each["flown"]["message"] if "flown" in each else each["words"]
            simulated = each["simulated"]["message"] if "simulated" in each else ""
            print(f"  seed {each['seed']}: {message} (in simulation: {simulated})")
    return len(solved) == len(flights) and not entered


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("sources")
    parser.add_argument("--flights", type=int, default=50)
    parser.add_argument("--kills", type=int, default=30)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--speedup", type=float, default=10)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="altiplan_flights_") as folder, \
            ThreadPoolExecutor(options.jobs) as pool:
        campaign = Campaign(options, folder)
        good = True
        if options.flights:
            good = report_flights(list(pool.map(campaign.fly, range(options.flights))))
        if options.kills:
            ends = list(pool.map(campaign.kill, range(options.kills)))
            held = sum(is_commanded and end for is_commanded, _, end, _ in ends)
            under = sum(before == "GUIDED" for _, before, _, _ in ends)
            print(f"killed {options.kills} times, {under} under command: left in hold or AUTO "
                  f"{held}/{options.kills}")
            good = good and held == options.kills
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
