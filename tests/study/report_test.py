# SPDX-License-Identifier: Apache-2.0
"""report_test.py PROGRAM: what `altiplan report` writes of studies that were really run; its page is
looked at by tests/viewer/report_test.py."""
import csv
import html
import os
import shutil
import sys
import unittest

from case import GREEDY, RUNS, StudyCase


class Report(StudyCase):
    def report(self, folder, *stores_and_options):
        self.call("report", *stores_and_options, "-o", self.path(folder))
        return self.files(folder)

    def files(self, folder):
        files = {}
        for parent, _, names in os.walk(self.path(folder)):
            for name in names:
                path = os.path.join(parent, name)
                with open(path, "rb") as stream:
                    files[os.path.relpath(path, self.path(folder))] = stream.read()
        return files

    def page(self, folder):
        return self.files(folder)["index.html"].decode()

    def assert_same(self, first, second):
        self.assertEqual(sorted(first), sorted(second))
        for name, content in first.items():
            self.assertTrue(content == second[name], name)

    def test_without_times_history_does_not_matter(self):
        whole = self.report("whole", self.store("whole.db"), "--no-times")
        self.assertGreater(len(whole), 25)
        # One after the other, in two calls, several in a process.
        again = self.store("again.db", "--jobs", "1", "--sample", "0.5")
        self.store("again.db", "--reuse", "4")
        self.assert_same(whole, self.report("again", again, "--no-times"))
        # In parts, given in any order, and merged.
        parts = [self.store(f"part-{n}.db", "--shard", f"{n}/3") for n in (1, 2, 3)]
        self.assert_same(whole, self.report("parts", *reversed(parts), "--no-times"))
        self.call("merge", *parts, "-o", self.path("all.db"))
        self.assert_same(whole, self.report("all", self.path("all.db"), "--no-times"))
        for content in whole.values():
            self.assertNotIn(b"whole.db", content)

    def test_traces_with_iterations_are_drawn(self):
        self.write("astar.yaml", "altiplan: 1\nscenario: city.yaml\nsteps:\n  - plan: rrt_star\n"
                                 "    within_iterations: 3000\n")
        self.write("study.yaml", self.read("study.yaml").replace(GREEDY, ""))
        without = self.report("without", self.store("without.db", "--reuse", "6"), "--no-times")
        self.assertFalse(any("convergence" in name for name in without))
        with_traces = self.report("with", self.store("with.db", "--reuse", "6", "--traces"),
                                  "--no-times")
        self.assertEqual(set(with_traces) - set(without),
                         {"figures/convergence-octile.csv", "figures/convergence-octile.svg",
                          "tables/convergence.csv", "tables/convergence.md", "tables/convergence.tex"})
        rows = list(csv.DictReader(with_traces["figures/convergence-octile.csv"].decode()
                                   .splitlines()))
        self.assertEqual([float(rows[-1][f"best_{part}"]) for part in ("p10", "median", "p90")],
                         [1, 1, 1])
        self.assertGreater(len(rows), 6)

    def test_figures_as_pdf(self):
        store = self.store("study.db", "--sample", "0.4")
        self.environment = {**os.environ, "PATH": self.folder}
        self.assertIn("--pdf: needs the program rsvg-convert, which is not on the PATH; in Debian and Ubuntu it is in "
                      "the package librsvg2-bin", self.refused("report", store, "-o", self.path("none"), "--pdf"))
        self.assertFalse(os.path.exists(self.path("none")))
        fails = self.write("rsvg-convert", "#!/bin/sh\necho no room >&2\nexit 1\n")
        os.chmod(fails, 0o755)
        said = self.refused("report", store, "-o", self.path("none"), "--pdf")
        self.assertRegex(said, r"--pdf: '.*/rsvg-convert' failed for [a-z-]+\.svg: no room")
        self.assertFalse(os.path.exists(self.path("none/index.html")))
        self.environment = None
        if shutil.which("rsvg-convert") is None:
            self.skipTest("no rsvg-convert")
        files = self.report("report", store, "--pdf", "--no-times")
        drawn = {name[:-4] for name in files if name.endswith(".svg")}
        self.assertEqual({name[:-4] for name in files if name.endswith(".pdf")}, drawn)
        for name in drawn:
            self.assertTrue(files[name + ".pdf"].startswith(b"%PDF-"))
        self.assert_same(files, self.report("again", store, "--pdf", "--no-times"))
        self.report("report", store)
        self.assertFalse(any(name.endswith(".pdf") for name in self.files("report")), "those of before are gone")

    def test_rows_are_the_stores(self):
        store = self.store("study.db")
        self.report("report", store)
        with open(self.path("report/runs.csv"), newline="", encoding="utf-8") as stream:
            rows = list(csv.DictReader(stream))
        runs = self.runs(store)
        self.assertEqual(len(rows), RUNS)
        for row in rows:
            (key, seed, outcome, message), values = runs[
                f"{row['pipeline']} {row['scenario']} #{row['repetition']}"]
            self.assertEqual((row["key"], int(row["seed"]), row["outcome"], row["message"]),
                             (key, seed, outcome, message))
            for name, value in values:
                self.assertAlmostEqual(float(row[name]), value, delta=1e-11 * abs(value))
        self.assertGreater(len([name for name in rows[0] if name.endswith("time_s")]), 3)

    def test_claims_are_those_of_the_study(self):
        text = self.read("study.yaml").replace("1..3", "[9, 12, 10, 2, 30, 1]").replace(
            "repetitions: 2", "repetitions: 1")
        study = self.write("claims.yaml", text + "claims:\n  - {id: longer, that: "
                           "median(greedy.length_m / octile.length_m), is: '> 1'}\n")
        out, _ = self.call("study", study, "--out", self.path("claims.db"))
        words = out.split("claim longer: ")[1].strip().split(" is ", 1)[1]  # after the expression
        self.report("report", self.path("claims.db"))
        self.assertIn(html.escape(words), self.page("report"))

    def test_scenes_that_cannot_be_built_are_told(self):
        store = self.store("study.db")
        os.remove(self.path("city.yaml"))
        out, err = self.call("report", store, "-o", self.path("report"))
        self.assertIn(" 0 scenes", out)
        self.assertIn("city.yaml no longer exists: 12 runs made before are not shown", err)
        self.assertTrue("no longer exists" in self.page("report"), "the page tells it too")

    def test_a_world_that_has_changed_is_not_drawn(self):
        store = self.store("study.db")
        self.write("astar.yaml", self.read("astar.yaml").replace("prune", "no_such"))
        out, err = self.call("report", store, "-o", self.path("report"))
        self.assertIn(" 0 scenes", out)
        self.assertIn("astar.yaml has changed since: 12 runs made before are not shown", err)

    def test_an_earlier_report_stays_where_the_new_one_fails(self):
        store = self.store("study.db")
        before = self.report("report", store)
        for name in self.spoilt():
            self.assertIn(name, self.refused("report", self.path(name), "-o",
                                             self.path("report")))
        self.assert_same(before, self.files("report"))

    def test_wrong_use(self):
        store = self.store("study.db", "--sample", "0.2")
        self.call("report", store, code=2)
        self.call("report", "-o", self.path("report"), code=2)
        self.assertIn("contains other files", self.refused("report", store, "-o", self.folder))
        self.assertIn("is a file", self.refused("report", store, "-o", store))
        other = self.write("other.yaml", self.read("study.yaml").replace("seed: 5", "seed: 6"))
        self.call("study", other, "--out", self.path("other.db"), "--sample", "0.2")
        self.assertIn("another study", self.refused("report", store, self.path("other.db"), "-o",
                                                    self.path("report")))
        self.assertFalse(os.path.exists(self.path("report")))


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
