# SPDX-License-Identifier: Apache-2.0
"""Scenes for the tests of the viewer's page, of the form that tools/viewer/README.md gives."""
import array
import base64
import json
import math

PLACE = "/*SCENE*/"
ADDED, ITERATION = 1, 4  # kinds of events


def packed(kind, values):
    """Base64 of little-endian values; `kind` as in the module array."""
    return base64.b64encode(array.array(kind, values).tobytes()).decode()


def page(template, scene):
    text = json.dumps(scene).replace("<", "\\u003c")
    assert template.count(PLACE) == 1
    return template.replace(PLACE, text)


def hills(x, y):
    """Metres above the sea, 200 to 1,300, for x, y in kilometres."""
    return (600 + 260 * math.sin(x / 1.7) * math.cos(y / 1.3) + 150 * math.sin(x / 0.6 + y / 0.9)
            + 500 * math.exp(-((x - 5.2) ** 2 / 1.1 + (y - 4.5) ** 2 / 6)))


def ground(nx, ny, box, hole=None):
    """`hole`: (i, j) of a post without a height."""
    (x0, y0, _), (x1, y1, _) = box
    dx, dy = (x1 - x0) / (nx - 1), (y1 - y0) / (ny - 1)
    heights = array.array("f", [hills((i * dx) / 1000, (j * dy) / 1000)
                                for j in range(ny) for i in range(nx)])
    if hole:
        heights[hole[1] * nx + hole[0]] = math.nan
    return {"nx": nx, "ny": ny, "x0": x0, "y0": y0, "dx": dx, "dy": dy,
            "heights": packed("f", heights), "of": None}


def thing(role, layer=None, **keys):
    return {"layer": layer or role, "role": role, "known": True, "name": f"a {role}",
            "added_by": None, "removed_by": None, **keys}


def profile_of(route, ground_height, speed=20.0):
    """Samples along the route, some thirty a leg."""
    made = {key: [] for key in ("s", "at", "altitude", "ground", "clearance", "speed", "turn")}
    s = 0.0
    for leg, (a, b) in enumerate(zip(route, route[1:])):
        length = math.dist(a, b)
        for k in range(31 if leg == len(route) - 2 else 30):
            at = [p + (q - p) * k / 30 for p, q in zip(a, b)]
            height = ground_height(at[0], at[1])
            made["s"].append(s + length * k / 30)
            made["at"].append(at)
            made["altitude"].append(at[2])
            made["ground"].append(height)
            made["clearance"].append(None if height is None else
                                     min(at[2] - height, 300 + 80 * math.sin(s / 900 + k / 9)))
            made["speed"].append(speed + 3 * math.sin((s + k) / 700))
            turn = None
            if k == 0 and leg > 0:
                p = route[leg - 1]
                turn = abs(math.degrees(math.atan2(b[1] - a[1], b[0] - a[0])
                                        - math.atan2(a[1] - p[1], a[0] - p[0])))
                turn = min(turn, 360 - turn)
            made["turn"].append(turn)
        s += length
    return made


def step(ident, plugin, route, stands=True, status="solved", message="", check=None):
    return {"id": ident, "verb": "plan", "plugin": plugin, "instead_of": None, "accepted": stands,
            "status": status, "message": message, "route": route, "metrics": None, "check": check}


def metrics(route):
    length = sum(math.dist(a, b) for a, b in zip(route, route[1:])) if route else None
    return {"length_m": length, "waypoints": len(route) if route else None,
            "max_turn_deg": 41.5 if route else None, "min_clearance_m": 62.25 if route else None,
            "min_radius_m": 2.2753e15 if route else None,
            "duration_s": length / 20 if route else None, "plan_time_s": 0.0125, "expanded": 4321}


def result(name, route, steps, status="solved", message="", check=None, profile=None):
    return {"name": name, "file": f"{name}.json", "status": status, "message": message, "seed": 1,
            "metrics": metrics(route), "check": check or {"ok": True, "violations": []},
            "steps": steps, "route": route,
            "limits": {"clearance_m": 60.0, "ground_clearance_m": 60.0, "turn_deg": 45.0,
                       "climb_deg": None},
            "profile": profile, "flight": None, "trace": None}


def violation(constraint, at, value, limit):
    return {"constraint": constraint, "at": at, "value": value, "limit": limit,
            "message": f"{constraint} is {value} at waypoint {at}, allowed {limit}."}


def trace(count, box, events):
    """A tree that grows from the south-west: point k hangs on point k // 2."""
    (x0, y0, _), (x1, y1, _) = box
    points = []
    for k in range(count):
        share = (k / count) ** 0.7
        swing = math.sin(k * 12.9898) * 43758.5453
        swing -= math.floor(swing)
        angle = math.radians(5 + 80 * swing)
        points.append((x0 + share * (x1 - x0) * math.cos(angle),
                       y0 + share * (y1 - y0) * math.sin(angle), 1100.0))
    kinds = [1 if k % 10 else 3 for k in range(count)]
    kinds[-1] = 2
    points[-1] = points[-2]
    flat = [value for point in points for value in point]
    parents = [value for k in range(count) for value in points[k // 2]]
    return {"events": events, "kept": count, "steps": ["search"], "step": packed("B", [0] * count),
            "kind": packed("B", kinds), "at": packed("f", flat), "parent": packed("f", parents),
            "value": packed("f", [0.0] * count), "iterations": iterations([]), "order": None}


def iterations(rows):
    """Of each its number, mean and how many are alive, -1 where it is of no population."""
    numbers, means, alive = zip(*rows) if rows else ([], [], [])
    return {"number": packed("f", numbers), "mean": packed("f", means),
            "alive": packed("f", alive)}


def with_iterations(events, rows, kept_of=1, steps=("search",)):
    """A trace of events (kind, at, parent, value)."""
    flat = [value for event in events for value in event[1]]
    parents = [value for event in events for value in event[2]]
    return {"events": len(events) * kept_of, "kept": len(events), "steps": list(steps),
            "step": packed("B", [0] * len(events)), "kind": packed("B", [e[0] for e in events]),
            "at": packed("f", flat), "parent": packed("f", parents),
            "value": packed("f", [e[3] for e in events]), "iterations": iterations(rows),
            "order": None}


def colony(start, goal, kept_of=1):
    """Five iterations of three ants, who all die in the first; each next route is straighter."""
    events, rows = [], []
    ants = 3
    for number in range(1, 6):
        alive = 0 if number == 1 else ants
        best = math.nan if number == 1 else 13000.0 - 500 * number
        rows.append((number, best + 250, alive))
        events.append((ITERATION, goal, goal, best))
        for ant in range(alive):
            aside = 400.0 * (6 - number) * (ant + 1)
            nodes = [start, [start[0] + 3000 - aside, start[1] + 2000 + aside, start[2]], goal]
            for before, node in zip([nodes[0], *nodes], nodes):
                events.append((ADDED, node, before, 0.0))
    return with_iterations(events, rows, kept_of)


def improvements(start, goal):
    """A tree of twelve nodes, found to be shorter twice."""
    events, rows = [], []
    for node in range(12):
        at = [start[0] + 600.0 * node, start[1] + 400.0 * node, start[2]]
        events.append((ADDED, at, start, 0.0))
        if node in (4, 9):
            rows.append((100 * node, math.nan, -1))
            events.append((ITERATION, goal, goal, 12000.0 - 100 * node))
    return with_iterations(events, rows)


def empty(box, title="Test scene"):
    return {"altiplan_scene": 1, "title": title, "attribution": [], "box": box,
            "corners_lonlat": None, "start": None, "goal": None, "via": [], "ground": None,
            "solids": [], "boxes": [], "meshes": [], "moving": [], "events": [], "notes": [],
            "results": []}


def flight(route, times_of_events):
    """Twelve seconds a leg, a little off the route."""
    track, t = [], 0.0
    for leg, (a, b) in enumerate(zip(route, route[1:])):
        for k in range(12):
            at = [p + (q - p) * k / 12 for p, q in zip(a, b)]
            track.append([t, at[0] + 60 * math.sin(t / 9), at[1] + 60 * math.cos(t / 7) - 60,
                          at[2]])
            t += 1.0 + leg * 0.25
    track.append([t, *route[-1]])
    return {"status": "collided", "message": "The vehicle came to touch post at 31.5 s.",
            "metrics": metrics(route), "check": {"ok": False, "violations": [
                violation("clearance", 20, 12.5, 60)]},
            "collisions": 1, "min_separation_m": -0.4, "reached": True,
            "handovers": [{"at_s": 8.0, "to": "avoid", "why": "an obstacle is near"},
                          {"at_s": 15.0, "to": "route", "why": "it has passed"}],
            "replans": [{"at_s": 22.0, "step": "again", "status": "solved",
                         "message": "the way is blocked"}],
            "track": track, "event_times": times_of_events,
            "profile": {"t": [row[0] for row in track],
                        "s": [30.0 * row[0] for row in track],
                        "altitude": [row[3] for row in track],
                        "ground": [hills(row[1] / 1000, row[2] / 1000) for row in track],
                        "clearance": [abs(80 - 2 * row[0]) for row in track],
                        "speed": [20 + math.sin(row[0] / 5) for row in track],
                        "turn": [None] * len(track)}}


def ridge(nx=101, ny=81):
    """All that a scene can hold, over 10 × 8 km of hills."""
    box = [[0.0, 0.0, 100.0], [10000.0, 8000.0, 2000.0]]
    height = lambda x, y: hills(x / 1000, y / 1000)
    scene = empty(box, "Ridge crossing")
    scene["attribution"] = ["Terrain: made of sines"]
    scene["corners_lonlat"] = [[8.0, 46.0], [8.13, 46.0], [8.13, 46.072], [8.0, 46.072]]
    scene["start"] = [700.25, 1200.5, 1000.0]
    scene["goal"] = {"at": [9300.0, 6800.0, 1150.0], "tolerance": 50.0}
    scene["via"] = [{"at": [3500.0, 5600.0, 1200.0], "tolerance": 80.0}]
    scene["ground"] = ground(nx, ny, box)
    scene["solids"] = [
        thing("threat", "radar", name="radar north", shape="sphere", at=[6900.0, 2600.0, 620.0],
              radius=1100.0),
        thing("obstacle", "masts", name="mast", shape="cylinder", at=[2200.0, 2600.0],
              radius=120.0, floor=None, ceiling=1250.0),
        thing("obstacle", "masts", name="block", shape="box", min=[2600.0, 1200.0, 300.0],
              max=[3100.0, 1600.0, 1150.0]),
        thing("keep_out", "zones", name="reserve", shape="prism",
              outline=[[7000, 4300], [8600, 4600], [8300, 5800], [7200, 5700]],
              holes=[[[7500, 4900], [7900, 4900], [7900, 5300], [7500, 5300]]],
              floor=None, ceiling=1500.0),
        thing("keep_in", "fence", name="fence", shape="prism",
              outline=[[200, 200], [9800, 200], [9800, 7800], [200, 7800]], holes=[],
              floor=None, ceiling=1900.0),
        thing("threat", "pop-up", name="pop-up radar", known=False, added_by=0, removed_by=1,
              shape="sphere", at=[5200.0, 6600.0, 700.0], radius=700.0),
    ]
    scene["boxes"] = [thing("obstacle", "houses", count=60, data=packed("f", [
        value for k in range(60) for x, y in [(1200 + 90 * (k % 10), 4600 + 110 * (k // 10))]
        for value in (x, y, height(x, y) - 20, x + 50, y + 60, height(x, y) + 40 + 15 * (k % 7))]))]
    tent = [(4200, 900, 500), (4900, 900, 500), (4550, 1500, 500), (4550, 1100, 1200)]
    scene["meshes"] = [thing("obstacle", "tent", triangles=packed("f", [
        float(value) for face in ((0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3))
        for corner in face for value in tent[corner]]))]
    scene["moving"] = [{"id": "balloon", "known": True, "since_s": 0.0,
                        "velocity": [60.0, 0.0, 0.0],
                        "added_by": None, "removed_by": None, "shape": "sphere",
                        "at": [1000.0, 7000.0, 1400.0], "radius": 180.0}]
    scene["events"] = [{"text": "a radar appears"}, {"text": "the radar is gone"}]
    scene["notes"] = ["The tent is drawn with 4 triangles."]
    first = [[700.25, 1200.5, 1000.0], [2000.0, 4100.0, 1080.0], [3500.0, 5600.0, 1200.0],
             [5400.0, 7000.0, 1300.0], [7000.0, 7200.0, 1250.0], [9300.0, 6800.0, 1150.0]]
    second = [[700.25, 1200.5, 1000.0], [3700.0, 2300.0, 1050.0], [5300.0, 2200.0, 1500.0],
              [5700.0, 3900.0, 1500.0], [6600.0, 6200.0, 1250.0], [9300.0, 6800.0, 1150.0]]
    early = [[700.25, 1200.5, 1000.0], [5300.0, 4400.0, 1000.0], [9300.0, 6800.0, 1150.0]]
    broken = {"ok": False, "violations": [violation("ground_clearance", 1, -12.0, 60)]}
    around = result("around", first, [
        step("search", "rrt_star", early, False, "rejected", "The leg goes through the ridge.",
             broken),
        step("again", "astar", first)], profile=profile_of(first, height))
    around["flight"] = flight(first, [10.0, 40.0])
    around["flight"]["check"]["violations"].append(violation("turn", 3, 51.0, 45))
    around["trace"] = trace(600, [[700, 1200, 0], [9300, 6800, 0]], 3000)
    over = result("over", second, [step("search", "astar", second)],
                  profile=profile_of(second, height),
                  check={"ok": False, "violations": [violation("clearance", 2, 31.0, 60)]})
    sealed = result("sealed", None, [step("search", "astar", None, False, "no_route",
                                          "The goal is closed in by wall.")],
                    "no_route", "No route: the goal is closed in by wall.")
    scene["results"] = [around, over, sealed]
    return scene
