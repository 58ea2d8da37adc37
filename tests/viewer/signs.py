# SPDX-License-Identifier: Apache-2.0
"""Numbers, names and attribution that can be read: parts of Page and Flat."""
import copy
import re

import scenes
from case import own_scene

SOURCES = ["Buildings: © OpenStreetMap contributors, ODbL 1.0", "Terrain: Copernicus DEM GLO-30, "
           "© DLR e.V. 2010-2014 and © Airbus Defence and Space GmbH 2014-2018"]
RECTANGLES = """
const seen = (element) => element.checkVisibility() && element.getBoundingClientRect().width > 0;
const corners = (element) => {
  const {left, top, right, bottom} = element.getBoundingClientRect();
  return [left, top, right, bottom];
};
const all = (selector) => [...document.querySelectorAll(selector)].filter(seen);
return {stage: corners(document.getElementById('stage')),
  panels: all('#legend, #attribution, #north').map(corners),
  labels: all('.mark.tick > span').map((span) => [span.textContent, corners(span)])};
"""


def overlap(a, b):
    return a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3]


def within(inner, outer):
    return (inner[0] >= outer[0] and inner[1] >= outer[1] and inner[2] <= outer[2]
            and inner[3] <= outer[3])


def luminance(color):
    linear = [value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
              for value in (channel / 255 for channel in color)]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a, b):
    low, high = sorted([luminance(a), luminance(b)])
    return (high + 0.05) / (low + 0.05)


def level(altitudes):
    """A route of two legs at these three altitudes, and its profile."""
    scene = scenes.empty([[0, 0, 0], [1000, 1000, 60]])
    route = [[0, 0, altitudes[0]], [500, 500, altitudes[1]], [1000, 1000, altitudes[2]]]
    scene["results"] = [scenes.result("level", route, [],
                                      profile=scenes.profile_of(route, lambda x, y: None))]
    return scene


class Signs:
    @own_scene
    def test_labels_are_within_the_picture_and_beside_the_panels(self):
        for size in ([1000, 1000, 60], [40, 15, 3], [300, 4000, 50], [10000, 8000, 2000]):
            scene = scenes.empty([[-size[0] / 4, -size[1] / 2, 0],
                                  [size[0] * 3 / 4, size[1] / 2, size[2]]])
            scene["attribution"] = SOURCES
            scene["solids"] = [scenes.thing(role, shape="sphere", at=[0, 0, 0], radius=1)
                               for role in ("obstacle", "threat", "keep_out", "keep_in")]
            for query in ("", "?still"):
                self.open(scene, query)
                with self.subTest(size=size, query=query):
                    self.assert_labels(self.run_js(RECTANGLES))

    def assert_labels(self, found):
        self.assertGreaterEqual(len(found["panels"]), 3)
        self.assertGreater(len(found["labels"]), 4)
        for text, label in found["labels"]:
            self.assertTrue(within(label, found["stage"]), text)
            self.assertEqual([panel for panel in found["panels"] if overlap(panel, label)], [],
                             text)
        texts = [text for text, _ in found["labels"]]
        for name in ("x east, m", "y north, m"):
            self.assertIn(name, texts)

    def test_labels_go_with_the_grid_and_come_back(self):
        self.click("#show_contours")  # which have heights of their own
        before = self.run_js(RECTANGLES)["labels"]
        self.press("g")
        self.assertEqual(self.run_js(RECTANGLES)["labels"], [])
        self.press("g")
        self.assertEqual(self.run_js(RECTANGLES)["labels"], before)

    def dot_height(self, share):
        """How far the curve's dot is from the altitude chart's top, as a share of its height."""
        wide, high = self.run_js("const over = document.querySelector('.altitude .u-over');"
                                 "return [over.clientWidth, over.clientHeight]")
        self.point_at(".altitude .u-over", wide * share, high / 2)
        moved = self.run_js("return document.querySelector('.altitude .dot').style.transform")
        return float(re.findall(r"-?[\d.]+(?=px)", moved)[1]) / high

    @own_scene
    def test_a_level_route_looks_level(self):
        self.open(level([10, 10.1, 10]))
        ends, middle = self.dot_height(0.03), self.dot_height(0.5)
        self.assertLess(abs(ends - middle), 0.05)
        self.assertAlmostEqual(middle, 0.5, delta=0.1)
        self.open(level([10, 50, 10]))
        self.assertGreater(self.dot_height(0.03) - self.dot_height(0.5), 0.6)

    @own_scene
    def test_attribution_of_a_picture(self):
        scene = copy.deepcopy(self.scene)
        scene["attribution"] = SOURCES
        for theme in ("light", "dark"):
            self.open(scene, f"?still&theme={theme}")
            style = self.run_js("const s = getComputedStyle(document.getElementById("
                                "'attribution')); return [s.fontSize, s.color, s.backgroundColor]")
            self.assertGreaterEqual(float(style[0].removesuffix("px")), 14)
            # Three numbers: a fourth would say that the ground shines through.
            ink, paper = ([float(value) for value in re.findall(r"[\d.]+", color)]
                          for color in style[1:])
            self.assertEqual([len(ink), len(paper)], [3, 3])
            self.assertGreaterEqual(contrast(ink, paper), 7)
            box, legend, stage = self.run_js(
                "return ['attribution', 'legend', 'stage'].map((id) => {"
                "const r = document.getElementById(id).getBoundingClientRect();"
                "return [r.left, r.top, r.right, r.bottom]; })")
            self.assertTrue(within(box, stage))
            self.assertFalse(overlap(box, legend))
