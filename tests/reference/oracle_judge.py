# SPDX-License-Identifier: Apache-2.0
"""The verdict on a mission from the paths that may be flown: `must_fail` if one of them violates beyond doubt,
`must_pass` if the whole band keeps every limit."""
import math

import numpy as np

from oracle_commands import Mission, Order, faults, refusals
from oracle_flight import ArduCopter, Px4Copter, ring_points
from oracle_planes import ArduPlane, Px4Plane, Px4Vtol, QuadPlane
from oracle_world import ALWAYS, read_fences

MARGIN_M = 0.5  # rounding of files, and of how the ground is read
WALKS = {"AC": ArduCopter, "AF": ArduPlane, "QP": QuadPlane, "PM": Px4Copter, "PF": Px4Plane, "PV": Px4Vtol}
CHOICES = {"AC": ["as drawn", "leaves early"], "PM": ["as drawn"], "AF": ["cut", "slow climbs", "steered", "weak"],
           "QP": ["cut", "slow climbs", "steered", "weak"], "PF": ["cut", "slow climbs"], "PV": ["cut"]}
OFF_GROUND = {"leg", "circle", "return"}  # limits of height above ground apply; not to take-off and landing
HOME_M = 3.0  # home higher or lower than its ground: heights relative to it are in doubt


class Verdict:
    def __init__(self):
        self.refused, self.violations, self.faults, self.unjudged, self.doubts = [], [], [], [], []
        self.near = []  # what the band touches

    @property
    def word(self):
        if self.refused:
            return "refused"
        if self.violations or self.faults:
            return "must_fail"
        if self.unjudged:
            return "not_judgeable"
        return "undecided" if self.doubts or self.near else "must_pass"

    def clears_but_for_the_start(self):
        """For planes, whose take-off is never known."""
        known = {"start in flight", "take-off along an unknown course", "not judged beyond the landing point"}
        return not (self.refused or self.violations or self.faults or self.near) and set(self.doubts) <= known

    def reasons(self):
        return [*self.refused, *self.violations, *self.faults, *self.unjudged]


class Case:
    """A plan, its world, the zones, and the options of `check`."""

    def __init__(self, plan, world, zones=(), min_agl=None, max_agl=None, name=""):
        self.plan, self.world, self.zones, self.name = plan, world, list(zones), name
        self.min_agl, self.max_agl = min_agl, max_agl

    def fly(self):
        mission = Mission(self.plan, self.world)
        order = Order(mission)
        walk = WALKS[mission.kind]
        return mission, [walk(mission, order, self.world, choice).run() for choice in CHOICES[mission.kind]]

    def judge(self):
        verdict = Verdict()
        mission, walks = self.fly()
        fences = read_fences(self.plan, self.world)
        verdict.refused = refusals(mission)
        verdict.faults, verdict.unjudged = faults(mission)
        for walk in walks:
            verdict.doubts += [d for d in walk.doubts if d not in verdict.doubts]
            verdict.faults += [f for f in walk.faults if f not in verdict.faults]
            for piece in walk.pieces:
                verdict.violations += violations(piece, self, fences)
        ground = self.world.ground(mission.home[:2])
        if not abs(mission.home[2] - ground) <= HOME_M:
            verdict.doubts.append("home is not on the ground")
        if not any(walk.tubes for walk in walks):
            verdict.doubts.append("nothing is flown")
        verdict.violations = sorted(set(verdict.violations))
        if not verdict.reasons() or verdict.unjudged:
            verdict.near = touched(walks, self, fences)
        return verdict


def violations(piece, case, fences):
    """Of one path: only samples that violate by more than they may be off."""
    found, item = [], piece.item
    points, places = piece.points, piece.points[:, :2]
    ground = case.world.ground(places)
    doubt = MARGIN_M + piece.heights + case.world.slope * piece.across
    above = points[:, 2] - ground
    with np.errstate(invalid="ignore"):
        if piece.phase in OFF_GROUND | {"climb"} and (above < -doubt).any():
            found.append(f"item {item}: below ground ({piece.phase})")
        if piece.phase in OFF_GROUND and case.min_agl is not None and (above < case.min_agl - doubt).any():
            found.append(f"item {item}: below least height ({piece.phase})")
        if case.max_agl is not None and (above > case.max_agl + doubt).any():
            found.append(f"item {item}: above greatest height ({piece.phase})")
    for n, fence in enumerate(fences):
        depth = fence.shape.distance(places) * (1 if fence.keeps_in else -1)
        if (depth > MARGIN_M + piece.across + fence.shape.doubt).any():
            found.append(f"item {item}: {'out of' if fence.keeps_in else 'in'} fence {n} ({piece.phase})")
    for n, zone in enumerate(case.zones):
        if (in_zone(zone, piece, above, places, doubt)).any():
            found.append(f"item {item}: in zone {n} ({piece.phase})")
    return found


def in_zone(zone, piece, above, places, doubt):
    inside = zone.shape.distance(places) < -(MARGIN_M + piece.across)
    z = above if zone.datum == "AGL" else piece.points[:, 2]
    off = doubt if zone.datum == "AGL" else MARGIN_M + piece.heights
    with np.errstate(invalid="ignore"):
        inside &= (z > zone.floor + off) & (z < zone.ceiling - off)
    if zone.closed != ALWAYS:  # starts and stops are not in the nominal times
        inside &= (piece.times > zone.closed[0] + 5) & (1.15 * piece.times + 15 < zone.closed[1])
    return inside


def touched(walks, case, fences):
    """What any part of the band comes near to."""
    found = set()
    for walk in walks:
        for tube in walk.tubes:
            found |= tube_touches(tube, case, fences)
            if len(found) > 3:
                return sorted(found)
    return sorted(found)


def tube_touches(tube, case, fences):
    found, item = set(), tube.item
    for n, fence in enumerate(fences):
        depth = fence.shape.distance(tube.places) * (-1 if fence.keeps_in else 1)
        if (depth < tube.radius + fence.shape.doubt + 1).any():
            found.add(f"item {item}: fence {n}")
    lowest, highest = ground_about(tube, case.world)
    if np.isnan(lowest).any():
        return found | {f"item {item}: beyond the grid"}
    if tube.phase in OFF_GROUND and (tube.low - highest < (case.min_agl or 0)).any():
        found.add(f"item {item}: ground")
    if case.max_agl is not None and (tube.high - lowest > case.max_agl).any():
        found.add(f"item {item}: greatest height")
    for n, zone in enumerate(case.zones):
        near = zone.shape.distance(tube.places) < tube.radius + 1
        floor, ceiling = zone.floor, zone.ceiling
        if zone.datum == "AGL":
            floor, ceiling = floor + lowest, ceiling + highest
        near &= (tube.high > floor - 1) & (tube.low < ceiling + 1)
        open_then = tube.times[1] < zone.closed[0] - 1 or tube.times[0] > zone.closed[1] + 1
        if near.any() and not open_then:
            found.add(f"item {item}: zone {n}")
    return found


def ground_about(tube, world):
    """Lowest and highest ground within the radius, by samples and the steepest slope between them."""
    offsets = [np.zeros((1, 2))] + [ring_points((0, 0), r, math.pi * r / 4) for r in (tube.radius, tube.radius / 2)]
    ground = world.ground(tube.places[:, None, :] + np.vstack(offsets)[None])
    slack = world.slope * tube.radius / 4
    return ground.min(1) - slack, ground.max(1) + slack
