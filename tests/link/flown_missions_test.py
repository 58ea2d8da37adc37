# SPDX-License-Identifier: Apache-2.0
"""flown_missions_test.py TRACK_IN_BAND SOURCES: random missions that the test vehicle flies stay in the band
that is predicted for ArduPilot.

The vehicle is a point mass with limits of acceleration (copter), or airspeed, bank and L1 guidance (plane); it shares
no code with the model that predicts. Which commands are flown it learns from the one table: what the table says is
dropped stands in the mission, and is kept from the vehicle."""
import math
import pathlib
import random
import re
import sys
import tempfile
import unittest

from band_case import SOURCES, BandCase, parameter_text
from constants import Command, Frame
from flavours import RTL
from flight_case import at
from station import HOME, item

sys.path[1:1] = [str(SOURCES / "tests/support")]
from night import by_day  # noqa: E402

COLUMN = {"copter": 0, "plane": 1}


def effects():
    """The table: for each command a letter for each of the vehicles."""
    text = (SOURCES / "framework/src/formats/mission_commands.cpp").read_text(encoding="utf-8")
    words = dict(re.findall(r'constexpr const char\* (k\w+) = "(.{6})";', text))
    rows = re.findall(r'\{(\d+), "[^"]*", Task::\w+, (?:"(.{6})"|(k\w+))\}', text)
    return {int(number): own or words[common] for number, own, common in rows}


def takeoff(height):
    return item(Command.NAV_TAKEOFF, HOME[0], HOME[1], height)


def order(command, *params):
    return item(command, params=params + (0.0,) * (4 - len(params)), frame=Frame.MISSION)


def somewhere(rng, here, distance, heading):
    return here[0] + distance * math.cos(heading), here[1] + distance * math.sin(heading)


def copter_mission(rng):
    items, here, height = [takeoff(20.0)], (0.0, 0.0), 20.0
    for n in range(rng.randint(4, 7)):
        here = somewhere(rng, here, rng.uniform(40, 250), rng.uniform(0, 6.28))
        height = max(10.0, height + rng.choice((0, 0, 8, -9, 20, 30)))
        kind = rng.random()
        if kind < 0.2:
            items.append(at(*here, height, Command.NAV_LOITER_TURNS,
                            params=(1.0, 0.0, float(rng.choice((15, 30))), 0.0)))
        elif kind < 0.35:
            items.append(at(*here, height, Command.NAV_LOITER_TIME, params=(4.0, 0.0, 0.0, 0.0)))
        else:
            items.append(at(*here, height, params=(float(rng.choice((0, 0, 3))), 0.0, 0.0, 0.0)))
        if rng.random() < 0.2:
            items.append(order(Command.DO_CHANGE_SPEED, 1.0, float(rng.choice((5, 8)))))
        if n == 3:
            items.append(order(Command.DO_JUMP, 2.0, 1.0))
    items.append(order(Command.NAV_RETURN_TO_LAUNCH))
    return items


def plane_mission(rng):
    heading = rng.uniform(-0.5, 0.5)
    items, here, height = [takeoff(60.0)], somewhere(rng, (0, 0), 900, heading), 80.0
    items.append(at(*here, height))
    for _ in range(rng.randint(2, 5)):
        heading += rng.uniform(-1.6, 1.6)
        here = somewhere(rng, here, rng.uniform(700, 1300), heading)
        height = max(60.0, height + rng.choice((0, 0, 10, -10, 30)))
        items.append(at(*here, height, params=(0.0, float(rng.choice((0, 40))), 0.0, 0.0)))
        if rng.random() < 0.2:
            items.append(order(Command.DO_CHANGE_SPEED, 0.0, float(rng.choice((18, 26)))))
    return items


class FlownMissions(BandCase):
    def with_dropped(self, rng, items, kind):
        """The mission with commands that fly nowhere, and the numbers of its items."""
        dropped = [number for number, letters in effects().items() if letters[COLUMN[kind]] == "K"]
        self.assertTrue(dropped)
        last = items[-1] if items[-1]["command"] == Command.NAV_RETURN_TO_LAUNCH else None
        where = len(items) - 1 if last else len(items)
        more = at(rng.uniform(-2000, 2000), 2000.0, 50.0)
        more["command"] = rng.choice(dropped)
        return items[:where] + [more] + items[where:]

    def write(self, folder, items):
        lines = ["QGC WPL 110", f"0\t1\t0\t16\t0\t0\t0\t0\t{HOME[0]}\t{HOME[1]}\t{HOME[2]}\t1"]
        for n, one in enumerate(items, 1):
            values = [one[f"param{i}"] for i in range(1, 5)] + [one["x"] / 1e7, one["y"] / 1e7, one["z"]]
            words = [n, 0, one["frame"], one["command"], *values, 1]
            lines.append("\t".join(str(word) for word in words))
        (folder / "mission.waypoints").write_text("\n".join(lines) + "\n", encoding="utf-8")
        own = parameter_text(self.pilot.parameters, self.pilot.kind)
        (folder / "vehicle.param").write_text(own, encoding="utf-8")

    def check(self, kind, seed):
        rng = random.Random(f"{kind}{seed}")
        flown = copter_mission(rng) if kind == "copter" else plane_mission(rng)
        written = self.with_dropped(rng, flown, kind)
        self.fly(f"--autopilot ardupilot --type {kind}", [at(0, 0, 0)] + flown)
        self.begin()
        circling = []

        def ends():
            if kind == "plane" and self.pilot.mode == RTL:
                circling.append(self.pilot.time)
            return not self.pilot.armed or (circling and self.pilot.time > circling[0] + 150)
        self.assertTrue(self.station.run(2000, ends), f"{kind} {seed} did not end")
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            self.write(folder, written)
            self.expect_in_band(folder / "mission.waypoints", kind, "0" if kind == "plane" else "-")

    def test_copter(self):
        for seed in by_day(range(100), 20):
            with self.subTest(seed=seed):
                self.check("copter", seed)

    def test_plane(self):
        for seed in by_day(range(100), 20):
            with self.subTest(seed=seed):
                self.check("plane", seed)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
