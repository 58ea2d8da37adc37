# SPDX-License-Identifier: Apache-2.0
"""faults_campaign.py PROGRAM SOURCES --like ardupilot|px4 [--scripts N] [--first SEED] [--jobs N]:
`altiplan fly` with vehicles whose link, memory, motors and pilot misbehave by random scripts.

Each flight ends in success or in one sentence, within its time-outs; the vehicle is armed with the
mission that was shown alone and flies it from its first item on; a pilot who has switched the mode is
left alone; and nothing is left on a stale command."""
import argparse
import collections
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

from flown_case import FlownCase, Vehicle

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "vehicle"))
import geodesy
from constants import MISSION, Command
from faults import EVENTS

LIMIT = 150  # s, the sum of all time-outs and the longest flight
SPEEDUP = 5  # the guardian, heartbeats and grace of modes keep to the time of the link
SETTLES = 4.0  # s: the guardian's patience, and a second
STILL = 0.5  # m/s
KNOWN = 1.3  # s, until a heartbeat has reported a mode
# What each ends in when nothing reaches it, with a time that a faster flight leaves room for.
HOLDING = {"ardupilot": ("--parameter", "GUID_TIMEOUT=5.0"),
           "px4": ("--parameter", "COM_OBL_RC_ACT=5", "--parameter", "COM_OF_LOSS_T=5.0")}
# As POP_UP of flown_case has them: east, north, radius (m).
POP_UP = {"copter": (230, 5, 30), "plane": (2300, 20, 200)}
TAKEOFF = {"copter": ("--takeoff", "--home-altitude", "500"), "plane": ()}
LOST = ("COMMAND_ACK", "MISSION_ACK", "HEARTBEAT", "MISSION_CURRENT", "PARAM_VALUE", "STATUSTEXT",
        "MISSION_SET_CURRENT", "MISSION_ITEM_REACHED", "GLOBAL_POSITION_INT",
        "SET_POSITION_TARGET_GLOBAL_INT", "SET_POSITION_TARGET_LOCAL_NED", "PARAM_REQUEST_READ")
COMMANDS = (Command.DO_SET_MODE, Command.COMPONENT_ARM_DISARM, Command.MISSION_START,
            Command.DO_CHANGE_SPEED)
TRANSFER = ("MISSION_COUNT", "MISSION_ITEM_INT", "MISSION_REQUEST_LIST", "MISSION_REQUEST_INT")


def script(seed):
    """One to three faults of links and of vehicles, of any time of a flight."""
    rng = random.Random(seed)

    def at(**more):
        return {"from": round(rng.uniform(0, 25), 2), **more}

    def link(fault, **more):
        rule = at(fault=fault, direction=rng.choice(["in", "out", "both"]),
                  probability=round(rng.uniform(0.02, 0.3), 3), **more)
        return {**rule, "from": rng.choice([0, rule["from"]])}

    def command(fault, **more):
        return {"fault": fault, "message": "COMMAND_LONG", "command": int(rng.choice(COMMANDS)),
                "skip": rng.randint(0, 2), **more}

    menu = [
        lambda: link("lose"), lambda: link("double"), lambda: link("reorder"),
        lambda: link("damage"), lambda: link("delay", seconds=[0.01, rng.uniform(0.1, 1.5)]),
        lambda: at(fault="lose", message=rng.choice(LOST), count=rng.randint(1, 20)),
        lambda: at(fault="lose", message=rng.choice(LOST)),
        lambda: command("lose", count=rng.randint(1, 6)),
        lambda: at(fault="silence", seconds=round(rng.uniform(0.5, 8.0), 2)),
        lambda: at(fault="silence"),
        lambda: {"fault": "silence", "message": rng.choice(TRANSFER), "count": 1,
                 "skip": rng.randint(0, 9), "seconds": round(rng.uniform(0.5, 8.0), 2)},
        lambda: {"fault": "nak", "message": rng.choice(TRANSFER), "count": 1,
                 "skip": rng.randint(0, 9), "result": rng.choice(["ERROR", "NO_SPACE", "INVALID",
                                                                 "DENIED"])},
        lambda: at(fault="reboot", loses_plans=rng.random() < 0.5),
        lambda: at(fault="disarm"), lambda: command("disarm", count=1),
        lambda: at(fault="switch", mode=rng.choice(["HOLD", "RTL", "LAND"])),
        lambda: command("switch", count=1),
        lambda: {"fault": "change", **rng.choice([
            {"round_altitude": 1.0}, {"shift_lat": 1e-5}, {"infeasible": "Landing pattern required"},
            {"drop_command": int(Command.NAV_WAYPOINT)}, {"refuse_frame": 0}])}]
    return [rng.choice(menu)() for _ in range(rng.randint(1, 3))]


class Flight:
    """One flight by a script, and what is wrong with it."""

    def __init__(self, campaign, seed):
        self.campaign, self.seed, self.like = campaign, seed, campaign.options.like
        self.kind = "plane" if seed % 5 == 4 else "copter"
        self.is_commanded = seed % 10 < 7
        self.wrong = []
        self.end = ""

    def path(self, name):
        return os.path.join(self.campaign.folder, f"{self.seed}.{name}")

    def expect(self, is_so, words):
        if not is_so:
            self.wrong.append(words)

    def fly(self):
        self.result, self.shown = self.campaign.plans[self.kind]
        self.vehicle_of_flight = self.campaign.vehicle(
            self.kind, self.path("jsonl"), "--faults", json.dumps(script(self.seed)), "--seed",
            str(self.seed))
        try:
            self.follow()
        finally:
            self.vehicle_of_flight.end()
        return self

    def follow(self):
        out = self.path("flown.json")
        command = [self.campaign.options.program, "fly", "--link", self.vehicle_of_flight.address,
                   "-o", out, "--arm", self.result, *TAKEOFF[self.kind],
                   *(("--command",) if self.is_commanded else ())]
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   text=True)
        try:
            words, _ = process.communicate(timeout=LIMIT)
        except subprocess.TimeoutExpired:
            process.kill()
            words, _ = process.communicate()
            self.expect(False, f"it has not ended after {LIMIT} s: {words.splitlines()[-1:]}")
        self.ended_at = self.vehicle_of_flight.log()[-1]["time"]
        time.sleep(SETTLES)
        self.log = self.vehicle_of_flight.log()
        self.judge_end(process.returncode, words, out)
        self.judge_missions()
        self.judge_switches()
        self.judge_rest()

    def events(self, *names):
        return [entry for entry in self.log if entry["event"] in names]

    def judge_end(self, code, words, out):
        self.expect(code in (0, 1), f"exit code {code}: {words}")
        flight = {}
        if os.path.exists(out):
            with open(out, encoding="utf-8") as file:
                flight = json.load(file)["flight"]
        lines = words.splitlines()
        said = [flight["message"]] if flight else [
            line for line in lines if line.startswith(("altiplan: ", "mission: ", "fence: ", "  item "))
            and "warning" not in line and "read back equal" not in line]
        self.end = said[-1] if said else ""
        self.expect(self.end, f"no sentence: {words}")
        self.is_solved = code == 0
        self.expect(not (self.can_avoid() and flight.get("collisions")), self.end)
        if self.is_solved:
            self.expect(flight.get("reached"), "success without a goal")
            self.expect_clear()

    def can_avoid(self):
        """What is commanded sees the obstacle, unless the link, the motors or a pilot let it down."""
        return self.is_commanded and not any(
            rule["fault"] in EVENTS or (rule["fault"] == "lose" and
                                        not rule.keys() & {"count", "probability"})
            for rule in script(self.seed))

    def expect_clear(self):
        """By what the vehicle knows of itself; the obstacle is there when the vehicle flies by."""
        east, north, radius = POP_UP[self.kind]
        home = geodesy.Position(47.0, 8.0, 500.0)
        place = geodesy.offset(home, north, east)
        near = min(geodesy.horizontal(geodesy.Position(entry["lat"], entry["lon"], entry["alt"]),
                                      place) for entry in self.events("position") if entry["time"] < self.ended_at)
        self.expect(near > radius, f"success through the obstacle: {near:.1f} m from its centre")

    def judge_missions(self):
        """What is armed is what was shown, from its first item on."""
        stored, at = None, None
        first = 1 if self.like == "ardupilot" else 0
        for entry in self.log:
            if entry["event"] == "stored" and entry["kind"] == MISSION:
                stored = entry["items"]
            elif entry["event"] == "plan":
                at = entry["current"]
            elif entry["event"] == "armed":
                self.expect(stored == self.shown, f"armed with another mission: {stored}")
                self.expect(at == first, f"armed at item {at}")
        reached = [entry["item"] for entry in self.events("reached")]
        if "GUIDED" not in [entry["mode"] for entry in self.events("mode")][1:]:
            self.expect(reached == list(range(first, first + len(reached))),
                        f"items in the order {reached}")

    def judge_switches(self):
        """Nobody takes the vehicle from its pilot, once that is in the air; but for a command that was
        under way before a heartbeat could show the switch."""
        is_flying, switched_at = False, math.inf
        for entry in self.log:
            if entry["event"] == "reached":
                is_flying = True
            elif entry["event"] == "mode" and is_flying:
                if entry["reason"] == "pilot":
                    switched_at = min(switched_at, entry["time"])
                elif entry["reason"] == "command" and entry["time"] < switched_at + KNOWN:
                    switched_at = math.inf
                self.expect(entry["reason"] != "command" or entry["time"] < switched_at,
                            f"{entry['mode']} commanded after a switch of the pilot")

    def judge_rest(self):
        """Armed and under command is only what hovers, or circles, by itself."""
        last = self.events("position")[-1]
        if last["armed"] and last["mode"] == "GUIDED" and self.kind == "copter":
            speed = max(map(abs, last["velocity"]))
            self.expect(speed < STILL, f"left in GUIDED at {speed:.1f} m/s")


class Campaign:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        FlownCase.program, FlownCase.sources = options.program, options.sources
        self.plans = {}
        for kind in POP_UP:
            FlownCase.folder = os.path.join(folder, kind)  # a scenario each
            os.mkdir(FlownCase.folder)
            result = FlownCase().planned(kind, pop_up=True)
            self.plans[kind] = (result, self.stored(kind, result))

    def vehicle(self, kind, log, *options):
        program = os.path.join(self.options.sources, "tests/link/vehicle/vehicle.py")
        return Vehicle(program, log, "--speedup", str(SPEEDUP), "--autopilot", self.options.like,
                       "--type", kind, *HOLDING[self.options.like], *options)

    def stored(self, kind, result):
        """The items that fly gives to a vehicle without faults."""
        vehicle = self.vehicle(kind, os.path.join(self.folder, kind + ".jsonl"))
        process = subprocess.Popen(
            [self.options.program, "fly", result, "--link", vehicle.address, "-o",
             os.path.join(self.folder, "none.json"), *TAKEOFF[kind]], stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL)
        try:
            assert vehicle.wait(lambda: vehicle.log("stored"))
            return vehicle.log("stored")[-1]["items"]
        finally:
            process.kill()
            process.wait()
            vehicle.end()


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("sources")
    parser.add_argument("--like", choices=sorted(HOLDING), required=True)
    parser.add_argument("--scripts", type=int, default=200)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--keep", action="store_true", help="the logs of what went wrong")
    options = parser.parse_args()
    folder = tempfile.mkdtemp(prefix="altiplan_faults_")
    campaign = Campaign(options, folder)
    seeds = range(options.first, options.first + options.scripts)
    with ThreadPoolExecutor(options.jobs) as pool:
        flights = list(pool.map(lambda seed: Flight(campaign, seed).fly(), seeds))
    ends = collections.Counter(flight.end.split(" (")[0].removeprefix("altiplan: ")[:90]
                               for flight in flights)
    for words, count in ends.most_common():
        print(f"{count:4d}  {words}")
    wrong = [flight for flight in flights if flight.wrong]
    for flight in wrong:
        print(f"seed {flight.seed}, {json.dumps(script(flight.seed))}:")
        for words in flight.wrong:
            print(f"  {words}")
    print(f"{options.like}: {len(flights)} scripts, {len(wrong)} went wrong")
    if options.keep:
        print(folder)
    else:
        shutil.rmtree(folder)
    sys.exit(1 if wrong or not flights else 0)


if __name__ == "__main__":
    main()
