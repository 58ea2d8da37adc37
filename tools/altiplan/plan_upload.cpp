// SPDX-License-Identifier: Apache-2.0
#include "plan_upload.hpp"

#include <iostream>

#include "commands.hpp"
#include "link/plan_transfer.hpp"

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
}  // namespace

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

bool upload_plan(Connection& connection, const host::Plan& plan, bool with_fence) {
  bool is_equal = upload(connection, plan, link::PlanType::mission, plan.items.size()) &&
                  accepts_mission(connection);
  if (!plan.fence.empty() && with_fence) {
    is_equal = upload(connection, plan, link::PlanType::fence, plan.fence.size()) && is_equal;
  }
  if (!plan.rally.empty()) {
    is_equal = upload(connection, plan, link::PlanType::rally, plan.rally.size()) && is_equal;
  }
  return is_equal;
}

void add_no_fence(App& command, bool& no_fence) {
  command.add_flag("--no-fence", no_fence,
                   "leave the vehicle's fence as it is, whatever zones the scenario has");
}
}  // namespace altiplan::cli
