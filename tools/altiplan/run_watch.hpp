// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "host/run/pipeline.hpp"
#include "progress.hpp"

namespace altiplan::cli {

/// On a terminal, what a run is doing: its step, the time left of its budget, and how far the
/// plugin is.
class RunWatch {
 public:
  RunWatch(const host::Config& config, double timeout_s);
  /// Where the run shows how far it is.
  host::RunProgress* progress() { return &progress_; }
  /// A plugin is called; with the result so far.
  void call(const host::RunResult& result);
  void end() { activity_.end(); }

 private:
  void note_budgets(const host::StepEntry& step);

  double timeout_s_;
  std::map<std::string, double> budgets_;  ///< by the step's id
  host::RunProgress progress_;
  bool has_begun_ = false;
  std::size_t steps_ = 0;
  Activity activity_;
};
}  // namespace altiplan::cli
