# SPDX-License-Identifier: Apache-2.0
"""bench_commands_test.py PROGRAM SOURCES: each subcommand of altiplan-bench measures as little as it can, as JSON and
as a table (by day every third of them, and two as a table), and says what a build has left out.
"""
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import by_day  # noqa: E402

PROGRAM, SOURCES = map(os.path.abspath, sys.argv[1:3])
ANTS = f"{SOURCES}/configs/scenarios/ant_colony.yaml"
# What is measured, and the columns of a table or the names of Google Benchmark's rows.
CALLS = {
    "airspace": ([f"{SOURCES}/plugins/environment/zones/conformance.openair", "--questions", "1000"],
                 {"files": "questions_per_s"}),
    "ants": ([ANTS, "--iterations", "2", "--cells", "20", "--passes", "1"],
             {"steps": "ns_per_step", "threads": "efficiency", "by_cells": "ns_per_cell"}),
    "any-angle": (["city", "--seeds", "1", "--passes", "1"], {"planners": "median_ms"}),
    "dubins": (["--benchmark_filter=length/easy", "--benchmark_min_time=0.001"],
               "length/easy/altiplan"),
    "field": (["--passes", "1"], {"steps": "p99_us"}),
    "legs": ([f"{SOURCES}/configs/scenarios/city_complex.yaml", "legs", "--passes", "1"],
             {"worlds": "ns_per_leg"}),
    "pilot": (["--flights", "1"], {"steps": "p99.9_us"}),
    "plan": ([f"{SOURCES}/configs/pipelines/city_astar.yaml", "--passes", "2", "--set",
              "steps.0.with.cell_m=[20, 20, 20]"], {"calls": "run_ms"}),
    "replan": (["--trials", "1"], {"first_plans": "ms", "repairs": "ratio"}),
    "queries": (["--benchmark_filter=point/", "--benchmark_min_time=0.001"], "point/altiplan"),
    "sampling": (["--benchmark_filter=nearest/scattered/1000/", "--benchmark_min_time=0.001"],
                 "nearest/scattered/1000/tree"),
    "search": (["--paper-worlds", "--benchmark_filter=fitted/plan$", "--benchmark_min_time=0.001"],
               "fusion_fitted/plan"),
    "terrain": (["--cells", "100", "--fine-cells", "100", "--passes", "1"], {"plans": "warm_ms"}),
}


def bench(*arguments):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=600,
                          check=False)
    return done.returncode, done.stdout, done.stderr


def setUpModule():
    """The files that some read are in the current folder."""
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    os.chdir(folder.name)
    with open("legs", "wb") as stream:
        stream.write(struct.pack("<6d", 15, 25, 45, 675, 645, 45))


class Subcommands(unittest.TestCase):
    def each(self):
        """Those that this build has; the others must say what they need."""
        listed = bench("--help")[1]
        for name in CALLS:
            self.assertIn(f"  {name} ", listed)
        for name in by_day(CALLS, 3):
            arguments, expected = CALLS[name]
            with self.subTest(name):
                code, out, err = bench(name, *arguments, "--json")
                if code == 3 and "left out of this build: needs " in err:
                    self.assertEqual(out, "")
                    continue
                self.assertEqual(code, 0, err)
                yield [name, *arguments], json.loads(out), expected

    def test_figures(self):
        for call, figures, expected in self.each():
            if isinstance(expected, str):
                names = [row["name"] for row in figures["benchmarks"]]
                self.assertIn(expected, names)
                continue
            if call[0] not in by_day(CALLS, 6):
                continue
            code, out, err = bench(*call)
            self.assertEqual(code, 0, err)
            for table, column in expected.items():
                self.assertGreater(len(figures[table]), 0)
                self.assertTrue(all(list(row) == list(figures[table][0]) for row in figures[table]))
                self.assertIsInstance(figures[table][0][column], (int, float))
                self.assertIn(f"\n{table}\n", out)
                self.assertIn(f" {column}", out)

    def test_wrong_usage(self):
        for arguments in ([], ["grids"], ["field", "--passes", "0"], ["any-angle"],
                          ["field", "--benchmark_filter=a"]):
            self.assertEqual(bench(*arguments)[0], 2, arguments)
        code, _, err = bench("search", "--paper-words")
        self.assertIn((code, "left out" in err), ((2, False), (3, True)))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
