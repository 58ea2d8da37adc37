// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/route.hpp"
#include "altiplan/world.hpp"
#include "host/config/scenario_file.hpp"

namespace altiplan::host {

/// The keep-out and keep-in zones of a world, in longitude and latitude.
struct Fence {
  std::vector<formats::Zone> zones;
  std::vector<std::string> notes;  ///< what the format cannot express
};

/// All zones unchanged: for formats with vertical limits and holes.
Fence zones_of(const World& world);

/// The zones as a fence without vertical limits, as ground stations use it, that fits into the
/// vehicle (see fit_fence): circles as circles, polygons with fewer corners where they are too
/// many. A zone that the route passes over, under, or through a hole of would stop it there: it is
/// left out with a note.
Fence flat_fence_of(const World& world, const Polyline& route, VehicleType vehicle);
}  // namespace altiplan::host
