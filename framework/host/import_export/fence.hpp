// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/kit/formats/mission_file.hpp"
#include "altiplan/route.hpp"
#include "altiplan/world.hpp"

namespace altiplan::host {

/// The keep-out and keep-in zones of a world, in longitude and latitude.
struct Fence {
  std::vector<kit::MissionZone> zones;
  std::vector<std::string> notes;  ///< what of them the format cannot say
};

/// All zones as they are: for formats that hold limits in height and holes.
Fence zones_of(const World& world);

/// The zones as a fence without limits in height, as ground stations have it. A zone that the route
/// flies over, under or through the hole of would stop it there: it is left out, and said.
Fence flat_fence_of(const World& world, const Route& route);
}  // namespace altiplan::host
