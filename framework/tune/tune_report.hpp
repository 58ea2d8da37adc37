// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "study/figures/svg.hpp"
#include "tune/tune_run.hpp"

namespace altiplan::tune {

/// Comparison of the tuned with the original pipeline over scenarios.
struct TunedComparison {
  std::size_t scenarios = 0;
  std::size_t failed_before = 0;  ///< of the original pipeline
  std::size_t failed_now = 0;
  std::size_t only_before = 0;  ///< scenarios that only the original solves
  std::size_t only_now = 0;
  /// Scenarios that both solved, by the metric; with a penalty all, a failure having that value.
  std::size_t better = 0;
  std::size_t worse = 0;
  std::size_t equal = 0;
  double mean_before = 0;  ///< over the same; NaN if none
  double mean_now = 0;
  std::string words;  ///< a sentence, with the paired tests
};

struct TuneSummary {
  TunedComparison tuned_on;
  TunedComparison held_back;  ///< without scenarios if none are held out
  std::size_t evaluations = 0;
  std::size_t on_plateau = 0;  ///< with the lowest score, to a relative 1e-9
  std::size_t failed = 0;      ///< with a run that failed
};
TuneSummary summary_of(const TunePlan& plan, const Tuning& tuning);

/// The best and the mean score of each iteration.
study::report::Figure convergence_figure(const TunePlan& plan, const Tuning& tuning);

/// Writes evaluations.csv, held_back.csv (if any), convergence.svg, summary.json, tuned.yaml.
void write_tuning(const TunePlan& plan, const Tuning& tuning, const std::filesystem::path& folder);
}  // namespace altiplan::tune
