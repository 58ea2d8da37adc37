// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/formats/mission_file.hpp"
#include "altiplan/world.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// A route read from a file of altiplan or of another program.
struct ImportedRoute {
  Route route;
  std::vector<std::string> notes;  ///< what was ignored, how heights were interpreted
  /// Of a mission: the item of each waypoint; a circle may have two.
  std::vector<formats::MissionItem> items{};
};

/// Maximum rounding error of degrees with seven decimals, in metres: a first point this near to the
/// start is taken as the start.
inline constexpr double kRoundingReach = 0.02;

/// The point in local metres; `home` is for heights relative to it. Throws Error in a world without
/// a georeference, or without ground below the point if that is needed.
Vec3 to_local(const formats::MissionPoint& point, const std::optional<formats::MissionPoint>& home,
              const World& world);

/// A mission's route in the world, as joined_route describes it; messages begin with `file`. The
/// request gives the start and the limits on climb and descent.
ImportedRoute route_in(const formats::MissionFile& mission, const World& world,
                       const Request& request, const std::string& file);

/// Reads a route in any format that altiplan writes: JSON ([[x, y, z], …] or a result), or one of
/// the table of formats. Undoes the rounding of the start except in JSON. A CSV of columns x, y and
/// z has the waypoints between start and goal, with heights above ground.
ImportedRoute read_imported_route(const std::string& file, const Mission& mission);
/// The same from a text in memory, not JSON; `home` is that of a format without one.
ImportedRoute read_imported_route(const std::string& file, const std::string& text,
                                  const World& world, const Request& request,
                                  const std::optional<formats::MissionPoint>& home = {});
}  // namespace altiplan::host
