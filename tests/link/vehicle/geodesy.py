# SPDX-License-Identifier: Apache-2.0
"""Positions on WGS 84 and the plane tangent to it: over the legs of a mission, metres north and
east follow from degrees by the two radii of curvature at the middle latitude."""
import math
from dataclasses import dataclass

SEMI_MAJOR = 6378137.0
FLATTENING = 1 / 298.257223563
ECCENTRICITY2 = FLATTENING * (2 - FLATTENING)


@dataclass(frozen=True)
class Position:
    lat: float  # degrees
    lon: float  # degrees
    alt: float  # metres above mean sea level

    def at(self, alt):
        return Position(self.lat, self.lon, alt)


def metres_per_degree(lat):
    """North and east, at the latitude (degrees)."""
    sine = math.sin(math.radians(lat))
    bend = 1 - ECCENTRICITY2 * sine * sine
    meridian = SEMI_MAJOR * (1 - ECCENTRICITY2) / bend ** 1.5
    normal = SEMI_MAJOR / math.sqrt(bend)
    return (math.radians(1) * meridian,
            math.radians(1) * normal * math.cos(math.radians(lat)))


def vector(a, b):
    """North, east and up (m) from a to b."""
    north, east = metres_per_degree((a.lat + b.lat) / 2)
    lon = (b.lon - a.lon + 180) % 360 - 180
    return (b.lat - a.lat) * north, lon * east, b.alt - a.alt


def offset(a, north, east, up=0.0):
    per_north, _ = metres_per_degree(a.lat)
    lat = a.lat + north / per_north
    _, per_east = metres_per_degree((a.lat + lat) / 2)
    lon = (a.lon + east / per_east + 180) % 360 - 180
    return Position(lat, lon, a.alt + up)


def horizontal(a, b):
    north, east, _ = vector(a, b)
    return math.hypot(north, east)


def distance(a, b):
    return math.hypot(*vector(a, b))


def wrap(angle):
    """Into (-pi, pi]."""
    return math.pi - (math.pi - angle) % (2 * math.pi)
