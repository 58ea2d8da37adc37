// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/api.hpp"

namespace altiplan {

/// Machine-readable cause of an outcome: the message beside it is for people, and its words may
/// change.
enum class Reason {
  none,  ///< nothing to add to the status, or unknown
  // Of an invalid problem: the end that violates a constraint.
  start,
  goal,
  // Of an exhausted budget.
  deadline,
  iterations,
  memory,
  // Of a failure.
  threw,
  out_of_memory,        ///< std::bad_alloc
  contract_of_ends,     ///< the route does not begin or end where it must
  contract_of_results,  ///< the session shows another result than it returned
  contract,             ///< another clause of the interface's contract
  process_changed,      ///< the plugin changed process state: locale, working folder, …
  never_stopped,        ///< the plugin ran on after its budget and was ended
  process_ended,        ///< by a signal, or by a call of exit
  // Of a judged route or track.
  constraint,  ///< violates a constraint
  // Of a flight that does not arrive; the deadline is its max_time_s.
  stuck,        ///< the pilot finds no way to continue
  route_ended,  ///< away from the goal
};

/// Name of a reason in results ("contract_of_ends"); "" for none.
ALTIPLAN_API const char* name(Reason reason);
}  // namespace altiplan
