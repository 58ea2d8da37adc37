// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "altiplan/kit/lattice/ground_rules.hpp"
#include "altiplan/kit/lattice/lattice.hpp"
#include "altiplan/kit/scratch.hpp"

namespace altiplan::kit {

/// Which steps of a lattice the ground permits. A step over the same two columns of cells is
/// permitted from some level on (and, below a ceiling over the ground, up to another), so that one
/// or two queries to the world answer for all levels.
class ALTIPLAN_API GroundSteps {
 public:
  /// True if the levels can be numbered here.
  static bool fit(const Lattice& lattice) { return lattice.spec().counts[2] < kNever; }

  /// Both must outlive this object.
  GroundSteps(const Lattice& lattice, const GroundRules& rules);

  /// The steps among `wanted` out of c that are permitted.
  DirectionMask permitted(const Cell& c, DirectionMask wanted) {
    const std::size_t at = column_at(c[0], c[1]);
    const Column& column = columns_.at(at);
    for (DirectionMask left = wanted & ~column.known; left != 0; left &= left - 1) {
      learn(c[0], c[1], __builtin_ctz(left));
    }
    DirectionMask kept = wanted & ~above(column.lowest.data(), c[2]);
    if (has_ceiling_) {
      kept &= above(highest_.at(at).data(), c[2] - 1);
    }
    if (kept != wanted) {
      count(at, c[2], wanted & ~kept);
    }
    return kept;
  }
  /// True if every step between two cells of the 3 x 3 x 3 around c is permitted, as far as bounds
  /// tell.
  bool permits_all_around(const Cell& c) {
    const std::size_t at = column_at(c[0], c[1]);
    if (open_from_[at] == 0) [[unlikely]] {
      open_from_.at(at) = std::uint16_t(level_above_all(c[0], c[1]) + 1);
    }
    return c[2] + 1 >= open_from_[at];
  }
  /// How many steps were refused, and why.
  struct Refused {
    std::int64_t no_ground = 0;
    std::int64_t too_low = 0;
    std::int64_t too_high = 0;
  };
  const Refused& refused() const { return refused_; }

  /// Bytes of the answers known so far.
  std::size_t bytes() const { return columns_.bytes() + highest_.bytes(); }

 private:
  using Level = std::int16_t;
  static constexpr Level kNever = 32'000;  ///< as a lowest level: permitted on none

  using Levels = std::array<Level, 32>;  ///< by direction
  struct alignas(64) Column {
    std::array<Level, 28> lowest;  ///< by direction, the level from which its step is permitted
    DirectionMask known = 0;
    float ground = NAN;  ///< below its middle, or a little less; NaN: not asked yet
  };
  static_assert(sizeof(Column) == sizeof(Levels));

  /// One for each column of cells, in pages that are made when they are asked for.
  template <class T>
  class Pages {
   public:
    void resize(std::size_t columns) { pages_.resize(columns / kColumns + 1); }
    T& at(std::size_t column) {
      std::unique_ptr<Page>& page = pages_[column / kColumns];
      if (page == nullptr) [[unlikely]] {
        page = std::make_unique<Page>();
        ++used_;
      }
      return page->columns[column % kColumns];
    }
    std::size_t bytes() const { return used_ * sizeof(Page); }

   private:
    static constexpr std::size_t kColumns = 64;
    struct alignas(64) Page {
      std::array<T, kColumns> columns{};
    };
    std::vector<std::unique_ptr<Page>> pages_;
    std::size_t used_ = 0;
  };

  std::size_t column_at(int east, int north) const {
    return std::size_t(north) * columns_east_ + std::size_t(east);
  }
  /// The directions whose level, of 32, is above that one.
  static DirectionMask above(const Level* levels, int level);
  void count(std::size_t column, int level, DirectionMask refused);
  /// Finds the levels of a step, and of its reverse.
  void learn(int east, int north, int d);
  void set(int east, int north, int d, int lowest, int highest);
  double ground_at(int east, int north);
  /// The lowest level around which bounds permit everything.
  int level_above_all(int east, int north) const;

  const Lattice& lattice_;
  const GroundRules& rules_;
  const World& world_;
  std::size_t columns_east_;
  double z0_;      ///< of the nodes of level 0
  double height_;  ///< between two levels
  int levels_;
  bool has_ceiling_;
  Pages<Column> columns_;
  Pages<Levels> highest_;  ///< where there is a ceiling: the highest levels of steps
  Refused refused_;
  ScratchArray<std::uint16_t> open_from_;  ///< by column, plus 1; 0: unknown
};
}  // namespace altiplan::kit
