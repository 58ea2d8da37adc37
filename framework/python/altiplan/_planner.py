# SPDX-License-Identifier: Apache-2.0
"""How plugins are written in Python: decorators and parameters.

Stands alone, so that the process of a plugin starts without the rest of the package."""
import dataclasses
import inspect
import math
import pathlib
import types
import typing

_Made = typing.TypeVar("_Made", bound=type)
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
    for words in (unit, doc, *choices):
        if not isinstance(words, str):
            raise TypeError(f"unit, doc and choices of a parameter: expected texts, found {words!r}")
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


def objective(name: str, sentence: str,
              params: type = _NoParameters) -> typing.Callable[[_Made], _Made]:
    """As planner, of a class with a method build(site), which returns a Field: what is minimised is
    its integral along the route. It depends on the parameters and the site alone."""
    return _announced("objective", name, sentence, params)


def _announced(kind: str, name: str, sentence: str,
               params: type) -> typing.Callable[[_Made], _Made]:
    if not dataclasses.is_dataclass(params):
        raise TypeError(f"the parameters of '{name}': expected a class below @altiplan.parameters, "
                        f"found {params!r}")

    def announce(plugin_class: _Made) -> _Made:
        offered.append({"kind": kind, "name": name, "sentence": sentence, "class": plugin_class,
                        "params": params})
        return plugin_class

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
    raise TypeError(f"is of type {hint}: expected bool, int, float, str, Path, a list, "
                    "2 or 3 floats as a Tuple, or one of them that is Optional")


def _plain(value: typing.Any, kind: str) -> typing.Any:
    """A default as JSON has it; TypeError or ValueError unless it is of the kind."""
    if kind.startswith("list of "):
        return [_plain(each, kind[8:]) for each in value]
    if kind.startswith("vec"):
        return [_plain(each, "number") for each in value]
    if kind == "path":
        return str(value)
    wanted: typing.Any = {"boolean": bool, "integer": int, "number": (int, float), "text": str}[kind]
    if not isinstance(value, wanted) or (isinstance(value, bool) and kind != "boolean"):
        raise TypeError(f"expected a default of type {kind}, found {value!r}")
    if kind == "integer" and not -2**63 <= value < 2**63:
        raise ValueError("expected a default of 64 bits")
    if kind == "number" and not math.isfinite(value):
        raise ValueError(f"expected a finite default, found {value}: Optional may be None")
    return float(value) if kind == "number" else value


def _expect_allowed(value: typing.Any, declared: typing.Mapping[str, typing.Any]) -> None:
    """ValueError for a default that could not be given in a file."""
    for each in value if isinstance(value, list) else [value]:
        if declared["choices"] and each not in declared["choices"]:
            raise ValueError(f"expected a default among {', '.join(declared['choices'])}, found {each!r}")
        low, high = declared["min"], declared["max"]
        if (low is not None and (each < low or (declared["above"] and each == low))) or (
                high is not None and each > high):
            raise ValueError(f"expected a default within its bounds, found {each!r}")


def _described_field(field: typing.Any, hint: typing.Any) -> typing.Dict[str, typing.Any]:
    kind, optional = _type_of(hint)
    has_factory = field.default_factory is not dataclasses.MISSING
    required = not has_factory and field.default is dataclasses.MISSING
    default = field.default_factory() if has_factory else None if required else field.default
    declared = {**parameter(doc="").metadata, **field.metadata}
    if default is not None:
        default = _plain(default, kind)
        _expect_allowed(default, declared)
    elif not required and not optional:
        raise TypeError("is None by default: make it Optional")
    return {**declared, "name": field.name, "type": kind, "optional": optional, "required": required,
            "default": default}


def described(plugin: typing.Dict[str, typing.Any]) -> typing.Dict[str, typing.Any]:
    """A plugin's parameters as the framework declares them."""
    hints = typing.get_type_hints(plugin["params"])
    fields = []
    for field in dataclasses.fields(plugin["params"]):
        try:
            fields.append(_described_field(field, hints[field.name]))
        except (TypeError, ValueError) as error:
            raise type(error)(f"the parameter {field.name}: {error}") from None
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


def constructed(plugin: typing.Dict[str, typing.Any],
                values: typing.Dict[str, typing.Any]) -> typing.Any:
    """An object of the plugin's class; `values` are checked."""
    hints = typing.get_type_hints(plugin["params"])
    params = plugin["params"](**{name: _typed(value, _type_of(hints[name])[0])
                                 for name, value in values.items()})
    takes = plugin["params"] is not _NoParameters or len(
        inspect.signature(plugin["class"]).parameters) > 0
    return plugin["class"](params) if takes else plugin["class"]()


def properties_of(kind: str, plugin: typing.Any) -> typing.Dict[str, typing.Any]:
    """The methods and traits of an object."""
    needs = {"planner": ("plan",), "smoother": ("smooth",), "environment": ("build",), "objective": ("build",),
             "constraint": ("tighten", "admits", "violations")}[kind]
    methods = [name for name in needs if callable(getattr(plugin, name, None))]
    if not methods:
        raise TypeError(f"a class of a {kind} needs a method {' or '.join(needs)}")
    applies_to = getattr(plugin, "applies_to", "both")
    if kind == "constraint" and applies_to not in ("both", "route", "track"):
        raise ValueError(f"applies_to: expected 'both', 'route' or 'track', found {applies_to!r}")
    traits = getattr(plugin, "traits", {}) if kind == "planner" else {}
    return {"methods": methods, "applies_to": applies_to, "traits": dict(traits)}


class Ground(typing.NamedTuple):
    """Ground from heights above sea level (m) at posts, bilinear between them: heights[j, i] is i
    spacings east and j spacings north of the origin. Each post needs a height."""
    heights: typing.Any  # rows from the south, of at least 2 posts each
    spacing_m: typing.Any  # one number, or (east, north)
    origin_m: typing.Tuple[float, float] = (0.0, 0.0)  # of the post in the south west


class Field(typing.NamedTuple):
    """Costs of a metre of flight at posts, at least 0, linear along each axis between them:
    values[j, i] is i spacings east and j spacings north of the origin, the same at all heights;
    values[k, j, i] is k spacings above it as well; NaN where there is none. `elsewhere` is the cost
    where there are none; None: routes do not lead there. `unit` is that of a cost times a metre."""
    values: typing.Any  # (levels from the lowest, of) rows from the south, of at least 2 posts each
    spacing_m: typing.Any  # one number, or (east, north), or (east, north, up)
    origin_m: typing.Any = 0.0  # of the first post, likewise
    elsewhere: typing.Optional[float] = None
    unit: str = ""


class Cells(typing.NamedTuple):
    """Cells that are blocked or free: blocked[i, j, k] is i cells east, j north and k above the lower
    corner of the grid."""
    blocked: typing.Any  # of three dimensions
    cell_m: typing.Any  # edges: one number, or (east, north, up)
    origin_m: typing.Tuple[float, float, float] = (0.0, 0.0, 0.0)
