# SPDX-License-Identifier: Apache-2.0
"""page_ground_test.py PROGRAM SOURCES: the ground in pages of `altiplan view` and `edit`: voids, and `--basemap` with
images that GDAL's programs make."""
import base64
import json
import math
import os
import re
import shutil
import sqlite3
import subprocess
import sys
import unittest

import numpy

from edit_session import PROGRAM, Session, by_night
from plan_case import POINTS, TERRAIN, PlanCase, plan_of

WEST, EAST, SOUTH, NORTH = -84.45, -84.13, 36.41, 36.73
PIXELS = 640  # half a thousandth of a degree
OUTSIDE = ["-a_ullr", "10", "50", "11", "49", "-a_srs", "EPSG:4326"]
PLACED = ["-a_ullr", *map(str, (WEST, NORTH, EAST, SOUTH)), "-a_srs", "EPSG:4326"]


class PageGround(PlanCase):
    def setUp(self):
        super().setUp()
        self.plan = self.folder / "mission.plan"
        self.plan.write_text(json.dumps(plan_of(POINTS)))

    def gdal(self, *arguments):
        subprocess.run([arguments[0], "-q", *arguments[1:]], cwd=self.folder, check=True, capture_output=True)

    def image(self, name, bands, *options):
        """A GeoTIFF of these bands."""
        data = numpy.array(bands)
        count, rows, columns = data.shape
        (self.folder / "raw").write_bytes(data.tobytes())
        kind = {"uint8": 1, "int16": 2}[str(data.dtype)]
        (self.folder / "raw.hdr").write_text(f"ENVI\nsamples = {columns}\nlines = {rows}\nbands = {count}\n"
                                             f"data type = {kind}\ninterleave = bsq\nbyte order = 0\n")
        self.gdal("gdal_translate", "raw", name, *(options or PLACED))
        return name

    def spots(self):
        """Bright spots of three pixels' width at the mission's items."""
        degrees = (EAST - WEST) / PIXELS
        x = WEST + (numpy.arange(PIXELS) + 0.5) * degrees
        y = NORTH - (numpy.arange(PIXELS) + 0.5) * degrees
        light = sum(numpy.exp(-((x[None, :] - lon) ** 2 + (y[:, None] - lat) ** 2) / (2 * (3 * degrees) ** 2))
                    for lon, lat, _ in POINTS)
        return (255 * numpy.minimum(light, 1)).astype(numpy.uint8)

    def view(self, file, *arguments, code=0, path=os.environ["PATH"]):
        done = subprocess.run([PROGRAM, "view", *(arguments or ("mission.plan", "--terrain", TERRAIN, "-o", "page.html")),
                               "--basemap", file], cwd=self.folder, capture_output=True, text=True, timeout=600,
                              env={**os.environ, "PATH": path})
        self.assertEqual(done.returncode, code, done.stderr)
        return done.stderr

    def scene(self, page=None):
        page = page or (self.folder / "page.html").read_bytes()
        return json.loads(re.search(rb'<script id="scene"[^>]*>(.*?)</script>', page, re.S)[1])

    def pixels(self, scene):
        """The basemap's bands: three, and a fourth where a part of it is transparent."""
        kind, data = scene["basemap"]["image"].split(",")
        self.assertEqual(kind, "data:image/webp;base64")
        (self.folder / "shown.webp").write_bytes(base64.b64decode(data))
        self.gdal("gdal_translate", "-of", "ENVI", "shown.webp", "shown")
        lines = (self.folder / "shown.hdr").read_text()
        columns, rows, bands = (int(re.search(rf"{key}\s*= *(\d+)", lines)[1]) for key in ("samples", "lines", "bands"))
        return numpy.fromfile(self.folder / "shown", numpy.uint8).reshape(bands, rows, columns)

    def assert_spots(self, scene):
        """The centre of each spot is where the item is, within half a pixel."""
        light = self.pixels(scene)[0].astype(float)
        (west, south), (east, north) = scene["basemap"]["box"]
        rows, columns = light.shape
        self.assertEqual([item["number"] for item in scene["numbered"]], [1, 2, 3, 4])
        for item in scene["numbered"]:
            x = (item["at"][0] - west) / (east - west) * columns - 0.5
            y = (north - item["at"][1]) / (north - south) * rows - 0.5
            left, top = round(x) - 15, round(y) - 15
            part = light[top:top + 31, left:left + 31]
            part = numpy.where(part > 40, part, 0)
            found = [(part.sum(axis).dot(numpy.arange(31))) / part.sum() for axis in (0, 1)]
            self.assertLess(math.dist((left + found[0], top + found[1]), (x, y)), 0.5)

    def test_it_is_where_the_file_says(self):
        """In any coordinate system, over a model in degrees and one in metres, as GeoTIFF and as tiles."""
        grey = self.image("spots.tif", [self.spots()])
        self.gdal("gdalwarp", "-t_srs", "EPSG:32616", "-r", "bilinear", "-dstnodata", "-9999", TERRAIN, "metres.tif")
        for system, model in (("EPSG:32616", TERRAIN), ("+proj=laea +lon_0=20 +lat_0=60", "metres.tif"),  # turned far round
                              ("EPSG:3857", "metres.tif")):
            self.gdal("gdalwarp", "-t_srs", system, "-r", "cubic", "-overwrite", "-dstalpha", grey, "moved.tif")
            self.view("moved.tif", "mission.plan", "--terrain", model, "--fill-voids", "-o", "page.html")
            self.assert_spots(self.scene())
        self.gdal("gdal_translate", "-b", "1", "-b", "1", "-b", "1", "-b", "2", "-of", "MBTiles", "moved.tif", "spots.mbtiles")
        self.view("spots.mbtiles")
        self.assert_spots(self.scene())

    def test_kinds_of_images(self):
        """West red, or dark where it is grey; east transparent, or light."""
        half = numpy.zeros((64, 64), numpy.uint8)
        half[:, :32] = 1
        value = {"red": (half * 200, half * 20, half * 20), "grey": (60 + (1 - half) * 140,)}
        alpha = half * 255
        for name, bands, options, east in (
                ("rgb", value["red"], (), (0, 0, 0)), ("rgba", (*value["red"], alpha), ("-colorinterp_4", "alpha"), None),
                ("infrared", (*value["red"], half * 99), ("-colorinterp_4", "undefined"), (0, 0, 0)),
                ("bgr", value["red"][::-1], ("-colorinterp", "blue,green,red"), (0, 0, 0)),
                ("none", value["grey"], ("-a_nodata", "200"), None), ("grey", value["grey"], (), (200, 200, 200)),
                ("masked", (*value["grey"], alpha), ("-colorinterp_2", "alpha"), None)):
            with self.subTest(name):
                self.view(self.image(f"{name}.tif", bands, *options, *PLACED))
                pixels = self.pixels(self.scene())
                rows, columns = pixels.shape[1:]
                left, right = (pixels[:, rows // 2, columns * share // 4] for share in (1, 3))
                expected = (60, 60, 60) if len(bands) < 3 else (200, 20, 20)
                self.assertLess(math.dist(left[:3], expected), 8)
                self.assertEqual(list(left[3:]), [255] * (len(pixels) - 3))
                if east is None:
                    self.assertEqual(right[3], 0)
                else:
                    self.assertLess(math.dist(right[:3], east), 8)
        self.view(self.palette(half))
        pixels = self.pixels(self.scene())
        self.assertLess(math.dist(pixels[:, pixels.shape[1] // 2, pixels.shape[2] // 4], (10, 200, 10)), 8)

    def palette(self, half):
        """An image whose pixel 1 is green."""
        self.image("index.tif", [half])
        vrt = self.folder / "palette.vrt"
        self.gdal("gdal_translate", "-of", "VRT", "index.tif", "palette.vrt")
        vrt.write_text(re.sub("<ColorInterp>Gray</ColorInterp>",
                              '<ColorInterp>Palette</ColorInterp><ColorTable><Entry c1="0" c2="0" c3="90" c4="255"/>'
                              '<Entry c1="10" c2="200" c3="10" c4="255"/></ColorTable>', vrt.read_text()))
        self.gdal("gdal_translate", "palette.vrt", "palette.tif")
        return "palette.tif"

    @by_night
    def test_a_large_image_is_thinned(self):
        self.gdal("gdal_create", "-of", "GTiff", "-outsize", "40000", "40000", "-bands", "1", "-co", "SPARSE_OK=TRUE", "-co",
                  "TILED=YES", "-co", "BLOCKXSIZE=4096", "-co", "BLOCKYSIZE=4096", *PLACED, "large.tif")
        said = self.folder / "said"  # what is read of it: all of 10^10 pixels take minutes
        said.mkdir()
        (said / "gdal_translate").write_text(f'#!/bin/sh\necho "$@" >> {said}/log\nexec {shutil.which("gdal_translate")} "$@"\n')
        (said / "gdal_translate").chmod(0o755)
        self.view("large.tif", path=f"{said}:{os.environ['PATH']}")
        read = re.search(r"-outsize (\d+) (\d+) .*large.tif", (said / "log").read_text())
        self.assertLess(max(map(int, read.groups())), 25000, read[0])
        scene = self.scene()
        self.assertLessEqual(max(self.pixels(scene).shape), 4096)
        self.assertLess(len(scene["basemap"]["image"]), 1e6)

    def test_what_is_no_basemap(self):
        vector = sqlite3.connect(self.folder / "vector.mbtiles")
        vector.executescript("CREATE TABLE metadata (name text, value text); CREATE TABLE tiles (zoom_level integer,"
                             "tile_column integer, tile_row integer, tile_data blob);"
                             "INSERT INTO metadata VALUES ('name', 'v'), ('format', 'pbf'), ('json', '{\"vector_layers\": []}');"
                             "INSERT INTO tiles VALUES (0, 0, 0, x'1f8b');")
        vector.commit()
        vector.close()
        grey = [numpy.full((8, 8), 9, numpy.uint8)]
        self.gdal("gdal_translate", "-of", "MBTiles", self.image("whole.tif", [numpy.full((2000, 2000), 120, numpy.uint8)] * 3),
                  "whole.mbtiles")
        whole = (self.folder / "whole.mbtiles").read_bytes()
        third = len(whole) // 3
        for name, data in (("empty", b""), ("half", whole[:third]), ("middle", whole[:third] + b"x" * third + whole[2 * third:])):
            (self.folder / f"{name}.mbtiles").write_bytes(data)
        for name, change in (("no_tables", "DROP TABLE tiles"), ("pictures", "UPDATE tiles SET tile_data = x'0102'"),
                             ("one_picture", "UPDATE tiles SET tile_data = substr(tile_data, 1, 100) WHERE rowid = 5")):
            shutil.copy(self.folder / "whole.mbtiles", self.folder / f"{name}.mbtiles")
            with sqlite3.connect(self.folder / f"{name}.mbtiles") as tiles:
                tiles.execute(change)
            tiles.close()
        (self.folder / "text.tif").write_text("no image")
        (self.folder / "cut.tif").write_bytes((self.folder / self.image("whole.tif", [self.spots()])).read_bytes()[:20000])
        kind = "expected a GeoTIFF image, or MBTiles of PNG or JPEG tiles"
        nowhere = "is nowhere on the Earth: it lacks a coordinate system or its corners"
        for file, said in (
                ("text.tif", kind), ("vector.mbtiles", kind), ("mission.plan", kind), ("empty.mbtiles", kind), ("no_tables.mbtiles", kind),
                ("half.mbtiles", "gdalinfo: database disk image is malformed"),
                ("middle.mbtiles", "gdalinfo: In ExecuteSQL(): sqlite3_step("), ("pictures.mbtiles", "gdalwarp: Cannot parse tile data"),
                ("one_picture.mbtiles", "gdalwarp: libpng: Read Error"),
                (self.image("heights.tif", [numpy.full((8, 8), 900, numpy.int16)]), "expected an image of bytes, found numbers (Int16)"),
                (self.image("bare.tif", grey, "-co", "PROFILE=BASELINE"), nowhere),
                (self.image("no_corners.tif", grey, "-a_srs", "EPSG:4326"), nowhere),
                (self.image("no_system.tif", grey, "-a_ullr", "0", "9", "9", "0"), nowhere),
                (self.image("outside.tif", grey, *OUTSIDE), "shows nothing of the scene: it covers longitude "
                                                            "10.000 to 11.000 and latitude 49.000 to 50.000"),
                ("cut.tif", "gdalwarp: ")):
            err = self.view(file, code=3)
            self.assertEqual(err.count("\n"), 1, err)
            self.assertTrue(err.startswith(f"altiplan: {file}: {said}"), err)
            self.assertFalse((self.folder / "page.html").exists())
        for file, said in (("missing.tif", "there is no such file"), (".", "is a folder, expected a file"),
                           ("/vsicurl/http://localhost/a.tif", "there is no such file")):
            self.assertEqual(self.view(file, code=3), f"altiplan: --basemap {file}: {said}\n")
        self.image("spots.tif", [self.spots()])
        self.assertIn("--basemap is shown by -o, --png and --mp4",
                      self.view("spots.tif", "mission.plan", "--terrain", TERRAIN, "--svg", "map.svg", code=2))
        self.view("spots.tif", "mission.plan", "--terrain", TERRAIN, "-o", "spots.tif", code=3)
        done = subprocess.run([PROGRAM, "view", "mission.plan", "--terrain", TERRAIN, "-o", "page.html", "--basemap",
                               "spots.tif"], cwd=self.folder, capture_output=True, text=True, timeout=600,
                              env={**os.environ, "PATH": str(self.folder)})
        self.assertEqual((done.returncode, done.stderr),
                         (3, "altiplan: --basemap needs gdalwarp: install the Debian package 'gdal-bin'\n"))

    def test_a_world_without_a_position(self):
        (self.folder / "scenario.yaml").write_text(
            "altiplan: 1\nvolume: {min_m: [0, 0, 0], max_m: [100, 100, 50]}\n"
            "start: {at_m: [10, 10, 10]}\ngoal: {at_m: [90, 90, 10]}\n")
        (self.folder / "pipeline.yaml").write_text("altiplan: 1\nscenario: scenario.yaml\nsteps: [{plan: astar}]\n")
        subprocess.run([PROGRAM, "run", "pipeline.yaml", "--out", "result.json"], cwd=self.folder, check=True, capture_output=True)
        err = self.view(self.image("spots.tif", [self.spots()]), "result.json", "-o", "page.html", code=3)
        self.assertRegex(err, "the world has no geographic position")

    def test_voids_that_are_closed_are_holes(self):
        """And not as high as they are judged, ten times as high as the ground and its contours."""
        self.gdal("gdal_translate", "-of", "ENVI", TERRAIN, "whole")
        heights = numpy.fromfile(self.folder / "whole", numpy.int16).reshape(1, 344, 403)
        heights[0, 150:160, 200:220] = -9999
        corners = json.loads(subprocess.run(["gdalinfo", "-json", TERRAIN], check=True, capture_output=True).stdout)["cornerCoordinates"]
        voids = self.image("voids.tif", heights, "-a_srs", "EPSG:4326", "-a_nodata", "-9999", "-a_ullr",
                           *map(str, corners["upperLeft"] + corners["lowerRight"]))
        subprocess.run([PROGRAM, "view", "mission.plan", "--terrain", voids, "-o", "page.html"], cwd=self.folder, check=True,
                       capture_output=True)
        ground = self.scene()["ground"]
        shown = numpy.frombuffer(base64.b64decode(ground["heights"]), numpy.float32)
        self.assertEqual(numpy.isnan(shown).sum(), 200)
        self.assertLess(numpy.nanmax(shown), 1100)

    def test_pages_that_edit_have_it(self):
        name = self.image("spots.tif", [self.spots()])
        session = Session(self.plan, "--terrain", TERRAIN, "--basemap", self.folder / name)
        self.addCleanup(session.end)
        for _ in range(2):
            status, page = session.request("GET", session.address.path)
            scene = self.scene(page)
            self.assertEqual((status, scene["basemap"]["name"]), (200, "spots.tif"))
        self.view(name)
        shown = self.scene()
        self.assertEqual(scene["basemap"], shown["basemap"])
        outside = self.image("outside.tif", [self.spots()], *OUTSIDE)
        done = subprocess.run([PROGRAM, "edit", "--no-browser", "mission.plan", "--terrain", TERRAIN, "--basemap", outside],
                              cwd=self.folder, capture_output=True, text=True, timeout=600)
        self.assertEqual(done.returncode, 3)
        self.assertIn("shows nothing of the scene", done.stderr)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
