# SPDX-License-Identifier: Apache-2.0
"""The mission protocol of the vehicle, by its text and as autopilots do it."""
import math
import unittest

from constants import ALL_PLANS, FENCE, MISSION, RALLY, Command, Frame, MissionResult
from station import HOME, STEP, Station, item, make_node, square, waypoint

FLAVOURS = ("generic", "ardupilot", "px4")
FENCES = [item(Command.NAV_FENCE_POLYGON_VERTEX_INCLUSION, HOME[0] + a, HOME[1] + b,
               params=(4.0, 0.0, 0.0, 0.0)) for a, b in ((1, 1), (1, -1), (-1, -1), (-1, 1))]
RALLIES = [item(Command.NAV_RALLY_POINT, HOME[0], HOME[1] + 1e-3, 30.0)]


def start(arguments="", rules=()):
    return Station(make_node(arguments, rules))


def kept(station, items):
    """What the flavour returns of uploaded items."""
    if station.node.pilot.flavour.name != "ardupilot":
        return items
    home = {**items[0], "frame": 0, "x": round(HOME[0] * 1e7), "y": round(HOME[1] * 1e7),
            "z": HOME[2]}
    return [home] + items[1:]


class Whole(unittest.TestCase):
    def test_three_plans_are_separate(self):
        for flavour in FLAVOURS:
            station = start(f"--autopilot {flavour}")
            for kind, items in ((MISSION, square()), (FENCE, FENCES), (RALLY, RALLIES)):
                self.assertEqual(station.upload(items, kind), MissionResult.ACCEPTED)
            self.assertEqual(station.download(MISSION), kept(station, square()))
            for kind, items in ((FENCE, FENCES), (RALLY, RALLIES)):
                if flavour == "ardupilot":
                    items = [{**each, "autocontinue": 0} for each in items]
                    items = [{**each, "frame": 0} for each in items] if kind == FENCE else items
                self.assertEqual(station.download(kind), items)
            station.ask("MISSION_CLEAR_ALL", ("MISSION_ACK",), mission_type=FENCE)
            counts = [len(station.download(kind)) for kind in (MISSION, FENCE, RALLY)]
            self.assertEqual(counts, [6, 0, 1])
            answer = station.ask("MISSION_CLEAR_ALL", ("MISSION_ACK",), mission_type=ALL_PLANS)
            left = [6, 0, 1] if flavour == "ardupilot" else [0, 0, 0]
            self.assertEqual(answer.type == MissionResult.UNSUPPORTED, flavour == "ardupilot")
            self.assertEqual([len(station.download(kind)) for kind in (0, 1, 2)], left)

    def test_ardupilot_asks_and_answers_as_it_does(self):
        station = start("--autopilot ardupilot")
        mission = square()
        mission[1] = waypoint(47.0, 8.0, 20.127, params=(2.4, 0.0, 0.0, math.nan),
                              frame=Frame.GLOBAL_RELATIVE_ALT_INT)
        station.upload(mission)
        self.assertEqual(len(station.all("MISSION_REQUEST")), 6)
        self.assertEqual(station.all("MISSION_REQUEST_INT"), [])
        stored = station.download()[1]
        self.assertAlmostEqual(stored["z"], 20.12, places=5)
        self.assertEqual((stored["frame"], stored["param1"], stored["param4"]),
                         (Frame.GLOBAL_RELATIVE_ALT, 2.0, 0.0))

    def test_ardupilot_keeps_less_of_fences_and_rally_points(self):
        station = start("--autopilot ardupilot")
        high = [{**corner, "z": 25.5} for corner in FENCES]
        station.upload(high, FENCE)
        self.assertEqual({each["z"] for each in station.download(FENCE)}, {0.0})
        self.assertEqual(station.upload(FENCES[:3], FENCE), MissionResult.ERROR)
        self.assertEqual(len(station.download(FENCE)), 4, "fences are replaced as a whole")
        station.upload([{**RALLIES[0], "z": 30.9}], RALLY)
        self.assertEqual(station.download(RALLY)[0]["z"], 30.0)
        absolute = [{**RALLIES[0], "frame": int(Frame.GLOBAL_INT)}]
        self.assertEqual(station.upload(absolute, RALLY), MissionResult.ACCEPTED)
        self.assertEqual(station.download(RALLY)[0]["frame"], Frame.GLOBAL)
        corners = [{**corner, "param1": 256.0} for corner in FENCES]
        self.assertEqual(station.upload(corners, FENCE), MissionResult.INVALID_PARAM1)

    def test_what_ardupilot_makes_of_parameters(self):
        """Fractions are cut off; a landing comes back with a direction of its yaw."""
        nan = math.nan
        for kind, command, sent, held in (
                ("copter", Command.NAV_WAYPOINT, (2.9, 3, 4, nan), (2, 0, 0, 0)),
                ("plane", Command.NAV_WAYPOINT, (2, 300.5, 4.5, nan), (0, 255, 4, 0)),
                ("plane", Command.NAV_LAND, (0, 0, 0, nan), (0, 0, 0, 1)),
                ("plane", Command.NAV_LOITER_UNLIM, (0, 0, -80.7, nan), (0, 0, -80, 0)),
                ("plane", Command.NAV_LOITER_TURNS, (2, 1, -307.5, 1), (2, 0, -300, 1)),
                ("plane", Command.NAV_LOITER_TIME, (9, 1, 80, 1), (9, 0, 1, 1)),
                ("plane", Command.NAV_LOITER_TO_ALT, (1, -90.9, 0, 1), (0, -90, 0, 1))):
            station = start(f"--autopilot ardupilot --type {kind}")
            mission = square(1) + [item(command, *HOME[:2], 20.0, params=sent)]
            self.assertEqual(station.upload(mission), MissionResult.ACCEPTED)
            stored = station.download()[1]
            self.assertEqual(tuple(stored[f"param{n}"] for n in (1, 2, 3, 4)), held, command)

    def test_what_ardupilot_says_of_items_that_it_has_not(self):
        station = start("--autopilot ardupilot")
        station.send("MISSION_REQUEST_INT", target_system=1, target_component=1, seq=0)
        self.assertEqual(station.wait(("MISSION_ITEM_INT",), 1).x, round(HOME[0] * 1e7))
        self.assertEqual(len(station.download()), 1, "home is there from the beginning")
        self.assertEqual(station.upload([]), MissionResult.ACCEPTED)
        self.assertEqual(station.download(), [])
        station.upload(square(1))
        self.assertEqual(len(station.download()), 2, "where it is not, the vehicle puts it before")
        station.upload(square())
        station.send("MISSION_REQUEST_INT", target_system=1, target_component=1, seq=6)
        station.run(STEP)
        self.assertEqual([m.name for m in station.received[-2:]], ["MISSION_COUNT", "MISSION_ACK"])
        self.assertEqual(station.last("MISSION_ACK").type, MissionResult.INVALID_SEQUENCE)

    def test_empty_plan_clears(self):
        station = start()
        station.upload(square())
        self.assertEqual(station.upload([]), MissionResult.ACCEPTED)
        self.assertEqual(station.download(), [])

    def test_float_items(self):
        """MISSION_ITEM is understood; its degrees are floats."""
        station = start()
        station.send("MISSION_COUNT", target_system=1, target_component=1, count=1)
        station.send("MISSION_ITEM", target_system=1, target_component=1, command=16, frame=3,
                     x=47.5, y=8.25, z=10.0)
        self.assertEqual(station.wait(("MISSION_ACK",), 1).type, MissionResult.ACCEPTED)
        self.assertEqual([station.download()[0][name] for name in "xy"], [475000000, 82500000])

    def test_opaque_ids_change_with_the_plan(self):
        station = start("--autopilot px4")
        station.upload(square())
        station.run(1.1)
        first = station.last("MISSION_ACK").opaque_id
        self.assertEqual(station.last("MISSION_CURRENT").mission_id, first)
        station.upload(square(5))
        self.assertNotEqual(station.last("MISSION_ACK").opaque_id, first)

    def test_partial_upload(self):
        station = start("--autopilot ardupilot")
        station.upload(square())
        mission = square()
        mission[2], mission[3] = mission[3], mission[2]
        station.send("MISSION_WRITE_PARTIAL_LIST", target_system=1, target_component=1,
                     start_index=2, end_index=3)
        for _ in range(2):
            station.run(0.1)
            station.send_item(mission, station.last("MISSION_REQUEST").seq)
        station.run(0.1)
        self.assertEqual(station.last("MISSION_ACK").type, MissionResult.ACCEPTED)
        self.assertEqual(station.download(), kept(station, mission))


class Refusals(unittest.TestCase):
    def refused(self, bad, kind=MISSION, arguments=""):
        station = start(arguments)
        good = {MISSION: square(), FENCE: FENCES, RALLY: RALLIES}[kind]
        self.assertEqual(station.upload(good, kind), MissionResult.ACCEPTED)
        result = station.upload(bad, kind)
        self.assertEqual(station.download(kind), good, "the old plan is whole")
        return result

    def test_items(self):
        nan, inf = math.nan, math.inf
        here = HOME[:2]
        for expected, bad in (
                ("UNSUPPORTED", item(Command.DO_REPOSITION, *here)),
                ("UNSUPPORTED", item(Command.NAV_RALLY_POINT, *here)),
                ("UNSUPPORTED_FRAME", waypoint(*here, 5, frame=Frame.LOCAL_NED)),
                ("INVALID_PARAM1", waypoint(*here, 5, params=(nan, 0, 0, 0))),
                ("INVALID_PARAM2", waypoint(*here, 5, params=(0, inf, 0, 0))),
                ("INVALID_PARAM3", waypoint(*here, 5, params=(0, 0, nan, 0))),
                ("INVALID_PARAM5_X", waypoint(91.0, 8.0, 5)),
                ("INVALID_PARAM6_Y", waypoint(47.0, 181.0, 5)),
                ("INVALID_PARAM7", waypoint(*here, nan)),
                ("INVALID_PARAM1", item(Command.DO_JUMP, params=(9.0, 1.0, 0, 0)))):
            result = self.refused(square(2) + [bad])
            self.assertEqual(result, MissionResult[expected])
        yaw = waypoint(*here, 5, params=(0, 0, 0, nan))
        self.assertEqual(start().upload([yaw]), MissionResult.ACCEPTED)

    def test_polygons(self):
        self.assertEqual(self.refused(FENCES[:3], FENCE), MissionResult.INVALID)
        two = [{**corner, "param1": 2.0} for corner in FENCES[:2]]
        self.assertEqual(self.refused(two, FENCE), MissionResult.INVALID)

    def test_no_space(self):
        result = self.refused(square(11), arguments="--capacity 10")
        self.assertEqual(result, MissionResult.NO_SPACE)

    def test_unknown_kind(self):
        station = start()
        station.send("MISSION_REQUEST_LIST", target_system=1, target_component=1, mission_type=7)
        self.assertEqual(station.wait(("MISSION_ACK",), 1).type, MissionResult.UNSUPPORTED)


class Sequence(unittest.TestCase):
    def begin(self, flavour, count=3):
        station = start(f"--autopilot {flavour}")
        station.send("MISSION_COUNT", target_system=1, target_component=1, count=count)
        station.run(STEP)
        return station

    def requests(self, station):
        return station.all(station.node.pilot.flavour.request)

    def test_requests_are_repeated_and_given_up(self):
        for flavour, every, total in (("generic", 0.25, 1.5), ("ardupilot", 1.0, 8.0),
                                      ("px4", 0.25, 5.0)):
            station = self.begin(flavour)
            station.run(total - 0.1)
            expected = 1 + math.floor((total - 0.05) / every)
            self.assertAlmostEqual(len(self.requests(station)), expected, delta=1)
            self.assertIsNotNone(station.node.missions.upload)
            station.run(0.2)
            self.assertIsNone(station.node.missions.upload)
            self.assertIn("Mission upload timeout", station.texts())

    def test_items_out_of_order(self):
        for flavour, again, naks in (("generic", 2, 0), ("px4", 1, 0), ("ardupilot", 1, 1)):
            station = self.begin(flavour)
            station.send_item(square(), 2)
            station.run(STEP)
            self.assertEqual(len(self.requests(station)), again)
            results = [m.type for m in station.all("MISSION_ACK")]
            self.assertEqual(results, [MissionResult.INVALID_SEQUENCE] * naks)
            for sequence in range(3):
                station.send_item(square(), sequence)
            station.run(STEP)
            self.assertEqual(station.last("MISSION_ACK").type, MissionResult.ACCEPTED)

    def test_last_item_again(self):
        """The client did not get the acknowledgement."""
        for flavour, result in (("generic", "ACCEPTED"), ("px4", "ACCEPTED"),
                                ("ardupilot", "ERROR")):
            station = start(f"--autopilot {flavour}")
            station.upload(square())
            station.send_item(square(), 5)
            self.assertEqual(station.wait(("MISSION_ACK",), 1).type, MissionResult[result])

    def test_cancelling(self):
        for flavour, cancels in (("generic", True), ("ardupilot", False), ("px4", False)):
            station = self.begin(flavour)
            station.send("MISSION_ACK", target_system=1, target_component=1,
                         type=int(MissionResult.OPERATION_CANCELLED))
            self.assertEqual(station.node.missions.upload is None, cancels)

    def test_competing_transfers(self):
        for flavour, result in (("generic", "DENIED"), ("ardupilot", "DENIED"), ("px4", "ERROR")):
            station = self.begin(flavour)
            other = Station(station.node, 254, "other")
            station.others["other"] = other
            for name in ("MISSION_COUNT", "MISSION_REQUEST_LIST"):
                other.send(name, target_system=1, target_component=1)
                station.run(STEP)
                answer = other.last("MISSION_ACK")
                self.assertEqual((answer.type, answer.target_system), (MissionResult[result], 254))
            for sequence in range(3):
                station.send_item(square(), sequence)
            self.assertEqual(len(station.node.missions.plans[MISSION]), 3)

    def test_clearing_during_an_upload(self):
        """ArduPilot begins anew for the partner, and answers another one twice."""
        station = self.begin("ardupilot")
        other = Station(station.node, 254, "other")
        station.others["other"] = other
        other.send("MISSION_CLEAR_ALL", target_system=1, target_component=1)
        station.run(STEP)
        self.assertEqual([m.type for m in other.all("MISSION_ACK")],
                         [MissionResult.DENIED, MissionResult.ERROR])
        station.send("MISSION_CLEAR_ALL", target_system=1, target_component=1)
        station.run(STEP)
        self.assertEqual(station.last("MISSION_ACK").target_system, 255)
        self.assertEqual(station.last("MISSION_ACK").type, MissionResult.ACCEPTED)
        self.assertIsNone(station.node.missions.upload)

    def test_item_beyond_the_end(self):
        station = start()
        station.upload(square())
        station.send("MISSION_REQUEST_INT", target_system=1, target_component=1, seq=6)
        self.assertEqual(station.wait(("MISSION_ACK",), 1).type, MissionResult.INVALID_SEQUENCE)

    def test_other_targets_are_not_answered(self):
        station = start()
        station.send("MISSION_REQUEST_LIST", target_system=9, target_component=1)
        station.send("MISSION_REQUEST_LIST", target_system=1, target_component=50)
        self.assertIsNone(station.wait(("MISSION_COUNT",), 1))
        station.send("MISSION_REQUEST_LIST", target_system=0, target_component=0)
        self.assertIsNotNone(station.wait(("MISSION_COUNT",), 1))


class Storage(unittest.TestCase):
    def interrupted(self, storage):
        """Eight items begin to replace six, and stop after three."""
        station = start(f"--storage {storage}")
        station.upload(square())
        new = [waypoint(46.0, 7.0, 50.0 + i) for i in range(8)]
        station.send("MISSION_COUNT", target_system=1, target_component=1, count=8)
        for sequence in range(3):
            station.send_item(new, sequence)
        station.run(3)
        return station.download(), new

    def test_atomic(self):
        stored, _ = self.interrupted("atomic")
        self.assertEqual(stored, square())

    def test_overwriting(self):
        stored, new = self.interrupted("overwrite")
        self.assertEqual(stored, new[:3] + square()[3:])


if __name__ == "__main__":
    unittest.main()
