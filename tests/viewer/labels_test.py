# SPDX-License-Identifier: Apache-2.0
"""labels_test.py PROGRAM PLUGINS: in pages of real results, and in the report of a study, no text is
cut and none lies on another one, on wide and narrow screens, light and dark, at rest and in flight. With
ALTIPLAN_NIGHTLY=1 more results, each screen both light and dark, and flights in more places.

`labels_test.py PROGRAM PLUGINS Views.test_ridge` runs one case; skipped without Chromium. With
ALTIPLAN_PICTURES in the environment, pictures of all of them go into that folder."""
import contextlib
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import tempfile
import unittest

import browser
import labels

PROGRAM, PLUGINS = sys.argv[1:3]
PICTURES = os.environ.get("ALTIPLAN_PICTURES")
CONFIGS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "configs")
SIZES = ((1400, 900), (390, 800))
SCHEMES = ("light", "dark")
NIGHTLY = os.environ.get("ALTIPLAN_NIGHTLY")
by_night = unittest.skipUnless(NIGHTLY, "by night")
if NIGHTLY:
    SCREENS = [(size, scheme) for size in SIZES for scheme in SCHEMES]
    PLACES, FOLLOWED, SECONDS = (0.3, 0.75, 1), (0.02, 0.6, 0.7, 1), (0, 1, 2.5, 20, 30, 33, 43.9)
else:  # colours move no text
    SCREENS = list(zip(SIZES, SCHEMES))
    PLACES, FOLLOWED, SECONDS = (0.75,), (0.02, 0.6), (1, 30, 43.9)
CITY = """altiplan: 1
scenario: {scenario}
seed: 3
steps:
  - plan: astar
    with: {{corner: free_box}}
  - smooth: prune
  - fly: route
"""
GO_TO = """const [share] = arguments; const slider = document.getElementById('time');
slider.value = slider.max * share; slider.dispatchEvent(new Event('input'));"""


class Labels(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.browser = browser.shared()
        cls.folder = tempfile.mkdtemp(prefix="altiplan_labels_")

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)
        cls.browser.scheme("light")

    def call(self, *arguments):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 0, (arguments, done.stdout, done.stderr))

    def assert_labels(self, name, least, scrolls=False):
        """No text is cut or over another one; at least that many are seen. Returns them."""
        if PICTURES:
            self.browser.picture(os.path.join(PICTURES, f"{name}.png"))
        found = labels.find(self.browser, scrolls)
        with self.subTest(what=name):
            self.assertEqual(found["wrong"], [])
        self.assertGreaterEqual(len(found["texts"]), least, name)
        return found["texts"]

    def on_all_screens(self):
        for (width, height), scheme in SCREENS:
            self.browser.size(width, height)
            self.browser.scheme(scheme)
            yield width, scheme


class Views(Labels):
    def run_pipeline(self, name, pipeline, *arguments):
        self.call("run", pipeline, "--out", f"{name}.json", *arguments)
        return f"{name}.json"

    def page_of(self, *results):
        self.call("view", *results, "-o", "page.html")
        with open(os.path.join(self.folder, "page.html"), encoding="utf-8") as file:
            return file.read()

    def look(self, name, page, names, queries=("",), flies=True):
        """Looks at a page; `names` must be among its texts at rest."""
        for query in queries:
            for width, scheme in self.on_all_screens():
                what = f"{name}{query.replace('?', '_')}_{width}_{scheme}"
                with self.subTest(what=what):
                    self.browser.open(page, query)
                    at_rest = self.assert_labels(what, 25)
                    for text in names:
                        self.assertIn(text, at_rest)
                    if flies:
                        self.fly(what)

    def fly(self, what):
        for share in PLACES:
            self.browser.run(GO_TO, share)
            self.browser.settle()
            self.assert_labels(f"{what}_at_{share}", 25)
        self.browser.run("document.getElementById('follow').click()")
        for share in FOLLOWED:
            self.browser.run(GO_TO, share)
            self.browser.settle()
            self.assert_labels(f"{what}_followed_{share}", 25)
        self.assertTrue(self.browser.run("return altiplan.camera().following"))

    def test_ridge(self):
        result = self.run_pipeline("ridge", os.path.join(CONFIGS, "pipelines", "ridge_crossing.yaml"))
        page = self.page_of(result)
        self.look("ridge", page, ("Start", "Goal", "N", "x east, km", "y north, km", "5", "1,000"),
                  ("", "?flat"))

    @by_night
    def test_two_results(self):
        """Of colonies in a paper's plane world."""
        results = [self.run_pipeline(name, os.path.join(CONFIGS, "pipelines", f"{name}.yaml"))
                   for name in ("ant_colony", "improved_ant_colony")]
        page = self.page_of(*results)
        self.look("ants", page, ("Start", "Goal", "N", "x east, m", "y north, m", "200"),
                  ("", "?flat"), flies=False)

    @by_night
    def test_city(self):
        pipeline = os.path.join(self.folder, "city.yaml")
        with open(pipeline, "w", encoding="utf-8") as file:
            file.write(CITY.format(scenario=os.path.join(CONFIGS, "scenarios", "city_complex.yaml")))
        page = self.page_of(self.run_pipeline("city", pipeline))
        self.look("city", page, ("Start", "Goal", "N", "≤ 16 m beside"))

    @by_night
    def test_wing(self):
        result = self.run_pipeline("wing", os.path.join(CONFIGS, "pipelines", "wing_ridge.yaml"))
        self.look("wing", self.page_of(result), ("Start", "Goal", "N", "x east, km"))

    def test_live_plane(self):
        """A flight of an hour over 100 km without terrain."""
        result = self.run_pipeline("live", os.path.join(CONFIGS, "pipelines",
                                                        "velocity_field_live.yaml"))
        self.look("live", self.page_of(result), ("Start", "Goal", "N", "x east, km", "100"))

    def test_still_and_film(self):
        result = self.run_pipeline("ridge", os.path.join(CONFIGS, "pipelines", "ridge_crossing.yaml"))
        page = self.page_of(result)
        self.browser.size(1280, 720)
        self.browser.scheme("light")
        self.browser.open(page, "?still")
        self.assert_labels("still", 15)
        self.browser.open(page, "?film")
        self.browser.driver.execute_async_script("altiplan.film.begin(44).then(arguments[0])")
        for second in SECONDS:
            self.browser.driver.execute_async_script(
                "altiplan.film.frame(arguments[0]).then(arguments[1])", second)
            self.assert_labels(f"film_{second}", 15)

    def test_pictures(self):
        """From above, with the heights below."""
        pipelines = os.path.join(CONFIGS, "pipelines")
        one = self.run_pipeline("ridge", os.path.join(pipelines, "ridge_crossing.yaml"))
        two = self.run_pipeline("greedy", os.path.join(pipelines, "ridge_crossing.yaml"),
                                "--set", "steps.0.with.weight_g=0.9", "--set", "steps.0.within_s=60")
        ants = self.run_pipeline("ants", os.path.join(pipelines, "ant_colony.yaml"))
        self.browser.size(1700, 1100)
        for results, names in (((one,), ("25", "5 km")), ((one, two), ("greedy: solved",)),
                               ((ants,), ("200 m", "2,000"))):
            self.call("view", *results, "--svg", "above.svg")
            with open(os.path.join(self.folder, "above.svg"), encoding="utf-8") as file:
                self.browser.open(f"<!DOCTYPE html><meta charset=utf-8>{file.read()}")
            texts = self.assert_labels("above_" + results[-1].removesuffix(".json"), 20, scrolls=True)
            for name in ("Start", "Goal", "N", *names):
                self.assertIn(name, texts)


class Report(Labels):
    def setUp(self):
        if not os.path.exists(os.path.join(self.folder, "quick.db")):
            self.call("study", os.path.join(CONFIGS, "studies", "quick.yaml"), "--out", "quick.db",
                      "--jobs", "2")

    def test_quick(self):
        self.call("report", "quick.db", "-o", "report")
        address = f"file://{self.folder}/report/index.html"
        for width, scheme in self.on_all_screens():
            self.browser.driver.get(address)
            self.browser.settle()
            self.assertTrue(self.browser.run("return altiplan_report.ready"))
            if PICTURES:
                self.picture_of_all(f"report_{width}_{scheme}", width)
            texts = self.assert_labels(f"report_top_{width}_{scheme}", 200, scrolls=True)
            self.assertIn("greedy", texts)

    def test_corner(self):
        """On a machine so fast that the first number of the times lies in the corner of the axes."""
        shutil.copy(os.path.join(self.folder, "quick.db"), os.path.join(self.folder, "corner.db"))
        with contextlib.closing(sqlite3.connect(os.path.join(self.folder, "corner.db"))) as store:
            times = "quantity IN (SELECT id FROM quantities WHERE name = 'plan_time_s')"
            least, = store.execute("SELECT min(value) FROM run_values JOIN runs ON run = runs.id "
                                   f"WHERE outcome = 'solved' AND {times}").fetchone()
            store.execute(f"UPDATE run_values SET value = value * ? WHERE {times}", (0.001 / least,))
            store.commit()
        self.call("report", "corner.db", "-o", "corner")
        self.browser.size(*SIZES[0])
        self.browser.driver.get(f"file://{self.folder}/corner/index.html")
        self.browser.settle()
        self.assertTrue("0.001" in self.assert_labels("report_corner", 200, scrolls=True))

    def picture_of_all(self, name, width):
        """The whole page, however long."""
        height = self.browser.run("return document.documentElement.scrollHeight")
        self.browser.size(width, height)
        self.browser.settle()
        self.browser.picture(os.path.join(PICTURES, f"{name}.png"))
        self.browser.size(width, dict(SIZES)[width])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
