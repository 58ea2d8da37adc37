// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/limits.hpp"
#include "altiplan/route.hpp"

namespace altiplan::host {

/// An item of a mission in local metres: a waypoint, or a circle around it.
struct MissionPlace {
  Vec3 at{0, 0, 0};
  std::optional<formats::MissionCircle> circle{};
  double hold_s = 0;  ///< for which the vehicle waits there, of a route that is written
  double along = 0;   ///< of the same: the waypoint, or between two the share of the leg beside it
};

struct JoinedRoute {
  Route route;
  std::vector<std::size_t> places;  ///< of each waypoint: the place that it belongs to
  std::size_t circles = 0;          ///< that became turns
  std::size_t unjoined = 0;  ///< without a tangent from the place before or to the one after: read
                             ///< as waypoints
};

/// An autopilot leaves a circle once its heading is this near to that of the tangent.
inline constexpr double kExitTolerance = radians(10);
/// A waypoint this near to a circle lies on it, metres: the route enters the circle there.
inline constexpr double kOnCircle = 1;

/// The route past the places as MAVLink describes their commands: straight to the tangent point of
/// a circle, around it, and out along the tangent to the next place. A circle at a new altitude is
/// climbed with the fewest full circles that the limits on climb and descent allow. A route that
/// begins with a circle begins at its exit, one that ends with a circle ends where it enters it.
/// `heading` is the one at the first place, if known.
JoinedRoute joined_route(const std::vector<MissionPlace>& places, std::optional<double> heading,
                         const Limits& limits);
}  // namespace altiplan::host
