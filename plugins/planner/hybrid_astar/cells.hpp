// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace altiplan::hybrid_astar {

/// A hash map from cells to nodes with open addressing and linear probing; nothing is erased.
class Cells {
 public:
  using Node = std::uint32_t;
  static constexpr Node kNone = ~Node{0};

  Cells() : slots_(kFirst) {}

  /// The node of a cell, kNone if it has none.
  Node find(std::uint64_t cell) const { return slots_[slot_of(cell)].node; }

  /// Sets the node of a cell, and returns the one that it had.
  Node exchange(std::uint64_t cell, Node node) {
    if (2 * used_ >= slots_.size()) {
      grow();
    }
    Slot& slot = slots_[slot_of(cell)];
    used_ += slot.node == kNone ? 1 : 0;
    slot.cell = cell;
    return std::exchange(slot.node, node);
  }

  std::size_t bytes() const { return slots_.size() * sizeof(Slot); }

 private:
  struct Slot {
    std::uint64_t cell = 0;
    Node node = kNone;
  };
  static constexpr std::size_t kFirst = 1024;  ///< slots; a power of two

  std::size_t slot_of(std::uint64_t cell) const {
    const std::size_t mask = slots_.size() - 1;
    // The upper bits of the product depend on all bits of the cell.
    std::size_t at = std::size_t(cell * 0x9E3779B97F4A7C15u >> 20) & mask;
    while (slots_[at].node != kNone && slots_[at].cell != cell) {
      at = (at + 1) & mask;
    }
    return at;
  }

  void grow() {
    const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(2 * slots_.size()));
    for (const Slot& slot : old) {
      if (slot.node != kNone) {
        slots_[slot_of(slot.cell)] = slot;
      }
    }
  }

  std::vector<Slot> slots_;
  std::size_t used_ = 0;
};
}  // namespace altiplan::hybrid_astar
