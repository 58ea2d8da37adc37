// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "study/statistics/statistics.hpp"

namespace altiplan::study {

std::vector<std::size_t> non_dominated(std::span<const Place> points) {
  std::vector<std::size_t> front;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Place& p = points[i];
    const bool is_dominated = std::any_of(points.begin(), points.end(), [&](const Place& q) {
      return q[0] <= p[0] && q[1] <= p[1] && q != p;
    });
    if (!is_dominated) {
      front.push_back(i);
    }
  }
  std::stable_sort(front.begin(), front.end(),
                   [&](std::size_t a, std::size_t b) { return points[a] < points[b]; });
  return front;
}

double hypervolume(std::span<const Place> points, const Place& reference) {
  double area = 0;
  double ceiling = reference[1];
  // Along the front the first coordinate rises and the second falls: rectangles, one per point.
  for (const std::size_t at : non_dominated(points)) {
    const auto& [x, y] = points[at];
    if (x < reference[0] && y < ceiling) {
      area += (reference[0] - x) * (ceiling - y);
      ceiling = y;
    }
  }
  return area;
}
}  // namespace altiplan::study
