# SPDX-License-Identifier: Apache-2.0
"""Plans routes for unmanned aircraft over real terrain.

>>> import altiplan
>>> result = altiplan.run("configs/pipelines/ridge_crossing.yaml", seed=3)
>>> result.route.points    # (n, 3) array, metres of the scenario's frame
>>> result.plot()

Points are [x, y, z] in metres of the scenario's frame: x east, y north, z above sea level. What
altiplan refuses raises altiplan.Error; an argument of the wrong type raises TypeError, one out of
range or of the wrong shape ValueError. That no route is found is a result, not an error."""
import os as _os
import warnings as _warnings
from typing import Any as _Any
from typing import Mapping as _Mapping
from typing import Optional as _Optional
from typing import Sequence as _Sequence
from typing import Union as _Union

try:
    from . import _altiplan
except ImportError as error:
    if "_altiplan" not in str(error.path):  # else it is there, and a library that it needs is not
        raise ImportError("altiplan's library for this Python is not built: in the build's folder, cmake --build . "
                          "--target altiplan_python, which needs pybind11 and the python3 that CMake found") from error
    raise
from . import _plot, _values
from ._altiplan import (Check, Flight, Leg, Metrics, Result, Route, Step, Violation, World,
                        __version__)
from ._error import Error
from ._go import go
from ._planner import (Cells, Field, Ground, NoRoute, constraint, environment, objective, parameter,
                       parameters, planner, smoother)
from ._plans import typed as _typed
from ._study import Study, study

__all__ = ["Cells", "Check", "Error", "Field", "Flight", "Ground", "Leg", "Metrics", "NoRoute",
           "Result", "Route", "Step", "Study", "Violation", "World", "check", "constraint", "environment",
           "go", "objective", "parameter", "parameters", "plan", "planner", "run", "smoother", "study"]

_Path = _Union[str, "_os.PathLike[str]"]

for _type in (Check, Error, Flight, Leg, Metrics, Result, Route, Step, Study, Violation, World,
              study):
    _type.__module__ = "altiplan"
setattr(Result, "plot", _plot.plot)


def _warn(sentences: _Sequence[str]) -> None:
    for sentence in sentences:
        _warnings.warn(sentence, stacklevel=3)


def run(pipeline: _Path, *, seed: _Optional[int] = None, set: _Mapping[str, _Any] = {},
        plugin_path: _Sequence[_Path] = (), threads: int = 1, timeout_s: float = 60,
        out: _Optional[_Path] = None) -> Result:
    """Runs a pipeline: plans, smooths, judges and flies a route, as `altiplan run` does.

    `set` replaces values of the files: {"steps.0.with.weight_g": 0.6, "scenario.…": …}; None
    removes a key. `threads` is the most per plugin; `timeout_s` that of steps without `within_s`.
    `out` is a file for the result (JSON). Ctrl-C stops the step, writes `out` and raises
    KeyboardInterrupt. A step that never stops has status 'failed' and is left to its thread.
    Raises Error for files, parameters and plugins that are refused."""
    result = _altiplan.run(
        _values.path(pipeline, "pipeline"), _values.seed(seed), _values.assignments(set),
        _values.paths(plugin_path, "plugin_path"), _values.whole(threads, "threads", 1, 1024),
        _values.seconds(timeout_s, "timeout_s"), None if out is None else _values.path(out, "out"))
    _warn(result.warnings)
    return result


def _end(values: "dict[str, _Any]", name: str, end: _Any) -> None:
    """Adds what replaces the start or the goal, with all of its keys."""
    if isinstance(end, _Mapping):
        values[f"scenario.{name}"] = dict(end)
    elif end is not None:
        values[f"scenario.{name}"] = {"at_m": _values.point(end, name)}


@_typed
def plan(file: _Path, planner: str, /, start: _Any = None, goal: _Any = None, seed: int = 0,
         within_s: _Optional[float] = None, *, set: _Mapping[str, _Any] = {},
         plugin_path: _Sequence[_Path] = (), **parameters: _Any) -> Step:
    """Plans one route with a planner in a scenario, or in that of a pipeline under its constraints.

    `start` and `goal` replace those of the scenario with all of their keys: [x, y, z] in metres of
    its frame, or a dict such as {"at_m": [4000, 6000], "above_ground_m": 80, "tolerance_m": 5}.
    `parameters` are the planner's, checked as in a file; `within_s` is its time budget (s). Returns
    the Step: its `route` is the planner's, `accepted` and `check` tell what the judge holds of it.
    Raises as `run`."""
    if not isinstance(planner, str):
        raise TypeError(f"planner: expected a name, found {type(planner).__name__}")
    step: _Any = {"plan": planner, "with": parameters}
    if within_s is not None:
        step["within_s"] = _values.seconds(within_s, "within_s")
    if "steps" in set:
        raise ValueError("set: 'steps' is the planner's alone; 'steps.0.within_mb' is a key of it")
    values = {"steps": [step], **set}
    _end(values, "start", start)
    _end(values, "goal", goal)
    found, warnings = _altiplan.plan(
        _values.path(file, "file"), _values.seed(seed), _values.assignments(values),
        _values.paths(plugin_path, "plugin_path"))
    _warn(warnings)
    return found


def check(route: _Union[Route, _Any], file: _Path, set: _Mapping[str, _Any] = {},
          plugin_path: _Sequence[_Path] = ()) -> Check:
    """The judge's verdict on a Route, or points of shape (n, 3) in metres, in a scenario, or under
    the constraints of a pipeline too; as `altiplan check`. Raises Error as World does."""
    return World(file, set, plugin_path).check(route)
