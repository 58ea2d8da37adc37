// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stop_token>
#include <string>
#include <vector>

#include "plugin_test.hpp"

namespace altiplan::cli {

struct Verdict {
  std::string test;
  std::vector<conformance::Finding> findings;  ///< none: passed
  bool seen_from_outside = false;  ///< a finding is this process's, of the one that ran the test
  std::string skipped;
  bool misfit = false;  ///< skipped, as the parameters do not fit the plugin
  std::string said;     ///< the end of what it wrote to stdout and stderr
  double time_s = 0;
  double peak_memory_mb = 0;

  bool failed() const { return !findings.empty(); }
};

struct RunnerOptions {
  std::size_t jobs = 1;
  double time_limit_s = 60;  ///< of a test; then it is killed
  double memory_limit_mb = 4096;
  /// How this program runs one test in the process that it is: program, arguments. The name of the
  /// test and the file for its outcome are set after them (--only ^NAME$ --here --answer FILE).
  std::vector<std::string> command;
  std::stop_token stop;
};

/// Runs each test in a process of its own, in a scratch folder of its own; those that look at the
/// clock one after the other, at the end. Calls `done` with each verdict as it comes. Returns them
/// in the order of the tests; fewer where it was stopped. Throws Error where no process can be
/// made.
std::vector<Verdict> run_apart(const std::vector<PluginTest>& tests, const RunnerOptions& options,
                               const std::function<void(const Verdict&)>& done);

/// The outcome as a process hands it to the one that started it, and back; throws Error where the
/// text is none.
std::string outcome_text(const Outcome& outcome);
Outcome outcome_of(const std::string& text);
}  // namespace altiplan::cli
