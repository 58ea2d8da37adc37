# SPDX-License-Identifier: Apache-2.0
"""fly_test.py PROGRAM SOURCES: altiplan fly with the vehicle of tests/link/vehicle. By day most flights are those of
one autopilot."""
import json
import os
import pathlib
import signal
import sys
import time

from flown_case import SPEEDUP, FlownCase, run_together

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import by_day  # noqa: E402

FlownCase.program, FlownCase.sources = sys.argv[1:3]
COPTERS = ("generic", "ardupilot", "px4")
TAKEOFF = ("--takeoff", "--home-altitude", "500")
# So that each ends in a hold when nothing reaches it; of a generic one that is not known.
HOLDING = {"px4": ("--parameter", "COM_OBL_RC_ACT=5")}
ACCEPTED = {"generic": ("--accept-failsafe",)}


class Fly(FlownCase):
    """What the tests share."""

    def expect_flown(self, code, flight, out):
        self.assertEqual(code, 0, out)
        self.assertEqual(flight["status"], "solved")
        self.assertEqual(flight["check"]["violations"], [])
        self.assertTrue(flight["reached"])

    def expect_nothing_uploaded(self, vehicle):
        received = {entry["message"] for entry in vehicle.log("received")}
        self.assertIn("HEARTBEAT", received)
        self.assertFalse(received & {"MISSION_COUNT", "COMMAND_LONG", "COMMAND_INT"})


class Flown(Fly):
    """Routes and threats, to the end."""

    def test_a_route_is_flown_and_judged(self):
        result = self.planned(pilot="route")
        for autopilot in by_day(COPTERS, 2):
            with self.subTest(autopilot=autopilot):
                vehicle = self.vehicle("--autopilot", autopilot, speedup=SPEEDUP)
                code, flight, out = self.fly(result, vehicle, *TAKEOFF, "--land", "--arm")
                self.expect_flown(code, flight, out)
                self.assertEqual(flight["link"], vehicle.address)
                self.assertLess(flight["cross_track_max_m"], 1)
                self.assertGreater(len(flight["track"]), 150)
                self.assertNotIn("setpoint", [entry["event"] for entry in vehicle.log()])
                code, out, err = self.altiplan("check", self.path("flown.json"))
                self.assertEqual(code, 0, out + err)
                code, out, err = self.altiplan("view", self.path("flown.json"), "-o",
                                               self.path("page.html"))
                self.assertEqual(code, 0, out + err)

    def test_a_plane_flies_a_route(self):
        vehicle = self.vehicle("--autopilot", "ardupilot", "--type", "plane", "--wind", "0,6")
        code, flight, out = self.fly(self.planned("plane", pilot="route"), vehicle, "--arm")
        self.expect_flown(code, flight, out)
        self.assertLess(flight["cross_track_max_m"], 100)

    def test_a_threat_is_flown_around(self):
        for kind, autopilots in by_day((("copter", COPTERS), ("plane", ("ardupilot",))), 2):
            result = self.planned(kind, pop_up=True)
            for autopilot in by_day(autopilots, 3, 1):
                with self.subTest(autopilot=autopilot, kind=kind):
                    vehicle = self.vehicle("--autopilot", autopilot, "--type", kind,
                                           *HOLDING.get(autopilot, ()))
                    options = (TAKEOFF if kind == "copter" else ()) + ACCEPTED.get(autopilot, ())
                    code, flight, out = self.fly(result, vehicle, "--arm", "--command", *options)
                    self.assertIn("when nothing reaches the vehicle any more, ", out)
                    self.expect_flown(code, flight, out)
                    self.assertEqual([handover["to"] for handover in flight["handovers"]],
                                     ["velocity_field", "route"])
                    modes = vehicle.modes()
                    self.assertEqual(modes[modes.index("AUTO"):][:3], ["AUTO", "GUIDED", "AUTO"])
                    self.assertGreater(flight["min_separation_m"], 5)

    def test_the_height_is_kept_under_command(self):
        vehicle = self.vehicle("--autopilot", "ardupilot", "--drift", "0.5")
        code, flight, out = self.fly(self.planned(pop_up=True), vehicle, *TAKEOFF, "--arm",
                                     "--command")
        self.expect_flown(code, flight, out)
        heights = [entry["alt"] for entry in vehicle.log("position") if entry["mode"] == "GUIDED"
                   and entry["alt"] > 525]
        self.assertGreater(len(heights), 50)
        self.assertLess(max(heights), 532)

    def test_terrain_is_answered(self):
        # The world has no ground: nothing is answered, and nothing is harmed.
        vehicle = self.vehicle("--autopilot", "ardupilot", "--terrain")
        code, flight, out = self.fly(self.planned(pilot="route"), vehicle, *TAKEOFF, "--arm")
        self.expect_flown(code, flight, out)
        self.assertTrue([entry for entry in vehicle.log("sent")
                         if entry["message"] == "TERRAIN_REQUEST"])


class Begun(Fly):
    """What is believed, refused or undone before the first item."""

    def test_px4_begins_at_the_first_item_after_half_a_flight(self):
        """It keeps the number of the old mission's item unless the new one says otherwise."""
        vehicle = self.vehicle("--autopilot", "px4", "--faults", '[{"fault": "lose", "direction": "in",'
                               ' "message": "MISSION_SET_CURRENT", "count": 2}]')
        result = self.planned(pilot="route")
        process = self.flying(result, vehicle, *TAKEOFF, "--land", "--arm")
        self.assertTrue(vehicle.wait(lambda: vehicle.log("reached"), 60))
        process.send_signal(signal.SIGINT)
        process.wait(30)
        code, out, err = self.altiplan("upload", result, "--to", vehicle.address, *TAKEOFF, "--land")
        self.assertEqual(code, 0, out + err)
        self.assertEqual([entry["current"] for entry in vehicle.log("plan")], [0, 0])

    def test_a_mode_is_believed_when_the_vehicle_reports_it(self):
        """PX4's receiver accepts each; without set-points OFFBOARD is refused afterwards."""
        faults = ('[{"fault": "lose", "direction": "in", "count": 8, "message":'
                  ' ["SET_POSITION_TARGET_GLOBAL_INT", "SET_POSITION_TARGET_LOCAL_NED"]}]')
        vehicle = self.vehicle("--autopilot", "px4", "--faults", faults, *HOLDING["px4"])
        code, flight, out = self.fly(self.planned(pop_up=True), vehicle, "--arm", "--command", *TAKEOFF)
        self.expect_flown(code, flight, out)
        self.assertIn("GUIDED", vehicle.modes())
        self.assertGreater(flight["min_separation_m"], 5)

    def test_a_mission_that_is_refused_after_its_acknowledgement(self):
        faults = '[{"fault": "change", "infeasible": "Landing pattern required"}]'
        vehicle = self.vehicle("--autopilot", "px4", "--faults", faults)
        code, out, err = self.altiplan("fly", self.planned(), "--link", vehicle.address, "-o",
                                       self.path("flown.json"), "--arm", *TAKEOFF)
        self.assertEqual(code, 1, out + err)
        self.assertIn("declares it invalid (\"Mission rejected: Landing pattern required\")", out + err)
        self.assertEqual(vehicle.log("armed"), [])

    def test_a_start_that_comes_to_nothing(self):
        """Before the first item: the motors stop, or a pilot switches the mode."""
        result = self.planned()
        for autopilot in by_day(("ardupilot", "px4"), 2):
            for fault, words in (({"fault": "disarm"}, "it has disarmed"),
                                 ({"fault": "switch"}, "it is in the mode ")):
                with self.subTest(autopilot=autopilot, fault=fault):
                    script = json.dumps([{**fault, "message": "COMMAND_LONG", "command": 178}])
                    vehicle = self.vehicle("--autopilot", autopilot, "--faults", script, speedup=1)
                    code, flight, out = self.fly(result, vehicle, *TAKEOFF, "--arm")
                    self.assertEqual(code, 1, out)
                    self.assertIn("the vehicle has left its mission before the first item: " +
                                  words, flight["message"])

    def test_a_start_without_an_answer_is_undone(self):
        """It has begun all the same, and climbs."""
        faults = ('[{"fault": "lose", "direction": "out", "message": "COMMAND_ACK", "command": 300,'
                  ' "count": 99}]')
        vehicle = self.vehicle("--autopilot", "ardupilot", "--faults", faults, speedup=1)
        code, flight, out = self.fly(self.planned(), vehicle, *TAKEOFF, "--arm")
        self.assertEqual(code, 1, out)
        self.assertIn("does not answer the command to start its mission", flight["message"])
        self.assertTrue(vehicle.wait(lambda: vehicle.modes()[-1] == "HOLD", 5))

    def test_reports_are_asked_for_until_they_come(self):
        """ArduCopter sends none unasked, and ArduPlane too few to command it by."""
        def lose(message, count):
            return {"fault": "lose", "direction": "in", "message": "COMMAND_LONG", "command": 511,
                    "param1": message, "count": count}
        faults = [lose(33, 3), lose(42, 3), {"fault": "lose", "message": "MISSION_ITEM_REACHED"}]
        vehicle = self.vehicle("--autopilot", "ardupilot", "--faults", json.dumps(faults))
        code, flight, out = self.fly(self.planned(pilot="route"), vehicle, *TAKEOFF, "--arm")
        self.expect_flown(code, flight, out)

        vehicle = self.vehicle("--autopilot", "ardupilot", "--type", "plane", "--faults",
                               json.dumps([lose(33, 1)]), speedup=1)
        self.flying(self.planned("plane", pop_up=True), vehicle, "--command")
        self.assertTrue(vehicle.wait(lambda: len([
            entry for entry in vehicle.log("sent")
            if entry["message"] == "GLOBAL_POSITION_INT"]) > 40, 8))

    def test_without_arm_nothing_is_commanded(self):
        vehicle = self.vehicle("--autopilot", "ardupilot")
        process = self.flying(self.planned(), vehicle, *TAKEOFF, "--command")
        line = ""
        while "waiting" not in line:
            line = process.stderr.readline()
            self.assertTrue(line, "it has ended")
        self.assertFalse(vehicle.wait(lambda: vehicle.log("mode", "armed", "setpoint"), 2))
        process.send_signal(signal.SIGINT)
        self.assertEqual(process.wait(30), 130)
        self.assertEqual(vehicle.log("mode", "armed", "setpoint"), [])

    def test_what_is_neither_hold_nor_return_is_not_commanded(self):
        result = self.planned(pop_up=True)
        silent = '[{"fault": "lose", "direction": "out", "message": "PARAM_VALUE"}]'
        for autopilot, options, words in by_day((
                ("px4", (), "it flies on for 1 s and is in POSCTL"),
                ("px4", ("COM_OBL_RC_ACT=4",), "lands where it is"),
                ("px4", ("COM_OBL_RC_ACT=5", "NAV_DLL_ACT=6"), "holds, then disarms"),
                ("px4", ("COM_OBL_RC_ACT=9",), "what is not known here"),
                ("ardupilot", ("FS_GCS_ENABLE=5",), "hovers, then lands where it is"),
                ("ardupilot", ("GUID_TIMEOUT=30.0",), "it flies on for 30 s"),
                ("ardupilot", (silent,), "it does not tell its parameter GUID_TIMEOUT"),
                ("generic", (), "its autopilot is neither ArduPilot nor PX4")), 3, 1):
            with self.subTest(autopilot=autopilot, options=options):
                more = [part for option in options for part in
                        ("--faults" if option == silent else "--parameter", option)]
                vehicle = self.vehicle("--autopilot", autopilot, *more)
                code, out, err = self.altiplan("fly", result, "--link", vehicle.address, *TAKEOFF,
                                               "--arm", "--command")
                self.assertEqual(code, 1, out + err)
                self.assertIn(words, err)
                self.assertIn("--accept-failsafe commands it all the same", err)
                self.expect_nothing_uploaded(vehicle)

    def test_a_route_is_not_flown_by_another_kind(self):
        vehicle = self.vehicle("--autopilot", "ardupilot")
        code, out, err = self.altiplan("fly", self.planned("plane", pilot="route"), "--link",
                                       vehicle.address, "--arm")
        self.assertEqual(code, 1, out + err)
        self.assertIn("the route is an aeroplane's, and the vehicle is a quadrotor", err)
        self.expect_nothing_uploaded(vehicle)

    def test_usage(self):
        result = self.planned()
        for options, words in ((("--arcs", "loiter"), "give --arcs points"),):
            code, _, err = self.altiplan("fly", result, "--link", "udp:127.0.0.1:9", *options)
            self.assertEqual(code, 2)
            self.assertIn(words, err)


class Ended(Fly):
    """How flights end that nobody planned so."""

    def test_without_command_a_danger_is_only_noted(self):
        vehicle = self.vehicle("--autopilot", "ardupilot")
        code, flight, out = self.fly(self.planned(pop_up=True), vehicle, *TAKEOFF, "--arm")
        self.assertEqual(code, 1, out)
        self.assertEqual(flight["status"], "collided")
        self.assertIn("too close to 'pop_up', but commands are not allowed",
                      flight["handovers"][0]["why"])
        self.assertEqual(vehicle.log("setpoint"), [])

    def test_a_lost_link_is_one_sentence(self):
        faults = '[{"fault": "silence", "from": 6, "seconds": 30}]'
        vehicle = self.vehicle("--autopilot", "ardupilot", "--faults", faults, speedup=5)
        code, flight, out = self.fly(self.planned(), vehicle, *TAKEOFF, "--arm", "--command")
        self.assertEqual(code, 1, out)
        self.assertEqual((flight["status"], flight["reached"]), ("not_reached", False))
        self.assertIn("the link is lost", flight["message"])
        self.assertGreater(len(flight["track"]), 20)
        self.assertEqual(vehicle.log("setpoint"), [])
        self.assertNotIn("HOLD", vehicle.modes())

    def test_what_is_interrupted_or_killed_is_left_in_hold(self):
        result = self.planned(pop_up=True)
        for number, autopilot in ((signal.SIGKILL, "ardupilot"), (signal.SIGINT, "px4")):
            with self.subTest(signal=number):
                vehicle = self.vehicle("--autopilot", autopilot, *HOLDING.get(autopilot, ()),
                                       speedup=3)
                process = self.flying(result, vehicle, *TAKEOFF, "--arm", "--command")
                self.assertTrue(vehicle.wait(lambda: vehicle.modes()[-1:] == ["GUIDED"] and
                                             vehicle.log("setpoint"), 60))
                process.send_signal(number)
                self.assertTrue(vehicle.wait(lambda: vehicle.modes()[-1] == "HOLD", 20))
                self.assertIn(process.wait(30), (-signal.SIGKILL, 130))

    def test_a_pilot_who_has_switched_keeps_the_vehicle(self):
        """Also where the flight ends before the new mode has been looked at for long."""
        result = self.planned(pop_up=True)
        switch = ('[{"fault": "switch", "mode": "RTL", "skip": 60, "count": 1, "message":'
                  ' ["SET_POSITION_TARGET_GLOBAL_INT", "SET_POSITION_TARGET_LOCAL_NED"]}]')
        for autopilot in by_day(("ardupilot", "px4"), 2):
            with self.subTest(autopilot=autopilot):
                vehicle = self.vehicle("--autopilot", autopilot, *HOLDING.get(autopilot, ()),
                                       "--faults", switch, speedup=3)
                process = self.flying(result, vehicle, *TAKEOFF, "--arm", "--command")
                self.assertTrue(vehicle.wait(lambda: "RTL" in vehicle.modes(), 60))
                time.sleep(1.2)  # a heartbeat later
                process.send_signal(signal.SIGINT)
                process.wait(30)
                self.assertFalse(vehicle.wait(lambda: vehicle.modes()[-1] != "RTL", 4))

    def test_a_late_planner_leaves_the_vehicle_in_hold(self):
        vehicle = self.vehicle("--autopilot", "generic", speedup=3)
        process = self.flying(self.planned(pop_up=True), vehicle, *TAKEOFF, "--arm", "--command",
                              "--accept-failsafe")
        self.assertTrue(vehicle.wait(lambda: vehicle.log("setpoint"), 60))
        process.send_signal(signal.SIGSTOP)
        self.assertTrue(vehicle.wait(lambda: vehicle.modes()[-1] == "HOLD", 20))
        process.send_signal(signal.SIGCONT)
        self.assertEqual(process.wait(30), 1)
        self.assertIn("which this flight has not asked for", self.flight()["message"])
        self.assertEqual(vehicle.modes()[-1], "HOLD")

    def test_a_mission_that_another_program_replaces(self):
        other = os.path.join(self.folder, "other.json")
        os.rename(self.planned(pilot="route"), other)
        result = self.planned(pop_up=True)
        for autopilot in by_day(("px4", "ardupilot"), 2):
            with self.subTest(autopilot=autopilot):
                vehicle = self.vehicle("--autopilot", autopilot, *HOLDING.get(autopilot, ()),
                                       speedup=3)
                process = self.flying(result, vehicle, *TAKEOFF, "--arm", "--command")
                self.assertTrue(vehicle.wait(lambda: vehicle.log("reached"), 60))
                _, out, err = self.altiplan("upload", other, "--to", vehicle.address,
                                            "--takeoff", "--land", "--home-altitude", "500")
                self.assertIn("the vehicle is armed", out + err)
                out, err = process.communicate(timeout=600)
                self.assertEqual(process.returncode, 1, out + err)
                self.assertIn("another program has replaced the vehicle's mission", out)

    def test_an_aeroplane_that_does_not_turn_as_commanded(self):
        """It accepts each set-point, and flies straight on: PX4's simulation did so once."""
        vehicle = self.vehicle("--autopilot", "ardupilot", "--type", "plane", "--stiff-after",
                               "10", speedup=SPEEDUP)
        code, flight, out = self.fly(self.planned("plane", pop_up=True), vehicle, "--arm",
                                     "--command")
        self.assertEqual(code, 1, out)
        self.assertIn("the vehicle does not turn as it is commanded", flight["message"])
        self.assertLess(flight["track"][-1][0], 240)
        self.assertEqual(vehicle.modes()[-1], "HOLD")

    def test_motors_that_stop_in_flight(self):
        """Also where it is too low for its pilot before a heartbeat says so."""
        stop = ('[{"fault": "disarm", "skip": 60, "count": 1, "message":'
                ' ["SET_POSITION_TARGET_GLOBAL_INT", "SET_POSITION_TARGET_LOCAL_NED"]}]')
        for autopilot in by_day(("ardupilot", "px4"), 2):
            with self.subTest(autopilot=autopilot):
                vehicle = self.vehicle("--autopilot", autopilot, *HOLDING.get(autopilot, ()),
                                       "--parameter", "COM_OF_LOSS_T=5.0", "--faults", stop,
                                       speedup=SPEEDUP)
                code, flight, out = self.fly(self.planned(pop_up=True), vehicle, *TAKEOFF, "--arm",
                                             "--command")
                self.assertEqual(code, 1, out)
                self.assertIn("the vehicle has disarmed in flight", flight["message"])


if __name__ == "__main__":
    if not os.path.exists(os.path.join(FlownCase.sources, "tests", "link", "vehicle")):
        print("skipped: tests/link/vehicle is missing")
        sys.exit(77)
    sys.exit(0 if run_together(sys.argv[3:]) else 1)
