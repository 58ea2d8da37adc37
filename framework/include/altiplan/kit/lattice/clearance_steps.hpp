// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/scratch.hpp"
#include "altiplan/world.hpp"

namespace altiplan::kit {

/// Which steps of a lattice keep off the obstacles of a world. Clearance changes by at most a metre
/// a metre: one query frees all steps of a block of cells that is far from them; near them one
/// query a cell decides most steps, and the world the rest.
class ALTIPLAN_API ClearanceSteps {
 public:
  /// `needed`: metres that a leg keeps off, exactly. The lattice and the world must outlive this
  /// object.
  ClearanceSteps(const Lattice& lattice, const World& obstacles, double needed);

  /// The steps among `wanted` out of c that keep off.
  DirectionMask permitted(const Cell& c, DirectionMask wanted) {
    return is_far(c) ? wanted : near(c, wanted);
  }
  /// True if every step between two cells of the 3 x 3 x 3 around c is known to keep off.
  bool permits_all_around(const Cell& c) { return is_far(c) || clearance(c) > around_; }
  /// A lower bound of the clearance at the cell.
  double clearance(const Cell& c);
  /// The layer that blocked the last step refused; "" if none was.
  const std::string& layer() const { return layer_; }
  std::size_t bytes() const { return blocks_.size() * sizeof(Block); }

 private:
  static constexpr int kEdge = 4;  // cells
  static constexpr float kUnknown = -std::numeric_limits<float>::infinity();
  struct Block {
    std::array<float, kEdge * kEdge * kEdge> clearance;  ///< a lower bound
  };

  bool is_far(const Cell& c) {
    const std::size_t at = block_of(c);
    return (slots_[at] == 0 ? look_at(c, at) : slots_[at]) == kFar;
  }
  std::size_t block_of(const Cell& c) const {
    return (std::size_t(c[2] / kEdge) * blocks_north_ + std::size_t(c[1] / kEdge)) * blocks_east_ +
           std::size_t(c[0] / kEdge);
  }
  std::uint32_t look_at(const Cell& c, std::size_t block);
  DirectionMask near(const Cell& c, DirectionMask wanted);

  const Lattice& lattice_;
  const World& obstacles_;
  double needed_;
  double spare_;   ///< clearance beyond half a leg that proves the leg free
  double around_;  ///< clearance of a cell around which all steps are free
  std::size_t blocks_east_;
  std::size_t blocks_north_;
  static constexpr std::uint32_t kFar = 1;  ///< of a block: all of its cells are
  ScratchArray<std::uint32_t> slots_;       ///< by block; 0: unknown; else number in blocks_ + 2
  std::vector<std::unique_ptr<Block>> blocks_;
  std::string layer_;
};
}  // namespace altiplan::kit
