// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "altiplan/planner.hpp"
#include "measuring.hpp"

namespace altiplan::bench {

/// The problem of a scenario in a newly built world, without cached grids.
Request problem_of(const std::filesystem::path& scenario);

/// A plan's time by two clocks, in milliseconds.
struct Time {
  double wall_ms = 0;
  double processor_ms = 0;  ///< of all threads

  static Time now() { return {1e3 * wall_s(), 1e3 * process_s()}; }
  Time since(const Time& before) const {
    return {wall_ms - before.wall_ms, processor_ms - before.processor_ms};
  }
};

/// The settings of a colony's plan.
struct Setting {
  std::string planner;  ///< the plugin's name and, after a space, its parameters in YAML
  double cell_m = 0;    ///< 0: that of the parameters
  int iterations = 50;
};

struct Run {
  Time time;
  double steps = 0;   ///< of all ants
  double alive = 0;   ///< ants of the last iteration that reached the goal
  double length = 0;  ///< infinite without a route
};

/// A planner with all iterations of its setting, and with a single one: the difference in time is
/// due to the other iterations, the rest is the set-up.
class Colony {
 public:
  Colony(host::Registry& registry, const Setting& setting);

  /// Throws Error if the judge rejects the route, or if the planner is not a colony.
  Run all(const Request& request) const { return run(*all_, request); }
  Run single(const Request& request) const { return run(*single_, request); }
  /// That many parallel plans, each on its own thread.
  Time at_once(const Request& request, int plans) const;

 private:
  Run run(const Planner& planner, const Request& request) const;

  std::string name_;
  std::shared_ptr<const Planner> all_;
  std::shared_ptr<const Planner> single_;
};

/// The times of one seed, on one thread.
struct Pass {
  Run first;   ///< by a new planner in a new world
  Run again;   ///< by the same planner once more
  Run single;  ///< a single iteration

  double iterations_ms(double Time::*clock) const { return again.time.*clock - single.time.*clock; }
  double step_ns() const {
    return 1e6 * iterations_ms(&Time::processor_ms) / (again.steps - single.steps);
  }
  /// The time of a plan without its steps.
  double set_up_ms(const Run& run) const {
    return run.time.processor_ms - 1e-6 * step_ns() * run.steps;
  }
};
/// The request must be a new one of problem_of().
Pass plan_once(host::Registry& registry, const Setting& setting, Request request, int seed);
}  // namespace altiplan::bench
