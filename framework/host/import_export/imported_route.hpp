// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "altiplan/kit/formats/mission_file.hpp"
#include "altiplan/world.hpp"
#include "host/mission/mission.hpp"

namespace altiplan::host {

/// A route that another program wrote, or that we wrote for one.
struct ImportedRoute {
  Route route;
  std::vector<std::string> notes;  ///< what was left out, how heights were read
};

/// Degrees of seven decimals are up to this far from what they stand for, in metres: a first point
/// that is as near to the start is the start.
inline constexpr double kRoundingReach = 0.02;

/// The point in local metres; `home` is for heights relative to it. Throws Error in a world without
/// a position, or ground below where it is asked for.
Vec3 to_local(const kit::MissionPoint& point, const std::optional<kit::MissionPoint>& home,
              const World& world);

/// A mission's route in the world; messages begin with `file`.
ImportedRoute route_in(const kit::MissionFile& mission, const World& world, const Vec3& start,
                      const std::string& file);

/// Reads a route in any of the forms that we write: JSON ([[x, y, z], …] or a result), CSV, or a
/// mission file. The rounding of a start is undone for all but JSON.
ImportedRoute read_imported_route(const std::string& file, const Mission& mission);
/// The same from a text that is at hand, not JSON.
ImportedRoute read_imported_route(const std::string& file, const std::string& text,
                                const World& world, const Vec3& start);
}  // namespace altiplan::host
