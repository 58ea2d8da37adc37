// SPDX-License-Identifier: Apache-2.0
#include "survey_item.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/formats/input_file.hpp"
#include "altiplan/formats/qgc_survey.hpp"
#include "check_survey.hpp"
#include "host/base/output_file.hpp"
#include "host/import_export/plan.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;
using formats::qgc::SurveyItem;
using formats::qgc::SurveySettings;
using host::Json;

bool is_convex(const formats::Ring& ring) {
  bool turns_left = false;
  bool turns_right = false;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto& [ax, ay] = ring[i];
    const auto& [bx, by] = ring[(i + 1) % ring.size()];
    const auto& [cx, cy] = ring[(i + 2) % ring.size()];
    const double side = (bx - ax) * (cy - by) - (by - ay) * (cx - bx);
    turns_left = turns_left || side > 0;
    turns_right = turns_right || side < 0;
  }
  return !(turns_left && turns_right);
}

/// Why no item can say it; "" if one may.
std::string reason_against(const SurveyArguments& arguments, const host::FirstRoute& first,
                           const Surveyed& surveyed) {
  const std::vector<formats::Polygon>& areas = first.areas();
  return arguments.wish.turn_radius_m        ? "it knows no turns of an aeroplane"
         : areas.size() != 1                 ? "it takes one area alone"
         : !areas.front().holes.empty()      ? "it knows no islands"
         : !is_convex(areas.front().outline) ? "it flies across the corners of a concave area"
         : surveyed.flights.size() != 1      ? "it is one flight"
                                             : "";
}

/// The plan with an item in place of what is flown after take-off and before the way home.
Json plan_with(Json plan, const SurveyItem& item, std::size_t before) {
  Json& items = plan["mission"]["items"];
  const auto is_waypoint = [](const Json& each) {
    return each.at("command") == host::Command::kWaypoint;
  };
  Json ends[] = {*std::find_if(items.rbegin(), items.rend(), is_waypoint), items.back()};
  items.erase(items.begin() + std::ptrdiff_t(before), items.end());
  items.push_back(Json::parse(item.json));
  std::size_t number = before + item.commands;
  for (Json& end : ends) {
    end["doJumpId"] = ++number;
    items.push_back(std::move(end));
  }
  return plan;
}

SurveySettings settings_of(const host::SurveyWish& wish, const host::SurveyLines& lines,
                           const Json& home, const Vehicle& vehicle) {
  SurveySettings settings;
  settings.polygon = formats::without_repeats(wish.areas.front().polygon.outline);
  settings.sensor_mm = wish.camera.sensor_mm;
  settings.image_px = wish.camera.image_px;
  settings.focal_mm = wish.camera.focal_mm;
  settings.min_interval_s = wish.camera.min_interval_s;
  settings.gsd_cm = 100 * wish.gsd_m;
  settings.overlap = wish.overlap;
  settings.sidelap = wish.sidelap;
  settings.spacing_m = lines.spacing_m;
  settings.trigger_m = lines.trigger_m;
  settings.start = {home.at(1).get<double>(), home.at(0).get<double>()};
  if (vehicle.acceleration.takes_time()) {
    settings.stop_m = vehicle.speed_mps * vehicle.speed_mps / vehicle.acceleration.mps2;
  }
  return settings;
}

/// The mean of the greatest and the least height of the photos' lines.
double mean_height(const std::vector<Polyline>& lines) {
  double low = kInfinity;
  double high = -kInfinity;
  for (const Polyline& line : lines) {
    for (const Vec3& p : line) {
      low = std::min(low, p.z());
      high = std::max(high, p.z());
    }
  }
  return (low + high) / 2;
}

/// The item's lines as they are flown, in short pieces over the ground.
std::vector<Polyline> flown_lines(const SurveyItem& item, const World& world,
                                  const SurveySettings& settings, double home_m) {
  constexpr double kPiece = 10;  // metres
  std::vector<Polyline> lines;
  for (const auto& [from, to] : item.lines) {
    const auto [ax, ay] = world.frame().to_local(from[0], from[1]);
    const auto [bx, by] = world.frame().to_local(to[0], to[1]);
    const int pieces = std::max(1, int(std::ceil(std::hypot(bx - ax, by - ay) / kPiece)));
    Polyline& line = lines.emplace_back();
    for (int i = 0; i <= pieces; ++i) {
      const double x = ax + (bx - ax) * i / pieces;
      const double y = ay + (by - ay) * i / pieces;
      const double below = settings.above_ground ? world.ground(x, y).value_or(home_m) : home_m;
      line.emplace_back(x, y, below + settings.height_m);
    }
  }
  return lines;
}

/// Why the plan does not do what the survey does; "" if it does.
std::string judged_against(const host::PlanReport& report, double shown,
                           const SurveyArguments& arguments, const Surveyed& surveyed) {
  constexpr double kAsMuch = 1e-3;
  if (!report.findings.empty()) {
    const host::Finding& first = report.findings.front();
    return first.items.back() + ": " + first.violation.message;
  }
  if (arguments.flight_minutes && report.time.max_s > 60 * *arguments.flight_minutes) {
    return "it takes up to " + fixed(report.time.max_s / 60, 1) + " min";
  }
  if (shown < surveyed.shown - kAsMuch) {
    return "it shows " + fixed(100 * shown, 2) + " % for certain";
  }
  return report.passed() ? "" : "its verdict is " + std::string(word_of(report.verdict()));
}
}  // namespace

std::string write_survey_item(const fs::path& folder, const SurveyArguments& arguments,
                              const host::SurveyWish& wish, const host::FirstRoute& first,
                              const Surveyed& surveyed) {
  const std::string not_written = "no survey.plan, of QGroundControl's survey item: ";
  if (const std::string reason = reason_against(arguments, first, surveyed); !reason.empty()) {
    return not_written + reason;
  }
  const fs::path file = folder / "survey.plan";
  const Json plan = Json::parse(formats::read_file((folder / surveyed.flights[0].file).string()));
  const Json& home = plan.at("mission").at("plannedHomePosition");
  const double home_m = home.at(2).get<double>();
  host::Config config =
      host::load_scenario_text(first.flown_scenario(), "the world of survey", arguments.overrides);
  config.is_only_judged = true;
  const World world = host::build_mission(config, 1).truth;
  SurveySettings settings = settings_of(wish, first.lines(), home, surveyed.result.vehicle);
  constexpr std::size_t kBefore = 2;  // take-off and speed
  std::string reason;
  for (const bool above_ground : {false, true}) {
    settings.above_ground = above_ground;
    settings.height_m =
        above_ground ? first.lines().above_ground_m : mean_height(surveyed.lines()) - home_m;
    const SurveyItem item = formats::qgc::survey_item(settings, int(kBefore) + 1);
    host::write_file(file,
                     with_survey(plan_with(plan, item, kBefore).dump(), first, world.frame()));
    const host::PlanReport report = judged(file, first, arguments.overrides, arguments.gate);
    const std::vector<Polyline> lines = flown_lines(item, world, settings, home_m);
    const double shown = host::share_shown(first.areas(), photo_lines(first, lines), world);
    reason = judged_against(report, shown, arguments, surveyed);
    if (reason.empty()) {
      return "survey.plan: QGroundControl's survey item, " + std::to_string(lines.size()) +
             " lines of its own at one height above " + (above_ground ? "the ground" : "home") +
             ": pass, " + time_in_words(report.time);
    }
  }
  fs::remove(file);
  return not_written + reason;
}
}  // namespace altiplan::cli
