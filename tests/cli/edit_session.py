# SPDX-License-Identifier: Apache-2.0
"""A running `altiplan edit`, talked to as its page does."""
import http.client
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
import urllib.parse

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY, by_night  # noqa: E402, F401

PROGRAM = sys.argv[1]

SCENARIO = """# The world of this test.
altiplan: 1
environment:
  - cylinder: {at_m: [400, 480], radius_m: 60, floor_m: 0, ceiling_m: 300}   # in the middle
  - box: {min_m: [600, 200, 0], max_m: [700, 420, 120]}
    id: house
  # Two radars would be too many.
  - prism: {outline_m: [[200, 700], [300, 700], [250, 820]]}
    known: false
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 300]}
vehicle: {radius_m: 2, speed_mps: 12}
start: {at_m: [40, 40, 60]}          # the field
goal: {at_m: [940, 930, 60], tolerance_m: 5}
events:
  - at_s: 20
    add: {sphere: {at_m: [500, 520, 60], radius_m: 25}}
"""
PIPELINE = """# How it is planned.
altiplan: 1
scenario: scenario.yaml
seed: 4
steps:
  - plan: astar        # cells first
    with: {cell_m: [50, 50, 30]}
  - smooth: prune
  - fly: route
"""


class Session:
    """`altiplan edit` of these files."""

    def __init__(self, *arguments):
        self.process = subprocess.Popen([PROGRAM, "edit", "--no-browser", *map(str, arguments)],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        line = self.process.stdout.readline()
        while line and not line.startswith("http"):
            line = self.process.stdout.readline()
        if not line:
            raise AssertionError(self.process.communicate()[1])
        self.address = urllib.parse.urlsplit(line.strip())
        self.shown = ""

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
        self.process.wait(20)
        self.process.stdout.close()
        self.process.stderr.close()

    def request(self, method, path, body=None, headers=None, timeout=600):
        """The status and the answer to a request below the server's root."""
        connection = http.client.HTTPConnection(self.address.hostname, self.address.port,
                                                timeout=timeout)
        try:
            connection.request(method, path, body, headers or {})
            response = connection.getresponse()
            return response.status, response.read()
        finally:
            connection.close()

    def ask(self, path, wish=None, status=200):
        """The answer to a wish of the page."""
        found, body = self.request("POST", self.address.path + path, json.dumps(wish or {}))
        if found != status:
            raise AssertionError((path, wish, found, body[:500]))
        return json.loads(body) if body else None

    def edit(self, status=200, **wish):
        answer = self.ask("edit", {"world": self.shown, **wish}, status)
        self.shown = answer.get("world", self.shown)
        return answer


class EditCase(unittest.TestCase):
    """Both files in a folder of the test's own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.pipeline = self.folder / "pipeline.yaml"
        self.scenario = self.folder / "scenario.yaml"
        self.pipeline.write_text(PIPELINE)
        self.scenario.write_text(SCENARIO)

    def begin(self, *arguments):
        session = Session(*(arguments or [self.pipeline]))
        self.addCleanup(session.end)
        return session
