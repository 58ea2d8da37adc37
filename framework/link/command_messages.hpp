// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "link/declared.hpp"

/// \file Messages of MAVLink's common.xml: commands, set-points, parameters, terrain and time.
namespace altiplan::link {

struct Ping {
  std::uint64_t time_usec = 0;  ///< us
  std::uint32_t seq = 0;
  std::uint8_t target_system = 0, target_component = 0;
  ALTIPLAN_MESSAGE(4, "PING", time_usec, seq, target_system, target_component);
};

struct SetMode {
  std::uint8_t target_system = 0, base_mode = 0;
  std::uint32_t custom_mode = 0;
  ALTIPLAN_MESSAGE(11, "SET_MODE", target_system, base_mode, custom_mode);
};

struct ParamRequestRead {
  std::uint8_t target_system = 0, target_component = 0;
  std::array<char, 16> param_id{};
  std::int16_t param_index = 0;
  ALTIPLAN_MESSAGE(20, "PARAM_REQUEST_READ", target_system, target_component, param_id,
                   param_index);
};

struct ParamRequestList {
  std::uint8_t target_system = 0, target_component = 0;
  ALTIPLAN_MESSAGE(21, "PARAM_REQUEST_LIST", target_system, target_component);
};

struct ParamValue {
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;
  std::uint16_t param_count = 0, param_index = 0;
  ALTIPLAN_MESSAGE(22, "PARAM_VALUE", param_id, param_value, param_type, param_count, param_index);
};

struct ParamSet {
  std::uint8_t target_system = 0, target_component = 0;
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;
  ALTIPLAN_MESSAGE(23, "PARAM_SET", target_system, target_component, param_id, param_value,
                   param_type);
};

struct CommandInt {
  std::uint8_t target_system = 0, target_component = 0, frame = 0;
  std::uint16_t command = 0;
  std::uint8_t current = 0, autocontinue = 0;
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0;
  std::int32_t x = 0, y = 0;
  float z = 0;
  ALTIPLAN_MESSAGE(75, "COMMAND_INT", target_system, target_component, frame, command, current,
                   autocontinue, param1, param2, param3, param4, x, y, z);
};

struct CommandLong {
  std::uint8_t target_system = 0, target_component = 0;
  std::uint16_t command = 0;
  std::uint8_t confirmation = 0;
  float param1 = 0, param2 = 0, param3 = 0, param4 = 0, param5 = 0, param6 = 0, param7 = 0;
  ALTIPLAN_MESSAGE(76, "COMMAND_LONG", target_system, target_component, command, confirmation,
                   param1, param2, param3, param4, param5, param6, param7);
};

struct CommandAck {
  std::uint16_t command = 0;
  std::uint8_t result = 0;
  std::uint8_t progress = 0;  ///< %
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0, target_component = 0;
  ALTIPLAN_MESSAGE(77, "COMMAND_ACK", command, result, kExtensions, progress, result_param2,
                   target_system, target_component);
};

struct SetPositionTargetLocalNed {
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::uint8_t target_system = 0, target_component = 0, coordinate_frame = 0;
  std::uint16_t type_mask = 0;
  float x = 0, y = 0, z = 0;        ///< m
  float vx = 0, vy = 0, vz = 0;     ///< m/s
  float afx = 0, afy = 0, afz = 0;  ///< m/s^2
  float yaw = 0;                    ///< rad
  float yaw_rate = 0;               ///< rad/s
  ALTIPLAN_MESSAGE(84, "SET_POSITION_TARGET_LOCAL_NED", time_boot_ms, target_system,
                   target_component, coordinate_frame, type_mask, x, y, z, vx, vy, vz, afx, afy,
                   afz, yaw, yaw_rate);
};

struct SetPositionTargetGlobalInt {
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::uint8_t target_system = 0, target_component = 0, coordinate_frame = 0;
  std::uint16_t type_mask = 0;
  std::int32_t lat_int = 0, lon_int = 0;  ///< 1e-7 degrees
  float alt = 0;                          ///< m
  float vx = 0, vy = 0, vz = 0;           ///< m/s
  float afx = 0, afy = 0, afz = 0;        ///< m/s^2
  float yaw = 0;                          ///< rad
  float yaw_rate = 0;                     ///< rad/s
  ALTIPLAN_MESSAGE(86, "SET_POSITION_TARGET_GLOBAL_INT", time_boot_ms, target_system,
                   target_component, coordinate_frame, type_mask, lat_int, lon_int, alt, vx, vy, vz,
                   afx, afy, afz, yaw, yaw_rate);
};

struct Timesync {
  std::int64_t tc1 = 0, ts1 = 0;  ///< ns
  std::uint8_t target_system = 0, target_component = 0;
  ALTIPLAN_MESSAGE(111, "TIMESYNC", tc1, ts1, kExtensions, target_system, target_component);
};

struct TerrainRequest {
  std::int32_t lat = 0, lon = 0;   ///< 1e-7 degrees
  std::uint16_t grid_spacing = 0;  ///< m
  std::uint64_t mask = 0;
  ALTIPLAN_MESSAGE(133, "TERRAIN_REQUEST", lat, lon, grid_spacing, mask);
};

struct TerrainData {
  std::int32_t lat = 0, lon = 0;   ///< 1e-7 degrees
  std::uint16_t grid_spacing = 0;  ///< m
  std::uint8_t gridbit = 0;
  std::array<std::int16_t, 16> data{};  ///< m
  ALTIPLAN_MESSAGE(134, "TERRAIN_DATA", lat, lon, grid_spacing, gridbit, data);
};

struct TerrainCheck {
  std::int32_t lat = 0, lon = 0;  ///< 1e-7 degrees
  ALTIPLAN_MESSAGE(135, "TERRAIN_CHECK", lat, lon);
};

struct TerrainReport {
  std::int32_t lat = 0, lon = 0;  ///< 1e-7 degrees
  std::uint16_t spacing = 0;
  float terrain_height = 0, current_height = 0;  ///< m
  std::uint16_t pending = 0, loaded = 0;
  ALTIPLAN_MESSAGE(136, "TERRAIN_REPORT", lat, lon, spacing, terrain_height, current_height,
                   pending, loaded);
};
}  // namespace altiplan::link
