# SPDX-License-Identifier: Apache-2.0
"""A strict reader of ground-station files, independent of the framework's: QGroundControl's
requirements on a .plan, and the columns of QGC WPL 110. Raises Wrong."""
import json
import math

NUMBER = (int, float)
FRAMES = (0, 2, 3, 10)  # sea level, no position, relative to home, above ground
PLACES = (16, 17, 18, 19, 21, 22, 31, 82, 84, 85)


class Wrong(Exception):
    pass


def expect(condition, message):
    if not condition:
        raise Wrong(message)


def keys(where, value, required):
    """Checks that every key has a value of its type; True is not a number here."""
    expect(isinstance(value, dict), f"{where}: no object")
    for key, kind in required.items():
        expect(key in value, f"{where}: no {key}")
        expect(isinstance(value[key], kind) and (kind is bool or not isinstance(value[key], bool)),
               f"{where}.{key}: {value[key]!r}")


def place(where, lat, lon):
    expect(isinstance(lat, NUMBER) and isinstance(lon, NUMBER) and abs(lat) <= 90
           and abs(lon) <= 180, f"{where}: {lat!r}, {lon!r}")


def simple_item(where, item):
    keys(where, item, {"autoContinue": bool, "command": int, "doJumpId": int, "frame": int,
                       "params": list, "type": str})
    expect(item["frame"] in FRAMES, f"{where}: frame {item['frame']}")
    params = item["params"]
    if "coordinate" in item:
        expect(len(params) == 4 and len(item["coordinate"]) == 3, f"{where}: old form")
        params = params + item["coordinate"]
    expect(len(params) == 7, f"{where}: {len(params)} params")
    expect(all(p is None or isinstance(p, NUMBER) and math.isfinite(p) for p in params),
           f"{where}: params {params}")
    if item["command"] in PLACES:
        expect(item["frame"] != 2, f"{where}: a place without a frame")
        place(where, params[4], params[5])
        expect(isinstance(params[6], NUMBER), f"{where}: altitude")
    if "AltitudeMode" in item:
        keys(where, item, {"Altitude": NUMBER, "AltitudeMode": int})
        expect("AMSLAltAboveTerrain" in item, f"{where}: no AMSLAltAboveTerrain")
        expect(item["Altitude"] == params[6], f"{where}: two altitudes")


def items(mission):
    numbers = []
    for n, item in enumerate(mission["items"]):
        where = f"mission.items[{n}]"
        keys(where, item, {"type": str})
        if item["type"] == "ComplexItem":
            keys(where, item, {"complexItemType": str, "version": int})
            continue
        expect(item["type"] == "SimpleItem", f"{where}: {item['type']}")
        simple_item(where, item)
        numbers.append(item["doJumpId"])
    expect(len(set(numbers)) == len(numbers), "doJumpId twice")


def fence(value):
    keys("geoFence", value, {"version": int})
    if value["version"] == 1:
        keys("geoFence", value, {"polygon": list})
        return
    expect(value["version"] == 2, "geoFence.version")
    keys("geoFence", value, {"circles": list, "polygons": list})
    for polygon in value["polygons"]:
        keys("polygon", polygon, {"inclusion": bool, "polygon": list, "version": int})
        expect(polygon["version"] == 1 and len(polygon["polygon"]) >= 3, "polygon")
        for corner in polygon["polygon"]:
            expect(len(corner) == 2, "corner")
            place("corner", *corner)
        expect(polygon["polygon"][0] != polygon["polygon"][-1], "polygon closed")
    for circle in value["circles"]:
        keys("circle", circle, {"inclusion": bool, "circle": dict, "version": int})
        keys("circle", circle["circle"], {"center": list, "radius": NUMBER})
        place("circle", *circle["circle"]["center"])
        expect(circle["version"] == 1 and circle["circle"]["radius"] > 0, "circle")


def plan(text):
    """The plan as JSON; must be of version 1 with a mission of version 2."""
    try:
        value = json.loads(text)
    except ValueError as error:
        raise Wrong(str(error)) from error
    keys("plan", value, {"fileType": str, "version": int, "groundStation": str, "mission": dict,
                         "geoFence": dict, "rallyPoints": dict})
    expect(value["fileType"] == "Plan" and value["version"] == 1, "no plan of version 1")
    mission = value["mission"]
    keys("mission", mission, {"version": int, "firmwareType": int, "vehicleType": int,
                              "cruiseSpeed": NUMBER, "hoverSpeed": NUMBER, "items": list,
                              "plannedHomePosition": list})
    expect(mission["version"] == 2, "mission.version")
    home = mission["plannedHomePosition"]
    expect(len(home) == 3 and isinstance(home[2], NUMBER), "plannedHomePosition")
    place("plannedHomePosition", home[0], home[1])
    items(mission)
    fence(value["geoFence"])
    keys("rallyPoints", value["rallyPoints"], {"version": int, "points": list})
    expect(value["rallyPoints"]["version"] in (1, 2), "rallyPoints.version")
    return value


def waypoints(text):
    """Rows of twelve numbers, the first of them home or a fence point."""
    lines = text.splitlines()
    expect(lines and lines[0] == "QGC WPL 110", "no QGC WPL 110")
    rows = []
    for line in lines[1:]:
        if not line.strip():
            continue
        cells = line.split("\t")
        expect(len(cells) == 12, f"{len(cells)} columns")
        try:
            row = [float(cell) for cell in cells]
        except ValueError as error:
            raise Wrong(str(error)) from error
        expect(row[0] == len(rows), f"item {cells[0]}")
        expect(row[1] in (0, 1) and row[11] in (0, 1), "flags")
        expect(row[2] in FRAMES, f"frame {cells[2]}")
        if row[3] in PLACES:
            place(f"item {cells[0]}", row[8], row[9])
        rows.append(row)
    expect(rows, "no item")
    return rows
