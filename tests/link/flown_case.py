# SPDX-License-Identifier: Apache-2.0
"""What tests of `altiplan fly` share: a vehicle of tests/link/vehicle in a process, its log, and
scenarios around its home."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

HOME = "47,8,500"
SPEEDUP = 10
PX4_SPEEDUP = 2  # OFFBOARD ends 1 s of flight after the last set-point
COPTER = "{speed_mps: 8, sensing_m: 200}"
PLANE = "{wing: {airspeed_mps: 22, bank_deg: 35}, sensing_m: 900}"
SCENARIO = """altiplan: 1
frame: {{origin_lonlat: [8.0, 47.0]}}
environment:
  - cylinder: {{at_m: [-500, -2500], radius_m: 10}}
    id: mast
volume: {{min_m: [-3000, -3000, 400], max_m: [6000, 3000, 800]}}
vehicle: {vehicle}
start: {{at_m: [{start}, 0, 530]}}
goal: {{at_m: [{goal}, 0, 530]}}
events:
{events}
"""
PIPELINE = """altiplan: 1
scenario: scenario.yaml
steps:
  - plan: theta_star
    with: {{cell_m: [50, 50, 50]}}
  - fly: {pilot}
    step_s: 1
    with: {parameters}
"""
# Radius, ring and turns for the speed of each.
POP_UP = {
    "copter": ("  - {at_s: 5, add: {cylinder: {at_m: [230, 5], radius_m: 30}}, id: pop_up}",
               "{variant: robust, ring_m: 60, min_turn_radius_m: 15, release_m: 15}"),
    "plane": ("  - {at_s: 5, add: {cylinder: {at_m: [2300, 20], radius_m: 200}}, id: pop_up}",
              "{variant: robust, ring_m: 400, min_turn_radius_m: 150, "
              "release_m: 60}")}


class Vehicle:
    """A process of vehicle.py, with its log."""

    def __init__(self, program, log, *options):
        self.log_file = log
        self.process = subprocess.Popen(
            [sys.executable, program, "--listen", "udpin", "127.0.0.1:0", "--home", HOME, "--seed",
             "1", "--log", log, *options], stdout=subprocess.PIPE, text=True)
        word, port = self.process.stdout.readline().split()
        assert word == "listening"
        self.address = f"udp:127.0.0.1:{port}"

    def end(self):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()

    def log(self, *events):
        with open(self.log_file, encoding="utf-8") as file:
            text = file.read()  # at once: it grows
        entries = [json.loads(line) for line in text[:text.rfind("\n") + 1].splitlines()]
        return [entry for entry in entries if not events or entry["event"] in events]

    def modes(self):
        return [entry["mode"] for entry in self.log("mode")]

    def wait(self, condition, seconds=30):
        """True as soon as the condition holds."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return True
            time.sleep(0.05)
        return False


class FlownCase(unittest.TestCase):
    program = sources = None

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_fly_")
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def altiplan(self, *arguments, timeout=600):
        done = subprocess.run([self.program, *arguments], capture_output=True, text=True,
                              timeout=timeout, check=False)
        return done.returncode, done.stdout, done.stderr

    def planned(self, kind="copter", pop_up=False, pilot="velocity_field"):
        """A result of altiplan run, flown in simulation: its file."""
        vehicle = PLANE if kind == "plane" else COPTER
        start, goal = (700, 4000) if kind == "plane" else (0, 450)
        events, parameters = POP_UP[kind]
        for name, text in (
                ("scenario.yaml", SCENARIO.format(vehicle=vehicle, start=start, goal=goal,
                                                  events=events if pop_up else "  []")),
                ("pipeline.yaml", PIPELINE.format(pilot=pilot, parameters=parameters
                                                  if pilot != "route" else "{}"))):
            with open(self.path(name), "w", encoding="utf-8") as file:
                file.write(text)
        result = self.path("result.json")
        code, out, err = self.altiplan("run", self.path("pipeline.yaml"), "-o", result)
        self.assertEqual(code, 0, out + err)
        return result

    def vehicle(self, *options, speedup=None):
        speedup = speedup or (PX4_SPEEDUP if "px4" in options else SPEEDUP)
        vehicle = Vehicle(os.path.join(self.sources, "tests", "link", "vehicle", "vehicle.py"),
                          self.path(f"{self.id()}.{time.monotonic_ns()}.jsonl"), "--speedup",
                          str(speedup), *options)
        self.addCleanup(vehicle.end)
        return vehicle

    def flying(self, result, vehicle, *options):
        """A process of altiplan fly that is still under way."""
        if os.path.exists(self.path("flown.json")):
            os.remove(self.path("flown.json"))
        process = subprocess.Popen(
            [self.program, "fly", result, "--link", vehicle.address, "-o",
             self.path("flown.json"), *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
            text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def fly(self, result, vehicle, *options):
        """Exit code, the flight as written, and all output."""
        process = self.flying(result, vehicle, *options)
        out, err = process.communicate(timeout=600)
        self.assertTrue(os.path.exists(self.path("flown.json")), out + err)
        return process.returncode, self.flight(), out + err

    def flight(self):
        with open(self.path("flown.json"), encoding="utf-8") as file:
            return json.load(file)["flight"]


def run_together(names, flights=8):
    """The tests of those names, of the main file by default, so many at a time, for they wait for
    the clock more than they compute: true if none fails."""
    loader = unittest.defaultTestLoader
    main = sys.modules["__main__"]
    tests, suites = [], [loader.loadTestsFromNames(names, main) if names else
                         loader.loadTestsFromModule(main)]
    for suite in suites:  # grows
        for test in suite:
            (suites if isinstance(test, unittest.TestSuite) else tests).append(test)

    def failures(test):
        result = test.run()
        print("FAILED" if result.failures or result.errors else "skipped" if result.skipped else "ok",
              test.id(), flush=True)
        return [text for _, text in result.failures + result.errors]

    with ThreadPoolExecutor(flights) as pool:
        failed = [text for texts in pool.map(failures, tests) for text in texts]
    print(*failed, sep="\n")
    return bool(tests) and not failed
