// SPDX-License-Identifier: Apache-2.0
#include "host/gate/route_returns.hpp"

#include <algorithm>

#include "altiplan/error.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "host/gate/declared_battery.hpp"
#include "host/gate/returns.hpp"
#include "host/gate/returns_json.hpp"

namespace altiplan::host {
namespace {

ExportSource source_of(const Config& config, const RunResult& result) {
  ExportSource source;
  source.name =
      config.scenario.name.empty() ? config.scenario_path.stem().string() : config.scenario.name;
  source.route = result.steps[*result.accepted].route;
  if (result.task) {
    for (const Pass& pass : result.task->passes) {
      if (pass.stop.acts()) {
        source.stops.push_back({pass.points.back(), pass.stop});
      }
    }
  }
  return source;
}

/// What is said of a mission that is not made, or fails.
std::string problem_of(const RouteMission& made) {
  if (!made.fewest) {
    return made.written.messages.front();
  }
  const PlanReport& report = made.fewest->report;
  const Finding& finding = report.findings.front();
  return "the route fails as the mission of " + report.autopilots.front().name() + ": " +
         finding.items.front() + ": " + finding.violation.message;
}
}  // namespace

void take_changes(const Config& config, const Mission& mission, GateOptions& options) {
  options.has_events = !config.scenario.events.empty();
  options.zones_known_s = kit::known_until_s(mission.truth);
}

RouteMission mission_of_route(const Mission& mission, const ExportSource& source,
                              ExportOptions options, GateOptions gate) {
  options.max_items.reset();
  // It would fly home where its mission ends.
  options.circles_at_end = mission.vehicle_type == VehicleType::plane;
  options.firmware = gate.firmware.value_or(options.firmware);
  RouteMission made{export_route(mission, source, options), std::nullopt};
  if (made.written.text) {
    gate.flight.wind_mps = std::max(gate.flight.wind_mps, mission.request.wind.max_speed());
    made.fewest = fewest_items(mission, source, options, made.written.mission, gate);
  }
  return made;
}

ReturnsVerdict judge_route_returns(const Config& config, const Mission& mission,
                                   const RunResult& result, const StepEntry& entry) {
  const ExportSource source = source_of(config, result);
  Mission world = mission;
  take_open_ends(mission, source.route, world.request);
  if (mission.task && !mission.ends.goal) {
    world.request.goal.tolerance_m = 1;  // files of missions round points
  }
  ExportOptions options;
  options.format = &format_named("qgc-plan");
  options.takeoff = options.land = mission.vehicle_type != VehicleType::plane;
  GateOptions gate;
  gate.firmware = entry.plugin == "px4" ? formats::Firmware::px4 : formats::Firmware::ardupilot;
  if (entry.params) {
    gate.flight.parameters = read_parameters(entry.params->text);
  }
  RouteMission made;
  try {
    made = mission_of_route(world, source, options, gate);
  } catch (const PluginError&) {
    throw;
  } catch (const Error& error) {
    return {false, std::string("the route cannot be a mission: ") + error.what(), ""};
  }
  if (!made.fewest || !made.fewest->passed()) {
    return {false, problem_of(made), ""};
  }
  const formats::MissionFile file =
      formats::read_mission("route.plan", plan_text(made.fewest->plan));
  gate.flight.wind_mps = mission.request.wind.max_speed();
  take_changes(config, mission, gate);
  take_battery(mission.request.vehicle, file, gate);
  PlanReport report = std::move(made.fewest->report);
  report.returns = judge_returns(file, world, gate);
  const ReturnsReport& returns = *report.returns;
  std::string message = std::string(word_of(returns.verdict)) + ": " + returns.in_words();
  if (const RefusedReturn* worst = returns.worst()) {
    message += ": " + in_words(*worst, report);
  }
  return {returns.verdict == Verdict::pass, std::move(message),
          json_text(returns_json(report, world))};
}
}  // namespace altiplan::host
