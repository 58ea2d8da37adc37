# SPDX-License-Identifier: Apache-2.0
"""What is left to the night. ctest's test NAME, and a run by hand, leave out what is marked with these; its
NAME_nightly, with ALTIPLAN_NIGHTLY=1, leaves out nothing."""
import os
import unittest

NIGHTLY = bool(os.environ.get("ALTIPLAN_NIGHTLY"))
by_night = unittest.skipUnless(NIGHTLY, "by night: ALTIPLAN_NIGHTLY=1")


def by_day(cases, every, first=0):
    """All of them by night; by day each so many-th, from the `first` on."""
    cases = list(cases)
    return cases if NIGHTLY else cases[first::every]
