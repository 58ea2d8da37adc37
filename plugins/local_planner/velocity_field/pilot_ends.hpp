// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "altiplan/local_planner.hpp"

namespace velocity_field {
using namespace altiplan;

inline PilotStep stuck(const Observation& seen, std::string_view why) {
  return {seen.state, PilotStep::Outcome::stuck, why};
}

/// The result if nothing is left to fly: at the goal, or where a level flight cannot reach it.
inline std::optional<PilotStep> end_of_flight(const Observation& seen, bool level) {
  if (seen.goal.reached_at(seen.state.position)) {
    return PilotStep{{seen.state.time_s + std::min(seen.max_dt_s, 1e-3), seen.state.position,
                      seen.state.velocity},
                     PilotStep::Outcome::arrived,
                     "at the goal"};
  }
  if (level && std::abs(seen.goal.position.z() - seen.state.position.z()) >
                   seen.goal.tolerance_m + kLengthTolerance) {
    return stuck(seen, "the goal is not at the height of the flight, which is level");
  }
  return std::nullopt;
}
}  // namespace velocity_field
