# SPDX-License-Identifier: Apache-2.0
"""Ground: posts of an elevation model, bilinear between them, and hills of a formula."""
import os
import subprocess
import tempfile

import numpy as np


class Grid:
    """Heights of posts: `heights[row, column]` from the south-west, `step` (east, north) apart."""

    def __init__(self, heights, step, origin=(0.0, 0.0)):
        self.heights = np.asarray(heights, float)
        self.step, self.origin = np.array(step, float), np.array(origin, float)
        self.counts = np.array([self.heights.shape[1], self.heights.shape[0]])

    def cells(self, xy):
        """Places in units of posts, and the cells that they lie in, the last ones closed."""
        u = (xy - self.origin) / self.step
        return u, np.clip(np.floor(u).astype(int), 0, self.counts - 2)

    def in_cell(self, cell, u):
        i, j = cell[..., 0], cell[..., 1]
        s, t = u[..., 0] - i, u[..., 1] - j
        h = self.heights
        return ((1 - s) * (1 - t) * h[j, i] + s * (1 - t) * h[j, i + 1]
                + (1 - s) * t * h[j + 1, i] + s * t * h[j + 1, i + 1])

    def height(self, xy):
        """NaN beyond the posts."""
        u, cell = self.cells(np.asarray(xy, float))
        beyond = (u < -1e-9).any(-1) | (u > self.counts - 1 + 1e-9).any(-1)
        return np.where(beyond, np.nan, self.in_cell(cell, u))

    def gaps(self, a, b):
        """(least, greatest) height above the ground of each leg a[i], b[i], NaN beyond the posts."""
        found = np.array([self.gap_of(p, q) for p, q in zip(a, b)])
        beyond = np.isnan(self.height(a[:, :2])) | np.isnan(self.height(b[:, :2]))
        found[beyond] = np.nan
        return found

    def gap_of(self, a, b):
        """Between two lines of posts the ground below a straight leg is a quadratic, which three of
        its heights fix."""
        ua, ub = (a[:2] - self.origin) / self.step, (b[:2] - self.origin) / self.step
        cuts = [np.array([0.0, 1.0])]
        for k in (0, 1):
            if ua[k] != ub[k]:
                low, high = sorted((ua[k], ub[k]))
                lines = np.arange(np.ceil(low), np.floor(high) + 1)
                cuts.append((lines - ua[k]) / (ub[k] - ua[k]))
        t = np.unique(np.clip(np.concatenate(cuts), 0, 1))
        t0, t1 = t[:-1], t[1:]
        if not len(t0):
            t0, t1 = np.array([0.0]), np.array([1.0])
        middle = (t0 + t1) / 2
        cell = np.floor(ua + (ub - ua) * middle[:, None]).astype(int)
        cell = np.clip(cell, 0, self.counts - 2)

        def gap(s):
            return a[2] + (b[2] - a[2]) * s - self.in_cell(cell, ua + (ub - ua) * s[:, None])

        g0, gm, g1 = gap(t0), gap(middle), gap(t1)
        bend, slope = 2 * (g0 + g1 - 2 * gm), 4 * gm - 3 * g0 - g1  # g0 + slope s + bend s^2
        with np.errstate(divide="ignore", invalid="ignore"):
            vertex = np.where(bend != 0, -slope / (2 * bend), 0)
        at_vertex = gap(t0 + (t1 - t0) * np.clip(vertex, 0, 1))
        values = np.concatenate([g0, g1, at_vertex])
        return float(values.min()), float(values.max())

    def steepest(self):
        h = self.heights
        east = np.abs(np.diff(h, axis=1)).max() / self.step[0]
        north = np.abs(np.diff(h, axis=0)).max() / self.step[1]
        return float(np.hypot(east, north))


class Hills:
    """min(cap, base + sum of h exp(-((x - x0) / sx)^2 / 2 - ((y - y0) / sy)^2 / 2))."""

    def __init__(self, base, cap, peaks):
        self.base, self.cap = base, cap
        self.peaks = [(np.array(at, float), float(h), np.array(s, float)) for at, h, s in peaks]

    def height(self, xy):
        xy = np.asarray(xy, float)
        total = np.full(xy.shape[:-1], float(self.base))
        for at, h, sigma in self.peaks:
            total = total + h * np.exp(-(((xy - at) / sigma) ** 2).sum(-1) / 2)
        return np.minimum(total, self.cap)

    def gaps(self, a, b):
        """(least, greatest) height above the ground of each leg a[i], b[i]: a comb along it, made
        finer about its extremes until nothing changes."""
        width = min([s.min() for _, _, s in self.peaks], default=1e9)
        length = np.hypot(*(b - a)[:, :2].T)
        teeth = 2 ** np.ceil(np.log2(np.clip(length / width * 40, 16, 2**14))).astype(int)
        found = np.empty((len(a), 2))
        for count in np.unique(teeth):
            legs = np.nonzero(teeth == count)[0]
            for part in np.array_split(legs, max(1, len(legs) * count // 200000)):
                found[part] = self.combed(a[part], b[part], count)
        return found

    def combed(self, a, b, count):
        def gap(t):
            p = a[:, None] + (b - a)[:, None] * t.reshape(len(a), -1)[..., None]
            return (p[..., 2] - self.height(p[..., :2])).reshape(t.shape)

        t = np.broadcast_to(np.linspace(0, 1, count + 1), (len(a), count + 1))
        at = gap(t)
        order = np.argsort(at, axis=1)
        tops = np.take_along_axis(t, np.concatenate([order[:, :4], order[:, -4:]], axis=1), axis=1)
        sign = np.repeat([1, -1], 4)[None, :, None]
        low, high = ((tops + d / count).clip(0, 1) for d in (-1, 1))
        for _ in range(16):
            comb = np.linspace(low, high, 9, axis=2)
            n = (sign * gap(comb)).argmin(axis=2)[..., None]
            low = np.take_along_axis(comb, np.maximum(n - 1, 0), axis=2)[..., 0]
            high = np.take_along_axis(comb, np.minimum(n + 1, 8), axis=2)[..., 0]
        found = gap((low + high) / 2)
        return np.stack([np.minimum(at.min(1), found.min(1)), np.maximum(at.max(1), found.max(1))], 1)

    def steepest(self):
        return float(sum(h * np.exp(-0.5) / s.min() for _, h, s in self.peaks))


def numbers_of(path):
    """The header of an ESRI grid, in small letters, and its rows."""
    header, rows = {}, []
    with open(path, encoding="utf-8") as file:
        for line in file:
            words = line.split()
            if words and words[0][0].isalpha():
                header[words[0].lower()] = float(words[1])
            elif words:
                rows.append([float(w) for w in words])
    counts = int(header["nrows"]), int(header["ncols"])
    return header, np.array([v for row in rows for v in row]).reshape(counts)


def posts(path):
    """(heights from the south-west as 32-bit floats, (east, north) of the south-west post, step)."""
    if not path.lower().endswith(".asc"):
        with tempfile.TemporaryDirectory() as folder:
            grid = os.path.join(folder, "grid.asc")
            subprocess.run(["gdal_translate", "-q", "-of", "AAIGrid", "-co", "FORCE_CELLSIZE=NO",
                            "-co", "DECIMAL_PRECISION=9", path, grid], check=True, timeout=600)
            return posts(grid)
    header, heights = numbers_of(path)
    step = (header.get("dx", header.get("cellsize")), header.get("dy", header.get("cellsize")))
    corner = [header.get("xllcorner"), header.get("yllcorner")]
    for k, name in enumerate(("xllcenter", "yllcenter")):
        corner[k] = header[name] if name in header else corner[k] + step[k] / 2
    if (heights == header.get("nodata_value", np.nan)).any():
        raise ValueError(f"{path}: voids are not judged")
    return heights[::-1].astype(np.float32).astype(float), corner, step
