// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "host/import_export/plan.hpp"
#include "link/link.hpp"

namespace altiplan::link {

/// Items as MAVLink carries them: degrees to seven decimals, numbers as floats.
std::vector<MissionItemInt> wire_items(const std::vector<host::PlanItem>& items);
std::vector<host::PlanItem> plan_items(const std::vector<MissionItemInt>& items);

/// Maximum differences between what was sent and what a vehicle holds: 1e-7 degrees, and 1 cm or as
/// much of another parameter.
inline constexpr double kDegreesTolerance = 1e-7;
inline constexpr double kValueTolerance = 0.01;

/// What a vehicle changed, one line per item. Equivalent frames are equal, and so is anything to
/// what was left to the autopilot.
std::vector<std::string> differences(const std::vector<MissionItemInt>& sent,
                                     const std::vector<MissionItemInt>& held);

/// Uploads the items of this type, reads them back, and returns what the vehicle changed. To
/// ArduPilot a mission begins with home, which it may replace by its own. Throws LinkError.
std::vector<std::string> upload(Link& link, const Vehicle& vehicle, const host::Plan& plan,
                                PlanType type, const std::stop_token& stop);

/// What a vehicle makes of the mission that it has just stored.
struct StoredMission {
  std::optional<int> current;     ///< item with which it begins; none: it does not say
  bool begins_elsewhere = false;  ///< than at the first item, though it was asked to
  bool is_refused = false;        ///< it declares the mission invalid
  std::string words;              ///< its last warning since, "" for none
};

/// Waits until the vehicle has checked its mission and, unless it is armed, will begin with the
/// first item; asks it to.
StoredMission stored_mission(Link& link, const Vehicle& vehicle, const std::stop_token& stop);

/// Adds the items of this type, and the home of ArduPilot, to the plan. Throws LinkError.
void download(Link& link, const Vehicle& vehicle, PlanType type, host::Plan& plan,
              const std::stop_token& stop);
}  // namespace altiplan::link
