// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/mission/mission.hpp"

namespace altiplan::host {

/// Indices of at most `most` points of the route that keep every leg valid under the request's
/// constraints: repeatedly drops the point nearest to the line between its neighbours whose new
/// legs are valid. Ends and via points stay. More than `most` if no further point can be dropped.
std::vector<std::size_t> thinned(const Polyline& route, std::size_t most, const Request& request,
                                 const std::vector<Goal>& via);
}  // namespace altiplan::host
