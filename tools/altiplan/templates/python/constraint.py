# SPDX-License-Identifier: Apache-2.0
import altiplan


@altiplan.parameters
class Params:
    edge_m: float = altiplan.parameter(0.0, unit="m", doc="position of the border, east of the frame's origin")


@altiplan.constraint("@name@", "Keeps the route east of a border", Params)
class EastOfABorder:
    def __init__(self, params):
        self.edge_m = params.edge_m

    def admits(self, leg):  # depends on the leg alone: planners and the judge ask for each
        return min(leg.start[0], leg.end[0]) >= self.edge_m
