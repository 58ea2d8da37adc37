#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""python_queries.py PREFIX [LEGS]: what the Python package costs beyond the library, for a build or an
installation in PREFIX: leg checks of World.legs_blocked against the same in C++ (altiplan-bench legs).
Times are the processor's, the least of several."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

PREFIX = pathlib.Path(sys.argv[1]).resolve()
LEGS = int(sys.argv[2]) if len(sys.argv) > 2 else 1_000_000
SCENARIOS = pathlib.Path(__file__).resolve().parents[2] / "configs/scenarios"
WORLDS = ("city_complex", "jacksboro_ridge", "random_hills")
PASSES = 5
RADIUS_M = 5

sys.path.insert(0, str(PREFIX / "lib/python3/dist-packages"))
import numpy  # noqa: E402

import altiplan  # noqa: E402


def legs_in(world, count):
    """Legs that are short against the volume, as planners ask for, of shape (n, 2, 3)."""
    random = numpy.random.default_rng(7)
    low, high = world.volume
    ends = random.uniform(low, high, (count, 2, 3))
    ends[:, 1] = ends[:, 0] + random.uniform(-0.02, 0.02, (count, 3)) * (high - low)
    return ends


def compare(name, folder):
    world = altiplan.World(SCENARIOS / f"{name}.yaml")
    legs = legs_in(world, LEGS)
    file = os.path.join(folder, "legs")
    legs.tofile(file)
    a, b = legs[:, 0].copy(), legs[:, 1].copy()
    least = 1e9
    for _ in range(PASSES):
        begin = time.thread_time()
        blocked = world.legs_blocked(a, b, RADIUS_M)
        least = min(least, time.thread_time() - begin)
    done = subprocess.run([PREFIX / "bin/altiplan-bench", "legs", SCENARIOS / f"{name}.yaml", file,
                           f"--radius={RADIUS_M}", f"--passes={PASSES}", "--json"],
                          capture_output=True, check=True, text=True)
    row = json.loads(done.stdout)["worlds"][0]
    if row["blocked"] != blocked.sum():
        sys.exit(f"{name}: {row['blocked']} legs are blocked in C++, {blocked.sum()} in Python")
    python_ns = 1e9 * least / len(legs)
    print(f"{name:20} {len(legs):8} legs {100 * blocked.mean():5.1f} % blocked "
          f"{python_ns:8.1f} ns in Python {row['ns_per_leg']:8.1f} ns in C++ "
          f"{python_ns / row['ns_per_leg']:6.2f}", flush=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        for name in WORLDS:
            compare(name, folder)


if __name__ == "__main__":
    main()
