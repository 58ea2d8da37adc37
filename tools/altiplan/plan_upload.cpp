// SPDX-License-Identifier: Apache-2.0
#include "plan_upload.hpp"

#include <iostream>

#include "commands.hpp"
#include "link/plan_transfer.hpp"
#include "link/vehicle_words.hpp"

namespace altiplan::cli {
namespace {

/// Uploads the items of one type; true if the vehicle holds what was sent.
bool upload(Connection& connection, const host::Plan& plan, link::PlanType type,
            std::size_t count) {
  const std::vector<std::string> changed =
      link::upload(connection.link, connection.vehicle, plan, type, connection.stop);
  std::cout << link::name(type) << ": " << count << " items uploaded, read back "
            << (changed.empty() ? "equal" : "with differences") << '\n';
  for (const std::string& line : changed) {
    std::cout << "  " << line << '\n';
  }
  return changed.empty();
}

/// None where the autopilot is neither ArduPilot nor PX4.
std::optional<formats::Autopilot> autopilot_of(const link::Vehicle& vehicle) {
  using formats::Airframe;
  using formats::Firmware;
  constexpr std::uint8_t kFixedWing = 1;
  if (!vehicle.is_ardupilot() && !vehicle.is_px4()) {
    return std::nullopt;
  }
  const Airframe airframe = !link::is_fixed_wing(vehicle.heartbeat) ? Airframe::copter
                            : vehicle.heartbeat.type == kFixedWing  ? Airframe::plane
                                                                    : Airframe::vtol;
  return formats::Autopilot{vehicle.is_px4() ? Firmware::px4 : Firmware::ardupilot, airframe};
}
}  // namespace

void tell_refusals(const link::Vehicle& vehicle, const formats::MissionFile& mission) {
  const std::optional<formats::Autopilot> autopilot = autopilot_of(vehicle);
  if (!autopilot || mission.items.empty() || mission.commands.empty()) {
    return;  // nothing is flown, or without commands that could be refused
  }
  host::GateOptions gate;
  gate.firmware = autopilot->firmware;
  gate.airframe = autopilot->airframe;
  try {
    for (const host::FlownMission& flown : host::flights_of(mission, nullptr, gate)) {
      for (const host::Remark& remark : flown.remarks) {
        if (remark.rule == "refused") {
          warn(host::name_of_command(mission.commands[remark.command]) + ": " + remark.message);
        }
      }
    }
  } catch (const Error& error) {
    warn(std::string("what the vehicle refuses is not known: ") + error.what());
  }
}

bool is_judged_for(const link::Vehicle& vehicle, const formats::MissionFile& mission,
                   const host::GateOptions& gate) {
  const std::optional<formats::Autopilot> autopilot = autopilot_of(vehicle);
  if (!autopilot) {
    warn("the vehicle's autopilot is neither ArduPilot nor PX4: how it flies is not judged");
    return true;
  }
  std::string judged;
  for (const formats::Autopilot& possible :
       host::possible_autopilots(mission, gate.firmware, gate.airframe, gate.flight.parameters)) {
    // ArduPilot's VTOL may call itself a fixed wing.
    const bool is_plane = possible.airframe == formats::Airframe::vtol && !possible.is_px4() &&
                          autopilot->airframe == formats::Airframe::plane;
    if (possible.firmware == autopilot->firmware &&
        (possible.airframe == autopilot->airframe || is_plane)) {
      return true;
    }
    judged += (judged.empty() ? "" : ", ") + possible.name();
  }
  std::cerr << "altiplan: the mission was judged as flown by " << judged << ", and the vehicle is "
            << autopilot->name()
            << ": nothing was uploaded; --autopilot and --vehicle say who flies it\n";
  return false;
}

host::Plan plan_to_upload(const host::Exported& written) {
  if (written.mission.decimals.degrees > 7) {
    warn(
        "MAVLink carries 7 decimals of a degree: rounded so, the route is not valid, by 1 cm at "
        "most");
  }
  return host::plan_of(written.mission);
}

/// Prints what the vehicle has against the mission that it stores; true if nothing.
bool accepts_mission(Connection& connection) {
  const link::StoredMission stored =
      link::stored_mission(connection.link, connection.vehicle, connection.stop);
  const std::string words = stored.words.empty() ? "" : " (\"" + stored.words + "\")";
  if (stored.is_refused) {
    std::cout << "mission: the vehicle declares it invalid" << words << '\n';
  } else if (stored.begins_elsewhere && stored.current) {
    std::cout << "mission: the vehicle would begin at its item " << *stored.current
              << ", not at the first" << words << '\n';
  } else if (!words.empty()) {
    std::cout << "mission: the vehicle says" << words << '\n';
  }
  return !stored.is_refused && !(stored.begins_elsewhere && stored.current);
}

/// Prints whether the vehicle still has a fence, or rally points, of an older plan.
void tell_kept(Connection& connection, link::PlanType type, const std::string& cure) {
  const std::string what = link::name(type);
  host::Plan held;
  try {
    link::download(connection.link, connection.vehicle, type, held, connection.stop);
  } catch (const link::LinkError& error) {
    std::cout << what << ": whether the vehicle has any is not known: " << error.what() << '\n';
  }
  if (const std::size_t count = held.fence.size() + held.rally.size(); count > 0) {
    std::cout << what << ": the vehicle keeps " << count
              << " items, which this plan has not: " << cure << '\n';
  }
}

bool upload_plan(Connection& connection, const host::Plan& plan, const FenceOptions& fence) {
  if ((connection.vehicle.heartbeat.base_mode & link::kArmedFlag) != 0) {
    warn("the vehicle is armed: if it flies a mission, that is replaced under it");
  }
  bool is_equal = upload(connection, plan, link::PlanType::mission, plan.items.size()) &&
                  accepts_mission(connection);
  if (!fence.leave && (!plan.fence.empty() || fence.clear)) {
    is_equal = upload(connection, plan, link::PlanType::fence, plan.fence.size()) && is_equal;
  } else if (!fence.leave) {
    tell_kept(connection, link::PlanType::fence, "--clear-fence removes it");
  }
  if (!plan.rally.empty() || fence.clear_rally) {
    is_equal = upload(connection, plan, link::PlanType::rally, plan.rally.size()) && is_equal;
  } else {
    tell_kept(connection, link::PlanType::rally,
              "a return may lead to them; --clear-rally removes them");
  }
  return is_equal;
}

void add_fence_options(App& command, FenceOptions& fence) {
  auto* leave = command.add_flag("--no-fence", fence.leave,
                                 "leave the vehicle's fence as it is, whatever zones the scenario "
                                 "has");
  command
      .add_flag("--clear-fence", fence.clear,
                "remove the vehicle's fence where the scenario has no zones")
      ->excludes(leave);
  command.add_flag("--clear-rally", fence.clear_rally,
                   "remove the vehicle's rally points where the plan has none");
}
}  // namespace altiplan::cli
