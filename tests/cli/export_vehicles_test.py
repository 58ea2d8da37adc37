# SPDX-License-Identifier: Apache-2.0
"""export_vehicles_test.py PROGRAM SOURCES: exported missions of vehicles: take-offs and landings,
speeds of legs, times at points."""
import csv
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree

import ground_station

PROGRAM, SOURCES = sys.argv[1:3]
PIPELINE = str(pathlib.Path(SOURCES) / "configs/pipelines/ridge_crossing.yaml")
SPEED = 178  # MAV_CMD_DO_CHANGE_SPEED
GPX = "{http://www.topografix.com/GPX/1/1}"


def altiplan(*arguments):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=600,
                          check=False)
    return done.returncode, done.stdout, done.stderr


class Vehicles(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def planned_with(self, name, *settings):
        """The README's route for another vehicle: its result, and its metrics."""
        result = self.folder / (name + ".json")
        options = [word for setting in settings for word in ("--set", setting)]
        code, out, err = altiplan("run", PIPELINE, *options, "--out", str(result))
        self.assertEqual(code, 0, out + err)
        return str(result), json.loads(result.read_text())["metrics"]

    def test_take_offs_and_landings_of_vehicle_types(self):
        for vehicle, number, ends in (("copter", 2, (22, 21)), ("vtol", 20, (84, 85)),
                                      ("plane", 1, (22, 16))):
            result, _ = self.planned_with(vehicle, f"scenario.vehicle.type={vehicle}",
                                          "scenario.vehicle.speed_near=[]")
            land = ["--land"] if vehicle != "plane" else []
            code, out, err = altiplan("export", result, "--to", "qgc-plan", "--takeoff", *land)
            self.assertEqual(code, 0, err)
            mission = ground_station.plan(out)["mission"]
            self.assertEqual(mission["vehicleType"], number)
            self.assertEqual((mission["items"][0]["command"], mission["items"][-1]["command"]), ends)
            if vehicle == "plane":
                self.assertEqual(mission["items"][0]["params"][0], 10)  # pitch
                self.assertIn("an aeroplane climbs to the start from its runway", err)
                code, out, err = altiplan("export", result, "--to", "qgc-plan", "--land")
                self.assertEqual((code, out), (3, ""))
                self.assertIn("vehicle: {type: vtol}", err)

    def test_speeds_of_legs_and_times(self):
        result, metrics = self.planned_with(
            "speeds", "scenario.start_time=2026-05-01T10:00:00Z", "scenario.vehicle.speed_near="
            "[{within_m: 200, speed_mps: 7}, {within_m: 1000, speed_mps: 12}]")
        code, out, err = altiplan("export", result, "--to", "qgc-plan")
        self.assertEqual(code, 0, err)
        items = ground_station.plan(out)["mission"]["items"]
        speeds = [item["params"][1] for item in items if item["command"] == SPEED]
        self.assertTrue({7, 12} & set(speeds), speeds)
        self.assertTrue(all(a != b for a, b in zip(speeds, speeds[1:])), "said twice")
        places = len(items) - len(speeds)
        code, out, err = altiplan("export", result, "--to", "qgc-plan", "--max-items",
                                  str(len(items) - 10))
        self.assertEqual(code, 0, err)
        self.assertLessEqual(len(json.loads(out)["mission"]["items"]), len(items) - 10)
        rows = list(csv.DictReader(altiplan("export", result, "--to", "csv")[1].splitlines()))
        times = [float(row["time_s"]) for row in rows]
        self.assertEqual((len(times), times[0]), (places, 0))
        self.assertEqual(times, sorted(times))
        self.assertGreaterEqual(times[-1], metrics["duration_s"] - 0.01)  # each leg at its slowest
        line = json.loads(altiplan("export", result, "--to", "geojson")[1])["features"][0]
        self.assertEqual(line["properties"]["times_s"], times)
        root = xml.etree.ElementTree.fromstring(altiplan("export", result, "--to", "gpx")[1])
        clock = [point.find(f"{GPX}time").text for point in root.iter(f"{GPX}rtept")]
        self.assertEqual(clock[0], "2026-05-01T10:00:00Z")
        self.assertEqual(len(set(clock)), places)

    def test_the_last_time_is_the_duration(self):
        result, metrics = self.planned_with("steady", "scenario.vehicle.speed_near=[]")
        rows = list(csv.DictReader(altiplan("export", result, "--to", "csv")[1].splitlines()))
        self.assertAlmostEqual(float(rows[-1]["time_s"]), metrics["duration_s"], 2)
        self.assertNotIn("<time>", altiplan("export", result, "--to", "gpx")[1])  # no start time


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
