// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "altiplan/route.hpp"
#include "host/base/json.hpp"

namespace altiplan::host {

/// The legs of a route: [{"kind": "straight" | "arc" | "trochoid", "end": [x, y, z], "turn_deg",
/// "radius_m", "heading_deg", "drift_m"}]. Angles of turn are positive to the left. The heading is
/// that through the air at the leg's begin, clockwise from north; the drift that of the air during
/// the leg, [east, north]. All four are null for a straight leg; one on which the vehicle waits in
/// one place has its time too, "hold_s".
Json legs_json(const Route& route);

/// Reads them back; the first leg begins at `start`. Throws Error that begins with `place` (the
/// file and the key).
Route route_of_legs(const Vec3& start, const Json& legs, const std::string& place);
}  // namespace altiplan::host
