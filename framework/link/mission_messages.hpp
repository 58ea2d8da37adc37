// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "link/declared.hpp"

/// \file Messages of MAVLink's common.xml: the mission protocol.
namespace altiplan::link {

struct MissionWritePartialList {
  std::uint8_t target_system = 0, target_component = 0;
  std::int16_t start_index = 0, end_index = 0;
  std::uint8_t mission_type = 0;
  ALTIPLAN_MESSAGE(38, "MISSION_WRITE_PARTIAL_LIST", target_system, target_component, start_index,
                   end_index, kExtensions, mission_type);
};

struct MissionRequest {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t mission_type = 0;
  ALTIPLAN_MESSAGE(40, "MISSION_REQUEST", target_system, target_component, seq, kExtensions,
                   mission_type);
};

struct MissionSetCurrent {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint16_t seq = 0;
  ALTIPLAN_MESSAGE(41, "MISSION_SET_CURRENT", target_system, target_component, seq);
};

struct MissionCurrent {
  std::uint16_t seq = 0;
  std::uint16_t total = 0;
  std::uint8_t mission_state = 0, mission_mode = 0;
  std::uint32_t mission_id = 0, fence_id = 0, rally_points_id = 0;
  ALTIPLAN_MESSAGE(42, "MISSION_CURRENT", seq, kExtensions, total, mission_state, mission_mode,
                   mission_id, fence_id, rally_points_id);
};

struct MissionRequestList {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint8_t mission_type = 0;
  ALTIPLAN_MESSAGE(43, "MISSION_REQUEST_LIST", target_system, target_component, kExtensions,
                   mission_type);
};

struct MissionCount {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint16_t count = 0;
  std::uint8_t mission_type = 0;
  std::uint32_t opaque_id = 0;
  ALTIPLAN_MESSAGE(44, "MISSION_COUNT", target_system, target_component, count, kExtensions,
                   mission_type, opaque_id);
};

struct MissionClearAll {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint8_t mission_type = 0;
  ALTIPLAN_MESSAGE(45, "MISSION_CLEAR_ALL", target_system, target_component, kExtensions,
                   mission_type);
};

struct MissionItemReached {
  std::uint16_t seq = 0;
  ALTIPLAN_MESSAGE(46, "MISSION_ITEM_REACHED", seq);
};

struct MissionAck {
  std::uint8_t target_system = 0, target_component = 0, type = 0;
  std::uint8_t mission_type = 0;
  std::uint32_t opaque_id = 0;
  ALTIPLAN_MESSAGE(47, "MISSION_ACK", target_system, target_component, type, kExtensions,
                   mission_type, opaque_id);
};

struct MissionRequestInt {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t mission_type = 0;
  ALTIPLAN_MESSAGE(51, "MISSION_REQUEST_INT", target_system, target_component, seq, kExtensions,
                   mission_type);
};

struct MissionItemInt {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t frame = 0;
  std::uint16_t command = 0;
  std::uint8_t current = 0, autocontinue = 0;
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0;
  std::int32_t x = 0, y = 0;
  float z = 0;
  std::uint8_t mission_type = 0;
  ALTIPLAN_MESSAGE(73, "MISSION_ITEM_INT", target_system, target_component, seq, frame, command,
                   current, autocontinue, param1, param2, param3, param4, x, y, z, kExtensions,
                   mission_type);
};
}  // namespace altiplan::link
