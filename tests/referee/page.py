# SPDX-License-Identifier: Apache-2.0
"""What `altiplan view` puts on the page: the scene, solids of layers that are drawn, and profiles."""
import base64
import json
import os
import subprocess
import tempfile

import numpy as np

import solids


def scene(program, result):
    with tempfile.TemporaryDirectory() as folder:
        page = os.path.join(folder, "page.html")
        subprocess.run([program, "view", result, "-o", page], check=True, capture_output=True,
                       timeout=600)
        with open(page, encoding="utf-8") as file:
            text = file.read()
    begin = text.rindex("{", 0, text.index('"altiplan_scene"'))
    return json.JSONDecoder(object_hook=unpacked).raw_decode(text[begin:])[0]


def unpacked(value):
    """A long list of thousandths, which the page holds as differences in base64."""
    if "packed" not in value:
        return value
    raw = iter(base64.b64decode(value["packed"]))

    def number():
        whole, scale = 0, 1
        while (byte := next(raw)) >= 128:
            whole, scale = whole + (byte - 128) * scale, 128 * scale
        return whole + byte * scale

    def tokens():
        current = 0
        while True:
            code = number()
            repeats = number() if code == 1 else 1
            current = current if code == 1 else code
            for _ in range(repeats):
                yield current

    token = tokens()

    def column():
        values, last, step = [], 0, 0
        for _ in range(value["count"]):
            code = next(token)
            if code == 0:
                values.append(None)
                continue
            now = last + step + (-((code - 1) // 2) if code % 2 == 1 else (code - 2) // 2)
            step, last = (now - last if value["order"] == 2 else 0), now
            values.append(now / 1000)
        return values

    if value["per"] == 0:
        return column()
    return [list(row) for row in zip(*[column() for _ in range(value["per"])])]


def drawn(of):
    """A function from a layer's id to the solids that the scene has of it; to the millimetre only."""
    def solids_of(layer):
        found = [solid_of(s) for s in of["solids"] if s["layer"] == layer]
        for boxes in of["boxes"]:
            if boxes["layer"] == layer:
                numbers = np.frombuffer(base64.b64decode(boxes["data"]), "<f4").reshape(-1, 6)
                found += [solids.box(row[:3], row[3:]) for row in numbers]
        return found
    return solids_of


def solid_of(s):
    if s["shape"] == "sphere":
        return solids.sphere(s["at"], s["radius"])
    if s["shape"] == "box":
        return solids.box(s["min"], s["max"])
    low = -solids.EVERYWHERE if s["floor"] is None else s["floor"]
    high = solids.EVERYWHERE if s["ceiling"] is None else s["ceiling"]
    if s["shape"] == "cylinder":
        return solids.cylinder(s["at"], s["radius"], low, high)
    return solids.prism(s["outline"], s["holes"], low, high)


def profile_differences(of, metrics):
    """Where the least clearance of the page's profile is not the metric, to 1 cm."""
    profile = of["results"][0]["profile"]
    metric = metrics["min_clearance_m"]
    if profile is None or metric is None:
        return []
    least = min((v for v in profile["clearance"] if v is not None), default=None)
    if least is None or abs(least - metric) > 0.01:
        return [f"page: the least clearance of the profile is {least} m, the metric {metric} m"]
    return []
