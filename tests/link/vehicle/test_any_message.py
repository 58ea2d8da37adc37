# SPDX-License-Identifier: Apache-2.0
"""No message, however senseless its fields, stops the vehicle or its reports."""
import math
import random
import unittest

import messages
from constants import Command
from flavours import AUTO, GUIDED, HOLD, RTL
from station import Station, make_node
from test_codec import random_fields

OFTEN = ("COMMAND_LONG", "COMMAND_INT", "MISSION_ITEM_INT", "MISSION_ITEM", "MISSION_COUNT",
         "SET_POSITION_TARGET_LOCAL_NED", "SET_POSITION_TARGET_GLOBAL_INT")
FLOATS = (math.nan, math.inf, -math.inf, 0.0, 1.0, 2.0, 3e38, -1.0)
# Of integers, so that they are not always refused at once.
PLAUSIBLE = {"command": [int(command) for command in Command], "frame": range(12),
             "coordinate_frame": range(12), "seq": range(5), "count": range(5),
             "mission_type": (0, 0, 0, 1, 2, 255, 9), "type_mask": (0xDC7, 0xDF8, 0xDC0, 0, 0xFFF),
             "target_system": (1,), "target_component": (1,)}


class AnyMessage(unittest.TestCase):
    def fields(self, message, rng, parameters):
        fields = random_fields(message, rng)
        for name, value in fields.items():
            if name in PLAUSIBLE:
                fields[name] = rng.choice(PLAUSIBLE[name])
            elif isinstance(value, float) and rng.random() < 0.4:
                fields[name] = rng.choice(FLOATS)
        if message.name == "PARAM_SET":
            fields["param_id"] = rng.choice(parameters)
        return fields

    def test_any_message(self):
        for seed in range(12):
            rng = random.Random(seed)
            flavour = rng.choice(["generic", "ardupilot", "px4"])
            kind = ["copter", "plane"][seed % 2]
            station = Station(make_node(f"--autopilot {flavour} --type {kind} --terrain"))
            parameters = list(station.node.pilot.parameters)
            for _ in range(200):
                any_name = rng.choice(sorted(messages.BY_NAME))
                message = messages.BY_NAME[rng.choice([any_name, rng.choice(OFTEN)])]
                station.send(message.name, **self.fields(message, rng, parameters))
                station.run(0.06)
                if rng.random() < 0.05:
                    station.arm()
                    station.set_mode(rng.choice([AUTO, GUIDED, HOLD, RTL]))
            station.received.clear()
            station.run(2.0)
            self.assertIsNotNone(station.last("HEARTBEAT"), seed)
            position = station.node.pilot.body.position
            self.assertTrue(math.isfinite(position.lat + position.lon + position.alt), seed)


if __name__ == "__main__":
    unittest.main()
