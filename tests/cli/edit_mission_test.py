# SPDX-License-Identifier: Apache-2.0
"""edit_mission_test.py PROGRAM SOURCES: `altiplan edit MISSION --terrain …` by the requests of its page."""
import json
import re
import subprocess
import sys
import unittest

from edit_session import PROGRAM, Session
from plan_case import POINTS, TERRAIN, PlanCase, item, plan_of

HIGH = [[lon, lat, 1500] for lon, lat, _ in POINTS]
OPTIONS = ("--terrain", TERRAIN, "--min-agl", "150")


class EditMission(PlanCase):
    def setUp(self):
        super().setUp()
        self.plan = self.folder / "mission.plan"
        camera = {"type": "SimpleItem", "command": 206, "frame": 2, "doJumpId": 9, "autoContinue": True,
                  "params": [25, 0, 1, 0, 0, 0, 0]}
        plan = plan_of(HIGH)
        plan["mission"]["items"].insert(1, camera)
        self.plan.write_text(json.dumps(plan))

    def begin(self, *arguments):
        session = Session(*(arguments or (self.plan, *OPTIONS)))
        self.addCleanup(session.end)
        return session

    def verdict_of(self, file, code):
        return self.call(str(file), *OPTIONS, code=code)[0].splitlines()[0]

    def test_the_page(self):
        session = self.begin()
        status, page = session.request("GET", session.address.path)
        self.assertEqual(status, 200)
        scene = json.loads(re.search(rb'<script id="scene"[^>]*>(.*?)</script>', page, re.S)[1])
        self.assertEqual([one["number"] for one in scene["movable"]], [1, 2, 3, 4])
        self.assertEqual(scene["edit"]["mission"], str(self.plan))
        self.assertRegex(scene["edit"]["verdict"], "^pass: ")

    def test_a_move_is_judged_as_check_does_and_undone(self):
        session = self.begin()
        key = "mission.items.3"
        quick = session.edit(move={"key": key, "by": [0, 0, -100]}, gesture=7, quick=True)
        self.assertTrue(quick["quick"])
        low = session.edit(move={"key": key, "by": [300, 200, -1000]}, gesture=7)
        self.assertRegex(low["verdict"], "^fail: ")
        self.assertRegex(low["findings"][0], "item")
        self.assertEqual(len(low["answers"][0]["results"][0]["check"]["violations"]), len(low["findings"]))
        self.assertEqual(session.ask("save", {"as": "low"})["files"], [str(self.folder / "mission_low.plan")])
        self.assertEqual(self.verdict_of("mission_low.plan", 1).replace("mission_low.plan", str(self.plan)),
                         low["verdict"])
        undone = session.edit(history="undo")  # the drag is one change
        self.assertEqual((undone["verdict"][:5], undone["undo"], undone["redo"]), ("pass:", False, True))
        self.assertEqual(session.edit(history="redo")["verdict"], low["verdict"])

    def test_saving_changes_the_moved_item_alone(self):
        session = self.begin()
        before = json.loads(self.plan.read_text())
        session.edit(move={"key": "mission.items.3", "by": [100, -50, 20]})
        self.assertEqual(session.ask("save")["files"], [str(self.plan)])
        after = json.loads(self.plan.read_text())
        moved = after["mission"]["items"][3]["params"]
        self.assertEqual(moved[6], 1520)
        self.assertAlmostEqual((moved[5] - HIGH[2][0]) * 89380, 100, delta=2)
        self.assertAlmostEqual((moved[4] - HIGH[2][1]) * 110990, -50, delta=2)
        moved[4:7] = before["mission"]["items"][3]["params"][4:7]
        self.assertEqual(after, before)
        self.assertEqual(session.ask("save")["files"], [])
        session.edit(move={"key": "mission.items.2", "by": [0, 0, 10]})
        self.plan.write_text("{}")
        self.assertIn("another program", session.ask("save", status=400)["error"])
        self.assertEqual(self.plan.read_text(), "{}")

    def test_saving_keeps_every_other_byte(self):
        """Whatever program wrote the file: its indentation, order of keys, numbers and ends of lines."""
        plan = json.loads(self.plan.read_text())
        plan["mission"]["items"][3].update(Altitude=1500, AltitudeMode=2, AMSLAltAboveTerrain=None, note="a \\ \"params\": [1, {")
        compact, tabs = json.dumps(plan, separators=(",", ":")), json.dumps(plan, indent="\t").replace("\n", "\r\n")
        old_form = json.loads(json.dumps(plan))
        for one in old_form["mission"]["items"]:
            one["coordinate"], one["params"] = one["params"][4:], one["params"][:4]
        ours = json.dumps(plan, indent=4, sort_keys=True).replace("1500", "1.5e3") + "\n"
        for text in (compact, tabs, json.dumps(plan, indent=2), "\ufeff" + ours, json.dumps(old_form, indent=1)):
            self.plan.write_bytes(text.encode())
            session = self.begin()
            session.edit(move={"key": "mission.items.3", "by": [0, 0, 20.5]})
            session.ask("save")
            lines, after = text.split("\n"), self.plan.read_bytes().decode().split("\n")
            if len(lines) > 1:
                changed = [n for n, line in enumerate(lines) if line != after[n]]
                self.assertEqual(len(changed), 2, changed)
                for n in changed:
                    self.assertEqual(re.sub("1500|1.5e3", "1520.5", lines[n]), after[n])
            else:
                begin, end = compact.index('"note"') - 200, len(compact) - len(compact.split('"note"')[1])
                part = compact[begin:end]
                part = part[:part.rindex('"params"')] + re.sub("1500", "1520.5", part[part.rindex('"params"'):])
                self.assertEqual(after[0], compact[:begin] + part + compact[end:])

    def test_the_landing_is_moved_and_numbered(self):
        """Of a copter too, whose landing is no part of the line."""
        plan = json.loads(self.plan.read_text())
        lon, lat, _ = HIGH[3]
        landing = dict(item([lon + 0.001, lat, 0], 10), command=21, frame=3)
        plan["mission"]["items"].append(landing)
        self.plan.write_text(json.dumps(plan))
        subprocess.run([PROGRAM, "view", self.plan, "--terrain", TERRAIN, "-o", self.folder / "page.html"], check=True)
        shown = json.loads(re.search(r'<script id="scene"[^>]*>(.*?)</script>', (self.folder / "page.html").read_text(), re.S)[1])
        self.assertEqual([one["number"] for one in shown["numbered"]], [1, 2, 3, 4, 10])
        session = self.begin()
        _, page = session.request("GET", session.address.path)
        scene = json.loads(re.search(rb'<script id="scene"[^>]*>(.*?)</script>', page, re.S)[1])
        self.assertEqual([one["number"] for one in scene["movable"]], [1, 2, 3, 4, 10])
        last = scene["movable"][-1]
        self.assertEqual(last["name"], "item 10 (landing)")
        self.assertGreater(last["at"][2], 200)  # on the ground
        answer = session.edit(move={"key": last["key"], "by": [50, 0, 0]})
        moved = answer["answers"][0]["movable"][-1]["at"]
        self.assertAlmostEqual(moved[0] - last["at"][0], 50, 1)
        session.ask("save")
        after = json.loads(self.plan.read_text())["mission"]["items"][-1]["params"]
        self.assertAlmostEqual((after[5] - landing["params"][5]) * 89380, 50, delta=1)

    def test_waypoints(self):
        lines = ["QGC WPL 110", "0\t1\t0\t16\t0\t0\t0\t0\t36.48\t-84.38\t400\t1"]
        for n, (lon, lat, _) in enumerate(POINTS):
            lines.append(f"{n + 1}\t0\t0\t16\t0\t0\t0\t0\t{lat:.7f}\t{lon:.7f}\t1500\t1")
        file = self.folder / "m.waypoints"
        file.write_text("\n".join(lines) + "\n")
        session = self.begin(file, *OPTIONS, "--autopilot", "ardupilot", "--vehicle", "copter")
        session.edit(move={"key": "line 4", "by": [0, 0, 100]})
        session.ask("save")
        self.assertEqual(file.read_text().splitlines(), [
            line.replace("1500", "1600.000") if n == 3 else line for n, line in enumerate(lines)])

    def test_refused_wishes_change_nothing(self):
        session = self.begin()
        for wish, said in (({"move": {"key": "mission.items.1", "by": [1, 0, 0]}}, "no item"),
                           ({"move": {"key": "mission.items.3", "by": [1, 0]}}, "metres"),
                           ({"move": {"by": [1, 0, 0]}}, "not as expected"), ({"history": "back"}, "history")):
            answer = session.edit(status=400, **wish)
            self.assertIn(said, answer["error"])
        self.assertIn("letters", session.ask("save", {"as": "../x"}, 400)["error"])
        state = session.edit()
        self.assertEqual((state["undo"], state["verdict"][:5]), (False, "pass:"))

    def test_what_cannot_be_opened(self):
        self.plan.write_text(json.dumps({**plan_of([]), "mission": {**plan_of([])["mission"], "items": [
            item(HIGH[0], 1)]}}))
        kml = self.folder / "m.kml"
        kml.write_text('<kml xmlns="http://www.opengis.net/kml/2.2"><Document><Placemark><LineString>'
                       "<altitudeMode>absolute</altitudeMode><coordinates>-84.3,36.5,1500 -84.2,36.6,1500"
                       "</coordinates></LineString></Placemark></Document></kml>")
        for arguments, code, sentence in (
                ([self.plan], 2, "add --terrain"), ([self.plan, self.plan, *OPTIONS], 2, "alone"),
                ([self.folder / "no.plan", *OPTIONS], 3, "no.plan"), ([kml, *OPTIONS], 3, "expected a .plan")):
            done = subprocess.run([PROGRAM, "edit", "--no-browser", *arguments], capture_output=True,
                                  text=True, timeout=600, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(sentence, done.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
