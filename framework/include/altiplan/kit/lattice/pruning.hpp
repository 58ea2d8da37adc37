// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdlib>
#include <vector>

#include "altiplan/kit/lattice/lattice.hpp"

namespace altiplan::kit {

/// Successors of a cell on its level, for one direction of the step into the cell: the neighbours
/// that no other path from the preceding cell reaches at most as late, with diagonal steps before
/// straight ones among equals. D. Harabor, A. Grastien: Online Graph Pruning for Pathfinding on
/// Grid Maps. AAAI 2011, doi:10.1609/aaai.v25i1.7994; without corners cut: Improving Jump Point
/// Search. ICAPS 2014, doi:10.1609/icaps.v24i1.13633.
struct Pruning {
  /// A blocked neighbour, and the neighbours that it makes unreachable otherwise.
  struct Forced {
    DirectionMask if_blocked = 0;
    DirectionMask kept = 0;
  };
  DirectionMask natural = 0;     ///< independent of blocked cells
  std::array<Forced, 2> forced;  ///< one per side
};

constexpr DirectionMask level_bit(int dx, int dy) {
  return DirectionMask{1} << direction(dx, dy, 0);
}

/// For a step (dx, dy); (0, 0), the start: all neighbours.
constexpr Pruning pruning_after(int dx, int dy, CornerRule rule) {
  Pruning pruning;
  if (dx == 0 && dy == 0) {
    for (int d = direction(-1, -1, 0); d <= direction(1, 1, 0); ++d) {
      pruning.natural |= DirectionMask{1} << d;
    }
    return pruning;
  }
  pruning.natural = level_bit(dx, dy);
  if (dx != 0 && dy != 0) {
    pruning.natural |= level_bit(dx, 0) | level_bit(0, dy);
    if (rule == CornerRule::any) {
      pruning.forced = {
          {{level_bit(-dx, 0), level_bit(-dx, dy)}, {level_bit(0, -dy), level_bit(dx, -dy)}}};
    }
    return pruning;
  }
  for (const int side : {-1, 1}) {
    const int sx = dy == 0 ? 0 : side;
    const int sy = dx == 0 ? 0 : side;
    Pruning::Forced& forced = pruning.forced[side > 0];
    if (rule == CornerRule::any) {
      forced = {level_bit(sx, sy), level_bit(sx + dx, sy + dy)};
    } else {
      forced = {level_bit(sx - dx, sy - dy), level_bit(sx, sy) | level_bit(sx + dx, sy + dy)};
    }
  }
  return pruning;
}

template <CornerRule kRule>
constexpr std::array<Pruning, kDirections> prunings() {
  std::array<Pruning, kDirections> all{};
  for (int d = direction(-1, -1, 0); d <= direction(1, 1, 0); ++d) {
    const Cell o = offset(d);
    all[std::size_t(d)] = pruning_after(o[0], o[1], kRule);
  }
  return all;
}
template <CornerRule kRule>
inline constexpr std::array<Pruning, kDirections> kPrunings = prunings<kRule>();

/// The free neighbours that only a path through the cell reaches as soon, in addition to the
/// natural ones.
template <CornerRule kRule>
DirectionMask forced(DirectionMask blocked, int in) {
  DirectionMask kept = 0;
  for (const Pruning::Forced& side : kPrunings<kRule>[std::size_t(in)].forced) {
    kept |= (blocked & side.if_blocked) != 0 ? side.kept : 0;
  }
  return kept & free_steps(blocked, kRule);
}

/// Directions in which a search continues from a cell that was entered in direction `in`.
template <CornerRule kRule>
DirectionMask level_successors(DirectionMask blocked, int in) {
  return (kPrunings<kRule>[std::size_t(in)].natural & free_steps(blocked, kRule)) |
         forced<kRule>(blocked, in);
}

/// The same from a table.
class LevelSuccessors {
 public:
  static const LevelSuccessors& of(CornerRule rule) {
    static const LevelSuccessors kAny = make<CornerRule::any>();
    static const LevelSuccessors kFreeBox = make<CornerRule::free_box>();
    return rule == CornerRule::any ? kAny : kFreeBox;
  }
  DirectionMask operator()(DirectionMask blocked, int in) const {
    return DirectionMask{table_[std::size_t(in - kFirst)][blocked >> kFirst & 511]} << kFirst;
  }

 private:
  static constexpr int kFirst = direction(-1, -1, 0);
  template <CornerRule kRule>
  static LevelSuccessors make() {
    LevelSuccessors successors;
    for (DirectionMask around = 0; around < 512; ++around) {
      for (int in = 0; in < 9; ++in) {
        successors.table_[std::size_t(in)][around] =
            std::uint16_t(level_successors<kRule>(around << kFirst, in + kFirst) >> kFirst & 511);
      }
    }
    return successors;
  }
  std::array<std::array<std::uint16_t, 512>, 9> table_{};  ///< by direction and blocked cells
};

using DirectionMasks = std::array<DirectionMask, kDirections>;
/// In 3-D: by the step into a cell, its successors if all cells around it are free, steps along
/// some of the axes of that step. The ones left out cost at least as much by a path around the cell
/// that moves along more axes first.
constexpr DirectionMasks natural_neighbours() {
  DirectionMasks natural{};
  for (int in = 0; in < kDirections; ++in) {
    for (int out = 0; out < kDirections; ++out) {
      const Cell before = offset(in);
      const Cell after = offset(out);
      bool along = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        along = along && (after[axis] == 0 || after[axis] == before[axis]);
      }
      if (along || in == kHere) {
        natural[std::size_t(in)] |= DirectionMask{1} << out;
      }
    }
  }
  return natural;
}
inline constexpr DirectionMasks kNatural = natural_neighbours();

/// The same among blocked cells, on any box-shaped cells: other steps are left out where a path
/// around the cell is free that costs less, or the same with a last step that comes earlier in the
/// order of astar's NaturalSteps.
class SpaceSuccessors {
 public:
  static const SpaceSuccessors& of(CornerRule rule) {
    static const SpaceSuccessors kAny(CornerRule::any);
    static const SpaceSuccessors kFreeBox(CornerRule::free_box);
    return rule == CornerRule::any ? kAny : kFreeBox;
  }
  /// Of the steps `open`, which are free, those needed from a cell entered in direction `in`.
  DirectionMask operator()(DirectionMask open, DirectionMask blocked, int in) const {
    DirectionMask kept = open & kNatural[std::size_t(in)];
    for (DirectionMask left = open & ~kept; left != 0; left &= left - 1) {
      const int out = std::countr_zero(left);
      const Ways& ways = ways_[std::size_t(in)][std::size_t(out)];
      const bool is_avoidable = (ways.over & ~blocked) != 0 || any_free(ways, blocked);
      kept |= DirectionMask(!is_avoidable) << out;
    }
    return kept;
  }

 private:
  struct Ways {
    DirectionMask over = 0;  ///< cells of which a free one suffices
    int first = 0;           ///< others, by a range of cells_
    int end = 0;
  };

  bool any_free(const Ways& ways, DirectionMask blocked) const {
    int way = ways.first;
    while (way < ways.end && (cells_[std::size_t(way)] & blocked) != 0) {
      ++way;
    }
    return way < ways.end;
  }

  explicit SpaceSuccessors(CornerRule rule) {
    for (int in = 0; in < kDirections; ++in) {
      for (int out = 0; out < kDirections; ++out) {
        Ways& ways = ways_[std::size_t(in)][std::size_t(out)];
        ways.first = int(cells_.size());
        if (in != kHere && out != kHere) {
          add_ways(in, out, rule, ways);
        }
        ways.end = int(cells_.size());
      }
    }
  }

  static unsigned axes(int d) {
    const Cell o = offset(d);
    return unsigned(o[0] != 0) | unsigned(o[1] != 0) << 1 | unsigned(o[2] != 0) << 2;
  }
  static bool is_step(const Cell& o) {
    return std::abs(o[0]) <= 1 && std::abs(o[1]) <= 1 && std::abs(o[2]) <= 1;
  }
  static int direction_of(const Cell& o) { return direction(o[0], o[1], o[2]); }

  /// True if two steps replace two others, whatever the edges of a cell. Of all pairs along given
  /// axes that one is shortest of which one step has all the axes, as the root is concave.
  static bool replace(int first, int last, int in, int out) {
    const unsigned any = axes(first) | axes(last);
    const unsigned both = axes(first) & axes(last);
    const unsigned any_of = axes(in) | axes(out);
    const unsigned both_of = axes(in) & axes(out);
    const bool is_nested = any == axes(first) || any == axes(last);
    const bool was_nested = any_of == axes(in) || any_of == axes(out);
    if ((any & ~any_of) != 0 || (both & ~both_of) != 0 || (was_nested && !is_nested)) {
      return false;
    }
    const bool is_equal = any == any_of && both == both_of && is_nested == was_nested;
    const bool is_alike = (axes(first) == axes(in) && axes(last) == axes(out)) ||
                          (axes(first) == axes(out) && axes(last) == axes(in));
    if (!is_nested && (any != any_of || (is_equal && !is_alike))) {
      return false;  // depends on the edges
    }
    const int fewer = std::popcount(axes(last)) - std::popcount(axes(out));
    return !is_equal || fewer < 0 || (fewer == 0 && last < out);
  }

  /// The cells that a step between two of those around this one passes, as bits.
  static DirectionMask passed(const Cell& from, const Cell& to, CornerRule rule) {
    DirectionMask cells = DirectionMask{1} << direction_of(from);
    cells |= DirectionMask{1} << direction_of(to);
    for (int d = 0; d < kDirections && rule == CornerRule::free_box; ++d) {
      const Cell o = offset(d);
      bool is_between = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        is_between = is_between && (o[axis] == from[axis] || o[axis] == to[axis]);
      }
      cells |= DirectionMask(is_between) << d;
    }
    return cells;
  }

  void add_ways(int in, int out, CornerRule rule, Ways& ways) {
    const Cell here = offset(in);
    const Cell to = offset(out);
    const Cell from = offset(opposite(in));
    const Cell end = {here[0] + to[0], here[1] + to[1], here[2] + to[2]};  // from the cell before
    const auto add = [&](DirectionMask cells) {
      cells &= ~(DirectionMask{1} << opposite(in) | DirectionMask{1} << out);  // which are free
      if (std::popcount(cells) == 1) {
        ways.over |= cells;
      } else {
        cells_.push_back(cells);
      }
    };
    if (is_step(end)) {
      add(passed(from, to, rule) | DirectionMask{1} << kHere);
    }
    for (int first = 0; first < kDirections; ++first) {
      const Cell o = offset(first);
      const Cell rest = {end[0] - o[0], end[1] - o[1], end[2] - o[2]};
      const Cell over = {o[0] - here[0], o[1] - here[1], o[2] - here[2]};
      if (first == in || first == kHere || !is_step(rest) || !is_step(over)) {
        continue;
      }
      const int last = direction_of(rest);
      if (last != kHere && replace(first, last, in, out)) {
        add(passed(from, over, rule) | passed(over, to, rule));
      }
    }
  }

  std::array<std::array<Ways, kDirections>, kDirections> ways_{};  ///< ranges of cells_
  std::vector<DirectionMask> cells_;  ///< by way, those that must all be free
};
}  // namespace altiplan::kit
