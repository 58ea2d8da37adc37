// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "altiplan/error.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/zero_memory.hpp"

/// \file Cells numbered by tiles, and arrays over them that take memory where a search writes: a
/// lattice may have many more cells than a search reaches, and neighbours share cache lines and
/// pages.
namespace altiplan::kit {

/// Numbers of the cells of a box in tiles of kCells: 16 x 8 x 8 cells, 32 x 32 x 1 in a box of one
/// level. Sixteen consecutive numbers are 4 x 4 cells of one level. A number is the sum of a part
/// for each axis, so that those of neighbours differ from it by parts of their own.
class TileIndex {
 public:
  static constexpr std::uint32_t kCells = 1024;

  TileIndex() = default;
  explicit TileIndex(const Cell& counts)
      : is_level_(counts[2] == 1),
        tiles_(is_level_ ? Cell{up(counts[0], 32), up(counts[1], 32), 1}
                         : Cell{up(counts[0], 16), up(counts[1], 8), up(counts[2], 8)}),
        of_tiles_(tiles_),
        row_(std::uint32_t(tiles_[0]) * kCells),
        level_(row_ * std::uint32_t(tiles_[1])) {}

  /// Of the lattice's cells. Throws ParameterError("cell_m", …) if they are too many.
  static TileIndex of(const Lattice& lattice) {
    TileIndex tiles(lattice.spec().counts);
    if (!tiles.fits()) {
      throw ParameterError("cell_m",
                           "the lattice would have too many cells to number in 32 bits: " +
                               std::to_string(lattice.size()) +
                               "; choose larger cells or a smaller volume");
    }
    return tiles;
  }

  /// Of cells, those of unfilled tiles included; a number is below it.
  std::size_t size() const { return tiles() * kCells; }
  std::size_t tiles() const {
    return std::size_t(tiles_[0]) * std::size_t(tiles_[1]) * std::size_t(tiles_[2]);
  }
  /// True if every number fits into 32 bits.
  bool fits() const { return size() <= std::size_t{1} << 32; }

  std::uint32_t x_part(int x) const {
    const auto n = std::uint32_t(x);
    return is_level_ ? (n & 3) | (n >> 2 & 7) << 4 | (n >> 5) * kCells
                     : (n & 3) | (n >> 2 & 3) << 6 | (n >> 4) * kCells;
  }
  std::uint32_t y_part(int y) const {
    const auto n = std::uint32_t(y);
    return is_level_ ? (n & 3) << 2 | (n >> 2 & 7) << 7 | (n >> 5) * row_
                     : (n & 3) << 2 | (n >> 2 & 1) << 8 | (n >> 3) * row_;
  }
  std::uint32_t z_part(int z) const {
    const auto n = std::uint32_t(z);
    return is_level_ ? 0 : (n & 3) << 4 | (n >> 2 & 1) << 9 | (n >> 3) * level_;
  }
  std::uint32_t number(const Cell& c) const { return x_part(c[0]) + y_part(c[1]) + z_part(c[2]); }

  Cell cell(std::uint32_t number) const {
    const Cell tile = of_tiles_.cell(number / kCells);
    const auto bits = [&](int at, std::uint32_t mask) { return int(number >> at & mask); };
    return is_level_ ? Cell{tile[0] * 32 + (bits(0, 3) | bits(4, 7) << 2),
                            tile[1] * 32 + (bits(2, 3) | bits(7, 7) << 2), 0}
                     : Cell{tile[0] * 16 + (bits(0, 3) | bits(6, 3) << 2),
                            tile[1] * 8 + (bits(2, 3) | bits(8, 1) << 2),
                            tile[2] * 8 + (bits(4, 3) | bits(9, 1) << 2)};
  }

 private:
  static int up(int count, int edge) { return (count + edge - 1) / edge; }

  bool is_level_ = false;
  Cell tiles_{};
  CellIndex of_tiles_;
  std::uint32_t row_ = 0;
  std::uint32_t level_ = 0;
};

/// The numbers of the cells around a cell, by direction.
class NumbersAround {
 public:
  NumbersAround(const TileIndex& tiles, const Cell& c) {
    for (int by = -1; by <= 1; ++by) {
      x_[by + 1] = tiles.x_part(c[0] + by);
      y_[by + 1] = tiles.y_part(c[1] + by);
      z_[by + 1] = tiles.z_part(c[2] + by);
    }
  }
  std::uint32_t operator()(int d) const { return x_[d % 3] + y_[d / 3 % 3] + z_[d / 9]; }

 private:
  std::uint32_t x_[3];
  std::uint32_t y_[3];
  std::uint32_t z_[3];
};

/// A number for each cell of some tiles, 0 until written. The system gives memory to pages that are
/// written, and a reset clears the tiles that were.
template <class T>
class TiledArray {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// All zero, for so many tiles.
  void reset(std::size_t tiles) {
    if (tiles > is_written_.size()) {
      is_written_.clear();
      memory_ = {};
      memory_ = ZeroMemory(tiles * kTileBytes);
      values_ = static_cast<T*>(memory_.data());
      is_written_.assign(tiles, 0);
    } else {
      for (const std::uint32_t tile : written_) {
        std::memset(values_ + std::size_t(tile) * TileIndex::kCells, 0, kTileBytes);
        is_written_[tile] = 0;
      }
    }
    written_.clear();
  }

  const T& operator[](std::size_t number) const { return values_[number]; }
  /// For writing.
  T& at(std::size_t number) {
    const std::size_t tile = number / TileIndex::kCells;
    if (is_written_[tile] == 0) [[unlikely]] {
      note(tile);
    }
    return values_[number];
  }
  void prefetch(std::size_t number) const { __builtin_prefetch(values_ + number); }
  /// Bytes of the tiles written since the reset.
  std::size_t bytes() const { return written_.size() * kTileBytes; }

 private:
  static constexpr std::size_t kTileBytes = TileIndex::kCells * sizeof(T);

  [[gnu::noinline]] void note(std::size_t tile) {
    is_written_[tile] = 1;
    written_.push_back(std::uint32_t(tile));
  }

  ZeroMemory memory_;
  T* values_ = nullptr;
  std::vector<std::uint8_t> is_written_;  // by tile
  std::vector<std::uint32_t> written_;    // tiles
};
}  // namespace altiplan::kit
