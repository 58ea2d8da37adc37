// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// What can be dragged in a scenario: its start, via points and goal, shapes and points of layers,
/// of moving obstacles and of events. Each is {"key": of its map in the scenario ("via.0"), "kind":
/// start, via, goal, layer, moving or event, "plugin", "name", "at": [x, y, z] of its middle (m)},
/// heights above the sea where it has one, else on the ground.
Json movable(const Value& scenario, const World& world);

/// The assignments that move what stands at `key` by so much (m; east, north, up), in the form in
/// which it is written: metres, or longitude and latitude; a height above the ground stays so.
/// Throws Error if there is nothing to move, or no height to change.
std::vector<std::string> moved(const Value& scenario, const std::string& key, const Vec3& by,
                               const Frame& frame);
}  // namespace altiplan::host
