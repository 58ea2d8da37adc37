// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/request.hpp"
#include "host/import_export/joined_route.hpp"

namespace altiplan::host {

/// A route as the places of a file.
struct WrittenRoute {
  std::vector<MissionPlace> places;
  std::size_t loiters = 0;  ///< turns written as circles
  std::size_t turns = 0;    ///< turns written as points
  std::size_t points = 0;   ///< the number of those
};

/// Maximum distance between a turn and the legs between the points that stand for it, metres.
inline constexpr double kArcTolerance = 0.5;

/// How to write turns.
struct ArcForm {
  bool loiters = false;              ///< as circles, where joined_route reads back the same turn
  double tolerance = kArcTolerance;  ///< of the points of all others
};

/// The intersection of the tangents at both ends of a piece of less than half a turn.
Vec3 corner_of(const Leg& piece);

/// Points stand outside a turn, so that the legs between them touch it: they have its headings, and
/// corners of its radius fit into them. Waypoints of a turn are left out where the legs on both
/// sides pass through them, unless they are among `via`. Where turns may be circles, so are the
/// loiters of start and goal: the goal's follows the last waypoint, the start's takes the place of
/// the first one if it is left along a straight leg.
WrittenRoute written_route(const Route& route, const ArcForm& form,
                           const std::vector<std::size_t>& via, const Request& request);
}  // namespace altiplan::host
