// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "altiplan/world.hpp"
#include "problem.hpp"

namespace altiplan::dstar_lite {

/// Calls visit(n) for the words from `first` to `end` in which two occupancies differ.
template <class Visit>
void for_each_changed_word(const VoxelGrid& before, const VoxelGrid& now, std::size_t first,
                           std::size_t end, const Visit& visit) {
  constexpr std::size_t kAtOnce = 8;
  const std::uint64_t* a = before.words().data();
  const std::uint64_t* b = now.words().data();
  for (std::size_t n = first; n < end;) {
    const std::size_t stop = std::min(n + kAtOnce, end);
    std::uint64_t changed = 0;
    if (stop - n == kAtOnce) {
      for (std::size_t w = 0; w < kAtOnce; ++w) {  // branch-free: many words, few changes
        changed |= a[n + w] ^ b[n + w];
      }
    } else {
      changed = 1;
    }
    for (; n < stop; ++n) {
      if (changed != 0 && a[n] != b[n]) {
        visit(n);
      }
    }
  }
}

/// The cells in which two occupancies of the same layout differ. Searches only inside the changes'
/// boxes, each grown by the obstacle inflation, and within known(level). Where boxes overlap, a
/// cell may occur more than once.
template <class Known>
std::vector<Cell> changed_cells(const VoxelGrid& before, const VoxelGrid& now,
                                std::span<const Change> changes, const Known& known,
                                const kit::Lattice& lattice) {
  std::vector<Cell> cells;
  const std::size_t width = now.words_per_row();
  for (const Change& change : changes) {
    const CellRange box = cells_in(change.box.grown(now.spec().inflation), lattice);
    for (int k = box.low[2]; k <= box.high[2]; ++k) {
      auto [low, high] = known(k);
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::max(low[axis], box.low[axis]);
        high[axis] = std::min(high[axis], box.high[axis]);
      }
      if (low[0] > high[0] || low[1] > high[1]) {
        continue;
      }
      const std::size_t first = std::size_t(low[0] + 1) / 64;
      const std::size_t last = std::size_t(high[0] + 1) / 64;
      const auto look = [&](int j0, int j1) {  // rows j0 to j1 are contiguous in memory
        const std::size_t base = now.bit(-1, j0, k) / 64;
        const std::size_t end = now.bit(-1, j1, k) / 64 + last + 1;
        for_each_changed_word(before, now, base + first, end, [&](std::size_t n) {
          std::uint64_t bits = before.words()[n] ^ now.words()[n];
          for (; bits != 0; bits &= bits - 1) {
            cells.push_back({int(64 * ((n - base) % width)) + std::countr_zero(bits) - 1,
                             j0 + int((n - base) / width), k});
          }
        });
      };
      if (first == 0 && last + 1 == width) {
        look(low[1], high[1]);
      } else {
        for (int j = low[1]; j <= high[1]; ++j) {
          look(j, j);
        }
      }
    }
  }
  return cells;
}
}  // namespace altiplan::dstar_lite
