# SPDX-License-Identifier: Apache-2.0
import altiplan


@altiplan.parameters
class Params:
    poles: int = altiplan.parameter(6, at_least=2, at_most=10000, doc="number of poles, at equal distances")
    apart_m: float = altiplan.parameter(100.0, unit="m", above=0, doc="from one to the next, eastwards")
    radius_m: float = altiplan.parameter(20.0, unit="m", above=0, doc="radius of a pole")
    top_m: float = altiplan.parameter(150.0, unit="m", doc="height of the poles above sea level")


@altiplan.environment("@name@", "A row of poles", Params)
class RowOfPoles:
    def __init__(self, params):
        self.params = params

    def build(self, site):  # solids, as a scenario has them
        return [{"cylinder": {"at_m": (i * self.params.apart_m, 0), "radius_m": self.params.radius_m,
                              "ceiling_m": self.params.top_m}} for i in range(self.params.poles)]
