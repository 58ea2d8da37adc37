# SPDX-License-Identifier: Apache-2.0
"""The calls of altiplan.plan, by planner. Made by tests/python/stubs_test.py; edit the C++ instead."""
from typing import (Any, Callable, Literal, Mapping, NoReturn, Optional, Protocol, Sequence, Union,
                    overload)

from numpy import floating, integer
from numpy.typing import NDArray

from . import _Path
from ._altiplan import Step

_Whole = Union[int, integer[Any]]
_Number = Union[float, floating[Any], _Whole]
_Numbers = Union[Sequence[_Number], NDArray[Any]]

class RefusedParameters(Protocol):
    """What a call gives whose parameters are not those of this planner, or not of their types:
    nothing, since it raises altiplan.Error."""

class Plan(Protocol):
    """Type of altiplan.plan."""
    @overload
    def __call__(self, file: _Path, name: Literal["ant_colony"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], ants: _Whole = 100, iterations: _Whole = 100,
                 deposit_q: _Number = 2000, initial_pheromone: _Number = 2, alpha: _Number = 6,
                 beta: _Number = 3, evaporation: _Number = 0.6, max_length_m: Union[_Number,
                 Literal["auto"]] = "auto", max_memory_mb: _Whole = 4096,
                 heuristic: Literal["goal_scaled", "goal", "leg"] = "goal_scaled",
                 **others: NoReturn) -> Step:
        """ant colony on an eight-connected grid, the baseline of paper 004

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        ants: integer, 1 … 1e+06, default 100
            number of ants in the colony
        iterations: integer, 1 … 1e+06, default 100
            number of iterations, in each of which every ant walks once; all are run if the
            budget allows
        deposit_q: number, 1e-09 … 1e+09, default 2000
            Q of eq. (2): an ant deposits Q divided by the metres of its route, or by its cost
            in metres that cost the same on the first routes
        initial_pheromone: number, 1e-09 … 1e+09, default 2
            initial tau everywhere
        alpha: number, 0 … 20, default 6
            exponent of the pheromone in eq. (1)
        beta: number, 0 … 20, default 3
            exponent of the heuristic in eq. (1)
        evaporation: number, 0 … 1, default 0.6
            rho of eq. (4): fraction of the pheromone that evaporates in each iteration
        max_length_m: number or auto [m], > 0, default "auto"
            maximum length of an ant's walk; auto: three times the volume's length and width
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation
        heuristic: word, goal_scaled, goal, leg, default "goal_scaled"
            eta of a neighbour: 1 over its extra distance to the goal, compared with the nearest
            free neighbour, plus one cell (goal_scaled); 1 over its distance to the goal (goal);
            or 1 over the length of the leg (leg), as published"""
    @overload
    def __call__(self, file: _Path, name: Literal["anya"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), cell_m: _Numbers = [50, 50, 10],
                 corner: Literal["any", "one_free"] = "any", max_memory_mb: _Whole = 4096,
                 **others: NoReturn) -> Step:
        """Anya: the shortest route of any angle on one level of cells, searched by intervals of its lines

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        corner: word, any, one_free, default "any"
            a route may pass between two blocked cells that meet at a corner (any), or one of
            the two cells beside it must be free there (one_free)
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation"""
    @overload
    def __call__(self, file: _Path, name: Literal["astar"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), cell_m: _Numbers = [50, 50, 10],
                 neighbours: _Whole = 26, corner: Literal["any", "free_box"] = "any",
                 moves: Literal["auto", "exact", "cells"] = "auto", heuristic: Literal["octile",
                 "euclidean", "manhattan", "zero"] = "octile", weight_g: _Number = 0.5,
                 weight_h: _Number = 0.5, state: Literal["auto", "parent",
                 "cell_and_heading"] = "auto", weight_length: _Number = 1,
                 weight_altitude: _Number = 0, weight_threat: _Number = 0,
                 accumulate: Literal["length", "none"] = "length", length_unit_m: _Number = 1000,
                 anytime: bool = False, max_memory_mb: _Whole = 4096, costs: Literal["exact",
                 "integer"] = "exact", runs: bool = True, **others: NoReturn) -> Step:
        """A* on a 3-D or level lattice that checks every move, with angle limits and a multi-term cost

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        neighbours: integer, 6 … 26, default 26
            neighbours of a cell: 26 (8 in level flight) or 6 (4 in level flight)
        corner: word, any, free_box, default "any"
            with moves by cells: a step needs its two cells free (any), or every cell of its
            bounding box (free_box)
        moves: word, auto, exact, cells, default "auto"
            how a move is checked against obstacles: the straight leg against the exact world,
            or the cells that it crosses; auto: cells if every layer has its own cells and the
            vehicle needs no clearance, else exact
        heuristic: word, octile, euclidean, manhattan, zero, default "octile"
            estimate of the cost-to-go: octile is the length on an empty lattice; manhattan is
            not admissible with 26 neighbours, nor octile with 6
        weight_g: number, 0 … 1, default 0.5
            weight of the cost-to-come g in f, paper 002 eq. (10)
        weight_h: number, 0 … 1, default 0.5
            weight of the heuristic in f
        state: word, auto, parent, cell_and_heading, default "auto"
            search state for turn limits: a cell with a single parent, which can miss a route,
            or a cell and the direction into it; auto: the second if the first finds nothing
        weight_length: number, 0 … 1000, default 1
            weight w_L of the length in the cost, paper 002 eq. (11)
        weight_altitude: number, 0 … 1000, default 0
            weight w_C of the altitude above sea, eq. (13)
        weight_threat: number, 0 … 1000, default 0
            weight w_T of the sum over threats of 10 / horizontal distance to the centre, eq.
            (14)
        accumulate: word, length, none, default "length"
            altitude and threats count along the whole route (length), or as printed only at the
            node itself (none): they then order the search, but do not choose between paths
        length_unit_m: number [m], 0.001 … 1e+06, default 1000
            unit of lengths, altitudes and distances in the cost
        anytime: true or false, default false
            find a route fast, then better ones, the last as good as without this option
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit: a search ends where it has used it; where memory for the whole lattice
            is taken beforehand, one that needs more is refused
        costs: word, exact, integer, default "exact"
            where cells decide alone: step lengths exact (to 1e-7 on cubes and squares), or in
            the ratios 41 : 58 : 71 on cubes and 70 : 99 on squares, which gives more paths
            equal length (routes up to 0.05 % and 0.006 % longer; on other cells 2.5 %)
        runs: true or false, default true
            where cells decide alone, in space: a straight run beside which nothing changes is
            one step, and its cells are not among those expanded; false: every cell is expanded"""
    @overload
    def __call__(self, file: _Path, name: Literal["bidirectional_astar"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], neighbours: _Whole = 26, corner: Literal["any",
                 "free_box"] = "any", moves: Literal["auto", "exact", "cells"] = "auto",
                 heuristic: Literal["octile", "euclidean", "manhattan", "zero"] = "octile",
                 weight_g: _Number = 0.5, weight_h: _Number = 0.5, state: Literal["auto", "parent",
                 "cell_and_heading"] = "auto", weight_length: _Number = 1,
                 weight_altitude: _Number = 0, weight_threat: _Number = 0,
                 accumulate: Literal["length", "none"] = "length", length_unit_m: _Number = 1000,
                 anytime: bool = False, max_memory_mb: _Whole = 4096, **others: NoReturn) -> Step:
        """A* from both ends simultaneously, with the options of astar

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        neighbours: integer, 6 … 26, default 26
            neighbours of a cell: 26 (8 in level flight) or 6 (4 in level flight)
        corner: word, any, free_box, default "any"
            with moves by cells: a step needs its two cells free (any), or every cell of its
            bounding box (free_box)
        moves: word, auto, exact, cells, default "auto"
            how a move is checked against obstacles: the straight leg against the exact world,
            or the cells that it crosses; auto: cells if every layer has its own cells and the
            vehicle needs no clearance, else exact
        heuristic: word, octile, euclidean, manhattan, zero, default "octile"
            estimate of the cost-to-go: octile is the length on an empty lattice; manhattan is
            not admissible with 26 neighbours, nor octile with 6
        weight_g: number, 0 … 1, default 0.5
            weight of the cost-to-come g in f, paper 002 eq. (10)
        weight_h: number, 0 … 1, default 0.5
            weight of the heuristic in f
        state: word, auto, parent, cell_and_heading, default "auto"
            search state for turn limits: a cell with a single parent, which can miss a route,
            or a cell and the direction into it; auto: the second if the first finds nothing
        weight_length: number, 0 … 1000, default 1
            weight w_L of the length in the cost, paper 002 eq. (11)
        weight_altitude: number, 0 … 1000, default 0
            weight w_C of the altitude above sea, eq. (13)
        weight_threat: number, 0 … 1000, default 0
            weight w_T of the sum over threats of 10 / horizontal distance to the centre, eq.
            (14)
        accumulate: word, length, none, default "length"
            altitude and threats count along the whole route (length), or as printed only at the
            node itself (none): they then order the search, but do not choose between paths
        length_unit_m: number [m], 0.001 … 1e+06, default 1000
            unit of lengths, altitudes and distances in the cost
        anytime: true or false, default false
            find a route fast, then better ones, the last as good as without this option
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit: a search ends where it has used it; where memory for the whole lattice
            is taken beforehand, one that needs more is refused"""
    @overload
    def __call__(self, file: _Path, name: Literal["differential_evolution"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 encoding: Literal["cartesian", "spherical", "spherical_mirrored"] = "cartesian",
                 waypoints: _Whole = 5, reach: _Number = 0.5, above_ground_m: _Numbers = ...,
                 evaluations: _Whole = 5000, rule: Literal["judge", "objective"] = "judge",
                 members: _Whole = 100, factor: _Number = 0.5, crossover: _Number = 0.9,
                 **others: NoReturn) -> Step:
        """differential evolution (DE/rand/1/bin) of whole routes, for any objective

        encoding: word, cartesian, spherical, spherical_mirrored, default "cartesian"
            waypoints by their coordinates (cartesian), or each from the one before by length,
            climb and heading of the leg (spherical); spherical_mirrored exchanges sine and
            cosine of the heading, as the published program does
        waypoints: integer, 1 … 1000, default 5
            number of waypoints between start and goal
        reach: number, > 0, ≤ 1e+06, default 0.5
            cartesian: how far a waypoint may lie to each side of its place on the straight
            line, in distances of start and goal
        above_ground_m: 2 numbers [m]
            minimum and maximum height of waypoints above ground; default: anywhere in the
            volume
        evaluations: integer, 1 … 1e+09, default 5000
            number of routes that are evaluated, if the budget allows
        rule: word, judge, objective, default "judge"
            what makes a route infeasible: the judge's constraints, or only an infinite cost, as
            in papers, whose routes the judge may then reject
        members: integer, 4 … 1e+06, default 100
            size of the population, NP
        factor: number, > 0, ≤ 2, default 0.5
            factor of differences, F
        crossover: number, 0 … 1, default 0.9
            share of numbers that a trial has of its mutant, CR"""
    @overload
    def __call__(self, file: _Path, name: Literal["dstar_lite"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], neighbours: _Whole = 26, corner: Literal["any",
                 "free_box"] = "any", moves: Literal["auto", "exact", "cells"] = "auto",
                 state: Literal["auto", "parent", "cell_and_heading"] = "auto",
                 max_memory_mb: _Whole = 4096, **others: NoReturn) -> Step:
        """D* Lite on a 3-D or level lattice: repairs its plan where the world changes

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        neighbours: integer, 6 … 26, default 26
            neighbours of a cell: 26 (8 in level flight) or 6 (4 in level flight)
        corner: word, any, free_box, default "any"
            with moves by cells: a step needs its two cells free (any), or every cell of its
            bounding box (free_box)
        moves: word, auto, exact, cells, default "auto"
            how a move is checked against obstacles: the straight leg against the exact world,
            or the cells that it crosses; auto: cells if every layer has its own cells and the
            vehicle needs no clearance, else exact
        state: word, auto, parent, cell_and_heading, default "auto"
            where constraints on two consecutive legs (turn limits, constraint plugins) are
            checked: on the shortest path over cells alone (parent), for every direction in
            which a cell is reached (cell_and_heading), or auto: the second if the first
            violates them
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit: a search ends where it has used it; where memory for the whole lattice
            is taken beforehand, one that needs more is refused"""
    @overload
    def __call__(self, file: _Path, name: Literal["genetic"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 encoding: Literal["cartesian", "spherical", "spherical_mirrored"] = "cartesian",
                 waypoints: _Whole = 5, reach: _Number = 0.5, above_ground_m: _Numbers = ...,
                 evaluations: _Whole = 5000, rule: Literal["judge", "objective"] = "judge",
                 members: _Whole = 100, elite: _Whole = 2, crossover: _Number = 0.9,
                 crossover_eta: _Number = 15, mutation_eta: _Number = 20,
                 **others: NoReturn) -> Step:
        """real-coded genetic algorithm over whole routes, for any objective

        encoding: word, cartesian, spherical, spherical_mirrored, default "cartesian"
            waypoints by their coordinates (cartesian), or each from the one before by length,
            climb and heading of the leg (spherical); spherical_mirrored exchanges sine and
            cosine of the heading, as the published program does
        waypoints: integer, 1 … 1000, default 5
            number of waypoints between start and goal
        reach: number, > 0, ≤ 1e+06, default 0.5
            cartesian: how far a waypoint may lie to each side of its place on the straight
            line, in distances of start and goal
        above_ground_m: 2 numbers [m]
            minimum and maximum height of waypoints above ground; default: anywhere in the
            volume
        evaluations: integer, 1 … 1e+09, default 5000
            number of routes that are evaluated, if the budget allows
        rule: word, judge, objective, default "judge"
            what makes a route infeasible: the judge's constraints, or only an infinite cost, as
            in papers, whose routes the judge may then reject
        members: integer, 2 … 1e+06, default 100
            size of the population
        elite: integer, 0 … 1e+06, default 2
            number of the best that live on unchanged
        crossover: number, 0 … 1, default 0.9
            probability that two parents are crossed over
        crossover_eta: number, 0 … 1000, default 15
            distribution index of the crossover: the larger, the nearer children are to parents
        mutation_eta: number, 0 … 1000, default 20
            distribution index of the mutation, likewise"""
    @overload
    def __call__(self, file: _Path, name: Literal["grey_wolf"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 encoding: Literal["cartesian", "spherical", "spherical_mirrored"] = "cartesian",
                 waypoints: _Whole = 5, reach: _Number = 0.5, above_ground_m: _Numbers = ...,
                 evaluations: _Whole = 5000, rule: Literal["judge", "objective"] = "judge",
                 wolves: _Whole = 30, **others: NoReturn) -> Step:
        """grey wolf optimiser over whole routes, for any objective

        encoding: word, cartesian, spherical, spherical_mirrored, default "cartesian"
            waypoints by their coordinates (cartesian), or each from the one before by length,
            climb and heading of the leg (spherical); spherical_mirrored exchanges sine and
            cosine of the heading, as the published program does
        waypoints: integer, 1 … 1000, default 5
            number of waypoints between start and goal
        reach: number, > 0, ≤ 1e+06, default 0.5
            cartesian: how far a waypoint may lie to each side of its place on the straight
            line, in distances of start and goal
        above_ground_m: 2 numbers [m]
            minimum and maximum height of waypoints above ground; default: anywhere in the
            volume
        evaluations: integer, 1 … 1e+09, default 5000
            number of routes that are evaluated, if the budget allows
        rule: word, judge, objective, default "judge"
            what makes a route infeasible: the judge's constraints, or only an infinite cost, as
            in papers, whose routes the judge may then reject
        wolves: integer, 3 … 1e+06, default 30
            size of the pack"""
    @overload
    def __call__(self, file: _Path, name: Literal["hybrid_astar"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 radius_m: Union[_Number, Literal["auto"]] = "auto", cell_m: Union[_Number,
                 Literal["auto"]] = "auto", cell_height_m: Union[_Number, Literal["auto"]] = "auto",
                 headings: _Whole = 16, weight_h: _Number = 1.2, max_memory_mb: _Whole = 2048,
                 **others: NoReturn) -> Step:
        """Hybrid A*: curved legs between poses, searched by position, height and heading

        radius_m: number or auto [m], > 0, default "auto"
            radius of turns; auto: the smallest that vehicle and constraints allow, else one
            cell
        cell_m: number or auto [m], > 0, default "auto"
            horizontal cell edge length; auto: half the radius, or 1/200 of the volume without a
            limit on turns
        cell_height_m: number or auto [m], > 0, default "auto"
            height of a cell; auto: half the climb of a leg at the limit
        headings: integer, 4 … 128, default 16
            headings distinguished in a cell
        weight_h: number, 1 … 100, default 1.2
            weight of h: more finds a route sooner, up to that factor longer
        max_memory_mb: integer [MB], 1 … 2147483647, default 2048
            memory limit of the search"""
    @overload
    def __call__(self, file: _Path, name: Literal["improved_ant_colony"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], ants: _Whole = 100, iterations: _Whole = 100,
                 deposit_q: _Number = 2000, initial_pheromone: _Number = 2, alpha: _Number = 6,
                 beta: _Number = 3, evaporation: _Number = 0.6, max_length_m: Union[_Number,
                 Literal["auto"]] = "auto", max_memory_mb: _Whole = 4096, reach_cells: _Whole = 8,
                 min_steps: _Whole = ..., spacing_cells: _Whole = 2, leg_test: Literal["remembered",
                 "guard_zone", "always"] = "remembered", tilt: _Number = 0.5,
                 region_radius: _Whole = 2, region_decay: _Number = 0.5,
                 heuristic: Literal["euclidean", "geodesic"] = "euclidean", trim: bool = True,
                 longest_stride: _Whole = 10, shortest_stride: _Whole = 4, decay: _Number = 0.8,
                 deposit: Literal["resampled", "cells", "nodes"] = "resampled",
                 **others: NoReturn) -> Step:
        """ant colony with wide steps, regional pheromone and trimmed routes, paper 004

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        ants: integer, 1 … 1e+06, default 100
            number of ants in the colony
        iterations: integer, 1 … 1e+06, default 100
            number of iterations, in each of which every ant walks once; all are run if the
            budget allows
        deposit_q: number, 1e-09 … 1e+09, default 2000
            Q of eq. (2): an ant deposits Q divided by the metres of its route, or by its cost
            in metres that cost the same on the first routes
        initial_pheromone: number, 1e-09 … 1e+09, default 2
            initial tau everywhere
        alpha: number, 0 … 20, default 6
            exponent of the pheromone in eq. (1)
        beta: number, 0 … 20, default 3
            exponent of the heuristic in eq. (1)
        evaporation: number, 0 … 1, default 0.6
            rho of eq. (4): fraction of the pheromone that evaporates in each iteration
        max_length_m: number or auto [m], > 0, default "auto"
            maximum length of an ant's walk; auto: three times the volume's length and width
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation
        reach_cells: integer, 1 … 1000, default 8
            l_c: a step leads to the border of the square of this half-width around the ant
        min_steps: integer, 1 … 1e+06
            N_c of eq. (6): steps from start to goal in open air, in place of reach_cells
        spacing_cells: integer, 0 … 1000, default 2
            l_s: cells skipped between candidates, from each corner to the middle of a side
        leg_test: word, remembered, guard_zone, always, default "remembered"
            when legs are tested against the cells: every time (always); only near blocked cells
            (guard_zone); there, and once per plan (remembered); the route is the same
        tilt: number, 0 … 0.999, default 0.5
            C of eq. (8): candidates below this fraction of the range of eta are excluded; 0:
            none
        region_radius: integer, 0 … 20, default 2
            r of eq. (10): rings of cells whose pheromone counts; 0: only the cell's own
        region_decay: number, 0 … 1, default 0.5
            mu of eq. (10): decay from ring to ring
        heuristic: word, euclidean, geodesic, default "euclidean"
            eta is 1 over the distance to the goal: the straight line, eq. (9), or over the free
            cells (geodesic)
        trim: true or false, default true
            trim routes before pheromone is deposited, eq. (11)
        longest_stride: integer, 2 … 1e+05, default 10
            stride of the first round in nodes, paper 004 l_c,max
        shortest_stride: integer, 2 … 1e+05, default 4
            minimum stride, paper 004 l_c,min
        decay: number, 0.01 … 0.99, default 0.8
            factor of the stride from round to round, sigma of eq. (11)
        deposit: word, resampled, cells, nodes, default "resampled"
            where pheromone is deposited: every reach_cells along the legs, on every cell of
            them, or on the nodes alone"""
    @overload
    def __call__(self, file: _Path, name: Literal["informed_rrt_star"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 range_m: Union[_Number, Literal["auto"]] = "auto", goal_bias: _Number = 0.05,
                 route_bias: _Number = 0.25, radius_scale: _Number = 1.1,
                 max_iterations: _Whole = 20000, steering: Literal["auto", "straight",
                 "dubins"] = "auto", radius_m: Union[_Number, Literal["auto"]] = "auto",
                 **others: NoReturn) -> Step:
        """Informed RRT*: RRT* that samples only where a shorter route may lie

        range_m: number or auto [m], > 0, default "auto"
            maximum length of the tree's edges; auto: a tenth of the volume's diagonal, with
            turns at least a circle
        goal_bias: number, 0 … 1, default 0.05
            probability of sampling the goal, until it is in the tree
        route_bias: number, 0 … 0.9, default 0.25
            probability of sampling near a point of the best route, once there is one
        radius_scale: number, 1 … 10, default 1.1
            neighbour radius relative to the smallest one with which the length converges
        max_iterations: integer, 1 … 2147483647, default 20000
            number of samples; all are used if the budget allows
        steering: word, auto, straight, dubins, default "auto"
            how nodes are joined: by straight legs, or as poses by Dubins paths, which takes a
            turn radius; auto: dubins for a vehicle with a wing
        radius_m: number or auto [m], > 0, default "auto"
            radius of turns; auto: the smallest that vehicle and constraints allow"""
    @overload
    def __call__(self, file: _Path, name: Literal["jps"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), cell_m: _Numbers = [50, 50, 10],
                 corner: Literal["any", "free_box"] = "any", costs: Literal["exact",
                 "integer"] = "exact", max_memory_mb: _Whole = 4096, **others: NoReturn) -> Step:
        """jump point search on one level of cells, scanning many cells at once

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        corner: word, any, free_box, default "any"
            a diagonal step requires its two cells to be free (any), or also the two beside it
            (free_box)
        costs: word, exact, integer, default "exact"
            costs of straight and diagonal steps: as fine as 28 bits allow for the length of a
            path, or, on square cells, 70 to 99, which makes routes at most 1e-4 longer than the
            shortest
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation"""
    @overload
    def __call__(self, file: _Path, name: Literal["lazy_theta_star"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], angle_rule: Literal["printed", "route_consistent",
                 "complete"] = "complete", max_memory_mb: _Whole = 4096,
                 **others: NoReturn) -> Step:
        """Lazy Theta*: straight legs between cells that see each other, each checked when its end is expanded

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        angle_rule: word, printed, route_consistent, complete, default "complete"
            check of the limits on turns and climb during expansion: for the step, not for the
            leg taken (printed, paper 003); for that leg, and again when its end is expanded
            (route_consistent); or the same and, if that finds nothing, an A* search over cell
            and heading, whose steps may touch edges (complete)
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation"""
    @overload
    def __call__(self, file: _Path, name: Literal["nsga2"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), encoding: Literal["cartesian", "spherical",
                 "spherical_mirrored"] = "cartesian", waypoints: _Whole = 5, reach: _Number = 0.5,
                 above_ground_m: _Numbers = ..., evaluations: _Whole = 5000, rule: Literal["judge",
                 "objective"] = "judge", members: _Whole = 100, crossover: _Number = 0.9,
                 crossover_eta: _Number = 15, mutation_eta: _Number = 20,
                 **others: NoReturn) -> Step:
        """NSGA-II: compromises between the terms of an objective, over whole routes

        encoding: word, cartesian, spherical, spherical_mirrored, default "cartesian"
            waypoints by their coordinates (cartesian), or each from the one before by length,
            climb and heading of the leg (spherical); spherical_mirrored exchanges sine and
            cosine of the heading, as the published program does
        waypoints: integer, 1 … 1000, default 5
            number of waypoints between start and goal
        reach: number, > 0, ≤ 1e+06, default 0.5
            cartesian: how far a waypoint may lie to each side of its place on the straight
            line, in distances of start and goal
        above_ground_m: 2 numbers [m]
            minimum and maximum height of waypoints above ground; default: anywhere in the
            volume
        evaluations: integer, 1 … 1e+09, default 5000
            number of routes that are evaluated, if the budget allows
        rule: word, judge, objective, default "judge"
            what makes a route infeasible: the judge's constraints, or only an infinite cost, as
            in papers, whose routes the judge may then reject
        members: integer, 4 … 1e+05, default 100
            size of the population
        crossover: number, 0 … 1, default 0.9
            probability that two parents are crossed over
        crossover_eta: number, 0 … 1000, default 15
            distribution index of the crossover: the larger, the nearer children are to parents
        mutation_eta: number, 0 … 1000, default 20
            distribution index of the mutation, likewise"""
    @overload
    def __call__(self, file: _Path, name: Literal["ompl"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), planner: Literal["ABITstar", "AITstar", "BFMT",
                 "BITstar", "BKPIECE1", "BiEST", "BiTRRT", "EST", "FMT", "InformedRRTstar",
                 "KPIECE1", "LBKPIECE1", "LazyPRM", "LazyRRT", "PDST", "PRM", "PRMstar", "ProjEST",
                 "RRT", "RRTConnect", "RRTXstatic", "RRTsharp", "RRTstar", "SBL", "SORRTstar",
                 "STRIDE", "TRRT"] = "RRTConnect", range_m: Union[_Number,
                 Literal["auto"]] = "auto", parameters: Any = {}, max_iterations: _Whole = 100000,
                 **others: NoReturn) -> Step:
        """a geometric planner of the Open Motion Planning Library, selected by name

        planner: word, ABITstar, AITstar, BFMT, BITstar, BKPIECE1, BiEST, BiTRRT, EST, FMT,
          InformedRRTstar, KPIECE1, LBKPIECE1, LazyPRM, LazyRRT, PDST, PRM, PRMstar, ProjEST,
          RRT, RRTConnect, RRTXstatic, RRTsharp, RRTstar, SBL, SORRTstar, STRIDE, TRRT, default
          "RRTConnect"
            OMPL's name of the planner
        range_m: number or auto [m], > 0, default "auto"
            maximum extension of the planner's tree, its parameter range; auto: OMPL's default
        parameters: any, default {}
            the planner's other parameters: a map from their OMPL names to values
        max_iterations: integer, ≥ 1, default 100000
            maximum number of queries by the planner; one that keeps improving its route stops
            there"""
    @overload
    def __call__(self, file: _Path, name: Literal["pso"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), encoding: Literal["cartesian", "spherical",
                 "spherical_mirrored"] = "cartesian", waypoints: _Whole = 5, reach: _Number = 0.5,
                 above_ground_m: _Numbers = ..., evaluations: _Whole = 5000, rule: Literal["judge",
                 "objective"] = "judge", particles: _Whole = 50, inertia: _Number = 0.7298,
                 damping: _Number = 1, own_pull: _Number = 1.49618, common_pull: _Number = 1.49618,
                 max_velocity: _Number = 0.5, **others: NoReturn) -> Step:
        """particle swarm over whole routes, for any objective

        encoding: word, cartesian, spherical, spherical_mirrored, default "cartesian"
            waypoints by their coordinates (cartesian), or each from the one before by length,
            climb and heading of the leg (spherical); spherical_mirrored exchanges sine and
            cosine of the heading, as the published program does
        waypoints: integer, 1 … 1000, default 5
            number of waypoints between start and goal
        reach: number, > 0, ≤ 1e+06, default 0.5
            cartesian: how far a waypoint may lie to each side of its place on the straight
            line, in distances of start and goal
        above_ground_m: 2 numbers [m]
            minimum and maximum height of waypoints above ground; default: anywhere in the
            volume
        evaluations: integer, 1 … 1e+09, default 5000
            number of routes that are evaluated, if the budget allows
        rule: word, judge, objective, default "judge"
            what makes a route infeasible: the judge's constraints, or only an infinite cost, as
            in papers, whose routes the judge may then reject
        particles: integer, 1 … 1e+06, default 50
            number of particles, N
        inertia: number, 0 … 1, default 0.7298
            fraction of its velocity that a particle keeps, w
        damping: number, > 0, ≤ 1, default 1
            factor of the inertia after each iteration
        own_pull: number, 0 … 4, default 1.49618
            attraction to the particle's own best position, c1
        common_pull: number, 0 … 4, default 1.49618
            attraction to the global best position, c2
        max_velocity: number, > 0, ≤ 1, default 0.5
            maximum step on each dimension, as a fraction of its range"""
    @overload
    def __call__(self, file: _Path, name: Literal["rrt"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), step_m: Union[_Number,
                 Literal["auto"]] = "auto", weight_random: _Number = 1, weight_goal: _Number = 1,
                 random_share: _Number = 0.5, goal_bias: _Number = 0, toward_goal_once: bool = True,
                 max_failures: _Whole = 50, max_iterations: _Whole = 100000,
                 cut_off: Literal["drop", "reconnect", "afresh"] = "reconnect",
                 steering: Literal["auto", "straight", "dubins"] = "auto", radius_m: Union[_Number,
                 Literal["auto"]] = "auto", **others: NoReturn) -> Step:
        """RRT with a goal heuristic under flight constraints and a tree that persists between plans

        step_m: number or auto [m], ≥ 0.001, default "auto"
            L, length of a leg; auto: a hundredth of the volume's diagonal, within the limits on
            leg length
        weight_random: number, 0 … 1000, default 1
            w_1: the node with the minimum w_1 |q - q_rand| + w_2 |q - goal| is extended
        weight_goal: number, 0 … 1000, default 1
            w_2; 0 with w_1 = 1 is the basic tree
        random_share: number, 0 … 1, default 0.5
            p: fraction of extensions toward q_rand, the others go toward the goal; 1: basic
        goal_bias: number, 0 … 1, default 0
            probability of sampling the goal as q_rand
        toward_goal_once: true or false, default true
            extend a node toward the goal only once
        max_failures: integer, 0 … 60000, default 50
            failed extensions after which a node rests until all others rest too; 0: never
        max_iterations: integer, 1 … 2147483647, default 100000
            maximum number of extensions
        cut_off: word, drop, reconnect, afresh, default "reconnect"
            branches that a change cuts off are removed (drop), or reconnected when the tree
            grows near them (reconnect); afresh removes the whole tree, for comparison
        steering: word, auto, straight, dubins, default "auto"
            how nodes are joined: by straight legs, or as poses by Dubins paths, which takes a
            turn radius; auto: dubins for a vehicle with a wing
        radius_m: number or auto [m], > 0, default "auto"
            radius of turns; auto: the smallest that vehicle and constraints allow"""
    @overload
    def __call__(self, file: _Path, name: Literal["rrt_connect"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 range_m: Union[_Number, Literal["auto"]] = "auto", max_iterations: _Whole = 100000,
                 steering: Literal["auto", "straight", "dubins"] = "auto", radius_m: Union[_Number,
                 Literal["auto"]] = "auto", **others: NoReturn) -> Step:
        """RRT-Connect: random trees from both ends that grow toward each other

        range_m: number or auto [m], > 0, default "auto"
            longest edge by which a tree grows; auto: a tenth of the volume's diagonal, with
            turns at least a circle
        max_iterations: integer, 1 … 2147483647, default 100000
            maximum number of edges tried
        steering: word, auto, straight, dubins, default "auto"
            how nodes are joined: by straight legs, or as poses by Dubins paths, which takes a
            turn radius; auto: dubins for a vehicle with a wing
        radius_m: number or auto [m], > 0, default "auto"
            radius of turns; auto: the smallest that vehicle and constraints allow"""
    @overload
    def __call__(self, file: _Path, name: Literal["rrt_star"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 range_m: Union[_Number, Literal["auto"]] = "auto", goal_bias: _Number = 0.05,
                 route_bias: _Number = 0.25, radius_scale: _Number = 1.1,
                 max_iterations: _Whole = 20000, steering: Literal["auto", "straight",
                 "dubins"] = "auto", radius_m: Union[_Number, Literal["auto"]] = "auto",
                 bound: bool = True, **others: NoReturn) -> Step:
        """RRT*: asymptotically optimal, rewires as it grows

        range_m: number or auto [m], > 0, default "auto"
            maximum length of the tree's edges; auto: a tenth of the volume's diagonal, with
            turns at least a circle
        goal_bias: number, 0 … 1, default 0.05
            probability of sampling the goal, until it is in the tree
        route_bias: number, 0 … 0.9, default 0.25
            probability of sampling near a point of the best route, once there is one
        radius_scale: number, 1 … 10, default 1.1
            neighbour radius relative to the smallest one with which the length converges
        max_iterations: integer, 1 … 2147483647, default 20000
            number of samples; all are used if the budget allows
        steering: word, auto, straight, dubins, default "auto"
            how nodes are joined: by straight legs, or as poses by Dubins paths, which takes a
            turn radius; auto: dubins for a vehicle with a wing
        radius_m: number or auto [m], > 0, default "auto"
            radius of turns; auto: the smallest that vehicle and constraints allow
        bound: true or false, default true
            once there is a route, reject samples through which none can be shorter"""
    @overload
    def __call__(self, file: _Path, name: Literal["sipp"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), cell_m: _Numbers = [50, 50, 10],
                 max_memory_mb: _Whole = 4096, **others: NoReturn) -> Step:
        """safe-interval path planning: the earliest arrival among moving obstacles, with waits

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit: a search ends where it has used it; where memory for the whole lattice
            is taken beforehand, one that needs more is refused"""
    @overload
    def __call__(self, file: _Path, name: Literal["spatial_slicing"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], axis: Literal["x", "y", "z", "auto"] = "x",
                 plane_cells: _Whole = 1, max_memory_mb: _Whole = 4096, **others: NoReturn) -> Step:
        """slices the volume into planes toward the goal and moves each plane's point around obstacles

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        axis: word, x, y, z, auto, default "x"
            axis perpendicular to the planes; auto: the axis on which start and goal lie
            farthest apart
        plane_cells: integer, 1 … 1e+06, default 1
            spacing of the planes in cells
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation"""
    @overload
    def __call__(self, file: _Path, name: Literal["spso"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), encoding: Literal["cartesian", "spherical",
                 "spherical_mirrored"] = "spherical", waypoints: _Whole = 5, reach: _Number = 0.5,
                 above_ground_m: _Numbers = ..., evaluations: _Whole = 5000, rule: Literal["judge",
                 "objective"] = "judge", particles: _Whole = 50, inertia: _Number = 1,
                 damping: _Number = 0.98, own_pull: _Number = 1.5, common_pull: _Number = 1.5,
                 max_velocity: _Number = 0.5, **others: NoReturn) -> Step:
        """particle swarm over lengths, climbs and headings of legs (spherical vectors)

        encoding: word, cartesian, spherical, spherical_mirrored, default "spherical"
            waypoints by their coordinates (cartesian), or each from the one before by length,
            climb and heading of the leg (spherical); spherical_mirrored exchanges sine and
            cosine of the heading, as the published program does
        waypoints: integer, 1 … 1000, default 5
            number of waypoints between start and goal
        reach: number, > 0, ≤ 1e+06, default 0.5
            cartesian: how far a waypoint may lie to each side of its place on the straight
            line, in distances of start and goal
        above_ground_m: 2 numbers [m]
            minimum and maximum height of waypoints above ground; default: anywhere in the
            volume
        evaluations: integer, 1 … 1e+09, default 5000
            number of routes that are evaluated, if the budget allows
        rule: word, judge, objective, default "judge"
            what makes a route infeasible: the judge's constraints, or only an infinite cost, as
            in papers, whose routes the judge may then reject
        particles: integer, 1 … 1e+06, default 50
            number of particles, N
        inertia: number, 0 … 1, default 1
            fraction of its velocity that a particle keeps, w
        damping: number, > 0, ≤ 1, default 0.98
            factor of the inertia after each iteration
        own_pull: number, 0 … 4, default 1.5
            attraction to the particle's own best position, c1
        common_pull: number, 0 … 4, default 1.5
            attraction to the global best position, c2
        max_velocity: number, > 0, ≤ 1, default 0.5
            maximum step on each dimension, as a fraction of its range"""
    @overload
    def __call__(self, file: _Path, name: Literal["stratified_theta"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], angle_rule: Literal["printed", "route_consistent",
                 "complete"] = "route_consistent", max_memory_mb: _Whole = 4096,
                 p_max: _Number = 0.25, d_limit_m: _Number = 140, start_levels: _Whole = 1,
                 refine: Literal["successors", "corridor"] = "successors",
                 **others: NoReturn) -> Step:
        """Stratified Lazy Theta* (SS-LT*): plans a coarse route and refines it level by level

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        angle_rule: word, printed, route_consistent, complete, default "route_consistent"
            check of the limits on turns and climb during expansion: for the step, not for the
            leg taken (printed, paper 003); for that leg, and again when its end is expanded
            (route_consistent); or the same and, if that finds nothing, an A* search over cell
            and heading, whose steps may touch edges (complete)
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation
        p_max: number, 0 … 1, default 0.25
            planning starts at the lowest level where more than this share of the blocks is
            fully free or fully blocked, eq. (5)
        d_limit_m: number [m], ≥ 0, default 140
            maximum distance to the goal at which a straight leg is tried first
        start_levels: integer, 1 … 30, default 1
            number of start levels from that one on; the shortest route is kept
        refine: word, successors, corridor, default "successors"
            refine a route level by level in the nodes along it and their neighbours, or at once
            in the cells around a path over blocks of 8 cells, which needs no levels"""
    @overload
    def __call__(self, file: _Path, name: Literal["taut"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), cell_m: _Numbers = [50, 50, 10],
                 gap: _Number = 0.001, max_memory_mb: _Whole = 4096, **others: NoReturn) -> Step:
        """a route pulled taut around closed cells, and how much longer than the shortest of all it is at most

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        gap: number, ≥ 0, default 0.001
            how much longer than the bound the route may be, as a fraction: the search ends
            there
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation"""
    @overload
    def __call__(self, file: _Path, name: Literal["theta_star"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 cell_m: _Numbers = [50, 50, 10], angle_rule: Literal["printed", "route_consistent",
                 "complete"] = "complete", max_memory_mb: _Whole = 4096,
                 **others: NoReturn) -> Step:
        """Theta*: straight legs between cells that see each other, each checked when it is found

        cell_m: 3 numbers [m], ≥ 0.001, default [50, 50, 10]
            cell edge length on each axis; a layer with its own cells overrides it
        angle_rule: word, printed, route_consistent, complete, default "complete"
            check of the limits on turns and climb during expansion: for the step, not for the
            leg taken (printed, paper 003); for that leg, and again when its end is expanded
            (route_consistent); or the same and, if that finds nothing, an A* search over cell
            and heading, whose steps may touch edges (complete)
        max_memory_mb: integer [MB], 1 … 2147483647, default 4096
            memory limit of the lattice; a larger one is refused before allocation"""
    @overload
    def __call__(self, file: _Path, name: Literal["apf"], /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), variant: Literal["plain", "modified",
                 "improved"] = "improved", influence_m: _Number = 3000,
                 ground_influence_m: Union[_Number, Literal["auto"]] = "auto",
                 target_m: Union[_Number, Literal["auto"]] = "auto", attraction: _Number = 43,
                 repulsion: _Number = 5, length_unit_m: Union[_Number, Literal["auto"]] = "auto",
                 goal_exponent: _Number = 2, turned_repulsion: bool = True,
                 small_angle_deg: _Number = 10, stronger_goal: bool = True,
                 goal_factor: _Number = 3, goal_zone_m: Union[_Number, Literal["auto"]] = "auto",
                 two_steps: bool = True, step_far_m: Union[_Number, Literal["auto"]] = "auto",
                 step_near_m: Union[_Number, Literal["auto"]] = "auto", reaction_s: _Number = 10,
                 turn_limit: bool = True, max_turn_deg: _Number = 30, side: Literal["field",
                 "predicted"] = "predicted", **others: NoReturn) -> Step:
        """artificial potential field with four repairs, in 3-D

        variant: word, plain, modified, improved, default "improved"
            the bare field (plain), the repulsion that fades toward the goal (modified), or the
            four repairs (improved)
        influence_m: number [m], 0.001 … 1e+09, default 3000
            d_0: obstacles farther away have no effect; the host hands over within it
        ground_influence_m: number or auto [m], 0.001 … 1e+09, default "auto"
            d_0 for ground, above the ground clearance; auto: a tenth of influence_m
        target_m: number or auto [m], 0.001 … 1e+09, default "auto"
            a target farther away is moved in to this distance; auto: 2/3 of influence_m
        attraction: number, 0 … 1e+09, default 43
            k_a, for distances in length_unit_m
        repulsion: number, 0 … 1e+09, default 5
            k_r, for distances in length_unit_m
        length_unit_m: number or auto [m], 0.001 … 1e+09, default "auto"
            unit of length of the gains; auto: a third of influence_m (1 km for 3 km)
        goal_exponent: number, 1 … 8, default 2
            m of the modified repulsion, scaled by (distance to goal / start to goal)^m
        turned_repulsion: true or false, default true
            repair 1: rotate the repulsion of obstacles in front of the target by 45 degrees
        small_angle_deg: number [deg], 0 … 90, default 10
            rotate if the bearings of obstacle and target differ by less than this
        stronger_goal: true or false, default true
            repair 2: stronger attraction near the goal
        goal_factor: number, 1 … 1e+06, default 3
            factor of the attraction near the goal
        goal_zone_m: number or auto [m], 0.001 … 1e+09, default "auto"
            distance that counts as near the goal; auto: influence_m
        two_steps: true or false, default true
            repair 3: use step_far_m while the nearest edge is more than reaction_s away
        step_far_m: number or auto [m], 0.001 … 1e+09, default "auto"
            L1; auto: influence_m / 6; never more than the distance flown in the host's time
            step
        step_near_m: number or auto [m], 0.001 … 1e+09, default "auto"
            L2; auto: influence_m / 30
        reaction_s: number [s], ≥ 0, default 10
            reaction time; lookahead for paths and moving obstacles
        turn_limit: true or false, default true
            repair 4: no turn above max_turn_deg, except for safety
        max_turn_deg: number [deg], 1 … 180, default 30
            alpha_2, per step, in 3-D
        side: word, field, predicted, default "predicted"
            side on which to pass obstacles in front of the target: by the field's push alone,
            or the one predicted to reach the target sooner, kept until passed"""
    @overload
    def __call__(self, file: _Path, name: Literal["velocity_field"], /, start: Any = None,
                 goal: Any = None, seed: int = 0, within_s: Optional[float] = None, *,
                 set: Mapping[str, Any] = {}, plugin_path: Sequence[_Path] = (),
                 variant: Literal["paper", "robust"] = "paper", pull_weight: _Number = 1,
                 edge_ratio: _Number = 0.05, surface_ratio: _Number = 10, ring_m: _Number = 2000,
                 guide_ratio: _Number = 1, step_s: _Number = 1, min_turn_radius_m: Union[_Number,
                 Literal["auto"]] = 500, min_speed_mps: _Number = ..., max_bank_deg: _Number = ...,
                 release_m: _Number = 100, toward: Literal["goal", "route"] = "goal",
                 terrain: Literal["ignore", "sections"] = "ignore", max_climb_deg: _Number = 15,
                 detour_m: _Number = 5000, section_cell_m: Union[_Number, Literal["auto"]] = "auto",
                 max_steps: _Whole = 40000, **others: NoReturn) -> Step:
        """velocity vector field around discs in level flight, with virtual targets

        variant: word, paper, robust, default "paper"
            paper: the method as published; robust: along a guide, never without an escape path
        pull_weight: number, 0 … 1e+09, default 1
            omega: speed toward the target
        edge_ratio: number, > 0, ≤ 1e+09, default 0.05
            alpha: push at the outer edge of a threat's ring, as a multiple of the pull
        surface_ratio: number, > 0, ≤ 1e+09, default 10
            beta: push at a threat's edge, as a multiple of the pull
        ring_m: number [m], 0.001 … 1e+09, default 2000
            Delta R: width of the ring around a threat in which it acts
        guide_ratio: number, 0 … 1e+09, default 1
            epsilon: speed alongside a threat, toward the target, as a multiple of its push
        step_s: number [s], 0.001 … 1e+06, default 1
            Delta T: duration of a step; never more than the host's
        min_turn_radius_m: number or auto [m], 0.001 … 1e+09, default 500
            R_min: the heading changes by at most 2 asin(v Delta T / (2 R_min)) per step; auto:
            min_speed_mps^2 / (g tan(max_bank_deg))
        min_speed_mps: number [m/s], 0.001 … 1e+06
            V_min, minimum level speed
        max_bank_deg: number [deg], 0.1 … 89
            gamma_max, maximum bank angle
        release_m: number [m], 0.001 … 1e+09, default 100
            distance at which a virtual target counts as reached
        toward: word, goal, route, default "goal"
            source of the attraction: the goal, as published, or the point at which the flight
            rejoins the route
        terrain: word, ignore, sections, default "ignore"
            ignore: ground is ignored, as published; sections: fly around ground higher than the
            flight, or over it if there is no path around
        max_climb_deg: number [deg], 0.1 … 80, default 15
            terrain: maximum climb and descent angle
        detour_m: number [m], 1 … 1e+09, default 5000
            terrain: climb after flying around ground for this distance without getting closer
            by a tenth of it
        section_cell_m: number or auto [m], 0.1 … 1e+06, default "auto"
            terrain: edge of the cells that sample the ground; auto: the volume's longer side /
            512
        max_steps: integer, 1 … 1e+06, default 40000
            number of steps after which the pilot gives up"""
    @overload  # type: ignore[misc]
    def __call__(self, file: _Path, name: Literal["ant_colony", "anya", "astar",
                 "bidirectional_astar", "differential_evolution", "dstar_lite", "genetic",
                 "grey_wolf", "hybrid_astar", "improved_ant_colony", "informed_rrt_star", "jps",
                 "lazy_theta_star", "nsga2", "ompl", "pso", "rrt", "rrt_connect", "rrt_star",
                 "sipp", "spatial_slicing", "spso", "stratified_theta", "taut", "theta_star", "apf",
                 "velocity_field"], /, start: Any = None, goal: Any = None, seed: int = 0,
                 within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), **parameters: Any) -> RefusedParameters: ...
    @overload
    def __call__(self, file: _Path, name: str, /, start: Any = None, goal: Any = None,
                 seed: int = 0, within_s: Optional[float] = None, *, set: Mapping[str, Any] = {},
                 plugin_path: Sequence[_Path] = (), **parameters: Any) -> Step:
        """Plans one route with a planner in a scenario, or in that of a pipeline under its constraints.

        `start` and `goal` replace those of the scenario with all of their keys: [x, y, z] in metres of
        its frame, or a dict such as {"at_m": [4000, 6000], "above_ground_m": 80, "tolerance_m": 5}.
        `parameters` are the planner's, checked as in a file; `within_s` is its time budget (s). Returns
        the Step: its `route` is the planner's, `accepted` and `check` tell what the judge holds of it.
        Raises as `run`."""

def typed(plan: Callable[..., Step]) -> Plan: ...
