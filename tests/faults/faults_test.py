# SPDX-License-Identifier: Apache-2.0
"""faults_test.py PROGRAM LIBRARY COUNT EACH [SEED]: so many calls of the program in which one call of the
system fails, or all from then on, or some, or in which a process is killed there; before them, what was once
not survived: of each such fault EACH places from its first to its last (0: all).

Each ends by itself with a documented exit code, names what failed and why, leaves every output as it
was or as it shall be, and no other file; the same call without faults then gives what it always gives,
and every run of a study is as in one that nobody disturbed.

A fault that is not survived is printed with the call that repeats it:
faults_test.py PROGRAM LIBRARY --only 'study open 17 1 EIO tree files'"""
import collections
import contextlib
import errno
import itertools
import os
import random
import re
import shutil
import signal
import sqlite3
import sys
import tempfile
import time

import calls
from calls import CALLS, Inputs, files_in, stored
from injector import ERRORS, SCOPES, Fault, Injector, counting, end_all, with_id

TIMEOUT_S = 120
CODES = (3, 4)  # of a call that a fault has ended
NO_MEANS = 5  # … for lack of memory, threads or descriptors
# Other words for what the system says, and for calls without a file. A permission that comes back is
# a change.
SYNONYMS = {"EACCES": ("have changed since the runs were planned",),
            "ENOSPC": ("is full",), "ENOMEM": ("out of memory", "no memory", "bad_alloc"),
            "ENOLCK": ("another program is writing",)}
# SQLite does not say why it could not make a journal: it tries again to open one to read alone.
OF_SQLITE = ("disk I/O error", "malformed", "its journal cannot be created",
             "or the system did not show it")
WORDS = {"fork": ("process", "thread"), "map": ("memory", "bad_alloc"),
         "descriptor": ("pipe", "socket", "stdout", "memory", "process", "descriptor")}
# What was once not survived: call, calls of the system that fail in turn, which of them (slice), how
# many from there on (0: all), error.
ALL, FIRST, LAST = slice(None), slice(4), slice(-12, None)
MENDED = (("report", "rename", slice(-4, None), 1, "EACCES"), ("view", "map", ALL, 1, "ENOMEM"),
          ("run", "stat", LAST, 1, "EIO"), ("run", "fork", ALL, 1, "EAGAIN"),
          ("run", "descriptor", ALL, 1, "EMFILE"), ("merge", "truncate", ALL, 1, "ENOSPC"),
          ("goes_on", "stat", LAST, 1, "ENOMEM"), ("tune", "sync", ALL, 1, "KILL"),
          ("tune", "rename", FIRST, 1, "KILL"), ("report", "map", FIRST, 1, "ENOMEM"),
          ("report", "map", FIRST, 0, "ENOMEM"), ("plugins", "map", FIRST, 1, "ENOMEM"),
          ("check", "read", ALL, 1, "EIO"), ("check_route", "read", ALL, 0, "EIO"),
          ("view", "stat", slice(24), 1, "EIO"), ("view", "open", ALL, 1, "EMFILE"),
          ("tune", "read", LAST, 5, "EIO"), ("report", "open", LAST, 1, "EMFILE"),
          ("merge", "lock", FIRST, 1, "EIO"), ("merge", "open", FIRST, 1, "EACCES"),
          ("view", "open", FIRST, 1, "EACCES"), ("replay", "open", slice(9), 1, "EACCES"),
          ("merge", "stat", slice(23, 26), 5, "EIO"))


class Wrong(Exception):
    pass


def expect(true, *words):
    if not true:
        raise Wrong(" ".join(map(str, words)))


class Campaign:
    def __init__(self, program, library, folder):
        self.bare = Injector(program, library, {}, TIMEOUT_S)
        plugins = os.path.join(os.path.dirname(os.path.dirname(program)), "lib/altiplan/plugins")
        self.inputs = Inputs(folder, self.undisturbed)
        work = self.inputs.work
        self.injector = Injector(program, library, {
            "files": work, "libraries": work + ":" + plugins, "all": ""}, TIMEOUT_S)
        self.expected, self.counts = {}, {}

    def undisturbed(self, arguments, folder):
        ended = self.bare.call(arguments, folder)
        if ended.code != 0:
            raise SystemExit("%s: exit code %s\n%s" % (arguments, ended.code, ended.err))
        return ended

    def content(self, name):
        """All that a call leaves, and says where that counts."""
        call = CALLS[name]
        made = {}
        for output, of in call.makes.items():
            path = self.inputs.path(output)
            made[output] = (calls.folder_of if os.path.isdir(path) else of)(path)
        return made, stored(self.inputs.path(call.store)) if call.store else {}

    def prepare(self, name):
        """What the call leaves and says when nothing fails."""
        if name not in self.expected:
            self.inputs.lay_out()
            ended = self.undisturbed(CALLS[name].arguments, self.inputs.work)
            self.expected[name] = (*self.content(name), ended.out)

    def count(self, name, below):
        """How often each kind of call is made."""
        if (name, below) not in self.counts:
            self.inputs.lay_out()
            ended = self.injector.call(CALLS[name].arguments, self.inputs.work,
                                       counting(below=below))
            expect(ended.code == 0, "counted only, exit code", ended.code, ended.err)
            self.counts[name, below] = ended.counted
        return self.counts[name, below]

    def draw(self, dice, name):
        """A fault of this call of the program."""
        below = dice.choices(("files", "libraries", "all"), (6, 1, 2))[0]
        counted = {kind: n for kind, n in self.count(name, below).items() if n}
        kind = dice.choice(sorted(counted))
        nth = dice.randint(1, counted[kind])
        if dice.random() < 0.4:  # the first ones are the least alike
            nth = 1 + int(counted[kind] ** dice.random()) // 2
        error = dice.choice(ERRORS[kind])
        once = error in ("EINTR", "HALF", "KILL")
        times = 1 if once else dice.choice((0, 1, 1, 5))
        return Fault(kind, nth, times, error, dice.choices(SCOPES, (6, 1, 1))[0], below)

    def mended(self, each):
        """Calls, each with a fault."""
        for name, kind, which, times, error in MENDED:
            all_of_them = range(1, self.count(name, "files")[kind] + 1)[which]
            last = len(all_of_them) - 1
            places = range(last + 1)
            if each and places:
                places = sorted({last * k // max(1, each - 1) for k in range(each)})
            for at in places:
                yield name, Fault(kind, all_of_them[at], times, error, "tree", "files")

    def drawn(self, dice, count, names):
        for n in range(count):
            name = names[n % len(names)]
            yield name, self.draw(dice, name)

    def try_out(self, name, fault):
        """Raises Wrong where the fault is not survived. Whether it happened at all."""
        self.prepare(name)
        self.inputs.lay_out()
        ended = self.injector.call(CALLS[name].arguments, self.inputs.work, fault)
        try:
            self.judge(name, fault, ended)
            if CALLS[name].once and os.path.exists(self.inputs.path(CALLS[name].store)):
                os.remove(self.inputs.path(CALLS[name].store))
            again = self.bare.call(CALLS[name].arguments, self.inputs.work)
            self.judge_again(name, fault, again)
        except Wrong as wrong:
            end_all(ended.mark)
            raise Wrong("%s\n    exit code %s, failed: %s\n    %s" % (
                wrong, ended.code, ended.failed[:3],
                (ended.err + ended.out).strip().replace("\n", "\n    ")[:1500])) from None
        return ended.failures > 0

    def judge(self, name, fault, ended):
        expect(ended.code is not None, "hangs")
        killed = fault.error == "KILL" and ended.code == -signal.SIGKILL
        expect(ended.code >= 0 or killed, "ended by signal", -ended.code)
        said = ended.err + ended.out
        expect(not re.search(r"SIG(SEGV|ABRT|BUS|ILL|FPE)|internal error|terminate called", said),
               "crashed, or an internal error")
        if ended.code == 0:
            self.judge_done(name, fault, ended)
        elif not killed:
            self.judge_message(name, fault, ended)
        self.judge_files(name, fault, ended)
        until = time.time() + 5  # the supervisor ends what a killed parent leaves
        while with_id(ended.mark) and time.time() < until:
            time.sleep(0.02)
        expect(not with_id(ended.mark), "processes are left")

    @staticmethod
    def is_told(fault, ended):
        """Whether a call that went on without a part says so."""
        reason = {"KILL": "Killed", "HALF": "?"}.get(fault.error) or fault.reason()
        return reason in ended.out + ended.err

    def judge_done(self, name, fault, ended):
        """Where all is said to be well, it is."""
        made, runs, said = self.expected[name]
        is_told = self.is_told(fault, ended)
        found = self.content(name)[0]
        expect(is_told or found == made or self.has_failed_runs(fault, *found.values()),
               "exit code 0 with another output")
        expect(not CALLS[name].said or is_told or ended.out == said,
               "exit code 0, and says something else")
        expect(not CALLS[name].store or self.content(name)[1].keys() == runs.keys(),
               "exit code 0 with runs that are missing")

    def judge_message(self, name, fault, ended):
        expect(ended.failures > 0, "ends otherwise although nothing failed")
        if any(kind == "write" and "/" not in path for kind, path in ended.failed):
            return  # of what would have said it
        no_means = fault.calls in ("map", "fork", "descriptor")
        if name == "replay" and fault.calls == "map" and ended.code == 1:
            return  # a run that failed is another than the stored one
        expect(ended.code in CODES or no_means and ended.code == NO_MEANS, "exit code", ended.code)
        if fault.error == "KILL" or any(path.startswith("/usr") for _, path in ended.failed):
            return  # nobody is left who knows it, or another's library (PROJ) that does not say it
        said = ended.err + ended.out
        of_sqlite = any(path.endswith((".db", "-journal")) or ".altiplan-" in path or
                        ".db.work" in path for _, path in ended.failed)
        reasons = (OF_SQLITE if of_sqlite else ()) + SYNONYMS.get(fault.error, ())
        reasons += () if fault.error == "HALF" else (fault.reason(),)
        if fault.calls == "fork":  # the C library says so of threads, whatever the system has said
            reasons += (os.strerror(errno.EAGAIN),)
        expect(fault.error == "HALF" or any(reason in said for reason in reasons),
               "does not say why")
        names = [word for kind in fault.calls.split(",") for word in WORDS.get(kind, ())]
        for _, path in ended.failed:
            names += [os.path.basename(path), os.path.basename(os.path.dirname(path))]
        names += [output for output in CALLS[name].makes] + [CALLS[name].store]
        names += [word for word in CALLS[name].arguments if "." in word]  # its folder has failed
        expect(any(word and word in said for word in names), "does not say what failed")

    def judge_files(self, name, fault, ended):
        """Every output is as it was or as it shall be, and there is nothing else."""
        call = CALLS[name]
        killed = ended.code is not None and ended.code < 0
        made, runs, _ = self.expected[name]
        removed = "unlink" in fault.calls or fault.error == "KILL"
        listed = "open" not in fault.calls  # or a work folder waits for the next call, a part for ever
        for file in sorted(files_in(self.inputs.work) - files_in(self.inputs.kept)):
            expect(call.may_leave(file) or removed or not listed and (
                ".work" in file or fault.times == 0 and ".partial" in file), "leaves", file)
        for file in sorted(files_in(self.inputs.kept)):
            path = self.inputs.path(file)
            expect(os.path.exists(path), "removes", file)
            expect(call.may_leave(file) or
                   calls.read(path) == calls.read(os.path.join(self.inputs.kept, file)),
                   "changes", file)
        if call.store:
            self.judge_store(call, fault, runs)
        if ended.code == 0 and self.is_told(fault, ended):
            return
        for output, of in call.makes.items():
            path = self.inputs.path(output)
            old, new = self.inputs.old(output), made[output]
            if os.path.isdir(path):
                for file, content in calls.folder_of(path).items():
                    expect(output in call.goes_on or content in (
                        new.get(file), (old or {}).get(file)), "damages", output + "/" + file)
            elif os.path.exists(path) and calls.read(path) != old and not (killed and old is None):
                content = of(path) if of is calls.read or calls.is_json(path) else None
                is_failure = ended.code in (1, 4) and calls.is_of_failed_run(path)
                expect(content == new or is_failure, "damages", output)

    def judge_store(self, call, fault, runs):
        there = self.runs_in(call.store)
        for run, row in there.items():
            expect(row == runs.get(run) or self.may_differ(fault, row),
                   "stores a run that is not as undisturbed:", row[:7])
        expect(not call.once or not there or there.keys() == runs.keys(), "stores a part")

    @staticmethod
    def may_differ(fault, row):
        """A run whose memory was refused has come to that."""
        return fault.calls == "map" and (row[5] == "out_of_memory" or "bad_alloc" in row[6])

    @staticmethod
    def has_failed_runs(fault, *outputs):
        """A tuning, like a store, keeps a run whose memory was refused."""
        return fault.calls == "map" and any(
            word in folder.get("evaluations.csv", b"") for folder in outputs
            if isinstance(folder, dict) for word in (b"out_of_memory", b"bad_alloc"))

    def runs_in(self, store):
        """Of a copy: to read it is to undo by its journal what was half written."""
        with tempfile.TemporaryDirectory() as folder:
            copy = os.path.join(folder, store)
            for suffix in ("", "-journal"):
                if os.path.exists(self.inputs.path(store + suffix)):
                    shutil.copy(self.inputs.path(store + suffix), copy + suffix)
            if os.path.exists(copy + "-journal"):
                with contextlib.closing(sqlite3.connect(copy)) as database:
                    database.execute("PRAGMA schema_version").fetchall()
            return stored(copy)

    def judge_again(self, name, fault, again):
        """Nothing is lost: without faults the call gives what it always gives."""
        expect(again.code == 0, "the next call ends with exit code", again.code, again.err)
        made, runs, said = self.expected[name]
        found, stored_now = self.content(name)
        for output, content in made.items():
            expect(found[output] == content or self.has_failed_runs(fault, found[output]),
                   "the next call makes another", output)
        expect(not CALLS[name].said or again.out == said, "the next call says something else")
        expect(stored_now.keys() == runs.keys() and all(
            row == runs[run] or self.may_differ(fault, row) for run, row in stored_now.items()),
               "the next call stores other runs")
        expect("unlink" in fault.calls or fault.error == "KILL" or
               files_in(self.inputs.work) <= files_in(self.inputs.kept) | set(CALLS[name].makes) |
               {CALLS[name].store} | {file for file in files_in(self.inputs.work)
                                      if file.split(os.sep)[0] in CALLS[name].makes},
               "the next call leaves files:", files_in(self.inputs.work) - files_in(self.inputs.kept))


def campaign(program, library, count, each, seed, names):
    dice = random.Random(seed)
    wrong, happened = [], collections.Counter()
    with tempfile.TemporaryDirectory(prefix="altiplan_faults_") as folder:
        under_test = Campaign(program, library, folder)
        for name, fault in itertools.chain(under_test.mended(each),
                                           under_test.drawn(dice, count, names)):
            try:
                happened[under_test.try_out(name, fault)] += 1
            except (Wrong, AssertionError, sqlite3.Error) as error:
                wrong.append("%s %s" % (name, fault))
                print("--only '%s %s': %s" % (name, fault, error), flush=True)
    met = happened[True] + len(wrong)
    print("seed %s: %d faults, %d of them met, %d not survived" % (
        seed, met + happened[False], met, len(wrong)))
    return wrong


def main():
    program, library = (os.path.abspath(path) for path in sys.argv[1:3])
    if sys.argv[3] == "--only":
        name, _, fault = sys.argv[4].partition(" ")
        with tempfile.TemporaryDirectory(prefix="altiplan_faults_") as folder:
            Campaign(program, library, folder).try_out(name, Fault.read(fault))
        return
    count, each = map(int, sys.argv[3:5])
    seed = sys.argv[5] if len(sys.argv) > 5 else "1"
    names = sys.argv[6:] or list(CALLS)
    sys.exit(1 if campaign(program, library, count, each, seed, names) else 0)


if __name__ == "__main__":
    main()
