// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/request.hpp"
#include "altiplan/route.hpp"
#include "altiplan/swept_volume.hpp"

/// \file The places and attitudes of a vehicle's body along a route, for pictures; with the
/// attitudes that the judge checks. Where any heading is possible, the body faces east.
namespace altiplan {

/// The body at both attitudes of every waypoint, and at most `spacing` metres apart between them,
/// in order; none without a body.
ALTIPLAN_API std::vector<Placement> body_along(const Route& route, const Request& request,
                                               double spacing);

/// Where a body comes nearest to the layers of the world.
struct NearestBody {
  Placement placement;
  std::string layer;  ///< its id
  double distance;    ///< metres; 0 where they meet
  bool proven;        ///< false: the search ended early, and another place may be nearer
};

/// Searches the route for the minimum distance between body and layers, to 1 cm; none without a
/// body, a leg or an obstacle. The search ends early on long routes and far from obstacles.
ALTIPLAN_API std::optional<NearestBody> nearest_body(const Route& route, const Request& request);
}  // namespace altiplan
