#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""A small autopilot for tests that speaks MAVLink 2 on this machine, over UDP, TCP or a
pseudo-terminal.

It prints `listening PORT` (or the terminal) on standard output when it can be spoken to. With
--lockstep time stands still but for lines `step SECONDS` on standard input: each is done for all
packets that had arrived, and answered by `time SECONDS`."""
import argparse
import dataclasses
import json
import math
import select
import sys
import time

import faults
import flavours
import transports
from node import Node

STEP = 0.02  # s
# A process that gets no processor for longer does not see that as time: nothing would time out but
# for packets that wait to be read.
LONGEST_STEP = 0.1
LOOPBACK = ("127.0.0.1", "localhost", "::1")


def coordinates(text):
    lat, lon, alt = (float(part) for part in text.split(","))
    return lat, lon, alt


def wind(text):
    come_from, speed = (float(part) for part in text.split(","))
    return come_from, speed


def key_of_file(path):
    """32 bytes, or 64 hexadecimal digits."""
    with open(path, "rb") as file:
        data = file.read()
    key = data if len(data) == 32 else bytes.fromhex(data.decode().strip())
    if len(key) != 32:
        raise argparse.ArgumentTypeError(f"{path} has a key of {len(key)} bytes, expected 32")
    return key


def address(text):
    """HOST:PORT of loopback."""
    host, _, port = text.rpartition(":")
    if host not in LOOPBACK:
        raise argparse.ArgumentTypeError(f"{host!r} is not an address of this machine; "
                                         "expected 127.0.0.1:PORT")
    return "127.0.0.1", int(port)


def parameter(text):
    name, _, value = text.partition("=")
    return name, int(value) if value.lstrip("-").isdigit() else float(value)


class Options(argparse.Namespace):
    def flavour(self):
        flavour = flavours.FLAVOURS[self.autopilot]
        if self.give_up is not None:
            flavour = dataclasses.replace(flavour, give_up_after=self.give_up)
        return flavour

    def wind_vector(self):
        """Where the wind blows to: north, east."""
        come_from, speed = self.wind
        angle = math.radians(come_from)
        return -speed * math.cos(angle), -speed * math.sin(angle)


def parser():
    result = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    add = result.add_argument
    add("--listen", nargs="+", default=["udpin", "127.0.0.1:0"], metavar="KIND",
        help="udpin HOST:PORT (default, port 0: any free one), tcpin HOST:PORT, or pty; "
        "loopback only")
    add("--peer", type=address, metavar="HOST:PORT",
        help="sends here from the beginning; otherwise only to those that have spoken")
    add("--type", choices=("copter", "plane"), default="copter")
    add("--autopilot", choices=sorted(flavours.FLAVOURS), default="generic")
    add("--storage", choices=("atomic", "overwrite"),
        help="of uploads (default: as the autopilot does it)")
    add("--give-up", type=float, metavar="S",
        help="of an upload, after the last item (default: as the autopilot does it)")
    add("--capacity", type=int, default=2000, help="items of a plan")
    add("--home", type=coordinates, default=(47.397742, 8.545594, 488.0), metavar="LAT,LON,ALT")
    add("--heading", type=float, default=0.0, help="degrees")
    add("--wind", type=wind, default=(0.0, 0.0), metavar="FROM_DEG,SPEED")
    add("--system", type=int, default=1, help="system id")
    add("--key", type=key_of_file, metavar="FILE",
        help="signs everything and accepts only what is signed")
    add("--ready-after", type=float, default=0.0, metavar="S", help="until then it does not arm")
    add("--parameter", type=parameter, action="append", default=[], metavar="NAME=VALUE",
        help="a whole number is of an integer type")
    add("--drift", type=float, default=0.0, metavar="M/S",
        help="of a copter's height while velocities are commanded")
    add("--stiff-after", type=float, default=math.inf, metavar="S",
        help="of commands: an aeroplane keeps its course, whatever it is told")
    add("--terrain", action="store_true", help="asks for terrain")
    add("--terrain-spacing", type=int, default=100, metavar="M")
    add("--seed", type=int, default=0)
    add("--faults", metavar="FILE|JSON|random", help="see faults.py")
    add("--speedup", type=float, default=1.0, help="of the flight; links keep their time")
    add("--lockstep", action="store_true")
    add("--log", metavar="FILE", help="JSON lines")
    return result


def options_of(arguments):
    known = parser()
    options = known.parse_args(arguments, Options())
    options.parameters = dict(options.parameter)
    try:
        script = options.faults
        options.faults = faults.of_text(script, options.seed) if script else None
        options.transport = transport(":".join(options.listen))
    except (argparse.ArgumentTypeError, ValueError, KeyError, OSError) as error:
        known.error(str(error))
    return options


def transport(text):
    """What opens the transport when the vehicle starts."""
    kind, _, rest = text.partition(":")
    if kind == "pty":
        return transports.Pty
    if kind not in ("udpin", "tcpin"):
        raise ValueError(f"--listen begins with {kind!r}; expected udpin, tcpin or pty")
    place = address(rest)
    return lambda: (transports.UdpIn if kind == "udpin" else transports.TcpIn)(place)


def strict(value):
    """JSON has no NaN."""
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {key: strict(each) for key, each in value.items()}
    return [strict(each) for each in value] if isinstance(value, (list, tuple)) else value


def log_to(file):
    return lambda entry: file.write(json.dumps(strict(entry)) + "\n")


class Server:
    def __init__(self, options):
        self.options = options
        self.transport = options.transport()
        # Lines at once, for whoever follows the log.
        self.file = open(options.log, "w", buffering=1, encoding="utf-8") if options.log else None
        log = log_to(self.file) if self.file else None
        self.node = Node(options, options.flavour(), log)
        if options.peer:
            self.node.peer(options.peer)
        print("listening", self.transport.name, flush=True)

    def receive(self):
        for packet, sender in self.transport.receive():
            self.node.receive(packet, sender)

    def send(self):
        for packet, receiver in self.node.take_outbox():
            self.transport.send(packet, receiver)

    def run(self):
        before = time.monotonic()
        while True:
            select.select(self.transport.files, [], [], STEP)
            self.receive()
            now = time.monotonic()
            if now - before >= STEP:
                self.node.step(min(now - before, LONGEST_STEP), self.options.speedup)
                before = now
            self.send()

    def run_in_lockstep(self):
        for line in sys.stdin:
            words = line.split()
            if len(words) != 2 or words[0] != "step":
                raise SystemExit(f"standard input has {line.strip()!r}; expected step SECONDS")
            self.receive()
            left = float(words[1])
            while left > 1e-9:
                self.node.step(min(STEP, left), self.options.speedup)
                left -= STEP
            self.send()
            print(f"time {self.node.now:.4f}", flush=True)


def main():
    server = Server(options_of(sys.argv[1:]))
    try:
        server.run_in_lockstep() if server.options.lockstep else server.run()
    except KeyboardInterrupt:
        pass


if __name__ == "__main__":
    main()
