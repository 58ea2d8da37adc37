// SPDX-License-Identifier: Apache-2.0
#include "plain_astar.hpp"

#include <algorithm>
#include <cmath>
#include <queue>

namespace altiplan::bench {

double octile(const Cell& a, const Cell& b) {
  std::array<double, 3> n{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    n[axis] = std::abs(a[axis] - b[axis]);
  }
  std::sort(n.begin(), n.end());
  return n[0] * std::sqrt(3.0) + (n[1] - n[0]) * std::sqrt(2.0) + (n[2] - n[1]);
}

namespace {

struct Open {
  double f;
  double g;
  std::size_t index;
  bool operator<(const Open& other) const {  // the heap's top is the greatest
    return f != other.f ? f > other.f : g < other.g;
  }
};
}  // namespace

PlainResult plain_astar(const VoxelGrid& grid, const Cell& start, const Cell& goal) {
  const Cell& counts = grid.spec().counts;
  const auto index_of = [&](const Cell& c) {
    return (std::size_t(c[2]) * std::size_t(counts[1]) + std::size_t(c[1])) *
               std::size_t(counts[0]) +
           std::size_t(c[0]);
  };
  const int rise = counts[2] == 1 ? 0 : 1;
  std::vector<double> best(grid.spec().cell_count(), kInfinity);
  std::vector<bool> closed(best.size(), false);
  std::priority_queue<Open> open;
  best[index_of(start)] = 0;
  open.push({octile(start, goal), 0, index_of(start)});
  PlainResult result;
  while (!open.empty()) {
    const Open node = open.top();
    open.pop();
    if (closed[node.index]) {
      continue;
    }
    closed[node.index] = true;
    ++result.expanded;
    const Cell c = {int(node.index % std::size_t(counts[0])),
                    int(node.index / std::size_t(counts[0]) % std::size_t(counts[1])),
                    int(node.index / std::size_t(counts[0]) / std::size_t(counts[1]))};
    if (c == goal) {
      result.length = node.g * grid.spec().cell.x();
      break;
    }
    for (int dz = -rise; dz <= rise; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Cell next = {c[0] + dx, c[1] + dy, c[2] + dz};
          if (grid.blocked(next) || closed[index_of(next)]) {
            continue;
          }
          const double g = node.g + std::sqrt(double(dx * dx + dy * dy + dz * dz));
          if (g < best[index_of(next)]) {
            best[index_of(next)] = g;
            open.push({g + octile(next, goal), g, index_of(next)});
          }
        }
      }
    }
  }
  return result;
}
}  // namespace altiplan::bench
