// SPDX-License-Identifier: Apache-2.0
#include "guarded_run.hpp"

#include <unistd.h>

#include <filesystem>
#include <iostream>
#include <optional>

#include "commands.hpp"
#include "host/result/result_json.hpp"
#include "run_watch.hpp"

namespace altiplan::cli {
namespace {

/// Printed if a plugin ends the process: the result as of the call of that plugin.
host::ProcessGuard::CrashReport crash_report(const CrashOutput& crash, const host::Config& config,
                                             const host::RunResult& result) {
  host::ProcessGuard::CrashReport words;
  words.for_user = over_progress() + "altiplan: " + result.message + "\n";
  words.exit_code = result.exit_code();
  if (crash.file || crash.on_stdout) {
    words.result = host::file_text(host::result_json(config, result));
  }
  words.on_stdout = crash.on_stdout;
  if (crash.file) {
    words.file = std::filesystem::absolute(*crash.file);
  }
  if (crash.complete) {
    crash.complete(words, result);
  }
  return words;
}
}  // namespace

host::RunResult guarded_run(const host::Config& config, host::RunOptions options,
                            const CrashOutput& crash, Interrupt& interrupt,
                            const HandOut& hand_out) {
  options.out = crash.file;
  options.stop = interrupt.token();
  std::optional<host::ProcessGuard> process(std::in_place);
  options.process = &*process;
  options.judge_returns = returns_judge();
  std::optional<RunWatch> watch(std::in_place, config, options.timeout_s);
  options.progress = watch->progress();
  options.on_call = [&](const host::RunResult& result) {
    watch->call(result);
    process->set_crash_report(crash_report(crash, config, result));
  };
  options.on_stuck = [&](const host::RunResult& result) {
    watch->end();
    int code = result.exit_code();
    // The plugin is still running and may print: its stdout stays redirected.
    if (std::FILE* out = fdopen(process->true_stdout(), "w")) {
      try {
        code = hand_out(out, result);
      } catch (const Error& error) {
        std::cerr << "altiplan: " << error.what() << std::endl;
      }
      std::fclose(out);
    }
    _exit(interrupt.happened() ? kInterrupted : code);
  };
  return host::run(config, options);
}

void print_remarks(const host::RunResult& result) {
  for (const std::string& warning : result.warnings) {
    warn(warning);
  }
  for (const std::string& note : result.notes) {
    info(note);
  }
}
}  // namespace altiplan::cli
