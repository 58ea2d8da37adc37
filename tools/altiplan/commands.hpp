// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "guarded.hpp"
#include "host/config/config.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::cli {

/// The work of a subcommand, run once the command line is parsed; returns the exit code.
using Action = std::function<int()>;

// Each adds its subcommand, which sets the action when it is called.
void add_run(CLI::App& app, Action& action);
void add_validate(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_export(CLI::App& app, Action& action);
void add_upload(CLI::App& app, Action& action);
void add_fly(CLI::App& app, Action& action);
void add_download(CLI::App& app, Action& action);
void add_status(CLI::App& app, Action& action);
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

/// Adds --plugin-path.
void add_plugin_path(CLI::App& command, host::Overrides& overrides);
/// Adds --plugin-path, --scenario, --seed and --set.
void add_overrides(CLI::App& command, host::Overrides& overrides);

/// Accepts a number in the range; unlike CLI::Range, rejects NaN.
CLI::Validator number_from(double low, double high);
/// The error message for a seed, or for KEY=VALUE; "" if it is valid.
std::string seed_problem(const std::string& text);
std::string assignment_problem(const std::string& text);

/// Adds the example to the --help text.
void set_example(CLI::App& command, const std::string& example);

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
