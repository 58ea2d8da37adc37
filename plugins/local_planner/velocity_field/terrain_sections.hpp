// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/world.hpp"
#include "field.hpp"

namespace velocity_field {

/// What a flight asks of the ground.
struct GroundRules {
  altiplan::Box box;   ///< where it is looked at; the height is not used
  double cell = 0;     ///< side of the cells it is looked at by
  double above = 0;    ///< least height above ground
  double radius = 0;   ///< least distance in space
  double reserve = 0;  ///< height that may be lost before a climb is under way
  double bay = 0;      ///< no bay or pass of a section is narrower than two of it
  double slope = 0;    ///< steepest climb, rise over run; 0: level flight
  double ceiling = altiplan::kInfinity;
};

/// The ground as a grid of heights that a flight has to keep above.
class TerrainSections {
 public:
  TerrainSections(const altiplan::World& world, const GroundRules& rules);

  /// Least height from which a climb at `slope` keeps above the ground whichever way it heads, at
  /// least that of the ground below; outside the box as at its edge. It rises nowhere steeper than
  /// `slope`. Ground too high for the ceiling is not part of it.
  double safe_height(const Vec2& p) const;
  /// Whether the leg keeps above the ground; legs close to it may be refused.
  bool is_above(const altiplan::Vec3& a, const altiplan::Vec3& b) const;
  /// Signed distances from the sections' edges, their bays filled: wherever the safe height is
  /// above `level`, and all ground too high for the ceiling.
  std::vector<float> gaps(double level) const;
  /// The disc that stands for the sections at p: its edge as far as theirs, pushing the same way,
  /// with the radius given; none beyond `reach`.
  std::optional<Disc> disc(const std::vector<float>& gaps, const Vec2& p, double radius,
                           double reach) const;

 private:
  std::size_t at(int i, int j) const { return std::size_t(j) * std::size_t(columns_) + i; }
  Vec2 centre(int i, int j) const { return low_ + cell_ * Vec2(i + 0.5, j + 0.5); }
  /// Greatest height of the cell's ground with what is asked above it; infinite where not known.
  double top(const altiplan::World& world, const GroundRules& rules, const Vec2& centre) const;
  void spread(double slope);
  /// Distance of each cell to the nearest one that is not `far`; 0 for those.
  template <class Far>
  std::vector<float> distances(const Far& far) const;
  /// Calls with each cell and each neighbour of it, so that whatever is handed on from neighbour to
  /// cell comes everywhere.
  template <class HandOn>
  void sweep(const HandOn& hand_on) const;
  /// Between the cells' centres; values are finite.
  double between(const std::vector<float>& values, const Vec2& p) const;

  Vec2 low_{0, 0};
  double cell_ = 1;
  double bay_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> tops_;   ///< one entry a cell: greatest height, with what is asked above it
  std::vector<float> safe_;   ///< one entry a cell, at its centre
  std::vector<char> closed_;  ///< one entry a cell: too high for the ceiling
};
}  // namespace velocity_field
