// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "altiplan/kit/lattice/lattice_search.hpp"
#include "altiplan/kit/lattice/tiles.hpp"

namespace altiplan::astar {

/// The cells from which the goal can be reached, found from the goal outward in steps of the
/// search: limits on turns, which depend on two steps, count as kept. If they are exhausted before
/// one of them is a cell that the search has reached, there is no route.
class GoalFlood {
 public:
  GoalFlood(const kit::TileIndex& tiles, kit::MoveRules& rules, kit::TiledArray<std::uint8_t>& seen)
      : tiles_(tiles), rules_(rules), seen_(seen) {}

  /// Adds a cell from which the goal is one leg away.
  void begin_at(const Cell& c) { see(c); }

  /// Visits up to `count` cells; `is_reached(number)`: true for cells that the search has reached.
  template <class IsReached>
  void go_on(int count, const IsReached& is_reached) {
    for (; count > 0 && !is_over(); --count) {
      const std::uint32_t number = frontier_[next_++];
      if (is_reached(number)) {
        has_met_ = true;
        return;
      }
      const Cell c = tiles_.cell(number);
      for (kit::DirectionMask left = rules_.places_free(c, unseen(c), true); left != 0;
           left &= left - 1) {
        const Cell o = kit::offset(std::countr_zero(left));
        see({c[0] + o[0], c[1] + o[1], c[2] + o[2]});
      }
    }
  }

  /// True if no more is to be found: the flood has met the search, or is exhausted.
  bool is_over() const { return has_met_ || next_ == frontier_.size(); }
  /// True if the goal is shut in.
  bool is_shut_in() const { return !has_met_ && next_ == frontier_.size(); }
  std::size_t cells() const { return frontier_.size(); }
  /// Every `stride`th of the cells.
  template <class Visit>
  void for_each(std::size_t stride, const Visit& visit) const {
    for (std::size_t n = 0; n < frontier_.size(); n += stride) {
      visit(tiles_.cell(frontier_[n]));
    }
  }
  std::size_t bytes() const { return frontier_.size() * sizeof(std::uint32_t) + seen_.bytes(); }

 private:
  void see(const Cell& c) {
    std::uint8_t& seen = seen_.at(tiles_.number(c));
    if (seen == 0) {
      seen = 1;
      frontier_.push_back(tiles_.number(c));
    }
  }
  kit::DirectionMask unseen(const Cell& c) {
    kit::DirectionMask wanted = 0;
    for (kit::DirectionMask left = kit::reversed(rules_.into(c)); left != 0; left &= left - 1) {
      const int d = std::countr_zero(left);
      const Cell o = kit::offset(d);
      const std::uint32_t number = tiles_.number({c[0] + o[0], c[1] + o[1], c[2] + o[2]});
      wanted |= kit::DirectionMask(seen_[number] == 0) << d;
    }
    return wanted;
  }

  const kit::TileIndex& tiles_;
  kit::MoveRules& rules_;
  kit::TiledArray<std::uint8_t>& seen_;
  std::vector<std::uint32_t> frontier_;
  std::size_t next_ = 0;
  bool has_met_ = false;
};
}  // namespace altiplan::astar
