# SPDX-License-Identifier: Apache-2.0
"""Missions made from others: laid over a model, with other heights, frames, orders and lengths, and written
in any format; published airspace moved over the same model."""
import copy
import json
import math
import re

import numpy as np

import airspace_peer
import mission_peer

ROUTES = ["px4_avoidance.plan", "qgc_SectionTest.plan", "qgroundcontrol_sample.plan",
          "qgroundcontrol_sample_with_survey.plan", "dronekit_mpmission.waypoints",
          "qgc_100Waypoints.waypoints", "qgc_MissionPlanner.waypoints", "qgc_MissionPlanner_full.waypoints",
          "mavproxy_springvalley-foamy-mission-cw.txt"]
POSITIONS = tuple(mission_peer.KINDS)
FRAMES = {"sea": (0, 5), "home": (3, 6), "ground": (10, 11)}


# --- missions as lists of commands


def commands(text):
    """(home, wing, [command, frame, params, lat, lon, height] …) of a .plan or of QGC WPL."""
    if text.lstrip()[:1] != "{":
        rows = [line.split() for line in text.splitlines()[1:] if line.strip()]
        made = [[int(r[3]), int(r[2]), [float(v) for v in r[4:8]], *map(float, r[8:11])] for r in rows]
        return made[0][3:], 2, made[1:]
    body = json.loads(text)["mission"]
    made = []
    for item in body["items"]:
        inner = item["TransectStyleComplexItem"]["Items"] if item["type"] == "ComplexItem" else [item]
        for one in inner:
            places = one["coordinate"] if "coordinate" in one else one["params"][4:]
            made.append([one["command"], one["frame"], one["params"][:4], *(v or 0 for v in places[-3:])])
    return body["plannedHomePosition"], body["vehicleType"], made


def is_placed(row):
    return row[0] in POSITIONS and (row[3] or row[4])


class Mutant:
    """A mission over a model, in local metres until it is written."""

    def __init__(self, text, model, rng):
        self.model, self.rng = model, rng
        self.home, self.vehicle, self.rows = commands(text)
        self.fence = None
        keeps = rng.random() < 0.15  # commands that are not judged
        waypoints = [r for r in self.rows if r[0] == 16 and is_placed(r)]
        if keeps and waypoints and rng.random() < 0.2:
            rng.choice(waypoints)[0] = mission_peer.SPLINE
        self.rows = [r for r in self.rows if keeps or r[0] == 20 or r[0] not in mission_peer.MOVES]
        self.shorten()
        self.place()
        self.reorder()
        self.set_heights()
        if rng.random() < 0.1:
            self.vehicle = 1
        self.has_circle = rng.random() < 0.08 and self.add_circle()

    def shorten(self):
        count = self.rng.choice([5, 8, 12, 16])
        if len(self.rows) > count and self.rng.random() < 0.95:
            first = self.rng.randrange(len(self.rows) - count + 1)
            self.rows = self.rows[first:first + count]
        if not any(map(is_placed, self.rows)):
            self.rows.append([16, 3, [0] * 4, *self.home])

    def place(self):
        """Turned, scaled and moved to somewhere over the model, seldom beyond it."""
        rng, size = self.rng, self.model.size
        lat0, lon0 = self.home[:2]
        placed = [r for r in self.rows if is_placed(r)]
        stretch = math.cos(math.radians(lat0))
        points = np.array([((r[4] - lon0) * stretch, r[3] - lat0) for r in placed])
        extent = max(np.ptp(points, axis=0).max(), 1e-9)
        metres = math.exp(rng.uniform(math.log(60), math.log(min(6000, 0.6 * size.min()))))
        turn = rng.uniform(0, 2 * math.pi)
        c, s = math.cos(turn), math.sin(turn)
        points = (points - points.mean(0)) @ np.array([[c, s], [-s, c]]) * metres / extent
        low, high = points.min(0), points.max(0)
        beyond = rng.random() < 0.06
        for k in (0, 1):
            least, most = (-0.3 * metres, size[k] + 0.3 * metres) if beyond else (-low[k], size[k] - high[k])
            points[:, k] += rng.uniform(min(least, most), most)
        if rng.random() < 0.5:
            points += np.array([[rng.gauss(0, 0.05 * metres) for _ in (0, 1)] for _ in points])
        if not beyond:
            points = np.clip(points, 1, size - 1)
        for row, p in zip(placed, points, strict=True):
            row[3:5] = [float(v) for v in p]
        self.home = [float(v) for v in points[0]] + [0]

    def reorder(self):
        rng, rows = self.rng, self.rows
        for _ in range(rng.choice([0, 0, 1, 2])):
            i, j = rng.randrange(len(rows)), rng.randrange(len(rows))
            how = rng.randrange(4)
            if how == 0:
                rows[i], rows[j] = rows[j], rows[i]
            elif how == 1:
                rows.insert(i, copy.deepcopy(rows[j]))
            elif how == 2 and len(rows) > 3:
                del rows[i]
            elif is_placed(rows[i]) and is_placed(rows[j]):
                rows[i][3:5] = rows[j][3:5]
        if rng.random() < 0.2:
            rows.append([21, 3, [0] * 4, *(rng.choice([r for r in rows if is_placed(r)] or rows)[3:5]), 0])

    def ground(self, x, y):
        found = self.model.ground(x, y)
        return 500.0 if found is None else found

    def set_heights(self):
        """Near the ground or over the highest of it, in one frame or in any."""
        rng = self.rng
        self.home[2] = self.ground(*self.home[:2]) + rng.choice([0, 0, 0, rng.uniform(-20, 20)])
        placed = [r for r in self.rows if is_placed(r)]
        tops = [self.ground(*r[3:5]) for r in placed] or [0]
        above, level = rng.uniform(5, 250), rng.random() < 0.75
        spread = rng.choice([0, 5, 60])
        words = rng.choice([["sea"], ["home"], ["ground"], ["sea", "home", "ground"]])
        for row in self.rows:
            if row[0] not in POSITIONS:
                continue
            word = rng.choice(words)
            here = self.ground(*row[3:5]) if is_placed(row) else self.home[2]
            z = (max(tops) if level else here) + above + rng.uniform(-spread, spread)
            if word == "ground" and rng.random() < 0.7:
                z = here + above
            row[1] = rng.choice(FRAMES[word])
            row[5] = z - {"sea": 0, "home": self.home[2], "ground": here}[word]

    def add_circle(self):
        """Full circles about one item, left on the tangent to the next, all at one height."""
        rng, placed = self.rng, [r for r in self.rows if r[0] in POSITIONS]
        inner = [k for k in range(1, len(placed) - 1) if placed[k][0] == 16]
        if not inner or not all(is_placed(r) for r in placed) or placed[-1][0] in mission_peer.LAND:
            return False
        k = rng.choice(inner)
        reach = min(math.dist(placed[k][3:5], placed[k + d][3:5]) for d in (-1, 1))
        if reach < 30:
            return False
        placed[k][0] = 18
        placed[k][2] = [rng.choice([1, 2]), 0, rng.choice([-1, 1]) * rng.uniform(0.1, 0.9) * reach, 1]
        height = max(self.ground(*r[3:5]) for r in placed) + rng.uniform(-20, 200)
        for row in placed:
            row[1], row[5] = 0, height
        return True

    # --- writing

    def lonlat(self, row, near):
        """Latitude and longitude, rounded as ground stations do, or not."""
        if not (row[3] or row[4]):
            return 0, 0
        lon, lat = self.model.to_lonlat(row[3], row[4], near)
        return (round(lat, 7), round(lon, 7)) if self.digits else (lat, lon)

    def written(self, near):
        """(suffix, text)."""
        rng = self.rng
        self.digits = rng.random() < 0.5
        suffix = rng.choice(["kml", "gpx", "geojson"])
        home = [*self.lonlat([0, 0, 0, *self.home], near), self.home[2]]
        rows = [[*r[:3], *self.lonlat(r, near), r[5]] for r in self.rows]
        return suffix, self.map_text(suffix, home, rows)

    def map_text(self, suffix, home, rows):
        """One line; heights as they come, in one frame."""
        rows = [r for r in rows if r[0] in POSITIONS and (r[3] or r[4])]
        word = self.rng.choice(["sea", "ground", "home"][:{"kml": 2, "gpx": 1, "geojson": 3}[suffix]])
        above = self.rng.uniform(5, 250)
        top = max(self.ground(*r[3:5]) for r in self.rows if is_placed(r))
        heights = [above if word == "ground" else above + top - (home[2] if word == "home" else 0)
                   for _ in rows]
        points = [(r[4], r[3], z + self.rng.uniform(-5, 5)) for r, z in zip(rows, heights, strict=True)]
        if suffix == "geojson":
            line = {"type": "LineString", "coordinates": points}
            words = {} if word == "sea" else {"altitude_frame": word}
            if word == "home":
                words["home"] = [home[1], home[0], home[2]]
            return json.dumps({"type": "FeatureCollection", "features": [
                {"type": "Feature", "properties": words, "geometry": line}]})
        if suffix == "gpx":
            body = "".join('<rtept lat="%r" lon="%r"><ele>%r</ele></rtept>' % (p[1], p[0], p[2])
                           for p in points)
            return ('<gpx version="1.1" creator="test" xmlns="http://www.topografix.com/GPX/1/1"><rte>'
                    + body + "</rte></gpx>")
        mode = {"sea": "absolute", "ground": "relativeToGround"}[word]
        return ('<kml xmlns="http://www.opengis.net/kml/2.2"><Placemark><LineString><altitudeMode>' + mode
                + "</altitudeMode><coordinates>" + " ".join("%r,%r,%r" % p for p in points)
                + "</coordinates></LineString></Placemark></kml>")


# --- zones


class Move:
    """Places about one centre to another, smaller by a factor; distances by the same."""

    def __init__(self, centre, to, factor):
        self.centre, self.to, self.factor = centre, to, factor
        self.east = factor * math.cos(math.radians(centre[1])) / math.cos(math.radians(to[1]))

    def __call__(self, lon, lat):
        return (self.to[0] + (lon - self.centre[0]) * self.east,
                self.to[1] + (lat - self.centre[1]) * self.factor)


def walk(value, key, move):
    """A JSON document with its places and radii moved."""
    if isinstance(value, list) and len(value) in (2, 3) and all(isinstance(v, (int, float)) for v in value):
        if key in ("polygon", "latlon") or key == "center" and move.swapped:
            lon, lat = move(value[1], value[0])
            return [lat, lon]
        return [*move(*value[:2]), *value[2:]] if key in ("coordinates", "center") else value
    if isinstance(value, list):
        return [walk(v, key, move) for v in value]
    if isinstance(value, dict):
        return {k: walk(v, k, move) for k, v in value.items()}
    return value * move.factor if key == "radius" else value


def moved_openair(text, move):
    def place(m):
        lon, lat = move(*airspace_peer.coordinates(m[0])[0])

        def clock(value):
            seconds = abs(value) * 3600
            return "%d:%02d:%08.5f" % (seconds // 3600, seconds // 60 % 60, seconds % 60)

        return "%s %s %s %s" % (clock(lat), "NS"[lat < 0], clock(lon), "EW"[lon < 0])

    lines = []
    for line in text.splitlines():
        code, _, value = line.partition(" ")
        if code == "DC":
            line = "DC %.6f" % (float(value.split("*")[0]) * move.factor)
        elif code == "DA":
            radius, rest = value.split(",", 1)
            line = "DA %.6f,%s" % (float(radius) * move.factor, rest)
        elif code in ("DP", "DB", "V"):
            line = code + " " + airspace_peer.COORDINATE.sub(place, value)
        lines.append(line)
    return "\n".join(lines) + "\n"


def moved_xml(text, move):
    def pos(m):
        lat, lon = map(float, m[2].split())
        return m[1] + "%.9f %.9f" % move(lon, lat)[::-1] + m[3]

    def radius(m):
        return m[1] + "%.6f" % (float(m[2]) * move.factor) + m[3]

    def places(m):
        return m[1] + " ".join("%.9f,%.9f,%s" % (*move(*map(float, t.split(",")[:2])), t.split(",")[2])
                               for t in m[2].split()) + m[3]

    text = re.sub(r"(<gml:pos[^>]*>)([^<]*)(<)", pos, text)
    text = re.sub(r"(<gml:radius[^>]*>)([^<]*)(<)", radius, text)
    return re.sub(r"(<coordinates>)([^<]*)(<)", places, text)


def moved_fence(text, move):
    lines = text.splitlines()
    for n, line in enumerate(lines[1:], 1):
        words = line.split()
        words[9], words[8] = ("%.9f" % v for v in move(float(words[9]), float(words[8])))
        lines[n] = "\t".join(words)
    return "\n".join(lines) + "\n"


def bounds(text):
    """Of the places in a file of zones, longitudes and latitudes."""
    start = text.lstrip()[:1]
    if text.startswith("QGC"):
        places = [(float(w[9]), float(w[8])) for w in map(str.split, text.splitlines()[1:])]
    elif start == "<":
        places = [tuple(map(float, m.split()))[::-1] for m in re.findall(r"<gml:pos[^>]*>([^<]*)<", text)]
        for m in re.findall(r"<coordinates>([^<]*)<", text):
            places += [tuple(map(float, t.split(",")[:2])) for t in m.split()]
    elif start == "{":
        places = []
        find = Move((0, 0), (0, 0), 1)
        find.swapped = "geoFence" in text
        find.__class__ = type("Find", (Move,), {"__call__": lambda _, x, y: places.append((x, y)) or (x, y)})
        walk(json.loads(text), "", find)
    else:
        places = airspace_peer.coordinates(text)
    points = np.array(places)
    return points.min(0), points.max(0)


def moved(text, to, extent_deg, rng):
    """The zones of a file about another place, spread over about that extent."""
    low, high = bounds(text)
    factor = min(1.2, extent_deg / max((high - low).max(), 1e-6) * rng.uniform(0.5, 2))
    move = Move((low + high) / 2, to, factor)
    start = text.lstrip()[:1]
    if start == "{":
        move.swapped = "geoFence" in text
        return json.dumps(walk(json.loads(text), "", move))
    if text.startswith("QGC"):
        return moved_fence(text, move)
    return moved_xml(text, move) if start == "<" else moved_openair(text, move)


def box_zone(name, lonlat, lower, upper):
    """ED-269 with one polygon and the limits (datum, metres)."""
    words = {"sea": "AMSL", "ground": "AGL"}
    projection = {"type": "Polygon", "coordinates": [lonlat + lonlat[:1]]}
    geometry = {"uomDimensions": "M", "lowerLimit": lower[1], "lowerVerticalReference": words[lower[0]],
                "upperLimit": upper[1], "upperVerticalReference": words[upper[0]],
                "horizontalProjection": projection}
    return json.dumps({"features": [{"identifier": name, "country": "CHE", "name": name, "type": "COMMON",
                                     "restriction": "PROHIBITED", "reason": [], "zoneAuthority": [],
                                     "applicability": [{"permanent": "YES"}], "geometry": [geometry]}]})
