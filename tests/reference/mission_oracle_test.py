# SPDX-License-Identifier: Apache-2.0
"""The evaluator of mission_oracle.py judged by itself, without the program."""
import math
import random
import sys
import unittest

try:
    import numpy as np
except ModuleNotFoundError:
    print("skipped: no numpy")
    sys.exit(77)

import oracle_commands
import oracle_missions
import oracle_section9
from oracle_flight import arc, spline
from oracle_judge import touched
from oracle_planes import l1_length, l1_track
from oracle_world import hills, read_fences, ring_distance, square


class KnownMissions(unittest.TestCase):
    def test_verdicts_of_section_9(self):
        for name, case, right in oracle_section9.TABLE:
            with self.subTest(name):
                verdict = case.judge()
                why = verdict.reasons() + verdict.near + verdict.doubts
                self.assertIn(verdict.word, oracle_section9.OWN[right], why)

    def test_the_cause_decides(self):
        """Without it the same missions are not failed."""
        self.assertNotEqual(oracle_section9.drops_at_once(crest=80.0).judge().word, "must_fail")
        case = oracle_section9.plane_cuts_corner()
        case.plan["geoFence"]["circles"][0]["circle"]["radius"] = 5  # the path is 10 to 20 m from its middle
        case.plan["mission"]["items"][0]["params"][1] = 9
        self.assertNotEqual(case.judge().word, "must_fail")
        case = oracle_section9.two_keep_ins("AC")
        case.plan["geoFence"]["polygons"] = []
        self.assertEqual(case.judge().word, "must_pass")


class Geometry(unittest.TestCase):
    def test_arc(self):
        """Clockwise from south to north: by the west."""
        points = arc(np.array([0.0, 0, 10]), np.array([0.0, 100, 30]), math.pi)
        np.testing.assert_allclose(points[0], [0, 0, 10], atol=1e-9)
        np.testing.assert_allclose(points[-1], [0, 100, 30], atol=1e-9)
        np.testing.assert_allclose(np.hypot(points[:, 0], points[:, 1] - 50), 50, atol=1e-9)
        self.assertLess(points[:, 0].min(), -49)
        self.assertLess(points[:, 0].max(), 1)

    def test_spline(self):
        a, b = np.zeros(3), np.array([100.0, 0, 0])
        points = spline(a, b, np.array([0, 50.0, 0]), np.array([0, 50.0, 0]))
        np.testing.assert_allclose(points[[0, -1]], [a, b], atol=1e-9)
        self.assertGreater(points[:, 1].max(), 4)
        long = spline(a, b, np.array([0, 5000.0, 0]), np.array([0, 5000.0, 0]))
        np.testing.assert_allclose(long, spline(a, b, np.array([0, 200.0, 0]), np.array([0, 200.0, 0])), atol=1e-6)

    def test_l1_turns_inside_the_corner_and_joins_the_line(self):
        self.assertAlmostEqual(l1_length(20), 81, delta=0.3)
        track = l1_track((np.array([-81.0, 0]), np.array([1.0, 0])), np.zeros(2), np.array([0, 900.0]), 0, 20)
        inside = np.linalg.norm(track - [-35.4, 35.4], axis=1).min()
        self.assertLess(inside, 25)
        self.assertLess(track[:, 0].max(), 15)
        self.assertLess(abs(track[-1][0]), 1)

    def test_polygons(self):
        ring = np.array(square(0, 0, 10))
        places = np.array([[0.0, 0], [9, 0], [20, 0], [13, 14]])
        np.testing.assert_allclose(ring_distance(ring, places), [-10, -1, 10, 5])

    def test_ground_is_bilinear(self):
        world = hills(random.Random(1), 50)
        middle = world.heights.shape[0] // 2
        east, north = world.cell_deg * world.east, world.cell_deg * world.north
        corners = [[0, 0], [east, 0], [0, north], [east, north]]
        np.testing.assert_allclose(world.ground(corners), world.heights[middle:middle + 2, middle:middle + 2].ravel())
        self.assertAlmostEqual(float(world.ground([east / 2, north / 2])), world.ground(corners).mean(), places=6)


class Jumps(unittest.TestCase):
    def order(self, *items):
        world = oracle_section9.SEA
        made = [oracle_section9.item(16, world, (100 * n, 0), 40) if i is None else i for n, i in enumerate(items)]
        return oracle_commands.Order(oracle_commands.Mission(oracle_section9.plan("AC", world, made), world))

    def test_legs_back_are_counted(self):
        numbers = [s.number for s in self.order(None, None, oracle_section9.act(177, 1, 2), None).steps]
        self.assertEqual(numbers, [1, 2, 1, 2, 1, 2, 4])
        self.assertTrue(self.order(None, None, oracle_section9.act(177, 1, -1), None).never_ends)


class Consistency(unittest.TestCase):
    def test_the_band_holds_what_violates(self):
        """What a possible path touches, the band touches."""
        rng, seen = random.Random(7), 0
        world, = oracle_missions.worlds(rng, 1)
        for n in range(60):
            case = oracle_missions.make(random.Random(f"band/{n}"), world, str(n))
            verdict = case.judge()
            if verdict.violations:
                seen += 1
                walks = case.fly()[1]
                self.assertTrue(touched(walks, case, read_fences(case.plan, world)), verdict.violations)
        self.assertGreater(seen, 10)


if __name__ == "__main__":
    unittest.main()
