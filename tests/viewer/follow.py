# SPDX-License-Identifier: Apache-2.0
"""What follows the flight, and what gives directions and lengths: parts of Page and Flat."""
import math

import scenes
from case import own_scene

CENTRE = """const {left, top, right, bottom} = document.querySelector(arguments[0])
  .getBoundingClientRect(); return [(left + right) / 2, (top + bottom) / 2, right - left];"""


def clock_text(seconds):
    return f"{int(seconds // 60)}:{int(seconds % 60):02}.{int(seconds % 1 * 10)}"


class Follow:
    def track(self):
        return self.scene["results"][0]["flight"]["track"]

    def place(self, time):
        """Where the vehicle is, and its speed."""
        for (t0, *a), (t1, *b) in zip(self.track(), self.track()[1:]):
            if t0 <= time <= t1:
                share = (time - t0) / (t1 - t0)
                return [p + share * (q - p) for p, q in zip(a, b)], math.dist(a, b) / (t1 - t0)
        raise ValueError(time)

    def stage(self):
        return self.run_js("const s = document.getElementById('stage');"
                           "return [s.clientWidth, s.clientHeight]")

    def test_follow(self):
        self.assertFalse(self.run_js("return altiplan.camera().following"))
        self.click("#follow")
        for time in (1.25, 20, 44):
            self.slide("time", time)
            at, _ = self.place(time)
            seen = self.run_js("return altiplan.project(arguments[0])", at)
            width, height = self.stage()
            self.assertLess(abs(seen["x"] - width / 2), 0.2 * width, time)
            self.assertLess(abs(seen["y"] - height / 2), 0.3 * height, time)
        self.assertTrue(self.run_js("return altiplan.camera().following"))
        self.press("f")
        self.assertFalse(self.run_js("return altiplan.camera().following"))
        self.press("f")
        self.press("r")
        self.assertFalse(self.run_js("return altiplan.camera().following"), "the overview ends it")

    def test_telemetry(self):
        for time in (0.5, 20.25, 44):
            self.slide("time", time)
            at, speed = self.place(time)
            said = self.run_js("return [...document.querySelectorAll('#telemetry output')]"
                               ".map((output) => output.textContent)")
            self.assertEqual([said[0], said[2]], [f"{speed:.1f} m/s", clock_text(time)])
            height = float(said[1].removesuffix(" m").replace(",", ""))
            self.assertAlmostEqual(height, at[2] - scenes.hills(at[0] / 1000, at[1] / 1000), delta=3)
        self.assertEqual(self.text("#telemetry b"), "around")

    def test_captions_of_what_happens(self):
        self.click("#follow")
        self.run_js("const s = document.getElementById('speed'); s.value = 1;"
                    "s.dispatchEvent(new Event('change'))")
        said = []
        last = self.track()[-1][0]
        for time in (7.5, 9, 12.5, 21.5, 22.5, last):
            self.slide("time", time)
            said.append(self.text("#caption") if self.visible("#caption") else None)
        self.assertEqual(said, [
            None, "Handover to avoid: an obstacle is near", "a radar appears",
            None, "Replan with again, solved: the way is blocked",
            "Goal reached: The vehicle came to touch post at 31.5 s."])

    def test_profiles_follow(self):
        """Their cursor is where the vehicle is, and their part goes on with it."""
        self.slide("time", 20)
        at, _ = self.place(20)
        samples = self.scene["results"][0]["profile"]
        nearest = min(range(len(samples["at"])), key=lambda n: math.dist(samples["at"][n], at))
        self.assertAlmostEqual(self.cursor_x(), samples["s"][nearest], delta=60)
        self.run_js("[...document.querySelectorAll('.choice button')].find((button) =>"
                    "button.textContent === 'Flight').click()")
        self.browser.settle()
        last = self.track()[-1][0]
        for _ in range(4):
            self.click(".zoom button", 1)
        low, high = self.run_js("return altiplan.state.zoom")
        self.assertAlmostEqual(high - low, last / 1.6 ** 4, delta=1e-6)
        self.assertTrue(low < 20 < high)
        self.slide("time", 44)
        low, high = self.run_js("return altiplan.state.zoom")
        self.assertTrue(low < 44 < high)
        self.assertAlmostEqual(high - low, last / 1.6 ** 4, delta=1e-6)
        self.assertAlmostEqual(self.cursor_x(), 44, delta=0.2)
        for _ in range(5):
            self.click(".zoom button", 0)
        self.assertIsNone(self.run_js("return altiplan.state.zoom"))

    def cursor_x(self):
        """Along the altitude's axis, from two of its numbers and the cursor on the page."""
        numbers = self.run_js("""const canvas = document.querySelector('.altitude canvas')
          .getBoundingClientRect(); const all = altiplan.labels().filter(({within}) =>
            within[0] === canvas.left); const low = Math.max(...all.map(({box}) => box[1]));
          return all.filter(({box}) => box[1] === low).map(({text, box}) =>
            [Number(text.replace(',', '')), (box[0] + box[2]) / 2]);""")
        (a, left), (b, right) = numbers[0], numbers[-1]
        line = self.run_js("return document.querySelector('.altitude .u-cursor-x')"
                           ".getBoundingClientRect().left")
        per_pixel = (b - a) / (right - left)
        unit = 1000 if ", km" in self.text(".choice .note") else 1
        return (a + (line - left) * per_pixel) * unit

    def test_the_n_is_at_the_head_of_the_needle(self):
        for key in ("r", "t", "n"):
            self.press(key)
            middle = self.run_js(CENTRE, "#north")
            letter = self.run_js(CENTRE, "#north span")
            away = [p - q for p, q in zip(letter[:2], middle[:2])]
            self.assertGreater(math.hypot(*away), 14)
            base = [5000, 4000, 600]
            here, north = (self.run_js("return altiplan.project(arguments[0])", [5000, y, 600])
                           for y in (base[1], base[1] + 10))
            turned = math.atan2(north["x"] - here["x"], here["y"] - north["y"])
            # In perspective the north of the middle is a little aside.
            self.assertAlmostEqual(math.atan2(away[0], -away[1]), turned, delta=0.5)

    def test_the_scale(self):
        for key in ("r", "t"):
            self.press(key)
            text = self.text("#scale")
            length = float(text.split()[0]) * (1000 if text.endswith("km") else 1)
            width = self.run_js(CENTRE, "#scale i")[2]
            self.assertAlmostEqual(width, length / self.metres_per_pixel(), delta=1.5)
            self.assertTrue(40 < width <= 125, width)

    def metres_per_pixel(self):
        """Across the middle of the picture."""
        eye = self.run_js("return altiplan.camera()")
        if self.view == "2d":
            here, there = [0, 0, 0], [100, 0, 0]
        else:
            middle = [(a + b) / 2 for a, b in zip(*self.scene["box"])]
            here = [m + t for m, t in zip(middle, eye["target"])]
            ahead = [t - p for t, p in zip(eye["target"], eye["position"])][:2]
            flat = math.hypot(*ahead) or 1
            there = [here[0] + 100 * ahead[1] / flat, here[1] - 100 * ahead[0] / flat, here[2]]
        a, b = (self.run_js("return altiplan.project(arguments[0])", point) for point in (here, there))
        return 100 / math.dist([a["x"], a["y"]], [b["x"], b["y"]])

    @own_scene
    def test_kilometres_above_ten_thousand_metres(self):
        for east, unit in ((10000, "m"), (10001, "m"), (12000, "km")):
            scene = scenes.empty([[0, 0, 0], [east, 9000, 500]])
            route = [[0, 0, 100], [east, 0, 100]]
            scene["results"] = [scenes.result("far", route, [],
                                              profile=scenes.profile_of(route, lambda x, y: None))]
            self.open(scene)
            texts = self.run_js("return [...document.querySelectorAll('.mark.tick')].filter((mark) =>"
                                "!mark.hidden).map((mark) => mark.textContent)")
            self.assertIn(f"x east, {unit}", texts)
            along = "km" if east > 10000 else "m"
            self.assertIn(f"over distance, {along}", self.text(".choice"))
            numbers = self.run_js("return altiplan.labels().map(({text}) => text)")
            self.assertIn("5" if along == "km" else "5,000", numbers)

    @own_scene
    def test_a_film(self):
        self.open(self.scene, "?film")
        begin = "altiplan.film.begin(20).then(arguments[0])"
        self.browser.driver.execute_async_script(begin)
        times, captions = [], []
        for second in (0, 1, 2.5, 10.25, 18, 19.96):
            self.browser.driver.execute_async_script(
                "altiplan.film.frame(arguments[0]).then(arguments[1])", second)
            times.append(self.run_js("return altiplan.state.time"))
            captions.append(self.text("#caption"))
        last = self.track()[-1][0]
        for time, expected in zip(times, (0, 0, 0, last / 2, last, last), strict=True):
            self.assertAlmostEqual(time, expected, delta=1e-6)
        self.assertIn("Goal reached", captions[-1])
        self.assertTrue(self.run_js("return altiplan.camera().following"))
        for part in ("#telemetry", "#north", "#scale", ".chart.altitude"):
            self.assertTrue(self.visible(part), part)
        for part in ("#bar", "#side", "#clock", "#legend", ".chart.speed"):
            self.assertFalse(self.visible(part), part)


class FollowIn3:
    def test_the_eye_is_behind_and_above_the_ground(self):
        self.click("#follow")
        middle = [(a + b) / 2 for a, b in zip(*self.scene["box"])]
        for time in (5, 14, 30, 44):
            self.slide("time", time)
            eye = self.run_js("return altiplan.camera()")
            position = [m + p for m, p in zip(middle, eye["position"])]
            (ax, ay, _), (bx, by, _) = self.place(time - 3)[0], self.place(time + 3)[0]
            at, _ = self.place(time)
            ahead = (at[0] - position[0]) * (bx - ax) + (at[1] - position[1]) * (by - ay)
            away = math.dist(position[:2], at[:2]) * math.hypot(bx - ax, by - ay)
            self.assertGreater(ahead / away, 0.8, time)
            self.assertGreater(position[2], scenes.hills(position[0] / 1000, position[1] / 1000), time)

    def test_the_user_turns_the_eye_around_the_vehicle(self):
        self.click("#follow")
        self.slide("time", 20)
        before = self.run_js("return altiplan.camera()")
        self.run_js("""const canvas = document.querySelector('#stage canvas');
          canvas.setPointerCapture = canvas.releasePointerCapture = () => {};
          const at = (type, x) => canvas.dispatchEvent(new PointerEvent(type, {pointerId: 1, button: 0,
            buttons: type === 'pointerup' ? 0 : 1, clientX: x, clientY: 300, bubbles: true}));
          at('pointerdown', 600); at('pointermove', 800); at('pointerup', 800);""")
        self.slide("time", 20.1)
        after = self.run_js("return altiplan.camera()")
        self.assertTrue(after["following"])
        back = [[p - t for p, t in zip(eye["position"], eye["target"])] for eye in (before, after)]
        self.assertAlmostEqual(math.hypot(*back[0]), math.hypot(*back[1]), delta=1)
        turned = math.atan2(back[1][1], back[1][0]) - math.atan2(back[0][1], back[0][0])
        self.assertGreater(abs(math.remainder(turned, 2 * math.pi)), 0.5)

    @own_scene
    def test_a_floor_where_there_is_no_ground(self):
        box = [[-20, 10, 5], [100, 80, 60]]
        self.open(scenes.empty(box))
        low, high = self.drawn()["floor"]
        self.assert_points([low, high], [box[0], [*box[1][:2], box[0][2]]])
        self.assertIn("floor drawn at 5 m", self.text("#legend"))
        self.open(scenes.ridge(20, 20))
        self.assertIsNone(self.drawn()["floor"])
