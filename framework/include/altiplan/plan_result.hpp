// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/reason.hpp"
#include "altiplan/route.hpp"

namespace altiplan {

/// Outcome of a planner or a smoother.
enum class PlanStatus {
  solved,           ///< a route is returned
  no_route,         ///< no route exists (`proved`), or the search was exhausted without finding one
  timed_out,        ///< no route within the budget
  cancelled,        ///< the stop token fired before a route was found
  invalid_problem,  ///< start or goal violate a constraint: the message names it and by how much
};

/// Name of a status in results ("no_route").
ALTIPLAN_API const char* name(PlanStatus status);

struct Counter {
  std::string name;
  std::int64_t value = 0;
};
using Counters = std::vector<Counter>;

/// Result of a planner or a smoother.
struct PlanResult {
  PlanStatus status = PlanStatus::no_route;
  Reason reason = Reason::none;  ///< for programs; set by the framework where it can determine it
  std::string message;           ///< a sentence: the position and the constraint that most likely
                                 ///< caused it
  Route route;  ///< first point = start; last within the goal's tolerance; empty unless solved
                ///< (local planners may return the part that they flew)
  Counters counters;  ///< including "expanded"
  bool budget_hit = false;
  bool proved = false;  ///< with no_route: no route exists in the planner's own search space
};

/// Guarantees of a planner for the given parameters; the conformance suite checks them.
struct Traits {
  bool complete = false;         ///< finds a route of its search space whenever one exists
  bool optimal = false;          ///< complete, and finds the shortest of them
  bool any_angle = false;        ///< never longer than the grid's shortest
  bool anytime = false;          ///< more budget never gives a longer route
  bool incremental = false;      ///< its session reuses earlier search effort
  bool planar = true;            ///< level flight
  bool spatial = true;           ///< three dimensions
  bool loiters = false;          ///< plans from and to loiter circles
  bool avoids_obstacles = true;  ///< no leg through a known one; a local planner without it may
                                 ///< cross one, and the judge reports that
  bool objectives = false;       ///< minimises any objective that does not depend on the time
  bool whole_routes = false;     ///< minimises any objective, also of the time and of waypoints
};
}  // namespace altiplan
