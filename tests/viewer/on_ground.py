# SPDX-License-Identifier: Apache-2.0
"""What is drawn on the ground, contours and a basemap: parts of Page and Flat."""
import array
import base64
import math
import struct
import time
import zlib

import scenes
from case import own_scene

BOX = [[0.0, 0.0, 100.0], [10000.0, 8000.0, 2000.0]]
NX, NY = 201, 161
DX, DY = 10000 / (NX - 1), 8000 / (NY - 1)
# Of 1,000 m of relief.
STEP, INDEX = 50, 250
RED, GREEN, BLUE, NOTHING = (200, 40, 40, 255), (40, 160, 40, 255), (40, 40, 200, 255), (0, 0, 0, 0)


def hills(hole=None):
    scene = scenes.empty(BOX)
    scene["ground"] = scenes.ground(NX, NY, BOX, hole)
    return scene


def png(rows):
    """A PNG of rows of RGBA pixels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    pixels = b"".join(b"\0" + bytes(value for pixel in row for value in pixel) for row in rows)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 6, 0, 0, 0)) + \
        chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b"")
    return "data:image/png;base64," + base64.b64encode(data).decode()


def basemap(low, high):
    """Red in the north-west, green in the north-east, blue in the south-west, nothing in the south-east."""
    return {"name": "quarters.tif", "box": [low, high], "image": png(
        [[RED] * 64 + [GREEN] * 64] * 64 + [[BLUE] * 64 + [NOTHING] * 64] * 64)}


def along_rows(height_of, slopes=(2, 12), every=3, margin=4):
    """Places between two posts of a row, apart by these heights, where the ground has a height above the lower one."""
    for j in range(margin, NY - margin, every):
        for i in range(margin, NX - 1 - margin):
            a, b = (scenes.hills(n * DX / 1000, j * DY / 1000) for n in (i, i + 1))
            height = height_of(min(a, b))
            if min(a, b) <= height <= max(a, b) and slopes[0] < abs(b - a) < slopes[1]:
                yield [(i + (height - a) / (b - a)) * DX, j * DY, height]


class OnGround:
    def from_above(self, scene, query="?theme=light"):
        """Opens the scene, seen from above, with nothing but the ground."""
        self.open(scene, query)
        while not self.run_js("return altiplan.ready || altiplan.errors.length > 0"):
            time.sleep(0.02)
        self.press("g")
        self.press("t")
        self.run_js("for (const panel of document.querySelectorAll('#stage > :not(canvas)')) panel.style.visibility = 'hidden'")

    def places(self, points):
        left, top = self.run_js("const r = document.getElementById('stage')"
                                ".getBoundingClientRect(); return [r.left, r.top]")
        found = self.run_js("return arguments[0].map((point) => altiplan.project(point))", points)
        return [(left + place["x"], top + place["y"]) for place in found]

    def light(self, points):
        """The darkest of a pixel and its neighbours, for each of the points: a line is a pixel wide."""
        around = [(x + east, y + south) for x, y in self.places(points) for east in (-1, 0, 1) for south in (-1, 0, 1)]
        sums = [sum(color) for color in self.pixels(around)]
        return [sums[at:at + 9] for at in range(0, len(sums), 9)]

    def darkened(self, points):
        """Of each point, by how much contours darken the middle and the darkest pixel, from 0 to 1."""
        before = self.light(points)
        self.click("#show_contours")
        after = self.light(points)
        self.click("#show_contours")
        share = [[1 - a / b for a, b in zip(on, off)] for on, off in zip(before, after)]
        return [(around[4], max(around)) for around in share]

    @own_scene
    def test_contours_are_where_the_ground_is_so_high(self):
        self.from_above(hills())
        self.assertIn(f"contours every {STEP} m", self.text("#legend"))
        on = list(along_rows(lambda low: math.ceil(low / STEP) * STEP))
        between = list(along_rows(lambda low: (math.floor(low / STEP) + 0.5) * STEP))
        self.assertGreater(min(len(on), len(between)), 100)
        self.assertGreater(min(most for _, most in self.darkened(on)), 0.15)
        self.assertLess(max(middle for middle, _ in self.darkened(between)), 0.05)
        index = [most for point, (_, most) in zip(on, self.darkened(on)) if point[2] % INDEX == 0]
        self.assertGreater(min(index), 0.45)

    @own_scene
    def test_no_contours_beside_missing_posts(self):
        i, j = 104, 88
        scene = hills((i, j))
        self.from_above(scene)
        hole = [[(i + east) * DX, (j + north) * DY, scenes.hills(i * DX / 1000, j * DY / 1000)]
                for east in (-0.5, 0, 0.5) for north in (-0.5, 0, 0.5)]
        self.assertEqual([change for change, _ in self.darkened(hole)], [0] * 9)
        self.assertEqual(self.run_js("return altiplan.errors"), [])

    @own_scene
    def test_level_ground_has_no_contours(self):
        scene = scenes.empty(BOX)
        scene["ground"] = {**scenes.ground(3, 3, BOX), "heights": scenes.packed("f", [400.0] * 9)}
        self.from_above(scene)
        self.assertIsNone(self.run_js("return document.getElementById('show_contours')"))
        self.assertNotIn("contours", self.text("#legend"))
        # A lake as high as a contour, from which ground rises.
        heights = array.array("f", [400.0 if i < 100 else 400.0 + i - 100 for _ in range(NY) for i in range(NX)])
        scene["ground"] = {**scenes.ground(NX, NY, BOX), "heights": scenes.packed("f", heights)}
        self.from_above(scene)
        lake = [[x, y, 400] for x in (1000, 2000, 4000) for y in (1000, 4000, 7000)]
        self.assertEqual([change for change, _ in self.darkened(lake)], [0] * 9)

    @own_scene
    def test_index_contours_say_their_heights(self):
        self.from_above(hills())
        labels = self.run_js(
            "const left = document.getElementById('stage').getBoundingClientRect();"
            "return [...document.querySelectorAll('.mark.height')].filter(({hidden}) => !hidden).map((mark) => {"
            "const r = mark.querySelector('span').getBoundingClientRect();"
            "return [mark.textContent, (r.left + r.right) / 2, (r.top + r.bottom) / 2]; })")
        self.assertGreater(len(labels), 3)
        at = {INDEX * nth: self.places(list(along_rows(
            lambda low, nth=nth: INDEX * nth if low <= INDEX * nth else math.inf, (0, 100), 1, 0))) for nth in range(1, 5)}
        for text, x, y in labels:
            nearest = min(math.dist((x, y), place) for place in at[int(text.replace(",", ""))])
            self.assertLess(nearest, 4, (text, x, y))
        self.click("#show_contours")
        self.assertEqual(self.run_js("return [...document.querySelectorAll('.mark.height')]"
                                     ".filter(({hidden}) => !hidden).length"), 0)

    @own_scene
    def test_a_basemap_is_where_it_says(self):
        for scene in (hills(), scenes.empty(BOX)):
            scene["basemap"] = basemap([2000, 1000], [9000, 7000])
            self.from_above(scene)
            has_ground = scene["ground"] is not None
            if has_ground:
                self.click("#show_contours")
            # Two pixels of the image from the borders of its quarters.
            near = [(2110, 6900, RED), (5390, 4100, RED), (5610, 4100, GREEN), (8890, 6900, GREEN), (2110, 1100, BLUE),
                    (5390, 3900, BLUE), (5800, 3700, None), (8890, 1100, None), (1900, 4000, None), (9100, 4000, None),
                    (4000, 900, None), (4000, 7100, None)]
            points = [[x, y, scenes.hills(x / 1000, y / 1000) if has_ground else BOX[0][2]] for x, y, _ in near]
            shown = self.pixels(self.places(points))
            self.click("#show_basemap")
            bare = self.pixels(self.places(points))
            for (x, y, color), found, below in zip(near, shown, bare):
                self.assertLess(math.dist(found, (color or below)[:3]), 12, (x, y, has_ground))
                if color:
                    self.assertGreater(math.dist(below, color[:3]), 40)

    @own_scene
    def test_items_of_a_mission_have_their_numbers(self):
        scene = scenes.empty(BOX)
        scene["numbered"] = [{"number": 3 + nth, "at": [1000 + 1000 * nth, 4000, 900]} for nth in range(8)]
        self.open(scene)
        shown = "return [...document.querySelectorAll('.mark.via')].map((mark) => [mark.textContent, mark.hidden])"
        self.assertEqual(self.run_js(shown), [[str(3 + nth), False] for nth in range(8)])
        place = self.run_js("return altiplan.project(arguments[0])", scene["numbered"][0]["at"])
        self.assertLess(math.dist(self.mark("via"), (place["x"], place["y"])), 1)
        scene["numbered"] = scene["numbered"] * 100
        self.open(scene)
        self.assertEqual(len(self.run_js(shown)), 200)
