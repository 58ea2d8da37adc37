// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/plan_result.hpp"

namespace altiplan {

class Environment;
struct Request;

/// What is done at a place before the flight goes on; an aeroplane does nothing.
struct ALTIPLAN_API Stop {
  double hold_s = 0;   ///< waits, on the ground where it lands
  bool lands = false;  ///< goes straight down to the ground, and up again
  bool drops = false;  ///< lets go of its cargo, once it has waited

  bool acts() const { return hold_s > 0 || lands || drops; }
  /// From arrival to departure: of a landing the ways down and up as the vehicle flies them, too.
  double seconds(const Vec3& at, const Request& request) const;
};

/// A part of a task that is flown as it is: straight legs through its points. One point is a place.
struct Pass {
  Polyline points;
  /// Waypoints between the end of the pass before and this one, along which the order was costed.
  /// Flown where they are valid; elsewhere a planner joins the two passes.
  Polyline join{};
  bool takes_off = false;  ///< first of another flight, which begins where the one before ended
  Stop stop{};             ///< at its last point
};

/// Where the passes may begin and end; empty: anywhere.
struct TaskEnds {
  std::optional<Vec3> start{};
  std::optional<Vec3> goal{};
};

/// A task's passes in the order, and the direction, in which they are flown.
struct ALTIPLAN_API TaskOrder {
  PlanStatus status = PlanStatus::no_route;  ///< solved if and only if there are passes
  Reason reason = Reason::none;
  std::string message;  ///< unless solved: why not
  std::vector<Pass> passes;
  Polyline last_join{};  ///< waypoints between the last pass and the end
  bool closes = false;   ///< without a goal: the end is where it began, else the last pass's end
  double time_s = 0;     ///< of route(), by flown_time of flown_route.hpp
  double bound_s = 0;    ///< see contract 4
  Counters counters{};   ///< including "expanded"
  bool budget_hit = false;

  /// The first waypoint: the start, or that of the first pass.
  Vec3 first(const TaskEnds& ends) const { return ends.start.value_or(passes.front().points[0]); }
  Vec3 last(const TaskEnds& ends) const {
    return ends.goal.value_or(closes ? first(ends) : passes.back().points.back());
  }
  /// Along the passes and joins, with waits as long as the stops.
  Route route(const TaskEnds& ends, const Request& request) const;
};

/// What is to be done besides reaching a goal: an area to cover, a line to follow, places to visit.
/// It chooses passes and their order; any planner joins those whose joins are not valid in its
/// world, smoothers keep them, and the judge checks that each is flown.
///
/// Contract:
///  1. Pure and const: built from (parameters, Site) alone; callable from any number of threads.
///     Two calls with equal requests give equal orders, unless a deadline or stop ended one.
///  2. Each pass has at least one point, all finite and within bounds(). Its legs may touch, but
///     not cross, obstacles(); so may the joins.
///  3. No order is a status, never an exception. The budget is kept; more of it never makes the
///     time longer.
///  4. No route that flies the same passes and stops, in any order and either direction, between
///     the same ends takes less than bound_s, whatever joins them. time_s is at least that.
///  5. obstacles() fulfils the contract of Environment; the host adds it to the world.
class ALTIPLAN_API Task {
 public:
  virtual ~Task();
  /// Throws PluginError where the order breaks the contract, or do_order throws.
  TaskOrder order(const Request& request, const TaskEnds& ends) const;
  /// Holds all passes.
  Box bounds() const { return do_bounds(); }
  /// What the task itself keeps routes out of, such as islands; null: nothing.
  std::shared_ptr<const Environment> obstacles() const { return do_obstacles(); }

 private:
  virtual TaskOrder do_order(const Request& request, const TaskEnds& ends) const = 0;
  virtual Box do_bounds() const = 0;
  /// Default: null.
  virtual std::shared_ptr<const Environment> do_obstacles() const;
};
}  // namespace altiplan
