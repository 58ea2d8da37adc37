// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/check.hpp"

namespace altiplan::host {

/// A change of a waypoint: of its height, or of its place in plan.
struct Cure {
  std::size_t waypoint = 0;
  Vec3 by{0, 0, 0};  ///< metres; its length is a multiple of 0.1 m
};

/// What moves with what.
struct Bonds {
  /// Waypoints whose heights are given above the ground: moved aside, they follow it. Empty: none.
  std::vector<bool> follows_ground{};
  /// The last waypoint is at the height of the one before it, as where a landing is flown to, and
  /// its place is given.
  bool last_is_led = false;
};

/// The least change of one waypoint's height or, where none helps, the least shift toward one of 16
/// directions, of at most 1,000 m, with which the violated leg and the other leg at that waypoint
/// are valid; none if there is none, or the route has turns.
std::optional<Cure> cure(const Route& route, const Violation& violation, const Request& request,
                         const Bonds& bonds);

/// "raise mission.items.7 by 12.4 m", "move line 5 by 30.1 m to the north-east"
std::string in_words(const Cure& cure, const std::string& item);

/// The route with heights and places changed until it is valid, by cures of single waypoints and
/// by raising or lowering both ends of a leg, each by at most 1,000 m; none where that fails.
std::optional<Route> cured(const Route& route, const Request& request, const Bonds& bonds);
}  // namespace altiplan::host
