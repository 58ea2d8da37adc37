// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "link/declared.hpp"

/// \file Messages of MAVLink's common.xml and of ardupilotmega.xml (Wind): what a vehicle reports
/// of itself.
namespace altiplan::link {

struct Heartbeat {
  static constexpr Declared kDeclared{0, "HEARTBEAT"};
  std::uint8_t type = 0;
  std::uint8_t autopilot = 0;
  std::uint8_t base_mode = 0;
  std::uint32_t custom_mode = 0;
  std::uint8_t system_status = 0;
  std::uint8_t mavlink_version = 0;

  void describe(auto& f) {
    f("type", type);
    f("autopilot", autopilot);
    f("base_mode", base_mode);
    f("custom_mode", custom_mode);
    f("system_status", system_status);
    f("mavlink_version", mavlink_version);
  }
};

struct SysStatus {
  static constexpr Declared kDeclared{1, "SYS_STATUS"};
  std::uint32_t onboard_control_sensors_present = 0;
  std::uint32_t onboard_control_sensors_enabled = 0;
  std::uint32_t onboard_control_sensors_health = 0;
  std::uint16_t load = 0;             ///< 0.1 %
  std::uint16_t voltage_battery = 0;  ///< mV
  std::int16_t current_battery = 0;   ///< 0.01 A
  std::int8_t battery_remaining = 0;  ///< %
  std::uint16_t drop_rate_comm = 0;   ///< 0.01 %
  std::uint16_t errors_comm = 0;
  std::uint16_t errors_count1 = 0;
  std::uint16_t errors_count2 = 0;
  std::uint16_t errors_count3 = 0;
  std::uint16_t errors_count4 = 0;
  std::uint32_t onboard_control_sensors_present_extended = 0;
  std::uint32_t onboard_control_sensors_enabled_extended = 0;
  std::uint32_t onboard_control_sensors_health_extended = 0;

  void describe(auto& f) {
    f("onboard_control_sensors_present", onboard_control_sensors_present);
    f("onboard_control_sensors_enabled", onboard_control_sensors_enabled);
    f("onboard_control_sensors_health", onboard_control_sensors_health);
    f("load", load);
    f("voltage_battery", voltage_battery);
    f("current_battery", current_battery);
    f("battery_remaining", battery_remaining);
    f("drop_rate_comm", drop_rate_comm);
    f("errors_comm", errors_comm);
    f("errors_count1", errors_count1);
    f("errors_count2", errors_count2);
    f("errors_count3", errors_count3);
    f("errors_count4", errors_count4);
    f.extensions();
    f("onboard_control_sensors_present_extended", onboard_control_sensors_present_extended);
    f("onboard_control_sensors_enabled_extended", onboard_control_sensors_enabled_extended);
    f("onboard_control_sensors_health_extended", onboard_control_sensors_health_extended);
  }
};

struct SystemTime {
  static constexpr Declared kDeclared{2, "SYSTEM_TIME"};
  std::uint64_t time_unix_usec = 0;  ///< us
  std::uint32_t time_boot_ms = 0;    ///< ms

  void describe(auto& f) {
    f("time_unix_usec", time_unix_usec);
    f("time_boot_ms", time_boot_ms);
  }
};

struct GpsRawInt {
  static constexpr Declared kDeclared{24, "GPS_RAW_INT"};
  std::uint64_t time_usec = 0;  ///< us
  std::uint8_t fix_type = 0;
  std::int32_t lat = 0;  ///< 1e-7 degrees
  std::int32_t lon = 0;  ///< 1e-7 degrees
  std::int32_t alt = 0;  ///< mm
  std::uint16_t eph = 0;
  std::uint16_t epv = 0;
  std::uint16_t vel = 0;  ///< cm/s
  std::uint16_t cog = 0;  ///< 0.01 degrees
  std::uint8_t satellites_visible = 0;
  std::int32_t alt_ellipsoid = 0;  ///< mm
  std::uint32_t h_acc = 0;         ///< mm
  std::uint32_t v_acc = 0;         ///< mm
  std::uint32_t vel_acc = 0;       ///< mm/s
  std::uint32_t hdg_acc = 0;       ///< 1e-5 degrees
  std::uint16_t yaw = 0;           ///< 0.01 degrees

  void describe(auto& f) {
    f("time_usec", time_usec);
    f("fix_type", fix_type);
    f("lat", lat);
    f("lon", lon);
    f("alt", alt);
    f("eph", eph);
    f("epv", epv);
    f("vel", vel);
    f("cog", cog);
    f("satellites_visible", satellites_visible);
    f.extensions();
    f("alt_ellipsoid", alt_ellipsoid);
    f("h_acc", h_acc);
    f("v_acc", v_acc);
    f("vel_acc", vel_acc);
    f("hdg_acc", hdg_acc);
    f("yaw", yaw);
  }
};

struct Attitude {
  static constexpr Declared kDeclared{30, "ATTITUDE"};
  std::uint32_t time_boot_ms = 0;  ///< ms
  float roll = 0;                  ///< rad
  float pitch = 0;                 ///< rad
  float yaw = 0;                   ///< rad
  float rollspeed = 0;             ///< rad/s
  float pitchspeed = 0;            ///< rad/s
  float yawspeed = 0;              ///< rad/s

  void describe(auto& f) {
    f("time_boot_ms", time_boot_ms);
    f("roll", roll);
    f("pitch", pitch);
    f("yaw", yaw);
    f("rollspeed", rollspeed);
    f("pitchspeed", pitchspeed);
    f("yawspeed", yawspeed);
  }
};

struct LocalPositionNed {
  static constexpr Declared kDeclared{32, "LOCAL_POSITION_NED"};
  std::uint32_t time_boot_ms = 0;  ///< ms
  float x = 0;                     ///< m
  float y = 0;                     ///< m
  float z = 0;                     ///< m
  float vx = 0;                    ///< m/s
  float vy = 0;                    ///< m/s
  float vz = 0;                    ///< m/s

  void describe(auto& f) {
    f("time_boot_ms", time_boot_ms);
    f("x", x);
    f("y", y);
    f("z", z);
    f("vx", vx);
    f("vy", vy);
    f("vz", vz);
  }
};

struct GlobalPositionInt {
  static constexpr Declared kDeclared{33, "GLOBAL_POSITION_INT"};
  std::uint32_t time_boot_ms = 0;  ///< ms
  std::int32_t lat = 0;            ///< 1e-7 degrees
  std::int32_t lon = 0;            ///< 1e-7 degrees
  std::int32_t alt = 0;            ///< mm
  std::int32_t relative_alt = 0;   ///< mm
  std::int16_t vx = 0;             ///< cm/s
  std::int16_t vy = 0;             ///< cm/s
  std::int16_t vz = 0;             ///< cm/s
  std::uint16_t hdg = 0;           ///< 0.01 degrees

  void describe(auto& f) {
    f("time_boot_ms", time_boot_ms);
    f("lat", lat);
    f("lon", lon);
    f("alt", alt);
    f("relative_alt", relative_alt);
    f("vx", vx);
    f("vy", vy);
    f("vz", vz);
    f("hdg", hdg);
  }
};

struct VfrHud {
  static constexpr Declared kDeclared{74, "VFR_HUD"};
  float airspeed = 0;          ///< m/s
  float groundspeed = 0;       ///< m/s
  std::int16_t heading = 0;    ///< degrees
  std::uint16_t throttle = 0;  ///< %
  float alt = 0;               ///< m
  float climb = 0;             ///< m/s

  void describe(auto& f) {
    f("airspeed", airspeed);
    f("groundspeed", groundspeed);
    f("heading", heading);
    f("throttle", throttle);
    f("alt", alt);
    f("climb", climb);
  }
};

struct Wind {
  static constexpr Declared kDeclared{168, "WIND"};
  float direction = 0;  ///< degrees
  float speed = 0;      ///< m/s
  float speed_z = 0;    ///< m/s

  void describe(auto& f) {
    f("direction", direction);
    f("speed", speed);
    f("speed_z", speed_z);
  }
};

struct WindCov {
  static constexpr Declared kDeclared{231, "WIND_COV"};
  std::uint64_t time_usec = 0;  ///< us
  float wind_x = 0;             ///< m/s
  float wind_y = 0;             ///< m/s
  float wind_z = 0;             ///< m/s
  float var_horiz = 0;          ///< m/s
  float var_vert = 0;           ///< m/s
  float wind_alt = 0;           ///< m
  float horiz_accuracy = 0;     ///< m/s
  float vert_accuracy = 0;      ///< m/s

  void describe(auto& f) {
    f("time_usec", time_usec);
    f("wind_x", wind_x);
    f("wind_y", wind_y);
    f("wind_z", wind_z);
    f("var_horiz", var_horiz);
    f("var_vert", var_vert);
    f("wind_alt", wind_alt);
    f("horiz_accuracy", horiz_accuracy);
    f("vert_accuracy", vert_accuracy);
  }
};

struct HomePosition {
  static constexpr Declared kDeclared{242, "HOME_POSITION"};
  std::int32_t latitude = 0;   ///< 1e-7 degrees
  std::int32_t longitude = 0;  ///< 1e-7 degrees
  std::int32_t altitude = 0;   ///< mm
  float x = 0;                 ///< m
  float y = 0;                 ///< m
  float z = 0;                 ///< m
  std::array<float, 4> q{};
  float approach_x = 0;         ///< m
  float approach_y = 0;         ///< m
  float approach_z = 0;         ///< m
  std::uint64_t time_usec = 0;  ///< us

  void describe(auto& f) {
    f("latitude", latitude);
    f("longitude", longitude);
    f("altitude", altitude);
    f("x", x);
    f("y", y);
    f("z", z);
    f("q", q);
    f("approach_x", approach_x);
    f("approach_y", approach_y);
    f("approach_z", approach_z);
    f.extensions();
    f("time_usec", time_usec);
  }
};

struct ExtendedSysState {
  static constexpr Declared kDeclared{245, "EXTENDED_SYS_STATE"};
  std::uint8_t vtol_state = 0;
  std::uint8_t landed_state = 0;

  void describe(auto& f) {
    f("vtol_state", vtol_state);
    f("landed_state", landed_state);
  }
};

struct Statustext {
  static constexpr Declared kDeclared{253, "STATUSTEXT"};
  std::uint8_t severity = 0;
  std::array<char, 50> text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;

  void describe(auto& f) {
    f("severity", severity);
    f("text", text);
    f.extensions();
    f("id", id);
    f("chunk_seq", chunk_seq);
  }
};

struct AutopilotVersion {
  static constexpr Declared kDeclared{148, "AUTOPILOT_VERSION"};
  std::uint64_t capabilities = 0;
  std::uint32_t flight_sw_version = 0;
  std::uint32_t middleware_sw_version = 0;
  std::uint32_t os_sw_version = 0;
  std::uint32_t board_version = 0;
  std::array<std::uint8_t, 8> flight_custom_version{};
  std::array<std::uint8_t, 8> middleware_custom_version{};
  std::array<std::uint8_t, 8> os_custom_version{};
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint64_t uid = 0;
  std::array<std::uint8_t, 18> uid2{};

  void describe(auto& f) {
    f("capabilities", capabilities);
    f("flight_sw_version", flight_sw_version);
    f("middleware_sw_version", middleware_sw_version);
    f("os_sw_version", os_sw_version);
    f("board_version", board_version);
    f("flight_custom_version", flight_custom_version);
    f("middleware_custom_version", middleware_custom_version);
    f("os_custom_version", os_custom_version);
    f("vendor_id", vendor_id);
    f("product_id", product_id);
    f("uid", uid);
    f.extensions();
    f("uid2", uid2);
  }
};
}  // namespace altiplan::link
