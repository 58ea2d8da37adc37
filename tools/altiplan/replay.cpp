// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "commands.hpp"
#include "guarded_run.hpp"
#include "host/base/output_file.hpp"
#include "host/result/result_json.hpp"
#include "study/compare/replay.hpp"
#include "study/plan/study_plan.hpp"
#include "study/store/find_run.hpp"
#include "terminal.hpp"

namespace altiplan::cli {
namespace {

struct ReplayArguments {
  std::string store;
  std::string run;
  bool stored = false;
  std::optional<std::string> out;
  std::optional<std::string> trace;
  host::Overrides overrides;
};

/// Prints the comparison of the run with the stored one; returns the exit code.
int report(std::FILE* to, const study::StoredRun& stored, const host::Json& result,
           const std::string& key) {
  const study::Replayed replayed = study::compare_replay(stored, result, key);
  for (const std::string& change : replayed.changed) {
    warn(change);
  }
  const std::string name = study::run_name(stored);
  if (!replayed.difference) {
    std::fprintf(to, "%s: %s to the stored run: %s\n", name.c_str(),
                 painted(to, Color::good, "identical").c_str(), stored.outcome.c_str());
    return kDone;
  }
  const host::Difference& difference = *replayed.difference;
  std::fprintf(to, "%s: %s from the stored run at %s: it was %s and is %s\n", name.c_str(),
               painted(to, Color::bad, "differs").c_str(), difference.path.c_str(),
               difference.first.c_str(), difference.second.c_str());
  if (!replayed.changed.empty()) {
    std::fprintf(to, "  possible cause: the changes reported above\n");
  } else if (result.at("budget_hit") == true) {
    std::fprintf(to, "  possible cause: a time budget ran out\n");
  }
  return kNoRoute;
}

int hand_out(std::FILE* to, const ReplayArguments& arguments, const study::StoredRun& stored,
             const host::Config& config, const std::string& key, const host::RunResult& result) {
  const host::Json json = host::result_json(config, result);
  const int code = report(to, stored, json, key);
  if (arguments.out) {
    host::write_file(*arguments.out, host::file_text(json));
  }
  return code;
}

/// If a plugin ends the process, whether it did so in the stored run.
void complete(host::ProcessGuard::CrashReport& report, const study::StoredRun& stored) {
  const bool as_then = stored.outcome == "crashed";
  report.for_user += study::run_name(stored) + ": " +
                     (as_then ? "crashed, as the stored run did: " + stored.message
                              : "crashed, unlike the stored run: " + stored.outcome) +
                     "\n";
  report.exit_code = as_then ? kDone : kNoRoute;
}

int run_again(const ReplayArguments& arguments, const study::Store& store,
              const study::StoredRun& stored) {
  const host::Config config = study::config_of(store, stored, arguments.overrides.plugin_path);
  const study::StudyBudget budget = study::budget_of(store);
  const std::string key = study::key_of(config, budget, study::run_name(stored), stored.seed);
  Interrupt interrupt;
  host::RunOptions options;
  options.timeout_s = budget.wall_s;
  options.trace = arguments.trace;
  const CrashOutput crash{arguments.out, false,
                          [&](auto& words, const auto&) { complete(words, stored); }};
  const HandOut to = [&](std::FILE* out, const host::RunResult& result) {
    return interrupt.happened() ? kInterrupted  // an incomplete run cannot be compared
                                : hand_out(out, arguments, stored, config, key, result);
  };
  const host::RunResult result = guarded_run(config, options, crash, interrupt, to);
  const int code = to(stdout, result);
  if (code != kInterrupted && !result.trace_error.empty()) {
    throw Error(result.trace_error);
  }
  return code;
}

int write_stored(const ReplayArguments& arguments, const study::StoredRun& stored) {
  if (stored.result.empty()) {
    throw Error("the run '" + study::run_name(stored) + "' has no result: " + stored.outcome +
                (stored.message.empty() ? "" : " (" + stored.message + ")"));
  }
  if (arguments.out) {
    host::write_file(*arguments.out, stored.result);
  } else {
    std::fputs(stored.result.c_str(), stdout);
  }
  if (arguments.trace) {
    if (stored.trace.empty()) {
      throw Error("the run '" + study::run_name(stored) + "' was stored without a trace");
    }
    host::write_file(*arguments.trace, stored.trace);
  }
  return kDone;
}

int replay(const ReplayArguments& arguments) {
  expect_writable(arguments.out, "--out");
  expect_writable(arguments.trace, "--trace");
  expect_apart(arguments.out, "--out", {arguments.store});
  expect_apart(arguments.trace, "--trace", {arguments.store, arguments.out.value_or("")});
  const study::Store store(arguments.store, study::StoreMode::read);
  const study::StoredRun stored = study::find_run(store, arguments.run);
  return arguments.stored ? write_stored(arguments, stored) : run_again(arguments, store, stored);
}
}  // namespace

void add_replay(App& app, Action& action) {
  auto [command, arguments] = add_command<ReplayArguments>(
      app, action, "replay", "repeat a run of a study and compare the results bit for bit", replay);
  command.add_option("store DB", arguments.store, "study database")->required();
  command
      .add_option("run", arguments.run,
                  "run: its id, its key or a prefix of the key, or its name 'PIPELINE SCENARIO "
                  "#REPETITION'")
      ->required();
  command.add_option("-o,--out FILE", arguments.out, "write the result to this file (JSON)");
  command.add_option("--trace FILE", arguments.trace, "write a search trace to this file");
  command.add_flag("--stored", arguments.stored,
                   "write the stored result instead of running (input for view, check and export)");
  add_plugin_path(command, arguments.overrides);
  set_example(command, "altiplan replay study.db 'astar city #0'");
}
}  // namespace altiplan::cli
