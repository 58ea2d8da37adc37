// SPDX-License-Identifier: Apache-2.0
#include "altiplan/voxel_grid.hpp"

#include <algorithm>
#include <bit>

#include "altiplan/error.hpp"

namespace altiplan {
namespace {

constexpr std::uint64_t kAll = ~std::uint64_t{0};

// Calls change(word, mask) for the words of a row that hold bits first..last (both included).
template <class Change>
void for_each_word(int first, int last, const Change& change) {
  for (int word = first / 64; word <= last / 64; ++word) {
    const int from = std::max(first - 64 * word, 0);
    const int to = std::min(last - 64 * word, 63);
    change(std::size_t(word), (kAll << from) & (kAll >> (63 - to)));
  }
}

// Sets or clears bits first..last (both included) of a row.
void fill(std::uint64_t* row, int first, int last, bool value) {
  for_each_word(first, last, [&](std::size_t word, std::uint64_t mask) {
    row[word] = value ? row[word] | mask : row[word] & ~mask;
  });
}
}  // namespace

Cell GridSpec::cell_of(const Vec3& p) const {
  constexpr double kFar = 1 << 30;
  Cell c{};
  for (int axis = 0; axis < 3; ++axis) {
    double index = std::floor((p[axis] - origin[axis]) / cell[axis]);
    // The quotient's rounding must not contradict the cell faces of cell_box.
    if (origin[axis] + cell[axis] * (index + 1) <= p[axis]) {
      ++index;
    } else if (origin[axis] + cell[axis] * index > p[axis]) {
      --index;
    }
    c[axis] = static_cast<int>(std::clamp(index, -kFar, kFar));
  }
  return c;
}

VoxelGrid::VoxelGrid(const GridSpec& spec) : spec_(spec) {
  for (int axis = 0; axis < 3; ++axis) {
    if (spec.counts[axis] < 1 || !(spec.cell[axis] > 0) || !std::isfinite(spec.cell[axis]) ||
        !std::isfinite(spec.origin[axis])) {
      throw Error("a voxel grid needs at least one cell of positive size on each axis; axis " +
                  std::string(1, "xyz"[axis]) + " has " + std::to_string(spec.counts[axis]) +
                  " cells of " + std::to_string(spec.cell[axis]) + " m from " +
                  std::to_string(spec.origin[axis]) + " m");
    }
  }
  words_per_row_ = (std::size_t(spec.counts[0]) + 2 + 63) / 64;
  rows_per_level_ = std::size_t(spec.counts[1]) + 2;
  // One spare word: reading a few bits may load a few bytes beyond them.
  words_.assign(words_per_row_ * rows_per_level_ * (std::size_t(spec.counts[2]) + 2) + 1, kAll);
  for (int k = 0; k < spec.counts[2]; ++k) {
    for (int j = 0; j < spec.counts[1]; ++j) {
      fill(words_.data() + row(j, k), 1, spec.counts[0], false);
    }
  }
}

void VoxelGrid::set(const Cell& c, bool is_blocked) {
  if (!spec_.holds(c)) {
    throw Error("cell (" + std::to_string(c[0]) + ", " + std::to_string(c[1]) + ", " +
                std::to_string(c[2]) + ") lies outside the voxel grid");
  }
  fill(words_.data() + row(c[1], c[2]), c[0] + 1, c[0] + 1, is_blocked);
}

void VoxelGrid::set_run(int i0, int i1, int j, int k, bool is_blocked) {
  ask_watch();
  i0 = std::max(i0, 0);
  i1 = std::min(i1, spec_.counts[0] - 1);
  if (i0 <= i1 && spec_.holds({i0, j, k})) {
    fill(words_.data() + row(j, k), i0 + 1, i1 + 1, is_blocked);
  }
}

void VoxelGrid::merge(const VoxelGrid& other) {
  if (!(spec_ == other.spec_)) {
    throw Error("voxel grids of different specs cannot be merged");
  }
  for (std::size_t w = 0; w < words_.size(); ++w) {
    words_[w] |= other.words_[w];
  }
}

void VoxelGrid::copy(const VoxelGrid& other, const Cell& low, const Cell& high) {
  if (!(spec_ == other.spec_)) {
    throw Error("cells cannot be copied from a voxel grid of another spec");
  }
  const int i0 = std::max(low[0], 0);
  const int i1 = std::min(high[0], spec_.counts[0] - 1);
  if (i0 > i1) {
    return;
  }
  for (int k = std::max(low[2], 0); k <= std::min(high[2], spec_.counts[2] - 1); ++k) {
    for (int j = std::max(low[1], 0); j <= std::min(high[1], spec_.counts[1] - 1); ++j) {
      std::uint64_t* words = words_.data() + row(j, k);
      const std::uint64_t* from = other.row_words(j, k);
      for_each_word(i0 + 1, i1 + 1, [&](std::size_t word, std::uint64_t mask) {
        words[word] = (words[word] & ~mask) | (from[word] & mask);
      });
    }
  }
}

std::size_t VoxelGrid::blocked_count() const {
  const std::size_t always = 64 * words_per_row_ - std::size_t(spec_.counts[0]);
  std::size_t count = 0;
  for (int k = 0; k < spec_.counts[2]; ++k) {
    for (int j = 0; j < spec_.counts[1]; ++j) {
      const std::uint64_t* words = row_words(j, k);
      for (std::size_t w = 0; w < words_per_row_; ++w) {
        count += std::size_t(std::popcount(words[w]));
      }
      count -= always;
    }
  }
  return count;
}

std::vector<Cell> VoxelGrid::diff(const VoxelGrid& a, const VoxelGrid& b) {
  if (!(a.spec_ == b.spec_)) {
    throw Error("voxel grids of different specs cannot be compared");
  }
  std::vector<Cell> cells;
  for (int k = 0; k < a.spec_.counts[2]; ++k) {
    for (int j = 0; j < a.spec_.counts[1]; ++j) {
      for (std::size_t w = 0; w < a.words_per_row_; ++w) {
        std::uint64_t bits = a.row_words(j, k)[w] ^ b.row_words(j, k)[w];
        for (; bits != 0; bits &= bits - 1) {
          cells.push_back({int(64 * w) + std::countr_zero(bits) - 1, j, k});
        }
      }
    }
  }
  return cells;
}
}  // namespace altiplan
