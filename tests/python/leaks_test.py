# SPDX-License-Identifier: Apache-2.0
"""leaks_test.py PROGRAM PLUGINS SOURCES: calls leave no lists, dicts and exceptions behind, whether they return or
raise. A sanitizer finds other leaks alone: the garbage collector holds all objects that may hold objects."""
import gc
import pickle
import warnings

import case
import numpy
from case import PLUGINS, PythonCase

import altiplan

ROUND = [[100, 500, 100], [300, 100, 100], [900, 500, 100]]
ROUNDS, CALLS = 3, 5
TURNS = ([[0, 0, 0], [5, 0, 0]], [[0, 0, 0, 5, 0, 0, 3, 5, 0, 0, 0, 0]])  # of a route with an arc


class Raises:
    def fail(self, *_):
        raise ZeroDivisionError

    __array__ = __float__ = __index__ = __fspath__ = fail


class Leaks(PythonCase):
    def left_behind(self, call):
        """Objects that remain of each call: the least of some rounds, since caches fill now and then."""
        counts = []
        for _ in range(ROUNDS):
            for _ in range(CALLS):
                try:
                    call()
                except Exception:
                    pass
            gc.collect()
            counts.append(len(gc.get_objects()))
        return min(after - before for before, after in zip(counts, counts[1:])) / CALLS

    def none_left(self, *calls):
        for number, call in enumerate(calls):
            with self.subTest(call=number):
                self.assertLess(self.left_behind(call), 0.5)

    def test_routes(self):
        route = altiplan.Route(ROUND)
        make = route.__reduce__()[0]
        self.none_left(
            lambda: altiplan.Route(ROUND), lambda: altiplan.Route([[1, 2]]), lambda: altiplan.Route(Raises()),
            lambda: altiplan.Route(), lambda: route.points, lambda: route.chords(), lambda: route.chords(-1),
            lambda: list(route), lambda: route[7], lambda: [leg.end for leg in route.legs], lambda: repr(route),
            lambda: numpy.asarray(route, dtype="f4"), lambda: pickle.loads(pickle.dumps(route)),
            lambda: make(*TURNS).legs, lambda: make("a", "b"), lambda: route == ROUND, lambda: route.legs[0].to_dict())

    def test_worlds(self):
        world = altiplan.World(self.scenario)
        self.none_left(
            lambda: altiplan.World(self.scenario), lambda: altiplan.World(self.folder / "none.yaml"),
            lambda: altiplan.World(Raises()), lambda: altiplan.World(self.scenario, {"environment.7": 1}),
            lambda: world.clearance(ROUND), lambda: world.clearance([[1e9, 0, 0]]),
            lambda: world.legs_blocked(ROUND, ROUND, Raises()), lambda: world.legs_blocked(ROUND, ROUND[:1]),
            lambda: world.ground([[1, 2]]), lambda: (world.layers, world.volume, world.start, world.warnings),
            lambda: world.check(ROUND), lambda: [v.place for v in world.check(ROUND[::2]).violations],
            lambda: world.check([]), lambda: repr(world.check(ROUND)))

    def test_runs(self):
        result = altiplan.run(self.pipeline)
        rogue = self.rogue("throws")
        beyond = {"scenario.environment.0.box": {"min_m": [5000, 0, 0], "max_m": [5010, 700, 1000]}}
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            self.none_left(
                lambda: altiplan.run(self.pipeline), lambda: altiplan.run(self.pipeline, set={"seed": "x"}),
                lambda: altiplan.run(rogue, plugin_path=[PLUGINS]), lambda: altiplan.run(self.pipeline, set=beyond),
                lambda: altiplan.World(self.pipeline, beyond), lambda: result.steps[0].check.ok,
                lambda: (result.route, result.legs, result.metrics, result.check, result.files, result.to_json()),
                lambda: result.to_dict(), lambda: repr(result) + repr(result.steps) + repr(result.metrics),
                lambda: altiplan.plan(self.scenario, "astar", cell_m=[50, 50, 50]),
                lambda: altiplan.plan(self.scenario, "astar", cell_m="small"))


if __name__ == "__main__":
    case.main()
