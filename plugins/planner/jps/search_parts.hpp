// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "altiplan/kit/lattice/bucket_queue.hpp"
#include "altiplan/kit/lattice/step_costs.hpp"
#include "altiplan/kit/scratch.hpp"
#include "bit_lines.hpp"

namespace altiplan::jps {

struct Memory {
  kit::ScratchArray<std::uint32_t, 256> nodes;
  kit::BucketQueue open;
  Columns columns;

  /// Bytes a cell without the open list.
  static constexpr double kBytesPerCell = 4.3;
};

/// What is known of a cell, in four bytes: g as what is left of the most that fits, above the
/// direction of the straight run of steps that led there. 0: not reached; greater: nearer.
class NodeWord {
 public:
  static constexpr std::uint32_t kMax = (std::uint32_t{1} << 28) - 1;  ///< g is below

  static std::uint32_t of(std::uint32_t g, int in) {
    return (kMax - g) << 4 | std::uint32_t(in - kFirst);
  }
  static std::uint32_t g(std::uint32_t word) { return kMax - (word >> 4); }
  static int in(std::uint32_t word) { return int(word & 15) + kFirst; }
  /// Whether a is a shorter way than b.
  static bool nearer(std::uint32_t a, std::uint32_t b) { return a >> 4 > b >> 4; }

 private:
  static constexpr int kFirst = kit::direction(-1, -1, 0);
};

/// A cell from which the goal is one leg away.
struct GoalCell {
  std::uint32_t index;
  int x, y;
  std::uint32_t cost;  ///< of the leg
};

/// Those cells; every run stops at one.
class GoalCells {
 public:
  void add(const GoalCell& cell) {
    low_x_ = cells_.empty() ? cell.x : std::min(low_x_, cell.x);
    low_y_ = cells_.empty() ? cell.y : std::min(low_y_, cell.y);
    high_x_ = std::max(high_x_, cell.x);
    high_y_ = std::max(high_y_, cell.y);
    cells_.push_back(cell);
  }
  std::vector<GoalCell>::const_iterator begin() const { return cells_.begin(); }
  std::vector<GoalCell>::const_iterator end() const { return cells_.end(); }

  bool holds(int x, int y) const {
    return y >= low_y_ && y <= high_y_ &&
           std::any_of(cells_.begin(), cells_.end(),
                       [&](const GoalCell& cell) { return cell.x == x && cell.y == y; });
  }

  /// What a straight run from a cell comes to that without these cells came to `found` (see
  /// Strip::scan).
  template <bool kAlongX, bool kAhead>
  int stopped(int x, int y, int found) const {
    if (kAlongX ? y < low_y_ || y > high_y_ : x < low_x_ || x > high_x_) {
      return found;
    }
    for (const GoalCell& cell : cells_) {
      const int off = kAlongX ? cell.x - x : cell.y - y;
      const int n = kAhead ? off : -off;
      if ((kAlongX ? cell.y == y : cell.x == x) && n > 0 && n < std::abs(found)) {
        found = n;
      }
    }
    return found;
  }

 private:
  std::vector<GoalCell> cells_;
  int low_x_ = 0;
  int low_y_ = 0;
  int high_x_ = -1;
  int high_y_ = -1;
};

/// Whole-number costs of the steps on a level.
struct LevelCosts {
  std::uint32_t x, y, xy;

  explicit LevelCosts(const kit::StepCosts& costs)
      : x(costs[kit::direction(1, 0, 0)]),
        y(costs[kit::direction(0, 1, 0)]),
        xy(costs[kit::direction(1, 1, 0)]) {}
  /// Of the cheapest way between cells so far apart if none were blocked.
  std::uint32_t apart(int along_x, int along_y) const {
    const auto nx = std::uint32_t(std::abs(along_x));
    const auto ny = std::uint32_t(std::abs(along_y));
    const std::uint32_t both = std::min(nx, ny);
    return both * xy + (nx - both) * x + (ny - both) * y;
  }
};
}  // namespace altiplan::jps
