// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace altiplan::host {

/// One line of a scenario file: cells in the map file's indices, and the published optimal length,
/// in cells.
struct GridScenario {
  std::array<double, 3> start{0, 0, 0};
  std::array<double, 3> goal{0, 0, 0};
  double length = 0;
  int decimals = 0;  ///< decimals of the published length
  int line = 0;
};

struct GridScenarios {
  bool is_3d = false;
  std::vector<GridScenario> list;
};

/// The numbers of cells (columns, rows, levels) of a MovingAI .map or a Warframe .3dmap, from its
/// first lines. Throws Error.
std::array<int, 3> grid_counts(const std::filesystem::path& map);

/// The first `limit` scenarios of a MovingAI .scen or a Warframe .3dscen file (by extension), for a
/// map of `counts` cells. Throws Error with file:line.
GridScenarios read_grid_scenarios(const std::filesystem::path& file,
                                  const std::array<int, 3>& counts, std::size_t limit);
}  // namespace altiplan::host
