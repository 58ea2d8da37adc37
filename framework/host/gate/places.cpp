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

namespace {
/// Items whose heights count from home.
std::size_t items_of_home(const std::vector<MissionCommand>& commands) {
  return std::size_t(
      std::count_if(commands.begin(), commands.end(), [](const MissionCommand& command) {
        const Task task = formats::command_task(command.number).task;
        return formats::is_of_home(command.frame) && formats::flies_to_position(task) &&
               task != Task::land && task != Task::vtol_land;
      }));
}

std::optional<double> ground_of_home(const formats::MissionFile& plan, const World& world) {
  if (!plan.home || !world.frame().has_position()) {
    return std::nullopt;
  }
  const auto [x, y] = world.frame().to_local(plan.home->lon, plan.home->lat);
  return world.ground(x, y);
}
}  // namespace

std::optional<double> height_of_home(const formats::MissionFile& plan, const World& world) {
  const std::optional<double> ground = ground_of_home(plan, world);
  if (!ground || items_of_home(plan.commands) == 0 || *ground >= kUnknownGround ||
      std::abs(plan.home->altitude_m - *ground) <= kHomeTolerance) {
    return std::nullopt;
  }
  return std::round(*ground * 10) / 10;
}

formats::MissionFile with_home_at(formats::MissionFile plan, double altitude_m) {
  plan.home->altitude_m = altitude_m;
  return plan;
}

void add_home(PlanReport& report, const formats::MissionFile& plan, const World& world) {
  const std::size_t relative = items_of_home(report.commands);
  const std::optional<double> ground = ground_of_home(plan, world);
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
  const auto [x, y] = world.frame().to_local(plan.home->lon, plan.home->lat);
  const Vec3 place(x, y, *ground);
  Violation violation;
  violation.constraint = "home";
  violation.value = plan.home->altitude_m;
  violation.limit = *ground;
  violation.unit = "m";
  violation.message =
      "home is at " + with_digits(std::round(plan.home->altitude_m), 6) +
      " m in the mission, where the ground is at " + with_digits(std::round(*ground), 6) + " m: " +
      (relative == 0 ? "no height is" : "the heights of " + counted(relative, "item") + " are") +
      " relative to it";
  if (relative > 0) {
    report.findings.insert(report.findings.begin(), {violation, {"home"}, "", 0, place});
    report.findings.front().is_own_way = true;
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

namespace {
/// What is violated at a rally point.
std::vector<Violation> violations_at(const Vec3& p, const Request& request) {
  Request alone = request;
  alone.limits.min_leg = 0;  // a place has no length
  return leg_violations(std::nullopt, Leg::straight(p, p), alone, 0);
}

/// By how much a place is to be raised to be valid, found by what it is off; none where that does
/// not help.
std::optional<double> rise_of(const Vec3& p, const Request& request) {
  constexpr int kTries = 20;
  constexpr double kStep = 0.1;   // metres
  constexpr double kMost = 1000;  // above that is a void, not ground
  double rise = 0;
  for (int n = 0; n < kTries && std::abs(rise) < kMost; ++n) {
    const std::vector<Violation> found = violations_at(p + Vec3(0, 0, rise), request);
    if (found.empty()) {
      return rise;
    }
    const double off = found.front().limit - found.front().value;
    if (found.front().unit != "m" || !std::isfinite(off)) {
      return std::nullopt;
    }
    rise += std::copysign(std::ceil(std::abs(off) / kStep - 1e-6) * kStep, off);
  }
  return std::nullopt;
}
}  // namespace

void add_rally(PlanReport& report, const formats::MissionFile& plan, const Request& request) {
  ZoneNames names(*request.world);
  for (std::size_t n = 0; n < plan.rally.size(); ++n) {
    const auto add = [&](Finding finding) {
      finding.items = {"rally point " + std::to_string(n + 1)};
      finding.violation.constraint = "rally";
      report.findings.push_back(std::move(finding));
    };
    try {
      const Vec3 p = to_local(plan.rally[n], plan.home, *request.world);
      const std::optional<double> rise = rise_of(p, request);
      for (const Violation& violation : violations_at(p, request)) {
        Finding finding;
        finding.violation = violation;
        finding.at = p;
        if (rise) {
          finding.cure = std::string(*rise > 0 ? "raise" : "lower") + " rally point " +
                         std::to_string(n + 1) + " by " + with_decimals(std::abs(*rise), 1) + " m";
        }
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

formats::MissionFile with_rally_raised(formats::MissionFile plan, const Request& request) {
  for (formats::MissionPoint& point : plan.rally) {
    try {
      point.altitude_m += rise_of(to_local(point, plan.home, *request.world), request).value_or(0);
    } catch (const Error&) {  // where it is cannot be told
    }
  }
  return plan;
}
}  // namespace altiplan::host
