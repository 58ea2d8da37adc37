#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""referee.py RESULT [--program ALTIPLAN] [--page]: judges a stored result again from its files.

Nothing of the library is used. Prints each difference between what the result says and what the
referee finds, and exits with 1; with 0 where they agree within 1e-5 m, and with 2 where the world has
a layer that the referee has no geometry for. With --program such layers are taken from the page of
`altiplan view`, to the millimetre; with --page the page's profile is held against the metrics too."""
import argparse
import json
import sys

import numpy as np

import curved
import flights
import layers
import page
import rules
import scenario

AGREES = 1e-5  # m, and degrees
# The judge allows 1e-6 m and 1e-8 rad. As close to that as a finding's own error either verdict does.
# Chords of a turn are 3e-6 m from it; beside a turn a micrometre in a metre is no corner; a radius of a
# fillet of legs that hardly turn is no number to speak of.
ALLOWED = {"m": (0.5e-6, 1.5e-6), "deg": (1e-7, 2e-6), "bound": (0, 0), "curve": (-5e-6, 5e-6),
           "joint": (1e-7, 1e-4), "fillet": (-1e-3, 1e-3)}
ONCE = {"start", "goal", "via", "route_length", "volume", "level_flight"}  # held by name, not by place
UNVALUED = ONCE | {"ground", "collision", "speed", "wind", "goal_heading"}


class Differences(list):
    def __init__(self, what, route, tolerance=AGREES):
        super().__init__()
        self.what, self.tolerance = what, tolerance
        self.longest = float(np.linalg.norm(np.diff(route, axis=0), axis=1).max())

    def allowed(self, key, value):
        """How far a number of the library's may be from the referee's."""
        if value < 0:  # a depth is searched for, to a ten-thousandth of the leg or a millimetre
            return max(1e-3, 1e-4 * self.longest) + self.tolerance
        # Large numbers have fewer digits after the point, a radius of legs that hardly turn fewer still.
        turn = (value * 1e-3) ** 2 if "radius" in key else 0
        return self.tolerance * max(1, value * 1e-4, turn)

    def say(self, text):
        self.append(f"{self.what}: {text}")

    def metrics(self, stored, own, skip=()):
        for key, value in own.items():
            if key in skip:
                continue
            told = stored[key]
            if "radius" in key:  # of legs that hardly turn: no number to speak of
                told, value = (None if v is None or v > 1e6 else v for v in (told, value))
            if told is None or value is None:
                if told is not value:
                    self.say(f"{key} is {told}, by the referee {value}")
            elif abs(told - value) > self.allowed(key, value):
                self.say(f"{key} is {told}, by the referee {value}")

    def verdict(self, check, findings, skip=()):
        told, own = {}, {}
        for v in check["violations"]:
            if v["constraint"] not in skip:
                told.setdefault(key_of(v["constraint"], v["at"]), []).append(v["value"])
        for finding in findings:
            if finding.rule not in skip:
                own.setdefault(key_of(finding.rule, finding.at), []).append(finding)
        for key in sorted(own, key=str):
            broken = [f for f in own[key] if f.excess is not None and f.excess > ALLOWED[f.unit][1]]
            if broken and key not in told:
                worst = max(broken, key=lambda f: f.excess)
                self.say(f"accepted, but {where(key)}: {worst.value} against a limit of {worst.limit}")
        for key, values in told.items():
            possible = [f for f in own.get(key, ())
                        if f.excess is None or f.excess >= ALLOWED[f.unit][0]]
            if not possible:
                self.say(f"refused for {where(key)}, which the referee finds kept: {values}")
            elif key[0] not in UNVALUED and all(
                    f.excess is not None and f.unit in ("m", "deg") for f in possible):
                self.values(key, values, possible)

    def values(self, key, values, possible):
        for value in values:
            if not any(abs(value - f.value) <= self.allowed(key[0], f.value)
                       for f in possible):
                self.say(f"{where(key)} is {value}, by the referee "
                         + ", ".join(str(f.value) for f in possible))


def key_of(rule, at):
    return (rule, None if rule in ONCE else at)


def where(key):
    return key[0] if key[1] is None else f"{key[0]} at {key[1]}"


def judge_route(mission, limits, route, check, metrics, what, tolerance=AGREES):
    """Differences about one route in the world known before take-off."""
    route = np.array(route, float)
    world, grounds = mission.known()
    judge = rules.Judge(mission, limits)
    judge.ends(route)
    judge.volume(route)
    judge.shape(route)
    judge.steepness(route)
    judge.length(route)
    at = np.arange(len(route) - 1)
    judge.heights(at, route[:-1], route[1:], grounds)
    judge.clearances(route[:-1], route[1:], world, at)
    found = Differences(what, route, tolerance)
    found.verdict(check, judge.findings)
    if metrics is not None:
        own = rules.measures(mission, route, world, grounds)
        skip = {"duration_s"} if own["duration_s"] is None else set()
        gap, told = own["min_ground_clearance_m"], metrics["min_clearance_m"]
        if grounds:
            skip.add("min_clearance_m")
        if grounds and gap is not None and gap > 0:
            low, high = rules.ground_bounds(grounds, gap, own["min_clearance_m"])
            allowed = found.allowed("min_clearance_m", low)
            if told is None or not low - allowed <= told <= high + allowed:
                found.say(f"min_clearance_m is {told}, by the referee between {low} and {high}")
        found.metrics(metrics, own, skip)
    return found


def judge_curved(mission, limits, route, legs, check, metrics, what):
    """The same of a route with turns, or in wind."""
    world, grounds = mission.known()
    if grounds or limits.turn_space < 180:
        raise layers.NotJudged("a route with turns over ground, or with a limit on turns in space,")
    route, legs = np.array(route, float), curved.legs_of(route[0], legs)
    judge = curved.Judge(mission, limits)
    judge.ends(route)
    judge.volume(route)
    judge.legs(legs, mission.air)
    judge.places(legs, world)
    own = curved.measures(mission, legs)
    judge.below("route_length", 0, own["length_m"], limits.length)
    found = Differences(what, route)
    found.verdict(check, judge.findings)
    if metrics is not None:
        found.metrics(metrics, own)
    return found


def judge_flight(mission, limits, flight, tolerance=AGREES):
    track = np.array(flight["track"], float)[:, 1:]
    found = Differences("flight", track, tolerance)
    own = flights.Flight(mission, limits, flight["track"])
    # A corner's radius says nothing of a track, which has a point every second.
    found.verdict(flight["check"], own.judge.findings, {"turn_radius", "collision", "turn_angle"})
    told, separation = flight["min_separation_m"], own.separation
    depth = own.collided()
    if depth is not None and depth > 1.5e-6 and not flight["collisions"]:
        found.say(f"0 collisions, but the vehicle comes to {separation} m of what it meets at point "
                  f"{own.contact_at}")
    if flight["collisions"] and (depth is None or depth < 0.5e-6):
        found.say(f"{flight['collisions']} collisions, by the referee none: {separation} m")
    if not is_separation(told, own, found):
        found.say(f"min_separation_m is {told}, by the referee {separation}")
    if flight["status"] == "solved" and not (flight["reached"] and flight["check"]["ok"]
                                             and not flight["collisions"]):
        found.say("solved, without having reached the goal in accordance with all rules")
    lengths = np.linalg.norm(np.diff(track, axis=0), axis=1)
    corners = [p for _, p, _, _ in rules.turns(track, mission.on_the_spot) if p is not None]
    found.metrics(flight["metrics"], {
        "length_m": float(lengths.sum()), "waypoints": len(track),
        "max_turn_deg": max(corners, default=0.0),
        "max_climb_deg": float(np.abs(rules.climbs(track)).max()),
        "duration_s": float(flight["track"][-1][0] - flight["track"][0][0])})
    return found


def is_separation(told, own, found):
    """Of ground a bound is known: no less than the height over the steepest slope, and no more than
    the height."""
    if told is None or own.separation is None and own.min_gap == np.inf:
        return told is own.separation
    low = high = np.inf if own.separation is None else own.separation
    if own.min_gap < np.inf:
        steepest = max(g.steepest() for g in own.world.grounds())
        low, high = min(low, own.min_gap / np.hypot(1, steepest)), min(high, own.min_gap)
    allowed = found.allowed("separation", low)
    return low - allowed <= told <= high + allowed


def judge_result(result, scene=None):
    """All differences of a result, as sentences."""
    tolerance = AGREES if scene is None else 2e-3
    mission = scenario.of_result(result, None if scene is None else page.drawn(scene))
    limits = rules.limits_of(mission)
    found, standing = [], None

    def judged(of, what):
        if mission.is_flown or any(leg["turn_deg"] for leg in of["legs"]):
            return judge_curved(mission, limits, of["route"], of["legs"], of["check"], of["metrics"],
                                what)
        return judge_route(mission, limits, of["route"], of["check"], of["metrics"], what, tolerance)

    for step in result["steps"]:
        if len(step["route"]) > 1 and step["check"] is not None:
            found += judged(step, f"step '{step['id']}'")
            if step["accepted"] and not step["check"]["ok"]:
                found.append(f"step '{step['id']}': stands with violations")
        if step["accepted"] and step["verb"] != "fly":
            standing = step["route"]
    if result["route"]:
        found += judged(result, "result")
        if result["route"] != standing:
            found.append("result: the route is not that of the last step that stands")
    if result["flight"] and len(result["flight"]["track"]) > 1:
        found += judge_flight(mission, limits, result["flight"], tolerance)
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("result")
    parser.add_argument("--program", help="altiplan, for layers that only its page tells")
    parser.add_argument("--page", action="store_true", help="hold the page's profile too")
    options = parser.parse_args()
    with open(options.result, encoding="utf-8") as file:
        result = json.load(file)
    scene = page.scene(options.program, options.result) if options.page else None
    try:
        try:
            found = judge_result(result)
        except layers.NotJudged:
            if options.program is None:
                raise
            scene = scene or page.scene(options.program, options.result)
            found = judge_result(result, scene)
    except layers.NotJudged as reason:
        print(f"{options.result}: {reason} is not judged")
        return 2
    if options.page:
        found += page.profile_differences(scene, result["metrics"])
    for difference in found:
        print(difference)
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
