// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "host/base/run_status.hpp"

namespace altiplan::study {

/// What became of a run of a study: what a run says of itself (host::RunStatus), or what its
/// process came to.
enum class Outcome {
  solved,
  no_route,
  timed_out,
  cancelled,
  invalid_problem,
  rejected,
  failed,
  collided,
  not_reached,
  crashed,         ///< its process ended before its time
  out_of_memory,   ///< it used more than was allowed, or than there was
  bad_output,      ///< its result cannot be read, or is too large
  refused,         ///< a plugin library cannot be used
  bad_parameters,  ///< of a tuning: a configuration on trial is wrong, which says nothing of files
  /// The machine did not let the run be done as planned, which says nothing about its pipeline: a
  /// file cannot be read, the system gives no thread. Never stored.
  not_done,
  /// Its files are others than those that were planned with. Never stored.
  changed,
};

Outcome outcome_of(host::RunStatus status);

/// The word in the store and in reports ("out_of_memory").
const char* name(Outcome outcome);
std::optional<Outcome> outcome_named(std::string_view word);
}  // namespace altiplan::study
