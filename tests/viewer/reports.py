# SPDX-License-Identifier: Apache-2.0
"""A report of `altiplan report` in headless Chromium, from a file, with no network.

The arguments of its tests are PROGRAM and MAKE_STORE; they are skipped without Chromium. With
ALTIPLAN_PICTURES in the environment, pictures of the pages go into that folder."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import browser  # first: without Chromium it skips the program
import studies

from selenium.webdriver.support.ui import WebDriverWait

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY, by_night  # noqa: E402, F401

PROGRAM, MAKE_STORE = sys.argv[1:3]
PICTURES = os.environ.get("ALTIPLAN_PICTURES")


def report(store, folder, *options):
    done = subprocess.run([PROGRAM, "report", store, "-o", folder, *options], check=False,
                          capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return folder


class Reports(unittest.TestCase):
    """One study for all tests of a class."""
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.mkdtemp(prefix="altiplan_report_")
        cls.store = studies.store(MAKE_STORE, os.path.join(cls.folder, "study.db"), cls.content())
        cls.report = report(cls.store, os.path.join(cls.folder, "report"))
        cls.browser = browser.shared()

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def setUp(self):
        self.browser.size(1200, 900)
        self.open()

    def tearDown(self):
        self.browser.driver.switch_to.default_content()
        self.assertEqual(self.js("return altiplan_report.errors"), [])
        self.assertEqual(self.browser.console(), [])
        asked = self.browser.requests()
        page = f"file://{self.report}/index.html"
        self.assertEqual({url for url in asked if not url.startswith(("data:", "about:", "blob:"))},
                         {page})

    def open(self):
        self.browser.driver.get_log("performance")
        self.browser.driver.get(f"file://{self.report}/index.html")
        self.wait("return altiplan_report.ready")

    def js(self, script, *arguments):
        return self.browser.run(script, *arguments)

    def wait(self, script, *arguments):
        return WebDriverWait(self.browser.driver, 60).until(
            lambda driver: driver.execute_script(script, *arguments))

    def click(self, selector):
        self.js("document.querySelector(arguments[0]).dispatchEvent("
                "new MouseEvent('click', {bubbles: true}))", selector)

    def text(self, selector):
        return self.js("return document.querySelector(arguments[0]).textContent", selector)

    def picture(self, name):
        if PICTURES:
            self.browser.picture(os.path.join(PICTURES, f"{name}.png"))

    def assert_figures_are_drawn(self):
        figures = self.js("""return [...document.querySelectorAll('figure')].map((figure) => {
            const box = figure.querySelector('svg').getBoundingClientRect();
            const marks = [...figure.querySelectorAll('svg path, svg rect')].filter((mark) => {
              const {width, height} = mark.getBoundingClientRect();
              return width + height > 0;
            });
            return [figure.id, box.width, box.height, marks.length];
          })""")
        self.assertGreater(len(figures), 4)
        for name, width, height, marks in figures:
            self.assertGreater(width, 200, name)
            self.assertGreater(height, 60, name)
            self.assertGreater(marks, 2, name)
        return figures

    def assert_text_lies_within(self):
        """No label runs out of its figure, or into another one of its line."""
        wrong = self.js("""const wrong = [];
          for (const svg of document.querySelectorAll('figure svg')) {
            const room = svg.getBoundingClientRect();
            const lines = new Map();
            for (const text of svg.querySelectorAll('text')) {
              const box = text.getBoundingClientRect();
              if (box.left < room.left - 3 || box.right > room.right + 3 ||
                  box.top < room.top - 3 || box.bottom > room.bottom + 3) {
                wrong.push('out: ' + text.textContent);
              }
              const y = text.getAttribute('y');
              for (const [other, what] of lines.get(y) ?? []) {
                if (box.left < other.right - 1 && other.left < box.right - 1) {
                  wrong.push('over: ' + what + ' | ' + text.textContent);
                }
              }
              lines.set(y, [...lines.get(y) ?? [], [box, text.textContent]]);
            }
          }
          return wrong;""")
        self.assertEqual(wrong, [])


def main():
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=2)
