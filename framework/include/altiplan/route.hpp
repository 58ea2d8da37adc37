// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Waypoints joined by straight legs.
using Route = std::vector<Vec3>;

/// Sum of leg lengths, metres.
ALTIPLAN_API double length(const Route& route);
/// The route without consecutive repeated points.
ALTIPLAN_API Route without_repeats(const Route& route);

/// Where a vehicle comes from, and its heading, on reaching the first point of a leg. Legs without
/// a heading preserve the last one: a vehicle that climbs on the spot keeps its heading.
struct ALTIPLAN_API Approach {
  Vec3 from{0, 0, 0};
  Vec3 heading{0, 0, 0};  ///< horizontal direction of any length, on reaching `from`; zero where
                          ///< there is none yet

  Approach(const Vec3& point, const Vec3& before = Vec3::Zero())  // NOLINT(*-explicit-*)
      : from(point), heading(before) {}

  /// Heading on arrival at `here`; zero where there is none.
  Vec3 heading_at(const Vec3& here) const {
    const Vec3 leg = here - from;
    return has_heading(leg) ? Vec3(leg.x(), leg.y(), 0) : heading;
  }
};

/// The approach to the end of the next leg of a vehicle that reached `here` by `before`.
inline Approach onward(const std::optional<Approach>& before, const Vec3& here) {
  return {here, before ? before->heading_at(here) : Vec3::Zero()};
}

/// Horizontal turn at `here` toward `next`, in [0, pi]; 0 where there is no heading to turn from or
/// to. A vehicle that turns on the spot does so on legs without a heading.
ALTIPLAN_API double horizontal_turn(const Approach& before, const Vec3& here, const Vec3& next,
                                    bool turns_on_the_spot);
/// Fillet radius of the corner at `here`; 0 where the heading changes over a leg without a heading
/// and the vehicle does not turn on the spot.
ALTIPLAN_API double corner_radius(const Approach& before, const Vec3& here, const Vec3& next,
                                  bool turns_on_the_spot);

/// The approach to point number `to` of a vehicle that reached the route's first point by `before`.
/// Repeated points are skipped.
ALTIPLAN_API std::optional<Approach> approach(const Route& route, std::size_t to,
                                              const std::optional<Approach>& before);
}  // namespace altiplan
