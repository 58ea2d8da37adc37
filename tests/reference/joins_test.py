# SPDX-License-Identifier: Apache-2.0
"""joins_test.py TRACK_IN_BAND SOURCES: at which items a return may join the mission, against ArduPilot's rules written a
second time (AP_Mission::distance_to_mission_leg, get_landing_sequence_start)."""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import unittest

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from night import NIGHTLY  # noqa: E402

PROGRAM = sys.argv[1]
DEGREE = 111318.84502145034  # metres
HOME = (47.0, 8.0, 400.0)
RADIUS = 4  # metres that the place is not known
DOUBT = 2   # and that the vehicle may think that it is elsewhere


def apart(a, b):
    east = max(math.cos(math.radians((a[0] + b[0]) / 2)), 0.01)
    return (b[0] - a[0]) * DEGREE, (b[1] - a[1]) * DEGREE * east, b[2] - a[2]


def distance(begin, end, place):
    leg, off = apart(begin, end), apart(begin, place)
    square = sum(x * x for x in leg)
    share = min(1, max(0, sum(x * y for x, y in zip(leg, off)) / square)) if square else 0
    return math.dist(off, [share * x for x in leg])


def height_of(item):
    return item[3] + (HOME[2] if item[4] == 3 else 0)


def joined(items, place, start):
    """(metres, index) of all that may be joined. Items are (command, lat, lon, altitude, frame)."""
    found = []
    for begin, (command, *_) in enumerate(items):
        if command != start:
            continue
        if start == 189:
            at = begin
            while not any(items[at][1:4]):
                at += 1
            found.append((math.dist((0, 0, 0), apart((*items[at][1:3], height_of(items[at])), place)), begin))
            continue
        before = first = None
        for at in range(begin, len(items)):
            if any(items[at][1:4]):
                here = (*items[at][1:3], height_of(items[at]))
                # Where the first leg is nearest at its start, its item has been found, and is no farther.
                is_behind = before is not None and before == first and sum(
                    x * y for x, y in zip(apart(before, here), apart(before, place))) <= 0
                if not is_behind:
                    found.append((distance(before or here, here, place), at))
                first = first if before else here
                before = here
            if items[at][0] in (21, 85, 208, 189):
                break
    return found


class Joins(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def told(self, vehicle, items, place, item, parameters):
        lines = ["QGC WPL 110", f"0\t1\t0\t16\t0\t0\t0\t0\t{HOME[0]}\t{HOME[1]}\t{HOME[2]}\t1"]
        for n, (command, lat, lon, altitude, frame) in enumerate(items, 1):
            lines.append(f"{n}\t0\t{frame}\t{command}\t0\t0\t0\t0\t{lat:.7f}\t{lon:.7f}\t{altitude}\t1")
        (self.folder / "m.waypoints").write_text("\n".join(lines) + "\n")
        (self.folder / "p.param").write_text("".join(f"{name},{value}\n" for name, value in parameters.items()))
        lat, lon, z = place
        (self.folder / "track.csv").write_text(f"{lon:.7f},{lat:.7f},{z},{item}\n" * 2)
        run = subprocess.run([PROGRAM, "m.waypoints", vehicle, "p.param", "0", "-", "track.csv", "0", str(RADIUS)],
                             cwd=self.folder, capture_output=True, text=True, timeout=120)
        self.assertEqual(run.returncode, 0, run.stderr)
        return json.loads(run.stdout)

    def judge(self, chance):
        vehicle = chance.choice(("copter", "plane"))
        far = 300 if vehicle == "copter" else 2000
        start = chance.choice((188, 188, 189))

        def at(command, height=None):
            z = chance.randint(30, 150) if height is None else height
            frame = chance.choice((0, 3, 3))
            return (command, HOME[0] + chance.uniform(-far, far) / DEGREE, HOME[1] + chance.uniform(-far, far) / DEGREE,
                    float(z + (HOME[2] if frame == 0 else 0)), frame)

        def marker(command):
            return at(command) if chance.random() < 0.5 else (command, 0, 0, 0, 2)

        items = [at(16) for _ in range(chance.randint(2, 4))] + [(20, 0, 0, 0, 3)]
        flown = len(items) - 1
        for _ in range(chance.choice((1, 2, 3))):
            if start == 188:
                items += [marker(188), *(at(chance.choice((16, 16, 16, 19))) for _ in range(chance.randint(1, 4)))]
                items += [(178, 0, 0, 0, 2)] if chance.random() < 0.2 else []
                items += [marker(189)] if chance.random() < 0.8 else []
            else:
                items += [marker(189)]
            items += [at(16), (21, *at(21)[1:3], 0, 3)]
        parameters = {"FS_THR_ENABLE": 6} if vehicle == "copter" else {"RTL_AUTOLAND": 4 if start == 188 else 2}
        for _ in range(20 if NIGHTLY else 5):
            place = (HOME[0] + chance.uniform(-far, far) / DEGREE, HOME[1] + chance.uniform(-far, far) / DEGREE,
                     HOME[2] + chance.uniform(30, 150))
            told = self.told(vehicle, items, place, chance.randint(1, flown), parameters)
            found = joined(items, place, start)
            nearest = min(found)[0]

            def flown_to(most):
                """The items that are flown to, by those that are joined; landings are not judged of aeroplanes."""
                to = set()
                for metres, index in found:
                    while items[index][0] > 95:
                        index += 1
                    if metres <= most:
                        to.add(index + 1)
                return {n for n in to if vehicle == "copter" or items[n - 1][0] != 21}

            self.assertTrue(flown_to(nearest + 1e-3) <= set(told["joins"]), (items, place, found, told))
            most = nearest + 2 * math.hypot(RADIUS, RADIUS) + DOUBT
            self.assertTrue(set(told["joins"]) <= flown_to(most + 0.5), (items, place, found, told))
            self.counts[0] += 1
            self.counts[1] += len(flown_to(nearest + 1e-3)) == 1 == len(told["joins"])

    def test_known_joins(self):
        """As ArduPilot's source has them; metres east and north of home, and above it."""
        def placed(east, north, height):
            return (HOME[0] + north / DEGREE, HOME[1] + east / DEGREE / math.cos(math.radians(HOME[0])), height)

        def at(command, *place):
            return (command, *(placed(*place) if place else (0, 0, 0)), 3 if place else 2)

        flown = [at(16, 0, -500, 50), at(20)]
        path = [at(188), at(16, 0, 0, 50), at(16, 400, 0, 50), at(16, 400, 400, 50), at(189)]
        land = [at(16, 0, 600, 50), at(21, 0, 800, 0)]
        auto_rtl, link_lost = {"FS_THR_ENABLE": 6}, {"FS_THR_ENABLE": 0, "FS_GCS_ENABLE": 6}
        for name, items, place, parameters, joins in (
                ("a leg is flown to its end, wherever on it", path, (150, 60, 50), auto_rtl, [5]),
                ("the first item is taken where it is as near as its leg", path, (-200, 30, 50), auto_rtl, [4]),
                ("behind a corner either leg may be", path, (500, -100, 50), auto_rtl, [5, 6]),
                ("a path ends at a landing start", path, (0, 700, 50), auto_rtl, [6]),
                ("its marker is the beginning of a leg", [at(188, -400, 0, 50), *path[1:]], (-200, 30, 50), auto_rtl, [4]),
                ("but no place to fly to", [at(188, -400, 0, 50), *path[1:]], (-500, 30, 50), auto_rtl, [4]),
                ("a landing start with a place ends the last leg", [*path[:4], at(189, 0, 500, 50)], (200, 460, 50), auto_rtl, [8]),
                ("without one the landing ends it", path[:4], (0, 700, 50), auto_rtl, [8]),
                ("height counts", [at(188), at(16, 0, 0, 30), at(16, 400, 0, 30), at(189), at(21, 800, 0, 0),
                                   at(188), at(16, 0, 0, 130), at(16, 400, 0, 130), at(189)], (200, 0, 115), auto_rtl, [10]),
                ("of two paths the nearer", [*path, at(21, 0, 900, 0), at(188), at(16, -600, 0, 50), at(16, -600, 300, 50),
                                             at(189)], (-560, 200, 50), auto_rtl, [11]),
                ("without a path the landing start whose item is nearer",
                 [at(189), at(16, 500, 0, 50), at(21, 600, 0, 0), at(189), at(178), at(16, -500, 0, 50)],
                 (-100, 0, 50), auto_rtl, [8]),
                ("or which is nearer itself, before an item far away",
                 [at(189), at(16, 500, 0, 50), at(21, 600, 0, 0), at(189, 100, 0, 50), at(16, -900, 0, 50)],
                 (200, 0, 50), auto_rtl, [7]),
                ("without either home", [], (100, 0, 50), auto_rtl, []),
                ("a link to the ground station that is lost", path, (150, 60, 50), link_lost, [5])):
            with self.subTest(name):
                lat, lon, z = placed(*place)
                told = self.told("copter", [*flown, *items, *land], (lat, lon, HOME[2] + z), 1, parameters)
                self.assertEqual(told["joins"], joins, told)
        for autoland, joins in ((4, [5]), (2, [8]), (1, [8]), (3, []), (0, [])):
            lat, lon, z = placed(150, 60, 50)
            told = self.told("plane", [*flown, *path, *land], (lat, lon, HOME[2] + z), 1, {"RTL_AUTOLAND": autoland})
            self.assertEqual(told["joins"], joins, (autoland, told))

    def test_random_missions(self):
        self.counts = [0, 0]
        for seed in range(200 if NIGHTLY else 30):
            self.judge(random.Random(seed))
        self.assertGreater(self.counts[1], 0.6 * self.counts[0], self.counts)  # else it tells little


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
