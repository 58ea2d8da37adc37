# SPDX-License-Identifier: Apache-2.0
"""Telemetry, parameters, time and terrain of the vehicle, and the program itself over UDP."""
import collections
import json
import os
import pathlib
import select
import socket
import subprocess
import sys
import tempfile
import time
import unittest

import codec
import geodesy
from constants import Command, Frame
from station import HOME, Station, make_node, square, waypoint

VEHICLE = pathlib.Path(__file__).with_name("vehicle.py")


class Telemetry(unittest.TestCase):
    def rates(self, arguments="", seconds=10):
        station = Station(make_node(arguments))
        station.run(1)
        station.received.clear()
        station.run(seconds)
        return station, collections.Counter(message.name for message in station.received)

    def test_rates(self):
        _, counts = self.rates()
        for name, rate in (("HEARTBEAT", 1), ("SYS_STATUS", 1), ("GLOBAL_POSITION_INT", 5),
                           ("ATTITUDE", 5), ("LOCAL_POSITION_NED", 5), ("VFR_HUD", 4),
                           ("MISSION_CURRENT", 1), ("WIND", 1)):
            self.assertAlmostEqual(counts[name], 10 * rate, delta=1, msg=name)

    def test_arducopter_sends_nothing_unasked(self):
        for kind, rate in (("copter", 0), ("plane", 1)):
            station, counts = self.rates(f"--autopilot ardupilot --type {kind}")
            self.assertAlmostEqual(counts["HEARTBEAT"], 10, delta=1)
            for name in ("GLOBAL_POSITION_INT", "MISSION_CURRENT", "SYS_STATUS"):
                self.assertAlmostEqual(counts[name], 10 * rate, delta=rate, msg=name)
            self.assertEqual(station.command(Command.SET_MESSAGE_INTERVAL, 33, 100000), 0)
            station.received.clear()
            station.run(2)
            self.assertAlmostEqual(len(station.all("GLOBAL_POSITION_INT")), 20, delta=1)

    def test_heartbeats_of_each_autopilot(self):
        for arguments, expected in (
                ("--autopilot ardupilot", (2, 3, 0)),
                ("--autopilot ardupilot --type plane", (1, 3, 0)),
                ("--autopilot px4", (2, 12, 1 << 16)), ("", (2, 0, 0))):
            station, _ = self.rates(arguments, 2)
            message = station.last("HEARTBEAT")
            self.assertEqual((message.type, message.autopilot, message.custom_mode), expected)
            self.assertEqual(message.mavlink_version, 3)

    def test_wind_is_where_it_comes_from(self):
        station, _ = self.rates("--wind 270,6", 2)
        wind = station.last("WIND")
        self.assertAlmostEqual(wind.direction % 360, 270, places=3)
        self.assertAlmostEqual(wind.speed, 6, places=5)
        station, _ = self.rates("--wind 270,6 --autopilot px4", 2)
        self.assertAlmostEqual(station.last("WIND_COV").wind_y, 6, places=5)

    def test_mission_current(self):
        for flavour, none, total in (("generic", 65535, 6), ("ardupilot", 0, 5)):
            station, _ = self.rates(f"--autopilot {flavour}", 2)
            station.command(Command.SET_MESSAGE_INTERVAL, 42, 1e6)
            station.run(1.1)
            self.assertEqual(station.last("MISSION_CURRENT").total, none)
            self.assertEqual(station.last("MISSION_CURRENT").mission_state, 1)
            station.upload(square())
            station.run(1.1)
            self.assertEqual(station.last("MISSION_CURRENT").total, total)
            self.assertEqual(station.last("MISSION_CURRENT").mission_state, 2)

    def test_message_intervals(self):
        station = Station(make_node())
        self.assertEqual(station.command(Command.SET_MESSAGE_INTERVAL, 33, 100000), 0)
        self.assertEqual(station.command(Command.SET_MESSAGE_INTERVAL, 30, -1), 0)
        station.run(1)
        station.received.clear()
        station.run(5)
        self.assertAlmostEqual(len(station.all("GLOBAL_POSITION_INT")), 50, delta=1)
        self.assertEqual(station.all("ATTITUDE"), [])
        self.assertEqual(station.command(Command.REQUEST_MESSAGE, 148), 0)
        self.assertTrue(station.last("AUTOPILOT_VERSION").capabilities & 0x2000)

    def test_home(self):
        station = Station(make_node())
        station.command(Command.GET_HOME_POSITION)
        home = station.last("HOME_POSITION")
        self.assertEqual((home.latitude, home.longitude, home.altitude),
                         (470000000, 80000000, 500000))

    def test_home_is_where_it_arms_unless_it_was_set(self):
        station = Station(make_node())
        where = {"x": 471000000, "y": 80000000, "z": 400.0, "frame": int(Frame.GLOBAL)}
        self.assertEqual(station.command(Command.DO_SET_HOME, 0, **where), 0)
        station.command(Command.COMPONENT_ARM_DISARM, 1)
        station.command(Command.GET_HOME_POSITION)
        self.assertEqual(station.last("HOME_POSITION").latitude, 471000000)
        self.assertEqual(station.last("HOME_POSITION").altitude, 400000)

    def test_unknown_commands(self):
        self.assertEqual(Station(make_node()).command(31000), 3)
        self.assertEqual(Station(make_node()).command(Command.NAV_WAYPOINT), 3)


class Services(unittest.TestCase):
    def setUp(self):
        self.station = Station(make_node())

    def test_parameters(self):
        station = self.station
        station.send("PARAM_REQUEST_LIST", target_system=1, target_component=1)
        station.run(0.1)
        values = {m.param_id: m.param_value for m in station.all("PARAM_VALUE")}
        self.assertEqual(values["WPNAV_SPEED"], 10.0)
        self.assertEqual(len(values), station.last("PARAM_VALUE").param_count)
        station.send("PARAM_SET", target_system=1, target_component=1, param_id="WPNAV_SPEED",
                     param_value=4.0, param_type=9)
        self.assertEqual(station.wait(("PARAM_VALUE",), 1).param_value, 4.0)
        station.send("PARAM_REQUEST_READ", target_system=1, target_component=1,
                     param_id="WPNAV_SPEED", param_index=-1)
        self.assertEqual(station.wait(("PARAM_VALUE",), 1).param_value, 4.0)

    def test_integers_are_bytes_to_px4_and_numbers_to_ardupilot(self):
        for autopilot, name, kind, coded in (("px4", "COM_OBL_RC_ACT", 6, 7.006492321624085e-45),
                                             ("ardupilot", "FS_GCS_ENABLE", 2, 5.0)):
            station = Station(make_node(f"--autopilot {autopilot} --parameter {name}=5"))
            station.send("PARAM_REQUEST_READ", target_system=1, target_component=1,
                         param_id=name, param_index=-1)
            value = station.wait(("PARAM_VALUE",), 1)
            self.assertEqual((value.param_value, value.param_type), (coded, kind))

    def test_ping_and_timesync(self):
        self.station.run(2)
        self.station.send("PING", time_usec=123, seq=7)
        answer = self.station.wait(("PING",), 1)
        self.assertEqual((answer.time_usec, answer.seq, answer.target_system), (123, 7, 255))
        self.station.send("TIMESYNC", ts1=99)
        answer = self.station.wait(("TIMESYNC",), 1)
        self.assertEqual(answer.ts1, 99)
        self.assertAlmostEqual(answer.tc1 / 1e9, 2.0, delta=0.1)


class Terrain(unittest.TestCase):
    """The station answers from a slope: 500 m at home, 1 m more for each 100 m north."""

    def setUp(self):
        self.station = Station(make_node("--terrain"))
        self.withheld = {3, 40}
        self.answered = 0
        self.station.every_step = self.answer

    def answer(self):
        requests = self.station.all("TERRAIN_REQUEST")
        for request in requests[self.answered:]:
            for bit in range(56):
                if request.mask >> bit & 1 and bit not in self.withheld:
                    self.send_tile(request, bit)
            self.withheld = set()
        self.answered = len(requests)

    def send_tile(self, request, bit):
        corner = geodesy.Position(request.lat / 1e7, request.lon / 1e7, 0.0)
        heights = []
        for i in range(16):
            north = (bit // 8 * 4 + i // 4) * request.grid_spacing
            there = geodesy.offset(corner, north, 0.0)
            up = geodesy.vector(geodesy.Position(*HOME), there)[0] / 100
            heights.append(round(500 + up))
        self.station.send("TERRAIN_DATA", lat=request.lat, lon=request.lon, gridbit=bit,
                          grid_spacing=request.grid_spacing, data=heights)

    def test_blocks_are_completed(self):
        self.station.run(1.5)
        self.assertEqual(self.station.last("TERRAIN_REPORT").pending, 2)
        self.station.run(2)
        masks = [message.mask for message in self.station.all("TERRAIN_REQUEST")]
        self.assertEqual(masks, [2 ** 56 - 1, 1 << 3 | 1 << 40])
        report = self.station.last("TERRAIN_REPORT")
        self.assertEqual((report.pending, report.loaded), (0, 56))
        self.assertAlmostEqual(report.terrain_height, 500, delta=1)

    def test_waypoints_above_terrain(self):
        there = geodesy.offset(geodesy.Position(*HOME), 1000.0, 200.0)
        self.station.upload([waypoint(there.lat, there.lon, 30.0, frame=Frame.GLOBAL_TERRAIN_ALT)])
        self.station.run(4)
        height = self.station.node.terrain.height(there.lat, there.lon)
        self.assertAlmostEqual(height, 510, delta=1)


class Client:
    """A station over UDP, to a vehicle in a process of its own."""

    def __init__(self, *arguments, signer=None):
        self.process = subprocess.Popen(
            [sys.executable, VEHICLE, "--home", "47,8,500", *arguments], stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, text=True)
        self.port = self.process.stdout.readline().split()[1]
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.socket.settimeout(0.2)
        self.encoder = codec.Encoder(255, 190, signer)
        self.parser = codec.Parser(signer)
        self.received = []

    def send(self, name, **fields):
        self.socket.sendto(self.encoder.frame(name, fields), ("127.0.0.1", int(self.port)))

    def receive(self):
        try:
            packet = self.socket.recv(65535)
        except (TimeoutError, BlockingIOError):
            return []
        messages = self.parser.feed(packet)
        self.received += messages
        return messages

    def wait(self, name, seconds=30):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            for message in self.receive():
                if message.name == name:
                    return message
        raise AssertionError(f"no {name} came")

    def step(self, seconds):
        """Of a vehicle in lock-step: all that it sent in that time is there afterwards."""
        self.process.stdin.write(f"step {seconds}\n")
        self.process.stdin.flush()
        self.process.stdout.readline()
        self.socket.setblocking(False)
        while self.receive():
            pass

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.communicate()
        self.socket.close()


class Program(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def upload(self, client):
        items = square()
        client.send("MISSION_COUNT", target_system=1, target_component=1, count=len(items))
        for _ in range(1000):
            client.step(0.02)
            requests = [m for m in client.received if m.name == "MISSION_REQUEST_INT"]
            client.received.clear()
            for request in requests:
                client.send("MISSION_ITEM_INT", target_system=1, target_component=1,
                            seq=request.seq, **items[request.seq])
                if request.seq == len(items) - 1:
                    client.step(0.02)
                    return
        self.fail("the upload did not end")

    def test_speaks_when_spoken_to(self):
        listen = ("--listen", "udpin", "127.0.0.1:0")
        with Client("--autopilot", "px4", *listen) as client:
            self.assertEqual(client.receive(), [])
            client.send("HEARTBEAT", type=6)
            self.assertEqual(client.wait("HEARTBEAT").autopilot, 12)
            client.send("MISSION_REQUEST_LIST", target_system=1, target_component=1)
            self.assertEqual(client.wait("MISSION_COUNT").count, 0)

    def answered(self, file, send, receive):
        """A question cut in two, noise before it, is answered."""
        frame = b"noise" + codec.Encoder(255, 190).frame("PING", {"seq": 5})
        parser, seen = codec.Parser(), []
        for part in (frame[:12], frame[12:]):
            send(part)
            time.sleep(0.1)
        end = time.monotonic() + 20
        while "PING" not in seen and time.monotonic() < end:
            if not select.select([file], [], [], 0.2)[0]:
                continue
            seen += [message.name for message in parser.feed(receive())]
        self.assertIn("PING", seen)

    def test_tcp(self):
        with Client("--listen", "tcpin", "127.0.0.1:0") as client:
            with socket.create_connection(("127.0.0.1", int(client.port))) as connection:
                self.answered(connection, connection.sendall,
                              lambda: connection.recv(4096))

    def test_pseudo_terminal(self):
        with Client("--listen", "pty") as client:
            line = os.open(client.port, os.O_RDWR | os.O_NOCTTY)
            try:
                self.answered(line, lambda data: os.write(line, data),
                              lambda: os.read(line, 4096))
            finally:
                os.close(line)

    def test_speedup_is_of_the_flight(self):
        with Client("--speedup", "20") as client:
            client.send("HEARTBEAT", type=6)
            client.wait("ATTITUDE")
            beats = [client.wait("HEARTBEAT") and time.monotonic() for _ in range(2)]
            first = client.wait("ATTITUDE").time_boot_ms
            self.assertGreater(beats[1] - beats[0], 0.5)
            client.wait("HEARTBEAT")
            self.assertGreater(client.wait("ATTITUDE").time_boot_ms - first, 4000)

    def test_lockstep_logs_are_equal(self):
        rules = json.dumps([{"fault": "lose", "message": "MISSION_REQUEST_INT",
                             "probability": 0.5, "count": 3}])
        logs = []
        for run in range(2):
            log = self.folder / f"{run}.jsonl"
            with Client("--lockstep", "--faults", rules, "--seed", "6", "--log", log) as client:
                self.upload(client)
                client.step(2)
            logs.append(log.read_text())
        self.assertEqual(logs[0], logs[1])
        entries = [json.loads(line) for line in logs[0].splitlines()]
        events = collections.Counter(entry["event"] for entry in entries)
        self.assertGreater(events["fault"], 0)
        positions = [entry["flight"] for entry in entries if entry["event"] == "position"]
        gaps = {round(b - a, 3) for a, b in zip(positions, positions[1:])}
        self.assertEqual(gaps, {0.1})

    def test_key_and_script_of_files(self):
        key, script = self.folder / "key", self.folder / "script.json"
        key.write_text(bytes(range(32)).hex())
        script.write_text(json.dumps({"rules": [{"fault": "silence", "from": 1e6}]}))
        signer = codec.Signer(bytes(range(32)))
        with Client("--lockstep", "--key", key, "--faults", script, signer=signer) as client:
            client.send("PING", seq=1)
            client.step(1.0)
            self.assertIn("PING", [message.name for message in client.received])
            self.assertEqual(client.parser.counts["unsigned"], 0)

    def test_other_machines_are_refused(self):
        for arguments in (("--listen", "udpin", "0.0.0.0:0"), ("--peer", "192.0.2.1:14550"),
                          ("--listen", "tcp:127.0.0.1:0")):
            ended = subprocess.run([sys.executable, VEHICLE, *arguments], capture_output=True,
                                   text=True, check=False, stdin=subprocess.DEVNULL, timeout=600)
            self.assertNotEqual(ended.returncode, 0)
            self.assertIn("expected", ended.stderr)
            self.assertNotIn("Traceback", ended.stderr)


if __name__ == "__main__":
    unittest.main()
