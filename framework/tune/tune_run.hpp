// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tune/tune_log.hpp"
#include "tune/tune_plan.hpp"

namespace altiplan::tune {

struct TuneProgress {
  std::size_t evaluations = 0;  ///< ended ones, including those of earlier calls
  std::size_t expected = 0;     ///< number that the tuner requests if all scores are equal
  std::size_t runs = 0;         ///< by this call
  std::size_t runs_left = 0;    ///< estimated
  double best = kInfinity;
  double elapsed_s = 0;
};

struct TuneOptions {
  std::filesystem::path out;
  int jobs = 1;
  bool fresh = false;
  std::function<void(const TuneProgress&)> progress;
};

/// A point of the search, and the outcomes of its runs.
struct Evaluation {
  std::size_t iteration = 0;             ///< the tuner's batch, from 1; 0 for the original pipeline
  std::vector<std::string> assignments;  ///< "steps.0.with.weight_g=0.3"; empty: the original
  std::vector<ScoredRun> runs;  ///< in the scenarios tuned on, then possibly those held out
  double score = kInfinity;     ///< over those tuned on
  std::size_t failed = 0;       ///< of the runs tuned on
};

struct Tuning {
  /// The first is the original pipeline, the others are in the order of the tuner's requests.
  std::vector<Evaluation> evaluations;
  std::size_t best = 0;  ///< the first with the lowest score; 0 if none is below the original's
  bool is_interrupted = false;
  std::size_t runs_done = 0;      ///< by this call
  std::size_t damaged_lines = 0;  ///< of the log, whose runs were repeated
  double elapsed_s = 0;

  const Evaluation& as_it_is() const { return evaluations.front(); }
  const Evaluation& tuned() const { return evaluations[best]; }
};

/// Searches, and then runs the held-out scenarios. Continues an earlier call, however it ended.
/// Throws Error if the folder cannot be used, a file changed meanwhile, or the metric has no value
/// in a run that solved the problem.
Tuning run_tuning(const TunePlan& plan, const TuneOptions& options);
}  // namespace altiplan::tune
