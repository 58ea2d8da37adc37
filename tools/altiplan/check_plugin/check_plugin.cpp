// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <regex>
#include <sstream>
#include <thread>

#include "altiplan/error.hpp"
#include "check_plugin/verdicts.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/result/result_json.hpp"
#include "host/scripts/script.hpp"
#include "interrupt.hpp"
#include "progress.hpp"
#include "study/figures/text.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct Arguments {
  std::string library;
  std::string only;
  std::string sets;
  std::string junit;
  std::string answer;         ///< outcome file of a process that runs one test for another
  host::Overrides overrides;  ///< only the plugin path and the seed are used
  int rounds = PluginToCheck().rounds;
  double time_limit_s = RunnerOptions().time_limit_s;
  double memory_limit_mb = RunnerOptions().memory_limit_mb;
  std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
  bool json = false;
  bool untimed = false;
  bool list = false;
  bool here = false;
};

/// Tests run in their own folders, so relative paths would not resolve.
void make_plugin_path_absolute() {
  const char* const listed = std::getenv("ALTIPLAN_PLUGIN_PATH");
  std::istringstream folders(listed != nullptr ? listed : "");
  std::string all;
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (!folder.empty()) {
      all += (all.empty() ? "" : ":") + fs::absolute(folder).string();
    }
  }
  if (!all.empty()) {
    ::setenv("ALTIPLAN_PLUGIN_PATH", all.c_str(), 1);
  }
}

PluginToCheck plugin_of(const Arguments& arguments) {
  if (!fs::is_regular_file(arguments.library)) {
    throw Error(arguments.library + (fs::exists(arguments.library) ? ": not a file, expected a "
                                                                     "plugin library"
                                                                   : ": no such file"));
  }
  PluginToCheck what;
  what.library = fs::absolute(arguments.library);
  if (!arguments.sets.empty()) {
    what.sets = parameter_sets(fs::absolute(arguments.sets));
  }
  for (const fs::path& folder : arguments.overrides.plugin_path) {
    what.plugin_path.push_back(fs::absolute(folder));
  }
  what.seed = std::uint64_t(arguments.overrides.seed.value_or(1));
  what.rounds = arguments.rounds;
  return what;
}

/// The command that repeats these tests, with absolute paths.
std::vector<std::string> command_of(const Arguments& arguments, const PluginToCheck& what) {
  std::vector<std::string> words{"altiplan", "check-plugin", what.library.string(), "--seed",
                                 std::to_string(what.seed)};
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (what.rounds != PluginToCheck().rounds) {
    add("--rounds", std::to_string(what.rounds));
  }
  if (!arguments.sets.empty()) {
    add("--sets", fs::absolute(arguments.sets).string());
  }
  for (const fs::path& folder : what.plugin_path) {
    add("--plugin-path", folder.string());
  }
  return words;
}

std::vector<PluginTest> chosen(const Arguments& arguments, const PluginToCheck& what) {
  std::vector<PluginTest> tests = tests_of(what);
  const std::regex only(arguments.only);
  std::erase_if(tests, [&](const PluginTest& test) {
    return (arguments.untimed && test.alone) || !std::regex_search(test.name, only);
  });
  return tests;
}

/// Runs one test in this process: for a debugger, or for the parent process that reads --answer.
int run_here(const Arguments& arguments, const PluginTest& test, const CheckedLibrary& library) {
  Outcome outcome;
  host::keep_script_processes();
  try {
    outcome = test.run();
  } catch (const std::exception& error) {
    outcome.findings.push_back({"Process: the test can be run", error.what()});
  }
  if (!arguments.answer.empty()) {
    host::write_file(arguments.answer, outcome_text(outcome));
    return kDone;
  }
  Verdict verdict;
  verdict.test = test.name;
  verdict.findings = outcome.findings;
  verdict.skipped = outcome.skipped;
  std::cout << verdict_text(library, verdict);
  return verdict.failed() ? kBadPlugin : kDone;
}

/// Runs each test in its own process and prints the verdicts as they arrive.
std::vector<Verdict> verdicts_of(const Arguments& arguments, const std::vector<PluginTest>& tests,
                                 const CheckedLibrary& library, RunnerOptions options) {
  options.jobs = arguments.jobs;
  options.time_limit_s = arguments.time_limit_s;
  options.memory_limit_mb = arguments.memory_limit_mb;
  const Interrupt interrupt;
  options.stop = interrupt.token();
  ProgressLine progress;
  std::size_t done = 0;
  std::vector<Verdict> verdicts = run_apart(tests, options, [&](const Verdict& verdict) {
    progress.clear();
    if (!arguments.json && (verdict.failed() || log_level() == LogLevel::info)) {
      std::cout << verdict_text(library, verdict) << std::flush;
    }
    progress.show(std::to_string(++done) + " of " + std::to_string(tests.size()) + " tests");
  });
  progress.clear();
  return verdicts;
}

/// The exit code for the verdicts of that many tests.
int exit_code(const std::vector<Verdict>& verdicts, std::size_t tests) {
  if (verdicts.size() < tests) {
    std::cerr << "altiplan: check-plugin: interrupted, " << tests - verdicts.size()
              << " tests were not run\n";
    return kInterrupted;
  }
  if (std::any_of(verdicts.begin(), verdicts.end(),
                  [](const Verdict& verdict) { return verdict.failed(); })) {
    return kBadPlugin;
  }
  const auto misfit = std::find_if(verdicts.begin(), verdicts.end(),
                                   [](const Verdict& verdict) { return verdict.misfit; });
  if (misfit != verdicts.end()) {
    throw Error(misfit->test + " and others were skipped: " + misfit->skipped);
  }
  return kDone;
}

int check_plugin(const Arguments& arguments) {
  make_plugin_path_absolute();
  const PluginToCheck what = plugin_of(arguments);
  const std::vector<PluginTest> tests = chosen(arguments, what);
  if (tests.empty()) {
    std::cerr << "altiplan: check-plugin: --only: no test of " << arguments.library
              << " has a name that matches '" << arguments.only << "' (--list shows them)\n";
    return kUsage;
  }
  if (arguments.list) {
    for (const PluginTest& test : tests) {
      std::cout << test.name << '\n';
    }
    return kDone;
  }
  RunnerOptions options;
  options.command = command_of(arguments, what);
  CheckedLibrary library{arguments.library, host::examine_library(what.library).build, what.seed, 0,
                         ""};
  for (const std::string& word : options.command) {
    library.command += (library.command.empty() ? "" : " ") + study::report::shell(word);
  }
  if (arguments.here) {
    if (tests.size() > 1) {
      std::cerr << "altiplan: check-plugin: --here runs one test, and --only selects "
                << tests.size() << '\n';
      return kUsage;
    }
    return run_here(arguments, tests.front(), library);
  }
  if (!arguments.junit.empty()) {
    expect_writable(arguments.junit, "--junit");
  }
  const auto from = Clock::now();
  const std::vector<Verdict> verdicts = verdicts_of(arguments, tests, library, std::move(options));
  library.time_s = std::chrono::duration<double>(Clock::now() - from).count();
  std::cout << (arguments.json ? host::file_text(verdicts_json(library, verdicts))
                               : summary_text(library, verdicts))
            << std::flush;  // before the JUnit file, whose writing may fail
  if (!arguments.junit.empty()) {
    host::write_file(arguments.junit, verdicts_junit(library, verdicts));
  }
  return exit_code(verdicts, tests.size());
}

std::string regex_problem(const std::string& text) {
  try {
    const std::regex parsed(text);
    return "";
  } catch (const std::regex_error& error) {
    return "expected a regular expression, found '" + text + "'";
  }
}
}  // namespace

void add_check_plugin(App& app, Action& action) {
  auto [command, arguments] =
      add_command<Arguments>(app, action, "check-plugin",
                             "check a plugin against the contract of its interface, each test "
                             "in its own process",
                             check_plugin);
  command
      .add_option("library LIB", arguments.library,
                  "plugin library (.so), or plugins in Python (.py)")
      ->required();
  command
      .add_option("--only RE", arguments.only,
                  "run only tests whose name matches this regular expression")
      ->check(regex_problem);
  command.add_option("--seed N", arguments.overrides.seed, "random seed of the tests (default 1)")
      ->check(seed_problem);
  command
      .add_option("--rounds N", arguments.rounds,
                  "number of random worlds, routes or samples per test")
      ->check(Check::between(1, 1'000'000))
      ->capture_default_str();
  command.add_option("--sets FILE", arguments.sets,
                     "parameter sets to check the plugin with, see docs/reference/conformance.md "
                     "(default: the plugin's defaults)");
  add_plugin_path(command, arguments.overrides);
  command
      .add_option("--jobs N", arguments.jobs,
                  "number of parallel tests (default: number of processors)")
      ->check(Check::between(1, 1024));
  command.add_option("--time-limit S", arguments.time_limit_s, "time limit of a test (s)")
      ->check(number_from(0.01, 86400))
      ->capture_default_str();
  command.add_option("--memory-limit MB", arguments.memory_limit_mb, "memory limit of a test (MB)")
      ->check(number_from(1, 1e9))
      ->capture_default_str();
  command.add_flag("--untimed", arguments.untimed, "skip the tests that measure time");
  command.add_flag("--list", arguments.list, "print the test names without running any");
  Option* here =
      command.add_flag("--here", arguments.here,
                       "run the single test selected by --only in this process, for a debugger");
  command.add_flag("--json", arguments.json, "print as JSON")->excludes(here);
  command.add_option("--junit FILE", arguments.junit, "also write the verdicts as JUnit XML")
      ->excludes(here);
  command.add_option("--answer", arguments.answer)->hide();  // internal, from the parent
  set_example(command, "altiplan check-plugin build/libaltiplan_planner_my_planner.so");
}
}  // namespace altiplan::cli
