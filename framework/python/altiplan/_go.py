# SPDX-License-Identifier: Apache-2.0
"""A first route between two points of an elevation model, as `altiplan go` plans it."""
import math
import os
from typing import TYPE_CHECKING, Any, List, Optional, Sequence, Union

from . import _program, _values

if TYPE_CHECKING:
    from ._altiplan import Result

_Path = Union[str, "os.PathLike[str]"]
_NO_ROUTE = 1  # the program's exit code; its files are written


def _place(value: Any, name: str) -> str:
    """LON,LAT[,AGL] as the program reads it."""
    parts = list(value) if isinstance(value, (list, tuple)) or hasattr(value, "tolist") else []
    if len(parts) not in (2, 3):
        raise ValueError(f"{name}: expected (longitude, latitude) in degrees, or also metres above ground, "
                         f"found {value!r}")
    for part in parts:
        if not math.isfinite(_values.real(part, name, "numbers")):
            raise ValueError(f"{name}: expected finite numbers, found {part}")
    return ",".join(repr(float(part)) for part in parts)


def _files(given: Any, name: str) -> List[str]:
    """The absolute paths of one file, or of several."""
    all_of = given if isinstance(given, (list, tuple)) else [given]
    return [os.path.abspath(_values.path(one, name)) for one in all_of]


def go(terrain: Union[_Path, Sequence[_Path]], start: Sequence[float], goal: Sequence[float], out: _Path, *,
       via: Sequence[Sequence[float]] = (), avoid: Union[_Path, Sequence[_Path]] = (),
       min_agl: float = 50, max_agl: Optional[float] = None, wing: Optional[float] = None,
       planner: Optional[str] = None) -> "Result":
    """Plans a first route over elevation models, without YAML, as `altiplan go` does.

    `start`, `goal` and each of `via` are (longitude, latitude) in degrees, or also metres above
    ground. `avoid` are files of zones; `min_agl` and `max_agl` limit the height above ground (m);
    `wing` is the turn radius of an aeroplane (m), a copter without. `out` is a new folder: scenario,
    pipeline, mission and page are written there. Returns the Result of that pipeline; that there is
    no route is its status. Error for files that are refused, and if `out` exists."""
    from . import run

    folder = os.path.abspath(_values.path(out, "out"))
    arguments = ["go", f"--from={_place(start, 'start')}", f"--to={_place(goal, 'goal')}", f"--out={folder}"]
    arguments += [f"--terrain={file}" for file in _files(terrain, "terrain")]
    arguments += [f"--via={_place(one, 'via')}" for one in via]
    arguments += [f"--avoid={file}" for file in _files(avoid, "avoid")]
    for name, metres in (("min-agl", min_agl), ("max-agl", max_agl), ("wing", wing)):
        if metres is not None:
            arguments.append(f"--{name}={_values.real(metres, name.replace('-', '_'))!r}")
    if planner is not None:
        arguments.append(f"--planner={_values.text(planner, 'planner')}")
    _program.call(*arguments, results=(0, _NO_ROUTE))
    return run(os.path.join(folder, "pipeline.yaml"))
