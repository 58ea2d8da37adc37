# SPDX-License-Identifier: Apache-2.0
"""Makes the stubs of the package from what the C++ declares; tests/python/stubs_test.py writes them.

_altiplan.pyi is that of the built module: functions have pybind11's signatures, and docstrings of
attributes begin with their type ("float: …"). _plans.pyi has the parameters of each planner, as
`altiplan describe` prints them."""
import inspect
import json
import os
import re
import subprocess
import textwrap

LICENCE = "# SPDX-License-Identifier: Apache-2.0\n"
MADE = "Made by tests/python/stubs_test.py; edit the C++ instead."
MODULE = f'''{LICENCE}"""The part of altiplan that is in C++. {MADE}"""
from os import PathLike
from typing import Any, Iterator, Mapping, Optional, Sequence, Union, final

from matplotlib.figure import Figure
from numpy import bool_, float64
from numpy.typing import ArrayLike, NDArray

__version__: str
'''
PLANS = f'''{LICENCE}"""The calls of altiplan.plan, by planner. {MADE}"""
from typing import (Any, Callable, Literal, Mapping, NoReturn, Optional, Protocol, Sequence, Union,
                    overload)

from numpy import floating, integer
from numpy.typing import NDArray

from . import _Path
from ._altiplan import Step

_Whole = Union[int, integer[Any]]
_Number = Union[float, floating[Any], _Whole]
_Numbers = Union[Sequence[_Number], NDArray[Any]]

class RefusedParameters(Protocol):
    """What a call gives whose parameters are not those of this planner, or not of their types:
    nothing, since it raises altiplan.Error."""

class Plan(Protocol):
    """Type of altiplan.plan."""
'''
TYPES = {"number": "_Number", "integer": "_Whole", "true or false": "bool", "text": "str",
         "path": "_Path", "2 numbers": "_Numbers", "3 numbers": "_Numbers",
         "number or auto": 'Union[_Number, Literal["auto"]]'}
# Of pybind11 from 2.10 to 3.1; lists are arguments alone, which may be any sequence.
SPELLINGS = [(r"altiplan\._altiplan\.|collections\.abc\.", ""), (r"\b[Ll]ist\[", "Sequence["),
             (r"\bTuple\[", "tuple["),
             (r"os\.PathLike( \| str \| bytes)?", "Union[str, PathLike[str]]"),
             (r"typing\.SupportsFloat \| typing\.SupportsIndex", "float"),
             (r"typing\.SupportsInt \| typing\.SupportsIndex", "int"),
             (r"(\w+) \| None", r"Optional[\1]")]


def function(name, signature, doc, indent):
    """The lines of a function of a stub."""
    opening = f"{indent}def {name}("
    # Lines break between arguments.
    joined = re.sub("([:=>]) | (?=[=-])", "\\1\0", f"{opening.lstrip()}{signature}:")
    head = textwrap.fill(joined, 100, initial_indent=indent, subsequent_indent=" " * len(opening),
                         break_long_words=False, break_on_hyphens=False).replace("\0", " ")
    return f"{head}{docstring(doc, indent + '    ') or ' ...'}\n"


def docstring(doc, indent):
    """The lines of a docstring, after the end of the line before."""
    text = textwrap.indent(inspect.cleandoc(doc or ""), indent).strip()
    return f'\n{indent}"""{text}"""' if text else ""


def bound(found, indent):
    """A function of pybind11's, whose docstring begins with the signature; "" of any other."""
    line, _, doc = (found.__doc__ or "").partition("\n")
    for spelling, plain in SPELLINGS:
        line = re.sub(spelling, plain, line)
    parts = re.fullmatch(r"(\w+)\((?:self: \w+(, |(?=\))))?(.*)", line)
    if parts is None:
        return ""
    name, more, signature = parts.groups()
    if name == "__eq__":  # False of any other object, by pybind11's operators
        signature = "other: object) -> bool"
    return function(name, ("self" + (more or "") if indent else "") + signature, doc, indent)


def member(name, found):
    if isinstance(found, property):
        wanted, _, doc = found.__doc__.partition(": ")
        return "    @property\n" + function(name, f"self) -> {wanted}", doc, "    ")
    if inspect.isfunction(found):  # of the package's own
        signature = str(inspect.signature(found)).replace("'", "")
        return function(name, re.sub(r"^\(\w+: \w+", "self", signature), found.__doc__, "    ")
    hidden = not callable(found) or name in ("__new__", "__repr__", "__reduce__")
    return "" if hidden else bound(found, "    ")


def module_stub(module):
    """Text of the stub of the module `altiplan._altiplan`."""
    text = MODULE
    for name, found in vars(module).items():
        if inspect.isclass(found):
            text += f"\n@final\nclass {name}:{docstring(found.__doc__, '    ')}\n"
            text += "".join(member(each, value) for each, value in vars(found).items())
    return text + "\n" + "".join(bound(found, "") for found in vars(module).values()
                                 if inspect.isbuiltin(found))


def described(program, name):
    """The description of a planner, and the text on each parameter; None where the build has none."""
    plain = {key: value for key, value in os.environ.items() if not key.startswith("ALTIPLAN_")}
    both = [subprocess.run([program, "describe", name, *more], env=plain, cwd="/", check=False,
                           stdout=subprocess.PIPE, text=True) for more in (["--json"], [])]
    if both[0].returncode != 0:
        return None
    about = json.loads(both[0].stdout)
    if isinstance(about, list):  # other kinds have the name, too
        about = next(one for one in about if one["kind"] == "planner")
    text = next((one for one in re.split(r"^(?=\w+ \w+: )", both[1].stdout, flags=re.M)
                 if one.startswith("planner ")), both[1].stdout)
    return about, dict(re.findall(r"^  (\w+)(:.*(?:\n {6}.*)*)", text, re.M))


def parameter(described_one):
    choices = ", ".join(json.dumps(word) for word in described_one["choices"])
    wanted = f"Literal[{choices}]" if choices else TYPES.get(described_one["type"], "Any")
    if described_one["required"]:
        return f"{described_one['key']}: {wanted}"
    default = described_one["default"]
    given = "..." if default is None else json.dumps(default) if isinstance(default, str) else repr(default)
    return f"{described_one['key']}: {wanted} = {given}"


def plans_stub(plan, program, planners):
    """Text of the stub of `plan`, and the planners that this build has not."""
    source = re.search(r"def plan\((.*?)planner: str, (.*?)\*\*parameters", inspect.getsource(plan), re.S)
    before, after = (re.sub(r"\b_(?!Path)", "", " ".join(part.split())) for part in source.groups())
    taken = {one.name for one in inspect.signature(plan).parameters.values()
             if one.kind in (one.POSITIONAL_OR_KEYWORD, one.KEYWORD_ONLY)}
    text, missing, names = PLANS, [], []

    def call(planner, parameters, gives, doc, note=""):
        return f"    @overload{note}\n" + function(
            "__call__", f"self, {before} name: {planner}, {after} {parameters}) -> {gives}", doc, "    ")

    for name in planners:
        found = described(program, name)
        if found is None:
            missing.append(name)
            continue
        about, texts = found
        names.append(json.dumps(name))
        own = [each for each in about["parameters"] if each["key"] not in taken]
        lines = [line for each in own for line in (each["key"] + texts[each["key"]]).splitlines()]
        doc = f"{about['sentence']}\n\n" + "\n".join(
            textwrap.fill(line.strip(), 88, initial_indent=indent, subsequent_indent=indent or "  ")
            for line in lines for indent in [line[:4] if line.startswith(" ") else ""])
        # No value fits the others, but checkers take an unpacked dict of Any for these parameters.
        parameters = ", ".join([*map(parameter, own), "**others: NoReturn"])
        text += call(f"Literal[{names[-1]}]", parameters, "Step", doc)
    # The last is of all other planners. The one before it keeps those above from it: then what is
    # wrong in a call is an error where its result is used.
    text += call(f"Literal[{', '.join(names)}]", "**parameters: Any", "RefusedParameters", "",
                 "  # type: ignore[misc]")
    text += call("str", "**parameters: Any", "Step", plan.__doc__)
    return text + "\ndef typed(plan: Callable[..., Step]) -> Plan: ...\n", missing
