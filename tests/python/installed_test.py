# SPDX-License-Identifier: Apache-2.0
"""installed_test.py PROGRAM PLUGINS SOURCES: the package works where the build has been installed to."""
import os
import subprocess
import sys

import case
from case import PROGRAM, PythonCase


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
        self.assertTrue((tree / "share/altiplan/notebooks/study.ipynb").is_file())
        self.assertRegex(text, rf"searched: {tree}/lib[^ ]*/altiplan/plugins")
        self.assertNotIn(build + "/", text)
        self.new_planner(tree / "bin/altiplan", {**path, "ALTIPLAN_PYTHON": sys.executable})

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
