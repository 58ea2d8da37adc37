# SPDX-License-Identifier: Apache-2.0
"""Random worlds: scenarios as files, with all that stands in them written out."""
import json
import os

import numpy as np

import geometry
import scenario as scenarios
import solids

START_TIME = "2026-05-01T10:00:00Z"
ORIGIN = (8.5, 47.4)


def write(folder, name, data):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        json.dump(data, file, indent=1)  # JSON is YAML
    return path


def rounded(values, digits=3):
    return [round(float(v), digits) for v in values]


def star(rng, at, radius, corners):
    """A polygon about a place that is seen whole from there; concave as a rule."""
    turn = np.sort(rng.uniform(0, 2 * np.pi, corners))
    while np.diff(turn, append=turn[0] + 2 * np.pi).max() > 2.8 or np.diff(turn).min() < 0.1:
        turn = np.sort(rng.uniform(0, 2 * np.pi, corners))
    far = radius * rng.uniform(0.4, 1, corners)
    return [rounded((at[0] + f * np.cos(t), at[1] + f * np.sin(t))) for f, t in zip(far, turn)]


class World:
    def __init__(self, rng, folder, kind):
        self.rng, self.folder, self.kind = rng, folder, kind
        self.side = float(rng.choice([600, 1500, 4000]))
        self.top = self.side * 0.4
        self.base = 0.0
        self.scenario = {
            "altiplan": 1, "name": f"Random world of {kind}", "environment": [],
            "start_time": START_TIME,
            "vehicle": {"radius_m": float(rng.choice([0, 0, 1, 2.5])),
                        "speed_mps": self.side / 80, "sensing_m": self.side / 6}}
        getattr(self, "make_" + kind)()
        self.scenario["volume"] = {"min_m": [0, 0, self.base],
                                   "max_m": [self.side, self.side, self.base + self.top]}
        self.constraints = []

    def place(self):
        return rounded(self.rng.uniform(0.1, 0.9, 3) * [self.side, self.side, self.top]
                       + [0, 0, self.base])

    def size(self, low=0.02, high=0.12):
        return round(self.side * self.rng.uniform(low, high), 3)

    def ends(self):
        """A floor and a ceiling, each perhaps."""
        low, high = np.sort(self.rng.uniform(0, 1, 2)) * self.top + self.base
        of = {}
        if self.rng.random() < 0.5:
            of["floor_m"] = round(low, 3)
        if self.rng.random() < 0.6:
            of["ceiling_m"] = round(high + 1, 3)
        return of

    def solid(self, kinds=("sphere", "cylinder", "box", "prism")):
        kind, at = str(self.rng.choice(kinds)), self.place()
        if kind == "sphere":
            return {"sphere": {"at_m": at, "radius_m": self.size()}}
        if kind == "cylinder":
            return {"cylinder": {"at_m": at[:2], "radius_m": self.size(), **self.ends()}}
        if kind == "box":
            half = np.array([self.size(), self.size(), self.size(0.05, 0.4)])
            return {"box": {"min_m": rounded(at - half), "max_m": rounded(at + half)}}
        outline = star(self.rng, at, self.size(0.05, 0.15), int(self.rng.integers(3, 9)))
        return {"prism": {"outline_m": outline, **self.ends()}}

    def make_solids(self):
        for n in range(int(self.rng.integers(4, 25))):
            self.scenario["environment"].append({**self.solid(), "id": f"solid_{n}"})

    def make_level(self):
        for n in range(int(self.rng.integers(3, 14))):
            of = self.solid(("cylinder",))
            of["cylinder"] = {k: of["cylinder"][k] for k in ("at_m", "radius_m")}
            self.scenario["environment"].append({**of, "id": f"disc_{n}"})
        if self.rng.random() < 0.5:
            self.scenario["environment"].append({"zones": {"list": self.zones(3)}})
        self.scenario["level_flight_at_m"] = round(self.top / 2, 1)

    def zones(self, count):
        """Some that count and some whose time is another, some with holes."""
        made = []
        for n in range(count):
            at, size = self.place(), self.size(0.06, 0.16)
            zone = {"id": f"zone_{n}", **self.ends()}
            if self.rng.random() < 0.3:
                zone["cylinder"] = {"at_m": at[:2], "radius_m": size}
            else:
                outline = star(self.rng, at, size, int(self.rng.integers(4, 10)))
                zone["polygon"] = {"outline_m": outline}
                room = -float(geometry.polygon(np.array([at[:2]]), [np.array(outline)])[0])
                if self.rng.random() < 0.5 and room > 3:
                    zone["polygon"]["holes_m"] = [star(self.rng, at, 0.9 * room, 5)]
            when = self.rng.random()
            if when < 0.15:
                zone["until"] = "2026-05-01T09:59:59Z"  # before take-off
            elif when < 0.3:
                zone["from"] = "2026-05-01T10:30:00Z"
            elif when < 0.4:
                zone["from"] = "2026-05-01T11:00:01Z"  # a second after the horizon
            made.append(zone)
        return made

    def make_zones(self):
        listed = self.zones(int(self.rng.integers(2, 8)))
        if self.rng.random() < 0.5:
            s, t = self.side, self.top
            listed += [{"kind": "keep_in", "floor_m": round(0.05 * t, 2), "ceiling_m": round(0.9 * t, 2),
                        "polygon": {"outline_m": rounded_all([[0.02, 0.03], [0.97, 0.02], [0.6, 0.5],
                                                              [0.95, 0.96], [0.03, 0.98]], s)}},
                       {"kind": "keep_in", "cylinder": {"at_m": rounded([0.8 * s, 0.5 * s]),
                                                        "radius_m": round(0.17 * s, 2)}}]
        of = {"list": listed}
        if self.rng.random() < 0.6:
            self.scenario["frame"] = {"origin_lonlat": list(ORIGIN)}
            of["file"] = self.geojson("zones.geojson", 3, "upper")
            of["ceiling_property"] = "upper"
        self.scenario["environment"].append({"zones": of})

    def geojson(self, name, count, key):
        """Footprints in degrees, some with a courtyard."""
        features = []
        per_degree = np.array([75365.0, 111170.0])  # about: where they are is in the file alone
        for _ in range(count):
            at, size = self.place(), self.size(0.04, 0.1)
            rings = [star(self.rng, at, size, int(self.rng.integers(4, 9)))]
            room = -float(geometry.polygon(np.array([at[:2]]), [np.array(rings[0])])[0])
            if self.rng.random() < 0.4 and room > 3:
                rings.append(star(self.rng, at, 0.8 * room, 4)[::-1])
            rings = [[list(np.round(np.array(p) / per_degree + ORIGIN, 9)) for p in ring + ring[:1]]
                     for ring in rings]
            features.append({"type": "Feature", "properties": {key: round(self.size(0.05, 0.3), 1)},
                             "geometry": {"type": "Polygon", "coordinates": rings}})
        write(self.folder, name, {"type": "FeatureCollection", "features": features})
        return name

    def make_city(self):
        self.scenario["frame"] = {"origin_lonlat": list(ORIGIN)}
        name = self.geojson("buildings.geojson", int(self.rng.integers(5, 25)), "height")
        self.scenario["environment"].append({"city": {"file": name, "base_m": 3.0}})

    def make_terrain(self):
        n = int(self.rng.integers(12, 50))
        step = round(self.side / (n - 3), 2)
        xs = np.linspace(0, 1, n)
        x, y = np.meshgrid(xs, xs)
        heights = np.zeros((n, n))
        for _ in range(8):
            fx, fy, phase = self.rng.uniform(0.5, 5, 2).tolist() + [self.rng.uniform(0, 6.3)]
            heights += self.rng.uniform(0, self.side / 60) * np.sin(6.3 * (fx * x + fy * y) + phase)
        heights += self.rng.uniform(-1, 1, (n, n)) * self.side / 200 + 400
        lines = [f"ncols {n}", f"nrows {n}", "xllcorner 500000", "yllcorner 5200000",
                 f"cellsize {step}", "NODATA_value -9999"]
        lines += [" ".join(f"{v:.2f}" for v in row) for row in heights]
        with open(os.path.join(self.folder, "ground.asc"), "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
        self.base = round(float(heights.min()), 1)
        self.scenario["environment"].append({"terrain": {"file": "ground.asc", "crs": "EPSG:32632"}})
        self.some_solids()

    def make_hills(self):
        peaks = [{"at_m": self.place()[:2], "height_m": self.size(0.05, 0.2),
                  "sigma_m": [self.size(0.05, 0.15), self.size(0.05, 0.15)]}
                 for _ in range(int(self.rng.integers(2, 8)))]
        self.scenario["environment"].append(
            {"hills": {"base_m": 5.0, "cap_m": round(0.22 * self.side, 1), "peaks": peaks}})
        self.some_solids()

    def make_wing(self):
        """An aeroplane among few solids, in layers of wind as a rule."""
        speed = self.side / 80
        self.scenario["vehicle"] = {
            "radius_m": float(self.rng.choice([0, 2.5])),
            "wing": {"airspeed_mps": round(speed, 2), "climb_deg": 12, "sink_deg": 10,
                     "bank_deg": float(np.degrees(np.arctan(speed**2 / 9.80665 / (self.side / 25))))}}
        borders = np.sort(self.rng.uniform(0.1, 0.9, int(self.rng.integers(0, 4)))) * self.top
        if len(borders):
            self.scenario["wind"] = {"layers": [
                {"above_m": round(float(z), 2), "from_deg": float(self.rng.integers(0, 360)),
                 "speed_mps": round(float(self.rng.uniform(0, 0.6) * speed), 2)} for z in borders]}
        self.some_solids()

    def some_solids(self):
        for n in range(int(self.rng.integers(0, 6))):
            self.scenario["environment"].append({**self.solid(), "id": f"solid_{n}"})

    def settle(self):
        """Finds a start and a goal with room about them; False where there are none. Writes it."""
        self.scenario["start"] = self.scenario["goal"] = {"at_m": [0, 0, 0]}
        self.scenario["constraints"] = self.constraints
        path = write(self.folder, "scenario.yaml", self.scenario)
        mission = scenarios.of_file(path)
        standing = solids.Set([s for layer in mission.layers for s in layer.solids])
        grounds = [layer.ground for layer in mission.layers if layer.ground is not None]
        free = []
        for _ in range(200):
            p = np.array(self.place())
            if mission.level is not None:
                p[2] = mission.level
            height = [p[2] - float(g.height(p[:2])) for g in grounds]
            near = standing.nearest(p[None], p[None])
            if (near is None or near[0] > self.side / 50) and all(
                    self.side / 40 < h for h in height):
                if not free or np.linalg.norm(p - free[0]) > 0.5 * self.side:
                    free.append(p)
            if len(free) == 2:
                break
        else:
            return False
        start, goal = ({"at_m": rounded(p)} for p in free)
        self.scenario["start"] = start
        self.scenario["goal"] = {**goal, "tolerance_m": round(self.side / 100, 1)}
        for end in ("start", "goal") if self.kind == "wing" else ():
            if self.rng.random() < 0.7:
                self.scenario[end]["heading_deg"] = float(self.rng.integers(0, 360))
        return True

    def write(self):
        self.scenario["constraints"] = self.constraints
        return write(self.folder, "scenario.yaml", self.scenario)


def rounded_all(points, scale):
    return [rounded(np.array(p) * scale) for p in points]


KINDS = ("solids", "solids", "zones", "city", "terrain", "hills", "level", "wing")
