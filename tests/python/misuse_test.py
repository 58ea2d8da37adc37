# SPDX-License-Identifier: Apache-2.0
"""misuse_test.py PROGRAM PLUGINS SOURCES: what is wrong raises an exception, and ends no process."""
import copy
import gc
import math
import pickle
import threading

import case
import numpy
from case import PIPELINES, PLUGINS, SOURCES, UNHURRIED, PythonCase

import altiplan

CLASSES = ("Check", "Flight", "Leg", "Metrics", "Result", "Route", "Step", "Violation", "World")
NO_POINTS = [  # no numbers of shape (n, 3), and what is raised
    (None, TypeError), ("points", TypeError), (b"points", TypeError), (object(), TypeError),
    ([["a", "b", "c"]], TypeError), ([[None, 1, 2]], TypeError), ([[True, False, True]], TypeError),
    ([[1j, 0, 0]], TypeError), (numpy.zeros((2, 3), dtype=object), TypeError),
    (numpy.zeros(3, dtype="datetime64[s]"), TypeError), ({"x": 1}, TypeError), (7, ValueError),
    ([1, 2, 3], ValueError), ([[1, 2]], ValueError), ([[1, 2, 3], [4, 5]], ValueError),
    ([[[1, 2, 3]]], ValueError), (numpy.zeros((3, 2)), ValueError), (numpy.zeros((0, 2)), ValueError),
    ([[1e9, 0, 0]], ValueError)]


class Arguments(PythonCase):
    def refuses(self, expected, call, *arguments, **named):
        with self.assertRaises(expected) as caught:
            call(*arguments, **named)
        return str(caught.exception)

    def test_points(self):
        world = altiplan.World(self.scenario)
        good = [[0, 0, 0]]
        for points, expected in NO_POINTS:
            with self.subTest(points=repr(points)):
                messages = [
                    self.refuses(expected, altiplan.Route, points),
                    self.refuses(expected, world.clearance, points),
                    self.refuses(expected, world.legs_blocked, points, good),
                    self.refuses(expected, world.legs_blocked, good, points),
                    self.refuses(expected, altiplan.check, points, self.scenario)]
                for message in messages:
                    self.assertRegex(message, r"shape \(n, 3\)|beyond 1e8 m")

    def test_callbacks_that_raise(self):
        class Raises:
            def fail(self, *_):
                raise ZeroDivisionError("mine")

            __array__ = __float__ = __fspath__ = fail

        class Values(dict):
            def items(self):
                raise ZeroDivisionError("mine")

        world = altiplan.World(self.scenario)
        for call in (lambda: altiplan.Route(Raises()), lambda: world.clearance(Raises()),
                     lambda: world.legs_blocked([[1, 2, 3]], Raises()), lambda: world.check(Raises()),
                     lambda: world.ground(Raises()), lambda: altiplan.run(self.pipeline, set=Values())):
            self.assertEqual(self.refuses(ZeroDivisionError, call), "mine")

    def test_other_shapes(self):
        world = altiplan.World(self.scenario)
        message = self.refuses(ValueError, world.ground, [[1, 2, 3]])
        self.assertIn("points_xy: expected numbers of shape (n, 2), found shape (1, 3)", message)
        message = self.refuses(ValueError, world.legs_blocked, [[1, 2, 3]] * 2, [[1, 2, 3]])
        self.assertIn("b: expected shape (2, 3) as of a, found (1, 3)", message)
        for radius in (-1, math.nan, math.inf):
            self.refuses(ValueError, world.legs_blocked, [[1, 2, 3]], [[1, 2, 3]], radius)
        self.refuses(TypeError, world.legs_blocked, [[1, 2, 3]], [[1, 2, 3]], "wide")
        self.refuses(ValueError, altiplan.Route, [[1, 2, math.nan]])
        self.refuses(ValueError, altiplan.Route, [[1, 2, math.inf]])
        self.refuses(ValueError, altiplan.check, [], self.scenario)
        for tolerance in (0, -1, math.nan):
            self.refuses(ValueError, altiplan.Route([[1, 2, 3]]).chords, tolerance)

    def test_run(self):
        for expected, named in [
                (TypeError, {"seed": 1.5}), (TypeError, {"seed": "1"}), (ValueError, {"seed": -1}),
                (ValueError, {"seed": 2**63}), (TypeError, {"set": "a=b"}), (TypeError, {"set": 3}),
                (TypeError, {"set": {1: 2}}), (ValueError, {"set": {"": 2}}),
                (ValueError, {"set": {"a=b": 2}}), (ValueError, {"set": {"~a": 2}}),
                (TypeError, {"set": {"a": object()}}), (ValueError, {"set": {"a": math.nan}}),
                (TypeError, {"plugin_path": "/"}), (TypeError, {"plugin_path": [3]}),
                (TypeError, {"plugin_path": 3}), (TypeError, {"threads": 1.0}),
                (ValueError, {"threads": 0}), (ValueError, {"threads": 2000}),
                (ValueError, {"timeout_s": 0}), (ValueError, {"timeout_s": math.nan}),
                (TypeError, {"timeout_s": "1"}), (TypeError, {"out": 3}),
                (ValueError, {"out": "a\0b"}), (TypeError, {"unknown": 1}),
                (altiplan.Error, {"set": {"no.such.key": 1}}),
                (altiplan.Error, {"set": {"steps.7": 1}}),
                (altiplan.Error, {"out": self.folder}), (altiplan.Error, {"out": self.pipeline}),
                (altiplan.Error, {"out": self.folder / "no/r.json"})]:
            with self.subTest(**named):
                self.refuses(expected, altiplan.run, self.pipeline, **named)
        for pipeline in (None, 3, b"bytes", ["list"]):
            self.refuses(TypeError, altiplan.run, pipeline)

    def test_plan(self):
        for expected, named in [
                (ValueError, {"start": [1, 2]}), (TypeError, {"start": [1, 2, "3"]}),
                (ValueError, {"start": [1, 2, math.nan]}), (ValueError, {"goal": "here"}),
                (ValueError, {"goal": 3}), (altiplan.Error, {"goal": {"at": 3}}),
                (TypeError, {"within_s": "1"}), (ValueError, {"within_s": 0}),
                (TypeError, {"seed": None and 0 or "x"}), (altiplan.Error, {"cell": 1}),
                (TypeError, {"cell_m": object()})]:
            with self.subTest(**named):
                self.refuses(expected, altiplan.plan, self.scenario, "astar", **named)
        self.refuses(TypeError, altiplan.plan, self.scenario, None)


class Errors(PythonCase):
    def raised(self, call, *arguments, **named):
        with self.assertRaises(altiplan.Error) as caught:
            call(*arguments, **named)
        return caught.exception

    def test_place(self):
        text = self.pipeline.read_text().replace("cell_m", "cel_m")
        error = self.raised(altiplan.run, self.write("p.yaml", text))
        self.assertEqual((error.file, error.line, error.column, error.key),
                         (str(self.folder / "p.yaml"), 6, 12, "steps.0.with.cel_m"))
        self.assertEqual(str(error), error.message)
        self.assertIn("did you mean 'cell_m'", error.message)

    def test_every_problem(self):
        self.write("scenario.yaml", self.scenario.read_text().replace("radius_m: 2", "radius_m: -2"))
        text = self.pipeline.read_text().replace("seed: 3", "seed: x")
        problems = self.raised(altiplan.run, self.write("p.yaml", text)).problems
        self.assertEqual({problem["key"] for problem in problems}, {"seed", "vehicle.radius_m"})

    def test_other_errors(self):
        error = self.raised(altiplan.run, self.folder / "none.yaml")
        self.assertEqual((error.line, error.key, error.reason), (None, None, None))
        self.raised(altiplan.World, self.write("empty.yaml", ""))
        self.raised(altiplan.World, self.write("bytes.yaml", "\0"))
        (self.folder / "latin.yaml").write_bytes(b"altiplan: 1\nname: \xe9\n")
        self.raised(altiplan.World, self.folder / "latin.yaml")
        self.raised(altiplan.World, SOURCES / "configs/studies/quick.yaml")
        self.raised(altiplan.run, self.rogue("making_throws"), plugin_path=[PLUGINS])

    def test_copies(self):
        error = self.raised(altiplan.run, self.pipeline, set={"steps.0.with.cel_m": 1})
        for again in (pickle.loads(pickle.dumps(error)), copy.copy(error)):
            self.assertEqual(vars(again), vars(error))
        self.assertEqual(altiplan.Error("by hand").file, None)

    def test_throwing_steps(self):
        for does in ("throws", "throws_int", "nan", "no_points", "huge"):
            result = altiplan.run(self.rogue(does), plugin_path=[PLUGINS])
            self.assertIn(result.status, ("failed", "rejected"))
            self.assertTrue(result.message)

    def test_in_threads(self):
        raised = []

        def work():
            for call in (lambda: altiplan.run(self.folder / "none.yaml"),
                         lambda: altiplan.Route([[1, 2]]), lambda: altiplan.World(self.pipeline)):
                try:
                    call()
                except Exception as error:
                    raised.append(type(error))

        threads = [threading.Thread(target=work) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(raised.count(altiplan.Error), 8)
        self.assertEqual(raised.count(ValueError), 8)


class Objects(PythonCase):
    def all_of(self, value, seen):
        """Prints, compares and walks a value and all that it has."""
        if id(value) in seen or len(seen) > 3000:
            return
        seen[id(value)] = value
        self.assertTrue(repr(value) and (str(value) or value == ""))
        value == value, value != 3, value is not None and value == None  # noqa: E711
        if type(value).__module__ != "altiplan":
            return
        for name in dir(value):
            if not name.startswith("_") and name not in ("plot", "to_json"):
                found = getattr(value, name)
                self.all_of(found() if callable(found) and name.startswith("to_") else found, seen)
                for one in found if isinstance(found, list) else []:
                    self.all_of(one, seen)

    def test_every_attribute_of_every_object(self):
        seen = {}
        self.all_of(altiplan.run(self.pipeline, set={"scenario.goal.at_m": [305, 500, 100]}), seen)
        self.all_of(altiplan.World(self.scenario), seen)
        for violation in altiplan.check([[0, 0, 0], [900, 500, 100]], self.scenario).violations:
            self.all_of(violation, seen)
        for name in ("ridge_crossing", "wing_ridge"):
            self.all_of(altiplan.run(PIPELINES / f"{name}.yaml", set=UNHURRIED), seen)
        self.assertGreater(len(seen), 300)
        kinds = {type(value).__name__ for value in seen.values()}
        self.assertLessEqual(set(CLASSES), kinds)

    def test_parts_outlive_the_whole(self):
        result = altiplan.run(PIPELINES / "ridge_crossing.yaml", set=UNHURRIED)
        parts = [result.steps, result.flight.track, result.route.points, result.metrics]
        text = repr(parts)
        del result
        gc.collect()
        self.assertEqual(repr(parts), text)
        with self.assertRaises(ValueError):
            parts[1][0] = 0

    def test_nothing_can_be_set(self):
        result = altiplan.run(self.pipeline)
        for target, name in ((result, "status"), (result.metrics, "length_m"),
                             (result.steps[0], "route")):
            with self.assertRaises(AttributeError):
                setattr(target, name, 1)
        result.steps.clear()
        result.to_dict()["steps"].clear()
        self.assertEqual(len(result.steps), 1)

    def test_classes_without_a_constructor(self):
        for name in CLASSES:
            for arguments in ((), (None,), ("x", 3)):
                with self.subTest(name=name), self.assertRaises((TypeError, ValueError)):
                    getattr(altiplan, name)(*arguments)

    def test_objects_that_nothing_has_made(self):
        for name in CLASSES:
            kind = getattr(altiplan, name)
            with self.subTest(name=name):
                self.assertRaises(TypeError, kind.__new__, kind)
                self.assertRaises(TypeError, object.__new__, kind)
                self.assertRaises(TypeError, type, "Sub", (kind,), {})

    def test_the_base_of_all_classes(self):
        base = altiplan.Route.__base__
        for make in (base, lambda: base.__new__(base), lambda: type(base)("Mine", (base,), {})()):
            with self.assertRaises(TypeError):
                make()
        self.assertRaises(TypeError, base.__init__, altiplan.Route([[1, 2, 3]]))

    def test_copies(self):
        route = altiplan.Route([[1, 2, 3], [4, 5, 6]])
        self.assertEqual(copy.deepcopy(route), route)
        for value in (altiplan.World(self.scenario), altiplan.run(self.pipeline)):
            self.assertRaises(TypeError, copy.copy, value)
            self.assertRaises(TypeError, pickle.dumps, value)

    def test_states_that_no_route_has(self):
        make = altiplan.Route([[1, 2, 3]]).__reduce__()[0]
        for state in ((None, None), ([[1, 2, 3]], [[1] * 11]), ("a", "b"), ([], [[math.nan] * 12]),
                      ([], [[1] * 7 + [-1] + [0] * 4]), ([[1, 2]], [])):
            with self.subTest(state=state), self.assertRaises((TypeError, ValueError)):
                make(*state)


if __name__ == "__main__":
    case.main()
