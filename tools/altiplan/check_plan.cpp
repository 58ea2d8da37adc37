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
#include "host/first_route/zones.hpp"
#include "host/gate/certificate.hpp"
#include "host/gate/changed_plan.hpp"
#include "host/gate/declared_battery.hpp"
#include "host/gate/glide.hpp"
#include "host/gate/plan_report.hpp"
#include "host/gate/return_cure.hpp"
#include "host/gate/returns.hpp"
#include "host/gate/route_returns.hpp"
#include "host/import_export/route_format.hpp"
#include "host/mission/mission.hpp"
#include "host/result/result_json.hpp"
#include "plan_text.hpp"
#include "plan_world.hpp"
#include "progress.hpp"
#include "terminal.hpp"

namespace altiplan::cli {
namespace {

using host::Finding;
using host::Json;
using host::PlanReport;

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

host::Basis basis_of(const PlanCheck& plan, const formats::MissionFile& mission,
                     const PlanReport& report) {
  host::Basis basis;
  const auto add_file = [&](const char* what, const std::string& file) {
    basis.emplace_back(what, file + ", SHA-256 " + host::sha256(file));
  };
  add_file("plan", plan.plan);
  std::string autopilots;
  for (const formats::Autopilot& autopilot : report.autopilots) {
    autopilots += (autopilots.empty() ? "" : ", ") + autopilot.name();
  }
  basis.emplace_back("flown by", autopilots.empty() ? "not said: judged as drawn" : autopilots);
  if (plan.parameters) {
    add_file("parameters", *plan.parameters);
  }
  if (plan.ditch) {
    add_file("sites of a glide", *plan.ditch);
  }
  if (plan.scenario) {
    add_file("scenario", *plan.scenario);
    return basis;
  }
  for (const std::string& file : models_of(plan)) {
    add_file("terrain", file);
  }
  for (const std::string& file : plan.airspace) {
    add_file("airspace", file);
  }
  for (const std::string& zone : plan.permitted) {
    basis.emplace_back("permission had", zone == host::kEveryZone ? "for every zone that takes one"
                                                                  : "for '" + zone + "'");
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
                                   " m above sea level: armed at that place and height");
  }
  add_metres("vehicle's radius", plan.radius_m);
  add_metres("distance kept from zones", plan.buffer_m);
  add_metres("minimum height above ground", plan.min_above_ground_m);
  add_metres("greatest height above ground", plan.max_above_ground_m);
  add_metres("greatest distance from the ground", plan.max_ground_distance_m);
  basis.emplace_back("hours", plan.start_time
                                  ? *plan.start_time + " and " + time_in_words(report.time) + " on"
                                  : "any: zones count at all hours");
  basis.emplace_back(
      "judged", formats::iso_time(double(std::time(nullptr))) + " by altiplan " ALTIPLAN_VERSION);
  return basis;
}

/// The changes from one mission to another: of heights and places, frames of heights, home's height
/// and rally points'.
host::PlanChanges changes_of(const formats::MissionFile& before, const formats::MissionFile& after,
                             const World& world, const PlanReport& report, std::string& words) {
  host::PlanChanges changes;
  if (before.home && before.home->altitude_m != after.home->altitude_m) {
    changes.home_raised_by_m = after.home->altitude_m - before.home->altitude_m;
    words += "  set home's altitude to " + host::rounded_text(after.home->altitude_m, 1) + " m\n";
  }
  for (std::size_t n = 0; n < before.commands.size(); ++n) {
    const formats::MissionCommand& old = before.commands[n];
    const formats::MissionCommand& now = after.commands[n];
    host::ChangedItem change{
        old.place, {}, std::round((now.altitude_m - old.altitude_m) * 10) / 10, {}};
    Vec3 aside(0, 0, 0);
    if (old.lon != now.lon || old.lat != now.lat) {
      change.lonlat = {now.lon, now.lat};
      const auto [x, y] = world.frame().to_local(old.lon, old.lat);
      const auto [to_x, to_y] = world.frame().to_local(now.lon, now.lat);
      aside = {to_x - x, to_y - y, 0};
    }
    if (old.frame != now.frame) {
      change.frame = now.frame;
      words += "  set the frame of " + report.name_of(n) + " to " + std::to_string(now.frame) +
               " (relative)\n";
    }
    if (!change.lonlat && change.raised_by_m == 0 && !change.frame) {
      continue;
    }
    for (const Vec3& part : {Vec3(0, 0, change.raised_by_m), aside}) {
      if (part.norm() > 0) {
        words +=
            "  " +
            in_words(host::Cure{n, part}, report.name_of(n), host::above_ground(after, n, world)) +
            "\n";
      }
    }
    changes.items.push_back(std::move(change));
  }
  for (std::size_t n = 0; n < before.rally.size(); ++n) {
    const double rise = after.rally[n].altitude_m - before.rally[n].altitude_m;
    if (rise != 0) {
      changes.rally.emplace_back(n, rise);
      words += std::string("  ") + (rise > 0 ? "raise" : "lower") + " rally point " +
               std::to_string(n + 1) + " by " + fixed(std::abs(rise), 1) + " m\n";
    }
  }
  return changes;
}

/// Writes the cured mission, judged again, or says why not.
void fix(const PlanCheck& plan, const PlanReport& report, const std::string& text,
         const formats::MissionFile& mission, const host::Mission& world) {
  if (report.findings.empty()) {
    warn(*plan.fixed + ": not written: the mission passes as it is");
    return;
  }
  const auto cured =
      busy("curing the mission", [&] { return host::cured_plan(mission, world, plan.gate); });
  std::string words;
  std::string better;
  bool passes = false;
  if (cured) {
    better = host::changed_plan(text, mission.format,
                                changes_of(mission, *cured, world.truth, report, words));
    passes =
        host::judge_plan(plan.plan, host::read_mission_file(plan.plan, better), world, plan.gate)
            .passed();
  }
  if (!passes) {
    warn(*plan.fixed +
         ": not written: found no items to raise, lower or move with which the mission passes");
    return;
  }
  host::write_file(*plan.fixed, better);
  if (!plan.json) {
    std::printf("fixed: %s passes%s:\n%s", plan.fixed->c_str(),
                report.returns ? ", but for its returns, which --fix-returns looks at" : "",
                words.c_str());
  }
}

/// Writes what cures the returns, markers or rally points in a copy of the mission or a parameter,
/// or says why not.
void fix_returns(const PlanCheck& plan, const PlanReport& report, const std::string& text,
                 const formats::MissionFile& mission, const host::Mission& world) {
  const std::string& file = *plan.fixed_returns;
  if (report.findings.empty() && report.returns->verdict == host::Verdict::pass) {
    warn(file + ": not written: the returns pass as they are");
    return;
  }
  const auto own = std::find_if(report.findings.begin(), report.findings.end(),
                                [](const Finding& finding) { return finding.is_own_way; });
  if (own != report.findings.end()) {
    warn(file + ": not written: the mission itself fails, which no return cures (" +
         items_of(*own) + ": " + own->violation.message + "): cure it first (--fix)");
    return;
  }
  const bool by_rally = std::filesystem::path(file).extension() == ".plan";
  std::string words;
  busy("curing the returns", [&] {
    if (const auto markers = by_rally
                                 ? host::markers_that_cure(plan.plan, mission, world, plan.gate)
                                 : std::nullopt) {
      host::write_file(file, host::with_added_markers(text, *markers));
      for (const host::AddedMarker& marker : *markers) {
        words = (marker.command == 188 ? "a return path (188)" : "a landing start (189)") +
                std::string(" before ") + marker.before + (words.empty() ? "" : ", " + words);
      }
    } else if (by_rally) {
      if (const auto cured = host::with_rally_cure(plan.plan, mission, world, plan.gate)) {
        host::write_file(file, host::with_rally_points(text, cured->rally));
        const std::size_t added = cured->rally.size() - mission.rally.size();
        words = std::to_string(added) + (added == 1 ? " rally point" : " rally points") +
                (cured->rally.size() > added ? " more" : "");
      }
    } else if (const auto cure = host::cure_of_returns(plan.plan, mission, world, plan.gate)) {
      host::write_file(file, cure->parameter + "," + fixed(cure->value, 0) + "\n");
      words = cure->parameter + " " + fixed(cure->value, 0);
    }
    return 0;
  });
  if (words.empty()) {
    warn(file + ": not written: found no " + (by_rally ? "rally points" : "return height") +
         " with which the mission and its returns pass");
  } else if (!plan.json) {
    const std::string passes =
        report.returns->unjudged.empty() ? "passes" : "leaves no return refused of those judged";
    std::printf("fixed: %s %s: %s\n", file.c_str(), passes.c_str(), words.c_str());
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
    if (nearest > kFar && layer.environment->ground() == nullptr) {
      report.notes.insert(report.notes.begin(), layer.id +
                                                    ": nothing is closed within 50 km of the "
                                                    "route: of another region, or of other hours?");
    }
  }
}

/// Throws Error if what is to be written cannot be, or is read, or written twice.
void expect_outputs(const PlanCheck& plan, const std::vector<std::filesystem::path>& read) {
  std::vector<std::string> others{plan.plan};
  others.insert(others.end(), plan.airspace.begin(), plan.airspace.end());
  const std::vector<std::string> models = models_of(plan);
  others.insert(others.end(), models.begin(), models.end());
  for (const auto& file : {plan.scenario, plan.parameters, plan.ditch}) {
    others.insert(others.end(), file.value_or(plan.plan));
  }
  for (const std::filesystem::path& file : read) {
    others.push_back(file.string());
  }
  for (const auto& [file, option] : {std::pair(&plan.certificate, "--certificate"),
                                     {&plan.junit, "--junit"},
                                     {&plan.fixed, "--fix"},
                                     {&plan.fixed_returns, "--fix-returns"}}) {
    if (*file) {
      expect_writable(*file, option);
      expect_apart(*file, option, others);
      others.push_back(std::filesystem::absolute(**file).lexically_normal().string());
      expect_apart(others.back(), option, {others.begin(), others.end() - 1});
    }
  }
}

/// Throws Error where what cures the returns cannot be written so.
void expect_kind_of_cure(const PlanCheck& plan) {
  const std::filesystem::path file(plan.fixed_returns.value_or("cure.param"));
  const std::string ending = file.extension().string();
  if (ending != ".plan" && !ending.starts_with(".par")) {
    throw Error("--fix-returns " + file.string() +
                ": expected a name that ends in .param, for a return height, or in .plan, for the "
                "mission with rally points");
  }
  if (ending == ".plan" && std::filesystem::path(plan.plan).extension() != ".plan") {
    throw Error("--fix-returns " + file.string() + ": rally points are added to a .plan, found " +
                plan.plan);
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
  for (const std::string& file : plan.terrain) {
    expect("--terrain", file);
  }
  if (plan.parameters) {
    expect("--params", *plan.parameters);
  }
  for (const std::string& file : plan.airspace) {
    expect("--airspace", file);
  }
  if (plan.ditch) {
    expect("--ditch", *plan.ditch);
  }
}

Finding not_judged(const char* rule, std::string message) {
  Finding finding;
  finding.violation.constraint = rule;
  finding.violation.message = std::move(message);
  finding.items = {"the mission"};
  finding.is_unjudged = true;
  return finding;
}

/// What of the file and of its scenario the world does not show.
void add_not_judged(PlanReport& report, const PlanCheck& plan, const JudgedPlan& judged) {
  constexpr std::size_t kNamed = 5;
  if (const auto names = zones_not_judged(plan, judged.mission); !names.empty()) {
    report.findings.push_back(not_judged(
        "zones",
        "whether the file's own polygons are closed is not said: " + host::listed(names, kNamed) +
            ": if they are, give the file as --airspace too, else take them out"));
  }
}

/// The world that the options describe in a part of the flight's time; none without zones with
/// hours.
host::WorldDuring world_during(const PlanCheck& plan, const formats::MissionFile& mission,
                               const host::Overrides& overrides) {
  if (!plan.start_time || plan.airspace.empty()) {
    return {};
  }
  if (mission.format == formats::MissionFile::Format::other && !plan.gate.drawn_mps) {
    throw Error(plan.plan + ": its own speeds and times are not read: give --speed M/S, at which " +
                "it meets zones with hours, or no --start-time: all of them are closed then");
  }
  const double start_s = formats::parse_iso_time(*plan.start_time).value();
  return [plan, mission, overrides, start_s](double from_s, double until_s) {
    PlanCheck during = plan;
    during.start_time = formats::iso_time(start_s + from_s);
    during.flown_s = until_s - from_s;
    return host::build_mission(world_of(during, mission, overrides), 1);
  };
}

PlanCheck prepared(PlanCheck plan) {
  plan.gate.own_ends = !plan.scenario;
  if (plan.battery_wh) {
    plan.gate.battery = plan.battery;
    plan.gate.battery->capacity_wh = *plan.battery_wh;
    plan.gate.battery->least_w = plan.battery.power_w;
  }
  if (plan.glide) {
    plan.gate.glide = {*plan.glide, {}};
    if (plan.ditch) {
      plan.gate.glide->sites = host::read_glide_sites(*plan.ditch);
    }
  }
  if (plan.parameters) {
    plan.gate.flight.parameters = host::read_parameters(*plan.parameters);
    if (!host::decide_a_flight(plan.gate.flight.parameters)) {
      warn(*plan.parameters +
           ": none of its parameters decides how a mission is flown: are their names right?");
    }
  }
  return plan;
}

/// Who flies a mission of a format that does not say it, where the scenario does.
void take_vehicle(host::GateOptions& options, host::VehicleType type,
                  const formats::MissionFile& mission) {
  using formats::Airframe;
  if (!options.airframe && !mission.commands.empty() &&
      mission.format != formats::MissionFile::Format::qgc_plan &&
      type != host::VehicleType::by_wing) {
    options.airframe = type == host::VehicleType::copter  ? Airframe::copter
                       : type == host::VehicleType::plane ? Airframe::plane
                                                          : Airframe::vtol;
  }
}

JudgedPlan judge(PlanCheck& plan, const std::string& text,
                 const std::optional<host::Config>& scenario, const host::Overrides& overrides) {
  JudgedPlan judged{host::read_mission_file(plan.plan, text), {}, {}};
  if (plan.above_ground_m) {
    host::put_above_ground(plan.plan, judged.mission, *plan.above_ground_m);
  }
  host::expect_route(plan.plan, judged.mission);
  if (scenario) {
    take_vehicle(plan.gate, scenario->scenario.vehicle.type, judged.mission);
  }
  plan.gate.world_during = world_during(plan, judged.mission, overrides);
  judged.world = busy("building the world", [&] {
    return host::build_mission(scenario ? *scenario : world_of(plan, judged.mission, overrides), 1);
  });
  plan.gate.flight.wind_mps =
      std::max(plan.gate.flight.wind_mps, judged.world.request.wind.max_speed());
  if (scenario) {
    host::take_changes(*scenario, judged.world, plan.gate);
  }
  host::take_battery(judged.world.request.vehicle, judged.mission, plan.gate);
  judged.report = busy("judging the mission", [&] {
    return host::judge_plan(plan.plan, judged.mission, judged.world, plan.gate);
  });
  add_not_judged(judged.report, plan, judged);
  if (plan.returns) {
    judged.report.returns = busy("judging the returns", [&] {
      return host::judge_returns(judged.mission, judged.world, plan.gate);
    });
  }
  if (plan.gate.glide) {
    judged.report.returns->glide = busy("judging the glides", [&] {
      return host::judge_glide(judged.mission, judged.world, plan.gate);
    });
  }
  add_notes(judged.report, judged.world);
  judged.gate = plan.gate;
  return judged;
}

int check(PlanCheck plan, const std::optional<host::Config>& scenario,
          const host::Overrides& overrides) {
  const std::string text = formats::read_file(plan.plan);
  if (plan.fixed) {  // refuses other formats
    static_cast<void>(
        host::changed_plan(text, host::read_mission_file(plan.plan, text).format, {}));
  }
  JudgedPlan judged = judge(plan, text, scenario, overrides);
  auto& [mission, world, report, gate] = judged;
  if (const std::string words = left_out(plan); !words.empty()) {
    report.notes.insert(report.notes.begin(), words);
  }
  if (plan.certificate) {
    host::write_file(*plan.certificate, busy("writing the certificate", [&] {
      return certificate(judged.report, judged.world,
                         basis_of(plan, judged.mission, judged.report));
    }));
  }
  if (plan.junit) {
    host::write_file(*plan.junit, junit(report));
  }
  plan.json ? void(std::cout << host::file_text(plan_json(report, world)))
            : print_plan(report, world);
  if (plan.fixed) {
    fix(plan, report, text, mission, world);
  }
  if (plan.fixed_returns) {
    fix_returns(plan, report, text, mission, world);
  }
  return report.passed() ? kDone : kNoRoute;
}

}  // namespace

std::vector<std::string> JudgedPlan::findings() const {
  std::vector<std::string> lines;
  for (const Finding& finding : report.findings) {
    lines.push_back(items_of(finding) + ": " + finding.violation.message);
  }
  return lines;
}

std::string JudgedPlan::verdict() const {
  return std::string(word_of(report.verdict())) + ": " + figures_of(report);
}

Vec3 JudgedPlan::in_frame(const Vec3& p, const Frame& page) const {
  const Frame& own = world.truth.frame();
  if (&own == &page) {
    return p;
  }
  const auto [lon, lat] = own.to_lonlat(p.x(), p.y());
  const auto [x, y] = page.to_local(lon, lat);
  return {x, y, p.z()};
}

std::vector<PlacedItem> JudgedPlan::items(const Frame& page) const {
  const host::ImportedRoute& drawn = report.imported;
  std::vector<PlacedItem> all;
  for (const formats::MissionItem& item : mission.items) {
    const auto in_line =
        std::find_if(drawn.items.begin(), drawn.items.end(),
                     [&](const formats::MissionItem& one) { return one.place == item.place; });
    const auto n = std::size_t(in_line - drawn.items.begin());
    Vec3 at;
    if (n < std::min(drawn.items.size(), drawn.route.size())) {
      at = drawn.route[n];
    } else {
      at = host::to_local(item.at, mission.home, world.truth);
      at.z() = std::max(at.z(), world.truth.ground(at.x(), at.y()).value_or(at.z()));
    }
    all.push_back({item.place, report.name_of_item(item.place), item.number, in_frame(at, page)});
  }
  return all;
}

host::JudgedLine JudgedPlan::line(const Frame& page) const {
  host::JudgedLine shown;
  shown.file = report.file;
  shown.verdict = verdict();
  shown.status =
      report.verdict() == host::Verdict::pass ? host::RunStatus::solved : host::RunStatus::rejected;
  // What is refused at upload flies nowhere: as it is drawn.
  shown.line = report.line.empty() ? report.imported.route : Route(report.line);
  if (&page != &world.truth.frame()) {
    Polyline moved;
    for (const Vec3& point : shown.line) {
      moved.push_back(in_frame(point, page));
    }
    shown.line = Route(std::move(moved));
  }
  shown.measures = report.measures;
  if (report.energy) {
    shown.notes.push_back("energy: " + report.energy->in_words());
  }
  if (report.returns) {
    const std::vector<std::string> lines = lines_of_returns(report);
    shown.notes.insert(shown.notes.end(), lines.begin(), lines.end());
  }
  shown.notes.insert(shown.notes.end(), report.notes.begin(), report.notes.end());
  const std::vector<std::string> sentences = findings();
  for (std::size_t n = 0; n < sentences.size(); ++n) {
    Violation violation = report.findings[n].violation;
    violation.message = sentences[n];
    violation.at = 0;
    if (const std::optional<Vec3>& found = report.findings[n].at) {
      const Vec3 at = in_frame(*found, page);
      const auto nearest =
          std::min_element(shown.line.begin(), shown.line.end(), [&](const Vec3& a, const Vec3& b) {
            return (a - at).squaredNorm() < (b - at).squaredNorm();
          });
      violation.at = std::size_t(nearest - shown.line.begin());
    }
    shown.check.violations.push_back(std::move(violation));
  }
  return shown;
}

JudgedPlan judged_plan(const PlanCheck& given, const host::Overrides& overrides,
                       const std::optional<std::string>& text) {
  expect_files(given);
  PlanCheck plan = prepared(given);
  std::optional<host::Config> scenario;
  if (plan.scenario) {
    scenario = host::load_scenario(*plan.scenario, overrides);
  }
  return judge(plan, text ? *text : formats::read_file(plan.plan), scenario, overrides);
}

int check_plan(const PlanCheck& given, const host::Overrides& overrides) {
  expect_files(given);
  PlanCheck plan = prepared(given);
  std::optional<host::Config> scenario;
  if (plan.scenario) {
    scenario = host::load_scenario(*plan.scenario, overrides);
  }
  expect_kind_of_cure(plan);
  expect_outputs(plan, scenario ? scenario->files : decltype(scenario->files){});
  try {
    return check(plan, scenario, overrides);
  } catch (const Error& error) {
    const std::string message = about_file(error);
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
