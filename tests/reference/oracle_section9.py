# SPDX-License-Identifier: Apache-2.0
"""Missions whose right verdict is known: what a checker gets wrong that joins the items by straight lines.
`TABLE`: name, case, and the verdict of a checker (`pass`, `fail`, or either)."""
import math

import oracle_world
from oracle_judge import Case
from oracle_world import Zone, box

FIRMWARE = {"A": 3, "P": 12}
VEHICLE = {"C": 2, "M": 2, "F": 1, "P": 20, "V": 20}


def item(command, world, place=None, alt=0.0, frame=3, p=(0, 0, 0, 0), **keys):
    """Without a place: 0, 0."""
    lat, lon = (0, 0) if place is None else world.to_degrees(*place)
    return {"type": "SimpleItem", "command": command, "frame": frame, "autoContinue": True,
            "params": [*p, lat, lon, alt], **keys}


def act(command, *p):
    return {"type": "SimpleItem", "command": command, "frame": 2, "autoContinue": True,
            "params": [*p, *[0] * (7 - len(p))]}


def plan(kind, world, items, fences=(), rally=(), home=(0, 0), home_height=None):
    """`fences`: (corners, whether to keep in) or (centre, radius, whether)."""
    polygons = [{"inclusion": f[1], "version": 1, "polygon": [list(world.to_degrees(*c)) for c in f[0]]}
                for f in fences if len(f) == 2]
    circles = [{"inclusion": f[2], "version": 1,
                "circle": {"center": list(world.to_degrees(*f[0])), "radius": f[1]}} for f in fences if len(f) == 3]
    height = float(world.ground(home)) if home_height is None else home_height
    firmware, vehicle = ("QP" == kind and (3, 20)) or (FIRMWARE[kind[0]], VEHICLE[kind[1]])
    mission = {"version": 2, "firmwareType": firmware, "vehicleType": vehicle, "cruiseSpeed": 15, "hoverSpeed": 5,
               "plannedHomePosition": [*world.to_degrees(*home), round(height, 2)],
               "items": [dict(entry, doJumpId=n + 1) for n, entry in enumerate(items)]}
    return {"fileType": "Plan", "version": 1, "groundStation": "QGroundControl", "mission": mission,
            "geoFence": {"version": 2, "circles": circles, "polygons": polygons},
            "rallyPoints": {"version": 2, "points": [[*world.to_degrees(*r[:2]), r[2]] for r in rally]}}


SEA = oracle_world.flat()


def takeoff_elsewhere(kind):
    items = [item(22, SEA, (300, 0), 40), item(16, SEA, (300, 300), 40), item(21, SEA, (300, 300))]
    return Case(plan(kind, SEA, items, [((150, 150), 30, False)]), SEA)


def quadplane_number_is_height():
    world = oracle_world.flat(430)
    items = [item(84, world, (0, 0), 480, 0), item(16, world, (900, 0), 480, 0), item(85, world, (900, 900), 0)]
    return Case(plan("QP", world, items), world, max_agl=120)


def drops_at_once(crest=95.0):
    """The ridge lies across the leg, 250 m along it."""
    world = oracle_world.flat(0.0, size=161)
    middle = int(round((-1000 + 250) / world.east / world.cell_deg)) + 80
    world.heights[:, middle] = crest
    start = (middle - 80) * world.cell_deg * world.east - 250
    steps = abs(crest) / (world.cell_deg * world.east)
    world.slope = steps
    items = [item(16, world, (start, 0), 114, 0), item(16, world, (start + 2000, 0), 100, 0),
             item(16, world, (start + 2900, 0), 100, 0)]
    return Case(plan("AF", world, items), world, min_agl=10)


def return_climbs(kind):
    items = [item(22, SEA, (0, 0), 10), item(16, SEA, (800, 0), 10), act(20)]
    return Case(plan(kind, SEA, items), SEA, [Zone(box(380, -60, 420, 60), 12, 40)])


def lands_at_null(kind):
    items = [item(22, SEA, (0, 0), 30), item(16, SEA, (200, 0), 30), item(21, SEA)]
    return Case(plan(kind, SEA, items), SEA)


def plane_cuts_corner():
    away = 50 / math.sqrt(2)
    items = [act(178, 0, 20, 0), item(16, SEA, (-1500, 0), 100), item(16, SEA, (-700, 0), 100),
             item(16, SEA, (0, 0), 100), item(16, SEA, (0, 900), 100)]
    return Case(plan("AF", SEA, items, [((-away, away), 25, False)], home=(-1500, 0)), SEA)


def arc_is_skipped(kind):
    """A quarter of a circle from A to the item, round the middle of the line from A to C."""
    takeoff = [item(22, SEA, (50, 0), 60)] if kind != "AF" else []
    rest = [item(16, SEA, (0, 0), 60), item(36, SEA, (400, 400), 60, p=(90, 0, 0, 0)), item(16, SEA, (1000, 0), 60)]
    end = [item(21, SEA, (1000, 0))] if kind != "AF" else []
    return Case(plan(kind, SEA, takeoff + rest + end, [((500, 0), 40, False)]), SEA)


def arc_is_flown(radius):
    """Clockwise from A to B by 90 degrees: 117 m to the left of the middle of the line."""
    a, b = (200, 0), (965.7, 0)
    items = [item(22, SEA, (0, 0), 60), item(16, SEA, a, 60), item(36, SEA, b, 60, p=(90, 0, 0, 0)), item(21, SEA, b)]
    middle, bulge = (a[0] + b[0]) / 2, (b[0] - a[0]) / 2 * math.tan(math.radians(22.5))
    return Case(plan("AC", SEA, items, [((middle, bulge), radius, False)]), SEA)


def follows_ground(kind):
    """A hill of 55 m between two items 60 m above the ground."""
    world = oracle_world.flat(0.0)
    world.heights[:, 66:71] = [18.0, 37.0, 55.0, 37.0, 18.0]
    world.slope = 0.3
    top = 8 * world.cell_deg * world.east
    zone = Zone(box(top - 60, -80, top + 60, 80), 100, 300)
    takeoff = [item(22, world, (0, 0), 60)] if kind != "AF" else []
    items = takeoff + [item(16, world, (100, 0), 60, 10), item(16, world, (1200, 0), 60, 10)]
    return Case(plan(kind, world, items + [item(21, world, (1200, 0))] * (kind != "AF")), world, [zone])


def waits(command):
    items = [item(22, SEA, (0, 0), 30), act(command, 300), item(16, SEA, (600, 0), 30), item(21, SEA, (600, 0))]
    zone = Zone(box(540, -60, 660, 60), 0, 100, closed=(-3600, 300))
    return Case(plan("AC", SEA, items), SEA, [zone])


def two_keep_ins(kind):
    items = [item(22, SEA, (100, 0), 40), item(16, SEA, (150, 0), 40), item(16, SEA, (500, 0), 40)]
    if kind == "PF":
        items += [item(16, SEA, (1200, 0), 40), item(21, SEA, (1900, 0))]
    fences = [(box(-200, -300, 300, 300), True), (box(300, -300, 2500, 300), True)]
    return Case(plan(kind, SEA, items, fences), SEA)


def stops_for_ever(kind):
    items = [item(22, SEA, (0, 0), 40)] + [item(16, SEA, (100 * n, 50 * n), 40) for n in range(1, 7)]
    items.append(item(21, SEA, (600, 300)))
    items[3]["autoContinue"] = False
    return Case(plan(kind, SEA, items), SEA)


def beside_a_long_leg():
    """Along a parallel: the great circle, near which PX4 flies, is 54 m nearer to the pole in the
    middle of the leg; ArduPilot keeps the latitude."""
    world = oracle_world.flat(0.0, lat=60.0, cell_deg=0.01)
    items = [item(22, world, (-20000, 0), 60), item(16, world, (20000, 0), 60), item(21, world, (20000, 0))]
    return Case(plan("PM", world, items, [(box(-1500, 30, 1500, 600), False)], home=(-20000, 0)), world)


def armed_on_the_hill(kind):
    items = [item(22, SEA, (0, 0), 40), item(16, SEA, (300, 0), 40), item(21, SEA, (300, 0))]
    return Case(plan(kind, SEA, items), SEA, min_agl=20, max_agl=80)


def rows():
    yield "1 AC take-off elsewhere", takeoff_elsewhere("AC"), "fail"
    yield "1 PX4 copter take-off elsewhere", takeoff_elsewhere("PM"), "pass"
    yield "3 QuadPlane take-off above the sea", quadplane_number_is_height(), "fail"
    yield "4 ArduPlane drops at once", drops_at_once(), "fail"
    yield "6 AC return over wires", return_climbs("AC"), "fail"
    yield "6 PX4 copter return over wires", return_climbs("PM"), "fail"
    yield "8 PX4 landing at 0, 0", lands_at_null("PM"), "fail"
    yield "8 AC landing at 0, 0", lands_at_null("AC"), "pass"
    yield "9 ArduPlane cuts the corner", plane_cuts_corner(), "fail"
    yield "10 ArduPlane skips the arc", arc_is_skipped("AF"), "fail"
    yield "10 PX4 refuses the arc", arc_is_skipped("PM"), "fail"
    yield "10 PX4 plane refuses the arc", arc_is_skipped("PF"), "fail"
    yield "10 AC flies the arc past the line", arc_is_skipped("AC"), "pass"
    yield "10 AC flies the arc into the zone", arc_is_flown(30), "fail"
    yield "12 AC follows the ground", follows_ground("AC"), "fail"
    yield "12 ArduPlane follows the ground", follows_ground("AF"), "fail"
    yield "12 PX4 refuses terrain", follows_ground("PM"), "fail"
    yield "13 AC condition is no hold", waits(112), "fail"
    yield "13 AC delay is a hold", waits(93), "pass"
    for kind in ("AC", "PM", "PF"):
        yield f"15 {kind} two keep-ins", two_keep_ins(kind), "fail"
    yield "16 PX4 stops for ever", stops_for_ever("PM"), "fail"
    yield "16 AC goes on", stops_for_ever("AC"), "pass"
    yield "18 PX4 beside a long leg", beside_a_long_leg(), "fail"
    for kind in ("AC", "PM"):
        yield f"20 {kind} armed at the plan's home", armed_on_the_hill(kind), "pass"


TABLE = list(rows())
OWN = {"fail": {"must_fail", "refused", "not_judgeable"}, "pass": {"must_pass"}}
