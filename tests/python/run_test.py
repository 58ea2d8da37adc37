# SPDX-License-Identifier: Apache-2.0
"""run_test.py PROGRAM PLUGINS SOURCES: what altiplan.run gives is what `altiplan run` writes."""
import json
import os
import signal
import subprocess
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import case
import numpy
from case import HANGS_S, PIPELINES, PLUGINS, PROGRAM, UNHURRIED, PythonCase, untimed

import altiplan


class Run(PythonCase):
    def program(self, *arguments):
        out = self.folder / "program.json"
        values = [word for key, value in UNHURRIED.items() for word in ("--set", f"{key}={value}")]
        subprocess.run([PROGRAM, "run", *map(str, arguments), *values, "--out", str(out)], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=HANGS_S)
        return out.read_text()

    def test_the_file_is_that_of_the_program(self):
        pipeline = PIPELINES / "ridge_crossing.yaml"
        expected = self.program(pipeline, "--seed", "7", "--set", "steps.0.with.weight_g=0.6")
        result = altiplan.run(pipeline, seed=7, set={"steps.0.with.weight_g": 0.6, **UNHURRIED},
                              out=self.folder / "python.json")
        written = (self.folder / "python.json").read_text()
        self.assertEqual(untimed(written), untimed(expected))
        self.assertEqual(result.to_json(), written)
        self.assertEqual(result.to_dict(), json.loads(written))
        self.assertEqual(json.dumps(result.route.points.tolist()),
                         json.dumps(json.loads(expected)["route"]))

    def test_turns(self):
        pipeline = PIPELINES / "wing_ridge.yaml"
        expected = json.loads(self.program(pipeline))
        result = altiplan.run(pipeline, set=UNHURRIED)
        self.assertEqual(result.route.chords().tolist(), expected["route"])
        self.assertEqual([leg.to_dict() for leg in result.route.legs], expected["legs"])
        self.assertEqual(result.route_lonlat.tolist(), expected["route_lonlat"])
        self.assertEqual(result.flight.track.tolist(), expected["flight"]["track"])
        self.assertLess(len(result.route), len(result.route.chords()))
        self.assertAlmostEqual(result.route.length_m, expected["metrics"]["length_m"])

    def test_attributes_are_the_keys(self):
        result = altiplan.run(PIPELINES / "ridge_crossing.yaml", set=UNHURRIED)
        arrays = {"route", "route_lonlat", "legs", "track", "trace", "altiplan"}
        pairs = [(result, result.to_dict()), (result.flight, result.to_dict()["flight"]),
                 (result.metrics, result.to_dict()["metrics"])]
        pairs += zip(result.steps, result.to_dict()["steps"])
        looked_at = 0
        for record, keys in pairs:
            for key, value in keys.items():
                if key in arrays or key == "steps":
                    continue
                found = getattr(record, key)
                self.assertEqual(found.to_dict() if hasattr(found, "to_dict") else found, value, key)
                looked_at += 1
        self.assertGreater(looked_at, 100)

    def test_no_route_is_a_result(self):
        result = altiplan.run(self.pipeline, set={"scenario.goal.at_m": [305, 500, 100]})
        self.assertEqual((result.status, result.reason), ("invalid_problem", "goal"))
        self.assertIn("goal", result.message)
        self.assertIsNone(result.route)
        self.assertIsNone(result.legs)
        self.assertIsNone(result.flight)
        self.assertIsNone(result.steps[0].route)
        self.assertIsNone(result.metrics.length_m)

    def test_set(self):
        result = altiplan.run(self.pipeline, set={
            "seed": None, "steps.0.with.cell_m": numpy.array([40, 40, 50]),
            "steps.0.with.corner": "free_box", "scenario.vehicle": {"radius_m": numpy.float64(3)},
            "scenario.environment.1.known": True, "steps.0.id": "7"})
        self.assertEqual(result.seed, 0)
        self.assertEqual(result.steps[0].id, "7")
        self.assertEqual(result.status, "solved")

    def test_warnings_are_pythons(self):
        with self.assertWarnsRegex(UserWarning, "'wall'.*does not touch the volume") as seen:
            altiplan.run(self.pipeline, set={"scenario.environment.0.box": {
                "min_m": [5000, 0, 0], "max_m": [5010, 700, 1000]}})
        self.assertEqual(seen.filename, __file__)

    def test_threads_give_the_same_route(self):
        def route(seed):
            return altiplan.run(self.pipeline, seed=seed, set={"steps.0": {
                "plan": "rrt_connect"}}).route

        alone = [route(seed) for seed in range(6)]
        with ThreadPoolExecutor(3) as pool:
            self.assertEqual(list(pool.map(route, range(6))), alone)
        self.assertNotEqual(alone[0], alone[1])


class Interruption(PythonCase):
    def setUp(self):
        super().setUp()
        # A shell starts what it runs in the background with Ctrl-C ignored.
        before = signal.signal(signal.SIGINT, signal.default_int_handler)
        self.addCleanup(signal.signal, signal.SIGINT, before)

    def test_other_threads_go_on(self):
        times = []
        done = threading.Event()

        def tick():
            while not done.wait(0.02):
                times.append(time.monotonic())

        ticking = threading.Thread(target=tick)
        ticking.start()
        result = altiplan.run(self.rogue("never_returns", ", within_s: 0.1"), plugin_path=[PLUGINS])
        done.set()
        ticking.join()
        self.assertGreater(len(times), 10)
        self.assertEqual((result.status, result.reason), ("failed", "never_stopped"))

    def test_a_step_that_never_stops_ends_nothing_else(self):
        text = self.python(
            "import altiplan, sys\n"
            "print(altiplan.run(sys.argv[1], plugin_path=[sys.argv[3]], out='r.json').message)\n"
            "print(altiplan.run(sys.argv[2]).status)\n",
            self.rogue("never_returns", ", within_s: 0.1"), self.pipeline, PLUGINS)
        self.assertRegex(text, "did not stop within two seconds.*\nsolved\n")
        written = json.loads((self.folder / "r.json").read_text())
        self.assertEqual(written["reason"], "never_stopped")

    def waiting(self, seconds):
        """A pipeline with a planner that waits for its stop token."""
        return self.write("waits.yaml", "altiplan: 1\nscenario: scenario.yaml\nsteps:\n"
                          f"  - {{plan: told, within_s: {seconds}, with: {{does: waits}}}}\n")

    def interrupted(self, pipeline):
        """Seconds until KeyboardInterrupt."""
        began = time.monotonic()
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            altiplan.run(pipeline, plugin_path=[PLUGINS], out=self.folder / "r.json")
        timer.join()
        return time.monotonic() - began

    def test_ctrl_c(self):
        self.assertLess(self.interrupted(self.waiting(50)), HANGS_S / 2)
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["status"], "cancelled")
        self.assertEqual(altiplan.run(self.pipeline).status, "solved")

    def test_ctrl_c_of_what_never_stops(self):
        self.assertLess(self.interrupted(self.rogue("never_returns", ", within_s: 50")), HANGS_S / 2)
        self.assertEqual(json.loads((self.folder / "r.json").read_text())["status"], "cancelled")

    def test_a_handler_that_does_not_raise(self):
        seen = []
        before = signal.signal(signal.SIGUSR1, lambda *_: seen.append(1))
        self.addCleanup(signal.signal, signal.SIGUSR1, before)
        timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGUSR1))
        timer.start()
        result = altiplan.run(self.waiting(1), plugin_path=[PLUGINS])
        timer.join()
        self.assertEqual(seen, [1])
        self.assertEqual(result.status, "timed_out")


if __name__ == "__main__":
    case.main()
