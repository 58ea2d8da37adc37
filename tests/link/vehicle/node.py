# SPDX-License-Identifier: Apache-2.0
"""The whole vehicle without a socket: packets and steps of time in, packets out.

Two times: `now` is of the link (heartbeats, transfers, faults), pilot.time of the flight; a
speed-up makes the second one faster. A packet has an address of any kind; what the vehicle sends
goes to every address that it has heard lately."""
import struct

import codec
import messages
from commands import Commands
from constants import Severity
from faults import Faults
from flavours import mode_of
from missions import Missions
from pilot import Pilot
from telemetry import Telemetry
from terrain import Terrain

FLIGHT_STEP = 0.02  # s
POSITION_EVERY = 0.1  # s, in the log
FORGOTTEN_AFTER = 30.0  # s, of an address that is silent
COMPONENT = 1
# MAV_PARAM_TYPE
PARAMETER_INT8, PARAMETER_INT32, PARAMETER_FLOAT = 2, 6, 9


class Node:
    def __init__(self, options, flavour, log=None):
        self.system = options.system
        self.options, self.write = options, log
        self.now = 0.0
        self.outbox = []  # (packet, address)
        self.texts = []  # STATUSTEXT that wait for the answer to what caused them
        self.peers = {}  # address: [Encoder, Parser, last heard]
        self.signer = codec.Signer(options.key) if options.key else None
        self.faults = options.faults or Faults()
        self.pilot = Pilot(options, flavour, self)
        self.missions = Missions(flavour, options.type, self, self.pilot, options.capacity,
                                 options.storage)
        self.commands = Commands(self, self.pilot, flavour)
        self.telemetry = Telemetry(self, flavour, options.type)
        self.terrain = Terrain(options.terrain, options.terrain_spacing, self)
        self.pending = 0.0  # flight time that is less than a step
        self.position_due = 0.0
        self.booted_at = 0.0  # after a reboot; until then nothing is sent

    def log(self, event, **fields):
        if self.write:
            self.write({"time": round(self.now, 4), "flight": round(self.pilot.time, 4),
                        "event": event, **fields})

    # Packets in.

    def receive(self, packet, address):
        for each, sender in self.faults.packet(self.now, "in", packet, address):
            self.accept(each, sender)
        self.follow_faults()

    def peer(self, address):
        if address not in self.peers:
            encoder = codec.Encoder(self.system, COMPONENT, self.signer)
            self.peers[address] = [encoder, codec.Parser(self.signer), self.now]
        return self.peers[address]

    def accept(self, packet, address):
        peer = self.peer(address)
        peer[2] = self.now
        received = peer[1].feed(packet)
        for message in received + peer[1].end_datagram():
            self.log("received", message=message.name, number=message.number,
                     sequence=message.sequence, fields=message.fields)
            if message.name and self.addressed(message):
                self.dispatch(message, address)

    def addressed(self, message):
        to_system = message.fields.get("target_system", 0) in (0, self.system)
        return to_system and message.fields.get("target_component", 0) in (0, COMPONENT)

    def dispatch(self, message, address):
        name = message.name
        if name in ("COMMAND_LONG", "COMMAND_INT"):
            self.commands.handle(message)
        elif hasattr(Missions, "on_" + name.lower()):
            self.missions.handle(message, address)
        else:
            handler = getattr(self, "on_" + name.lower(), None)
            if handler:
                handler(message)

    # Messages that are not of the mission or command protocol.

    def on_set_mode(self, message):
        mode = mode_of(self.pilot.flavour, self.pilot.kind, message.base_mode, message.custom_mode)
        self.pilot.set_mode(mode)

    def on_mission_set_current(self, message):
        self.set_current(message.seq)

    def set_current(self, index):
        if self.pilot.flavour.name == "px4" and self.missions.upload is not None:
            return False  # ignored while a transfer is open
        if not self.pilot.auto.set_current(index):
            if self.pilot.flavour.name != "ardupilot":
                self.text(Severity.ERROR, f"Mission has no item {index}")
            return False
        self.telemetry.send("MISSION_CURRENT")
        return True

    def on_set_position_target_global_int(self, message):
        self.pilot.guided.set_global(message)

    def on_set_position_target_local_ned(self, message):
        self.pilot.guided.set_local(message)

    def on_terrain_data(self, message):
        self.terrain.on_data(message)

    def on_terrain_check(self, message):
        if abs(message.lat) <= 900_000_000 and abs(message.lon) <= 1_800_000_000:
            self.terrain.report(message.lat / 1e7, message.lon / 1e7)

    def on_request_data_stream(self, message):
        rate = message.req_message_rate if message.start_stop else 0
        self.telemetry.set_stream(message.req_stream_id, rate)

    def on_ping(self, message):
        """A request has no target; the answer names who asked."""
        if message.target_system == 0:
            self.send("PING", {"time_usec": message.time_usec, "seq": message.seq,
                               "target_system": message.system,
                               "target_component": message.component})

    def on_timesync(self, message):
        if message.tc1 == 0:
            self.send("TIMESYNC", {"tc1": self.pilot.boot_ms() * 1_000_000, "ts1": message.ts1,
                                   "target_system": message.system,
                                   "target_component": message.component})

    def on_param_request_list(self, message):
        for name in self.pilot.parameters:
            self.send_parameter(name)

    def on_param_request_read(self, message):
        names = list(self.pilot.parameters)
        if message.param_index < 0:
            self.send_parameter(message.param_id)
        elif message.param_index < len(names):
            self.send_parameter(names[message.param_index])

    def on_param_set(self, message):
        if message.param_id in self.pilot.parameters:
            is_whole = isinstance(self.pilot.parameters[message.param_id], int)
            value = message.param_value
            if is_whole:
                value = self.whole(value)
            # The answer has the value that counts.
            if (0 <= value < 100) if is_whole else (0 < value < 1e5):
                self.pilot.parameters[message.param_id] = value
            self.send_parameter(message.param_id)

    def whole(self, value):
        """PX4 takes and sends the bytes of an integer, ArduPilot its value as a float."""
        if self.pilot.flavour.name == "px4":
            return struct.unpack("<i", struct.pack("<f", value))[0]
        return int(value) if abs(value) < 2 ** 31 else -1

    def send_parameter(self, name):
        names = list(self.pilot.parameters)
        if name not in names:
            return
        value, kind = self.pilot.parameters[name], PARAMETER_FLOAT
        if isinstance(value, int):
            is_px4 = self.pilot.flavour.name == "px4"
            kind = PARAMETER_INT32 if is_px4 else PARAMETER_INT8
            value = struct.unpack("<f", struct.pack("<i", value))[0] if is_px4 else float(value)
        self.send("PARAM_VALUE", {"param_id": name, "param_value": value, "param_type": kind,
                                  "param_count": len(names), "param_index": names.index(name)})

    # Packets out.

    def send(self, name, fields):
        if self.now < self.booted_at:
            return
        self.log("sent", message=name, fields=fields)
        for address, (encoder, _, _) in list(self.peers.items()):
            packet = encoder.frame(name, fields)
            self.outbox += self.faults.packet(self.now, "out", packet, address)

    def text(self, severity, text):
        limit = messages.BY_NAME["STATUSTEXT"].base[-1].length
        fields = {"severity": int(severity), "text": text[:limit]}
        if self.pilot.flavour.name == "ardupilot":
            self.texts.append(fields)
        else:
            self.send("STATUSTEXT", fields)

    def take_outbox(self):
        packets, self.outbox = self.outbox, []
        return packets

    # Time.

    def step(self, dt, speedup=1.0):
        self.now += dt
        self.forget()
        waiting, self.texts = self.texts, []
        for fields in waiting:
            self.send("STATUSTEXT", fields)
        for direction, packet, address in self.faults.step(self.now):
            if direction == "in":
                self.accept(packet, address)
            else:
                self.outbox.append((packet, address))
        self.follow_faults()
        if self.now >= self.faults.silent_until:
            self.missions.step()
            self.terrain.step()
        self.pending += dt * speedup
        while self.pending >= FLIGHT_STEP - 1e-9:
            self.pending -= FLIGHT_STEP
            self.fly()

    def fly(self):
        self.pilot.step(FLIGHT_STEP)
        self.telemetry.step()
        if self.pilot.time >= self.position_due - 1e-9:
            self.position_due = self.pilot.time + POSITION_EVERY
            self.log_position()

    def log_position(self):
        body = self.pilot.body
        self.log("position", lat=body.position.lat, lon=body.position.lon, alt=body.position.alt,
                 velocity=[round(v, 4) for v in body.velocity], yaw=round(body.yaw, 5),
                 roll=round(body.roll, 5), mode=self.pilot.mode, armed=self.pilot.armed,
                 item=self.pilot.current_item())

    def forget(self):
        for address, peer in list(self.peers.items()):
            if self.now - peer[2] > FORGOTTEN_AFTER and address != self.options.peer:
                del self.peers[address]

    def follow_faults(self):
        for met in self.faults.met:
            self.log("fault", **met)
        self.faults.met = []
        if self.faults.stops_motors:
            self.faults.stops_motors = False
            self.pilot.disarm(force=True)
        switch, self.faults.switch_to = self.faults.switch_to, None
        if switch:
            self.pilot.set_mode(switch, "pilot")
        reboots, self.faults.reboots = self.faults.reboots, []
        for seconds, loses_plans in reboots:
            self.reboot(seconds, loses_plans)

    def reboot(self, seconds, loses_plans):
        self.log("reboot", seconds=seconds, loses_plans=loses_plans)
        self.missions.restart()
        if loses_plans:
            for kind in self.missions.plans:
                self.missions.plans[kind] = []
        for address in list(self.peers):
            heard = self.peers.pop(address)[2]
            self.peer(address)[2] = heard  # a new encoder counts from 0
        self.pilot.reboot()
        self.booted_at = self.now + seconds
        self.faults.silent_until = max(self.faults.silent_until, self.booted_at)
