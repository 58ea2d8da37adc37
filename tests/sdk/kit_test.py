# SPDX-License-Identifier: Apache-2.0
"""kit_test.py SOURCE BUILD: walks through docs/how-to/plan-with-the-kit.md as a reader would.

Then holds the page's planner against astar on the same cells and against the straight line: on
random maps made here, and on published ones where ALTIPLAN_TEST_DATA (default
SOURCE/../shared/data) has them.
"""
import json
import math
import os
import pathlib
import random
import sys
import tempfile

import walk

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])
PAGE = walk.Page(SOURCE / "docs/how-to/plan-with-the-kit.md", SOURCE / "tests/sdk/basic_theta")
DATA = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", SOURCE / "../shared/data")).resolve()
PUBLISHED = {"grid2d/arena.map": 160, "grid2d/random512-20-0.map": 60, "voxel3d/Simple.3dmap": 40}


def grid_map(path, blocked, size):
    rows = ["".join("@" if (x, y, 0) in blocked else "." for x in range(size))
            for y in range(size)]
    path.write_text(f"type octile\nheight {size}\nwidth {size}\nmap\n" + "\n".join(rows) + "\n")


def voxel_map(path, blocked, size):
    path.write_text(f"voxel {size} {size} {size}\n"
                    + "".join(f"{x} {y} {z}\n" for x, y, z in sorted(blocked)))


def random_map(folder, seed, is_3d, share):
    """A map with that share of its cells blocked, and 100 scenarios, some without a route."""
    draw = random.Random(seed)
    size = 14 if is_3d else 40
    cells = [(x, y, z) for x in range(size) for y in range(size)
             for z in range(size if is_3d else 1)]
    blocked = {cell for cell in cells if draw.random() < share}
    path = folder / f"random{seed}.{'3dmap' if is_3d else 'map'}"
    (voxel_map if is_3d else grid_map)(path, blocked, size)
    free = [cell for cell in cells if cell not in blocked]
    lines = ["version 1", path.name] if is_3d else ["version 1"]
    for _ in range(100):
        ends = draw.sample(free, 2)
        if is_3d:
            lines.append(" ".join(str(i) for cell in ends for i in cell) + " 1 1")
        else:
            lines.append(f"0 {path.name} {size} {size} "
                         + " ".join(f"{x} {y}" for x, y, _ in ends) + " 1")
    scen_of(path).write_text("\n".join(lines) + "\n")
    return path


def scen_of(path):
    return path.with_name(path.name + (".3dscen" if path.suffix == ".3dmap" else ".scen"))


def distances(path, count):
    """From start to goal, in cells."""
    lines = [line.split() for line in scen_of(path).read_text().splitlines()]
    if path.suffix == ".3dmap":
        numbers = [[int(word) for word in line[:6]] for line in lines[2:] if line]
        return [math.dist(n[:3], n[3:]) for n in numbers[:count]]
    numbers = [[int(word) for word in line[4:8]] for line in lines[1:] if line]
    return [math.dist(n[:2], n[2:]) for n in numbers[:count]]


def lengths(shell, planner, path, count):
    """Lengths in cells of what the planner finds, all of it judged; None: no route."""
    call = f"altiplan-bench grid {path} {scen_of(path)} --planner {planner} --limit {count}"
    output, code, _ = shell.run(f"{call} --each --json --plugin-path build")
    each, brace, figures = output.partition("{")
    if code != 0 or json.loads(brace + figures)["unsound"] != 0:
        PAGE.fail(f"{call}\nexit code {code}\n{output}")
    rows = [line.split() for line in each.splitlines()]
    return [float(row[2]) if row[1] == "1" else None for row in rows]


def compare(shell, path, count):
    """How many have a route, how many none; lengths of all by A* and by Theta*."""
    astar = lengths(shell, "astar", path, count)
    theta = lengths(shell, "basic_theta", path, count)
    straight = distances(path, count)
    assert len(astar) == len(theta) == len(straight) == count, (path, len(theta), len(straight))
    for number, (a, t, least) in enumerate(zip(astar, theta, straight)):
        where = f"{path.name}, scenario {number}: A* {a}, Theta* {t}, straight {least}"
        assert (a is None) == (t is None), where
        # Printed with nine digits.
        assert t is None or least * (1 - 1e-7) <= t <= a * (1 + 1e-7), where
    found = [(a, t) for a, t in zip(astar, theta) if t is not None]
    return len(found), count - len(found), sum(a for a, _ in found), sum(t for _, t in found)


def page_routes(folder):
    """The page's own problem, whose goal is no centre of a cell."""
    theta, astar = (json.loads((folder / name).read_text())
                    for name in ("theta.json", "astar.json"))
    least = math.dist(theta["route"][0], (945, 883, 64))
    assert theta["route"][-1] == [945, 883, 64], theta["route"]
    by_astar = next(step for step in astar["steps"] if step["plugin"] == "astar")
    assert least < theta["metrics"]["length_m"] < by_astar["metrics"]["length_m"]


def run(shell, folder, name, constraints="", options=""):
    """First step of a pipeline of basic_theta in scenario NAME.yaml."""
    (folder / f"{name}_run.yaml").write_text(
        f"altiplan: 1\nscenario: {name}.yaml\nconstraints: [{constraints}]\n"
        "steps:\n  - plan: basic_theta\n    with: {cell_m: [20, 20, 10]}\n")
    shell.run(f"altiplan run {name}_run.yaml --plugin-path build --out {name}.json {options}")
    return json.loads((folder / f"{name}.json").read_text())["steps"][0]


def edge_of_the_volume(folder, shell):
    """Ends in cells whose centres lie outside of the volume, so that none of them is a node."""
    grid_map(folder / "edge.map", {(x, y, 0) for x in range(3, 9) for y in range(4, 8)}, 12)
    (folder / "edge.yaml").write_text(
        "altiplan: 1\nenvironment:\n  - grid_map: {file: edge.map, cell_m: 10, height_m: 10}\n"
        "volume: {min_m: [6, 6, 0], max_m: [114, 114, 10]}\nlevel_flight_at_m: 5\n"
        "start: {at_m: [8, 7, 5]}\ngoal: {at_m: [112.5, 113.5, 5]}\n")
    step = run(shell, folder, "edge")
    assert step["accepted"] and step["route"][0] == [8, 7, 5], step
    assert step["route"][-1] == [112.5, 113.5, 5], step


def sealed(folder, shell):
    """No way through a wall, by a start and a goal beside their cells' centres."""
    grid_map(folder / "sealed.map", {(6, y, 0) for y in range(12)}, 12)
    (folder / "sealed.yaml").write_text(
        "altiplan: 1\nenvironment:\n  - grid_map: {file: sealed.map, cell_m: 10, height_m: 10}\n"
        "level_flight_at_m: 5\nstart: {at_m: [8, 7, 5]}\ngoal: {at_m: [112.5, 113.5, 5]}\n")
    step = run(shell, folder, "sealed")
    assert step["status"] == "no_route" and step["proved"], step
    assert step["counters"]["expanded"] == 6 * 12, step
    assert step["message"].startswith("refused moves: blocked cells ("), step


def budgets(folder, shell):
    """Of memory, the nodes taken but the open list not; of length, which proves nothing."""
    step = run(shell, folder, "scenario", options="--set steps.0.within_mb=0.9")
    assert step["status"] == "timed_out" and step["budget_hit"], step
    step = run(shell, folder, "scenario", constraints="route_length: {max_m: 1300}")
    assert step["status"] == "no_route" and not step["proved"], step
    assert run(shell, folder, "scenario")["accepted"]


def main():
    with tempfile.TemporaryDirectory() as name:
        home = pathlib.Path(name)
        walk.install(BUILD, home)
        folder, shell = PAGE.walk(home)
        page_routes(folder)
        edge_of_the_volume(folder, shell)
        sealed(folder, shell)
        budgets(folder, shell)
        made = [compare(shell, random_map(home, seed, seed % 2 == 1, share), 100)
                for seed, share in enumerate([0.1, 0.1, 0.25, 0.3, 0.4, 0.5, 0.4, 0.65])]
        made += [compare(shell, DATA / path, count) for path, count in PUBLISHED.items()
                 if (DATA / path).exists()]
        found, none, astar, theta = (sum(figures) for figures in zip(*made))
        print(f"{found} routes, {none} times none: Theta* {theta:.0f} cells, A* {astar:.0f}")
        assert found > 500 and none > 50
        assert theta < 0.97 * astar  # any angle, not the grid's eight or 26


main()
