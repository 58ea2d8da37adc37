# SPDX-License-Identifier: Apache-2.0
"""Studies for tests: a folder with a scenario, pipelines and a study, what a store holds, and which
processes a study has left."""
import contextlib
import json
import os
import sqlite3
import subprocess
import uuid
import zlib

SCENARIO = """altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 1000]}
start: {at_m: [100, 500, 500]}
goal: {at_m: [900, 500, 500]}
"""


class Study:
    """Pipelines by id, each as its steps in YAML."""

    def __init__(self, program, plugins, folder, pipelines, more):
        self.program, self.plugins, self.folder = program, plugins, folder
        self.id = uuid.uuid4().hex  # in the environment of all its processes
        os.makedirs(folder, exist_ok=True)
        self.write("s.yaml", SCENARIO)
        for name, steps in pipelines.items():
            self.write(name + ".yaml", "altiplan: 1\nscenario: s.yaml\nsteps: [" + steps + "]\n")
        entries = "".join("  - {id: %s, file: %s.yaml}\n" % (name, name) for name in pipelines)
        self.write("study.yaml", "altiplan: 1\nname: a test\nscenarios: [{file: s.yaml}]\n"
                   "pipelines:\n" + entries + more)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w") as stream:
            stream.write(text)

    def start(self, store, *more):
        """In a session of its own, so that its group can be killed."""
        return subprocess.Popen(
            [self.program, "study", self.path("study.yaml"), "--out", store, "--plugin-path",
             self.plugins, *map(str, more)], cwd=self.folder, start_new_session=True,
            env=dict(os.environ, ALTIPLAN_TEST=self.id), stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, store, *more, code=0):
        process = self.start(store, *more)
        said = process.communicate(timeout=600)[0].decode(errors="replace")
        if process.returncode != code:
            raise AssertionError("exit code %d, not %d:\n%s" % (process.returncode, code, said))
        return said

    def report(self, store, folder):
        """The files of a report without times, by name."""
        subprocess.run([self.program, "report", store, "-o", folder, "--no-times", "--plugin-path",
                        self.plugins], check=True, stdin=subprocess.DEVNULL,
                       stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=600)
        files = {}
        for place, _, names in os.walk(folder):
            for name in names:
                path = os.path.join(place, name)
                with open(path, "rb") as stream:
                    files[os.path.relpath(path, folder)] = stream.read()
        return files

    def processes(self):
        """Those that are alive and have this study's environment."""
        found = []
        for name in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open("/proc/%s/environ" % name, "rb") as stream:
                    if self.id.encode() in stream.read():
                        found.append(int(name))
            except OSError:
                pass  # gone, a zombie, or another user's
        return found


def timed(name):
    return name.endswith("time_s") or name.endswith("memory_mb")


def without_times(value):
    if isinstance(value, dict):
        return {key: without_times(part) for key, part in value.items() if not timed(key)}
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return [without_times(part) for part in value]
    return value


def runs(store):
    """Every run as a row, without what varies from one time to another; fails on a damaged store."""
    with contextlib.closing(
            sqlite3.connect("file:%s?mode=ro" % store, uri=True)) as database:
        if database.execute("PRAGMA integrity_check").fetchall() != [("ok",)]:
            raise AssertionError(store + " is damaged")
        if not database.execute("SELECT 1 FROM sqlite_master").fetchall():
            return []  # not even its tables were written
        values = {}
        for run, name, value in database.execute(
                "SELECT run, name, value FROM run_values "
                "JOIN quantities ON quantities.id = quantity ORDER BY name"):
            if not timed(name):
                values.setdefault(run, []).append((name, value))
        rows = []
        for run, result, *row in database.execute(
                "SELECT runs.id, result, pipelines.name, scenarios.name, repetition, seed, key, "
                "outcome, message FROM runs JOIN pipelines ON pipelines.id = pipeline "
                "JOIN scenarios ON scenarios.id = scenario "
                "LEFT JOIN results ON results.run = runs.id "
                "ORDER BY pipelines.name, scenarios.name, repetition"):
            text = zlib.decompress(result).decode() if result else ""
            rows.append((*row, values.get(run, []),
                         without_times(json.loads(text)) if text else None))
    return rows
