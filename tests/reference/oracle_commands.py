# SPDX-License-Identifier: Apache-2.0
"""What each autopilot does with each mission command at upload and before take-off, and the order in which
the items of a mission are flown."""
import math

ARDUPILOT, PX4 = 3, 12
COPTERS = {2, 3, 4, 13, 14, 15, 29, 35}
VTOLS = set(range(19, 26))
KINDS = ("AC", "AF", "QP", "PM", "PF", "PV")  # ArduCopter, ArduPlane, QuadPlane; PX4 multirotor, plane, VTOL

# V flown, J jump, S speed, H home, D delay, N neither flown nor held, P payload or marker, E ends the flight,
# K stored and skipped, ? another program decides, U refused at upload, X refused before take-off.
TABLE = """
16 17 19 20 21 31     V V V V V V
22                    V V V V V V
18                    V V V U U U
30                    K V V U U U
36                    V K K U U U
80 195 197 201        P P P P P P
82                    V U U U U U
83                    K ? ? U U U
84 85                 V K V X X V
92                    ? K K U U U
93                    D D D D D D
94                    V K V U U U
112 114               N N N X X X
115                   P K K U U U
177                   J J J J J J
178                   S S S S S S
179                   H H H H H H
181 182 183 184 202   P P P U U U
203 205 206 211       P P P P P P
216 215 217 207 188   P P P U U U
187 196 200 204 214   U U U P P P
189                   P P P P P P
191                   K P P U U U
193 194 213           K K K U U U
210 212               K P P U U U
222                   P K K U U U
223                   K E E U U U
208                   E E E U U U
218                   ? ? ? U U U
260                   U U U P P P
400                   U U U E E E
530 1001 2003         U U U P P P
531                   P P P U U U
532 534 1000 2000 2001 2500 2501 P P P P P P
600                   P P P U U U
601                   J J J U U U
3000                  K K V X X V
4501                  U U U P P P
42600                 P K K P P P
42702                 ? ? ? U U U
42703                 ? K K U U U
"""
CODES = {}
for _line in TABLE.strip().splitlines():
    _words = _line.split()
    for _number in _words[:-6]:
        CODES[int(_number)] = dict(zip(KINDS, _words[-6:], strict=True))

POSITIONS = {16, 17, 18, 19, 21, 22, 30, 31, 36, 82, 84, 85, 94}
LANDINGS, TAKEOFFS = {21, 85}, {22, 84}
MAX_STEPS = 150


def code(command, kind):
    return CODES.get(command, {}).get(kind, "U")


def kind_of(firmware, vehicle):
    """None for what section 8 has no column for: then the worst of several counts."""
    column = 0 if vehicle in COPTERS else 1 if vehicle == 1 else 2 if vehicle in VTOLS else None
    if column is None or firmware not in (ARDUPILOT, PX4):
        return None
    return KINDS[column + (3 if firmware == PX4 else 0)]


class Item:
    def __init__(self, number, entry, world):
        self.number, self.command, self.frame = number, entry["command"], entry["frame"]
        values = [math.nan if v is None else float(v) for v in entry["params"]]
        self.p, (self.lat, self.lon, self.alt) = [math.nan, *values[:4]], values[4:7]
        self.goes_on = entry.get("autoContinue", True)
        self.nowhere = not (self.lat or self.lon)
        self.place = world.to_local(self.lat, self.lon)

    def param(self, number):
        """0 where it is not given."""
        return 0.0 if math.isnan(self.p[number]) else self.p[number]


class Mission:
    def __init__(self, plan, world):
        body = plan["mission"]
        self.kind = kind_of(body["firmwareType"], body["vehicleType"])
        self.is_px4 = body["firmwareType"] == PX4
        lat, lon, height = body["plannedHomePosition"]
        self.home = (*world.to_local(lat, lon), float(height))
        self.items = [Item(n + 1, entry, world) for n, entry in enumerate(body["items"])]
        self.rally = [(*world.to_local(lat, lon), height) for lat, lon, height in plan["rallyPoints"]["points"]]


def refusals(mission):
    """Reasons why the autopilot does not take the mission."""
    kind, found = mission.kind, []
    for item in mission.items:
        does = code(item.command, kind)
        if does in "UX":
            found.append(f"item {item.number}: command {item.command} is refused")
        found += px4_item(item) if mission.is_px4 else ardupilot_item(item, len(mission.items))
    if mission.is_px4:
        found += px4_feasibility(mission)
    return found


def ardupilot_item(item, count):
    found = []
    if item.command in POSITIONS and item.frame not in (0, 2, 3, 5, 6, 10, 11):
        found.append(f"item {item.number}: frame {item.frame}")
    if item.command == 82 and any(map(math.isnan, item.p[1:])):
        found.append(f"item {item.number}: NaN in a spline")
    if item.command in POSITIONS and abs(item.alt) >= 83000:
        found.append(f"item {item.number}: altitude out of range")
    if item.command == 177 and not 1 <= item.param(1) <= count:
        found.append(f"item {item.number}: jump to no item")
    return found


def px4_item(item):
    found = []
    placed = item.command in POSITIONS or item.command == 4501
    if item.command not in (80, 195, 197, 201) and item.frame not in ((0, 3, 5, 6) if placed else (2,)):
        found.append(f"item {item.number}: frame {item.frame} of command {item.command}")
    if placed and item.nowhere:
        found.append(f"item {item.number}: at 0 N 0 E")
    return found


def px4_feasibility(mission):
    """What PX4 checks once the mission is stored."""
    found, kind = [], mission.kind
    placed = [item for item in mission.items if item.command in POSITIONS]
    takeoffs = [item for item in placed if item.command in TAKEOFFS]
    if any(item is not placed[0] for item in takeoffs):
        found.append("take-off is not the first position")
    if placed and placed[0].command in LANDINGS:
        found.append("landing is the first position")
    for item in takeoffs:
        if item.alt - (mission.home[2] if item.frame in (0, 5) else 0) <= 0:
            found.append("take-off not above home")
    lands = any(item.command in LANDINGS for item in placed)
    if kind != "PM" and not lands:
        found.append("no landing")
    starts = [item for item in mission.items if item.command == 189]
    if starts and any(item.command == 20 and item.number > starts[0].number for item in mission.items):
        found.append("return behind a landing start")
    if len(starts) > 1 or starts and not lands:
        found.append("landing starts without landing, or two of them")
    if kind == "PF":
        found += glide_slopes(placed, mission.home[2])
    return found


def glide_slopes(placed, home):
    found = []
    for before, item in zip(placed, placed[1:]):
        if item.command != 21:
            continue
        run = math.dist(before.place, item.place)
        drop, level = (i.alt + (home if i.frame in (3, 6) else 0) for i in (before, item))
        if before.command not in (16, 31):
            found.append(f"item {item.number}: landing entered from command {before.command}")
        elif drop <= level + 0.5 or drop - level > run * math.tan(math.radians(5.2)):
            found.append(f"item {item.number}: glide slope")
        elif before.command == 31 and run <= (abs(before.param(2)) or 80) * 1.01:
            found.append(f"item {item.number}: landing point within the circle before it")
    return found


def faults(mission):
    """What section 8 calls a failure although the autopilot takes it; and what is not to be judged."""
    found, unjudged = [], []
    for item in mission.items:
        does, name = code(item.command, mission.kind), f"item {item.number}"
        if does == "?" and (item.command != 92 or item.param(1) >= 1):
            found.append(f"{name}: another program decides what command {item.command} flies")
        if item.command == 218 and does == "?":
            found.append(f"{name}: may switch the mode")
        if item.command == 223 and does == "E" and item.param(1) == 0:
            found.append(f"{name}: stops the engine")
        if item.command == 400 and does == "E" and item.param(1) == 0:
            found.append(f"{name}: disarms")
        if mission.is_px4 and not item.goes_on and item is not mission.items[-1]:
            found.append(f"{name}: autoContinue is false, the mission stops there")
        if mission.is_px4 and item.command == 179 and item.param(1) != 1:
            found.append(f"{name}: home set to a place that is read unscaled")
        before = mission.items[item.number - 2] if item.number > 1 else None
        is_above = before is not None and before.command == 16 and before.frame == item.frame != 10 and (
            before.alt > item.alt + 3)  # it ends at once
        if mission.kind == "AF" and item.command == 22 and not is_above:
            unjudged.append(f"{name}: take-off along an unknown course")
        if mission.kind == "QP" and item.command in TAKEOFFS and item.frame in (0, 2, 5):
            found.append(f"{name}: take-off of a QuadPlane above the sea")
    return found, unjudged


class Order:
    """Items as flown, jumps unrolled: `steps`; `never_ends` if a loop has no end."""

    def __init__(self, mission):
        self.steps, self.never_ends, self.doubts = [], False, []
        self.items, self.is_px4 = mission.items, mission.is_px4
        self.done = {}
        n = 0
        while n < len(self.items) and len(self.steps) < MAX_STEPS and not self.never_ends:
            item = self.items[n]
            n = n + 1 if code(item.command, mission.kind) != "J" else self.jump(item, n)
            if n is None:
                break
            if code(item.command, mission.kind) != "J":
                self.steps.append(item)
        if len(self.steps) >= MAX_STEPS:
            self.doubts.append("too many steps")

    def jump(self, item, n):
        """A lap flown three times is flown as often as anybody likes."""
        target, repeats = int(item.param(1)) - 1, int(item.param(2))
        if item.command == 601:
            target = next((k for k, i in enumerate(self.items)
                           if i.command == 600 and i.param(1) == item.param(1)), None)
        if target is None or not 0 <= target < len(self.items):
            return None
        if repeats < -1 and not self.is_px4:
            repeats = 0  # none
        if repeats < 0 and self.is_px4:
            self.doubts.append("PX4 has no jumps for ever")
            repeats = 65535
        forever = repeats < 0
        self.done[n] = self.done.get(n, 0) + 1
        if self.done[n] > (3 if forever else min(repeats, 3)):
            self.never_ends = forever
            return n + 1
        return target
