# SPDX-License-Identifier: Apache-2.0
"""sanitized_test.py LIBRARIES LIST: what sanitized.py reports of a process, and what it leaves out."""
import os
import pathlib
import subprocess
import sys
import unittest

import sanitized

LIBRARIES, LIST = sys.argv[1:3]
C = "import ctypes; c = ctypes.CDLL(None); c.malloc.restype = ctypes.c_void_p\n"
LEAK = "Direct leak of 8 byte(s) in 1 object(s) allocated from:\n" + "".join(
    f"    #{i} in some_function(int) <null> ({{{i}}})\n" for i in range(4))
MALLOC, PYTHON, OURS = "/lib/libasan.so", "/bin/python3.11", "/build/_altiplan.cpython-311.so"


class Processes(unittest.TestCase):
    def ends(self, code, expected, says=""):
        """A script in a process ends with this code, and the report says this."""
        done = subprocess.run(
            [sys.executable, sanitized.__file__, LIBRARIES, LIST, "/usr/bin/python3", "-c", code], text=True,
            capture_output=True, check=False,
            env={**os.environ, "ASAN_OPTIONS": "detect_leaks=1", "ALTIPLAN_WHOLE_STACKS": "1"})
        self.assertEqual(done.returncode, expected, done.stdout + done.stderr)
        self.assertIn(says, done.stdout)

    def test_nothing(self):
        self.ends("import numpy, sys", 0)
        self.ends("import numpy, sys; sys.exit(3)", 3)

    def test_a_leak(self):
        self.ends(C + "c.malloc(1234)", 1, "Direct leak of 1234 byte(s)")

    def test_an_error(self):
        code = C + "p = c.malloc(99); c.free(ctypes.c_void_p(p)); ctypes.string_at(p, 9)"
        self.ends(code, 134, "heap-use-after-free")

    def test_a_leak_of_a_child(self):
        self.ends("import subprocess, sys\n"
                  f"subprocess.run([sys.executable, '-c', {C + 'c.malloc(1234)'!r}], check=True)", 1,
                  "Direct leak of 1234 byte(s)")


class Stacks(unittest.TestCase):
    def test_who_asks(self):
        known = sanitized.names(pathlib.Path(LIST))
        for modules, expected in (((MALLOC, PYTHON, PYTHON, PYTHON), True),
                                  ((MALLOC, "/dist-packages/numpy/core/a.so", PYTHON, PYTHON), True),
                                  ((MALLOC, PYTHON, OURS, PYTHON), False),
                                  ((MALLOC, OURS, PYTHON, PYTHON), False),
                                  ((MALLOC, PYTHON, "/build/lib/libaltiplan.so.3", PYTHON), False),
                                  ((MALLOC, PYTHON, "/plugins/libaltiplan_planner_astar.so", PYTHON), False),
                                  ((MALLOC, "/lib/libgdal.so", PYTHON, PYTHON), False)):
            self.assertEqual(sanitized.is_known(LEAK.format(*modules), known), expected, modules)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
