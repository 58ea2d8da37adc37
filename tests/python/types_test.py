# SPDX-License-Identifier: Apache-2.0
"""types_test.py PROGRAM PLUGINS SOURCES: the types that are declared are those of the values, and mypy
agrees with the package and with a user's code. Exits with 77 where there is no mypy."""
import ast
import os
import re
import shutil
import subprocess
import sys
import typing
import unittest

import case
import numpy
import numpy.typing
from case import PIPELINES, SANITIZED, SOURCES, UNHURRIED, PythonCase

import altiplan

PACKAGE = SOURCES / "framework/python/altiplan"
SAMPLE = SOURCES / "tests/python/typed_sample.py"
SAMPLE_WORLD = (305, 500, 100)  # in the wall


@unittest.skipIf(SANITIZED, "runs nothing of altiplan")
class Mypy(PythonCase):
    def mypy(self, *files):
        """What it prints, with notes of errors alone, and its exit code."""
        done = subprocess.run(
            ["mypy", "--config-file", SOURCES / "framework/python/mypy.ini", "--cache-dir", self.folder,
             "--python-executable", "/usr/bin/python3", "--no-error-summary", *files],
            capture_output=True, text=True, check=False,
            env={**os.environ, "MYPYPATH": str(PACKAGE.parent)})
        return done.stdout + done.stderr, done.returncode

    def test_the_package(self):
        self.assertEqual(self.mypy(PACKAGE), ("", 0))

    def test_a_users_code(self):
        found, code = self.mypy(SAMPLE)
        self.assertEqual(code, 1, found)
        lines = {int(line) for line in re.findall(rf"^\S*{SAMPLE.name}:(\d+): error", found, re.MULTILINE)}
        refused = {number for number, line in enumerate(SAMPLE.read_text().splitlines(), 1)
                   if "  # refused" in line}
        self.assertEqual(lines, refused, found)


class Values(PythonCase):
    """Each attribute of each object has the type that the stub declares."""

    def setUp(self):
        super().setUp()
        tree = ast.parse((PACKAGE / "_altiplan.pyi").read_text())
        self.classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        self.names = {**vars(typing), **vars(numpy.typing), **vars(altiplan), "float64": numpy.float64}
        self.seen = set()

    def declared(self, name):
        """The types of the properties of a class."""
        return {each.name: eval(ast.unparse(each.returns), self.names)  # of our own stub
                for each in self.classes[name].body
                if isinstance(each, ast.FunctionDef) and each.decorator_list}

    def has_type(self, value, wanted):
        origin, of = typing.get_origin(wanted), typing.get_args(wanted)
        if wanted is typing.Any:
            return True
        if origin is typing.Union:
            return any(self.has_type(value, each) for each in of)
        if origin is list:
            return type(value) is list and all(self.has_type(each, of[0]) for each in value)
        if origin is dict:
            return type(value) is dict and all(
                self.has_type(key, of[0]) and self.has_type(each, of[1])
                for key, each in value.items())
        if wanted is float:  # as mypy has it
            return type(value) in (int, float)
        if origin is numpy.ndarray:
            return isinstance(value, origin) and value.dtype == numpy.float64
        return type(value) is wanted

    def walk(self, value):
        for each in value if isinstance(value, list) else []:
            self.walk(each)
        name = type(value).__name__
        if name not in self.classes:
            return
        for attribute, wanted in self.declared(name).items():
            found = getattr(value, attribute)
            self.assertTrue(self.has_type(found, wanted), f"{name}.{attribute}: {found!r}, not {wanted}")
            if found is not None:
                self.seen.add(f"{name}.{attribute}")
            self.walk(found)

    def test_as_declared(self):
        self.walk(altiplan.run(self.pipeline, set={"scenario.goal.at_m": SAMPLE_WORLD}))
        self.walk(altiplan.run(self.pipeline, out=self.folder / "r.json"))
        self.walk(altiplan.run(self.pipeline, set={"scenario.vehicle.energy": {"power_w": 300}}))
        for name in ("ridge_crossing", "wing_ridge", "among_movers"):
            self.walk(altiplan.run(PIPELINES / f"{name}.yaml", set=UNHURRIED))
        self.walk(altiplan.World(self.scenario))
        self.walk(altiplan.check([[0, 0, 0], SAMPLE_WORLD, [900, 500, 100]], self.scenario))
        every = {f"{name}.{attribute}" for name in self.classes for attribute in self.declared(name)}
        never = every - self.seen - {"Flight.link", "Flight.reason", "Step.instead_of", "Leg.drift_m",
                                     "Metrics.min_radius_m"}
        self.assertEqual(never, set())


if __name__ == "__main__":
    if shutil.which("mypy") is None:
        print("skipped: no mypy (tools/setup test)")
        sys.exit(77)
    case.main()
