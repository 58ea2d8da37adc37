# SPDX-License-Identifier: Apache-2.0
"""Chromium without a screen, the processor in place of a graphics card, and only our page. Where it
is not installed, a program that imports this is skipped."""
import atexit
import functools
import json
import os
import shutil
import sys
import tempfile

SKIPPED = 77
try:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service
    MISSING = [name for name in ("chromium", "chromedriver") if not shutil.which(name)]
except ImportError as error:
    MISSING = [str(error)]
if MISSING:
    print(f"skipped: needs Debian's chromium, chromium-driver and python3-selenium (tools/setup ci): {MISSING}")
    sys.exit(SKIPPED)

QUIET = ["--headless", "--no-sandbox", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--disable-extensions", "--hide-scrollbars", "--force-device-scale-factor=1"]
# In one process, frames need not be handed from one to another: a third less time.
SOFTWARE_GL = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
               "--in-process-gpu", "--disable-gpu-compositing"]
NO_WEBGL = """const all = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
  return /webgl/.test(kind) ? null : all.call(this, kind, ...more);
};"""


@functools.cache
def shared():
    """The one browser of a test program: starting one takes as long as some tests."""
    browser = Browser()
    atexit.register(browser.close)
    return browser


class Browser:
    def __init__(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_viewer_")
        options = webdriver.ChromeOptions()
        for argument in QUIET + SOFTWARE_GL:
            options.add_argument(argument)
        options.add_argument(f"--user-data-dir={self.folder}/profile")
        options.binary_location = shutil.which("chromium")
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(
            options=options, service=Service(shutil.which("chromedriver")))
        self.driver.set_script_timeout(30)
        self.without_webgl = None
        self.size(1280, 720)
        self.scheme("light")

    def close(self):
        self.driver.quit()
        shutil.rmtree(self.folder, ignore_errors=True)

    def size(self, width, height):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def webgl(self, there):
        """Whether pages that are opened from now on find WebGL."""
        if there == (self.without_webgl is None):
            return
        if there:
            self.driver.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument",
                                        {"identifier": self.without_webgl})
            self.without_webgl = None
        else:
            self.without_webgl = self.driver.execute_cdp_cmd(
                "Page.addScriptToEvaluateOnNewDocument", {"source": NO_WEBGL})["identifier"]

    def scheme(self, scheme):
        """The reader's light or dark; and no motion, so that flights of the eye end at once."""
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [
            {"name": "prefers-color-scheme", "value": scheme},
            {"name": "prefers-reduced-motion", "value": "reduce"}]})

    def open(self, html, query=""):
        """Shows the page from a file and waits for its first full frame."""
        path = os.path.join(self.folder, "page.html")
        with open(path, "w", encoding="utf-8") as file:
            file.write(html)
        self.driver.get_log("browser")
        self.driver.get_log("performance")
        self.driver.get(f"file://{path}{query}")
        self.settle()

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def settle(self):
        """Until what was asked for has been drawn: two frames."""
        self.driver.execute_async_script(
            "const done = arguments[0];"
            "requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done)));")

    def console(self):
        """What it said, but for how long reading pixels back takes."""
        return [entry["message"] for entry in self.driver.get_log("browser")
                if "GL Driver Message (OpenGL, Performance" not in entry["message"]]

    def requests(self):
        """Addresses of all that the page asked for since it was opened."""
        messages = [json.loads(entry["message"])["message"]
                    for entry in self.driver.get_log("performance")]
        return [message["params"]["request"]["url"] for message in messages
                if message["method"] == "Network.requestWillBeSent"]

    def picture(self, path):
        self.driver.save_screenshot(path)
