# SPDX-License-Identifier: Apache-2.0
"""Elevation models read a second time, plainly: map projections, bilinear ground, heights of legs above it
(the extremes of a quadratic over each cell), and distances to it (minimised over each cell)."""
import json
import math
import pathlib
import subprocess
import tempfile

import numpy as np

WGS84 = (6378137.0, 1 / 298.257223563)
BESSEL = (6377397.155, 1 / 299.1528128)
GRID = np.linspace(-1, 1, 13)


def affine(lon0, lat0, middle_lat):
    """East and north by the radii of curvature at the middle latitude."""
    a, f = WGS84
    e2, s = f * (2 - f), math.sin(math.radians(middle_lat))
    w = math.sqrt(1 - e2 * s * s)
    east = math.radians(1) * a / w * math.cos(math.radians(middle_lat))
    north = math.radians(1) * a * (1 - e2) / w**3
    return lambda lon, lat: ((lon - lon0) * east, (lat - lat0) * north)


def utm(zone):
    """Transverse Mercator by Krueger's series to the sixth order (Karney 2011, equation 35)."""
    a, f = WGS84
    n, e = f / (2 - f), math.sqrt(f * (2 - f))
    radius = 0.9996 * a / (1 + n) * (1 + n**2 / 4 + n**4 / 64 + n**6 / 256)
    alpha = [
        n / 2 - 2 / 3 * n**2 + 5 / 16 * n**3 + 41 / 180 * n**4 - 127 / 288 * n**5 + 7891 / 37800 * n**6,
        13 / 48 * n**2 - 3 / 5 * n**3 + 557 / 1440 * n**4 + 281 / 630 * n**5 - 1983433 / 1935360 * n**6,
        61 / 240 * n**3 - 103 / 140 * n**4 + 15061 / 26880 * n**5 + 167603 / 181440 * n**6,
        49561 / 161280 * n**4 - 179 / 168 * n**5 + 6601661 / 7257600 * n**6,
        34729 / 80640 * n**5 - 3418889 / 1995840 * n**6,
        212378941 / 319334400 * n**6]

    def forward(lon, lat):
        turn = math.radians(math.remainder(lon - (6 * zone - 183), 360))
        tau = math.tan(math.radians(lat))
        sigma = math.sinh(e * math.atanh(e * tau / math.hypot(1, tau)))
        tau = tau * math.hypot(1, sigma) - sigma * math.hypot(1, tau)
        xi = math.atan2(tau, math.cos(turn))
        eta = math.asinh(math.sin(turn) / math.hypot(tau, math.cos(turn)))
        north = xi + sum(v * math.sin(2 * j * xi) * math.cosh(2 * j * eta) for j, v in enumerate(alpha, 1))
        east = eta + sum(v * math.cos(2 * j * xi) * math.sinh(2 * j * eta) for j, v in enumerate(alpha, 1))
        return 500000 + radius * east, radius * north

    return forward


def to_bessel(lon, lat):
    """WGS 84 to CH1903 by the three parameters of EPSG's transformation, at height 0."""
    a, f = WGS84
    lon, lat = math.radians(lon), math.radians(lat)
    e2 = f * (2 - f)
    n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
    x = n * math.cos(lat) * math.cos(lon) - 674.374
    y = n * math.cos(lat) * math.sin(lon) - 15.056
    z = n * (1 - e2) * math.sin(lat) - 405.346
    a, f = BESSEL
    e2, p, lat = f * (2 - f), math.hypot(x, y), math.atan2(z, math.hypot(x, y))
    for _ in range(12):
        n = a / math.sqrt(1 - e2 * math.sin(lat) ** 2)
        lat = math.atan2(z + e2 * n * math.sin(lat), p)
    return math.atan2(y, x), lat


def swiss(lon, lat):
    """CH1903 / LV03 by swisstopo's formulas: to a sphere, turned, and to Mercator's map."""
    a, f = BESSEL
    e2 = f * (2 - f)
    e, lat0, lon0 = math.sqrt(e2), math.radians(46.9524055555556), math.radians(7.43958333333333)
    radius = a * math.sqrt(1 - e2) / (1 - e2 * math.sin(lat0) ** 2)
    alpha = math.sqrt(1 + e2 / (1 - e2) * math.cos(lat0) ** 4)
    b0 = math.asin(math.sin(lat0) / alpha)

    def isometric(phi):
        return math.asinh(math.tan(phi)) - e * math.atanh(e * math.sin(phi))

    lon, lat = to_bessel(lon, lat)
    s = math.asinh(math.tan(b0)) + alpha * (isometric(lat) - isometric(lat0))
    b, turn = math.atan(math.sinh(s)), alpha * (lon - lon0)
    east = math.atan2(math.sin(turn), math.sin(b0) * math.tan(b) + math.cos(b0) * math.cos(turn))
    up = math.cos(b0) * math.sin(b) - math.sin(b0) * math.cos(b) * math.cos(turn)
    return 600000 + radius * east, 200000 + radius * math.atanh(up)


def gdal(*words):
    return subprocess.run([str(w) for w in words], check=True, capture_output=True, text=True).stdout


class Model:
    """Heights at posts, columns from the west and rows from the south, in a local frame in metres."""

    def __init__(self, file):
        self.file = pathlib.Path(file)
        info = json.loads(gdal("gdalinfo", "-json", file))
        columns, rows = info["size"]
        west, dx, _, north, _, dy = info["geoTransform"]
        if self.file.suffix == ".hgt":  # 1201 numbers a row, from the north; its name is a corner
            name = self.file.stem
            heights = np.fromfile(file, ">i2").reshape(rows, columns)
            south = float(name[1:3]) * (1 if name[0] == "N" else -1)
            west = float(name[4:7]) * (1 if name[3] == "E" else -1)
            step = (1 / (columns - 1), 1 / (rows - 1))
        else:
            with tempfile.TemporaryDirectory() as folder:
                raw = pathlib.Path(folder) / "raw"
                gdal("gdal_translate", "-q", "-of", "ENVI", "-ot", "Float32", file, raw)
                heights = np.fromfile(raw, "<f4").reshape(rows, columns)
            west, south, step = west + dx / 2, north + dy * (rows - 0.5), (dx, -dy)
        self.heights = heights[::-1].astype(float)
        code = info["coordinateSystem"]["wkt"]
        if code.startswith("GEOG"):
            self.to_local = affine(west, south, south + (rows - 1) * step[1] / 2)
            self.step = np.array(self.to_local(west + step[0], south + step[1]))
        else:
            forward = swiss if "LV03" in code else utm(int(code.split("UTM zone ")[1].split("N")[0]))
            self.step = np.array(step)

            def local(lon, lat):
                east, north = forward(lon, lat)
                return east - west, north - south

            self.to_local = local
        self.crs = "EPSG:4326" if code.startswith("GEOG") else code
        ring = info["wgs84Extent"]["coordinates"][0]
        self.somewhere = tuple(np.mean(ring[:4], axis=0))
        self.last = np.array([columns - 1, rows - 1])
        self.size = self.last * self.step

    def to_lonlat(self, x, y, near):
        """By Newton's method from a place nearby, for those who make missions."""
        lon, lat = near
        for _ in range(8):
            u, v = self.to_local(lon, lat)
            e, n = self.to_local(lon + 1e-4, lat), self.to_local(lon, lat + 1e-4)
            a, b = (np.array(e) - (u, v)) / 1e-4, (np.array(n) - (u, v)) / 1e-4
            lon, lat = np.array([lon, lat]) + np.linalg.solve(np.array([a, b]).T, (x - u, y - v))
        return float(lon), float(lat)

    def cell(self, posts):
        """The lower left posts of the cells that hold the places, given in posts."""
        return np.clip(np.floor(posts).astype(int), 0, self.last - 1)

    def at(self, posts, cells):
        s, w = (posts - cells).T
        i, j = cells.T
        h = self.heights
        return (1 - w) * ((1 - s) * h[j, i] + s * h[j, i + 1]) + w * (
            (1 - s) * h[j + 1, i] + s * h[j + 1, i + 1])

    def ground(self, x, y):
        """None beyond the posts."""
        posts = np.array([[x, y]]) / self.step
        if not self.holds(x, y):
            return None
        return float(self.at(posts, self.cell(posts))[0])

    def holds(self, x, y, reach=0):
        return bool((np.array([x, y]) >= -reach).all() and (np.array([x, y]) <= self.size + reach).all())

    def pieces(self, a, b, more=()):
        """Parameters at which a leg passes from cell to cell, and at `more`."""
        u, v = np.array(a[:2]) / self.step, np.array(b[:2]) / self.step
        cuts = [np.array([0.0, 1.0]), np.array(more, float)]
        for k in (0, 1):
            lines = np.arange(math.ceil(min(u[k], v[k])), math.floor(max(u[k], v[k])) + 1)
            if u[k] != v[k]:
                cuts.append((lines - u[k]) / (v[k] - u[k]))
        return np.unique(np.clip(np.concatenate(cuts), 0, 1))

    def gaps(self, a, b, cuts):
        """Heights of a leg above the ground as c + b t + a t t of each piece, t from 0 to 1."""
        a, b = np.array(a, float), np.array(b, float)
        first, last = cuts[:-1], cuts[1:]
        middle = (first + last) / 2

        def posts(t):
            return (a[:2] + t[:, None] * (b - a)[:2]) / self.step

        cells = self.cell(posts(middle))
        h0, h1, h2 = (a[2] + t * (b[2] - a[2]) - self.at(posts(t), cells) for t in (first, middle, last))
        return h0, 4 * h1 - 3 * h0 - h2, 2 * (h0 - 2 * h1 + h2)

    def leg(self, a, b):
        """Least and greatest height above ground; None where there is none below a part."""
        if not (self.holds(*a[:2]) and self.holds(*b[:2])):
            return None
        cuts = self.pieces(a, b)
        c, s, q = self.gaps(a, b, cuts)
        with np.errstate(divide="ignore", invalid="ignore"):
            t = np.where(q != 0, np.clip(-s / (2 * q), 0, 1), 0)
        found = np.concatenate([c, c + s + q, c + t * (s + q * t)])
        return found.min(), found.max()

    def circle(self, centre, radius):
        """Least and greatest height above ground of a level circle; None where it leaves the posts."""
        centre = np.array(centre, float)
        if not all(self.holds(*(centre[:2] + radius * np.array(d))) for d in ((1, 0), (-1, 0), (0, 1), (0, -1))):
            return None
        turns = [np.linspace(0, 2 * math.pi, 33)]
        for k in (0, 1):
            low, high = (centre[k] - radius) / self.step[k], (centre[k] + radius) / self.step[k]
            lines = np.arange(math.ceil(low), math.floor(high) + 1) * self.step[k]
            off = np.arccos(np.clip((lines - centre[k]) / radius, -1, 1))
            turns.append(np.concatenate([off, -off]) + k * math.pi / 2)
        cuts = np.unique(np.concatenate(turns) % (2 * math.pi))
        cuts = np.append(cuts, cuts[0] + 2 * math.pi)

        def places(t):
            return (centre[:2] + radius * np.stack([np.cos(t), np.sin(t)], -1)) / self.step

        cells = self.cell(places((cuts[:-1] + cuts[1:]) / 2))
        found = []
        for sign in (1, -1):
            low, high = cuts[:-1], cuts[1:]
            for _ in range(16):
                t = low[:, None] + (high - low)[:, None] * (GRID + 1) / 2
                values = sign * (centre[2] - self.at(places(t).reshape(-1, 2), cells.repeat(GRID.size, 0)))
                best = values.reshape(t.shape).argmin(1)
                rows = np.arange(len(t))
                low, high = t[rows, np.maximum(best - 1, 0)], t[rows, np.minimum(best + 1, GRID.size - 1)]
            found.append(sign * values.min())
        return tuple(found)

    def clipped(self, a, b):
        """The part of a leg that is over the posts, None if there is none."""
        a, b = np.array(a, float), np.array(b, float)
        t0, t1 = 0.0, 1.0
        for k in (0, 1):
            if a[k] == b[k]:
                if not 0 <= a[k] <= self.size[k]:
                    return None
                continue
            u, v = sorted((-a[k] / (b[k] - a[k]), (self.size[k] - a[k]) / (b[k] - a[k])))
            t0, t1 = max(t0, u), min(t1, v)
        if t0 >= t1:
            return None
        found = [a + t * (b - a) for t in (t0, t1)]
        for p in found:
            p[:2] = np.clip(p[:2], 0, self.size)
        return found

    def steepest(self, low, high):
        """Greatest slope of the cells that a rectangle touches."""
        i0, j0 = self.cell(np.array([low]) / self.step)[0] - 1
        i1, j1 = self.cell(np.array([high]) / self.step)[0] + 2
        h = self.heights[max(j0, 0):j1 + 1, max(i0, 0):i1 + 1]
        ex, ey = np.abs(np.diff(h, axis=1)) / self.step[0], np.abs(np.diff(h, axis=0)) / self.step[1]
        return math.hypot(ex.max(), ey.max())

    def distance(self, a, b, r):
        """From a leg that is above the ground to the ground, exact where it is below r, else r or more."""
        a, b = np.array(a, float), np.array(b, float)
        return min((self.distance_to(c, a, b, r) for c in self.cells_about(a, b, r)), default=r)

    def cells_about(self, a, b, r):
        """Cells that come within r of the leg, as far as boxes tell."""
        cuts = self.pieces(a, b)
        found = set()
        for t0, t1 in zip(cuts[:-1], cuts[1:], strict=True):
            p, q = a + t0 * (b - a), a + t1 * (b - a)
            i0, j0 = self.cell((np.minimum(p, q)[None, :2] - r) / self.step)[0]
            i1, j1 = self.cell((np.maximum(p, q)[None, :2] + r) / self.step)[0]
            for i in range(i0, i1 + 1):
                for j in range(j0, j1 + 1):
                    if self.heights[j:j + 2, i:i + 2].max() + r > min(p[2], q[2]):
                        found.add((i, j))
        return found

    def distance_to(self, cell, a, b, r):
        h = self.heights[cell[1]:cell[1] + 2, cell[0]:cell[0] + 2]
        way = b - a
        square = max(way @ way, 1e-30)

        def off(s, w):
            z = (1 - w) * ((1 - s) * h[0, 0] + s * h[0, 1]) + w * ((1 - s) * h[1, 0] + s * h[1, 1])
            p = np.array([(cell[0] + s) * self.step[0], (cell[1] + w) * self.step[1], z])
            t = np.clip(np.tensordot(way, p - a.reshape(3, *[1] * (p.ndim - 1)), 1) / square, 0, 1)
            return p - a.reshape(3, *[1] * (p.ndim - 1)) - way.reshape(3, *[1] * (p.ndim - 1)) * t

        def tries(s0, w0, half):
            s, w = (np.clip(v, 0, 1).ravel() for v in np.meshgrid(s0 + half * GRID, w0 + half * GRID))
            return np.linalg.norm(off(s, w), axis=0), s, w

        found, s, w = tries(0.5, 0.5, 0.5)
        order = np.argsort(found)
        slope = math.hypot(1, self.steepest_of(h))
        if found[order[0]] - slope * np.linalg.norm(self.step) / 24 > r:
            return r
        best = r
        below = [np.clip(end[:2] / self.step - cell, 0, 1) for end in (a, b)]
        for at in [(s[k], w[k]) for k in (order[0], order[5], order[20])] + below:
            half = 1 / 6
            while half > 1e-9:
                near, u, v = tries(*at, half)
                k = near.argmin()
                best, at, half = min(best, near[k]), (u[k], v[k]), half / 3
        return best

    def steepest_of(self, h):
        return math.hypot(np.abs(np.diff(h, axis=1)).max() / self.step[0],
                          np.abs(np.diff(h, axis=0)).max() / self.step[1])
