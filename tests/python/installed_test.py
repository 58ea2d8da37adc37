# SPDX-License-Identifier: Apache-2.0
"""installed_test.py PROGRAM PLUGINS SOURCES: the package works where the build has been installed to."""
import json
import os
import pathlib
import shutil
import subprocess
import sys

import case
from case import PROGRAM, PythonCase

import altiplan


class Installed(PythonCase):
    def test_an_installed_tree(self):
        build = os.path.dirname(os.path.dirname(PROGRAM))
        tree = self.folder / "tree"
        for component in ("program", "library", "python"):
            subprocess.run(["cmake", "--install", build, "--prefix", tree, "--component", component],
                           check=True, stdout=subprocess.DEVNULL)
        path = {**os.environ, "PYTHONPATH": str(tree / "lib/python3/dist-packages")}
        path.pop("LD_LIBRARY_PATH", None)
        text = self.python(
            "import altiplan, sys\n"
            "print(altiplan.__file__, altiplan._altiplan.__file__)\n"
            "print(altiplan.run(sys.argv[1]).status)\n"
            "try:\n"
            "  altiplan.plan(sys.argv[1], 'nothing')\n"
            "except altiplan.Error as error:\n"
            "  print(error)\n"
            "print(*[line.split()[-1] for line in open('/proc/self/maps') if 'altiplan' in line])\n",
            self.pipeline, env=path)
        self.assertIn("solved", text)
        for file in sorted((tree / "share/altiplan/notebooks").iterdir()):
            self.assertTrue(self.cell_that_finds_the_configurations(file).is_dir(), file)
        self.assertRegex(text, rf"searched: {tree}/lib[^ ]*/altiplan/plugins")
        self.assertNotIn(build + "/", text)
        self.new_planner(tree / "bin/altiplan", {**path, "ALTIPLAN_PYTHON": sys.executable})

    def test_without_its_library(self):
        package = os.path.dirname(os.path.abspath(altiplan.__file__))
        shutil.copytree(package, self.folder / "altiplan", ignore=shutil.ignore_patterns("*.so", "__pycache__"))
        done = subprocess.run([sys.executable, "-c", "import altiplan"], cwd=self.folder, capture_output=True, text=True,
                              env={**os.environ, "PYTHONPATH": str(self.folder)})
        self.assertIn("altiplan's library for this Python is not built", done.stderr)

    def cell_that_finds_the_configurations(self, file):
        """The folder that a notebook takes where it lies."""
        lines = [line for cell in json.loads(file.read_text())["cells"] if cell["cell_type"] == "code"
                 for line in "".join(cell["source"]).splitlines()]
        first = next(n for n, line in enumerate(lines) if line.startswith("configs = "))
        names = {"pathlib": pathlib}
        before = os.getcwd()
        os.chdir(file.parent)
        self.addCleanup(os.chdir, before)
        exec("\n".join(lines[first:first + 3]), names)
        return names["configs"].resolve()

    def new_planner(self, program, environment):
        """A planner in Python is written and found by an installed program, without PYTHONPATH."""
        environment.pop("PYTHONPATH")
        for arguments in (["new", "planner", "bends", "--python"],
                          ["run", self.write("p.yaml", self.pipeline.read_text().replace(
                              "astar\n    with: {cell_m: [50, 50, 50]}", "bends")),
                           "--plugin-path", "."]):
            done = subprocess.run([program, *arguments], cwd=self.folder, env=environment, text=True,
                                  capture_output=True)
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)


if __name__ == "__main__":
    case.main()
