# SPDX-License-Identifier: Apache-2.0
"""Missions of ground stations read and judged a second time, plainly: their items, the legs that are flown,
and for each leg and constraint how far it is from its limit (negative: violated)."""
import json
import math
import xml.etree.ElementTree as ET

import zones_peer

TAKEOFF, LAND, WAYPOINT, LOITER = (22, 84), (21, 85), (16, 82), (17, 18, 19, 31)
RETURN, SPLINE = 20, 82
# Fly the vehicle somewhere, but to no position that is known.
MOVES = (RETURN, 23, 24, 25, 30, 32, 33, 34, 35, 36, 81, 83, 92, 94, 176, 177, 192, 601)
KINDS = {**dict.fromkeys(TAKEOFF, "take-off"), **dict.fromkeys(LAND, "landing"),
         **dict.fromkeys(WAYPOINT, "waypoint"), **dict.fromkeys(LOITER, "loiter")}
FRAMES = {0: "sea", 5: "sea", 3: "home", 6: "home", 10: "ground", 11: "ground"}
SAME_PLACE_M = 0.02
HOME_M = 10  # between home's height in the mission and the ground there


class Refused(Exception):
    """The program is to end with exit code 3."""


class Item:
    def __init__(self, name, kind, lon, lat, height, frame):
        self.name, self.kind, self.frame = name, kind, frame
        self.lon, self.lat, self.height = lon, lat, height
        self.circle = None  # radius, positive clockwise, of full circles left on a tangent
        self.loiter = 0  # radius of any loiter


class Mission:
    def __init__(self):
        self.items, self.home, self.wing = [], None, False
        self.moves = []  # (name, number, how many items come before)

    def command(self, number, command, frame, place, params):
        """`number` as ground stations show it; `place` is longitude, latitude and height."""
        if command in MOVES:
            what = {RETURN: "return to launch", 177: "jump"}.get(command, "command %d" % command)
            self.moves.append(("item %d (%s)" % (number, what), command, len(self.items)))
        if command not in KINDS:
            return
        lon, lat, height = place
        if lon == 0 and lat == 0 or lon is None and lat is None:
            if command in WAYPOINT:
                raise Refused("a waypoint without a position")
            before = (self.items[-1].lon, self.items[-1].lat) if self.items else self.home
            if before is None:
                raise Refused("no home")
            lon, lat = before[:2]
        if frame not in FRAMES:
            raise Refused("frame %d" % frame)
        kind = KINDS[command]
        self.items.append(Item("item %d (%s)" % (number, kind), kind, lon, lat, height, FRAMES[frame]))
        if command in LOITER:
            self.items[-1].loiter = abs(params[1 if command == 31 else 2] or 0)
        if command == 18 and params[3] == 1 and params[2]:
            self.items[-1].circle = params[2]
        if command == SPLINE:  # nobody knows its curve
            self.moves.append(("item %d (spline)" % number, command, len(self.items)))

    def end_at_home(self):
        """A return that ends the mission is a landing at home."""
        if not self.moves or not self.items or self.home is None:
            return
        name, command, before = self.moves[-1]
        if command == RETURN and before == len(self.items) and self.items[-1].kind != "landing":
            self.moves.pop()
            self.items.append(Item(name, "landing", *self.home, "sea"))


def read_waypoints(text):
    mission, number = Mission(), 0
    for line in text.splitlines()[1:]:
        words = line.split()
        if not words:
            continue
        frame, command = int(words[2]), int(words[3])
        lat, lon, height = map(float, words[8:11])
        if number == 0 and command == 16 and frame == 0:
            mission.home = (lon, lat, height)
        else:
            mission.command(number, command, frame, (lon, lat, height), [float(w) for w in words[4:8]])
        number += 1
    return mission


def read_plan(document):
    mission, body = Mission(), document["mission"]
    lat, lon, height = body["plannedHomePosition"]
    mission.home, mission.wing = (lon, lat, height), body["vehicleType"] == 1

    for item in body["items"]:
        inner = [item] if item["type"] == "SimpleItem" else item["TransectStyleComplexItem"]["Items"]
        for one in inner:
            lat, lon, height = one["coordinate"] if "coordinate" in one else one["params"][4:]
            mission.command(one["doJumpId"], one["command"], one["frame"], (lon, lat, height), one["params"])
    return mission


def read_geojson(document):
    mission = Mission()
    for n, feature in enumerate(document["features"]):
        if feature["geometry"]["type"] != "LineString":
            continue
        frame = feature.get("properties", {}).get("altitude_frame", "sea")
        if frame == "home":
            mission.home = feature["properties"]["home"]
        for k, (lon, lat, height) in enumerate(feature["geometry"]["coordinates"]):
            mission.items.append(Item("features.%d.geometry.coordinates.%d" % (n, k), "waypoint",
                                      lon, lat, height, frame))
    return mission


def read_xml(text):
    mission, root = Mission(), ET.fromstring(text)
    for node in root.iter():
        tag = node.tag.rsplit("}", 1)[-1]
        children = {c.tag.rsplit("}", 1)[-1]: (c.text or "").strip() for c in node}
        if tag == "LineString":
            frame = {"absolute": "sea", "relativeToGround": "ground"}[children["altitudeMode"]]
            points = [tuple(map(float, t.split(","))) for t in children["coordinates"].split()]
        elif tag == "rtept":
            frame = "sea"
            points = [(float(node.get("lon")), float(node.get("lat")), float(children["ele"]))]
        else:
            continue
        for p in points:
            mission.items.append(Item("point %d" % (len(mission.items) + 1), "waypoint", *p, frame))
    return mission


def read(text):
    start = text.lstrip()[:1]
    if start == "{":
        document = json.loads(text)
        return read_geojson(document) if "features" in document else read_plan(document)
    return read_xml(text) if start == "<" else read_waypoints(text)


# --- what is flown


class Flight:
    """Names and places of the points that legs join; columns: (constraint, item, foot, top), of an aeroplane
    slanted; and what is judged beside the route: (item, from, to) and (item, centre, radius)."""

    def __init__(self, mission, model):
        self.names, self.points, self.columns, self.ways, self.circles = [], [], [], [], []
        self.circle = None  # (index of its item, radius), of one level circle between straight legs
        self.model, self.home, self.wing = model, mission.home, mission.wing
        if not mission.items:
            raise Refused("no route")
        if all(model.ground(*model.to_local(i.lon, i.lat)) is None for i in mission.items):
            raise Refused("no position within the model")
        mission.end_at_home()
        for n, item in enumerate(mission.items):
            if item.circle:
                self.circle = (n, item.circle)
            x, y = model.to_local(item.lon, item.lat)
            self.names.append(item.name)
            self.points.append((x, y, self.height(item, x, y, mission, model)))
            if item.loiter:
                self.circles.append((item.name, self.points[-1], item.loiter))
        if mission.items[0].kind == "take-off":
            self.begin()
        if len(mission.items) > 1 and mission.items[-1].kind == "landing":
            self.end(list(mission.items))
        if len(self.points) == 1:
            self.ways.append((self.names[0], self.points[0], self.points[0]))

    def foot(self, x, y, top):
        ground = self.model.ground(x, y)
        if ground is None:
            ground = self.home[2] if self.home else top[2]
        return (x, y, min(top[2], ground))

    def begin(self):
        name, top = self.names[0], self.points[0]
        above = top
        if self.home:
            x, y = self.model.to_local(*self.home[:2])
            if math.dist((x, y), top[:2]) > SAME_PLACE_M:
                above = (x, y, top[2])
        self.columns.append(("climb", name, self.foot(*above[:2], above), top if self.wing else above))
        if above != top and not self.wing:
            self.ways.append((name, above, top))

    def end(self, items):
        while len(items) > 2 and items[-2].kind == "landing" and (
                math.dist(self.points[-1][:2], self.points[-2][:2]) <= SAME_PLACE_M):
            for of in (items, self.names, self.points):  # the descent begins above the first
                del of[-2]
        before, (x, y, _) = self.points[-2:]
        is_flown_to = math.dist((x, y), before[:2]) > SAME_PLACE_M and not self.wing
        over = (x, y, before[2]) if is_flown_to else before
        self.columns.append(("descent", self.names[-1], self.foot(x, y, over), over))
        if is_flown_to:
            self.points[-1] = over
            return
        self.names.pop()
        self.points.pop()
        if len(items) > 2 and items[-2].kind == "landing" and same_degrees(items[-3:-1]):
            self.names.pop()  # nor is another one straight below
            self.points.pop()

    @staticmethod
    def height(item, x, y, mission, model):
        if item.frame == "sea":
            return item.height
        if item.frame == "home":
            if mission.home is None:
                raise Refused("no home")
            return mission.home[2] + item.height
        ground = model.ground(x, y)
        if ground is None:
            raise Refused("no ground below " + item.name)
        return ground + item.height

    def legs(self):
        found = list(zip(self.names, self.names[1:], self.points, self.points[1:], strict=False))
        if self.circle:
            n, radius = self.circle
            (a, b, before, centre), (c, d, _, after) = found[n - 1:n + 1]
            found[n - 1] = (a, b, before, tangent(before, centre, radius, 1))
            found[n] = (c, d, tangent(after, centre, radius, -1), after)
        return found


def tangent(p, centre, radius, way):
    """Where a straight line from (way 1) or to (way -1) p touches the circle, flown in its sense."""
    x, y = p[0] - centre[0], p[1] - centre[1]
    turn = math.acos(abs(radius) / math.hypot(x, y)) * -math.copysign(1, radius) * way
    angle = math.atan2(y, x) + turn
    return (centre[0] + abs(radius) * math.cos(angle), centre[1] + abs(radius) * math.sin(angle), centre[2])


def same_degrees(items):
    a, b = items
    return abs(a.lon - b.lon) <= 2e-7 and abs(a.lat - b.lat) <= 2e-7


# --- the verdict


class Leg:
    """Margins in metres by constraint; zones as zones_peer has them, `blocked` of terrain and zones."""

    def __init__(self, names):
        self.names, self.margins, self.values = names, {}, {}
        self.off_ground, self.lowest, self.terrain, self.zones = False, None, None, []


def judge_leg(names, a, b, model, zones, limits):
    leg = Leg(names)
    radius = limits.get("radius", 0)
    heights = model.leg(a, b)
    leg.margins["ground"] = min(min(*p[:2], *(model.size - p[:2])) for p in (a, b))
    if heights is None:
        leg.off_ground = True
        part = model.clipped(a, b)
        low = model.leg(*part)[0] if part else math.inf
        # Beyond the posts the program may be careful for a radius.
        leg.terrain = low - radius if low < radius or radius == 0 else math.nan
    else:
        low, high = heights
        leg.lowest = low
        if "min_agl" in limits:
            leg.margins["ground_clearance"] = low - limits["min_agl"]
            leg.values["ground_clearance"] = low
        if "max_agl" in limits:
            leg.margins["altitude"] = limits["max_agl"] - high
            leg.values["altitude"] = high
        near = low > 0 and radius > 0
        leg.terrain = (model.distance(a, b, 2 * radius) if near else low) - radius
    leg.zones = zones_peer.verdicts(zones, a, b, model, radius)
    return leg


def judge_circle(name, centre, radius, model, zones, limits):
    """By chords as to zones, whose depth is uncertain by a metre; by slopes as to a vehicle's radius."""
    leg, heights, keep = Leg((name,)), model.circle(centre, radius), limits.get("radius", 0)
    corners = [(centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t), centre[2])
               for t in (2 * math.pi * k / 90 for k in range(91))]
    leg.margins["ground"] = min(min(centre[k], model.size[k] - centre[k]) - radius for k in (0, 1))
    if heights is None:
        leg.off_ground, leg.terrain = True, math.nan
    else:
        leg.lowest, leg.terrain = heights[0], heights[0] - keep
        if keep > 0 and leg.terrain > 0:
            reach, middle = radius + keep, model.size * 0 + centre[:2]
            least = leg.lowest / math.hypot(1, model.steepest(middle - reach, middle + reach)) - keep
            leg.terrain = least if least > 0 else math.nan
        if "min_agl" in limits:
            leg.margins["ground_clearance"] = heights[0] - limits["min_agl"]
        if "max_agl" in limits:
            leg.margins["altitude"] = limits["max_agl"] - heights[1]
    for a, b in zip(corners, corners[1:], strict=False):
        for v in zones_peer.verdicts(zones, a, b, model, keep):
            leg.zones.append(zones_peer.Verdict(v.zone, v.hit - 1, v.near + 1))
    return leg


def home_margin(mission, model):
    """None where no height counts from home, or the ground there is unknown."""
    relative = any(i.frame == "home" and i.kind != "landing" for i in mission.items)
    ground = model.ground(*model.to_local(*mission.home[:2])) if mission.home and relative else None
    return None if ground is None else HOME_M - abs(mission.home[2] - ground)


TOUCH_M = 1  # an aeroplane's climb and descent end at the ground


def judge_column(foot, top, model, zones, limits):
    """Verdicts of zones; of a slanted one also its height above the ground, less what may be missing."""
    low = None
    if foot[:2] != top[:2]:
        heights = model.leg(foot, top)
        low = heights[0] + TOUCH_M if heights else -math.inf
    return zones_peer.verdicts(zones, foot, top, model, limits.get("radius", 0)), low


def judge(flight, model, zones, limits):
    """Legs of the route; those beside it; and (constraint, item, verdicts, height) of columns."""
    legs = [judge_leg((m, n), a, b, model, zones, limits) for m, n, a, b in flight.legs()]
    if flight.circle:
        n, radius = flight.circle
        legs.append(judge_circle("circle", flight.points[n], abs(radius), model, zones, limits))
    beside = [judge_leg((name,), a, b, model, zones, limits) for name, a, b in flight.ways]
    beside += [judge_circle(*circle, model, zones, limits) for circle in flight.circles]
    columns = [(rule, item, *judge_column(foot, top, model, zones, limits))
               for rule, item, foot, top in flight.columns]
    return legs, beside, columns
