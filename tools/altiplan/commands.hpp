// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "command_line.hpp"
#include "guarded.hpp"
#include "host/config/config.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::cli {

/// The work of a subcommand, run once the command line is parsed; returns the exit code.
using Action = std::function<int()>;

/// Adds a subcommand. Its options are to fill the returned arguments; once they are parsed,
/// `prepare` may complete them or throw UsageError, and the action becomes to call `run` with them.
template <class Arguments>
std::pair<App&, Arguments&> add_command(
    App& app, Action& action, const std::string& name, const std::string& description,
    const std::function<int(const Arguments&)>& run,
    const std::function<void(Arguments&)>& prepare = [](Arguments&) {}) {
  App* command = app.add_subcommand(name, description);
  const auto arguments = std::make_shared<Arguments>();
  command->callback([&action, arguments, run, prepare] {
    prepare(*arguments);
    action = [arguments, run] { return run(*arguments); };
  });
  return {*command, *arguments};
}

/// Does what the command line says, with the commands that `add_commands` adds; returns the exit
/// code.
int run_program(int argc, char** argv, const std::function<void(App&, Action&)>& add_commands);

// Each adds its subcommand, which sets the action when it is called.
void add_run(App& app, Action& action);
void add_go(App& app, Action& action);
void add_survey(App& app, Action& action);
void add_info(App& app, Action& action);
void add_validate(App& app, Action& action);
void add_set(App& app, Action& action);
void add_explain(App& app, Action& action);
void add_check(App& app, Action& action);
void add_export(App& app, Action& action);
void add_upload(App& app, Action& action);
void add_fly(App& app, Action& action);
void add_download(App& app, Action& action);
void add_status(App& app, Action& action);
void add_plugins(App& app, Action& action);
void add_view(App& app, Action& action);
void add_edit(App& app, Action& action);
void add_merge(App& app, Action& action);
void add_replay(App& app, Action& action);
void add_compare(App& app, Action& action);
void add_slurm(App& app, Action& action);
void add_study(App& app, Action& action, const std::string& command_line);
void add_report(App& app, Action& action);
void add_reproduce(App& app, Action& action, const std::string& command_line);
void add_tune(App& app, Action& action);
void add_new(App& app, Action& action);
void add_check_plugin(App& app, Action& action);
void add_completion(App& app, Action& action);
/// Last: it knows the names of the others.
void add_man(App& app, Action& action);

/// Adds --plugin-path.
void add_plugin_path(App& command, host::Overrides& overrides);
/// Adds --plugin-path, --scenario, --seed and --set.
void add_overrides(App& command, host::Overrides& overrides);

/// Accepts a number in the range, and no NaN.
Check number_from(double low, double high);
/// The error message for a seed, or for KEY=VALUE; "" if it is valid.
std::string seed_problem(const std::string& text);
std::string assignment_problem(const std::string& text);

/// Adds the example to the --help text.
void set_example(App& command, const std::string& example);

enum class LogLevel { quiet, warning, info };
LogLevel& log_level();
/// Prints one line on stderr, subject to the log level.
void warn(const std::string& message);
void info(const std::string& message);

/// Checks before any computation that the file can be written: throws Error naming the option if
/// its folder does not exist or the file is not writable.
void expect_writable(const std::optional<std::string>& file, const char* option);
/// The same for a study's database, following links; it must not be the file that stdout or stderr
/// is redirected to.
void expect_store_writable(const std::string& store, const char* option);
/// Throws Error if the file is one of the others, which the same call reads or writes.
void expect_apart(const std::optional<std::string>& file, const char* option,
                  const std::vector<std::string>& others);
/// The result's file and its input files.
std::vector<std::string> files_of(const host::StoredResult& stored);

/// A fixed-point number for tables, "-" if there is no value.
std::string fixed(const std::optional<double>& value, int digits);
/// "45 s", "12 min", "3.5 h"
std::string duration(double seconds);
}  // namespace altiplan::cli
