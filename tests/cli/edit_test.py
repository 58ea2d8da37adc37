# SPDX-License-Identifier: Apache-2.0
"""edit_test.py PROGRAM SOURCES [CHANGES]: `altiplan edit` by the requests of its page; nightly with
more random changes."""
import concurrent.futures
import json
import os
import pathlib
import random
import re
import signal
import socket
import subprocess
import sys
import time
import unittest

from edit_session import NIGHTLY, PIPELINE, PROGRAM, SCENARIO, EditCase

SOURCES = sys.argv[2]
CHANGES = int(sys.argv.pop(3)) if len(sys.argv) > 3 and sys.argv[3].isdigit() else 150 if NIGHTLY else 50


class Edit(EditCase):
    def run_of(self, pipeline):
        out = self.folder / "out.json"
        done = subprocess.run([PROGRAM, "run", pipeline, "--out", out], capture_output=True,
                              text=True, timeout=600, check=False)
        self.assertIn(done.returncode, (0, 1), done.stderr)
        return json.loads(out.read_text())

    # Changes.

    def test_each_kind_of_thing_moves(self):
        session = self.begin()
        cases = {
            "start": ["scenario.start.at_m=[45, 42, 60]"],
            "environment.0.cylinder": ["scenario.environment.0.cylinder.at_m=[405, 482]"],
            "environment.1.box": ["scenario.environment.1.box.min_m=[605, 202, 0]",
                                  "scenario.environment.1.box.max_m=[705, 422, 120]"],
            "environment.2.prism": ["scenario.environment.2.prism.outline_m="
                                    "[[205, 702], [305, 702], [255, 822]]"],
            "events.0.add.sphere": ["scenario.events.0.add.sphere.at_m=[505, 522, 60]"]}
        keys = {item["key"]: item for item in session.edit()["answers"][0]["movable"]}
        self.assertEqual(set(keys), {*cases, "goal"})
        self.assertEqual(keys["environment.1.box"]["at"], [650, 310, 60])
        for key, expected in cases.items():
            answer = session.edit(move={"key": key, "by": [5, 2, 0]})
            self.assertEqual(answer["pipelines"][0]["set"], expected, key)
            moved = {item["key"]: item for item in answer["answers"][0]["movable"]}[key]
            for axis, by in enumerate((5, 2, 0)):
                self.assertAlmostEqual(moved["at"][axis], keys[key]["at"][axis] + by, 6)
            session.edit(history="undo")
        up = session.edit(move={"key": "environment.0.cylinder", "by": [0, 0, 30]})
        self.assertEqual(up["pipelines"][0]["set"][1:],
                         ["scenario.environment.0.cylinder.floor_m=30",
                          "scenario.environment.0.cylinder.ceiling_m=330"])
        self.assertIn("no height", session.edit(400, move={"key": "environment.2.prism",
                                                           "by": [0, 0, 1]})["error"])

    def test_longitude_latitude_and_height_above_the_ground_stay_so(self):
        dem = pathlib.Path(SOURCES) / "configs/data/jacksboro_fault.tif"
        self.scenario.write_text(
            "altiplan: 1\nenvironment:\n"
            f"  - terrain: {{file: {dem}}}\n"
            "start: {at_m: [4000, 5000], above_ground_m: 200}\n"
            "goal: {at_lonlat: [-84.2, 36.6], above_ground_m: 150, tolerance_m: 50}\n"
            "volume: {floor_m: 100, ceiling_m: 1500}\n")
        self.pipeline.write_text(
            "altiplan: 1\nscenario: scenario.yaml\nsteps:\n"
            "  - plan: astar\n    with: {cell_m: [400, 400, 50]}\n")
        session = self.begin()
        before = session.edit()["answers"][0]
        after = session.edit(move={"key": "goal", "by": [300, -200, 25]})
        [goal, height] = after["pipelines"][0]["set"]
        self.assertRegex(goal, r"^scenario\.goal\.at_lonlat=\[-84\.\d+, 36\.\d+\]$")
        self.assertEqual(height, "scenario.goal.above_ground_m=175")
        for axis, by in ((0, 300), (1, -200)):
            self.assertAlmostEqual(after["answers"][0]["goal"]["at"][axis],
                                   before["goal"]["at"][axis] + by, delta=0.02)

    def test_moves_across_the_180th_meridian_and_a_pole(self):
        for origin, goal, by, moved in (([179.99, -16.8], [179.98, -16.8], [3000, 0, 0], [-179.9919, -16.8]),
                                        ([0, 89.99], [0, 89.99], [0, 2000, 0], [180, 89.9921]),
                                        ([0, -89.99], [0, -89.99], [0, -2000, 0], [180, -89.9921])):
            self.scenario.write_text(
                "altiplan: 1\n"
                f"frame: {{crs: local, origin_lonlat: {origin}}}\n"
                "start: {at_m: [500, 0, 100]}\n"
                f"goal: {{at_lonlat: [{goal[0]}, {goal[1]}, 100], tolerance_m: 5}}\n"
                "volume: {min_m: [-9000, -9000, 0], max_m: [9000, 9000, 500]}\n")
            self.pipeline.write_text("altiplan: 1\nscenario: scenario.yaml\nsteps:\n  - plan: astar\n"
                                     "    with: {cell_m: [200, 200, 100]}\n")
            session = self.begin()
            [setting] = session.edit(move={"key": "goal", "by": by})["pipelines"][0]["set"]
            lonlat = json.loads(setting.split("=")[1])
            off = (lonlat[0] - moved[0] + 180) % 360 - 180
            self.assertLess(abs(off), 2e-4 if abs(origin[1]) < 80 else 0.02, setting)
            self.assertAlmostEqual(lonlat[1], moved[1], 3)
            answer = session.edit()["answers"][0]
            self.assertEqual(answer["results"][0]["status"], "solved")

    def test_a_drag_is_one_change(self):
        session = self.begin()
        session.edit()
        numbers = []
        for step in range(1, 9):
            answer = session.edit(gesture=7, quick=True, move={"key": "goal", "by": [-step, -2 * step, 0]})
            numbers.append(answer["number"])
        self.assertEqual(numbers, sorted(set(numbers)))
        self.assertEqual(answer["pipelines"][0]["set"], ["scenario.goal.at_m=[932, 914, 60]"])
        self.assertTrue(answer["quick"])
        self.assertEqual(session.edit(history="undo")["pipelines"][0]["set"], [])
        again = session.edit(history="redo")
        self.assertEqual(again["pipelines"][0]["set"], ["scenario.goal.at_m=[932, 914, 60]"])
        self.assertEqual((again["undo"], again["redo"]), (True, False))

    def test_what_cannot_be_planned_is_not_kept(self):
        session = self.begin()
        for wish, sentence in (
                ({"set": ["steps.0.with.cell_m=no"]}, "cell_m"),
                ({"set": ["scenario.goal.at_m=[5000]"]}, "goal"),
                ({"set": ["steps.0.with.weight_x=1"]}, "weight_x"),
                ({"set": ["~scenario.goal"]}, "goal"),
                ({"set": ["a"]}, "KEY=VALUE"), ({"set": ["a=1\nb=2"]}, "one line"),
                ({"set": [7]}, "request"), ({"set": "a=1"}, "request"),
                ({"pipeline": 3, "set": ["seed=1"]}, "pipeline 3"),
                ({"sett": ["seed=1"]}, "unknown key 'sett'"), ({"history": "back"}, "undo or redo"),
                ({"move": {"key": "nowhere", "by": [1, 2, 3]}}, "nowhere"),
                ({"move": {"key": "goal", "by": [1, 2]}}, "[east, north, up]"),
                ({"move": {"key": "goal"}}, "by"), ({"gesture": -1.5, "move": 3}, "request")):
            answer = session.edit(400, **wish)
            self.assertIn(sentence, answer["error"], wish)
        left = session.edit()
        self.assertEqual(left["pipelines"][0]["set"], [])
        self.assertEqual(left["answers"][0]["results"][0]["status"], "solved")

    def test_two_pipelines_on_one_world(self):
        other = self.folder / "other.yaml"
        other.write_text(PIPELINE.replace("astar", "theta_star"))
        session = self.begin(self.pipeline, other)
        answer = session.edit(pipeline=1, set=["steps.0.with.cell_m=[100, 100, 60]"])
        self.assertEqual([one["set"] for one in answer["pipelines"]],
                         [[], ["steps.0.with.cell_m=[100, 100, 60]"]])
        self.assertEqual([one["results"][0]["name"] for one in answer["answers"]],
                         ["pipeline", "other"])
        moved = session.edit(move={"key": "goal", "by": [-10, 0, 0]})
        for one in moved["answers"]:
            self.assertEqual(one["goal"]["at"], [930, 930, 60])
        session.ask("compare")
        copied = session.edit(pipeline=2, set=["steps.0.plan=lazy_theta_star"])
        self.assertEqual(len(copied["answers"]), 3)
        self.assertIn("different scenarios", subprocess.run(
            [PROGRAM, "edit", self.pipeline, pathlib.Path(SOURCES) / "configs/pipelines/city_astar.yaml"],
            capture_output=True, text=True, timeout=600, check=False).stderr)

    def test_a_scenario_alone_and_a_result(self):
        self.pipeline.unlink()
        session = self.begin(self.scenario)
        self.assertEqual(session.edit()["answers"][0]["results"][0]["status"], "solved")
        made = self.folder / "scenario_pipeline.yaml"
        self.assertIn("astar", made.read_text())
        out = self.folder / "r.json"
        subprocess.run([PROGRAM, "run", made, "--set", "scenario.goal.at_m=[900, 900, 60]", "--out", out],
                       stdout=subprocess.DEVNULL, timeout=600, check=True)
        opened = self.begin(out)
        self.assertEqual(opened.edit()["answers"][0]["goal"]["at"], [900, 900, 60])
        opened.ask("save")
        self.assertIn("at_m: [900, 900, 60]", self.scenario.read_text())

    def test_obstacles_that_follow_the_seed(self):
        self.scenario.write_text("altiplan: 1\nenvironment:\n  - city: {generate: complex}\n"
                                 "start: {at_m: [15, 25, 45]}\ngoal: {at_m: [675, 645, 45]}\n")
        self.pipeline.write_text("altiplan: 1\nscenario: scenario.yaml\nseed: 3\nsteps:\n  - plan: astar\n")
        session = self.begin()
        first = session.edit()["answers"][0]
        moved = session.edit(move={"key": "goal", "by": [-10, 0, 0]})["answers"][0]
        self.assertNotIn("solids", moved)  # the page has them
        other = session.edit(set=["seed=4"])["answers"][0]
        self.assertNotEqual((other["solids"], other["boxes"]), (first["solids"], first["boxes"]))

    # Files.

    def test_saving_changes_what_has_changed(self):
        session = self.begin()
        session.edit(move={"key": "goal", "by": [-40, 0, 0]})
        session.edit(set=["scenario.environment.3={cylinder: {at_m: [100, 600], radius_m: 30}}"])
        session.edit(set=["~scenario.environment.1"])
        session.edit(set=["steps.0.with.cell_m=[40, 40, 30]"])
        self.assertEqual(len(session.ask("save")["files"]), 2)
        self.assertEqual(self.pipeline.read_text(), PIPELINE.replace("[50, 50, 30]", "[40, 40, 30]"))
        lines = SCENARIO.replace("[940, 930, 60]", "[900, 930, 60]").splitlines()
        house = lines.index("    id: house")
        del lines[house - 1:house + 1]
        known = lines.index("    known: false")
        lines.insert(known + 1, "  - {cylinder: {at_m: [100, 600], radius_m: 30}}")
        self.assertEqual(self.scenario.read_text().splitlines(), lines)
        self.assertEqual(session.ask("save")["files"], [])
        saved = session.edit()
        self.assertEqual((saved["undo"], saved["pipelines"][0]["set"]), (False, []))
        self.scenario.write_text(SCENARIO)  # by another program
        session.edit(set=["scenario.vehicle.radius_m=3"])
        self.assertIn("another program", session.ask("save", status=400)["error"])
        self.assertEqual(self.scenario.read_text(), SCENARIO)
        names = [pathlib.Path(name).name for name in session.ask("save", {"as": "b-2"})["files"]]
        self.assertEqual(sorted(names), ["pipeline_b-2.yaml", "scenario_b-2.yaml"])
        self.assertEqual(self.run_of(self.folder / "pipeline_b-2.yaml")["scenario"],
                         str(self.folder / "scenario_b-2.yaml"))
        self.assertIn("is there already", session.ask("save", {"as": "b-2"}, 400)["error"])
        for name in ("../up", "a/b", "", "x" * 65, ".", "a.b"):
            self.assertIn("expected a name", session.ask("save", {"as": name}, 400)["error"])

    def test_export_is_that_of_the_command(self):
        session = self.begin()
        session.edit(move={"key": "goal", "by": [-40, 0, 0]})
        status, exported = session.request("POST", session.address.path + "export",
                                           json.dumps({"to": "csv"}))
        self.assertEqual(status, 200, exported)
        session.ask("save")
        self.run_of(self.pipeline)
        done = subprocess.run([PROGRAM, "export", self.folder / "out.json", "--to", "csv"],
                              capture_output=True, timeout=600, check=True)
        self.assertEqual(exported, done.stdout)
        session.edit()
        # What the page was opened with can be exported before anything is changed.
        opened = self.begin()
        self.assertEqual(opened.request("GET", opened.address.path)[0], 200)
        status, again = opened.request("POST", opened.address.path + "export",
                                       json.dumps({"to": "csv"}))
        self.assertEqual((status, again), (200, exported))
        # This world has no place on the earth.
        self.assertIn("georeference", session.ask("export", {"to": "qgc-plan"}, 400)["error"])
        self.assertIn("address", session.ask("upload", {"address": "nowhere"}, 400)["error"].lower())

    # Random changes: the page's state, the saved files and a fresh run say the same.

    def test_random_changes(self):
        draw = random.Random(3)
        session = self.begin()
        comments = re.findall(r"# .*", SCENARIO + PIPELINE)
        solved = 0
        answer = session.edit()
        for change in range(CHANGES):
            answer = self.changed(session, draw, answer)
            if change % 10 != 9:
                continue
            answer = session.edit()
            session.ask("save")
            fresh = self.run_of(self.pipeline)
            [shown] = answer["answers"][0]["results"]
            self.assertEqual(shown["status"], fresh["status"], answer["pipelines"][0]["set"])
            self.assertEqual(json.dumps(shown["route"]), json.dumps(fresh["route"]))
            solved += fresh["status"] == "solved"
            text = self.scenario.read_text() + self.pipeline.read_text()
            gone = [comment for comment in comments if comment not in text]
            self.assertLessEqual(set(gone), {"# in the middle"})  # of a layer that may be removed
        self.assertGreater(solved, CHANGES // 25)

    def changed(self, session, draw, answer):
        """Any change; one that cannot be planned with is refused and leaves the state."""
        items = answer["answers"][0]["movable"]
        layers = len(answer["scenario"].get("environment", []))
        at = [draw.randrange(50, 950) for _ in range(2)]
        kind = draw.randrange(10)
        if kind < 5:
            item = draw.choice(items)
            to = [min(970, max(30, value + draw.randrange(-150, 150))) for value in item["at"][:2]]
            by = [to[0] - item["at"][0], to[1] - item["at"][1], draw.choice((0, 0, 5, -5))]
            # A gesture of its own, or the last one: then it counts from where that began.
            self.gesture = getattr(self, "gesture", 0) + (draw.random() < 0.8)
            wish = {"gesture": self.gesture, "quick": draw.random() < 0.5,
                    "move": {"key": item["key"], "by": by}}
        elif kind == 5:
            wish = {"set": [f"scenario.environment.{layers}={{cylinder: {{at_m: {at}, radius_m: 20}}}}"]}
        elif kind == 6 and layers > 0:
            wish = {"set": [f"~scenario.environment.{draw.randrange(layers)}"]}
        elif kind == 7:
            wish = {"set": [draw.choice(["steps.0.plan=astar", "steps.0.plan=theta_star",
                                         "steps.0.with.cell_m=[40, 40, 30]", "steps.1.smooth=prune",
                                         "scenario.vehicle.speed_mps=9", "seed=5"])]}
        else:
            wish = {"history": draw.choice(["undo", "undo", "redo"])}
        status, body = session.request("POST", session.address.path + "edit",
                                       json.dumps({"world": "", **wish}))
        self.assertIn(status, (200, 400), body)
        return json.loads(body) if status == 200 else session.edit()

    # Attacks.

    def test_refused_requests(self):
        session = self.begin()
        mine = session.address.path
        host = session.address.netloc
        for path in ("/", "/edit", "/" + "0" * 32 + "/", mine[:-2] + "/", mine[:-1] + "0/", mine[:10],
                     "/../etc/passwd", mine + "../../etc/passwd", "//" + host):
            for method in ("GET", "POST"):
                self.assertIn(session.request(method, path)[0], (400, 403, 404), path)
        for path in ("../pipeline.yaml", "%2e%2e/pipeline.yaml", "scenario.yaml", "edit/../plugins",
                     "..%2fpipeline.yaml"):
            status, body = session.request("GET", mine + path)
            self.assertIn(status, (400, 403, 404), path)
            self.assertNotIn(b"altiplan: 1", body)
        for headers in ({"Host": "evil.example"}, {"Host": "localhost:" + host.split(":")[1]},
                        {"Origin": "http://evil.example"}, {"Origin": "null"}):
            for method, path in (("GET", mine), ("POST", mine + "edit")):
                status, body = session.request(method, path, headers={"Host": host, **headers})
                self.assertEqual((status, body), (403, b""), headers)
        for body in (b"{", b"[1]", b"\xff\xfe", b"{\"set\": {}}", b"nul", b"{\"set\": [null]}",
                     b"[" * 100000, b"{\"move\": {\"key\": \"goal\", \"by\": [1e999, 0, 0]}}"):
            status, answer = session.request("POST", mine + "edit", body)
            self.assertEqual(status, 400, body[:40])
            self.assertTrue(json.loads(answer)["error"])
        self.assertEqual(session.edit()["pipelines"][0]["set"], [])

    def test_a_body_without_end(self):
        session = self.begin()
        with socket.create_connection((session.address.hostname, session.address.port)) as link:
            link.sendall(f"POST {session.address.path}edit HTTP/1.1\r\nHost: {session.address.netloc}\r\n"
                         f"Content-Length: {10**9}\r\n\r\n".encode())
            link.settimeout(20)
            sent = 0
            try:
                while sent < 10**9:
                    sent += link.send(b"x" * 65536)
            except OSError:
                pass
            self.assertLess(sent, 5e7)
        self.assertEqual(session.edit()["pipelines"][0]["set"], [])

    def test_a_thousand_requests_at_once(self):
        session = self.begin()
        def ask(number):
            try:
                return session.request("POST", session.address.path + "edit", json.dumps(
                    {"gesture": 1, "quick": True, "move": {"key": "goal", "by": [-number / 100, 0, 0]}}))[0]
            except OSError:
                return "refused"
        silent = [socket.create_connection((session.address.hostname, session.address.port))
                  for _ in range(20)]
        with concurrent.futures.ThreadPoolExecutor(100) as many:
            found = list(many.map(ask, range(1000)))
        for link in silent:
            link.close()
        self.assertLessEqual(set(found), {200, "refused"})
        self.assertGreater(found.count(200), 500)
        answer = session.edit(gesture=2, move={"key": "goal", "by": [0, 0, 0]})
        self.assertEqual(answer["answers"][0]["results"][0]["status"], "solved")

    def test_a_killed_planning_process(self):
        slow = PIPELINE.replace("plan: astar        # cells first\n    with: {cell_m: [50, 50, 30]}",
                                "plan: rrt_star\n    within_s: 20\n    with: {max_iterations: 100000000}")
        self.pipeline.write_text(slow)
        session = self.begin()
        with concurrent.futures.ThreadPoolExecutor(1) as one:
            answer = one.submit(session.edit, 400)
            time.sleep(1.5)
            own = session.process.pid
            children = pathlib.Path(f"/proc/{own}/task/{own}/children").read_text().split()
            self.assertEqual(len(children), 2, children)  # the server, and the one that plans
            os.kill(int(children[-1]), signal.SIGKILL)
            self.assertIn("signal", answer.result(30)["error"])
        quick = session.edit(quick=True)
        self.assertTrue(quick["answers"])

    def test_a_newer_change_ends_an_older_one(self):
        slow = PIPELINE.replace("plan: astar        # cells first\n    with: {cell_m: [50, 50, 30]}",
                                "plan: rrt_star\n    within_s: 30\n    with: {max_iterations: 100000000}")
        self.pipeline.write_text(slow)
        session = self.begin()
        with concurrent.futures.ThreadPoolExecutor(1) as one:
            older = one.submit(session.ask, "edit", {"set": ["scenario.vehicle.speed_mps=9"]})
            time.sleep(1)
            began = time.monotonic()
            newer = session.edit(quick=True, move={"key": "goal", "by": [-5, 0, 0]})
            self.assertLess(time.monotonic() - began, 10)
            self.assertEqual(older.result(30), {"superseded": True})
        self.assertEqual(len(newer["pipelines"][0]["set"]), 2)

    # The process.

    def test_listens_on_the_loopback_alone(self):
        session = self.begin()
        self.assertEqual(session.address.hostname, "127.0.0.1")
        port = session.address.port
        for table in ("tcp", "tcp6"):
            rows = [row.split() for row in pathlib.Path(f"/proc/net/{table}").read_text().splitlines()]
            listening = [row[1] for row in rows if row[3:4] == ["0A"] and row[1].endswith(f":{port:04X}")]
            self.assertEqual(listening, [f"0100007F:{port:04X}"] if table == "tcp" else [])

    def test_ends_with_its_page_or_its_terminal(self):
        session = self.begin()
        page = socket.create_connection((session.address.hostname, session.address.port))
        page.sendall(f"GET {session.address.path}alive HTTP/1.1\r\nHost: {session.address.netloc}\r\n\r\n"
                     .encode())
        self.assertIn(b"200", page.recv(100))
        time.sleep(5)
        self.assertIsNone(session.process.poll())  # the page is open
        page.close()
        self.assertEqual(session.process.wait(20), 0)
        other = self.begin()
        own = other.process.pid
        [server] = pathlib.Path(f"/proc/{own}/task/{own}/children").read_text().split()
        other.process.send_signal(signal.SIGINT)
        self.assertEqual(other.process.wait(20), 130)
        deadline = time.monotonic() + 5
        while pathlib.Path(f"/proc/{server}/exe").exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        self.assertFalse(pathlib.Path(f"/proc/{server}/exe").exists())

    def test_what_cannot_be_opened(self):
        for arguments, code, sentence in (
                (["nowhere.yaml"], 3, "nowhere.yaml"), ([], 2, "files"),
                ([pathlib.Path(SOURCES) / "configs/studies/quick.yaml"], 3, "expected a pipeline")):
            done = subprocess.run([PROGRAM, "edit", "--no-browser", *arguments], capture_output=True,
                                  text=True, timeout=600, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(sentence, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
