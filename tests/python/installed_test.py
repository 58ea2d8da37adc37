# SPDX-License-Identifier: Apache-2.0
"""installed_test.py PROGRAM PLUGINS SOURCES: the package works where the build has been installed to."""
import os
import subprocess

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
        self.assertRegex(text, rf"searched: {tree}/lib[^ ]*/altiplan/plugins")
        self.assertNotIn(build + "/", text)


if __name__ == "__main__":
    case.main()
