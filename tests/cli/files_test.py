# SPDX-License-Identifier: Apache-2.0
"""files_test.py PROGRAM PLUGINS FAULTS: what is read and written, and what an interruption leaves.

PLUGINS is the folder of the plugins that misbehave, FAULTS the library that makes calls of the system
fail ("" for none). A pipe, a socket or a device where a file is expected is refused and never waited
for; a file is written as a whole or not at all; a signal ends every call. Each call has a time limit,
as what is tested for here would hang."""
import errno
import fcntl
import json
import os
import resource
import re
import shutil
import signal
import socket
import stat
import subprocess
import sys
import tempfile
import time
import unittest

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "faults"))
import injector  # pylint: disable=wrong-import-position

PROGRAM, PLUGINS, FAULTS = sys.argv[1:4]
HANGS_S = 60

SCENARIO = """altiplan: 1
environment:
  - box: {min_m: [300, 300, 0], max_m: [310, 700, 1000]}
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
frame: {origin_lonlat: [24.9, 60.2]}
start: {at_m: [100, 500, 100]}
goal: {at_m: [900, 500, 100], tolerance_m: 5}
"""
PIPELINE = """altiplan: 1
scenario: scenario.yaml
steps:
  - plan: astar
    with: {cell_m: [50, 50, 50]}
"""
STUDY = """altiplan: 1
scenarios: [{file: scenario.yaml}]
pipelines: [{id: it, file: pipeline.yaml}]
"""
KINDS = {"pipe": "is a pipe", "socket": "is a socket", "device": "is a device",
         "folder": "is a folder"}


class Folder(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_files_")
        self.addCleanup(shutil.rmtree, self.folder)
        self.write("scenario.yaml", SCENARIO)
        self.write("pipeline.yaml", PIPELINE)
        self.write("study.yaml", STUDY)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8") as file:
            file.write(text)
        return name

    def read(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def names(self):
        return sorted(os.listdir(self.folder))

    def make(self, kind, name):
        """What is no file, under that name."""
        if os.path.lexists(self.path(name)):
            os.remove(self.path(name))
        if kind == "pipe":
            os.mkfifo(self.path(name))
        elif kind == "socket":
            here = os.getcwd()
            os.chdir(self.folder)  # the name of a socket is short
            try:
                with socket.socket(socket.AF_UNIX) as made:
                    made.bind(name)
            finally:
                os.chdir(here)
        elif kind == "device":
            os.symlink("/dev/zero", self.path(name))  # as a link: making one takes root
        else:
            os.mkdir(self.path(name))
        return name

    def remove(self, name):
        if os.path.isdir(self.path(name)):
            os.rmdir(self.path(name))
        else:
            os.remove(self.path(name))

    def call(self, *arguments, code=0, **more):
        done = subprocess.run([PROGRAM, *arguments], stdin=subprocess.DEVNULL, cwd=self.folder,
                              capture_output=True, text=True, timeout=HANGS_S, **more)
        self.assertEqual(done.returncode, code, (arguments, done.stdout[-1000:], done.stderr))
        return done.stdout, done.stderr

    def result(self, name="result.json", *arguments):
        self.call("run", "pipeline.yaml", "--out", name, *arguments)
        return name

    def refused(self, said, *arguments):
        """Ends with 3 and one line on stderr."""
        _, err = self.call(*arguments, code=3)
        self.assertIn(said, err, arguments)
        self.assertEqual(len(err.splitlines()), 1, (arguments, err))


class Input(Folder):
    def test_commands_refuse_what_is_no_file(self):
        self.result()
        for kind, said in KINDS.items():
            odd = {ending: self.make(kind, "odd." + ending)
                   for ending in ("yaml", "json", "csv", "plan", "kml", "gpx", "geojson")}
            with self.subTest(kind):
                self.refused(said, "run", odd["yaml"])
                self.refused(said, "run", "pipeline.yaml", "--scenario", odd["yaml"])
                self.refused(said, "run", "pipeline.yaml", "--set", "scenario=odd.yaml")
                self.refused(said, "validate", odd["yaml"])
                self.refused(said, "explain", odd["yaml"])
                self.refused(said, "check", odd["json"])
                for ending in ("json", "csv", "plan", "kml", "gpx", "geojson"):
                    self.refused(said, "check", "--route", odd[ending], "--scenario",
                                 "scenario.yaml")
                self.refused(said, "check", "--route", "result.json", "--scenario", odd["yaml"])
                self.refused(said, "view", odd["json"], "-o", "page.html")
                self.refused(said, "export", odd["json"], "--to", "csv")
                self.refused(said, "study", odd["yaml"], "--out", "out.db")
                self.refused(said, "slurm", odd["yaml"], "--out", "out.db", "--dry-run")
                self.refused(said, "tune", odd["yaml"], "--over", "steps.0.with.weight_g=0..1",
                             "--metric", "length_m", "--out", "tuned")
                self.refused(said, "tune", "pipeline.yaml", "--scenarios", odd["yaml"], "--over",
                             "steps.0.with.weight_g=0..1", "--metric", "length_m", "--out", "tuned")
            for name in odd.values():
                self.remove(name)

    def test_databases_refuse_what_is_no_file(self):
        self.call("study", "study.yaml", "--out", "out.db")
        for kind in KINDS:
            odd = self.make(kind, "odd.db")
            said = "is a folder" if kind == "folder" else "is a"
            with self.subTest(kind):
                self.refused(said, "report", odd, "-o", "page")
                self.refused(said, "compare", odd, odd)
                self.refused(said, "merge", odd, "-o", "all.db")
                self.refused(said, "merge", "out.db", "-o", odd)
                self.refused(said, "replay", odd, "a")
                self.refused(said, "study", "study.yaml", "--out", odd)
            self.remove(odd)

    def test_files_that_files_name(self):
        self.make("pipe", "odd")
        for name in ("odd.tif", "odd.asc", "odd.map", "odd.3dmap", "odd.bt", "odd.stl", "odd.obj",
                     "odd.csv", "odd.json", "odd.geojson", "odd.kml", "odd.plan"):
            self.make("pipe", name)
        for layer in ("terrain: {file: odd.tif}", "terrain: {file: odd.asc}",
                      "grid_map: {file: odd.map}", "voxel_map: {file: odd.3dmap}",
                      "octomap: {file: odd.bt}", "mesh: {file: odd.stl}", "mesh: {file: odd.obj}",
                      "city: {file: odd.csv}", "city: {file: odd.json}", "city: {file: odd.geojson}",
                      "zones: {file: odd.geojson}", "zones: {file: odd.kml}"):
            with self.subTest(layer):
                self.write("layer.yaml", SCENARIO.replace("volume:", "  - " + layer + "\nvolume:"))
                self.refused("is a pipe, expected a file", "validate", "layer.yaml")
                self.refused("is a pipe, expected a file", "run", "pipeline.yaml", "--scenario",
                             "layer.yaml")
        for name in ("odd.plan", "odd.kml"):
            self.write("mission.yaml", "altiplan: 1\nmission: %s\n" % name)
            self.refused("is a pipe, expected a file", "run", "pipeline.yaml", "--scenario",
                         "mission.yaml")
        self.write("odd_study.yaml", STUDY.replace("scenario.yaml", "odd"))
        self.refused("is a pipe, expected a file", "study", "odd_study.yaml", "--out", "out.db")
        self.write("odd_study.yaml", STUDY.replace("pipeline.yaml", "odd"))
        self.refused("is a pipe, expected a file", "study", "odd_study.yaml", "--out", "out.db")

    def test_files_that_a_result_names(self):
        self.result("result.json", "--trace", "trace.jsonl")
        self.make("pipe", "trace.jsonl")
        _, err = self.call("view", "result.json", "-o", "page.html")
        self.assertIn("trace.jsonl: is a pipe, expected a file", err)
        self.make("pipe", "scenario.yaml")
        _, err = self.call("check", "result.json", code=3)
        self.assertIn("is a pipe, expected a file", err)
        os.mkdir(self.path("page"))
        self.make("pipe", "page/index.html")
        os.remove(self.path("scenario.yaml"))
        self.write("scenario.yaml", SCENARIO)
        self.call("study", "study.yaml", "--out", "out.db")
        self.refused("holds other files", "report", "out.db", "-o", "page")

    def test_a_link_to_a_file_is_read(self):
        os.symlink("pipeline.yaml", self.path("link.yaml"))
        self.call("run", "link.yaml")

    def test_what_may_not_be_read(self):
        self.refused("there is no such file", "run", "none.yaml")
        self.refused("there is no such file", "check", "none.json")
        if os.geteuid() != 0:
            os.chmod(self.path("pipeline.yaml"), 0)
            self.refused("Permission denied", "run", "pipeline.yaml")


class Output(Folder):
    def setUp(self):
        super().setUp()
        self.result()
        self.call("study", "study.yaml", "--out", "out.db")

    def calls(self, to):
        """Each command that writes one file."""
        return {
            "run --out": ("run", "pipeline.yaml", "--out", to),
            "run --trace": ("run", "pipeline.yaml", "--trace", to),
            "export -o": ("export", "result.json", "--to", "gpx", "-o", to),
            "view -o": ("view", "result.json", "-o", to),
            "view --svg": ("view", "result.json", "--svg", to),
            "view --png": ("view", "result.json", "--png", to),
            "replay --out": ("replay", "out.db", "1", "--out", to),
            "replay --trace": ("replay", "out.db", "1", "--trace", to),
            "replay --stored": ("replay", "out.db", "1", "--stored", "--out", to),
        }

    def test_only_a_file_is_written_over(self):
        for kind, said in KINDS.items():
            self.make(kind, "odd")
            said = "is a symbolic link" if kind == "device" else said
            for what, arguments in self.calls("odd").items():
                with self.subTest(kind + " " + what):
                    before = self.names()
                    self.refused(said, *arguments)
                    self.assertEqual(self.names(), before)
            self.remove("odd")
        for what, arguments in self.calls("/dev/null").items():
            with self.subTest("/dev/null " + what):
                self.refused("is a device", *arguments)
        self.refused("is a symbolic link", "run", "pipeline.yaml", "--out", "/dev/stdout")

    def test_a_store_is_not_where_the_lines_of_the_call_go(self):
        for place, stream in (("/dev/stdout", "stdout"), ("/proc/self/fd/1", "stdout"),
                              ("/dev/fd/2", "stderr"), ("file", "stdout")):
            with self.subTest(place), open(self.path("file"), "w", encoding="utf-8") as file, \
                    open(self.path("said"), "w", encoding="utf-8") as said:
                other = {"stdout": "stderr", "stderr": "stdout"}[stream]
                done = subprocess.run([PROGRAM, "study", "study.yaml", "--out", place],
                                      stdin=subprocess.DEVNULL, cwd=self.folder, timeout=HANGS_S,
                                      **{stream: file, other: said})
                self.assertEqual(done.returncode, 3)
                self.assertIn(f"is the file that {stream} of this call goes to",
                              self.read("file") + self.read("said"))
                self.assertNotIn("SQLite", self.read("file"))
        self.refused("is the kernel's and holds no files", "run", "pipeline.yaml", "--out", "/proc/x")
        self.refused("is the kernel's and holds no files", "study", "study.yaml", "--out", "/proc/x")

    def test_a_store_that_cannot_be_begun_leaves_no_file(self):
        self.call("study", "study.yaml", "--out", "none.db", code=3,
                  preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (512, 512)))
        self.assertFalse([name for name in self.names() if name.startswith("none.db")])

    def test_a_link_is_refused_and_what_it_leads_to_stays(self):
        self.write("target", "mine")
        for target in ("target", "nowhere"):
            os.symlink(target, self.path("link"))
            for what, arguments in self.calls("link").items():
                with self.subTest(target + " " + what):
                    self.refused("is a symbolic link", *arguments)
                    self.assertEqual(os.readlink(self.path("link")), target)
            os.remove(self.path("link"))
        self.assertEqual(self.read("target"), "mine")
        self.assertFalse(os.path.exists(self.path("nowhere")))

    def test_files_of_others_beside_it_stay(self):
        self.write("victim", "victim")
        for what, arguments in self.calls("out").items():
            if what == "view --png":
                continue  # draws with a browser
            for kind in ("file", "link", "folder"):
                with self.subTest(what + " " + kind):
                    beside = self.path("out.partial")
                    if kind == "file":
                        self.write("out.partial", "mine")
                    elif kind == "link":
                        os.symlink("victim", beside)
                    else:
                        os.mkdir(beside)
                    before = self.names()
                    self.call(*arguments)
                    self.assertEqual(self.names(), sorted(before + ["out"]))
                    self.assertEqual(self.read("victim"), "victim")
                    if kind == "file":
                        self.assertEqual(self.read("out.partial"), "mine")
                    self.remove("out.partial")
                    os.remove(self.path("out"))

    def test_permissions_and_other_names(self):
        for what, arguments in self.calls("out").items():
            if what == "view --png":
                continue
            with self.subTest(what):
                self.call(*arguments, umask=0o027)
                self.assertEqual(stat.S_IMODE(os.stat(self.path("out")).st_mode), 0o640)
                os.chmod(self.path("out"), 0o604)
                os.link(self.path("out"), self.path("other"))
                self.write("other", "before")
                self.call(*arguments, umask=0o027)
                self.assertEqual(stat.S_IMODE(os.stat(self.path("out")).st_mode), 0o604)
                self.assertEqual(self.read("other"), "before")
                self.assertNotEqual(self.read("out"), "before")
                os.remove(self.path("out"))
                os.remove(self.path("other"))

    @unittest.skipUnless(FAULTS, "a sanitizer wants to be loaded first")
    def test_what_was_there_stays_where_writing_fails(self):
        self.write("out", "before")
        before = self.names()
        failing = injector.Injector(PROGRAM, FAULTS, {"files": self.folder}, HANGS_S)
        calls = {what: arguments for what, arguments in self.calls("out").items()
                 if what in ("run --out", "run --trace", "export -o", "view -o")}
        for call, error in (("open", "EIO"), ("write", "ENOSPC"), ("sync", "EIO"),
                            ("close", "EIO"), ("rename", "EACCES")):
            for what, arguments in calls.items():
                with self.subTest((call, what)):
                    first = 1
                    if call in ("open", "close"):  # those before it are of what is read
                        if what == "run --trace":
                            continue
                        first = failing.call(arguments, self.folder,
                                             injector.counting(call)).counted[call]
                    self.write("out", "before")
                    ended = failing.call(arguments, self.folder, injector.Fault(
                        call, first, 1, error, "tree", "files"))
                    self.assertEqual(ended.code, 3, ended.err)
                    self.assertIn("cannot write 'out': " + os.strerror(getattr(errno, error)),
                                  ended.err)
                    self.assertEqual(self.read("out"), "before")
                    self.assertEqual(self.names(), before)
                    if what == "run --out":  # the result is shown all the same
                        self.assertIn("the route of 'astar'", ended.out)

    def test_a_report_leaves_what_is_not_its_own(self):
        self.call("report", "out.db", "-o", "page")
        os.mkdir(self.path("page/.partial"))
        self.write("page/.partial/mine", "mine")
        self.call("report", "out.db", "-o", "page")
        self.assertEqual(self.read("page/.partial/mine"), "mine")
        self.assertEqual(sorted(os.listdir(self.path("page"))),
                         [".partial", "figures", "index.html", "runs.csv", "tables"])

    def test_a_crash_keeps_the_trace_and_writes_the_result(self):
        self.write("out.json.partial", "mine")
        self.write("crashes.yaml", PIPELINE + "  - plan: rogue\n    with: {does: segfaults}\n")
        self.call("run", "crashes.yaml", "--plugin-path", PLUGINS, "--trace", "trace.jsonl",
                  "--out", "out.json", code=1)
        self.assertEqual(json.loads(self.read("out.json"))["status"], "failed")
        lines = [json.loads(line) for line in self.read("trace.jsonl").splitlines()]
        self.assertEqual(lines[0], {"altiplan_trace": 1})
        self.assertEqual(self.read("out.json.partial"), "mine")
        self.assertEqual([name for name in self.names() if "partial" in name],
                         ["out.json.partial"])


class Interruption(Folder):
    def begin(self, *arguments, ready=None, **more):
        """The call, once it is in the middle of it: as `ready` says, or where a plugin sleeps."""
        call = subprocess.Popen([PROGRAM, *arguments, "--plugin-path", PLUGINS], text=True,
                                stdin=subprocess.DEVNULL, cwd=self.folder,
                                **{"stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE, **more})
        self.addCleanup(call.stderr.close)
        self.addCleanup(call.wait)
        self.addCleanup(call.kill)
        self.wait_for(ready or (lambda: self.sleeps(call)), call)
        return call

    def sleeps(self, call):
        """Whether it is in a plugin that never returns, which sleeps and wakes all the time."""
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
    unittest.main(argv=sys.argv[:1] + sys.argv[4:])
