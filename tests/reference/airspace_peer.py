# SPDX-License-Identifier: Apache-2.0
"""Published airspace read a second time, plainly: what each zone holds, by winding numbers over fine
outlines, normal sections of the ellipsoid, and the calendar of the standard library."""
import datetime
import json
import math
import re
import xml.etree.ElementTree as ET

import numpy as np

A, F = 6378137.0, 1 / 298.257223563
E2 = F * (2 - F)
INF = math.inf
FINE = 0.5  # degrees of an arc between two points


def fan(centre, bearing, metres):
    """The end of a normal section: centimetres from the geodesic's over the sizes of airspace."""
    lon, lat = map(math.radians, centre)
    s, c = math.sin(lat), math.cos(lat)
    w = math.sqrt(1 - E2 * s * s)
    n, m = A / w, A * (1 - E2) / w**3
    az = math.radians(bearing)
    radius = 1 / (math.cos(az) ** 2 / m + math.sin(az) ** 2 / n)
    angle = metres / radius
    out, down = radius * math.sin(angle), radius * (1 - math.cos(angle))
    east, north, up = out * math.sin(az), out * math.cos(az), -down
    sl, cl = math.sin(lon), math.cos(lon)
    x = n * c * cl - sl * east - s * cl * north + c * cl * up
    y = n * c * sl + cl * east - s * sl * north + c * sl * up
    z = n * (1 - E2) * s + c * north + s * up
    p = math.hypot(x, y)
    phi = math.atan2(z, p * (1 - E2))
    for _ in range(8):
        nn = A / math.sqrt(1 - E2 * math.sin(phi) ** 2)
        phi = math.atan2(z + E2 * nn * math.sin(phi), p)
    return (math.degrees(math.atan2(y, x)), math.degrees(phi))


def flat(centre, p):
    """East and north of p from the centre, metres, for distances and bearings nearby."""
    lat = math.radians((centre[1] + p[1]) / 2)
    w = math.sqrt(1 - E2 * math.sin(lat) ** 2)
    east = math.radians(p[0] - centre[0]) * A / w * math.cos(lat)
    north = math.radians(p[1] - centre[1]) * A * (1 - E2) / w**3
    return east, north


def arc(centre, metres, start, sweep):
    steps = max(2, int(abs(sweep) / FINE) + 1)
    return [fan(centre, start + sweep * k / steps, metres) for k in range(steps + 1)]


class Volume:
    def __init__(self, ring, holes=(), lower=None, upper=None, joints=()):
        self.ring, self.holes = np.array(ring), [np.array(h) for h in holes]
        self.lower, self.upper = lower, upper  # (datum, metres) or None
        self.joints = list(joints)  # where arcs and corners may leave a gap

    def winding(self, ring, p):
        a, b = ring, np.roll(ring, -1, axis=0)
        side = (b[:, 0] - a[:, 0]) * (p[1] - a[:, 1]) - (p[0] - a[:, 0]) * (b[:, 1] - a[:, 1])
        up = (a[:, 1] <= p[1]) & (b[:, 1] > p[1]) & (side > 0)
        down = (a[:, 1] > p[1]) & (b[:, 1] <= p[1]) & (side < 0)
        return int(up.sum()) - int(down.sum())

    def over(self, p):
        return self.winding(self.ring, p) != 0 and all(self.winding(h, p) == 0 for h in self.holes)

    def edge_distance(self, p):
        scale = np.array([111320 * math.cos(math.radians(p[1])), 110950])
        least = INF
        for ring in [self.ring, *self.holes]:
            a, b = (ring - p) * scale, (np.roll(ring, -1, axis=0) - p) * scale
            d = b - a
            t = np.clip(-(a * d).sum(1) / np.maximum((d * d).sum(1), 1e-12), 0, 1)
            least = min(least, np.hypot(*(a + t[:, None] * d).T).min())
        return least

    def near_joint(self, p, reach):
        return any(math.hypot(*flat(j, p)) < reach for j in self.joints)

    def meets_itself(self):
        a, b = self.ring, np.roll(self.ring, -1, axis=0)
        n = len(a)

        def side(p, q, r):
            return (q[..., 0] - p[..., 0]) * (r[..., 1] - p[..., 1]) - (q[..., 1] - p[..., 1]) * (
                r[..., 0] - p[..., 0])

        for i in range(n):
            j = np.arange(i + 2, n if i else n - 1)
            if len(j) == 0:
                continue
            c, d = a[j], b[j]
            cross = (side(a[i], b[i], c) * side(a[i], b[i], d) <= 0) & (
                side(c, d, a[i]) * side(c, d, b[i]) <= 0)
            if cross.any():
                return True
        return False


def height(limit, ground):
    datum, metres = limit
    return metres + (ground if datum == "ground" else 0)


class Zone:
    def __init__(self, name, volumes, periods=None):
        self.name, self.volumes, self.periods = name, volumes, periods

    def active(self, time):
        if not self.periods:
            return True
        return any(p(time) for p in self.periods)


def limit(value, unit, reference, upper):
    unit, reference = unit.upper(), reference.upper()
    if upper and value >= (999 if unit == "FL" else 99999) or not upper and value == 0:
        return None
    if unit == "FL":
        return ("sea", value * 30.48)
    metres = value * {"M": 1, "FT": 0.3048}[unit]
    if reference in ("AGL", "SFC", "GND"):
        return ("ground", metres)
    return ("sea", metres)


# --- ED-269, ED-318, facility maps

DAYS = ["MON", "TUE", "WED", "THU", "FRI", "SAT", "SUN"]


def instant(text):
    text = text.replace("Z", "+00:00")
    if re.search(r"T\d\d:\d\d\+", text):
        text = text.replace("+", ":00+", 1)
    text = re.sub(r"\.(\d+)", "", text)
    return datetime.datetime.fromisoformat(text).timestamp()


def seconds(text):
    h, m, s = (re.match(r"(\d+):(\d+)(?::(\d+))?", text).groups() + (None,))[:3]
    return int(h) * 3600 + int(m) * 60 + int(s or 0)


def period(entry):
    start = instant(entry["startDateTime"]) if entry.get("startDateTime") else -INF
    end = instant(entry["endDateTime"]) if entry.get("endDateTime") else INF
    if entry.get("permanent") == "YES":
        start, end = -INF, INF

    def active(time):
        if not start <= time <= end:
            return False
        if "schedule" not in entry:
            return True
        at = datetime.datetime.fromtimestamp(time, datetime.timezone.utc)
        clock = at.hour * 3600 + at.minute * 60 + at.second
        for hours in entry["schedule"]:
            last = seconds(hours["endTime"])
            if DAYS[at.weekday()] in hours["day"] and seconds(hours["startTime"]) <= clock and (
                    clock <= last or last >= 86340):
                return True
        return False

    return active


def read_json(text):
    zones = []
    for feature in json.loads(text)["features"]:
        geometry, props = feature["geometry"], feature.get("properties", {})
        if isinstance(geometry, list):
            volumes = []
            for g in geometry:
                low = limit(g["lowerLimit"], g["uomDimensions"], g["lowerVerticalReference"], False)
                high = limit(g["upperLimit"], g["uomDimensions"], g["upperVerticalReference"], True)
                shape = g["horizontalProjection"]
                if shape["type"] == "Circle":
                    volumes.append(Volume(arc(shape["center"], shape["radius"], 0, 360), (), low, high))
                else:
                    rings = shape["coordinates"]
                    volumes.append(Volume(rings[0][:-1], [h[:-1] for h in rings[1:]], low, high))
            zones.append(Zone(feature["identifier"], volumes,
                              [period(e) for e in feature["applicability"]]))
        elif "CEILING" in props:
            low = limit(props["CEILING"], "FT", "AGL", False)
            zones.append(Zone(str(props["OBJECTID"]),
                              [Volume(geometry["coordinates"][0][:-1], (), low, None)]))
        else:
            layer = geometry["layer"]
            low = limit(layer["lower"], layer["uom"], layer["lowerReference"], False)
            high = limit(layer["upper"], layer["uom"], layer["upperReference"], True)
            if geometry["type"] == "Point":
                ring = arc(geometry["coordinates"], geometry["extent"]["radius"], 0, 360)
            else:
                ring = geometry["coordinates"][0][:-1]
            zones.append(Zone(props["identifier"], [Volume(ring, (), low, high)],
                              [period(e) for e in props["limitedApplicability"]]))
    return zones


# --- OpenAir

COORDINATE = re.compile(r"([\d:.]+)\s*([NS])[\s,]*([\d:.]+)\s*([EW])", re.I)


def coordinates(text):
    def degrees(t):
        return sum(float(v) / 60**k for k, v in enumerate(t.split(":")))

    return [(degrees(m[2]) * (-1 if m[3] in "Ww" else 1), degrees(m[0]) * (-1 if m[1] in "Ss" else 1))
            for m in COORDINATE.findall(text)]


def openair_limit(text, upper):
    words = re.sub(r"\(.*", "", text).upper().replace(" ", "")
    if words in ("SFC", "GND") or words.startswith("UNL"):
        return None
    found = re.fullmatch(r"(FL)?(\d+)(FT)?(AGL|MSL|AMSL)?", words)
    if not found:
        return None
    return limit(float(found[2]), found[1] or "FT", found[4] or "MSL", upper)


def read_openair(text):
    zones, now, centre, sign = [], None, None, 1

    def finish():
        if now is None:
            return
        volumes = [Volume(r, (), now["low"], now["high"]) for r in now["circles"]]
        if now["ring"]:
            volumes.append(Volume(now["ring"], (), now["low"], now["high"], now["joints"]))
        periods = now["times"]
        zones.append(Zone(now["name"], volumes, None if None in periods else periods))

    for raw in text.splitlines():
        line = raw.split("*")[0].strip()
        code, _, value = line.partition(" ")
        if code == "AC":
            finish()
            now = dict(name="", low=None, high=None, ring=[], circles=[], joints=[], times=[])
            sign = 1
        elif code in ("TC", "TO"):
            finish()
            now = None
        elif code == "V" and "X=" in value.upper():
            centre = coordinates(value)[0]
        elif code == "V" and "D=" in value.upper():
            sign = -1 if "-" in value else 1
        elif now is None:
            continue
        elif code == "AN":
            now["name"] = value.strip()
        elif code == "AL":
            now["low"] = openair_limit(value, False)
        elif code == "AH":
            now["high"] = openair_limit(value, True)
        elif code == "AA":
            span = re.fullmatch(r"(\S+Z|NONE)/(\S+Z|NONE)", value.strip())
            if not span:
                now["times"].append(None)
                continue
            a = -INF if span[1] == "NONE" else instant(span[1])
            b = INF if span[2] == "NONE" else instant(span[2])
            now["times"].append(lambda t, a=a, b=b: a <= t <= b)
        elif code == "DP":
            now["ring"].append(coordinates(value)[0])
        elif code == "DC":
            now["circles"].append(arc(centre, float(value) * 1852, 0, 360))
        elif code in ("DA", "DB"):
            if code == "DA":
                r, a, b = (float(v) for v in value.split(","))
                r *= 1852
                points = []
            else:
                points = coordinates(value)
                (xa, ya), (xb, yb) = flat(centre, points[0]), flat(centre, points[1])
                r = min(math.hypot(xa, ya), math.hypot(xb, yb))
                a, b = math.degrees(math.atan2(xa, ya)), math.degrees(math.atan2(xb, yb))
            sweep = sign * ((sign * (b - a)) % 360 or 360)
            piece = arc(centre, r, a, sweep)
            now["ring"] += points[:1] + piece + points[1:]
            now["joints"] += [piece[0], piece[-1], *points]
            if code == "DB":
                now["joints"] += arc(centre, r, a, sweep)  # its radius is given twice
    finish()
    return zones


# --- AIXM


def local(tag):
    return tag.rsplit("}", 1)[-1]


def every(node, name):
    return [n for n in node.iter() if local(n.tag) == name]


def one(node, name):
    found = every(node, name)
    return found[0].text.strip() if found and found[0].text else None


def positions(node):
    return [tuple(map(float, reversed(p.text.split()))) for p in every(node, "pos")]


def aixm_limit(volume, side, upper):
    node = every(volume, side + "Limit")[0]
    return limit(float(node.text), node.get("uom"), one(volume, side + "LimitReference"), upper)


def aixm_ring(volume, borders, flips):
    ring, joints, arcs, members = [], [], 0, every(volume, "curveMember")
    hrefs = []
    for member in members:
        href = next((v for k, v in member.attrib.items() if local(k) == "href"), None)
        if href:
            hrefs.append((len(ring), borders[href]))
            continue
        for segment in list(every(member, "segments")[0]):
            kind = local(segment.tag)
            if kind in ("ArcByCenterPoint", "CircleByCenterPoint"):
                centre = positions(segment)[0]
                radius = float(one(segment, "radius")) * 1852
                if kind.startswith("Circle"):
                    return arc(centre, radius, 0, 360), [], 0
                a, b = float(one(segment, "startAngle")), float(one(segment, "endAngle"))
                sweep = (b - a + 180) % 360 - 180
                if flips >> arcs & 1:
                    sweep -= math.copysign(360, sweep)
                arcs += 1
                piece = arc(centre, radius, a, sweep)
                ring += piece
                joints += [piece[0], piece[-1]]
            else:
                ring += positions(segment)
    for at, border in hrefs:
        start, end = ring[at - 1], ring[at % len(ring)]
        i, j = border.index(start), border.index(end)
        ring[at:at] = border[i + 1:j] if i < j else border[j + 1:i][::-1]
    return ring, joints, arcs


def read_aixm(text):
    root = ET.fromstring(text)
    borders = {"urn:uuid:" + one(b, "identifier"): positions(b) for b in every(root, "GeoBorder")}
    zones = []
    for airspace in every(root, "Airspace"):
        volumes = []
        for volume in every(airspace, "AirspaceVolume"):
            low, high = aixm_limit(volume, "lower", False), aixm_limit(volume, "upper", True)
            flips = 0
            while True:
                ring, joints, arcs = aixm_ring(volume, borders, flips)
                found = Volume(ring, (), low, high, joints)
                # Gaps between arcs and corners are no reason to turn an arc.
                corners = ring[:-1] if ring[0] == ring[-1] else ring
                plain = Volume([p for p in corners if not any(
                    0 < math.hypot(*flat(j, p)) < 60 for j in joints)])
                flips += 1
                if not plain.meets_itself() or flips >> arcs:
                    break
            volumes.append(found)
        zones.append(Zone(one(airspace, "designator"), volumes))
    return zones


def read(text):
    start = text.lstrip()[:1]
    return read_aixm(text) if start == "<" else read_json(text) if start == "{" else read_openair(text)
