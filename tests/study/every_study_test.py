#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""every_study_test.py PROGRAM SOURCES RUNS: about so many runs of each study in configs/studies are run, but
at least one scenario and seed with every pipeline (0: that alone, but for LONG, and of colonies a twentieth
of their iterations); every run has an outcome that says something about the problem, and its report is
written."""

import pathlib
import re
import shutil
import sqlite3
import subprocess
import sys
import tempfile

# What takes seconds; read alone where RUNS is 0. Of MANY scenarios that takes seconds, too.
LONG = {"ant_colony", "coverage", "nmopso", "spso", "velocity_field_live", "wing_planners"}
MANY = {"fusion_paper", "stratified_complex", "stratified_simple", "velocity_field_random"}
FAILURES = ("failed", "crashed", "out_of_memory", "bad_output", "refused")


def call(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, words))}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def share_of(program, study, store, runs):
    """What share of the study so many runs are."""
    said = call(program, "study", study, "--out", store, "--dry-run")
    return min(1, runs / int(said.split("=")[1].split()[0]))


def shortened(configs):
    """What takes most of the time, after which nothing is different."""
    for file in configs.glob("pipelines/*ant_colony*.yaml"):
        text, count = re.subn(r"iterations: (\d+)", lambda found: f"iterations: {int(found[1]) // 20}",
                              file.read_text(encoding="utf-8"))
        assert count, f"{file} names no iterations"
        file.write_text(text, encoding="utf-8")


def main():
    program, sources, runs = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        configs = pathlib.Path(folder, "configs")
        shutil.copytree(pathlib.Path(sources, "configs"), configs)
        if not int(runs):
            shortened(configs)
        studies = sorted(configs.glob("studies/*.yaml"))
        if not studies:
            sys.exit("no study found")
        assert {study.stem for study in studies} >= LONG | MANY
        if not int(runs):
            studies = [study for study in studies if study.stem not in MANY]
        for study in studies:
            store = pathlib.Path(folder, study.stem + ".db")
            if study.stem in LONG and not int(runs):
                call(program, "validate", study)
                continue
            share = share_of(program, study, store, int(runs)) if int(runs) else 1e-9
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
            print(f"{study.name}: {len(outcomes)} runs")


if __name__ == "__main__":
    main()
