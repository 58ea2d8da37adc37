// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "host/config/config.hpp"

namespace altiplan::cli {

/// What a command left to be done once the command line is parsed; its value is the exit code.
using Action = std::function<int()>;

inline constexpr int kDone = 0;
inline constexpr int kNoRoute = 1;
inline constexpr int kUsage = 2;
inline constexpr int kBadFile = 3;
inline constexpr int kBadPlugin = 4;
inline constexpr int kInternal = 5;
inline constexpr int kInterrupted = 130;

// Each adds its subcommand, and sets the action when it is the one called.
void add_run(CLI::App& app, Action& action);
void add_validate(CLI::App& app, Action& action);
void add_explain(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_plugins(CLI::App& app, Action& action);

/// --plugin-path, --seed, --set and --scenario as they are wanted.
void add_plugin_path(CLI::App& command, host::Overrides& overrides);
void add_overrides(CLI::App& command, host::Overrides& overrides);

/// "usage: …\nexample: …" for --help.
void set_example(CLI::App& command, const std::string& example);

enum class LogLevel { quiet, warning, info };
LogLevel& log_level();
/// A line on stderr.
void warn(const std::string& message);
void info(const std::string& message);

/// A fixed-point number for tables, "-" where there is none.
std::string fixed(const std::optional<double>& value, int digits);
}  // namespace altiplan::cli
