// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "host/base/run_status.hpp"

namespace altiplan::study {

/// The outcome of a run of a study: the status that the run reports (host::RunStatus), or the end
/// of its process.
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
  crashed,         ///< its process ended prematurely
  out_of_memory,   ///< it exceeded the memory limit or the machine's memory
  bad_output,      ///< its result cannot be read, or is too large
  refused,         ///< a plugin library cannot be used
  bad_parameters,  ///< tuning only: a configuration on trial is invalid, not a file
  /// The machine prevented the run, so the pipeline is not at fault: a file cannot be read, no
  /// thread can be started. Never stored.
  not_done,
  /// Its files have changed since it was planned. Never stored.
  changed,
};

Outcome outcome_of(host::RunStatus status);

/// The word in the store and in reports ("out_of_memory").
const char* name(Outcome outcome);
std::optional<Outcome> outcome_named(std::string_view word);
}  // namespace altiplan::study
