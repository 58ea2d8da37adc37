# SPDX-License-Identifier: Apache-2.0
"""The part of altiplan that is in C++. Made by tests/python/stubs_test.py; edit the C++ instead."""
from os import PathLike
from typing import Any, Iterator, Mapping, Optional, Sequence, Union, final

from matplotlib.figure import Figure
from numpy import bool_, float64
from numpy.typing import ArrayLike, NDArray

__version__: str

@final
class Metrics:
    """Measures of a route or a track; None where one does not apply."""
    @property
    def length_m(self) -> Optional[float]:
        """sum of leg lengths (m)"""
    @property
    def waypoints(self) -> Optional[int]:
        """number of points"""
    @property
    def max_turn_deg(self) -> Optional[float]:
        """largest turn at a waypoint, seen from above (degrees)"""
    @property
    def max_climb_deg(self) -> Optional[float]:
        """steepest leg, up or down (degrees)"""
    @property
    def min_radius_m(self) -> Optional[float]:
        """smallest turn radius (m)"""
    @property
    def min_clearance_m(self) -> Optional[float]:
        """minimum distance to an obstacle, in any direction (m)"""
    @property
    def min_ground_clearance_m(self) -> Optional[float]:
        """minimum height above the ground (m)"""
    @property
    def smoothness_rad(self) -> Optional[float]:
        """sum of turns and changes of climb (radians)"""
    @property
    def duration_s(self) -> Optional[float]:
        """flying time by the vehicle's speed model (s)"""
    @property
    def time_s(self) -> Optional[float]:
        """flying time with accelerations and stops (s)"""
    @property
    def energy_wh(self) -> Optional[float]:
        """energy of that flight (Wh)"""
    @property
    def plan_time_s(self) -> Optional[float]:
        """search time of all plan attempts (s); of a whole run only"""
    @property
    def smooth_time_s(self) -> Optional[float]:
        """time of all smoothing (s); of a whole run only"""
    @property
    def expanded(self) -> Optional[int]:
        """sum over all plan attempts; of a whole run only"""
    def to_dict(self) -> dict[str, Any]:
        """All of it as a dict, as in result.json."""
    def __eq__(self, other: object) -> bool: ...

@final
class Violation:
    """What a route violates at one place."""
    @property
    def constraint(self) -> str:
        """name of the constraint"""
    @property
    def at(self) -> int:
        """index of the waypoint, or of the leg's first waypoint"""
    @property
    def value(self) -> Optional[float]:
        """in `unit`"""
    @property
    def limit(self) -> Optional[float]:
        """in `unit`"""
    @property
    def unit(self) -> str:
        """'m', 'deg', 'm/s'; '' where value and limit are no figures"""
    @property
    def layer(self) -> str:
        """id of the layer that it concerns, '' if of none"""
    @property
    def message(self) -> str:
        """a sentence with the place"""
    def to_dict(self) -> dict[str, Any]:
        """All of it as a dict, as in result.json."""
    def __eq__(self, other: object) -> bool: ...
    @property
    def place(self) -> Optional[NDArray[float64]]:
        """(3,), the waypoint `at` (m); None of a track's."""

@final
class Check:
    """The judge's verdict on a route; true if it is ok."""
    @property
    def ok(self) -> bool:
        """True if nothing is violated"""
    def to_dict(self) -> dict[str, Any]:
        """All of it as a dict, as in result.json."""
    def __eq__(self, other: object) -> bool: ...
    @property
    def violations(self) -> list[Violation]:
        """one for each place."""
    def __bool__(self) -> bool: ...

@final
class Leg:
    """What joins two waypoints; the turn's attributes are None of a straight leg."""
    @property
    def kind(self) -> str:
        """'straight', 'arc' or 'trochoid'"""
    @property
    def end(self) -> list[float]:
        """[x, y, z] in metres of the scenario's frame"""
    @property
    def turn_deg(self) -> Optional[float]:
        """degrees through the air, positive to the left"""
    @property
    def radius_m(self) -> Optional[float]:
        """metres through the air"""
    @property
    def heading_deg(self) -> Optional[float]:
        """at the beginning, through the air, degrees clockwise from north"""
    @property
    def drift_m(self) -> Optional[list[float]]:
        """[east, north] of the air during the leg (m)"""
    @property
    def hold_s(self) -> Optional[float]:
        """time that the vehicle waits, None of a leg without a wait"""
    def to_dict(self) -> dict[str, Any]:
        """All of it as a dict, as in result.json."""
    def __eq__(self, other: object) -> bool: ...

@final
class Flight:
    """The flight of a run, simulated or with a vehicle."""
    @property
    def status(self) -> str:
        """'solved' if it arrived"""
    @property
    def reason(self) -> Optional[str]:
        """its machine-readable cause, or None"""
    @property
    def message(self) -> str:
        """a sentence"""
    @property
    def link(self) -> Optional[str]:
        """address of the vehicle, None if simulated"""
    @property
    def counters(self) -> dict[str, int]:
        """the pilot's counters"""
    @property
    def collisions(self) -> int:
        """number of contacts with obstacles"""
    @property
    def min_separation_m(self) -> Optional[float]:
        """minimum distance from any surface (m), negative inside"""
    @property
    def reached(self) -> bool:
        """True if it reached the goal"""
    @property
    def cross_track_max_m(self) -> Optional[float]:
        """largest horizontal distance from the route (m)"""
    @property
    def cross_track_p999_m(self) -> Optional[float]:
        """the distance exceeded for 0.1 % of the time (m)"""
    @property
    def height_error_max_m(self) -> Optional[float]:
        """largest height difference from the route (m)"""
    @property
    def handovers(self) -> list[dict[str, Any]]:
        """at_s, to, why"""
    @property
    def replans(self) -> list[dict[str, Any]]:
        """at_s, step, status, reason, message, time_s, counters"""
    def to_dict(self) -> dict[str, Any]:
        """All of it as a dict, as in result.json."""
    def __eq__(self, other: object) -> bool: ...
    @property
    def metrics(self) -> Metrics:
        """those of the track."""
    @property
    def check(self) -> Check:
        """that of the track."""
    @property
    def track(self) -> NDArray[float64]:
        """(n, 4), read-only: seconds, then metres of the scenario's frame."""

@final
class Route:
    """Waypoints joined by legs, in metres of the scenario's frame: x east, y north, z above sea
    level. Route(points) joins points of shape (n, 3) by straight legs; ValueError for another
    shape or numbers that are not finite, TypeError for what is no number. Nothing changes it."""
    def __init__(self, points: ArrayLike) -> None: ...
    @property
    def points(self) -> NDArray[float64]:
        """(n, 3), read-only view of the waypoints (m)."""
    def to_numpy(self) -> NDArray[float64]:
        """The same as `points`."""
    def __array__(self, dtype: Any = None) -> NDArray[Any]: ...
    def chords(self, tolerance_m: float = 0.01) -> NDArray[float64]:
        """(m, 3) float64: the waypoints, and the ends of chords that lie within this distance of
        the turns (m). Those within 0.01 m are the `route` of result.json."""
    @property
    def legs(self) -> list[Leg]:
        """one fewer than waypoints."""
    @property
    def length_m(self) -> float:
        """sum of leg lengths (m)."""
    def __len__(self) -> int: ...
    def __getitem__(self, arg0: Any) -> Any: ...
    def __iter__(self) -> Iterator[NDArray[float64]]: ...
    def __eq__(self, other: object) -> bool: ...

@final
class Step:
    """One attempt of a step of a pipeline."""
    @property
    def id(self) -> str:
        """name of the step"""
    @property
    def verb(self) -> str:
        """'plan', 'smooth' or 'fly'"""
    @property
    def plugin(self) -> str:
        """name of the plugin"""
    @property
    def instead_of(self) -> Optional[str]:
        """id of the step that this attempt replaces, or None"""
    @property
    def accepted(self) -> bool:
        """True if the route is accepted"""
    @property
    def proved(self) -> bool:
        """True if the planner's search space contains no route"""
    @property
    def time_s(self) -> float:
        """wall time of the call (s)"""
    @property
    def counters(self) -> dict[str, int]:
        """the plugin's counters, including 'expanded'"""
    def to_dict(self) -> dict[str, Any]:
        """All of it as a dict, as in result.json."""
    def __eq__(self, other: object) -> bool: ...
    @property
    def status(self) -> str:
        """the outcome; 'solved' only with an accepted route and flight"""
    @property
    def reason(self) -> Optional[str]:
        """its machine-readable cause, or None"""
    @property
    def message(self) -> str:
        """a sentence"""
    @property
    def budget_hit(self) -> bool:
        """True if a budget ended it"""
    @property
    def cost(self) -> Optional[float]:
        """what its route costs by the objective, by default its length (m)"""
    @property
    def bound(self) -> Optional[float]:
        """what any such route costs at least"""
    @property
    def setup_time_s(self) -> float:
        """wall time of the setup (s)"""
    @property
    def route(self) -> Optional[Route]:
        """its route, or None."""
    @property
    def legs(self) -> Optional[list[Leg]]:
        """the legs of that route."""
    @property
    def metrics(self) -> Optional[Metrics]:
        """the measures of that route."""
    @property
    def check(self) -> Optional[Check]:
        """the verdict on that route."""

@final
class Result:
    """What a run gave: its attributes are the keys of result.json."""
    @property
    def version(self) -> str:
        """of altiplan"""
    @property
    def folder(self) -> Optional[str]:
        """where `out` was written, or None"""
    @property
    def pipeline(self) -> str:
        """absolute path"""
    @property
    def scenario(self) -> str:
        """absolute path"""
    @property
    def files(self) -> list[dict[str, str]]:
        """path, sha256"""
    @property
    def plugins(self) -> list[dict[str, str]]:
        """kind, name, build, checksum"""
    @property
    def overrides(self) -> dict[str, Any]:
        """what replaced values of the files"""
    @property
    def seed(self) -> int:
        """the seed"""
    def to_dict(self) -> dict[str, Any]:
        """All of it as a dict, as in result.json."""
    def __eq__(self, other: object) -> bool: ...
    @property
    def status(self) -> str:
        """the outcome; 'solved' only with an accepted route and flight"""
    @property
    def reason(self) -> Optional[str]:
        """its machine-readable cause, or None"""
    @property
    def message(self) -> str:
        """a sentence"""
    @property
    def budget_hit(self) -> bool:
        """True if a budget ended it"""
    @property
    def cost(self) -> Optional[float]:
        """what its route costs by the objective, by default its length (m)"""
    @property
    def bound(self) -> Optional[float]:
        """what any such route costs at least"""
    @property
    def setup_time_s(self) -> float:
        """wall time of the setup (s)"""
    @property
    def route(self) -> Optional[Route]:
        """its route, or None."""
    @property
    def legs(self) -> Optional[list[Leg]]:
        """the legs of that route."""
    @property
    def metrics(self) -> Optional[Metrics]:
        """the measures of that route."""
    @property
    def check(self) -> Optional[Check]:
        """the verdict on that route."""
    @property
    def steps(self) -> list[Step]:
        """every attempt, in order."""
    @property
    def flight(self) -> Optional[Flight]:
        """the flight, None where there is none."""
    @property
    def route_lonlat(self) -> Optional[NDArray[float64]]:
        """(m, 3), read-only: degrees east, degrees north, metres above
        sea level of route.chords(); None without a route or a georeference."""
    @property
    def warnings(self) -> list[str]:
        """sentences to check."""
    @property
    def notes(self) -> list[str]:
        """sentences on the data read."""
    def to_json(self) -> str:
        """The text of result.json, as `altiplan run --out` writes it."""
    def _repr_html_(self) -> str:
        """The page of `altiplan view` in a frame, which works offline. Builds the world again;
        altiplan.Error if its files are gone."""
    def plot(self, figure: Optional[Figure] = None) -> Figure:
        """A top view and the height profile of the accepted route, and of the flight's track; the routes
        of other steps are thin. Axes are in metres of the scenario's frame. Returns the
        matplotlib.figure.Figure, a new one unless `figure` is given; ImportError without matplotlib."""

@final
class World:
    """The layers of a scenario, or of a pipeline's, with the problem posed there; nothing changes it.
    World(file, set={}, plugin_path=(), known=False): `set` replaces values of the scenario, as of
    altiplan.run. All layers count; with `known`, only those that planners know at take-off.
    altiplan.Error for files and plugins that are refused."""
    def __init__(self, file: Union[str, PathLike[str]], set: Mapping[str, Any] = {},
                 plugin_path: Sequence[Union[str, PathLike[str]]] = (),
                 known: bool = False) -> None: ...
    @property
    def layers(self) -> list[str]:
        """the layers' ids."""
    @property
    def volume(self) -> NDArray[float64]:
        """(2, 3), lowest and highest corner of the volume (m)."""
    @property
    def start(self) -> NDArray[float64]:
        """(3,), the start (m)."""
    @property
    def goal(self) -> NDArray[float64]:
        """(3,), the goal (m)."""
    @property
    def warnings(self) -> list[str]:
        """sentences to check."""
    def clearance(self, points: ArrayLike) -> NDArray[float64]:
        """Signed distances from the nearest obstacle or ground (m), negative inside, of points of
        shape (n, 3): float64 of shape (n,). Infinite in an empty world, -inf of a point that is
        not finite; ValueError for another shape."""
    def legs_blocked(self, a: ArrayLike, b: ArrayLike, radius_m: float = 0.0) -> NDArray[bool_]:
        """Whether a sphere of this radius (m) meets an obstacle on the straight leg from a[i] to
        b[i]; both of shape (n, 3): bool of shape (n,). True of points that are not finite;
        ValueError for other shapes."""
    def ground(self, points_xy: ArrayLike) -> NDArray[float64]:
        """Heights of the ground above sea level (m) at points of shape (n, 2): float64 of shape
        (n,), nan where there is none; ValueError for another shape."""
    def check(self, route: Union[Route, ArrayLike]) -> Check:
        """The judge's verdict on a Route, or on points of shape (n, 3) in metres, in the world known
        at take-off: a Check of ends, volume, every leg, limit and constraint of the file."""

def route_of_state(points: ArrayLike, legs: ArrayLike) -> Route: ...
def run(pipeline: Union[str, PathLike[str]], seed: Optional[int], set: Sequence[str],
        plugin_path: Sequence[Union[str, PathLike[str]]], threads: int, timeout_s: float,
        out: Optional[str]) -> Result: ...
def stored(text: str, plugin_path: Sequence[Union[str, PathLike[str]]]) -> Result: ...
def plan(file: Union[str, PathLike[str]], seed: Optional[int], set: Sequence[str],
         plugin_path: Sequence[Union[str, PathLike[str]]]) -> tuple[Step, Sequence[str]]: ...
