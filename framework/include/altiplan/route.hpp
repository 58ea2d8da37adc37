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
/// The route without repeated points in a row.
ALTIPLAN_API Route without_repeats(const Route& route);

/// How a vehicle comes to the first point of a leg: from which point, and with what heading. A
/// heading lasts through legs that have none: a vehicle that climbs on the spot keeps its own.
struct ALTIPLAN_API Approach {
  Vec3 from{0, 0, 0};
  Vec3 heading{0, 0, 0};  ///< horizontal direction of any length, with which it came to `from`;
                          ///< zero where it has had none

  Approach(const Vec3& point, const Vec3& before = Vec3::Zero())  // NOLINT(*-explicit-*)
      : from(point), heading(before) {}

  /// The heading with which it arrives at `here`; zero where it has none.
  Vec3 heading_at(const Vec3& here) const {
    const Vec3 leg = here - from;
    return has_heading(leg) ? Vec3(leg.x(), leg.y(), 0) : heading;
  }
};

/// How a vehicle that came to `here` by `before` comes to the end of its next leg.
inline Approach onward(const std::optional<Approach>& before, const Vec3& here) {
  return {here, before ? before->heading_at(here) : Vec3::Zero()};
}

/// The turn in the horizontal at `here`, on to `next`, in [0, pi]; 0 where there is no heading to
/// turn from or to. A vehicle that turns on the spot does so at legs without a heading.
ALTIPLAN_API double horizontal_turn(const Approach& before, const Vec3& here, const Vec3& next,
                                    bool turns_on_the_spot);
/// The radius of the corner at `here`: that of its fillet; 0 where the heading changes over a leg
/// that has none and the vehicle does not turn on the spot.
ALTIPLAN_API double corner_radius(const Approach& before, const Vec3& here, const Vec3& next,
                                  bool turns_on_the_spot);

/// How a vehicle that came to the route's first point by `before` comes to point number `to`.
/// Repeated points are passed over.
ALTIPLAN_API std::optional<Approach> approach(const Route& route, std::size_t to,
                                              const std::optional<Approach>& before);
}  // namespace altiplan
