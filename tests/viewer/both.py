# SPDX-License-Identifier: Apache-2.0
"""What holds with and without WebGL: each of these classes is tested as a part of Page and Flat."""
import math
import re

from selenium.webdriver import Keys

import scenes
from case import CENTIMETRE, own_scene


class Both:
    """Lines, ground and obstacles are the data; panels, marks, keys and charts act on them."""
    view = "3d"

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scene = scenes.ridge()

    def setUp(self):
        super().setUp()
        if not hasattr(getattr(self, self._testMethodName), "own_scene"):
            self.open(self.scene)
            self.assertTrue(self.run_js("return altiplan.ready"))

    def test_lines_are_the_data(self):
        self.assertEqual(self.drawn()["view"], self.view)
        self.assert_all_lines(self.scene)

    def test_ground_is_the_data(self):
        drawn = self.drawn()["ground"]
        given = self.scene["ground"]
        self.assertEqual([drawn["nx"], drawn["ny"]], [given["nx"], given["ny"]])
        self.assertGreater(drawn["max"], drawn["min"] + 900)

    def test_toggles(self):
        self.click("[data-line='1']")
        self.assertEqual([route["result"] for route in self.drawn()["routes"]], [0])
        self.click("[data-line='0.flight']")
        self.assertEqual(self.drawn()["tracks"], [])
        self.click("[data-line='0.0']")
        attempt = [route for route in self.drawn()["routes"] if route["step"] == "search"]
        self.assert_points(attempt[0]["points"], self.scene["results"][0]["steps"][0]["route"])
        before = self.drawn()["solids"]
        self.click("[data-layer='houses|obstacle|true']")
        self.assertEqual(self.drawn()["solids"], before - 60)

    @own_scene
    def test_unknown_space_is_hidden_until_asked_for(self):
        scene = scenes.empty([[0.0, 0.0, 0.0], [100.0, 100.0, 50.0]])
        box = {"shape": "box", "min": [0, 0, 0], "max": [10, 10, 10]}
        scene["solids"] = [scenes.thing("obstacle", "map", **box),
                           scenes.thing("unknown", "map", **{**box, "max": [100, 100, 50]}),
                           scenes.thing("unknown", "map", **{**box, "min": [50, 50, 0]})]
        self.open(scene)
        self.assertEqual(self.drawn()["solids"], 1)
        self.assertNotIn("Unknown space", self.text("#legend"))
        self.click("[data-layer='map|unknown|true']")
        self.assertEqual(self.drawn()["solids"], 3)
        self.assertIn("Unknown space, treated as blocked", self.text("#legend"))
        self.click("[data-layer='map|unknown|true']")
        self.assertEqual(self.drawn()["solids"], 1)

    def test_time(self):
        """The pop-up radar comes at 10 s and goes at 40 s; the balloon flies east at 60 m/s."""
        solids = {}
        for time in (0, 9.9, 10, 39, 40):
            self.slide("time", time)
            solids[time] = self.drawn()["solids"]
            balloon = self.drawn()["moving"][0]["at"]
            self.assertLess(math.dist(balloon, [1000 + 60 * time, 7000, 1400]), CENTIMETRE)
        without = solids[0]
        self.assertEqual(solids, {0: without, 9.9: without, 10: without + 1, 39: without + 1,
                                  40: without})
        # Five solids, a field of 60, a tent and the balloon.
        self.assertEqual(without, 67)
        self.slide("time", self.scene["results"][0]["flight"]["track"][-1][0])
        self.assertLess(math.dist(self.mark("vehicle"), self.mark("goal")), 1.5)

    def test_signs_on_the_clock(self):
        count = {kind: self.run_js("return document.querySelectorAll(arguments[0]).length",
                                   f"#clock .{kind}") for kind in ("handover", "replan", "event")}
        self.assertEqual(count, {"handover": 2, "replan": 1, "event": 2})
        self.click("#clock .replan")
        self.assertEqual(self.run_js("return altiplan.state.time"), 22)

    def test_play(self):
        self.press(" ")
        self.browser.settle()
        self.press(" ")
        stopped = self.run_js("return altiplan.state.time")
        self.assertGreater(stopped, 0)
        self.browser.settle()
        self.assertEqual(self.run_js("return altiplan.state.time"), stopped)

    def test_a_violation_brings_the_view_there(self):
        before = self.run_js("return altiplan.camera()")
        signs = "return [...document.querySelectorAll('.mark.violation')].filter((sign) => " \
            "!sign.hidden).length"
        # Not that of the attempt, which is not shown.
        self.assertEqual(self.run_js(signs), 3)
        self.click("#tab_violations")
        self.assertEqual(self.text("#tab_violations"), "Violations (4)")
        self.click(".violations button", 3)
        self.assertNotEqual(self.run_js("return altiplan.camera()"), before)
        place = self.run_js("return altiplan.project(arguments[0])",
                            self.scene["results"][1]["route"][2])
        stage = self.run_js("const s = document.getElementById('stage');"
                            "return [s.clientWidth, s.clientHeight]")
        self.assertLess(math.dist([place["x"], place["y"]], [side / 2 for side in stage]), 2)
        self.assertEqual(self.run_js("return altiplan.state.selected"), 1)
        self.click(".violations button", 0)
        self.assertIn("search", [route["step"] for route in self.drawn()["routes"]])

    def test_chart_moves_the_mark(self):
        self.point_at(".chart.altitude .u-over", 150, 40)
        cursor = self.run_js("return altiplan.state.cursor")
        profile = self.scene["results"][0]["profile"]
        self.assertEqual(cursor["at"], profile["at"][cursor["index"]])
        place = self.run_js("return altiplan.project(arguments[0])", cursor["at"])
        self.assertLess(math.dist(self.mark("cursor"), [place["x"], place["y"]]), 0.2)
        self.assertIn("over ground", self.text(".chart.altitude .caption"))
        # All charts show the same place.
        lines = self.run_js("return [...document.querySelectorAll('.u-over')].map((over) =>"
                            "over.querySelector('.u-cursor-x').getBoundingClientRect().left -"
                            "over.getBoundingClientRect().left)")
        widths = self.run_js("return [...document.querySelectorAll('.u-over')].map((over) =>"
                             "over.clientWidth)")
        shares = [line / width for line, width in zip(lines, widths)]
        self.assertLess(max(shares) - min(shares), 0.02)

    def test_route_moves_the_charts(self):
        self.click("[data-line='0.flight']")
        route = self.scene["results"][0]["route"]
        middle = [(a + b) / 2 for a, b in zip(route[0], route[1])]
        place = self.run_js("return altiplan.project(arguments[0])", middle)
        self.point_at("#stage", place["x"], place["y"])
        cursor = self.run_js("return altiplan.state.cursor")
        self.assertLess(math.dist(cursor["at"], middle), 40)
        profile = self.scene["results"][0]["profile"]
        self.assertLess(abs(cursor["x"] - math.dist(route[0], route[1]) / 2), 200)
        self.assertEqual(profile["s"][cursor["index"]], cursor["x"])
        self.assertIn("around", self.text("#tip"))

    def test_search(self):
        self.click("#tab_search")
        self.click("#search_shown")
        self.assertEqual(self.drawn()["searched"], 600)
        self.assertIn("every 5th of 3,000 events shown", self.text("#search_text"))
        self.assertIn("every 5th of 3,000 events shown", self.text("#legend"))
        self.slide("searched", 40)
        self.assertEqual(self.drawn()["searched"], 40)
        self.click("#search_shown")
        self.assertIsNone(self.drawn()["searched"])

    def test_the_pointer_says_where_it_is(self):
        place = self.run_js("return altiplan.project(arguments[0])",
                            [8000, 1000, scenes.hills(8, 1)])
        self.point_at("#stage", place["x"], place["y"])
        said = [float(value.replace(",", "")) for value in
                re.findall(r"-?\d[\d,]*(?:\.\d+)?", self.text("#readout"))]
        x, y, ground, latitude, longitude = said
        self.assertLess(math.dist([x, y], [8000, 1000]), 60)
        self.assertLess(abs(ground - scenes.hills(x / 1000, y / 1000)), 2)
        self.assertAlmostEqual(longitude, 8 + 0.13 * x / 10000, delta=1e-4)
        self.assertAlmostEqual(latitude, 46 + 0.072 * y / 8000, delta=1e-4)

    def test_keys(self):
        self.press("?")
        self.assertTrue(self.visible("#help"))
        self.press(Keys.ESCAPE)
        self.assertFalse(self.visible("#help"))
        self.press("d")
        self.assertEqual(self.run_js("return document.documentElement.dataset.theme"), "dark")
        self.press("1")
        self.assertEqual([route["result"] for route in self.drawn()["routes"]], [1])
        self.press("m")
        self.assertTrue(self.visible(".pane.metrics"))
        self.press("l")
        self.assertFalse(self.visible("#legend"))
        self.press(Keys.ARROW_RIGHT)
        self.assertEqual(self.run_js("return altiplan.state.time"), 1)

    def test_metrics_side_by_side(self):
        rows = self.run_js("return [...document.querySelectorAll('.metrics tr')].map((row) =>"
                           "[...row.children].map((cell) => cell.textContent))")
        self.assertIn(["Min clearance, m", "62.25", "62.25", "–"], rows)
        self.assertIn(["Min radius, m", "straight", "straight", "–"], rows)
        self.assertIn(["Collisions", "1", "–", "–"], rows)

    @own_scene
    def test_still(self):
        self.open(self.scene, "?still")
        for panel in ("#bar", "#side", "#clock", "#dock"):
            self.assertFalse(self.visible(panel))
        self.assertTrue(self.visible("#legend"))
        for x in self.scene["box"][0][0], self.scene["box"][1][0]:
            for y in self.scene["box"][0][1], self.scene["box"][1][1]:
                for z in self.scene["box"][0][2], self.scene["box"][1][2]:
                    place = self.run_js("return altiplan.project(arguments[0])", [x, y, z])
                    self.assertTrue(0 <= place["x"] <= 1280 and 0 <= place["y"] <= 720, place)
