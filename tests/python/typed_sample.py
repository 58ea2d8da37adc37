# SPDX-License-Identifier: Apache-2.0
"""Code of a user's, which mypy reads and nothing runs. A comment 'refused' marks what it must refuse."""
from pathlib import Path
from typing import Any, Dict, List, Optional

import numpy
from typing_extensions import assert_type

import altiplan


def longest(pipelines: List[Path]) -> Optional[altiplan.Route]:
    best: Optional[altiplan.Route] = None
    for pipeline in pipelines:
        result = altiplan.run(pipeline, seed=3, set={"steps.0.with.weight_g": 0.6}, out=Path("r.json"))
        assert_type(result, altiplan.Result)
        assert_type(result.steps, List[altiplan.Step])
        assert_type(result.route, Optional[altiplan.Route])
        if result.route is not None and (best is None or result.route.length_m > best.length_m):
            best = result.route
    return best


def open_legs(world: altiplan.World, a: List[List[float]]) -> int:
    blocked = world.legs_blocked(a, numpy.zeros((len(a), 3)), radius_m=2)
    assert_type(blocked, "numpy.typing.NDArray[numpy.bool_]")
    assert_type(world.clearance([[1, 2, 3]]), "numpy.typing.NDArray[numpy.float64]")
    return int((~blocked).sum())


def lengths(step: altiplan.Step) -> float:
    if step.metrics is None or step.metrics.length_m is None:
        return 0
    return step.metrics.length_m


def verdicts() -> List[str]:
    step = altiplan.plan("s.yaml", "astar", [1, 2, 3], seed=1, cell_m=[50, 50, 50])
    check = altiplan.check([[1, 2, 3], [4, 5, 6]], "s.yaml")
    study = altiplan.study("study.yaml", "s.db", jobs=2)
    runs = altiplan.Study(study.path).runs()
    print(runs.groupby("pipeline").length_m.median(), study.tables()["success"], step.counters)
    try:
        altiplan.run("p.yaml")
    except altiplan.Error as error:
        assert_type(error.line, Optional[int])
    return [violation.message for violation in check.violations]


def planners(name: str, parameters: Dict[str, Any]) -> List[altiplan.Step]:
    steps = [altiplan.plan("s.yaml", name, step_m=3), altiplan.plan("s.yaml", "my_planner", step_m=3),
             altiplan.plan("s.yaml", "jps", cell_m=numpy.ones(3), max_memory_mb=numpy.int64(9), costs="integer"),
             altiplan.plan("s.yaml", "ompl", planner="RRTstar"),
             altiplan.plan("s.yaml", "hybrid_astar", radius_m="auto", plugin_path=["plugins"])]
    with_all: altiplan.Step = altiplan.plan("s.yaml", "astar", **parameters)
    return [*steps, with_all]


def wrong(result: altiplan.Result, world: altiplan.World) -> None:
    altiplan.run(3)  # refused
    altiplan.run("p.yaml", seed="3")  # refused
    altiplan.run("p.yaml", 3)  # refused
    result.route.points  # refused: there may be none
    result.statsu  # refused
    result.status = "solved"  # refused
    world.clearance(None)  # refused
    world.legs_blocked([[1, 2, 3]])  # refused
    altiplan.study("study.yaml")  # refused
    altiplan.plan(3, "astar")  # refused
    altiplan.plan("s.yaml", "astar", cell=[1, 2, 3]).route  # refused
    altiplan.plan("s.yaml", "astar", neighbours="26").route  # refused
    altiplan.plan("s.yaml", "astar", moves="exactly").route  # refused
    altiplan.Metrics.length_m()  # refused

    class Mine(altiplan.World):  # refused
        pass
