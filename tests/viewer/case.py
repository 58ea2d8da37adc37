# SPDX-License-Identifier: Apache-2.0
"""What the tests of the page have in common: how to open, click, point and read back."""
import math
import os
import pathlib
import re
import sys
import unittest

import browser  # first: without Chromium it skips the program
import scenes

from selenium.webdriver import ActionChains

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY  # noqa: E402, F401

VIEWER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "tools", "viewer")
with open(os.path.join(VIEWER, "dist", "viewer.html"), encoding="utf-8") as file:
    TEMPLATE = file.read()
CENTIMETRE = 0.01


def own_scene(test):
    """Of a test that opens scenes of its own: none is opened for it before, which takes most of its time."""
    test.own_scene = True
    return test


class Case(unittest.TestCase):
    """One browser for all tests; after each: no error, no request but the page."""
    webgl = True

    @classmethod
    def setUpClass(cls):
        cls.browser = browser.shared()
        cls.browser.webgl(cls.webgl)

    def setUp(self):
        self.expected = []

    def tearDown(self):
        self.assertEqual(self.run_js("return altiplan.errors"), self.expected)
        self.assertEqual(self.browser.console(), [])
        requests = self.browser.requests()
        self.assertGreater(len(requests), 0)
        self.assertEqual([url for url in requests if not url.startswith("file://")
                          and not url.startswith("data:")], [])
        self.assertEqual(len({url for url in requests if url.startswith("file://")}), 1)
        self.browser.scheme("light")

    def open(self, scene, query=""):
        self.browser.open(scenes.page(TEMPLATE, scene), query)

    def run_js(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def click(self, selector, index=0):
        self.run_js("document.querySelectorAll(arguments[0])[arguments[1]].click()", selector,
                    index)
        self.browser.settle()

    def slide(self, identity, value):
        self.run_js("const input = document.getElementById(arguments[0]);"
                    "input.value = arguments[1]; input.dispatchEvent(new Event('input'))",
                    identity, value)
        self.browser.settle()

    def press(self, key):
        ActionChains(self.browser.driver).send_keys(key).perform()
        self.browser.settle()

    def drawn(self):
        return self.run_js("return altiplan.drawn()")

    def text(self, selector):
        return self.run_js("return document.querySelector(arguments[0]).textContent", selector)

    def visible(self, selector):
        return self.run_js("return document.querySelector(arguments[0]).checkVisibility()",
                           selector)

    def point_at(self, selector, x, y):
        """Moves the mouse to x, y from the top left of an element."""
        left, top = self.run_js("const r = document.querySelector(arguments[0])"
                                ".getBoundingClientRect(); return [r.left, r.top]", selector)
        actions = ActionChains(self.browser.driver, duration=0)  # or each move takes 250 ms
        actions.w3c_actions.pointer_action.move_to_location(round(left + x) - 2, round(top + y))
        actions.w3c_actions.pointer_action.move_to_location(round(left + x), round(top + y))
        actions.perform()
        self.browser.settle()

    def pixel(self, x, y):
        return self.pixels([(x, y)])[0]

    def pixels(self, places):
        """Their colours, in one picture."""
        picture = self.browser.driver.get_screenshot_as_base64()
        return self.browser.driver.execute_async_script(
            "const [data, places, done] = arguments; const image = new Image();"
            "image.onload = () => { const canvas = document.createElement('canvas');"
            "canvas.width = image.width; canvas.height = image.height;"
            "const context = canvas.getContext('2d', {willReadFrequently: true});"
            "context.drawImage(image, 0, 0);"
            "done(places.map(([x, y]) => [...context.getImageData(x, y, 1, 1).data].slice(0, 3))); };"
            "image.src = 'data:image/png;base64,' + data;", picture,
            [(round(x), round(y)) for x, y in places])

    def mark(self, name):
        """Where a mark is on the stage."""
        moved = self.run_js("return document.querySelector(arguments[0]).style.transform",
                            f".mark.{name}")
        return [float(value) for value in re.findall(r"-?[\d.]+(?=px)", moved)]

    def assert_points(self, drawn, expected):
        self.assertEqual(len(drawn), len(expected))
        worst = max(math.dist(a, b) for a, b in zip(drawn, expected))
        self.assertLessEqual(worst, CENTIMETRE)

    def assert_all_lines(self, scene):
        drawn = self.drawn()
        expected = [(index, result["route"]) for index, result in enumerate(scene["results"])
                    if result["route"]]
        self.assertEqual([(route["result"], route["step"]) for route in drawn["routes"]],
                         [(index, None) for index, _ in expected])
        for route, (_, points) in zip(drawn["routes"], expected):
            self.assert_points(route["points"], points)
        tracks = [result["flight"]["track"] for result in scene["results"] if result["flight"]]
        for track, points in zip(drawn["tracks"], tracks, strict=True):
            self.assert_points(track["points"], [point[1:] for point in points])
