// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "link/declared.hpp"

/// \file Messages of MAVLink's common.xml and of ardupilotmega.xml (Wind): what a vehicle reports
/// of itself.
namespace altiplan::link {

struct Heartbeat {
  std::uint8_t type = 0, autopilot = 0, base_mode = 0;
  std::uint32_t custom_mode = 0;
  std::uint8_t system_status = 0, mavlink_version = 0;
  ALTIPLAN_MESSAGE(0, "HEARTBEAT", type, autopilot, base_mode, custom_mode, system_status,
                   mavlink_version);
};

struct SysStatus {
  std::uint32_t onboard_control_sensors_present = 0, onboard_control_sensors_enabled = 0;
  std::uint32_t onboard_control_sensors_health = 0;
  std::uint16_t load = 0;             ///< 0.1 %
  std::uint16_t voltage_battery = 0;  ///< mV
  std::int16_t current_battery = 0;   ///< 0.01 A
  std::int8_t battery_remaining = 0;  ///< %
  std::uint16_t drop_rate_comm = 0;   ///< 0.01 %
  std::uint16_t errors_comm = 0, errors_count1 = 0, errors_count2 = 0, errors_count3 = 0,
                errors_count4 = 0;
  std::uint32_t onboard_control_sensors_present_extended = 0,
                onboard_control_sensors_enabled_extended = 0;
  std::uint32_t onboard_control_sensors_health_extended = 0;
  ALTIPLAN_MESSAGE(1, "SYS_STATUS", onboard_control_sensors_present,
                   onboard_control_sensors_enabled, onboard_control_sensors_health, load,
                   voltage_battery, current_battery, battery_remaining, drop_rate_comm, errors_comm,
                   errors_count1, errors_count2, errors_count3, errors_count4, kExtensions,
                   onboard_control_sensors_present_extended,
                   onboard_control_sensors_enabled_extended,
                   onboard_control_sensors_health_extended);
};

struct SystemTime {
  std::uint64_t time_unix_usec = 0;  ///< us
  std::uint32_t time_boot_ms = 0;    ///< ms
  ALTIPLAN_MESSAGE(2, "SYSTEM_TIME", time_unix_usec, time_boot_ms);
};

struct GpsRawInt {
  std::uint64_t time_usec = 0;  ///< us
  std::uint8_t fix_type = 0;
  std::int32_t lat = 0, lon = 0;  ///< 1e-7 degrees
  std::int32_t alt = 0;           ///< mm
  std::uint16_t eph = 0, epv = 0;
  std::uint16_t vel = 0;  ///< cm/s
  std::uint16_t cog = 0;  ///< 0.01 degrees
  std::uint8_t satellites_visible = 0;
  std::int32_t alt_ellipsoid = 0;      ///< mm
  std::uint32_t h_acc = 0, v_acc = 0;  ///< mm
  std::uint32_t vel_acc = 0;           ///< mm/s
  std::uint32_t hdg_acc = 0;           ///< 1e-5 degrees
  std::uint16_t yaw = 0;               ///< 0.01 degrees
  ALTIPLAN_MESSAGE(24, "GPS_RAW_INT", time_usec, fix_type, lat, lon, alt, eph, epv, vel, cog,
                   satellites_visible, kExtensions, alt_ellipsoid, h_acc, v_acc, vel_acc, hdg_acc,
                   yaw);
};

struct Attitude {
  std::uint32_t time_boot_ms = 0;                     ///< ms
  float roll = 0, pitch = 0, yaw = 0;                 ///< rad
  float rollspeed = 0, pitchspeed = 0, yawspeed = 0;  ///< rad/s
  ALTIPLAN_MESSAGE(30, "ATTITUDE", time_boot_ms, roll, pitch, yaw, rollspeed, pitchspeed, yawspeed);
};

struct LocalPositionNed {
  std::uint32_t time_boot_ms = 0;  ///< ms
  float x = 0, y = 0, z = 0;       ///< m
  float vx = 0, vy = 0, vz = 0;    ///< m/s
  ALTIPLAN_MESSAGE(32, "LOCAL_POSITION_NED", time_boot_ms, x, y, z, vx, vy, vz);
};

struct GlobalPositionInt {
  std::uint32_t time_boot_ms = 0;          ///< ms
  std::int32_t lat = 0, lon = 0;           ///< 1e-7 degrees
  std::int32_t alt = 0, relative_alt = 0;  ///< mm
  std::int16_t vx = 0, vy = 0, vz = 0;     ///< cm/s
  std::uint16_t hdg = 0;                   ///< 0.01 degrees
  ALTIPLAN_MESSAGE(33, "GLOBAL_POSITION_INT", time_boot_ms, lat, lon, alt, relative_alt, vx, vy, vz,
                   hdg);
};

struct VfrHud {
  float airspeed = 0, groundspeed = 0;  ///< m/s
  std::int16_t heading = 0;             ///< degrees
  std::uint16_t throttle = 0;           ///< %
  float alt = 0;                        ///< m
  float climb = 0;                      ///< m/s
  ALTIPLAN_MESSAGE(74, "VFR_HUD", airspeed, groundspeed, heading, throttle, alt, climb);
};

struct Wind {
  float direction = 0;           ///< degrees
  float speed = 0, speed_z = 0;  ///< m/s
  ALTIPLAN_MESSAGE(168, "WIND", direction, speed, speed_z);
};

struct WindCov {
  std::uint64_t time_usec = 0;                                            ///< us
  float wind_x = 0, wind_y = 0, wind_z = 0, var_horiz = 0, var_vert = 0;  ///< m/s
  float wind_alt = 0;                                                     ///< m
  float horiz_accuracy = 0, vert_accuracy = 0;                            ///< m/s
  ALTIPLAN_MESSAGE(231, "WIND_COV", time_usec, wind_x, wind_y, wind_z, var_horiz, var_vert,
                   wind_alt, horiz_accuracy, vert_accuracy);
};

struct HomePosition {
  std::int32_t latitude = 0, longitude = 0;  ///< 1e-7 degrees
  std::int32_t altitude = 0;                 ///< mm
  float x = 0, y = 0, z = 0;                 ///< m
  std::array<float, 4> q{};
  float approach_x = 0, approach_y = 0, approach_z = 0;  ///< m
  std::uint64_t time_usec = 0;                           ///< us
  ALTIPLAN_MESSAGE(242, "HOME_POSITION", latitude, longitude, altitude, x, y, z, q, approach_x,
                   approach_y, approach_z, kExtensions, time_usec);
};

struct ExtendedSysState {
  std::uint8_t vtol_state = 0, landed_state = 0;
  ALTIPLAN_MESSAGE(245, "EXTENDED_SYS_STATE", vtol_state, landed_state);
};

struct Statustext {
  std::uint8_t severity = 0;
  std::array<char, 50> text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;
  ALTIPLAN_MESSAGE(253, "STATUSTEXT", severity, text, kExtensions, id, chunk_seq);
};

struct AutopilotVersion {
  std::uint64_t capabilities = 0;
  std::uint32_t flight_sw_version = 0, middleware_sw_version = 0, os_sw_version = 0,
                board_version = 0;
  std::array<std::uint8_t, 8> flight_custom_version{};
  std::array<std::uint8_t, 8> middleware_custom_version{};
  std::array<std::uint8_t, 8> os_custom_version{};
  std::uint16_t vendor_id = 0, product_id = 0;
  std::uint64_t uid = 0;
  std::array<std::uint8_t, 18> uid2{};
  ALTIPLAN_MESSAGE(148, "AUTOPILOT_VERSION", capabilities, flight_sw_version, middleware_sw_version,
                   os_sw_version, board_version, flight_custom_version, middleware_custom_version,
                   os_custom_version, vendor_id, product_id, uid, kExtensions, uid2);
};
}  // namespace altiplan::link
