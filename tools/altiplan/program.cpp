// SPDX-License-Identifier: Apache-2.0
#include <malloc.h>

#include <charconv>
#include <csignal>
#include <cstdio>
#include <iostream>
#include <map>

#include "commands.hpp"
#include "host/config/overrides.hpp"
#include "host/plugins/unbuilt.hpp"
#include "interrupt.hpp"

namespace altiplan::cli {

LogLevel& log_level() {
  static LogLevel level = LogLevel::warning;
  return level;
}

void warn(const std::string& message) {
  if (log_level() != LogLevel::quiet) {
    std::cerr << "altiplan: warning: " << message << '\n';
  }
}

void info(const std::string& message) {
  if (log_level() == LogLevel::info) {
    std::cerr << "altiplan: " << message << '\n';
  }
}

void set_example(App& command, const std::string& example) {
  command.footer("Example:\n  " + example);
}

void add_plugin_path(App& command, host::Overrides& overrides) {
  command
      .add_option("--plugin-path DIR", overrides.plugin_path,
                  "folder of plugin libraries, searched before the default ones; repeatable")
      ->one_at_a_time()
      ->take_all();
}

void add_overrides(App& command, host::Overrides& overrides) {
  add_plugin_path(command, overrides);
  command.add_option("--scenario FILE", overrides.scenario,
                     "scenario file, overrides the pipeline's");
  command.add_option("--seed N", overrides.seed, "random seed, overrides the pipeline's")
      ->check(seed_problem);
  command
      .add_option(
          "--set KEY=VALUE", overrides.set,
          "override a key of the pipeline, or of the scenario as scenario.KEY; ~KEY removes it; "
          "repeatable")
      ->expected(1)
      ->take_all()
      ->check(assignment_problem);
}

Check number_from(double low, double high) {
  const std::string range =
      "from " + host::exact_json_text(low) + " to " + host::exact_json_text(high);
  return Check(
      [low, high, range](const std::string& text) {
        double value = 0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc() && stop == text.data() + text.size();
        return whole && value >= low && value <= high
                   ? std::string()
                   : "expected a number " + range + ", found '" + text + "'";
      },
      range);
}

std::string seed_problem(const std::string& text) {
  std::int64_t seed = -1;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), seed);
  const bool whole = error == std::errc() && stop == text.data() + text.size();
  return whole && seed >= 0
             ? ""
             : "expected a whole number from 0 to 9223372036854775807, found '" + text + "'";
}

std::string assignment_problem(const std::string& text) {
  try {
    host::parse_set(text);
    return "";
  } catch (const ConfigError&) {
    return "expected KEY=VALUE, or ~KEY to remove, found '" + text + "'";
  }
}

std::string fixed(const std::optional<double>& value, int digits) {
  if (!value) {
    return "-";
  }
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", digits, *value);
  return text;
}

std::string duration(double seconds) {
  if (std::isnan(seconds)) {
    return "unknown";
  }
  if (seconds > 0 && seconds < 0.1) {
    return fixed(1000 * seconds, 0) + " ms";
  }
  if (seconds < 1) {
    return fixed(seconds, 1) + " s";
  }
  return seconds < 100    ? fixed(seconds, 0) + " s"
         : seconds < 6000 ? fixed(seconds / 60, 0) + " min"
                          : fixed(seconds / 3600, 1) + " h";
}

namespace {

/// "" if it is a log level, which it sets.
std::string read_log_level(const std::string& text) {
  static const std::map<std::string, LogLevel> kLevels{
      {"quiet", LogLevel::quiet}, {"warning", LogLevel::warning}, {"info", LogLevel::info}};
  const auto level = kLevels.find(text);
  if (level == kLevels.end()) {
    return "expected quiet, warning or info, found '" + text + "'";
  }
  log_level() = level->second;
  return "";
}

int main_checked(int argc, char** argv, const std::function<void(App&, Action&)>& add_commands) {
  const auto begin = [] {  // first: on a busy machine a signal may arrive early
    catch_interrupts();
    return kDone;
  };
  if (const int code = guarded("altiplan", begin); code != kDone) {
    return code;
  }
  host::Unbuilt::allow();
  App app("Plans and judges routes for unmanned aircraft with plugins configured in YAML.",
          "altiplan");
  app.add_option_function("--log-level LEVEL", read_log_level,
                          "messages on stderr: quiet, warning or info (default warning)");
  set_example(app, "altiplan run configs/pipelines/ridge_crossing.yaml");
  Action action;
  add_commands(app, action);
  if (const std::optional<int> code = app.parse(argc, argv)) {
    return *code;
  }
  return guarded("altiplan", action);
}
}  // namespace

int run_program(int argc, char** argv, const std::function<void(App&, Action&)>& add_commands) {
  std::signal(SIGPIPE, SIG_IGN);  // a closed pipe is reported as a write error
  std::signal(SIGXFSZ, SIG_IGN);  // so is a file that reaches its size limit (ulimit -f)
  // Searches free and take again some megabytes at a time: memory that goes back to the system in
  // between is cleared by it again, which took half of the time of `go --wing`.
  mallopt(M_TOP_PAD, 16 << 20);
  return main_checked(argc, argv, add_commands);
}
}  // namespace altiplan::cli
