# SPDX-License-Identifier: Apache-2.0
"""stubs_test.py PROGRAM PLUGINS SOURCES: the stubs of the package are those that the C++ declares. With
ALTIPLAN_UPDATE=1 the test writes them."""
import os
import sys
import unittest

import case
from case import PROGRAM, SOURCES

import altiplan

sys.path.append(str(SOURCES / "framework/python"))  # behind the built package
import stubs  # noqa: E402

PACKAGE = SOURCES / "framework/python/altiplan"
MENDS = "ALTIPLAN_UPDATE=1 ctest --test-dir build/release -R python_stubs"
PLANNERS = [file.parent.name for kind in ("planner", "local_planner")
            for file in sorted((SOURCES / "plugins" / kind).glob("*/CMakeLists.txt"))]


class Stubs(unittest.TestCase):
    def up_to_date(self, name, text):
        if os.environ.get("ALTIPLAN_UPDATE") == "1":
            (PACKAGE / name).write_text(text)
        if (PACKAGE / name).read_text() != text:
            self.fail(f"{name}: out of date; {MENDS} mends it")

    def test_the_module(self):
        self.up_to_date("_altiplan.pyi", stubs.module_stub(altiplan._altiplan))

    def test_the_planners(self):
        text, missing = stubs.plans_stub(altiplan.plan, PROGRAM, PLANNERS)
        if missing:
            self.skipTest(f"this build has no {', '.join(missing)}")
        self.up_to_date("_plans.pyi", text)


if __name__ == "__main__":
    case.main()
