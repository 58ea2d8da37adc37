# SPDX-License-Identifier: Apache-2.0
"""What methods of plugins in Python return, checked, as messages to the program.

Stands alone, as _planner.py does. ValueError and TypeError tell what was expected."""
import math
import numbers
import typing
from array import array

from . import _planner, _values

_Json = typing.Dict[str, typing.Any]
_Answer = typing.Tuple[_Json, typing.Iterable[float]]
_LIMITS = ("min_clearance_m", "min_ground_clearance_m", "min_leg_m", "max_leg_m", "max_turn",
           "max_turn_in_space", "min_turn_radius_m", "max_climb", "max_descent", "max_route_m")
_BAND = ("above_ground", "min_m", "max_m")
_LONGEST = 2000  # characters of a message
_CONTROLS = dict.fromkeys([*range(32), *range(127, 160)], " ")  # which terminals would obey
_HIGHEST_M = 100_000.0
_HIGHEST_COST = 1e9  # of a metre
_MAX_VIOLATIONS = 10_000  # of a route; more tell nothing
_ANGLES = {"max_turn": math.pi, "max_turn_in_space": math.pi, "max_climb": math.pi / 2,
           "max_descent": math.pi / 2}


def text(value: typing.Any) -> str:
    """A message in one line, in no more characters than anybody reads."""
    return str(value)[:_LONGEST].translate(_CONTROLS)


def number(value: typing.Any, name: str) -> float:
    """A finite number."""
    try:
        found = _values.real(value, name)
    except OverflowError:  # of a whole number
        found = math.inf
    if not math.isfinite(found):
        raise ValueError(f"{name}: expected a finite number, found {found}")
    return found


def numbers_or_one(value: typing.Any, count: int, name: str) -> typing.List[float]:
    """As many numbers, or one for all."""
    if not isinstance(value, numbers.Real) and not hasattr(value, "__iter__"):
        raise TypeError(f"{name}: expected {count} numbers, or one, found {type(value).__name__}")
    values = [value] * count if isinstance(value, numbers.Real) else list(value)
    if len(values) != count:
        raise ValueError(f"{name}: expected {count} numbers, found {len(values)}")
    return [number(each, name) for each in values]


def _shape(values: typing.Any, dimensions: int, name: str) -> typing.List[int]:
    """The numbers of rows, columns, …, of which there is at least one."""
    if hasattr(values, "tolist") and hasattr(values, "dtype"):  # numpy's arrays
        if values.ndim != dimensions or values.size == 0:
            raise ValueError(f"{name}: expected numbers in {dimensions} dimensions, found shape "
                             f"{values.shape}")
        if values.dtype.kind not in "biuf":
            raise TypeError(f"{name}: expected numbers, found {values.dtype}")
        return list(values.shape)
    shape = []
    for _ in range(dimensions):
        if not hasattr(values, "__len__") or len(values) == 0:
            raise ValueError(f"{name}: expected numbers in {dimensions} dimensions")
        shape.append(len(values))
        values = values[0]
    if hasattr(values, "__len__"):
        raise ValueError(f"{name}: expected numbers in {dimensions} dimensions")
    return shape


def _flat(values: typing.Any, shape: typing.Sequence[int], name: str) -> "array[float]":
    """The numbers in the order of an array's memory."""
    if hasattr(values, "tolist"):  # numpy's arrays
        return array("d", values.astype(float).tobytes())
    if len(values) != shape[0]:
        raise ValueError(f"{name}: expected rows of the same length")
    if len(shape) == 1:
        return array("d", map(float, values))
    flat = array("d")
    for row in values:
        flat += _flat(row, shape[1:], name)
    return flat


def _posts(posts: typing.Any, values: typing.Any, name: str, axes: int) -> _Answer:
    """Where the posts of Ground or Field lie, along each axis, and their values, which are called
    `name`."""
    shape = _shape(values, axes, name)
    flat = _flat(values, shape, name)
    spacing = numbers_or_one(posts.spacing_m, axes, "spacing_m")
    if min(shape) < 2 or min(spacing) <= 0:
        raise ValueError(f"{type(posts).__name__}: expected 2 posts or more along each axis, and spacings "
                         f"above 0, found {' x '.join(map(str, shape))} posts of {spacing} m")
    return {"counts": shape[::-1], "spacing_m": spacing,
            "origin_m": numbers_or_one(posts.origin_m, axes, "origin_m")}, flat


def _ground(ground: typing.Any) -> _Answer:
    posts, heights = _posts(ground, ground.heights, "heights", 2)
    if not all(-_HIGHEST_M <= height <= _HIGHEST_M for height in heights):
        raise ValueError(f"heights: expected a finite number at each post, up to {_HIGHEST_M:.0f} m")
    return {"ground": posts}, heights


def _axes(values: typing.Any) -> int:
    """3 of values in three dimensions, else 2."""
    if hasattr(values, "ndim"):  # numpy's arrays
        return 3 if values.ndim == 3 else 2
    row = values[0] if hasattr(values, "__len__") and len(values) else None
    return 3 if hasattr(row, "__len__") and len(row) and hasattr(row[0], "__len__") else 2


def field(returned: typing.Any) -> _Answer:
    """What `build` of an objective returns."""
    if not isinstance(returned, _planner.Field):
        raise TypeError(f"build: expected a Field, found {type(returned).__name__}")
    posts, values = _posts(returned, returned.values, "values", _axes(returned.values))
    if not all(0 <= value <= _HIGHEST_COST or math.isnan(value) for value in values):
        raise ValueError(f"values: expected 0 to {_HIGHEST_COST:g} at each post, or NaN")
    if all(map(math.isnan, values)):
        raise ValueError("values: expected a number at one post or more, found NaN alone")
    elsewhere = None if returned.elsewhere is None else number(returned.elsewhere, "elsewhere")
    if elsewhere is not None and not 0 <= elsewhere <= _HIGHEST_COST:
        raise ValueError(f"elsewhere: expected 0 to {_HIGHEST_COST:g}, found {elsewhere}")
    return {"field": {**posts, "elsewhere": elsewhere, "unit": text(returned.unit)}}, values


def _cells(cells: typing.Any) -> _Answer:
    shape = _shape(cells.blocked, 3, "blocked")
    edges = numbers_or_one(cells.cell_m, 3, "cell_m")
    if min(edges) <= 0:
        raise ValueError(f"cell_m: expected edges above 0, found {edges}")
    blocked = _flat(cells.blocked, shape, "blocked")
    if not all(one in (0.0, 1.0) for one in blocked):
        raise ValueError("blocked: expected True or False, or 1 or 0, of each cell")
    return {"cells": {"counts": shape, "cell_m": edges,
                      "origin_m": numbers_or_one(cells.origin_m, 3, "origin_m")}}, blocked


def built(layer: typing.Any) -> _Answer:
    """What `build` returns."""
    if isinstance(layer, _planner.Ground):
        return _ground(layer)
    if isinstance(layer, _planner.Cells):
        return _cells(layer)
    if not isinstance(layer, (list, tuple)):
        raise TypeError("build: expected a list of solids, Ground or Cells, found "
                        f"{type(layer).__name__}")
    for at, solid in enumerate(layer):
        if not isinstance(solid, dict) or len(solid) != 1:
            raise TypeError(f'solid {at}: expected a dict such as {{"box": {{"min_m": …, "max_m": …}}}},'
                            + text(f" found {solid!r}"))
    return {"solids": [_values.plain_value(solid, f"solid {at}") for at, solid in enumerate(layer)]}, ()


def _band(band: typing.Any) -> _Json:
    """A band of `altitude` with all of its keys."""
    if not isinstance(band, dict) or not set(band) <= set(_BAND):
        raise ValueError(f"altitude: expected dicts of {', '.join(_BAND)}, found {band!r}")
    ends = {key: None if band.get(key) is None else number(band[key], key) for key in _BAND[1:]}
    return {"above_ground": bool(band.get("above_ground", False)), **ends}


def _limit(value: typing.Any, name: str) -> float:
    """A length, or an angle in radians: one in degrees would be a limit that limits nothing."""
    limit = number(value, name)
    if name in _ANGLES and not 0 <= limit <= _ANGLES[name] + 1e-9:
        raise ValueError(f"{name}: expected radians from 0 to {_ANGLES[name]:.4f}, found {limit}")
    if name not in _ANGLES and name != "min_ground_clearance_m" and limit < 0:
        raise ValueError(f"{name}: expected metres from 0, found {limit}")
    return limit


def admitted(returned: typing.Any) -> bool:
    """What `admits` returns; numpy's Booleans are no bool."""
    if type(returned).__name__ not in ("bool", "bool_"):
        raise TypeError(f"admits: expected True or False, found {type(returned).__name__}")
    return bool(returned)


def limits(returned: typing.Any) -> _Json:
    """What `tighten` returns; None of a limit, or of all, tightens nothing."""
    given: typing.Any = {} if returned is None else returned
    if not isinstance(given, dict):
        raise TypeError(f"tighten: expected a dict of limits, found {type(given).__name__}")
    for name in given:
        if name not in (*_LIMITS, "altitude"):
            raise ValueError(f"tighten: there is no limit {name!r}: expected altitude, "
                             + ", ".join(_LIMITS))
    values: _Json = {name: _limit(value, name) for name, value in given.items()
                     if name != "altitude" and value is not None}
    return {**values, "altitude": [_band(band) for band in given.get("altitude") or ()]}


def violations(returned: typing.Any, count: int) -> typing.List[typing.Any]:
    """What `violations` returns of a route of as many points."""
    if not isinstance(returned, (list, tuple)):
        raise TypeError("violations: expected a list, empty where nothing is violated, found "
                        + type(returned).__name__)
    found = []
    for one in returned[:_MAX_VIOLATIONS]:
        if not isinstance(one, (list, tuple)) or len(one) != 4:
            raise ValueError(f"violations: expected (at, value, limit, message), found {one!r}")
        at, value, limit, message = one
        if not isinstance(at, numbers.Integral) or not 0 <= int(at) < count:
            raise ValueError(f"violations: expected the index of one of {count} points, found {at!r}")
        found.append([int(at), number(value, "value"), number(limit, "limit"), text(message)])
    return found
