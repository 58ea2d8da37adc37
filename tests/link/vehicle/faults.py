# SPDX-License-Identifier: Apache-2.0
"""Faults on demand. A script is a list of rules, each an object with

  fault        lose | double | delay | reorder | damage: of packets
               silence: nothing is answered for `seconds`, or ever after without them
               nak: MISSION_ACK with `result` in place of the answer; ends an upload
               reboot: sequence numbers and transfers are lost, plans only if `loses_plans`;
               silent for `seconds` (2)
               disarm: its motors stop
               switch: its pilot changes to `mode` (HOLD)
               change: of stored items: `round_altitude` (m), `shift_lat` (degrees),
               `drop_command`, `refuse_frame`; of a mission that was acknowledged: `infeasible`,
               the reason for which it is declared invalid
  direction    in (to the vehicle) | out | both (of packets: both, else in)
  message      a name or a list of names; none: any
  kind         only messages of this mission_type; `seq`: only of this item, `command`: only of
               this MAV_CMD, `param1`: only with this number
  from, until  s since the script began; a silence, reboot, disarm or switch without `message`
               happens at `from`
  skip, count  the first `skip` matches pass, then at most `count` are met
  probability  of a match to be met (1)
  seconds      of a delay: a number, or [least, greatest]

All chances are of one generator, so a seed and the same packets give the same faults."""
import dataclasses
import heapq
import json
import math
import random

import codec
from constants import MissionResult

PACKET_FAULTS = ("lose", "double", "delay", "reorder", "damage")
EVENTS = ("silence", "reboot", "disarm", "switch")
FIELDS = {"kind": "mission_type", "seq": "seq", "command": "command", "param1": "param1"}
KEYS = {"fault", "direction", "message", *FIELDS, "from", "until", "skip", "count",
        "probability", "seconds", "result", "loses_plans", "round_altitude", "shift_lat",
        "drop_command", "refuse_frame", "infeasible", "mode"}
HELD_AT_MOST = 0.5  # s, of a packet that waits to be overtaken


class Rule:
    def __init__(self, declared, rng):
        unknown = set(declared) - KEYS
        if unknown:
            raise ValueError(f"a fault has the unknown key {sorted(unknown)[0]!r}")
        self.fault = declared["fault"]
        if self.fault not in PACKET_FAULTS + EVENTS + ("nak", "change"):
            raise ValueError(f"there is no fault {self.fault!r}")
        self.declared, self.rng = declared, rng
        both = "both" if self.fault in PACKET_FAULTS else "in"
        self.direction = declared.get("direction", both)
        names = declared.get("message", [])
        self.names = [names] if isinstance(names, str) else names
        self.begin, self.end = declared.get("from", 0.0), declared.get("until", math.inf)
        self.skip = declared.get("skip", 0)
        self.left = declared.get("count", math.inf)
        self.probability = declared.get("probability", 1.0)
        if self.fault == "nak":
            self.result = MissionResult[declared.get("result", "ERROR")]

    def timed(self):
        return self.fault in EVENTS and not self.names

    def fires(self, now, direction, message):
        """`message` is a codec.Received, or None for bytes without one."""
        if not self.begin <= now < self.end or self.left <= 0:
            return False
        if self.direction not in ("both", direction) or not self.matches(message):
            return False
        if self.skip > 0:
            self.skip -= 1
            return False
        if self.probability < 1.0 and self.rng.random() >= self.probability:
            return False
        self.left -= 1
        return True

    def matches(self, message):
        wanted = {key: self.declared[key] for key in FIELDS if key in self.declared}
        if not (self.names or wanted):
            return True
        fields = message.fields if message else {}
        return ((not self.names or (message is not None and message.name in self.names))
                and all(fields.get(FIELDS[key], 0 if key == "kind" else None) == value
                        for key, value in wanted.items()))

    def due(self, now):
        if not self.timed() or self.left <= 0 or now < self.begin:
            return False
        self.left = 0
        return True

    def seconds(self, default):
        value = self.declared.get("seconds", default)
        return self.rng.uniform(*value) if isinstance(value, list) else value


class Faults:
    def __init__(self, rules=(), seed=0):
        self.rng = random.Random(seed)
        self.rules = [Rule(rule, self.rng) for rule in rules]
        self.silent_until = 0.0
        self.waiting = []  # heap of (time, order, direction, packet, address)
        self.order = 0
        self.held = {"in": None, "out": None}
        self.reboots = []  # (seconds, loses_plans) to be done
        self.stops_motors = False  # is to be done
        self.switch_to = None  # a mode: is to be done
        self.now = 0.0  # of the last packet or step
        self.met = []  # names of faults since last asked, for the log

    def of_fault(self, *names):
        return (rule for rule in self.rules if rule.fault in names)

    def packet(self, now, direction, packet, address):
        """Packets that go on now in place of this one, as (packet, address); others wait."""
        self.now = now
        message = next(iter(codec.Parser().feed(packet)), None)
        passing = [packet]
        for rule in self.of_fault(*PACKET_FAULTS):
            if passing and rule.fires(now, direction, message):
                self.note(rule, direction, message)
                passing = getattr(self, rule.fault)(rule, now, direction, passing, address)
        for rule in self.of_fault(*EVENTS):
            if not rule.timed() and rule.fires(now, direction, message):
                self.note(rule, direction, message)
                self.stop(rule, now)
        if now < self.silent_until:
            return []
        return [(each, address) for each in passing] + self.overtaken(direction, passing)

    def lose(self, rule, now, direction, packets, address):
        return []

    def double(self, rule, now, direction, packets, address):
        return packets + packets

    def damage(self, rule, now, direction, packets, address):
        """A few bytes differ; now and then the end is missing."""
        damaged = bytearray(packets[0])
        for _ in range(self.rng.randint(1, 4)):
            damaged[self.rng.randrange(len(damaged))] ^= self.rng.randint(1, 255)
        if self.rng.random() < 0.2:
            del damaged[self.rng.randrange(1, len(damaged)):]
        return [bytes(damaged)] + packets[1:]

    def delay(self, rule, now, direction, packets, address):
        for packet in packets:
            self.wait(now + rule.seconds(0.5), direction, packet, address)
        return []

    def reorder(self, rule, now, direction, packets, address):
        """Held until another one has passed."""
        if self.held[direction] is not None:
            return packets
        self.held[direction] = (now + HELD_AT_MOST, packets, address)
        return []

    def overtaken(self, direction, passing):
        held = self.held[direction]
        if held is None or not passing:
            return []
        self.held[direction] = None
        return [(packet, held[2]) for packet in held[1]]

    def wait(self, until, direction, packet, address):
        self.order += 1
        heapq.heappush(self.waiting, (until, self.order, direction, packet, address))

    def stop(self, rule, now):
        if rule.fault == "disarm":
            self.stops_motors = True
        elif rule.fault == "switch":
            self.switch_to = rule.declared.get("mode", "HOLD")
        elif rule.fault == "reboot":
            self.reboots.append((rule.seconds(2.0), rule.declared.get("loses_plans", False)))
        else:
            self.silent_until = max(self.silent_until, now + rule.seconds(math.inf))

    def step(self, now):
        """Packets that have waited long enough, as (direction, packet, address)."""
        self.now = now
        for rule in self.rules:
            if rule.due(now):
                self.note(rule, "", None)
                self.stop(rule, now)
        for direction, held in self.held.items():
            if held is not None and now >= held[0]:
                for packet in held[1]:
                    self.wait(now, direction, packet, held[2])
                self.held[direction] = None
        released = []
        while self.waiting and self.waiting[0][0] <= now:
            _, _, direction, packet, address = heapq.heappop(self.waiting)
            if now >= self.silent_until:
                released.append((direction, packet, address))
        return released

    def nak(self, message):
        """The MissionResult that answers this message whatever it says, or None."""
        for rule in self.of_fault("nak"):
            if rule.fires(self.now, "in", message):
                self.note(rule, "in", message)
                return rule.result
        return None

    def changes(self):
        return [rule.declared for rule in self.of_fault("change")]

    def refuses(self, item):
        return any(change.get("refuse_frame") == item.frame for change in self.changes())

    def infeasible(self):
        """Why a whole mission is invalid, or None."""
        return next((rule.declared["infeasible"] for rule in self.of_fault("change")
                     if "infeasible" in rule.declared), None)

    def drops(self, item):
        return any(change.get("drop_command") == item.command for change in self.changes())

    def changed(self, item):
        for change in self.changes():
            step = change.get("round_altitude")
            if step:
                item = dataclasses.replace(item, z=round(item.z / step) * step)
            shift = round(change.get("shift_lat", 0.0) * 1e7)
            if shift:
                item = dataclasses.replace(item, x=item.x + shift)
        return item

    def note(self, rule, direction, message):
        self.met.append({"fault": rule.fault, "direction": direction,
                         "message": message.name if message else None})


def random_script(seed):
    """One to four rules of any kind, such as a bad link and a bad vehicle have."""
    rng = random.Random(seed)
    transfer = ["MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_REQUEST_LIST", "MISSION_REQUEST_INT"]

    def chance(fault, **more):
        return {"fault": fault, "direction": rng.choice(["in", "out", "both"]),
                "probability": round(rng.uniform(0.02, 0.3), 3), **more}

    menu = [
        lambda: chance("lose"), lambda: chance("double"), lambda: chance("reorder"),
        lambda: chance("damage"), lambda: chance("delay", seconds=[0.01, rng.uniform(0.1, 2.0)]),
        lambda: {"fault": "lose", "message": "MISSION_ACK", "count": rng.randint(1, 4)},
        lambda: {"fault": "nak", "message": rng.choice(transfer), "skip": rng.randint(0, 20),
                 "count": 1, "result": rng.choice(list(MissionResult)[1:]).name},
        lambda: {"fault": "silence", "message": rng.choice(transfer), "count": 1,
                 "skip": rng.randint(0, 20), "seconds": round(rng.uniform(0.5, 20.0), 2)},
        lambda: {"fault": "silence", "message": rng.choice(transfer), "skip": rng.randint(0, 20)},
        lambda: {"fault": "reboot", "message": rng.choice(transfer), "skip": rng.randint(0, 20),
                 "count": 1, "loses_plans": rng.random() < 0.5},
        lambda: {"fault": "change", "round_altitude": rng.choice([0.1, 1.0])}]
    return [rng.choice(menu)() for _ in range(rng.randint(1, 4))]


def of_text(text, seed):
    """Of JSON, or of a file that holds it: a list of rules, or an object with `rules`; `random`
    makes one of the seed."""
    if text == "random":
        return Faults(random_script(seed), seed)
    if not text.lstrip().startswith(("[", "{")):
        with open(text, encoding="utf-8") as file:
            text = file.read()
    script = json.loads(text)
    return Faults(script["rules"] if isinstance(script, dict) else script, seed)
