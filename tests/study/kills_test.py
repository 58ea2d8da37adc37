# SPDX-License-Identifier: Apache-2.0
"""kills_test.py PROGRAM PLUGINS KILLS RUNS [SEED]: random `kill -9` during studies: of the program, of
one of its processes (a worker, the supervisor), of its process group. After each the study goes on, with
or without --reuse. In the end nothing is missing, nothing is there twice, every run is as in a study
that nobody disturbed, and no process is left."""
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

from study_kit import Study, runs

PROGRAM, PLUGINS = (os.path.abspath(path) for path in sys.argv[1:3])
KILLS, RUNS = int(sys.argv[3]), int(sys.argv[4])
SEED = int(sys.argv[5]) if len(sys.argv) > 5 else random.randrange(10**6)

PIPELINES = {
    "quick": "{plan: told}",
    "slow": "{plan: told, within_iterations: 1500, with: {does: uses_budget}}",
    "crashes": "{plan: told, with: {does: past, past_m: [500, 500, 700]}}, "
               "{plan: rogue, with: {does: segfaults}}",
    "litters": "{plan: outlaw, with: {does: leaves_a_child}}",
    "smooth": "{plan: told, with: {does: past, past_m: [500, 500, 700]}}, "
              "{smooth: rogue_smoother}",
}


def children(process):
    try:
        with open("/proc/%d/task/%d/children" % (process, process)) as stream:
            return [int(word) for word in stream.read().split()]
    except OSError:
        return []


def kill_something(process, what):
    """Whether there was something to kill."""
    if what == "parent":
        process.kill()
    elif what == "group":
        os.killpg(process.pid, signal.SIGKILL)
    else:
        victims = children(process.pid)
        if not victims:
            return False
        try:
            os.kill(random.choice(victims), signal.SIGKILL)
        except ProcessLookupError:
            return False
    return True


def study_under_fire(study, store, kills):
    """Runs the study to its end with at most so many kills; how many there were, of which kind."""
    count = {"parent": 0, "worker": 0, "group": 0}
    calls = 0
    while True:
        calls += 1
        process = study.start(store, "--jobs", random.choice((1, 2, 4)),
                              "--reuse", random.choice((1, 1, 3, 8)))
        while sum(count.values()) < kills and process.poll() is None:
            try:
                process.wait(timeout=random.uniform(0, 0.35))
            except subprocess.TimeoutExpired:
                what = random.choice(list(count))
                count[what] += kill_something(process, what)
        said = process.communicate()[0].decode(errors="replace")
        if process.returncode == 0:
            return count, calls
        if process.returncode != -signal.SIGKILL:
            raise AssertionError("exit code %d: %s" % (process.returncode, said))


def main():
    random.seed(SEED)
    print("seed", SEED)
    repetitions = RUNS // len(PIPELINES)
    with tempfile.TemporaryDirectory(prefix="altiplan_kills_") as folder:
        study = Study(PROGRAM, PLUGINS, folder, PIPELINES, "repetitions: %d\n" % repetitions)
        study.run(study.path("calm.db"), "--jobs", 2)
        expected = runs(study.path("calm.db"))
        assert len(expected) == repetitions * len(PIPELINES), len(expected)
        report = study.report(study.path("calm.db"), study.path("calm"))
        assert "index.html" in report
        done = 0
        while done < KILLS:
            store = study.path("%d.db" % done)
            count, calls = study_under_fire(study, store, KILLS - done)
            found = runs(store)
            print("%d runs in %d calls, killed: %s" % (len(found), calls, count))
            assert len({row[4] for row in found}) == len(found), "a run is there twice"
            assert len(found) == len(expected), "%d runs of %d" % (len(found), len(expected))
            for there, here in zip(found, expected):
                assert there == here, "not as undisturbed:\n%s\n%s" % (there, here)
            assert not os.path.exists(store + ".work"), "the work folder is still there"
            again = study.report(store, store + ".report")
            assert again.keys() == report.keys(), again.keys() ^ report.keys()
            for name, text in again.items():
                assert text == report[name], name + " of the report is another"
            done += sum(count.values())
        until = time.time() + 5
        while study.processes() and time.time() < until:
            time.sleep(0.05)
        assert not study.processes(), "left: %s" % study.processes()


main()
