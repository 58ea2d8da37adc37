# SPDX-License-Identifier: Apache-2.0
"""vehicle_test.py PROGRAM SOURCES: altiplan upload, download and status with the vehicle of
tests/link/vehicle, which is written apart from the library; skipped where that is missing."""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
VEHICLE = os.path.join(SOURCES, "tests", "link", "vehicle", "vehicle.py")
PIPELINE = """altiplan: 1
scenario: scenario.yaml
steps:
  - plan: astar
    with: {cell_m: [50, 50, 50]}
"""
SCENARIO = """altiplan: 1
frame: {origin_lonlat: [8.0, 47.0]}
environment:
  - box: {min_m: [302, 302, 0], max_m: [308, 698, 1000]}
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100], tolerance_m: 5}
"""


def altiplan(*arguments, timeout=600):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=timeout,
                          check=False)
    return done.returncode, done.stdout, done.stderr


class Vehicle(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="altiplan_link_")
        for name, text in (("scenario.yaml", SCENARIO), ("pipeline.yaml", PIPELINE)):
            with open(os.path.join(cls.folder, name), "w", encoding="utf-8") as file:
                file.write(text)
        cls.result = os.path.join(cls.folder, "result.json")
        code, _, err = altiplan("run", os.path.join(cls.folder, "pipeline.yaml"), "-o", cls.result)
        assert code == 0, err

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def vehicle(self, *options, faults=None):
        """The address of a vehicle that lives as long as the test."""
        if faults:
            with open(self.path("faults.json"), "w", encoding="utf-8") as file:
                json.dump(faults, file)
            options = (*options, "--faults", self.path("faults.json"))
        process = subprocess.Popen(
            [sys.executable, VEHICLE, "--listen", "udpin", "127.0.0.1:0", "--home", "47,8,500",
             "--seed", "1", *options], stdout=subprocess.PIPE, text=True)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        word, port = process.stdout.readline().split()
        self.assertEqual(word, "listening")
        return f"udp:127.0.0.1:{port}"

    def test_a_route_goes_up_and_comes_back(self):
        for autopilot in ("generic", "ardupilot", "px4"):
            with self.subTest(autopilot=autopilot):
                address = self.vehicle("--autopilot", autopilot)
                code, out, err = altiplan("upload", self.result, "--to", address)
                self.assertEqual(code, 0, err)
                self.assertIn("read back equal", out)
                code, out, err = altiplan("status", "--from", address)
                self.assertEqual(code, 0, err)
                self.assertIn("quadrotor", out)
                self.assertIn("disarmed", out)
                self.assertIn(", at item ", out)
                for name in ("back.plan", "back.waypoints"):
                    code, _, err = altiplan("download", "--from", address, "-o", self.path(name))
                    self.assertEqual(code, 0, err)
                    code, out, err = altiplan("check", "--route", self.path(name), "--scenario",
                                              self.path("scenario.yaml"))
                    self.assertEqual(code, 0, out + err)

    def test_a_mission_goes_up_as_it_is(self):
        points = [[36.48, -84.38, 1100], [36.54, -84.30, 1200]]
        items = [{"type": "SimpleItem", "command": 16, "frame": 0, "doJumpId": n + 1, "autoContinue": True,
                  "params": [0, 0, 0, 0, *point]} for n, point in enumerate(points)]
        plan = {"fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
                "geoFence": {"version": 2, "polygons": [], "circles": [
                    {"circle": {"center": [36.5, -84.34], "radius": 20000}, "inclusion": True, "version": 1}]},
                "rallyPoints": {"version": 2, "points": [[36.49, -84.37, 200]]},
                "mission": {"version": 2, "firmwareType": 3, "vehicleType": 2, "cruiseSpeed": 15,
                            "hoverSpeed": 5, "plannedHomePosition": [36.48, -84.38, 400], "items": items}}
        with open(self.path("mission.plan"), "w", encoding="utf-8") as file:
            json.dump(plan, file)
        address = self.vehicle("--autopilot", "ardupilot")
        code, out, err = altiplan("upload", self.path("mission.plan"), "--to", address, "--terrain",
                                  os.path.join(SOURCES, "configs", "data", "jacksboro_fault.tif"))
        self.assertEqual(code, 0, out + err)
        for line in ("mission: 2 items uploaded, read back equal", "fence: 1 items uploaded, read back equal",
                     "rally points: 1 items uploaded, read back equal"):
            self.assertIn(line, out)
        # Judged as ArduPilot's copter flies it, it goes to no other vehicle.
        for other in (("--autopilot", "px4"), ("--autopilot", "ardupilot", "--type", "plane")):
            code, out, err = altiplan("upload", self.path("mission.plan"), "--to", self.vehicle(*other),
                                      "--terrain", os.path.join(SOURCES, "configs", "data",
                                                                "jacksboro_fault.tif"))
            self.assertEqual(code, 1, out + err)
            self.assertIn("the mission was judged as flown by ArduPilot copter, and the vehicle is", err)
            self.assertNotIn("uploaded, read back", out)
        # A plan without zones and rally points over those.
        for options, lines in (((), ("fence: the vehicle keeps 1 items", "rally points: the vehicle keeps 1 items")),
                               (("--clear-fence", "--clear-rally"),
                                ("fence: 0 items uploaded, read back equal",
                                 "rally points: 0 items uploaded, read back equal"))):
            code, out, err = altiplan("upload", self.result, "--to", address, *options)
            self.assertEqual(code, 0, out + err)
            for line in lines:
                self.assertIn(line, out)
        code, out, err = altiplan("upload", self.result, "--to", address)
        self.assertEqual((code, "fence" in out, "rally" in out), (0, False, False), out + err)

    def test_ardupilot_keeps_a_take_off_and_a_landing(self):
        for kind in ("copter", "plane"):
            address = self.vehicle("--autopilot", "ardupilot", "--type", kind)
            code, out, err = altiplan("upload", self.result, "--to", address, "--takeoff", "--land",
                                      "--home-altitude", "0")
            self.assertEqual(code, 0, out + err)
            self.assertIn("read back equal", out)

    def test_what_will_be_refused_is_said_beforehand(self):
        address = self.vehicle("--autopilot", "px4", "--type", "plane", faults=[
            {"fault": "change", "infeasible": "Landing pattern required"}])
        code, out, err = altiplan("upload", self.result, "--to", address)
        self.assertEqual(code, 1, out + err)
        self.assertIn("PX4 plane refuses a mission without a landing (MIS_TKO_LAND_REQ)", err)
        self.assertIn("Landing pattern required", out)

    def test_loss_is_harmless(self):
        address = self.vehicle("--autopilot", "ardupilot", faults=[
            {"fault": "lose", "direction": "both", "probability": 0.1},
            {"fault": "double", "direction": "both", "probability": 0.1},
            {"fault": "damage", "direction": "both", "probability": 0.05}])
        code, out, err = altiplan("upload", self.result, "--to", address)
        self.assertEqual(code, 0, err)
        self.assertIn("read back equal", out)

    def test_what_a_vehicle_changes_is_named(self):
        address = self.vehicle(faults=[{"fault": "change", "shift_lat": 1e-5}])
        code, out, err = altiplan("upload", self.result, "--to", address)
        self.assertEqual(code, 1, err)
        self.assertIn("item 0: latitude ", out)

    def test_a_refusal_is_one_sentence(self):
        address = self.vehicle(faults=[{"fault": "nak", "message": "MISSION_ITEM_INT", "seq": 1,
                                        "result": "NO_SPACE"}])
        code, _, err = altiplan("upload", self.result, "--to", address)
        self.assertEqual(code, 1)
        self.assertIn("the vehicle has no space for so many items", err)
        self.assertIn("upload again before it flies", err)

    def test_signed_links(self):
        for name, byte in (("key", b"k"), ("other", b"x")):
            with open(self.path(name), "wb") as file:
                file.write(32 * byte)
        address = self.vehicle("--key", self.path("key"))
        code, out, err = altiplan("upload", self.result, "--to", address, "--sign-key",
                                  self.path("key"))
        self.assertEqual(code, 0, out + err)
        code, _, err = altiplan("status", "--from", address, "--timeout", "2", "--sign-key",
                                self.path("other"))
        self.assertEqual(code, 1)
        self.assertIn("signed with another key", err)

    def test_a_silent_address_is_one_sentence(self):
        code, out, err = altiplan("status", "--from", "udp:127.0.0.1:9", "--timeout", "0.5")
        self.assertEqual((code, out), (1, ""))
        self.assertIn("no heartbeat of a vehicle within 0.5 s", err)
        self.assertEqual(err.count("\n"), 1)

    def test_a_bad_address_is_a_usage_error(self):
        for command in (["status", "--from"], ["upload", self.result, "--to"]):
            code, _, err = altiplan(*command, "udp:14550")
            self.assertEqual(code, 2)
            self.assertIn("expected udp:HOST:PORT", err)


if __name__ == "__main__":
    if not os.path.exists(VEHICLE):
        print("skipped: tests/link/vehicle is missing")
        sys.exit(77)
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
