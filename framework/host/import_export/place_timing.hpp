// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/import_export/joined_route.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// How a vehicle is expected to fly a mission.
struct PlaceTiming {
  double time_s = 0;  ///< when it is at the place, since the route's start
  /// The speed at which it may fly all of the way from the place before, where its speed depends on
  /// the distance from obstacles; 0: as always.
  double speed_mps = 0;
};

/// One per place, in the known world.
std::vector<PlaceTiming> timing_of(const std::vector<MissionPlace>& places, const Mission& mission);

/// How many commands set those speeds.
std::size_t speed_changes(const std::vector<PlaceTiming>& timing, double speed_mps);
}  // namespace altiplan::host
