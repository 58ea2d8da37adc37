# SPDX-License-Identifier: Apache-2.0
"""terminal_test.py PROGRAM BROKEN: tables, colours and progress on a terminal."""
import re
import subprocess
import sys
import unittest

from case import PROGRAM, CliCase
from terminal import COLOR, on_terminal, progress_of

LONG = "a_first_route_with_a_name_that_goes_on_and_on"
# A goal in a closed shell, and cells for more than the time allowed.
SEARCH = """altiplan: 1
scenario: sealed.yaml
steps:
  - plan: PLANNER
    id: route
    within_s: 2.5
    with: PARAMETERS
"""


class Terminal(CliCase):
    def terminal(self, *call, columns=200, code=0, **environment):
        printed, ended = on_terminal([PROGRAM, *call], columns, self.folder, **environment)
        self.assertEqual(ended, code, printed)
        return printed

    def with_long_names(self):
        text = self.read("pipeline.yaml")
        self.write("long.yaml", text.replace("- plan: astar", f"- plan: astar\n    id: {LONG}") +
                   "  - smooth: waypoint_reduction\n")
        return "long.yaml"


class Tables(Terminal):
    def columns_of(self, table):
        """Where each word of the titles ends or begins, and the same of every row's cells."""
        lines = [COLOR.sub("", line) for line in table.split("\n") if line.startswith("  ")]
        return [[cell.span() for cell in re.finditer(r"\S+", line)] for line in lines]

    def test_long_names_are_aligned_and_whole(self):
        out, _ = self.call("run", self.with_long_names())
        rows = out.split("\n")[1:4]
        self.assertIn(LONG, rows[1])
        self.assertIn("waypoint_reduction", rows[2])
        spans = self.columns_of("\n".join(rows))
        self.assertEqual([span[0] for span in spans[0][:3]], [span[0] for span in spans[1][:3]])
        for titles, cells in zip(zip(*spans[:1]), zip(*spans[1:])):
            for cell in cells:  # numbers end where their titles do
                self.assertTrue(cell[0] == titles[0][0] or cell[1] == titles[0][1], rows)

    def test_colors_on_terminals_only(self):
        pipeline = self.with_long_names()
        printed = self.terminal("run", pipeline)
        self.assertIn("\033[32maccepted\033[0m", printed)
        self.assertIn("long: \033[32msolved\033[0m", printed)
        out, err = self.call("run", pipeline)
        for plain in (self.terminal("run", pipeline, NO_COLOR="1"), self.terminal("run", pipeline, TERM="dumb"),
                      out, err):
            self.assertNotIn("\033[3", plain)
        self.write("none.yaml", self.read("pipeline.yaml").replace("scenario.yaml", "sealed.yaml"))
        self.assertIn("\033[31mno_route\033[0m", self.terminal("run", "none.yaml", code=1))

    def test_narrow_terminals(self):
        pipeline = self.with_long_names()
        wide = [COLOR.sub("", line) for line in self.terminal("run", pipeline).split("\n")]
        for columns in (110, 60, 30):
            printed = self.terminal("run", pipeline, columns=columns)
            lines = [COLOR.sub("", line) for line in printed.split("\n")]
            table = lines[1:-2]
            self.assertEqual(lines[-2], wide[-2])
            words = re.findall(r"\S+", "\n".join(table))
            for word in re.findall(r"\S+", "\n".join(wide[1:-3]))[:12]:  # the titles, and the first id
                self.assertIn(word, words)
            if columns > 60:  # blocks of columns
                self.assertLessEqual(max(map(len, table)), columns)
                self.assertEqual(sum(LONG in line for line in table), 2)
            else:  # a list of each row
                self.assertEqual([line.split()[0] for line in table[:3]], ["step", "plugin", "status"])

    def test_a_last_column_of_words_is_wrapped(self):
        printed = self.terminal("plugins", columns=72)
        lines = [COLOR.sub("", line) for line in printed.split("\n")
                 if not line.startswith(("searched", "skipped", "refused"))]
        self.assertLessEqual(max(map(len, lines)), 72)
        first = next(n for n, line in enumerate(lines) if line.startswith("planner informed_rrt_star"))
        begins = lines[first].index(lines[first].split("  ")[-1].strip())
        self.assertEqual(len(lines[first + 1]) - len(lines[first + 1].lstrip()), begins)
        out, _ = self.call("plugins")
        self.assertRegex(out, r"\nplanner informed_rrt_star {7}\S")

    def test_studies(self):
        self.write("study.yaml", "altiplan: 1\nname: two\nscenarios: [{file: scenario.yaml}, {file: sealed.yaml}]\n"
                   f"pipelines: [{{id: {LONG}, file: pipeline.yaml}}, {{id: b, file: pipeline.yaml}}]\n"
                   f"claims: [{{id: c, that: min({LONG}.length_m), is: '<= 1'}}]\n")
        printed = self.terminal("study", "study.yaml", "--out", "one.db")
        self.assertRegex(COLOR.sub("", printed), rf"\n  {LONG} +2 +1 +[\d.]+  1 no_route\n  b {{{len(LONG) + 7}}}2 ")
        self.assertIn("claim c: \033[31mFails\033[0m: min(", printed)
        printed = self.terminal("compare", "one.db", "one.db")
        self.assertIn("\033[32mnothing is worse\033[0m", printed)
        narrow = self.terminal("compare", "one.db", "one.db", columns=100)
        self.assertIn("\n\033[1mpipeline\033[0m", narrow)
        self.assertGreater(COLOR.sub("", narrow).count(LONG + " length_m"), 1, narrow)
        self.assertIn("\033[32midentical\033[0m", self.terminal("replay", "one.db", "b scenario #0"))


class Progress(Terminal):
    def search(self, planner, parameters, columns=200, code=1):
        self.write("search.yaml", SEARCH.replace("PLANNER", planner).replace("PARAMETERS", parameters))
        return progress_of(self.terminal("run", "search.yaml", columns=columns, code=code))

    def test_of_a_search(self):
        lines = self.search("astar", "{cell_m: [1, 1, 1], max_memory_mb: 100000}")
        self.assertTrue(lines)
        for line in lines:
            self.assertRegex(line, r"^(building the world|route \(astar\): \d+ s, \d s left"
                             r"(; [\d.,]+( [kMG])? expanded, [\d.,]+( [kMG])? nodes)?)")
        self.assertIn(" nodes", "".join(lines))

    def test_of_a_tree(self):
        self.write("sealed.yaml", self.read("scenario.yaml"))
        lines = self.search("rrt_star", "{max_iterations: 1000000000}", code=0)
        self.assertRegex(lines[-1], r"^route \(rrt_star\): \d+ s, \d s left; best [\d,.]+; "
                         r"[\d.,]+( [kMG])? expanded, [\d.,]+( [kMG])? nodes$")

    def test_of_a_colony(self):
        self.write("sealed.yaml", self.read("scenario.yaml"))
        lines = self.search("ant_colony", "{cell_m: [20, 20, 200], iterations: 1000000}", code=0)
        self.assertRegex(lines[-1], r"; best [\d,.]+; iteration [\d,]+; [\d.,]+( [kMG])? expanded$")

    def test_fits_the_terminal(self):
        lines = self.search("astar", "{cell_m: [1, 1, 1], max_memory_mb: 100000}", columns=30)
        self.assertTrue(lines)
        self.assertTrue(all(len(line) <= 30 for line in lines), lines)
        self.assertTrue(lines[-1].endswith("…"))

    def test_is_not_in_pipes(self):
        self.write("search.yaml", SEARCH.replace("PLANNER", "astar").replace(
            "PARAMETERS", "{cell_m: [1, 1, 1], max_memory_mb: 100000}"))
        done = subprocess.run([PROGRAM, "run", "search.yaml"], cwd=self.folder, capture_output=True, text=True,
                              check=False)
        self.assertEqual((done.returncode, done.stderr), (1, ""))
        self.assertNotIn("\033", done.stdout)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
