# SPDX-License-Identifier: Apache-2.0
"""store_test.py PROGRAM: what becomes of the files that a study is told to write to."""
import os
import resource
import shutil
import subprocess
import sys
import time
import unittest
import zlib

from case import RUNS, STUDY, StudyCase


class Stores(StudyCase):
    def test_fresh_removes_stores_alone(self):
        self.write("notes.txt", "years of work")
        os.mkfifo(self.path("pipe"))
        os.symlink("notes.txt", self.path("link"))
        for name, words in {"study.yaml": "not a database", "notes.txt": "not a database",
                            "link": "not a database", "pipe": "a pipe"}.items():
            why = self.refused("study", self.study, "--out", self.path(name), "--fresh")
            self.assertIn(words, why)
            self.assertIn(name, why)
        self.assertEqual(self.read("link"), "years of work")
        self.assertEqual(self.read("study.yaml"), STUDY)
        self.assertTrue(os.path.exists(self.path("pipe")))
        store = self.store("out.db", "--sample", "0.2")
        os.symlink("out.db", self.path("current.db"))
        out, _ = self.call("study", self.study, "--out", self.path("current.db"), "--fresh")
        self.assertIn(f"{RUNS} runs stored, {RUNS} of them new", out)
        self.assertTrue(os.path.islink(self.path("current.db")))
        self.assertEqual(len(self.runs(store)), RUNS)
        self.assertFalse([name for name in os.listdir(self.folder) if name.endswith(".work")])

    def test_what_a_killed_call_had_begun_to_write_is_undone_by_who_reads(self):
        store = self.store("out.db", "--sample", "0.2")
        expected = self.runs(store)
        for arguments in (["report", "hot.db", "-o", self.path("report")],
                          ["compare", store, "hot.db"], ["merge", "hot.db", "-o", "all.db"],
                          ["replay", "hot.db", "1"],
                          ["study", self.study, "--out", "hot.db", "--dry-run"]):
            self.killed_while_it_writes("out.db", "hot.db")
            self.call(*arguments)
            self.assertFalse(os.path.exists(self.path("hot.db-journal")))
            self.assertEqual(self.runs(self.path("hot.db")), expected)

    @unittest.skipUnless(os.geteuid() == 0, "gives up the rights of root")
    def test_who_may_not_undo_it_is_told_why(self):
        self.store("out.db", "--sample", "0.2")
        self.killed_while_it_writes("out.db", "hot.db")
        os.chmod(self.folder, 0o755)
        done = subprocess.run([self.program, "compare", "hot.db", "hot.db"], cwd=self.folder,
                              capture_output=True, text=True, timeout=600, user=65534, group=65534,
                              extra_groups=[])
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn("was killed while writing", done.stderr)
        self.assertTrue(os.path.exists(self.path("hot.db-journal")))

    def test_one_store_by_two_names_is_one(self):
        self.write("study.yaml", STUDY.replace("repetitions: 2", "repetitions: 200"))
        os.symlink("out.db", self.path("link.db"))
        first = subprocess.Popen([self.program, "study", self.study, "--out", self.path("link.db")],
                                 stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        try:
            until = time.monotonic() + 60
            while not (os.path.exists(self.path("out.db.work/lock")) and
                       os.path.getsize(self.path("out.db.work/lock"))):
                self.assertLess(time.monotonic(), until)
                time.sleep(0.01)
            for arguments in (["study", self.study, "--out", self.path("out.db")],
                              ["study", self.study, "--out", self.path("out.db"), "--fresh"]):
                self.assertIn(f"in use by another process: {first.pid}",
                              self.refused(*arguments))
            while not self.has_runs("out.db"):
                self.assertLess(time.monotonic(), until)
                time.sleep(0.01)
            self.assertIn(f"in use by another process: {first.pid}", self.refused(
                "merge", self.path("out.db"), "-o", self.path("out.db")))
            self.assertIsNone(first.poll(), "it should be at work still")
        finally:
            first.terminate()
            first.wait()
        self.assertFalse(os.path.exists(self.path("link.db.work")))

    def has_runs(self, name):
        return os.path.exists(self.path(name)) and os.path.getsize(self.path(name)) > 0

    def test_every_name_is_that_of_a_file(self):
        for name in ":memory:", "file:x.db?mode=memory":
            self.call("study", self.study, "--out", name, "--sample", "0.2")
            self.assertTrue(self.runs(self.path(name)))

    def test_limits_of_the_system_are_named(self):
        store = self.store("out.db")

        def limited(limit, most, *arguments):
            done = subprocess.run(
                [self.program, *arguments], cwd=self.folder, capture_output=True, text=True,
                timeout=600, preexec_fn=lambda: resource.setrlimit(limit, (most, most)))
            self.assertEqual(done.returncode, 3, (done.stdout, done.stderr))
            return done.stderr

        for arguments in ["study", self.study, "--out", "new.db"], ["merge", store, "-o", "all.db"]:
            self.assertIn("File too large", limited(resource.RLIMIT_FSIZE, 10240, *arguments))
            if not os.environ.get("ALTIPLAN_SANITIZED"):  # it opens files of its own
                self.assertIn("Too many open files", limited(resource.RLIMIT_NOFILE, 5, *arguments))
        self.assertFalse(os.path.exists(self.path("all.db")))
        self.assertFalse([name for name in os.listdir(self.folder) if name.startswith(".altiplan")])
        self.assertIn("File name too long",
                      self.refused("study", self.study, "--out", 250 * "x" + ".db"))

    def test_a_bomb_is_no_result(self):
        store = self.store("out.db", "--sample", "0.2")
        packer = zlib.compressobj(9, wbits=-15)
        block = packer.compress(bytes(1 << 24)) + packer.flush(zlib.Z_FULL_FLUSH)  # may be repeated
        bomb = b"\x78\xda" + 65 * block + packer.flush()
        self.change(store, "UPDATE results SET result = ?", bomb)
        why = self.refused("replay", store, "1", "--stored")
        self.assertIn("larger than 1 GB unpacked", why)
        self.assertIn("out.db", why)
        self.assertIn("#", why)

    def test_planner_arena_replaces_databases_alone(self):
        store = self.store("out.db", "--sample", "0.2")
        shutil.copy(store, self.path("precious.db"))
        for name, words in {"study.yaml": "not a database", "precious.db": "of altiplan study"}.items():
            self.assertIn(words, self.refused("report", store, "--arena", self.path(name)))
        self.assertEqual(self.read("study.yaml"), STUDY)
        self.write("arena.db.partial", "mine")
        for _ in range(2):
            self.call("report", store, "--arena", self.path("arena.db"))
        self.assertEqual(self.read("arena.db.partial"), "mine")

    def test_what_is_no_finite_number_is_refused(self):
        store = self.store("out.db", "--sample", "0.2")
        for number in "nan", "inf", "-nan", "", "1x":
            self.call("compare", store, store, "--gate", "--tolerance", number, code=2)
            for option in "--chunk-minutes", "--sample":
                self.call("slurm", self.study, "--out", self.path("s.db"), "--dry-run", option,
                          number, code=2)

    def test_options_of_sbatch_after_a_plugin_path(self):
        out, _ = self.call("slurm", self.study, "--out", self.path("s.db"), "--dry-run",
                           "--plugin-path", self.folder, "--", "--account=a", "--qos=b")
        self.assertIn("--account=a --qos=b", out)


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
