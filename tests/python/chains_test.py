# SPDX-License-Identifier: Apache-2.0
"""chains_test.py PROGRAM PLUGINS SOURCES [CALLS [SEED]]: random calls, each with what earlier ones gave: wrong
types, parts of owners that are gone, and callbacks that raise or free what is being read, in three threads
at once. Nothing may crash, hang or raise SystemError; the seed repeats the calls, but for the threads' turns."""
import copy
import faulthandler
import gc
import math
import os
import pickle
import random
import sys
import threading
import warnings

import case
import numpy
from case import PLUGINS, PythonCase

import altiplan

CALLS = int(sys.argv.pop(4)) if len(sys.argv) > 4 and sys.argv[4].isdigit() else 6000
SEED = int(sys.argv.pop(4)) if len(sys.argv) > 4 and sys.argv[4].isdigit() else 1
THREADS = 3
POOL = 60
SLOW = 0.003  # share of calls that read files or plan
# Of a wrong call, not of a part that works: a bug of the C++ part, or of how it asks Python.
BUGS = (SystemError, MemoryError, UnboundLocalError, NameError)


class Raises:
    """Raises from whatever is asked of it."""

    def __init__(self, error):
        self.error = error

    def fail(self, *_):
        raise self.error

    __array__ = __float__ = __index__ = __len__ = __getitem__ = __iter__ = __fspath__ = __eq__ = fail
    __bool__ = __str__ = __repr__ = keys = items = tolist = __hash__ = __getattr__ = fail


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

    def __len__(self):
        return 3

    def __getitem__(self, index):
        self._pool.clear()
        return [1.0, 2.0, 3.0][index]

    def __eq__(self, other):
        self._pool.clear()
        return True

    __hash__ = None


class Chain:
    """One thread's calls."""

    def __init__(self, seed, folder):
        self.random = random.Random(seed)
        self.numbers = numpy.random.default_rng(seed)
        self.folder = folder
        self.pool = []
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
            lambda: Frees(self.pool, points), lambda: (x for x in points), lambda: memoryview(points),
            lambda: self.random.choice([int, altiplan.Route, altiplan.World, altiplan.Step]),
            lambda: altiplan.Route(self.numbers.uniform(0, 1000, (4, 3)))])()

    def value(self):
        if self.pool and self.random.random() < 0.6:
            with_luck = list(self.pool)  # which another value may empty meanwhile
            if with_luck:
                return self.random.choice(with_luck)
        return self.fresh()

    def slow(self):
        """What reads files and plans."""
        file = self.folder / self.random.choice(["scenario.yaml", "pipeline.yaml", "rogue.yaml"])
        return self.random.choice([
            lambda: altiplan.World(file, known=self.random.random() < 0.5),
            lambda: altiplan.run(file, seed=self.value(), plugin_path=[PLUGINS]),
            lambda: altiplan.run(file, plugin_path=[PLUGINS], timeout_s=5),
            lambda: altiplan.plan(file, "astar", self.value(), self.value(), cell_m=self.value()),
            lambda: altiplan.run(file, set={"seed": self.value()}, plugin_path=[PLUGINS])._repr_html_(),
            lambda: altiplan.check(self.value(), file)])

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
            lambda: repr(a), lambda: str(a), lambda: a == b, lambda: len(a), lambda: a[0],
            lambda: a[::-1], lambda: iter(a), lambda: next(a), lambda: list(a)[:20], lambda: bool(a),
            lambda: hash(a), lambda: numpy.asarray(a), lambda: numpy.asarray(a, dtype="f4"),
            lambda: pickle.loads(pickle.dumps(a)), lambda: copy.copy(a), lambda: copy.deepcopy(a),
            lambda: setattr(a, "points", b), lambda: delattr(a, "route"), lambda: a.to_dict(),
            lambda: a.setflags(write=True), lambda: a.resize((9, 3)), lambda: a.route.points,
            lambda: altiplan._values.route_of_state(a, b), lambda: memoryview(a)])

    def call(self):
        chance = self.random.random()
        try:
            made = (self.slow() if chance < SLOW else self.quick() if chance < 0.6
                    else self.attribute)()
        except BUGS:
            raise
        except Exception:
            made = None  # refused, as it should be
        if made is not None:
            self.pool.append(made)
        if len(self.pool) > POOL:
            del self.pool[self.random.randrange(POOL)]
        if self.random.random() < 0.01:  # the owners, before their parts
            del self.pool[::2]
            gc.collect()
        self.done += 1


class Chains(PythonCase):
    def test_nothing_crashes(self):
        faulthandler.enable()
        warnings.simplefilter("ignore")
        os.chdir(self.folder)
        self.addCleanup(os.chdir, "/")
        self.rogue("throws")
        (self.folder / "throws.yaml").rename(self.folder / "rogue.yaml")
        failed = []
        chains = [Chain(SEED * THREADS + i, self.folder) for i in range(THREADS)]

        def work(chain):
            try:
                while chain.done < CALLS / THREADS and not failed:
                    chain.call()
            except BaseException as error:
                failed.append((chain.done, error))
                raise

        threads = [threading.Thread(target=work, args=(chain,)) for chain in chains]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(failed, [], f"seed {SEED}")
        self.assertGreaterEqual(sum(chain.done for chain in chains), CALLS)
        world = altiplan.World(self.scenario)  # all works as before
        self.assertEqual(world.clearance([[200, 500, 100]]).tolist(), [100])


if __name__ == "__main__":
    print(f"seed {SEED}, {CALLS} calls", flush=True)
    case.main()
