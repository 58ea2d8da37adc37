# SPDX-License-Identifier: Apache-2.0
"""libraries_test.py PROGRAM PLUGINS CHECKSUM [CASE…]: damaged, moved and unreadable plugin
libraries. PLUGINS is the folder of the intentionally broken plugins, CHECKSUM is altiplan-checksum."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAM, PLUGINS, CHECKSUM = (os.path.abspath(path) for path in sys.argv[1:4])
PIPELINE = """altiplan: 1
scenario: s.yaml
steps: [{plan: alpha}]
"""
SCENARIO = """altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [100, 100, 100]}
start: {at_m: [5, 5, 50]}
goal: {at_m: [95, 95, 50]}
"""


class Libraries(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="altiplan_libraries_"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.file = self.folder / "plugins/two.so"
        self.file.parent.mkdir()
        shutil.copy(os.path.join(PLUGINS, "two_plugins.so"), self.file)
        (self.folder / "s.yaml").write_text(SCENARIO)
        (self.folder / "p.yaml").write_text(PIPELINE)

    def call(self, *arguments, code):
        done = subprocess.run([PROGRAM, *arguments], cwd=self.folder, text=True, errors="replace",
                              stdin=subprocess.DEVNULL, capture_output=True, timeout=600)
        self.assertEqual(done.returncode, code, (arguments, done.stdout, done.stderr))
        return done

    def listed(self, name="two.so"):
        """The entry of the library in the output of `plugins`."""
        out = self.call("plugins", "--json", "--plugin-path", "plugins", code=0)
        return next(library for library in json.loads(out.stdout)["libraries"]
                    if library["file"].endswith(name))

    def change(self, *commands):
        for command in commands:
            subprocess.run([str(word) for word in command], check=True, cwd=self.folder,
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def run_path(self, cmake):
        text = subprocess.run(["readelf", "-dW", self.file], check=True, text=True,
                              capture_output=True).stdout
        old = text.partition("runpath: [")[2].partition("]")[0]
        (self.folder / "rpath.cmake").write_text(cmake % {"file": self.file, "old": old})
        self.change(["cmake", "-P", "rpath.cmake"])

    def test_a_folder_that_cannot_be_read_is_not_an_empty_one(self):
        os.symlink("loop", self.folder / "loop")
        done = self.call("plugins", "--plugin-path", "loop", code=3)
        self.assertIn("loop: cannot be read: Too many levels of symbolic links", done.stderr)
        self.call("plugins", "--plugin-path", "nowhere", code=0)

    def test_stripped(self):
        before = self.listed()
        self.assertIsNone(before["refused"])
        for strip in (["strip", "-g"], ["strip", "--strip-unneeded", "-R", ".comment"],
                      ["objcopy", "--compress-debug-sections"], ["llvm-strip"], ["strip"]):
            if shutil.which(strip[0]):
                with self.subTest(strip):
                    self.change([*strip, self.file])
                    self.assertEqual(self.listed(), before)

    def test_installed(self):
        before = self.listed()
        self.assertIsNone(before["refused"])
        self.run_path('file(RPATH_CHANGE FILE "%(file)s" OLD_RPATH "%(old)s" NEW_RPATH "/o")')
        self.assertEqual(self.listed(), before)
        self.change(["strip", self.file])
        self.run_path('file(RPATH_REMOVE FILE "%(file)s")')
        self.assertEqual(self.listed(), before)

    def test_damaged(self):
        text = subprocess.run(["readelf", "-SW", self.file], check=True, text=True,
                              capture_output=True).stdout
        address = int(text.partition(" .text ")[2].split()[2], 16)
        whole = bytearray(self.file.read_bytes())
        whole[address + 40] ^= 4
        self.file.write_bytes(whole)
        refused = self.listed()["refused"]
        self.assertRegex(refused, "two.so: damaged: its bytes have the checksum [0-9a-f]{8}, "
                                  "expected [0-9a-f]{8}; build or install it again$")
        for command in (["run", "p.yaml"], ["explain", "p.yaml"]):
            said = self.call(*command, "--plugin-path", "plugins", code=4).stderr
            self.assertIn(refused, said)
            self.assertEqual(said.count("\n"), 1, said)
        said = self.call("check-plugin", str(self.file), code=4)
        self.assertIn("damaged: its bytes have the checksum", said.stdout + said.stderr)
        self.change([CHECKSUM, self.file])  # as after an intentional change
        self.assertIsNone(self.listed()["refused"])

    def test_without_a_checksum(self):
        whole = self.file.read_bytes()
        self.assertEqual(whole.count(b"altiplan checksum\0"), 1)
        self.file.write_bytes(whole.replace(b"altiplan checksum\0", 18 * b"\0"))
        self.assertEqual(self.listed()["refused"], "its checksum was not filled in after "
                         "linking: build it by altiplan_add_plugin")
        said = self.call("run", "p.yaml", "--plugin-path", "plugins", code=4).stderr
        self.assertIn("was not filled in", said)
        self.change(["objcopy", "--rename-section", "altiplan_checksum=other", self.file])
        self.assertIn("has no checksum", self.listed()["refused"])
        done = subprocess.run([CHECKSUM, self.file], capture_output=True, text=True)
        self.assertEqual(done.returncode, 3)
        self.assertIn("has no checksum", done.stderr)

    def test_a_library_beside_it(self):
        """Found by $ORIGIN, which is not the folder of the private copy."""
        for name in ("uses_neighbour.so", "libneighbour.so"):
            shutil.copy(os.path.join(PLUGINS, "neighbours", name), self.file.parent)
        out = self.call("describe", "neighbourly", "--plugin-path", "plugins", code=0).stdout
        self.assertIn("42", out)
        os.remove(self.file.parent / "libneighbour.so")
        self.assertIn("uses_neighbour.so cannot be loaded: libneighbour.so",
                      self.listed("uses_neighbour.so")["refused"])

    def test_in_place(self):
        """For programs that find libraries by their names in /proc/PID/maps."""
        os.environ["ALTIPLAN_PLUGINS_IN_PLACE"] = "1"
        self.addCleanup(os.environ.pop, "ALTIPLAN_PLUGINS_IN_PLACE")
        self.assertIsNone(self.listed()["refused"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[4:], verbosity=2)
