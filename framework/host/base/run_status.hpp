// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>

#include "altiplan/plan_result.hpp"

namespace altiplan::host {

/// Outcome of a step, a flight or a run.
enum class RunStatus {
  solved,  ///< a route is accepted; a flight has arrived
  no_route,
  timed_out,
  cancelled,
  invalid_problem,
  rejected,     ///< the judge found violations
  failed,       ///< a plugin threw, violated the contract of its interface, or never stopped
  collided,     ///< of a flight
  not_reached,  ///< of a flight
};

RunStatus run_status(PlanStatus status);

/// The reason to report for an exception of a plugin.
Reason reason_of(const std::exception& error);

/// Name of a status in results ("no_route").
const char* name(RunStatus status);
}  // namespace altiplan::host
