// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "guarded.hpp"
#include "host/config/config.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::cli {

/// What a command left to be done once the command line is parsed; its value is the exit code.
using Action = std::function<int()>;

// Each adds its subcommand, and sets the action when it is the one called.
void add_run(CLI::App& app, Action& action);
void add_validate(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_plugins(CLI::App& app, Action& action);
void add_view(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_compare(CLI::App& app, Action& action);
void add_slurm(CLI::App& app, Action& action);
void add_study(CLI::App& app, Action& action, const std::string& command_line);
void add_report(CLI::App& app, Action& action);
void add_tune(CLI::App& app, Action& action);
void add_new(CLI::App& app, Action& action);
void add_check_plugin(CLI::App& app, Action& action);

/// --plugin-path, --seed, --set and --scenario as they are wanted.
void add_plugin_path(CLI::App& command, host::Overrides& overrides);
void add_overrides(CLI::App& command, host::Overrides& overrides);

/// A number in the range; CLI::Range lets NaN pass.
CLI::Validator number_from(double low, double high);
/// What is wrong with a seed, or with KEY=VALUE; "" where nothing is.
std::string seed_problem(const std::string& text);
std::string assignment_problem(const std::string& text);

/// "usage: …\nexample: …" for --help.
void set_example(CLI::App& command, const std::string& example);

enum class LogLevel { quiet, warning, info };
LogLevel& log_level();
/// A line on stderr.
void warn(const std::string& message);
void info(const std::string& message);

/// A folder that is not there, and what else forbids to write the file, is said before anything is
/// computed: throws Error naming the option.
void expect_writable(const std::optional<std::string>& file, const char* option);
/// The same of a study's database, to which a link may lead; nor may it be the file that stdout or
/// stderr of the call goes to.
void expect_store_writable(const std::string& store, const char* option);
/// Throws Error where the file is one of the others, which the call reads or writes.
void expect_apart(const std::optional<std::string>& file, const char* option,
                  const std::vector<std::string>& others);
/// The result's file, and those that it was made from.
std::vector<std::string> files_of(const host::StoredResult& stored);

/// A fixed-point number for tables, "-" where there is none.
std::string fixed(const std::optional<double>& value, int digits);
/// "45 s", "12 min", "3.5 h"
std::string duration(double seconds);
}  // namespace altiplan::cli
