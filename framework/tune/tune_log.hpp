// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "host/result/result_json.hpp"

namespace altiplan::tune {

/// The outcome of a run of an evaluation.
struct ScoredRun {
  std::string outcome;          ///< as of a study's run
  std::optional<double> value;  ///< of the metric; none if the run failed
  std::string message;          ///< why it failed; "" if it did not

  bool operator==(const ScoredRun&) const = default;
};

/// A run by its evaluation and scenario.
using RunId = std::pair<std::size_t, std::size_t>;

/// The folder of a tuning: its settings, and a log to which each run is appended as it ends.
///
/// A line of the log is JSON and its CRC-32. Truncated or damaged lines are dropped: the search is
/// deterministic, so missing runs are repeated.
class TuneLog {
 public:
  /// Creates the folder, or continues the tuning in it. Throws Error if it contains other files, or
  /// a tuning with different settings, naming them.
  TuneLog(std::filesystem::path folder, const host::Json& settings, bool fresh);

  /// The run, if logged; throws Error if it had other parameters, i.e. the tuner is not
  /// deterministic.
  const ScoredRun* find(const RunId& id, const std::string& parameters) const;
  void add(const RunId& id, const std::string& parameters, const ScoredRun& run);
  std::size_t size() const { return runs_.size(); }
  /// Number of damaged lines, not counting one truncated by a kill.
  std::size_t damaged() const { return damaged_; }
  /// Writes the log in the order of evaluations, identical for every tuning with these settings.
  void finish() const;

 private:
  struct Line {
    std::string parameters;
    ScoredRun run;
  };
  void read();

  std::filesystem::path folder_;
  std::filesystem::path file_;
  std::map<RunId, Line> runs_;
  std::size_t damaged_ = 0;
};
}  // namespace altiplan::tune
