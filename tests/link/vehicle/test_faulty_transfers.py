# SPDX-License-Identifier: Apache-2.0
"""The mission protocol of the vehicle under faults, signed, and repeated."""
import unittest

import codec
import faults
import plans
from constants import MISSION, Command, Frame, MissionResult
from station import Station, item, make_node, square, waypoint
from test_transfers import FLAVOURS, kept, start


class Faulty(unittest.TestCase):
    def test_transfers_survive_lossy_links(self):
        rules = [{"fault": "lose", "probability": 0.2}, {"fault": "double", "probability": 0.2},
                 {"fault": "reorder", "probability": 0.1}, {"fault": "damage", "probability": 0.1},
                 {"fault": "delay", "probability": 0.1, "seconds": [0.01, 0.3]}]
        for flavour in FLAVOURS:
            for seed in range(5):
                station = start(f"--autopilot {flavour} --seed {seed}", rules)
                mission = square(20)
                for _ in range(20):
                    result = station.upload(mission)
                    if result == MissionResult.ACCEPTED:
                        break
                self.assertEqual(result, MissionResult.ACCEPTED, (flavour, seed))
                self.assertEqual(station.download(), kept(station, mission), (flavour, seed))

    def test_800_items(self):
        """The text's five retries are too few for so many items; a patient vehicle gets them."""
        rules = [{"fault": "lose", "probability": 0.2}]
        station = start("--give-up 10", rules)
        mission = square(800)
        self.assertEqual(station.upload(mission, seconds=600.0), MissionResult.ACCEPTED)
        stored = [plans.fields_of(each) for each in station.node.missions.plans[MISSION]]
        self.assertEqual(stored, mission)

    def test_every_nak(self):
        for result in MissionResult:
            if result in (MissionResult.ACCEPTED, MissionResult.INVALID_SEQUENCE):
                continue
            station = start("", [{"fault": "nak", "message": "MISSION_ITEM_INT", "seq": 3,
                                  "result": result.name, "count": 1, "skip": 1}])
            self.assertEqual(station.upload(square()), MissionResult.ACCEPTED)
            self.assertEqual(station.upload(square(5)), result)
            self.assertEqual(station.download(), square())
            self.assertEqual(station.upload(square(5)), MissionResult.ACCEPTED)

    def test_silence(self):
        station = start("", [{"fault": "silence", "from": 1.0, "seconds": 3.0}])
        station.run(1.0)
        count = len(station.received)
        station.run(2.9)
        self.assertEqual(len(station.received), count)
        station.run(1.0)
        self.assertGreater(len(station.received), count)

    def test_silence_for_ever_begins_with_an_item(self):
        station = start("", [{"fault": "silence", "message": "MISSION_ITEM_INT", "skip": 2}])
        self.assertIsNone(station.upload(square(), seconds=20))
        self.assertEqual(len(station.all("MISSION_REQUEST_INT")), 3)

    def test_changed_items(self):
        change = {"fault": "change", "round_altitude": 1.0, "shift_lat": 1e-6}
        station = start("", [change])
        station.upload(square())
        stored = station.download()
        self.assertEqual([each["z"] for each in stored], [20, 22, 23, 24, 26, 28])
        self.assertEqual(stored[0]["x"] - square()[0]["x"], 10)

    def test_dropped_and_refused_items(self):
        speed = item(Command.DO_CHANGE_SPEED, params=(1.0, 5.0, 0, 0))
        drop = {"fault": "change", "drop_command": int(Command.DO_CHANGE_SPEED)}
        station = start("", [drop])
        station.upload(square(3) + [speed] + square(2))
        self.assertEqual(station.download(), square(3) + square(2))
        refuse = {"fault": "change", "refuse_frame": int(Frame.GLOBAL_TERRAIN_ALT)}
        station = start("", [refuse])
        terrain = [waypoint(47.0, 8.0, 5.0, frame=Frame.GLOBAL_TERRAIN_ALT)]
        self.assertEqual(station.upload(terrain), MissionResult.UNSUPPORTED_FRAME)
        self.assertEqual(station.upload(square()), MissionResult.ACCEPTED)

    def test_reboot_in_the_middle(self):
        for loses in (False, True):
            station = start("", [{"fault": "reboot", "message": "MISSION_ITEM_INT", "skip": 9,
                                  "count": 1, "seconds": 2.0, "loses_plans": loses}])
            station.run(2.0)
            self.assertEqual(station.upload(square()), MissionResult.ACCEPTED)
            self.assertIsNone(station.upload(square(8), seconds=1.0))
            self.assertIsNone(station.node.missions.upload)
            station.run(3.0)
            self.assertEqual(station.download(), [] if loses else square())
            since_boot = station.last("GLOBAL_POSITION_INT").time_boot_ms
            self.assertLess(since_boot, (station.node.now - 2.0) * 1000)
            sequences = [message.sequence for message in station.received]
            self.assertEqual(sequences.count(0), 2, "counted from the beginning again")

    def test_random_scripts(self):
        """Whatever happens, an atomic vehicle has the old plan, the new one, or lost both."""
        new = square(12)
        for seed in range(60):
            rules = [rule for rule in faults.random_script(seed) if rule["fault"] != "change"]
            station = start(f"--seed {seed}")
            self.assertEqual(station.upload(square()), MissionResult.ACCEPTED)
            station.node.faults = faults.Faults(rules, seed)
            station.upload(new, seconds=10.0)
            stored = [plans.fields_of(item) for item in station.node.missions.plans[MISSION]]
            wiped = any(rule.get("loses_plans") for rule in rules)
            self.assertIn(stored, [square(), new] + [[]] * wiped, rules)

    def test_bad_scripts(self):
        for script in ({"fault": "lost"}, {"fault": "lose", "chance": 1}):
            with self.assertRaises(ValueError):
                start("", [script])


class Signed(unittest.TestCase):
    def test_only_signed_messages_are_accepted(self):
        node = make_node()
        key = bytes(range(32))
        node.signer = codec.Signer(key)
        unsigned = Station(node)
        self.assertIsNone(unsigned.upload(square(), seconds=5))
        signed = Station(node, address="signed", signer=codec.Signer(key))
        self.assertEqual(signed.upload(square()), MissionResult.ACCEPTED)
        other = Station(node, address="wrong", signer=codec.Signer(key[::-1]))
        self.assertIsNone(other.upload(square(), seconds=5))


class Determinism(unittest.TestCase):
    def run_once(self, seed):
        entries = []
        rules = [{"fault": "lose", "probability": 0.2}, {"fault": "damage", "probability": 0.2},
                 {"fault": "delay", "probability": 0.2, "seconds": [0.0, 0.5]}]
        station = Station(make_node(f"--seed {seed}", rules, entries.append))
        station.upload(square())
        return entries

    def test_same_seed_same_log(self):
        self.assertEqual(self.run_once(3), self.run_once(3))
        self.assertNotEqual(self.run_once(3), self.run_once(4))


class Items(unittest.TestCase):
    def test_opaque_id_of_nothing_is_zero(self):
        self.assertEqual(plans.opaque_id([]), 0)


if __name__ == "__main__":
    unittest.main()
