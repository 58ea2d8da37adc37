#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""study_overhead.py PROGRAM [RUNS [JOBS]]: the overhead of a study beyond planning, from a study of short
runs (A* on a coarse lattice in a box with an obstacle), with one process per run and with --reuse; and
the program's memory during the study.

The overhead of a run is JOBS * (time of the call) / RUNS minus the run's own plan_time_s and
setup_time_s. The study's set-up before the first run (files, keys, checks) is reported separately."""
import os
import resource
import sqlite3
import subprocess
import sys
import tempfile
import time

PROGRAM = os.path.abspath(sys.argv[1])
RUNS = int(sys.argv[2]) if len(sys.argv) > 2 else 10000
JOBS = int(sys.argv[3]) if len(sys.argv) > 3 else 2

SCENARIO = """altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 400]}
environment: [{box: {min_m: [400, 300, 0], max_m: [500, 700, 400]}}]
start: {at_m: [50, 450, 150]}
goal: {at_m: [950, 550, 250]}
"""
PIPELINE = "altiplan: 1\nscenario: s.yaml\nsteps: [{plan: astar, with: {cell_m: [100, 100, 100]}}]\n"
STUDY = """altiplan: 1
name: short runs
scenarios: [{file: s.yaml}]
pipelines: [{id: astar, file: p.yaml}]
repetitions: %d
""" % RUNS


def memory_mb(process):
    with open("/proc/%d/status" % process) as stream:
        return next(int(line.split()[1]) for line in stream if line.startswith("RssAnon")) / 1024


def study(folder, reuse):
    store = os.path.join(folder, "reuse%d.db" % reuse)
    used_before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.time()
    process = subprocess.Popen([PROGRAM, "study", "study.yaml", "--out", store, "--jobs", str(JOBS),
                                "--reuse", str(reuse)], cwd=folder, stdout=subprocess.DEVNULL)
    first = None
    memory = []
    while process.poll() is None:
        time.sleep(0.05)
        if first is None and os.path.exists(store + ".work"):
            first = time.time()
        try:
            memory.append(memory_mb(process.pid))
        except (OSError, StopIteration):
            pass
    ended = time.time()
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    cpu = (used.ru_utime + used.ru_stime - used_before.ru_utime - used_before.ru_stime) / RUNS
    if process.returncode != 0:
        sys.exit("exit code %d" % process.returncode)
    with sqlite3.connect(store) as database:
        rows = database.execute(
            "SELECT name, avg(value), count(*) FROM run_values JOIN quantities "
            "ON quantities.id = quantity GROUP BY name").fetchall()
    mean = {name: value for name, value, _ in rows}
    own = mean["plan_time_s"] + mean["setup_time_s"]
    each = JOBS * (ended - first) / RUNS
    print("--reuse %-3d %d runs, %d at a time: %.2f s before the first, then %.2f s; a run "
          "%.3f ms of a worker's time, of which planning %.3f ms, overhead %.3f ms; in its process "
          "%.3f ms; CPU time of all processes %.3f ms; solved %.3f" %
          (reuse, RUNS, JOBS, first - began, ended - first, 1000 * each, 1000 * own,
           1000 * (each - own), 1000 * mean["wall_time_s"], 1000 * cpu, mean["solved"]))
    tenth = max(1, len(memory) // 10)
    print("    memory of the program, MB, in tenths of the time: " +
          " ".join("%.1f" % max(memory[i:i + tenth]) for i in range(0, len(memory), tenth)))


def main():
    with tempfile.TemporaryDirectory(prefix="altiplan_overhead_") as folder:
        for name, text in (("s.yaml", SCENARIO), ("p.yaml", PIPELINE), ("study.yaml", STUDY)):
            with open(os.path.join(folder, name), "w") as stream:
                stream.write(text)
        for reuse in (1, 8, 100):
            study(folder, reuse)


main()
