// SPDX-License-Identifier: Apache-2.0
#include "link/flight_mode.hpp"

#include "link/vehicle_words.hpp"

namespace altiplan::link {
namespace {

// Of MAV_MODE_FLAG: what a generic autopilot has for modes.
constexpr std::uint8_t kCustomFlag = 1;
constexpr std::uint8_t kAutoFlag = 4;
constexpr std::uint8_t kGuidedFlag = 8;
constexpr std::uint8_t kStabilizeFlag = 16;

/// custom_mode of ArduPilot. The last is another mode that holds: a copter's LOITER lets sticks
/// move it, and sinks where there are none, so that BRAKE is set.
struct ArduPilotModes {
  unsigned mission;
  unsigned commanded;
  unsigned hold;
  unsigned also_hold;
};
constexpr ArduPilotModes kCopter{3, 4, 17, 5};
constexpr ArduPilotModes kPlane{10, 15, 12, 1};

/// Main mode and sub-mode of PX4.
struct Px4Mode {
  unsigned main;
  unsigned sub;
};
constexpr Px4Mode kPx4Mission{4, 4};
constexpr Px4Mode kPx4Commanded{6, 0};
constexpr Px4Mode kPx4Hold{4, 3};

const ArduPilotModes& modes_of(const Heartbeat& heartbeat) {
  return is_fixed_wing(heartbeat) ? kPlane : kCopter;
}

FlightMode ardupilot_mode(const Heartbeat& heartbeat) {
  const ArduPilotModes& modes = modes_of(heartbeat);
  const unsigned mode = heartbeat.custom_mode;
  return mode == modes.mission                           ? FlightMode::mission
         : mode == modes.commanded                       ? FlightMode::commanded
         : mode == modes.hold || mode == modes.also_hold ? FlightMode::hold
                                                         : FlightMode::other;
}

FlightMode px4_mode(const Heartbeat& heartbeat) {
  const unsigned main = heartbeat.custom_mode >> 16 & 0xff;
  const unsigned sub = heartbeat.custom_mode >> 24;
  const auto is = [&](const Px4Mode& mode) {
    return main == mode.main && (mode.sub == 0 || sub == mode.sub);
  };
  return is(kPx4Mission)     ? FlightMode::mission
         : is(kPx4Commanded) ? FlightMode::commanded
         : is(kPx4Hold)      ? FlightMode::hold
                             : FlightMode::other;
}

FlightMode generic_mode(const Heartbeat& heartbeat) {
  const std::uint8_t flags = heartbeat.base_mode;
  return (flags & kAutoFlag) != 0        ? FlightMode::mission
         : (flags & kGuidedFlag) != 0    ? FlightMode::commanded
         : (flags & kStabilizeFlag) != 0 ? FlightMode::hold
                                         : FlightMode::other;
}

std::uint8_t generic_flags(FlightMode mode) {
  switch (mode) {
    case FlightMode::mission:
      return kAutoFlag | kGuidedFlag | kStabilizeFlag;
    case FlightMode::commanded:
      return kGuidedFlag | kStabilizeFlag;
    default:
      return kStabilizeFlag;
  }
}
}  // namespace

FlightMode mode_of(const Heartbeat& heartbeat) {
  return heartbeat.autopilot == kArduPilot ? ardupilot_mode(heartbeat)
         : heartbeat.autopilot == kPx4     ? px4_mode(heartbeat)
                                           : generic_mode(heartbeat);
}

CommandLong mode_command(const Vehicle& vehicle, FlightMode mode) {
  const bool is_mission = mode == FlightMode::mission;
  const bool is_commanded = mode == FlightMode::commanded;
  if (vehicle.is_ardupilot()) {
    const ArduPilotModes& modes = modes_of(vehicle.heartbeat);
    const unsigned number = is_mission     ? modes.mission
                            : is_commanded ? modes.commanded
                                           : modes.hold;
    return command_to(vehicle, VehicleCommand::kSetMode, kCustomFlag, static_cast<float>(number));
  }
  if (vehicle.is_px4()) {
    const Px4Mode& px4 = is_mission ? kPx4Mission : is_commanded ? kPx4Commanded : kPx4Hold;
    return command_to(vehicle, VehicleCommand::kSetMode, kCustomFlag, static_cast<float>(px4.main),
                      static_cast<float>(px4.sub));
  }
  return command_to(vehicle, VehicleCommand::kSetMode, generic_flags(mode));
}

int first_item(const Vehicle& vehicle) { return vehicle.is_ardupilot() ? 1 : 0; }

MissionSetCurrent set_current(const Vehicle& vehicle, int item) {
  MissionSetCurrent set;
  set.target_system = vehicle.address.system;
  set.target_component = vehicle.address.component;
  set.seq = static_cast<std::uint16_t>(item);
  return set;
}

CommandLong command_to(const Vehicle& vehicle, std::uint16_t command, float param1, float param2,
                       float param3) {
  CommandLong message;
  message.target_system = vehicle.address.system;
  message.target_component = vehicle.address.component;
  message.command = command;
  message.param1 = param1;
  message.param2 = param2;
  message.param3 = param3;
  return message;
}
}  // namespace altiplan::link
