// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/random.hpp"

namespace altiplan::testing {

/// Levels of random cells, start and goal free.
inline std::vector<std::string> random_levels(SplitMix64& random, int nx, int ny, int nz,
                                              double density) {
  const std::size_t row = std::size_t(nx) + 1;
  std::vector<std::string> levels;
  for (int k = 0; k < nz; ++k) {
    std::string level(std::size_t(ny) * row, '\n');
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (i % row != std::size_t(nx)) {
        level[i] = random.uniform() < density ? '#' : '.';
      }
    }
    levels.push_back(level);
  }
  const auto place = [&](char what) {
    auto& level = levels[std::size_t(random.integer(0, nz - 1))];
    std::size_t at = 0;
    do {
      at = std::size_t(random.integer(0, ny - 1)) * row + std::size_t(random.integer(0, nx - 1));
    } while (level[at] == 'S');
    level[at] = what;
  };
  place('S');
  place('G');
  return levels;
}
}  // namespace altiplan::testing
