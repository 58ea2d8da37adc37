// SPDX-License-Identifier: Apache-2.0
#include "host/gate/plan_cures.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "host/base/words.hpp"
#include "host/gate/return_height.hpp"

namespace altiplan::host {

using formats::Autopilot;
using formats::MissionCommand;
using formats::Task;

PlanCures::PlanCures(const formats::MissionFile& plan, const World& world,
                     const FlightOptions& flight, const std::vector<formats::Autopilot>& autopilots,
                     const BandJudge& judge, Fly fly)
    : plan_(plan),
      world_(world),
      flight_(flight),
      autopilots_(autopilots),
      judge_(judge),
      fly_(std::move(fly)) {}

void PlanCures::add_to(PlanReport& report, const std::vector<std::optional<Way>>& ways,
                       const std::vector<FlownMission>& flown) const {
  Cures search(plan_, flown, world_, fly_, judge_);
  const std::optional<AboveHome> above_home = search.above_home();
  std::map<std::pair<std::size_t, std::size_t>, std::string> found;
  for (std::size_t n = 0; n < report.findings.size(); ++n) {
    Finding& finding = report.findings[n];
    finding.cure = cure_of_landing(finding, report);
    if (!finding.cure.empty()) {
      continue;
    }
    if (above_home && !finding.is_unjudged && (ways[n] || above_home->passes)) {
      finding.cure = in_words(*above_home, report);
      continue;
    }
    if (!ways[n]) {
      continue;
    }
    const auto [before, command, is_return] = *ways[n];
    const std::pair way(before, command);
    if (!found.contains(way) && !search.is_exhausted()) {
      const Violation& violation = finding.violation;
      const double off = violation.unit == "m" ? std::abs(violation.value - violation.limit) : 0;
      const std::optional<Cure> cure = search.find(before, command, off);
      found[way] = cure ? in_words(*cure, report) : "";
      if (const std::string higher = is_return ? cure_by_height(command) : ""; !higher.empty()) {
        found[way] += (found[way].empty() ? "" : ", or ") + higher;
      }
    }
    if (const auto cure = found.find(way); cure != found.end()) {
      finding.cure = cure->second;
    }
  }
  if (!above_home && search.is_exhausted()) {
    report.notes.emplace_back(
        "not every cure was searched for: --fix searches longer, and writes the cured mission");
  }
}

std::string PlanCures::in_words(const Cure& cure, const PlanReport& report) const {
  const std::optional<double> height = above_ground(plan_, cure.command, world_);
  return host::in_words(cure, report.name_of(cure.command),
                        height ? std::optional(*height + cure.by.z()) : std::nullopt);
}

std::string PlanCures::in_words(const AboveHome& change, const PlanReport& report) const {
  std::vector<std::string> names;
  std::vector<int> numbers;
  for (const std::size_t n : change.commands) {
    names.push_back(report.name_of(n));
    numbers.push_back(plan_.commands[n].item);
  }
  const std::string how = "set the frame of " + items_in_words(names, numbers) + " to relative (" +
                          (plan_.commands[change.commands.front()].frame == 5 ? "6" : "3") + ")";
  if (change.passes) {
    return "as heights above home this passes: " + how;
  }
  return how + ": as heights above home " +
         (change.invalid == 0 ? "no part" : counted(change.invalid, "part")) + " of the flight " +
         (change.invalid < 2 ? "fails" : "fail") + ", in place of " + std::to_string(change.before);
}

std::string PlanCures::cure_of_landing(const Finding& finding, const PlanReport& report) const {
  for (const auto& [n, rise] : landings_off_ground()) {
    if (finding.items == std::vector{report.name_of(n)} && !finding.is_unjudged) {
      formats::MissionFile plan = plan_;
      plan.commands[n].altitude_m += rise;
      return fails_at(plan, n) ? ""
                               : "set the altitude of " + report.name_of(n) +
                                     " to that of the ground: " + (rise > 0 ? "raise" : "lower") +
                                     " it by " + with_decimals(std::abs(rise), 1) + " m";
    }
  }
  return "";
}

std::vector<std::pair<std::size_t, double>> PlanCures::landings_off_ground() const {
  constexpr double kOff = 0.1;  // metres
  std::vector<std::pair<std::size_t, double>> landings;
  const bool is_copter =
      std::any_of(autopilots_.begin(), autopilots_.end(),
                  [](const Autopilot& autopilot) { return autopilot.is_copter(); });
  for (std::size_t n = 0; n < plan_.commands.size() && !is_copter; ++n) {
    const MissionCommand& command = plan_.commands[n];
    if (formats::command_task(command.number).task == Task::land && command.has_position()) {
      const double rise = -above_ground(plan_, n, world_).value_or(0);
      if (std::abs(rise) > kOff) {
        landings.emplace_back(n, rise);
      }
    }
  }
  return landings;
}

bool PlanCures::fails_at(const formats::MissionFile& plan, std::size_t command) const {
  const std::vector<FlownMission> all = fly_(plan);
  return std::any_of(all.begin(), all.end(), [&](const FlownMission& flown) {
    return std::any_of(flown.parts.begin(), flown.parts.end(),
                       [&](const FlownPart& part) {
                         return part.command == command && !judge_.is_valid(part);
                       }) ||
           std::any_of(flown.remarks.begin(), flown.remarks.end(), [&](const Remark& remark) {
             return remark.command == command && remark.weight == Remark::Weight::fails;
           });
  });
}

std::string PlanCures::cure_by_height(std::size_t command) const {
  if (autopilots_.size() != 1) {
    return "";
  }
  FlightOptions flight = flight_;
  const auto cure = min_return_height(
      autopilots_.front(), flight.parameters, [&](const ParameterFile& parameters) {
        flight.parameters = parameters;
        const FlownMission flown = fly_mission(plan_, autopilots_.front(), world_, flight);
        return std::all_of(flown.parts.begin(), flown.parts.end(), [&](const FlownPart& part) {
          return part.command != command || judge_.is_valid(part);
        });
      });
  return cure ? "return higher: " + cure->parameter + " " + with_decimals(cure->value, 0) : "";
}

std::optional<formats::MissionFile> PlanCures::cured() const {
  formats::MissionFile plan = plan_;
  for (const auto& [n, rise] : landings_off_ground()) {
    plan.commands[n].altitude_m += fails_at(plan_, n) ? rise : 0;
  }
  return Cures(plan, fly_(plan), world_, fly_, judge_).cured();
}
}  // namespace altiplan::host
