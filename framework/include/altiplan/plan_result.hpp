// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/reason.hpp"
#include "altiplan/route.hpp"

namespace altiplan {

/// What a planner or a smoother answers.
enum class PlanStatus {
  solved,           ///< a route is returned
  no_route,         ///< there is none (`proved`), or the search ran dry without finding one
  timed_out,        ///< no route within the budget
  cancelled,        ///< the stop token fired before there was a route
  invalid_problem,  ///< start or goal break a rule: the message says which and by how much
};

/// The word of a status in results ("no_route").
ALTIPLAN_API const char* name(PlanStatus status);

struct Counter {
  std::string name;
  std::int64_t value = 0;
};
using Counters = std::vector<Counter>;

/// What a plan or a smoothing gave.
struct PlanResult {
  PlanStatus status = PlanStatus::no_route;
  Reason reason = Reason::none;  ///< for programs; set by the framework where it can be told
  std::string message;           ///< a sentence: the place and the rule nearest to blame
  Route route;  ///< first point = start; last within the goal's tolerance; empty unless solved
                ///< (local planners may leave the part that they flew)
  Counters counters;  ///< "expanded" among them
  bool budget_hit = false;
  bool proved = false;  ///< of no_route: no route exists on the planner's own search space
};

/// What a planner holds to for the given parameters; the conformance suite checks it.
struct Traits {
  bool complete = false;         ///< finds a route of its search space whenever there is one
  bool optimal = false;          ///< and the shortest of them
  bool any_angle = false;        ///< never longer than the grid's shortest
  bool anytime = false;          ///< more budget never gives a longer route
  bool incremental = false;      ///< its session keeps what it searched
  bool planar = true;            ///< level flight
  bool spatial = true;           ///< three dimensions
  bool avoids_obstacles = true;  ///< no leg through a known one; false: a local planner's may lead
                                 ///< there, and the judge says so
};
}  // namespace altiplan
