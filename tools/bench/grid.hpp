// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace altiplan::bench {

struct GridArguments {
  std::string map;
  std::string scenarios;
  std::string planner = "astar";
  std::optional<std::string> corner;
  std::vector<std::string> with;  ///< further parameters of the planner, KEY=VALUE
  std::size_t limit = ~std::size_t{0};
  int repeat = 1;     ///< times that each scenario is planned; its time is the median
  bool each = false;  ///< a line for each scenario on stdout
  std::vector<std::filesystem::path> plugin_path;
};

/// Plans every scenario on the map, loaded once, and compares the lengths with those printed.
nlohmann::ordered_json run_grid(const GridArguments& arguments);
}  // namespace altiplan::bench
