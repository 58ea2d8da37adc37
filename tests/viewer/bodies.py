# SPDX-License-Identifier: Apache-2.0
"""The vehicle's body along a route, and at its closest place: a part of Page and Flat."""
import math

import scenes
from case import own_scene

# A wedge of 4 x 2 x 1 m, to the front of the reference point.
CORNERS = [(0, -1, 0), (4, 0, 0), (0, 1, 0), (0, 0, 1)]
FACES = [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]
HALF = math.sqrt(0.5)
NORTH = [0, 0, HALF, HALF]


def slot(proven=True):
    """A route north through a slot, with its body: twice at the corner."""
    scene = scenes.empty([[0, 0, 0], [100, 100, 40]])
    scene["solids"] = [scenes.thing("obstacle", "slot", name="slot", shape="box",
                                    min=[51.42, 60, 0], max=[60, 80, 40])]
    scene["body"] = [{"triangles": scenes.packed("f", [
        float(value) for face in FACES for corner in face for value in CORNERS[corner]])}]
    route = [[10, 20, 10], [50, 20, 10], [50, 90, 10]]
    made = scenes.result("through", route, [])
    made["body"] = {
        "at": [[10, 20, 10], [30, 20, 10], [50, 20, 10], [50, 20, 10], [50, 55, 10], [50, 90, 10]],
        "turned": [[0, 0, 0, 1]] * 3 + [NORTH] * 3,
        "nearest": {"at": [50, 70, 10], "turned": NORTH, "layer": "slot",
                    "body_clearance_m": 0.42, "proven": proven}}
    scene["results"] = [made, scenes.result("sphere", [[10, 5, 10], [90, 5, 10]], [])]
    return scene


class Bodies:
    @own_scene
    def test_the_body_stands_along_the_route_to_scale(self):
        scene = slot()
        self.open(scene)
        drawn = self.drawn()["bodies"]
        self.assertEqual([body["result"] for body in drawn], [0])
        self.assert_points(drawn[0]["at"], scene["results"][0]["body"]["at"])
        xs, ys = ([point[axis] for point in drawn[0]["nearest"]] for axis in (0, 1))
        for found, expected in ((xs, (49, 51)), (ys, (70, 74))):
            self.assertAlmostEqual(min(found), expected[0], delta=0.001)
            self.assertAlmostEqual(max(found), expected[1], delta=0.001)

    @own_scene
    def test_the_label_of_the_closest_place(self):
        self.open(slot())
        self.assertEqual(self.text(".mark.body"), "body: 0.42 m from 'slot'")
        place = self.run_js("return altiplan.project(arguments[0])", [50, 70, 10])
        self.assertLess(math.dist(self.mark("body"), [place["x"], place["y"]]), 1)
        self.assertIn("Body, to scale", self.text("#legend"))
        self.click("[role=tab]", 1)
        self.assertIn("Body clearance, m0.42–", self.text(".pane.metrics"))
        self.open(slot(proven=False))
        self.assertEqual(self.text(".mark.body"), "body: at most 0.42 m from 'slot'")
        touching = slot()
        touching["results"][0]["body"]["nearest"]["body_clearance_m"] = 0.0
        self.open(touching)
        self.assertEqual(self.text(".mark.body"), "body meets 'slot'")

    @own_scene
    def test_bodies_are_hidden_by_the_check_box_and_with_their_route(self):
        self.open(slot())
        self.run_js("document.getElementById('show_bodies').focus()")
        self.press(" ")
        self.assertEqual(self.drawn()["bodies"], [])
        self.assertFalse(self.visible(".mark.body"))
        self.assertNotIn("Body", self.text("#legend"))
        self.press(" ")
        self.assertEqual(len(self.drawn()["bodies"]), 1)
        self.click("[data-line='0']")
        self.assertEqual(self.drawn()["bodies"], [])
        self.assertFalse(self.visible(".mark.body"))
        # The button shows it again, from near by: in full colour.
        self.click(".bodies button")
        self.assertEqual(len(self.drawn()["bodies"]), 1)
        self.assertTrue(self.visible(".mark.body"))
        left, top = self.run_js("const r = document.getElementById('stage')"
                                ".getBoundingClientRect(); return [r.left, r.top]")
        self.click("[data-line='0']")
        place = self.run_js("return altiplan.project(arguments[0])", [50.2, 71.2, 10.3])
        without = self.pixel(left + place["x"], top + place["y"])
        self.click("[data-line='0']")
        body = self.pixel(left + place["x"], top + place["y"])
        self.assertGreater(math.dist(body, without), 60)
        self.assertGreater(body[2], body[0] + 40, "the blue of the first route")

    @own_scene
    def test_a_scene_without_a_body_has_no_check_box(self):
        scene = slot()
        del scene["body"], scene["results"][0]["body"]
        self.open(scene)
        self.assertEqual(self.drawn()["bodies"], [])
        self.assertEqual(self.run_js("return document.querySelectorAll('#show_bodies').length"), 0)
        self.assertNotIn("Body", self.text("#legend"))
