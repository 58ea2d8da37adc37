// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "host/config/scenario_file.hpp"

namespace altiplan::host {

/// What the smaller of the autopilots' stores holds of a fence: PX4 64 corners and circles
/// together, ArduPilot so many bytes (StorageManager.cpp).
struct FenceLimits {
  std::size_t points = 64;
  std::size_t bytes = 560;
};
FenceLimits fence_limits(VehicleType vehicle);

/// What a fence of these zones takes of both, with holes of keep-in zones as polygons.
FenceLimits fence_size(const std::vector<formats::Zone>& zones);

/// Simplifies the zones' polygons, whose edges are straight in longitude and latitude as autopilots
/// judge them, until the fence fits: keep-out zones grow, keep-in zones shrink, and keep-out zones
/// near each other become one; none comes to touch the route, points of longitude and latitude. The
/// simplifications of least area come first; those within 1.5 m of the outline are made in any
/// case. Returns what it did; a fence that cannot be made to fit stays too large, which is a note.
std::vector<std::string> fit_fence(std::vector<formats::Zone>& zones, const formats::Ring& route,
                                   const FenceLimits& limits);
}  // namespace altiplan::host
