# SPDX-License-Identifier: Apache-2.0
"""A scenario with its pipeline, read from the files and the overrides that a result names."""
import dataclasses
import os

import numpy as np
import yaml

import curved
import layers
import solids


def load(path):
    """Every scalar as it is written: numbers and words are told apart where they are asked for."""
    with open(path, encoding="utf-8") as file:
        return yaml.load(file, Loader=yaml.BaseLoader)


def override(files, key, text):
    words, value = key.split("."), yaml.load(text, Loader=yaml.BaseLoader)
    of = files["pipeline"]
    if words[0] == "scenario" and len(words) > 1:
        of, words = files["scenario"], words[1:]
    for word, after in zip(words, words[1:] + [None]):
        key = int(word) if isinstance(of, list) else word
        if after is None:
            of[key] = value
        elif isinstance(of, dict):
            of = of.setdefault(key, [] if after.isdigit() else {})
        else:
            of = of[key]


@dataclasses.dataclass
class Mission:
    layers: list
    moving: list
    events: list
    start: np.ndarray
    goal: np.ndarray
    tolerance: float
    via: list
    low: np.ndarray
    high: np.ndarray
    level: object
    radius: float
    speed: float
    speed_near: list
    on_the_spot: bool
    rules: list
    wing: tuple = None  # airspeed, bank, climb, sink
    air: curved.Air = None
    start_course: object = None
    goal_heading: object = None

    @property
    def is_flown(self):
        """A course over the ground is not a heading, nor a gradient a climb."""
        return self.wing is not None or bool(self.air.layers)

    def course(self, heading, z):
        """Over the ground, m/s, of a heading clockwise from north."""
        h = np.radians(heading)
        return self.air.speed * np.array([np.sin(h), np.cos(h)]) + self.air.wind(z)

    def known(self):
        """The solids that are known before take-off, and all ground."""
        known = [s for layer in self.layers if layer.known for s in layer.solids]
        return solids.Set(known), [g.ground for g in self.layers if g.ground is not None and g.known]


def mission(scenario, rules, folder, drawn=None):
    """The mission of a scenario (as read) with the constraints of its pipeline."""
    builder = layers.Builder(scenario, folder, drawn)
    made = [builder.layer(entry, None) for entry in scenario.get("environment", [])]
    ids = set()
    for layer in made:
        name, n = layer.id, 2
        while layer.id in ids:
            layer.id, n = f"{name}_{n}", n + 1
        ids.add(layer.id)
    volume, vehicle = scenario.get("volume", {}), scenario.get("vehicle", {})
    low, high = (np.array([float(v) for v in volume.get(key, [sign * np.inf] * 3)])
                 for key, sign in (("min_m", -1), ("max_m", 1)))
    if "mission" in scenario or "start" not in scenario or "goal" not in scenario:
        raise layers.NotJudged("a mission from a file")
    goal, start, wing = scenario["goal"], scenario["start"], vehicle.get("wing")
    if "loiter" in goal or "loiter" in start:
        raise layers.NotJudged("a loiter circle")
    wing = wing and tuple(float(wing[k]) for k in ("airspeed_mps", "bank_deg", "climb_deg", "sink_deg"))
    speed = layers.end(vehicle, "speed_mps", 15.0)
    judged = Mission(
        made, moving(scenario, builder), events(scenario, builder),
        builder.point(scenario["start"]), builder.point(goal), float(goal.get("tolerance_m", 0)),
        [(builder.point(v), float(v.get("tolerance_m", 0))) for v in scenario.get("via", [])],
        low, high, layers.end(scenario, "level_flight_at_m", None), layers.end(vehicle, "radius_m", 0.0),
        layers.end(vehicle, "speed_mps", 15.0),
        [(float(s["within_m"]), float(s["speed_mps"])) for s in vehicle.get("speed_near", [])],
        vehicle.get("turns_on_the_spot", "false") == "true",
        [*scenario.get("constraints", []), *rules], wing,
        curved.Air(wind_of(scenario.get("wind", {})), wing[0] if wing else speed))
    judged.goal_heading = layers.end(goal, "heading_deg", None)
    if "heading_deg" in start:
        judged.start_course = judged.course(float(start["heading_deg"]), judged.start[2])
    return judged


def wind_of(of):
    """[(lower border, velocity)], from the lowest."""
    made = []
    for layer in of.get("layers", [of] if of else []):
        blows, speed = np.radians(float(layer["from_deg"])), float(layer["speed_mps"])
        made.append((layers.end(layer, "above_m", -np.inf),
                     -speed * np.array([np.sin(blows), np.cos(blows)])))
    return made


def moving(scenario, builder):
    made = []
    for entry in scenario.get("moving", []):
        if "random" in entry:
            raise layers.NotJudged("moving obstacles that are drawn")
        kind, = [k for k in entry if k not in ("id", "known")]
        layer = builder.layer(entry, f"moving_{len(made)}")
        layer.velocity = np.array(layers.numbers(entry[kind]["velocity_mps"]))
        made.append(layer)
    return made


def events(scenario, builder):
    """(seconds or None, (place, metres) or None, change) of each event."""
    made = []
    for entry in scenario.get("events", []):
        near = entry.get("when_near")
        near = near and (builder.point(near), float(near["within_m"]))
        at_s = float(entry["at_s"]) if "at_s" in entry else None
        if "add" in entry:
            layer = builder.layer(dict(entry["add"], id=entry.get("id", "")), "")
            (_, of), = entry["add"].items()
            if "velocity_mps" in of:
                layer.velocity = np.array(layers.numbers(of["velocity_mps"]))
            change = ("add", layer)
        elif "remove" in entry:
            change = ("remove", entry["remove"])
        elif "move" in entry:
            change = ("move", entry["move"]["layer"], np.array(layers.numbers(entry["move"]["by_m"])))
        elif "move_goal" in entry:
            change = ("move_goal", builder.point(entry["move_goal"]))
        else:
            raise layers.NotJudged("cells that are set")
        made.append((at_s, near, change))
    return made


def of_result(result, drawn=None):
    files = {"pipeline": load(result["pipeline"]), "scenario": load(result["scenario"])}
    for key, text in result.get("overrides", {}).get("set", {}).items():
        override(files, key, text)
    folder = os.path.dirname(result["scenario"])
    return mission(files["scenario"], files["pipeline"].get("constraints", []), folder, drawn)


def of_file(path):
    """Of a scenario alone, as `altiplan check --route` judges by it."""
    return mission(load(path), [], os.path.dirname(os.path.abspath(path)))
