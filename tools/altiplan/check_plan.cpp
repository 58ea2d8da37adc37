// SPDX-License-Identifier: Apache-2.0
#include "check_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iostream>

#include "commands.hpp"
#include "host/import_export/imported_route.hpp"
#include "host/judge/cure.hpp"
#include "host/judge/judge.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"

namespace altiplan::cli {
namespace {

using host::Json;

/// Quoted, absolute; JSON's strings are YAML's.
std::string path_text(const std::string& file) {
  return Json(std::filesystem::absolute(file).lexically_normal().string()).dump();
}

/// The scenario that the options describe.
std::string scenario_text(const PlanCheck& plan) {
  std::string text =
      "altiplan: 1\nenvironment:\n  - terrain: {file: " + path_text(*plan.terrain) + "}\n";
  for (const std::string& file : plan.airspace) {
    const std::string name = std::filesystem::path(file).filename().string();
    text += "  - zones: {file: " + path_text(file) + "}\n    id: " + Json(name).dump() + "\n";
  }
  // The ground and the zones alone bound a mission.
  text += "volume: {min_m: [-1e8, -1e8, -1e4], max_m: [1e8, 1e8, 1e5]}\n";
  text += "vehicle: {radius_m: " + Json(plan.radius_m).dump() + "}\n";
  text += "mission: " + path_text(plan.plan) + "\n";
  if (plan.start_time) {
    text += "start_time: " + Json(*plan.start_time).dump() + "\n";
  }
  text += "constraints:\n";
  if (plan.min_above_ground_m) {
    text += "  - ground_clearance: {min_m: " + Json(*plan.min_above_ground_m).dump() + "}\n";
  }
  if (plan.max_above_ground_m) {
    text += "  - altitude: {datum: ground, max_m: " + Json(*plan.max_above_ground_m).dump() + "}\n";
  }
  return plan.min_above_ground_m || plan.max_above_ground_m ? text : text + "  []\n";
}

/// A violation as the mission's author sees it.
struct Finding {
  Violation violation;
  std::vector<std::string> items;  ///< one, or the two of a leg
  Json lonlat;                     ///< of each
  std::string cure;                ///< "raise mission.items.4 by 12.4 m", or ""
};

std::string name_of(const host::ImportedRoute& imported, std::size_t waypoint) {
  return imported.places.empty() ? "waypoint " + std::to_string(waypoint)
                                 : imported.places[waypoint];
}

std::string words(const host::Cure& cure, const host::ImportedRoute& imported) {
  return (cure.by_m > 0 ? "raise " : "lower ") + name_of(imported, cure.waypoint) + " by " +
         fixed(std::abs(cure.by_m), 1) + " m";
}

std::vector<Finding> findings(const CheckResult& verdict, const host::ImportedRoute& imported,
                              const Request& request) {
  std::vector<Finding> all;
  const Route& route = imported.route;
  for (const Violation& violation : verdict.violations) {
    Finding finding{violation, {}, Json::array(), ""};
    for (std::size_t i = violation.at; i < std::min(violation.at + 2, route.size()); ++i) {
      finding.items.push_back(name_of(imported, i));
      const auto [lon, lat] = request.world->frame().to_lonlat(route[i].x(), route[i].y());
      finding.lonlat.push_back({lon, lat});
    }
    if (const auto found = host::cure(route, violation, request)) {
      finding.cure = words(*found, imported);
    }
    all.push_back(std::move(finding));
  }
  return all;
}

std::string where(const Finding& finding) {
  std::string text;
  for (std::size_t i = 0; i < finding.items.size(); ++i) {
    text += (i == 0 ? "" : " to ") + finding.items[i] + " (" +
            fixed(finding.lonlat[i][0].get<double>(), 6) + ", " +
            fixed(finding.lonlat[i][1].get<double>(), 6) + ")";
  }
  return text;
}

void print(const PlanCheck& plan, const std::vector<Finding>& found, const Measures& measures) {
  std::printf("%s: %s, %zu waypoints, %s km, at least %s m above ground\n",
              found.empty() ? "pass" : "fail", plan.plan.c_str(), measures.waypoints,
              fixed(measures.length_m / 1000, 3).c_str(),
              fixed(measures.min_ground_clearance_m, 1).c_str());
  for (const Finding& finding : found) {
    std::printf("  %s, %s: %s\n", where(finding).c_str(), finding.violation.constraint.c_str(),
                finding.violation.message.c_str());
    if (!finding.cure.empty()) {
      std::printf("    cure: %s\n", finding.cure.c_str());
    }
  }
}

Json to_json(const std::vector<Finding>& found) {
  Json all = Json::array();
  for (const Finding& finding : found) {
    Json one{{"constraint", finding.violation.constraint},
             {"items", finding.items},
             {"lonlat", finding.lonlat},
             {"value", finding.violation.value},
             {"limit", finding.violation.limit},
             {"message", finding.violation.message}};
    if (!finding.cure.empty()) {
      one["cure"] = finding.cure;
    }
    all.push_back(std::move(one));
  }
  return all;
}
}  // namespace

int check_plan(const PlanCheck& plan, const host::Overrides& overrides, bool as_json) {
  static_cast<void>(kit::read_mission(plan.plan));  // whose errors need no scenario
  const host::Config config =
      host::load_scenario_text(scenario_text(plan), "the world of --terrain", overrides);
  const host::Mission mission = host::build_mission(config, 1);
  const host::ImportedRoute imported = host::read_imported_route(plan.plan, mission);
  for (const std::string& note : imported.notes) {
    info(note);
  }
  for (const Layer& layer : mission.truth.layers()) {
    for (const std::string& note : layer.environment->info().notes) {
      info(layer.plugin + ": " + note);
    }
  }
  const CheckResult verdict = host::judge(imported.route, mission.request, mission.via);
  const std::vector<Finding> found = findings(verdict, imported, mission.request);
  const Measures measures = measure(imported.route, mission.request);
  if (as_json) {
    std::cout << host::file_text(Json{{"plan", plan.plan},
                                      {"passed", found.empty()},
                                      {"violations", to_json(found)},
                                      {"metrics", host::to_json(measures)}});
  } else {
    print(plan, found, measures);
  }
  return found.empty() ? kDone : kNoRoute;
}
}  // namespace altiplan::cli
