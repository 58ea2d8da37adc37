# SPDX-License-Identifier: Apache-2.0
"""What a route has to keep, and how much each leg keeps it: findings, to be held against a judge's."""
import collections
import dataclasses

import numpy as np

import terrain

HEADING = 1e-6  # m: a leg that is shorter than that on the plane has no heading

Finding = collections.namedtuple("Finding", "rule at value limit excess unit")


@dataclasses.dataclass
class Limits:
    clearance: float = 0.0
    ground: float = None
    bands: list = dataclasses.field(default_factory=list)
    turn: float = 180.0
    turn_space: float = 180.0
    radius: float = 0.0
    climb: float = 90.0
    sink: float = 90.0
    min_leg: float = 0.0
    greatest_leg: float = np.inf
    length: float = np.inf


def limits_of(mission):
    limits = Limits(clearance=mission.radius)
    if mission.wing is not None:
        speed, bank, limits.climb, limits.sink = mission.wing
        limits.radius = speed**2 / (9.80665 * np.tan(np.radians(bank)))
    for entry in mission.rules:
        (rule, of), = entry.items()
        low, high = (float(of[k]) if k in of else None for k in ("min_m", "max_m"))
        if rule == "clearance":
            limits.clearance = max(limits.clearance, low)
        elif rule == "ground_clearance":
            limits.ground = max(low, limits.ground or 0)
        elif rule == "altitude":
            limits.bands.append((low, high, of.get("datum", "sea")))
        elif rule == "turn_angle" and of.get("plane", "horizontal") == "horizontal":
            limits.turn = min(limits.turn, float(of["max_deg"]))
        elif rule == "turn_angle":
            limits.turn_space = min(limits.turn_space, float(of["max_deg"]))
        elif rule == "turn_radius":
            limits.radius = max(limits.radius, low)
        elif rule == "climb_angle":
            limits.climb = min(limits.climb, float(of["max_deg"]))
        elif rule == "leg_length":
            limits.min_leg = max(limits.min_leg, low or 0)
            limits.greatest_leg = min(limits.greatest_leg, np.inf if high is None else high)
        elif rule == "route_length" and high is not None:
            limits.length = min(limits.length, high)
        elif rule == "route_length":
            straight = float(np.linalg.norm(mission.goal - mission.start))
            limits.length = min(limits.length, float(of["max_ratio"]) * straight)
        else:
            raise ValueError(f"no rule of the referee's: '{rule}'")
    return limits


def angle(u, v):
    """Between two vectors, in degrees, well at 0 and at 180 too (W. Kahan's formula)."""
    u, v = u / np.linalg.norm(u), v / np.linalg.norm(v)
    return float(np.degrees(2 * np.arctan2(np.linalg.norm(u - v), np.linalg.norm(u + v))))


def turns(route, on_the_spot):
    """(waypoint, degrees seen from above, degrees in space, radius) where a route turns. A heading
    lasts through legs that have none."""
    found, heading, upright = [], None, False
    legs = np.diff(route, axis=0)
    for i, leg in enumerate(legs):
        plane, space, radius = None, None, np.inf
        if i and leg.any() and legs[i - 1].any():
            space = angle(legs[i - 1], leg)
            room = min(np.linalg.norm(legs[i - 1]), np.linalg.norm(leg)) / 2
            radius = fillet(room, space)
        if np.hypot(*leg[:2]) >= HEADING:
            if heading is not None:
                plane = angle(heading, leg[:2])
                if upright and plane > np.degrees(1e-8):
                    radius = 0.0
            heading, upright = leg[:2], False
        elif on_the_spot:
            heading = None
        else:
            upright = True
        found.append((i, plane, space, radius))
    return found


def fillet(room, degrees):
    """Radius of the circle that touches both legs at most so far from their corner."""
    if degrees == 0:
        return np.inf
    return 0.0 if degrees >= 180 else room / np.tan(np.radians(degrees) / 2)


def climbs(route):
    legs = np.diff(route, axis=0)
    return np.degrees(np.arctan2(legs[:, 2], np.hypot(legs[:, 0], legs[:, 1])))


class Judge:
    """Findings about the legs of a route or track in one world of solids and ground."""

    def __init__(self, mission, limits):
        self.mission, self.limits, self.findings = mission, limits, []

    def add(self, rule, at, value, limit, excess, unit="m"):
        self.findings.append(Finding(rule, at, float(value), float(limit), float(excess), unit))

    def below(self, rule, at, value, limit, unit="m"):
        """The value must not be above the limit."""
        if np.isfinite(limit):
            self.add(rule, at, value, limit, value - limit, unit)

    def above(self, rule, at, value, limit, unit="m"):
        self.add(rule, at, value, limit, limit - value, unit)

    def ends(self, route):
        m = self.mission
        self.below("start", 0, np.linalg.norm(route[0] - m.start), 0)
        self.below("goal", len(route) - 1, np.linalg.norm(route[-1] - m.goal), m.tolerance)
        at = 0
        for place, tolerance in m.via:
            away = np.linalg.norm(route[at:] - place, axis=1)
            passes = np.nonzero(away <= tolerance + 1e-6)[0]
            self.below("via", at, away[passes[0]] if len(passes) else away.min(), tolerance)
            at += int(passes[0]) if len(passes) else 0

    def volume(self, route):
        m = self.mission
        low, high = m.low.copy(), m.high.copy()
        if m.level is not None:
            low[2] = high[2] = m.level
        for i, p in enumerate(route):
            self.add("volume", i, 0, 0, max((low - p).max(), (p - high).max()))
            if m.level is not None:
                self.add("level_flight", i, p[2], m.level, abs(p[2] - m.level))

    def shape(self, route):
        limits = self.limits
        for i, plane, space, radius in turns(route, self.mission.on_the_spot):
            if plane is not None:
                self.below("turn_angle", i, plane, limits.turn, "deg")
            if space is not None:
                self.below("turn_angle", i, space, limits.turn_space, "deg")
            if limits.radius > 0 and i:
                self.above("turn_radius", i, radius, limits.radius)
        for i, length in enumerate(np.linalg.norm(np.diff(route, axis=0), axis=1)):
            self.below("leg_length", i, length, limits.greatest_leg)
            if limits.min_leg > 0:
                self.above("leg_length", i, length, limits.min_leg)

    def steepness(self, route):
        for i, climb in enumerate(np.abs(climbs(route))):
            self.below("climb_angle", i, climb, self.limits.climb, "deg")

    def length(self, route):
        total = np.linalg.norm(np.diff(route, axis=0), axis=1).sum()
        self.below("route_length", 0, total, self.limits.length)

    def doubt(self, rule, at, value, limit):
        """Either verdict will do: the library is documented to be careful here."""
        self.findings.append(Finding(rule, at, float(value), float(limit), None, "m"))

    def heights(self, at, a, b, grounds):
        """Bands and ground of the legs a[i], b[i]; their (least, greatest) heights above ground."""
        gaps = gaps_of(grounds, a, b)
        for leg in zip(at, a, b, gaps):
            self.heights_of(*leg, grounds)
        return gaps

    def heights_of(self, at, a, b, gaps, grounds):
        if gaps is not None and np.isnan(gaps[0]):
            self.add("ground", at, 0, 0, np.inf)
            return
        if gaps is not None:
            self.ground_all_round(at, a, b, gaps[0], grounds)
        if gaps is not None and self.limits.ground is not None:
            self.above("ground_clearance", at, gaps[0], self.limits.ground)
        for low, high, datum in self.limits.bands:
            if datum == "ground" and gaps is None:
                continue
            base = self.mission.start[2] if datum == "start" else 0.0
            least, greatest = (min(a[2], b[2]) - base, max(a[2], b[2]) - base)
            if datum == "ground":
                least, greatest = gaps
            if low is not None:
                self.above("altitude", at, least, low)
            if high is not None:
                self.below("altitude", at, greatest, high)

    def ground_all_round(self, at, a, b, gap, grounds):
        """The distance from the ground in any direction lies between two bounds; that from a place of
        the ground that is too near breaks the rule for certain."""
        limit = self.limits.clearance
        if ground_bounds(grounds, gap, None)[0] >= limit + 1e-6:
            return
        nearest = gap if gap <= 0 or limit == 0 else min(
            gap, *(ground_near(g, a, b, limit) for g in grounds))
        if nearest < limit - 1e-3 or gap < limit - 1.5e-6:
            self.findings.append(Finding("clearance", at, nearest, limit, np.inf, "bound"))
        else:
            self.doubt("clearance", at, nearest, limit)

    def clearances(self, a, b, world, at):
        """Of the legs a[i], b[i], whose numbers in the route are at[i]."""
        limit = self.limits.clearance
        for leg, solid, value in world.least(a, b, limit + 1e-3):
            self.add("clearance", at[leg], value, limit, limit - value)


def ground_near(ground, a, b, reach):
    """A distance of the leg from a place of the ground: the least of many."""
    t = np.linspace(0, 1, int(np.clip(np.linalg.norm(b - a) / reach * 4, 2, 500)))
    p = a + (b - a) * t[:, None]
    ring = np.stack(np.meshgrid(*[np.linspace(-reach, reach, 21)] * 2), -1).reshape(-1, 2)
    below = ground.height(p[:, None, :2] + ring) - p[:, None, 2]
    return float(np.nanmin(np.sqrt((ring**2).sum(-1) + below**2)))


def ground_bounds(grounds, gap, nearest):
    """(least, greatest) that the distance from ground and solids can be: no less than the height over
    the steepest slope, no more than the height."""
    steepest = max(g.steepest() for g in grounds)
    nearest = np.inf if nearest is None else nearest
    return min(gap / np.hypot(1, steepest), nearest), min(gap, nearest)


def gaps_of(grounds, a, b):
    """(least, greatest) height of each leg above the highest ground below; NaN: a part has none."""
    if not grounds:
        return [None] * len(a)
    if len(grounds) > 1 and any(isinstance(g, terrain.Grid) for g in grounds):
        raise ValueError("elevation models beside other ground are not judged")
    every = np.array([g.gaps(a, b) for g in grounds])
    return every.min(axis=0)  # of several the greatest is a bound


def measures(mission, route, world, grounds):
    """The geometric metrics of docs/reference/result.md."""
    legs = np.linalg.norm(np.diff(route, axis=0), axis=1)
    corners = turns(route, mission.on_the_spot)
    planes = [p for _, p, _, _ in corners if p is not None]
    slopes = climbs(route)
    radii = [r for _, _, _, r in corners if np.isfinite(r)]
    near = world.nearest(route[:-1], route[1:])
    gaps = gaps_of(grounds, route[:-1], route[1:])
    least = gaps[:, 0].min() if grounds else np.nan
    return {
        "length_m": float(legs.sum()),
        "waypoints": len(route),
        "max_turn_deg": max(planes, default=0.0) if corners[1:] else None,
        "max_climb_deg": float(np.abs(slopes).max()),
        "min_radius_m": min(radii, default=None),
        "min_clearance_m": near[0] if near else None,
        "min_ground_clearance_m": None if np.isnan(least) else float(least),
        "smoothness_rad": float(np.radians(sum(planes) + np.abs(np.diff(slopes)).sum())) if corners[1:]
        else None,
        "duration_s": None if mission.speed_near else float(legs.sum() / mission.speed),
    }
