# SPDX-License-Identifier: Apache-2.0
"""Routes that turn, in layers of wind: what their legs keep over the ground and through the air."""
import numpy as np

import rules

CHORD = 3e-6  # m: so far are chords from their turn


class Leg:
    def __init__(self, begin, of):
        self.a, self.b = np.array(begin, float), np.array(of["end"], float)
        self.turn = np.radians(of["turn_deg"] or 0.0)
        self.radius = of["radius_m"] or 0.0
        self.drift = np.array(of["drift_m"] or (0.0, 0.0))
        self.heading = np.radians(90 - of["heading_deg"]) if self.turn else 0.0
        self.way = self.b - self.a
        self.through_air = self.radius * abs(self.turn)  # of a turn

    def along(self, heading):
        """Metres over the ground in the time of the whole leg, at the speed of that heading."""
        return self.through_air * np.array([np.cos(heading), np.sin(heading)]) + self.drift

    def course(self, end):
        """At its begin (0) or end (1), in space; none of what is too short to have one."""
        if not self.turn:
            return self.way if np.hypot(*self.way[:2]) >= rules.HEADING else None
        if self.through_air < rules.HEADING:
            return None
        return np.append(self.along(self.heading + end * self.turn), self.way[2])

    def points(self, tolerance=CHORD):
        """So many that the chords keep to the leg."""
        if not self.turn:
            return np.array([self.a, self.b])
        sagitta = self.radius * self.turn**2 / 8
        t = np.linspace(0, 1, 1 + int(np.ceil(np.sqrt(sagitta / tolerance))))[:, None]
        heading = self.heading + t * self.turn
        circle = np.hstack([np.sin(heading) - np.sin(self.heading),
                            np.cos(self.heading) - np.cos(heading)])
        flat = self.a[:2] + np.sign(self.turn) * self.radius * circle + t * self.drift
        return np.hstack([flat, self.a[2] + t * self.way[2]])

    def length(self):
        if not self.turn:
            return float(np.linalg.norm(self.way))
        heading = self.heading + (np.arange(4000) + 0.5) / 4000 * self.turn
        flat = self.through_air * np.array([np.cos(heading), np.sin(heading)]).T + self.drift
        return float(np.hypot(np.hypot(*flat.T), self.way[2]).mean())


class Air:
    """Wind by layers of height."""

    def __init__(self, layers, speed):
        self.layers, self.speed = layers, speed

    def wind(self, z):
        return next((w for above, w in reversed(self.layers) if z >= above), np.zeros(2))

    def cuts(self, low, high):
        """The shares of a climb at which borders are crossed, with both ends."""
        inner = [(above - low) / (high - low) for above, _ in self.layers
                 if min(low, high) < above < max(low, high)]
        return sorted([0.0, 1.0, *inner])

    def seconds(self, leg):
        """Of a straight leg in each layer: where |way / t - wind| is the airspeed."""
        times, ends = [], self.cuts(leg.a[2], leg.b[2])
        for begin, end in zip(ends, ends[1:]):
            wind = self.wind(leg.a[2] + (begin + end) / 2 * leg.way[2])
            way = (end - begin) * leg.way[:2]
            rest, helps = self.speed**2 - wind @ wind, way @ wind
            root = helps**2 + rest * (way @ way)
            times.append(((np.sqrt(root) - helps) / rest if root >= 0 else np.inf,
                          (end - begin) * abs(leg.way[2])))
        return times

    def climb(self, leg):
        """Degrees through the air, the most in any layer; of a layer that is hardly touched none."""
        if leg.turn:
            return np.degrees(np.arctan2(abs(leg.way[2]), leg.through_air))
        if not self.layers or leg.course(0) is None:
            return np.degrees(np.arctan2(abs(leg.way[2]), np.hypot(*leg.way[:2])))
        return max((np.degrees(np.arctan2(rise, seconds * self.speed))
                    for seconds, rise in self.seconds(leg) if rise > 2e-6), default=0.0)


def legs_of(start, legs):
    made = []
    for of in legs:
        made.append(Leg(made[-1].b if made else start, of))
    return made


def kinks(mission, legs):
    """(leg, degrees over the ground, whether beside a turn, metres to fillet it with) at each leg that
    has a heading; it lasts through those that have none. And the course on arrival."""
    found, course, turns, room = [], mission.start_course, False, 0.0
    if course is not None:
        room = np.hypot(*course)
    for i, leg in enumerate(legs):
        begins = leg.course(0)
        if begins is None:
            continue
        length = np.inf if leg.turn else np.linalg.norm(leg.way)
        if course is not None:
            found.append((i, rules.angle(course[:2], begins[:2]), turns or leg.turn != 0,
                          min(room, length)))
        course, turns, room = leg.course(1), leg.turn != 0, length
    return found, course


class Judge(rules.Judge):
    def legs(self, legs, air):
        limits = self.limits
        bends, arrival = kinks(self.mission, legs)
        for i, degrees, is_turn, room in bends:
            self.below("turn_angle", i, degrees, limits.turn, "deg")
            if limits.radius > 0 and is_turn:
                self.add("turn_radius", i, 0, limits.radius, degrees, "joint")
            elif limits.radius > 0:
                self.above("turn_radius", i, rules.fillet(room / 2, degrees), limits.radius, "fillet")
        if self.mission.goal_heading is not None and arrival is not None:
            z = legs[-1].b[2]
            off = min(rules.angle(arrival[:2], self.mission.course(self.mission.goal_heading, at))
                      for at in (z, z - 1e-6))  # a border belongs to both layers
            self.add("goal_heading", len(legs), off, 0, off, "joint")
        for i, leg in enumerate(legs):
            self.leg(i, leg, air)

    def leg(self, i, leg, air):
        limits = self.limits
        steepest = limits.climb if leg.way[2] >= 0 else min(limits.climb, limits.sink)
        self.below("climb_angle", i, air.climb(leg), steepest, "deg")
        self.below("leg_length", i, leg.length(), limits.greatest_leg)
        if limits.min_leg > 0:
            self.above("leg_length", i, leg.length(), limits.min_leg)
        if leg.turn:
            self.above("turn_radius", i, leg.radius, limits.radius)
            drift = leg.through_air / air.speed * air.wind((leg.a[2] + leg.b[2]) / 2)
            crosses = len(air.cuts(leg.a[2], leg.b[2])) > 2
            self.add("wind", i, 0, 0, np.inf if crosses else np.linalg.norm(leg.drift - drift))
        elif leg.course(0) is not None and air.layers:
            held = np.isfinite([seconds for seconds, _ in air.seconds(leg)]).all()
            self.add("wind", i, 0, 0, -1 if held else np.inf)

    def places(self, legs, world):
        """The volume, the bands above the sea and the clearance of chords."""
        low, high = self.mission.low, self.mission.high
        for i, leg in enumerate(legs):
            p = leg.points()
            self.add("volume", i, 0, 0, max((low - p).max(), (p - high).max()))
            for least, greatest, datum in self.limits.bands:
                base = self.mission.start[2] if datum == "start" else 0.0
                if least is not None:
                    self.above("altitude", i, p[:, 2].min() - base, least)
                if greatest is not None:
                    self.below("altitude", i, p[:, 2].max() - base, greatest)
            limit, unit = self.limits.clearance, "curve" if leg.turn else "m"
            near = [value for _, _, value in world.least(p[:-1], p[1:], limit + 1e-3)]
            for value in [min(near)] if leg.turn and near else near:
                self.add("clearance", i, value, limit, limit - value, unit)


def measures(mission, legs):
    air = mission.air
    degrees = [d for _, d, _, _ in kinks(mission, legs)[0]]
    skip = mission.start_course is not None and legs[0].course(0) is not None
    seconds = [leg.through_air / air.speed if leg.turn else sum(s for s, _ in air.seconds(leg))
               for leg in legs]
    return {"length_m": sum(leg.length() for leg in legs), "waypoints": len(legs) + 1,
            "max_turn_deg": max(degrees[skip:], default=0.0) if len(legs) > 1 or legs[0].turn else None,
            "duration_s": float(sum(seconds))}
