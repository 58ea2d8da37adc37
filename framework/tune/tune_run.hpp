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
  std::size_t evaluations = 0;  ///< that have ended, those of an earlier call included
  std::size_t expected = 0;     ///< as the tuner would ask for if all scores were equal
  std::size_t runs = 0;         ///< by this call
  std::size_t runs_left = 0;    ///< about
  double best = kInfinity;
  double elapsed_s = 0;
};

struct TuneOptions {
  std::filesystem::path out;
  int jobs = 1;
  bool fresh = false;
  std::function<void(const TuneProgress&)> progress;
};

/// A point of the search, and what its runs came to.
struct Evaluation {
  std::size_t iteration = 0;             ///< the tuner's batch, from 1; 0 for the pipeline as it is
  std::vector<std::string> assignments;  ///< "steps.0.with.weight_g=0.3"; none: as it is
  std::vector<ScoredRun> runs;           ///< in the scenarios tuned on, maybe then those held back
  double score = kInfinity;              ///< over those tuned on
  std::size_t failed = 0;                ///< of the runs tuned on
};

struct Tuning {
  /// The first is the pipeline as it is, the others in the order in which the tuner asked.
  std::vector<Evaluation> evaluations;
  std::size_t best = 0;  ///< the first of the least score; 0 where nothing is less than as it is
  bool is_interrupted = false;
  std::size_t runs_done = 0;      ///< by this call
  std::size_t damaged_lines = 0;  ///< of the log, whose runs were done again
  double elapsed_s = 0;

  const Evaluation& as_it_is() const { return evaluations.front(); }
  const Evaluation& tuned() const { return evaluations[best]; }
};

/// Searches, and then runs what is held back. Goes on where an earlier call ended, however it did.
/// Throws Error where the folder cannot be used, a file changed meanwhile, or the metric has no
/// value in a run that solved the problem.
Tuning run_tuning(const TunePlan& plan, const TuneOptions& options);
}  // namespace altiplan::tune
