// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "link/link.hpp"

namespace altiplan::link {

/// The modes that a flight needs. `mission`: the autopilot flies its mission (AUTO); `commanded`:
/// it flies to set-points (GUIDED, OFFBOARD); `hold`: it stays where it is.
enum class FlightMode { mission, commanded, hold, other };

/// The mode that a heartbeat reports.
FlightMode mode_of(const Heartbeat& heartbeat);
/// MAV_CMD_DO_SET_MODE by the autopilot's numbers; not for `other`.
CommandLong mode_command(const Vehicle& vehicle, FlightMode mode);

/// Numbers of MAV_CMD.
struct VehicleCommand {
  static constexpr std::uint16_t kSetMode = 176;
  static constexpr std::uint16_t kChangeSpeed = 178;
  static constexpr std::uint16_t kReposition = 192;
  static constexpr std::uint16_t kStartMission = 300;
  static constexpr std::uint16_t kArm = 400;
  static constexpr std::uint16_t kSetMessageInterval = 511;
};
/// The number of a mission's first item: to ArduPilot item 0 is home.
int first_item(const Vehicle& vehicle);
MissionSetCurrent set_current(const Vehicle& vehicle, int item);
CommandLong command_to(const Vehicle& vehicle, std::uint16_t command, float param1 = 0,
                       float param2 = 0, float param3 = 0);
}  // namespace altiplan::link
