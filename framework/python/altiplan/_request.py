# SPDX-License-Identifier: Apache-2.0
"""What methods of plugins in Python get: values, and a world that they ask of the program.

Stands alone, as _planner.py does."""
import math
import random
import sys
import time
import typing
from array import array

_Ask = typing.Callable[[typing.Dict[str, typing.Any], typing.Any],
                       typing.Tuple[typing.Dict[str, typing.Any], "array[float]"]]


def numbers_of(points: typing.Any, columns: int, name: str) -> "array[float]":
    """The numbers of points, row by row; ValueError unless each has as many."""
    if hasattr(points, "tolist"):  # numpy's arrays
        if len(points.shape) != 2 or points.shape[1] != columns:
            raise ValueError(f"{name}: expected numbers of shape (n, {columns}), found shape "
                             f"{points.shape}")
        return array("d", points.astype(float).tobytes())
    numbers = array("d")
    for point in points:
        if len(point) != columns:
            raise ValueError(f"{name}: expected points of {columns} numbers, found {len(point)}")
        numbers.extend(map(float, point))
    return numbers


def listed(numbers: typing.Any, columns: int = 1) -> typing.Any:
    """Numbers, or rows of them: arrays in a script that imports numpy, else lists of tuples."""
    numpy = sys.modules.get("numpy")
    if numpy is not None:
        values = numpy.array(numbers, dtype=float)
        return values if columns == 1 else values.reshape(-1, columns)
    if columns == 1:
        return list(numbers)
    return list(zip(*(numbers[column::columns] for column in range(columns))))


class Budget:
    """What a plan may use. `spent` is asked in every iteration; once true it stays true."""

    def __init__(self, given: typing.Dict[str, typing.Any], is_stopped: typing.Callable[[], bool]):
        self._is_stopped = is_stopped
        self._deadline: typing.Optional[float] = given["deadline"]
        self.max_iterations: int = given["max_iterations"]
        self.expanded = 0  # iterations that have been counted
        self._asked = 0
        self.was_spent = False  # what `spent` last said

    @property
    def seconds_left(self) -> float:
        """Infinite without a time limit."""
        return math.inf if self._deadline is None else self._deadline - time.monotonic()

    def spent(self, iterations: typing.Optional[int] = None) -> bool:
        """True when the search has to end; `iterations` are those done, by default the calls before
        this one."""
        done = self._asked if iterations is None else iterations
        self._asked += 1
        self.expanded = max(self.expanded, min(done, self.max_iterations))
        self.was_spent = (self.was_spent or done >= self.max_iterations or self.seconds_left <= 0 or
                          self._is_stopped())
        return self.was_spent


class World:
    """The known world of a request, asked of the program: its answers are those of the judge."""

    def __init__(self, ask: _Ask):
        self._ask = ask

    @property
    def layers(self) -> typing.List[str]:
        """The layers' ids."""
        return list(self._ask({"ask": "layers"}, ())[0]["layers"])

    def clearance(self, points: typing.Any) -> typing.Any:
        """Signed distances from the nearest obstacle or ground (m) of points (n, 3)."""
        return listed(self._ask({"ask": "clearance"}, numbers_of(points, 3, "points"))[1])

    def ground(self, points_xy: typing.Any) -> typing.Any:
        """Heights of the ground (m) at points (n, 2); nan where there is none."""
        return listed(self._ask({"ask": "ground"}, numbers_of(points_xy, 2, "points_xy"))[1])

    def to_local(self, lonlat: typing.Any) -> typing.Any:
        """Degrees east and north (n, 2) as metres east and north (n, 2) of the scenario's frame."""
        return listed(self._ask({"ask": "local"}, numbers_of(lonlat, 2, "lonlat"))[1], 2)

    def legs_blocked(self, a: typing.Any, b: typing.Any, radius_m: float = 0.0) -> typing.Any:
        """Whether a sphere meets an obstacle on each straight leg from a[i] to b[i]."""
        return self._yes({"ask": "legs_blocked", "radius_m": float(radius_m)}, self._pairs(a, b))

    def legs_ok(self, a: typing.Any, b: typing.Any, before: typing.Any = None) -> typing.Any:
        """Whether each leg from a[i] to b[i] keeps every limit and constraint that depends on it
        alone. `before` are the points from which a[i] are reached, for limits of turns; a leg from
        the request's start has its approach."""
        rows = self._pairs(a, b)
        if before is not None:
            rows = rows + numbers_of(before, 3, "before")
            if 2 * len(rows) != 3 * len(self._pairs(a, b)):
                raise ValueError("before: expected as many points as a")
        return self._yes({"ask": "legs_ok", "before": before is not None}, rows)

    def leg_ok(self, a: typing.Any, b: typing.Any, before: typing.Any = None) -> bool:
        """legs_ok of one leg."""
        return bool(self.legs_ok([a], [b], None if before is None else [before])[0])

    def violations(self, points: typing.Any) -> typing.List[str]:
        """What the judge finds wrong with a whole route, a sentence each; [] of one that holds."""
        answer = self._ask({"ask": "violations"}, numbers_of(points, 3, "points"))[0]
        return list(answer["violations"])

    def _yes(self, question: typing.Dict[str, typing.Any], numbers: "array[float]") -> typing.Any:
        answers = self._ask(question, numbers)[1]
        numpy = sys.modules.get("numpy")
        return [answer != 0 for answer in answers] if numpy is None else numpy.array(answers) != 0

    @staticmethod
    def _pairs(a: typing.Any, b: typing.Any) -> "array[float]":
        begins, ends = numbers_of(a, 3, "a"), numbers_of(b, 3, "b")
        if len(begins) != len(ends):
            raise ValueError(f"b: expected {len(begins) // 3} points as of a, "
                             f"found {len(ends) // 3}")
        return begins + ends


def _point(given: typing.Any) -> typing.Any:
    """A tuple of numbers, or an array in a script that imports numpy; None of None."""
    if given is None:
        return None
    return tuple(given) if sys.modules.get("numpy") is None else listed(given)


class Leg:
    """A straight motion that a constraint admits or refuses. `world` answers clearance, ground,
    legs_blocked and to_local of the known layers; it is empty where none are known."""

    def __init__(self, numbers: "array[float]", ask: _Ask):
        self.start, self.end = _point(numbers[:3]), _point(numbers[3:6])  # metres
        self.before = _point(numbers[6:]) if len(numbers) > 6 else None  # whence start is reached
        self.world = World(ask)


class Site:
    """Where a layer is built: values, and the layers before it to ask. Points are in metres."""

    def __init__(self, given: typing.Dict[str, typing.Any], ask: _Ask):
        # The lowest and the highest corner; infinite where the scenario leaves it to the layers.
        self.volume = listed([(-math.inf if n < 3 else math.inf) if number is None else number
                              for n, number in enumerate(given["volume"])], 3)
        self.start, self.goal = _point(given["start"]), _point(given["goal"])  # None: not yet known
        self.vehicle = given["vehicle"]  # as of a request
        self.start_time_s = given["start_time_s"]  # since 1970-01-01 UTC; None where none is given
        self.seed = given["seed"]
        self.rng = random.Random(self.seed)
        self.world = World(ask)
        self._ask = ask

    def to_local(self, lonlat: typing.Any) -> typing.Any:
        """As of the world."""
        return self.world.to_local(lonlat)


class Request:
    """A planning problem: values, and the world to ask. Points are in metres of the scenario's frame."""

    def __init__(self, given: typing.Dict[str, typing.Any], ask: _Ask,
                 is_stopped: typing.Callable[[], bool]):
        self.start, self.goal = _point(given["start"]), _point(given["goal"])
        velocity = given["start_velocity"]  # m/s; None where no heading is given
        self.start_velocity = None if velocity is None else listed(velocity)
        self.goal_tolerance_m = given["goal_tolerance_m"]
        self.goal_heading = given["goal_heading"]  # radians, counter-clockwise from east, or None
        self.volume = listed(given["volume"], 3)  # the lowest and the highest corner
        self.level_m = given["level_m"]  # of level flight, or None
        self.vehicle = given["vehicle"]  # a dict: radius_m, speed_mps, and of an aeroplane wing
        self.limits = given["limits"]  # a dict; None: no limit
        self.wind = given["wind"]  # dicts of above_m and velocity, by ascending border
        self.threads = given["threads"]
        self.seed = given["seed"]
        self.rng = random.Random(self.seed)
        self.budget = Budget(given["budget"], is_stopped)
        self.world = World(ask)
