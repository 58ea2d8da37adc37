// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "altiplan/request.hpp"
#include "altiplan/route.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// The scene seen from above, with its routes' height profiles below: one self-contained SVG.
std::string picture_svg(const Json& scene);

/// The height profile of a route alone, with the ground, the heights allowed and obstacles.
std::string profile_svg(const Route& route, const Request& request);

/// A route seen from above among the world's layers, with a label at each waypoint.
std::string map_svg(const Route& route, const std::vector<std::string>& labels,
                    const Mission& world);
}  // namespace altiplan::host
