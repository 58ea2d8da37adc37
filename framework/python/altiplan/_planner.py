# SPDX-License-Identifier: Apache-2.0
"""How plugins are written in Python: decorators, and what their methods get.

Stands alone, so that the process of a plugin starts without the rest of the package."""
import dataclasses
import inspect
import math
import pathlib
import random
import sys
import time
import types
import typing
from array import array

_Made = typing.TypeVar("_Made", bound=type)
_Ask = typing.Callable[[typing.Dict[str, typing.Any], typing.Any],
                       typing.Tuple[typing.Dict[str, typing.Any], "array[float]"]]
_KINDS = {bool: "boolean", int: "integer", float: "number", str: "text", pathlib.Path: "path"}
_UNIONS = (typing.Union, getattr(types, "UnionType", typing.Union))  # `float | None` since 3.10
_TUPLES = {(float,) * 2: "vec2", (float,) * 3: "vec3"}
# What the decorators have announced, in the order of the file.
offered: typing.List[typing.Dict[str, typing.Any]] = []


class NoRoute(Exception):
    """Returned or raised by plan: there is no route, and why; `proved` where none can exist."""

    def __init__(self, message: str, proved: bool = False):
        super().__init__(message)
        self.proved = proved


def parameter(default: typing.Any = dataclasses.MISSING, *, unit: str = "", doc: str = "",
              above: typing.Optional[float] = None, at_least: typing.Optional[float] = None,
              at_most: typing.Optional[float] = None, choices: typing.Sequence[str] = (),
              min_items: int = 0) -> typing.Any:
    """A field of a class of parameters; without a default it is required. Bounds are of each number."""
    declared = {"unit": unit, "doc": doc, "max": at_most, "choices": list(choices),
                "min": at_least if above is None else above, "above": above is not None,
                "min_items": min_items}
    if isinstance(default, (list, dict, set)):
        kind: typing.Any = type(default)

        def fresh() -> typing.Any:
            return kind(default)

        return dataclasses.field(default_factory=fresh, metadata=declared)
    return dataclasses.field(default=default, metadata=declared)


parameters = dataclasses.dataclass


@parameters
class _NoParameters:
    pass


def planner(name: str, sentence: str,
            params: type = _NoParameters) -> typing.Callable[[_Made], _Made]:
    """Makes a class a planner: constructed from its parameters, with a method plan(request).

    Name and sentence are written as plain texts: they are read before any of the file runs."""
    return _announced("planner", name, sentence, params)


def smoother(name: str, sentence: str,
             params: type = _NoParameters) -> typing.Callable[[_Made], _Made]:
    """As planner, of a class with a method smooth(route, request), which returns a better route with
    the same ends, or None for no better one. `route` is a list of points, or an array."""
    return _announced("smoother", name, sentence, params)


def environment(name: str, sentence: str,
                params: type = _NoParameters) -> typing.Callable[[_Made], _Made]:
    """As planner, of a class with a method build(site), which returns what the layer consists of:
    solids, each as in a scenario, such as {"box": {"min_m": (0, 0, 0), "max_m": (20, 20, 40)}}, or
    Ground, or Cells. It depends on the parameters and the site alone."""
    return _announced("environment", name, sentence, params)


def constraint(name: str, sentence: str,
               params: type = _NoParameters) -> typing.Callable[[_Made], _Made]:
    """As planner, of a class with one or more of the methods tighten(request), which returns limits
    as in request.limits, stricter ones alone have an effect; admits(leg), whether a straight leg
    keeps the constraint, depending on the leg alone; violations(points, request), which returns of
    a whole route (at, value, limit, message) for each place where it is violated. Its attribute
    `applies_to` is "both" unless it says "route" or "track"."""
    return _announced("constraint", name, sentence, params)


def _announced(kind: str, name: str, sentence: str,
               params: type) -> typing.Callable[[_Made], _Made]:
    def announce(made_of: _Made) -> _Made:
        offered.append({"kind": kind, "name": name, "sentence": sentence, "class": made_of,
                        "params": params})
        return made_of

    return announce


def _type_of(hint: typing.Any) -> typing.Tuple[str, bool]:
    """The framework's name of a type, and whether it may be None."""
    inner = typing.get_args(hint)
    if typing.get_origin(hint) in _UNIONS and len(inner) == 2 and type(None) in inner:
        hint = inner[inner[0] is type(None)]
        if hint in _KINDS:
            return _KINDS[hint], True
    if typing.get_origin(hint) is list and inner[0] in (int, float, str):
        return "list of " + _KINDS[inner[0]], False
    if typing.get_origin(hint) is tuple and inner in _TUPLES:
        return _TUPLES[inner], False
    if hint in _KINDS:
        return _KINDS[hint], False
    raise TypeError(f"a parameter of type {hint}: expected bool, int, float, str, Path, a list, "
                    "2 or 3 floats as a Tuple, or one of them that is Optional")


def _plain(value: typing.Any, kind: str) -> typing.Any:
    """A default as JSON has it."""
    if value is None or kind in ("boolean", "integer", "text"):
        return value
    if kind == "path":
        return str(value)
    if isinstance(value, (list, tuple)):
        return [_plain(each, kind.replace("list of ", "", 1)) for each in value]
    return float(value)


def described(plugin: typing.Dict[str, typing.Any]) -> typing.Dict[str, typing.Any]:
    """A plugin's parameters as the framework declares them."""
    hints = typing.get_type_hints(plugin["params"])
    fields = []
    for field in dataclasses.fields(plugin["params"]):
        kind, optional = _type_of(hints[field.name])
        factory: typing.Any = field.default_factory
        made = factory is not dataclasses.MISSING
        required = not made and field.default is dataclasses.MISSING
        default = factory() if made else None if required else field.default
        if default is None and not required and not optional:
            raise TypeError(f"the parameter {field.name} is None by default: make it Optional")
        fields.append({**parameter(doc="").metadata, **field.metadata, "name": field.name,
                       "type": kind, "optional": optional, "required": required,
                       "default": _plain(default, kind)})
    return {key: plugin[key] for key in ("kind", "name", "sentence")} | {"parameters": fields}


def _typed(value: typing.Any, kind: str) -> typing.Any:
    """A checked value of JSON, where 3 may stand for 3.0, in its type."""
    if value is None:
        return None
    if kind.startswith("list of "):
        return [_typed(each, kind[8:]) for each in value]
    if kind.startswith("vec"):
        return tuple(map(float, value))
    types_of: typing.Dict[str, typing.Any] = {"number": float, "path": pathlib.Path}
    return types_of[kind](value) if kind in types_of else value


def made(plugin: typing.Dict[str, typing.Any], values: typing.Dict[str, typing.Any]) -> typing.Any:
    """An object of the plugin's class; `values` are checked."""
    hints = typing.get_type_hints(plugin["params"])
    params = plugin["params"](**{name: _typed(value, _type_of(hints[name])[0])
                                 for name, value in values.items()})
    takes = plugin["params"] is not _NoParameters or len(
        inspect.signature(plugin["class"]).parameters) > 0
    return plugin["class"](params) if takes else plugin["class"]()


def told(kind: str, plugin: typing.Any) -> typing.Dict[str, typing.Any]:
    """What an object says of itself."""
    needs = {"planner": ("plan",), "smoother": ("smooth",), "environment": ("build",),
             "constraint": ("tighten", "admits", "violations")}[kind]
    methods = [name for name in needs if callable(getattr(plugin, name, None))]
    if not methods:
        raise TypeError(f"a class of a {kind} needs a method {' or '.join(needs)}")
    applies_to = getattr(plugin, "applies_to", "both")
    if kind == "constraint" and applies_to not in ("both", "route", "track"):
        raise ValueError(f"applies_to: expected 'both', 'route' or 'track', found {applies_to!r}")
    traits = getattr(plugin, "traits", {}) if kind == "planner" else {}
    return {"methods": methods, "applies_to": applies_to, "traits": dict(traits)}


def numbers_of(points: typing.Any, columns: int, name: str) -> "array[float]":
    """The numbers of points, row by row; ValueError unless each has as many."""
    if hasattr(points, "tolist"):  # numpy's arrays
        if len(points.shape) != 2 or points.shape[1] != columns:
            raise ValueError(f"{name}: expected numbers of shape (n, {columns}), found shape "
                             f"{points.shape}")
        return array("d", points.astype(float).tobytes())
    numbers = array("d")
    for point in points:
        if len(point) != columns:
            raise ValueError(f"{name}: expected points of {columns} numbers, found {len(point)}")
        numbers.extend(map(float, point))
    return numbers


def listed(numbers: typing.Any, columns: int = 1) -> typing.Any:
    """Numbers, or rows of them: arrays in a script that imports numpy, else lists of tuples."""
    numpy = sys.modules.get("numpy")
    if numpy is not None:
        values = numpy.array(numbers, dtype=float)
        return values if columns == 1 else values.reshape(-1, columns)
    if columns == 1:
        return list(numbers)
    return list(zip(*(numbers[column::columns] for column in range(columns))))


class Ground(typing.NamedTuple):
    """Ground from heights above sea level (m) at posts, bilinear between them: heights[j, i] is i
    spacings east and j spacings north of the origin. Each post needs a height."""
    heights: typing.Any  # rows from the south, of at least 2 posts each
    spacing_m: typing.Any  # one number, or (east, north)
    origin_m: typing.Tuple[float, float] = (0.0, 0.0)  # of the post in the south west


class Cells(typing.NamedTuple):
    """Cells that are blocked or free: blocked[i, j, k] is i cells east, j north and k above the lower
    corner of the grid."""
    blocked: typing.Any  # of three dimensions
    cell_m: typing.Any  # edges: one number, or (east, north, up)
    origin_m: typing.Tuple[float, float, float] = (0.0, 0.0, 0.0)


class Budget:
    """What a plan may use. `spent` is asked in every iteration; once true it stays true."""

    def __init__(self, given: typing.Dict[str, typing.Any], is_stopped: typing.Callable[[], bool]):
        self._is_stopped = is_stopped
        self._deadline: typing.Optional[float] = given["deadline"]
        self.max_iterations: int = given["max_iterations"]
        self.expanded = 0  # iterations that have been counted
        self._asked = 0
        self.was_spent = False  # what `spent` last said

    @property
    def seconds_left(self) -> float:
        """Infinite without a time limit."""
        return math.inf if self._deadline is None else self._deadline - time.monotonic()

    def spent(self, iterations: typing.Optional[int] = None) -> bool:
        """True when the search has to end; `iterations` are those done, by default the calls before
        this one."""
        done = self._asked if iterations is None else iterations
        self._asked += 1
        self.expanded = max(self.expanded, min(done, self.max_iterations))
        self.was_spent = (self.was_spent or done >= self.max_iterations or self.seconds_left <= 0 or
                          self._is_stopped())
        return self.was_spent


class World:
    """The known world of a request, asked of the program: its answers are those of the judge."""

    def __init__(self, ask: _Ask):
        self._ask = ask

    @property
    def layers(self) -> typing.List[str]:
        """The layers' ids."""
        return list(self._ask({"ask": "layers"}, ())[0]["layers"])

    def clearance(self, points: typing.Any) -> typing.Any:
        """Signed distances from the nearest obstacle or ground (m) of points (n, 3)."""
        return listed(self._ask({"ask": "clearance"}, numbers_of(points, 3, "points"))[1])

    def ground(self, points_xy: typing.Any) -> typing.Any:
        """Heights of the ground (m) at points (n, 2); nan where there is none."""
        return listed(self._ask({"ask": "ground"}, numbers_of(points_xy, 2, "points_xy"))[1])

    def legs_blocked(self, a: typing.Any, b: typing.Any, radius_m: float = 0.0) -> typing.Any:
        """Whether a sphere meets an obstacle on each straight leg from a[i] to b[i]."""
        return self._yes({"ask": "legs_blocked", "radius_m": float(radius_m)}, self._pairs(a, b))

    def legs_ok(self, a: typing.Any, b: typing.Any, before: typing.Any = None) -> typing.Any:
        """Whether each leg from a[i] to b[i] keeps every limit and constraint that depends on it
        alone. `before` are the points from which a[i] are reached, for limits of turns; a leg from
        the request's start has its approach."""
        rows = self._pairs(a, b)
        if before is not None:
            rows = rows + numbers_of(before, 3, "before")
            if 2 * len(rows) != 3 * len(self._pairs(a, b)):
                raise ValueError("before: expected as many points as a")
        return self._yes({"ask": "legs_ok", "before": before is not None}, rows)

    def leg_ok(self, a: typing.Any, b: typing.Any, before: typing.Any = None) -> bool:
        """legs_ok of one leg."""
        return bool(self.legs_ok([a], [b], None if before is None else [before])[0])

    def violations(self, points: typing.Any) -> typing.List[str]:
        """What the judge finds wrong with a whole route, a sentence each; [] of one that holds."""
        answer = self._ask({"ask": "violations"}, numbers_of(points, 3, "points"))[0]
        return list(answer["violations"])

    def _yes(self, question: typing.Dict[str, typing.Any], numbers: "array[float]") -> typing.Any:
        answers = self._ask(question, numbers)[1]
        numpy = sys.modules.get("numpy")
        return [answer != 0 for answer in answers] if numpy is None else numpy.array(answers) != 0

    @staticmethod
    def _pairs(a: typing.Any, b: typing.Any) -> "array[float]":
        begins, ends = numbers_of(a, 3, "a"), numbers_of(b, 3, "b")
        if len(begins) != len(ends):
            raise ValueError(f"b: expected {len(begins) // 3} points as of a, "
                             f"found {len(ends) // 3}")
        return begins + ends


def _point(given: typing.Any) -> typing.Any:
    """A tuple of numbers, or an array in a script that imports numpy; None of None."""
    if given is None:
        return None
    return tuple(given) if sys.modules.get("numpy") is None else listed(given)


class Leg:
    """A straight motion that a constraint admits or refuses."""

    def __init__(self, numbers: "array[float]", ask: typing.Optional[_Ask]):
        self.start, self.end = _point(numbers[:3]), _point(numbers[3:6])  # metres
        self.before = _point(numbers[6:]) if len(numbers) > 6 else None  # whence start is reached
        self.world = None if ask is None else World(ask)  # None: nothing is known of it


class Site:
    """Where a layer is built: values, and the layers before it to ask. Points are in metres."""

    def __init__(self, given: typing.Dict[str, typing.Any], ask: _Ask):
        # The lowest and the highest corner; infinite where the scenario leaves it to the layers.
        self.volume = listed([(-math.inf if n < 3 else math.inf) if number is None else number
                              for n, number in enumerate(given["volume"])], 3)
        self.start, self.goal = _point(given["start"]), _point(given["goal"])  # None: not yet known
        self.vehicle = given["vehicle"]  # as of a request
        self.start_time_s = given["start_time_s"]  # since 1970-01-01 UTC; None where none is given
        self.seed = given["seed"]
        self.rng = random.Random(self.seed)
        self.world = World(ask)
        self._ask = ask

    def to_local(self, lonlat: typing.Any) -> typing.Any:
        """Degrees east and north (n, 2) as metres east and north (n, 2) of the scenario's frame."""
        return listed(self._ask({"ask": "local"}, numbers_of(lonlat, 2, "lonlat"))[1], 2)


class Request:
    """A planning problem: values, and the world to ask. Points are in metres of the scenario's frame."""

    def __init__(self, given: typing.Dict[str, typing.Any], ask: _Ask,
                 is_stopped: typing.Callable[[], bool]):
        self.start, self.goal = _point(given["start"]), _point(given["goal"])
        velocity = given["start_velocity"]  # m/s; None where no heading is given
        self.start_velocity = None if velocity is None else listed(velocity)
        self.goal_tolerance_m = given["goal_tolerance_m"]
        self.goal_heading = given["goal_heading"]  # radians, counter-clockwise from east, or None
        self.volume = listed(given["volume"], 3)  # the lowest and the highest corner
        self.level_m = given["level_m"]  # of level flight, or None
        self.vehicle = given["vehicle"]  # a dict: radius_m, speed_mps, and of an aeroplane wing
        self.limits = given["limits"]  # a dict; None: no limit
        self.wind = given["wind"]  # dicts of above_m and velocity, by ascending border
        self.threads = given["threads"]
        self.seed = given["seed"]
        self.rng = random.Random(self.seed)
        self.budget = Budget(given["budget"], is_stopped)
        self.world = World(ask)
