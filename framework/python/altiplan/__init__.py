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
from typing import List as _List
from typing import Mapping as _Mapping
from typing import Optional as _Optional
from typing import Sequence as _Sequence
from typing import Union as _Union

from . import _altiplan, _plot, _values
from ._altiplan import (Check, Flight, Leg, Metrics, Result, Route, Step, Violation, __version__)
from ._error import Error

__all__ = ["Check", "Error", "Flight", "Leg", "Metrics", "Result", "Route", "Step", "Violation",
           "World", "check", "run"]

_Path = _Union[str, "_os.PathLike[str]"]

for _type in (Check, Flight, Leg, Metrics, Result, Route, Step, Violation):
    _type.__module__ = "altiplan"
Result.plot = _plot.plot


def _warn(sentences: _List[str]) -> None:
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


def _route(route: _Any) -> Route:
    return route if isinstance(route, Route) else Route(route)


class World(_altiplan._World):
    """The layers of a scenario, or of a pipeline's, with the problem posed there; it never changes.

    `set` replaces values of the scenario, as of `run`. All layers count; with `known`, only those
    that planners know at take-off. Raises Error for files and plugins that are refused."""

    def __init__(self, file: _Path, set: _Mapping[str, _Any] = {},
                 plugin_path: _Sequence[_Path] = (), known: bool = False):
        super().__init__(_values.path(file, "file"), _values.assignments(set),
                         _values.paths(plugin_path, "plugin_path"), bool(known))
        _warn(self.warnings)

    def check(self, route: _Union[Route, _Any]) -> Check:
        """The judge's verdict on a Route, or points of shape (n, 3), in the world known at take-off:
        ends, volume, every leg, limit and constraint of the file."""
        return super()._check(_route(route))


def check(route: _Union[Route, _Any], file: _Path, set: _Mapping[str, _Any] = {},
          plugin_path: _Sequence[_Path] = ()) -> Check:
    """The judge's verdict on a Route, or points of shape (n, 3) in metres, in a scenario, or under
    the constraints of a pipeline too; as `altiplan check`. Raises Error as World does."""
    return World(file, set, plugin_path).check(_route(route))
