// SPDX-License-Identifier: Apache-2.0
#include "link/plan_type.hpp"

namespace altiplan::link {

std::string in_words(MissionResult result, PlanType type) {
  if (result >= MissionResult::invalid_param1 && result <= MissionResult::invalid_param7) {
    const int parameter = int(result) - int(MissionResult::invalid_param1) + 1;
    return "refused an item for the value of its parameter " + std::to_string(parameter);
  }
  switch (result) {
    case MissionResult::unsupported_frame:
      return "does not support the altitude reference of an item: try another --altitude";
    case MissionResult::unsupported:
      return "does not support this item, or no " + name(type) + " at all";
    case MissionResult::no_space:
      return "has no space for so many items: drop waypoints with --max-items";
    case MissionResult::invalid:
      return "refused an item with an invalid value";
    case MissionResult::denied:
      return "accepts no " + name(type) +
             " now: another ground station may be transferring one, or it does not accept one in "
             "flight";
    case MissionResult::cancelled:
      return "cancelled the transfer";
    case MissionResult::invalid_sequence:
      return "received items out of order";
    default:
      break;
  }
  return "ended the transfer with an error that it does not describe (MAV_MISSION_RESULT " +
         std::to_string(int(result)) + ")";
}
}  // namespace altiplan::link
