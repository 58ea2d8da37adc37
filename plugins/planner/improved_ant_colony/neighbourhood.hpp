// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace altiplan::improved_ant_colony {

/// Number of candidates in a neighbourhood; our reading of eq. (7).
constexpr std::int64_t candidates(int reach, int spacing) {
  return 8 * ((std::int64_t(reach) - 1) / std::max(std::int64_t(spacing) + 1, std::int64_t{1}) + 1);
}

/// The candidates of the asynchronous neighbourhood: cells on the border of a square, on each side
/// from both corners toward the middle, and the middle.
inline std::vector<std::array<int, 2>> ring(int reach, int spacing) {
  const auto is_place = [&](int along) {
    return along == 0 || (reach - std::abs(along)) % (spacing + 1) == 0;
  };
  std::vector<std::array<int, 2>> offsets;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x) {
      if (std::max(std::abs(x), std::abs(y)) == reach && is_place(x) && is_place(y)) {
        offsets.push_back({x, y});
      }
    }
  }
  return offsets;
}
}  // namespace altiplan::improved_ant_colony
