// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

namespace altiplan::host {

/// Distances from the route of a vehicle that follows it, over time.
class FollowError {
 public:
  /// For dt seconds: horizontal distance to the nearest point of the route, and difference in
  /// height to it, metres.
  void add(double across, double height, double dt) {
    across_.emplace_back(across, dt);
    height_max_ = std::max(height_max_.value_or(0), std::abs(height));
  }
  /// The smallest horizontal distance that is exceeded for at most 1 - `share` of the time.
  std::optional<double> across_quantile(double share) const {
    if (across_.empty()) {
      return std::nullopt;
    }
    std::vector<std::pair<double, double>> sorted = across_;
    std::sort(sorted.begin(), sorted.end());
    double total = 0;
    for (const auto& [error, dt] : sorted) {
      total += dt;
    }
    double left = (1 - share) * total;
    std::size_t i = sorted.size() - 1;
    for (; i > 0 && sorted[i].second <= left; --i) {
      left -= sorted[i].second;
    }
    return sorted[i].first;
  }
  std::optional<double> height_max() const { return height_max_; }

 private:
  std::vector<std::pair<double, double>> across_;  ///< metres, seconds
  std::optional<double> height_max_;
};
}  // namespace altiplan::host
