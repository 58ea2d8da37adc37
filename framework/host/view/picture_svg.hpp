// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/request.hpp"
#include "altiplan/route.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::host {

/// The scene seen from above, with its routes' height profiles below: one self-contained SVG.
std::string picture_svg(const Json& scene);

/// The height profile of a route alone, with the ground, the heights allowed and obstacles.
std::string profile_svg(const Route& route, const Request& request);
}  // namespace altiplan::host
