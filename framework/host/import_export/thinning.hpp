// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/mission/mission.hpp"

namespace altiplan::host {

/// Indices of at most `max_points` waypoints of the route that keep every leg valid under the
/// request's constraints: repeatedly drops the one nearest to the line between its neighbours whose
/// new legs are valid. Ends, turns and the waypoints in `via` stay. More than `max_points` if no
/// further one can be dropped.
std::vector<std::size_t> thinned(const Route& route, std::size_t max_points, const Request& request,
                                 const std::vector<std::size_t>& via);

/// The route past the waypoints with those indices: straight where some between are left out.
Route part_of(const Route& route, const std::vector<std::size_t>& kept);
}  // namespace altiplan::host
