# SPDX-License-Identifier: Apache-2.0
"""Flights in lock-step: missions are flown through their waypoints, set-points are followed and
their loss ends in hold, modes and arming are as the autopilots have them."""
import math
import unittest

import geodesy
from constants import Command, Frame, Result
from flavours import AUTO, GUIDED, HOLD, POSITION, RTL
from flight_case import (HOME_ITEM, ORIGIN, POSITION_ONLY, VELOCITY_ONLY, Flight, at, place,
                         takeoff)
from station import HOME, item


class Copter(Flight):
    def test_square(self):
        corners = [(80, 0, 20), (80, 80, 30), (0, 80, 25)]
        mission = [takeoff(20)] + [at(*corner) for corner in corners] + [
            at(0, 0, 0, Command.NAV_LAND)]
        for flavour in ("generic", "px4", "ardupilot"):
            home = [HOME_ITEM] if flavour == "ardupilot" else []
            self.fly(f"--autopilot {flavour} --wind 270,6", home + mission)
            self.begin()
            self.until_disarmed(200)
            first = len(home)
            self.assertEqual(self.reached(), list(range(first, first + 5)), flavour)
            for corner in corners:
                self.assertLess(self.nearest(place(*corner)), 2.0)
            self.assertLess(geodesy.distance(self.pilot.body.position, ORIGIN), 1.0)
            airspeeds = [message.groundspeed for message in self.station.all("VFR_HUD")]
            self.assertLess(max(airspeeds), 10.6)

    def test_legs_are_followed(self):
        self.fly("", [takeoff(20), at(150, 0, 20), at(150, 150, 40)])
        self.begin()
        self.assertTrue(self.station.run(120, lambda: self.reached() == [0, 1, 2]))
        for _, position in self.track:
            north, east, up = geodesy.vector(ORIGIN, position)
            beside = min(abs(east) if north <= 150 else 9e9,
                         math.hypot(north - 150, up - (20 + 20 * east / 150)))
            self.assertLess(beside, 2.5)

    def test_speed_jump_time_and_return(self):
        speed = item(Command.DO_CHANGE_SPEED, params=(1.0, 4.0, -1.0, 0.0))
        mission = [takeoff(15), speed, at(40, 0, 15), at(0, 0, 15, params=(5.0, 0, 0, 0)),
                   item(Command.DO_JUMP, params=(2.0, 1.0, 0, 0)),
                   item(Command.NAV_RETURN_TO_LAUNCH)]
        self.fly("", mission)
        self.begin()
        self.until_disarmed(200)
        self.assertEqual(self.reached(), [0, 2, 3, 2, 3, 5])
        speeds = [message.groundspeed for message in self.station.all("VFR_HUD")]
        self.assertLess(max(speeds), 4.2)
        stood = [m for m in self.station.all("VFR_HUD") if m.groundspeed < 0.3 and m.alt > 514]
        self.assertGreater(len(stood), 4 * 7)

    def test_turns_and_loiter_time(self):
        circle = at(60, 0, 20, Command.NAV_LOITER_TURNS, params=(2.0, 0, 20.0, 0))
        wait = at(60, 0, 20, Command.NAV_LOITER_TIME, params=(8.0, 0, 0, 0))
        self.fly("", [takeoff(20), circle, wait, at(0, 0, 0, Command.NAV_LAND)])
        self.begin()
        self.until_disarmed(300)
        self.assertEqual(self.reached(), [0, 1, 2, 3])
        centre, angle, before = place(60, 0, 20), 0.0, None
        for _, position in self.track:
            north, east, up = geodesy.vector(centre, position)
            if abs(math.hypot(north, east) - 20) < 2.0 and abs(up) < 2:
                bearing = math.atan2(east, north)
                angle += geodesy.wrap(bearing - before) if before is not None else 0.0
                before = bearing
        self.assertAlmostEqual(angle / (2 * math.pi), 2.0, delta=0.35)

    def test_takeover_and_hand_back(self):
        """GUIDED leaves the mission, AUTO goes on with the item that was flown."""
        mission = [HOME_ITEM, takeoff(20), at(100, 0, 20), at(100, 100, 20)]
        self.fly("--autopilot ardupilot", mission)
        self.begin()
        self.station.run(60, lambda: self.pilot.body.position.lat > place(40, 0).lat)
        self.station.set_mode(GUIDED)
        self.send_position(place(50, 40, 25))
        self.assertTrue(self.station.run(60, lambda: self.nearest(place(50, 40, 25)) < 1.0))
        self.assertEqual(self.station.set_mode(AUTO), 0)
        self.assertTrue(self.station.run(60, lambda: 3 in self.reached()))
        self.assertEqual(self.reached(), [1, 2, 3])
        self.assertEqual(self.pilot.mode, AUTO)

    def test_set_current(self):
        self.fly("", [takeoff(20), at(200, 0, 20), at(0, 50, 20)])
        self.begin()
        self.station.run(20)
        self.station.send("MISSION_SET_CURRENT", target_system=1, target_component=1, seq=2)
        self.station.run(0.1)
        self.assertEqual(self.station.last("MISSION_CURRENT").seq, 2)
        self.assertTrue(self.station.run(60, lambda: 2 in self.reached()))
        self.station.send("MISSION_SET_CURRENT", target_system=1, target_component=1, seq=9)
        self.station.run(0.1)
        self.assertIn("Mission has no item 9", self.station.texts())


class SetPoints(Flight):
    def test_velocity_and_its_loss(self):
        """ArduCopter hovers 3 s after the last one, still in GUIDED."""
        self.hover()
        for _ in range(8):
            self.send_velocity(5.0, 0.0)
            self.station.run(1.0)
        self.assertAlmostEqual(self.pilot.body.velocity[0], 5.0, delta=0.1)
        self.station.run(1.8)
        self.assertAlmostEqual(self.pilot.body.velocity[0], 5.0, delta=0.1)
        self.station.run(5.0)
        self.assertLess(self.speed(), 0.1)
        self.assertEqual(self.pilot.mode, GUIDED)

    def test_position_does_not_time_out(self):
        self.hover()
        target = place(120, 50, 30)
        self.send_position(target)
        self.station.run(40)
        self.assertLess(geodesy.distance(self.pilot.body.position, target), 0.5)

    def test_offboard_needs_its_stream(self):
        """PX4 refuses OFFBOARD without set-points, and leaves it 1 s after the last one."""
        self.hover("--autopilot px4 --parameter COM_OBL_RC_ACT=5")
        self.assertEqual(self.station.set_mode(GUIDED), Result.FAILED)
        for i in range(30):
            self.send_velocity(0.0, 4.0)
            if i == 5:
                self.assertEqual(self.station.set_mode(GUIDED), 0)
            self.station.run(0.1)
        self.assertEqual(self.pilot.mode, GUIDED)
        self.assertAlmostEqual(self.pilot.body.velocity[1], 4.0, delta=0.2)
        self.station.run(1.1)
        self.assertEqual(self.pilot.mode, HOLD)
        self.station.run(5.0)
        self.assertLess(self.speed(), 0.1)

    def test_offboard_ends_in_a_mode_that_needs_a_radio(self):
        """By default, as PX4's own simulation does: a copter sinks."""
        self.hover("--autopilot px4", 40.0)
        for _ in range(10):
            self.send_velocity(0.0, 4.0)
            self.station.run(0.1)
        self.assertEqual(self.station.set_mode(GUIDED), 0)
        self.station.run(1.2)
        self.assertEqual(self.pilot.mode, POSITION)
        height = self.height()
        self.station.run(10.0)
        self.assertAlmostEqual(height - self.height(), 9.0, delta=1.5)

    def test_target_is_reported(self):
        self.hover()
        self.assertEqual(self.station.last("POSITION_TARGET_GLOBAL_INT").type_mask, 0xFF8)
        target = place(120, 50, 30)
        self.send_position(target)
        self.station.run(0.6)
        reported = self.station.last("POSITION_TARGET_GLOBAL_INT")
        self.assertEqual((reported.lat_int, reported.alt), (round(target.lat * 1e7), target.alt))
        self.send_velocity(1.0, 2.0, -0.5)
        self.station.run(0.6)
        reported = self.station.last("POSITION_TARGET_GLOBAL_INT")
        self.assertEqual(reported.type_mask, 0xFC7)
        self.assertEqual((reported.vx, reported.vy, reported.vz), (1.0, 2.0, -0.5))

    def test_set_points_outside_guided_do_nothing(self):
        self.hover()
        self.station.set_mode(HOLD)
        self.send_velocity(5.0, 0.0)
        self.station.run(2.0)
        self.assertLess(self.speed(), 0.1)

    def test_local_and_body_frames(self):
        self.hover()
        self.pilot.body.yaw = math.pi / 2
        for frame, velocity in ((Frame.LOCAL_NED, (3.0, 0.0)), (Frame.BODY_NED, (0.0, 3.0))):
            self.station.send("SET_POSITION_TARGET_LOCAL_NED", target_system=1,
                              target_component=1, coordinate_frame=int(frame), yaw=math.pi / 2,
                              type_mask=VELOCITY_ONLY & ~0x400, vx=3.0)
            self.station.run(2.9)
            for axis in (0, 1):
                self.assertAlmostEqual(self.pilot.body.velocity[axis], velocity[axis], delta=0.1)
        self.station.send("SET_POSITION_TARGET_LOCAL_NED", target_system=1, target_component=1,
                          coordinate_frame=int(Frame.LOCAL_NED), type_mask=POSITION_ONLY,
                          x=10.0, y=-20.0, z=-15.0)
        self.station.run(30)
        self.assertLess(geodesy.distance(self.pilot.body.position, place(10, -20, 15)), 0.5)

    def test_reposition_of_each_autopilot(self):
        for flavour, mode in (("ardupilot", GUIDED), ("px4", HOLD)):
            self.hover(f"--autopilot {flavour}")
            target = place(60, 0)
            where = {"x": round(target.lat * 1e7), "y": round(target.lon * 1e7), "z": 25.0,
                     "frame": int(Frame.GLOBAL_RELATIVE_ALT)}
            result = self.station.command(Command.DO_REPOSITION, -1, 1, 0, math.nan, **where)
            self.assertEqual(result, 0)
            self.station.run(30)
            self.assertEqual(self.pilot.mode, mode)
            self.assertLess(geodesy.distance(self.pilot.body.position, place(60, 0, 25)), 0.5)


class Plane(Flight):
    CORNERS = [(600, 0, 80), (900, 600, 100), (200, 900, 120)]

    def mission(self, *rest):
        return [HOME_ITEM, takeoff(60)] + [at(*corner) for corner in self.CORNERS] + list(rest)

    def airborne(self, arguments="--autopilot ardupilot"):
        self.fly(f"{arguments} --type plane", self.mission())
        self.begin()
        self.assertTrue(self.station.run(120, lambda: 2 in self.reached()))
        return self.station

    def circling(self, centre, radius):
        """Distances to the circle over the next minute."""
        self.track.clear()
        self.station.run(60)
        return max(abs(geodesy.horizontal(position, centre) - radius)
                   for _, position in self.track)

    def test_mission(self):
        self.fly("--autopilot ardupilot --type plane --wind 300,5", self.mission())
        self.begin()
        self.assertTrue(self.station.run(300, lambda: self.pilot.mode == RTL))
        self.assertEqual(self.reached(), [1, 2, 3, 4])
        for north, east, height in self.CORNERS:
            nearest = min(geodesy.horizontal(p, place(north, east)) for _, p in self.track)
            self.assertLess(nearest, 60.0)
            self.assertLess(self.nearest(place(north, east, height)), 62.0)
        flown = [m for m in self.station.all("ATTITUDE")]
        self.assertLess(max(abs(m.roll) for m in flown), math.radians(45.1))
        self.assertLess(max(abs(m.rollspeed) for m in flown), math.radians(60.1))
        speeds = [m.airspeed for m in self.station.all("VFR_HUD")][-200:]
        self.assertTrue(all(abs(speed - 22) < 0.5 for speed in speeds))
        self.station.run(90)
        self.assertLess(self.circling(ORIGIN, 80), 12)

    def test_landing(self):
        land = at(0, 0, 0, Command.NAV_LAND)
        self.fly("--autopilot ardupilot --type plane", self.mission(at(-500, 0, 40), land))
        self.begin()
        self.until_disarmed(400)
        self.assertLess(geodesy.horizontal(self.pilot.body.position, ORIGIN), 150)
        self.assertEqual(self.pilot.body.position.alt, HOME[2])

    def test_circles_and_altitude(self):
        circle = at(600, 0, 80, Command.NAV_LOITER_TURNS, params=(1.0, 0, -100.0, 0))
        climb = at(600, 0, 150, Command.NAV_LOITER_TO_ALT, params=(0.0, 120.0, 0, 0))
        wait = at(600, 0, 150, Command.NAV_LOITER_UNLIM, params=(0.0, 0, 120.0, 0))
        self.fly("--type plane", [takeoff(60), circle, climb, wait])
        self.begin()
        self.assertTrue(self.station.run(300, lambda: self.reached() == [0, 1]))
        self.assertLess(self.pilot.body.roll, -0.1, "a negative radius is flown to the left")
        self.assertTrue(self.station.run(300, lambda: self.reached() == [0, 1, 2]))
        self.assertAlmostEqual(self.height(), 150, delta=4)
        self.station.run(40)
        self.assertLess(self.circling(place(600, 0), 120), 12)

    def test_guided_circles_its_target(self):
        """DO_REPOSITION, then an item with current = 2; nothing repeats them and it keeps on."""
        self.airborne()
        target = place(1500, 300)
        where = {"x": round(target.lat * 1e7), "y": round(target.lon * 1e7), "z": 90.0,
                 "frame": int(Frame.GLOBAL_RELATIVE_ALT)}
        self.assertEqual(self.station.command(Command.DO_REPOSITION, -1, 0, -100, 0, **where),
                         Result.FAILED)
        self.assertEqual(self.station.command(Command.DO_REPOSITION, -1, 1, -100, 0, **where), 0)
        self.assertEqual(self.pilot.mode, GUIDED)
        self.station.run(100)
        self.assertLess(self.circling(target, 100), 10)
        near = at(300, 300, 70)
        self.station.send("MISSION_ITEM_INT", target_system=1, target_component=1,
                          **{**near, "current": 2})
        self.assertEqual(self.station.wait(("MISSION_ACK",), 1).type, 0)
        self.station.run(100)
        self.assertLess(self.circling(place(300, 300), 80), 10)
        self.assertAlmostEqual(self.height(), 70, delta=2)

    def test_hold_circles_where_it_was(self):
        self.airborne()
        where = self.pilot.body.position
        self.assertEqual(self.station.set_mode(HOLD), 0)
        self.station.run(60)
        self.assertLess(self.circling(where, 80), 10)


class Arming(Flight):
    def test_checks(self):
        self.fly("--autopilot ardupilot --ready-after 5")
        self.station.set_mode(GUIDED)
        self.station.received.clear()
        self.assertEqual(self.station.arm(), Result.FAILED)
        self.station.run(0.1)
        self.assertIn("Arm: Need Position Estimate", self.station.texts())
        names = [m.name for m in self.station.received]
        self.assertLess(names.index("COMMAND_ACK"), names.index("STATUSTEXT"))
        self.station.run(5)
        self.assertEqual(self.station.arm(), 0)
        self.station.run(1.1)
        self.assertTrue(self.station.last("HEARTBEAT").base_mode & 128)

    def test_arducopter_does_not_arm_in_auto(self):
        self.fly("--autopilot ardupilot", [HOME_ITEM, takeoff(10)])
        self.assertEqual(self.station.set_mode(AUTO), 0)
        self.assertEqual(self.station.arm(), Result.FAILED)

    def test_numbers_of_modes_want_their_flag(self):
        """base_mode without MAV_MODE_FLAG_CUSTOM_MODE_ENABLED does not say that there is one."""
        self.fly("--autopilot ardupilot")
        self.assertEqual(self.station.command(Command.DO_SET_MODE, 0, 4), Result.DENIED)
        self.assertEqual(self.station.command(Command.DO_SET_MODE, 1, 4), 0)
        self.assertEqual(self.pilot.mode, GUIDED)

    def test_disarming_in_flight(self):
        self.hover()
        self.assertEqual(self.station.command(Command.COMPONENT_ARM_DISARM, 0), Result.FAILED)
        self.assertEqual(self.station.command(Command.COMPONENT_ARM_DISARM, 0, 21196), 0)
        self.station.run(10)
        self.assertEqual(self.height(), 0.0)

    def test_auto_wants_a_mission(self):
        for flavour in ("ardupilot", "px4", "generic"):
            self.fly(f"--autopilot {flavour}")
            self.assertEqual(self.station.set_mode(AUTO), Result.FAILED)

    def test_mission_is_not_cleared_while_arducopter_flies_it(self):
        self.fly("--autopilot ardupilot", [HOME_ITEM, takeoff(10), at(90, 0, 10)])
        self.begin()
        self.station.send("MISSION_CLEAR_ALL", target_system=1, target_component=1)
        self.assertEqual(self.station.wait(("MISSION_ACK",), 1).type, 1)


class Uploads(Flight):
    MISSION = [HOME_ITEM, takeoff(10), at(60, 0, 10), at(60, 60, 10), at(0, 60, 10)]

    def test_the_item_stays_whatever_is_uploaded(self):
        """Until the mission is begun again, or the vehicle disarms; to PX4 until an item is marked
        as the current one."""
        marked = [{**self.MISSION[0], "current": 1}, *self.MISSION[1:]]
        for flavour, items, item in (("ardupilot", marked, 3), ("px4", self.MISSION, 3), ("px4", marked, 0)):
            self.fly(f"--autopilot {flavour}", self.MISSION)
            self.begin()
            self.assertTrue(self.station.run(60, lambda: self.pilot.auto.current() == 3))
            self.assertEqual(self.station.set_mode(HOLD), 0)
            self.assertEqual(self.station.upload(items), 0)
            self.assertEqual(self.pilot.current_item(), item)
        self.assertEqual(self.station.command(Command.MISSION_START, 1, 0), 0)
        self.fly("--autopilot ardupilot", self.MISSION)
        self.assertEqual(self.station.command(Command.MISSION_START, 1, 0), Result.DENIED)


class Reboot(Flight):
    def test_in_flight(self):
        """Comes back in hold, in the air, with its mission."""
        rules = [{"fault": "reboot", "from": 20.0, "seconds": 3.0}]
        self.fly("", [takeoff(20), at(500, 0, 20)], rules)
        self.begin()
        self.station.run(24)
        self.assertEqual(self.pilot.mode, HOLD)
        self.station.run(10)
        self.assertLess(self.speed(), 0.1)
        self.assertGreater(self.height(), 15)
        self.assertEqual(len(self.station.download()), 2)
        self.assertLess(self.station.last("ATTITUDE").time_boot_ms, 20000)


if __name__ == "__main__":
    unittest.main()
