# SPDX-License-Identifier: Apache-2.0
"""A made-up world for missions: ground from a grid, zones with floors and ceilings, fences; and the files
that `altiplan check` reads of them."""
import datetime
import json
import math

import numpy as np

GEOGRAPHIC = ('GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
              'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
START = datetime.datetime(2026, 5, 1, 10, tzinfo=datetime.timezone.utc)
ALWAYS = (-math.inf, math.inf)


class World:
    """Ground over a grid of latitude and longitude; x east and y north of its middle, in metres."""

    def __init__(self, heights, lat, lon, cell_deg):
        self.heights = np.round(np.asarray(heights, float), 2)  # rows from south to north; as in the file
        self.lat, self.lon, self.cell_deg = lat, lon, cell_deg
        e2, sine = 0.00669437999014, math.sin(math.radians(lat))
        w = math.sqrt(1 - e2 * sine * sine)
        self.north = math.radians(1) * 6378137 * (1 - e2) / w**3
        self.east = math.radians(1) * 6378137 / w * math.cos(math.radians(lat))
        steps = [np.abs(np.diff(self.heights, axis=k)).max() for k in (0, 1)]
        self.slope = math.hypot(steps[0] / (cell_deg * self.north), steps[1] / (cell_deg * self.east))

    def to_local(self, lat, lon):
        return np.array([(lon - self.lon) * self.east, (lat - self.lat) * self.north])

    def to_degrees(self, x, y):
        """Latitude and longitude, to the 1e-7 degrees that an autopilot stores."""
        return round(self.lat + y / self.north, 7), round(self.lon + x / self.east, 7)

    def ground(self, places):
        """Bilinear between the middles of cells; NaN beyond them."""
        places = np.asarray(places, float)
        rows, columns = self.heights.shape
        u = places[..., 0] / self.east / self.cell_deg + (columns - 1) / 2
        v = places[..., 1] / self.north / self.cell_deg + (rows - 1) / 2
        beyond = ~((u >= 0) & (v >= 0) & (u <= columns - 1) & (v <= rows - 1))
        u, v = np.where(beyond, 0, u), np.where(beyond, 0, v)
        j, i = np.minimum(u.astype(int), columns - 2), np.minimum(v.astype(int), rows - 2)
        u, v, h = u - j, v - i, self.heights
        mixed = ((1 - u) * h[i, j] + u * h[i, j + 1]) * (1 - v) + ((1 - u) * h[i + 1, j] + u * h[i + 1, j + 1]) * v
        return np.where(beyond, np.nan, mixed)

    def write(self, file):
        rows, columns = self.heights.shape
        corner = [middle - size * self.cell_deg / 2 for middle, size in ((self.lon, columns), (self.lat, rows))]
        lines = [f"ncols {columns}", f"nrows {rows}", f"xllcorner {corner[0]!r}", f"yllcorner {corner[1]!r}",
                 f"cellsize {self.cell_deg!r}", "NODATA_value -9999"]
        lines += [" ".join(f"{h:.2f}" for h in row) for row in self.heights[::-1]]
        file.write_text("\n".join(lines) + "\n")
        file.with_suffix(".prj").write_text(GEOGRAPHIC)


def flat(height=0.0, lat=47.0, lon=8.0, size=121, cell_deg=0.001):
    return World(np.full((size, size), height), lat, lon, cell_deg)


def hills(rng, relief, size=121):
    """Waves of some hundred metres to kilometres; the grid is about 13 by 9 km."""
    lat, cell = 47.0 + rng.uniform(-8, 8), 0.001
    y, x = np.mgrid[0:size, 0:size] * 100.0
    heights = np.full((size, size), rng.uniform(5, 900))
    for _ in range(6):
        length, way = rng.uniform(900, 4000), rng.uniform(0, 2 * math.pi)
        phase = 2 * math.pi / length * (x * math.cos(way) + y * math.sin(way)) + rng.uniform(0, 6.3)
        heights += relief / 6 * np.sin(phase)
    return World(heights, lat, 8.0 + rng.uniform(-3, 3), cell)


# --- shapes


def ring_distance(ring, places):
    """Distance from a polygon's outline, negative inside."""
    a, b = ring, np.roll(ring, -1, axis=0)
    way = b - a
    off = places[:, None, :] - a[None]
    t = np.clip((off * way).sum(2) / np.maximum((way * way).sum(1), 1e-12), 0, 1)
    distance = np.hypot(*np.moveaxis(off - t[..., None] * way, 2, 0)).min(1)
    x, y = places[:, :1], places[:, 1:]
    spans = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        crossing = a[:, 0] + (y - a[:, 1]) / way[:, 1] * way[:, 0]
    inside = (spans & (x < crossing)).sum(1) % 2 == 1
    return np.where(inside, -distance, distance)


class Shape:
    """A polygon or a circle; `doubt` is how far an autopilot's flat radius may be off."""

    def __init__(self, ring=None, centre=None, radius=0.0):
        self.ring = None if ring is None else np.asarray(ring, float)
        self.centre, self.radius = centre, radius
        self.doubt = 0.007 * radius

    def distance(self, places):
        if self.ring is None:
            return np.hypot(*(places - self.centre).T) - self.radius
        return ring_distance(self.ring, places)


class Zone:
    """Prohibited between two heights above the sea or the ground, while closed (seconds after the start)."""

    def __init__(self, ring, floor, ceiling, datum="AMSL", closed=ALWAYS):
        self.shape, self.floor, self.ceiling = Shape(ring), round(floor, 2), round(ceiling, 2)
        self.datum, self.closed = datum, closed

    def feature(self, world, name):
        corners = [list(world.to_degrees(*p)[::-1]) for p in self.shape.ring]
        times = {"permanent": "YES"}
        if self.closed != ALWAYS:
            days = [START + datetime.timedelta(seconds=max(min(t, 3e7), -3e7)) for t in self.closed]
            stamps = [day.strftime("%Y-%m-%dT%H:%M:%SZ") for day in days]
            times = {"startDateTime": stamps[0], "endDateTime": stamps[1], "permanent": "NO"}
        geometry = {"uomDimensions": "M", "lowerLimit": self.floor, "lowerVerticalReference": self.datum,
                    "upperLimit": self.ceiling, "upperVerticalReference": self.datum,
                    "horizontalProjection": {"type": "Polygon", "coordinates": [corners + corners[:1]]}}
        return {"identifier": name, "country": "CHE", "name": name, "type": "COMMON",
                "restriction": "PROHIBITED", "reason": ["OTHER"], "zoneAuthority": [],
                "applicability": [times], "geometry": [geometry]}


def write_zones(zones, world, file):
    """ED-269: plain GeoJSON has no heights that `check` reads without a scenario."""
    features = [zone.feature(world, f"Z{n}") for n, zone in enumerate(zones)]
    file.write_text(json.dumps({"title": "made up", "features": features}))


class Fence:
    def __init__(self, shape, keeps_in):
        self.shape, self.keeps_in = shape, keeps_in


def read_fences(plan, world):
    found = []
    for polygon in plan["geoFence"].get("polygons", []):
        ring = [world.to_local(*corner) for corner in polygon["polygon"]]
        found.append(Fence(Shape(ring), polygon["inclusion"]))
    for circle in plan["geoFence"].get("circles", []):
        made = Shape(None, world.to_local(*circle["circle"]["center"]), circle["circle"]["radius"])
        found.append(Fence(made, circle["inclusion"]))
    return found


def square(x, y, half, turn=0.0):
    corners = [(half * math.sqrt(2) * math.cos(a), half * math.sqrt(2) * math.sin(a))
               for a in (turn + math.pi / 4 + k * math.pi / 2 for k in range(4))]
    return [(x + dx, y + dy) for dx, dy in corners]


def box(x0, y0, x1, y1):
    return [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
