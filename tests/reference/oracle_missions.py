# SPDX-License-Identifier: Apache-2.0
"""Random missions over random hills: plausible ones, then changed in ways that autopilots take differently, with
fences and zones put where a path may be flown, or just beside it."""
import copy
import math

import numpy as np

import oracle_world
from oracle_commands import COPTERS, MAX_STEPS, POSITIONS, VTOLS, Mission, Order
from oracle_judge import Case
from oracle_flight import samples
from oracle_section9 import act, item, plan
from oracle_world import Zone, box, square

KIND_SHARES = (("AC", 5), ("AF", 3), ("QP", 3), ("PM", 5), ("PF", 3), ("PV", 3))
STEPS = {"AC": (40, 400), "PM": (40, 400), "AF": (350, 900), "QP": (350, 900), "PF": (350, 900), "PV": (350, 900)}
TAKEOFF = {"AC": 22, "PM": 22, "AF": 22, "QP": 84, "PF": 22, "PV": 84}
PLAIN = {3: [181, 183, 205, 206, 215], 12: [203, 205, 206, 211, 187, 530]}
ODD = [18, 23, 30, 36, 82, 83, 84, 92, 94, 115, 176, 180, 189, 191, 209, 216, 218, 223, 400, 2003, 3000, 42600, 42702,
       42703, 31000, 4501, 188]


class Maker:
    """One mission; heights are meant above the highest ground near it."""

    def __init__(self, rng, world):
        self.rng, self.world = rng, world
        kinds, shares = zip(*KIND_SHARES, strict=True)
        self.kind = rng.choices(kinds, shares)[0]
        self.home = np.array([rng.uniform(-600, 600), rng.uniform(-600, 600)])
        self.home_z = round(float(world.ground(self.home)), 2)
        self.is_px4 = self.kind[0] == "P"
        self.items, self.fences, self.rally = [], [], []

    def make(self):
        self.route()
        for _ in range(self.rng.choice([0, 0, 0, 1, 1, 2, 3])):
            self.rng.choice(CHANGES)(self)
        if self.rng.random() < 0.15:
            self.rally = [(*(self.home + self.around(400)), self.rng.choice([0, 30, 60]))
                          for _ in range(self.rng.choice([1, 2]))]
        if self.rng.random() < 0.25:
            self.keep_in()
        home_z = self.home_z + (self.rng.choice([-30, 15]) if self.rng.random() < 0.02 else 0)
        made = plan(self.kind, self.world, self.items, self.fences, self.rally, self.home, home_z)
        if self.kind in ("AC", "PM"):
            made["mission"]["vehicleType"] = self.rng.choice(sorted(COPTERS))
        elif self.kind in ("QP", "PV"):
            made["mission"]["vehicleType"] = self.rng.choice(sorted(VTOLS))
        return made

    def around(self, reach):
        angle, far = self.rng.uniform(0, 2 * math.pi), self.rng.uniform(0.1, 1) * reach
        return np.array([far * math.cos(angle), far * math.sin(angle)])

    def placed(self, command, place, z, p=(0, 0, 0, 0), frame=None):
        """A height above the sea, written in a frame."""
        frame = self.frame if frame is None else frame
        base = {0: 0.0, 3: self.home_z}.get(frame, float(self.world.ground(place)))
        return item(command, self.world, place, round(z - base, 2), frame, p)

    def route(self):
        rng, low, high = self.rng, *STEPS[self.kind]
        count, places = rng.randint(2, 6), [self.home]
        heading, swing = rng.uniform(0, 2 * math.pi), rng.choice([0.3, 1.0, 2.2])
        for _ in range(count):
            far = math.exp(rng.uniform(math.log(low), math.log(high)))
            nearest = [heading + rng.uniform(-swing, swing) for _ in range(6)]
            ends = [places[-1] + far * np.array([math.cos(a), math.sin(a)]) for a in nearest]
            best = min(range(6), key=lambda k: max(math.hypot(*ends[k]) - 2200, 0))
            heading = nearest[best]
            places.append(ends[best])
        drawn = np.vstack([np.linspace(a, b, 20) for a, b in zip(places, places[1:], strict=False)])
        top = np.nanmax(self.world.ground(drawn))
        self.z = max(top, self.home_z) + rng.choice([rng.uniform(-15, 30)] + 4 * [rng.uniform(30, 120)])
        self.z = max(self.z, self.home_z + 8)
        self.frame = rng.choice([3, 3, 3, 0])
        self.take_off(places[1])
        spread = rng.choice([0, 0, 6, 14, 40])
        for place in places[1:]:
            self.items.append(self.placed(16, place, max(self.z + rng.uniform(-spread, spread), self.home_z + 5)))
        self.finish(places)

    def take_off(self, first):
        if self.kind == "AF" and self.rng.random() < 0.8 or self.rng.random() < 0.03:
            return  # begun in flight; an aeroplane's take-off is not judged
        place = self.home + (first - self.home) * 0.5 if self.kind in ("PF", "PV") else self.home
        frame = 3 if self.kind == "QP" else None
        self.items.append(self.placed(TAKEOFF[self.kind], place, self.z, frame=frame))

    def finish(self, places):
        rng, last = self.rng, places[-1]
        if self.kind == "PF":
            before = places[-2]
            way = (last - before) / math.dist(last, before)
            above = float(self.world.ground(last + 900 * way)) if not self.gone(last + 900 * way) else self.home_z
            self.items[-1] = self.placed(16, last, above + 60)
            self.items.append(self.placed(21, last + 900 * way, above))
        elif self.kind == "PV":
            self.items.append(self.placed(rng.choice([85, 85, 21]), last + self.around(300), self.home_z))
        else:
            end = rng.choice(["return", "land", "nothing"])
            if end == "return":
                self.items.append(act(20))
            elif end == "land":
                command = 85 if self.kind == "QP" else 21
                self.items.append(self.placed(command, last + self.around(300), self.home_z))

    def gone(self, place):
        return math.isnan(float(self.world.ground(place)))

    def keep_in(self):
        """One or two that hold the whole route with room, or cut it."""
        rng = self.rng
        places = np.array([self.home] + [self.world.to_local(*e["params"][4:6]) for e in self.items
                                         if e["command"] in POSITIONS and e["params"][4]])
        low, high = places.min(0), places.max(0)
        for _ in range(rng.choice([1, 1, 2])):
            room = rng.choice([600, 600, 600, 20, -40])
            if rng.random() < 0.6:
                corners = box(*(low - room), *(high + room * np.array([1, 1])))
                self.fences.append((corners, True))
            else:
                middle = (low + high) / 2
                self.fences.append((middle, round(math.dist(low, high) / 2 + max(room, 20), 1), True))

    # --- changes

    def waypoints(self):
        return [entry for entry in self.items if entry["command"] == 16]

    def some(self):
        return self.rng.choice(self.waypoints() or self.items)

    def insert(self, entry):
        self.items.insert(self.rng.randint(1, len(self.items)), entry)


def hold(m):
    m.some()["params"][0] = m.rng.choice([0.5, 5, 30])


def acceptance(m):
    m.some()["params"][1] = m.rng.choice([1, 5, 30, 120, 255, 300])


def pass_by(m):
    m.some()["params"][2] = m.rng.choice([20, 100])


def height_zero(m):
    m.some()["params"][6] = 0


def nowhere(m):
    m.some()["params"][4:6] = [0, 0]


def takeoff_elsewhere(m):
    for entry in m.items:
        if entry["command"] in (22, 84):
            entry["params"][4:6] = m.world.to_degrees(*(m.home + m.around(400)))


def other_frame(m):
    entry = m.some()
    place, old = m.world.to_local(*entry["params"][4:6]), entry["frame"]
    if entry["command"] in POSITIONS and old in (0, 3) and entry["params"][4]:
        frame = m.rng.choice([0, 3, 10, 10])
        z = entry["params"][6] + (m.home_z if old == 3 else 0)
        entry.update(m.placed(entry["command"], place, z, entry["params"][:4], frame))


def all_over_ground(m):
    for entry in m.waypoints():
        entry.update(frame=10)
        entry["params"][6] = round(m.rng.uniform(20, 90), 2)


def loiter(m):
    entry = m.some()
    if entry["command"] != 16:
        return
    command = m.rng.choice([17, 18, 18, 19, 31, 31])
    radius = m.rng.choice([0, 0, 30, -40, 80, 150, 300.5])
    entry["command"] = command
    entry["params"][:4] = {17: [0, 0, radius, 0], 18: [m.rng.choice([0.5, 1, 2, 3]), 0, radius, m.rng.choice([0, 1])],
                           19: [m.rng.choice([10, 60]), 0, radius, m.rng.choice([0, 1])],
                           31: [m.rng.choice([0, 1]), radius, 0, m.rng.choice([0, 1])]}[command]
    if command == 31:
        entry["params"][6] = round(entry["params"][6] + m.rng.uniform(-20, 40), 2)


def jump(m):
    index = m.rng.randint(1, len(m.items))
    m.items.insert(index, act(177, m.rng.randint(1, index), m.rng.choice([1, 1, 2, 5, -1, 0])))
    if m.rng.random() < 0.1:
        m.items[index]["params"][0] = 99


def speed(m):
    m.insert(act(178, m.rng.choice([0, 0, 1, 1, 2, 3]), m.rng.choice([-2, 3, 9, 15, 20, 22, 30]), 0, 0))


def set_home(m):
    here = m.rng.random() < 0.5
    place = (0, 0) if here else m.world.to_degrees(*m.around(300))
    m.insert(act(179, 1 if here else 0, 0, 0, 0, *place, m.home_z))


def delay(m):
    m.insert(act(m.rng.choice([93, 112, 114]), m.rng.choice([5, 60, 300])))


def arc(m):
    entry = m.some()
    if entry["command"] == 16:
        entry["command"] = 36
        entry["params"][:4] = [m.rng.choice([-1, 1]) * m.rng.choice([30, 90, 120.7, 180, 270]), 0, 0, 0]


def splines(m):
    for entry in m.waypoints()[m.rng.choice([0, 1]):]:
        if m.rng.random() < 0.6:
            entry["command"] = 82


def plain(m):
    m.insert(act(m.rng.choice(PLAIN[12 if m.is_px4 else 3]), 0))


def odd(m):
    command = m.rng.choice(ODD)
    is_placed = command in POSITIONS or command == 4501
    entry = copy.deepcopy(m.some()) if is_placed else act(command, m.rng.choice([0, 1, 3]))
    entry["command"] = command
    m.insert(entry)


def stop(m):
    m.some()["autoContinue"] = False


def return_early(m):
    m.insert(act(20))


def land_early(m):
    m.insert(m.placed(21, m.home + m.around(300), m.home_z))


def reorder(m):
    m.items.insert(m.rng.randrange(len(m.items) + 1), m.items.pop(m.rng.randrange(len(m.items))))


def twice(m):
    m.insert(copy.deepcopy(m.some()))


def null(m):
    m.some()["params"][3] = None


CHANGES = [hold, acceptance, pass_by, height_zero, nowhere, takeoff_elsewhere, other_frame, all_over_ground,
           loiter, loiter, loiter, jump, jump, speed, speed, set_home, delay, delay, arc, splines, plain, plain, odd,
           stop, return_early, land_early, reorder, twice, null]


# --- a case


def worlds(rng, count):
    return [oracle_world.hills(rng, rng.choice([5, 40, 120, 200])) for _ in range(count)]


def obstacle(rng, case, walks):
    """A small zone or fence on a place that may be flown over, or at some distance from it."""
    pieces = [piece for walk in walks for piece in walk.pieces]
    if not pieces:
        return
    point, most = rng.choice(off_the_lines(case, pieces) if rng.random() < 0.6 else [None]) or (None, 60)
    if point is None:
        piece = rng.choice(pieces)
        point = piece.points[rng.randrange(len(piece.points))]
    half = math.exp(rng.uniform(math.log(min(4, most / 2)), math.log(min(most, 60))))
    aside = rng.choice([0, 0, 0, half + 30, half + 400])
    angle = rng.uniform(0, 2 * math.pi)
    x, y = point[0] + aside * math.cos(angle), point[1] + aside * math.sin(angle)
    if rng.random() < 0.35:
        corners = [list(case.world.to_degrees(*c)) for c in square(x, y, half, angle)]
        if rng.random() < 0.5:
            shape = {"inclusion": False, "version": 1, "polygon": corners}
            case.plan["geoFence"]["polygons"].append(shape)
        else:
            circle = {"center": list(case.world.to_degrees(x, y)), "radius": round(half, 1)}
            case.plan["geoFence"]["circles"].append({"inclusion": False, "version": 1, "circle": circle})
        return
    case.zones.append(zone_about(rng, case, square(x, y, half, angle), point))


def off_the_lines(case, pieces):
    """Places of paths that are not on the straight lines between the items, and how far from them these are:
    there a checker goes wrong that draws the mission."""
    world, home = case.world, case.plan["mission"]["plannedHomePosition"]
    drawn = [np.array([*world.to_local(*home[:2]), home[2]])]
    for entry in case.plan["mission"]["items"]:
        lat, lon, alt = entry["params"][4:7]
        if entry["command"] in POSITIONS and lat:
            place = world.to_local(lat, lon)
            base = {0: 0.0, 3: home[2]}.get(entry["frame"], float(world.ground(place)))
            drawn.append(np.array([*place, base + alt]))
    lines = np.vstack([samples(a, b, 15) for a, b in zip(drawn, drawn[1:], strict=False)] or [drawn])
    points = np.vstack([piece.points[::8] for piece in pieces])
    away = np.array([np.linalg.norm(lines - p, axis=1).min() for p in points])
    return [(p, d / 2) for p, d in zip(points, away, strict=True) if d > 16] or [None]


def zone_about(rng, case, ring, point):
    """At its height, or under or over it; over the sea or the ground; a few with hours."""
    z, datum = point[2], rng.choice(["AMSL", "AMSL", "AGL"])
    ground = float(case.world.ground(point[:2]))
    z = z - ground if datum == "AGL" else z
    how, thick = rng.choice(["at", "at", "at", "under", "over"]), rng.uniform(6, 40)
    floor = {"at": z - thick / 2, "under": z - thick - 40, "over": z + 40}[how]
    if datum == "AGL":
        floor = max(floor, 0)
    closed = oracle_world.ALWAYS
    if rng.random() < 0.1 and case.plan["mission"]["vehicleType"] in COPTERS:
        begin = rng.choice([-3600, round(rng.uniform(0, 300))])
        closed = (begin, round(begin + rng.uniform(60, 4000)))
    return Zone(ring, floor, max(floor + thick, 1.0), datum, closed)


def make(rng, world, name):
    """A case with its verdict; few of the plans may be flown too long to be sampled."""
    while True:
        made = Maker(rng, world).make()
        mission = Mission(made, world)
        if len(Order(mission).steps) < MAX_STEPS:
            break
    case = Case(made, world, name=name)
    if rng.random() < 0.3:
        case.min_agl = round(rng.uniform(3, 25), 1)
    if rng.random() < 0.2:
        case.max_agl = round(rng.uniform(80, 400), 1)
    walks = case.fly()[1]
    for _ in range(rng.choice([0, 0, 1, 1, 2])):
        obstacle(rng, case, walks)
    return case
