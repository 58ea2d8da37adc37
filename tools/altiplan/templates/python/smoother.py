# SPDX-License-Identifier: Apache-2.0
import altiplan


@altiplan.parameters
class Params:
    passes: int = altiplan.parameter(2, at_least=1, at_most=100, doc="number of passes along the route")


@altiplan.smoother("@name@", "Removes waypoints that are not needed", Params)
class DropWaypoints:
    def __init__(self, params):
        self.params = params

    def smooth(self, route, request):
        for at in list(range(1, len(route) - 1))[::-1] * self.params.passes:
            if request.budget.spent():
                break
            shorter = route[:at] + route[at + 1:]
            if at + 1 < len(route) and not request.world.violations(shorter):  # the judge's own code
                route = shorter
        return route
