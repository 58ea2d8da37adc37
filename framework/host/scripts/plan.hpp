// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/planner.hpp"
#include "host/scripts/worker.hpp"

namespace altiplan::host {

/// One call of a planner or smoother in Python: the request as values, the answers to what it asks
/// about the world, the budget, and the result.
class ScriptPlan {
 public:
  /// Smooths the route if there is one.
  ScriptPlan(const Request& request, const Polyline* route, ScriptWorker& worker);
  /// Throws PluginError, after which the worker is of no use, if it fails or does not stop.
  PlanResult result();

 private:
  using Clock = Budget::Clock;

  void watch_budget();
  void watch_memory(Clock::time_point now);
  void answer(const ScriptMessage& question);
  PlanResult result_of(const ScriptMessage& answer) const;
  void take_failure(const Json& head, PlanResult& result) const;

  const Request& request_;
  const Polyline* route_;
  ScriptWorker& worker_;
  double memory_before_mb_;
  Clock::time_point memory_seen_;
  bool too_large_ = false;
  std::optional<Clock::time_point> stop_requested_;  ///< when it was told to stop
};
}  // namespace altiplan::host
