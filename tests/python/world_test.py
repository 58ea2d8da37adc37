# SPDX-License-Identifier: Apache-2.0
"""world_test.py PROGRAM PLUGINS SOURCES: routes, worlds, verdicts and plans as values of Python."""
import gc
import json
import math
import pickle
import subprocess

import case
import numpy
from case import PIPELINES, PLUGINS, PROGRAM, SOURCES, UNHURRIED, PythonCase

import altiplan

RIDGE = SOURCES / "configs/scenarios/jacksboro_ridge.yaml"
ROUND = [[100, 500, 100], [300, 100, 100], [900, 500, 100]]  # past the wall
THROUGH = [[100, 500, 100], [900, 500, 100]]


class Routes(PythonCase):
    def test_points(self):
        route = altiplan.Route(ROUND)
        self.assertEqual(route.points.shape, (3, 3))
        self.assertEqual(route.points.dtype, numpy.float64)
        self.assertEqual(route.points.tolist(), ROUND)
        self.assertEqual(numpy.asarray(route).tolist(), ROUND)
        self.assertEqual(numpy.array(route, dtype=numpy.float32).dtype, numpy.float32)
        self.assertEqual(len(route), 3)
        self.assertEqual([point.tolist() for point in route], ROUND)
        self.assertEqual(route[-1].tolist(), ROUND[-1])
        self.assertEqual(route.length_m, sum(math.dist(a, b) for a, b in zip(ROUND, ROUND[1:])))
        self.assertEqual([leg.kind for leg in route.legs], ["straight", "straight"])
        self.assertEqual([leg.end for leg in route.legs], ROUND[1:])

    def test_conversions(self):
        route = altiplan.Route(ROUND)
        for points in (numpy.array(ROUND, dtype=">i2"), numpy.array(ROUND, order="F"), route,
                       numpy.array(ROUND, dtype=float)[::-1][::-1], [tuple(p) for p in ROUND]):
            self.assertEqual(altiplan.Route(points), route)
        self.assertEqual(len(altiplan.Route([])), 0)
        self.assertEqual(altiplan.Route(numpy.empty((0, 3))).chords().shape, (0, 3))
        self.assertEqual(altiplan.Route([]).points.shape, (0, 3))

    def test_a_view_outlives_its_route(self):
        views = []
        for x in range(200):
            route = altiplan.Route([[x, 0, 0], [x, 1, 0]] * 100)
            views.append((route.points, next(iter(route)), route.to_numpy()[::2]))
        del route
        gc.collect()
        for x, (points, first, half) in enumerate(views):
            self.assertTrue((points[:, 0] == x).all() and (half[:, 0] == x).all() and first[0] == x)

    def test_nothing_changes_a_route(self):
        route = altiplan.Route(ROUND)
        with self.assertRaises(ValueError):
            route.points[0, 0] = 1
        with self.assertRaises(ValueError):
            route.points.setflags(write=True)
        with self.assertRaises(AttributeError):
            route.points = ROUND
        with self.assertRaises(TypeError):
            hash(route)  # equal by value, as a list

    def test_pickle(self):
        turning = altiplan.run(PIPELINES / "wing_ridge.yaml", set=UNHURRIED).route
        self.assertIn("turns", repr(turning))
        for route in (turning, altiplan.Route(ROUND), altiplan.Route([])):
            again = pickle.loads(pickle.dumps(route))
            self.assertEqual(again, route)
            self.assertEqual([leg.to_dict() for leg in again.legs],
                             [leg.to_dict() for leg in route.legs])
        self.assertNotEqual(turning, altiplan.Route(turning.points))


class Worlds(PythonCase):
    def test_queries(self):
        world = altiplan.World(self.scenario)
        self.assertEqual(world.layers, ["wall", "post"])
        self.assertEqual(world.volume.tolist(), [[0, 0, 0], [1000, 1000, 200]])
        self.assertEqual((world.start.tolist(), world.goal.tolist()), tuple(THROUGH))
        clearance = world.clearance([[200, 500, 100], [305, 500, 100], [math.nan, 0, 0],
                                     [700, 850, 100]])
        self.assertEqual(clearance.tolist(), [100, -5, -math.inf, 20])
        self.assertEqual(clearance.dtype, numpy.float64)
        blocked = world.legs_blocked([[100, 500, 100]] * 3,
                                     [[900, 500, 100], [290, 500, 100], [0, 0, math.inf]])
        self.assertEqual(blocked.tolist(), [True, False, True])
        self.assertEqual(blocked.dtype, numpy.bool_)
        self.assertTrue(world.legs_blocked(THROUGH[:1], [[290, 500, 100]], radius_m=11).all())
        self.assertTrue(numpy.isnan(world.ground([[0, 0], [500, 500]])).all())
        for empty in (world.clearance([]), world.legs_blocked([], []), world.ground([])):
            self.assertEqual(empty.shape, (0,))

    def test_what_is_known(self):
        self.assertEqual(altiplan.World(self.scenario, known=True).layers, ["wall"])

    def test_ground(self):
        world = altiplan.World(RIDGE)
        heights = world.ground([world.start[:2], [math.nan, 0], [-1e7, 0]])
        self.assertLess(200, heights[0])
        self.assertLess(heights[0], world.start[2])
        self.assertTrue(numpy.isnan(heights[1:]).all())
        place = [[*world.start[:2], heights[0]]]
        self.assertAlmostEqual(world.clearance(place)[0], 0, delta=0.1)

    def test_set(self):
        for key in ("environment.0.box.max_m", "scenario.environment.0.box.max_m"):
            world = altiplan.World(self.scenario, set={key: [320, 700, 1000]})
            self.assertEqual(world.clearance([[400, 500, 100]]).tolist(), [80])
        self.assertEqual(altiplan.World(self.scenario, set={"environment.1": None}).layers, ["wall"])

    def test_of_a_pipeline(self):
        self.assertEqual(altiplan.World(self.pipeline).layers, ["wall", "post"])


class Verdicts(PythonCase):
    def test_check(self):
        self.assertTrue(altiplan.check(ROUND, self.scenario))
        verdict = altiplan.check(THROUGH, self.scenario)
        self.assertFalse(verdict)
        self.assertFalse(verdict.ok)
        violation = verdict.violations[0]
        self.assertEqual((violation.constraint, violation.at, violation.limit), ("clearance", 0, 2))
        self.assertEqual((violation.layer, violation.unit), ("wall", "m"))
        self.assertIn("'wall'", violation.message)
        self.assertEqual(violation.place.tolist(), THROUGH[0])
        outside = altiplan.check([*ROUND[:2], [900, 100, 500], ROUND[2]], self.scenario).violations
        self.assertEqual({tuple(one.place) for one in outside if one.at == 2}, {(900, 100, 500)})

    def test_as_the_program(self):
        (self.folder / "route.json").write_text(json.dumps(THROUGH))
        done = subprocess.run([PROGRAM, "check", "--json", "--route", self.folder / "route.json",
                               "--scenario", self.scenario], capture_output=True, text=True,
                              check=False)
        verdict = altiplan.World(self.scenario).check(altiplan.Route(THROUGH))
        self.assertEqual(json.loads(done.stdout)["check"], verdict.to_dict())

    def test_constraints_of_a_pipeline(self):
        text = self.pipeline.read_text() + "constraints: [{route_length: {max_m: 10}}]\n"
        self.assertTrue(altiplan.check(ROUND, self.pipeline))
        violations = altiplan.check(ROUND, self.write("short.yaml", text)).violations
        self.assertEqual([one.constraint for one in violations], ["route_length"])


class Plans(PythonCase):
    def test_as_a_pipeline(self):
        expected = altiplan.run(self.pipeline).route
        for file in (self.scenario, self.pipeline):
            step = altiplan.plan(file, "astar", seed=3, cell_m=[50, 50, 50])
            self.assertEqual((step.status, step.accepted, step.route), ("solved", True, expected))

    def test_ends(self):
        step = altiplan.plan(self.scenario, "astar", start=numpy.array([50, 50, 50]),
                             goal={"at_m": [900, 900, 50], "tolerance_m": 1}, cell_m=[50, 50, 50])
        self.assertEqual(step.route[0].tolist(), [50, 50, 50])
        self.assertEqual(step.route[-1].tolist(), [900, 900, 50])

    def test_parameters_are_checked(self):
        with self.assertRaisesRegex(altiplan.Error, "cell_m: expected three numbers") as caught:
            altiplan.plan(self.scenario, "astar", cell_m="small")
        self.assertEqual(caught.exception.key, "steps.0.with.cell_m")
        with self.assertRaisesRegex(altiplan.Error, "did you mean 'astar'"):
            altiplan.plan(self.scenario, "astra")

    def test_set_reaches_the_step(self):
        keys = {"steps.0.with.cell_m": [50, 50, 50], "steps.0.id": "mine"}
        self.assertEqual(altiplan.plan(self.scenario, "astar", set=keys).id, "mine")
        with self.assertRaisesRegex(ValueError, "'steps' is the planner's alone"):
            altiplan.plan(self.scenario, "astar", set={"steps": []})

    def test_a_parameter_may_be_called_as_an_argument(self):
        with self.assertRaises(altiplan.Error) as caught:
            altiplan.plan(self.scenario, "astar", planner="PRM", cell_m=[50, 50, 50])
        self.assertEqual(caught.exception.key, "steps.0.with.planner")

    def test_a_scenario_stands_for_its_pipeline(self):
        with self.assertRaises(altiplan.Error) as caught:
            altiplan.plan(self.scenario, "astar", cell=1)
        self.assertEqual((caught.exception.file, caught.exception.key),
                         (str(self.scenario), "steps.0.with.cell"))
        (self.folder / "beside").symlink_to(PLUGINS)  # a path in `set` is relative to it
        self.assertEqual(altiplan.plan(self.scenario, "told", set={"plugins": ["beside"]}).plugin, "told")
        with self.assertWarnsRegex(UserWarning, "does not touch the volume") as seen:
            altiplan.plan(self.scenario, "astar", cell_m=[50, 50, 50], set={
                "scenario.environment.0.box": {"min_m": [5000, 0, 0], "max_m": [5010, 700, 1000]}})
        self.assertEqual(seen.filename, __file__)

    def test_rejected_by_the_judge(self):
        step = altiplan.plan(self.scenario, "told", plugin_path=[PLUGINS])
        self.assertEqual((step.status, step.accepted), ("rejected", False))
        self.assertEqual(step.route.points.tolist(), THROUGH)
        self.assertFalse(step.check)


class Names(PythonCase):
    def test_every_class_is_public(self):
        classes = {name for name, found in vars(altiplan._altiplan).items() if isinstance(found, type)}
        self.assertEqual(classes | {
            "Cells", "Error", "Field", "Ground", "NoRoute", "Study", "check", "constraint", "environment",
            "go", "objective", "parameter", "parameters", "plan", "planner", "run", "smoother", "study"},
            set(altiplan.__all__))

    def test_everything_has_a_docstring(self):
        for name in altiplan.__all__:
            public = getattr(altiplan, name)
            self.assertTrue(public.__doc__, name)
            for attribute in vars(public) if isinstance(public, type) else []:
                if not attribute.startswith("_"):
                    self.assertTrue(getattr(public, attribute).__doc__, f"{name}.{attribute}")


class Pictures(PythonCase):
    def test_html(self):
        page = altiplan.run(self.pipeline, out=self.folder / "r.json")._repr_html_()
        self.assertRegex(page, '^<iframe [^>]*srcdoc="<!DOCTYPE html>')
        self.assertTrue(page.endswith('"></iframe>'))
        self.assertEqual(page.count('"'), 4)  # all of the page's are escaped
        self.assertIn("&quot;wall&quot;", page)

    def test_html_of_files_that_are_gone(self):
        result = altiplan.run(self.pipeline)
        self.scenario.unlink()
        with self.assertRaisesRegex(altiplan.Error, "no such file"):
            result._repr_html_()

    def test_plot(self):
        try:
            import matplotlib
        except ImportError:
            self.skipTest("no matplotlib")
        matplotlib.use("Agg")
        top, profile = altiplan.run(PIPELINES / "ridge_crossing.yaml", set=UNHURRIED).plot().axes
        self.assertEqual([line.get_label() for line in top.lines],
                         ["route", "prune", "accepted route", "flight"])
        self.assertEqual(len(profile.lines), 2)

    def test_matplotlib_is_not_loaded_before(self):
        self.python("import altiplan, sys; assert 'matplotlib' not in sys.modules")


if __name__ == "__main__":
    case.main()
