// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "host/result/result_json.hpp"

namespace altiplan::tune {

/// What a run of an evaluation came to.
struct ScoredRun {
  std::string outcome;          ///< as of a study's run
  std::optional<double> value;  ///< of the metric; none where the run failed
  std::string message;          ///< why; "" where it did not

  bool operator==(const ScoredRun&) const = default;
};

/// A run by its evaluation and scenario.
using RunId = std::pair<std::size_t, std::size_t>;

/// The folder of a tuning: its settings, and a log to which every run is added as it ends.
///
/// A line of the log is JSON and its CRC-32. One that a kill has cut off, or that is damaged, is
/// dropped: the search is deterministic, so what is missing is done again.
class TuneLog {
 public:
  /// Makes the folder, or goes on with the tuning in it. Throws Error where it holds other files,
  /// or a tuning with other settings, saying which.
  TuneLog(std::filesystem::path folder, const host::Json& settings, bool fresh);

  /// The run, if it is known; throws Error where it was of other parameters, so that the tuner is
  /// not deterministic.
  const ScoredRun* find(const RunId& id, const std::string& parameters) const;
  void add(const RunId& id, const std::string& parameters, const ScoredRun& run);
  std::size_t size() const { return runs_.size(); }
  /// Lines that were not as they were written, beside one that a kill has cut off.
  std::size_t damaged() const { return damaged_; }
  /// The log in order of evaluations, as every tuning with these settings leaves it.
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
