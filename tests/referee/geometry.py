# SPDX-License-Identifier: Apache-2.0
"""Distances of straight legs from sets of points, with formulas of the referee's own.

Nothing is taken from the library: a convex solid's signed distance is a convex function, so that its
least value on a leg is found by golden section; what is not convex is found by branch and bound."""
import numpy as np

GOLDEN = (np.sqrt(5) - 1) / 2
STEPS = 64  # 0.618^64 of 100 km is 4e-9 m


def along(a, b, t):
    return a + (b - a) * t[..., None]


def convex_min(f, a, b):
    """The least values of a convex f on the legs a[i], b[i] (arrays of points), one each."""
    low, high = np.zeros(len(a)), np.ones(len(a))
    t1, t2 = low + (1 - GOLDEN) * (high - low), low + GOLDEN * (high - low)
    f1, f2 = f(along(a, b, t1)), f(along(a, b, t2))
    best = np.minimum(f(a), f(b))
    for _ in range(STEPS):
        left = f1 < f2
        high, low = np.where(left, t2, high), np.where(left, low, t1)
        t_new = np.where(left, low + (1 - GOLDEN) * (high - low), low + GOLDEN * (high - low))
        f_new = f(along(a, b, t_new))
        t1, t2 = np.where(left, t_new, t2), np.where(left, t1, t_new)
        f1, f2 = np.where(left, f_new, f2), np.where(left, f1, f_new)
        best = np.minimum(best, f_new)
    return best


def min_by_bounds(f, bound, a, b, tolerance=1e-7):
    """The least value on all legs together of an f that changes by at most 1 m in a metre, and of
    which `bound` gives lower bounds on short pieces. The tighter they are the sooner it ends."""
    a, b = np.asarray(a, float).reshape(-1, 3), np.asarray(b, float).reshape(-1, 3)
    best = float(min(f(a).min(), f(b).min()))
    while len(a):
        middle = (a + b) / 2
        half = np.linalg.norm(b - a, axis=1) / 2
        value = f(middle)
        best = min(best, float(value.min()))
        open_ = np.maximum(value - half, bound(a, b)) < best - tolerance
        a, b, middle = a[open_], b[open_], middle[open_]
        a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
    return best


def edges_of(rings):
    return (np.concatenate(list(rings)), np.concatenate([np.roll(r, -1, axis=0) for r in rings]))


def polygon_bounds(a, b, rings):
    """(lower, upper) bounds on short pieces a[i], b[i] of the depth in a polygon on the plane. The
    distance from an edge is convex: not above its greater end, not below its tangent."""
    p, q = edges_of(rings)
    low_end, high_end = point_segments(a[:, None, :2], p, q), point_segments(b[:, None, :2], p, q)
    middle, half = (a + b)[:, None, :2] / 2, np.linalg.norm((b - a)[:, :2], axis=1)[:, None] / 2
    d = q - p
    square = np.maximum((d * d).sum(-1), 1e-300)
    near = p + np.clip(((middle - p) * d).sum(-1) / square, 0, 1)[..., None] * d
    away = middle - near
    at = np.hypot(away[..., 0], away[..., 1])
    slope = np.abs((away * (b - a)[:, None, :2]).sum(-1)) / np.maximum(at, 1e-300) / 2
    tangent = np.where(at > 0, at - np.minimum(slope, half), 0)
    least, greatest = tangent.min(1), np.maximum(low_end, high_end).min(1)
    depth = -polygon(middle[:, 0], rings)
    half = half[:, 0]
    crosses_ = least <= 0
    return (np.where(crosses_, depth - half, np.where(depth > 0, least, -greatest)),
            np.where(crosses_, depth + half, np.where(depth > 0, greatest, -least)))


def disc_bounds(a, b, centre, radius):
    """The same of a disc, whose depth is concave."""
    ends = [radius - np.hypot(*(p[:, :2] - centre).T) for p in (a, b)]
    lower = np.minimum(*ends)
    half = np.linalg.norm((b - a)[:, :2], axis=1) / 2
    return lower, np.minimum((ends[0] + ends[1]) / 2 + half, radius)


def upright_bounds(plane, a, b, low, high):
    """The same of what stands upright on it: a depth grows with that on the plane and that in z."""
    z0, z1 = a[:, 2], b[:, 2]
    vertical = (np.minimum(np.minimum(z0, z1) - low, high - np.maximum(z0, z1)),
                np.minimum(np.maximum(z0, z1) - low, high - np.minimum(z0, z1)))
    return tuple(np.where((p > 0) & (v > 0), np.minimum(p, v),
                          -np.hypot(np.minimum(p, 0), np.minimum(v, 0)))
                 for p, v in zip(plane, vertical))


def point_segments(p, a, b):
    """Distances on the plane of the points p[i] from the segments a[i], b[i] (broadcast)."""
    d = b - a
    square = (d * d).sum(-1)
    t = ((p - a) * d).sum(-1) / np.where(square > 0, square, 1)
    near = a + np.clip(t, 0, 1)[..., None] * d
    return np.hypot(p[..., 0] - near[..., 0], p[..., 1] - near[..., 1])


def upright(plane, z, low, high):
    """Signed distance of what stands upright, from that on the plane and its lower and upper ends."""
    vertical = np.maximum(low - z, z - high)
    outside = np.hypot(np.maximum(plane, 0), np.maximum(vertical, 0))
    return np.where((plane > 0) | (vertical > 0), outside, np.maximum(plane, vertical))


def sphere(p, centre, radius):
    return np.sqrt(((p - centre) ** 2).sum(-1)) - radius


def cylinder(p, centre, radius, low, high):
    plane = np.hypot(p[..., 0] - centre[..., 0], p[..., 1] - centre[..., 1]) - radius
    return upright(plane, p[..., 2], low, high)


def box(p, low, high):
    q = np.maximum(low - p, p - high)
    outside = np.sqrt((np.maximum(q, 0) ** 2).sum(-1))
    return np.where((q > 0).any(-1), outside, q.max(-1))


def triangle_prism(p, corners, low, high):
    """`corners[i]`: three points of the plane against the clock."""
    xy = p[..., :2]
    edge, inside = np.inf, True
    for i in range(3):
        a, b = corners[..., i, :], corners[..., (i + 1) % 3, :]
        edge = np.minimum(edge, point_segments(xy, a, b))
        inside = inside & (cross(b - a, xy - a) >= 0)
    return upright(np.where(inside, -edge, edge), p[..., 2], low, high)


def cross(u, v):
    return u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]


def polygon(xy, rings):
    """Signed distance on the plane from a polygon: its outline and its holes, by even and odd."""
    edge = np.full(len(xy), np.inf)
    inside = np.zeros(len(xy), bool)
    for ring in rings:
        for a, b in zip(ring, np.roll(ring, -1, axis=0)):
            edge = np.minimum(edge, point_segments(xy, a, b))
            crosses = (a[1] > xy[:, 1]) != (b[1] > xy[:, 1])
            if a[1] != b[1]:
                x = a[0] + (xy[:, 1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
                inside ^= crosses & (xy[:, 0] < x)
    return np.where(inside, -edge, edge)


def area(ring):
    return float(cross(ring, np.roll(ring, -1, axis=0)).sum()) / 2


def bridged(outline, holes):
    """One ring of the outline with its holes, each joined by a bridge flown twice."""
    ring = [tuple(p) for p in (outline if area(outline) > 0 else outline[::-1])]
    for hole in sorted(holes, key=lambda h: -max(p[0] for p in h)):
        hole = [tuple(p) for p in (hole if area(hole) < 0 else hole[::-1])]
        k = max(range(len(hole)), key=lambda i: hole[i][0])
        hole = hole[k:] + hole[:k]
        others = [h for h in map(list, holes)]
        for i in sorted(range(len(ring)), key=lambda i: np.hypot(ring[i][0] - hole[0][0],
                                                                 ring[i][1] - hole[0][1])):
            if sees(ring[i], hole[0], ring, others) and opens(ring, i, hole[0]):
                ring = ring[:i + 1] + hole + hole[:1] + ring[i:]
                break
        else:
            raise ValueError("a hole that no bridge reaches")
    return ring


def opens(ring, i, p):
    """Whether the way from corner i of a ring against the clock to p begins inside of it."""
    before, at, after = (np.array(ring[(i + k) % len(ring)]) for k in (-1, 0, 1))
    p = np.array(p)
    left_of_in, left_of_out = cross(at - before, p - at) > 0, cross(after - at, p - at) > 0
    if cross(at - before, after - at) >= 0:
        return left_of_in and left_of_out
    return left_of_in or left_of_out


def sees(p, q, ring, holes):
    for points in [ring, *holes]:
        for i, a in enumerate(points):
            b = points[(i + 1) % len(points)]
            a, b = tuple(a), tuple(b)
            if p in (a, b) or q in (a, b):
                continue
            if crosses(p, q, a, b):
                return False
    return True


def crosses(p, q, a, b):
    side = [cross(np.subtract(v, u), np.subtract(w, u))
            for u, v, w in ((p, q, a), (p, q, b), (a, b, p), (a, b, q))]
    return side[0] * side[1] <= 0 and side[2] * side[3] <= 0


def triangles(outline, holes=()):
    """Triangles whose union is the polygon, by cutting off ears."""
    ring = [np.array(p, float) for p in bridged(np.asarray(outline, float),
                                                [np.asarray(h, float) for h in holes])]
    cut = []
    while len(ring) > 3:
        for i in range(len(ring)):
            a, b, c = ring[i - 1], ring[i], ring[(i + 1) % len(ring)]
            turn = cross(b - a, c - b)
            if turn == 0 and np.dot(b - a, c - b) >= 0 or turn > 0 and not any(
                    holds(a, b, c, p) for p in ring if not same(p, a, b, c)):
                if turn > 0:
                    cut.append((a, b, c))
                del ring[i]
                break
        else:
            raise ValueError("an outline that meets itself")
    if cross(ring[1] - ring[0], ring[2] - ring[1]) > 0:
        cut.append(tuple(ring))
    return np.array(cut)


def same(p, *others):
    return any((p == q).all() for q in others)


def holds(a, b, c, p):
    return cross(b - a, p - a) >= 0 and cross(c - b, p - b) >= 0 and cross(a - c, p - c) >= 0
