// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <functional>
#include <optional>
#include <string>

#include "host/run/pipeline.hpp"
#include "interrupt.hpp"

namespace altiplan::cli {

/// Where the result of a run goes, also if a plugin ends the process.
struct CrashOutput {
  std::optional<std::string> file;
  bool on_stdout = false;
  /// Completes what is printed then, and the exit code.
  std::function<void(host::ProcessGuard::CrashReport& report, const host::RunResult& result)>
      complete{};
};

/// Prints, and writes, a result; returns the exit code.
using HandOut = std::function<int(std::FILE* to, const host::RunResult& result)>;

/// What judges steps `returns`; none in the program that tools/run builds first.
decltype(host::RunOptions::judge_returns) returns_judge();

/// Runs a pipeline with the process guarded against its plugins. If a plugin never returns, the
/// result so far is handed out and the process ends.
host::RunResult guarded_run(const host::Config& config, host::RunOptions options,
                            const CrashOutput& crash, Interrupt& interrupt,
                            const HandOut& hand_out);

/// Prints the run's warnings and notes, on stderr.
void print_remarks(const host::RunResult& result);
}  // namespace altiplan::cli
