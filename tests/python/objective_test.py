# SPDX-License-Identifier: Apache-2.0
"""objective_test.py PROGRAM PLUGINS SOURCES: objectives written in Python are those of files."""
from script_case import ScriptCase, few_by_day, main

HEAD = """import altiplan

@altiplan.parameters
class Params:
    factor: float = altiplan.parameter(1.0, above=0, doc="of all costs")

@altiplan.objective("tested", "An objective of a test", Params)
class Tested:
    def __init__(self, params):
        self.factor = params.factor

    def build(self, site):
        {body}
"""
FIELD = """rows = [[1, 2, 1], [1, 40, 1], [1, 9, float('nan')]]
return altiplan.Field([[self.factor * one for one in row] for row in rows], (400, 300), (100, 200), 1.5, "risk")"""
SCENARIO = """altiplan: 1
environment: [{box: {min_m: [0, 0, -20], max_m: [10, 10, -10]}}]
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
vehicle: {radius_m: 2}
start: {at_m: [50, 500, 100]}
goal: {at_m: [950, 500, 100]}
"""
PIPELINE = """altiplan: 1
scenario: s.yaml
objective: {objective}
steps:
  - plan: astar
    with: {{cell_m: [50, 50, 50]}}
"""
WRONG = {  # what build does: what is said
    "return None": "TypeError: build: expected a Field, found NoneType",
    "return altiplan.Ground([[1, 2], [1, 2]], 10)": "TypeError: build: expected a Field, found Ground",
    "return altiplan.Field([[1, 2]], 10)": "Field: expected 2 posts or more along each axis",
    "return altiplan.Field([[1, 2], [1, -1]], 10)": "values: expected 0 to 1e+09 at each post, or NaN",
    "return altiplan.Field([[1, 2], [1, float('inf')]], 10)": "values: expected 0 to 1e+09",
    "return altiplan.Field([[float('nan')] * 2] * 2, 10)": "values: expected a number at one post or more",
    "return altiplan.Field([[1, 2], [1, 2]], 10, elsewhere=-1)": "elsewhere: expected 0 to 1e+09",
    "return altiplan.Field([[1, 2], [1, 2]], 10, elsewhere=float('inf'))": "elsewhere: expected a finite number",
    "return altiplan.Field([[1, 2], [1, 2]], 0)": "spacings above 0",
    "raise ValueError('the attic')": "threw: ValueError: the attic (tested.py:13)",
}


class Objectives(ScriptCase):
    def setUp(self):
        super().setUp()
        self.write("s.yaml", SCENARIO)

    def objective(self, body):
        self.write("tested.py", HEAD.format(body=body.replace("\n", "\n        ")))

    def run_of(self, objective):
        return self.result(self.write("p.yaml", PIPELINE.format(objective=objective)))[0]

    def test_a_field_is_that_of_a_file(self):
        self.objective(FIELD)
        self.write("f.asc", "ncols 3\nnrows 3\nxllcenter 100\nyllcenter 200\ndx 400\ndy 300\nNODATA_value -1\n"
                   "1 9 -1\n1 40 1\n1 2 1\n")
        own = self.run_of("{tested: {}}")
        of_file = self.run_of("{exposure: {file: f.asc, elsewhere: 1.5, unit: risk}}")
        self.assertEqual(own["steps"][0]["route"], of_file["steps"][0]["route"])
        self.assertEqual(own["cost"], of_file["cost"])
        self.assertEqual(own["bound"], of_file["bound"])
        self.assertGreater(len(own["steps"][0]["route"]), 3)  # it goes around
        self.assertEqual(self.workers(), [])

    def test_a_price_by_height(self):
        self.objective("""levels = [[[self.factor * one] * 2] * 2 for one in (9, 9, 1, 1)]
return altiplan.Field(levels, (1000, 1000, 70))""")
        result = self.run_of("{tested: {}}")
        self.assertEqual(max(z for _, _, z in result["steps"][0]["route"]), 150)
        self.assertLess(result["cost"], 900 * (1 + 8 * 40 / 70))  # as straight at 100 m
        self.assertGreaterEqual(result["bound"], 900 - 1e-6)
        self.objective("return altiplan.Field([[[1, 1], [1, 1]]], 100)")
        self.assertIn("expected 2 posts or more along each axis",
                      self.altiplan("run", self.write("p.yaml", PIPELINE.format(objective="{tested: {}}")),
                                    code=4).stderr)

    def test_parameters_and_sums(self):
        self.objective(FIELD)
        one, ten = (self.run_of(f"{{tested: {{factor: {factor}}}}}")["cost"] for factor in (1, 10))
        self.assertGreater(ten, one)
        self.run_of("{weighted: {of: [{tested: {}}, {length: {}, weight: 2}]}}")

    def test_where_no_route_leads(self):
        self.objective("return altiplan.Field([[1, 1], [1, 1]], 100, (400, 400))")
        result = self.result(self.write("p.yaml", PIPELINE.format(objective="{tested: {}}")), code=1)[0]
        self.assertEqual(result["steps"][0]["status"], "no_route")

    def test_wrong_fields(self):
        pipeline = self.write("p.yaml", PIPELINE.format(objective="{tested: {}}"))
        for body, says in WRONG.items():
            with self.subTest(body=body):
                self.objective(body)
                done = self.altiplan("run", pipeline, code=4)
                self.assertIn(says, done.stderr)
                self.assertIn("objective", done.stderr)

    def test_one_to_begin_with(self):
        self.altiplan("new", "objective", "towns", "--python")
        self.altiplan("check-plugin", "towns.py", "--time-limit", 300, *few_by_day)
        self.assertIn("towns", self.altiplan("plugins").stdout)


if __name__ == "__main__":
    main()
