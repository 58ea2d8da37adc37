# SPDX-License-Identifier: Apache-2.0
"""view_test.py PROGRAM BROKEN: `altiplan view`, without a browser."""
import json
import os
import re
import subprocess
import xml.etree.ElementTree

import case
from case import CliCase, PIPELINE, PROGRAM, SCENARIO, SEALED


class View(CliCase):
    def view(self, *arguments, code=0):
        """As call; there is no Chromium."""
        done = subprocess.run([PROGRAM, "view", *arguments], stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, cwd=self.folder, timeout=600,
                              env={**os.environ, "ALTIPLAN_CHROMIUM": "/nowhere"})
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done.stdout, done.stderr

    def scene(self, page):
        found = re.findall(r'<script id="scene" type="application/json">(.*?)</script>',
                           self.read(page), re.DOTALL)
        self.assertEqual(len(found), 1)
        return json.loads(found[0])

    def test_a_film_needs_programs_and_a_flight(self):
        self.call("run", self.pipeline, "--out", "route.json")
        os.mkdir(self.path("bin"))
        for name in ("chromium", "ffmpeg"):
            self.write(f"bin/{name}", "#!/bin/sh\nexit 1\n")
        for programs, said in (
                ((), "--mp4 needs Chromium: install the Debian package 'chromium', or set "
                     "ALTIPLAN_CHROMIUM to its path"),
                (("chromium",), "--mp4 needs ffmpeg: install the Debian package 'ffmpeg'"),
                (("chromium", "ffmpeg"), "--mp4: expected a result with a flight (of a pipeline "
                                         "with a fly step), found none")):
            for name in programs:
                os.chmod(self.path(f"bin/{name}"), 0o755)
            environment = {name: value for name, value in os.environ.items()
                           if name != "ALTIPLAN_CHROMIUM"}
            done = subprocess.run([PROGRAM, "view", "route.json", "--mp4", "film.mp4"],
                                  capture_output=True, text=True, cwd=self.folder, timeout=600,
                                  env={**environment, "PATH": self.path("bin")})
            self.assertEqual((done.returncode, done.stdout, done.stderr),
                             (3, "", f"altiplan: {said}\n"))
        for wrong in (["--mp4-seconds", "5", "-o", "page.html"],
                      ["--mp4", "film.mp4", "--mp4-seconds", "0.5"],
                      ["--mp4", "film.mp4", "--mp4-seconds", "nan"]):
            self.view("route.json", *wrong, code=2)
        self.assertNotIn("film.mp4", os.listdir(self.folder))

    def test_view_makes_a_page(self):
        self.call("run", self.pipeline, "--out", "one.json", "--trace", "trace.jsonl")
        self.call("run", self.pipeline, "--out", "two.json", "--seed", "5", "--set",
                  "steps.0.with.weight_g=0.9")
        self.write("page.html", "before")
        out, err = self.view("one.json", "two.json", "-o", "page.html")
        self.assertRegex(out, r"^page\.html: 0\.\d\d MB: 2 routes, 0 flights, 2 solids\n$")
        self.assertEqual(err, "")
        scene = self.scene("page.html")
        stored = [json.loads(self.read(name)) for name in ("one.json", "two.json")]
        self.assertEqual([result["route"] for result in scene["results"]],
                         [result["route"] for result in stored], "to the last bit")
        self.assertEqual([result["name"] for result in scene["results"]], ["one", "two"])
        self.assertEqual(scene["results"][0]["trace"]["events"],
                         len(self.read("trace.jsonl").splitlines()) - 1)
        self.assertIsNone(scene["results"][1]["trace"])
        self.assertEqual(scene["notes"], [])
        self.assertEqual(sorted(os.listdir(self.folder)), sorted([
            "scenario.yaml", "pipeline.yaml", "sealed.yaml", "one.json", "two.json", "trace.jsonl",
            "page.html"]))

    def test_view_of_no_route_and_of_what_has_changed(self):
        self.call("run", self.pipeline, "--out", "result.json", "--scenario", self.sealed,
                  "--trace", "trace.jsonl", code=1)
        self.view("result.json", "-o", "page.html")
        scene = self.scene("page.html")
        self.assertEqual(len(scene["solids"]), 6)
        self.assertIsNone(scene["results"][0]["route"])
        self.assertEqual(scene["results"][0]["status"], "no_route")
        self.assertTrue(scene["results"][0]["message"])
        whole = self.read("trace.jsonl")
        self.write("trace.jsonl", whole[:len(whole) // 2])
        _, err = self.view("result.json", "-o", "page.html")
        self.assertRegex(err, r"^altiplan: warning: trace\.jsonl:\d+: this is not a search "
                              r"event: the search is shown up to here\n$")
        os.remove(self.path("trace.jsonl"))
        self.write("sealed.yaml", SEALED + "# changed\n")
        _, err = self.view("result.json", "-o", "page.html")
        self.assertEqual(err, f"altiplan: warning: {self.sealed} has changed since "
                              "result.json was written\naltiplan: warning: trace.jsonl: there is no such "
                              "file: the search is not shown\n")
        os.remove(self.sealed)
        self.view("result.json", "-o", "page.html", code=3)

    def test_view_refuses_what_it_cannot_show(self):
        self.call("run", self.pipeline, "--out", "one.json")
        self.call("run", self.pipeline, "--out", "other.json", "--scenario", self.sealed, code=1)
        self.write("page.html", "before")
        before = sorted(os.listdir(self.folder))
        _, err = self.view("one.json", "other.json", "-o", "page.html", code=3)
        self.assertEqual(err, f"altiplan: 'one.json' and 'other.json' are of different worlds: "
                              f"{self.path('scenario.yaml')}, and {self.sealed}\n")
        for wrong in ("nowhere.json", ".", "", "scenario.yaml"):
            out, err = self.view("one.json", wrong, "-o", "page.html", code=3)
            self.assertEqual((out, err.count("\n")), ("", 1), err)
        result = json.loads(self.read("one.json"))
        keys = set(result) - {"version", "plugins", "budget_hit", "reason", "setup_time_s", "route_lonlat",
                              "legs", "folder", "cost", "bound"}  # which results of earlier versions lack
        for key in keys:
            damaged = self.write("damaged.json", json.dumps(
                {name: value for name, value in result.items() if name != key}))
            _, err = self.view("damaged.json", "-o", "page.html", code=3)
            self.assertRegex(err, r"^altiplan: damaged\.json: expected a result of ", key)
            for value in (7, "text", [1], {"a": 1}, [[1, 2]], [{}]):
                self.write("damaged.json", json.dumps({**result, key: value}))
                done = subprocess.run([PROGRAM, "view", "damaged.json", "--svg", "damaged.svg"],
                                      capture_output=True, text=True, cwd=self.folder, timeout=600)
                self.assertIn(done.returncode, (0, 3), (key, value, done.stderr))
        os.remove(damaged)
        for option in ("-o", "--png", "--svg"):
            for place in ("missing/page.html", self.folder, ""):
                _, err = self.view("one.json", option, place, code=3)
                self.assertIn(option, err)
        self.view("one.json", code=2)
        self.view("-o", "page.html", code=2)
        self.assertEqual(self.read("page.html"), "before")
        self.assertEqual([name for name in sorted(os.listdir(self.folder))
                          if name != "damaged.svg"], before)

    def test_pictures_without_chromium(self):
        self.write("scenario.yaml", SCENARIO.replace("KNOWN", "false"))
        flies = self.write("flies.yaml", PIPELINE + "  - fly: apf\n"
                           "    with: {influence_m: 200}\n")
        self.call("run", flies, "--out", "<result> & co.json")
        out, err = self.view("<result> & co.json", "--png", "picture.png", "--svg", "other.svg")
        self.assertEqual(err, "altiplan: warning: no Chromium found (set ALTIPLAN_CHROMIUM to its "
                              "path): writing a top view as SVG instead, picture.svg\n")
        self.assertRegex(out, r"^other\.svg: .*\npicture\.svg: 0\.\d\d MB: 1 route, 1 flight, ")
        self.assertFalse(os.path.exists(self.path("picture.png")))
        self.assertEqual(self.read("picture.svg"), self.read("other.svg"))
        svg = xml.etree.ElementTree.fromstring(self.read("picture.svg"))
        texts = [element.text for element in svg.iter("{http://www.w3.org/2000/svg}text")]
        for text in ("scenario", "Start", "Goal", "N", "<result> & co: solved",
                     "Obstacle, met in flight", "200 m"):
            self.assertIn(text, texts)
        self.assertNotIn("href=\"http", self.read("picture.svg"))


if __name__ == "__main__":
    case.main()
