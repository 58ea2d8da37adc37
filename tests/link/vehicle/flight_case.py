# SPDX-License-Identifier: Apache-2.0
"""What tests of flights share: places about home, a vehicle that is started or hovers, and its
track."""
import math
import unittest

import geodesy
from constants import Command, Frame
from flavours import AUTO, GUIDED, HOLD
from station import HOME, Station, item, make_node

ORIGIN = geodesy.Position(*HOME)
VELOCITY_ONLY = 0xDC7
POSITION_ONLY = 0xDF8


def place(north, east, up=0.0):
    return geodesy.offset(ORIGIN, north, east, up)


def at(north, east, height, command=Command.NAV_WAYPOINT, **more):
    there = place(north, east)
    return item(command, there.lat, there.lon, height, **more)


def takeoff(height):
    return item(Command.NAV_TAKEOFF, 0.0, 0.0, height)


HOME_ITEM = at(0, 0, 0)


class Flight(unittest.TestCase):
    """Tracks hold (time, Position) of every step."""

    def fly(self, arguments, items=(), rules=()):
        self.station = station = Station(make_node(arguments, rules))
        self.node, self.pilot = station.node, station.node.pilot
        self.track = []
        station.every_step = lambda: self.track.append((self.pilot.time, self.pilot.body.position))
        if self.pilot.flavour.name == "ardupilot":  # which streams little by itself
            station.send("REQUEST_DATA_STREAM", target_system=1, target_component=1,
                         req_stream_id=0, req_message_rate=5, start_stop=1)
        if items:
            self.assertEqual(station.upload(list(items)), 0)
        return station

    def begin(self):
        """Arms and starts the mission in the way of the autopilot."""
        station, flavour = self.station, self.pilot.flavour.name
        if flavour == "ardupilot" and self.pilot.kind == "copter":
            self.assertEqual(station.set_mode(GUIDED), 0)
            self.assertEqual(station.arm(), 0)
            self.assertEqual(station.set_mode(AUTO), 0)
            self.assertEqual(station.command(Command.MISSION_START), 0)
        else:
            self.assertEqual(station.set_mode(AUTO), 0)
            self.assertEqual(station.arm(), 0)

    def hover(self, arguments="--autopilot ardupilot", height=20.0):
        self.fly(arguments)
        station = self.station
        if self.pilot.flavour.name == "px4":
            station.arm()
            station.command(Command.NAV_TAKEOFF, 0, 0, 0, math.nan, math.nan, math.nan,
                            HOME[2] + height)
            self.assertTrue(station.run(60, lambda: self.pilot.mode == HOLD))
        else:
            self.assertEqual(station.set_mode(GUIDED), 0)
            self.assertEqual(station.arm(), 0)
            self.assertEqual(station.command(Command.NAV_TAKEOFF, 0, 0, 0, 0, 0, 0, height), 0)
            self.assertTrue(station.run(60, lambda: self.height() > height - 0.6))
        station.run(5)
        return station

    def height(self):
        return self.pilot.body.position.alt - HOME[2]

    def speed(self):
        return math.hypot(*self.pilot.body.velocity)

    def nearest(self, target):
        return min(geodesy.distance(position, target) for _, position in self.track)

    def reached(self):
        return [message.seq for message in self.station.all("MISSION_ITEM_REACHED")]

    def until_disarmed(self, seconds):
        self.assertTrue(self.station.run(seconds, lambda: not self.pilot.armed), "did not end")

    def send_velocity(self, north, east, down=0.0):
        self.station.send("SET_POSITION_TARGET_LOCAL_NED", target_system=1, target_component=1,
                          coordinate_frame=int(Frame.LOCAL_NED), type_mask=VELOCITY_ONLY,
                          vx=north, vy=east, vz=down)

    def send_position(self, target):
        self.station.send("SET_POSITION_TARGET_GLOBAL_INT", target_system=1, target_component=1,
                          coordinate_frame=int(Frame.GLOBAL_INT), type_mask=POSITION_ONLY,
                          lat_int=round(target.lat * 1e7), lon_int=round(target.lon * 1e7),
                          alt=target.alt)
