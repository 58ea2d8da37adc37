# SPDX-License-Identifier: Apache-2.0
"""AUTO: the mission is flown item by item. NAV items give goals, DO items act when their turn
comes."""
import math

import geodesy
import plans
from airframe import Goal
from constants import NAVIGATION, Command, Severity

CIRCLES = (Command.NAV_LOITER_TURNS, Command.NAV_LOITER_TIME, Command.NAV_LOITER_UNLIM,
           Command.NAV_LOITER_TO_ALT)
MOST_STEPS = 1000  # of DO items without a NAV item between, against jumps in circles


class Auto:
    def __init__(self, pilot):
        self.pilot = pilot
        self.restart()

    def restart(self):
        """From the beginning, with all jumps to be done again."""
        self.index = None  # of the NAV item being flown
        self.next = self.first()
        self.jumps = {}
        self.goal = None
        self.finished = False

    def first(self):
        return 1 if self.pilot.flavour.home_is_item_0 else 0

    def items(self):
        return self.pilot.mission_items()

    def current(self):
        return self.next if self.index is None else self.index

    def set_current(self, index):
        if not 0 <= index < len(self.items()):
            return False
        self.index, self.next, self.finished = None, max(index, self.first()), False
        self.goal = None
        return True

    def resume(self):
        """The item that was being flown begins again, from where the vehicle is now."""
        if self.index is not None:
            self.next = self.index
        self.index = self.goal = None
        if self.finished:
            self.restart()

    def step(self, dt):
        """The goal now, or None when the mission is over."""
        if self.goal is None and not self.finished:
            self.advance(self.pilot.body.position)
        if self.goal is not None and self.complete(dt):
            self.pilot.reached(self.index)
            self.next, end = self.index + 1, self.end_of_leg()
            self.advance(end)
        return self.goal

    def end_of_leg(self):
        """The next leg begins where this one ended on paper, so that corners do not drift; after a
        copter's circle where it would come to rest."""
        goal, body = self.goal, self.pilot.body
        holds = self.pilot.kind == "copter" and goal.kind == "loiter"
        if goal.kind == "leg" or (holds and not goal.radius):
            return goal.target
        return body.stop_here().target if holds else body.position

    def advance(self, start):
        """Executes items up to and including the next NAV item."""
        self.goal = None
        for _ in range(MOST_STEPS):
            items = self.items()
            if self.next >= len(items):
                break
            item, index = items[self.next], self.next
            if item.command in NAVIGATION:
                self.index = index
                self.begin(item, start)
                self.pilot.current_changed()
                return
            self.next = self.execute(item, index)
        self.index, self.finished = None, True
        self.next = self.first()

    def execute(self, item, index):
        """A DO item; the index of the item after it."""
        if item.command == Command.DO_JUMP:
            return self.jump(item, index)
        if item.command == Command.DO_CHANGE_SPEED:
            self.pilot.change_speed(item.params[1])
        return index + 1

    def jump(self, item, index):
        left = self.jumps.get(index, item.params[1])
        if left == 0:
            return index + 1
        self.jumps[index] = left - 1 if left > 0 else left
        return int(item.params[0])

    def begin(self, item, start):
        self.item = item
        self.since = None  # arrived, s of flight
        self.turned, self.bearing = 0.0, None
        if item.command == Command.NAV_RETURN_TO_LAUNCH:
            self.pilot.begin_return()
            self.goal = self.pilot.go_home()
            return
        target = plans.target_of(item, self.pilot.home, self.pilot.body.position,
                                 self.pilot.terrain_height)
        self.goal = self.goal_of(item, target, start)

    def goal_of(self, item, target, start):
        if item.command == Command.NAV_TAKEOFF:
            there = item.x or item.y
            toward = self.pilot.flavour.name == "px4" and self.pilot.kind == "plane" and there
            return Goal("takeoff", target, start if toward else None)
        if item.command == Command.NAV_LAND:
            return Goal("land", target, start)
        if item.command in CIRCLES:
            radius = item.params[1 if item.command == Command.NAV_LOITER_TO_ALT else 2]
            circle = Goal("loiter", target, radius=self.circle_radius(item, radius))
            edge = self.edge(circle, start)
            if edge is None:
                return circle
            self.circle = circle
            return Goal("leg", edge, start)
        acceptance = item.params[1] if self.pilot.kind == "plane" else 0
        return Goal("leg", target, start, following=self.following(item),
                    acceptance=acceptance or None)

    def edge(self, circle, start):
        """The nearest place of its circle, to which an ArduCopter flies first, straight."""
        if self.pilot.kind != "copter" or self.pilot.flavour.name != "ardupilot":
            return None
        if not circle.radius:
            return circle.target
        north, east, _ = geodesy.vector(circle.target, start)
        distance = math.hypot(north, east)
        if distance < 0.5:
            return None
        scale = abs(circle.radius) / distance
        return geodesy.offset(circle.target, north * scale, east * scale)

    def circle_radius(self, item, radius):
        """Copters circle only for turns and hold still otherwise."""
        if self.pilot.kind == "copter":
            return radius if item.command == Command.NAV_LOITER_TURNS else 0.0
        return radius or self.pilot.parameters["WP_LOITER_RAD"]

    def following(self, item):
        """Where the leg after this waypoint leads, if it is passed without a stop."""
        if self.pilot.kind == "copter" and item.params[0] > 0:
            return None
        after = self.index + 1
        items = self.items()
        while after < len(items) and items[after].command not in NAVIGATION:
            if items[after].command == Command.DO_JUMP:
                return None
            after += 1
        if after >= len(items) or items[after].command == Command.NAV_RETURN_TO_LAUNCH:
            return None
        if self.pilot.kind == "copter" and items[after].command != Command.NAV_WAYPOINT:
            return None
        return plans.target_of(items[after], self.pilot.home, self.pilot.body.position,
                               self.pilot.terrain_height)

    def complete(self, dt):
        item, body = self.item, self.pilot.body
        if item.command == Command.NAV_LOITER_UNLIM and self.goal.kind != "leg":
            return False
        if item.command == Command.NAV_RETURN_TO_LAUNCH:
            self.goal = self.pilot.go_home()
            return self.goal.kind == "land" and body.arrived(self.goal)
        if item.command in CIRCLES and self.goal.kind == "leg":
            if body.arrived(self.goal):
                self.goal = self.circle
            return False
        if self.since is None and body.arrived(self.goal):
            self.since = 0.0
            if item.command == Command.NAV_WAYPOINT and item.params[0] > 0:
                self.pilot.text(Severity.INFO, f"Reached command #{self.index}")
        if self.since is None and item.command != Command.NAV_LOITER_TURNS:
            return False
        return self.enough(item, body, dt)

    def enough(self, item, body, dt):
        """Whether the time, turns or altitude of an item that was arrived at are done."""
        if item.command == Command.NAV_LOITER_TURNS:
            return self.turns_done(item, body)
        self.since += dt
        if item.command == Command.NAV_LOITER_TO_ALT:
            return abs(body.position.alt - self.goal.target.alt) < 3.0
        if item.command == Command.NAV_LOITER_TIME:
            return self.since >= item.params[0]
        if item.command == Command.NAV_WAYPOINT and self.pilot.kind == "copter":
            return self.since >= item.params[0]
        return True

    def turns_done(self, item, body):
        """Counts the angle seen from the centre, once the circle is reached."""
        north, east, _ = geodesy.vector(self.goal.target, body.position)
        radius = abs(self.goal.radius)
        if not radius:
            return body.arrived(self.goal)
        if self.since is None and abs(math.hypot(north, east) - radius) > 0.3 * radius:
            return False
        self.since = 0.0
        bearing = math.atan2(east, north)
        if self.bearing is not None:
            self.turned += abs(geodesy.wrap(bearing - self.bearing))
        self.bearing = bearing
        return self.turned >= item.params[0] * 2 * math.pi
