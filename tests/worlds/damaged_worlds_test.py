# SPDX-License-Identifier: Apache-2.0
"""Damaged files through the program, for every reader of worlds: one clear error each, exit code 3,
nothing on stdout, and no more memory than a map of that size needs.

python3 damaged_worlds_test.py PROGRAM SOURCES

A file is damaged by what it says of itself (sizes, types, numbers that are none), by its end (cut off),
and by what it is (another format's file under this one's name).
"""
import json
import os
import resource
import struct
import subprocess
import sys
import tempfile
import unittest

PROGRAM, SOURCES = sys.argv[1:3]
# A sanitizer takes memory and time of its own: of a reader, each third file.
SANITIZED = os.environ.get("ALTIPLAN_SANITIZED")
EACH = 3 if SANITIZED else 1
MEGABYTES = 400  # of a process that refuses a file, at most


def sample(*path):
    with open(os.path.join(SOURCES, *path), "rb") as file:
        return file.read()


def envi(samples=40, lines=30, **header):
    """An ENVI elevation model: its header's text and its heights."""
    keys = {"samples": samples, "lines": lines, "bands": 1, "header offset": 0, "data type": 4,
            "interleave": "bsq", "byte order": 0,
            "map info": "{UTM, 1, 1, 600000, 5100000, 30, 30, 32, North, WGS-84}"}
    keys.update({key.replace("_", " "): value for key, value in header.items()})
    text = "ENVI\n" + "".join(f"{key} = {value}\n" for key, value in keys.items())
    heights = struct.pack("<1200f", *[500 + n % 40 for n in range(1200)])
    return text.encode(), heights


def box_geojson(ring, properties="{}", kind="Polygon"):
    return (f'{{"type":"FeatureCollection","features":[{{"type":"Feature","id":"hall",'
            f'"properties":{properties},"geometry":{{"type":"{kind}","coordinates":[{ring}]}}}}]}}'
            ).encode()


RING = "[[8.1,46.5],[8.101,46.5],[8.101,46.501],[8.1,46.501],[8.1,46.5]]"
TALL = '{"height": 9}'
GRID = b"type octile\nheight 3\nwidth 4\nmap\n....\n.@@.\n....\n"
VOXELS = b"voxel 4 5 6\n0 0 0\n3 4 5\n"
ASC = (b"ncols 4\nnrows 3\nxllcorner 8\nyllcorner 46\ncellsize 0.001\nNODATA_value -9999\n"
       b"1 2 3 4\n5 6 7 8\n9 10 11 12\n")
CSV = b"lat0 46.5, lon0 8.1\nposX,posY,posZ,halfSizeX,halfSizeY,halfSizeZ\n0,0,5,5,5,5\n"
TREE = b"# Octomap OcTree binary file\nid OcTree\nsize 9\nres 0.1\ndata\n"
TIFF = sample("configs", "data", "jacksboro_fault.tif")
OCTOMAP = sample("plugins", "environment", "octomap", "conformance.bt")
CITY_JSON = sample("plugins", "environment", "city", "conformance.city.json")
FOREIGN = {"a picture": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0",
           "a page": b"<!DOCTYPE html><html><body>404 Not Found</body></html>\n",
           "an archive": b"PK\3\4\x14\0\0\0\x08\0", "nothing": b"", "a NUL": b"\0",
           "zeros": bytes(4096)}


def tiff_with(tag, value):
    """The elevation model with one of its header's numbers changed."""
    order = "<" if TIFF[:2] == b"II" else ">"
    start = struct.unpack(order + "I", TIFF[4:8])[0]
    count = struct.unpack(order + "H", TIFF[start:start + 2])[0]
    for n in range(count):
        at = start + 2 + 12 * n
        if struct.unpack(order + "H", TIFF[at:at + 2])[0] == tag:
            return TIFF[:at + 2] + struct.pack(order + "HII", 4, 1, value) + TIFF[at + 12:]
    raise KeyError(tag)


def cut(whole, places=(0.2, 0.5, 0.9)):
    """Cut off, in the middle of something."""
    return {f"cut at {place}": whole[:int(len(whole) * place)] for place in places}


def swap(text, *pairs):
    damaged = {}
    for old, new in pairs:
        assert old in text, old
        damaged[f"{old!r} as {new!r}"] = text.replace(old, new, 1)
    return damaged


# reader: (file's name, layer, damaged files by what was done to them)
READERS = {
    "grid_map": ("a.map", "grid_map: {{file: {}}}", {
        **FOREIGN, **cut(GRID, (0.1, 0.3, 0.5, 0.7, 0.9)),
        **swap(GRID, (b"type octile", b"type hex"), (b"height 3", b"height 4"),
               (b"height 3", b"height 2"), (b"height 3", b"height -3"), (b"height 3", b"height 3.0"),
               (b"height 3", b"height nan"), (b"height 3", b"height 999999999999"),
               (b"height 3", b"height 2000000000"), (b"height 3\nwidth 4", b"height 4\nwidth 3"),
               (b"width 4", b"width 0"), (b"width 4\n", b""), (b"map\n", b"mop\n"),
               (b".@@.", b".@@"), (b".@@.", b".@@.."), (b".@@.", b".@S."), (b".@@.", b".@\0."),
               (b"type", b"\xef\xbb\xbftype"))}),
    "voxel_map": ("a.3dmap", "voxel_map: {{file: {}}}", {
        **FOREIGN, **cut(VOXELS, (0.3, 0.8)),
        **swap(VOXELS, (b"voxel", b"voxels"), (b"4 5 6", b"4 5"), (b"4 5 6", b"0 5 6"),
               (b"4 5 6", b"4 -5 6"), (b"4 5 6", b"4 5 nan"), (b"4 5 6", b"99999 99999 99999"),
               (b"4 5 6", b"6 5 4"), (b"3 4 5", b"4 4 5"), (b"3 4 5", b"3 4"),
               (b"3 4 5", b"3 4 5 6"), (b"3 4 5", b"3 4 5.5"), (b"3 4 5", b"5 4 3"),
               (b"3 4 5", b"-1 4 5"), (b"3 4 5", b"x y z"))}),
    "octomap": ("a.bt", "octomap: {{file: {}}}", {
        **FOREIGN, **cut(OCTOMAP, (0.05, 0.1, 0.5, 0.9, 0.999)), "with more": OCTOMAP + b"\0\0",
        **swap(OCTOMAP, (b"res 0.5", b"res 0"), (b"res 0.5", b"res -1"), (b"res 0.5", b"res nan"),
               (b"res 0.5", b"res 1e300"), (b"res 0.5\n", b""), (b"id OcTree", b"id Tree"),
               (b"\ndata\n", b"\ndat\n")),
        "the whole tree is one leaf": TREE + b"\x02\x80",
        "nothing is known": TREE + b"\0\0",
        "deeper than a tree": TREE + b"\3\0" * 60}),
    "city_geojson": ("a.geojson", "city: {{file: {}}}", {
        **FOREIGN, **cut(box_geojson(RING, TALL)),
        "no height": box_geojson(RING), "height 0": box_geojson(RING, '{"height": 0}'),
        "height in words": box_geojson(RING, '{"height": "high"}'),
        "height NaN": box_geojson(RING, '{"height": NaN}'),
        "height 1e999": box_geojson(RING, '{"height": 1e999}'),
        "height in a list": box_geojson(RING, '{"height": [9]}'),
        "axes swapped": box_geojson(RING.replace("8.1", "-122.4"), TALL).replace(
            b"[-122.4", b"[46.5,-122.4],[46.6"),
        "open": box_geojson("[[8,46],[8.1,46],[8.1,46.1],[8,46.1]]", TALL),
        "two spikes": box_geojson("[[8,46],[8.1,46.1],[8,46],[8.1,46],[8,46]]", TALL),
        "three points": box_geojson("[[8,46],[8.1,46],[8,46]]", TALL),
        "no area": box_geojson("[[8,46],[8.1,46],[8.2,46],[8,46]]", TALL),
        "a curve": box_geojson(RING, TALL, "CircularString"),
        "text for numbers": box_geojson(RING.replace("46.5", '"46.5"'), TALL),
        "nested deeply": b'{"type":' + b"[" * 5000}),
    "city_json": ("a.json", "city: {{file: {}}}", {
        **cut(CITY_JSON),
        **swap(CITY_JSON, (b'"CityObjects"', b'"Objects"'), (b'"vertices"', b'"points"'),
               (b'"Solid"', b'"Fluid"'), (b"[[[[3", b"[[[[3000"), (b"[[[[3", b"[[[[-3"),
               (b"[[[[3", b"[[[[0.5"), (b"[0.001", b"[1e308"), (b"[0.001", b'["m"'),
               (b'"boundaries"', b'"borders"'), (b'"CityJSON"', b'"CityXML"'))}),
    "colliders": ("a.csv", "city: {{file: {}}}", {
        **FOREIGN,
        **swap(CSV, (b"lat0", b"lon0"), (b"46.5", b"nan"), (b"46.5", b"-122.4"),
               (b"posX,posY", b"posY,posX"), (b"0,0,5,5,5,5", b"0,0,5,5,5"),
               (b"0,0,5,5,5,5", b"0;0;5;5;5;5"), (b"0,0,5,5,5,5", b"0,0,5,5,5,0"),
               (b"0,0,5,5,5,5", b"0,0,5,5,-5,5"), (b"0,0,5,5,5,5", b"0,0,inf,5,5,5"),
               (b"0,0,5,5,5,5", b"0,0,1e999,5,5,5"), (b"0,0,5,5,5,5\n", b""))}),
    "zones": ("a.geojson", "zones: {{file: {}}}", {
        **FOREIGN, **cut(box_geojson(RING)),
        "longitude 190": box_geojson(RING.replace("8.1", "190.1")),
        "axes swapped": box_geojson("[[46.5,122.1],[46.5,122.2],[46.6,122.2],[46.5,122.1]]"),
        "open": box_geojson("[[8,46],[8.1,46],[8.1,46.1],[8,46.1]]"),
        "numbers too large": box_geojson(RING.replace("46.5", "1e999")),
        "not a number": box_geojson(RING.replace("46.5", "NaN")),
        "a list": b"[1, 2, 3]", "a feature that is none": b'{"type":"FeatureCollection","features":[3]}',
        "another type": b'{"type":"Topology","objects":{}}'}),
    "asc": ("a.asc", "terrain: {{file: {}, crs: 'EPSG:4326'}}", {
        **FOREIGN, **cut(ASC, (0.2, 0.5, 0.95)),
        **swap(ASC, (b"ncols 4", b"ncols 400000"), (b"ncols 4", b"ncols -4"),
               (b"nrows 3", b"nrows 999999999"), (b"cellsize 0.001", b"cellsize 0"),
               (b"cellsize 0.001", b"cellsize nan"), (b"yllcorner 46", b"yllcorner 146"),
               (b"1 2 3 4", b"1 2 x 4"), (b"1 2 3 4", b"nan nan nan nan"))}),
    "geotiff": ("a.tif", "terrain: {{file: {}}}", {
        **FOREIGN, **cut(TIFF, (0.001, 0.1, 0.5, 0.95)),
        "a width of 2e9": tiff_with(256, 2000000000), "a height of 2e9": tiff_with(257, 2000000000),
        "no width": tiff_with(256, 0), "a compression that is none": tiff_with(259, 4242)}),
    "hgt": ("N46E008.hgt", "terrain: {{file: {}}}", {
        "cut": bytes(1201 * 1201), "one byte more": bytes(2 * 1201 * 1201 + 1),
        "a picture": FOREIGN["a picture"]}),
    "dted": ("a.dt1", "terrain: {{file: {}}}", {
        **{name: text for name, text in FOREIGN.items() if name != "zeros"},
        "a header alone": b"UHL1" + b"0" * 76}),
    "envi": ("a.img", "terrain: {{file: {}}}", {
        "no header": None,
        "too short": envi(lines=3000), "too wide": envi(samples=2000000000),
        "no samples": envi(samples=0), "a type that is none": envi(data_type=99),
        "complex": envi(data_type=6), "two bands": envi(bands="x"),
        "not ENVI": (b"ENVY\n", bytes(4800))}),
}


class Damaged(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, content):
        with open(self.path(name), "wb") as out:
            out.write(content)

    def refused(self, name, layer):
        self.write("scenario.yaml", (
            "altiplan: 1\nenvironment:\n  - " + layer.format(self.path(name)) +
            "\nvolume: {min_m: [0, 0, 0], max_m: [100, 100, 50]}\nvehicle: {radius_m: 1}\n"
            "start: {at_m: [1, 1, 40]}\ngoal: {at_m: [90, 90, 40]}\n").encode())
        self.write("pipeline.yaml", b"altiplan: 1\nscenario: scenario.yaml\nsteps:\n  - plan: astar\n")
        process = subprocess.Popen([PROGRAM, "run", self.path("pipeline.yaml")],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        out, err = process.communicate(timeout=600)
        said = err.decode()
        self.assertEqual(process.returncode, 3, said + out.decode())
        self.assertEqual(out, b"")
        self.assertEqual(len(said.strip().split("\n")), 1, said)
        self.assertIn(name, said)
        self.assertIn("environment.0", said)

    def hold(self, reader):
        name, layer, damaged = READERS[reader]
        for what, content in list(damaged.items())[::EACH]:
            with self.subTest(f"{reader}: {what}"):
                if isinstance(content, tuple):
                    self.write(name.replace(".img", ".hdr"), content[0])
                    self.write(name, content[1])
                else:
                    self.write(name, content or bytes(4800))
                self.refused(name, layer)
        # Of all children so far; KiB.
        most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024
        if not SANITIZED:
            self.assertLess(most, MEGABYTES)


for each in READERS:
    setattr(Damaged, f"test_{each}", lambda self, reader=each: self.hold(reader))


class Enough(unittest.TestCase):
    def test_there_are_two_hundred(self):
        self.assertGreaterEqual(sum(len(damaged) for _, _, damaged in READERS.values()), 190)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
