# SPDX-License-Identifier: Apache-2.0
"""misbehaving_study_test.py PROGRAM DOC PLUGINS [REPETITIONS]: studies of all rows of the document's
table, each a pipeline, and of pipelines that behave, with a process each (by day of every fourth row) and
with processes that are used again (by day of the others). Every row has its outcome; what behaves has the
results of a study without the rows. Rows that damage the files of other runs have studies of their own: one
could remove what another has forged. So have, beside all others, those that wait for the end of their time,
which takes nothing but time.

A row is a fault, a step, an outcome and words that the message must hold."""
import concurrent.futures
import os
import re
import sys
import tempfile
import time

from study_kit import Study, runs

PROGRAM, DOC, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:4])
# How often each row is run, by --reuse: where processes are used again, those of one follow those of others.
NIGHTLY = len(sys.argv) > 4
REPETITIONS = {reuse: int(sys.argv[4]) if NIGHTLY else 1 for reuse in (1, 8)}
NEIGHBOURS = {
    "straight": "{plan: told}",
    "past": "{plan: told, with: {does: past, past_m: [500, 700, 600]}}",
    "smoothed": "{plan: told, with: {does: past, past_m: [500, 700, 600]}}, {smooth: rogue_smoother}",
}
# The CPU time is enough to write the 1 GB at which a file is too large; nothing but the rows that wait
# comes near to the time by the clock, however busy the machine is.
MORE = "repetitions: %d\nbudget: {wall_s: %d, cpu_s: 2, memory_mb: 200}\n"
WAITING_S, WALL_S = 3, 60
WAITS = "did not end within %d s" % WAITING_S


def table():
    with open(DOC) as stream:
        for line in stream:
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if len(cells) == 4 and cells[1].startswith("`"):
                yield [cell.strip("`") for cell in cells]


def neighbours_alone(folder, repetitions):
    study = Study(PROGRAM, PLUGINS, folder, NEIGHBOURS, MORE % (repetitions, WALL_S))
    study.run(study.path("alone.db"))
    return runs(study.path("alone.db"))


def check(rows, reuse):
    """What is wrong; [] where nothing is."""
    with tempfile.TemporaryDirectory(prefix="altiplan_study_") as folder:
        return check_in(folder, rows, reuse)


def check_in(folder, rows, reuse):
    waits = WAITS in rows[0][3]
    store = os.path.join(folder, "all.db")
    pipelines = dict(NEIGHBOURS)
    for i, row in enumerate(rows):
        pipelines["row%d" % i] = row[1].replace("WORK", store + ".work").replace("FOLDER", folder)
    study = Study(PROGRAM, PLUGINS, folder, pipelines,
                  MORE % (REPETITIONS[reuse], WAITING_S if waits else WALL_S))
    study.run(store, "--jobs", REPETITIONS[reuse] * len(rows) if waits else 3, "--reuse", reuse)
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
    for run in neighbours_alone(os.path.join(folder, "alone"), REPETITIONS[reuse]):
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
    with concurrent.futures.ThreadPoolExecutor(1) as beside:
        for reuse in REPETITIONS:
            began = time.time()
            chosen = [row for n, row in enumerate(rows) if NIGHTLY or (n % 4 == 3) == (reuse == 1)]
            waiting = [row for row in chosen if WAITS in row[3]]
            alone = [[row] for row in chosen if "WORK" in row[1]]
            among_themselves = [row for row in chosen if "WORK" not in row[1] and row not in waiting]
            waited = beside.submit(check, waiting, reuse)
            for part in [among_themselves] + alone:
                wrong += check(part, reuse)
            wrong += waited.result()
            print("--reuse %d: %d kinds of fault, %.1f s" % (reuse, len(chosen), time.time() - began))
    sys.exit("\n".join(wrong) or 0)


if __name__ == "__main__":
    main()
