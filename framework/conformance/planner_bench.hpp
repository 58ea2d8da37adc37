// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "worlds.hpp"

namespace altiplan::conformance {

// The contract of planner.hpp, and the requirements related to it.
inline constexpr const char* kPlannerEnds =
    "Planner contract 1: the route starts at the start exactly and ends within the goal's "
    "tolerance";
inline constexpr const char* kPlannerLegs = "Planner contract 2: every leg satisfies leg_ok";
inline constexpr const char* kPlannerStatus =
    "Planner contract 3: solved if and only if a route is returned; no route is a status, never an "
    "exception";
inline constexpr const char* kPlannerBudget =
    "Planner contract 4: the budget is kept, the stop token honoured within 1,024 iterations";
inline constexpr const char* kPlannerPure =
    "Planner contract 5: equal requests give equal results, on any threads, in any order";
inline constexpr const char* kNothingToJudge = "Suite: there must be something to judge";

/// Common data of the cases of one planner.
struct PlannerBench {
  Factory<Planner> make;
  Options options;

  /// The flight modes that the planner's traits claim.
  std::vector<Flight> flights() const {
    const Traits traits = make()->traits();
    std::vector<Flight> all;
    if (traits.spatial) {
      all.push_back(Flight::spatial);
    }
    if (traits.planar) {
      all.push_back(Flight::level);
    }
    return all;
  }
  Flight flight() const { return make()->traits().spatial ? Flight::spatial : Flight::level; }
  /// Sets the budget of one plan and the random seed of the scene.
  Scene budgeted(Scene scene) const {
    scene.request.budget.max_iterations = options.iterations;
    scene.request.random = RandomStream(options.seed).sub("plan");
    return scene;
  }
  Scene world(std::uint64_t n, Flight flight) const {
    return budgeted(random_scene(options.unit_m, options.seed * 1000 + n, flight));
  }
  Scene cells(std::uint64_t n, Flight flight) const {
    return budgeted(random_cells(options.unit_m, options.seed * 1000 + n, flight));
  }
};

/// Cases of a planner: an escaping exception violates contract 3, unless Planner::plan found a
/// route's ends wrong.
Cases planner_cases_on(const PlannerBench& bench, Bodies<PlannerBench> bodies);

/// Checks a result against contracts 1 to 3; true if it is solved.
bool judge(Report& report, const PlanResult& result, const Scene& scene);

Cases planner_law_cases(const PlannerBench& bench);
Cases planner_budget_cases(const PlannerBench& bench);
Cases planner_trait_cases(const PlannerBench& bench);
Cases session_cases(const PlannerBench& bench);
}  // namespace altiplan::conformance
