# SPDX-License-Identifier: Apache-2.0
import math

import altiplan


@altiplan.parameters
class Params:
    at_m: tuple[float, float] = altiplan.parameter((0.0, 0.0), unit="m", doc="the middle of a town")
    worst: float = altiplan.parameter(20.0, at_least=0, doc="risk of a metre of flight there, 1 far away")
    radius_m: float = altiplan.parameter(500.0, unit="m", above=0, doc="of the town")


@altiplan.objective("@name@", "Risk to a town below, which falls with the distance", Params)
class RiskToATown:
    def __init__(self, params):
        self.params = params

    def build(self, site):  # costs of a metre of flight at posts, 20 to a radius
        spacing, count = self.params.radius_m / 20, 101
        west, south = (at - 50 * spacing for at in self.params.at_m)

        def risk(i, j):
            squared = ((i - 50) ** 2 + (j - 50) ** 2) * spacing ** 2 / self.params.radius_m ** 2
            return 1 + (self.params.worst - 1) * math.exp(-squared) if self.params.worst > 1 else 1

        return altiplan.Field([[risk(i, j) for i in range(count)] for j in range(count)], spacing,
                              origin_m=(west, south), elsewhere=1.0, unit="risk")
