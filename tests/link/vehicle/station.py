# SPDX-License-Identifier: Apache-2.0
"""A scripted ground station for the vehicle's own tests, in the same process and in lock-step."""
import math

import codec
import faults
import flavours
import vehicle
from constants import MISSION, Command, Frame, MissionResult
from node import Node

STEP = 0.02
HOME = (47.0, 8.0, 500.0)


def make_node(arguments="", rules=(), log=None):
    home = ",".join(str(value) for value in HOME)
    options = vehicle.options_of(["--home", home, *arguments.split()])
    options.faults = faults.Faults(rules, options.seed)
    return Node(options, options.flavour(), log)


def item(command, lat=0.0, lon=0.0, z=0.0, params=(0.0, 0.0, 0.0, 0.0),
         frame=Frame.GLOBAL_RELATIVE_ALT):
    return {"command": int(command), "frame": int(frame), "x": round(lat * 1e7),
            "y": round(lon * 1e7), "z": z, "autocontinue": 1,
            **{f"param{i + 1}": value for i, value in enumerate(params)}}


def waypoint(lat, lon, z, **more):
    return item(Command.NAV_WAYPOINT, lat, lon, z, **more)


def square(count=6):
    """Waypoints on a circle about home, at altitudes that differ."""
    return [waypoint(HOME[0] + 1e-3 * math.cos(i), HOME[1] + 1e-3 * math.sin(i), 20.0 + 1.5 * i)
            for i in range(count)]


class Station:
    def __init__(self, node, system=255, address="station", signer=None):
        self.node, self.system, self.address = node, system, address
        self.encoder = codec.Encoder(system, 190, signer)
        self.parser = codec.Parser(signer)
        self.received = []
        self.heartbeat_at = 0.0
        self.every_step = None  # called after each step
        self.others = {}  # stations that share the vehicle, by address

    def send(self, name, **fields):
        self.node.receive(self.encoder.frame(name, fields), self.address)

    def step(self):
        if self.node.now >= self.heartbeat_at:
            self.heartbeat_at += 1.0
            self.send("HEARTBEAT", type=6, autopilot=8, mavlink_version=3)
        self.node.step(STEP)
        for packet, address in self.node.take_outbox():
            receiver = self if address == self.address else self.others.get(address)
            if receiver:
                receiver.received += receiver.parser.feed(packet) + receiver.parser.end_datagram()
        if self.every_step:
            self.every_step()

    def run(self, seconds, until=None):
        """True as soon as the condition holds."""
        end = self.node.now + seconds
        while self.node.now < end - 1e-9:
            self.step()
            if until and until():
                return True
        return until is None

    def all(self, name):
        return [message for message in self.received if message.name == name]

    def last(self, name):
        return next((m for m in reversed(self.received) if m.name == name), None)

    def wait(self, names, seconds):
        """The next message of these names."""
        seen = len(self.received)
        found = []

        def came():
            found.extend(m for m in self.received[seen:] if m.name in names)
            return bool(found)
        self.run(seconds, came)
        return found[0] if found else None

    # The mission protocol.

    def upload(self, items, kind=MISSION, seconds=60.0):
        """The vehicle's result, or None if it did not come to an end."""
        end = self.node.now + seconds
        seen, heard_at = len(self.received), -math.inf
        while self.node.now < end:
            if self.node.now - heard_at > 1.5:
                self.send("MISSION_COUNT", target_system=1, target_component=1, count=len(items),
                          mission_type=kind)
                heard_at = self.node.now
            self.step()
            for message in self.received[seen:]:
                heard_at = self.node.now if message.name.startswith("MISSION_") and \
                    message.name != "MISSION_CURRENT" else heard_at
                result = self.answer(message, items, kind)
                if result is not None:
                    return result
            seen = len(self.received)
        return None

    def answer(self, message, items, kind):
        if message.fields.get("target_system") != self.system or \
                message.fields.get("mission_type") != kind:
            return None
        if message.name in ("MISSION_REQUEST", "MISSION_REQUEST_INT"):
            if message.seq < len(items):
                self.send_item(items, message.seq, kind)
        elif message.name == "MISSION_ACK" and message.type != MissionResult.INVALID_SEQUENCE:
            return MissionResult(message.type)
        return None

    def send_item(self, items, sequence, kind=MISSION):
        self.send("MISSION_ITEM_INT", target_system=1, target_component=1, seq=sequence,
                  mission_type=kind, **items[sequence])

    def ask(self, name, answers, seconds=20.0, matches=lambda message: True, **fields):
        """Sends until a matching answer comes."""
        end = self.node.now + seconds
        while self.node.now < end:
            self.send(name, target_system=1, target_component=1, **fields)
            answer = self.wait(answers, 0.5)
            if answer and matches(answer):
                return answer
        return None

    def download(self, kind=MISSION):
        count = self.ask("MISSION_REQUEST_LIST", ("MISSION_COUNT",), mission_type=kind)
        items = []
        for sequence in range(count.count):
            answer = self.ask("MISSION_REQUEST_INT", ("MISSION_ITEM_INT",), mission_type=kind,
                              matches=lambda m, s=sequence: m.seq == s, seq=sequence)
            names = ("command", "frame", "x", "y", "z", "autocontinue", "param1", "param2",
                     "param3", "param4")
            items.append({name: answer.fields[name] for name in names})
        self.send("MISSION_ACK", target_system=1, target_component=1, mission_type=kind)
        return items

    # Commands.

    def command(self, command, *params, **place):
        """MAV_RESULT of COMMAND_LONG, or of COMMAND_INT if a place is given."""
        values = {f"param{i + 1}": value for i, value in enumerate(params)}
        name = "COMMAND_INT" if place else "COMMAND_LONG"
        seen = len(self.received)
        self.send(name, target_system=1, target_component=1, command=int(command), **values,
                  **place)
        self.run(0.5, lambda: any(m.name == "COMMAND_ACK" for m in self.received[seen:]))
        answer = self.last("COMMAND_ACK")
        return answer.result if answer else None

    def set_mode(self, mode):
        numbers = flavours.mode_numbers(self.node.pilot.flavour, self.node.pilot.kind)
        if numbers is None:
            return self.command(Command.DO_SET_MODE, flavours.BASE_FLAGS[mode])
        if self.node.pilot.flavour.name == "px4":
            number = numbers[mode]
            return self.command(Command.DO_SET_MODE, 1, number >> 16 & 255, number >> 24)
        return self.command(Command.DO_SET_MODE, 1, numbers[mode])

    def arm(self):
        return self.command(Command.COMPONENT_ARM_DISARM, 1)

    def texts(self):
        return [message.text for message in self.all("STATUSTEXT")]
