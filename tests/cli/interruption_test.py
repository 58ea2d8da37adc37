# SPDX-License-Identifier: Apache-2.0
"""interruption_test.py PROGRAM PLUGINS FAULTS: a signal ends every call and leaves no partial file."""
import fcntl
import json
import os
import pty
import re
import select
import signal
import subprocess
import sys
import time

import folder
from folder import Folder, HANGS_S, PIPELINE, PLUGINS, PROGRAM, SCENARIO, STUDY


class Interruption(Folder):
    def begin(self, *arguments, ready=None, **more):
        """Starts a call and returns it in progress: when `ready`, or while a plugin sleeps."""
        call = subprocess.Popen([PROGRAM, *arguments, "--plugin-path", PLUGINS], text=True,
                                stdin=subprocess.DEVNULL, cwd=self.folder,
                                **{"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, **more})
        self.addCleanup(call.stderr.close)
        self.addCleanup(call.wait)
        self.addCleanup(call.kill)
        self.wait_for(ready or (lambda: self.sleeps(call)), call)
        return call

    def sleeps(self, call):
        """True if it runs a plugin that never returns, which sleeps and wakes all the time."""
        with open("/proc/%d/maps" % call.pid, encoding="utf-8") as file:
            if "rogues.so" not in file.read():
                return False
        before = self.sleeps_of(call)
        time.sleep(0.1)
        return self.sleeps_of(call) > before + 10

    def sleeps_of(self, call):
        with open("/proc/%d/status" % call.pid, encoding="utf-8") as file:
            return int(re.search(r"^voluntary_ctxt_switches:\s+(\d+)", file.read(), re.M)[1])

    def used_s(self, call):
        with open("/proc/%d/stat" % call.pid, encoding="utf-8") as file:
            fields = file.read().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def wait_for(self, condition, call):
        end = time.monotonic() + HANGS_S
        while not condition():
            self.assertIsNone(call.poll(), "ended by itself")
            self.assertLess(time.monotonic(), end, "nothing has happened")
            time.sleep(0.01)

    def ends(self, call, number):
        call.send_signal(number)
        self.assertEqual(call.wait(timeout=HANGS_S), 130)

    def layer(self, layer):
        self.write("hangs.yaml", SCENARIO.replace("volume:", "  - " + layer + "\nvolume:"))

    def test_a_world_that_is_being_built(self):
        result = self.result()
        self.layer("rogue_layer: {does: making_never_returns}")
        stored = json.loads(self.read(result))
        stored["scenario"] = self.path("hangs.yaml")
        self.write("hangs.json", json.dumps(stored))
        before = self.names()
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            for arguments in (
                    ("explain", "pipeline.yaml", "--scenario", "hangs.yaml"),
                    ("check", "hangs.json"),
                    ("check", "--route", "result.json", "--scenario", "hangs.yaml"),
                    ("view", "hangs.json", "-o", "page.html"),
                    ("export", "hangs.json", "--to", "csv", "-o", "route.csv")):
                with self.subTest((number, *arguments)):
                    self.ends(self.begin(*arguments), number)
                    self.assertEqual(self.names(), before)

    def test_a_city_of_two_billion_buildings(self):
        self.layer("city: {generate: complex, buildings: 2000000000}")
        for number in (signal.SIGINT, signal.SIGTERM):
            call = self.begin("run", "pipeline.yaml", "--scenario", "hangs.yaml", "--out",
                              "out.json", "--trace", "trace.jsonl", ready=lambda: True)
            self.wait_for(lambda: self.used_s(call) > 0.5, call)
            self.ends(call, number)
            self.assertEqual(json.loads(self.read("out.json"))["status"], "cancelled")
            self.assertFalse([name for name in self.names() if "partial" in name])

    def test_a_run_that_does_not_heed_it(self):
        rule = "constraints: [{rogue_rule: {does: never_returns}}]\n"
        rogue = "  - plan: rogue\n    with: {does: %s}\n"
        for what, text, steps in (
                ("judging", PIPELINE + rule, ["cancelled"]),
                ("planning", PIPELINE + rogue % "never_returns", ["solved", "cancelled"]),
                ("making", PIPELINE + rogue % "making_never_returns", ["solved", "cancelled"])):
            for number in (signal.SIGINT, signal.SIGTERM):
                with self.subTest((what, number)):
                    self.write("hangs.yaml", text)
                    call = self.begin("run", "hangs.yaml", "--out", "out.json", "--trace",
                                      "trace.jsonl")
                    self.ends(call, number)
                    result = json.loads(self.read("out.json"))
                    self.assertEqual(result["status"], "cancelled")
                    self.assertEqual([step["status"] for step in result["steps"]], steps)
                    self.assertEqual(result["route"] is None, len(steps) == 1)
                    self.assertTrue(self.read("trace.jsonl").startswith('{"altiplan_trace": 1}\n'))
                    self.assertFalse([name for name in self.names() if "partial" in name])

    def test_a_reader_that_does_not_read(self):
        self.write("flies.yaml", PIPELINE + "  - fly: route\n")
        for arguments in (("schema",), ("run", "flies.yaml", "--json", "--out", "out.json")):
            with self.subTest(arguments):
                reader, writer = os.pipe()
                fcntl.fcntl(writer, fcntl.F_SETPIPE_SZ, 4096)
                call = self.begin(*arguments, ready=lambda: True, stdout=writer)
                os.close(writer)
                full = lambda: len(self.waiting_in(reader)) >= 4096
                self.wait_for(full, call)
                self.ends(call, signal.SIGINT)
                os.close(reader)
        self.assertEqual(json.loads(self.read("out.json"))["status"], "solved")

    def waiting_in(self, reader):
        count = fcntl.ioctl(reader, 0x541B, b"\0\0\0\0")  # FIONREAD
        return range(int.from_bytes(count, sys.byteorder))

    def test_a_browser_that_never_draws(self):
        self.result()
        self.write("browser", "#!/bin/sh\necho $$ > '%s'\nexec sleep 1000\n" % self.path("pid"))
        os.chmod(self.path("browser"), 0o755)
        os.mkdir(self.path("tmp"))
        call = self.begin("view", "result.json", "--png", "out.png", ready=lambda: True,
                          env={**os.environ, "ALTIPLAN_CHROMIUM": self.path("browser"),
                               "TMPDIR": self.path("tmp")})
        self.wait_for(lambda: os.path.exists(self.path("pid")) and self.read("pid").strip(), call)
        self.ends(call, signal.SIGTERM)
        self.assertEqual(os.listdir(self.path("tmp")), [])
        self.assertFalse(os.path.exists(self.path("out.png")))
        self.assertRaises(ProcessLookupError, os.kill, int(self.read("pid")), 0)

    def test_a_film_that_is_being_made(self):
        """By programs that take all and never end."""
        self.write("pipeline.yaml", PIPELINE + "  - fly: route\n")
        self.result()
        os.mkdir(self.path("bin"))
        for name in ("chromium", "ffmpeg"):
            self.write(f"bin/{name}", "#!/bin/sh\necho $$ > '%s'\nexec sleep 1000\n" %
                       self.path(f"{name}.pid"))
            os.chmod(self.path(f"bin/{name}"), 0o755)
        os.mkdir(self.path("tmp"))
        call = self.begin("view", "result.json", "--mp4", "out.mp4", ready=lambda: True,
                          env={**os.environ, "PATH": self.path("bin") + ":" + os.environ["PATH"],
                               "TMPDIR": self.path("tmp")})
        self.wait_for(lambda: os.path.exists(self.path("chromium.pid"))
                      and self.read("chromium.pid").strip(), call)
        self.ends(call, signal.SIGINT)
        self.assertEqual(os.listdir(self.path("tmp")), [])
        self.assertFalse(os.path.exists(self.path("out.mp4")))
        self.assertRaises(ProcessLookupError, os.kill, int(self.read("chromium.pid")), 0)

    def test_progress_on_a_terminal(self):
        stored = json.loads(self.read(self.result()))
        self.layer("rogue_layer: {does: making_never_returns}")
        self.write("hangs.json", json.dumps({**stored, "scenario": self.path("hangs.yaml")}))
        here, there = pty.openpty()
        self.addCleanup(os.close, here)
        call = subprocess.Popen([PROGRAM, "view", "hangs.json", "-o", "page.html", "--plugin-path",
                                 PLUGINS], stdin=subprocess.DEVNULL, stderr=there, cwd=self.folder)
        os.close(there)
        self.addCleanup(call.wait)
        self.addCleanup(call.kill)
        said = b""
        while b"building the world of hangs.json" not in said:
            self.assertTrue(select.select([here], [], [], HANGS_S)[0], said)
            said += os.read(here, 1000)
        self.ends(call, signal.SIGINT)

    def test_a_study_and_a_tuning(self):
        self.write("hangs.yaml", PIPELINE.replace("astar", "rogue").replace(
            "cell_m: [50, 50, 50]", "does: never_returns"))
        self.write("study.yaml", STUDY.replace("pipeline.yaml", "hangs.yaml"))
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                call = self.begin("study", "study.yaml", "--out", "out.db", ready=lambda: True)
                self.wait_for(lambda: os.path.exists(self.path("out.db.work")), call)
                self.ends(call, number)
                self.assertEqual([name for name in self.names() if ".work" in name], [])


if __name__ == "__main__":
    folder.main()
