// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "planner_bench.hpp"

namespace altiplan::conformance {
namespace {

constexpr const char* kComplete =
    "Planner trait `complete`: finds a route of its search space whenever there is one";
constexpr const char* kOptimal = "Planner trait `optimal`: finds the shortest route of its lattice";
constexpr const char* kAnyAngle =
    "Planner trait `any_angle`: never longer than the grid's shortest";
constexpr const char* kAnytime = "Planner trait `anytime`: more budget never gives a longer route";
constexpr const char* kProved =
    "Planner contract 3: no_route is `proved` only where the planner's search space holds no route";

constexpr Lanes kFewest{6, true};
constexpr Lanes kMaxLanes{26, false};

/// Cells to search, hand-made and random.
std::vector<Scene> mazes(const PlannerBench& bench) {
  const double unit = bench.options.unit_m;
  std::vector<Scene> all;
  for (const Flight flight : bench.flights()) {
    all.push_back(cell_scene(unit, "a corridor of one cell, bent",
                             {"S........./####.#####/####..####/#####.####/.........G"}, flight));
    all.push_back(cell_scene(unit, "a goal walled in",
                             {"S........./......####/......#..#/......#.G#/......####"}, flight));
    all.push_back(cell_scene(unit, "an enclosed start",
                             {"S#......../##......../........../........../.........G"}, flight));
    all.push_back(cell_scene(unit, "cells that meet in a corner only",
                             {"S..#....../...#....../..#......./###......./.........G"}, flight));
    if (flight == Flight::spatial) {
      all.push_back(cell_scene(
          unit, "a shaft of one cell between two floors",
          {"S..../...../.....", "#####/###.#/#####", "#####/###.#/#####", "...../...../G...."},
          flight));
      all.push_back(cell_scene(unit, "two floors apart",
                               {"S..../...../.....", "#####/#####/#####", "...../...../G...."},
                               flight));
    }
    for (int n = 0; n < 4 * bench.options.rounds; ++n) {
      all.push_back(bench.cells(100 + std::uint64_t(n), flight));
    }
  }
  for (Scene& scene : all) {
    scene = bench.budgeted(std::move(scene));
  }
  return all;
}

void complete(const PlannerBench& bench, Report& report) {
  const auto planner = bench.make();
  const bool claims = planner->traits().complete;
  for (const Scene& scene : mazes(bench)) {
    const PlanResult result = planner->plan(scene.request);
    const bool solved = judge(report, result, scene);
    const bool surely_open = shortest(scene, kFewest) < kInfinity;
    report.expect(!surely_open || !result.proved, kProved, [&] {
      return scene.name + ": there is a route, the planner returned " + text(result);
    });
    if (!claims || result.budget_hit) {
      continue;
    }
    report.expect(!surely_open || solved, kComplete, [&] {
      return scene.name + ": there is a route, the planner returned " + text(result);
    });
    if (shortest(scene, kMaxLanes) == kInfinity) {
      report.expect(result.status == PlanStatus::no_route, kComplete, [&] {
        return scene.name + ": expected no_route, the planner returned " + text(result);
      });
    }
  }
  for (const Flight flight : bench.flights()) {
    const Scene open = bench.budgeted(open_scene(bench.options.unit_m, flight));
    const PlanResult result = planner->plan(open.request);
    report.expect(!claims || result.status == PlanStatus::solved || result.budget_hit, kComplete,
                  [&] { return open.name + ": the planner returned " + text(result); });
  }
}

/// A planner need not declare its lattice: in every world its length must be the optimum of the
/// same one.
void optimal(const PlannerBench& bench, Report& report) {
  const auto planner = bench.make();
  const Traits traits = planner->traits();
  if (!traits.optimal) {
    return;
  }
  const Lanes kinds[] = {{6, false}, {26, false}, {26, true}};
  std::vector<std::string> differs(std::size(kinds));
  for (const Scene& scene : mazes(bench)) {
    const PlanResult result = planner->plan(scene.request);
    const double found = result.status == PlanStatus::solved ? length(result.route) : kInfinity;
    if (result.budget_hit) {
      continue;
    }
    for (std::size_t i = 0; i < std::size(kinds); ++i) {
      const double best = shortest(scene, kinds[i]);
      const bool shorter = traits.any_angle && found < best;
      if (found != best && !(std::abs(found - best) <= 1e-9 * best) && !shorter) {
        differs[i] = scene.name + ": the planner's route has " + text(found) +
                     " m, the shortest with " + std::to_string(kinds[i].neighbours) +
                     " neighbours" + (kinds[i].free_box ? " and no cut corner " : " ") +
                     text(best) + " m";
      }
    }
  }
  const bool some = std::any_of(differs.begin(), differs.end(),
                                [](const std::string& text) { return text.empty(); });
  report.expect(some, kOptimal, [&] {
    std::string all = "the lengths are the optima of no lattice:";
    for (const std::string& one : differs) {
      all += "\n    " + one;
    }
    return all;
  });
}

void any_angle(const PlannerBench& bench, Report& report) {
  const auto planner = bench.make();
  if (!planner->traits().any_angle) {
    return;
  }
  for (const Scene& scene : mazes(bench)) {
    const PlanResult result = planner->plan(scene.request);
    const double best = shortest(scene, {26, true});
    if (result.status != PlanStatus::solved || best == kInfinity) {
      continue;
    }
    report.expect(length(result.route) <= best * (1 + 1e-9), kAnyAngle, [&] {
      return scene.name + ": the planner's route has " + text(length(result.route)) +
             " m, the grid's shortest " + text(best) + " m";
    });
  }
}

void anytime(const PlannerBench& bench, Report& report) {
  const auto planner = bench.make();
  if (!planner->traits().anytime) {
    return;
  }
  for (int n = 0; n < bench.options.rounds; ++n) {
    Scene scene = bench.world(std::uint64_t(n), bench.flight());
    const std::int64_t all = counter(planner->plan(scene.request).counters, "expanded");
    double before = kInfinity;
    for (const std::int64_t max_iterations : {all / 16, all / 8, all / 4, all / 2, all, 2 * all}) {
      scene.request.budget.max_iterations = std::uint64_t(max_iterations);
      const PlanResult result = planner->plan(scene.request);
      const double now = judge(report, result, scene) ? length(result.route) : kInfinity;
      report.expect(now <= before * (1 + 1e-12), kAnytime, [&] {
        return scene.name + ": " + std::to_string(max_iterations) + " iterations give " +
               text(now) + " m, fewer gave " + text(before) + " m";
      });
      before = now;
    }
  }
}
}  // namespace

Cases planner_trait_cases(const PlannerBench& bench) {
  return planner_cases_on(bench, {{"trait_complete", complete},
                                  {"trait_optimal", optimal},
                                  {"trait_any_angle", any_angle},
                                  {"trait_anytime", anytime}});
}
}  // namespace altiplan::conformance
