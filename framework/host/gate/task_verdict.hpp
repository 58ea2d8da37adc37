// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "host/gate/plan_report.hpp"

namespace altiplan::host {

/// A waypoint of a flight, and what is done there.
struct PlaceFlown {
  Vec3 at{0, 0, 0};
  double hold_s = 0;
  bool lands = false;
  std::optional<double> drops_after_s{};  ///< its cargo, after waiting for so long
  bool is_on_curve = false;               ///< the way there is not straight
};

/// The waypoints of a route; it neither lands nor drops anything.
std::vector<PlaceFlown> places_flown(const Route& route);

/// What of the scenario's task is not done by a flight past these places, in whatever order it
/// flies the task's passes, and either way; none if all is. A pass that is not flown is not judged:
/// other lines may show the same ground. A place is missed that no waypoint is within a metre of.
std::optional<Finding> undone(const Mission& world, const std::vector<PlaceFlown>& places);
/// The same of a mission that may be flown so: of what all flights do. A landing is at the height
/// from which it goes down. Not judged with jumps, conditions, new homes, and of aeroplanes.
std::optional<Finding> undone(const Mission& world, const formats::MissionFile& plan,
                              const std::vector<FlownMission>& flights);
}  // namespace altiplan::host
