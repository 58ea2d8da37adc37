#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""All tests of the test vehicle: its codec, its transfers, its flights and its process."""
import unittest

from test_any_message import *  # noqa: F401,F403
from test_codec import *  # noqa: F401,F403
from test_flights import *  # noqa: F401,F403
from test_node import *  # noqa: F401,F403
from test_faulty_transfers import *  # noqa: F401,F403
from test_transfers import *  # noqa: F401,F403

if __name__ == "__main__":
    unittest.main()
