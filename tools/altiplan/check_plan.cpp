// SPDX-License-Identifier: Apache-2.0
#include "check_plan.hpp"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <iostream>

#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/iso_time.hpp"
#include "altiplan_build.hpp"
#include "commands.hpp"
#include "host/base/output_file.hpp"
#include "host/base/sha256.hpp"
#include "host/base/utf8.hpp"
#include "host/gate/certificate.hpp"
#include "host/gate/changed_plan.hpp"
#include "host/gate/plan_report.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"
#include "plan_world.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace altiplan::cli {
namespace {

using host::Finding;
using host::Json;
using host::PlanReport;

std::string items_of(const Finding& finding) {
  std::string text;
  for (const std::string& item : finding.items) {
    text += (text.empty() ? "" : " to ") + item;
  }
  return text;
}

std::string cure_of(const Finding& finding, const PlanReport& report) {
  return finding.cure ? in_words(*finding.cure, report.name_of(finding.cure->waypoint)) : "";
}

/// "not judged: airspace, heights above ground", for what the options leave out; "" for nothing.
std::string left_out(const PlanCheck& plan) {
  if (plan.scenario) {
    return "";
  }
  const bool has_heights =
      plan.min_above_ground_m || plan.max_above_ground_m || plan.max_ground_distance_m;
  const std::string airspace = plan.airspace.empty() ? "airspace (--airspace)" : "";
  const std::string heights =
      has_heights ? "" : "limits of height above ground (--min-agl, --max-agl)";
  const std::string all = airspace + (airspace.empty() || heights.empty() ? "" : ", ") + heights;
  return all.empty() ? "" : "not judged: " + all;
}

void print(const PlanReport& report, const host::Mission& world) {
  const Color color = report.passed() ? Color::good : Color::bad;
  std::printf("%s: %s, %zu waypoints, %s km, %s\n",
              painted(stdout, color, report.passed() ? "pass" : "fail").c_str(),
              host::printable(report.file).c_str(), report.measures.waypoints,
              fixed(report.measures.length_m / 1000, 3).c_str(), report.height_in_words().c_str());
  for (const Finding& finding : report.findings) {
    std::printf("  %s: %s\n", items_of(finding).c_str(), finding.violation.message.c_str());
    if (finding.at) {
      std::printf("    worst at %s\n", host::place_in_words(*finding.at, world.request).c_str());
    }
    if (finding.cure) {
      std::printf("    cure: %s\n", cure_of(finding, report).c_str());
    }
  }
  for (const std::string& note : report.notes) {
    std::printf("  note: %s\n", host::printable(note).c_str());
  }
}

/// When the vehicle is expected at each waypoint of the route, seconds from take-off.
std::vector<double> arrivals_of(const PlanCheck& plan, const formats::MissionFile& mission,
                                const PlanReport& report) {
  const std::vector<double> times = flown_times(plan, mission);
  std::vector<double> arrivals;
  std::size_t n = 0;
  for (const formats::MissionItem& item : report.imported.items) {
    while (n < times.size() && mission.items[n].place != item.place) {
      ++n;
    }
    arrivals.push_back(n < times.size() ? times[n] : kInfinity);
  }
  return arrivals;
}

Json to_json(const PlanReport& report, const host::Mission& world,
             const std::vector<double>& arrivals) {
  Json all = Json::array();
  for (const Finding& finding : report.findings) {
    const Violation& violation = finding.violation;
    Json one{{"constraint", violation.constraint},
             {"items", finding.items},
             {"leg", violation.at},
             {"value", violation.value},
             {"limit", violation.limit},
             {"margin", violation.value - violation.limit},
             {"unit", violation.unit},
             {"layer", violation.layer},
             {"zone", finding.zone},
             {"message", violation.message}};
    if (finding.at) {
      const auto [lon, lat] = world.truth.frame().to_lonlat(finding.at->x(), finding.at->y());
      one["lonlat"] = {lon, lat};
      one["altitude_m"] = finding.at->z();
    }
    if (finding.cure) {
      one["cure"] = cure_of(finding, report);
    }
    all.push_back(std::move(one));
  }
  Json times = Json::array();
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    const bool ends = std::isfinite(arrivals[i]);
    times.push_back({{"item", report.name_of(i)}, {"time_s", ends ? Json(arrivals[i]) : Json()}});
  }
  return Json{{"plan", report.file},
              {"passed", report.passed()},
              {"violations", all},
              {"arrivals", times},
              {"metrics", host::to_json(report.measures)},
              {"notes", report.notes}};
}

host::Basis basis_of(const PlanCheck& plan, const formats::MissionFile& mission) {
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
  if (plan.airspace.empty()) {
    basis.emplace_back("airspace", "none given: not judged");
  }
  const auto add_metres = [&](const char* what, const std::optional<double>& metres) {
    basis.emplace_back(what, metres ? fixed(metres, 1) + " m" : "not judged");
  };
  if (mission.home) {
    basis.emplace_back("home", fixed(mission.home->lat, 6) + ", " + fixed(mission.home->lon, 6) +
                                   " (latitude, longitude), " + fixed(mission.home->altitude_m, 1) +
                                   " m above sea level");
  }
  add_metres("vehicle's radius", plan.radius_m);
  add_metres("least height above ground", plan.min_above_ground_m);
  add_metres("greatest height above ground", plan.max_above_ground_m);
  add_metres("greatest distance from the ground", plan.max_ground_distance_m);
  basis.emplace_back("hours", plan.start_time ? *plan.start_time + " and " +
                                                    duration(flown_s(plan, mission)) + " on"
                                              : "any: zones count at all hours");
  basis.emplace_back(
      "judged", formats::iso_time(double(std::time(nullptr))) + " by altiplan " ALTIPLAN_VERSION);
  return basis;
}

/// The changes of items that cure the mission; none if that fails.
std::vector<host::ChangedItem> changes_of(const PlanReport& report, const host::Mission& world,
                                          std::string& words) {
  Request request = world.request;
  request.world = std::make_shared<const World>(world.truth);
  const Route& route = report.imported.route;
  request.start.position = route.front();
  request.goal = {route.back()};
  const host::Bonds bonds = report.bonds();
  const std::optional<Route> better = host::cured(route, request, bonds);
  const std::size_t count = report.imported.items.size() - (bonds.last_is_led ? 1 : 0);
  std::vector<host::ChangedItem> changes;
  for (std::size_t i = 0; better && i < count; ++i) {
    Vec3 by = (*better)[i] - route[i];
    if (by.norm() == 0) {
      continue;
    }
    if (bonds.follows_ground[i]) {  // its height above the ground
      by.z() -= world.truth.ground((*better)[i].x(), (*better)[i].y()).value_or(0) -
                world.truth.ground(route[i].x(), route[i].y()).value_or(0);
    }
    by.z() = std::round(by.z() * 10) / 10;
    host::ChangedItem change{report.imported.items[i].place, {}, by.z()};
    if (by.head<2>().norm() > 0) {
      change.lonlat = world.truth.frame().to_lonlat((*better)[i].x(), (*better)[i].y());
    }
    changes.push_back(std::move(change));
    for (const Vec3& part : {Vec3(0, 0, by.z()), Vec3(by.x(), by.y(), 0)}) {
      if (part.norm() > 0) {
        words += "  " + in_words(host::Cure{i, part}, report.name_of(i)) + "\n";
      }
    }
  }
  return changes;
}

/// Writes the cured mission, judged again, or says why not.
void fix(const PlanCheck& plan, const PlanReport& report, const std::string& text,
         const formats::MissionFile& mission, const host::Mission& world) {
  if (report.passed()) {
    warn(*plan.fixed + ": not written: the mission passes as it is");
    return;
  }
  std::string words;
  const std::vector<host::ChangedItem> changes =
      busy("curing the mission", [&] { return changes_of(report, world, words); });
  const std::string better = host::changed_plan(text, mission.format, changes);
  const bool passes =
      !changes.empty() &&
      host::judge_plan(plan.plan, formats::read_mission(plan.plan, better), world, !plan.scenario)
          .passed();
  if (!passes) {
    warn(*plan.fixed +
         ": not written: found no items to raise, lower or move with which the mission passes");
    return;
  }
  host::write_file(*plan.fixed, better);
  if (!plan.json) {
    std::printf("fixed: %s passes:\n%s", plan.fixed->c_str(), words.c_str());
  }
}

/// Notes of layers, and of airspace that has nothing near the route.
void add_notes(PlanReport& report, const host::Mission& world) {
  constexpr double kFar = 50'000;  // metres
  const Route& route = report.imported.route;
  for (const Layer& layer : world.truth.layers()) {
    for (const std::string& note : layer.environment->info().notes) {
      report.notes.push_back(layer.id + ": " + note);
    }
    double nearest = kInfinity;
    for (std::size_t i = 0; i < route.size(); ++i) {
      nearest = std::min(nearest, layer.environment->clearance(route[i]));
    }
    if (nearest > kFar) {
      report.notes.insert(report.notes.begin(),
                          layer.id + ": no zone within 50 km of the route: of another region?");
    }
  }
}

/// Throws Error if what is to be written cannot be, or is read, or written twice.
void expect_outputs(const PlanCheck& plan, const std::vector<std::filesystem::path>& read) {
  std::vector<std::string> others{plan.plan};
  others.insert(others.end(), plan.airspace.begin(), plan.airspace.end());
  for (const auto& file : {plan.scenario, plan.terrain}) {
    others.insert(others.end(), file.value_or(plan.plan));
  }
  for (const std::filesystem::path& file : read) {
    others.push_back(file.string());
  }
  for (const auto& [file, option] : {std::pair(&plan.certificate, "--certificate"),
                                     {&plan.junit, "--junit"},
                                     {&plan.fixed, "--fix"}}) {
    if (*file) {
      expect_writable(*file, option);
      expect_apart(*file, option, others);
      others.push_back(std::filesystem::absolute(**file).lexically_normal().string());
      expect_apart(others.back(), option, {others.begin(), others.end() - 1});
    }
  }
}

/// Throws Error naming the option whose file is missing.
void expect_files(const PlanCheck& plan) {
  const auto expect = [](const char* option, const std::string& file) {
    if (!std::filesystem::exists(file)) {
      throw Error(std::string(option) + ": file not found: '" + file + "'");
    }
    if (host::printable(file) != file) {
      throw Error(std::string(option) + ": expected a name in UTF-8, found '" +
                  host::printable(file) + "'");
    }
  };
  if (plan.terrain) {
    expect("--terrain", *plan.terrain);
  }
  for (const std::string& file : plan.airspace) {
    expect("--airspace", file);
  }
}
}  // namespace

namespace {

int judged(const PlanCheck& plan, const std::optional<host::Config>& scenario,
           const host::Overrides& overrides) {
  const std::string text = formats::read_file(plan.plan);
  const formats::MissionFile mission = formats::read_mission(plan.plan, text);
  if (plan.fixed) {
    static_cast<void>(host::changed_plan(text, mission.format, {}));  // refuses other formats
  }
  host::expect_route(plan.plan, mission);
  const host::Mission world = busy("building the world", [&] {
    return host::build_mission(scenario ? *scenario : world_of(plan, mission, overrides), 1);
  });
  PlanReport report = busy("judging the mission", [&] {
    return host::judge_plan(plan.plan, mission, world, !plan.scenario);
  });
  add_notes(report, world);
  if (const std::string words = left_out(plan); !words.empty()) {
    report.notes.insert(report.notes.begin(), words);
  }
  const std::vector<double> arrivals = arrivals_of(plan, mission, report);
  if (plan.certificate) {
    host::write_file(*plan.certificate, busy("writing the certificate", [&] {
      return certificate(report, world, basis_of(plan, mission), arrivals);
    }));
  }
  if (plan.junit) {
    host::write_file(*plan.junit, junit(report));
  }
  plan.json ? void(std::cout << host::file_text(to_json(report, world, arrivals)))
            : print(report, world);
  if (plan.fixed) {
    fix(plan, report, text, mission, world);
  }
  return report.passed() ? kDone : kNoRoute;
}
}  // namespace

int check_plan(const PlanCheck& plan, const host::Overrides& overrides) {
  expect_files(plan);
  std::optional<host::Config> scenario;
  if (plan.scenario) {
    scenario = host::load_scenario(*plan.scenario, overrides);
  }
  expect_outputs(plan, scenario ? scenario->files : decltype(scenario->files){});
  try {
    return judged(plan, scenario, overrides);
  } catch (const Error& error) {
    const std::string message = about_file(error.what());
    // What an earlier call wrote would be taken for this one's verdict.
    if (plan.junit) {
      host::write_file(*plan.junit, host::junit_of_error(plan.plan, message));
    }
    if (message == error.what()) {
      throw;
    }
    throw Error(message);
  }
}
}  // namespace altiplan::cli
