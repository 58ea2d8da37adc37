// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cstdio>

#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/result/result_json.hpp"
#include "host/run/pipeline.hpp"
#include "interrupt.hpp"
#include "run_watch.hpp"
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

/// Printed if a plugin ends the process.
host::ProcessGuard::CrashReport crash_report(const ReplayArguments& arguments,
                                             const host::Config& config,
                                             const study::StoredRun& stored,
                                             const host::RunResult& result) {
  host::ProcessGuard::CrashReport words;
  const bool as_then = stored.outcome == "crashed";
  words.for_user = over_progress() + "altiplan: " + result.message + "\n" +
                   study::run_name(stored) + ": " +
                   (as_then ? "crashed, as the stored run did: " + stored.message
                            : "crashed, unlike the stored run: " + stored.outcome) +
                   "\n";
  if (arguments.out) {
    words.result = host::file_text(host::result_json(config, result));
    words.file = std::filesystem::absolute(*arguments.out);
  }
  words.exit_code = as_then ? kDone : kNoRoute;
  return words;
}

int run_again(const ReplayArguments& arguments, const study::Store& store,
              const study::StoredRun& stored) {
  const host::Config config = study::config_of(store, stored, arguments.overrides.plugin_path);
  const study::StudyBudget budget = study::budget_of(store);
  const std::string key = study::key_of(config, budget, study::run_name(stored), stored.seed);
  Interrupt interrupt;
  host::RunOptions options;
  options.timeout_s = budget.wall_s;
  options.out = arguments.out;
  options.trace = arguments.trace;
  options.stop = interrupt.token();
  std::optional<host::ProcessGuard> process(std::in_place);
  options.process = &*process;
  std::optional<RunWatch> watch(std::in_place, config, options.timeout_s);
  options.progress = watch->progress();
  options.on_call = [&](const host::RunResult& result) {
    watch->call(result);
    process->set_crash_report(crash_report(arguments, config, stored, result));
  };
  options.on_stuck = [&](const host::RunResult& result) {
    watch->end();
    // The plugin is still running and may print: its stdout stays redirected.
    if (interrupt.happened()) {
      _exit(kInterrupted);
    }
    int code = kInternal;
    if (std::FILE* out = fdopen(process->true_stdout(), "w")) {
      code = hand_out(out, arguments, stored, config, key, result);
      std::fclose(out);
    }
    _exit(code);
  };
  const host::RunResult result = host::run(config, options);
  watch.reset();
  process.reset();
  if (interrupt.happened()) {
    return kInterrupted;  // an incomplete run cannot be compared
  }
  const int code = hand_out(stdout, arguments, stored, config, key, result);
  if (!result.trace_error.empty()) {
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
  App* command =
      app.add_subcommand("replay", "repeat a run of a study and compare the results bit for bit");
  auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("store", arguments->store, "study database")->required()->type_name("DB");
  command
      ->add_option("run", arguments->run,
                   "run: its id, its key or a prefix of the key, or its name 'PIPELINE SCENARIO "
                   "#REPETITION'")
      ->required();
  command->add_option("-o,--out", arguments->out, "write the result to this file (JSON)")
      ->type_name("FILE");
  command->add_option("--trace", arguments->trace, "write a search trace to this file")
      ->type_name("FILE");
  command->add_flag(
      "--stored", arguments->stored,
      "write the stored result instead of running (input for view, check and export)");
  add_plugin_path(*command, arguments->overrides);
  set_example(*command, "altiplan replay study.db 'astar city #0'");
  command->callback([&action, arguments] { action = [arguments] { return replay(*arguments); }; });
}
}  // namespace altiplan::cli
