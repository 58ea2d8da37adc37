# SPDX-License-Identifier: Apache-2.0
"""bad_commands_test.py PROGRAM SOURCES: every wrong call of commands.tsv, beside valid files."""
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
FILES = pathlib.Path(SOURCES) / "tests/bad_files"


def rows():
    for line in (FILES / "commands.tsv").read_text().splitlines():
        if line and not line.startswith("#"):
            yield line.split("\t")


class BadCommands(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        for file in FILES.iterdir():
            shutil.copy(file, self.folder)
        (self.folder / "results").mkdir()
        (self.folder / "result.json").write_text("{}")

    def call(self, arguments):
        done = subprocess.run([PROGRAM, *shlex.split(arguments)], cwd=self.folder, text=True,
                              capture_output=True, timeout=600, check=False)
        return done.returncode, done.stdout, done.stderr

    def test_the_files_are_valid(self):
        code, _, err = self.call("validate --build pipeline.yaml study.yaml")
        self.assertEqual(code, 0, err)

    def test_every_wrong_call_is_told_in_one_sentence(self):
        before = sorted(self.folder.rglob("*"))
        for arguments, code, message in rows():
            with self.subTest(arguments):
                found, out, err = self.call(arguments)
                self.assertEqual(found, int(code), err)
                self.assertIn(message, err or out)  # a route that was not found is an answer
                self.assertEqual(sorted(self.folder.rglob("*")), before, "something was written")


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
