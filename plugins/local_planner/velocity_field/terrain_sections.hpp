// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/world.hpp"
#include "field.hpp"

namespace velocity_field {

/// Requirements of a flight on the ground.
struct GroundRules {
  altiplan::Box box;   ///< region to sample; the height is not used
  double cell = 0;     ///< edge of the sampling cells
  double above = 0;    ///< minimum height above ground
  double radius = 0;   ///< minimum distance in 3-D
  double reserve = 0;  ///< height that may be lost before a climb is established
  double bay = 0;      ///< no bay or pass of a section is narrower than twice this
  double slope = 0;    ///< steepest climb, rise over run; 0: level flight
  double ceiling = altiplan::kInfinity;
};

/// The ground as a grid of heights that a flight has to stay above.
class TerrainSections {
 public:
  TerrainSections(const altiplan::World& world, const GroundRules& rules);

  /// Minimum height from which a climb at `slope` stays above the ground in any heading, at least
  /// the height of the ground below; outside the box as at its edge. Its slope never exceeds
  /// `slope`. Excludes ground too high for the ceiling.
  double safe_height(const Vec2& p) const;
  /// True if the leg stays above the ground; legs close to it may be rejected.
  bool is_above(const altiplan::Vec3& a, const altiplan::Vec3& b) const;
  /// Signed distances from the sections' edges, their bays filled: wherever the safe height is
  /// above `level`, and all ground too high for the ceiling.
  std::vector<float> gaps(double level) const;
  /// The disc that represents the sections at p: its edge as far away as theirs, pushing the same
  /// way, with the given radius; empty beyond `reach`.
  std::optional<Disc> disc(const std::vector<float>& gaps, const Vec2& p, double radius,
                           double reach) const;

 private:
  std::size_t at(int i, int j) const { return std::size_t(j) * std::size_t(columns_) + i; }
  Vec2 centre(int i, int j) const { return low_ + cell_ * Vec2(i + 0.5, j + 0.5); }
  /// Maximum height of the cell's ground plus the required height above it; infinite if unknown.
  double top(const altiplan::World& world, const GroundRules& rules, const Vec2& centre) const;
  void spread(double slope);
  /// Distance of each cell to the nearest one that is not `far`; 0 for those.
  template <class Far>
  std::vector<float> distances(const Far& far) const;
  /// Calls hand_on with each cell and each of its neighbours, in an order that propagates a value
  /// from neighbour to cell over the whole grid.
  template <class HandOn>
  void sweep(const HandOn& hand_on) const;
  /// Interpolates between the cells' centres; values are finite.
  double between(const std::vector<float>& values, const Vec2& p) const;

  Vec2 low_{0, 0};
  double cell_ = 1;
  double bay_ = 0;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> tops_;   ///< one entry per cell: maximum height plus required height above
  std::vector<float> safe_;   ///< one entry per cell, at its centre
  std::vector<char> closed_;  ///< one entry per cell: too high for the ceiling
};
}  // namespace velocity_field
