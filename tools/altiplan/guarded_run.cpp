// SPDX-License-Identifier: Apache-2.0
#include "guarded_run.hpp"

#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <iostream>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include "commands.hpp"
#include "host/result/result_json.hpp"
#include "progress_line.hpp"

namespace altiplan::cli {
namespace {

/// Printed if a plugin ends the process: the result as of the call of that plugin.
host::ProcessGuard::CrashReport crash_report(const CrashOutput& crash, const host::Config& config,
                                             const host::RunResult& result) {
  host::ProcessGuard::CrashReport words;
  words.for_user = "altiplan: " + result.message + "\n";
  words.exit_code = result.exit_code();
  if (crash.file || crash.on_stdout) {
    words.result = host::file_text(host::result_json(config, result));
  }
  words.on_stdout = crash.on_stdout;
  if (crash.file) {
    words.file = std::filesystem::absolute(*crash.file);
  }
  return words;
}

/// On a terminal, what a run of more than a second is doing.
class RunProgress {
 public:
  RunProgress(const host::Config& config, double timeout_s) : timeout_s_(timeout_s) {
    for (const host::StepEntry& step : config.steps) {
      note_budgets(step);
    }
    if (isatty(STDERR_FILENO) == 1) {
      thread_ = std::jthread([this](const std::stop_token& stop) { show(stop); });
    }
  }

  void call(const host::RunResult& result) {
    const std::lock_guard lock(mutex_);
    const std::string step = result.steps.empty() ? "" : result.steps.back().id;
    if (!has_begun_ || step != step_) {
      began_ = Clock::now();
    }
    has_begun_ = true;
    step_ = step;
    plugin_ = result.steps.empty() ? "" : result.steps.back().plugin;
  }

 private:
  using Clock = std::chrono::steady_clock;

  void note_budgets(const host::StepEntry& step) {
    if (step.within_s) {
      budgets_.try_emplace(step.id, *step.within_s);
    }
    for (const host::StepEntry& other : step.otherwise) {
      note_budgets(other);
    }
  }

  void show(const std::stop_token& stop) {
    ProgressLine line;
    std::unique_lock lock(mutex_);
    while (!stop.stop_requested()) {
      wake_.wait_for(lock, stop, std::chrono::milliseconds(500), [] { return false; });
      const double seconds = std::chrono::duration<double>(Clock::now() - began_).count();
      if (!has_begun_ || seconds < 1 || stop.stop_requested()) {
        continue;
      }
      const auto budget = budgets_.find(step_);
      const double most = budget == budgets_.end() ? timeout_s_ : budget->second;
      line.show((step_.empty() ? "building the world" : step_ + " (" + plugin_ + ")") + ": " +
                fixed(seconds, 0) + " s of " + fixed(most, 0) + " s");
    }
  }

  double timeout_s_;
  std::map<std::string, double> budgets_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  bool has_begun_ = false;
  std::string step_;
  std::string plugin_;
  Clock::time_point began_;
  std::jthread thread_;  ///< last: ended before what it uses
};
}  // namespace

host::RunResult guarded_run(const host::Config& config, host::RunOptions options,
                            const CrashOutput& crash, Interrupt& interrupt,
                            const HandOut& hand_out) {
  options.stop = interrupt.token();
  std::optional<host::ProcessGuard> process(std::in_place);
  options.process = &*process;
  std::optional<RunProgress> progress(std::in_place, config, options.timeout_s);
  options.on_call = [&](const host::RunResult& result) {
    progress->call(result);
    process->set_crash_report(crash_report(crash, config, result));
  };
  options.on_stuck = [&](const host::RunResult& result) {
    // The plugin is still running and may print: its stdout stays redirected.
    if (std::FILE* out = fdopen(process->true_stdout(), "w")) {
      try {
        hand_out(out, result);
      } catch (const Error& error) {
        std::cerr << "altiplan: " << error.what() << std::endl;
      }
      std::fclose(out);
    }
    _exit(interrupt.happened() ? kInterrupted : result.exit_code());
  };
  const host::RunResult result = host::run(config, options);
  progress.reset();
  process.reset();
  for (const std::string& warning : result.warnings) {
    warn(warning);
  }
  for (const std::string& note : result.notes) {
    info(note);
  }
  return result;
}
}  // namespace altiplan::cli
