# SPDX-License-Identifier: Apache-2.0
"""Files of published airspace against airspace_peer: airspace_peer_test.py PROGRAM FOLDER
[POINTS [COPIES [FILES]]]. At random places, heights and times the same zones are closed; damaged copies get
one sentence, or close at least what the whole file closes."""
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

import airspace_peer

EDGE_M = 2.5  # chords are up to 1.1 m off, fine outlines less
JOINT_M = 150  # between an arc and the corner beside it
DAY = 86400


def run(program, file, queries=()):
    lines = "".join("%.9f %.9f %.4f %.4f %.3f\n" % q for q in queries)
    done = subprocess.run([program, str(file)], input=lines, capture_output=True, text=True,
                          timeout=600, check=False)
    assert done.returncode in (0, 1), (file, done.returncode, done.stderr)
    out = done.stdout.splitlines()
    if done.returncode == 1:
        assert len(out) == 1 and out[0].startswith("error\t" + str(file)), (file, out)
        return None, out[0]
    end = out.index("end")
    answers = [set() if a == "-" else {int(v) for v in a.split()} for a in out[end + 1:]]
    return out[:end], answers


def places(zones, count, rng):
    """Random, most of them near a volume, its limits and the ends of its times."""
    found = []
    while len(found) < count:
        zone = rng.choice(zones)
        volume = rng.choice(zone.volumes)
        low, high = volume.ring.min(0), volume.ring.max(0)
        margin = 0.15 * (high - low) + 1e-4
        p = [rng.uniform(low[k] - margin[k], high[k] + margin[k]) for k in (0, 1)]
        ground = rng.uniform(0, 1500)
        z = rng.uniform(-100, 8000)
        for limit in (volume.lower, volume.upper):
            if limit and rng.random() < 0.4:
                z = airspace_peer.height(limit, ground) + rng.choice([-1, 1]) * rng.expovariate(0.05)
        if rng.random() < 0.4:
            low_z, high_z = (airspace_peer.height(side, ground) if side else none for side, none in (
                (volume.lower, 0), (volume.upper, 6000)))
            z = rng.uniform(low_z, high_z)
        time = rng.choice([1655553600, 1685275200, 1749578400, 1780000000, 1800000000])
        time += rng.uniform(-10, 10) * DAY
        found.append((p[0], p[1], z, ground, time))
    return found


def expected(zone, place):
    """True, False, or None where it is not certain."""
    p, z, ground, time = place[:2], place[2], place[3], place[4]
    result = False
    for volume in zone.volumes:
        low = airspace_peer.height(volume.lower, ground) if volume.lower else -airspace_peer.INF
        high = airspace_peer.height(volume.upper, ground) if volume.upper else airspace_peer.INF
        if not low <= z <= high:
            continue
        if volume.edge_distance(p) < EDGE_M or volume.near_joint(p, JOINT_M):
            return None
        result = result or volume.over(p)
    return result and zone.active(time)


def compare(program, file, count, rng):
    zones = airspace_peer.read(file.read_text())
    asked = places(zones, count, rng)
    head, answers = run(program, file, asked)
    names = [line.split("\t") for line in head if line.startswith("zone")]
    assert len(names) == len(zones), (file, len(names), len(zones))
    tangled = "".join(line for line in head if "meets itself" in line)
    certain = closed = 0
    for place, answer in zip(asked, answers, strict=True):
        for n, zone in enumerate(zones):
            # Far away from a zone nothing is certain but that it is open.
            want = expected(zone, place)
            if want is None:
                continue
            certain += 1
            closed += want
            assert not want or n in answer, ("open", file.name, zone.name, place)
            if n in answer and not want:
                more = any("'" + name + "'" in tangled or "more" in tangled
                           for name in (names[n][2], names[n][1] + " (" + names[n][2] + ")"))
                assert more, ("closed", file.name, zone.name, place)
    assert closed > count / 20, (file, closed)
    print(file.name, len(zones), "zones,", certain, "certain answers,", closed, "closed")


# --- damaged copies


def damaged_json(text, rng):
    """A key removed or its value replaced, but for those that say where a zone is."""
    document = json.loads(text)
    spots = []

    def walk(value, path):
        for key in (value if isinstance(value, dict) else range(len(value))):
            where = path + [key]
            names = [k for k in where if isinstance(k, str)]
            if names[-1] in ("features", "geometry", "properties", "horizontalProjection", "layer",
                             "coordinates", "center", "radius", "extent", "type") and not (
                                 names[-1] == "type" and "properties" in names):
                pass
            elif isinstance(value, dict):
                spots.append((value, key))
            if isinstance(value[key], (dict, list)) and names[-1] != "coordinates":
                walk(value[key], where)

    walk(document, [])
    value, key = rng.choice(spots)
    how = rng.randrange(4)
    if how == 0:
        del value[key]
    else:
        value[key] = [None, "#?", {"a": [1]}, [], -1e308][rng.randrange(4 if how < 3 else 5)]
        if key in ("applicability", "limitedApplicability", "schedule") and value[key] == []:
            del value[key]
    return json.dumps(document, indent=1)


def damaged_openair(text, rng):
    lines = text.splitlines()
    spots = [k for k, line in enumerate(lines) if re.match(r"(AC|AL|AH|AA) ", line)]
    k = rng.choice(spots)
    code = lines[k][:2]
    if code != "AC" and rng.random() < 0.3 and code != "AA":
        del lines[k]
    else:
        lines[k] = code + " " + rng.choice(["#?", "", "FLx", "9 furlongs", "\x07\xff", "1e"])
    return "\n".join(lines) + "\n"


def damaged_xml(text, rng):
    names = ["type", "upperLimit", "lowerLimit", "upperLimitReference", "lowerLimitReference"]
    found = [m for n in names for m in re.finditer(r"<aixm:(%s)\b[^>]*>([^<]*)</aixm:\1>" % n, text)
             if m[1] != "type" or len(m[2]) < 3]
    m = rng.choice(found)
    if rng.random() < 0.5:
        return text[:m.start()] + text[m.end():]
    if rng.random() < 0.3:
        return text[:m.start()] + m[0].replace('uom="', 'uom="#') + text[m.end():]
    return text[:m.start(2)] + rng.choice(["#?", "", "NIL", "&lt;"]) + text[m.end(2):]


def damaged_bytes(text, rng):
    data = bytearray(text.encode())
    for _ in range(rng.randrange(1, 4)):
        at = rng.randrange(len(data))
        how = rng.randrange(4)
        if how == 0:
            del data[at:at + rng.randrange(1, 40)]
        elif how == 1:
            data[at] = rng.randrange(256)
        elif how == 2:
            data[at:at] = bytes(rng.randrange(256) for _ in range(rng.randrange(1, 5)))
        else:
            del data[at:]
        if not data:
            break
    return bytes(data)


def damage(program, file, copies, rng, folder):
    text = file.read_text()
    zones = airspace_peer.read(text)
    asked = places(zones, 300, rng)
    head, before = run(program, file, asked)
    use = {"keep_out": 0, "ask": 1, "inform": 2}

    def strict(lines):
        return [use[line.split("\t")[4]] for line in lines if line.startswith("zone")]

    kind = text.lstrip()[:1]
    edit = damaged_xml if kind == "<" else damaged_json if kind == "{" else damaged_openair
    refused = 0
    for n in range(copies):
        copy = folder / ("copy" + file.suffix)
        if n % 2:
            copy.write_bytes(damaged_bytes(text, rng))
            refused += run(program, copy)[0] is None
            continue
        copy.write_text(edit(text, rng))
        after_head, after = run(program, copy, asked)
        if after_head is None:
            refused += 1
            continue
        old, new = strict(head), strict(after_head)
        assert len(new) >= len(old), (file, len(new), len(old))
        for place, a, b in zip(asked, before, after, strict=True):
            for zone in a:
                assert zone in b and new[zone] <= old[zone], (
                    "opened", file.name, zone, place, n)
    print(file.name, copies, "copies,", refused, "refused")


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    count = int(sys.argv[3]) if len(sys.argv) > 3 else 600
    copies = int(sys.argv[4]) if len(sys.argv) > 4 else 14
    rng = random.Random(28)
    names = ["ed269-ch.json", "ed269_u-space_che-1.json", "ed318-se.json", "faa-uasfm.json",
             "aixm51-gb.xml", "openair_sample.txt", "openair_slovenia.txt"]
    folder = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", folder)) / "airspace"
    if not folder.is_dir():
        print("no data in", folder)
        sys.exit(77)
    if len(sys.argv) > 5:
        names = sys.argv[5:]
    with tempfile.TemporaryDirectory() as temporary:
        for name in names:
            compare(program, folder / name, count, rng)
            damage(program, folder / name, copies, rng, pathlib.Path(temporary))


main()
