# SPDX-License-Identifier: Apache-2.0
"""notebooks_test.py PROGRAM PLUGINS SOURCES: the notebooks run from their first cell to their last, as in
Jupyter, and hold no outputs."""
import ast
import contextlib
import io
import json
import os

import case
from case import SOURCES, PythonCase

FOLDER = SOURCES / "framework/python/notebooks"


def shown(cell, names):
    """Runs a cell; the value of its last expression, as Jupyter shows it."""
    tree = ast.parse(cell)
    last = tree.body.pop() if isinstance(tree.body[-1], ast.Expr) else None
    exec(compile(tree, "cell", "exec"), names)
    if last is None:
        return None
    value = eval(compile(ast.Expression(last.value), "cell", "eval"), names)
    return value._repr_html_() if hasattr(value, "_repr_html_") else repr(value)


class Notebooks(PythonCase):
    def cells(self, name):
        notebook = json.loads((FOLDER / f"{name}.ipynb").read_text(encoding="utf-8"))
        self.assertEqual(notebook["nbformat"], 4)
        return [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]

    def run_all(self, name):
        """What each cell shows, and what it prints."""
        names = {"__name__": "__main__"}
        before = os.getcwd()
        os.chdir(FOLDER)
        self.addCleanup(os.chdir, before)
        found = []
        for cell in self.cells(name):
            text = "".join(cell["source"])
            with self.subTest(cell=text), contextlib.redirect_stdout(io.StringIO()) as printed:
                found.append((shown(text, names), printed.getvalue()))
        return found

    def setUp(self):
        super().setUp()
        try:
            import matplotlib
            import pandas  # noqa: F401
        except ImportError as error:
            self.skipTest(str(error))
        matplotlib.use("Agg")

    def test_all_are_tested_and_hold_no_outputs(self):
        names = {file.stem for file in FOLDER.glob("*.ipynb")}
        self.assertEqual({f"test_{name}" for name in names} - set(dir(self)), set())
        for name in names:
            for cell in self.cells(name):
                self.assertEqual((cell["outputs"], cell["execution_count"]), ([], None))

    def test_route(self):
        found = self.run_all("route")
        self.assertIn("<iframe", found[1][0])
        self.assertIn("accepted: True", found[2][1])
        self.assertIn("m above the ground", "".join(printed for _, printed in found))

    def test_planner(self):
        found = self.run_all("planner")
        self.assertRegex(found[1][1], "^solved True [0-9]+ m")
        self.assertIn("step_m: expected more than 0 m, found -1", found[2][1])
        self.assertRegex(found[3][1], "my_tree +solved [0-9]+ m")

    def test_study(self):
        found = self.run_all("study")
        self.assertIn("<iframe", found[0][0])
        self.assertIn("greedy_expands_less", found[1][0])
        self.assertIn("octile", found[2][0])


if __name__ == "__main__":
    case.main()
