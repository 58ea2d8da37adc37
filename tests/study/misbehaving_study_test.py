# SPDX-License-Identifier: Apache-2.0
"""misbehaving_study_test.py PROGRAM DOC PLUGINS: one study of all rows of the
document's table, each a pipeline, and of pipelines that behave, with a process each and with
processes that are used again. Every row has its outcome; what behaves has the results of a study
without the rows. Rows that damage the files of other runs have studies of their own: one could
remove what another has forged.

A row is a fault, a step, an outcome and words that the message must hold."""
import os
import re
import sys
import tempfile
import time

from study_kit import Study, runs

PROGRAM, DOC, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:4])
NEIGHBOURS = {
    "straight": "{plan: told}",
    "past": "{plan: told, with: {does: past, past_m: [500, 700, 600]}}",
    "smoothed": "{plan: told, with: {does: past, past_m: [500, 700, 600]}}, {smooth: rogue_smoother}",
}
# The CPU time is enough to write the 1 GB at which a file is too large.
MORE = "repetitions: %d\nbudget: {wall_s: 6, cpu_s: 2, memory_mb: 200}\n"
REPETITIONS = 2  # of each row; in another order among the others


def table():
    with open(DOC) as stream:
        for line in stream:
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if len(cells) == 4 and cells[1].startswith("`"):
                yield [cell.strip("`") for cell in cells]


def check(rows, reuse, folder):
    """What is wrong; [] where nothing is."""
    store = os.path.join(folder, "all.db")
    pipelines = dict(NEIGHBOURS)
    for i, row in enumerate(rows):
        pipelines["row%d" % i] = row[1].replace("WORK", store + ".work").replace("FOLDER", folder)
    study = Study(PROGRAM, PLUGINS, folder, pipelines, MORE % REPETITIONS)
    study.run(store, "--jobs", 3, "--reuse", reuse)
    of = {}
    for run in runs(store):
        of.setdefault(run[0], []).append(run)
    wrong = []
    for i, (fault, step, outcome, words) in enumerate(rows):
        for run in of["row%d" % i]:
            said = re.sub(r"\s+", " ", run[6])
            missing = [part for part in words.split(" … ") if part not in said]
            if run[5] != outcome or missing:
                wrong.append("--reuse %d: %s (%s): %s, not %s; %s" %
                             (reuse, fault, step, run[5], outcome, said))
    alone = Study(PROGRAM, PLUGINS, os.path.join(folder, "alone"), NEIGHBOURS, MORE % REPETITIONS)
    alone.run(alone.path("alone.db"))
    for run in runs(alone.path("alone.db")):
        there = of[run[0]][run[2]]
        # The files have other names.
        if comparable(there) != comparable(run):
            wrong.append("--reuse %d: '%s' came out as\n%s\nnot as\n%s" %
                         (reuse, run[0], comparable(there), comparable(run)))
    until = time.time() + 3
    while study.processes() and time.time() < until:
        time.sleep(0.05)
    if study.processes():
        wrong.append("--reuse %d: processes are left: %s" % (reuse, study.processes()))
    if os.path.exists(store + ".work"):
        wrong.append("--reuse %d: the work folder is left: %s" %
                     (reuse, os.listdir(store + ".work")))
    return wrong


def comparable(run):
    files = ("pipeline", "scenario", "files", "overrides")
    result = {key: value for key, value in (run[8] or {}).items() if key not in files}
    return run[:4] + run[5:8] + (result,)  # without the key


def main():
    rows = list(table())
    if len(rows) < 40:
        sys.exit("only %d rows in %s" % (len(rows), DOC))
    wrong = []
    among_themselves = [row for row in rows if "WORK" not in row[1]]
    alone = [[row] for row in rows if "WORK" in row[1]]
    for reuse in (1, 8):
        began = time.time()
        for part in [among_themselves] + alone:
            with tempfile.TemporaryDirectory(prefix="altiplan_study_") as folder:
                wrong += check(part, reuse, folder)
        print("--reuse %d: %d kinds of fault, %.1f s" % (reuse, len(rows), time.time() - began))
    sys.exit("\n".join(wrong) or 0)


if __name__ == "__main__":
    main()
