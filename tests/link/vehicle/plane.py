# SPDX-License-Identifier: Apache-2.0
"""A fixed wing: airspeed, a bank angle that the roll rate limits, coordinated turns, and wind that
carries it. Legs and circles are followed by the law of Park, Deyst and How, "A New Nonlinear
Guidance Logic for Trajectory Tracking", AIAA 2004-4900 (L1), as autopilots use it: L1 grows with
ground speed."""
import math

import geodesy
from airframe import GRAVITY, Airframe, Goal, limited, toward

ROLL_RATE = math.radians(60)
SPEED_CHANGE = 1.5  # m/s2
GROUND_RUN = 4.0  # m/s2
CLIMB_CHANGE = 2.0  # m/s2
TOUCHDOWN = 2.0  # m, how far below its point a landing aims


class Plane(Airframe):
    def cruise_speed(self):
        wanted = self.speed or self.parameters["AIRSPEED_CRUISE"]
        return limited(wanted, self.parameters["AIRSPEED_MIN"], self.parameters["AIRSPEED_MAX"])

    def acceptance(self, goal):
        return goal.acceptance or self.parameters["WP_RADIUS"]

    def step(self, dt, goal, ground):
        before = (self.roll, self.pitch, self.yaw)
        if self.on_ground:
            self.roll_on_ground(dt, goal)
        else:
            self.fly(dt, goal)
        self.move(dt, ground)
        if not self.on_ground and self.position.alt <= ground:
            self.on_ground, self.roll = True, 0.0
        self.note_rates(dt, before)

    def roll_on_ground(self, dt, goal):
        """Faster along the runway to take off, slower after landing."""
        wanted = self.cruise_speed() if goal.kind in ("takeoff", "leg", "loiter") else 0.0
        self.airspeed = toward(self.airspeed, wanted, GROUND_RUN * dt)
        self.pitch = 0.0
        speed, yaw = self.airspeed, self.yaw
        self.velocity = [speed * math.cos(yaw), speed * math.sin(yaw), 0.0]
        if wanted and self.airspeed >= self.parameters["AIRSPEED_MIN"]:
            self.on_ground = False
            self.velocity[2] = 0.5

    def fly(self, dt, goal):
        lateral = self.lateral_acceleration(goal)
        limit = math.radians(self.parameters["ROLL_LIMIT_DEG"])
        bank = limited(math.atan2(lateral, GRAVITY), -limit, limit)
        self.roll = toward(self.roll, bank, ROLL_RATE * dt)
        self.yaw = geodesy.wrap(self.yaw + GRAVITY * math.tan(self.roll) / self.airspeed * dt)
        self.airspeed = toward(self.airspeed, self.cruise_speed(), SPEED_CHANGE * dt)
        self.velocity[2] = toward(self.velocity[2], self.climb(goal), CLIMB_CHANGE * dt)
        self.pitch = math.asin(limited(self.velocity[2] / self.airspeed, -0.7, 0.7))
        level = self.airspeed * math.cos(self.pitch)
        self.velocity[0] = level * math.cos(self.yaw) + self.wind[0]
        self.velocity[1] = level * math.sin(self.yaw) + self.wind[1]

    def climb(self, goal):
        up, down = self.parameters["TECS_CLMB_MAX"], self.parameters["TECS_SINK_MAX"]
        if goal.kind == "idle":
            return -down
        return limited(0.5 * (self.altitude(goal) - self.position.alt), -down, up)

    def altitude(self, goal):
        """Legs are flown as slopes, as far as climb and sink rate allow."""
        if goal.kind in ("leg", "land") and goal.start is not None:
            leg = geodesy.vector(goal.start, goal.target)
            length = math.hypot(leg[0], leg[1])
            if length > 1.0:
                along, _ = self.track(goal)
                # Flown at the ground itself, the last metre would take for ever.
                below = TOUCHDOWN if goal.kind == "land" else 0.0
                return goal.start.alt - below + leg[2] * limited(along / length, 0.0, 1.0)
        return goal.target.alt

    def track(self, goal):
        """Metres along the leg and beside it, positive on the left."""
        leg = geodesy.vector(goal.start, goal.target)
        here = geodesy.vector(goal.start, self.position)
        length = math.hypot(leg[0], leg[1])
        return ((here[0] * leg[0] + here[1] * leg[1]) / length,
                (here[0] * leg[1] - here[1] * leg[0]) / length)

    def lateral_acceleration(self, goal):
        if goal.kind in ("idle", "velocity") or (goal.kind == "takeoff" and goal.start is None):
            return 0.0
        if goal.kind == "loiter":
            return self.circle(goal)
        if goal.start is None or geodesy.horizontal(goal.start, goal.target) < 1.0:
            return self.toward_point(goal.target)
        return self.follow(goal)

    def look_ahead(self):
        period, damping = self.parameters["NAVL1_PERIOD"], self.parameters["NAVL1_DAMPING"]
        return max(1.0, damping * period * self.ground_speed() / math.pi)

    def steer(self, angle):
        """Acceleration of the law for the angle from the ground track to the L1 point."""
        gain = 4 * self.parameters["NAVL1_DAMPING"] ** 2
        angle = limited(angle, -math.pi / 2, math.pi / 2)
        return gain * self.ground_speed() ** 2 / self.look_ahead() * math.sin(angle)

    def course(self):
        return math.atan2(self.velocity[1], self.velocity[0])

    def toward_point(self, target):
        north, east, _ = geodesy.vector(self.position, target)
        return self.steer(geodesy.wrap(math.atan2(east, north) - self.course()))

    def follow(self, goal):
        leg = geodesy.vector(goal.start, goal.target)
        length = math.hypot(leg[0], leg[1])
        along, beside = self.track(goal)
        self.crosstrack = abs(beside)
        if along > length + 3 * self.ground_speed():
            return self.toward_point(goal.target)
        intercept = math.asin(limited(beside / self.look_ahead(), -0.7071, 0.7071))
        return self.steer(intercept + geodesy.wrap(math.atan2(leg[1], leg[0]) - self.course()))

    def circle(self, goal):
        """Far away the centre attracts; on the circle centripetal acceleration and damping."""
        radius = abs(goal.radius) or self.parameters["WP_LOITER_RAD"]
        side = -1 if goal.radius < 0 else 1
        north, east, _ = geodesy.vector(goal.target, self.position)
        distance = max(1.0, math.hypot(north, east))
        outward = (north * self.velocity[0] + east * self.velocity[1]) / distance
        tangential = side * (north * self.velocity[1] - east * self.velocity[0]) / distance
        omega = 2 * math.pi / self.parameters["NAVL1_PERIOD"]
        damping = self.parameters["NAVL1_DAMPING"]
        beside = distance - radius
        self.crosstrack = abs(beside)
        correction = beside * omega ** 2 + outward * 2 * damping * omega
        if tangential < 0 and beside < 0:
            correction = max(correction, 0.0)
        on_circle = side * (correction + tangential ** 2 / max(0.5 * radius, distance))
        capture = self.toward_point(goal.target)
        if beside > 0 and side * capture < side * on_circle:
            return capture
        return on_circle

    def arrived(self, goal):
        if goal.kind == "takeoff":
            return not self.on_ground and self.position.alt > goal.target.alt - 1.0
        if goal.kind == "land":
            return self.on_ground and self.airspeed < 0.1
        if goal.kind == "loiter":
            radius = abs(goal.radius) or self.parameters["WP_LOITER_RAD"]
            return abs(geodesy.horizontal(self.position, goal.target) - radius) < 0.3 * radius
        if geodesy.horizontal(self.position, goal.target) < self.turn_distance(goal):
            return True
        return self.finish_line(goal)

    def turn_distance(self, goal):
        """Turns begin early by at most the acceptance radius, and less where the angle is small."""
        if goal.following is None:
            return self.acceptance(goal)
        leg = geodesy.vector(goal.start or self.position, goal.target)
        onward = geodesy.vector(goal.target, goal.following)
        angle = abs(geodesy.wrap(math.atan2(onward[1], onward[0]) - math.atan2(leg[1], leg[0])))
        share = min(1.0, angle / (math.pi / 2))
        return max(5.0, min(self.acceptance(goal), self.look_ahead() * share))

    def finish_line(self, goal):
        if goal.start is None or geodesy.horizontal(goal.start, goal.target) < 1.0:
            return False
        along, _ = self.track(goal)
        return along >= geodesy.horizontal(goal.start, goal.target)

    def stop_here(self):
        """A plane that holds circles where it is."""
        return Goal("loiter", self.position, radius=self.parameters["WP_LOITER_RAD"])
