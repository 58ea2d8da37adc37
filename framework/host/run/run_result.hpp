// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/measures.hpp"
#include "altiplan/task.hpp"
#include "host/flight/flight.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {

/// One attempt of a step.
struct StepResult {
  std::string id;
  Verb verb = Verb::plan;
  std::string plugin;
  std::optional<std::string> instead_of;
  bool accepted = false;
  RunStatus status = RunStatus::failed;
  Reason reason = Reason::none;
  std::string message;
  double time_s = 0;
  double setup_time_s = 0;
  std::optional<double> first_route_s;  ///< of a traced search that reports iterations
  Counters counters;
  bool budget_hit = false;
  bool proved = false;
  Route route;
  std::optional<Measures> measures;
  MetricValues metrics;  ///< of a route that is measured
  std::optional<CheckResult> check;
  std::optional<Cost> cost;  ///< of a route that is judged
  std::string returns;       ///< the verdict on them in JSON; "" where none are judged
};

/// A scenario's task as ordered.
struct OrderedTask {
  std::vector<Pass> passes;
  std::vector<double> flights;  ///< seconds of each
  double time_s = 0;
  double bound_s = 0;  ///< of all orders of the same passes
};

/// Result of a run; grows while it runs.
struct RunResult {
  RunStatus status = RunStatus::failed;
  Reason reason = Reason::none;
  std::string message;
  bool budget_hit = false;
  std::vector<StepResult> steps;
  std::optional<std::size_t> accepted;  ///< index of the step whose route is accepted
  std::optional<OrderedTask> task;
  std::optional<FlightResult> flight;
  Frame frame;
  std::shared_ptr<const Objective> objective;  ///< null: length
  Vehicle vehicle;
  /// Of the accepted route (host/energy/way_home.hpp); none: no battery is known, or no route.
  std::optional<double> point_of_no_return_s;
  double setup_time_s = 0;
  std::vector<std::string> warnings;
  std::vector<std::string> notes;
  std::optional<std::string> folder;  ///< absolute, of the file that the result is written to
  std::optional<std::string> trace;
  std::string trace_error;  ///< why the trace could not be written

  /// 0 if solved; 4 if no route is accepted and a step failed; else 1.
  int exit_code() const;
};
}  // namespace altiplan::host
