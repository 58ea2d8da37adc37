// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/geometry.hpp"

namespace altiplan {

/// Waypoints joined by straight legs.
using Route = std::vector<Vec3>;

/// Sum of leg lengths, metres.
ALTIPLAN_API double length(const Route& route);
/// The route without repeated points in a row.
ALTIPLAN_API Route without_repeats(const Route& route);
}  // namespace altiplan
