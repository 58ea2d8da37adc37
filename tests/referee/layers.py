# SPDX-License-Identifier: Apache-2.0
"""Layers of a scenario, from what docs/reference/files.md and the READMEs of plugins say that they mean."""
import csv
import dataclasses
import datetime
import json
import os

import numpy as np

import solids
import terrain
from frame import Frame


class NotJudged(Exception):
    """What the referee has no geometry for."""


@dataclasses.dataclass
class Layer:
    id: str
    solids: list
    ground: object = None
    known: bool = True
    velocity: object = None  # of a moving obstacle


def numbers(values):
    return [float(v) for v in values]


def end(of, key, default):
    return float(of[key]) if key in of else default


class Builder:
    """Makes layers in the order of the file; what the frame is, the first one with a place says."""

    def __init__(self, scenario, folder, drawn=None):
        self.folder, self.drawn = folder, drawn
        self.frame, self.grounds, self.plane = None, [], False
        self.level = scenario.get("level_flight_at_m")
        self.start_time = time_of(scenario.get("start_time"))
        frame = scenario.get("frame", {})
        if "origin_lonlat" in frame:
            lon, lat = numbers(frame["origin_lonlat"])
            self.frame = Frame(lon, lat, lat)
        elif frame:
            raise NotJudged("a frame with a coordinate system")

    def point(self, of, height=True):
        if "at_m" in of:
            p = numbers(of["at_m"])
        elif "at_lonlat" in of:
            if self.frame is None:
                raise NotJudged("a longitude without a frame")
            p = numbers(of["at_lonlat"])
            p[:2] = self.frame.metres(*p[:2])
        else:
            raise NotJudged("a point by cells")
        if "above_ground_m" in of:
            p = p[:2] + [self.ground_at(p[:2]) + float(of["above_ground_m"])]
        if len(p) == 2:
            p.append(float(self.level) if self.level is not None and height else 0.0)
        return np.array(p)

    def ground_at(self, xy):
        heights = [g.height(np.array(xy)) for g in self.grounds]
        return float(np.nanmax(heights))

    def layer(self, entry, default_id):
        (kind, of), = [(k, v) for k, v in entry.items() if k not in ("id", "known")]
        id_ = entry.get("id", default_id or kind)
        made = Layer(id_, [], known=entry.get("known", "true") == "true")
        if not isinstance(of, dict):
            of = {}
        if hasattr(self, "do_" + kind):
            getattr(self, "do_" + kind)(of, made)
        elif self.drawn is not None:
            made.solids = self.drawn(id_)
        else:
            raise NotJudged(f"the layer '{kind}'")
        for solid in made.solids:
            solid.layer = id_
        if made.ground is not None:
            self.grounds.append(made.ground)
        return made

    def do_sphere(self, of, made):
        made.solids = [solids.sphere(self.point(of), of["radius_m"])]

    def do_radar(self, of, made):
        if of.get("masking", "false") == "true" or "range_m" not in of:
            raise NotJudged("a radar that is masked, or of an equation")
        made.solids = [solids.sphere(self.point(of), of["range_m"])]

    def do_cylinder(self, of, made):
        made.solids = [solids.cylinder(self.point(of, False), of["radius_m"], *ends(of))]

    def do_box(self, of, made):
        made.solids = [solids.box(numbers(of["min_m"]), numbers(of["max_m"]))]

    def do_prism(self, of, made):
        made.solids = [solids.prism(self.outline(of, "outline"), (), *ends(of))]

    def outline(self, of, key):
        if of.get(key + "_lonlat"):
            return [self.frame.metres(*numbers(p)) for p in of[key + "_lonlat"]]
        return [numbers(p) for p in of[key + "_m"]]

    def do_terrain(self, of, made):
        path = os.path.join(self.folder, of["file"])
        heights, (west, south), step = terrain.posts(path)
        if of.get("voids", "refuse") != "refuse" or self.grounds or self.frame is not None:
            raise NotJudged("terrain with voids, beside other ground or in another frame")
        if abs(west) <= 180 and abs(south) <= 90:
            self.frame = Frame(west, south, south + step[1] * (len(heights) - 1) / 2)
            step = self.frame.east * step[0], self.frame.north * step[1]
        made.ground = terrain.Grid(heights, step)

    def do_hills(self, of, made):
        if "peaks" not in of:
            raise NotJudged("hills that are drawn")
        peaks = [(numbers(p["at_m"]), float(p["height_m"]), numbers(p["sigma_m"]))
                 for p in of["peaks"]]
        made.ground = terrain.Hills(end(of, "base_m", 500.0), end(of, "cap_m", 4000.0), peaks)

    def do_zones(self, of, made):
        kept_in = []
        horizon = datetime.timedelta(seconds=end(of, "horizon_s", 3600.0))
        for zone in of.get("list", []):
            if not self.counts(zone.get("from"), zone.get("until"), horizon):
                continue
            low, high = end(zone, "floor_m", -solids.EVERYWHERE), end(zone, "ceiling_m",
                                                                      solids.EVERYWHERE)
            if "cylinder" in zone:
                solid = solids.cylinder(self.point(zone["cylinder"], False),
                                        zone["cylinder"]["radius_m"], low, high)
            else:
                polygon = zone["polygon"]
                holes = [[numbers(p) for p in ring] for ring in polygon.get("holes_m", [])]
                holes += [[self.frame.metres(*numbers(p)) for p in ring]
                          for ring in polygon.get("holes_lonlat", [])]
                solid = solids.prism(self.outline(polygon, "outline"), holes, low, high)
            (kept_in if zone.get("kind") == "keep_in" else made.solids).append(solid)
        if "file" in of:
            if not set(of) <= {"file", "floor_property", "ceiling_property", "file_kind", "list"}:
                raise NotJudged("zones of a file with more than floors and ceilings")
            found = self.features(of)
            (kept_in if of.get("file_kind") == "keep_in" else made.solids).extend(found)
        if kept_in:
            made.solids.append(solids.keep_in(kept_in))

    def counts(self, since, until, horizon):
        if since is None and until is None:
            return True
        if self.start_time is None:
            raise NotJudged("zones with times, without a start_time")
        return ((since is None or time_of(since) <= self.start_time + horizon)
                and (until is None or time_of(until) >= self.start_time))

    def rings(self, path):
        """(properties, rings in degrees) of each polygon of a GeoJSON."""
        if not path.lower().endswith((".json", ".geojson")):
            raise NotJudged(f"the file '{os.path.basename(path)}'")
        with open(path, encoding="utf-8") as file:
            for feature in json.load(file)["features"]:
                shape = feature["geometry"]
                polygons = {"Polygon": lambda s: [s["coordinates"]],
                            "MultiPolygon": lambda s: s["coordinates"]}
                for polygon in polygons.get(shape["type"], lambda s: [])(shape):
                    yield feature.get("properties") or {}, polygon

    def located(self, path):
        """The same in metres; a file read into a world without a place brings its own."""
        found = list(self.rings(path))
        if self.frame is None:
            every = np.array([p[:2] for _, polygon in found for ring in polygon for p in ring])
            lon, lat = every.min(axis=0)
            self.frame = Frame(lon, lat, (lat + every[:, 1].max()) / 2)
        return [(of, [[self.frame.metres(*p[:2]) for p in ring] for ring in polygon])
                for of, polygon in found]

    def features(self, of):
        found = []
        for properties, rings in self.located(os.path.join(self.folder, of["file"])):
            low = properties.get(of.get("floor_property"), -solids.EVERYWHERE)
            high = properties.get(of.get("ceiling_property"), solids.EVERYWHERE)
            found.append(solids.prism(rings[0], rings[1:], float(low), float(high)))
        return found

    def do_city(self, of, made):
        if of.get("generate", "nothing") != "nothing":
            if self.drawn is None:
                raise NotJudged("a city that is drawn")
            made.solids = self.drawn(made.id)
            return
        path = os.path.join(self.folder, of["file"])
        if path.endswith(".csv"):
            self.colliders(path, made)
            return
        height_key, levels_key = of.get("height_property", "height"), of.get("levels_property")
        for properties, rings in self.located(path):
            height = properties.get(height_key)
            if height is None and levels_key and properties.get(levels_key) is not None:
                height = float(properties[levels_key]) * end(of, "metres_per_level", 3.0)
            height = float(of["default_height_m"] if height is None else height)
            corners = [self.ground_at(p) for ring in rings for p in ring] if self.grounds else []
            base = end(of, "base_m", 0.0)
            low, high = (min(corners), max(corners)) if corners else (base, base)
            made.solids.append(solids.prism(rings[0], rings[1:], low, high + height))

    def colliders(self, path, made):
        with open(path, encoding="utf-8") as file:
            next(file)
            for row in csv.DictReader(file):
                north, east, up, dn, de, du = numbers(row.values())
                made.solids.append(solids.box([east - de, north - dn, up - du],
                                              [east + de, north + dn, up + du]))


def ends(of):
    return end(of, "floor_m", -solids.EVERYWHERE), end(of, "ceiling_m", solids.EVERYWHERE)


def time_of(text):
    return None if text is None else datetime.datetime.fromisoformat(text.replace("Z", "+00:00"))
