// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/world.hpp"

namespace altiplan::host {

/// A slanted end of a flight, which is on the ground at `foot_m` above sea level, keeps off the
/// ground by half of its height above that, up to what the rest of the flight keeps.
struct SlantedEnd {
  static constexpr double kTouch = 1;  ///< metres that it may be below that

  double foot_m = 0;
  double clearance_m = 0;

  double needed(double z) const;
  /// By how much a straight leg is above that, at its worst; negative: below. NaN or infinite where
  /// the ground is not known all along.
  double margin(const World& world, const Vec3& from, const Vec3& to) const;
  /// Within a metre, where on the leg that is.
  Vec3 worst(const World& world, Vec3 from, Vec3 to) const;
};
}  // namespace altiplan::host
