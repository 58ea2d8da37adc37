// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/route.hpp"
#include "altiplan/world.hpp"

/// \file Where a route comes nearest to what stands in its world.
namespace altiplan {

/// A leg, counted by the waypoint where it begins, and its clearance or its height above ground.
struct NearestLeg {
  std::size_t leg;
  double distance;
};

/// The leg with the least clearance from the layer, as leg_clearance has it; none where that is at
/// least `enough` on all legs.
ALTIPLAN_API std::optional<NearestLeg> nearest_leg(const Environment& environment,
                                                   const Route& route, double enough = kInfinity);
/// The place of the leg a–b, as a share of it, with that clearance, the leg's own.
ALTIPLAN_API double nearest_share(const Environment& environment, const Vec3& a, const Vec3& b,
                                  double clearance);

/// The leg that comes lowest above the ground; none where no ground is below the route.
ALTIPLAN_API std::optional<NearestLeg> lowest_leg(const World& world, const Route& route);
/// The place of the leg a–b, as a share of it, that is so high above the ground, the leg's least.
ALTIPLAN_API double lowest_share(const World& world, const Vec3& a, const Vec3& b, double height);

/// The clearance of a place, as the judge's, within 1 mm: quicker than leg_clearance.
ALTIPLAN_API double place_clearance(const Environment& environment, const Vec3& p);
}  // namespace altiplan
