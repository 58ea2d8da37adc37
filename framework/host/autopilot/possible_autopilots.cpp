// SPDX-License-Identifier: Apache-2.0
#include "host/autopilot/flown_mission.hpp"

namespace altiplan::host {

using formats::Airframe;
using formats::Autopilot;
using formats::Firmware;
using formats::MissionCommand;

std::vector<Autopilot> possible_autopilots(const formats::MissionFile& plan,
                                           const std::optional<Firmware>& firmware,
                                           const std::optional<Airframe>& airframe,
                                           const ParameterFile& parameters) {
  constexpr int kArduPilot = 3;
  constexpr int kPx4 = 12;
  std::vector<Firmware> firmwares{Firmware::ardupilot, Firmware::px4};
  if (firmware) {
    firmwares = {*firmware};
  } else if (plan.firmware == kArduPilot || plan.firmware == kPx4) {
    firmwares = {plan.firmware == kPx4 ? Firmware::px4 : Firmware::ardupilot};
  }
  std::vector<Airframe> airframes{Airframe::copter, Airframe::plane, Airframe::vtol};
  const int type = plan.vehicle_type;
  if (airframe) {
    airframes = {*airframe};
  } else if (type == 1) {
    airframes = {Airframe::plane};
  } else if (type >= 19 && type <= 25) {
    airframes = {Airframe::vtol};
  } else if ((type >= 2 && type <= 4) || (type >= 13 && type <= 15) || type == 29 || type == 35) {
    airframes = {Airframe::copter};
  }
  std::vector<Autopilot> all;
  std::vector<Autopilot> of_parameters;
  for (const Firmware f : firmwares) {
    for (const Airframe a : airframes) {
      all.push_back({f, a});
      if (Parameters(all.back(), parameters).of_another().empty()) {
        of_parameters.push_back(all.back());
      }
    }
  }
  return of_parameters.empty() ? all : of_parameters;
}

std::string name_of_command(const MissionCommand& command) {
  const std::string kind = std::string(" (") + formats::command_task(command.number).name + ")";
  return command.item > 0      ? "item " + std::to_string(command.item) + kind
         : command.number == 0 ? command.place + kind
                               : command.place;
}
}  // namespace altiplan::host
