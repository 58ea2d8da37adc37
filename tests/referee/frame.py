# SPDX-License-Identifier: Apache-2.0
"""Longitude and latitude on the plane: metres by the radii of curvature of WGS 84 at one latitude."""
import math

AXIS = 6378137.0
FLATTENING = 1 / 298.257223563


class Frame:
    def __init__(self, lon, lat, radii_at):
        square = FLATTENING * (2 - FLATTENING)
        phi = math.radians(radii_at)
        w = math.sqrt(1 - square * math.sin(phi) ** 2)
        self.lon, self.lat = lon, lat
        self.east = math.radians(1) * AXIS / w * math.cos(phi)  # m per degree
        self.north = math.radians(1) * AXIS * (1 - square) / w**3

    def metres(self, lon, lat):
        return (lon - self.lon) * self.east, (lat - self.lat) * self.north
