#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""damaged_libraries.py BUILD COUNT FLIPS [SEED]: damages copies of the plugin libraries of a build,
COUNT in all, and puts each through `altiplan plugins` and `altiplan run`; then FLIPS copies of a small
one with one byte changed each ("all": one for each of its bytes) through `altiplan run`.

`plugins` must end well and say of each library why it is refused, or list it. `run` must refuse it
with one sentence and 4, or end as with the undamaged library, to the last digit: what is damaged is
not loaded then. Nothing may crash. Prints a table; exits with 1 where one of these does not hold.
"""

import collections
import concurrent.futures
import json
import os
import pathlib
import random
import re
import resource
import shutil
import struct
import subprocess
import sys
import tempfile

PATIENCE_S = 60
SMALL = "libaltiplan_constraint_clearance.so"
TIMED = re.compile(r"time_s$|^(plugins|files|pipeline|scenario|overrides|memory)")
SCENARIO = """altiplan: 1
environment: [%s]
volume: {min_m: [0, 0, 0], max_m: [100, 100, 100]}
vehicle: {radius_m: 1}
start: {at_m: [5, 5, 50]}
goal: {at_m: [95, 95, 50], tolerance_m: 5}
"""
BALL = "{sphere: {at_m: [50, 50, 50], radius_m: 10}}"
GRID = "{cell_m: [10, 10, 10]}"
PARAMETERS = {
    "city": "{generate: simple, seed: 1, cells: [20, 20, 20], cell_m: 5}",
    "grid_map": "{file: cells.map, cell_m: 10, height_m: 100}",
    "gazebo": "{file: cylinder.world}",
    "mat_terrain": "{file: ground.mat}",
    "mesh": "{file: cube.obj}",
    "octomap": "{file: voxel.bt, unknown: free}",
    "voxel_map": "{file: voxels.3dmap, cell_m: 10}",
    "hills": "{peaks: [{at_m: [50, 20], height_m: 30, sigma_m: [10, 10]}]}",
    "radar": "{at_m: [50, 50, 0], range_m: 20}",
    "terrain": "{file: ground.asc, crs: 'EPSG:4326'}",
    "zones": "{list: [{cylinder: {at_m: [50, 20], radius_m: 5}}]}",
    "altitude": "{min_m: 0, max_m: 100}",
    "clearance": "{min_m: 1}",
    "climb_angle": "{max_deg: 80}",
    "ground_clearance": "{min_m: 1}",
    "ground_distance": "{max_m: 100}",
    "leg_length": "{min_m: 0.1}",
    "line_distance": "{line_m: [[0, 0], [1, 0]], within_m: 100000}",
    "photos": "{sensor_mm: [24, 16], image_px: [6000, 4000], focal_mm: 16, max_gsd_cm: 10000}",
    "returnable": "{power_w: 1, maximum_wh: 100, cell_m: [10, 10, 10]}",
    "route_length": "{max_ratio: 5}",
    "turn_angle": "{max_deg: 170}",
    "turn_radius": "{min_m: 0.1}",
    "astar": GRID,
    "cover": "{outline_m: [[0, 0], [100, 0], [100, 100], [0, 100]], spacing_m: 20, height_m: 80}",
    "visit": "{stops: [{at_m: [20, 80, 80]}, {at_m: [80, 20, 80]}]}",
    "follow": "{line_m: [[10, 10], [90, 10], [90, 90]], height_m: 80}",
}
OBJECTIVES = {
    "exposure": "{file: risk.asc, elsewhere: 1}",
    "energy": "{power_w: 180}",
    "spso": "{threat_weight: 0}",
    "nmopso": "{threat_weight: 0}",
}
CUBE = "".join("v %d %d %d\n" % (40 + 20 * (n & 1), 40 + 20 * (n >> 1 & 1), 40 + 20 * (n >> 2))
               for n in range(8)) + "".join("f %s\n" % face for face in (
                   "1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"))
# One occupied voxel, the first from the origin.
VOXEL = (b"# Octomap OcTree binary file\nid OcTree\nsize 17\nres 10\ndata\n" + b"\x00\xc0" +
         14 * b"\x03\x00" + b"\x02\x00")


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def array(kind, rows, columns, name, content):
    return element(14, element(6, struct.pack("<II", kind, 0)) + element(5, struct.pack("<ii", rows, columns)) +
                   element(1, name) + content)


def numbers(rows, columns, *values):
    return array(6, rows, columns, b"", element(9, struct.pack("<%dd" % len(values), *values)))


MAT = b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + array(
    2, 1, 1, b"terrainStruct", element(5, struct.pack("<i", 2)) + element(1, b"X\0Y\0H\0") +
    numbers(1, 2, 0, 100) + numbers(2, 1, 0, 100) + numbers(2, 2, 1, 2, 3, 4))
FILES = {
    "ground.mat": MAT,
    "ground.asc": b"ncols 4\nnrows 4\nxllcorner 8\nyllcorner 47\ncellsize 0.001\n" + 4 * b"1 2 3 4\n",
    "risk.asc": b"ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 40\n" + 3 * b"1 2 3\n",
    "cells.map": b"type octile\nheight 10\nwidth 10\nmap\n" + 5 * b"..........\n...@@@....\n",
    "voxels.3dmap": b"voxel 10 10 10\n5 5 5\n2 3 5\n",
    "voxel.bt": VOXEL,
    "cube.obj": CUBE.encode(),
    "cylinder.world": b"<sdf version='1.6'><world name='w'><model name='m'><pose>50 20 0 0 0 0</pose>"
                      b"<link name='l'><collision name='c'><geometry><cylinder><radius>5</radius>"
                      b"<length>40</length></cylinder></geometry></collision></link></model></world></sdf>",
}


def problem(kind, name):
    """The texts of a scenario and a pipeline that use the plugin."""
    with_ = PARAMETERS.get(name, "{}")
    layers = "{%s: %s}" % (name, with_) if kind == "environment" else BALL
    planner = name if kind in ("planner", "local_planner") else "astar"
    if kind == "objective" and name in ("spso", "nmopso", "curvature", "cusps"):
        planner = "pso"  # of whole routes
    steps = "  - {plan: %s, with: %s, within_s: 5}\n" % (planner, PARAMETERS.get(planner, "{}"))
    if kind == "smoother":
        steps += "  - {smooth: %s}\n" % name
    constraints = "constraints: [{%s: %s}]\n" % (name, with_) if kind == "constraint" else ""
    if kind == "objective":
        constraints = "objective: {%s: %s}\n" % (name, OBJECTIVES.get(name, "{}"))
    pipeline = "altiplan: 1\nscenario: scenario.yaml\n" + constraints + "steps:\n" + steps
    task = "task: {%s: %s}\n" % (name, with_) if kind == "task" else ""
    return SCENARIO % layers + task, pipeline


def damaged(random_, whole):
    """A copy with one kind of damage, and its name."""
    kind = random_.choice(["truncated", "bits", "bits", "block zeroed", "blocks swapped"])
    data = bytearray(whole)
    if kind == "truncated":
        return kind, bytes(data[: random_.randrange(len(data))])
    if kind == "bits":
        for _ in range(random_.choice([1, 2, 4, 8, 16, 32, 64])):
            data[random_.randrange(len(data))] ^= 1 << random_.randrange(8)
        return kind, bytes(data)
    size = random_.choice([16, 64, 256, 1024, 4096])
    a, b = (random_.randrange(len(data) - size) for _ in range(2))
    if kind == "block zeroed":
        data[a : a + size] = bytes(size)
    else:
        data[a : a + size], data[b : b + size] = data[b : b + size], data[a : a + size]
    return kind, bytes(data)


class Bench:
    """A copy of the program that finds no plugins by itself."""

    def __init__(self, build, folder):
        self.folder = folder
        self.program = folder / "bin/altiplan"
        self.program.parent.mkdir()
        shutil.copy(build / "bin/altiplan", self.program)
        (folder / "lib").mkdir()
        for library in (build / "lib").glob("libaltiplan*.so.*"):
            shutil.copy(library, folder / "lib", follow_symlinks=False)
        self.libraries = {}
        self.undamaged = {}
        plugins = sorted((build / "lib/altiplan/plugins").glob("libaltiplan_*.so"))
        # By its file's name a library is known when its manifest is gone.
        two_plugins = folder / "libaltiplan_planner_alpha.so"
        two_plugins.symlink_to(build / "tests/broken_plugins/two_plugins.so")
        for file in plugins + [two_plugins]:
            listed = json.loads(self.call(["plugins", "--json"], self.only(file)).stdout)
            offers = listed["libraries"][0]["plugins"][-1]
            kind, name = offers["kind"], offers["name"]
            self.libraries[file] = (kind, name, file.read_bytes())
            problem_folder = folder / "problems" / file.stem
            problem_folder.mkdir(parents=True)
            for file_name, content in FILES.items():
                (problem_folder / file_name).write_bytes(content)
            scenario, pipeline = problem(kind, name)
            (problem_folder / "scenario.yaml").write_text(scenario)
            (problem_folder / "pipeline.yaml").write_text(pipeline)
            others = folder / "others" / file.stem
            others.mkdir(parents=True)
            for other in plugins:
                if other != file:
                    (others / other.name).symlink_to(other)

    def only(self, file):
        made = self.folder / "only" / file.stem
        made.mkdir(parents=True)
        (made / file.name).symlink_to(file)
        return made

    def call(self, arguments, *plugin_paths):
        command = [str(self.program), *arguments]
        for path in plugin_paths:
            command += ["--plugin-path", str(path)]
        environment = {**os.environ, "LD_LIBRARY_PATH": str(self.folder / "lib")}
        environment.pop("ALTIPLAN_PLUGIN_PATH", None)
        return subprocess.run(command, capture_output=True, text=True, errors="replace",
                              timeout=PATIENCE_S, env=environment, check=False)

    def run(self, file, folder):
        pipeline = self.folder / "problems" / file.stem / "pipeline.yaml"
        return self.call(["run", "--json", str(pipeline), "--timeout", "5"], folder,
                         self.folder / "others" / file.stem)

    def run_undamaged(self, file):
        """Its exit code, and what of its result no clock decides."""
        run = self.run(file, self.folder / "only" / file.stem)
        # The planner of two_plugins violates the contract, which is the 4 of a step that failed.
        if run.returncode not in ((4,) if "_alpha" in file.name else (0, 1)):
            sys.exit("%s, undamaged: exit %d: %s" % (file.name, run.returncode, run.stderr))
        self.undamaged[file] = (run.returncode, untimed(run.stdout))


def untimed(text):
    def without(value):
        if isinstance(value, dict):
            return {key: without(part) for key, part in value.items() if not TIMED.search(key)}
        return [without(part) for part in value] if isinstance(value, list) else value
    try:
        return without(json.loads(text))
    except ValueError:
        return text


def outcome(bench, file, folder):
    """How a run with the damaged library ends, and what is wrong with that."""
    try:
        run = bench.run(file, folder)
    except subprocess.TimeoutExpired:
        return "hangs", "it hangs"
    if run.returncode == 4 and run.stderr.count("\n") == 1 and file.name in run.stderr:
        return "refused", ""
    if (run.returncode, untimed(run.stdout)) == bench.undamaged[file]:
        return "as before", ""
    return "exit %d" % run.returncode, "exit %d: " % run.returncode + run.stdout + run.stderr


def round_of(bench, seed, number, libraries):
    """One damaged copy of each library: what `plugins` and `run` say of it."""
    random_ = random.Random("%d %d" % (seed, number))
    root = bench.folder / ("round_%d" % number)
    together = root / "all"
    together.mkdir(parents=True)
    kinds = {}
    for file in libraries:
        kinds[file], data = damaged(random_, bench.libraries[file][2])
        (together / file.name).write_bytes(data)
    results = []
    problems = []
    listed = {}
    try:
        plugins = bench.call(["plugins", "--json"], together)
        if plugins.returncode == 0:
            listed = {pathlib.Path(library["file"]).name: library
                      for library in json.loads(plugins.stdout)["libraries"]}
        else:
            problems.append("plugins ended with %d: %s" % (plugins.returncode, plugins.stderr))
    except subprocess.TimeoutExpired:
        problems.append("plugins hung")
    for file in libraries:
        alone = root / file.stem
        alone.mkdir()
        (together / file.name).rename(alone / file.name)
        library = listed.get(file.name)
        if library is None:
            said = "not listed"
        elif library["refused"]:
            said = "refused"
        else:
            said = "works"
        run, detail = outcome(bench, file, alone)
        results.append((kinds[file], said, run))
        # `run` uses no tuner.
        both = (said == "refused") == (run == "refused") or "_tuner_" in file.name
        if said == "not listed" or detail or not both:
            problems.append("%s, %s: plugins: %s, run: %s\n%s"
                            % (file.name, kinds[file], said, run, detail))
    shutil.rmtree(root)
    return results, problems


def flip(bench, file, at, change):
    """One byte changed in a copy of a library: what `run` says of it."""
    folder = bench.folder / ("flip_%d_%d" % (at, change))
    folder.mkdir()
    data = bytearray(bench.libraries[file][2])
    data[at] ^= change
    (folder / file.name).write_bytes(data)
    run, detail = outcome(bench, file, folder)
    shutil.rmtree(folder)
    text = "%s, byte %d ^ %d: %s\n%s" % (file.name, at, change, run, detail)
    return [("one byte", "", run)], [text] if detail else []


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    count = int(sys.argv[2])
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    seed = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    base = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=base, prefix="altiplan_damaged_") as folder:
        bench = Bench(build, pathlib.Path(folder))
        files = list(bench.libraries)
        for file in files:
            bench.run_undamaged(file)
        small = next(file for file in files if file.name == SMALL)
        size = len(bench.libraries[small][2])
        random_ = random.Random(seed)
        places = (range(size) if sys.argv[3] == "all" else
                  sorted(random_.sample(range(size), int(sys.argv[3]))))
        results = []
        problems = []
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            rounds = [pool.submit(round_of, bench, seed, number, files[: count - first])
                      for number, first in enumerate(range(0, count, len(files)))]
            rounds += [pool.submit(flip, bench, small, at, random_.choice([1, 16, 128, 255]))
                       for at in places]
            for done in rounds:
                more, wrong = done.result()
                results += more
                problems += wrong
        table = collections.Counter(results)
        for (kind, said, run), times in sorted(table.items()):
            print("%6d  %-15s plugins: %-11s run: %s" % (times, kind, said, run))
        print("%6d  in all" % len(results))
        for text in problems:
            print("problem: " + text)
        print("%d problems" % len(problems))
        sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
