// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "altiplan/check.hpp"
#include "altiplan/request.hpp"

namespace altiplan::host {

/// Where a route leaves the ground, and returns to it, on a slope: from the start straight to a
/// point, and from a point straight to the goal. There it keeps off the ground as a SlantedEnd
/// does. A VTOL's are level: it begins and ends in hover.
struct Runways {
  std::optional<Vec3> climbs_to{};
  std::optional<Vec3> glides_from{};

  bool has_any() const { return climbs_to || glides_from; }
};

/// The ends of the route that are slopes.
struct SlantedLegs {
  std::size_t first = 0;  ///< waypoint after the climb
  std::size_t last = 0;   ///< and before the glide
};
SlantedLegs slanted_legs(const Route& route, const Runways& runways);

/// Ground and heights: of the route between its slopes as the request has them, and of its slopes.
std::vector<Violation> ground_violations(const Route& route, const Request& request,
                                         const Runways& runways);
/// The request without ground and the heights above it.
Request above_no_ground(Request request);
}  // namespace altiplan::host
