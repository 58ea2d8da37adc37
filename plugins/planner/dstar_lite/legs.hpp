// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>

#include "altiplan/kit/scratch.hpp"
#include "problem.hpp"

namespace altiplan::dstar_lite {

/// Cached information about legs beyond the occupancy.
struct LegMemory {
  kit::ScratchArray<std::uint32_t> judged;  ///< by cell: directions with a free leg to it, kJudged

  static constexpr std::size_t kBytesPerCell = sizeof(std::uint32_t);
};

/// The legs between neighbouring cells that a vehicle may fly, whatever the preceding leg.
class Legs {
 public:
  Legs(const Problem& problem, LegMemory& memory)
      : problem_(problem),
        lattice_(problem.lattice),
        memory_(memory),
        judges_(!cells_decide(problem.request, problem.settings)),
        level_(lattice_.spec().counts[2] == 1) {
    if (judges_) {
      memory.judged.reset(lattice_.size());
    }
    renew();
  }
  /// Adopts the request's world; cached legs within a box must be invalidated separately.
  void renew() {
    rules_.emplace(problem_.request, lattice_, problem_.settings.moves, problem_.settings.corner);
    steps_ = rules_->steps() & (level_ ? kit::kLevelDirections : ~kit::DirectionMask{0});
  }
  void forget(std::uint32_t index) {
    if (judges_ && memory_.judged[index] != 0) {
      memory_.judged.at(index) = 0;
    }
  }
  /// True if the legs to a cell are checked one by one, in one direction only.
  bool judges() const { return judges_; }
  kit::DirectionMask steps() const { return steps_; }
  kit::MoveRules& rules() { return *rules_; }
  const kit::MoveRules& rules() const { return *rules_; }

  /// Directions from a cell to those from which a leg leads to it.
  kit::DirectionMask into(std::uint32_t index, const Cell& c) {
    return judges_ ? judged(index, c) : by_cells(c, kit::reversed(steps_));
  }
  /// Directions in which a leg from the cell may lead; those that are judged are still to be.
  kit::DirectionMask out_of(const Cell& c) const {
    return judges_ ? steps_ & lattice_.inside(c) : by_cells(c, steps_);
  }
  /// True if the leg from the cell in that direction is free; the neighbour must exist.
  bool leads(std::uint32_t index, const Cell& c, int d) {
    const Cell o = kit::offset(d);
    return (into(std::uint32_t(index + lattice_.stride(d)),
                 {c[0] + o[0], c[1] + o[1], c[2] + o[2]}) >>
                kit::opposite(d) &
            1) != 0;
  }

 private:
  static constexpr std::uint32_t kJudged = std::uint32_t{1} << kit::kDirections;

  kit::DirectionMask by_cells(const Cell& c, kit::DirectionMask steps) const {
    const VoxelGrid& grid = *rules_->grid();
    const std::uint64_t* words = grid.words().data();
    const kit::DirectionMask blocked = level_ ? kit::bits_around<true>(grid, words, grid.bit(c))
                                              : kit::bits_around(grid, words, grid.bit(c));
    return steps & kit::free_steps(blocked, problem_.settings.corner);
  }

  kit::DirectionMask judged(std::uint32_t index, const Cell& c) {
    const std::uint32_t known = memory_.judged[index];
    if (known != 0) {
      return known & (kJudged - 1);
    }
    kit::DirectionMask free = rules_->places_free(c, kit::reversed(rules_->into(c)), true);
    if (problem_.request.judges_pairs()) {
      const Vec3 here = lattice_.position(c);
      for (kit::DirectionMask open = free; open != 0; open &= open - 1) {
        const int d = std::countr_zero(open);
        if (!rules_->admits(std::nullopt, here + lattice_.step(d), here)) {
          free &= ~(kit::DirectionMask{1} << d);
        }
      }
    }
    memory_.judged.at(index) = free | kJudged;
    return free;
  }

  const Problem& problem_;
  const kit::Lattice& lattice_;
  LegMemory& memory_;
  bool judges_;
  bool level_;
  std::optional<kit::MoveRules> rules_;
  kit::DirectionMask steps_ = 0;
};

/// Takes a direction from a non-empty mask, the likely one if possible.
inline int take_direction(kit::DirectionMask& mask, int likely) {
  const int d = (mask >> likely & 1) != 0 ? likely : std::countr_zero(mask);
  mask &= ~(kit::DirectionMask{1} << d);
  return d;
}
}  // namespace altiplan::dstar_lite
