# SPDX-License-Identifier: Apache-2.0
"""A multirotor: a velocity is demanded, and the velocity over ground follows it within limits of
acceleration. Wind tilts it and does not displace it."""
import math

import geodesy
from airframe import GRAVITY, Airframe, Goal, limited, toward

ACCELERATION = 2.5  # m/s2, horizontal
VERTICAL_ACCELERATION = 2.5
YAW_RATE = math.radians(60)
LAND_SPEED = 0.5  # m/s, below LAND_SLOW above ground
LAND_SLOW = 10.0


class Copter(Airframe):
    def cruise_speed(self):
        return self.speed or self.parameters["WPNAV_SPEED"]

    def acceptance(self, goal):
        return goal.acceptance or self.parameters["WPNAV_RADIUS"]

    def step(self, dt, goal, ground):
        before = (self.roll, self.pitch, self.yaw)
        if goal.kind == "idle":
            # Without motors it lies on the ground, or falls.
            self.velocity = [0.0, 0.0, self.velocity[2] - GRAVITY * dt]
            self.roll = self.pitch = 0.0
        else:
            self.accelerate(dt, self.demand(goal, ground))
            self.turn(dt, goal)
        self.move(dt, ground)
        self.on_ground = self.position.alt <= ground and self.velocity[2] <= 0
        if self.on_ground:
            self.velocity = [0.0, 0.0, 0.0]
        self.airspeed = math.hypot(*self.air_velocity()) if not self.on_ground else 0.0
        self.note_rates(dt, before)

    def air_velocity(self):
        return self.velocity[0] - self.wind[0], self.velocity[1] - self.wind[1]

    def demand(self, goal, ground):
        """The velocity wanted: north, east, up."""
        if goal.kind == "velocity":
            return self.within_limits(goal.velocity)
        if goal.kind == "takeoff":
            return self.approach(self.position.at(goal.target.alt))
        if goal.kind == "land":
            return self.descend(goal, ground)
        if goal.kind == "loiter" and goal.radius:
            return self.circle(goal)
        if goal.kind == "leg":
            return self.follow(goal)
        return self.approach(goal.target)

    def within_limits(self, velocity):
        horizontal = math.hypot(velocity[0], velocity[1])
        scale = min(1.0, self.cruise_speed() / horizontal) if horizontal else 1.0
        up, down = self.parameters["WPNAV_SPEED_UP"], self.parameters["WPNAV_SPEED_DN"]
        if velocity[2] > up or velocity[2] < -down:
            scale = min(scale, (up if velocity[2] > 0 else down) / abs(velocity[2]))
        return tuple(component * scale for component in velocity)

    @staticmethod
    def stopping(distance, end_speed=0.0):
        """The speed from which the copter still stops, or slows to `end_speed`, at the distance."""
        braking = math.sqrt(end_speed ** 2 + 2 * ACCELERATION * 0.8 * abs(distance))
        return math.copysign(min(braking, end_speed + abs(distance)), distance)

    def approach(self, target):
        ahead = geodesy.vector(self.position, target)
        distance = math.hypot(*ahead)
        if distance < 1e-6:
            return 0.0, 0.0, 0.0
        speed = min(self.stopping(distance), self.cruise_speed())
        return self.within_limits([component / distance * speed for component in ahead])

    def follow(self, goal):
        """Along the leg, and back to it where the copter is beside it."""
        leg = geodesy.vector(goal.start, goal.target)
        length = math.hypot(*leg)
        if length < 1.0:
            return self.approach(goal.target)
        along = [component / length for component in leg]
        ahead = geodesy.vector(self.position, goal.target)
        remaining = sum(a * b for a, b in zip(ahead, along))
        beside = [a - remaining * b for a, b in zip(ahead, along)]
        self.crosstrack = math.hypot(*beside)
        speed = self.stopping(remaining, self.corner_speed(goal, along))
        speed = limited(speed, -self.cruise_speed(), self.cruise_speed())
        wanted = self.within_limits([speed * component for component in along])
        return tuple(a + limited(b, -3.0, 3.0) for a, b in zip(wanted, beside))

    def corner_speed(self, goal, along):
        """Full speed where the next leg goes straight on, none where it turns by 90 degrees."""
        if goal.following is None:
            return 0.0
        leg = geodesy.vector(goal.target, goal.following)
        length = math.hypot(*leg)
        if length < 1.0:
            return 0.0
        cosine = sum(a * b for a, b in zip(along, leg)) / length
        return self.cruise_speed() * max(0.0, cosine) ** 3

    def circle(self, goal):
        north, east, up = geodesy.vector(self.position, goal.target)
        distance = math.hypot(north, east)
        if distance < 0.1:
            return goal.radius, 0.0, up
        inward = limited(distance - abs(goal.radius), -3.0, 3.0)
        speed = min(self.cruise_speed(), math.sqrt(ACCELERATION * 0.5 * abs(goal.radius)))
        side = math.copysign(speed if abs(inward) < 2.9 else 0.0, goal.radius)
        # Clockwise, seen from above, the centre is on the right.
        return self.within_limits(((north * inward + east * side) / distance,
                                   (east * inward - north * side) / distance, up))

    def descend(self, goal, ground):
        north, east, _ = geodesy.vector(self.position, goal.target)
        height = self.position.alt - ground
        if math.hypot(north, east) > 3.0:
            return self.approach(goal.target.at(self.position.alt))
        speed = LAND_SPEED if height < LAND_SLOW else self.parameters["WPNAV_SPEED_DN"]
        return north * 0.5, east * 0.5, -max(LAND_SPEED, min(speed, height))

    def accelerate(self, dt, wanted):
        change = [wanted[0] - self.velocity[0], wanted[1] - self.velocity[1]]
        size = math.hypot(*change)
        scale = min(1.0, ACCELERATION * dt / size) if size else 0.0
        forces = [component * scale / dt for component in change]
        self.velocity[0] += forces[0] * dt
        self.velocity[1] += forces[1] * dt
        self.velocity[2] = toward(self.velocity[2], wanted[2], VERTICAL_ACCELERATION * dt)
        self.tilt(forces)

    def tilt(self, forces):
        """Attitude that makes the acceleration, drag of the air included."""
        air = self.air_velocity()
        north, east = (force + 0.1 * speed for force, speed in zip(forces, air))
        cosine, sine = math.cos(self.yaw), math.sin(self.yaw)
        self.pitch = -math.atan2(north * cosine + east * sine, GRAVITY)
        self.roll = math.atan2(east * cosine - north * sine, GRAVITY)

    def turn(self, dt, goal):
        wanted = self.yaw
        if goal.yaw_rate is not None:
            wanted = self.yaw + goal.yaw_rate * dt
        elif goal.yaw is not None:
            wanted = goal.yaw
        elif self.ground_speed() > 1.0 and goal.kind in ("leg", "velocity"):
            wanted = math.atan2(self.velocity[1], self.velocity[0])
        error = limited(geodesy.wrap(wanted - self.yaw), -YAW_RATE * dt, YAW_RATE * dt)
        self.yaw = geodesy.wrap(self.yaw + error)

    def arrived(self, goal):
        if goal.kind == "takeoff":
            return self.position.alt > goal.target.alt - 0.5
        if goal.kind == "land":
            return self.on_ground
        return geodesy.distance(self.position, goal.target) < self.acceptance(goal)

    def stop_here(self):
        """A goal to hold where the copter comes to rest."""
        lead = self.ground_speed() / (2 * ACCELERATION)
        up = self.velocity[2] ** 2 / (2 * VERTICAL_ACCELERATION)
        target = geodesy.offset(self.position, self.velocity[0] * lead, self.velocity[1] * lead,
                                math.copysign(up, self.velocity[2]))
        return Goal("loiter", target)
