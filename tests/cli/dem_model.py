# SPDX-License-Identifier: Apache-2.0
"""Models of ALTIPLAN_TEST_DATA that a referee reads itself, and items of a .plan; the tests are called with PROGRAM
SOURCES."""
import os
import pathlib
import struct
import sys

SOURCES = sys.argv[2]
MODELS = pathlib.Path(os.environ.get("ALTIPLAN_TEST_DATA", f"{SOURCES}/../shared/data"), "dem")
METRES = 111320  # a degree


class Model:
    """Posts by row from the north, and the ground between four of them."""

    def __init__(self, name):
        self.file = str(MODELS / name)
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
