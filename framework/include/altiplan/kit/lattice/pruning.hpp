// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

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
}  // namespace altiplan::kit
