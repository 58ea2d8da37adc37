# SPDX-License-Identifier: Apache-2.0
"""Terrain by https://mavlink.io/en/services/terrain.html: the vehicle asks for blocks of 7 x 8
tiles of 4 x 4 heights around it and its mission, again for what did not come, and keeps them.

Bit b of the mask is the tile b // 8 tiles north and b % 8 tiles east of the block's south-west
corner; in a tile four heights go east, then the next four further north."""
import math

import geodesy
from constants import TERRAIN

TILE, ROWS, COLUMNS = 4, 7, 8
ALL_TILES = (1 << (ROWS * COLUMNS)) - 1
ASK_EVERY = 1.0  # s


class Block:
    def __init__(self, corner):
        self.corner = corner  # Position
        self.missing = ALL_TILES
        self.heights = {}  # (steps north, steps east): m


class Terrain:
    """Blocks lie on a lattice about home and overlap by a tile, so that a point is inside one."""

    def __init__(self, enabled, spacing, node):
        self.enabled, self.spacing, self.node = enabled, spacing, node
        self.blocks = {}
        self.asked = -math.inf

    def stride(self):
        return (ROWS - 1) * TILE * self.spacing, (COLUMNS - 1) * TILE * self.spacing

    def block_of(self, lat, lon):
        home = self.node.pilot.home if not self.blocks else self.origin
        self.origin = home
        north, east, _ = geodesy.vector(home, geodesy.Position(lat, lon, 0.0))
        stride = self.stride()
        key = math.floor(north / stride[0]), math.floor(east / stride[1])
        if key not in self.blocks:
            corner = geodesy.offset(home, key[0] * stride[0], key[1] * stride[1])
            # Whole units of the message, so that answers name the very corner.
            self.blocks[key] = Block(geodesy.Position(round(corner.lat * 1e7) / 1e7,
                                                      round(corner.lon * 1e7) / 1e7, 0.0))
        return self.blocks[key]

    def step(self):
        if not self.enabled or self.node.now - self.asked < ASK_EVERY:
            return
        self.asked = self.node.now
        here = self.node.pilot.body.position
        self.block_of(here.lat, here.lon)
        for item in self.node.pilot.mission_items():
            if item.frame in TERRAIN:
                self.block_of(*item.lat_lon())
        for block in self.blocks.values():
            if block.missing:
                self.node.send("TERRAIN_REQUEST", {**self.corner(block), "mask": block.missing})
                break
        self.report(here.lat, here.lon)

    def corner(self, block):
        return {"lat": round(block.corner.lat * 1e7), "lon": round(block.corner.lon * 1e7),
                "grid_spacing": self.spacing}

    def on_data(self, message):
        if message.grid_spacing != self.spacing or message.gridbit >= ROWS * COLUMNS:
            return
        for block in self.blocks.values():
            corner = self.corner(block)
            if (corner["lat"], corner["lon"]) == (message.lat, message.lon):
                self.fill(block, message)

    @staticmethod
    def fill(block, message):
        row, column = divmod(message.gridbit, COLUMNS)
        for i, height in enumerate(message.data):
            block.heights[row * TILE + i // TILE, column * TILE + i % TILE] = height
        block.missing &= ~(1 << message.gridbit)

    def height(self, lat, lon):
        """Between the four heights around; home's where there are none."""
        known = self.enabled and math.isfinite(lat) and math.isfinite(lon)
        found = self.interpolated(lat, lon) if known else None
        return self.node.pilot.home.alt if found is None else found

    def interpolated(self, lat, lon):
        block = self.block_of(lat, lon)
        north, east, _ = geodesy.vector(block.corner, geodesy.Position(lat, lon, 0.0))
        row, column = north / self.spacing, east / self.spacing
        i, j = math.floor(row), math.floor(column)
        corners = [block.heights.get((i + di, j + dj)) for di in (0, 1) for dj in (0, 1)]
        if None in corners:
            return None
        south = corners[0] + (corners[1] - corners[0]) * (column - j)
        far = corners[2] + (corners[3] - corners[2]) * (column - j)
        return south + (far - south) * (row - i)

    def report(self, lat, lon):
        pilot = self.node.pilot
        found = self.interpolated(lat, lon)
        missing = sum(bin(block.missing).count("1") for block in self.blocks.values())
        height = found or 0.0
        self.node.send("TERRAIN_REPORT", {
            "lat": round(lat * 1e7), "lon": round(lon * 1e7),
            "spacing": self.spacing if found is not None else 0, "terrain_height": height,
            "current_height": pilot.body.position.alt - height if found is not None else 0.0,
            "pending": missing, "loaded": ROWS * COLUMNS * len(self.blocks) - missing})
