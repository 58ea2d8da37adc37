# SPDX-License-Identifier: Apache-2.0
"""altiplan-bench grid: the lengths of published scenarios, and what it says of wrong files.

python3 bench_grid_test.py PROGRAM SOURCES LIMIT_2D LIMIT_3D
plans the first scenarios of each map in ALTIPLAN_TEST_DATA (default SOURCES/../shared/data); where it
is absent only files made here are used.
"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES, LIMIT_2D, LIMIT_3D = sys.argv[1:5]
DATA = os.environ.get("ALTIPLAN_TEST_DATA", os.path.join(SOURCES, "..", "shared", "data"))

MAP = "type octile\nheight 3\nwidth 4\nmap\n....\n.@@.\n....\n"
SCEN = "version 1\n0\ta.map\t4\t3\t0\t0\t3\t2\t{}\n"


def bench(*arguments):
    done = subprocess.run([PROGRAM, "grid", *arguments], capture_output=True, text=True,
                          timeout=2000, check=False)
    return done.returncode, done.stdout, done.stderr


class Made(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def file(self, name, text):
        path = os.path.join(self.folder.name, name)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        return path

    def figures(self, scen, *more):
        code, out, err = bench(self.file("a.map", MAP), self.file("a.scen", scen), "--json", *more)
        self.assertEqual((code, err), (0, ""))
        return json.loads(out)

    def test_a_length_that_is_right_matches(self):
        figures = self.figures(SCEN.format(5))
        self.assertEqual((figures["scenarios"], figures["matched"], figures["unsound"]), (1, 1, 0))
        self.assertLess(figures["worst_error"], 1e-12)

    def test_a_length_that_is_wrong_does_not(self):
        figures = self.figures(SCEN.format("5.002"))
        self.assertEqual(figures["matched"], 0)
        self.assertAlmostEqual(figures["worst_error"], 0.002)

    def test_two_decimals_are_taken_as_rounded(self):
        self.assertEqual(self.figures(SCEN.format("5.00"))["matched"], 1)
        self.assertEqual(self.figures(SCEN.format("5.01"))["matched"], 0)

    def test_each_scenario_has_a_line_when_asked_for(self):
        scen = SCEN.format(5) + "0\ta.map\t4\t3\t0\t0\t0\t0\t0\n"
        code, out, err = bench(self.file("a.map", MAP), self.file("a.scen", scen), "--each",
                               "--repeat", "3", "--with", "heuristic=zero")
        self.assertEqual((code, err), (0, ""))
        rows = [line.split() for line in out.splitlines()[:2]]
        self.assertEqual([row[:3] for row in rows], [["0", "1", "5"], ["1", "1", "0"]])
        self.assertEqual(rows[1][3], "0")
        self.assertGreater(float(rows[0][4]), 0)

    def test_wrong_parameters_are_named(self):
        for text, said in (("heuristic", "expected KEY=VALUE"), ("=1", "expected KEY=VALUE"),
                           ("heuristic=best", "octile"), ("speed=1", "speed")):
            code, out, err = bench(self.file("a.map", MAP), self.file("a.scen", SCEN.format(5)),
                                   "--with", text)
            self.assertEqual((code, out), (3, ""), text)
            self.assertIn(said, err)

    def test_corners_may_be_cut_when_told_so(self):
        figures = self.figures(SCEN.format("4.41421"), "--corner", "any")
        self.assertEqual(figures["matched"], 1)
        self.assertEqual(self.figures(SCEN.format("4.41421"))["matched"], 0)

    def test_the_limit_counts_scenarios(self):
        line = SCEN.format(5).split("\n", 1)[1]
        self.assertEqual(self.figures(SCEN.format(5) + 3 * line, "--limit", "2")["scenarios"], 2)

    def test_wrong_files_are_named_with_their_line(self):
        good = self.file("a.map", MAP)
        for text, why in [
                ("", "there is no scenario in it"),
                ("version 2\n", ":1: expected 'version 1'"),
                ("version 1\n0 a 4 3 0 0 3\n", ":2: expected nine columns"),
                ("version 1\n0 a 5 3 0 0 3 2 5\n", ":2: is for a map of 5 x 3 cells"),
                ("version 1\n0 a 4 3 0 0 4 2 5\n", ":2: expected the goal within the map's 4"),
                ("version 1\n0 a 4 3 0 -1 3 2 5\n", ":2: expected the start within"),
                ("version 1\n0 a 4 3 0 0 3 2 nan\n", ":2: expected the length as a number"),
                ("version 1\n0 a 4 3 0 0 3 1.5 5\n", ":2: expected the goal within"),
        ]:
            code, out, err = bench(good, self.file("b.scen", text))
            self.assertEqual((code, out), (3, ""), text)
            self.assertIn(why, err)
        code, _, err = bench(good, self.file("b.txt", "version 1\n"))
        self.assertEqual(code, 3)
        self.assertIn("expected a .scen or a .3dscen file", err)
        code, _, err = bench(self.file("a.png", ""), "b.scen")
        self.assertEqual(code, 3)
        self.assertIn("expected a .map or a .3dmap file", err)
        code, _, err = bench("/nowhere.map", "b.scen")
        self.assertEqual(code, 3)
        self.assertIn("/nowhere.map", err)

    def test_wrong_usage(self):
        self.assertEqual(bench()[0], 2)
        self.assertEqual(bench("a.map", "a.scen", "--limit", "0")[0], 2)
        good = (self.file("a.map", MAP), self.file("a.scen", SCEN.format(5)))
        code, _, err = bench(*good, "--planner", "astarr")
        self.assertEqual(code, 3)
        self.assertIn("astar", err)
        code, _, err = bench(*good, "--corner", "round")
        self.assertEqual(code, 3)
        self.assertIn("free_box", err)


class Detours(unittest.TestCase):
    """Maps made by `altiplan-bench detours`."""
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        if "left out" in subprocess.run([PROGRAM, "detours", "--help"], capture_output=True,
                                        text=True, check=True).stdout:
            self.skipTest("altiplan-bench detours is not in this build")

    def make(self, kind, name, *more):
        name = os.path.join(self.folder.name, name)
        done = subprocess.run([PROGRAM, "detours", kind, "-o", name, "--queries", "5", "--json", *more],
                              capture_output=True, text=True, timeout=600, check=False)
        return name, done

    def test_lengths(self):
        for kind, least in (("walls", 1.05), ("canyons", 1.5), ("towers", 1.02)):
            with self.subTest(kind):
                name, done = self.make(kind, kind, "--cells", "48,40,24", "--seed", "3")
                self.assertEqual((done.returncode, done.stderr), (0, ""))
                made = json.loads(done.stdout)
                self.assertGreater(made["detour"], least)
                code, out, err = bench(made["map"], made["scenarios"], "--json", "--corner", "any")
                self.assertEqual((code, err), (0, ""))
                figures = json.loads(out)
                self.assertEqual((figures["matched"], figures["unsound"]), (5, 0), out)
                files = [made["map"], made["scenarios"]]
                before = [open(file, "rb").read() for file in files]
                self.make(kind, kind, "--cells", "48,40,24", "--seed", "3")
                self.assertEqual([open(file, "rb").read() for file in files], before)
                self.make(kind, kind, "--cells", "48,40,24", "--seed", "4")
                self.assertNotEqual(open(files[0], "rb").read(), before[0])

    def test_wrong_usage(self):
        for kind, more, code, said in (("hills", (), 2, "hills"),
                                       ("walls", ("--cells", "23,40,24"), 3, "at least 24"),
                                       ("walls", ("--cells", "40,24"), 2, "--cells"),
                                       ("walls", ("--queries", "0"), 2, "queries")):
            done = self.make(kind, "wrong", *more)[1]
            self.assertEqual(done.returncode, code, more)
            self.assertIn(said, done.stderr)
        name, done = self.make("walls", "nowhere/a")
        self.assertEqual(done.returncode, 3)
        self.assertIn(name + ".3dmap", done.stderr)


@unittest.skipUnless(os.path.isdir(os.path.join(DATA, "grid2d")),
                     "no test data: set ALTIPLAN_TEST_DATA")
class Published(unittest.TestCase):
    def hold(self, folder, suffix, scen, limit):
        folder = os.path.join(DATA, folder)
        for name in sorted(os.listdir(folder)):
            if name.endswith(suffix):
                path = os.path.join(folder, name)
                with self.subTest(name):
                    code, out, err = bench(path, path + scen, "--limit", limit, "--json")
                    self.assertEqual((code, err), (0, ""))
                    figures = json.loads(out)
                    self.assertEqual(figures["matched"], figures["scenarios"], out)
                    self.assertEqual(figures["unsound"], 0, out)

    def test_grid_maps(self):
        self.hold("grid2d", ".map", ".scen", LIMIT_2D)

    def test_voxel_maps(self):
        self.hold("voxel3d", ".3dmap", ".3dscen", LIMIT_3D)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[5:])
