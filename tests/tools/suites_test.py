# SPDX-License-Identifier: Apache-2.0
"""suites_test.py BUILD: every test of a GoogleTest program that several tests of ctest share is run by exactly
one of them."""
import collections
import json
import pathlib
import subprocess
import sys

BUILD = pathlib.Path(sys.argv[1]).resolve()


def printed(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def tests(program, *filters):
    suite, found = "", []
    for line in printed(program, *filters, "--gtest_list_tests").splitlines():
        if line.startswith("  "):
            found.append(suite + line.split()[0])
        elif not line.startswith("Running main"):
            suite = line.split()[0]
    return found


def main():
    filters = collections.defaultdict(list)
    for test in json.loads(printed("ctest", "--test-dir", BUILD, "--show-only=json-v1"))["tests"]:
        command = test.get("command", [])
        if len(command) == 2 and command[1].startswith("--gtest_filter="):
            filters[command[0]].append(command[1])
    assert len(filters) > 10, filters.keys()
    problems = []
    for program, chosen in filters.items():
        times = collections.Counter(name for one in chosen for name in tests(program, one))
        problems += [f"{pathlib.Path(program).name}: {name} is run by {times[name]} tests of ctest"
                     for name in tests(program) if times[name] != 1]
    if problems:
        sys.exit("\n".join(problems))


main()
