# SPDX-License-Identifier: Apache-2.0
"""energy_test.py PROGRAM BROKEN: time and energy of routes as they are flown, against formulas written here.

`python3 energy_test.py PROGRAM BROKEN Energy.test_stops` runs one case."""
import base64
import json
import math
import struct
import zlib

import case

G = 9.80665
WORLD = """altiplan: 1
environment:
  - box: {min_m: [300, 300, 0], max_m: [310, 700, 90]}
volume: {min_m: [0, 0, 0], max_m: [1000, 1000, 200]}
vehicle: VEHICLE
wind: WIND
start: {at_m: [100, 500, 50]}
via: [{at_m: [500, 150, 160]}]
goal: {at_m: [900, 500, 100]}
"""


def legs(route):
    return [[b[k] - a[k] for k in range(3)] for a, b in zip(route, route[1:]) if a != b]


def trapezoid(length, speed, acceleration):
    if length < speed * speed / acceleration:
        return 2 * math.sqrt(length / acceleration)
    return length / speed + speed / acceleration


def liu(mass, v, up):
    weight = mass * G
    def vertical(w):
        return 0.8554 * weight * (w / 2 + math.sqrt(w * w / 4 + weight / 0.3051**2)) + 0.3177 * weight**1.5
    lift = v * math.cos(math.radians(10))
    level = (2.8037 + 0.3177) * ((weight - 0.0279 * lift**2)**2 + (0.0296 * v * v)**2)**0.75 + 0.0296 * v**3
    return vertical(up) if v == 0 else level + vertical(up) - vertical(0)


def simpson(f, steps=2000):
    return sum((1 if k in (0, steps) else 4 if k % 2 else 2) * f(k / steps) for k in range(steps + 1)) / 3 / steps


class Energy(case.CliCase):
    def ran(self, vehicle, wind="{}", code=0, steps="  - plan: astar\n    with: {cell_m: [50, 50, 50]}\n"):
        self.write("scenario.yaml", WORLD.replace("VEHICLE", vehicle).replace("WIND", wind))
        self.write("pipeline.yaml", "altiplan: 1\nscenario: scenario.yaml\nsteps:\n" + steps)
        return self.result("pipeline.yaml", code=code)

    def metrics(self, *arguments, **keys):
        ran = self.ran(*arguments, **keys)
        self.assertEqual(ran["metrics"]["time_s"], ran["steps"][-1]["metrics"]["time_s"])
        return ran["metrics"], legs(ran["route"])

    def same(self, found, expected):
        self.assertAlmostEqual(found / expected, 1, delta=1e-9)

    def test_stops(self):
        metrics, ways = self.metrics("{speed_mps: 3, acceleration_mps2: 1}")
        self.assertGreater(len(ways), 3)
        self.same(metrics["time_s"], sum(trapezoid(math.hypot(*way), 3, 1) for way in ways))
        self.same(metrics["duration_s"], sum(math.hypot(*way) for way in ways) / 3)
        self.assertIsNone(metrics["energy_wh"])

    def test_climbs_and_corners(self):
        metrics, ways = self.metrics("{speed_mps: 8, climb_mps: 2, sink_mps: 1}")
        def seconds(way):
            return max(math.hypot(*way[:2]) / 8, way[2] / 2, -way[2])
        self.same(metrics["time_s"], sum(map(seconds, ways)))
        self.same(metrics["time_s"], metrics["duration_s"])
        times = [self.metrics("{speed_mps: 8, acceleration_mps2: 2%s}" % more)[0]["time_s"]
                 for more in ("", ", corner_radius_m: 0", ", corner_radius_m: 3", ", corner_radius_m: 20")]
        self.assertEqual(times, sorted(times, reverse=True))
        self.assertGreater(times[0], times[3] + 2)

    def test_energy_by_liu(self):
        model = "energy: {multirotor: {mass_kg: 1.8}}"
        metrics, ways = self.metrics("{speed_mps: 9, %s}" % model)
        wh = 0
        for way in ways:
            length = math.hypot(*way)
            seconds = length / 9
            wh += liu(1.8, math.hypot(*way[:2]) / seconds, way[2] / seconds) * seconds / 3600
        self.same(metrics["energy_wh"], wh)
        metrics, ways = self.metrics("{speed_mps: 9, acceleration_mps2: 2, %s}" % model)
        wh = 0
        for way in ways:
            length = math.hypot(*way)
            flat, up = math.hypot(*way[:2]) / length, way[2] / length
            top = min(9, math.sqrt(2 * length))
            wh += 2 * top / 2 * simpson(lambda t: liu(1.8, top * t * flat, top * t * up)) / 3600
            wh += liu(1.8, top * flat, top * up) * (length - top * top / 2) / top / 3600
        self.assertAlmostEqual(metrics["energy_wh"] / wh, 1, delta=1e-8)

    def test_energy_in_wind(self):
        """A copter keeps its speed over the ground, and pays for that through the air."""
        metrics, ways = self.metrics("{speed_mps: 9, energy: {multirotor: {mass_kg: 1.8}}}",
                                     "{from_deg: 270, speed_mps: 4}")
        wh = duration = 0
        for x, y, z in ways:
            seconds = math.hypot(x, y, z) / 9
            wh += liu(1.8, math.hypot(x / seconds - 4, y / seconds), z / seconds) * seconds / 3600
            duration += seconds
        self.same(metrics["energy_wh"], wh)
        self.same(metrics["duration_s"], duration)

    def test_battery(self):
        vehicle = "{speed_mps: 9, energy: {capacity_wh: %s, reserve: 0.25, usable: 0.8, multirotor: {mass_kg: 1.5}}}"
        needs = self.metrics(vehicle % 1000)[0]["energy_wh"]
        self.ran(vehicle % (needs / 0.6 * 1.001))
        refused = self.ran(vehicle % (needs / 0.6 * 0.999), code=1)
        self.assertEqual(refused["status"], "rejected")
        violation, = refused["steps"][0]["check"]["violations"]
        self.assertEqual((violation["constraint"], violation["unit"]), ("energy", "Wh"))
        self.same(violation["value"], needs)
        self.assertIn("Wh of the battery may be used", refused["message"])
        unknown = vehicle.replace("multirotor: {mass_kg: 1.5}", "measured: {mass_kg: 1, level: [{airspeed_mps: 0, "
                                  "power_w: 9}, {airspeed_mps: 8, power_w: 9}]}") % 1e6
        refused = self.ran(unknown, code=1)
        self.assertIsNone(refused["steps"][0]["metrics"]["energy_wh"])
        self.assertIn("the power of part of the flight is not known", refused["message"])

    def test_reach(self):
        """In an empty world without wind a disc: its radius is what the battery gives over what a metre takes."""
        self.write("scenario.yaml", """altiplan: 1
volume: {min_m: [0, 0, 0], max_m: [4000, 4000, 100]}
vehicle: {speed_mps: 10, energy: {capacity_wh: 12, reserve: 0, power_w: 360}}
start: {at_m: [2000, 2000, 50]}
goal: {at_m: [2700, 2000, 50]}
""")
        self.write("pipeline.yaml", "altiplan: 1\nscenario: scenario.yaml\nsteps:\n  - plan: astar\n")
        self.call("run", "pipeline.yaml", "-o", "result.json")
        self.call("view", "result.json", "--reach", "-o", "page.html")
        page = self.read("page.html")
        scene = json.loads(page[page.index('{"altiplan_scene"'):].split("</script>")[0])
        shown = scene["basemap"]
        self.assertIn("a line every 2 Wh, to 12 Wh", shown["name"])
        last, = scene["numbered"]
        self.assertEqual(last["number"], "point of no return")
        self.assertTrue(2585 < last["at"][0] <= 2600, "6 Wh there, 6 Wh back")
        image = base64.b64decode(shown["image"].split(",")[1])
        width, height = struct.unpack(">II", image[16:24])
        (west, south), (east, north) = shown["box"]
        rows = zlib.decompress(image[image.index(b"IDAT") + 4:])

        def opacity(metres, degrees):
            x = 2000 + metres * math.cos(math.radians(degrees))
            y = 2000 + metres * math.sin(math.radians(degrees))
            row = int((north - y) / (north - south) * height) * (4 * width + 1) + 1
            column = int((x - west) / (east - west) * width)
            return sum(rows[row + 4 * k + 3] for k in range(column + 1)) % 256

        for degrees in range(0, 360, 15):
            self.assertIn(opacity(1090, degrees), (0, 255), degrees)  # up to 8 % longer by steps
            self.assertEqual(opacity(1230, degrees), 130, degrees)
        lines = [metres for metres in range(150, 1250) if opacity(metres, 90) == 255]
        self.assertEqual(sorted({round(metres, -2) for metres in lines}), [200, 400, 600, 800, 1000, 1200])

    def test_cells_of_ways_home_that_do_not_fit_are_refused_before_the_run(self):
        self.write("scenario.yaml", WORLD.replace("VEHICLE", "{radius_m: 1}").replace("WIND", "{}"))
        self.write("pipeline.yaml", "altiplan: 1\nscenario: scenario.yaml\nconstraints:\n"
                   "  - returnable: {cell_m: [0.1, 0.1, 0.1], power_w: 100, maximum_wh: 90}\n"
                   "steps: [{plan: astar}]\n")
        for command in (["validate", "--build"], ["run"]):
            _, err = self.call(*command, "pipeline.yaml", code=3)
            self.assertRegex(err, r"pipeline\.yaml:4:\d+: constraints\.returnable: cell_m: the lattice would have ")

    def test_limits_count_stops(self):
        """As the objectives time and energy, which searches know by their legs alone."""
        vehicle = "{speed_mps: 9, acceleration_mps2: 1, energy: {multirotor: {mass_kg: 1.5}}}"
        ran = self.metrics(vehicle)[0]
        for objective, value in (("time", ran["time_s"]), ("energy", ran["energy_wh"])):
            steps = ("  - plan: astar\n    with: {cell_m: [50, 50, 50]}\nmetrics: [{OBJECTIVE: {}}]\n"
                     "constraints: [{limit: {of: {OBJECTIVE: {}}, maximum: MAXIMUM}}]\n").replace("OBJECTIVE", objective)
            passed = self.ran(vehicle, steps=steps.replace("MAXIMUM", str(value * 1.001)))
            self.same(passed["metrics"][objective], value)
            refused = self.ran(vehicle, steps=steps.replace("MAXIMUM", str(value * 0.999)), code=1)
            self.assertEqual(refused["status"], "rejected", objective)
            self.assertEqual(refused["steps"][0]["check"]["violations"][0]["constraint"], "limit")

    def test_performance(self):
        for name, speed, climb, sink in (("arducopter", 10, 2.5, 1.5), ("px4_mc", 5, 3, 1.5)):
            metrics, ways = self.metrics("{performance: %s}" % name)
            self.same(metrics["duration_s"],
                      sum(max(math.hypot(*way[:2]) / speed, way[2] / climb, -way[2] / sink) for way in ways))
            self.assertGreater(metrics["time_s"], metrics["duration_s"] + 2)
            own = self.metrics("{performance: %s, speed_mps: 4, climb_mps: 0.5}" % name)[0]
            self.assertGreater(own["duration_s"], metrics["duration_s"])
        wing = self.ran("{performance: arduplane}", steps="  - plan: hybrid_astar\n")
        self.assertLess(wing["metrics"]["max_climb_deg"], math.degrees(math.atan(5 / 12)) + 1e-6)
        self.same(wing["metrics"]["time_s"], wing["metrics"]["duration_s"])

    def test_among_moving_obstacles(self):
        self.write("scenario.yaml", WORLD.replace("VEHICLE", "{acceleration_mps2: 1}").replace("WIND", "{}")
                   + "moving: [{sphere: {at_m: [1, 1, 1], radius_m: 1, velocity_mps: [1, 0, 0]}, known: true}]\n")
        _, err = self.call("run", "pipeline.yaml", code=3)
        self.assertIn("remove vehicle.acceleration_mps2", err)
        self.write("scenario.yaml", self.read("scenario.yaml").replace("{acceleration_mps2: 1}", "{}")
                   .replace("wind: {}", "wind: {from_deg: 90, speed_mps: 0.1}"))
        _, err = self.call("run", "pipeline.yaml", code=3)
        self.assertIn("in wind do not: remove wind", err)

    def test_a_flight_has_its_own_time(self):
        ran = self.ran("{speed_mps: 9, acceleration_mps2: 20, energy: {multirotor: {mass_kg: 1.5}}}",
                       steps="  - plan: astar\n    with: {cell_m: [50, 50, 50]}\n  - fly: route\n")
        flown = ran["flight"]["metrics"]
        self.assertEqual(flown["time_s"], flown["duration_s"])
        self.assertLess(flown["time_s"], ran["metrics"]["time_s"])
        self.assertAlmostEqual(flown["energy_wh"] / ran["metrics"]["energy_wh"], 1, delta=0.2)


if __name__ == "__main__":
    case.main()
