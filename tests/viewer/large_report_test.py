# SPDX-License-Identifier: Apache-2.0
"""large_report_test.py PROGRAM MAKE_STORE: how soon the report of a large study is ready."""
import math
import os
import sys

import reports
import studies
from reports import NIGHTLY, Reports


class Large(Reports):
    """A thousand scenarios, with as many values of each run as studies have: by night 10,000 runs, whose
    report takes ten seconds, by day 3,000."""
    @classmethod
    def content(cls):
        made = studies.made_up(1000, *((5, 2) if NIGHTLY else (3, 1)))
        cls.runs = len(made["runs"])
        for run in made["runs"]:
            run["values"].update({f"steps.astar.{name}": value * 1.01
                                  for name, value in list(run["values"].items())})
        return made

    def test_small_and_soon_ready(self):
        """The best of three, on a machine that may do other things besides."""
        size = os.path.getsize(os.path.join(self.report, "index.html"))
        times = []
        while len(times) < 3 and min(times, default=math.inf) > 2000:
            self.open()
            times.append(self.js("return altiplan_report.ready_ms"))
        print(f"{self.runs} runs: {size / 1e6:.2f} MB, ready after {min(times):.0f} ms",
              file=sys.stderr)
        self.assertLess(size, 5e6)
        self.assertLessEqual(min(times), 2000)
        self.assert_figures_are_drawn()
        self.assert_text_lies_within()

    def test_a_click_is_answered_soon(self):
        took = self.browser.driver.execute_async_script("""
            const done = arguments[0]; const start = performance.now();
            new MutationObserver((_, observer) => { observer.disconnect();
              done(performance.now() - start); }).observe(document.getElementById('panel'),
              {childList: true});
            document.querySelector('#boxes-length_m [data-open]').dispatchEvent(
              new MouseEvent('click', {bubbles: true}));""")
        print(f"{self.runs} runs: a click is answered after {took:.0f} ms", file=sys.stderr)
        self.assertLessEqual(took, 2000)
        self.assertIn("no 3-D scene of this run", self.text("#panel"))

    def test_heads_of_long_tables_say_that_they_sort(self):
        sign = ("return getComputedStyle(document.querySelector(arguments[0] + ' thead th'), "
                "'::after').content")
        self.assertIn("↕", self.js(sign, "#table-scenarios"))
        self.assertNotIn("↕", self.js(sign, "#table-success"))
        self.js("const head = document.querySelector('#table-scenarios thead th'); head.focus();"
                "head.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter', bubbles: true}))")
        self.assertEqual(self.js("return document.activeElement.ariaSort"), "ascending")

    def test_all_rows(self):
        rows = "return document.querySelectorAll('#table-scenarios tbody tr').length"
        self.assertEqual(self.js(rows), 50)
        self.click("#more")
        self.wait("return document.querySelectorAll('#table-scenarios tbody tr').length === 1000")


if __name__ == "__main__":
    reports.main()
