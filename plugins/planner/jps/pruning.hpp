// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "altiplan/kit/lattice.hpp"

namespace altiplan::jps {

/// The neighbours of a cell that a way through it may go on to, for one direction of the step that
/// led to the cell: those that no other way from the cell before reaches at most as late, with
/// diagonal steps before straight ones among equals.
struct Pruning {
  /// A blocked neighbour, and those that it bars from being reached otherwise.
  struct Forced {
    kit::DirectionMask if_blocked = 0;
    kit::DirectionMask kept = 0;
  };
  kit::DirectionMask natural = 0;  ///< whatever is blocked
  std::array<Forced, 2> forced;    ///< one a side
};

constexpr kit::DirectionMask bit(int dx, int dy) {
  return kit::DirectionMask{1} << kit::direction(dx, dy, 0);
}

/// For a step (dx, dy); none (the start): all neighbours.
constexpr Pruning pruning_after(int dx, int dy, kit::CornerRule rule) {
  Pruning pruning;
  if (dx == 0 && dy == 0) {
    for (int d = kit::direction(-1, -1, 0); d <= kit::direction(1, 1, 0); ++d) {
      pruning.natural |= kit::DirectionMask{1} << d;
    }
    return pruning;
  }
  pruning.natural = bit(dx, dy);
  if (dx != 0 && dy != 0) {
    pruning.natural |= bit(dx, 0) | bit(0, dy);
    if (rule == kit::CornerRule::any) {
      pruning.forced = {{{bit(-dx, 0), bit(-dx, dy)}, {bit(0, -dy), bit(dx, -dy)}}};
    }
    return pruning;
  }
  for (const int side : {-1, 1}) {
    const int sx = dy == 0 ? 0 : side;
    const int sy = dx == 0 ? 0 : side;
    Pruning::Forced& forced = pruning.forced[side > 0];
    if (rule == kit::CornerRule::any) {
      forced = {bit(sx, sy), bit(sx + dx, sy + dy)};
    } else {
      forced = {bit(sx - dx, sy - dy), bit(sx, sy) | bit(sx + dx, sy + dy)};
    }
  }
  return pruning;
}

template <kit::CornerRule kRule>
constexpr std::array<Pruning, kit::kDirections> prunings() {
  std::array<Pruning, kit::kDirections> all{};
  for (int d = kit::direction(-1, -1, 0); d <= kit::direction(1, 1, 0); ++d) {
    const Cell o = kit::offset(d);
    all[std::size_t(d)] = pruning_after(o[0], o[1], kRule);
  }
  return all;
}
template <kit::CornerRule kRule>
inline constexpr std::array<Pruning, kit::kDirections> kPrunings = prunings<kRule>();

/// The free neighbours that only a way through the cell reaches as soon, beside the natural ones.
template <kit::CornerRule kRule>
kit::DirectionMask forced(kit::DirectionMask blocked, int in) {
  kit::DirectionMask kept = 0;
  for (const Pruning::Forced& side : kPrunings<kRule>[std::size_t(in)].forced) {
    kept |= (blocked & side.if_blocked) != 0 ? side.kept : 0;
  }
  return kept & kit::free_steps(blocked, kRule);
}

/// Directions in which the search goes on from a cell.
template <kit::CornerRule kRule>
kit::DirectionMask successors(kit::DirectionMask blocked, int in) {
  return (kPrunings<kRule>[std::size_t(in)].natural & kit::free_steps(blocked, kRule)) |
         forced<kRule>(blocked, in);
}
}  // namespace altiplan::jps
