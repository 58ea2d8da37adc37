# SPDX-License-Identifier: Apache-2.0
"""command_table_test.py PROGRAM TERRAIN: what `altiplan check` makes of each mission command, for each autopilot,
against the table of the second model (oracle_commands, numpy is not needed); by day of every fifth pair, which is
each command for some autopilot."""
import concurrent.futures
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import by_day  # noqa: E402
from oracle_commands import ARDUPILOT, CODES, KINDS, POSITIONS, PX4, TAKEOFFS  # noqa: E402

PROGRAM, TERRAIN = sys.argv[1:3]
VEHICLES = {"AC": (ARDUPILOT, 2), "AF": (ARDUPILOT, 1), "QP": (ARDUPILOT, 20),
            "PM": (PX4, 2), "PF": (PX4, 1), "PV": (PX4, 20)}
WORDS = {"U": "refused", "X": "refused", "K": "dropped", "?": "unforeseeable"}
PARAMS = {18: [1, 0, 50, 0], 177: [1, 1, 0, 0], 19: [5, 0, 50, 0], 31: [0, 50, 0, 0]}
UNKNOWN = (23, 24, 25, 32, 33, 34, 35, 81, 113, 116, 119, 176, 180, 186, 192, 241, 31000)  # of no autopilot


def item(number, command):
    """A position 200 m east of the one before; others at no place, in the frame of commands."""
    flies = command in POSITIONS
    place = [36.55, -84.3 + 0.002 * number, 1500] if flies else [0, 0, 0]
    return {"type": "SimpleItem", "command": command, "frame": 0 if flies else 2, "doJumpId": number,
            "autoContinue": True, "params": PARAMS.get(command, [0, 0, 0, 0]) + place}


def plan(kind, command):
    firmware, vehicle = VEHICLES[kind]
    order = (command, 16, 16, 16) if command in TAKEOFFS else (16, 16, command, 16)
    items = [item(n + 1, c) for n, c in enumerate(order)]
    return {"fileType": "Plan", "version": 1, "groundStation": "test",
            "geoFence": {"version": 2, "circles": [], "polygons": []},
            "rallyPoints": {"version": 2, "points": []},
            "mission": {"version": 2, "firmwareType": firmware, "vehicleType": vehicle, "cruiseSpeed": 15,
                        "hoverSpeed": 5, "plannedHomePosition": [36.55, -84.3, 500], "items": items}}


def told(kind, command, folder):
    """What the program says of the command."""
    number = 1 if command in TAKEOFFS else 3
    file = pathlib.Path(folder) / f"{kind}-{command}.plan"
    file.write_text(json.dumps(plan(kind, command)))
    run = subprocess.run([PROGRAM, "check", str(file), "--terrain", TERRAIN, "--json"], capture_output=True,
                         text=True, timeout=600, check=False)
    if run.returncode not in (0, 1):
        return f"exit code {run.returncode}: {run.stderr}"
    answer = json.loads(run.stdout)
    for violation in answer["violations"]:
        if violation["item"] == number and violation["rule"] in ("refused", "unforeseeable"):
            return violation["rule"]
    skipped = any(note.startswith(f"item {number} ") and "skips this command" in note for note in answer["notes"])
    return "dropped" if skipped else "done"


def main():
    expected = {(kind, command): WORDS.get(codes[kind], "done")
                for command, codes in CODES.items() for kind in KINDS if codes[kind] != "E"}
    del expected["PF", 21]  # is a matter of its slope
    expected |= {(kind, command): "refused" for command in UNKNOWN for kind in KINDS}
    expected = dict(by_day(expected.items(), 5, 3))
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(2) as pool:
        answers = dict(zip(expected, pool.map(lambda key: told(*key, folder), expected), strict=True))
    wrong = {key: answer for key, answer in answers.items() if answer != expected[key]}
    for (kind, command), answer in wrong.items():
        print(f"{kind}, command {command}: {answer}, expected {expected[kind, command]}")
    print(len(expected), "pairs of command and autopilot,", len(wrong), "differ")
    sys.exit(len(wrong) > 0)


main()
