# SPDX-License-Identifier: Apache-2.0
"""Values of Python as the command line takes them."""
import json
import math
import numbers
import os
import re
from collections.abc import Mapping
from typing import Any, List, Optional

_SEED_LIMIT = 2**63
_PLAIN = re.compile(r"[a-z][a-z0-9_]*")
_NOT_TEXT = {"true", "false", "yes", "no", "on", "off", "null", "y", "n", "nan", "inf"}


def plain_value(value: Any, key: str) -> Any:
    """The value in types of JSON."""
    if isinstance(value, int) and abs(value) >= 2**63:  # JSON of any size is no number to C++
        raise ValueError(f"{key}: expected a finite number of 64 bits")
    if isinstance(value, (str, int)):
        return value
    if isinstance(value, (list, tuple)):
        return [plain_value(each, key) for each in value]
    if hasattr(value, "tolist"):  # numpy's arrays and numbers
        return plain_value(value.tolist(), key)
    if isinstance(value, numbers.Integral):
        return int(value)
    if isinstance(value, numbers.Real):
        if not math.isfinite(value):
            raise ValueError(f"{key}: expected a finite number, found {value}")
        return float(value)
    if isinstance(value, Mapping):
        return {str(name): plain_value(each, f"{key}.{name}") for name, each in value.items()}
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    raise TypeError(f"{key}: expected a number, a text, a list or a dict, "
                    f"found {type(value).__name__}")


def _text(value: Any) -> str:
    if isinstance(value, str) and _PLAIN.fullmatch(value) and value not in _NOT_TEXT:
        return value
    return json.dumps(value)


def assignments(values: "Mapping[str, Any]") -> List[str]:
    """{"steps.0.with.weight_g": 0.6} as the texts of --set; None removes a key."""
    if not isinstance(values, Mapping):
        raise TypeError(f"set: expected a dict of keys and values, found {type(values).__name__}")
    texts = []
    for key, value in values.items():
        if not isinstance(key, str):
            raise TypeError(f"set: expected keys of type str, found {type(key).__name__}")
        if not key or "=" in key or key.startswith("~"):
            raise ValueError(f"set: {key!r} is no key, such as 'steps.0.with.weight_g'")
        texts.append(f"~{key}" if value is None else f"{key}={_text(plain_value(value, key))}")
    return texts


def _expect_real(value: Any, name: str, wanted: str) -> None:
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name}: expected {wanted}, found {type(value).__name__}")


def real(value: Any, name: str, wanted: str = "a number") -> float:
    """A number that is no Boolean."""
    _expect_real(value, name, wanted)
    return float(value)


def point(value: Any, name: str) -> List[float]:
    """Three finite numbers."""
    numbers_of = plain_value(value, name) if hasattr(value, "tolist") else value
    if not isinstance(numbers_of, (list, tuple)) or len(numbers_of) != 3:
        raise ValueError(f"{name}: expected [x, y, z] in metres, found {value!r}")
    for number in numbers_of:
        _expect_real(number, name, "numbers")
    plain: List[float] = plain_value(numbers_of, name)
    return plain


def path(value: Any, name: str) -> str:
    """The text of a path."""
    if not isinstance(value, (str, os.PathLike)):
        raise TypeError(f"{name}: expected a path, found {type(value).__name__}")
    text = os.fsdecode(value)
    if "\0" in text:
        raise ValueError(f"{name}: a path has no zero byte")
    return text


def paths(values: Any, name: str) -> List[str]:
    """The texts of a list of paths; one path alone would be a list of its letters."""
    if isinstance(values, (str, bytes, os.PathLike)):
        raise TypeError(f"{name}: expected a list of paths, found {type(values).__name__}")
    return [path(each, name) for each in values]


def whole(value: Any, name: str, low: int, high: int) -> int:
    """A whole number in a range."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        raise TypeError(f"{name}: expected a whole number, found {type(value).__name__}")
    number = int(value)
    if not low <= number <= high:
        raise ValueError(f"{name}: expected a whole number from {low} to {high}, found {value}")
    return number


def seed(value: Any) -> Optional[int]:
    """A seed, or None for that of the pipeline."""
    return None if value is None else whole(value, "seed", 0, _SEED_LIMIT - 1)


def seconds(value: Any, name: str) -> float:
    """A time that a step may take."""
    number = real(value, name, "a number of seconds")
    if not 0.001 <= number <= 1e8:
        raise ValueError(f"{name}: expected a number from 0.001 to 1e8, found {value}")
    return number


def fraction(value: Any, name: str) -> float:
    """A part of a whole."""
    number = real(value, name, "a fraction")
    if not 0 < number <= 1:
        raise ValueError(f"{name}: expected a number above 0, up to 1, found {value}")
    return number


def text(value: Any, name: str) -> str:
    """A text that can be an argument of a program."""
    if not isinstance(value, str):
        raise TypeError(f"{name}: expected a text, found {type(value).__name__}")
    if "\0" in value:
        raise ValueError(f"{name}: a text has no zero byte")
    return value


def route_of_state(points: Any, legs: Any) -> Any:
    """What unpickles a Route: pickle finds functions of Python by their names, no others."""
    from . import _altiplan

    return _altiplan.route_of_state(points, legs)
