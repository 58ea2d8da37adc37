# SPDX-License-Identifier: Apache-2.0
"""reproduce_test.py PROGRAM SOURCE: altiplan reproduce, on rows of the papers that take little time and on a paper
made up for a study in cities. NightlyPapers runs a sample of every paper."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

import case
from case import by_day

PROGRAM, SOURCE = sys.argv[1], pathlib.Path(sys.argv[2])

STUDY = """altiplan: 1
name: Two in many cities
scenarios:
  - {id: simple, file: city.yaml, set: {environment.0.city.seed: 1..40}}
  - {id: other, file: city.yaml, set: {environment.0.city.seed: 41..43}}
pipelines:
  - {id: octile, file: astar.yaml, set: {steps.0.with.runs: false}}
  - {id: greedy, file: astar.yaml, set: {steps.0.with.weight_g: [0.3, 0.4]}}
claims:
  - {id: saves, that: "median(greedy[weight_g=0.3].expanded / octile.expanded)", is: < 1}
"""
# The figures of the documentation are the program's own, put in by `documented`.
PAPER = """altiplan: 1
title: Two searches
page: cities.md
runs:
  - id: cities
    study: study.yaml
    scenarios: simple
    quick: 0.5
    cpu_ms: {octile: 10, "greedy[weight_g=0.3]": 4}
tables:
  - heading: A table
    source: table 7
    runs: cities
    columns:
      - {name: solved, of: share(ROW.solved)}
      - {name: "length, median, km", of: median(ROW.length_m / 1000)}
      - {name: "most, km", of: max(ROW.length_m / 1000)}
      - {name: "time, ms", of: median(1000 * ROW.plan_time_s)}
    rows:
      - {id: octile, what: the usual one, paper: ["", 1.5, "", ""], documentation: [100 %, 1.234, 1.234, 1.2]}
      - {id: greedy, row: "greedy[weight_g=0.3]", what: the greedy one, documentation: [40/40, 1.234]}
  - heading: Claims
    runs: cities
    claims:
      - {id: saves, what: saves nodes, verdict: holds, measured: "0.123 [0.123, 0.123]"}
"""


class Reproduce(case.StudyCase):
    program = PROGRAM

    def setUp(self):
        super().setUp()
        self.study = self.write("study.yaml", STUDY)
        self.paper = self.write("007_cities.yaml", PAPER)

    def reproduce(self, *arguments, code=0):
        """The rows of one paper by id, each its figures by name."""
        out, err = self.call("reproduce", *arguments, "--json", code=code)
        self.assertEqual(err, "")
        paper, = json.loads(out)
        self.assertEqual(paper["differs"] > 0, code == 1)
        return {row["id"]: {figure["name"]: figure for figure in row["figures"]} for row in paper["rows"]}

    def documented(self):
        """Puts the figures of a whole run into the paper; keeps its results in the folder `kept`."""
        rows = self.reproduce(self.paper, "--out", "kept", code=1)
        text = PAPER
        for old, new in ((", 1.234, 1.234, 1.2]", ", %s, %s, 1.2]" % tuple(
                             rows["octile"][name]["here"] for name in ("length, median, km", "most, km"))),
                         ("[40/40, 1.234]", "[40/40, %s]" % rows["greedy"]["length, median, km"]["here"]),
                         ("0.123 [0.123, 0.123]", rows["saves"]["measured"]["here"])):
            self.assertIn(old, text)
            text = text.replace(old, new)
        self.write("007_cities.yaml", text)

    def marks(self, *arguments, code=0):
        return {(row, name): figure["mark"] for row, figures in self.reproduce(*arguments, code=code).items()
                for name, figure in figures.items()}

    def test_whole(self):
        self.documented()
        marks = self.marks(self.paper, "--out", "kept")
        self.assertEqual(marks.pop(("octile", "time, ms")), "time")
        self.assertEqual(len(marks), 7)
        self.assertEqual(set(marks.values()), {"equal"})
        runs = self.rows(self.path("kept/study.db"), "SELECT DISTINCT pipelines.name FROM runs "
                         "JOIN pipelines ON pipelines.id = pipeline")
        self.assertEqual(sorted(runs), [("greedy[weight_g=0.3]",), ("octile",)], "no others are needed")
        self.assertEqual(self.rows(self.path("kept/study.db"), "SELECT count(*) FROM runs"), [(80,)])

    def test_one_digit_off_is_marked(self):
        self.documented()
        text = self.read("007_cities.yaml")
        for was, becomes, row, name in (
                (r"\[40/40", "[39/40", "greedy", "solved"),
                (r"(\[100 %, \d\.\d\d)\d", r"\g<1>X", "octile", "length, median, km"),
                (r"verdict: holds", "verdict: fails", "saves", "verdict"),
                (r"(measured: \"\d\.\d\d)\d", r"\g<1>X", "saves", "measured")):
            changed = re.sub(was, becomes, text)
            for last in "09" if "X" in changed else " ":
                spoilt = changed.replace("X", last)
                if spoilt == text:
                    continue
                self.write("007_cities.yaml", spoilt)
                with self.subTest((row, name, last)):
                    marks = self.marks(self.paper, "--out", "kept", code=1)
                    self.assertEqual([key for key, mark in marks.items() if mark == "differs"], [(row, name)])

    def test_a_sample(self):
        self.documented()
        out, err = self.call("reproduce", self.paper, "--quick", "--out", "quick")
        self.assertEqual(err, "")
        self.assertIn("20 of 40 pairs (scenario, repetition) of the study study", out)
        self.assertRegex(out, r"(?m)^ +paper +documentation +this machine$")
        self.assertRegex(out, r"length, median, km +1\.5 +\d\.\d+ +\d\.\d+ +within: \d\.\d+ to \d\.\d+\n")
        self.assertRegex(out, r"solved +40/40 +20/20 +within: ")
        self.assertRegex(out, r"most, km +\d\.\d+ +\d\.\d+ +within: at least \d")
        self.assertRegex(out, r"time, ms +1\.2 +[\d.]+ +time\n")
        self.assertRegex(out, r"verdict +holds +holds +equal\n")
        self.assertIn("none differs", out)
        self.assertEqual(self.rows(self.path("quick/study.db"), "SELECT count(*) FROM runs"), [(40,)])
        # The figures of a sample differ where no sample is likely to be so far off.
        for was, becomes, row, name in ((r"\[40/40", "[4/40", "greedy", "solved"),
                                        (r"(\[100 %, )\d", r"\g<1>3", "octile", "length, median, km"),
                                        (r"verdict: holds", "verdict: fails", "saves", "verdict")):
            text = self.read("007_cities.yaml")
            self.write("007_cities.yaml", re.sub(was, becomes, text))
            marks = self.marks(self.paper, "--quick", "--out", "quick", code=1)
            self.assertEqual([key for key, mark in marks.items() if mark == "differs"], [(row, name)])
            self.write("007_cities.yaml", text)

    def test_too_few(self):
        self.documented()
        self.write("007_cities.yaml", self.read("007_cities.yaml").replace("quick: 0.5", "quick: 0.1"))
        figure = self.reproduce(self.paper, "--quick")["octile"]["length, median, km"]
        self.assertEqual(figure["mark"], "too few")
        self.assertEqual(figure["sample"], "too few scenarios: at least 11 for 99.9 %")

    def test_without_documentation(self):
        """Who writes a paper of his own has no figures yet: they are shown, and none is compared."""
        text = re.sub(r", documentation: \[[^]]*\]", "", PAPER)
        text = re.sub(r", verdict: holds, measured: \"[^\"]*\"", "", text)
        text = re.sub("title: .*\n|page: .*\n", "", text)
        self.write("007_cities.yaml", text)
        rows = self.reproduce(self.paper, "--out", "kept")
        self.assertEqual({figure["mark"] for figures in rows.values() for figure in figures.values()},
                         {"not compared"})
        self.assertEqual(rows["octile"]["solved"]["here"], "40/40")
        self.assertRegex(rows["octile"]["length, median, km"]["here"], r"^\d\.\d$", "as the paper's")
        self.assertRegex(rows["greedy"]["length, median, km"]["here"], r"^\d\.\d{3}$")
        self.assertEqual(rows["saves"]["verdict"]["here"], "holds")
        self.assertRegex(rows["saves"]["measured"]["here"], r"^0\.\d+ \[0\.\d+, 0\.\d+\]$")
        out, _ = self.call("reproduce", self.paper, "--out", "kept")
        self.assertIn("\n007 cities\n", "\n" + out)
        self.assertRegex(out, r"(?m)^ +paper +this machine$")
        self.assertRegex(out, r"(?m)^    length, median, km +1\.5 +\d\.\d$")
        self.assertIn("10 figures: none is compared", out)

    def test_rows(self):
        self.documented()
        rows = self.reproduce(self.paper, "--row", "greedy", "--row", "saves", "--out", "kept")
        self.assertEqual(list(rows), ["greedy", "saves"])
        self.call("reproduce", self.paper, "--row", "octile", "--out", "alone")
        self.assertEqual(self.rows(self.path("alone/study.db"), "SELECT count(*) FROM runs"), [(40,)])

    def test_list(self):
        out, _ = self.call("reproduce", "--list", self.paper)
        self.assertRegex(out, r"^007 cities: Two searches \(cities\.md\)\n")
        self.assertRegex(out, r"greedy +80 ms +0\.2 s +the greedy one\n")
        self.assertRegex(out, r"saves +0\.3 s +0\.6 s +saves nodes\n")
        self.assertRegex(out, r"all +0\.3 s +0\.6 s +all 3 rows")
        self.write("007_cities.yaml", PAPER.replace('    cpu_ms: {octile: 10, "greedy[weight_g=0.3]": 4}\n', ""))
        self.assertIn("unknown", self.call("reproduce", "--list", self.paper)[0])
        out, _ = self.call("reproduce", "--list", "--json")
        papers = json.loads(out)
        self.assertEqual([(paper["number"], paper["name"]) for paper in papers],
                         [("000", "uav_rrt"), ("001", "velocity_field"), ("002", "fusion_astar"),
                          ("003", "stratified_theta"), ("004", "ant_colony"), ("005", "spso"), ("006", "nmopso")])
        for paper in papers:
            self.assertGreater(len(paper["rows"]), 10)
            self.assertGreater(paper["cpu_s"], paper["quick_cpu_s"])

    def test_words(self):
        for word in by_day(("001", "1", "01", "velocity_field", "001_velocity_field"), 3):
            rows = self.reproduce(word, "--row", "trap_entries")
            self.assertEqual(rows["trap_entries"]["ours"]["here"], "5")
        self.assertIn("no paper is named 'velocty_field' (altiplan reproduce --list shows all); did you mean "
                      "'velocity_field'?", self.refused("reproduce", "velocty_field"))
        self.assertIn("no paper is named '007'", self.refused("reproduce", "007"))
        self.assertIn("has no row 'trap_entris' (altiplan reproduce --list shows all); did you mean "
                      "'trap_entries'?", self.refused("reproduce", "001", "--row", "trap_entris"))
        self.assertIn("--row: expected one paper, found 7", self.refused("reproduce", "all", "--row", "basic"))
        _, err = self.call("reproduce", code=2)
        self.assertIn("PAPER is required", err)
        self.call("reproduce", "001", "--jobs", "0", code=2)

    def test_damaged_papers(self):
        for was, becomes, where, message in (
                ("of: share(ROW.solved)", "of: shore(ROW.solved)", "15:24: tables.0.columns.0.of",
                 "of row 'octile': shore(octile.solved): at character 1: expected median(, mean("),
                ("median(ROW.length_m", "median(ROW.lengt_m", "16:38: tables.0.columns.1.of",
                 "no run has a value 'lengt_m'; did you mean 'length_m'?"),
                ("row: \"greedy[weight_g=0.3]\"", "row: gredy", "21:22: tables.0.rows.1.row",
                 "no pipeline is named 'gredy'; did you mean 'greedy'?"),
                ("[40/40, 1.234]", "[40/40, about 1]", "21:96: tables.0.rows.1.documentation.1",
                 "expected a figure as 303, 1,231, 0.45, 92.6 %, 54/100"),
                ("[40/40, 1.234]", "[1, 2, 3, 4, 5]", "21:73: tables.0.rows.1.documentation",
                 "expected at most 4 figures, one for each column, found 5"),
                ("[40/40, 1.234]", "[\"\", \"\"]", "21:73: tables.0.rows.1.documentation",
                 "has no figure: give at least one, or leave the key out to compare none"),
                ('paper: ["", 1.5,', 'paper: ["", abc,', "20:55: tables.0.rows.0.paper.1",
                 "expected a figure as 303"),
                ('paper: ["", 1.5,', 'paper: ["", "1.5O",', "20:55: tables.0.rows.0.paper.1",
                 "expected a figure as 303"),
                ('paper: ["", 1.5, "", ""]', 'paper: ["", 1.5]', "20:43: tables.0.rows.0.paper",
                 'expected 4 figures, one for each column, "" where the paper prints nothing; found 2'),
                ("of: share(ROW.solved)", "of: share(RAW.solved)", "15:24: tables.0.columns.0.of",
                 "share(RAW.solved): at character 7: no pipeline is named 'RAW'; did you mean 'ROW'?"),
                ("id: octile, what", "id: octil, what", "20:10: tables.0.rows.0.id",
                 "no pipeline is named 'octil'; did you mean 'octile'?"),
                ("title: Two searches", 'title: ""', "2:1: title", "is empty: give the title, or leave the key out"),
                ("page: cities.md", 'page: ""', "3:1: page", "is empty: give the page, or leave the key out"),
                ("id: greedy,", "id: octile,", "21:10: tables.0.rows.1.id", "the id 'octile' is taken"),
                ("runs: cities\n    claims", "runs: citie\n    claims", "23:5: tables.1.runs",
                 "there are no runs 'citie'; did you mean 'cities'?"),
                ("- {id: saves,", "- {id: save,", "25:10: tables.1.claims.0.id",
                 "the study has no claim 'save'; did you mean 'saves'?"),
                ("verdict: holds", "verdict: hold", "25:49: tables.1.claims.0.verdict", "expected one of"),
                ("scenarios: simple", "scenarios: simpel", "7:5: runs.0.scenarios",
                 "the study has no scenarios 'simpel'; did you mean 'simple'?"),
                ("study: study.yaml", "study: studi.yaml", "6:5: runs.0.study", "file not found"),
                ("quick: 0.5", "quick: 5", "8:12: runs.0.quick", "expected"),
                ("octile: 10, ", "", "9:5: runs.0.cpu_ms", "the time of the pipeline 'octile' is missing"),
                ("octile: 10", "octile: fast", "9:22: runs.0.cpu_ms.octile", "expected a time above 0 (ms)"),
                ("octile: 10", "octile: 10, optimal: 3", "9:26: runs.0.cpu_ms.optimal",
                 "no row names the pipeline 'optimal', so it is not run"),
                ("octile: 10", "octil: 10", "9:14: runs.0.cpu_ms.octil",
                 "no row names the pipeline 'octil'; did you mean 'octile'?"),
                ("title:", "titel:", "2:1: titel", "did you mean 'title'?"),
                ("tables:", "tables: 5\nrows:", "10:9: tables", "expected a list"),
                ("runs:\n", "runs: [\n", "", "")):
            with self.subTest(becomes):
                self.assertIn(was, PAPER)
                self.write("007_cities.yaml", PAPER.replace(was, becomes))
                for arguments in (("reproduce", self.paper), ("reproduce", "--list", self.paper),
                                  ("validate", self.paper)):
                    out, err = self.call(*arguments, code=3)
                    self.assertEqual(out, "")
                    self.assertIn("007_cities.yaml:" + where, err)
                    self.assertIn(message, err)
        # One sentence for each mistake, all at once.
        self.write("007_cities.yaml", PAPER.replace("id: octile, what", "id: octil, what")
                   .replace("[40/40, 1.234]", "[40/40, about 1]").replace("share(ROW", "share(RAW")
                   .replace("{id: saves,", "{id: save,"))
        _, err = self.call("validate", self.paper, code=3)
        self.assertEqual(err.count("007_cities.yaml:"), 4, err)
        self.write("007_cities.yaml", PAPER.replace("octile: 10", "octil: 10"))
        self.assertEqual(self.call("validate", self.paper, code=3)[1].count("007_cities.yaml:"), 1)
        self.write("007_cities.yaml", "altiplan: 1\nsteps: []\n")
        self.assertIn("expected a paper", self.refused("reproduce", self.paper))
        self.assertIn("no-such.yaml", self.refused("reproduce", "no-such.yaml"))
        self.write("007_cities.yaml", PAPER)
        self.assertIn("this is a paper (altiplan reproduce runs it)", self.refused("run", self.paper))
        self.assertIn("valid", self.call("validate", self.paper)[0])

    def test_out(self):
        self.write("taken", "")
        self.assertIn("--out", self.refused("reproduce", self.paper, "--out", "taken"))
        self.assertIn("--out", self.refused("reproduce", self.paper, "--out", "no/such"))

    def test_an_interruption(self):
        """Ends it while it runs; nothing of its temporary folder stays."""
        for number in (signal.SIGINT, signal.SIGTERM):
            with tempfile.TemporaryDirectory() as temporary:
                call = subprocess.Popen([PROGRAM, "reproduce", "000", "--row", "literal_2100"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True, cwd=self.folder,
                                        env={**os.environ, "TMPDIR": temporary})
                self.addCleanup(call.wait)
                self.addCleanup(call.kill)
                self.addCleanup(call.stderr.close)
                while not any("work" in name for name in walked(temporary)):
                    self.assertIsNone(call.poll())
                    time.sleep(0.01)
                call.send_signal(number)
                self.assertEqual(call.wait(timeout=600), 130)
                self.assertEqual(os.listdir(temporary), [])

    def test_what_is_installed_is_valid(self):
        files = sorted((SOURCE / "configs/papers").glob("*.yaml"))
        self.assertEqual(len(files), 7)
        self.call("validate", *files)

    def test_cheap_rows(self):
        """Rows of the papers as documented, and one of a copy with another figure."""
        for paper, *rows in by_day((("000", "connect"), ("001", "length", "reduced_turn"),
                                    ("002", "astar", "w73", "bidirectional"), ("003", "simple_slicing"),
                                    ("004", "printed")), 2):
            words = [word for row in rows for word in ("--row", row)]
            self.assertEqual(list(self.reproduce(paper, "--quick", *words)), rows)
        name = "001_velocity_field.yaml"
        text = (SOURCE / "configs/papers" / name).read_text()
        text = text.replace("../studies", str(SOURCE / "configs/studies"))
        self.assertIn("[121.200]", text)
        self.write(name, text.replace("[121.200]", "[121.201]"))
        out, _ = self.call("reproduce", self.path(name), "--row", "length", code=1)
        self.assertRegex(out, r"ours +121\.2 +121\.201 +121\.200 +DIFFERS\n")
        self.assertIn("1 figure: 1 DIFFERS", out)


def walked(folder):
    return [name for _, folders, files in os.walk(folder) for name in folders + files]


class NightlyPapers(case.unittest.TestCase):
    def test_every_paper(self):
        done = subprocess.run([PROGRAM, "reproduce", "all", "--quick"], text=True, stdout=subprocess.PIPE)
        print(done.stdout)
        self.assertEqual(done.returncode, 0)


if __name__ == "__main__":
    case.unittest.main(argv=sys.argv[:1] + sys.argv[3:])
