# SPDX-License-Identifier: Apache-2.0
"""Drawn routes read and judged a second time, plainly: their points, the legs between them, and for each leg
and constraint how far it is from its limit (negative: violated)."""
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


HOME_M = 10  # between home's height in the mission and the ground there


class Refused(Exception):
    """The program is to end with exit code 3."""


class Item:
    def __init__(self, name, lon, lat, height, frame):
        self.name, self.frame = name, frame
        self.lon, self.lat, self.height = lon, lat, height


class Mission:
    def __init__(self):
        self.items, self.home = [], None


def read_geojson(document):
    mission = Mission()
    for n, feature in enumerate(document["features"]):
        if feature["geometry"]["type"] != "LineString":
            continue
        frame = feature.get("properties", {}).get("altitude_frame", "sea")
        if frame == "home":
            mission.home = feature["properties"]["home"]
        for k, (lon, lat, height) in enumerate(feature["geometry"]["coordinates"]):
            mission.items.append(Item("features.%d.geometry.coordinates.%d" % (n, k),
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
            mission.items.append(Item("point %d" % (len(mission.items) + 1), *p, frame))
    return mission


def read(text):
    return read_geojson(json.loads(text)) if text.lstrip()[:1] == "{" else read_xml(text)


# --- what is flown


class Flight:
    """Names and places of the points that legs join; `ways` has the only point as a leg of no length."""

    def __init__(self, mission, model):
        self.names, self.points, self.ways = [], [], []
        if not mission.items:
            raise Refused("no route")
        if all(model.ground(*model.to_local(i.lon, i.lat)) is None for i in mission.items):
            raise Refused("no position within the model")
        for item in mission.items:
            x, y = model.to_local(item.lon, item.lat)
            self.names.append(item.name)
            self.points.append((x, y, self.height(item, x, y, mission, model)))
        if len(self.points) == 1:
            self.ways.append((self.names[0], self.points[0], self.points[0]))

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
        return list(zip(self.names, self.names[1:], self.points, self.points[1:], strict=False))


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


def home_margin(mission, model):
    """None where no height counts from home, or the ground there is unknown."""
    relative = any(i.frame == "home" for i in mission.items)
    ground = model.ground(*model.to_local(*mission.home[:2])) if mission.home and relative else None
    return None if ground is None else HOME_M - abs(mission.home[2] - ground)


def judge(flight, model, zones, limits):
    """Legs of the route, and the only point."""
    legs = [judge_leg((m, n), a, b, model, zones, limits) for m, n, a, b in flight.legs()]
    return legs, [judge_leg((name,), a, b, model, zones, limits) for name, a, b in flight.ways]
