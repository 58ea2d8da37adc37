# SPDX-License-Identifier: Apache-2.0
"""What stands in the world: a list of solids, each with the id of its layer, and how near legs come."""
import dataclasses

import numpy as np

import geometry

EVERYWHERE = 1e7  # m: ends of what has no end, beyond every world judged here


@dataclasses.dataclass
class Solid:
    """A solid of one kind: sphere (centre, radius), cylinder (centre, radius, low, high), box (low,
    high), prism (rings, low, high), or keep_in (zones), which is all outside of its zones."""
    kind: str
    of: dict
    layer: str = ""

    def moved(self, by):
        by, of = np.asarray(by, float), dict(self.of)
        for key in ("centre", "corner_low", "corner_high"):
            if key in of:
                of[key] = of[key] + by[:len(of[key])]
        for key in ("low", "high"):
            if key in of:
                of[key] = of[key] + by[2]
        if "rings" in of:
            of["rings"] = [ring + by[:2] for ring in of["rings"]]
        return Solid(self.kind, of, self.layer)

    def at(self, p):
        """Signed distances of points, one each."""
        of = self.of
        if self.kind == "sphere":
            return geometry.sphere(p, of["centre"], of["radius"])
        if self.kind == "cylinder":
            return geometry.cylinder(p, of["centre"], of["radius"], of["low"], of["high"])
        if self.kind == "box":
            return geometry.box(p, of["corner_low"], of["corner_high"])
        if self.kind == "prism":
            return geometry.upright(geometry.polygon(p[:, :2], of["rings"]), p[:, 2], of["low"],
                                    of["high"])
        return np.max([-zone.at(p) for zone in of["zones"]], axis=0)  # keep_in


    def depths(self, a, b):
        """(lower, upper) bounds of the depth on short pieces, of a cylinder or a prism."""
        of = self.of
        if self.kind == "cylinder":
            plane = geometry.disc_bounds(a, b, of["centre"], of["radius"])
        else:
            plane = geometry.polygon_bounds(a, b, of["rings"])
        return geometry.upright_bounds(plane, a, b, of["low"], of["high"])

    def bound(self, a, b):
        """Lower bounds of the signed distance on short pieces."""
        if self.kind == "keep_in":
            return np.max([zone.depths(a, b)[0] for zone in self.of["zones"]], axis=0)
        return -self.depths(a, b)[1]

    def least(self, a, b):
        return geometry.min_by_bounds(self.at, self.bound, a, b)


def sphere(centre, radius, layer=""):
    return Solid("sphere", {"centre": np.array(centre, float), "radius": float(radius)}, layer)


def cylinder(centre, radius, low=-EVERYWHERE, high=EVERYWHERE, layer=""):
    return Solid("cylinder", {"centre": np.array(centre, float)[:2], "radius": float(radius),
                              "low": float(low), "high": float(high)}, layer)


def box(low, high, layer=""):
    return Solid("box", {"corner_low": np.array(low, float), "corner_high": np.array(high, float)},
                 layer)


def prism(outline, holes=(), low=-EVERYWHERE, high=EVERYWHERE, layer=""):
    rings = [ring_of(outline), *map(ring_of, holes)]
    return Solid("prism", {"rings": rings, "low": float(low), "high": float(high)}, layer)


def ring_of(points):
    """Without the repeated point that closes a ring of GeoJSON, or points twice in a row."""
    ring = [np.array(p[:2], float) for p in points]
    kept = [p for i, p in enumerate(ring) if not (p == ring[i - 1]).all()]
    return np.array(kept)


def keep_in(zones, layer=""):
    return Solid("keep_in", {"zones": list(zones)}, layer)


class Set:
    """Many solids asked at once. Answers are by leg: the least signed distance of each leg, from
    one solid each, as far as it is below what was asked for."""

    KEYS = {"sphere": ("centre", "radius"), "cylinder": ("centre", "radius", "low", "high"),
            "box": ("corner_low", "corner_high"), "triangle": ("corners", "low", "high")}
    CALLS = {"sphere": geometry.sphere, "cylinder": geometry.cylinder, "box": geometry.box,
             "triangle": geometry.triangle_prism}

    def __init__(self, solids):
        self.solids = list(solids)
        self.groups = {}
        rows = {kind: [] for kind in self.KEYS}
        for n, solid in enumerate(self.solids):
            if solid.kind == "prism":
                rings = solid.of["rings"]
                for corners in geometry.triangles(rings[0], rings[1:]):
                    rows["triangle"].append((n, dict(solid.of, corners=corners)))
            elif solid.kind in rows:
                rows[solid.kind].append((n, solid.of))
        for kind, list_ in rows.items():
            if list_:
                columns = [np.array([of[k] for _, of in list_]) for k in self.KEYS[kind]]
                self.groups[kind] = (np.array([n for n, _ in list_]), columns)

    def least(self, a, b, below):
        """(leg, solid, distance) of all pairs that may be below `below`, the distances exact."""
        found = []
        for kind, (owners, columns) in self.groups.items():
            call = self.CALLS[kind]
            middle, half = (a + b) / 2, np.linalg.norm(b - a, axis=1) / 2
            # A distance changes by at most a metre in a metre: most pairs are out of question.
            at = call(middle[:, None, :], *(v[None] for v in columns))
            # In a prism a triangle of it is less deep than all of it.
            legs, items = np.nonzero(at - half[:, None] < (
                max(below, 1e-6) if kind == "triangle" else below))
            if not len(legs):
                continue
            chosen = [v[items] for v in columns]
            values = geometry.convex_min(lambda p: call(p, *chosen), a[legs], b[legs])
            found += zip(legs.tolist(), owners[items].tolist(), values.tolist())
        return [self.in_prism(a, b, pair) for pair in self.merged(found)] + self.others(a, b, below)

    def merged(self, found):
        least = {}
        for leg, solid, value in found:
            key = leg, solid
            least[key] = min(least.get(key, np.inf), value)
        return [(leg, solid, value) for (leg, solid), value in least.items()]

    def in_prism(self, a, b, pair):
        """The depth in a prism is that in all of it, not in the triangles that it is cut into."""
        leg, solid, value = pair
        if value < 1e-9 and self.solids[solid].kind == "prism":
            value = self.solids[solid].least(a[leg], b[leg])
        return leg, solid, value

    def others(self, a, b, below):
        found = []
        for n, solid in enumerate(self.solids):
            if solid.kind == "keep_in":
                half = np.linalg.norm(b - a, axis=1) / 2
                for leg in np.nonzero(solid.at((a + b) / 2) - half < below)[0].tolist():
                    value = solid.least(a[leg], b[leg])
                    if value < below:
                        found.append((leg, n, value))
        return found

    def nearest(self, a, b):
        """(distance, leg, solid) of the nearest pair of all, or None where there is nothing."""
        if not self.solids or not len(a):
            return None
        bound = min(float(solid.at(a).min()) for solid in self.solids)
        pairs = self.least(a, b, bound + 1e-6)
        value, leg, solid = min((v, l, s) for l, s, v in pairs)
        return value, leg, solid
