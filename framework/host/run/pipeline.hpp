// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "host/config/config.hpp"
#include "host/run/process_guard.hpp"
#include "host/run/run_result.hpp"
#include "host/run/watchdog.hpp"

namespace altiplan::host {

struct RunOptions {
  int threads = 1;
  std::optional<std::filesystem::path> trace;
  /// Called from the watchdog's thread with the result so far when a step never stops; must not
  /// return.
  std::function<void(const RunResult&)> on_stuck;
  std::stop_token stop;  ///< interrupted
  /// Told before each call of a plugin what the result is should that call end the process, with
  /// CrashReport::kCause in its message.
  std::function<void(const RunResult&)> on_call;
  ProcessGuard* process = nullptr;  ///< what plugins must leave alone; not watched where null
  /// What a step without a time of its own may take, and all that has none: constructors, judging.
  double timeout_s = kDefaultStepSeconds;
};

/// Runs a pipeline: every step, its alternatives, the judge after each, the flight.
RunResult run(const Config& config, const RunOptions& options);
}  // namespace altiplan::host
