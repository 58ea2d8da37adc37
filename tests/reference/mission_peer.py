# SPDX-License-Identifier: Apache-2.0
"""Missions of ground stations read and judged a second time, plainly: their items, the legs that are flown,
and for each leg and constraint how far it is from its limit (negative: violated)."""
import json
import math
import xml.etree.ElementTree as ET

import zones_peer

TAKEOFF, LAND, OTHERS = (22, 84), (21, 85), (16, 82, 17, 18, 19, 31)
FRAMES = {0: "sea", 5: "sea", 3: "home", 6: "home", 10: "ground", 11: "ground"}
SAME_PLACE_M = 0.02


class Refused(Exception):
    """The program is to end with exit code 3."""


class Item:
    def __init__(self, name, kind, lon, lat, height, frame):
        self.name, self.kind, self.frame = name, kind, frame
        self.lon, self.lat, self.height = lon, lat, height
        self.circle = None  # radius, positive clockwise, of full circles left on a tangent


class Mission:
    def __init__(self):
        self.items, self.home, self.wing = [], None, False

    def command(self, name, number, frame, lon, lat, height, params):
        if number not in (*TAKEOFF, *LAND, *OTHERS):
            return
        kind = "takeoff" if number in TAKEOFF else "land" if number in LAND else "other"
        if lon == 0 and lat == 0 or lon is None and lat is None:
            if number in (16, 82):
                raise Refused("a waypoint without a position")
            before = (self.items[-1].lon, self.items[-1].lat) if self.items else self.home
            if before is None:
                raise Refused("no home")
            lon, lat = before[:2]
        if frame not in FRAMES:
            raise Refused("frame %d" % frame)
        self.items.append(Item(name, kind, lon, lat, height, FRAMES[frame]))
        if number == 18 and params[3] == 1 and params[2]:
            self.items[-1].circle = params[2]


def read_waypoints(text):
    mission, number = Mission(), 0
    for n, line in enumerate(text.splitlines(), 1):
        words = line.split()
        if n == 1 or not words:
            continue
        frame, command = int(words[2]), int(words[3])
        lat, lon, height = map(float, words[8:11])
        if number == 0 and command == 16 and frame == 0:
            mission.home = (lon, lat, height)
        else:
            mission.command("line %d" % n, command, frame, lon, lat, height,
                            [float(w) for w in words[4:8]])
        number += 1
    return mission


def read_plan(document):
    mission, body = Mission(), document["mission"]
    lat, lon, height = body["plannedHomePosition"]
    mission.home, mission.wing = (lon, lat, height), body["vehicleType"] == 1

    def simple(item, name):
        lat, lon, height = item["coordinate"] if "coordinate" in item else item["params"][4:]
        mission.command(name, item["command"], item["frame"], lon, lat, height, item["params"])

    for n, item in enumerate(body["items"]):
        name = "mission.items.%d" % n
        if item["type"] == "SimpleItem":
            simple(item, name)
        else:
            inner = item.get("TransectStyleComplexItem", {}).get("Items", [])
            for k, one in enumerate(inner):
                simple(one, "%s.TransectStyleComplexItem.Items.%d" % (name, k))
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
            mission.items.append(Item("features.%d.geometry.coordinates.%d" % (n, k), "other",
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
            mission.items.append(Item("point %d" % (len(mission.items) + 1), "other", *p, frame))
    return mission


def read(text):
    start = text.lstrip()[:1]
    if start == "{":
        document = json.loads(text)
        return read_geojson(document) if "features" in document else read_plan(document)
    return read_xml(text) if start == "<" else read_waypoints(text)


# --- what is flown


class Flight:
    """Names and places of the points that legs join, and columns: (constraint, item, foot, top)."""

    def __init__(self, mission, model):
        self.names, self.points, self.columns = [], [], []
        self.circle = None  # (index of its item, radius), of one level circle between straight legs
        items = mission.items
        if len(items) < 2:
            raise Refused("%d points" % len(items))
        for n, item in enumerate(items):
            if item.circle:
                self.circle = (n, item.circle)
            x, y = model.to_local(item.lon, item.lat)
            self.names.append(item.name)
            self.points.append((x, y, self.height(item, x, y, mission, model)))

        def foot(x, y, top):
            ground = model.ground(x, y)
            if ground is None:
                ground = mission.home[2] if mission.home else top[2]
            return (x, y, min(top[2], ground))

        if items[0].kind == "takeoff":
            top = self.points[0]
            self.columns.append(("climb", items[0].name, foot(*top[:2], top), top))
        if items[-1].kind == "land":
            before, (x, y, _) = self.points[-2:]
            over = before
            if math.hypot(x - before[0], y - before[1]) > SAME_PLACE_M and not mission.wing:
                over = (x, y, before[2])
            self.columns.append(("descent", items[-1].name, foot(x, y, over), over))
            if over == before:
                self.names.pop()
                self.points.pop()
                if len(items) == 2 and same_degrees(items):
                    raise Refused("one point")
            else:
                self.points[-1] = over

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
    a, b = items[-2:]
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


def judge_circle(centre, radius, model, zones, limits):
    """Of a vehicle without a radius; by chords as to zones, whose depth is uncertain by a metre."""
    leg, heights = Leg(("circle",)), model.circle(centre, radius)
    corners = [(centre[0] + radius * math.cos(t), centre[1] + radius * math.sin(t), centre[2])
               for t in (2 * math.pi * k / 90 for k in range(91))]
    leg.margins["ground"] = min(min(centre[k], model.size[k] - centre[k]) - radius for k in (0, 1))
    if heights is None:
        leg.off_ground, leg.terrain = True, math.nan
    else:
        leg.lowest, leg.terrain = heights[0], heights[0]
        if "min_agl" in limits:
            leg.margins["ground_clearance"] = heights[0] - limits["min_agl"]
        if "max_agl" in limits:
            leg.margins["altitude"] = limits["max_agl"] - heights[1]
    for a, b in zip(corners, corners[1:], strict=False):
        for v in zones_peer.verdicts(zones, a, b, model, 0):
            leg.zones.append(zones_peer.Verdict(v.zone, v.hit - 1, v.near + 1))
    return leg


def judge(mission, model, zones, limits):
    flight = Flight(mission, model)
    legs = [judge_leg((m, n), a, b, model, zones, limits) for m, n, a, b in flight.legs()]
    if flight.circle:
        n, radius = flight.circle
        legs.append(judge_circle(flight.points[n], abs(radius), model, zones, limits))
    columns = [(rule, item, zones_peer.verdicts(zones, foot, top, model, limits.get("radius", 0)))
               for rule, item, foot, top in flight.columns]
    return legs, columns
