#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""python_plan.py PREFIX [CALLS]: what altiplan.plan() takes beyond the same plan in C++, from the files to
the result (altiplan-bench plan), for a build or an installation in PREFIX. Calls of C++ and Python come in
turn, so that both meet the noise of the machine; `beyond` is the median difference of two calls that follow
each other. Times in ms, medians; on a busy machine the processor's time tells most."""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

PREFIX = pathlib.Path(sys.argv[1]).resolve()
CALLS = int(sys.argv[2]) if len(sys.argv) > 2 else 200
CONFIGS = pathlib.Path(__file__).resolve().parents[2] / "configs"
WARM_UP = 10  # calls before those that count
# A pipeline, its scenario of an elevation model, and a small scenario, with the size of astar's cells.
PLANS = (("pipelines/ridge_crossing", [1000, 1000, 200]),
         ("scenarios/jacksboro_ridge", [1000, 1000, 200]),
         ("scenarios/city_complex", [20, 20, 20]))

sys.path.insert(0, str(PREFIX / "lib/python3/dist-packages"))
import altiplan  # noqa: E402


def timed_inside(times):
    """The call into the module that is written in C++, with its time added to the list."""
    inner = altiplan._altiplan.plan

    def timed(*arguments):
        begin = time.perf_counter()
        result = inner(*arguments)
        times.append(1000 * (time.perf_counter() - begin))
        return result

    return timed


def in_turn(pipeline, file, cell_m):
    """Rows of calls in C++ and in Python, in turn, and the median time in Python's own code."""
    steps = [{"plan": "astar", "with": {"cell_m": cell_m}}]
    cpp, python, inside = [], [], []
    call = [PREFIX / "bin/altiplan-bench", "plan", pipeline, "--asked", f"--passes={CALLS + WARM_UP}",
            f"--set=steps={json.dumps(steps)}"]
    with subprocess.Popen(call, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as bench:
        for _ in range(CALLS + WARM_UP):
            bench.stdin.write("\n")
            bench.stdin.flush()
            cpp.append(json.loads(bench.stdout.readline()))
            begin, begin_cpu = time.perf_counter(), time.process_time()
            step = altiplan.plan(file, "astar", cell_m=cell_m)
            python.append({"ms": 1000 * (time.perf_counter() - begin),
                           "cpu_ms": 1000 * (time.process_time() - begin_cpu),
                           "expanded": step.counters["expanded"]})
    real = altiplan._altiplan.plan
    altiplan._altiplan.plan = timed_inside(inside)
    outside = []
    for _ in range(CALLS):
        begin = time.perf_counter()
        altiplan.plan(file, "astar", cell_m=cell_m)
        outside.append(1000 * (time.perf_counter() - begin) - inside[-1])
    altiplan._altiplan.plan = real
    return cpp[WARM_UP:], python[WARM_UP:], statistics.median(outside)


def compare(name, cell_m, folder):
    file = pipeline = CONFIGS / f"{name}.yaml"
    if name.startswith("scenarios"):
        pipeline = pathlib.Path(folder, "pipeline.yaml")
        pipeline.write_text(f"altiplan: 1\nscenario: {json.dumps(str(file))}\nsteps: []\n")
    cpp, python, outside = in_turn(pipeline, file, cell_m)
    if len({row["expanded"] for row in cpp + python}) != 1:
        sys.exit(f"{name}: the searches of C++ and Python differ")
    of = {key: statistics.median(row[key] for row in cpp)
          for key in ("ms", "load_ms", "run_ms", "result_ms")}
    beyond, cpu_beyond = (statistics.median(b[key] - a[key] for a, b in zip(cpp, python))
                          for key in ("ms", "cpu_ms"))
    least = min(row["ms"] for row in python) - min(row["ms"] for row in cpp)
    print(f"{name:26} {len(python)} pairs: C++ {of['ms']:.2f} (load {of['load_ms']:.2f}, run {of['run_ms']:.2f}, "
          f"result {of['result_ms']:.2f}), Python {statistics.median(row['ms'] for row in python):.2f}; "
          f"beyond {beyond:+.3f}, of the fastest calls {least:+.3f}, of the processor's time {cpu_beyond:+.3f}; "
          f"{outside:.3f} in Python's own code", flush=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        for name, cell_m in PLANS:
            compare(name, cell_m, folder)


if __name__ == "__main__":
    main()
