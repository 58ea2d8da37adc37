// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "altiplan/kit/lattice/lattice.hpp"

namespace altiplan::kit {

/// Runs along an axis over cells that a search would only leave straight ahead: those beside which
/// nothing changes along the run. Their other successors are all reached as soon from the cell
/// before (see SpaceSuccessors), so a search needs neither to store nor to expand them.
///
/// Jump points as in D. Harabor, A. Grastien: Online Graph Pruning for Pathfinding on Grid Maps.
/// AAAI 2011, doi:10.1609/aaai.v25i1.7994, in space and for straight runs alone: diagonal steps are
/// few, and looking for jump points beside them would cost more than to expand them.
class StraightRuns {
 public:
  /// The grid must outlive it.
  explicit StraightRuns(const VoxelGrid& grid)
      : words_(grid.words().data()),
        last_word_(grid.words().size() - 1),
        row_bits_(grid.row_bits()),
        level_bits_(grid.level_bits()) {}

  /// Most steps of a run.
  static constexpr int kLongest = 62;

  /// Adds a cell to the box in which runs end at every cell.
  void end_at(const Cell& c) {
    first_end_ = {std::min(first_end_[0], c[0]), std::min(first_end_[1], c[1]),
                  std::min(first_end_[2], c[2])};
    last_end_ = {std::max(last_end_[0], c[0]), std::max(last_end_[1], c[1]),
                 std::max(last_end_[2], c[2])};
  }

  /// Steps from cell c, whose bit number is `at`, in a direction along an axis to the next cell
  /// that a search must expand; 0 if there is none before a blocked one. The first step is free.
  int steps(const Cell& c, std::size_t at, int direction) const {
    const int longest = to_end(c, direction);
    const auto row = std::ptrdiff_t(row_bits_);
    const auto level = std::ptrdiff_t(level_bits_);
    switch (direction) {
      case kHere - 1:
        return along_row<false>(at, longest);
      case kHere + 1:
        return along_row<true>(at, longest);
      case kHere - 3:
        return across_rows(at, -row, level, longest);
      case kHere + 3:
        return across_rows(at, row, level, longest);
      case kHere - 9:
        return across_rows(at, -level, row, longest);
      default:
        return across_rows(at, level, row, longest);
    }
  }

 private:
  /// Steps to the first cell of the box; kLongest if that is farther or the run passes it.
  int to_end(const Cell& c, int direction) const {
    const Cell o = offset(direction);
    int steps = kLongest;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (o[axis] == 0) {
        if (c[axis] < first_end_[axis] || c[axis] > last_end_[axis]) {
          return kLongest;
        }
        continue;
      }
      const int to_first = o[axis] > 0 ? first_end_[axis] - c[axis] : c[axis] - last_end_[axis];
      const int to_last = o[axis] > 0 ? last_end_[axis] - c[axis] : c[axis] - first_end_[axis];
      steps = to_last > 0 ? std::clamp(to_first, 1, kLongest) : kLongest;
    }
    return steps;
  }

  /// The cells of a row from bit number `at` on in the direction of the run: the first is the
  /// lowest bit (kAhead: bit numbers rise), or the highest. Only whole words that exist are read.
  template <bool kAhead>
  std::uint64_t window(std::size_t at) const {
    const std::size_t word = at / 64;
    const std::size_t shift = kAhead ? at % 64 : 63 - at % 64;
    if (kAhead) {
      const std::uint64_t next = words_[std::min(word + 1, last_word_)];
      return words_[word] >> shift | next << 1 << (63 - shift);
    }
    const std::uint64_t previous = words_[word - std::size_t(word > 0)];
    return words_[word] << shift | previous >> 1 >> (63 - shift);
  }

  template <bool kAhead>
  int along_row(std::size_t at, int longest) const {
    const auto next = [](std::uint64_t bits) { return kAhead ? bits >> 1 : bits << 1; };
    std::uint64_t differ = 0;  // by cell: a cell beside it is unlike the one after that
    for (const std::size_t level : {at - level_bits_, at, at + level_bits_}) {
      for (const std::size_t beside : {level - row_bits_, level, level + row_bits_}) {
        if (beside != at) {
          const std::uint64_t cells = window<kAhead>(beside);
          differ |= cells ^ next(cells);
        }
      }
    }
    const auto first = [](std::uint64_t bits) {
      return kAhead ? std::countr_zero(bits) : std::countl_zero(bits);
    };
    const int end = std::min(std::max(first(differ), 1), longest);
    return end < first(window<kAhead>(at)) ? end : 0;
  }

  /// `step`, `beside`: bits to the next row on the run, and to those on both sides of it. Rows
  /// begin with a word, so the cell has the same place in its word on all of them.
  int across_rows(std::size_t at, std::ptrdiff_t step, std::ptrdiff_t beside, int longest) const {
    return at % 64 == 0 || at % 64 == 63
               ? across(std::ptrdiff_t(at), step, beside, 1, longest,
                        [this](std::ptrdiff_t bit) { return three(std::size_t(bit)); })
               : across(std::ptrdiff_t(at / 64), step / 64, beside / 64, at % 64, longest,
                        [this](std::ptrdiff_t word) { return words_[word]; });
  }

  /// `cells` gives, by what `at` counts, a cell as the bit `place`, beside those before and after
  /// it in its row.
  template <class Cells>
  static int across(std::ptrdiff_t at, std::ptrdiff_t step, std::ptrdiff_t beside,
                    std::size_t place, int longest, const Cells& cells) {
    const std::uint64_t cell = std::uint64_t{1} << place;
    const std::uint64_t others = cell << 1 | cell >> 1;
    std::uint64_t left = cells(at - beside);
    std::uint64_t own = cells(at);
    std::uint64_t right = cells(at + beside);
    for (int steps = 0; steps < longest; ++steps) {
      at += step;
      const std::uint64_t next_left = cells(at - beside);
      const std::uint64_t next_own = cells(at);
      const std::uint64_t next_right = cells(at + beside);
      const std::uint64_t next_to = (left ^ next_left) | (right ^ next_right);
      if (((next_to & (cell | others)) | ((own ^ next_own) & others)) != 0) {
        return std::max(steps, 1);
      }
      if ((next_own & cell) != 0) {
        return 0;
      }
      left = next_left;
      own = next_own;
      right = next_right;
    }
    return longest;
  }

  std::uint64_t three(std::size_t bit) const {
    const std::size_t from = bit - 1;
    return words_[from / 64] >> from % 64 | words_[from / 64 + 1] << 1 << (63 - from % 64);
  }

  const std::uint64_t* words_;
  std::size_t last_word_;
  std::size_t row_bits_;
  std::size_t level_bits_;
  Cell first_end_{1 << 30, 1 << 30, 1 << 30};  ///< the box, empty if beyond last_end_
  Cell last_end_{-1, -1, -1};
};
}  // namespace altiplan::kit
