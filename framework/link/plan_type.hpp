// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace altiplan::link {

/// MAV_MISSION_TYPE: the three lists of items that a vehicle holds.
enum class PlanType : std::uint8_t { mission, fence, rally };

inline std::string name(PlanType type) {
  return type == PlanType::mission ? "mission" : type == PlanType::fence ? "fence" : "rally points";
}

/// MAV_MISSION_RESULT, as far as a transfer distinguishes them.
enum class MissionResult : std::uint8_t {
  accepted = 0,
  error = 1,
  unsupported_frame = 2,
  unsupported = 3,
  no_space = 4,
  invalid = 5,
  invalid_param1 = 6,
  invalid_param7 = 12,
  invalid_sequence = 13,
  denied = 14,
  cancelled = 15
};

/// The end of a sentence that begins with "the vehicle": "has no space for …".
std::string in_words(MissionResult result, PlanType type);
}  // namespace altiplan::link
