# SPDX-License-Identifier: Apache-2.0
"""Faults that are not survived yet: call of the program, calls of the system, complaint, as regular
expressions, and why. An entry goes with its mending."""
KNOWN = (
    ("study|goes_on|tune", ".*", "stores a run|with another output|other runs|another tuned",
     "a fault of the machine is stored as the run's"),
    ("plugins", "read|write|fork|descriptor|map|stat|open", "says something else",
     "the child that examines a library has failed, and the library is refused"),
    (".*", "stat", "does not say why|with another output|does not say what",
     "where a file cannot be looked at it counts as absent or as something else"),
    (".*", "open|read", "does not say why|with another output|exit code 5",
     "what cannot be read counts as changed, damaged or at its end"),
    ("replay", "stat|open|read", "exit code 1", "a step whose files cannot be read has failed"),
    ("run", "write|sync|close|open", "does not say why", "the trace's errors are without a reason"),
    ("run", "open|write|map", "damages trace.jsonl", "the trace is written in its place"),
)
