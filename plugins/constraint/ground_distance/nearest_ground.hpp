// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/ground.hpp"
#include "altiplan/world.hpp"

namespace ground_distance {

/// A point of the ground near a place, and bounds of the distance of the nearest one. A place at or
/// below the ground is 0 from it.
struct NearGround {
  altiplan::Vec3 point{0, 0, 0};
  const altiplan::Ground* ground = nullptr;  ///< that has the point; null: there is none
  double at_least = altiplan::kInfinity;
  double at_most = altiplan::kInfinity;
};

/// The ground of all layers near a place. Once a point within `limit` is found over posts, nearer
/// ones are not searched for; else all ground up to 1 mm beyond it is known.
NearGround nearest_ground(const altiplan::World& world, const altiplan::Vec3& p, double limit);

/// Maximum vertical distance between a straight line from one point of the surface to another and
/// the ground above or below it.
double off_the_ground(const altiplan::Ground& ground, const altiplan::Vec3& a,
                      const altiplan::Vec3& b);
}  // namespace ground_distance
