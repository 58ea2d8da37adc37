# SPDX-License-Identifier: Apache-2.0
"""Base of the tests of planners written in Python: files of them, and the program that runs them."""
import json
import os
import resource
import subprocess
import sys
import time

import case
from case import HANGS_S, NIGHTLY, PROGRAM, PythonCase

HEAD = """import altiplan

@altiplan.parameters
class Params:
    {parameters}

@altiplan.planner("{name}", "A planner of a test", Params)
class Tested:
    def __init__(self, params):
        self.params = params

    def plan(self, request):
        {body}
"""
# Of check-plugin: whose tests each start an interpreter or two.
few_by_day = [] if NIGHTLY else ["--rounds", 3, "--only", "library/|declared|sound|worse|agrees|costs|blocked|process"]
STEP = "altiplan: 1\nscenario: scenario.yaml\nseed: 3\nsteps:\n  - {step}\n"
AROUND = "[request.start, (300, 250, 100), (320, 250, 100), request.goal]"


class ScriptCase(PythonCase):
    def setUp(self):
        super().setUp()
        os.environ["ALTIPLAN_PYTHON"] = sys.executable  # of the package in this process, too
        self.environment = {**os.environ, "ALTIPLAN_PLUGIN_PATH": str(self.folder)}

    def planner(self, body, name="tested", parameters="step_m: float = altiplan.parameter("
                "50.0, unit='m', above=0, doc='length of a step')", head=""):
        """Writes a planner whose plan is this code, and a pipeline that uses it."""
        body = body.replace("\n", "\n        ")
        parameters = parameters.replace("\n", "\n    ")
        text = HEAD.format(name=name, body=body, parameters=parameters)
        self.write(f"{name}.py", head + text)
        return self.write(f"{name}.yaml", STEP.format(step=f"{{plan: {name}}}"))

    def altiplan(self, *arguments, code=0, **more):
        """The ended process of the program; fails unless it ends with this code."""
        done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=self.folder, text=True,
                              env=self.environment, capture_output=True, timeout=HANGS_S,
                              stdin=subprocess.DEVNULL, **more)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def result(self, pipeline, *arguments, code=0):
        """result.json, as stdout has it, and stderr."""
        done = self.altiplan("run", pipeline, "--json", *arguments, code=code, preexec_fn=lambda:
                             resource.setrlimit(resource.RLIMIT_CORE, (0, 0)))
        return json.loads(done.stdout), done.stderr

    def workers(self):
        """Processes that still run a file of this test's folder."""
        found = []
        for process in filter(str.isdigit, os.listdir("/proc")):
            try:
                with open(f"/proc/{process}/cmdline", "rb") as stream:
                    command = stream.read().decode(errors="replace")
                with open(f"/proc/{process}/stat") as stream:
                    state = stream.read().rpartition(")")[2].split()[0]
            except OSError:
                continue
            if str(self.folder) in command and "_worker.py" in command and state != "Z":
                found.append(process)
        return found

    def expect_no_workers(self):
        until = time.monotonic() + 10
        while self.workers() and time.monotonic() < until:
            time.sleep(0.05)
        self.assertEqual(self.workers(), [])


main = case.main
