// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/leg.hpp"

namespace altiplan {

/// Of one leg: a hundred circles, radians, and the largest radius, metres.
inline constexpr double kMaxTurn = radians(36'000);
inline constexpr double kMaxTurnRadius = 1e8;

/// True if all numbers are finite, the drift is horizontal, and a turn has a radius above 0, both
/// within their maximum.
inline bool is_well_formed(const Leg& leg) {
  return is_finite(leg.from) && is_finite(leg.to) && is_finite(leg.drift) && leg.drift.z() == 0 &&
         std::isfinite(leg.heading) &&
         (!leg.turns() ||
          (std::abs(leg.turn) <= kMaxTurn && leg.radius > 0 && leg.radius <= kMaxTurnRadius));
}
}  // namespace altiplan
