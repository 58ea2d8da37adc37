# SPDX-License-Identifier: Apache-2.0
"""chains_test.py PROGRAM PLUGINS SOURCES [CALLS [SEED]]: random calls, each with what earlier ones gave: wrong
types, parts of owners that are gone, and callbacks that raise or free what is being read (methods of arguments,
warnings, handlers of signals), in three threads at once that take each other's values. Nothing may crash, hang
or raise SystemError; the seed repeats the calls, but for the threads' turns."""
import copy
import faulthandler
import gc
import math
import numbers
import os
import pickle
import random
import signal
import sys
import tempfile
import threading
import traceback
import warnings

import case
import numpy
from case import PLUGINS, PythonCase

import altiplan

CALLS = int(sys.argv.pop(4)) if len(sys.argv) > 4 and sys.argv[4].isdigit() else 6000
SEED = int(sys.argv.pop(4)) if len(sys.argv) > 4 and sys.argv[4].isdigit() else 1
THREADS = 3
POOL = 60
SLOW = 0.006  # share of calls that read files or plan
# Of a wrong call, not of a part that works: a bug of the C++ part, or of how it asks Python.
BUGS = (SystemError, MemoryError, UnboundLocalError, NameError)


class Raises:
    """Raises from whatever is asked of it."""

    def __init__(self, error):
        self.error = error

    def fail(self, *_):
        raise self.error

    __array__ = __float__ = __index__ = __len__ = __getitem__ = __iter__ = __fspath__ = __eq__ = fail
    __bool__ = __str__ = __repr__ = keys = items = tolist = __hash__ = __getattr__ = __int__ = fail


class Frees:
    """Empties the pool while it is being read, and answers with what is no longer owned."""

    def __init__(self, pool, answer):
        self._pool = pool  # no call finds it: numpy itself crashes on a list that it empties
        self.answer = answer

    def __array__(self, *_):
        self._pool.clear()
        gc.collect()
        return self.answer

    def __float__(self):
        self._pool.clear()
        return 3.0

    def __index__(self):
        self._pool.clear()
        return 3

    __int__ = __hash__ = __index__

    def __fspath__(self):
        self._pool.clear()
        gc.collect()
        return "scenario.yaml"

    def __len__(self):
        return 3

    def __getitem__(self, index):
        self._pool.clear()
        return [1.0, 2.0, 3.0][index]

    def __eq__(self, other):
        self._pool.clear()
        return True


for _kind in (Raises, Frees):
    numbers.Integral.register(_kind)  # what is no number is refused before its methods are called


class Changes(dict):
    """Values to set, of which some go while they are read."""

    def __init__(self, pool, **values):
        super().__init__(values)
        self._pool = pool

    def items(self):
        for each in super().items():
            yield each
            self._pool.clear()
            self.clear()


class Interrupted(Exception):
    """Raised by the handler of a signal."""


class Chain:
    """One thread's calls."""

    def __init__(self, seed, folder, pools):
        self.random = random.Random(seed)
        self.numbers = numpy.random.default_rng(seed)
        self.folder = folder
        self.pool = []
        self.pools = pools
        pools.append(self.pool)
        self.done = 0

    def fresh(self):
        """A value of Python's, mostly of a wrong type."""
        points = self.numbers.uniform(0, 1000, (self.random.randrange(6), 3))
        return self.random.choice([
            lambda: None, lambda: self.random.choice([-1, 0, 1, 3, 2**31, 2**63, 2**200]),
            lambda: self.random.choice([0.0, -0.5, 5.0, 1e300, math.nan, math.inf]),
            lambda: self.random.choice(["", "points", "a\0b", "\udc80", "x" * 5000, b"\xff"]),
            lambda: points, lambda: points.tolist(), lambda: points[:, ::-1], lambda: points.T,
            lambda: points.astype(self.random.choice(["f4", ">f8", "i2", "O", "c16", "?", "U4"])),
            lambda: numpy.full((2, 3), self.random.choice([math.nan, math.inf, 1e9])),
            lambda: numpy.empty((self.random.choice([0, 1, 2]),) * self.random.randrange(4)),
            lambda: [], lambda: {}, lambda: {"steps.0.with.cell_m": [100, 100, 50]}, lambda: object(),
            lambda: Raises(self.random.choice([ValueError(), KeyError(1), OSError(), StopIteration()])),
            lambda: Frees(self.pool, points), lambda: Changes(self.pool, seed=1, steps=points),
            lambda: (x for x in points), lambda: memoryview(points),
            lambda: self.random.choice([int, altiplan.Route, altiplan.World, altiplan.Step]),
            lambda: altiplan.Route(self.numbers.uniform(0, 1000, (4, 3)))])()

    def value(self):
        if self.random.random() < 0.6:
            pool = self.random.choice(self.pools) if self.random.random() < 0.1 else self.pool
            with_luck = list(pool)  # which another value or thread may empty meanwhile
            if with_luck:
                return self.random.choice(with_luck)
        return self.fresh()

    def slow(self):
        """What reads files and plans."""
        file = self.folder / self.random.choice(["scenario.yaml", "pipeline.yaml", "rogue.yaml", "beyond.yaml",
                                                 "waits.yaml"])
        many = self.numbers.uniform(0, 1000, (9000, 3))
        return self.random.choice([
            lambda: altiplan.World(file, {}, [PLUGINS], known=self.random.random() < 0.5),
            lambda: altiplan.run(file, seed=self.value(), plugin_path=[PLUGINS]),
            lambda: altiplan.run(file, plugin_path=[PLUGINS], timeout_s=5),
            lambda: altiplan.plan(file, "astar", self.value(), self.value(), cell_m=self.value()),
            lambda: altiplan.run(file, threads=self.value(), timeout_s=self.value(), out=self.value(),
                                 plugin_path=[self.value()]),
            lambda: altiplan.go(self.value(), self.value(), self.value(), self.value()),
            lambda: altiplan.study(self.value(), self.value(), jobs=self.value()),
            lambda: altiplan.run(file, set={"seed": self.value()}, plugin_path=[PLUGINS])._repr_html_(),
            lambda: altiplan.World(self.value(), self.value(), known=self.value()),
            lambda: altiplan.World(file, {}, [PLUGINS]).clearance(many),
            lambda: altiplan.World(file, {}, [PLUGINS]).legs_blocked(many, many),
            lambda: altiplan.check(self.value(), file, {}, [PLUGINS])])

    def attribute(self):
        target = self.value()
        names = [name for name in dir(target) if not name.startswith("_")]
        found = getattr(target, self.random.choice(names))
        return found(*(self.value() for _ in range(self.random.randrange(3)))) if callable(
            found) and type(target).__module__ == "altiplan" else found

    def quick(self):
        a, b, c = self.value(), self.value(), self.value()
        kind = getattr(altiplan, self.random.choice(["Route", "World", "Step", "Check", "Error"]))
        return self.random.choice([
            lambda: altiplan.Route(a), lambda: a.legs_blocked(b, c), lambda: a.clearance(b),
            lambda: a.ground(b), lambda: a.check(b), lambda: a.chords(b), lambda: altiplan.check(a, b),
            lambda: a.legs_blocked(b, b, c), lambda: altiplan.run(a, seed=b), lambda: altiplan.World(a, b),
            lambda: altiplan.plan(a, b, c), lambda: altiplan.Study(a), lambda: kind(a), lambda: kind(),
            lambda: kind.__new__(kind, a), lambda: kind.__new__(a), lambda: a.__init__(b),
            lambda: type(a).points.fget(b), lambda: kind.__eq__(a, b), lambda: kind.__repr__(a),
            lambda: getattr(kind, self.random.choice(dir(kind)))(a, b), lambda: type(a).__reduce__(b),
            lambda: repr(a), lambda: str(a), lambda: a == b, lambda: len(a), lambda: a[0], lambda: a[b],
            lambda: a[::-1], lambda: iter(a), lambda: next(a), lambda: list(a)[:20], lambda: bool(a),
            lambda: hash(a), lambda: numpy.asarray(a), lambda: numpy.asarray(a, dtype="f4"),
            lambda: pickle.loads(pickle.dumps(a)), lambda: copy.copy(a), lambda: copy.deepcopy(a),
            lambda: setattr(a, "points", b), lambda: delattr(a, "route"), lambda: a.to_dict(),
            lambda: a.setflags(write=True), lambda: a.resize((9, 3)), lambda: a.route.points,
            lambda: altiplan._values.route_of_state(a, b), lambda: memoryview(a)])

    def in_time(self, call):
        """What a slow call gives."""
        return call()

    def call(self):
        chance = self.random.random()
        try:
            made = self.in_time(self.slow()) if chance < SLOW else (
                self.quick() if chance < 0.6 else self.attribute)()
        except BUGS:
            raise
        except Exception:
            made = None  # refused, as it should be
        if made is not None:
            self.pool.append(made)
        if len(self.pool) > POOL:
            self.pool.pop(self.random.randrange(POOL))
        if self.random.random() < 0.01:  # the owners, before their parts
            del self.pool[::2]
            gc.collect()
        self.done += 1


class InterruptedChain(Chain):
    """That of the main thread, in whose slow calls a handler raises."""

    def __init__(self, *arguments):
        super().__init__(*arguments)
        self.armed = False
        self.interrupted = 0

    def handle(self, *_):
        if self.armed:
            self.armed = False
            self.interrupted += 1
            raise Interrupted

    def slow(self):
        waits = self.random.random() < 0.5
        return (lambda: altiplan.run("waits.yaml", plugin_path=[PLUGINS])) if waits else super().slow()

    def in_time(self, call):
        try:
            self.armed = True
            signal.setitimer(signal.ITIMER_REAL, self.random.choice([0, 1e-4, 0.002, 0.05]))
            return call()
        finally:
            self.armed = False
            signal.setitimer(signal.ITIMER_REAL, 0)


class Chains(PythonCase):
    def setUp(self):
        super().setUp()
        os.chdir(self.folder)
        self.addCleanup(os.chdir, "/")
        before, tempfile.tempdir = tempfile.tempdir, str(self.folder)  # what an interrupted call may leave
        self.addCleanup(setattr, tempfile, "tempdir", before)
        self.rogue("throws").rename(self.folder / "rogue.yaml")
        self.write("beyond.yaml", case.SCENARIO.replace("[300, 300, 0], max_m: [310,",  # which it warns of
                                                        "[5000, 300, 0], max_m: [5010,"))
        self.write("waits.yaml", "altiplan: 1\nscenario: scenario.yaml\nsteps:\n"
                   "  - {plan: told, within_s: 0.2, with: {does: waits}}\n")
        self.warned = 0
        faulthandler.enable()

    def warn(self, *_, **__):
        """In place of what prints a warning: a third of them pass."""
        self.warned += 1
        if self.warned % 3:
            raise Warning if self.warned % 3 == 1 else ZeroDivisionError

    def test_nothing_crashes(self):
        failed, pools = [], []
        chains = [(Chain if i else InterruptedChain)(SEED * THREADS + i, self.folder, pools)
                  for i in range(THREADS)]
        self.addCleanup(signal.signal, signal.SIGALRM, signal.signal(signal.SIGALRM, chains[0].handle))

        def work(chain):
            try:
                while chain.done < CALLS / THREADS and not failed:
                    chain.call()
            except BaseException as error:
                failed.append((chain.done, error))
                traceback.print_exc()

        threads = [threading.Thread(target=work, args=(chain,)) for chain in chains[1:]]
        with warnings.catch_warnings():
            warnings.simplefilter("always")
            warnings.showwarning = self.warn
            for thread in threads:
                thread.start()
            work(chains[0])
            for thread in threads:
                thread.join()
        self.assertEqual(failed, [], f"seed {SEED}")
        self.assertGreater(chains[0].interrupted, 0)
        self.assertGreater(self.warned, 0)
        self.assertGreaterEqual(sum(chain.done for chain in chains), CALLS)
        world = altiplan.World(self.scenario)  # all works as before
        self.assertEqual(world.clearance([[200, 500, 100]]).tolist(), [100])


if __name__ == "__main__":
    print(f"seed {SEED}, {CALLS} calls", flush=True)
    case.main()
