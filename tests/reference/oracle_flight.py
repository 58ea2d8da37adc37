# SPDX-License-Identifier: Apache-2.0
"""Paths that a vehicle may fly for a mission, as dense samples, and the band that holds all of them. What is
common to copters and planes, and the two copters."""
import math

import numpy as np

from oracle_commands import POSITIONS, code

SAMPLE_M, BAND_SAMPLE_M = 2.0, 5.0
SAMPLES_MOST = 25000  # 50 km
DATUM_M = 10.0  # heights above the sea, as measured in flight
AC_RADIUS_MOST, PX_RADIUS_MOST = 10.0, 10.0  # WP_RADIUS_M and NAV_ACC_RAD at most, by section 8
EARTH_M = 6371000.0
BLENDED = {16, 17, 19, 36, 82, 94}  # ArduCopter: next items before which it need not stop


class Piece:
    """Samples of a path: places, height, how far each may be off, and when it is reached."""

    def __init__(self, item, phase, points, across, heights, times):
        self.item, self.phase, self.points = item, phase, points
        self.across, self.heights, self.times = (np.broadcast_to(v, len(points)) for v in (across, heights, times))


class Tube:
    """Part of the band: within `radius` of the places, between two heights; earliest and latest."""

    def __init__(self, item, phase, places, low, high, radius, times):
        self.item, self.phase, self.places, self.radius, self.times = item, phase, places, radius, times
        self.low, self.high = (np.broadcast_to(v, len(places)) for v in (low, high))


def samples(a, b, step=SAMPLE_M):
    count = max(2, min(int(math.dist(a, b) / step) + 2, SAMPLES_MOST))
    return np.asarray(a) + np.linspace(0, 1, count)[:, None] * (np.asarray(b, float) - np.asarray(a))


def ring_points(centre, radius, step=SAMPLE_M):
    angles = np.linspace(0, 2 * math.pi, max(24, int(2 * math.pi * radius / step)))
    return np.asarray(centre)[:2] + radius * np.stack([np.cos(angles), np.sin(angles)], 1)


def at_height(places, heights):
    return np.column_stack([places, np.broadcast_to(heights, len(places))])


class Walk:
    """Goes through the items as one possible flight (`choice`); what is not known becomes a doubt, and the
    part of the path that depends on it is left out of `pieces` but is in `tubes` where its bounds are known."""

    hover = True

    def __init__(self, mission, order, world, choice):
        self.mission, self.order, self.world, self.choice = mission, order, world, choice
        self.pieces, self.tubes = [], []
        self.doubts, self.faults = list(order.doubts), []
        self.home = np.array(mission.home)
        self.at, self.above = self.home.copy(), None  # above: height over ground, where that is what is held
        self.time = np.zeros(3)  # nominal, fastest, slowest
        self.is_over, self.flies = False, False
        self.datum = 0.0

    def run(self):
        steps = self.order.steps
        for n, item in enumerate(steps):
            follows = next((s for s in steps[n + 1:] if s.command in POSITIONS or s.command == 20), None)
            self.step(item, follows)
            if self.is_over:
                break
        else:
            if self.order.never_ends:
                self.doubts.append("never ends")
            else:
                self.end()
        return self

    def step(self, item, follows):
        does = code(item.command, self.mission.kind)
        if does == "S":
            self.change_speed(item)
        elif does == "H":
            self.set_home(item)
        elif does == "D":
            self.delay(item)
        elif does == "V" and self.mission.is_px4 and item.nowhere and item.command in POSITIONS:
            self.unknown_from_here(item, does)  # really to 0 N 0 E: refused
        elif does in "?EUX" or (does == "P" and item.command in (210, 4501)):
            self.unknown_from_here(item, does)
        elif does == "V":
            self.datum = DATUM_M if item.frame in (0, 2, 5) else 0.0
            getattr(self, f"do_{item.command}", self.unknown)(item, follows)
            self.flies = True
            if item.command not in (21, 85, 20) and self.mission.is_px4 and not item.goes_on:
                self.is_over = True

    def unknown(self, item, follows):
        self.unknown_from_here(item, "V")

    def unknown_from_here(self, item, does):
        inert = {208: item.param(1) != 2, 223: item.param(1) != 0, 400: item.param(1) != 0,
                 92: item.param(1) < 1}
        if not inert.get(item.command, False):
            self.doubts.append(f"item {item.number}: command {item.command}")
            self.is_over = True

    def set_home(self, item):
        if item.param(1) == 1 or item.nowhere:
            self.home = self.at.copy()
        else:
            base = self.home[2] if item.frame in (3, 6) else 0
            self.home = np.array([*item.place, base + item.alt])
        self.doubts.append("home is moved in flight")

    def delay(self, item):
        if item.param(1) <= 0:
            self.doubts.append("delay until a time of day")
        if self.hover or self.mission.is_px4:
            self.time += max(item.param(1), 0)
            self.time[2] += 5

    # --- recording

    def spend(self, length, speed):
        """Times over the length: no wind in the nominal one, starts and stops in the slowest."""
        rates = np.array([1, 1 if self.hover else 0.5, 2]) / speed
        times = self.time[:, None] + rates[:, None] * length
        times[2] += 20
        self.time = times[:, -1].copy()
        return times

    def record(self, item, phase, points, speed, across=0.0, heights=0.0, sampled=True):
        lengths = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        times = self.spend(lengths, speed)
        if sampled:
            self.pieces.append(Piece(item.number, phase, points, across, heights, times[0]))
        return times[1, 0], times[2, -1]

    def cover(self, item, phase, points, low, high, radius, times=None):
        """The band may be sampled more coarsely; half a step is added to its radius."""
        points = np.asarray(points)[:, :2]
        if times is None:
            times = (self.time[1], self.time[2])
        self.tubes.append(Tube(item.number, phase, points, np.asarray(low) - 3 - self.datum,
                               np.asarray(high) + 3 + self.datum, radius + 3 + BAND_SAMPLE_M / 2, times))

    def vertical(self, item, phase, place, z0, z1, speed, radius):
        points = at_height(np.array([place, place]), [z0, z1])
        count = max(2, int(abs(z1 - z0) / SAMPLE_M) + 2)
        points = np.column_stack([np.repeat([place], count, 0), np.linspace(z0, z1, count)])
        times = self.record(item, phase, points, speed)
        self.cover(item, phase, points[:1], min(z0, z1), max(z0, z1), radius, times)

    def straight(self, item, phase, a, b, speed, radius, **slack):
        points = samples(a, b)
        times = self.record(item, phase, points, speed, **slack)
        self.bow(item, phase, points)
        coarse = samples(a, b, BAND_SAMPLE_M)
        self.cover(item, phase, coarse, coarse[:, 2], coarse[:, 2], radius + sagitta(a, b, self.world.lat), times)

    def bow(self, item, phase, points):
        """Over long legs the great circle is as good a straight line; it lies nearer to the pole."""
        bent = sagitta(points[0], points[-1], self.world.lat)
        if bent > 0.5:
            t = np.linspace(0, 1, len(points))
            bowed = points + np.outer(4 * bent * t * (1 - t), [0, math.copysign(1, self.world.lat), 0])
            self.pieces.append(Piece(item.number, phase, bowed, 0.0, 0.0, self.time[0]))

    # --- places and heights

    def place_of(self, item):
        return self.at[:2].copy() if item.nowhere else item.place.copy()

    def height_of(self, item, place):
        if item.frame in (10, 11):
            if math.isnan(float(self.world.ground(place))):
                self.doubts.append("terrain beyond the grid")
            return self.ground_at(place) + item.alt
        return item.alt + (self.home[2] if item.frame in (3, 6) else 0)

    def ground_at(self, place):
        ground = float(self.world.ground(place))
        return self.home[2] if math.isnan(ground) else ground

    def end(self):
        pass


def sagitta(a, b, lat):
    """By how much the meanings of a straight line differ; only east-west runs bend."""
    across = b[0] - a[0]
    if math.dist(a[:2], b[:2]) < 5000:
        return 0.0
    return across * across * abs(math.tan(math.radians(lat))) / (8 * EARTH_M)


class CopterWalk(Walk):
    """What ArduCopter and PX4 multirotors share: vertical climbs and descents, straight legs."""

    def climb(self, item, phase, z1):
        speed = self.up if z1 > self.at[2] else self.down
        self.vertical(item, phase, self.at[:2], self.at[2], z1, speed, self.reach(item))
        self.at[2], self.above = z1, None

    def fly_to(self, item, place, z, phase="leg", **slack):
        to = np.array([*place, z])
        self.straight(item, phase, self.at, to, self.leg_speed(to), self.reach(item), **slack)
        self.at = to

    def leg_speed(self, to):
        """Slower on steep legs, so that climb and descent keep their limits."""
        run, rise = math.dist(self.at[:2], to[:2]), to[2] - self.at[2]
        limit = self.up if rise > 0 else self.down
        length = math.hypot(run, rise)
        if abs(rise) < 1e-9:
            return self.speed
        return min(self.speed * length / max(run, 1e-9), limit * length / abs(rise))

    def touch_down(self, item, place):
        self.fly_to(item, place, self.at[2])
        ground = min(self.ground_at(place), self.at[2])
        self.vertical(item, "landing", place, self.at[2], ground, 0.5, self.reach(item))
        self.is_over = True

    def come_home(self, item, height, z, place):
        self.climb(item, "return", z)
        self.above = None
        self.fly_to(item, place, z, "return")
        self.vertical(item, "landing", place, z, min(height, z), 0.5, self.reach(item))
        self.is_over = True


class ArduCopter(CopterWalk):
    up, down, speed = 2.5, 1.5, 10.0

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.tangent = np.zeros(3)  # of the leg before, where it was not stopped
        self.before = self.at.copy()

    def reach(self, item):
        return AC_RADIUS_MOST

    def change_speed(self, item):
        value = item.param(2)
        if value > 0:
            name = {0: "speed", 1: "speed", 2: "up", 3: "down"}.get(int(item.param(1)))
            if name:
                setattr(self, name, value)

    def target(self, item, alt0=True):
        """Height 0 keeps the height before, 0, 0 the place before."""
        place = self.place_of(item)
        if alt0 and item.alt == 0:
            if self.above is not None or item.frame in (10, 11):
                self.doubts.append(f"item {item.number}: height 0 with terrain")
            return place, self.at[2], self.above
        return place, self.height_of(item, place), item.alt if item.frame in (10, 11) else None

    def leg(self, item, place, z, above):
        """Above terrain the heights over ground are interpolated, not those above the sea."""
        self.before = self.at.copy()
        if not self.flies and self.at[2] <= self.home[2]:
            self.doubts.append("no take-off")
            self.at = np.array([*place, z])
        elif above is None:
            self.fly_to(item, place, z)
        else:
            self.follow_ground(item, place, above)
        self.above = above

    def follow_ground(self, item, place, above):
        start = self.above if self.above is not None else self.at[2] - self.ground_at(self.at[:2])
        plan = samples(self.at[:2], place)
        ground = self.world.ground(plan)
        if np.isnan(ground).any():
            self.doubts.append("terrain beyond the grid")
            ground = np.nan_to_num(ground, nan=self.home[2])
        heights = ground + np.linspace(start, above, len(plan))
        points = at_height(plan, heights)
        times = self.record(item, "leg", points, self.speed)
        self.cover(item, "leg", points, heights - 10, heights + 10, self.reach(item), times)
        self.at = points[-1].copy()

    def flows(self, item, follows):
        return item.param(1) == 0 and follows is not None and follows.command in BLENDED \
            and (follows.frame in (10, 11)) == (item.frame in (10, 11))

    def do_22(self, item, follows):
        self.climb(item, "takeoff", max(self.height_of(item, self.at[:2]), self.at[2] + 1))
        self.tangent = np.zeros(3)

    do_84 = do_22

    def do_16(self, item, follows):
        self.leg(item, *self.target(item))
        self.tangent = self.at - self.before if self.flows(item, follows) else np.zeros(3)
        self.time += item.param(1)

    def do_17(self, item, follows):
        self.do_16(item, follows)
        self.is_over = True

    do_19 = do_16

    def do_18(self, item, follows):
        place, z, above = self.target(item)
        turns, radius = item.param(1), float(math.floor(abs(item.param(3))))
        radius = radius if radius <= 255 else min(math.floor(radius / 10) * 10.0, 2000)
        turns = math.floor(turns) if turns >= 1 else turns
        self.tangent = np.zeros(3)
        if above is not None or self.above is not None:
            self.doubts.append("circle above terrain")
        if radius < 1:
            return self.turn_on_the_spot(item, place, z)
        off = self.at[:2] - place
        if math.hypot(*off) <= 0.5:
            return self.circle_from_the_centre(item, place, z, radius)
        angle = math.atan2(off[1], off[0])
        self.leg(item, place + radius * np.array([math.cos(angle), math.sin(angle)]), z, None)
        sweep = -math.copysign(2 * math.pi * (turns if turns > 0 else 1), item.param(3))
        angles = angle + np.linspace(0, sweep, max(16, int(abs(sweep) * radius / SAMPLE_M)))
        ring = place + radius * np.stack([np.cos(angles), np.sin(angles)], 1)
        times = self.record(item, "circle", at_height(ring, z), min(self.speed, math.sqrt(1.25 * radius)))
        self.cover(item, "circle", ring_points(place, radius, BAND_SAMPLE_M), z, z, self.reach(item), times)
        # Turns are counted of a point that the vehicle is up to two seconds behind.
        speed = min(self.speed, math.sqrt(1.25 * radius), math.radians(20) * radius)
        early = 2 * speed if self.choice == "leaves early" else 0.0
        left = angle + math.copysign(max(abs(sweep) - early / radius, 0), sweep)
        self.at = np.array([*(place + radius * np.array([math.cos(left), math.sin(left)])), z])

    def turn_on_the_spot(self, item, place, z):
        """Section 1 says that the height does not change; its leg there may still be flown to it."""
        self.doubts.append("circle of radius 0")
        other, now = z, self.at[2]
        self.leg(item, place, now, None)
        self.cover(item, "leg", self.at[None], min(other, now), max(other, now), self.reach(item))

    def circle_from_the_centre(self, item, place, z, radius):
        self.doubts.append("circle entered from its centre")
        times = self.record(item, "circle", at_height(ring_points(place, radius), z), self.speed)
        self.cover(item, "circle", place[None], min(z, self.at[2]), max(z, self.at[2]), radius + 10, times)
        self.at = np.array([*place, z])
        self.is_over = True  # where it leaves the circle is not known

    def do_31(self, item, follows):
        place, z, above = self.target(item)
        self.leg(item, place, z, above)
        if item.alt == 0:
            self.climb(item, "leg", self.height_of(item, place))
        self.tangent = np.zeros(3)

    def do_21(self, item, follows):
        if self.above is not None:
            self.doubts.append("landing after terrain")
        if not self.flies:
            self.doubts.append("no take-off")
        self.touch_down(item, self.place_of(item))

    do_85 = do_21

    def do_94(self, item, follows):
        place, z = self.place_of(item), self.at[2]
        self.fly_to(item, place, z)
        ground = self.ground_at(place)
        low = ground if item.param(1) <= 0 else max(ground, z - item.param(1))
        self.vertical(item, "landing", place, z, low, 1.0, self.reach(item))
        self.vertical(item, "landing", place, low, z, 1.0, self.reach(item))
        self.tangent = np.zeros(3)

    def do_36(self, item, follows):
        place, z, above = self.target(item)
        turn = math.radians(math.trunc(item.param(1)))
        if abs(turn) < math.radians(1) or math.dist(place, self.at[:2]) < 1:
            return self.do_16(item, follows)
        if abs(turn) > math.radians(350) or above is not None or self.above is not None:
            return self.unknown_from_here(item, "V")
        points = arc(self.at, np.array([*place, z]), turn)
        self.curve(item, points)
        self.tangent = np.full(3, np.nan)

    def do_82(self, item, follows):
        place, z, above = self.target(item)
        if above is not None or self.above is not None or np.isnan(self.tangent).any():
            return self.unknown_from_here(item, "V")
        to = np.array([*place, z])
        leaves = np.zeros(3)
        if self.flows(item, follows):
            next_place = place if follows.nowhere else follows.place
            next_z = z if follows.alt == 0 else self.height_of(follows, next_place)
            leaves = np.array([*next_place, next_z]) - (self.at if follows.command == 82 else to)
        points = spline(self.at, to, self.tangent, leaves)
        self.curve(item, points)
        self.tangent = leaves
        self.time += item.param(1)

    def curve(self, item, points):
        if not self.flies:
            self.doubts.append("no take-off")
            self.at = points[-1].copy()
            return
        times = self.record(item, "leg", points, self.speed)
        self.cover(item, "leg", points, points[:, 2], points[:, 2], self.reach(item), times)
        self.before, self.at = self.at, points[-1].copy()

    def do_20(self, item, follows):
        """The nearest rally point within 300 m, or home."""
        goal, least = self.home, 0.0
        near = min(self.mission.rally, key=lambda r: math.dist(r[:2], self.at[:2]), default=None)
        if near is not None:
            away = math.dist(near[:2], self.at[:2])
            if away < min(300, math.dist(self.home[:2], self.at[:2])):
                goal, least = np.array(near), near[2]
            if abs(away - 300) < 5 or abs(away - math.dist(self.home[:2], self.at[:2])) < 2:
                self.doubts.append("which rally point is nearest")
                self.is_over = True
                return
        if not self.flies:
            self.doubts.append("no take-off")
        now, away = self.at[2] - self.home[2], math.dist(goal[:2], self.at[:2])
        height = max(now, 15, least)
        height = max(min(height, max(3 * away, now)), 0.3)
        floor = self.home[2] if goal is self.home else self.ground_at(goal[:2])
        self.come_home(item, floor, self.home[2] + height, goal[:2].copy())


def arc(a, b, turn):
    """Clockwise for a positive turn; the heading to a place on it changes by half of what is flown."""
    chord = b[:2] - a[:2]
    bearing, sign = math.atan2(chord[0], chord[1]), math.copysign(1, turn)
    radius = math.hypot(*chord) / (2 * math.sin(abs(turn) / 2))
    flown = np.linspace(0, abs(turn), max(16, int(radius * abs(turn) / SAMPLE_M)))
    heading = bearing - sign * (abs(turn) - flown) / 2
    far = 2 * radius * np.sin(flown / 2)
    z = a[2] + (b[2] - a[2]) * flown / abs(turn)
    return np.column_stack([a[0] + far * np.sin(heading), a[1] + far * np.cos(heading), z])


def spline(a, b, begins, ends):
    both, chord = np.linalg.norm(begins) + np.linalg.norm(ends), np.linalg.norm(b - a)
    if both > 4 * chord:
        begins, ends = (v * 4 * chord / both for v in (begins, ends))
    t = np.linspace(0, 1, max(32, int(3 * chord / SAMPLE_M)))[:, None]
    ends_part = (3 * t**2 - 2 * t**3) * b + (t**3 - t**2) * ends
    return (2 * t**3 - 3 * t**2 + 1) * a + (t**3 - 2 * t**2 + t) * begins + ends_part


class Px4Copter(CopterWalk):
    up, down, speed = 3.0, 1.5, 5.0

    def reach(self, item):
        return max(item.param(2) if item.command == 16 else 0, PX_RADIUS_MOST)

    def change_speed(self, item):
        self.speed = min(item.param(2), 12) if item.param(2) > 0 else 5.0

    def go(self, item, z=None, stops=True):
        """From the ground it climbs where it stands to the first item's height. Holds are flown to their
        place itself, others to within their radius."""
        place = item.place.copy()
        z = self.height_of(item, place) if z is None else z
        if not self.flies and z > self.at[2] + 0.8:
            self.climb(item, "takeoff", z)
        radius = 0.0 if stops else item.param(2) or 2.0
        a, b = self.at.copy(), np.array([*place, z])
        length = math.dist(a, b)
        self.fly_to(item, place, z, sampled=False)
        self.around(item, a, b, radius, length)

    def around(self, item, a, b, radius, length):
        """Within the acceptance radius of either end the path is not known, but for the chord."""
        points = samples(a, b)
        away = np.minimum(np.linalg.norm(points - a, axis=1) - self.late,
                          np.linalg.norm(points - b, axis=1) - radius)
        kept = points[away >= 0]
        if length > 0 and len(kept):
            self.pieces.append(Piece(item.number, "leg", kept, 0.0, 0.0, self.time[0]))
        if self.corner is not None and min(length, self.corner[2]) > 2.5 * self.late and self.late > 0:
            start = self.corner[0] + (self.corner[1] - self.corner[0]) * (1 - self.late / self.corner[2])
            end = a + (b - a) * self.late / length
            self.pieces.append(Piece(item.number, "leg", samples(start, end), 0.0, 0.5, self.time[0]))
        self.corner = (a, b, length)
        self.late = radius

    late, corner = 0.0, None

    def do_22(self, item, follows):
        self.climb(item, "takeoff", self.height_of(item, self.at[:2]))
        self.flies = True
        self.go(item)

    def do_16(self, item, follows):
        self.go(item, stops=item.param(1) > 0 or follows is None or follows.command != 16)
        self.time += item.param(1)

    def do_17(self, item, follows):
        self.go(item)
        self.is_over = True

    def do_19(self, item, follows):
        self.go(item)
        self.time += item.param(1)

    def do_31(self, item, follows):
        if not self.flies:
            self.doubts.append("loiter before take-off")
        self.go(item, self.at[2])
        self.climb(item, "leg", self.height_of(item, item.place))

    def do_21(self, item, follows):
        self.touch_down(item, item.place.copy())

    def do_20(self, item, follows):
        """Home or the nearest safe point, if that is 2 m nearer."""
        away = math.dist(self.home[:2], self.at[:2])
        goal, floor = self.home[:2].copy(), self.home[2]
        for rally in self.mission.rally:
            near = math.dist(rally[:2], self.at[:2])
            if math.dist(rally[:2], self.home[:2]) > 10 and near < away + 4:
                self.doubts.append("which safe point is nearest")
                self.is_over = True
        if self.is_over:
            return
        if not self.flies:
            self.doubts.append("no take-off")
        z = max(self.at[2], floor + (30 if away > 12 else 0))
        if away <= 12:
            self.doubts.append("cone above home")
            self.is_over = True
        else:
            self.come_home(item, floor, z, goal)
