// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "altiplan/kit/lattice/bit_lines.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/lattice/open_list.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/voxel_grid.hpp"

/// \file What the search works on. Lengths along x and y are in cells, from the lower corner of the
/// level: cell (i, j) is the square from (i, j) to (i + 1, j + 1), line k holds the points of y =
/// k, and row j lies between the lines j and j + 1.
namespace altiplan::anya {

struct Point {
  double x, y;
};

/// The least whole number that is not below x >= 0.
inline int upper(double x) {
  const int down = int(x);
  return down + (down < x);
}

/// Whether a route may pass between two blocked cells that meet at a corner.
enum class Corner {
  any,       ///< it may
  one_free,  ///< of the cells beside a step across a corner, one must be free
};

/// Free cells of a row in sequence: the points from x = left to x = right.
struct Run {
  int left, right;
  bool holds(double x) const { return left <= x && x <= right; }
};

/// The cells of a level, read by words.
class Level {
 public:
  Level(const VoxelGrid& grid, const Vec3& cell)
      : rows_(grid.row_words(0, 0), grid.words_per_row()),
        counts_{grid.spec().counts},
        edge_x_(cell.x()),
        edge_y_(cell.y()) {}

  int width() const { return counts_[0]; }
  int height() const { return counts_[1]; }
  std::size_t corners() const { return std::size_t(width() + 1) * std::size_t(height() + 1); }
  std::size_t corner(int x, int line) const {
    return std::size_t(line) * std::size_t(width() + 1) + std::size_t(x);
  }
  bool blocked(int row, int x) const {
    return (kit::BitLines::window<true>(rows_.line(row), x) & 1) != 0;
  }
  /// The first blocked cell of a row from x on, or the first free one below `limit`.
  int first_blocked(int row, int x) const { return kit::first_blocked<true>(rows_.line(row), x); }
  int first_free(int row, int x, int limit) const {
    return kit::first_free(rows_.line(row), x, limit);
  }
  /// The run that contains a free cell.
  Run run(int row, int x) const {
    return {kit::first_blocked<false>(rows_.line(row), x) + 1, first_blocked(row, x)};
  }
  /// The run of a row that the point touches.
  std::optional<Run> run_at(int row, double x) const {
    if (row < 0 || row >= height() || !(x >= 0 && x <= width())) {
      return std::nullopt;
    }
    const int cell = std::min(int(x), width() - 1);
    if (!blocked(row, cell)) {
      return run(row, cell);
    }
    if (x == cell && cell > 0 && !blocked(row, cell - 1)) {
      return run(row, cell - 1);
    }
    return std::nullopt;
  }
  /// Where a straight path along a line, ahead (kAhead: x rises) of x, can turn next, around a
  /// blocked cell that ends beside it; nothing if it gets stuck first, then at `end`.
  template <bool kAhead>
  std::optional<int> next_turn(int line, int x, Corner rule, int& end) const;

  /// Metres.
  double length(double along_x, double along_y) const {
    const double x = along_x * edge_x_;
    const double y = along_y * edge_y_;
    return std::sqrt(x * x + y * y);
  }

 private:
  kit::BitLines rows_;
  Cell counts_;
  double edge_x_;
  double edge_y_;
};

template <bool kAhead>
std::optional<int> Level::next_turn(int line, int x, Corner rule, int& end) const {
  constexpr int kCells = kit::BitLines::kWindow - 1;
  constexpr std::uint64_t kLow = (std::uint64_t{1} << kit::BitLines::kWindow) - 1;
  constexpr std::uint64_t kJudged = kAhead ? kLow : kLow << (64 - kit::BitLines::kWindow);
  constexpr int kStep = kAhead ? 1 : -1;
  const auto previous = [](std::uint64_t window) { return kAhead ? window << 1 : window >> 1; };
  const auto holds = [](std::uint64_t window, int n) {
    return (window << (kAhead ? 63 - n : n) >> 63) != 0;
  };
  for (;; x += kStep * kCells) {
    const int cell = kAhead ? x : x - 1;
    const std::uint64_t above = kit::BitLines::window<kAhead>(rows_.line(line), cell);
    const std::uint64_t below = kit::BitLines::window<kAhead>(rows_.line(line - 1), cell);
    const std::uint64_t ends = (previous(above) & ~above) | (previous(below) & ~below);
    const std::uint64_t both = above & below;
    const std::uint64_t stops = (ends | both) & kJudged;
    if (stops == 0) {
      continue;
    }
    const int n = kAhead ? std::countr_zero(stops) : std::countl_zero(stops);
    end = x + kStep * n;
    const bool passable = rule == Corner::any || !(holds(above, n) || holds(below, n));
    return holds(both, n) || !passable ? std::nullopt : std::optional(end);
  }
}

/// A point where paths turn, or a start.
struct Root {
  double x, y;
  double g;
  std::uint32_t parent;
  std::size_t corner;
};

/// A direction from a root; its slope is kept as two numbers that have no rounding, so that a ray
/// through a corner is known to pass through it.
struct Ray {
  double x, y;
  /// Where it crosses a line.
  double at(const Root& root, int line) const { return root.x + (line - root.y) * x / y; }
};

/// A search node (I, r).
struct Node {
  enum class Kind : std::uint8_t {
    cone,  ///< all points of I are visible from r, which lies behind the line of I; the path goes
           ///< on into the row beyond
    flat,  ///< the path runs along the line of r to the corner `from`
    goal,  ///< the end of a route
  };
  double from = 0;  ///< I = [from, to]
  double to = 0;
  Ray left{0, 0};  ///< through `from`
  Ray right{0, 0};
  int line = 0;
  std::uint32_t root = 0;
  std::uint32_t target = 0;  ///< of a goal
  Kind kind = Kind::cone;
  bool ahead = true;   ///< of a flat node: x rises along the path
  bool bends = false;  ///< of a goal: the route turns at `from` on `line`

  /// Starts the interval at x, where `ray` meets its line, but not before `bound`.
  void cut_left(const Root& r, double x, int bound, const Ray& ray) {
    const bool cut = x < bound;
    from = cut ? bound : x;
    left = cut ? Ray{bound - r.x, line - r.y} : ray;
  }
  /// Ends it at x, but not beyond `bound`.
  void cut_right(const Root& r, double x, int bound, const Ray& ray) {
    const bool cut = x > bound;
    to = cut ? bound : x;
    right = cut ? Ray{bound - r.x, line - r.y} : ray;
  }
};

/// A point to reach, and the length of the route beyond it.
struct Target {
  struct Part {
    int row;
    Run run;
  };
  Point at{0, 0};
  double g = 0;
  std::vector<Part> parts;  ///< the runs that it touches

  /// True if it lies in the run that contains the interval.
  bool beside(int row, double from, double to) const {
    return std::any_of(parts.begin(), parts.end(), [&](const Part& part) {
      return part.row == row && from < part.run.right && to > part.run.left;
    });
  }
};

/// Work memory of a search.
struct Memory {
  kit::ScratchArray<std::uint32_t, 256> root_at;  ///< of each corner, its best root + 1; 0: none
  std::vector<Root> roots;
  std::vector<Node> nodes;
  std::vector<std::uint32_t> unused;  ///< nodes
  std::vector<Node> successors;
  kit::OpenList open;

  /// The number of a node that is kept until it is taken.
  std::uint32_t keep(const Node& node) {
    if (unused.empty()) {
      nodes.push_back(node);
      return std::uint32_t(nodes.size() - 1);
    }
    const std::uint32_t number = unused.back();
    unused.pop_back();
    nodes[number] = node;
    return number;
  }
  Node take(std::uint32_t number) {
    unused.push_back(number);
    return nodes[number];
  }

  /// Without the lists that grow with the search.
  static constexpr double kBytesPerCell = 4.3;
  /// Of those lists: of what is in them, as what an earlier search left them must not count.
  std::size_t bytes() const {
    return roots.size() * sizeof(Root) + nodes.size() * (sizeof(Node) + sizeof(std::uint32_t)) +
           open.size() * sizeof(kit::OpenList::Entry);
  }
};
}  // namespace altiplan::anya
