# SPDX-License-Identifier: Apache-2.0
"""Pictures of results, with matplotlib where it is installed."""
import math
from typing import TYPE_CHECKING, List, Optional

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._altiplan import Result


def _along(points: List[List[float]]) -> List[float]:
    """Horizontal distances from the first point, along the points (m)."""
    distances = [0.0]
    for a, b in zip(points, points[1:]):
        distances.append(distances[-1] + math.hypot(b[0] - a[0], b[1] - a[1]))
    return distances


def plot(result: "Result", figure: "Optional[Figure]" = None) -> "Figure":
    """A top view and the height profile of the accepted route, and of the flight's track; the routes
    of other steps are thin. Axes are in metres of the scenario's frame. Returns the
    matplotlib.figure.Figure, a new one unless `figure` is given; ImportError without matplotlib."""
    if figure is None:
        import matplotlib.pyplot as pyplot  # not needed by anything else

        figure = pyplot.figure(figsize=(7, 8), layout="constrained")
    top, profile = figure.subplots(2, 1, height_ratios=[3, 1])
    top.set_aspect("equal", adjustable="datalim")
    for step in result.steps:
        if step.route is not None and step.route != result.route:
            points = step.route.chords()
            top.plot(points[:, 0], points[:, 1], linewidth=0.8, color="0.6", label=step.id)
    lines = []
    if result.route is not None:
        lines.append(("accepted route", result.route.chords(), "C0"))
    if result.flight is not None and len(result.flight.track) > 0:
        lines.append(("flight", result.flight.track[:, 1:], "C1"))
    for name, points, color in lines:
        top.plot(points[:, 0], points[:, 1], color=color, label=name)
        profile.plot(_along(points.tolist()), points[:, 2], color=color, label=name)
    top.set(xlabel="east (m)", ylabel="north (m)", title=result.status)
    profile.set(xlabel="along the route (m)", ylabel="above sea level (m)")
    if top.lines:
        top.legend()
    return figure
