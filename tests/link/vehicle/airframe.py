# SPDX-License-Identifier: Apache-2.0
"""What copters and planes share: the state of the body, and the goals that modes give to it."""
import math
from dataclasses import dataclass

import geodesy

GRAVITY = 9.80665


@dataclass
class Goal:
    """What is to be flown now. Kinds: idle (motors off), takeoff, leg, loiter, velocity, land."""
    kind: str
    target: geodesy.Position = None
    start: geodesy.Position = None  # of the leg
    following: geodesy.Position = None  # where the leg after this one ends; None: stop at `target`
    radius: float = 0.0  # of the loiter, clockwise if positive; copters stop where it is 0
    velocity: tuple = (0.0, 0.0, 0.0)  # north, east, up, m/s
    yaw: float = None  # rad; None: as the airframe likes
    yaw_rate: float = None  # rad/s
    acceptance: float = None  # m; None: of the parameters


class Airframe:
    """A point mass with attitude. Velocities are over ground: north, east, up."""

    def __init__(self, home, heading, wind, parameters):
        self.position = home
        self.velocity = [0.0, 0.0, 0.0]
        self.roll = self.pitch = 0.0
        self.yaw = heading
        self.rates = (0.0, 0.0, 0.0)
        self.airspeed = 0.0
        self.wind = wind  # where it blows to: north, east, m/s
        self.parameters = parameters
        self.speed = None  # demanded by a command or DO_CHANGE_SPEED, m/s
        self.on_ground = True
        self.crosstrack = 0.0

    def ground_speed(self):
        return math.hypot(self.velocity[0], self.velocity[1])

    def move(self, dt, ground):
        """Integrates the position; the ground stops what sinks into it."""
        north, east, up = (component * dt for component in self.velocity)
        self.position = geodesy.offset(self.position, north, east, up)
        if self.position.alt <= ground:
            self.position = self.position.at(ground)
            self.velocity[2] = max(0.0, self.velocity[2])

    def note_rates(self, dt, before):
        after = (self.roll, self.pitch, self.yaw)
        self.rates = tuple(geodesy.wrap(b - a) / dt for a, b in zip(before, after))


def limited(value, low, high):
    return min(max(value, low), high)


def toward(value, target, change):
    """The target, or as near to it as the change allows."""
    return value + limited(target - value, -change, change)
