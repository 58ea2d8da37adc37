// SPDX-License-Identifier: Apache-2.0
#include "check_plan.hpp"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "altiplan/kit/formats/input_file.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/base/sha256.hpp"
#include "host/gate/certificate.hpp"
#include "host/gate/changed_plan.hpp"
#include "host/gate/plan_report.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::cli {
namespace {

using host::Finding;
using host::Json;
using host::PlanReport;

/// Where neither the file nor an option gives one: slow, so that more zones' hours count.
constexpr double kSpeed = 5;
/// Of a mission that ends in a loiter without end.
constexpr double kLongest = 86400;

/// Quoted, absolute; JSON's strings are YAML's.
std::string path_text(const std::string& file) {
  return Json(std::filesystem::absolute(file).lexically_normal().string()).dump();
}

/// Seconds in which the mission is flown, for zones with hours.
double flown_s(const PlanCheck& plan, const kit::MissionFile& mission) {
  return std::min(host::flight_time(mission, plan.speed_mps.value_or(kSpeed)), kLongest);
}

/// The scenario that the options describe.
std::string scenario_text(const PlanCheck& plan, const kit::MissionFile& mission) {
  std::string text =
      "altiplan: 1\nenvironment:\n  - terrain: {file: " + path_text(*plan.terrain) + "}\n";
  for (const std::string& file : plan.airspace) {
    const std::string name = std::filesystem::path(file).filename().string();
    text += "  - zones: {file: " + path_text(file) +
            ", horizon_s: " + Json(flown_s(plan, mission)).dump() +
            "}\n    id: " + Json(name).dump() + "\n";
  }
  // The ground and the zones alone bound a mission.
  text += "volume: {min_m: [-1e8, -1e8, -1e4], max_m: [1e8, 1e8, 1e5]}\n";
  text += "vehicle: {radius_m: " + Json(plan.radius_m).dump() + "}\n";
  text += "mission: " + path_text(plan.plan) + "\n";
  if (plan.start_time) {
    text += "start_time: " + Json(*plan.start_time).dump() + "\n";
  }
  std::string constraints;
  const auto add = [&](const char* words, const std::optional<double>& metres) {
    if (metres) {
      constraints += std::string("  - ") + words + ": " + Json(*metres).dump() + "}\n";
    }
  };
  add("ground_clearance: {min_m", plan.min_above_ground_m);
  add("altitude: {datum: ground, max_m", plan.max_above_ground_m);
  add("ground_distance: {max_m", plan.max_ground_distance_m);
  return text + "constraints:\n" + (constraints.empty() ? "  []\n" : constraints);
}

std::string where(const Finding& finding, const host::Mission& world) {
  std::string text;
  for (const std::string& item : finding.items) {
    text += (text.empty() ? "" : " to ") + item;
  }
  const Frame& frame = world.truth.frame();
  const auto [lon, lat] = frame.to_lonlat(finding.at.x(), finding.at.y());
  return text + " near " + fixed(lon, 6) + ", " + fixed(lat, 6) + " at " +
         fixed(finding.at.z(), 1) + " m";
}

std::string cure_of(const Finding& finding, const PlanReport& report) {
  return finding.cure ? in_words(*finding.cure, report.name_of(finding.cure->waypoint)) : "";
}

void print(const PlanReport& report, const host::Mission& world) {
  std::printf("%s: %s, %zu waypoints, %s km, at least %s m above ground\n",
              report.passed() ? "pass" : "fail", report.file.c_str(), report.measures.waypoints,
              fixed(report.measures.length_m / 1000, 3).c_str(),
              fixed(report.measures.min_ground_clearance_m, 1).c_str());
  for (const Finding& finding : report.findings) {
    std::printf("  %s: %s: %s\n", where(finding, world).c_str(),
                finding.violation.constraint.c_str(), finding.violation.message.c_str());
    if (finding.cure) {
      std::printf("    cure: %s\n", cure_of(finding, report).c_str());
    }
  }
  for (const std::string& note : report.notes) {
    std::printf("  read: %s\n", note.c_str());
  }
}

Json to_json(const PlanReport& report, const host::Mission& world) {
  Json all = Json::array();
  for (const Finding& finding : report.findings) {
    const Violation& violation = finding.violation;
    const auto [lon, lat] = world.truth.frame().to_lonlat(finding.at.x(), finding.at.y());
    Json one{{"constraint", violation.constraint},
             {"items", finding.items},
             {"lonlat", {lon, lat}},
             {"altitude_m", finding.at.z()},
             {"value", violation.value},
             {"limit", violation.limit},
             {"margin", violation.value - violation.limit},
             {"message", violation.message}};
    if (finding.cure) {
      one["cure"] = cure_of(finding, report);
    }
    all.push_back(std::move(one));
  }
  return Json{{"plan", report.file},
              {"passed", report.passed()},
              {"violations", all},
              {"metrics", host::to_json(report.measures)},
              {"notes", report.notes}};
}

host::Basis basis_of(const PlanCheck& plan, const kit::MissionFile& mission) {
  host::Basis basis;
  const auto add_file = [&](const char* what, const std::string& file) {
    basis.emplace_back(what, file + ", SHA-256 " + host::sha256(file));
  };
  add_file("plan", plan.plan);
  if (plan.scenario) {
    add_file("scenario", *plan.scenario);
    return basis;
  }
  add_file("terrain", *plan.terrain);
  for (const std::string& file : plan.airspace) {
    add_file("airspace", file);
  }
  const auto add_metres = [&](const char* what, const std::optional<double>& metres) {
    if (metres) {
      basis.emplace_back(what, fixed(metres, 1) + " m");
    }
  };
  add_metres("vehicle's radius", plan.radius_m);
  add_metres("least height above ground", plan.min_above_ground_m);
  add_metres("greatest height above ground", plan.max_above_ground_m);
  add_metres("greatest distance from the ground", plan.max_ground_distance_m);
  basis.emplace_back("hours", plan.start_time ? *plan.start_time + " and " +
                                                    duration(flown_s(plan, mission)) + " on"
                                              : "any: zones count at all hours");
  basis.emplace_back("judged by", "altiplan " ALTIPLAN_VERSION);
  return basis;
}

/// The mission with the route that cures it, judged again; none if that fails.
std::optional<std::string> cured_text(const PlanReport& report, const std::string& text,
                                      const kit::MissionFile& plan, const host::Mission& world) {
  Request request = world.request;
  request.world = std::make_shared<const World>(world.truth);
  const Route& route = report.imported.route;
  request.start.position = route.front();
  request.goal = {route.back()};
  const std::optional<Route> better = host::cured(route, request);
  if (!better || report.imported.places.empty()) {
    return std::nullopt;
  }
  std::vector<host::ChangedItem> changes;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const Vec3 by = (*better)[i] - route[i];
    if (by.norm() > 0) {
      const auto [lon, lat] = world.truth.frame().to_lonlat((*better)[i].x(), (*better)[i].y());
      changes.push_back({report.imported.places[i], lon, lat, by.z()});
    }
  }
  return host::changed_plan(text, plan.format, changes);
}
}  // namespace

int check_plan(const PlanCheck& plan, const host::Overrides& overrides) {
  for (const auto& [file, option] : {std::pair(&plan.certificate, "--certificate"),
                                     {&plan.junit, "--junit"},
                                     {&plan.fixed, "--fix"}}) {
    expect_writable(*file, option);
    std::vector<std::string> read = plan.airspace;
    read.push_back(plan.plan);
    expect_apart(*file, option, read);
  }
  const std::string text = kit::read_file(plan.plan);
  const kit::MissionFile mission = kit::read_mission(plan.plan, text);
  const host::Config config = plan.scenario
                                  ? host::load_scenario(*plan.scenario, overrides)
                                  : host::load_scenario_text(scenario_text(plan, mission),
                                                             "the world of --terrain", overrides);
  const host::Mission world = host::build_mission(config, 1);
  PlanReport report = host::judge_plan(plan.plan, mission, world, !plan.scenario);
  for (const Layer& layer : world.truth.layers()) {
    for (const std::string& note : layer.environment->info().notes) {
      report.notes.push_back(layer.id + ": " + note);
    }
  }
  if (plan.certificate) {
    host::write_file(*plan.certificate, certificate(report, world, basis_of(plan, mission)));
  }
  if (plan.junit) {
    host::write_file(*plan.junit, junit(report));
  }
  plan.json ? void(std::cout << host::file_text(to_json(report, world))) : print(report, world);
  if (plan.fixed && !report.passed()) {
    const std::optional<std::string> better = cured_text(report, text, mission, world);
    if (better &&
        host::judge_plan(plan.plan, kit::read_mission(plan.plan, *better), world, !plan.scenario)
            .passed()) {
      host::write_file(*plan.fixed, *better);
      warn(*plan.fixed + ": written with items changed, and passes");
    } else {
      warn(*plan.fixed + ": not written: raising, lowering or moving items does not cure it");
    }
  }
  return report.passed() ? kDone : kNoRoute;
}
}  // namespace altiplan::cli
