# SPDX-License-Identifier: Apache-2.0
"""edit_test.py PROGRAM: the page of `altiplan edit` in a browser: what is dragged, drawn, chosen and
saved, and another scene in an open page.

`edit_test.py PROGRAM Page.test_a_drag` runs one case; skipped without Chromium. With
ALTIPLAN_PICTURES in the environment, a picture of each case goes into that folder."""
import contextlib
import json
import os
import pathlib
import re
import sys
import time
import unittest

import browser
from selenium.common.exceptions import NoSuchElementException, StaleElementReferenceException
from selenium.webdriver import ActionChains, Keys
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import Select

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "cli"))
from edit_session import PIPELINE, EditCase, by_night  # noqa: E402

PICTURES = os.environ.get("ALTIPLAN_PICTURES")
TERRAIN = pathlib.Path(__file__).resolve().parents[2] / "configs/data/jacksboro_fault.tif"
# The text of all that a scene fills.
TEXTS = """const text = (id) => document.getElementById(id).innerText;
document.getElementById('tab_metrics').click();
await new Promise((done) => setTimeout(done, 50));
const metrics = text('dock');
document.getElementById('tab_violations').click();
await new Promise((done) => setTimeout(done, 50));
const violations = text('dock');
document.getElementById('tab_profiles').click();
await new Promise((done) => setTimeout(done, 50));
return {metrics, violations, profiles: text('dock'), side: text('side'), verdict: text('verdict'),
  clock: text('clock'), legend: text('legend'), telemetry: text('telemetry'),
  alert: document.getElementById('alert').hidden ? '' : text('alert'),
  marks: [...document.querySelectorAll('#marks .mark:not(.tick) > span')].map((one) => one.innerText).sort(),
  drawn: altiplan.drawn()};"""


class Page(EditCase):
    def setUp(self):
        super().setUp()
        self.browser = browser.shared()
        self.browser.size(1400, 900)
        self.driver = self.browser.driver

    def open(self, query=""):
        session = self.begin()
        self.driver.get("about:blank")
        self.browser.console()
        self.driver.get(session.address.geturl() + query)
        self.await_(lambda: self.browser.run("return window.altiplan?.ready"))
        self.await_(lambda: self.browser.run("return document.querySelectorAll('#edit .field').length > 0"))
        self.addCleanup(self.assert_quiet)
        return session

    def assert_quiet(self):
        if PICTURES:
            self.browser.picture(os.path.join(PICTURES, f"edit_{self._testMethodName}.png"))
        self.assertEqual(self.browser.run("return altiplan.errors"), [])

    def await_(self, holds, seconds=300):
        deadline = time.monotonic() + seconds
        while True:
            # Forms are built anew at each answer: an element may be gone when it is asked.
            with contextlib.suppress(StaleElementReferenceException, NoSuchElementException):
                if found := holds():
                    return found
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.05)

    def find(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def press(self, selector):
        self.await_(lambda: self.find(selector).click() or True)

    def handle(self, key):
        return self.find(f'.handle[data-key="{key}"]')

    def state(self):
        return self.browser.run("return altiplan.editor.state")

    def sets(self, pipeline=0):
        return self.state()["pipelines"][pipeline]["set"]

    def texts(self):
        found = self.driver.execute_async_script(
            "const done = arguments[0]; (async () => {" + TEXTS + "})().then(done);")
        # How long it took is another time each time.
        found["metrics"] = re.sub(r"(?m)^.* time, s\t.*$", "", found["metrics"])
        return found

    def still(self):
        """Until everything asked for is answered and drawn."""
        self.driver.execute_async_script(
            "const done = arguments[0]; altiplan.editor.change({}).then(() => done());")

    def route(self):
        return self.browser.run("return altiplan.drawn().routes.filter(({step}) => step === null)"
                                ".map(({points}) => points.at(-1).map(Math.round))")

    def test_a_drag(self):
        self.open()
        before = self.route()
        drag = ActionChains(self.driver, duration=20).click_and_hold(self.handle("goal"))
        for _ in range(30):
            drag.move_by_offset(-3, 1)
        drag.release().perform()
        self.await_(lambda: self.sets() and not self.state()["quick"])
        self.still()
        [text] = self.sets()
        self.assertRegex(text, r"^scenario\.goal\.at_m=\[.*, 60\]$")
        goal = [round(float(number)) for number in text.split("[")[1][:-1].split(",")]
        self.assertNotEqual(self.route(), before)
        self.assertEqual(self.route(), [goal])
        times = self.browser.run("return altiplan.editor.times")
        self.assertGreater(len(times), 3)
        numbers = [one["number"] for one in times]
        self.assertEqual(numbers, sorted(numbers))
        self.assertEqual(times[-1]["quick"], False)
        self.press("#undo")
        self.await_(lambda: not self.sets())
        self.still()
        self.assertEqual(self.route(), before)

    def test_an_item_of_a_mission(self):
        plan = self.folder / "m.plan"
        items = [{"type": "SimpleItem", "command": 16, "frame": 0, "doJumpId": n + 1, "autoContinue": True,
                  "params": [0, 0, 0, 0, lat, lon, 1500]}
                 for n, (lon, lat) in enumerate([(-84.3, 36.5), (-84.28, 36.54), (-84.24, 36.56)])]
        plan.write_text(json.dumps({"fileType": "Plan", "version": 1, "groundStation": "QGroundControl",
            "geoFence": {"version": 2, "circles": [], "polygons": []},
            "rallyPoints": {"version": 2, "points": []},
            "mission": {"version": 2, "firmwareType": 3, "vehicleType": 2, "items": items, "cruiseSpeed": 15,
                        "hoverSpeed": 5,
                        "plannedHomePosition": [36.5, -84.3, 400]}}))
        session = self.begin(plan, "--terrain", TERRAIN, "--min-agl", "100")
        self.driver.get(session.address.geturl())
        self.await_(lambda: self.browser.run("return window.altiplan?.ready"))
        self.addCleanup(self.assert_quiet)
        self.assertEqual(self.browser.run("return [...document.querySelectorAll('.handle')]"
                                          ".map((one) => one.dataset.number)"), ["1", "2", "3"])
        self.assertRegex(self.find("#judged").text, "^pass: ")
        before = self.route()
        drag = ActionChains(self.driver, duration=20).click_and_hold(self.handle("mission.items.2"))
        for _ in range(10):
            drag.move_by_offset(-4, 1)
        drag.release().perform()
        self.await_(lambda: self.state()["undo"] and not self.state()["quick"])
        self.assertNotEqual(self.route(), before)
        self.driver.execute_async_script(
            "const done = arguments[0]; altiplan.editor.move('mission.items.2', [0, 0, -900], 0, false).then(done);")
        self.await_(lambda: self.find("#judged").text.startswith("fail: "))
        self.assertIn("item 3", self.find("#judged ol").text)
        self.assertNotIn("pass", self.find("body").text)
        self.press("#save")
        self.await_(lambda: json.loads(plan.read_text())["mission"]["items"][2]["params"][6] == 600)

    def test_sizes_are_pulled(self):
        self.open("?flat")
        radius = self.handle("environment.0.cylinder.radius_m")
        ActionChains(self.driver).drag_and_drop_by_offset(radius, 30, 0).perform()
        self.await_(self.sets)
        self.still()
        [text] = self.sets()
        self.assertGreater(float(text.removeprefix("scenario.environment.0.cylinder.radius_m=")), 61)
        corner = self.handle("environment.1.box.max_m")
        ActionChains(self.driver).drag_and_drop_by_offset(corner, 20, -20).perform()
        self.await_(lambda: len(self.sets()) == 2)
        self.still()
        x, y, z = json.loads(self.sets()[1].removeprefix("scenario.environment.1.box.max_m="))
        self.assertGreater(x, 701)
        self.assertGreater(y, 421)
        self.assertEqual(z, 120)
        # The opposite corner cannot be passed.
        ActionChains(self.driver).drag_and_drop_by_offset(corner, -400, 300).perform()
        self.await_(lambda: json.loads(self.sets()[1].split("=")[1])[:2] == [600.1, 200.1])
        self.still()

    def test_heights_and_keys(self):
        self.open()
        cylinder = self.handle("environment.0.cylinder")
        ActionChains(self.driver).key_down(Keys.SHIFT).click_and_hold(cylinder).move_by_offset(0, -20) \
            .release().key_up(Keys.SHIFT).perform()
        self.await_(lambda: any("ceiling_m" in text for text in self.sets()))
        self.still()
        ceiling = next(text for text in self.sets() if "ceiling_m" in text)
        self.assertGreater(float(ceiling.split("=")[1]), 300)
        goal = self.handle("goal")
        self.browser.run("arguments[0].focus()", goal)
        goal.send_keys(Keys.ARROW_LEFT + Keys.ARROW_LEFT)  # in one call: one gesture on a busy machine, too
        self.await_(lambda: any(text.startswith("scenario.goal.at_m=[920,") or
                                text.startswith("scenario.goal.at_m=[930,") for text in self.sets()))
        time.sleep(0.6)
        self.still()
        goal = self.handle("goal")
        goal.send_keys(Keys.CONTROL, "z")
        self.await_(lambda: not any("goal" in text for text in self.sets()))
        self.browser.run("arguments[0].focus()", self.handle("environment.1.box"))
        self.handle("environment.1.box").send_keys(Keys.DELETE)
        self.await_(lambda: "~scenario.environment.1" in self.sets())

    def test_what_is_added_is_planned_around_and_saved(self):
        session = self.open()
        self.find("#do_top").click()
        self.browser.settle()
        canvas = self.find("#stage canvas")
        self.find("#add_zone").click()
        places = ([250, 250, 0], [350, 250, 0], [350, 350, 0], [250, 350, 0])
        for place in places:
            at = self.browser.run("return altiplan.project(arguments[0])", place)
            size = canvas.size
            ActionChains(self.driver).move_to_element_with_offset(
                canvas, int(at["x"] - size["width"] / 2), int(at["y"] - size["height"] / 2)).click().perform()
        self.driver.switch_to.active_element.send_keys(Keys.ENTER)
        self.await_(lambda: any("prism" in text for text in self.sets()))
        self.find("#add_pop_up").click()
        ActionChains(self.driver).move_to_element_with_offset(canvas, 60, 20).click().perform()
        self.await_(lambda: any("scenario.events.1" in text for text in self.sets()))
        self.still()
        keys = [item["key"] for item in self.browser.run("return altiplan.editor.movable")]
        self.assertIn("environment.3.prism", keys)
        self.assertIn("events.1.add.cylinder", keys)
        self.assertIn("prism", self.find("#side").text)
        self.find("#save").click()
        self.await_(lambda: "Saved" in self.find("#edit [role=status]").text)
        text = self.scenario.read_text()
        self.assertIn("# Two radars would be too many.", text)
        [outline] = re.findall(r"- {prism: {outline_m: (.*)}}", text)
        for corner, wanted in zip(json.loads(outline), places, strict=True):
            self.assertAlmostEqual(corner[0], wanted[0], delta=5)
            self.assertAlmostEqual(corner[1], wanted[1], delta=5)
        self.assertEqual(self.sets(), [])
        self.assertTrue(session.edit()["answers"][0]["results"][0]["route"])

    def test_plugins_parameters_and_a_second_pipeline(self):
        self.open()
        self.await_(lambda: len(Select(self.find("select.plan")).options) > 5)
        Select(self.find("select.plan")).select_by_value("theta_star")
        self.await_(lambda: "steps.0.plan=theta_star" in self.sets())
        self.still()
        self.browser.run("document.querySelector('#edit div.step details').open = true")
        field = self.browser.run("return [...document.querySelectorAll('#edit div.step .field')]"
                                 ".find((one) => one.innerText.includes('cell_m')).querySelector('input')")
        field.send_keys("[40, 40, 30]", Keys.TAB)
        focus = "return document.activeElement.ariaLabel"
        beside = self.browser.run(focus)
        self.await_(lambda: any("cell_m=[40, 40, 30]" in text for text in self.sets()))
        self.still()
        self.assertEqual(self.browser.run(focus), beside)  # in the form that was built anew
        self.assertIsNotNone(beside)
        self.press("#compare")
        self.await_(lambda: len(self.state()["pipelines"]) == 2)
        self.await_(lambda: len(self.driver.find_elements(By.CSS_SELECTOR, "#side .result")) == 2)
        self.assertEqual(len(self.route()), 2)
        field = self.browser.run("return [...document.querySelectorAll('#edit div.step .field')]"
                                 ".find((one) => one.innerText.includes('cell_m')).querySelector('input')")
        self.browser.run("arguments[0].value = ''", field)
        field.send_keys("none", Keys.TAB)
        self.await_(lambda: "cell_m" in self.find("#edit [role=status]").text)
        self.assertTrue(any("cell_m=[40, 40, 30]" in text for text in self.sets()))

    @by_night
    def test_a_constraint_is_of_one_pipeline(self):
        self.open()
        self.press("#compare")
        self.await_(lambda: len(self.state()["pipelines"]) == 2)
        self.await_(lambda: len(self.driver.find_elements(By.CSS_SELECTOR, "#edit h3")) == 2)
        self.still()
        # The plugins' names come after the page.
        self.await_(lambda: len(self.driver.find_elements(
            By.CSS_SELECTOR,
            "[aria-label='A further constraint'] option[value=climb_angle]")) == 2)
        choices = self.driver.find_elements(By.CSS_SELECTOR, "[aria-label='A further constraint']")
        Select(choices[1]).select_by_value("climb_angle")
        form = choices[1].find_element(By.XPATH, "..")
        form.find_element(By.CSS_SELECTOR, "[aria-label=max_deg]").send_keys("12")
        form.find_element(By.CSS_SELECTOR, "button").click()
        self.await_(lambda: any("climb_angle" in text for text in self.sets(1)))
        self.assertEqual(self.sets(0), [])

    @by_night
    def test_a_click_selects_and_moves_nothing(self):
        self.open()
        for key, by in (("environment.1.box", 0), ("goal", 2)):
            ActionChains(self.driver).click_and_hold(self.handle(key)).move_by_offset(by, 0).release().perform()
            self.await_(lambda key=key: Select(self.find("#items")).first_selected_option.get_attribute("value") == key)
        self.still()
        self.assertEqual(self.sets(), [])

    @by_night
    def test_an_event_is_dragged_on_the_clock(self):
        self.open()
        self.await_(lambda: self.find("#clock [data-event='0']"))
        height = self.find("#stage").size["height"]
        drag = ActionChains(self.driver, duration=50).click_and_hold(self.find("#clock [data-event='0']"))
        for _ in range(10):
            drag.move_by_offset(10, 0)
        drag.perform()
        self.assertEqual(self.find("#stage").size["height"], height)
        time.sleep(0.3)
        ActionChains(self.driver).move_by_offset(5, 0).release().perform()
        self.await_(lambda: self.sets() and not self.state()["quick"])
        self.still()
        [text] = self.sets()
        second = float(text.removeprefix("scenario.events.0.at_s="))
        wide = self.find("#clock .marks").size["width"]
        last = float(self.find("#time").get_attribute("max"))
        self.assertAlmostEqual(second, 20 + 105 / wide * last, delta=0.15 * last)

    @by_night
    def test_a_narrow_window_shows_all(self):
        self.addCleanup(self.browser.size, 1400, 900)
        for width, height in ((800, 600), (390, 844)):
            self.browser.size(width, height)
            self.open()
            for part in ("#stage", "#edit"):
                rect = self.find(part).rect
                self.assertGreater(rect["width"], 0.9 * width, (width, part))
                self.assertGreater(rect["height"], 150, (width, part))
                self.assertLessEqual(rect["y"] + rect["height"], height + 1, (width, part))

    @by_night
    def test_another_scene_shows_what_a_page_of_its_own_shows(self):
        session = self.open()
        first = self.texts()
        for wish in ({"set": ["scenario.goal.at_m=[300, 940, 80]"]},
                     {"set": ["scenario.via=[{at_m: [500, 200, 60], tolerance_m: 5}]"]},
                     {"set": ["steps.2.fly=apf"]},
                     {"set": ["scenario.environment.0.cylinder.radius_m=100"]},
                     {"set": ["scenario.goal.at_m=[650, 300, 60]"]}):  # within the box
            self.driver.execute_async_script(
                "altiplan.editor.change(arguments[0]).then(() => arguments[1]());", wish)
            changed = self.texts()
            self.assertNotEqual(changed, first, wish)
            self.driver.get(session.address.geturl())
            self.await_(lambda: self.browser.run("return window.altiplan?.ready"))
            self.browser.settle()
            opened = self.texts()
            for key, value in opened.items():
                self.assertEqual(changed[key], value, (wish, key))

    def test_what_is_wrong_shows_where_and_by_how_much(self):
        self.pipeline.write_text(PIPELINE.replace("steps:", "constraints:\n  - clearance: {min_m: 10}\nsteps:"))
        self.open()
        lines = "return altiplan.drawn().routes.length"
        self.assertEqual(self.browser.run(lines), 1)
        self.driver.execute_async_script(
            "altiplan.editor.change({set: ['constraints.0.clearance.min_m=150']})"
            ".then(() => arguments[0]());")
        self.assertEqual(self.browser.run(lines), 1)
        labels = self.browser.run("return [...document.querySelectorAll('.mark.violation > span')]"
                                  ".map((one) => one.textContent)")
        self.assertTrue(labels and "150.00 m" in labels[0], labels)
        self.press("#undo")
        self.await_(lambda: not self.sets())
        self.still()
        self.assertEqual(self.browser.run(lines), 1)

    @by_night
    def test_many_scenes_leave_nothing_behind(self):
        self.open()
        first = self.browser.run("return altiplan.memory()")
        for _ in range(16):
            self.driver.execute_async_script("""const done = arguments[0]; (async () => {
              const {editor} = altiplan;
              for (let n = 0; n < 5; n++) await editor.move('goal', [-n, 0, 0], 1, true);
            })().then(() => done());""")
        self.still()
        last = self.browser.run("return altiplan.memory()")
        self.assertEqual(last["geometries"], first["geometries"])
        self.assertEqual(last["listeners"], first["listeners"])
        self.assertEqual(last["marks"], first["marks"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[2:], verbosity=2)
