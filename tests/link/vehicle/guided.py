# SPDX-License-Identifier: Apache-2.0
"""GUIDED, PX4's OFFBOARD: set-points from outside, and what happens when they stop. Copter goes on
to a position and hovers GUID_TIMEOUT after the last velocity; PX4 leaves OFFBOARD for the mode of
COM_OBL_RC_ACT when no set-point of any kind came for COM_OF_LOSS_T; a plane circles its last
target."""
import math

import geodesy
from airframe import Goal
from constants import ABSOLUTE, RELATIVE, Frame, Severity

NO_POSITION, NO_VELOCITY, NO_YAW, NO_YAW_RATE = 0x007, 0x038, 0x400, 0x800
NO_ALTITUDE = 0x004
FARTHEST = 1e6  # m, of a set-point from its origin


class Guided:
    def __init__(self, pilot):
        self.pilot = pilot
        self.wanted = None  # Goal
        self.stamp = -math.inf  # of the last set-point, flight time
        self.entered_at = -math.inf
        self.offboard = None  # the goal that the stream asks for, before and in OFFBOARD

    def enter(self):
        self.entered_at = self.pilot.time
        self.wanted = self.offboard if self.pilot.flavour.stream_needed else None
        self.wanted = self.wanted or self.pilot.body.stop_here()

    def goal(self):
        body, wanted = self.pilot.body, self.wanted
        if wanted.kind == "takeoff" and not body.on_ground and body.arrived(wanted):
            self.wanted = Goal("loiter", body.position.at(wanted.target.alt))
        elif wanted.kind != "takeoff" and body.on_ground and not self.lifts():
            return Goal("idle")
        return self.wanted

    def lifts(self):
        """Only PX4 takes off by a set-point."""
        return self.pilot.flavour.name == "px4" and self.offboard is not None

    def take_off(self, target):
        self.wanted = Goal("takeoff", target)

    def stream_is_fresh(self):
        return self.silence() <= self.pilot.parameters["COM_OF_LOSS_T"]

    def watch(self):
        """Every step: set-points that stopped."""
        pilot = self.pilot
        if pilot.mode != "GUIDED":
            return
        if pilot.flavour.stream_needed:
            if not self.stream_is_fresh():
                pilot.lose_set_points()
        elif self.wanted.kind == "velocity" and self.silence() > pilot.parameters["GUID_TIMEOUT"]:
            pilot.text(Severity.WARNING, "Guided: set-points stopped")
            self.wanted = pilot.body.stop_here()
            pilot.node.log("hover", reason="set-points stopped")

    def silence(self):
        return self.pilot.time - self.stamp

    # Targets of single messages: DO_REPOSITION, items with current = 2.

    def go_to(self, target, radius=0.0, yaw=None):
        body, pilot = self.pilot.body, self.pilot
        if pilot.kind == "plane":
            self.wanted = Goal("loiter", target,
                               radius=radius or pilot.parameters["WP_LOITER_RAD"])
        else:
            self.wanted = Goal("leg", target, body.position, yaw=yaw)
        self.note("position", target)

    def change_altitude(self, alt):
        self.wanted = self.wanted or self.pilot.body.stop_here()
        self.wanted.target = self.wanted.target.at(alt)
        self.note("altitude", self.wanted.target)

    def note(self, kind, target=None, velocity=None):
        fields = {"kind": kind}
        if target is not None:
            fields.update(lat=target.lat, lon=target.lon, alt=target.alt)
        if velocity is not None:
            fields["velocity"] = list(velocity)
        self.pilot.node.log("setpoint", **fields)

    # SET_POSITION_TARGET_GLOBAL_INT and _LOCAL_NED.

    def set_global(self, message):
        target = self.global_target(message)
        if target is not None:
            velocity = (message.vx, message.vy, -message.vz)
            self.set_target(message, target, velocity)

    def global_target(self, message):
        frame, alt = message.coordinate_frame, message.alt
        lat, lon = message.lat_int / 1e7, message.lon_int / 1e7
        if abs(lat) > 90 or abs(lon) > 180:
            lat = lon = alt = math.nan  # ignored where the mask says so, else refused
        if frame in RELATIVE:
            alt += self.pilot.home.alt
        elif frame not in ABSOLUTE:
            if frame not in (Frame.GLOBAL_TERRAIN_ALT, Frame.GLOBAL_TERRAIN_ALT_INT):
                return None
            alt += self.pilot.terrain_height(lat, lon)
        return geodesy.Position(lat, lon, alt)

    def set_local(self, message):
        """North, east, down from home; the offset frames from here, the body frames turned."""
        frame = message.coordinate_frame
        place, velocity = (message.x, message.y), (message.vx, message.vy)
        if not all(abs(value) < FARTHEST for value in (*place, message.z)):
            place = math.nan, math.nan
        if frame in (Frame.BODY_NED, Frame.BODY_OFFSET_NED):
            place, velocity = self.turned(place), self.turned(velocity)
        if frame == Frame.LOCAL_NED:
            origin = self.pilot.home
        elif frame in (Frame.LOCAL_OFFSET_NED, Frame.BODY_NED, Frame.BODY_OFFSET_NED):
            origin = self.pilot.body.position
        else:
            return
        target = geodesy.Position(math.nan, math.nan, math.nan)
        if math.isfinite(place[0]):
            target = geodesy.offset(origin, *place, -message.z)
        self.set_target(message, target, (*velocity, -message.vz))

    def turned(self, ahead_right):
        cosine, sine = math.cos(self.pilot.body.yaw), math.sin(self.pilot.body.yaw)
        ahead, right = ahead_right
        return ahead * cosine - right * sine, ahead * sine + right * cosine

    def set_target(self, message, target, velocity):
        pilot, mask = self.pilot, message.type_mask
        if pilot.kind == "plane" and pilot.flavour.name == "ardupilot":
            # Plane takes the altitude of this message and nothing else.
            if pilot.mode == "GUIDED" and not mask & NO_ALTITUDE and math.isfinite(target.alt):
                self.change_altitude(target.alt)
            return
        goal = self.goal_of(mask, target, velocity)
        if goal is None:
            self.stop_at_nonsense()
            return
        goal.yaw = self.given(message.yaw, mask & NO_YAW)
        goal.yaw_rate = self.given(message.yaw_rate, mask & NO_YAW_RATE)
        if pilot.flavour.stream_needed:
            self.offboard = goal
        if pilot.flavour.stream_needed or pilot.mode == "GUIDED":
            self.stamp = pilot.time
        if pilot.mode == "GUIDED":
            self.accept(goal, target, velocity)

    def stop_at_nonsense(self):
        """ArduCopter holds its position where it can make nothing of a set-point."""
        pilot = self.pilot
        if pilot.flavour.name == "ardupilot" and pilot.mode == "GUIDED" and \
                not pilot.body.on_ground:
            self.wanted = pilot.body.stop_here()
            pilot.node.log("hover", reason="set-point refused")

    @staticmethod
    def given(value, ignored):
        return value if not ignored and math.isfinite(value) else None

    def goal_of(self, mask, target, velocity):
        """A position where there is one, else a velocity; with both the position counts."""
        pilot = self.pilot
        if mask & NO_POSITION == 0:
            if not all(math.isfinite(value) for value in (target.lat, target.lon, target.alt)):
                return None
            if pilot.kind == "plane":
                return Goal("loiter", target, radius=pilot.parameters["WP_LOITER_RAD"])
            return Goal("leg", target, pilot.body.position)
        if mask & NO_VELOCITY == 0 and pilot.kind == "copter":
            if all(math.isfinite(component) for component in velocity):
                return Goal("velocity", velocity=tuple(velocity))
        return None

    def accept(self, goal, target, velocity):
        if self.wanted.kind == "takeoff" and self.pilot.body.on_ground:
            return
        if self.same_leg(goal):
            return
        self.wanted = goal
        if goal.kind == "velocity":
            self.note("velocity", velocity=velocity)
        else:
            self.note("position", target)

    def same_leg(self, goal):
        """A position that is repeated does not begin a new leg."""
        before = self.wanted
        return (goal.kind == "leg" and before.kind == "leg" and before.target == goal.target
                and before.yaw == goal.yaw)
