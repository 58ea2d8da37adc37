// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "reference/level_maps.hpp"

// The exact shortest route of any angle on a level of cells: it bends only at corners of blocked
// cells, so it is a shortest way in the graph of corners that see each other. Blocked cells are
// open squares: a route may touch them, but not lead along an edge that two of them share. Points
// are whole numbers of 1/64 of a cell, so that no answer is rounded. For small maps: O(corners² ·
// cells).
namespace altiplan::reference {

class CellCorners {
 public:
  static constexpr int kUnit = 64;  ///< of a cell's edge
  struct Point {
    std::int64_t x, y;
  };

  /// `pinched`: a route may pass between two blocked cells that meet at a corner. If it may not,
  /// such a corner is an end of free cells on both sides, where no shortest route bends.
  CellCorners(const testing::Map& map, bool pinched) : map_(map), pinched_(pinched) {
    for (int y = 0; y <= map.height; ++y) {
      for (int x = 0; x <= map.width; ++x) {
        const int free = free_around(x, y);
        if (free == 3 || (is_pinched(x, y) && pinched)) {
          corners_.push_back({std::int64_t{x} * kUnit, std::int64_t{y} * kUnit});
        }
      }
    }
    seen_.resize(corners_.size());
    for (std::size_t a = 0; a < corners_.size(); ++a) {
      for (std::size_t b = 0; b < corners_.size(); ++b) {
        if (a != b && sees(corners_[a], corners_[b])) {
          seen_[a].push_back(b);
        }
      }
    }
  }

  /// Metres; infinite where there is no route. Both ends must touch a free cell.
  double shortest(const Point& start, const Point& goal) const {
    double best = sees(start, goal) ? length(start, goal) : kInfinity;
    std::vector<double> to(corners_.size(), kInfinity);
    std::vector<char> closed(corners_.size(), 0);
    for (std::size_t n = 0; n < corners_.size(); ++n) {
      to[n] = sees(start, corners_[n]) ? length(start, corners_[n]) : kInfinity;
    }
    for (;;) {
      std::size_t here = corners_.size();
      for (std::size_t n = 0; n < corners_.size(); ++n) {
        if (!closed[n] && to[n] < (here < corners_.size() ? to[here] : kInfinity)) {
          here = n;
        }
      }
      if (here == corners_.size()) {
        return best;
      }
      closed[here] = 1;
      if (sees(corners_[here], goal)) {
        best = std::min(best, to[here] + length(corners_[here], goal));
      }
      for (const std::size_t next : seen_[here]) {
        to[next] = std::min(to[next], to[here] + length(corners_[here], corners_[next]));
      }
    }
  }

  /// Whether the point lies in or beside a free cell.
  bool touches_free(const Point& p) const {
    for (const std::int64_t x : {p.x, p.x - 1}) {
      for (const std::int64_t y : {p.y, p.y - 1}) {
        if (x >= 0 && y >= 0 && map_.free(int(x / kUnit), int(y / kUnit))) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  int free_around(int x, int y) const {
    return map_.free(x, y) + map_.free(x - 1, y) + map_.free(x, y - 1) + map_.free(x - 1, y - 1);
  }
  bool is_pinched(int x, int y) const {
    return free_around(x, y) == 2 && map_.free(x, y) == map_.free(x - 1, y - 1);
  }
  double length(const Point& a, const Point& b) const {
    return Vec3(double(b.x - a.x) * map_.cell.x(), double(b.y - a.y) * map_.cell.y(), 0).norm() /
           kUnit;
  }

  bool sees(const Point& a, const Point& b) const {
    const auto [x0, x1] = std::minmax(a.x, b.x);
    const auto [y0, y1] = std::minmax(a.y, b.y);
    for (std::int64_t j = y0 / kUnit - 1; j <= y1 / kUnit; ++j) {
      for (std::int64_t i = x0 / kUnit - 1; i <= x1 / kUnit; ++i) {
        if (!map_.free(int(i), int(j)) && bars(a, b, int(i), int(j))) {
          return false;
        }
      }
    }
    return true;
  }

  /// Whether the leg a–b meets the inside of the blocked cell (i, j), runs along an edge that it
  /// shares with a blocked one after it, or passes its upper corners between blocked cells.
  bool bars(const Point& a, const Point& b, int i, int j) const {
    const std::int64_t left = std::int64_t{i} * kUnit;
    const std::int64_t right = left + kUnit;
    const std::int64_t low = std::int64_t{j} * kUnit;
    const std::int64_t high = low + kUnit;
    const std::int64_t x0 = std::min(a.x, b.x);
    const std::int64_t x1 = std::max(a.x, b.x);
    const std::int64_t y0 = std::min(a.y, b.y);
    const std::int64_t y1 = std::max(a.y, b.y);
    const bool beside_x = x1 > left && x0 < right;
    const bool beside_y = y1 > low && y0 < high;
    if (x0 == right && x1 == right && beside_y && !map_.free(i + 1, j)) {
      return true;
    }
    if (y0 == high && y1 == high && beside_x && !map_.free(i, j + 1)) {
      return true;
    }
    const std::array<std::int64_t, 4> sides{side(a, b, {left, low}), side(a, b, {right, low}),
                                            side(a, b, {left, high}), side(a, b, {right, high})};
    if (beside_x && beside_y && *std::min_element(sides.begin(), sides.end()) < 0 &&
        *std::max_element(sides.begin(), sides.end()) > 0) {
      return true;
    }
    const auto passes = [&](std::int64_t x, std::int64_t at_side) {
      return at_side == 0 && x0 <= x && x <= x1 && y0 <= high && high <= y1 &&
             !(x == a.x && high == a.y) && !(x == b.x && high == b.y);
    };
    return !pinched_ && ((passes(left, sides[2]) && is_pinched(i, j + 1)) ||
                         (passes(right, sides[3]) && is_pinched(i + 1, j + 1)));
  }

  static std::int64_t side(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }

  const testing::Map& map_;
  bool pinched_;
  std::vector<Point> corners_;
  std::vector<std::vector<std::size_t>> seen_;
};
}  // namespace altiplan::reference
