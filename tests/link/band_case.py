# SPDX-License-Identifier: Apache-2.0
"""What tests of missions that the test vehicle flies share: its parameters as a file of ArduPilot's, and how far it left
the band that is predicted. Arguments: TRACK_IN_BAND SOURCES …"""
import json
import pathlib
import subprocess
import sys

SOURCES = pathlib.Path(sys.argv[2])
sys.path.insert(0, str(SOURCES / "tests/link/vehicle"))

from flight_case import Flight  # noqa: E402

MOST_OUTSIDE = 0.01  # of the length
SWING_M = 1  # that a point mass overshoots fast corners by, which ArduPilot's curves do not


def parameter_text(own, kind):
    """The vehicle has metres under names whose unit is the centimetre."""
    scale = {name: 100 for name in ("WPNAV_SPEED", "WPNAV_SPEED_UP", "WPNAV_SPEED_DN", "WPNAV_RADIUS")}
    own = {name: value * scale.get(name, 1) for name, value in own.items()}
    own["RTL_ALT" if kind == "copter" else "ALT_HOLD_RTL"] = 100 * own.pop("RTL_ALT")
    return "".join(f"{name} {value}\n" for name, value in own.items())


class BandCase(Flight):
    def expect_in_band(self, mission, kind, runway="-", terrain="-", wind=0.0):
        """Of the track so far, for a mission beside which vehicle.param lies."""
        track = mission.parent / "track.csv"
        track.write_text("".join(f"{p.lon:.8f},{p.lat:.8f},{p.alt:.3f},0\n" for _, p in self.track[::10]),
                         encoding="utf-8")
        run = subprocess.run(
            [sys.argv[1], str(mission), kind, str(mission.parent / "vehicle.param"), str(runway), str(terrain),
             str(track), str(wind)], capture_output=True, text=True, timeout=600, check=False)
        self.assertEqual(run.returncode, 0, run.stderr)
        found = json.loads(run.stdout)
        self.assertGreater(found["flown_m"], 300)
        if found["worst"] and found["worst"]["outside_m"] > SWING_M:
            self.assertLess(found["outside_m"] / found["flown_m"], MOST_OUTSIDE, found["worst"])
