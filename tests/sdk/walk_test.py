# SPDX-License-Identifier: Apache-2.0
"""walk_test.py SOURCE BUILD: walks through docs/how-to/write-a-plugin.md as a reader would.

Then holds the routes of the page's own environment and constraint against geometry of this file's
own, with and without them.
"""
import json
import math
import pathlib
import sys
import tempfile

import walk

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])
# The page's planner is the one that `altiplan new` writes.
DOGLEG = (SOURCE / "tools/altiplan/templates/planner/@name@.cpp").read_text()
PAGE = walk.Page(SOURCE / "docs/how-to/write-a-plugin.md", SOURCE / "tests/sdk/my_plugins",
                 {"dogleg/dogleg.cpp": DOGLEG.replace("@name@", "dogleg")})


def points(route):
    """The route in steps of a few metres."""
    for a, b in zip(route, route[1:]):
        n = max(1, int(math.dist(a, b) / 2))
        for i in range(n + 1):
            yield tuple(p + (q - p) * i / n for p, q in zip(a, b))


def from_wires(p, a, b):
    """Horizontal distance from the outer wire of a power line with two towers."""
    length = math.dist(a, b) ** 2
    t = min(1, max(0, ((p[0] - a[0]) * (b[0] - a[0]) + (p[1] - a[1]) * (b[1] - a[1])) / length))
    return math.dist(p[:2], [a[i] + (b[i] - a[i]) * t for i in (0, 1)]) - 15


def judge(folder, shell, name, drop):
    """Runs flight.yaml without the lines that hold a word; what its flight keeps from what."""
    for file in ("scenario.yaml", "flight.yaml"):
        lines = (folder / file).read_text().splitlines(keepends=True)
        kept = [line for line in lines if not any(word in line for word in drop)]
        (folder / f"{name}_{file}").write_text(
            "".join(kept).replace("scenario: scenario", f"scenario: {name}_scenario"))
    output, code, _ = shell.run(f"altiplan run {name}_flight.yaml --out {name}.json")
    if code > (1 if drop else 0):
        PAGE.fail(output)
    result = json.loads((folder / f"{name}.json").read_text())
    flown = list(points([p[1:] for p in result["flight"]["track"]]))
    planned = list(points(result["route"]))
    return {
        "wires": min(from_wires(p, (2000, -1500), (2000, 700)) for p in planned),
        "new_wires": min(from_wires(p, (4300, 200), (4300, 500)) for p in flown),
        "village": min(math.dist(p[:2], (2000, 900)) for p in planned) - 300,
        "second_village": min(math.dist(p[:2], (4300, 900)) for p in flown) - 340,
    }


def honours(folder, shell):
    """The vehicle's radius is 5 m."""
    kept = judge(folder, shell, "all", [])
    assert kept["wires"] >= 5 and kept["new_wires"] >= 5, kept
    assert kept["village"] >= -1e-3 and kept["second_village"] >= -1e-3, kept
    # The same without them: else nothing would be shown.
    without = judge(folder, shell, "no_wires", ["[2000, 700]", "id: wires"])
    assert without["wires"] < 0, without
    without = judge(folder, shell, "no_new_wires", ["[4300, 500]", "id: new_wires", "known"])
    assert without["new_wires"] < 0, without
    without = judge(folder, shell, "no_village", ["[2000, 900]"])
    assert without["village"] < -100, without
    without = judge(folder, shell, "no_second_village", ["[4300, 900]"])
    assert without["second_village"] < -1, without


def main():
    with tempfile.TemporaryDirectory() as folder:
        home = pathlib.Path(folder)
        walk.install(BUILD, home)
        honours(*PAGE.walk(home))


main()
