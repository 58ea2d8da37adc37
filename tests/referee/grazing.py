# SPDX-License-Identifier: Apache-2.0
"""Routes made by hand that pass a limit by a margin that is known without any geometry code.

`cases(margin, radius)` gives (name, scenario, route): the route keeps the scenario's rule by `margin`
metres (or, of angles, degrees), and breaks it where the margin is negative."""
import numpy as np

ASIDE, HEIGHT = np.array([500.0, 500.0]), 100.0
TOP = 150.0
SQUARE = [[400, 400], [600, 400], [600, 600], [400, 600]]
NOTCHED = [[400, 400], [600, 400], [600, 600], [500, 480], [400, 600]]


def scenario(route, environment=(), constraints=(), radius=0.0, **more):
    return {"altiplan": 1, "name": "Grazing", "environment": list(environment),
            "volume": {"min_m": [-1e5, -1e5, -1e4], "max_m": [1e5, 1e5, 1e4]},
            "vehicle": {"radius_m": radius}, "constraints": list(constraints),
            "start": {"at_m": [float(v) for v in route[0]]},
            "goal": {"at_m": [float(v) for v in route[-1]]}, **more}


def through(point, direction, length=700):
    """A leg whose middle is that point."""
    way = np.array(direction, float) / np.linalg.norm(direction) * length / 2
    return [np.array(point, float) - way, np.array(point, float) + way]


def solids(margin, radius):
    """A straight leg past one solid at the vehicle's radius and the margin."""
    d = radius + margin
    across = np.array([1, 2, 2]) / 3  # and two directions that are square to it
    ball = [{"sphere": {"at_m": [500, 500, 100], "radius_m": 50}}]
    centre = np.array([500, 500, 100])
    yield "a ball", ball, through(centre + (50 + d) * across, [2, 1, -2])
    yield "a ball, beside", ball, through([550 + d, 500, 100], [0, 1, 0])
    yield "a ball, at the end", ball, [centre + 400 * across, centre + (50 + d) * across]
    post = [{"cylinder": {"at_m": [500, 500], "radius_m": 30, "floor_m": 20, "ceiling_m": TOP}}]
    side = np.array([0.6, 0.8, 0])
    yield "a cylinder's side", post, through(centre + (30 + d) * side, [0.8, -0.6, 0.05])
    yield "a cylinder's side, upright", post, through(centre + (30 + d) * side, [0, 0, 1])
    yield "a cylinder's top", post, through([500, 500, TOP + d], [1, 3, 0])
    yield "a cylinder's bottom", post, through([500, 500, 20 - d], [1, -3, 0])
    slope = d / np.sqrt(2)
    yield "a cylinder's rim", post, through([530 + slope, 500, TOP + slope], [0, 1, 0])
    block = [{"box": {"min_m": [450, 460, 50], "max_m": [550, 540, TOP]}}]
    yield "a box's face", block, through([550 + d, 500, 100], [0, 2, 0.3])
    yield "a box's roof", block, through([500, 500, TOP + d], [1, 1, 0])
    yield "a box's edge", block, through([550 + slope, 500, TOP + slope], [0, 1, 0])
    yield "a box's upright edge", block, through([550 + slope, 540 + slope, 100], [1, -1, 0.2])
    corner = d / np.sqrt(3)
    yield "a box's corner", block, through(np.array([550, 540, TOP]) + corner, [1, -1, 0])
    house = [{"prism": {"outline_m": NOTCHED, "floor_m": 0, "ceiling_m": TOP}}]
    yield "a prism's wall", house, through([400 - d, 500, 100], [0, 1, 0])
    yield "a prism's corner", house, through([600 + slope, 400 - slope, 100], [1, 1, 0.1])
    yield "a prism's notch", house, through([500, 480 + d * np.hypot(100, 120) / 100, 100], [0, 0, 1])
    yield "a prism's roof", house, through([500, 440, TOP + d], [1, 0, 0])
    court = [{"zones": {"list": [{"polygon": {
        "outline_m": SQUARE, "holes_m": [[[450, 450], [550, 450], [550, 550], [450, 550]]]}}]}}]
    yield "a courtyard", court, through([550 - d, 500, 100], [0, 0, 1])
    yield "a courtyard's wall along", court, through([500, 450 + d, 100], [1, 0, 0], 90 - 2 * radius)
    inside = [{"zones": {"list": [{"kind": "keep_in", "ceiling_m": TOP,
                                   "polygon": {"outline_m": SQUARE}}]}}]
    yield "a keep-in zone's border", inside, through([600 - d, 500, 100], [0, 1, 0], 100)
    yield "a keep-in zone's ceiling", inside, through([500, 500, TOP - d], [1, 1, 0], 100)


def bend(degrees, climb=0.0, legs=(400, 400)):
    """Two legs with that turn between them, both with that climb."""
    turn, climb = np.radians(degrees), np.radians(climb)
    first = np.array([np.cos(climb), 0, np.sin(climb)]) * legs[0]
    second = np.array([np.cos(climb) * np.cos(turn), np.cos(climb) * np.sin(turn),
                       np.sin(climb)]) * legs[1]
    return [np.zeros(3), first, first + second]


def rules(margin, _radius):
    """(name, constraint, route) of rules about the route itself."""
    yield "a turn", {"turn_angle": {"max_deg": 40}}, bend(40 - margin, 7)
    yield "a turn in space", {"turn_angle": {"max_deg": 40, "plane": "spatial"}}, bend(40 - margin)
    for tiny in (1e-9, 5e-7, 10.0):
        straight = bend(40 - margin)
        up = np.array([0, 0, tiny])
        yield (f"a turn behind a climb of {tiny} m", {"turn_angle": {"max_deg": 40}},
               [*straight[:2], straight[1] + up, straight[2] + up])
    yield "a climb", {"climb_angle": {"max_deg": 12}}, bend(20, 12 - margin)
    yield "a descent", {"climb_angle": {"max_deg": 12}}, bend(20, -12 + margin)
    yield "a leg's length", {"leg_length": {"max_m": 300}}, bend(20, 0, (200, 300 - margin))
    yield "a short leg", {"leg_length": {"min_m": 300}}, bend(20, 0, (300 + margin, 400))
    yield "a route's length", {"route_length": {"max_m": 800}}, bend(20, 0, (400, 400 - margin))
    yield "a ceiling", {"altitude": {"max_m": 50}}, through([0, 0, 50 - margin], [1, 0, 0])
    yield "a floor", {"altitude": {"min_m": 50}}, through([0, 0, 50 + margin], [1, 0, 0])
    half = (200 + margin) * np.tan(np.radians(45))
    yield "a corner's radius", {"turn_radius": {"min_m": 200}}, bend(90, 0, (2 * half, 900))
    half = (100 + margin) * np.tan(np.radians(15))
    yield "a flat corner's radius", {"turn_radius": {"min_m": 100}}, bend(30, 0, (700, 2 * half))


def ground(margin, radius, folder):
    """Over an elevation model: its highest post, and the saddle within a cell."""
    heights = np.full((9, 9), 100.0)
    heights[4, 4] = 160  # row from the north
    heights[1, 1] = heights[2, 2] = 130
    heights[1, 2] = heights[2, 1] = 110
    lines = ["ncols 9", "nrows 9", "xllcenter 500000", "yllcenter 5200000", "cellsize 100"]
    lines += [" ".join(f"{v:g}" for v in row) for row in heights]
    with open(f"{folder}/ground.asc", "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    layer = {"terrain": {"file": "ground.asc", "crs": "EPSG:32632"}}
    keep = {"ground_clearance": {"min_m": 40}}
    post, saddle = np.array([400, 400, 200 + margin]), np.array([150, 650])
    yield "a post", layer, keep, through(post, [1, 0.7, 0])
    # From corner to corner of the cell the ground runs from 110 over 120 back to 110.
    yield "a saddle", layer, keep, through([*saddle, 160 + margin], [1, 1, 0], 100)
    band = {"altitude": {"max_m": 60 + margin, "datum": "ground"}}
    yield "a band over the ground", layer, band, [np.array([300, 100, 160.0]), np.array([500, 100, 130.0])]


def cases(margin, radius, folder):
    for name, environment, route in solids(margin, radius):
        yield name, scenario(route, environment, radius=radius), route
    for name, constraint, route in rules(margin, radius):
        yield name, scenario(route, (), [constraint], radius), route
    for name, layer, constraint, route in ground(margin, radius, folder):
        yield name, scenario(route, [layer], [constraint], radius), route
    route = through([0, 0, 0], [1, 0, 0])
    goal = {"at_m": [350.0, 30.0 + margin, 0.0], "tolerance_m": 30.0 + 2 * margin}
    yield "the goal's tolerance", scenario(route, radius=radius, goal=goal), route
    volume = {"min_m": [-1e5, -1e5, -margin], "max_m": [1e5, 1e5, 1e4]}
    yield "the volume's floor", scenario(route, radius=radius, volume=volume), route
