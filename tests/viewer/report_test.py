# SPDX-License-Identifier: Apache-2.0
"""report_test.py PROGRAM MAKE_STORE: what `altiplan report` writes.

`/usr/bin/python3 report_test.py PROGRAM MAKE_STORE Page.test_sorting` runs one case."""
import csv
import filecmp
import glob
import math
import os
import re
import subprocess
import xml.etree.ElementTree as xml

import reports
import studies
from reports import PROGRAM, Reports, by_night, report


class Page(Reports):
    """Runs that were really planned, with one that crashed and one without a route."""
    @classmethod
    def content(cls):
        made = os.path.join(cls.folder, "planned")
        os.mkdir(made)
        return studies.planned(PROGRAM, made)

    def scene(self):
        """What the viewer in the panel has drawn."""
        frame = self.wait("return document.querySelector('#panel iframe[srcdoc]')")
        self.browser.driver.switch_to.frame(frame)
        self.wait("return window.altiplan?.ready")
        self.assertEqual(self.js("return altiplan.errors"), [])
        drawn = self.js("return altiplan.drawn()")
        names = self.js("return altiplan.state && [...document.querySelectorAll('#side .name')]"
                        ".map((name) => name.textContent)")
        self.browser.driver.switch_to.default_content()
        return drawn, names

    def test_figures(self):
        figures = {name for name, *_ in self.assert_figures_are_drawn()}
        for name in ("success", "outcomes", "boxes-length_m", "pairs-length_m", "ranks-length_m",
                     "profile-length_m", "solved-by-plan_time_s"):
            self.assertIn(name, figures)
        self.assert_text_lies_within()
        self.picture("wide")

    def test_narrow_and_dark(self):
        self.browser.size(360, 800)
        self.open()
        self.assertEqual(self.js("return document.documentElement.scrollWidth"), 360)
        self.assert_figures_are_drawn()
        self.assert_text_lies_within()
        self.picture("narrow")
        self.browser.size(1200, 900)
        self.browser.scheme("dark")
        ink = self.js("return getComputedStyle(document.querySelector('.figure .ink')).fill")
        self.picture("dark")
        self.browser.scheme("light")
        self.assertEqual(ink, "rgb(230, 234, 239)")

    def test_a_point_opens_its_route_with_the_others(self):
        self.click("#boxes-length_m path[data-open]")
        drawn, names = self.scene()
        self.picture("run")
        self.assertEqual(names[0], "octile")
        self.assertEqual(len(drawn["routes"]), len(names))
        self.assertGreaterEqual(len(names), 2)
        with open(os.path.join(self.report, "runs.csv"), newline="", encoding="utf-8") as file:
            runs = [run for run in csv.DictReader(file) if run["scenario"] == "hills[seed=1]"]
        lengths = {run["pipeline"]: float(run["length_m"]) for run in runs}
        for route, name in zip(drawn["routes"], names):
            length = sum(math.dist(a, b) for a, b in zip(route["points"], route["points"][1:]))
            self.assertAlmostEqual(length, lengths[name], delta=0.5)
        self.assertIn("altiplan replay", self.text("#panel pre"))
        self.js("document.dispatchEvent(new KeyboardEvent('keydown', {key: 'Escape'}))")
        self.assertTrue(self.js("return document.getElementById('panel').hidden"))

    def test_a_crashed_run_is_told(self):
        self.assertIn("1 unexplained failure", self.text(".summary"))
        self.assertEqual(self.js("return document.querySelectorAll('#table-failures tbody tr')"
                                 ".length"), 1)
        self.click("#table-failures [data-open]")
        drawn, names = self.scene()
        self.assertEqual(names, ["greedy", "octile", "pruned"])
        self.assertEqual(len(drawn["routes"]), 2)
        self.assertIn("greedy: crashed", self.text("#panel .state"))
        self.assertEqual(self.text("#message"),
                         "astar: segmentation fault while planning " + studies.HOSTILE)
        self.assertIn("This run left no result", self.text("#panel"))

    @by_night
    def test_a_run_without_a_route_has_no_profile(self):
        """Neither that of another pipeline of its pair; one with a route has its own."""
        for selector, name, profile in (
                ("#table-failures [data-open]", "greedy", "greedy has no route: astar: segmentation"),
                ("#table-scenarios [data-open='cell 1 0']", "octile", "octile has no route: astar"),
                ("#table-scenarios [data-open='cell 1 2']", "pruned", "pruned")):
            self.open()
            self.click(selector)
            _, names = self.scene()
            self.assertEqual(names[0], name)
            self.browser.driver.switch_to.frame(self.js("return document.querySelector('iframe')"))
            self.assertEqual(self.js("return altiplan.state.selected"), 0)
            self.assertEqual(self.text(".result.selected .name"), name)
            self.assertTrue(self.text(".choice").startswith(profile), self.text(".choice"))
            charts = self.js("return document.querySelectorAll('.chart').length")
            self.assertEqual(charts > 0, name == "pruned")
            self.browser.driver.switch_to.default_content()

    def test_numbers_have_units_and_no_noise(self):
        self.click("#boxes-length_m path[data-open]")
        self.wait("return document.querySelector('#panel .values')")
        values = dict(self.js("return [...document.querySelectorAll('#panel .values li')]"
                              ".map((row) => [...row.children].map((cell) => cell.textContent))"))
        self.assertRegex(values["Length"], r"^\d\d,\d{3} m$")
        self.assertRegex(values["Plan time"], r"^[0-9.]+ m?s$")
        self.assertNotRegex(" ".join(values.values()), r"e[+-]\d")

    def test_wide_tables_show_that_they_go_on(self):
        """By a shade at their edge, and with what a comparison comes to within reach."""
        self.browser.size(400, 800)
        self.open()
        heads = self.js("return [...document.querySelectorAll('#table-pairs-length_m thead th')]"
                        ".slice(2, 4).map((head) => head.textContent)")
        self.assertEqual(heads, ["better", "p (Holm)"])
        wide, shade, tall = self.js("""const table = document.getElementById('table-success');
          const scroll = table.parentElement;
          return [scroll.scrollWidth > scroll.clientWidth,
            getComputedStyle(scroll).backgroundAttachment,
            Math.max(...[...table.tBodies[0].rows].map((row) => row.clientHeight))];""")
        self.assertEqual((wide, shade), (True, "local, local, scroll, scroll"))
        self.assertLess(tall, 45)  # two lines

    def test_an_old_browser_is_told(self):
        self.js("delete window.DecompressionStream")
        self.click("#table-scenarios [data-open]")
        self.wait("return document.querySelector('#panel p')")
        self.assertIn("see runs.csv", self.text("#panel"))
        self.wait("return altiplan_report.errors.length")
        self.assertIn("no DecompressionStream", self.js("return altiplan_report.errors.pop()"))
        self.assertIn("Uncaught", " ".join(self.browser.console()))

    def test_keys(self):
        """A cell is reached and opened without a mouse, and closing goes back to it."""
        self.js("const cell = document.querySelector('#table-scenarios [data-open]'); cell.focus();"
                "cell.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter', bubbles: true}))")
        self.wait("return document.querySelector('#panel .state')")
        self.click("#close")
        self.assertEqual(self.js("return document.activeElement.dataset.open"), "cell 0 0")

    def test_cells_and_sorting(self):
        column = ("return [...document.querySelectorAll('#table-scenarios tbody tr')]"
                  ".map((row) => row.cells[2].dataset.v ?? row.cells[2].textContent)")
        self.click("#table-scenarios thead th:nth-child(3)")
        rising = self.js(column)
        self.click("#table-scenarios thead th:nth-child(3)")
        falling = self.js(column)
        numbers = [float(cell) for cell in rising if cell != "–"]
        self.assertEqual(numbers, sorted(numbers))
        self.assertEqual(rising[-1], "–")  # what is not there comes last, both ways
        self.assertEqual(falling, [*reversed(rising[:-1]), "–"])
        self.click("#table-scenarios td.lost")
        self.wait("return document.querySelector('#panel .state.bad')")

    def test_without_scripts_it_can_be_read(self):
        with open(os.path.join(self.report, "index.html"), encoding="utf-8") as file:
            page = re.sub(r"<script.*?</script>", "", file.read(), flags=re.DOTALL)
        for word in ("Unexplained failures", "greedy_is_quicker", "<svg", "Wilcoxon", "seed: 7",
                     "hills[seed=6]", "altiplan report", "a processor"):
            self.assertIn(word, page)
        self.assertIn("default-src 'none'", page)

    def test_files(self):
        for figure in glob.glob(os.path.join(self.report, "figures", "*.svg")):
            self.assertEqual(xml.parse(figure).getroot().tag, "{http://www.w3.org/2000/svg}svg")
            with open(figure[:-3] + "csv", newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
            self.assertGreater(len(rows), 1, figure)
            self.assertEqual({len(row) for row in rows}, {len(rows[0])}, figure)
        with open(os.path.join(self.report, "runs.csv"), newline="", encoding="utf-8") as file:
            self.assertEqual(len(list(csv.DictReader(file))), 18)

    @by_night
    def test_without_times_it_is_the_same_again(self):
        made = [report(self.store, os.path.join(self.folder, name), "--no-times")
                for name in ("one", "two")]
        files = [os.path.relpath(file, made[0]) for file in
                 glob.glob(os.path.join(made[0], "**", "*.*"), recursive=True)]
        self.assertGreater(len(files), 20)
        same, different, missing = filecmp.cmpfiles(*made, files, shallow=False)
        self.assertEqual((different, missing), ([], []))
        with open(os.path.join(made[0], "index.html"), encoding="utf-8") as file:
            self.assertNotIn(self.store, file.read())


class Changed(Reports):
    """Runs of a scenario and a pipeline that were changed afterwards, of a study half done."""
    @classmethod
    def content(cls):
        made = os.path.join(cls.folder, "planned")
        os.mkdir(made)
        content = studies.planned(PROGRAM, made, scenarios=2)
        content["study"]["planned"] = "96"
        cls.change(os.path.join(made, "pruned.yaml"))
        return content

    @staticmethod
    def change(file):
        with open(file, "a", encoding="utf-8") as out:
            out.write("# another line\n")

    @by_night
    def test_what_has_changed_is_not_drawn(self):
        self.assertIn("pruned.yaml has changed since: 2 runs made before are not shown in 3-D.",
                      self.text("#method"))
        self.click("#table-scenarios [data-open='cell 0 2']")
        frame = self.wait("return document.querySelector('#panel iframe[srcdoc]')")
        self.assertRegex(self.text("#panel"), "This run is not shown: .*pruned.yaml has changed since")
        self.browser.driver.switch_to.frame(frame)
        self.wait("return window.altiplan?.ready")
        self.assertEqual(len(self.js("return altiplan.drawn()")["routes"]), 2)
        self.assertRegex(self.text(".choice"), "^pruned is not shown: .* has changed since$")
        self.browser.driver.switch_to.default_content()

    def test_in_a_changed_world_nothing_is_drawn(self):
        scenario = os.path.join(self.folder, "planned", "hills.yaml")
        with open(scenario, encoding="utf-8") as file:
            before = file.read()
        self.change(scenario)
        try:
            done = subprocess.run([PROGRAM, "report", self.store, "-o", self.report], check=True,
                                  capture_output=True, text=True, timeout=600)
        finally:
            with open(scenario, "w", encoding="utf-8") as file:
                file.write(before)
        self.assertIn("hills.yaml has changed since: 6 runs made before", done.stderr)
        self.assertIn("0 scenes", done.stdout)
        self.open()
        self.click("#table-scenarios [data-open='cell 0 0']")
        self.wait("return document.querySelector('#panel .state')")
        self.assertRegex(self.text("#panel"),
                         "This page has no 3-D scene of this run: .*hills.yaml has changed since")
        self.assertIsNone(self.js("return document.querySelector('#panel iframe')"))
        report(self.store, self.report)

    def test_part_of_a_study_says_so(self):
        part = "6 of 96 planned runs are stored (6 %): verdicts are preliminary."
        self.assertIn(part, self.text(".notice"))
        self.assertLess(self.js("return document.querySelector('.notice').offsetTop"),
                        self.js("return document.querySelector('.summary').offsetTop"))
        with open(os.path.join(self.report, "tables", "verdicts.md"), encoding="utf-8") as file:
            self.assertIn(part, file.read().replace("\\", ""))
        done = subprocess.run([PROGRAM, "report", self.store, "-o", self.report], check=True,
                              capture_output=True, text=True, timeout=600)
        self.assertTrue(done.stdout.startswith(part), done.stdout)


class Hostile(Reports):
    @classmethod
    def content(cls):
        return studies.made_up(30, 4, 3, hostile=True)

    def test_names_are_text(self):
        self.assertIn("<script>", self.text("h1"))
        self.assertEqual(self.js("return document.querySelectorAll('script:not([type])').length"), 1)
        self.assert_figures_are_drawn()
        self.assert_text_lies_within()
        self.click("#table-scenarios [data-open]")
        self.wait("return document.querySelector('#panel .state')")
        self.assertIn("<script>", self.text("#panel h2"))


class Imported(Reports):
    """Runs of a benchmark database, which no command repeats."""
    @classmethod
    def content(cls):
        return studies.made_up(4, 2, 1)

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        database = os.path.join(cls.folder, "arena.db")
        report(cls.store, os.path.join(cls.folder, "exported"), "--arena", database)
        cls.report = report(database, os.path.join(cls.folder, "imported"))

    def test_a_run_says_where_it_comes_from(self):
        self.click("#boxes-length_m path[data-open]")
        self.assertIn("no command repeats it", self.text("#panel"))
        self.assertEqual(self.js("return document.querySelectorAll('#panel pre').length"), 0)


@by_night
class Variants(Reports):
    """A grid of 12 variants, with names as long as grids give them."""
    @classmethod
    def content(cls):
        made = studies.made_up(60, 12, 1)
        return studies.renamed(made, "fusion", [
            f"fusion[weight_g={n / 10},weight_h={1 - n / 20},smoother=bspline]" for n in range(12)])

    def test_labels(self):
        self.assert_figures_are_drawn()
        self.assert_text_lies_within()
        labels = self.js("return [...document.querySelectorAll('#boxes-length_m .strong')]"
                         ".map((text) => text.textContent)")
        self.assertEqual(len(set(labels)), 12)
        self.assertEqual(labels[0], "fusion[0.0,1.0,bspline]")
        self.assertIn("fusion[weight_g,weight_h,smoother]", self.text("#success p"))
        pairs = self.js("return [...document.querySelectorAll('#pairs-length_m .strong')]"
                        ".map((text) => text.textContent)")
        self.assertEqual(len(set(zip(pairs[::2], pairs[1::2]))), 16)
        self.browser.size(360, 800)
        self.open()
        self.assert_text_lies_within()


class Convergence(Reports):
    """Runs with traces, of a colony and of a tree."""
    @classmethod
    def content(cls):
        return studies.colonies(20)

    def test_figures(self):
        figures = {name for name, *_ in self.assert_figures_are_drawn()}
        self.assertLessEqual({"convergence-ants", "convergence-tree"}, figures)
        self.assert_text_lies_within()
        for name, labels in (("ants", 2), ("tree", 1)):
            self.assertEqual(len(self.js("return [...document.querySelectorAll(arguments[0])]"
                                         ".filter((text) => text.getAttribute('x') === '6')",
                                         f"#convergence-{name} text.ink")), labels)
        self.assertTrue(self.js("return document.querySelector('nav a[href=\"#convergence\"]')"
                                ".textContent === 'Convergence'"))
        self.assertIn("ants", self.text("#table-convergence"))
        self.picture("convergence")
        self.browser.size(360, 800)
        self.open()
        self.assert_text_lies_within()


if __name__ == "__main__":
    reports.main()
