// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "link/declared.hpp"

/// \file Messages of MAVLink's common.xml: commands, set-points, parameters, terrain and time.
namespace altiplan::link {

struct Ping {
  static constexpr Declared kDeclared{4, "PING"};
  std::uint64_t time_usec = 0;  ///< us
  std::uint32_t seq = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  void describe(auto& f) {
    f("time_usec", time_usec);
    f("seq", seq);
    f("target_system", target_system);
    f("target_component", target_component);
  }
};

struct SetMode {
  static constexpr Declared kDeclared{11, "SET_MODE"};
  std::uint8_t target_system = 0;
  std::uint8_t base_mode = 0;
  std::uint32_t custom_mode = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("base_mode", base_mode);
    f("custom_mode", custom_mode);
  }
};

struct ParamRequestRead {
  static constexpr Declared kDeclared{20, "PARAM_REQUEST_READ"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  std::int16_t param_index = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("param_id", param_id);
    f("param_index", param_index);
  }
};

struct ParamRequestList {
  static constexpr Declared kDeclared{21, "PARAM_REQUEST_LIST"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
  }
};

struct ParamValue {
  static constexpr Declared kDeclared{22, "PARAM_VALUE"};
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;
  std::uint16_t param_count = 0;
  std::uint16_t param_index = 0;

  void describe(auto& f) {
    f("param_id", param_id);
    f("param_value", param_value);
    f("param_type", param_type);
    f("param_count", param_count);
    f("param_index", param_index);
  }
};

struct ParamSet {
  static constexpr Declared kDeclared{23, "PARAM_SET"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("param_id", param_id);
    f("param_value", param_value);
    f("param_type", param_type);
  }
};

struct CommandInt {
  static constexpr Declared kDeclared{75, "COMMAND_INT"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
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

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
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
  }
};

struct CommandLong {
  static constexpr Declared kDeclared{76, "COMMAND_LONG"};
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t command = 0;
  std::uint8_t confirmation = 0;
  float param1 = 0;
  float param2 = 0;
  float param3 = 0;
  float param4 = 0;
  float param5 = 0;
  float param6 = 0;
  float param7 = 0;

  void describe(auto& f) {
    f("target_system", target_system);
    f("target_component", target_component);
    f("command", command);
    f("confirmation", confirmation);
    f("param1", param1);
    f("param2", param2);
    f("param3", param3);
    f("param4", param4);
    f("param5", param5);
    f("param6", param6);
    f("param7", param7);
  }
};

struct CommandAck {
  static constexpr Declared kDeclared{77, "COMMAND_ACK"};
  std::uint16_t command = 0;
  std::uint8_t result = 0;
  std::uint8_t progress = 0;  ///< %
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  void describe(auto& f) {
    f("command", command);
    f("result", result);
    f.extensions();
    f("progress", progress);
    f("result_param2", result_param2);
    f("target_system", target_system);
    f("target_component", target_component);
  }
};

struct SetPositionTargetLocalNed {
  static constexpr Declared kDeclared{84, "SET_POSITION_TARGET_LOCAL_NED"};
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t coordinate_frame = 0;
  std::uint16_t type_mask = 0;
  float x = 0;         ///< m
  float y = 0;         ///< m
  float z = 0;         ///< m
  float vx = 0;        ///< m/s
  float vy = 0;        ///< m/s
  float vz = 0;        ///< m/s
  float afx = 0;       ///< m/s^2
  float afy = 0;       ///< m/s^2
  float afz = 0;       ///< m/s^2
  float yaw = 0;       ///< rad
  float yaw_rate = 0;  ///< rad/s

  void describe(auto& f) {
    f("time_boot_ms", time_boot_ms);
    f("target_system", target_system);
    f("target_component", target_component);
    f("coordinate_frame", coordinate_frame);
    f("type_mask", type_mask);
    f("x", x);
    f("y", y);
    f("z", z);
    f("vx", vx);
    f("vy", vy);
    f("vz", vz);
    f("afx", afx);
    f("afy", afy);
    f("afz", afz);
    f("yaw", yaw);
    f("yaw_rate", yaw_rate);
  }
};

struct SetPositionTargetGlobalInt {
  static constexpr Declared kDeclared{86, "SET_POSITION_TARGET_GLOBAL_INT"};
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t coordinate_frame = 0;
  std::uint16_t type_mask = 0;
  std::int32_t lat_int = 0;  ///< 1e-7 degrees
  std::int32_t lon_int = 0;  ///< 1e-7 degrees
  float alt = 0;             ///< m
  float vx = 0;              ///< m/s
  float vy = 0;              ///< m/s
  float vz = 0;              ///< m/s
  float afx = 0;             ///< m/s^2
  float afy = 0;             ///< m/s^2
  float afz = 0;             ///< m/s^2
  float yaw = 0;             ///< rad
  float yaw_rate = 0;        ///< rad/s

  void describe(auto& f) {
    f("time_boot_ms", time_boot_ms);
    f("target_system", target_system);
    f("target_component", target_component);
    f("coordinate_frame", coordinate_frame);
    f("type_mask", type_mask);
    f("lat_int", lat_int);
    f("lon_int", lon_int);
    f("alt", alt);
    f("vx", vx);
    f("vy", vy);
    f("vz", vz);
    f("afx", afx);
    f("afy", afy);
    f("afz", afz);
    f("yaw", yaw);
    f("yaw_rate", yaw_rate);
  }
};

struct Timesync {
  static constexpr Declared kDeclared{111, "TIMESYNC"};
  std::int64_t tc1 = 0;  ///< ns
  std::int64_t ts1 = 0;  ///< ns
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  void describe(auto& f) {
    f("tc1", tc1);
    f("ts1", ts1);
    f.extensions();
    f("target_system", target_system);
    f("target_component", target_component);
  }
};

struct TerrainRequest {
  static constexpr Declared kDeclared{133, "TERRAIN_REQUEST"};
  std::int32_t lat = 0;            ///< 1e-7 degrees
  std::int32_t lon = 0;            ///< 1e-7 degrees
  std::uint16_t grid_spacing = 0;  ///< m
  std::uint64_t mask = 0;

  void describe(auto& f) {
    f("lat", lat);
    f("lon", lon);
    f("grid_spacing", grid_spacing);
    f("mask", mask);
  }
};

struct TerrainData {
  static constexpr Declared kDeclared{134, "TERRAIN_DATA"};
  std::int32_t lat = 0;            ///< 1e-7 degrees
  std::int32_t lon = 0;            ///< 1e-7 degrees
  std::uint16_t grid_spacing = 0;  ///< m
  std::uint8_t gridbit = 0;
  std::array<std::int16_t, 16> data{};  ///< m

  void describe(auto& f) {
    f("lat", lat);
    f("lon", lon);
    f("grid_spacing", grid_spacing);
    f("gridbit", gridbit);
    f("data", data);
  }
};

struct TerrainCheck {
  static constexpr Declared kDeclared{135, "TERRAIN_CHECK"};
  std::int32_t lat = 0;  ///< 1e-7 degrees
  std::int32_t lon = 0;  ///< 1e-7 degrees

  void describe(auto& f) {
    f("lat", lat);
    f("lon", lon);
  }
};

struct TerrainReport {
  static constexpr Declared kDeclared{136, "TERRAIN_REPORT"};
  std::int32_t lat = 0;  ///< 1e-7 degrees
  std::int32_t lon = 0;  ///< 1e-7 degrees
  std::uint16_t spacing = 0;
  float terrain_height = 0;  ///< m
  float current_height = 0;  ///< m
  std::uint16_t pending = 0;
  std::uint16_t loaded = 0;

  void describe(auto& f) {
    f("lat", lat);
    f("lon", lon);
    f("spacing", spacing);
    f("terrain_height", terrain_height);
    f("current_height", current_height);
    f("pending", pending);
    f("loaded", loaded);
  }
};
}  // namespace altiplan::link
