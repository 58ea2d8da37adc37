// SPDX-License-Identifier: Apache-2.0
#include "subcommand.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "altiplan/error.hpp"

namespace altiplan::bench {
namespace {

/// Four digits, or all digits before the decimal point.
std::string text_of(const Json& value) {
  if (value.is_string()) {
    return value.get<std::string>();
  }
  if (!value.is_number_float()) {
    return host::exact_json_text(value);
  }
  const double number = value;
  char text[64];
  std::snprintf(text, sizeof text, std::abs(number) < 1000 ? "%.4g" : "%.0f", number);
  return std::isfinite(number) ? text : "-";
}

void print_table(const std::string& title, const Json& rows) {
  std::vector<std::vector<std::string>> lines(1 + rows.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    for (const auto& [key, value] : rows[n].items()) {
      if (n == 0) {
        lines[0].push_back(key);
      }
      lines[n + 1].push_back(text_of(value));
    }
  }
  std::printf("\n%s\n", title.c_str());
  for (const std::vector<std::string>& line : lines) {
    for (std::size_t column = 0; column < line.size(); ++column) {
      std::size_t width = 0;
      for (const std::vector<std::string>& other : lines) {
        width = std::max(width, other[column].size());
      }
      // Row names left-aligned, figures right-aligned.
      std::printf(column == 0 ? "%-*s" : "  %*s", int(width), line[column].c_str());
    }
    std::printf("\n");
  }
}

void print(const Json& figures) {
  for (const auto& [key, value] : figures.items()) {
    if (value.is_array()) {
      print_table(key, value);
    } else {
      std::printf("%-17s %s\n", key.c_str(), text_of(value).c_str());
    }
  }
}
}  // namespace

CLI::App& Subcommands::add(const std::string& name, const std::string& sentence, Measure measure) {
  CLI::App* command = app_.add_subcommand(name, sentence);
  command->add_option("--plugin-path", plugin_path_, "folder of plugin libraries")
      ->type_name("DIR");
  command->add_flag("--json", as_json_, "print as one JSON object");
  all_[command] = std::move(measure);
  return *command;
}

void Subcommands::leave_out(const std::string& name, const std::string& needs) {
  const std::string why = "left out of this build: needs " + needs;
  add(name, "(" + why + ")", [=](const Given&) -> Json {
    throw Error("'" + name + "' is " + why);
  }).allow_extras();
}

void Subcommands::run() const {
  CLI::App* command = app_.get_subcommands().front();
  const auto registry = std::make_shared<host::Registry>(host::Registry::search_path(plugin_path_));
  const Json figures = all_.at(command)({registry, as_json_, command->remaining()});
  if (as_json_ && !figures.is_null()) {
    std::cout << figures.dump(1) << '\n';
  } else {
    print(figures);
  }
}
}  // namespace altiplan::bench
