# SPDX-License-Identifier: Apache-2.0
"""overwritten_test.py PROGRAM PLUGINS [CHECKSUM]: a library of plugins that is written over in place
while a study runs. The runs go on with what was loaded, the change is named once, and the next call
runs them again with the new library. CHECKSUM is altiplan-checksum; the other build is made by it."""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time
import unittest

from study_kit import Study, runs

PROGRAM, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:3])
CHECKSUM = os.path.abspath(sys.argv[3])
PIPELINES = {"slow": "{plan: told, within_iterations: 4000, with: {does: uses_budget}}",
             "quick": "{plan: told, with: {does: past, past_m: [500, 500, 700]}}"}
REPETITIONS = 8
CHANGED = "has changed since the study began"
AGAIN = "running again"


def children(process):
    try:
        return pathlib.Path("/proc/%d/task/%d/children" % (process, process)).read_text().split()
    except OSError:
        return []


def write_in_place(library, content):
    """As a slow cp does."""
    with open(library, "wb") as stream:
        stream.flush()
        time.sleep(0.3)
        stream.write(content)


class Overwritten(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="altiplan_study_")
        self.addCleanup(shutil.rmtree, self.folder)
        plugins = os.path.join(self.folder, "plugins")
        os.mkdir(plugins)
        self.library = shutil.copy(os.path.join(PLUGINS, "planners.so"), plugins)
        self.original = pathlib.Path(self.library).read_bytes()
        self.study = Study(PROGRAM, plugins, self.folder, PIPELINES,
                           "repetitions: %d\n" % REPETITIONS)
        self.store = self.study.path("runs.db")

    def other_build(self):
        """Another library with the same build id."""
        self.assertEqual(self.original.count(b"what it does\0"), 1)
        file = self.study.path("other.so")
        pathlib.Path(file).write_bytes(self.original.replace(b"what it does\0", b"what it DOES\0"))
        subprocess.run([CHECKSUM, file], check=True)
        return pathlib.Path(file).read_bytes()

    def run_while(self, change, *more):
        """What the study says; the change is made while its first runs are under way."""
        process = self.study.start(self.store, *more)
        until = time.time() + 60
        while not children(process.pid) and time.time() < until:
            time.sleep(0.01)
        change()
        said = process.communicate(timeout=600)[0].decode(errors="replace")
        self.assertEqual(process.returncode, 0, said)
        self.assertEqual([run[5] for run in runs(self.store)],
                         REPETITIONS * ["solved"] + REPETITIONS * ["timed_out"], said)
        return said

    def test_another_build(self):
        other = self.other_build()
        said = self.run_while(lambda: write_in_place(self.library, other), "--jobs", "2")
        self.assertEqual(said.count(self.library + " " + CHANGED), 1, said)
        before = {run[4] for run in runs(self.store)}
        said = self.study.run(self.store)
        self.assertIn("%d stored runs out of date" % (2 * REPETITIONS), said)
        self.assertIn(AGAIN, said)
        self.assertNotIn(CHANGED, said)
        self.assertFalse(before & {run[4] for run in runs(self.store)})
        self.assertIn(", 0 of them new", self.study.run(self.store))

    def test_the_same_again(self):
        said = self.run_while(lambda: write_in_place(self.library, self.original), "--reuse", "4")
        self.assertLessEqual(said.count(CHANGED), 1, said)  # a look may fall into the writing
        said = self.study.run(self.store)
        self.assertIn(", 0 of them new", said)

    def test_no_library_any_more(self):
        said = self.run_while(lambda: write_in_place(self.library, b"spoilt"))
        self.assertEqual(said.count(CHANGED), 1, said)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
