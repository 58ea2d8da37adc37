# SPDX-License-Identifier: Apache-2.0
"""What is above a height cut off: parts of Page and Flat."""
import math

from selenium.webdriver import Keys

import scenes
from case import own_scene

HOUSE = [[600, 600], [700, 600], [700, 700], [600, 700]]
SLAB = [[800, 150], [950, 150], [950, 300], [800, 300]]
SKIRT = [0x8d, 0x94, 0x9d]


def storeys():
    """1,000 x 1,000 x 100 m: shapes that begin at 0, 0, 10, 20, 30 and 50 m; a route at 25 m
    through the house."""
    scene = scenes.empty([[0, 0, 0], [1000, 1000, 100]])
    boxes = [(100, 100, 0, 200, 200, 20), (100, 400, 10, 200, 500, 60),
             (100, 700, 50, 200, 800, 90)]
    scene["boxes"] = [scenes.thing("obstacle", "boxes", count=3, data=scenes.packed("f", [
        float(value) for box in boxes for value in box]))]
    scene["solids"] = [
        scenes.thing("obstacle", "houses", name="house", shape="prism", outline=HOUSE, holes=[],
                     floor=None, ceiling=70),
        scenes.thing("obstacle", "houses", name="slab", shape="prism", outline=SLAB, holes=[],
                     floor=30, ceiling=80),
        scenes.thing("threat", name="radar", shape="sphere", at=[450, 800, 50], radius=30)]
    scene["results"] = [scenes.result("through", [[650, 550, 25], [650, 750, 25]], [])]
    return scene


class Cut:
    # (cut, shapes that begin below it)
    COUNTS = ((100, 6), (55, 6), (50, 5), (30, 4), (20, 3), (10, 2), (5, 2))

    @own_scene
    def test_what_begins_above_the_cut_is_left_out(self):
        self.open(storeys())
        found = []
        for cut, _ in self.COUNTS:
            self.slide("cut", cut)
            found.append((cut, self.drawn()["solids"]))
            self.assert_points(self.drawn()["routes"][0]["points"],
                               [[650, 550, 25], [650, 750, 25]])
        self.assertEqual(found, list(self.COUNTS))

    def test_meshes_are_cut(self):
        """The tent of the ridge stands from 500 to 1,200 m, alone in its layer."""
        for layer in self.run_js("return [...document.querySelectorAll('[data-layer]')]"
                                 ".map((box) => box.dataset.layer)"):
            if not layer.startswith("tent"):
                self.click(f"[data-layer='{layer}']")
        shapes = []
        for cut in (499, 501, 2000):
            self.slide("cut", cut)
            shapes.append(self.drawn()["solids"])
        self.assertEqual(shapes, [0, 1, 1])

    @own_scene
    def test_the_cut_in_the_address(self):
        self.open(storeys(), "?still&cut=30")
        self.assertEqual(self.drawn()["solids"], 4)
        self.assertIn("cut above 30 m", self.text("#legend"))
        self.open(storeys(), "?cut=-5.5")
        self.assertEqual(self.drawn()["solids"], 0)
        for wrong in ("high", "", "1e999"):
            sentence = f"The address says cut={wrong}: expected a height in metres."
            self.open(storeys(), f"?cut={wrong}")
            self.assertEqual(self.text("#alert"), sentence)
            self.assertEqual(self.drawn()["solids"], 6)
            self.expected = [sentence]

    @own_scene
    def test_keys_of_the_cut(self):
        self.open(storeys())
        heights = []
        for key in (",", ",", ".", ".", ".", ",", "c"):
            self.press(key)
            heights.append(self.run_js("return altiplan.state.cut"))
        # JSON has no infinity.
        self.assertEqual(heights, [95, 90, 95, None, None, 95, None])
        self.slide("cut", 2.5)
        for expected in (0, 0):
            self.press(",")
            self.assertEqual(self.run_js("return altiplan.state.cut"), expected)
        self.assertNotIn("cut", self.legend_after("c"))

    def legend_after(self, key):
        self.press(key)
        return self.text("#legend")

    @own_scene
    def test_the_slider_shows_the_cut(self):
        self.open(storeys())
        shown = "return document.getElementById('cut').parentElement.querySelector('output')" \
            ".textContent"
        self.assertTrue(self.visible("#cut"))
        self.assertEqual(self.run_js(shown), "off")
        self.slide("cut", 30)
        self.assertEqual(self.run_js(shown), "30 m")
        self.run_js("document.getElementById('cut').focus()")
        self.press(Keys.ARROW_LEFT)
        self.assertLess(self.run_js("return altiplan.state.cut"), 30)

    @own_scene
    def test_what_is_cut_off_has_no_name(self):
        self.open(storeys())
        names = []
        for cut in (100, 20):
            self.slide("cut", cut)
            place = self.run_js("return altiplan.project(arguments[0])", [875, 225, 80])
            self.point_at("#stage", place["x"], place["y"])
            names.append(self.text("#tip"))
        self.assertEqual(names, ["slab", ""])


class CutIn3:
    """Solids that are cut end at the cut; so does the ground."""

    def stage_pixel(self, point):
        place = self.run_js("return altiplan.project(arguments[0])", point)
        left, top = self.run_js("const r = document.getElementById('stage')"
                                ".getBoundingClientRect(); return [r.left, r.top]")
        return self.pixel(left + place["x"], top + place["y"])

    @own_scene
    def test_nothing_in_the_buffers_is_higher(self):
        self.open(storeys())
        heights = [self.drawn()["highest"]]
        for cut in (85, 60, 30, 7.5):
            self.slide("cut", cut)
            heights.append(self.drawn()["highest"])
        for height, expected in zip(heights, (90, 85, 60, 30, 7.5), strict=True):
            self.assertAlmostEqual(height, expected, delta=1e-3)

    @own_scene
    def test_the_cut_shows_what_was_hidden(self):
        self.open(storeys(), "?theme=light")
        inside = [650, 650, 25]
        self.assertGreater(math.dist(self.stage_pixel(inside), [0, 114, 178]), 60)
        self.slide("cut", 20)
        self.assertLess(math.dist(self.stage_pixel(inside), [0, 114, 178]), 30)

    @own_scene
    def test_a_sphere_is_as_wide_as_its_section(self):
        """Below its middle it is narrower than in its middle, and closed."""
        scene = scenes.empty([[0, 0, 0], [100, 100, 100]])
        scene["solids"] = [scenes.thing("threat", shape="sphere", at=[50, 50, 50], radius=40)]
        self.open(scene, "?cut=20&theme=light")
        self.press("g")
        self.press("t")
        section = math.sqrt(40 ** 2 - 30 ** 2)
        floor = self.stage_pixel([50 + section + 6, 50, 20])
        self.assertLess(max(floor) - min(floor), 10)
        for away in (0, section - 6):
            red, _, blue = self.stage_pixel([50 + away + 1, 53, 20])
            self.assertGreater(red - blue, 40)

    def test_the_ground_is_cut_flat(self):
        self.press("g")
        self.press("t")
        summit = [5200, 4800]
        before = self.stage_pixel([*summit, scenes.hills(5.2, 4.8)])
        self.assertGreater(math.dist(before, SKIRT), 30)
        self.slide("cut", 700)
        self.assertLess(math.dist(self.stage_pixel([*summit, 700]), SKIRT), 4)
        valley = self.stage_pixel([1000, 3300, scenes.hills(1.0, 3.3)])
        self.assertLess(scenes.hills(1.0, 3.3), 690)
        self.assertGreater(math.dist(valley, SKIRT), 30)
        # The pointer still says how high the ground is there.
        place = self.run_js("return altiplan.project(arguments[0])", [*summit, 700])
        self.point_at("#stage", place["x"], place["y"])
        said = float(self.text("#readout").split("ground ")[1].split(" m")[0].replace(",", ""))
        self.assertAlmostEqual(said, scenes.hills(5.2, 4.8), delta=15)

    @own_scene
    def test_what_moves_up_is_cut_where_it_is(self):
        scene = storeys()
        scene["solids"], scene["boxes"] = [], []
        scene["moving"] = [{"id": "lift", "known": True, "since_s": 0.0, "velocity": [0, 0, 2],
                            "added_by": None, "removed_by": None, "shape": "box",
                            "min": [100, 100, 0], "max": [200, 200, 20]}]
        scene["results"][0]["flight"] = scenes.flight([[650, 550, 25], [650, 750, 25]], [])
        scene["results"][0]["flight"]["track"][-1][0] = 30
        self.open(scene, "?cut=30")
        tops = {}
        for time in (0, 4, 10, 16):
            self.slide("time", time)
            tops[time] = self.drawn()["highest"]
        self.assertEqual({time: top and round(top, 3) for time, top in tops.items()},
                         {0: 20, 4: 28, 10: 30, 16: None})

    @own_scene
    def test_obstacles_are_lighter_the_higher_and_stay_grey(self):
        self.open(storeys(), "?theme=light")
        self.press("t")
        tops = [self.stage_pixel(at) for at in ([150, 150, 20], [150, 450, 60], [150, 750, 90])]
        for lower, higher in zip(tops, tops[1:]):
            self.assertGreater(min(b - a for a, b in zip(lower, higher)), 5)
        for color in tops:
            self.assertLess(max(color) - min(color), 30)
        swatches = self.run_js("return [...document.querySelectorAll('#legend .fill')].map("
                               "(fill) => fill.style.getPropertyValue('--swatch'))")
        self.assertIn("#7d8590", swatches)
