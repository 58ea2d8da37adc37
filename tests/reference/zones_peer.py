# SPDX-License-Identifier: Apache-2.0
"""Zones laid over a model, and legs against them: how deep a leg lies in a zone, at places where outlines
leave no doubt (`hit`), and at all places that may count (`near`)."""
import json
import math
import re
import xml.etree.ElementTree as ET

import numpy as np

import airspace_peer

INF = math.inf
EDGE_M = 2.5  # chords are up to 1.1 m off, edges bent by a map 0.5 m, fine outlines less
JOINT_M = 150  # between an arc and the corner beside it
EDGE_PIECE_M = 400  # of edges that are straight in longitude and latitude
INFORMS = {"NO_RESTRICTION", "E", "F", "G", "W"}


class Volume:
    """A prism in local metres; `rings` are the outline and its holes, `tangled` may hold more than them."""

    def __init__(self, rings, lower=None, upper=None, joints=(), tangled=False):
        self.rings, self.lower, self.upper, self.tangled = rings, lower, upper, tangled
        self.joints = np.array(joints, float).reshape(-1, 2)
        every = np.concatenate([*rings, self.joints])
        self.low, self.high = every.min(0), every.max(0)
        self.starts = np.concatenate(rings)
        self.ends = np.concatenate([np.roll(r, -1, axis=0) for r in rings])

    def over(self, p):
        return winding(self.rings[0], p) != 0 and all(winding(h, p) == 0 for h in self.rings[1:])


class Zone:
    """`closed(start, seconds)`: True, False, or None where it is not certain."""

    def __init__(self, file, name, volumes, periods=None, keep_in=False):
        self.file, self.name, self.volumes, self.keep_in = file, name, volumes, keep_in
        self.periods = periods

    def closed(self, start, seconds):
        if not self.periods or start is None:
            return True
        if any(p(start) for p in self.periods):
            return True
        times = [start + 60 * k for k in range(int(seconds / 60) + 2)]
        return None if any(p(t) for p in self.periods for t in times) else False


def winding(ring, p):
    return airspace_peer.Volume.winding(None, ring, p)


# --- reading


def mapped(ring, model, fine):
    """In local metres; of edges that are straight in longitude and latitude, places between the corners."""
    points = []
    ring = [tuple(p[:2]) for p in ring]
    ring = [p for n, p in enumerate(ring) if p != ring[n - 1]]
    for n, p in enumerate(ring):
        q = ring[(n + 1) % len(ring)]
        a, b = model.to_local(*p), model.to_local(*q)
        count = 1
        if fine and model.crs != "EPSG:4326":
            count = 1 + int(math.dist(a, b) / EDGE_PIECE_M)
        points += [a] + [model.to_local(*(np.array(p) + k / count * (np.array(q) - p)))
                         for k in range(1, count)]
    return np.array(points)


def classes(text):
    """Whether each zone of published airspace only informs, in the file's order."""
    if text.lstrip()[:1] == "{":
        return [f.get("restriction", "P") in INFORMS for f in json.loads(text)["features"]]
    found = []
    for line in text.splitlines():
        code, _, value = line.split("*")[0].strip().partition(" ")
        if code == "AC":
            found.append(value.strip() in INFORMS)
        elif code == "AY":
            found[-1] = found[-1] and value.strip() in INFORMS
    return found


def published(file, text, model):
    zones = airspace_peer.read(text)
    informs = [False] * len(zones) if text.lstrip()[:1] == "<" else classes(text)
    found = []
    for zone, only_informs in zip(zones, informs, strict=True):
        if only_informs:
            continue
        volumes = []
        for v in zone.volumes:
            rings = [mapped(r, model, True) for r in (v.ring, *v.holes)]
            joints = [model.to_local(*j) for j in v.joints]
            tangled = v.meets_itself() or bool(v.joints and text.lstrip()[:1] == "<")
            volumes.append(Volume(rings, v.lower, v.upper, joints, tangled))
        found.append(Zone(file, zone.name, volumes, zone.periods))
    return found


def circle(lon, lat, metres, model):
    return mapped(airspace_peer.arc((lon, lat), metres, 0, 360)[:-1], model, False)


def plan_fence(file, document, model):
    zones, fence = [], document["geoFence"]
    for shape in fence.get("polygons", []):
        ring = [(lon, lat) for lat, lon in shape["polygon"]]
        zones.append(Zone(file, "", [Volume([mapped(ring, model, False)])], None, shape["inclusion"]))
    for shape in fence.get("circles", []):
        lat, lon = shape["circle"]["center"]
        ring = circle(lon, lat, shape["circle"]["radius"], model)
        zones.append(Zone(file, "", [Volume([ring])], None, shape["inclusion"]))
    return zones


def waypoints_fence(file, text, model):
    zones, ring = [], []
    for line in text.splitlines()[1:]:
        words = line.split()
        if words and words[3] in ("5001", "5002"):
            ring.append((float(words[9]), float(words[8])))
            if len(ring) == float(words[4]):
                zones.append(Zone(file, "", [Volume([mapped(ring, model, False)])], None,
                                  words[3] == "5001"))
                ring = []
        elif words and words[3] in ("5003", "5004"):
            shape = circle(float(words[9]), float(words[8]), float(words[4]), model)
            zones.append(Zone(file, "", [Volume([shape])], None, words[3] == "5003"))
    return zones


def geojson(file, document, model):
    zones = []
    for feature in document["features"]:
        shape = feature["geometry"]
        if shape["type"] not in ("Polygon", "MultiPolygon"):
            continue
        polygons = [shape["coordinates"]] if shape["type"] == "Polygon" else shape["coordinates"]
        for rings in polygons:
            zones.append(Zone(file, "", [Volume([mapped(r, model, False) for r in rings])]))
    return zones


def kml(file, text, model):
    zones = []
    for node in ET.fromstring(text).iter():
        if not node.tag.endswith("}Polygon"):
            continue
        rings = []
        for ring in (n for n in node.iter() if n.tag.endswith("}coordinates")):
            rings.append(mapped([tuple(map(float, t.split(",")[:2])) for t in ring.text.split()],
                                model, False))
        zones.append(Zone(file, "", [Volume(rings)]))
    return zones


def read(file, text, model):
    start = text.lstrip()[:1]
    if start == "{":
        document = json.loads(text)
        if "geoFence" in document:
            return plan_fence(file, document, model)
        plain = "features" in document and all(
            isinstance(f["geometry"], dict) and "layer" not in f["geometry"]
            and "CEILING" not in f["properties"] for f in document["features"])
        return geojson(file, document, model) if plain else published(file, text, model)
    if start == "<":
        return kml(file, text, model) if "kml" in text[:300] else published(file, text, model)
    return waypoints_fence(file, text, model) if text.startswith("QGC") else published(file, text, model)


# --- legs


def capsules(a, b, starts, ends, reach):
    """Parts of the leg, as parameters from and to, within reach of each segment; from > to: none."""
    way, edge = b - a, ends - starts
    low, high = np.full(len(starts), INF), np.full(len(starts), -INF)

    def add(t0, t1, valid):
        t0, t1 = np.maximum(t0, 0), np.minimum(t1, 1)
        valid = valid & (t0 <= t1)
        np.minimum(low, np.where(valid, t0, INF), out=low)
        np.maximum(high, np.where(valid, t1, -INF), out=high)

    square = way @ way
    for centre in (starts, ends):
        off = a - centre
        c = (off * off).sum(1) - reach * reach
        if square == 0:
            add(np.zeros(len(c)), np.ones(len(c)), c <= 0)
            continue
        half = off @ way
        root = half * half - square * c
        s = np.sqrt(np.maximum(root, 0))
        add((-half - s) / square, (-half + s) / square, root >= 0)
    length = np.maximum(np.hypot(*edge.T), 1e-12)
    along = edge / length[:, None]
    t0, t1, valid = np.zeros(len(starts)), np.ones(len(starts)), np.ones(len(starts), bool)
    across = np.stack([-along[:, 1], along[:, 0]], 1)
    for axis, least, most in ((along, 0 * length, length), (across, -reach + 0 * length, reach + 0 * length)):
        at, rate = ((a - starts) * axis).sum(1), axis @ way
        level = np.abs(rate) < 1e-12
        valid &= ~level | ((least <= at) & (at <= most))
        safe = np.where(level, 1, rate)
        u, v = (least - at) / safe, (most - at) / safe
        t0 = np.where(level, t0, np.maximum(t0, np.minimum(u, v)))
        t1 = np.where(level, t1, np.minimum(t1, np.maximum(u, v)))
    add(t0, t1, valid)
    return low, high


def merged(low, high):
    """Intervals joined where they meet."""
    spans = sorted((s, t) for s, t in zip(low, high, strict=True) if s <= t)
    found = []
    for s, t in spans:
        if found and s <= found[-1][1]:
            found[-1][1] = max(found[-1][1], t)
        else:
            found.append([s, t])
    return found


def gaps(spans):
    last, found = 0.0, []
    for s, t in spans:
        if s > last:
            found.append((last, s))
        last = max(last, t)
    if last < 1:
        found.append((last, 1.0))
    return found


def parts(volume, a, b, reach):
    """Parts of the leg within reach of the outline, certainly inside, certainly outside."""
    p, q = np.array(a[:2], float), np.array(b[:2], float)
    low, high = capsules(p, q, volume.starts, volume.ends, reach)
    if len(volume.joints):
        more = capsules(p, q, volume.joints, volume.joints + 1e-9, reach + JOINT_M)
        low, high = np.concatenate([low, more[0]]), np.concatenate([high, more[1]])
    near = merged(low, high)
    inside, outside = [], []
    for s, t in gaps(near):
        (inside if volume.over(p + (s + t) / 2 * (q - p)) else outside).append((s, t))
    return near, inside, outside


def deepest(spans, a, b, model, volume, grow, grow_ground):
    """Greatest depth below the ceiling and above the floor, whichever is less, on parts of the leg."""
    best = -INF
    over_ground = "ground" in ((volume.lower or " ")[0], (volume.upper or " ")[0])
    for span in spans:
        if over_ground and not all(model.holds(*(np.array(a) + t * (np.array(b) - a))[:2]) for t in span):
            return None
        p, q = (np.array(a, float) + t * (np.array(b, float) - a) for t in span)
        cuts = model.pieces(p, q) if over_ground else np.array([0.0, 1.0])
        level = (p[2] + cuts[:-1] * (q - p)[2], np.diff(cuts) * (q - p)[2], 0 * cuts[1:])
        ground = model.gaps(p, q, cuts) if over_ground else level
        f, g = ((INF + 0 * level[0], 0 * level[0], 0 * level[0]) for _ in (0, 1))
        for limit, sign in ((volume.lower, 1), (volume.upper, -1)):
            if limit:
                c, s, k = ground if limit[0] == "ground" else level
                more = grow_ground if limit[0] == "ground" else grow
                made = (sign * (c - limit[1]) + more, sign * s, sign * k)
                f, g = (made, g) if sign == 1 else (f, made)
        best = max(best, least_of_two(f, g))
    return best


def least_of_two(f, g):
    """Maximum over pieces (t from 0 to 1) of the lesser of two quadratics c + s t + k t t."""
    n = len(f[0])
    tries = [np.zeros(n), np.ones(n)]
    with np.errstate(all="ignore"):
        for c, s, k in (f, g):
            tries.append(-s / (2 * k))
        c, s, k = (u - v for u, v in zip(f, g, strict=True))
        root = np.sqrt(s * s - 4 * k * c)
        tries += [(-s - root) / (2 * k), (-s + root) / (2 * k), 2 * c / (-s - root), 2 * c / (-s + root)]
        best = -INF
        for t in tries:
            t = np.clip(np.where(np.isfinite(t), t, 0), 0, 1)
            values = [np.where(np.isinf(u[0]), INF, u[0] + t * (u[1] + t * u[2])) for u in (f, g)]
            best = max(best, np.minimum(*values).max())
    return best


class Verdict:
    """hit: depth (m, above 0: violated) where outlines leave no doubt; near: where anything may count."""

    def __init__(self, zone, hit, near):
        self.zone, self.hit, self.near = zone, hit, near


def volume_verdict(volume, a, b, model, radius):
    reach = radius + EDGE_M
    low, high = (np.minimum(a, b)[:2] - reach - JOINT_M, np.maximum(a, b)[:2] + reach + JOINT_M)
    if (volume.low > high).any() or (volume.high < low).any():
        return -INF, -INF
    _, inside, _ = parts(volume, a, b, EDGE_M)
    around, within, _ = parts(volume, a, b, reach)
    maybe = around + within
    if volume.tangled:
        maybe = [(0.0, 1.0)]
    slope = 0
    if radius > 0 and any(v and v[0] == "ground" for v in (volume.lower, volume.upper)):
        slope = model.steepest(np.maximum(volume.low - radius, 0), np.minimum(volume.high + radius, model.size))
    steep = math.hypot(1, slope)
    grown = radius * math.hypot(1, slope + steep) * steep if slope else radius
    hit = deepest(inside, a, b, model, volume, radius, radius)
    near = deepest(maybe, a, b, model, volume, radius, grown)
    return -INF if hit is None else hit, INF if near is None else near


def keep_in_verdict(volume, a, b, radius):
    """Of one zone that is not to be left: a depth is not known, only whether."""
    _, _, outside = parts(volume, a, b, EDGE_M)
    near, _, beyond = parts(volume, a, b, radius + EDGE_M)
    hit = INF if any(t > s for s, t in outside) else -INF
    return hit, INF if near or beyond else -INF


def verdicts(zones, a, b, model, radius):
    """Of each zone that may matter to the leg."""
    found = []
    for zone in zones:
        if zone.keep_in:
            hit, near = keep_in_verdict(zone.volumes[0], a, b, radius)
        else:
            pairs = [volume_verdict(v, a, b, model, radius) for v in zone.volumes]
            hit, near = (max(p[k] for p in pairs) for k in (0, 1))
        if near > -INF:
            found.append(Verdict(zone, hit, near))
    return found
