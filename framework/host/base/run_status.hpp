// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>

#include "altiplan/plan_result.hpp"

namespace altiplan::host {

/// What became of a step, a flight or a run.
enum class RunStatus {
  solved,  ///< a route stands; a flight has arrived
  no_route,
  timed_out,
  cancelled,
  invalid_problem,
  rejected,     ///< the judge did not agree
  failed,       ///< a plugin threw, violated the contract of its interface, or never stopped
  collided,     ///< of a flight
  not_reached,  ///< of a flight
};

RunStatus run_status(PlanStatus status);

/// What an exception says of the plugin that threw it.
Reason reason_of(const std::exception& error);

/// The word of a status in results ("no_route").
const char* name(RunStatus status);
}  // namespace altiplan::host
