// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace altiplan::study {

/// An iteration of a search in the trace (TraceEvent).
struct Iteration {
  double number = 0;
  double best = 0;      ///< infinite while there is no route
  double mean = 0;      ///< NaN if it found none
  double alive = -1;    ///< -1: no population
  double time_s = 0;    ///< since the search began; NaN in traces of former versions
  double expanded = 0;  ///< by then, in the planner's unit: evaluations, samples; likewise
};

/// The iterations of the first search of a step.
struct Progress {
  std::string step;
  std::vector<Iteration> iterations;  ///< by ascending number
};
std::vector<Progress> progress_of(std::string_view trace);
}  // namespace altiplan::study
