// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "host/mission/mission.hpp"

namespace altiplan::host {

/// Indices of at most `most` points of the route that keep every leg sound by the request's rules:
/// the point that lies nearest to the line between its neighbours goes first, as long as the new
/// legs are sound. Ends and via points stay. More than `most` where no point can go any more.
std::vector<std::size_t> thinned(const Route& route, std::size_t most, const Request& request,
                                 const std::vector<Goal>& via);
}  // namespace altiplan::host
