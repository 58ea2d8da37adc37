# SPDX-License-Identifier: Apache-2.0
"""ground_station_test.py PROGRAM SOURCES: what the tests read missions with."""
import os
import sys
import unittest

import ground_station

SOURCES = sys.argv[2]
DATA = os.environ.get("ALTIPLAN_TEST_DATA", os.path.join(SOURCES, "..", "shared", "data"))
MISSIONS = os.path.join(DATA, "missions")


def text_of(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


@unittest.skipUnless(os.path.isdir(MISSIONS), "no test data: set ALTIPLAN_TEST_DATA")
class OfOthers(unittest.TestCase):
    """ground_station.py accepts and rejects files of other programs correctly."""

    def test_valid(self):
        plans = 0
        for name in sorted(os.listdir(MISSIONS)):
            if name.endswith(".plan") and not any(
                    word in name for word in ("wrong_", "without_mission")):
                ground_station.plan(text_of(os.path.join(MISSIONS, name)))
                plans += 1
            elif name.endswith(".waypoints"):
                ground_station.waypoints(text_of(os.path.join(MISSIONS, name)))
        self.assertEqual(plans, 6)

    def test_invalid(self):
        for name in ("qgroundcontrol_sample_without_mission.plan",
                     "qgroundcontrol_sample_wrong_mission_version.plan",
                     "qgroundcontrol_sample_wrong_overall_version.plan",
                     "qgc_OldFileFormat.mission"):
            with self.assertRaises(ground_station.Wrong, msg=name):
                ground_station.plan(text_of(os.path.join(MISSIONS, name)))
        for name in ("mavproxy_springvalley-foamy-fence.txt",
                     "mavproxy_springvalley-foamy-rally.txt"):
            with self.assertRaises(ground_station.Wrong, msg=name):
                ground_station.waypoints(text_of(os.path.join(MISSIONS, name)))


unittest.main(argv=sys.argv[:1] + sys.argv[3:])
