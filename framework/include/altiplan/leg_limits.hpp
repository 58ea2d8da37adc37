// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/leg.hpp"

namespace altiplan {

/// Of one leg: a hundred circles, radians, and the largest radius, metres.
inline constexpr double kMaxTurn = radians(36'000);
inline constexpr double kMaxTurnRadius = 1e8;

/// True if all numbers are finite, the drift is horizontal, a turn has a radius above 0, both
/// within their maximum, and a wait has no length.
inline bool is_well_formed(const Leg& leg) {
  return is_finite(leg.from) && is_finite(leg.to) && is_finite(leg.drift) && leg.drift.z() == 0 &&
         std::isfinite(leg.heading) && std::isfinite(leg.hold_s) &&
         (!leg.waits() || (leg.hold_s > 0 && !leg.turns() && leg.from == leg.to)) &&
         (!leg.turns() ||
          (std::abs(leg.turn) <= kMaxTurn && leg.radius > 0 && leg.radius <= kMaxTurnRadius));
}
}  // namespace altiplan
