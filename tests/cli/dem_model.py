# SPDX-License-Identifier: Apache-2.0
"""Models of ALTIPLAN_TEST_DATA that a referee reads itself, and items of a .plan; the tests are called with PROGRAM
SOURCES."""
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys

SOURCES = sys.argv[2]
MODELS = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", f"{SOURCES}/../shared/data"), "dem")
METRES = 111320  # a degree


class Model:
    """Posts by row from the north, and the ground between four of them."""

    def __init__(self, name):
        self.file = str(MODELS / name)
        self.name = pathlib.Path(name).stem
        self.crs = []
        if name.endswith(".hgt"):
            side = 1201
            self.posts = struct.unpack(f">{side * side}h", pathlib.Path(self.file).read_bytes())
            self.columns, self.step = side, 1 / 1200
            self.west, self.north = -int(name[4:7]), int(name[1:3]) + 1
        else:
            words = pathlib.Path(self.file).read_text().split()
            self.crs = ["--crs", "EPSG:4326"]
            head = {words[n]: float(words[n + 1]) for n in range(0, 12, 2)}
            self.posts = [float(word) for word in words[12:]]
            self.columns, self.step = int(head["ncols"]), head["cellsize"]
            self.west = head["xllcorner"] + self.step / 2
            self.north = head["yllcorner"] + (head["nrows"] - 0.5) * self.step

    def ground(self, lat, lon):
        x, y = (lon - self.west) / self.step, (self.north - lat) / self.step
        column, row = int(x), int(y)
        u, v = x - column, y - row
        at = row * self.columns + column
        a, b = self.posts[at:at + 2]
        c, d = self.posts[at + self.columns:at + self.columns + 2]
        return min((a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v,
                   *((a + u * (b - a) + v * (d - b), a + u * (d - c) + v * (c - a)) if u else (a + v * (c - a),)))


    def high_place(self):
        """The middle and the reach (degrees) of a box of known ground about one of its highest posts."""
        rows = len(self.posts) // self.columns
        reach = min(0.05, 0.4 * self.step * min(rows, self.columns))
        beside = int(reach / self.step) + 3
        chance = random.Random(1)
        places = [(chance.randrange(beside, rows - beside), chance.randrange(beside, self.columns - beside))
                  for _ in range(1000)]
        for row, column in sorted(places, key=lambda at: -self.posts[at[0] * self.columns + at[1]]):
            box = [self.posts[n * self.columns + column - beside:n * self.columns + column + beside]
                   for n in range(row - beside, row + beside, 4)]
            if min(map(min, box)) > -9000:
                return self.north - row * self.step, self.west + column * self.step, reach
        raise ValueError(f"{self.file}: no box without voids")


def all_models(folder):
    """Those of ALTIPLAN_TEST_DATA, in degrees, with a place to fly over; of other systems only where GDAL's tools are."""
    for file in sorted(MODELS.iterdir()):
        if file.suffix in (".hgt", ".asc"):
            model = Model(file.name)
        elif file.suffix in (".tif", ".dt1") and shutil.which("gdalwarp"):
            made = str(folder / file.stem)
            subprocess.run(["gdalwarp", "-q", "-t_srs", "EPSG:4326", "-r", "bilinear", "-tr", *["0.00055555"] * 2,
                            "-dstnodata", "-9999", "-ot", "Float32", str(file), made + ".tif"], check=True)
            subprocess.run(["gdal_translate", "-q", "-of", "AAIGrid", "-co", "FORCE_CELLSIZE=YES", made + ".tif",
                            made + ".asc"], check=True)
            pathlib.Path(made + ".prj").unlink()  # it is said with --crs
            model = Model(made + ".asc")
        else:
            continue
        yield model, model.high_place()


def item(number, command, lat, lon, height, frame=3, params=(0, 0, 0, 0)):
    return {"type": "SimpleItem", "command": command, "frame": frame, "doJumpId": number, "autoContinue": True,
            "params": [*params, lat, lon, height]}


def write_ridge(folder, lat, lon):
    """A ridge 200 m high, from 760 to 910 m east of a place at 400 m."""
    rows = [" ".join("600" if 60 <= column < 64 else "400" for column in range(120)) for _ in range(60)]
    (folder / "ridge.asc").write_text(
        f"ncols 120\nnrows 60\nxllcorner {lon - 0.02}\nyllcorner {lat - 0.015}\ncellsize 0.0005\n"
        "NODATA_value -9999\n" + "\n".join(rows) + "\n")
    (folder / "ridge.prj").write_text(
        'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
        'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
