# SPDX-License-Identifier: Apache-2.0
"""files_test.py PROGRAM PLUGINS FAULTS: input and output files.

A pipe, a socket or a device instead of a file is refused without waiting for it; a file is written
completely or not at all."""
import errno
import json
import os
import resource
import stat
import subprocess
import sys
import unittest

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "faults"))
import injector  # pylint: disable=wrong-import-position

import folder
from folder import FAULTS, Folder, HANGS_S, KINDS, PIPELINE, PLUGINS, PROGRAM, SCENARIO, STUDY


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
        self.refused("contains other files", "report", "out.db", "-o", "page")

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
                self.assertIn(f"is the file that {stream} is redirected to",
                              self.read("file") + self.read("said"))
                self.assertNotIn("SQLite", self.read("file"))
        self.refused("is on a kernel file system, which holds no files", "run", "pipeline.yaml", "--out", "/proc/x")
        self.refused("is on a kernel file system, which holds no files", "study", "study.yaml", "--out", "/proc/x")

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
                continue  # renders in a browser
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
                    if call in ("open", "close"):  # the earlier calls are for input files
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
                    if what == "run --out":  # the result is printed nevertheless
                        self.assertIn("route accepted (from 'astar')", ended.out)

    def test_a_report_leaves_what_is_not_its_own(self):
        self.call("report", "out.db", "-o", "page")
        os.mkdir(self.path("page/.partial"))
        self.write("page/.partial/mine", "mine")
        self.call("report", "out.db", "-o", "page")
        self.assertEqual(self.read("page/.partial/mine"), "mine")
        self.assertEqual(sorted(os.listdir(self.path("page"))),
                         [".partial", "figures", "index.html", "runs.csv", "tables"])

    @unittest.skipUnless(FAULTS, "a sanitizer ends the process at the crash")
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


if __name__ == "__main__":
    folder.main()
