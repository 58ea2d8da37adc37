// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "link/declared.hpp"

/// \file Messages of MAVLink's common.xml: the mission protocol.
namespace altiplan::link {

struct MissionWritePartialList {
  static constexpr Declared kDeclared{38, "MISSION_WRITE_PARTIAL_LIST"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::int16_t start_index = 0;
  std::int16_t end_index = 0;
  std::uint8_t mission_type = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("start_index", start_index);
    f("end_index", end_index);
    f.extensions();
    f("mission_type", mission_type);
  }
};

struct MissionRequest {
  static constexpr Declared kDeclared{40, "MISSION_REQUEST"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t mission_type = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("seq", seq);
    f.extensions();
    f("mission_type", mission_type);
  }
};

struct MissionSetCurrent {
  static constexpr Declared kDeclared{41, "MISSION_SET_CURRENT"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("seq", seq);
  }
};

struct MissionCurrent {
  static constexpr Declared kDeclared{42, "MISSION_CURRENT"};
  std::uint16_t seq = 0;
  std::uint16_t total = 0;
  std::uint8_t mission_state = 0;
  std::uint8_t mission_mode = 0;
  std::uint32_t mission_id = 0;
  std::uint32_t fence_id = 0;
  std::uint32_t rally_points_id = 0;

  void describe(auto& f) {
    f("seq", seq);
    f.extensions();
    f("total", total);
    f("mission_state", mission_state);
    f("mission_mode", mission_mode);
    f("mission_id", mission_id);
    f("fence_id", fence_id);
    f("rally_points_id", rally_points_id);
  }
};

struct MissionRequestList {
  static constexpr Declared kDeclared{43, "MISSION_REQUEST_LIST"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t mission_type = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f.extensions();
    f("mission_type", mission_type);
  }
};

struct MissionCount {
  static constexpr Declared kDeclared{44, "MISSION_COUNT"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t count = 0;
  std::uint8_t mission_type = 0;
  std::uint32_t opaque_id = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("count", count);
    f.extensions();
    f("mission_type", mission_type);
    f("opaque_id", opaque_id);
  }
};

struct MissionClearAll {
  static constexpr Declared kDeclared{45, "MISSION_CLEAR_ALL"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t mission_type = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f.extensions();
    f("mission_type", mission_type);
  }
};

struct MissionItemReached {
  static constexpr Declared kDeclared{46, "MISSION_ITEM_REACHED"};
  std::uint16_t seq = 0;

  void describe(auto& f) { f("seq", seq); }
};

struct MissionAck {
  static constexpr Declared kDeclared{47, "MISSION_ACK"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t type = 0;
  std::uint8_t mission_type = 0;
  std::uint32_t opaque_id = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("type", type);
    f.extensions();
    f("mission_type", mission_type);
    f("opaque_id", opaque_id);
  }
};

struct MissionRequestInt {
  static constexpr Declared kDeclared{51, "MISSION_REQUEST_INT"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t mission_type = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("seq", seq);
    f.extensions();
    f("mission_type", mission_type);
  }
};

struct MissionItemInt {
  static constexpr Declared kDeclared{73, "MISSION_ITEM_INT"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t seq = 0;
  std::uint8_t frame = 0;
  std::uint16_t command = 0;
  std::uint8_t current = 0;
  std::uint8_t autocontinue = 0;
  float param1 = 0;
  float param2 = 0;
  float param3 = 0;
  float param4 = 0;
  std::int32_t x = 0;
  std::int32_t y = 0;
  float z = 0;
  std::uint8_t mission_type = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("seq", seq);
    f("frame", frame);
    f("command", command);
    f("current", current);
    f("autocontinue", autocontinue);
    f("param1", param1);
    f("param2", param2);
    f("param3", param3);
    f("param4", param4);
    f("x", x);
    f("y", y);
    f("z", z);
    f.extensions();
    f("mission_type", mission_type);
  }
};
}  // namespace altiplan::link
