# SPDX-License-Identifier: Apache-2.0
"""check_plan_test.py PROGRAM SOURCES: verdicts of `altiplan check PLAN --terrain …`."""
import json
import pathlib
import subprocess
import re
import sys
import unittest

from plan_case import POINTS, PROGRAM, SOURCES, TERRAIN, PlanCase, by_day, item, plan_of

UTM = """PROJCS["WGS 84 / UTM zone 11N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],
PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],
PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",-117],PARAMETER["scale_factor",0.9996],
PARAMETER["false_easting",500000],PARAMETER["false_northing",0],UNIT["metre",1]]"""


class CheckPlan(PlanCase):
    def test_a_plan_high_above_the_ground_passes(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        out, _ = self.check(high, "--min-agl", "100", code=0)
        self.assertRegex(out, r"^pass: mission.plan, 4 waypoints, [0-9.]+ km, at least [0-9.]+ m")

    def test_a_zone_that_closes_nothing_is_named(self):
        """From the ground, at 240 m and higher, up to 100 m above sea level: nothing is closed."""
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        for ceiling, is_named in ((100, True), (1400, False)):
            self.zones("z.json", self.around(*POINTS[2][:2]), ceiling)
            out, _ = self.check(high, "--airspace", "z.json", code=0)
            self.assertEqual("nothing is closed, as the ceiling is below the floor, or the ground, there: 'Z" in out, is_named, out)

    def test_what_cures_a_plan_makes_it_pass(self):
        low = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        low[2][2] = 500
        for bounds in (["--min-agl", "150"], ["--min-agl", "150", "--max-agl", "1300"]):
            points = [list(point) for point in low]
            out, _ = self.check(points, *bounds, code=1)
            self.assertIn("fail: mission.plan", out)
            self.assertIn("item 3 (waypoint)", out)
            cures = re.findall(r"cure: (raise|lower) item (\d) \(waypoint\) by ([0-9.]+) m", out)
            self.assertTrue(cures, out)
            word, number, by = cures[0]
            self.assertEqual((word, number), ("raise", "3"))
            points[2][2] += float(by) - 0.2
            self.check(points, *bounds, code=1)  # it is the least
            points[2][2] += 0.2
            self.check(points, *bounds, code=0)

    def test_lines_without_heights_are_put_above_the_ground(self):
        near = [(-84.38, 36.48), (-84.379, 36.482), (-84.377, 36.485)]
        line = {"type": "LineString", "coordinates": [list(point) for point in near]}
        kml = "<kml><Placemark><LineString>{}<coordinates>{}</coordinates></LineString></Placemark></kml>"
        without = {
            "clamped.kml": kml.format("<altitudeMode>clampToGround</altitudeMode>",
                                      " ".join(f"{lon},{lat},0" for lon, lat in near)),
            "flat.kml": kml.format("", " ".join(f"{lon},{lat}" for lon, lat in near)),
            "flat.gpx": "<gpx><rte>" + "".join(f'<rtept lat="{lat}" lon="{lon}"/>' for lon, lat in near) + "</rte></gpx>",
            "flat.geojson": json.dumps({"type": "FeatureCollection", "features": [
                {"type": "Feature", "properties": {}, "geometry": line}]})}
        above = {}
        for name, text in without.items():
            (self.folder / name).write_text(text)
            _, err = self.call(name, "--terrain", TERRAIN, code=3)
            self.assertRegex(err, rf"{name}: a route needs heights.*\(--agl METRES puts it above the ground\)")
            out, _ = self.call(name, "--terrain", TERRAIN, "--agl", "80", "--json", code=0)
            above[name] = json.loads(out)
            out, _ = self.call(name, "--terrain", TERRAIN, "--agl", "80", "--min-agl", "81", code=1)
            self.assertIn("the height above ground is", out)
        written = kml.format("<altitudeMode>relativeToGround</altitudeMode>",
                             " ".join(f"{lon},{lat},80" for lon, lat in near))
        (self.folder / "written.kml").write_text(written)
        out, _ = self.call("written.kml", "--terrain", TERRAIN, "--json", code=0)
        for name, verdict in above.items():
            for key in ("length_m", "time_s", "min_height_above_ground_m"):
                self.assertEqual(verdict.get(key), json.loads(out).get(key), (name, key))
        _, err = self.call("written.kml", "--terrain", TERRAIN, "--agl", "80", code=3)
        self.assertIn("--agl is for a line without heights: this one has its own", err)
        for autopilot in ("px4", "ardupilot"):  # PX4 takes no heights above the ground
            done = subprocess.run([PROGRAM, "export", "clamped.kml", "--terrain", TERRAIN, "--agl", "80", "--takeoff",
                                   "--autopilot", autopilot, "--vehicle", "copter", "-o", autopilot + ".plan"],
                                  cwd=self.folder, capture_output=True, text=True, timeout=600)
            self.assertEqual(done.returncode, 0, done.stderr)
            self.call(autopilot + ".plan", "--terrain", TERRAIN, code=0)
        mixed = json.loads(without["flat.geojson"])
        mixed["features"][0]["geometry"]["coordinates"][1].append(600)
        (self.folder / "mixed.geojson").write_text(json.dumps(mixed))
        _, err = self.call("mixed.geojson", "--terrain", TERRAIN, "--agl", "80", code=3)
        self.assertIn("coordinates.1 has one, others none", err)
        two = json.loads(without["flat.geojson"])
        two["features"].append(two["features"][0])
        (self.folder / "two.geojson").write_text(json.dumps(two))
        _, err = self.call("two.geojson", "--terrain", TERRAIN, "--agl", "80", code=3)
        self.assertIn("expected one LineString as the route, found more", err)

    def test_polygons_beside_a_line(self):
        """Nothing says whether they are closed, but for those that we wrote."""
        ring = self.around(-84.36, 36.497, 0.004)
        line = [[-84.38, 36.48, 1500], [-84.34, 36.514, 1500]]
        feature = lambda kind, coordinates, **more: {"type": "Feature", "properties": more,
                                                     "geometry": {"type": kind, "coordinates": coordinates}}
        kml = ("<kml><Document><Placemark><LineString><altitudeMode>absolute</altitudeMode><coordinates>{}</coordinates>"
               "</LineString></Placemark><Placemark><name>Field</name>{}<Polygon><outerBoundaryIs><LinearRing><coordinates>"
               "{}</coordinates></LinearRing></outerBoundaryIs></Polygon></Placemark></Document></kml>")
        text = lambda points: " ".join(",".join(map(str, point)) for point in points)
        for role in (None, "keep_out"):
            more = {"role": role} if role else {}
            data = f'<ExtendedData><Data name="role"><value>{role}</value></Data></ExtendedData>' if role else ""
            files = {"own.kml": kml.format(text(line), data, text(ring)),
                     "own.geojson": json.dumps({"type": "FeatureCollection", "features": [
                         feature("LineString", line), feature("Polygon", [ring], name="Field", **more)]})}
            for name, content in files.items():
                (self.folder / name).write_text(content)
                out, _ = self.call(name, "--terrain", TERRAIN, code=1)
                self.assertTrue(out.startswith("fail" if role else "not judged"), out)
                self.assertIn("'Field'", out)
                self.assertEqual("own polygons are closed is not said" in out, role is None)
                out, _ = self.call(name, "--terrain", TERRAIN, "--airspace", name, code=1)
                self.assertTrue(out.startswith("fail"), out)

    def test_parameters_of_another_vehicle(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        for text, of in (("RTL_CLIMB_MIN,0\nTECS_CLMB_MAX,5\nNAVL1_PERIOD,17\n", "ArduPilot plane"),
                         ("WP_JERK,1\nWP_RADIUS,2\nATC_STR_RAT_P,0.2\n", "an ArduPilot rover"),
                         ("CRUISE_SPEED,5\nTURN_RADIUS,1\nFRAME_CLASS,1\n", "an ArduPilot rover"),
                         ("WPNAV_SPEED,500\nJS_GAIN_DEFAULT,0.5\n", "an ArduPilot submarine")):
            (self.folder / "other.param").write_text(text)
            out, _ = self.check(high, "--params", "other.param", code=1)
            self.assertTrue(out.startswith("not judged"), out)
            self.assertIn(f"the parameters are those of {of}, not of ArduPilot copter", out)

    def test_zones_count_at_their_hours(self):
        ring = [[-84.31, 36.52], [-84.25, 36.52], [-84.25, 36.56], [-84.31, 36.56], [-84.31, 36.52]]
        zone = {"title": "test", "features": [{
            "identifier": "Z1", "country": "USA", "name": "Z1", "type": "COMMON",
            "restriction": "PROHIBITED", "reason": ["OTHER"], "zoneAuthority": [],
            "applicability": [{"startDateTime": "2022-01-01T00:00:00Z",
                               "endDateTime": "2030-01-01T00:00:00Z", "permanent": "NO",
                               "schedule": [{"day": ["SAT"], "startTime": "17:00:00Z",
                                             "endTime": "23:00:00Z"}]}],
            "geometry": [{"uomDimensions": "M", "lowerLimit": 0, "lowerVerticalReference": "AGL",
                          "upperLimit": 3000, "upperVerticalReference": "AMSL",
                          "horizontalProjection": {"type": "Polygon", "coordinates": [ring]}}]}]}
        (self.folder / "zones.json").write_text(json.dumps(zone))
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        zones = ("--airspace", "zones.json", "--start-time")
        out, _ = self.check(high, *zones, "2022-06-18T18:00:00Z", code=1)  # a Saturday
        self.assertIn("'zones.json'", out)
        self.check(high, *zones, "2022-06-18T12:00:00Z", code=0)

    def test_climb_and_descent_are_judged_among_zones(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        takeoff = dict(item([0, 0, 1500], 1), command=22)
        landing = dict(item([0, 0, 0], 9), command=21)
        points = [item(point, n + 2) for n, point in enumerate(high)]
        for at, extra, word in ((POINTS[0], [takeoff, *points], "climb after take-off"),
                                (POINTS[3], [*points, landing], "landing")):
            self.zones("z.json", self.around(*at[:2]), 60, "AGL")
            self.write(points)
            options = ("mission.plan", "--terrain", TERRAIN, "--min-agl", "100")
            self.call(*options, "--airspace", "z.json", code=0)  # above it
            self.write(extra)
            self.call(*options, code=0)
            out, _ = self.call(*options, "--airspace", "z.json", code=1)
            self.assertIn(f": the {word}: ", out)
            self.assertIn("'Z' of 'z.json'", out)

    def test_circles_and_the_way_from_home_are_judged(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        options = ("mission.plan", "--terrain", TERRAIN, "--airspace", "z.json")
        # East of the last item, where its circle goes and no leg does.
        self.zones("z.json", self.around(-84.1944, 36.66, 0.001), 3000)
        for command, params in by_day([(18, [3, 0, -500, 0]), (17, [0, 0, 500, 0]), (31, [1, 500, 0, 1])], 3):
            loiter = item(high[3], 4)
            self.write([*(item(point, n + 1) for n, point in enumerate(high[:3])), loiter], vehicleType=1)
            # ArduPilot's aeroplane goes home at the end.
            out, _ = self.call(*options, code=1)
            self.assertNotIn("item 4 (waypoint) to", out)
            loiter["command"] = command
            loiter["params"][:4] = params
            self.write([*(item(point, n + 1) for n, point in enumerate(high[:3])), loiter], vehicleType=1)
            out, _ = self.call(*options, code=1)
            self.assertIn("item 4 (loiter): its circle: ", out)
        takeoff = dict(item([-84.38, 36.50, 1500], 1), command=22)
        self.write([takeoff, *(item(point, n + 2) for n, point in enumerate(high[1:]))], firmwareType=12)
        self.zones("z.json", self.around(-84.38, 36.49, 0.003), 3000)  # between home and item 1
        out, _ = self.call(*options, code=1)
        self.assertIn("item 1 (take-off): the way from home: ", out)

    def test_items_beside_a_circle_keep_their_names(self):
        points = [item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)]
        points[1].update(command=18, params=[1000, 0, 200, 1, *points[1]["params"][4:]])  # tangentially left
        points[2]["params"][6] = 300
        self.write(points)
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, code=1)
        self.assertIn("item 2 (loiter) to item 3 (waypoint): ", out)
        self.assertNotIn("a figure of the turn", out)
        self.assertNotIn("waypoint 1", out)

    def test_an_aeroplane_does_not_land_through_a_ridge(self):
        landing = dict(item([-84.22, 36.48, 0], 2), command=21)
        self.write([item([-84.38, 36.48, 900], 1), item([-84.37, 36.48, 900], 2), landing],
                   vehicleType=1)
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, code=1)
        self.assertIn("item 2 (landing): the landing: goes through the ground", out)

    def test_a_landing_elsewhere_is_flown_to_first(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        landing = dict(item([-84.19, 36.67, 0], 9), command=21)
        self.write([*(item(point, n + 1) for n, point in enumerate(high)), landing])
        options = ("mission.plan", "--terrain", TERRAIN, "--min-agl", "100", "--airspace", "z.json")
        self.zones("z.json", self.around(-84.195, 36.665, 0.001), 1450)  # below that leg
        out, _ = self.call(*options, code=0)
        self.assertIn("4 waypoints", out)
        # An aeroplane goes down along it.
        self.write([*(item(point, n + 1) for n, point in enumerate(high)), landing], vehicleType=1)
        out, _ = self.call(*options, code=1)
        self.assertIn("item 9 (landing): the landing: ", out)

    def test_the_first_of_two_landings_ends_the_flight(self):
        points = [[-84.38, 36.48, 1500], [-84.20, 36.66, 1500], [-84.20, 36.66, 620], [-84.20, 36.66, 600]]
        items = [item(p, n + 1) for n, p in enumerate(points)]
        items[2]["command"] = items[3]["command"] = 21
        self.write(items)
        options = ("mission.plan", "--terrain", TERRAIN)
        self.call(*options, code=0)
        self.zones("z.json", self.around(-84.20, 36.66), 1450)
        zone = (self.folder / "z.json").read_text()
        between = zone.replace('"lowerLimit": 0, "lowerVerticalReference": "AGL"',
                               '"lowerLimit": 1000, "lowerVerticalReference": "AMSL"')
        self.assertNotEqual(between, zone)
        (self.folder / "z.json").write_text(between)
        out, _ = self.call(*options, "--airspace", "z.json", code=1)
        self.assertIn("item 3 (landing): the landing: ", out)
        self.assertIn("item 4 (landing): is not flown", out)

    def test_one_position_is_judged(self):
        self.check([[-84.20, 36.66, 1500]], "--min-agl", "100", code=0)
        out, _ = self.check([[-84.20, 36.66, 200]], code=1)
        self.assertIn("its place: ", out)

    def test_a_return_is_flown_home(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        points = [item(point, n + 1) for n, point in enumerate(high)]
        back = dict(item([0, 0, 0], 9), command=20, frame=2)
        self.write([*points, back])
        options = ("mission.plan", "--terrain", TERRAIN, "--airspace", "z.json")
        self.zones("z.json", self.around(-84.29, 36.57), 3000)  # on the straight way
        self.write(points)
        self.call(*options, code=0)
        self.write([*points, back])
        out, _ = self.call(*options, code=1)
        self.assertIn("item 9 (return to launch): the way home: ", out)
        self.assertNotIn("skipped", out)

    def test_what_is_not_judged_does_not_pass(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        points = [item(point, n + 1) for n, point in enumerate(high)]
        scan = {"type": "ComplexItem", "complexItemType": "StructureScan"}
        spline = dict(item(high[3], 5), command=82)
        survey = {"type": "ComplexItem", "complexItemType": "survey",
                  "TransectStyleComplexItem": {"Items": []}}
        for extra, words in ((scan, "mission.items.4 (complex item): where this flies is not judged"),
                             (spline, "item 5 (spline): the curve of a spline is not judged"),
                             (survey, "mission.items.4 (complex item): where this flies is not judged")):
            self.write([*points, extra])
            out, _ = self.call("mission.plan", "--terrain", TERRAIN, code=1)
            self.assertTrue(out.startswith("not judged: mission.plan"), out)
            self.assertIn(words, out)
        camera = dict(item([0, 0, 0], 5), command=203, frame=2)
        self.write([*points, camera])
        self.call("mission.plan", "--terrain", TERRAIN, code=0)

    def test_home_is_where_the_ground_is(self):
        relative = [dict(item([lon, lat, 900], n + 1), frame=3)
                    for n, (lon, lat, _) in enumerate(POINTS)]
        for height, code in ((636, 0), (400, 1), (660, 1)):
            self.write(relative, plannedHomePosition=[36.48, -84.38, height])
            out, _ = self.call("mission.plan", "--terrain", TERRAIN, code=code)
            self.assertEqual(code == 1, "home: home is at" in out, out)

    def test_a_fence_in_the_plan_is_kept(self):
        self.write([item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)])
        plan = json.loads((self.folder / "mission.plan").read_text())
        circle = {"center": [36.54, -84.30], "radius": 500}
        plan["geoFence"]["circles"] = [{"version": 1, "inclusion": False, "circle": circle}]
        (self.folder / "mission.plan").write_text(json.dumps(plan))
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, code=1)
        self.assertIn("'fence of the mission'", out)

    def test_voids_are_closed(self):
        """A grid in degrees whose middle is unknown, as GIS programs write it."""
        rows = [["100"] * 40 for _ in range(40)]
        for j in range(18, 23):
            rows[j][18:23] = ["-9999"] * 5
        (self.folder / "dem.asc").write_text(
            "ncols 40\nnrows 40\nxllcorner 8\nyllcorner 47\ncellsize 0.001\n"
            "NODATA_value -9999\n" + "\n".join(" ".join(row) for row in rows) + "\n")
        (self.folder / "dem.prj").write_text(
            'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
            'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
        options = ("mission.plan", "--terrain", "dem.asc")
        self.write([item([8.002, 47.005, 300], 1), item([8.037, 47.005, 300], 2)])
        self.call(*options, code=0)
        self.write([item([8.002, 47.02, 300], 1), item([8.037, 47.02, 300], 2)])
        out, _ = self.call(*options, code=1)
        self.assertIn("fail: mission.plan, 2 waypoints, 2.6", out)
        self.assertIn("over unknown ground", out)
        self.assertIn("item 1 (waypoint) to item 2 (waypoint): passes over a void of the elevation model", out)
        self.assertNotIn("m above ground", out)
        self.call(*options, "--fill-voids", code=0)

    def test_zones_of_permission(self):
        self.zones("z.json", self.around(*POINTS[2][:2]), 3000)
        text = (self.folder / "z.json").read_text().replace("PROHIBITED", "REQ_AUTHORISATION")
        (self.folder / "z.json").write_text(text)
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        self.check(high, "--airspace", "z.json", code=1)
        self.check(high, "--airspace", "z.json", "--permission", code=0)

    def test_airspace_of_elsewhere_is_said(self):
        self.zones("z.json", self.around(8, 47), 3000)
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        out, _ = self.check(high, "--airspace", "z.json", code=0)
        self.assertIn("z.json: nothing is closed within 50 km of the route", out)

    def test_hours_are_those_of_the_flight(self):
        high = [[lon, lat, 1500] for lon, lat, _ in POINTS]
        points = [item(point, n + 1) for n, point in enumerate(high)]
        self.zones("z.json", self.around(*POINTS[2][:2]), 3000,
                   schedule={"startTime": "12:40:00Z", "endTime": "13:00:00Z"})
        options = ("mission.plan", "--terrain", TERRAIN, "--airspace", "z.json", "--start-time",
                   "2026-06-18T12:00:00Z")
        self.write(points)  # 27 km at 10 m/s
        self.call(*options, code=1)
        (self.folder / "fast.param").write_text("WPNAV_SPEED,6000\n")
        self.call(*options, "--params", "fast.param", code=0)
        faster = dict(item([0, 0, 0], 1), command=178, frame=2, params=[0, 60, -1, 0, 0, 0, 0])
        self.write([faster, *points])
        self.call(*options, code=0)
        waiting = dict(item([0, 0, 0], 1), command=93, frame=2, params=[2400, -1, -1, -1, 0, 0, 0])
        self.write([faster, points[0], waiting, *points[1:]])
        self.call(*options, code=1)

    def test_one_file_of_airspace_each_time(self):
        self.zones("z.json", self.around(8, 47), 3000)
        self.write([item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)])
        self.call("--terrain", TERRAIN, "--airspace", "z.json", "mission.plan", code=0)

    def test_who_flies_it_is_part_of_the_question(self):
        points = [[-84.38, 36.48, 1500], [-84.36, 36.48, 1500], [-84.36, 36.46, 1500]]
        self.zones("z.json", self.around(-84.36022, 36.47982, 0.00008), 3000)  # within the corner
        options = ("mission.plan", "--terrain", TERRAIN, "--airspace", "z.json")
        items = [item(point, n + 1) for n, point in enumerate(points)]
        self.write(items)
        self.call(*options, code=0)
        self.call(*options, "--vehicle", "plane", code=1)
        self.write(items, firmwareType=0, vehicleType=0)
        out, _ = self.call(*options, code=1)
        self.assertIn("ArduPilot plane: ", out)
        self.assertIn("note: judged as each of these may fly it: ArduPilot copter, ", out)
        self.call(*options, "--autopilot", "ardupilot", "--vehicle", "copter", code=0)
        _, err = self.call(*options, "--autopilot", "betaflight", code=2)
        self.assertIn("--autopilot", err)

    def test_parameters_are_read(self):
        self.write([item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)])
        options = ("mission.plan", "--terrain", TERRAIN, "--json", "--params", "p")
        for text, code in (("# of a vehicle\nWP_SPD 20\n", 0), ("WPNAV_SPEED,2000\n", 0),
                           ("1\t1\tWPNAV_SPEED\t2000\t9\n", 0), ("WP_SPD\n", 3), ("WP_SPD fast\n", 3),
                           ("", 3)):
            (self.folder / "p").write_text(text)
            out, err = self.call(*options, code=code)
            if code == 0:
                self.assertEqual(json.loads(out)["parameters"]["WP_SPD"], 20, text)
            else:
                self.assertRegex(err, r"p:1: (WP_SPD: )?expected a" if text else "p: contains no parameters")

    def test_parameters_of_another_autopilot_are_not_taken(self):
        items = [item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)]
        options = ("mission.plan", "--terrain", TERRAIN, "--params", "p")
        for text, other in (("1 1 MPC_XY_CRUISE 8 9\n", "PX4"), ("AIRSPEED_CRUISE = 22 # m/s\n", "ArduPilot plane")):
            (self.folder / "p").write_text(text)
            self.write(items)
            out, _ = self.call(*options, code=1)
            self.assertIn(f"the parameters are those of {other}, not of ArduPilot copter", out)
            self.write(items, firmwareType=0, vehicleType=0)
            out, _ = self.call(*options, code=1)
            self.assertNotIn("ArduPilot copter", out)  # it cannot be one
        (self.folder / "p").write_text("FRAME_CLASS 1 # of a quadrotor, say\nFENCE_MARGIN=3\n")
        self.write(items)
        self.call(*options, code=0)

    def test_models_may_be_several(self):
        self.write([item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)])
        (self.folder / "tiles").mkdir()
        (self.folder / "tiles" / "a.tif").write_bytes(pathlib.Path(TERRAIN).read_bytes())
        one, _ = self.call("mission.plan", "--terrain", TERRAIN, "--min-agl", "10", code=0)
        two, _ = self.call("mission.plan", "--terrain", "tiles", "--terrain", TERRAIN, "--min-agl", "10", code=0)
        self.assertEqual(one.splitlines()[0], two.splitlines()[0])

    def write_tiles(self):
        """Of a degree, where lengths are wrong in longitude and latitude."""
        (self.folder / "tiles").mkdir()
        for lat, lon in ((lat, lon) for lat in (40, 41, 42) for lon in (10, 11)):
            summit = lambda i, j: 600 + 13 * ((i * 7 + j * 5 + lat) % 11)  # of the post, from the north-west
            rows = "\n".join(" ".join(str(summit(i, j)) for i in range(61)) for j in range(61))
            (self.folder / f"tiles/{lat}_{lon}.asc").write_text(
                f"ncols 61\nnrows 61\nxllcenter {lon}\nyllcenter {lat}\ncellsize {1 / 60:.12f}\n{rows}\n")

    def over_tiles(self, way, height, code):
        self.write([item([*at, height], n + 1) for n, at in enumerate(way)],
                   plannedHomePosition=[way[0][1], way[0][0], 700])
        out, _ = self.call("mission.plan", "--terrain", "tiles", "--crs", "EPSG:4326", "--min-agl", "50", code=code)
        return out

    def test_tiles_leave_no_gaps_on_long_missions(self):
        """Along a seam, and across."""
        self.write_tiles()
        ways = {"diagonal": [[10.2, 40.2], [10.9, 41.2], [11.7, 42.5]], "seam": [[11, 40.3], [11, 42.5]]}
        for name, way in ways.items():
            for height, code in ((1000, 0), (740, 1)):
                with self.subTest(name, height=height):
                    out = self.over_tiles(way, height, code)
                    self.assertNotIn("no ground of known height", out)
                    self.assertEqual("the height above ground is" in out, code == 1, out)

    def test_a_missing_tile_is_closed_and_the_others_are_one_model(self):
        around = [[10.2, 40.2], [10.5, 41.2], [10.9, 42.2], [11.7, 42.5]]
        self.write_tiles()
        whole = self.over_tiles(around, 1000, 0).splitlines()[0]
        (self.folder / "tiles/41_11.asc").unlink()
        self.assertEqual(self.over_tiles(around, 1000, 0).splitlines()[0], whole)
        self.assertIn("the height above ground is", self.over_tiles(around, 740, 1))
        self.assertIn("void of the elevation model", self.over_tiles([[10.5, 41.2], [11.5, 42.5]], 1000, 1))
        self.assertIn("void of the elevation model", self.over_tiles([[11.5, 40.5], [11.5, 42.5]], 9000, 1))

    def test_the_model_below_the_mission_gives_the_frame(self):
        """Models of other regions that are named first change no figure, and hide no zone."""
        self.write([item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)])
        self.zones("zone.json", self.around(*POINTS[-1][:2]), 3000)
        for n, (lon, lat) in enumerate(((8, 47), (-70, 60), (-84.4, 57))):
            (self.folder / f"far{n}.asc").write_text(
                f"ncols 4\nnrows 4\nxllcorner {lon}\nyllcorner {lat}\ncellsize 0.001\n" + "500 500 500 500\n" * 4)
            (self.folder / f"far{n}.prj").write_text(
                'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563]],'
                'PRIMEM["Greenwich",0],UNIT["degree",0.0174532925199433]]')
            both = ("--terrain", f"far{n}.asc", "--terrain", TERRAIN)
            for more, code in (((), 0), (("--airspace", "zone.json"), 1)):
                one, _ = self.call("mission.plan", "--terrain", TERRAIN, *more, "--json", code=code)
                two, _ = self.call("mission.plan", *both, *more, "--json", code=code)
                one, two = json.loads(one), json.loads(two)
                for key in ("verdict", "violations", "time_s", "parts"):
                    self.assertEqual(one[key], two[key])
        # A scenario says itself which layer gives the frame.
        def scenario(start, goal):
            (self.folder / "far.yaml").write_text(
                f"altiplan: 1\nenvironment:\n  - terrain: {{file: far0.asc}}\n  - terrain: {{file: {TERRAIN}}}\n    id: model\n"
                "  - zones: {file: zone.json}\nvolume: {min_m: [-1e8, -1e8, -1e4], max_m: [1e8, 1e8, 1e5]}\n"
                f"start: {{at_lonlat: {start}}}\ngoal: {{at_lonlat: {goal}}}\n")

        scenario([8.001, 47.001, 600], [8.002, 47.002, 600])
        out, _ = self.call("mission.plan", "--scenario", "far.yaml", code=1)
        self.assertRegex(out, r"\n  the mission: lengths are off by up to [0-9.]+ % where the mission flies")
        scenario(POINTS[0], POINTS[-1])
        (self.folder / "p.yaml").write_text("altiplan: 1\nscenario: far.yaml\nsteps:\n  - plan: astar\n")
        done = subprocess.run([PROGRAM, "run", "p.yaml"], cwd=self.folder, capture_output=True, text=True)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("start: lies more than 20 degrees from the origin of the world's frame", done.stderr)

    def test_a_model_without_a_coordinate_system(self):
        self.write([item(point, n + 1) for n, point in enumerate(POINTS)])
        (self.folder / "bare.asc").write_text(
            "ncols 4\nnrows 4\nxllcorner -85\nyllcorner 36\ncellsize 0.5\n" + "500 500 500 500\n" * 4)
        _, err = self.call("mission.plan", "--terrain", "bare.asc", code=3)
        self.assertIn("--terrain: bare.asc: the file names no coordinate system: give --crs EPSG:CODE", err)
        self.call("mission.plan", "--terrain", "bare.asc", "--crs", "EPSG:4326", code=0)

    def test_no_cure_that_an_autopilot_refuses(self):
        """Below home a PX4 takes off to nothing: such a mission would fly through no zone."""
        lon, lat, _ = POINTS[0]
        take_off = dict(item([lon, lat, 50], 1), command=22, frame=3)
        self.zones("low.json", self.around(lon, lat), 1500)
        self.write([take_off, dict(item([lon + 0.01, lat, 60], 2), frame=3)], firmwareType=12,
                   plannedHomePosition=[lat, lon, 400])
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, "--airspace", "low.json", code=1)
        self.assertNotIn("cure: lower item 1", out)
        take_off["params"][6] = -5
        self.write([take_off, dict(item([lon + 0.01, lat, 60], 2), frame=3)], firmwareType=12,
                   plannedHomePosition=[lat, lon, 400])
        out, _ = self.call("mission.plan", "--terrain", TERRAIN, code=1)
        self.assertIn("takes off to a height above home alone, and this is 5.0 m below it", out)

    def test_parameters_that_decide_nothing(self):
        self.write([item([lon, lat, 1500], n + 1) for n, (lon, lat, _) in enumerate(POINTS)])
        (self.folder / "p.param").write_text("WPNAV_SPED,500\n")
        _, err = self.call("mission.plan", "--terrain", TERRAIN, "--params", "p.param", code=0)
        self.assertIn("p.param: none of its parameters decides how a mission is flown", err)
        (self.folder / "p.param").write_text("RTL_ALT,abc\n")
        _, err = self.call("mission.plan", "--terrain", TERRAIN, "--params", "p.param", code=3)
        self.assertIn("p.param:1: RTL_ALT: expected a number, found 'abc'", err)

    def test_a_plan_in_a_scenario(self):
        scenario = str(pathlib.Path(SOURCES) / "configs/scenarios/jacksboro_ridge.yaml")
        self.write([item(point, n + 1) for n, point in enumerate(POINTS)])
        out, _ = self.call("mission.plan", "--scenario", scenario, code=1)
        self.assertRegex(out, r"item 1 \(waypoint\) to .*: the route begins [0-9.]+ m from the")

    def test_a_model_in_a_map_projection(self):
        (self.folder / "utm.asc").write_text(
            "ncols 4\nnrows 4\nxllcorner 400000\nyllcorner 3800000\ncellsize 1000\n" + "500 500 500 500\n" * 4)
        (self.folder / "utm.prj").write_text(UTM)
        points = [[-118.07, 34.35, 650], [-118.06, 34.36, 650]]
        (self.folder / "mission.plan").write_text(json.dumps(plan_of(points)))
        options = ("mission.plan", "--terrain", "utm.asc", "--min-agl")
        out, _ = self.call(*options, "150", code=0)
        self.assertIn("at least 150.0 m", out)
        self.call(*options, "150.1", code=1)
        (self.folder / "utm.prj").unlink()
        _, err = self.call(*options, "150", code=3)
        self.assertIn("names no coordinate system", err)
        self.call(*options, "150", "--crs", "EPSG:32611", code=0)

if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1] + sys.argv[3:])
