# SPDX-License-Identifier: Apache-2.0
"""Flies the legs of a planned route, apart from the program: at an airspeed, in winds one after another."""
import cmath
import math


def fly(step, airspeed, winds):
    """The seconds that the legs take, and how far the worst end of a turn lies from where the winds, (from second on,
    m/s, degrees from which it blows), carry it. Fails where a heading through the air jumps between turns, or a course
    cannot be held."""
    def wind(time_s):
        _, speed, degrees = [given for given in winds if given[0] <= time_s + 1e-5][-1]
        return -cmath.rect(speed, math.radians(90 - degrees))

    def until(time_s):
        return min([from_s for from_s, _, _ in winds if from_s > time_s + 1e-5], default=math.inf)
    time_s, off_m, heading = 0, 0, None
    here = complex(*step["route"][0][:2])
    legs = step.get("legs") or [{"kind": "straight", "end": place} for place in step["route"][1:]]
    for leg in legs:
        end = complex(*leg["end"][:2])
        if leg["kind"] == "straight":
            way, left = end - here, abs(end - here)
            while left > 1e-7:
                along = wind(time_s) * way.conjugate() / abs(way)
                assert abs(along.imag) <= airspeed, "no course"
                speed = along.real + math.sqrt(airspeed**2 - along.imag**2)
                seconds = min(left / speed, until(time_s) - time_s)
                time_s, left = time_s + seconds, left - seconds * speed
            heading = None  # it crabs as the wind asks
        else:
            first, turn = math.radians(leg["heading_deg"]), math.radians(leg["turn_deg"])
            # Clockwise from north; to the left is positive.
            first = math.pi / 2 - first
            seconds = leg["radius_m"] * abs(turn) / airspeed
            if heading is not None and seconds * airspeed > 0.1:
                assert abs(math.remainder(first - heading, 2 * math.pi)) < 1e-4, "the heading jumps"
            assert seconds < 1e-3 or wind(time_s) == wind(time_s + seconds - 1e-3), "a turn in two winds"
            side = math.copysign(math.pi / 2, turn)
            circle = leg["radius_m"] * (cmath.exp(1j * (first + side)) - cmath.exp(1j * (first + turn + side)))
            off_m = max(off_m, abs(here + circle + seconds * wind(time_s) - end))
            time_s, heading = time_s + seconds, first + turn
        here = end
    return time_s, off_m
