// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "altiplan/kit/lattice/bit_lines.hpp"
#include "altiplan/kit/lattice/lattice.hpp"

namespace altiplan::jps {

using kit::BitLines;

/// Windows starting at one cell: of its line and of the two adjacent lines.
template <kit::CornerRule kRule, bool kAhead>
struct Strip {
  std::uint64_t own = 0;
  std::uint64_t left = 0;
  std::uint64_t right = 0;

  static std::uint64_t next(std::uint64_t window) { return kAhead ? window >> 1 : window << 1; }
  static std::uint64_t previous(std::uint64_t window) { return kAhead ? window << 1 : window >> 1; }
  /// State of the n-th cell.
  static bool blocked(std::uint64_t window, int n) {
    return (window << (kAhead ? 63 - n : n) >> 63) != 0;
  }
  /// Blocked cells of a line that precede a free one.
  static std::uint64_t ends(std::uint64_t window) { return window & ~next(window); }

  /// Scans the cells after the first: n > 0 if the n-th is a jump point, -n if it is blocked and
  /// none before it is a jump point, 0 if kCells of them are neither. Reads one more cell of each
  /// window.
  ///
  /// A cell is a jump point if an adjacent line has a blocked cell followed by a free one: under
  /// `any` next to the blocked one (the free one is then a diagonal step away, and no other path
  /// there is as short), under free_box next to the free one.
  template <int kCells>
  int scan() const {
    constexpr std::uint64_t kLow = (std::uint64_t{1} << kCells) - 1;
    constexpr std::uint64_t kJudged = kAhead ? kLow << 1 : kLow << (63 - kCells);
    const std::uint64_t beside = ends(left) | ends(right);
    const std::uint64_t jumps = kRule == kit::CornerRule::any ? beside : previous(beside);
    const std::uint64_t stops = (own | jumps) & kJudged;
    if (stops == 0) {
      return 0;
    }
    const int n = kAhead ? std::countr_zero(stops) : std::countl_zero(stops);
    return blocked(own, n) ? -n : n;
  }
};

/// The scan of a Strip from a cell on, to its end; `skipped` cells after it are known to be free
/// and no jump points.
template <kit::CornerRule kRule, bool kAhead>
int scan(const BitLines& lines, int line, int at, int skipped = 0) {
  constexpr int kCells = BitLines::kWindow - 2;
  const unsigned char* const own = lines.line(line);
  for (int gone = skipped;; gone += kCells) {
    const int here = kAhead ? at + gone : at - gone;
    const Strip<kRule, kAhead> strip{BitLines::window<kAhead>(own, here),
                                     BitLines::window<kAhead>(own + lines.bytes_per_line(), here),
                                     BitLines::window<kAhead>(own - lines.bytes_per_line(), here)};
    if (const int n = strip.template scan<kCells>(); n != 0) {
      return n > 0 ? gone + n : n - gone;
    }
  }
}

/// The strip that moves along with a diagonal run, one line per step: two of its windows are those
/// of the previous step, shifted by one cell.
template <kit::CornerRule kRule, bool kAhead>
class MovingStrip {
 public:
  /// Positioned at a cell, to move to the line after its own, or (-1) to the one before.
  MovingStrip(const BitLines& lines, int line, int at, int side)
      : lines_(lines),
        fore_(lines.line(line + side)),
        to_next_(side * lines.bytes_per_line()),
        strip_{BitLines::window<kAhead>(lines.line(line), at), BitLines::window<kAhead>(fore_, at),
               0} {}

  /// Moves to a cell of the next line.
  void step(int at) {
    fore_ += to_next_;
    strip_.right = S::next(strip_.own);
    strip_.own = S::next(strip_.left);
    strip_.left = BitLines::window<kAhead>(fore_, at);
  }
  /// True if the cell on the line that the run came from is blocked, and the one after it free.
  bool ends_behind() const { return S::blocked(S::ends(strip_.right), 0); }
  /// True if the neighbour straight ahead, or that of the next line, is blocked.
  bool blocked_straight() const { return S::blocked(strip_.own, 1); }
  bool blocked_fore() const { return S::blocked(strip_.left, 1); }

  int scan(int line, int at) const {
    constexpr int kCells = BitLines::kWindow - 4;  // a window suffices for three steps
    const int n = strip_.template scan<kCells>();
    return n != 0 ? n : jps::scan<kRule, kAhead>(lines_, line, at, kCells);
  }

 private:
  using S = Strip<kRule, kAhead>;
  const BitLines& lines_;
  const unsigned char* fore_;
  std::ptrdiff_t to_next_;
  S strip_;  // left: the next line
};

/// Transposes a square of bits: bit j of word i becomes bit i of word j.
inline void transpose(std::array<std::uint64_t, 64>& square) {
  std::uint64_t low = 0x00000000FFFFFFFF;
  for (std::size_t half = 32; half != 0; half /= 2, low ^= low << half) {
    for (std::size_t i = 0; i < 64; i = (i + half + 1) & ~half) {
      const std::uint64_t differ = (square[i] >> half ^ square[i + half]) & low;
      square[i] ^= differ << half;
      square[i + half] ^= differ;
    }
  }
}

/// The columns of an occupancy's only level, cached while the same occupancy is used.
class Columns {
 public:
  BitLines of(const std::shared_ptr<const VoxelGrid>& grid) {
    // Compares owners: another occupancy may be allocated at the same address.
    if (grid_.owner_before(grid) || grid.owner_before(grid_)) {
      build(*grid);
      grid_ = grid;
    }
    return {words_.data() + 1 + words_per_column_, words_per_column_};
  }

 private:
  void build(const VoxelGrid& grid) {
    const Cell& counts = grid.spec().counts;
    const std::size_t rows = std::size_t(counts[1]) + 2;
    const std::size_t columns = std::size_t(counts[0]) + 2;
    words_per_column_ = (rows + 63) / 64;
    words_.assign(words_per_column_ * columns + 2, ~std::uint64_t{0});
    std::array<std::uint64_t, 64> square{};
    for (std::size_t band = 0; band < words_per_column_; ++band) {
      for (std::size_t word = 0; word < grid.words_per_row(); ++word) {
        for (std::size_t i = 0; i < 64; ++i) {
          const std::size_t row = 64 * band + i;
          square[i] = row < rows ? grid.row_words(int(row) - 1, 0)[word] : ~std::uint64_t{0};
        }
        transpose(square);
        for (std::size_t i = 0; i < 64 && 64 * word + i < columns; ++i) {
          words_[1 + (64 * word + i) * words_per_column_ + band] = square[i];
        }
      }
    }
  }

  std::weak_ptr<const VoxelGrid> grid_;
  std::vector<std::uint64_t> words_;  // one, the columns from -1 on, one
  std::size_t words_per_column_ = 0;
};
}  // namespace altiplan::jps
