# SPDX-License-Identifier: Apache-2.0
"""planner_misuse_test.py PROGRAM PLUGINS SOURCES: a planner in Python that misbehaves ends its step, and
nothing else: the result is whole, and no process is left."""
import json
import os
import signal
import subprocess
import time
import unittest

from case import HANGS_S, NIGHTLY, PROGRAM, SANITIZED, by_day
from script_case import AROUND, STEP, ScriptCase, main

FAILS = {  # what plan does: what the result says, and its reason
    "raise ValueError('the attic is on fire')":
        ("threw: ValueError: the attic is on fire (tested.py:13)", "threw"),
    "import nothing_at_all":
        ("threw: ModuleNotFoundError: No module named 'nothing_at_all' (tested.py:13)", "threw"),
    "import sys; sys.exit(3)": ("ended the process by sys.exit(3) (tested.py:13)", "process_ended"),
    "import os; os._exit(3)": ("ended its process with exit code 3", "process_ended"),
    "import ctypes; ctypes.string_at(0)": ("crashed (SIGSEGV)", "process_ended"),
    "import os; os.abort()": ("crashed (SIGABRT)", "process_ended"),
    "import os; os.kill(os.getpid(), 9)": ("crashed (SIGKILL)", "process_ended"),
    "import os; os.kill(os.getppid(), 9)\nwhile True: pass": ("", "process_ended"),
    "import os; os.kill(0, 9)": ("", "process_ended"),
    "import os; os.closerange(0, 100)": ("ended its process with exit code", "process_ended"),
    "import os; os.write(3, b'\\xff' * 100)": ("writes to the descriptor", "process_changed"),
    "raise MemoryError()": ("threw: MemoryError", "out_of_memory"),
    "def f(): return f()\nf()": ("threw: RecursionError", "threw"),
    "raise ValueError('\\udcff' + 'x' * 10**7)": ("threw: ValueError: ?xxx", "threw"),
    "return 3": ("threw: TypeError", "threw"),
    "return 'points'": ("threw: ", "threw"),
    "return [[1, 2], [3, 4]]":
        ("threw: ValueError: the returned route: expected points of 3 numbers, found 2", "threw"),
    "return [request.start, (float('nan'), 0, 0), request.goal]":
        ("a coordinate that is not finite", "contract"),
    "return []": ("reports solved but returns no route", "contract"),
    "return [request.goal, request.goal]": ("does not begin at the start", "contract_of_ends"),
    "return [request.start, request.start]": ("m from the goal, outside its tolerance",
                                              "contract_of_ends"),
    "return [request.start, request.goal], {'expanded': 'many'}": ("threw: TypeError: the counter 'expanded': expected a whole number", "threw"),
    "return request.world.clearance([(1, 2)])": ("threw: ValueError", "threw"),
    "while True: pass": ("did not stop within half a second", "never_stopped"),
    "import signal, time\n"
    "for one in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP, signal.SIGALRM):\n"
    "    signal.signal(one, signal.SIG_IGN)\n"
    "while True: time.sleep(10)": ("did not stop within half a second", "never_stopped"),
    "import os, time\nos.setsid() if os.getpid() != os.getpgid(0) else None\n"
    "while True: time.sleep(10)": ("did not stop within half a second", "never_stopped"),
    "import os\nos.closerange(0, 100)\nwhile True: pass":
        ("did not stop within half a second", "never_stopped"),
    "import os, time\nos.fork()\nwhile True: time.sleep(1)":
        ("did not stop within half a second", "never_stopped"),
    "while True:\n    request.world.clearance([request.start])":
        ("did not stop within half a second", "never_stopped"),
}
BEGINS = "open('begun', 'w').close()\n"


class Fails(ScriptCase):
    def test_every_fault(self):
        one_of_each = {reason: body for body, (_, reason) in FAILS.items()}.values()
        for body in FAILS if NIGHTLY else one_of_each:
            says, reason = FAILS[body]
            with self.subTest(body=body):
                pipeline = self.planner(body)
                result, _ = self.result(pipeline, "--set", "steps.0.within_s=0.5", code=4)
                step = result["steps"][0]
                self.assertEqual((step["status"], step["reason"]), ("failed", reason), step)
                self.assertIn(says, step["message"])
                self.assertEqual(self.workers(), [])

    def test_the_next_step_runs(self):
        self.planner("import ctypes; ctypes.string_at(0)")
        pipeline = self.write("p.yaml", STEP.format(
            step="{plan: tested, else: [{plan: astar, with: {cell_m: [50, 50, 50]}}]}"))
        result, said = self.result(pipeline)
        self.assertEqual([step["status"] for step in result["steps"]], ["failed", "solved"])
        self.assertIn("Segmentation fault", said)  # where in Python it was

    def test_a_constructor(self):
        for code, says in (("raise ValueError('no attic')", "threw: ValueError: no attic (tested.py:10)"),
                           ("import os; os._exit(3)", "ended its process with exit code 3")):
            pipeline = self.planner(f"return {AROUND}")
            text = (self.folder / "tested.py").read_text()
            self.write("tested.py", text.replace("self.params = params", code))
            done = self.altiplan("run", pipeline, code=4)
            self.assertIn("the planner 'tested' (steps.0)", done.stderr)
            self.assertIn(says, done.stderr)

    def test_a_constructor_that_never_returns(self):
        pipeline = self.planner(f"return {AROUND}")
        text = (self.folder / "tested.py").read_text()
        self.write("tested.py", text.replace("self.params = params", "while True: pass"))
        result, _ = self.result(pipeline, "--timeout", "0.5", code=4)
        self.assertIn("the planner 'tested' (steps.0): its constructor did not stop",
                      result["message"])
        self.expect_no_workers()

    def test_a_route_that_the_judge_rejects(self):
        result, _ = self.result(self.planner("return [request.start, request.goal]"), code=1)
        self.assertEqual(result["steps"][0]["status"], "rejected")
        self.assertIn("wall", result["steps"][0]["message"])


class Files(ScriptCase):
    def test_files_that_do_not_run(self):
        for name, head, says in (
                ("syntax", "x = (\n", "threw: SyntaxError: "),
                ("missing", "import nothing_at_all\n",
                 "threw: ModuleNotFoundError: No module named 'nothing_at_all' (missing.py:1)"),
                ("exits", "import os\nos._exit(7)\n", "ended its process with exit code 7"),
                ("crashes", "import ctypes\nctypes.string_at(0)\n", "crashed (SIGSEGV)")):
            self.planner("return None", name=name, head=head)
            listed = self.altiplan("plugins").stdout
            self.assertRegex(listed, f"refused: .*/{name}.py: ")
            self.assertIn(says, listed)
            self.assertNotRegex(listed, rf"(?m)^planner +{name} ")
            os.remove(self.folder / f"{name}.py")

    def test_what_the_text_announces(self):
        for text, says in by_day((
                ("NAME = 'a'\n@altiplan.planner(NAME, 'what')\nclass A: pass\n", "line 2: expected"),
                ("@altiplan.planner('A-b', 'what')\nclass A: pass\n", "line 1: offers a planner named"),
                ("@altiplan.planner('a', '" + "x" * 300 + "')\nclass A: pass\n", "has 300 bytes"),
                ("@altiplan.planner('a')\nclass A: pass\n", "line 1: expected"),
                ("'''\n@altiplan.planner('a', 'what')\n'''\n", "does not contain it"),
                ("import altiplan\n@altiplan.planner('astar', 'what')\nclass A: pass\n", "remove one")), 2, 1):
            self.write("a.py", text)
            self.assertIn(says, self.altiplan("plugins").stdout)
        self.write("a.py", "import os\nos.abort()\n")  # not a plugin, and none of its code runs
        self.assertNotIn("a.py", self.altiplan("plugins").stdout)

    def test_declarations(self):
        for parameters, says in by_day((("a: set = altiplan.parameter(None, doc='x')", "the parameter a: is of type"),
                                        ("a: int = altiplan.parameter(None, doc='x')", "None by default"),
                                        ("a: int = altiplan.parameter(1.5, doc='x')", "a default of type integer"),
                                        ("a: int = altiplan.parameter(2**70, doc='x')", "a default of 64 bits"),
                                        ("a: float = altiplan.parameter(1.0, above=5, doc='x')", "its bounds"),
                                        ("a: float = altiplan.parameter(float('inf'), doc='x')", "finite"),
                                        ("a: str = altiplan.parameter('b', choices=['c'], doc='x')", "among c"),
                                        ("a: int = altiplan.parameter(1, doc=5)", "expected texts, found 5"),
                                        ("aB: int = altiplan.parameter(1, doc='x')", "named 'aB'")), 2):
            self.planner("return None", parameters=parameters)
            self.assertIn(says, self.altiplan("plugins").stdout)

    def test_an_interpreter_that_is_none(self):
        self.planner("return None")
        self.environment["ALTIPLAN_PYTHON"] = "/no/python3"
        self.assertIn("ALTIPLAN_PYTHON is '/no/python3'", self.altiplan("plugins").stdout)
        self.environment["ALTIPLAN_PYTHON"] = "/bin/false"
        self.assertIn("tested.py: ", self.altiplan("describe", "tested", code=4).stderr)


class Surroundings(ScriptCase):
    def test_output_is_not_the_result(self):
        result, said = self.result(self.planner(
            "import os, sys\nprint('to stdout', flush=True)\nprint('to stderr', file=sys.stderr)\n"
            f"os.write(1, b'to descriptor 1')\nos.system('echo from a shell')\nreturn {AROUND}"))
        self.assertEqual(result["status"], "solved")
        for words in ("to stdout", "to stderr", "to descriptor 1", "from a shell"):
            self.assertIn(words, said)

    def test_children_are_ended(self):
        result, _ = self.result(self.planner(
            "import os, time\nif os.fork() == 0: time.sleep(1000)\n"
            "if os.fork() == 0: raise ValueError('a child has nothing to say')\ntime.sleep(0.5)\n"
            f"return {AROUND}"))
        self.assertEqual(result["status"], "solved")
        self.assertEqual(self.workers(), [])

    @unittest.skipIf(SANITIZED, "limits of memory")
    def test_memory(self):
        self.planner("kept = []\nwhile True: kept.append(bytearray(1 << 20))")
        pipeline = self.write("p.yaml", STEP.format(step="{plan: tested, within_mb: 40}"))
        result, _ = self.result(pipeline, code=4)
        self.assertIn("used more memory than its within_mb", result["steps"][0]["message"])
        self.planner("kept = []\nwhile not request.budget.spent(): kept.append(bytearray(1 << 16))")
        result, _ = self.result(pipeline, code=1)
        self.assertEqual((result["steps"][0]["status"], result["steps"][0]["reason"]),
                         ("timed_out", "memory"))

    def wait_for_begin(self):
        """Returns when a plan with BEGINS runs."""
        until = time.monotonic() + HANGS_S
        while not (self.folder / "begun").exists() and time.monotonic() < until:
            time.sleep(0.02)
        (self.folder / "begun").unlink()

    def test_ctrl_c(self):
        for body in ("while not request.budget.spent(): pass", "while True: pass"):
            pipeline = self.planner(BEGINS + body)
            with subprocess.Popen([PROGRAM, "run", pipeline, "--json"], cwd=self.folder, text=True,
                                  env=self.environment, stdout=subprocess.PIPE,
                                  stderr=subprocess.DEVNULL) as run:
                self.wait_for_begin()
                run.send_signal(signal.SIGINT)
                out = run.communicate(timeout=20)[0]
            self.assertEqual(json.loads(out)["steps"][0]["status"], "cancelled")
            self.expect_no_workers()

    def test_a_program_that_is_killed(self):
        pipeline = self.planner("import os; os.fork()\n" + BEGINS + "while True: pass")
        with subprocess.Popen([PROGRAM, "run", pipeline], cwd=self.folder, env=self.environment,
                              stderr=subprocess.DEVNULL) as run:
            self.wait_for_begin()
            self.assertNotEqual(self.workers(), [])
            run.kill()
        self.expect_no_workers()


if __name__ == "__main__":
    main()
