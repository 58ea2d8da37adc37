// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/request.hpp"

namespace altiplan {

/// One for each leg of a route on which a moving obstacle, of those that routes are planned
/// against, comes nearer than allowed: the first such obstacle.
std::vector<Violation> moving_violations(const Route& route, const Request& request);
}  // namespace altiplan
