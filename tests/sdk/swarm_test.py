# SPDX-License-Identifier: Apache-2.0
"""swarm_test.py SOURCE BUILD: walks through docs/how-to/swarm-with-the-kit.md as a reader would.

Then holds its runs against the certified bound, and equal seeds against each other on other numbers of threads.
"""
import csv
import pathlib
import sys
import tempfile

import walk

SOURCE, BUILD = (pathlib.Path(argument) for argument in sys.argv[1:3])
FILES = SOURCE / "tests/sdk/teaching"
PAGE = walk.Page(SOURCE / "docs/how-to/swarm-with-the-kit.md", FILES)


def main():
    assert len((FILES / "teaching.cpp").read_text().splitlines()) <= 60
    with tempfile.TemporaryDirectory() as name:
        home = pathlib.Path(name)
        walk.install(BUILD, home)
        folder, shell = PAGE.walk(home)
        with open(folder / "compare/runs.csv", encoding="utf-8") as file:
            runs = list(csv.DictReader(file))
        assert len(runs) == 12 and {run["outcome"] for run in runs} == {"solved"}, runs
        gaps = {name: [float(run["gap"]) for run in runs if run["pipeline"] == name]
                for name in ("teaching", "pso", "de")}
        print(gaps)
        assert all(0 <= gap < 1 for each in gaps.values() for gap in each), gaps
        assert {run["expanded"] for run in runs} == {"5000"}, runs
        assert (folder / "compare/figures/anytime-evaluations.svg").exists()
        routes = []
        for threads in (1, 3):
            output, code, _ = shell.run(f"altiplan run swarm.yaml --plugin-path build --threads {threads} --json "
                                        "| grep '\"cost\"'")
            assert code == 0, output
            routes.append(output)
        assert routes[0] == routes[1], routes


main()
