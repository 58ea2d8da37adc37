# SPDX-License-Identifier: Apache-2.0
"""Iterations of a search, played back and drawn as curves: parts of Page and Flat."""
import copy
import math

from selenium.webdriver import ActionChains

import scenes
from case import own_scene

# Numbers of the events that are drawn now.
SHOWN = """
const {search, searched} = altiplan.state;
return [...search.until.keys()].filter((event) => event < searched &&
  searched <= search.until[event]);
"""


class Colony:
    def open_search(self, trace_of, **options):
        scene = copy.deepcopy(self.scene)
        self.ends = [scene["start"], scene["goal"]["at"]]
        scene["results"][0]["trace"] = trace_of(*self.ends, **options)
        self.open(scene)
        self.click("#tab_search")

    def shown(self):
        return self.run_js(SHOWN)

    def curves(self, chart):
        return self.run_js("return document.querySelector(arguments[0]).checkVisibility() ?"
                           "document.querySelector(arguments[0]).textContent : null",
                           f".convergence .chart.{chart} .caption")

    @own_scene
    def test_a_colony_is_played_iteration_by_iteration(self):
        self.open_search(scenes.colony)
        self.click("#search_shown")
        self.assertIn("Iteration 5 of 5: best 10,500 m, mean 10,750 m, 3 alive. 41 of 41, step "
                      "search. All 41 events shown.", self.text("#search_text"))
        self.assertEqual(self.shown(), list(range(32, 41)))
        stops = []
        for iteration in range(6):
            self.slide("searched", iteration)
            stops.append((self.drawn()["searched"], len(self.shown())))
        # Nobody lived through the first; of each later one three routes of three nodes.
        self.assertEqual(stops, [(0, 0), (1, 0), (11, 9), (21, 9), (31, 9), (41, 9)])
        self.slide("searched", 1)
        self.assertIn("Iteration 1 of 5: best –, mean –, 0 alive.", self.text("#search_text"))

    @own_scene
    def test_the_routes_of_an_iteration_are_seen_until_the_next(self):
        self.open_search(scenes.colony)
        self.click("#search_shown")
        start, _ = self.ends
        for key in ("0.flight", "0"):
            self.click(f"[data-line='{key}']")
        corner = [start[0] + 3000 - 1600, start[1] + 2000 + 1600, start[2]]
        middle = [(a + b) / 2 for a, b in zip(start, corner)]
        place = self.run_js("return altiplan.project(arguments[0])", middle)
        left, top = self.run_js("const r = document.getElementById('stage')"
                                ".getBoundingClientRect(); return [r.left, r.top]")
        away = []
        for iteration in (1, 2, 3):
            self.slide("searched", iteration)
            colors = self.pixels([(left + place["x"] + dx, top + place["y"] + dy)
                                  for dx in (-1, 0, 1) for dy in (-1, 0, 1)])
            away.append(min(math.dist(color, [0, 158, 115]) for color in colors))
        self.assertLess(away[1], min(away[0], away[2]) - 20)

    @own_scene
    def test_it_runs(self):
        self.open_search(scenes.colony)
        self.run_js("let now = 0; window.requestAnimationFrame = (callback) =>"
                    "setTimeout(() => callback(now += 1300), 0);"
                    "performance.now = () => now")
        self.click("#search_play")
        wait = ("const done = arguments[0]; const look = () => altiplan.state.searched === 41 &&"
                "document.getElementById('search_play').textContent === '▶' ? done(true) :"
                "setTimeout(look, 20); look();")
        self.assertTrue(self.browser.driver.execute_async_script(wait))

    @own_scene
    def test_how_it_converged(self):
        self.open_search(scenes.colony)
        self.assertEqual(self.curves("length"), "Length by iteration, km best 10,500 m mean 10,750 m")
        self.assertEqual(self.curves("alive"), "Alive  3")
        # The third of five iterations is in the middle.
        width, height = self.run_js("const {clientWidth, clientHeight} = document.querySelector("
                                    "'.chart.length .u-over'); return [clientWidth, clientHeight]")
        self.point_at(".chart.length .u-over", width / 2, height / 2)
        self.assertEqual(self.curves("length"), "Length by iteration, km best 11,500 m mean 11,750 m")
        self.assertIsNone(self.drawn()["searched"])
        ActionChains(self.browser.driver).click().perform()
        self.browser.settle()
        self.assertEqual(self.drawn()["searched"], 21)
        self.assertTrue(self.run_js("return document.getElementById('search_shown').checked"))
        self.assertIn("Iteration 3 of 5", self.text("#search_text"))
        self.press("d")
        self.assertEqual(self.curves("length"), "Length by iteration, km best 11,500 m mean 11,750 m")

    @own_scene
    def test_of_a_tree_its_best_length(self):
        self.open_search(scenes.improvements)
        self.click("#search_shown")
        self.assertEqual(self.curves("length"), "Best length by iteration, km best 11,100 m")
        self.assertIsNone(self.run_js("return document.querySelector('.chart.alive')"))
        self.assertEqual(len(self.shown()), 12)
        self.assertIn("Iteration 900: best 11,100 m. 14 of 14", self.text("#search_text"))
        self.slide("searched", 8)
        self.assertIn("Iteration 400: best 11,600 m. 8 of 14", self.text("#search_text"))
        self.assertEqual(len(self.shown()), 7)

    def test_no_iterations_no_curves(self):
        self.click("#tab_search")
        self.assertFalse(self.visible(".convergence"))

    @own_scene
    def test_thinned_by_routes(self):
        self.open_search(scenes.colony, kept_of=4)
        self.assertIn("Thinned: every 4th route shown (41 of 164 events kept).",
                      self.text("#search_text"))
