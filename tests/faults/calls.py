# SPDX-License-Identifier: Apache-2.0
"""What the program is asked to do while the system fails it: a folder of small inputs, calls, and what
each leaves when nothing fails."""
import contextlib
import json
import os
import shutil
import sqlite3
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "study"))
from study_kit import runs, without_times  # noqa: E402  pylint: disable=wrong-import-position

FILES = {
    "ground.asc": "ncols 5\nnrows 5\nxllcorner 8.4940\nyllcorner 47.3940\ncellsize 0.0040\n"
                  "NODATA_value -9999\n" + "10 20 30 20 10\n20 40 60 40 20\n30 60 90 60 30\n"
                  "20 40 60 40 20\n10 20 30 20 10\n",
    "zones.geojson": json.dumps({"type": "FeatureCollection", "features": [
        {"type": "Feature", "properties": {"name": "yard", "upper_m": 900, "lower_m": 0},
         "geometry": {"type": "Polygon", "coordinates": [[
             [8.502, 47.400], [8.504, 47.400], [8.504, 47.4025], [8.502, 47.4025],
             [8.502, 47.400]]]}}]}),
    "s.yaml": """altiplan: 1
frame: {origin_lonlat: [8.5, 47.4]}
environment:
  - terrain: {file: ground.asc, crs: "EPSG:4326"}
  - zones: {file: zones.geojson, ceiling_property: upper_m, floor_property: lower_m}
volume: {min_m: [0, -50, 0], max_m: [500, 500, 300]}
vehicle: {radius_m: 2}
start: {at_m: [50, 100, 150]}
goal: {at_m: [450, 100, 150]}
""",
    "p.yaml": """altiplan: 1
scenario: s.yaml
steps:
  - plan: astar
    id: route
    with: {cell_m: [25, 25, 25], weight_g: 1, weight_h: 1}
  - smooth: prune
""",
    "study.yaml": """altiplan: 1
name: a study
scenarios:
  - {file: s.yaml, set: {vehicle.radius_m: [2, 5]}}
pipelines:
  - {id: even, file: p.yaml}
  - {id: greedy, file: p.yaml, set: {steps.0.with.weight_g: 0.2}}
repetitions: 2
metrics: [{name: length_m}]
""",
}
RUNS = 8


def read(path):
    with open(path, "rb") as stream:
        return stream.read()


def is_json(path):
    try:
        json.loads(read(path))
    except ValueError:
        return False
    return True


def is_of_failed_run(path):
    """Whether it is the result of a run that failed, or a trace as far as such a run has come."""
    try:
        lines = [json.loads(line) for line in read(path).splitlines()] if path.endswith(
            ".jsonl") else [json.loads(read(path))]
        return lines[0].get("status") == "failed" or "altiplan_trace" in lines[0]
    except (AttributeError, IndexError, ValueError):
        return False


def result(path):
    return without_times(json.loads(read(path)))


class Call:
    """Arguments; `makes`: outputs, each with how its content is compared; `store`: its database of
    runs, which the call makes at once and for the first time (`once`); `goes_on`: what an interrupted
    call may leave for the next; `said`: whether what stands on stdout is always the same."""

    def __init__(self, arguments, makes=(), store=None, once=False, goes_on=(), said=False):
        self.arguments, self.makes, self.store = arguments.split(), dict(makes), store
        self.once, self.goes_on, self.said = once, goes_on, said

    def may_leave(self, name):
        parts = name.split(os.sep)
        return not is_temporary(name) and (
            parts[0] in self.makes or name == self.store or parts[0] in self.goes_on)


def is_temporary(name):
    return ".partial" in name or any(part.startswith(".") for part in name.split(os.sep))


def folder_of(path):
    """All files of a folder, by name, but those by which an interrupted call goes on."""
    return {name: read(os.path.join(path, name)) for name in files_in(path)
            if not name.startswith("work" + os.sep) and not is_temporary(name)}


def files_in(folder):
    return {os.path.relpath(os.path.join(place, name), folder)
            for place, _, names in os.walk(folder) for name in names}


CALLS = {
    "run": Call("run p.yaml -o out.json --trace trace.jsonl",
                {"out.json": result, "trace.jsonl": read}),
    "study": Call("study study.yaml --out new.db --jobs 2", store="new.db",
                  goes_on=("new.db.work", "new.db-journal")),
    "goes_on": Call("study study.yaml --out half.db --reuse 3 --traces", store="half.db",
                    goes_on=("half.db.work", "half.db-journal")),
    "report": Call("report whole.db -o report --no-times", {"report": folder_of}),
    "view": Call("view result.json -o page.html --svg picture.svg",
                 {"page.html": read, "picture.svg": read}),
    "export": Call("export result.json --to qgc-plan -o mission.plan", {"mission.plan": read}),
    "merge": Call("merge part-1.db part-2.db -o merged.db", store="merged.db", once=True),
    "check": Call("check result.json", said=True),
    "check_route": Call("check --route route.csv --scenario s.yaml", said=True),
    "tune": Call("tune p.yaml --over steps.0.with.weight_g=0..1 --metric length_m --out tuned "
                 "--tuner random_search --evaluations 5", {"tuned": folder_of},
                 goes_on=("tuned",)),
    "plugins": Call("plugins", said=True),
    "replay": Call("replay whole.db 1 -o replayed.json", {"replayed.json": result}, said=True),
}


class Inputs:
    """A folder `work` that is laid out anew for every call, always at one place."""

    def __init__(self, folder, call):
        """`call`: runs the program in a folder without faults."""
        self.kept, self.work = os.path.join(folder, "kept"), os.path.join(folder, "work")
        os.makedirs(self.kept)
        for name, text in FILES.items():
            with open(os.path.join(self.kept, name), "w", encoding="utf-8") as stream:
                stream.write(text)
        self.lay_out()
        for arguments in ("run p.yaml -o result.json",
                          "study study.yaml --out whole.db",
                          "study study.yaml --out part-1.db --shard 1/2",
                          "study study.yaml --out part-2.db --shard 2/2",
                          "run p.yaml --seed 3 -o out.json",
                          "view out.json -o page.html",
                          "export out.json --to qgc-plan -o mission.plan",
                          "report part-1.db -o report --no-times"):
            call(arguments.split(), self.work)
        shutil.copy(os.path.join(self.work, "part-1.db"), os.path.join(self.work, "half.db"))
        with open(os.path.join(self.work, "result.json"), encoding="utf-8") as stream:
            route = json.load(stream)["route"]
        with open(os.path.join(self.work, "route.csv"), "w", encoding="utf-8") as stream:
            stream.write("x_m,y_m,z_m\n" + "".join("%r,%r,%r\n" % tuple(point) for point in route))
        shutil.rmtree(self.kept)
        shutil.move(self.work, self.kept)

    def lay_out(self):
        shutil.rmtree(self.work, ignore_errors=True)
        shutil.copytree(self.kept, self.work)

    def old(self, name):
        """An output as it was before the call; None where there was none."""
        path = os.path.join(self.kept, name)
        return (folder_of if os.path.isdir(path) else read)(path) if os.path.exists(path) else None

    def path(self, name):
        return os.path.join(self.work, name)


def stored(path):
    """The runs in a store by their names; none where it is not there or empty."""
    if not os.path.exists(path) or os.path.getsize(path) == 0:
        return {}
    found = runs(path)
    assert len({row[:3] for row in found}) == len(found), "a run is there twice"
    return {row[:3]: row for row in found}


def is_whole(path):
    """Whether SQLite finds nothing wrong."""
    with contextlib.closing(sqlite3.connect("file:%s?mode=ro" % path, uri=True)) as database:
        return database.execute("PRAGMA integrity_check").fetchall() == [("ok",)]
