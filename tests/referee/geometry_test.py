# SPDX-License-Identifier: Apache-2.0
"""The referee's own geometry, held against dense samples."""
import unittest

import numpy as np

import geometry
import rules
import solids
import terrain
import worlds


def samples(a, b, count=4001):
    return a + (b - a) * np.linspace(0, 1, count)[:, None]


class Distances(unittest.TestCase):
    def setUp(self):
        self.rng = np.random.default_rng(7)

    def hold(self, solid):
        """No sample is nearer than the least, and the nearest is about as near."""
        for _ in range(40):
            a, b = self.rng.uniform(-30, 30, (2, 3))
            value, _, _ = solids.Set([solid]).nearest(a[None], b[None])
            sampled = solid.at(samples(a, b)).min()
            self.assertLessEqual(value, sampled + 1e-6)
            self.assertGreaterEqual(value, sampled - np.linalg.norm(b - a) / 8000 - 1e-6)

    def test_spheres(self):
        self.hold(solids.sphere([1, 2, 3], 8))

    def test_cylinders(self):
        self.hold(solids.cylinder([1, 2], 8, -5, 9))
        self.hold(solids.cylinder([1, 2], 8))

    def test_boxes(self):
        self.hold(solids.box([-5, -9, -3], [8, 2, 12]))

    def test_prisms(self):
        for corners in (3, 5, 9):
            outline = worlds.star(self.rng, (0, 0), 20, corners)
            self.hold(solids.prism(outline, low=-6, high=9))
        hole = [[-2, -2], [2, -2], [2, 2], [-2, 2]]
        self.hold(solids.prism([[-9, -9], [9, -9], [9, 9], [-9, 9]], [hole], -6, 9))

    def test_keep_in(self):
        square = solids.prism([[-20, -20], [20, -20], [20, 20], [-20, 20]], low=-20, high=20)
        self.hold(solids.keep_in([square, solids.cylinder([20, 0], 12, -10, 10)]))

    def test_signed_distances_of_points(self):
        """Of a polygon: the nearest of many places of its border, and even and odd by winding."""
        outline = np.array(worlds.star(self.rng, (0, 0), 20, 8))
        border = np.concatenate([samples(np.append(p, 0), np.append(q, 0), 2000)[:, :2]
                                 for p, q in zip(outline, np.roll(outline, -1, axis=0))])
        for p in self.rng.uniform(-25, 25, (60, 2)):
            angles = np.arctan2(*(outline - p).T[::-1])
            winding = np.angle(np.exp(1j * np.diff(np.append(angles, angles[0])))).sum()
            distance = np.hypot(*(border - p).T).min() * (-1 if abs(winding) > 3 else 1)
            self.assertAlmostEqual(float(geometry.polygon(p[None], [outline])[0]), distance, delta=0.02)

    def test_triangles_make_up_the_polygon(self):
        hole = [[-1, -1], [1, -1], [0, 2]]
        for corners in (3, 4, 7, 12):
            outline = np.array(worlds.star(self.rng, (0, 0), 20, corners))
            room = -geometry.polygon(np.zeros((1, 2)), [outline])[0]
            holes = [hole] if room > 3 else []
            cut = geometry.triangles(outline, holes)
            whole = abs(geometry.area(outline)) - sum(abs(geometry.area(np.array(h))) for h in holes)
            self.assertAlmostEqual(sum(abs(geometry.area(t)) for t in cut), whole, places=6)


class Ground(unittest.TestCase):
    def hold(self, ground, most):
        rng = np.random.default_rng(3)
        for _ in range(25):
            a, b = rng.uniform([5, 5, 50], [most, most, 90], (2, 3))
            (least, greatest), = ground.gaps(a[None], b[None])
            p = samples(a, b, 20001)
            gap = p[:, 2] - ground.height(p[:, :2])
            self.assertLessEqual(least, gap.min() + 1e-9)
            self.assertGreaterEqual(greatest, gap.max() - 1e-9)
            self.assertAlmostEqual(least, gap.min(), delta=0.02)
            self.assertAlmostEqual(greatest, gap.max(), delta=0.02)

    def test_posts(self):
        heights = np.random.default_rng(1).uniform(0, 40, (20, 25))
        self.hold(terrain.Grid(heights, (10.0, 12.0)), 200)

    def test_hills(self):
        rng = np.random.default_rng(2)
        peaks = [(rng.uniform(0, 200, 2), rng.uniform(5, 30), rng.uniform(8, 40, 2)) for _ in range(6)]
        self.hold(terrain.Hills(5, 40, peaks), 200)

    def test_beyond_the_posts_there_is_none(self):
        grid = terrain.Grid(np.zeros((3, 3)), (10, 10))
        self.assertTrue(np.isnan(grid.gaps(np.array([[5., 5, 9]]), np.array([[25., 5, 9]]))).all())


class Turns(unittest.TestCase):
    def turns(self, points, on_the_spot=False):
        return rules.turns(np.array(points, float), on_the_spot)

    def test_a_heading_lasts_through_a_climb(self):
        route = [[0, 0, 0], [100, 0, 0], [100, 0, 20], [100, 100, 20]]
        _, plane, _, radius = self.turns(route)[2]
        self.assertAlmostEqual(plane, 90)
        self.assertEqual(radius, 0)
        self.assertIsNone(self.turns(route, on_the_spot=True)[2][1])

    def test_a_fillet_touches_the_middles_of_the_legs(self):
        """The circle's centre is as far from both legs, and from the points where it touches."""
        a, c, b = np.array([[0, 0, 0], [80, 0, 0], [120, 60, 0]], float)
        (_, _, turn, radius), = self.turns([a, c, b])[1:]
        room = min(np.linalg.norm(c - a), np.linalg.norm(b - c)) / 2
        touch = [c + (a - c) / np.linalg.norm(a - c) * room, c + (b - c) / np.linalg.norm(b - c) * room]
        away = (touch[0] + touch[1]) / 2 - c
        centre = c + away / np.linalg.norm(away) * np.hypot(room, radius)
        self.assertAlmostEqual(turn, 56.309932474)
        for p in touch:
            self.assertAlmostEqual(np.linalg.norm(centre - p), radius)
            self.assertAlmostEqual(np.dot(centre - p, c - p), 0, places=6)

    def test_straight_back_has_no_radius(self):
        self.assertEqual(self.turns([[0, 0, 0], [10, 0, 0], [0, 0, 0]])[1][3], 0)


if __name__ == "__main__":
    unittest.main()
