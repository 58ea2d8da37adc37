# SPDX-License-Identifier: Apache-2.0
"""merge_test.py PROGRAM: parts of a study, put together."""
import fcntl
import os
import struct
import sys
import unittest

from case import RUNS, STUDY, StudyCase


class Merge(StudyCase):
    def test_parts_are_the_study(self):
        whole = self.store("whole.db")
        parts = [self.store(f"part-{n}.db", "--shard", f"{n}/3") for n in (1, 2, 3)]
        self.assertTrue(all(self.runs(part) for part in parts))
        out, err = self.call("merge", *parts, "-o", self.path("all.db"))
        self.assertEqual(out, f"{self.path('all.db')}: {RUNS} runs of 3 stores\n")
        self.assertEqual(err, "")
        self.assertEqual(self.runs(self.path("all.db")), self.runs(whole))
        self.assertEqual(len(self.rows(self.path("all.db"), "SELECT * FROM sessions")), 3)
        self.assertEqual(self.rows(self.path("all.db"), "PRAGMA integrity_check"), [("ok",)])
        # Nothing is left to do in it.
        before = self.rows(self.path("all.db"), "SELECT * FROM runs")
        self.call("study", self.study, "--out", self.path("all.db"))
        self.assertEqual(self.rows(self.path("all.db"), "SELECT * FROM runs"), before)

    def test_runs_of_two_parts_are_taken_once(self):
        whole = self.store("whole.db")
        part = self.store("part.db", "--shard", "1/2")
        out, err = self.call("merge", whole, part, "-o", self.path("all.db"))
        self.assertIn(f"{RUNS} runs of 2 stores; {len(self.runs(part))} stored more than once", out)
        self.assertEqual(err, "")
        self.change(part, "UPDATE runs SET outcome = 'failed' WHERE id = 1")
        out, err = self.call("merge", whole, part, "-o", self.path("again.db"))
        self.assertEqual(err.count("has different results"), 1, err)
        self.assertIn("outcome is solved and failed; keeping the first", err)
        self.assertEqual(self.runs(self.path("again.db")), self.runs(whole))

    def test_a_store_may_be_merged_into(self):
        all_of_them = self.store("all.db", "--shard", "1/2")
        part = self.store("part.db", "--shard", "2/2")
        why = self.refused("merge", part, "-o", all_of_them)
        self.assertIn("exists: list it", why)
        self.call("merge", all_of_them, part, "-o", all_of_them)
        self.assertEqual(len(self.runs(all_of_them)), RUNS)

    def test_a_store_that_is_being_written_is_refused(self):
        part = self.store("part.db", "--shard", "1/2")
        other = self.store("other.db", "--shard", "2/2")
        with open(part, "r+b") as file:
            beyond_all_stores = 1 << 62  # as study/store/store_lock.cpp has it
            range_of = struct.pack("hhqqi4x", fcntl.F_WRLCK, os.SEEK_SET, beyond_all_stores, 4712, 0)
            F_OFD_SETLK = 37
            fcntl.fcntl(file, F_OFD_SETLK, range_of)
            why = self.refused("merge", other, part, "-o", self.path("all.db"))
            self.assertIn(f"the database '{part}' is being written by process 4711", why)
        self.assertFalse(os.path.exists(self.path("all.db")))
        self.call("merge", other, part, "-o", self.path("all.db"))

    def test_nothing_of_the_users_is_removed(self):
        part = self.store("all.db.partial", "--shard", "1/2")
        self.write("all.db.partial-notes", "mine")
        self.write("all.db-journal", "what I did today")
        self.assertIn("is not a journal", self.refused("merge", part, "-o", self.path("all.db")))
        os.remove(self.path("all.db-journal"))
        self.call("merge", part, "-o", self.path("all.db"))
        self.assertEqual(self.runs(self.path("all.db")), self.runs(part))
        self.assertEqual(sorted(name for name in os.listdir(self.folder) if "all" in name),
                         ["all.db", "all.db.partial", "all.db.partial-notes"])

    def test_the_journal_of_a_removed_store_is_not_written_into_the_new_one(self):
        part = self.store("part.db")
        self.killed_while_it_writes("part.db", "all.db")
        os.remove(self.path("all.db"))
        self.call("merge", part, "-o", self.path("all.db"))
        self.assertEqual(self.runs(self.path("all.db")), self.runs(part))
        self.assertEqual(self.rows(self.path("all.db"), "PRAGMA integrity_check"), [("ok",)])

    def test_a_link_stays_a_link(self):
        part = self.store("part.db", "--shard", "1/2")
        os.symlink("real.db", self.path("all.db"))
        for stores in [part], [part, self.path("all.db")]:
            self.call("merge", *stores, "-o", self.path("all.db"))
            self.assertEqual(os.readlink(self.path("all.db")), "real.db")
            self.assertEqual(self.runs(self.path("real.db")), self.runs(part))

    def test_other_studies_are_refused(self):
        first = self.store("first.db", "--sample", "0.2")
        self.write("study.yaml", STUDY.replace("repetitions: 2", "repetitions: 3"))
        second = self.store("second.db", "--sample", "0.2")
        why = self.refused("merge", first, second, "-o", self.path("all.db"))
        self.assertTrue(why.endswith("belong to different studies: their files differ: '\"repetitions\": 2' "
                                     "against '\"repetitions\": 3'\n"), why)
        # Comments and blanks say nothing.
        self.write("study.yaml", "# A study\n" + STUDY.replace("seed: 5", "seed:   5"))
        same = self.store("same.db", "--sample", "0.4")
        self.call("merge", first, same, "-o", self.path("all.db"))

    def test_other_builds_are_refused(self):
        first = self.store("first.db", "--sample", "0.2")
        second = self.store("second.db", "--sample", "0.2")
        self.change(second, "UPDATE runs SET key = 'f' || substr(key, 2) || '0' WHERE id = 1")
        self.assertIn("made from different files, plugins or builds",
                      self.refused("merge", first, second, "-o", self.path("all.db")))
        self.assertFalse(os.path.exists(self.path("all.db")))

    def test_files_that_are_no_stores(self):
        good = self.store("good.db", "--sample", "0.1")
        for name, words in self.spoilt().items():
            why = self.refused("merge", good, self.path(name), "-o", self.path("all.db"))
            self.assertIn(name, why)
            if name != "nowhere.db":
                self.assertIn(words, why)
            self.assertEqual([file for file in os.listdir(self.folder) if "all.db" in file], [])
        self.refused("merge", good, "-o", self.path("no/folder/all.db"))
        self.call("merge", good, code=2)


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    unittest.main()
