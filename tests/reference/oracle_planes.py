# SPDX-License-Identifier: Apache-2.0
"""Paths that ArduPlane, QuadPlanes, and planes and VTOLs under PX4 may fly for a mission."""
import math

import numpy as np

from oracle_commands import POSITIONS
from oracle_flight import BAND_SAMPLE_M, Piece, Walk, at_height, ring_points, samples

GRAVITY = 9.81
L1_PERIOD, L1_DAMPING = 17.0, 0.75
FASTEST = 22.0  # AIRSPEED_MAX
STEP_S = 0.2
WEAK = 0.62  # of the turn that the guidance seeks, as it was flown in ArduPilot's simulation


def true_airspeed(z):
    """An indicated one, in the standard atmosphere."""
    return (1 - 2.25577e-5 * min(max(z, -500), 9000)) ** -2.128


def l1_length(speed):
    return L1_DAMPING * L1_PERIOD / math.pi * speed


def bend(a, b, c):
    """Degrees by which the course changes at b."""
    first, second = b[:2] - a[:2], c[:2] - b[:2]
    if min(np.hypot(*first), np.hypot(*second)) < 1e-6:
        return 90.0
    cross = first[0] * second[1] - first[1] * second[0]
    return abs(math.degrees(math.atan2(cross, first @ second)))


class Leg:
    def __init__(self, item, a, b, early, before, loose, blur, style):
        self.item, self.a, self.b, self.early, self.before = item, a, b, early, before
        self.loose, self.blur, self.style = loose, blur, style
        self.run = math.dist(a[:2], b[:2])


class PlaneWalk(Walk):
    """Legs between items, with corners that begin `early` metres before the item. `loose`: radius about the
    beginning of a leg within which the leg before may end; `blur`: by how much its height may be off there."""

    hover = False

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.speed, self.loose, self.blur, self.early = self.cruise, 0.0, 0.0, 0.0
        self.starts, self.fresh, self.pose = False, True, None

    # --- legs

    def fly_leg(self, item, place, z, follows, phase="leg", early=None, style=None):
        b = np.array([*place, z])
        if not self.starts:
            return self.begin_in_flight(b)
        run = math.dist(self.at[:2], place)
        if run < 1:
            self.at = b
            self.blur += abs(z - self.at[2])
            return None
        early = self.corner(item, b, follows) if early is None else early
        leg = Leg(item, self.at.copy(), b, min(early, run), self.early, self.loose, self.blur,
                  style or self.climbs(self.at, b, run))
        self.trace(leg, phase)
        self.band(leg, phase)
        self.time = self.spend(np.array([0, run]), self.speed)[:, -1]
        self.at, self.early, self.loose, self.blur = b, leg.early, 0.0, self.late_height(leg)
        self.fresh = False
        if leg.early + leg.before > run:  # it is left before it is joined, from nobody knows where
            self.loose, self.last = leg.early + leg.before, None
        return leg

    def begin_in_flight(self, b):
        """Without a take-off nobody knows where the mission is begun; it may be right before the first item."""
        self.doubts.append("start in flight")
        self.at, self.starts, self.early, self.fresh = b, True, 0.0, False
        self.loose, self.blur, self.pose = 0.0, 0.0, None

    def heights(self, leg, along):
        """Nominal height after a part of the leg."""
        a, b = leg.a[2], leg.b[2]
        if leg.style == "terrain":
            places = leg.a[:2] + np.outer(along / leg.run, leg.b[:2] - leg.a[:2])
            ground = self.world.ground(places)
            ends = self.world.ground(np.array([leg.a[:2], leg.b[:2]]))
            return ground + (a - ends[0]) + (b - ends[1] - a + ends[0]) * along / leg.run
        if leg.style == "level":
            return np.full(len(along), a)
        if leg.style == "ramp":
            end = max(leg.run - self.ramp_ends, 1e-6)
            return a + (b - a) * np.clip(along / end, 0, 1)
        rate = self.rate(b - a) if leg.style == "at once" else max(2.0, abs(b - a) * self.speed / max(leg.run, 1))
        change = rate / self.speed * along
        return a + np.sign(b - a) * np.minimum(change, abs(b - a))

    def late_height(self, leg):
        """How far the height may still be from the item's where the leg ends."""
        if leg.style in ("ramp", "level", "terrain"):
            return 0.0
        return max(0.0, abs(leg.b[2] - leg.a[2]) - self.slowest_rate * leg.run / self.speed)

    def trace(self, leg, phase):
        """The chord over the corner before, then the line up to the next corner."""
        along = np.linspace(0, leg.run, max(3, int(leg.run / 2) + 2))
        points = leg.a[:2] + np.outer(along / leg.run, leg.b[:2] - leg.a[:2])
        z = self.heights(leg, along)
        drift = leg.loose * (1 - along / leg.run)
        blur = leg.blur * (1 - np.clip(along / max(leg.run, 1), 0, 1)) if leg.blur else 0 * along
        if leg.style == "terrain":
            blur = blur + 8.0
        elif self.rate_needed(leg) > self.rate(leg.b[2] - leg.a[2]):
            blur = blur + abs(leg.b[2] - leg.a[2])
        kept = (along >= max(leg.before, leg.loose)) & (along <= leg.run - leg.early)
        if kept.any():
            piece = Piece(leg.item.number, phase, at_height(points, z)[kept], drift[kept], blur[kept], self.time[0])
            self.pieces.append(piece)
        self.chord(leg, phase, points, z, along)

    last = None

    def chord(self, leg, phase, points, z, along):
        if self.last is not None and leg.before > 1 and not leg.loose and leg.run > leg.before:
            start = self.last
            k = int(np.searchsorted(along, leg.before))
            end = np.array([*points[min(k, len(points) - 1)], z[min(k, len(z) - 1)]])
            spread = abs(start[2] - leg.a[2]) + abs(end[2] - leg.a[2])
            chord = samples(start, end)
            # A turn is tighter than its chord: somewhere between that and the legs.
            from_corner = chord[:, :2] - leg.a[:2]
            to_legs = []
            for other in (start, end):
                way = (other - leg.a)[:2] / max(1e-9, math.dist(other[:2], leg.a[:2]))
                along_it = np.clip(from_corner @ way, 0, None)
                to_legs.append(np.linalg.norm(from_corner - np.outer(along_it, way), axis=1))
            aside = np.minimum(*to_legs)
            self.pieces.append(Piece(leg.item.number, phase, chord, aside + 0.5, spread + 0.5, self.time[0]))
        k = int(np.searchsorted(along, leg.run - leg.early, side="right")) - 1
        self.last = np.array([*points[k], z[k]])

    def band(self, leg, phase):
        """Both ways of climbing; corners of the fastest flight; what a circle at the item needs."""
        coarse = samples(leg.a, leg.b, BAND_SAMPLE_M)
        along = np.linspace(0, leg.run, len(coarse))
        low, high = min(leg.a[2], leg.b[2]) - leg.blur, max(leg.a[2], leg.b[2]) + leg.blur
        near = np.minimum(along, leg.run - along) < self.wide_until
        for part, radius in ((coarse[near], self.widest(leg)), (coarse[~near], 30.0 + leg.loose)):
            if len(part):
                self.cover(leg.item, phase, part, low - 5, high + 5, radius)

    def rate_needed(self, leg):
        return abs(leg.b[2] - leg.a[2]) * self.speed / max(leg.run - self.ramp_ends, 1)

    # --- circles

    def fly_circle(self, item, place, z, radius, follows, is_forever, levels=None):
        """In from where it comes, round, and out to somewhere within the circle."""
        radius = max(radius, self.speed**2 / GRAVITY)
        if not self.starts:
            self.begin_in_flight(np.array([*place, z]))
        off = self.at[:2] - place
        away = math.hypot(*off)
        if away > radius + 60:
            edge = place + off / away * (radius + 25)
            portion = (away - radius - 25) / away
            style = self.circle_style(self.at, np.array([*place, z]), away)
            end = self.at[2] + (z - self.at[2]) * portion if style == "ramp" else self.at[2] if style == "level" else z
            self.inbound(item, place, edge, end, radius, style)
        slack = 0.0 if is_forever else abs(z - self.at[2]) + self.blur
        for level in levels or [z]:
            ring = at_height(ring_points(place, radius), level)
            self.pieces.append(Piece(item.number, "circle", ring, 0.01 * radius, slack if levels is None else 5.0,
                                     self.time[0]))
        low, high = min(self.at[2], z), max(self.at[2], z)
        disc = [place] + [ring_points(place, r, 30.0) for r in (radius, radius / 2)]
        self.cover(item, "circle", np.vstack(disc), low - 5 - self.blur, high + 5 + self.blur,
                   0.2 * radius + 60 + radius / 4)
        self.time += np.array([1, 0.5, 2]) * self.circle_seconds(item, radius)
        self.at, self.loose, self.blur, self.early = np.array([*place, z]), 1.3 * radius + 30, 5.0, 0.0
        self.last, self.pose, self.fresh = None, None, False

    def circle_seconds(self, item, radius):
        lap = 2 * math.pi * radius / self.speed
        return item.param(1) if item.command == 19 else lap * (item.param(1) + 1 if item.command == 18 else 2)

    def circle_style(self, a, b, run):
        return self.climbs(a, b, run)

    def inbound(self, item, place, edge, z, radius, style):
        self.fly_leg(item, edge, z, None, early=0.0, style=style)

    # --- landing and hovering

    def hover_down(self, item, place):
        """At the height of its start to the place, then down."""
        self.fly_leg(item, place, self.at[2], None, early=0.0, style="level")
        ground = self.ground_at(place)
        self.vertical(item, "landing", np.asarray(place), self.at[2], min(ground, self.at[2]), 1.0, 15.0)
        self.is_over = True

    def glide(self, item, place, z):
        """The slope ends at an aim point before the place, so heights near it are lower than the line."""
        if not self.starts:
            self.begin_in_flight(np.array([*place, z]))
        run = math.dist(self.at[:2], place)
        if run > 1:
            along = np.linspace(0, run, max(3, int(run / 2)))
            points = self.at[:2] + np.outer(along / run, np.asarray(place) - self.at[:2])
            heights = self.at[2] + (z - self.at[2]) * along / run
            drift = self.loose * (1 - along / run) + 1
            kept = along >= max(self.early, self.loose)
            if kept.any():
                slack = 8.0 + self.blur + abs(self.at[2] - z) * 0.2
                self.pieces.append(Piece(item.number, "landing", at_height(points, heights)[kept], drift[kept], slack,
                                         self.time[0]))
        self.doubts.append("not judged beyond the landing point")
        self.is_over = True

    def vertical_takeoff(self, item, z):
        place = self.at[:2].copy()
        self.vertical(item, "takeoff", place, self.at[2], z, 2.5, 15.0)
        self.at[2], self.starts, self.fresh = z, True, True
        self.early = self.loose = self.blur = 0.0
        self.last = self.pose = None

    def unknown_leg(self, item, reason):
        """The next leg begins nobody knows where."""
        self.doubts.append(f"item {item.number}: {reason}")
        self.is_over = True


class ArduPlane(PlaneWalk):
    cruise, slowest_rate, ramp_ends, wide_until = 12.0, 2.0, 0.0, 260.0

    def rate(self, change):
        return 5.0

    def change_speed(self, item):
        """Type 1 only raises the speed; others must lie within AIRSPEED_MIN and MAX."""
        kind, value = int(item.param(1)), item.param(2)
        if kind == 0 and value == -2:
            self.speed = self.cruise
        elif kind == 0 and 9 <= value <= 22:
            self.speed = value
        elif kind == 1 and value > self.speed:
            self.speed = min(value, FASTEST)

    def corner(self, item, b, follows):
        if item.command != 16 or self.passes(item):
            return 0.0
        if item.param(2) >= 1:
            return float(min(math.floor(item.param(2)), 255))
        angle = 90.0
        if follows is not None and follows.command in POSITIONS and not follows.nowhere:
            angle = min(bend(self.at, b, np.array([*follows.place, 0])), 90)
        ratio = true_airspeed(b[2]) if self.choice in ("steered", "weak") else 1.0
        return min(90.0 * ratio**2, l1_length(self.speed * ratio)) * angle / 90

    def passes(self, item):
        return min(math.floor(max(item.param(3), 0)), 255)

    def widest(self, leg):
        given = leg.item.param(2) if leg.item.command == 16 else 0
        return max(90.0, min(given, 255), leg.before) + FASTEST**2 / GRAVITY + leg.loose

    def climbs(self, a, b, run):
        change = b[2] - a[2]
        if abs(change) < 15 or (change > 0 and a[2] < self.home[2] + 25):
            return "slowly" if self.choice == "slow climbs" else "at once"
        return "ramp"

    def do_16(self, item, follows):
        self.was_circle = False
        if item.nowhere:
            return self.unknown_leg(item, "waypoint at 0, 0")
        place, z = item.place.copy(), self.height_of(item, item.place)
        style = None
        if item.frame in (10, 11):
            self.doubts.append("heights above terrain")
            if math.isnan(float(self.world.ground(place))):
                return self.unknown_leg(item, "terrain beyond the grid")
            style = "terrain"
        beyond = self.passes(item)
        if beyond and not style and self.starts and math.dist(place, self.at[:2]) > 1:
            place = place + beyond * (place - self.at[:2]) / math.dist(place, self.at[:2])
        if self.fresh:  # after a vertical take-off it is not said from where its ramp begins
            self.blur += abs(z - self.at[2])
        leg = self.fly_leg(item, place, z, follows, style=style)
        if leg is not None:
            self.check_slope(leg)
            self.steer(leg)
        return None

    def check_slope(self, leg):
        if leg.style == "ramp" and self.rate_needed(leg) > 1.1 * 5.0:
            self.faults.append(f"item {leg.item.number}: steeper than it can climb")

    def steer(self, leg):
        """The same leg by the L1 law, from wherever the leg before was left."""
        if self.choice not in ("steered", "weak") or leg.loose or self.loose:
            self.pose = None
            return
        way = (leg.b[:2] - leg.a[:2]) / leg.run
        if self.pose is None or self.pose[1] is None:
            self.pose = (leg.a[:2] + way * leg.before, way)
        strength = WEAK if self.choice == "weak" else 1.0
        points = l1_track(self.pose, leg.a[:2], leg.b[:2], leg.early, self.speed * true_airspeed(leg.b[2]), strength)
        if points is None:
            self.pose = None
            return
        self.pose = (points[-1], points[-1] - points[-2])
        along = (points - leg.a[:2]) @ way
        z = self.heights(leg, np.clip(along, 0, leg.run))
        blur = np.where(along < 80, abs(leg.b[2] - leg.a[2]) + leg.blur, leg.blur + 0.5)
        self.pieces.append(Piece(leg.item.number, "leg", at_height(points, z), 2.0, blur, self.time[0]))

    def radius(self, item):
        """Only the sign of a loiter for a time is stored."""
        value = {31: item.param(2), 19: 0}.get(item.command, item.param(3))
        value = float(math.floor(abs(value)))
        return 60.0 if value <= 1 else value

    def circle(self, item, follows, is_forever):
        if item.frame in (10, 11):
            return self.unknown_leg(item, "heights above terrain")
        if self.was_circle:
            return self.unknown_leg(item, "a circle after a circle may count as reached")
        place = self.place_of(item)
        # The radius grows with the square of the true airspeed.
        radius, z = self.radius(item), self.height_of(item, place)
        if self.choice in ("steered", "weak"):
            radius *= true_airspeed(z) ** 2
        self.fly_circle(item, place, z, radius, follows, is_forever)
        self.is_over, self.was_circle = is_forever, item.command != 17
        return None

    was_circle = False

    def do_17(self, item, follows):
        self.circle(item, follows, True)

    def do_18(self, item, follows):
        self.circle(item, follows, False)

    do_19 = do_31 = do_18

    def do_22(self, item, follows):
        """Nobody knows the course, nor how far it takes."""
        self.doubts.append("take-off along an unknown course")
        self.at[2] = self.height_of(item, self.at[:2])

    def do_21(self, item, follows):
        if item.nowhere or item.frame in (10, 11):
            return self.unknown_leg(item, "landing at 0, 0 or above terrain")
        self.glide(item, item.place, self.height_of(item, item.place))
        return None

    def do_20(self, item, follows):
        self.circle_at_home(item)

    def end(self):
        items = self.mission.items
        if items:
            self.circle_at_home(items[-1])

    def circle_at_home(self, item):
        """The nearest rally point within 5 km, home only if there is none; 100 m above home."""
        if not self.starts:
            return None
        goal, z = self.home[:2].copy(), self.home[2] + 100
        near = sorted(math.dist(r[:2], self.at[:2]) for r in self.mission.rally)
        if near and near[0] < 4900:
            rally = min(self.mission.rally, key=lambda r: math.dist(r[:2], self.at[:2]))
            goal, z = np.array(rally[:2]), self.home[2] + rally[2]
            if len(near) > 1 and near[1] - near[0] < 200:
                return self.unknown_leg(item, "which rally point is nearest")
        elif near and near[0] < 5100:
            return self.unknown_leg(item, "whether the rally point is near enough")
        style = ("slowly" if self.choice == "slow climbs" else "at once") if z > self.at[2] else "ramp"
        self.loose = max(self.loose, self.early, l1_length(self.cruise))
        self.early, self.speed, self.returns = 0.0, self.cruise, style
        self.fly_circle(item, goal, z, 60.0, None, True)
        self.is_over = True
        return None

    returns = None

    def circle_style(self, a, b, run):
        return self.returns or self.climbs(a, b, run)


def l1_track(pose, a, b, early, speed, strength=1.0):
    """Until the item counts as reached; None if that takes too long."""
    place, way = np.array(pose[0], float), pose[1]
    run = math.dist(a, b)
    along = (b - a) / run
    left = np.array([-along[1], along[0]])
    course = math.atan2(way @ left, way @ along)  # from the line, to the left
    length, gain = l1_length(speed), 4 * L1_DAMPING**2
    s, e = (place - a) @ along, (place - a) @ left
    track = []
    for _ in range(int((3 * run / speed + 60) / STEP_S)):
        track.append((s, e))
        if s >= run or math.hypot(run - s, e) <= early:
            break
        towards = -min(max(math.asin(min(max(e / length, -1), 1)), -math.pi / 4), math.pi / 4)
        off = math.remainder(towards - course, 2 * math.pi)
        sideways = gain * speed**2 / length * math.sin(min(max(off, -math.pi / 2), math.pi / 2))
        course += strength * min(max(sideways, -GRAVITY), GRAVITY) / speed * STEP_S
        s, e = s + speed * math.cos(course) * STEP_S, e + speed * math.sin(course) * STEP_S
    else:
        return None
    return a + np.array(track) @ np.array([along, left]) if len(track) > 1 else None


class QuadPlane(ArduPlane):
    def do_22(self, item, follows):
        """The number is the height above the present place, whatever the frame says."""
        if self.starts:
            self.doubts.append("vertical take-off in flight")
        self.vertical_takeoff(item, self.at[2] + item.alt)

    do_84 = do_22

    def do_21(self, item, follows):
        self.hover_down(item, self.place_of(item))

    do_85 = do_21

    def do_94(self, item, follows):
        self.hover_down(item, self.place_of(item))
        self.doubts.append("what follows a payload placed")

    def do_3000(self, item, follows):
        if int(item.param(1)) == 3:
            self.unknown_leg(item, "hovers from here on")


class Px4Plane(PlaneWalk):
    cruise, slowest_rate, ramp_ends, wide_until = 15.0, 2.0, 80.0, 340.0

    def rate(self, change):
        return 3.0 if change > 0 else 2.0

    def change_speed(self, item):
        self.speed = min(max(item.param(2), 10), 20) if item.param(2) > 0 else self.cruise

    def corner(self, item, b, follows):
        return max(10.0, 2.24 * self.speed) if item.command == 16 else 0.0

    def widest(self, leg):
        return 170.0 + leg.loose

    def climbs(self, a, b, run):
        if run < 80 or self.fresh:
            return "at once"
        return "ramp"

    def do_16(self, item, follows):
        leg = self.fly_leg(item, item.place.copy(), self.height_of(item, item.place), follows)
        if leg is None:
            return
        change = abs(leg.b[2] - leg.a[2])
        low = self.rate_needed(leg) > self.rate(leg.b[2] - leg.a[2]) * 0.9
        if change > 5 and (low or leg.style == "at once"):
            # It circles at the item until it is high or low enough, and leaves from anywhere on the circle.
            self.cover(item, "circle", leg.b[None], min(leg.a[2], leg.b[2]) - 5, max(leg.a[2], leg.b[2]) + 5, 180.0)
            self.loose, self.blur, self.last = 180.0, 10.0, None
        if self.early and self.last is not None and change > 1:
            self.blur = max(self.blur, 1.0)

    def circle(self, item, follows, is_forever, z, radius, levels=None):
        self.fly_circle(item, item.place.copy(), z, radius, follows, is_forever, levels)
        self.is_over = is_forever

    def circle_style(self, a, b, run):
        return "at once"

    def inbound(self, item, place, edge, z, radius, style):
        """Straight on to the tangent: up to a radius off the line to the centre, at its end."""
        start, self.last = self.at.copy(), None
        way = np.array([*(edge - start[:2]), 0.0])
        leg = Leg(item, start, np.array([*edge, z]), 0.0, self.early, self.loose, self.blur, style)
        along = np.linspace(0, leg.run, max(3, int(leg.run / 2)))
        points = at_height(start[:2] + np.outer(along / leg.run, way[:2]), self.heights(leg, along))
        drift = leg.loose * (1 - along / leg.run) + (radius + 10) * along / leg.run
        kept = along >= max(leg.before, leg.loose)
        if kept.any():
            self.pieces.append(Piece(item.number, "leg", points[kept], drift[kept], leg.blur, self.time[0]))
        coarse = samples(leg.a, leg.b, BAND_SAMPLE_M)
        self.cover(item, "leg", coarse, min(leg.a[2], z) - 5 - leg.blur, max(leg.a[2], z) + 5 + leg.blur,
                   radius + 90 + leg.loose)

    def do_17(self, item, follows):
        self.circle(item, follows, True, self.height_of(item, item.place), abs(item.param(3)) or 80.0)

    def do_19(self, item, follows):
        self.circle(item, follows, False, self.height_of(item, item.place), abs(item.param(3)) or 80.0)

    def do_31(self, item, follows):
        """At the height of its start to the circle, and there down or up in turns."""
        z, now = self.height_of(item, item.place), self.at[2]
        radius = abs(item.param(2)) or 80.0
        if not self.starts:
            return self.unknown_leg(item, "loiter before take-off")
        self.circle(item, follows, False, now, radius)
        self.circle(item, follows, False, z, radius, levels=list(np.linspace(now, z, 6)))
        return None

    def do_22(self, item, follows):
        """Along the line to the item and beyond, until high enough."""
        place, z = item.place.copy(), self.height_of(item, item.place)
        way = place - self.at[:2]
        away = math.hypot(*way)
        if self.starts:
            return
        if away <= 12:
            self.unknown_leg(item, "take-off where it stands")
            return
        self.at[2] = max(self.at[2], self.ground_at(self.at[:2]))  # where it stands, wherever home is said to be
        rise = max(z - self.at[2], 0.0)
        near, far = (max(away, rise * self.speed / rate) for rate in (5.0, 2.0))
        reach = far if self.choice == "slow climbs" else near
        rate = 2.0 if self.choice == "slow climbs" else 5.0
        along = np.linspace(0, reach, int(reach / 2) + 2)
        heights = np.minimum(self.at[2] + rate / self.speed * along, z)
        points = self.at[:2] + np.outer(along / away, way)
        self.record(item, "climb", at_height(points, heights), self.speed)
        coarse = samples(self.at[:2], self.at[:2] + way / away * far, BAND_SAMPLE_M)
        self.cover(item, "climb", coarse, self.at[2], z + 10, 60.0)
        self.at, self.starts, self.fresh = np.array([*points[-1], z]), True, True
        self.loose, self.blur, self.early = 40.0, 5.0, 0.0
        if self.choice != "slow climbs":
            self.loose = 40.0 + far - near

    def do_21(self, item, follows):
        self.glide(item, item.place, self.height_of(item, item.place))

    def do_20(self, item, follows):
        self.unknown_leg(item, "return by the nearer of landing and home")


class Px4Vtol(Px4Plane):
    def do_84(self, item, follows):
        """Up where it stands, then ahead to the place; the transition may carry it past it."""
        place, z = item.place.copy(), self.height_of(item, item.place)
        if self.starts:
            return
        self.vertical_takeoff(item, z)
        away = math.dist(place, self.at[:2])
        if away < 5:
            self.unknown_leg(item, "transition in an unknown direction")
            return
        start = self.at.copy()
        self.straight(item, "leg", start, np.array([*place, z]), self.speed, 100.0, across=1.0, heights=3.0)
        run = 15 * 20.0
        beyond = start[:2] + (place - start[:2]) / away * max(away, run)
        self.cover(item, "leg", samples(place, beyond, BAND_SAMPLE_M), z - 10, z + 10, 100.0)
        self.at = np.array([*place, z])
        self.loose, self.blur, self.last = max(run - away, 0) + 40, 5.0, None

    def do_22(self, item, follows):
        self.unknown_leg(item, "take-off of a VTOL as a plane or copter")

    def do_85(self, item, follows):
        self.hover_down(item, item.place.copy())

    do_21 = do_85

    def do_3000(self, item, follows):
        self.unknown_leg(item, "transition")

    def end(self):
        self.doubts.append("circles where the list ends")
