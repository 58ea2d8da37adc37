# SPDX-License-Identifier: Apache-2.0
"""replay_test.py PROGRAM PLUGINS: one run of a study again. PLUGINS is the folder of plugins that
misbehave."""
import json
import os
import sqlite3
import sys
import unittest
import zlib

from case import PIPELINE, SCENARIO, STUDY, StudyCase

PLUGINS = None


class Replay(StudyCase):
    def stored(self, store, run):
        (packed,), = self.rows(store, "SELECT result FROM results WHERE run = ?", run)
        return zlib.decompress(packed).decode()

    def store_result(self, store, run, text):
        self.change(store, "UPDATE results SET result = ? WHERE run = ?",
                    sqlite3.Binary(zlib.compress(text.encode())), run)

    def test_every_run_is_identical(self):
        store = self.store("study.db", "--jobs", "2")
        for name in self.runs(store):
            out, err = self.call("replay", store, name)
            self.assertEqual(out, f"{name}: identical to the stored run: solved\n")
            self.assertEqual(err, "")

    def test_a_run_has_three_names(self):
        store = self.store("study.db", "--sample", "0.4")
        (run, key), = self.rows(store, "SELECT id, key FROM runs ORDER BY id DESC LIMIT 1")
        said = {self.call("replay", store, name)[0] for name in (run, key, key[:12])}
        self.assertEqual(len(said), 1)
        for name in ("octile city #0", key[:3], "999", "octile city[seed=1] #7"):
            why = self.refused("replay", store, name)
            self.assertIn("expected its id, its key or a prefix of it", why)
        self.assertIn("city[seed=", why)

    def test_results_are_written(self):
        store = self.store("study.db", "--sample", "0.1")
        out, trace, stored = self.path("out.json"), self.path("trace.jsonl"), self.path("old.json")
        self.call("replay", store, 1, "--out", out, "--trace", trace)
        self.call("replay", store, 1, "--stored", "--out", stored)
        self.assertEqual(self.read("old.json"), self.stored(store, 1))
        self.assertEqual(self.call("replay", store, 1, "--stored")[0], self.stored(store, 1))
        self.assertEqual(json.loads(self.read("out.json"))["route"],
                         json.loads(self.read("old.json"))["route"])
        self.assertTrue(self.read("trace.jsonl"))
        # What was stored serves like any result.
        self.call("check", stored)
        self.call("view", stored, "-o", self.path("page.html"))
        self.call("export", stored, "--to", "csv", "-o", self.path("route.csv"))
        self.assertIn("without a trace",
                      self.refused("replay", store, 1, "--stored", "--out", stored, "--trace",
                                   self.path("t.jsonl")))

    def test_a_difference_is_named(self):
        store = self.store("study.db", "--sample", "0.1")
        result = json.loads(self.stored(store, 1))
        length = result["steps"][0]["metrics"]["length_m"]
        result["steps"][0]["metrics"]["length_m"] = length + 2e-13 * length
        self.store_result(store, 1, json.dumps(result))
        out, err = self.call("replay", store, 1, code=1)
        self.assertRegex(out, r"differs from the stored run at steps\.0\.metrics\.length_m: it was "
                              r"[0-9.]+ and is [0-9.]+\n")
        self.assertEqual(err, "")

    def test_what_has_changed_is_named(self):
        store = self.store("study.db", "--sample", "0.1")
        # The same world in other words.
        self.write("city.yaml", "# another comment\n" + SCENARIO)
        out, err = self.call("replay", store, 1)
        self.assertIn("identical to the stored run", out)
        self.assertIn(f"'{self.path('city.yaml')}' has changed since", err)
        self.write("city.yaml", SCENARIO.replace("645", "635"))
        out, err = self.call("replay", store, 1, code=1)
        self.assertIn("differs from the stored run at ", out)
        self.assertIn("possible cause: the changes reported above", out)
        self.write("city.yaml", SCENARIO)
        result = json.loads(self.stored(store, 1))
        result["plugins"][0]["build"] = "0" * 40
        result["version"] = "0.0.7"
        self.store_result(store, 1, json.dumps(result))
        out, err = self.call("replay", store, 1)
        self.assertIn("has been rebuilt since", err)
        self.assertIn("the stored run was made by 0.0.7", err.replace("altiplan 0.0.7", "0.0.7"))
        os.remove(self.path("astar.yaml"))
        self.assertIn("astar.yaml", self.refused("replay", store, 1))

    def test_another_build_of_the_program_is_named(self):
        store = self.store("study.db", "--filter", "octile city.seed=1. #0")
        self.change(store, "UPDATE runs SET key = '0123456789' || substr(key, 11)")
        out, err = self.call("replay", store, "0123456789")
        self.assertIn("identical to the stored run", out)
        self.assertIn("the program is another build than that of the stored run", err)

    @unittest.skipIf(os.environ.get("ALTIPLAN_SANITIZED"), "a sanitizer ends the process its way")
    def test_a_crash_happens_again(self):
        self.write("rogue.yaml", PIPELINE.split("  - plan")[0] + "  - plan: rogue\n    id: route\n"
                                                                 "    with: {does: segfaults}\n")
        self.write("study.yaml", STUDY.split("scenarios:")[0] +
                   "scenarios:\n  - {file: city.yaml}\npipelines:\n  - {id: rogue, file: "
                   "rogue.yaml}\n")
        store = self.store("study.db", "--plugin-path", PLUGINS)
        self.assertEqual(self.rows(store, "SELECT outcome FROM runs"), [("crashed",)])
        _, err = self.call("replay", store, 1, "--plugin-path", PLUGINS)
        self.assertIn("rogue city #0: crashed, as the stored run did", err)
        self.call("replay", store, 1, "--plugin-path", PLUGINS, "--out", self.path("out.json"))
        self.assertEqual(json.loads(self.read("out.json"))["message"],
                         json.loads(self.stored(store, 1))["message"])
        self.change(store, "UPDATE results SET result = x''")
        self.assertIn("has no result: crashed", self.refused("replay", store, 1, "--stored"))
        self.change(store, "UPDATE runs SET outcome = 'timed_out'")
        _, err = self.call("replay", store, 1, "--plugin-path", PLUGINS, code=1)
        self.assertIn("crashed, unlike the stored run: timed_out", err)

    def test_files_that_are_no_stores(self):
        for name, words in self.spoilt().items():
            why = self.refused("replay", self.path(name), "octile city[seed=1] #0")
            self.assertIn(name, why)
            if name != "nowhere.db":
                self.assertIn(words, why)


if __name__ == "__main__":
    StudyCase.program = os.path.abspath(sys.argv.pop(1))
    PLUGINS = os.path.abspath(sys.argv.pop(1))
    unittest.main()
