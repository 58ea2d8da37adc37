// SPDX-License-Identifier: Apache-2.0
#include "host/gate/plan_report.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "host/base/words.hpp"

namespace altiplan::host {

using formats::MissionCommand;
using formats::MissionItem;

Verdict PlanReport::verdict() const {
  const bool fails = std::any_of(findings.begin(), findings.end(),
                                 [](const Finding& finding) { return !finding.is_unjudged; });
  return fails ? Verdict::fail : findings.empty() ? Verdict::pass : Verdict::not_judged;
}

const char* word_of(Verdict verdict) {
  return verdict == Verdict::pass ? "pass" : verdict == Verdict::fail ? "fail" : "not judged";
}

std::string time_in_words(const TimeSpan& time) {
  const auto minutes = [](double seconds) { return with_decimals(seconds / 60, 1); };
  if (!std::isfinite(time.max_s)) {
    return std::isfinite(time.min_s) ? minutes(time.min_s) + " min or more" : "without end";
  }
  return time.max_s == 0 ? "not flown"
                         : minutes(time.min_s) + " to " + minutes(time.max_s) + " min";
}

std::string PlanReport::name_of(std::size_t command) const {
  return name_of_command(commands[command]);
}

std::string PlanReport::name_of_point(std::size_t waypoint) const {
  if (waypoint < imported.items.size()) {
    const MissionItem& item = imported.items[waypoint];
    for (const MissionCommand& command : commands) {
      if (command.place == item.place) {
        return name_of_command(command);
      }
    }
  }
  return "waypoint " + std::to_string(waypoint);
}

std::string PlanReport::height_in_words() const {
  const bool is_unknown = std::any_of(findings.begin(), findings.end(),
                                      [](const Finding& finding) { return finding.is_over_void; });
  return is_unknown                ? "over unknown ground"
         : std::isfinite(lowest_m) ? "at least " + with_decimals(lowest_m, 1) + " m above ground"
                                   : "height above ground unknown";
}

std::string EnergyUse::in_words() const {
  const auto one = [](double value) { return with_decimals(value, 1); };
  const std::string slowest = std::isfinite(max_wh) ? " to " + one(max_wh) + " Wh" : " Wh or more";
  return one(min_wh) + slowest + " of " + one(battery.usable_wh()) +
         " Wh that may be used (battery " + one(battery.capacity_wh) + " Wh, reserve " +
         with_decimals(100 * battery.reserve, 0) + " %), up to " +
         with_decimals(farthest_m / 1000, 3) + " km from home";
}

const RefusedReturn* ReturnsReport::worst() const {
  const auto off = [](const RefusedReturn& refused) {  // what hits something is worse
    const Violation& violation = refused.finding.violation;
    return std::pair(violation.unit != "Wh", std::abs(violation.value - violation.limit));
  };
  const auto found = std::max_element(
      refused.begin(), refused.end(),
      [&](const RefusedReturn& a, const RefusedReturn& b) { return off(a) < off(b); });
  return found == refused.end() ? nullptr : &*found;
}

std::string ReturnsReport::in_words() const {
  if (verdict == Verdict::pass) {
    return "there is a way home from every second of the flight";
  }
  std::string words =
      refused.empty() ? "" : counted(refused.size(), "part") + " of the flight without a way home";
  for (const std::string& why : unjudged) {
    words += (words.empty() ? "" : "; not judged: ") + why;
  }
  return words;
}

std::string in_words(const RefusedReturn& refused, const PlanReport& report) {
  const auto time = [](double seconds) {
    const long whole = std::lround(seconds);
    return (whole >= 60 ? std::to_string(whole / 60) + " min " : "") + std::to_string(whole % 60) +
           " s";
  };
  const auto place = [&](double seconds, std::size_t command) {
    return time(seconds) + " (" + report.name_of(command) + ")";
  };
  return "from " + place(refused.from_s, refused.first) + " to " +
         place(refused.to_s, refused.last) + ", worst at " + time(refused.worst_s) +
         ": a return's " + refused.finding.violation.message;
}

void expect_route(const std::string& file, const formats::MissionFile& plan) {
  if (!plan.route_problem.empty() && plan.commands.empty()) {
    throw Error(file + ": " + plan.route_problem +
                (plan.lacks_heights ? " (--agl METRES puts it above the ground)" : ""));
  }
  if (plan.items.empty()) {
    throw Error(file + ": it contains no route" +
                (plan.moves.empty()
                     ? !plan.zones.empty()   ? ": it contains only zones"
                       : !plan.rally.empty() ? ": it contains only rally points"
                                             : ""
                     : ", and where " + plan.moves.front() + " flies is not judged"));
  }
}

void put_above_ground(const std::string& file, formats::MissionFile& plan, double height_m) {
  if (!plan.lacks_heights) {
    throw Error(file + ": --agl is for a line without heights: " +
                (plan.route_problem.empty() ? "this one has its own" : plan.route_problem));
  }
  for (formats::MissionItem& item : plan.items) {
    if (item.at.altitude_m != 0) {
      throw Error(file + ": --agl is for a line without heights: " + item.place +
                  " has one, others none");
    }
    item.at.altitude_m = height_m;
    item.at.frame = formats::AltitudeFrame::ground;
  }
  plan.route_problem.clear();
  plan.lacks_heights = false;
}
}  // namespace altiplan::host
