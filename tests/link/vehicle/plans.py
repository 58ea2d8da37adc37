# SPDX-License-Identifier: Apache-2.0
"""Plans as the vehicle stores them: what it refuses of an item, and what it keeps of it."""
import dataclasses
import math
import struct
import zlib

import geodesy
from constants import (ABSOLUTE, FENCE, GLOBAL_FRAMES, MISSION, OF_PLAN, POLYGON, RALLY, RELATIVE,
                       TERRAIN, Command, Frame, MissionResult)

NO_POSITION = (Command.DO_JUMP, Command.DO_CHANGE_SPEED, Command.CONDITION_DELAY,
               Command.NAV_RETURN_TO_LAUNCH, Command.DO_LAND_START)
# Where NaN means "as the vehicle likes": yaw.
NAN_YAW = (Command.NAV_WAYPOINT, Command.NAV_LOITER_UNLIM, Command.NAV_LOITER_TURNS,
           Command.NAV_LOITER_TIME, Command.NAV_LAND, Command.NAV_TAKEOFF,
           Command.NAV_LOITER_TO_ALT)
ARDUPILOT_NAN_YAW = (Command.NAV_WAYPOINT, Command.NAV_LOITER_UNLIM, Command.NAV_LAND,
                     Command.NAV_TAKEOFF)
# What ArduPilot makes of a parameter that it keeps: whole numbers, signs, flags; of the commands
# named here the other parameters come back as zero.
WHOLE, SIGN, FLAG, BYTE, TURNS, BYTE_RADIUS, YAW_SIGN = range(7)
ARDUPILOT_KEEPS = {
    Command.NAV_LOITER_UNLIM: {3: WHOLE}, Command.NAV_TAKEOFF: {1: WHOLE},
    Command.NAV_LOITER_TURNS: {1: TURNS, 3: BYTE_RADIUS, 4: FLAG},
    Command.NAV_LOITER_TIME: {1: WHOLE, 3: SIGN, 4: FLAG},
    Command.NAV_LOITER_TO_ALT: {2: WHOLE, 4: FLAG},
    Command.NAV_LAND: {1: WHOLE, 4: YAW_SIGN}, Command.NAV_RETURN_TO_LAUNCH: {}}
ARDUPILOT_WAYPOINT = {"copter": {1: WHOLE}, "plane": {2: BYTE, 3: BYTE}}
ARDUPILOT_HIGHEST = 83000.0  # m, of an item
ARDUPILOT_CORNERS = 255  # of a polygon


@dataclasses.dataclass(frozen=True)
class Item:
    command: int
    frame: int
    params: tuple  # four
    x: int  # 1e-7 degrees
    y: int
    z: float
    autocontinue: int = 1

    def lat_lon(self):
        return self.x / 1e7, self.y / 1e7


def of_message(message):
    """Of MISSION_ITEM_INT, or of MISSION_ITEM, whose degrees are floats."""
    x, y = message.x, message.y
    if message.name == "MISSION_ITEM":
        # What no integer of the message can be becomes the greatest, which is refused.
        x, y = (round(v * 1e7) if abs(v) < 200 else 2 ** 31 - 1 for v in (x, y))
    params = (message.param1, message.param2, message.param3, message.param4)
    return Item(message.command, message.frame, params, x, y, message.z, message.autocontinue)


def fields_of(item):
    return {"command": item.command, "frame": item.frame, "autocontinue": item.autocontinue,
            "x": item.x, "y": item.y, "z": item.z,
            **{f"param{i + 1}": value for i, value in enumerate(item.params)}}


def listed(item):
    """For the log."""
    return [item.command, item.frame, item.autocontinue, item.x, item.y, item.z, *item.params]


def refusal(item, kind, ardupilot=False):
    """MissionResult.ACCEPTED, or why the item is refused."""
    if item.command not in OF_PLAN[kind]:
        return MissionResult.UNSUPPORTED
    positioned = item.command not in NO_POSITION
    absolute_too = ardupilot and kind == MISSION and item.frame == Frame.MISSION
    if positioned and item.frame not in GLOBAL_FRAMES and not absolute_too:
        return MissionResult.UNSUPPORTED_FRAME
    may_be_nan = ARDUPILOT_NAN_YAW if ardupilot else NAN_YAW
    for i, value in enumerate(item.params):
        allowed = i == 3 and item.command in may_be_nan
        if not math.isfinite(value) and not (allowed and math.isnan(value)):
            return MissionResult(MissionResult.INVALID_PARAM1 + i)
    if positioned and abs(item.x) > 900_000_000:
        return MissionResult.INVALID_PARAM5_X
    if positioned and abs(item.y) > 1_800_000_000:
        return MissionResult.INVALID_PARAM6_Y
    if not math.isfinite(item.z) or (ardupilot and abs(item.z) >= ARDUPILOT_HIGHEST):
        return MissionResult.INVALID_PARAM7
    if ardupilot and item.command in POLYGON and item.params[0] > ARDUPILOT_CORNERS:
        return MissionResult.INVALID_PARAM1
    return MissionResult.ACCEPTED


def jumps_nowhere(item, count):
    """ArduPilot looks at a jump when it comes; home is no place to jump to."""
    return item.command == Command.DO_JUMP and not 0 < item.params[0] < count


def refusal_of_whole(items, kind):
    """What can only be seen of all items: polygons with all of their vertices, jumps that end."""
    if kind == FENCE:
        return polygons(items)
    if kind != RALLY:
        for item in items:
            if item.command == Command.DO_JUMP and not 0 <= item.params[0] < len(items):
                return MissionResult.INVALID_PARAM1
    return MissionResult.ACCEPTED


def polygons(items):
    i = 0
    while i < len(items):
        if items[i].command not in POLYGON:
            i += 1
            continue
        count = int(items[i].params[0])
        corners = items[i:i + count]
        same = all(corner.command == items[i].command and corner.params[0] == count
                   for corner in corners)
        if count < 3 or len(corners) < count or not same:
            return MissionResult.INVALID
        i += count
    return MissionResult.ACCEPTED


def single(value):
    """As a float of 32 bits."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def ardupilot_parameter(rule, value):
    """Fractions are cut off, not rounded."""
    value = value if math.isfinite(value) else 0.0
    size = abs(value)
    if rule == FLAG:
        return float(value > 0)
    if rule in (SIGN, YAW_SIGN):
        return -1.0 if value < 0 else 1.0
    if rule == BYTE:
        return float(min(255, int(size)))
    if rule == TURNS:
        return int(value * 256) / 256 if 0 < value < 1 else float(min(255, int(size)))
    if rule == BYTE_RADIUS:
        whole = int(size) if size <= 255 else 10 * min(255, int(size / 10))
        return float(math.copysign(whole, value))
    return float(math.copysign(int(size), value))


def plain_frame(frame):
    """Without _INT; an item without a frame is above sea level."""
    for group, plain in ((ABSOLUTE + (Frame.MISSION,), Frame.GLOBAL),
                         (RELATIVE, Frame.GLOBAL_RELATIVE_ALT),
                         (TERRAIN, Frame.GLOBAL_TERRAIN_ALT)):
        if frame in group:
            return int(plain)
    return frame


def as_ardupilot_keeps(item, airframe, kind):
    """Altitudes in whole centimetres, frames without _INT, yaw and others lost; of fences no
    altitude and no frame, of rally points whole metres."""
    if kind == FENCE:
        first = (item.params[0], 0.0, 0.0, 0.0)
        return dataclasses.replace(item, params=first, frame=int(Frame.GLOBAL), z=0.0,
                                   autocontinue=0)
    if kind == RALLY:
        return dataclasses.replace(item, params=(0.0,) * 4, z=float(int(item.z)), autocontinue=0,
                                   frame=plain_frame(item.frame))
    keeps = ARDUPILOT_WAYPOINT[airframe] if item.command == Command.NAV_WAYPOINT else \
        ARDUPILOT_KEEPS.get(item.command)
    params = item.params
    if keeps is not None:
        params = tuple(ardupilot_parameter(keeps[n], value) if n in keeps else 0.0
                       for n, value in enumerate(params, 1))
    if item.command in NO_POSITION and item.command != Command.DO_LAND_START:
        return dataclasses.replace(item, params=params, frame=0, x=0, y=0, z=0.0, autocontinue=1)
    centimetres = int(single(single(item.z) * 100))
    return dataclasses.replace(item, params=params, frame=plain_frame(item.frame), autocontinue=1,
                               z=single(centimetres * single(0.01)))


def home_item(home):
    return Item(Command.NAV_WAYPOINT, Frame.GLOBAL, (0.0, 0.0, 0.0, 0.0), round(home.lat * 1e7),
                round(home.lon * 1e7), home.alt)


def opaque_id(items):
    """Of the plan's contents; 0 is kept for "none"."""
    crc = 0
    for item in items:
        packed = struct.pack("<HB4fiif", item.command, item.frame, *item.params, item.x, item.y,
                             item.z)
        crc = zlib.crc32(packed, crc)
    return crc if items else 0


def target_of(item, home, here, terrain_height):
    """Where the item is; 0/0 is where the vehicle is."""
    lat, lon = item.lat_lon()
    if item.x == 0 and item.y == 0:
        lat, lon = here.lat, here.lon
    alt = item.z
    if item.frame in RELATIVE:
        alt += home.alt
    elif item.frame in TERRAIN:
        alt += terrain_height(lat, lon)
    return geodesy.Position(lat, lon, alt)
