#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""every_study_test.py PROGRAM SOURCES: a sample of each study in configs/studies is run, every run has
an outcome that says something about the problem, and its report is written."""

import pathlib
import sqlite3
import subprocess
import sys
import tempfile

FAILURES = ("failed", "crashed", "out_of_memory", "bad_output", "refused")
RUNS = 12  # of each study, about


def call(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def main():
    program, sources = sys.argv[1:]
    studies = sorted(pathlib.Path(sources, "configs/studies").glob("*.yaml"))
    if not studies:
        sys.exit("no study found")
    with tempfile.TemporaryDirectory() as folder:
        for study in studies:
            store = pathlib.Path(folder, study.stem + ".db")
            said = call(program, "study", study, "--out", store, "--dry-run")
            planned = int(said.split("=")[1].split()[0])
            share = min(1, RUNS / planned)
            call(program, "study", study, "--out", store, "--jobs", 2, "--sample", share)
            with sqlite3.connect(store) as database:
                outcomes = database.execute("SELECT outcome, message FROM runs").fetchall()
            wrong = [row for row in outcomes if row[0] in FAILURES]
            if not outcomes or wrong:
                sys.exit(f"{study}: {len(outcomes)} runs, of which {wrong}")
            page = pathlib.Path(folder, study.stem, "index.html")
            call(program, "report", store, "-o", page.parent)
            if "</html>" not in page.read_text(encoding="utf-8"):
                sys.exit(f"{study}: no whole page")
            print(f"{study.name}: {len(outcomes)} of {planned} runs")


if __name__ == "__main__":
    main()
