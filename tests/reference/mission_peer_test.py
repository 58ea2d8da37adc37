# SPDX-License-Identifier: Apache-2.0
"""`altiplan check FILE --terrain` against mission_peer: mission_peer_test.py PROGRAM FOLDER [MISSIONS
[SEED]]. Routes as drawn (KML, GPX, GeoJSON), made of mutated missions, over real models and moved airspace:
the verdict, which legs violate what, and by how much. What autopilots make of commands: mission_oracle.py."""
import collections
import datetime
import json
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import ground_peer
import mission_mutants
import mission_peer
import zones_peer

TIE_M = 1e-6 + 2e-8  # the tolerance of the judge, and rounding
BLOCKED_TIE_M = 3e-6  # 1 um of distance, of heights above slopes of up to 70 degrees
AIRSPACE = ["ed269-ch.json", "ed269_u-space_che-1.json", "ed318-se.json", "faa-uasfm.json", "aixm51-gb.xml",
            "openair_sample.txt", "openair_slovenia.txt"]
FENCES = ["mavproxy_springvalleybottom-foamy-fence.txt", "qgc_geofence_home_base.plan",
          "qgc_PolygonGood.kml"]
CROPS = {"N46E008.tif": (185, 95, 120, 120), "n00_e006_3arc_v2.dt1": (720, 570, 300, 300),
         "elev_vinschgau.tif": (80, 20, 150, 150), "srtmgl3_boulder_co.asc": (0, 0, 144, 144)}
WHOLE = ["N44W072.hgt", "bigtujunga.tif", "davosdorf.tif", "jacksboro_fault.tif"]


class World:
    """A model and the files of zones moved over it, read by the peer once."""

    def __init__(self, file, data, folder, rng):
        self.model = ground_peer.Model(file)
        self.near = self.model.somewhere
        middle = self.model.size / 2
        lon, lat = self.model.to_lonlat(*middle, self.near)
        extent = min(self.model.size) / 111000
        self.zones = []
        for name in [*AIRSPACE, *FENCES]:
            source = data / ("airspace" if name in AIRSPACE else "missions") / name
            place = (lon + rng.uniform(-0.2, 0.2) * extent, lat + rng.uniform(-0.2, 0.2) * extent)
            text = mission_mutants.moved(source.read_text(), place, extent, rng)
            made = folder / (pathlib.Path(file).stem + "-" + name)
            made.write_text(text)
            self.zones.append((made, zones_peer.read(made.name, text, self.model)))


def worlds(data, folder, rng):
    found = []
    for name in [*WHOLE, *CROPS]:
        file = data / "dem" / name
        if name in CROPS:
            made = folder / (file.stem + ".tif")
            extra = ["-a_srs", "EPSG:4326", "-a_nodata", "none"] if file.suffix == ".asc" else []
            ground_peer.gdal("gdal_translate", "-q", "-of", "GTiff", "-srcwin", *CROPS[name], *extra, file, made)
            file = made
        found.append(World(file, data, folder, rng))
    return found


# --- a case


class Case:
    """A mission with its world, limits and options."""

    def __init__(self, source, world, folder, rng):
        self.world, self.rng, self.folder = world, rng, folder
        mutant = mission_mutants.Mutant(source.read_text(), world.model, rng)
        suffix, self.text = mutant.written(world.near)
        self.file = folder / ("mission." + suffix)
        self.file.write_text(self.text)
        self.mission = mission_peer.read(self.text)
        self.limits, self.zones, self.start, self.flight = {}, [], None, None
        try:
            self.choose()
        except mission_peer.Refused:
            pass

    def choose(self):
        """Limits, half of them next to what decides; zones, some of them made for a leg."""
        rng, limits = self.rng, self.limits
        self.flight = mission_peer.Flight(self.mission, self.world.model)
        legs, others = mission_peer.judge(self.flight, self.world.model, [], {"min_agl": 0, "max_agl": 0})
        legs += others
        lows = [leg.margins["ground_clearance"] for leg in legs if not leg.off_ground]
        highs = [-leg.margins["altitude"] for leg in legs if not leg.off_ground]

        is_kept = rng.random() < 0.5  # most of them: others pass too seldom

        def beside(value, kept):
            way = kept if is_kept else rng.choice([-1, 1])
            return value + way * 10 ** rng.uniform(-5.4, 1)

        if rng.random() < 0.6:
            decides = lows and (is_kept or rng.random() < 0.5)
            limits["min_agl"] = beside(min(lows), -1) if decides else rng.uniform(0, 120)
        if rng.random() < 0.6:
            decides = lows and (is_kept or rng.random() < 0.6)
            limits["max_agl"] = beside(max(highs), 1) if decides else rng.uniform(60, 600)
        if rng.random() < 0.35:
            limits["radius"] = rng.uniform(0, 6)
            if lows and rng.random() < 0.7:
                limits["radius"] = self.radius(lows, beside)
        for key in limits:
            limits[key] = min(max(limits[key], 0), 1e4)
        if limits.get("min_agl", -1) >= limits.get("max_agl", math.inf):
            del limits["min_agl"]  # refused
        for _ in range(rng.choice([0, 0, 1, 1, 2])):
            self.zones.append(rng.choice(self.world.zones))
        if rng.random() < 0.35:
            self.add_zone(beside)
        if rng.random() < 0.5:
            day = datetime.datetime(2022, 6, 10, tzinfo=datetime.timezone.utc)
            self.start = round(day.timestamp() + rng.uniform(0, 4.5 * 365) * 86400)

    def radius(self, lows, beside):
        """Next to the least distance from the ground, where that is a few metres."""
        low = min(lows)
        if not 0 < low < 40:
            return self.rng.uniform(0, 6)
        lines = [line[-2:] for line in (*self.flight.legs(), *self.flight.ways)]
        return beside(min((self.world.model.distance(a, b, low + 1) for a, b in lines), default=1), -1)

    def add_zone(self, beside):
        """Over or under a leg, or about its middle, with limits next to its heights."""
        lines = [line[-2:] for line in (*self.flight.legs(), *self.flight.ways)]
        if not lines:
            return
        a, b = self.rng.choice(lines)
        heights = self.world.model.leg(a, b)
        whole = self.rng.random() < 0.6
        middle, half = [(a[k] + b[k]) / 2 for k in (0, 1)], math.dist(a[:2], b[:2]) / 2 + 200
        half = half if whole else self.rng.uniform(10, half)
        corners = [(middle[0] + half * x, middle[1] + half * y) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
        lonlat = [list(self.world.model.to_lonlat(*c, self.world.near)) for c in corners]
        datum = self.rng.choice(["sea", "ground"]) if heights else "sea"
        low, high = heights if datum == "ground" else (min(a[2], b[2]), max(a[2], b[2]))
        keep = self.limits.get("radius", 0)
        if self.rng.random() < 0.5:
            lower, upper = ("sea", -900.0), (datum, beside(low - keep, -1))
        else:
            lower, upper = (datum, beside(high + keep, 1)), ("sea", 9000.0)
        if upper[0] == "ground" and upper[1] <= 0 or lower[0] == "ground" and lower[1] < 0:
            return
        made = self.folder / "made.json"
        text = mission_mutants.box_zone("MADE", lonlat, lower, upper)
        made.write_text(text)
        self.zones.append((made, zones_peer.read(made.name, text, self.world.model)))

    def command(self, program):
        words = [program, "check", str(self.file), "--terrain", str(self.world.model.file), "--json"]
        for key, option in (("min_agl", "--min-agl"), ("max_agl", "--max-agl"), ("radius", "--radius")):
            if key in self.limits:
                words += [option, repr(self.limits[key])]
        for file in {str(file) for file, _ in self.zones}:
            words += ["--airspace", file]
        if self.start is not None:
            words += ["--start-time", datetime.datetime.fromtimestamp(
                self.start, datetime.timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ")]
        return words


# --- comparison

ORDER = ("violated", "uncertain", "tie", "kept")


def status(margin, tie):
    return "tie" if abs(margin) <= tie else "violated" if margin < 0 else "kept"


def of_zones(verdicts, start):
    """"violated", "kept", "tie" or "uncertain", and the files that may be meant."""
    states, files = set(), set()
    for v in verdicts:
        state = "kept" if v.near < -TIE_M else "violated" if v.hit > TIE_M else "uncertain"
        if state == "uncertain" and v.near == v.hit:
            state = "tie"
        if state != "kept":
            closed = v.zone.closed(start, 86400)
            state = "kept" if closed is False else "uncertain" if closed is None else state
        if state != "kept":
            states.add(state)
            files.add(v.zone.file)
    return next((s for s in ORDER if s in states), "kept"), files


def expected(case):
    """{(constraint, items): state}, the files that may block each, values, and the least height."""
    legs, beside = mission_peer.judge(
        case.flight, case.world.model, [z for _, zones in case.zones for z in zones],
        case.limits)
    states, files, values, close = {}, {}, {}, 0
    home = mission_peer.home_margin(case.mission, case.world.model)
    if home is not None:
        states["home", ("home",)] = status(home, TIE_M)
    for leg in legs + beside:
        def note(rule, state, leg=leg):
            key = (rule, leg.names)
            states[key] = min(states.get(key, "kept"), state, key=ORDER.index)
        for rule, margin in leg.margins.items():
            note(rule, status(margin, TIE_M))
            close += abs(margin) < 1e-3
        for rule, value in leg.values.items():
            values.setdefault((rule, leg.names), []).append(value)
        state, may = of_zones(leg.zones, case.start)
        note("clearance", state)
        if math.isnan(leg.terrain):
            terrain = "uncertain"
        else:
            terrain = status(leg.terrain, BLOCKED_TIE_M)
            below = leg in legs and leg.lowest is not None and leg.lowest < 0
            if below and states.get(("ground_clearance", leg.names)) == "violated":
                terrain = "told"  # as the height above ground, and not twice
            close += abs(leg.terrain) < 1e-3
        close += sum(abs(v.hit) < 1e-3 for v in leg.zones)
        if terrain == "told":
            states["clearance", leg.names] = "uncertain"
        else:
            note("clearance", terrain)
        files.setdefault(("clearance", leg.names), set()).update(
            may | ({"terrain"} if terrain != "kept" else set()))
    least = [leg.lowest for leg in legs or beside]  # of a single position it is a point's
    return states, files, values, None if None in least else min(least, default=None), close


def heights_differ(told, least):
    return (told is None) != (least is None) or told is not None and abs(told - least) > 2e-6


def is_within_scale(case, violation):
    """True where the radius is kept, if not by as much as lengths in the frame may be off."""
    radius = case.limits.get("radius", 0)
    return (violation["rule"] == "clearance"
            and radius - TIE_M <= violation["value"] < violation["limit"] <= 1.02 * radius)


def differences(case, answer):
    """Sentences about what program and peer do not agree on, and the mission's state."""
    states, files, values, least, close = expected(case)
    found, wrong = set(), []
    for v in answer["violations"]:
        key = (v["rule"], tuple(v["items"]))
        found.add(key)
        state = states.get(key)
        if state is None:
            wrong.append("not known to the peer: %s" % v)
        elif state == "kept" and not is_within_scale(case, v):
            wrong.append("refused that is valid: %s" % v)
        named = re.search(".*'([^']*)'", v["message"])
        if named and state in ORDER[:3] and named[1] not in files.get(key, named[1]):
            wrong.append("another layer: %s, expected one of %s" % (v, files[key]))
        if key in values and all(abs(v["value"] - mine) > 2e-6 for mine in values[key]):
            wrong.append("another value: %s, expected %r" % (v, values[key]))
    for key, state in states.items():
        if state == "violated" and key not in found:
            wrong.append("passed that is violated: %s %s" % key)
    if (answer["verdict"] == "pass") != (not answer["violations"]):
        wrong.append("passed with violations")
    told = answer["metrics"]["min_ground_clearance_m"]
    if heights_differ(told, least):
        wrong.append("least height above ground %s, expected %s" % (told, least))
    worst = next((s for s in ORDER if s in states.values()), "kept")
    legs = collections.Counter(states.values()) + collections.Counter(
        {"within 1 mm of a limit": close})
    return wrong, worst, legs


def judge(case, program, counts):
    done = subprocess.run(case.command(program), capture_output=True, text=True, timeout=600, check=False)
    counts["missions"] += 1
    if case.flight is None:
        counts["not read"] += 1
        return [] if done.returncode == 3 else ["exit code %d, expected 3" % done.returncode]
    if done.returncode not in (0, 1):
        return ["exit code %d: %s" % (done.returncode, done.stderr)]
    answer = json.loads(done.stdout)
    wrong, worst, legs = differences(case, answer)
    if (answer["verdict"] == "pass") != (done.returncode == 0):
        wrong.append("exit code %d" % done.returncode)
    counts[{"violated": "refused by both", "kept": "passed by both"}.get(worst, worst)] += 1
    for state, number in legs.items():
        counts["legs: " + state] += number
    return wrong


def main():
    program, data = sys.argv[1], pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", sys.argv[2]))
    total = int(sys.argv[3]) if len(sys.argv) > 3 else 100
    rng = random.Random(int(sys.argv[4]) if len(sys.argv) > 4 else 28)
    if not (data / "missions").is_dir():
        print("no data in", data)
        sys.exit(77)
    counts, failed = collections.Counter(), 0
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        for number in range(total):
            if number % 1000 == 0:
                places = worlds(data, folder, rng)
            source = data / "missions" / mission_mutants.ROUTES[number % len(mission_mutants.ROUTES)]
            seed = rng.randrange(2**40)
            case = Case(source, places[number % len(places)], folder, random.Random(seed))
            wrong = judge(case, program, counts)
            if wrong:
                failed += 1
                print("mission", number, source.name, " ".join(case.command(program)))
                print("  " + "\n  ".join(wrong[:4]), flush=True)
                keep(case, number)
    print(", ".join("%d %s" % (n, what) for what, n in sorted(counts.items())), "-", failed, "disagreements")
    sys.exit(failed > 0)


def keep(case, number):
    """Where asked for, the files of a disagreement."""
    if "ALTIPLAN_KEEP" not in os.environ:
        return
    folder = pathlib.Path(os.environ["ALTIPLAN_KEEP"]) / str(number)
    folder.mkdir(parents=True, exist_ok=True)
    for file in {case.file, *(f for f, _ in case.zones)}:
        (folder / file.name).write_text(file.read_text())
    words = case.command("altiplan")
    (folder / "command").write_text(" ".join(words) + "\n")


main()
