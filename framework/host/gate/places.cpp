// SPDX-License-Identifier: Apache-2.0
#include "host/gate/places.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"
#include "host/gate/violated_zone.hpp"

namespace altiplan::host {

using formats::MissionCommand;
using formats::MissionItem;
using formats::Task;

void add_home(PlanReport& report, const formats::MissionFile& plan, const World& world) {
  const auto relative = std::count_if(
      report.commands.begin(), report.commands.end(), [](const MissionCommand& command) {
        const Task task = formats::command_task(command.number).task;
        return (command.frame == 3 || command.frame == 6) && formats::flies_to_position(task) &&
               task != Task::land && task != Task::vtol_land;
      });
  if (!plan.home || !world.frame().has_position()) {
    return;
  }
  const auto [x, y] = world.frame().to_local(plan.home->lon, plan.home->lat);
  const std::optional<double> ground = world.ground(x, y);
  if (!ground) {
    return;
  }
  const double off = plan.home->altitude_m - *ground;
  if (std::abs(off) <= kHomeTolerance) {
    if (relative > 0 && std::abs(off) > 1) {
      report.notes.push_back("heights count from home, which the mission has " +
                             with_decimals(std::abs(off), 1) + " m " +
                             (off > 0 ? "above" : "below") + " the ground");
    }
    return;
  }
  Violation violation;
  violation.constraint = "home";
  violation.value = plan.home->altitude_m;
  violation.limit = *ground;
  violation.unit = "m";
  violation.message =
      "home is at " + with_digits(std::round(plan.home->altitude_m), 6) +
      " m in the mission, where the ground is at " + with_digits(std::round(*ground), 6) + " m: " +
      (relative == 0 ? "no height is"
                     : "the heights of " + counted(std::size_t(relative), "item") + " are") +
      " relative to it";
  if (relative > 0) {
    report.findings.insert(report.findings.begin(),
                           {violation, {"home"}, "", 0, Vec3(x, y, *ground)});
  } else {
    report.notes.push_back(violation.message);
  }
}

void expect_on_ground(const formats::MissionFile& plan, const World& world) {
  const auto has_ground = [&](double lon, double lat) {
    const auto [x, y] = world.frame().to_local(lon, lat);
    return world.ground(x, y).has_value();
  };
  const auto& items = plan.items;
  if (!world.has_ground() || !world.frame().has_position() || items.empty() ||
      std::any_of(items.begin(), items.end(),
                  [&](const MissionItem& item) { return has_ground(item.at.lon, item.at.lat); })) {
    return;
  }
  const bool is_swapped = std::all_of(items.begin(), items.end(), [&](const MissionItem& item) {
    return std::abs(item.at.lon) <= 90 && has_ground(item.at.lat, item.at.lon);
  });
  const MissionItem& first = items.front();
  throw Error("no position of the mission is within the elevation model: " +
              (first.number > 0 ? "item " + std::to_string(first.number) : first.place) +
              " is at latitude " + with_digits(first.at.lat, 8) + ", longitude " +
              with_digits(first.at.lon, 9) +
              (is_swapped ? ", which are swapped: exchanged, all are within" : ""));
}
void add_rally(PlanReport& report, const formats::MissionFile& plan, const Request& request) {
  Request alone = request;
  alone.limits.min_leg = 0;  // a place has no length
  ZoneNames names(*request.world);
  for (std::size_t n = 0; n < plan.rally.size(); ++n) {
    const auto add = [&](Finding finding) {
      finding.items = {"rally point " + std::to_string(n + 1)};
      finding.violation.constraint = "rally";
      report.findings.push_back(std::move(finding));
    };
    try {
      const Vec3 p = to_local(plan.rally[n], plan.home, *request.world);
      for (const Violation& violation :
           leg_violations(std::nullopt, Leg::straight(p, p), alone, 0)) {
        Finding finding;
        finding.violation = violation;
        finding.at = p;
        names.add_to(finding);
        name_void(finding, *request.world);
        add(std::move(finding));
      }
    } catch (const Error& error) {  // where it is cannot be told
      Finding finding;
      finding.violation.message = error.what();
      add(std::move(finding));
    }
  }
}
}  // namespace altiplan::host
