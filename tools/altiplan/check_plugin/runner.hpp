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
  bool seen_from_outside = false;  ///< a finding by the parent about the process that ran the test
  std::string skipped;
  bool hung = false;    ///< it was killed after the time limit
  bool misfit = false;  ///< skipped because the parameters do not fit the plugin
  std::string output;   ///< the end of its output on stdout and stderr
  double time_s = 0;
  double peak_memory_mb = 0;

  bool failed() const { return !findings.empty(); }
};

struct RunnerOptions {
  std::size_t jobs = 1;
  double time_limit_s = 60;  ///< after which a test is killed
  double memory_limit_mb = 4096;
  /// Command of the child that runs one test: program, arguments. The name of the test and the file
  /// for its outcome are appended (--only ^NAME$ --here --answer FILE).
  std::vector<std::string> command;
  std::stop_token stop;
};

/// Runs each test in its own process and scratch folder; those that measure time one after the
/// other, at the end. Calls `done` with each verdict as it arrives. Returns them in the order of
/// the tests; fewer if stopped. After one that does not end, those that have not begun are skipped:
/// a plugin that hangs does so in most. Throws Error if no process can be started.
std::vector<Verdict> run_apart(const std::vector<PluginTest>& tests, const RunnerOptions& options,
                               const std::function<void(const Verdict&)>& done);

/// The outcome as text, passed from a child to its parent, and back; throws Error if the text is
/// not an outcome.
std::string outcome_text(const Outcome& outcome);
Outcome outcome_of(const std::string& text);
}  // namespace altiplan::cli
