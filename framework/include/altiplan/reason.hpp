// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/api.hpp"

namespace altiplan {

/// Why something ended as it did, for programs: the sentence beside it is for people, and its words
/// may change.
enum class Reason {
  none,  ///< nothing to add to the status, or not known
  // Of an invalid problem: which end breaks a rule.
  start,
  goal,
  // Of a budget that was used up.
  deadline,
  iterations,
  memory,
  // Of a failure.
  threw,
  out_of_memory,    ///< std::bad_alloc
  contract_of_ends,      ///< a route that does not begin or end where it must
  contract_of_results,   ///< a session that shows another result than it returned
  contract,              ///< another law of an interface
  process_changed,  ///< it changed what belongs to the process: locale, working folder, …
  never_stopped,    ///< it went on after its budget and was ended
  process_ended,    ///< by a signal, or by a call of exit
  // Of a route or a track that was judged.
  constraint,  ///< it breaks a rule
  // Of a flight that does not arrive; the deadline is its max_time_s.
  stuck,        ///< the pilot finds no way on
  route_ended,  ///< away from the goal
};

/// The word of a reason in results ("contract_of_ends"); "" for none.
ALTIPLAN_API const char* name(Reason reason);
}  // namespace altiplan
