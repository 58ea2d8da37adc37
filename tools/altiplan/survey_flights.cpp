// SPDX-License-Identifier: Apache-2.0
#include "survey_flights.hpp"

#include <cmath>
#include <set>

#include "check_survey.hpp"
#include "host/base/output_file.hpp"
#include "host/base/words.hpp"
#include "host/import_export/plan.hpp"
#include "progress.hpp"
#include "route_export.hpp"

namespace altiplan::cli {
namespace {

namespace fs = std::filesystem;

/// Shares of the tolerance of scale that are tried for the drawn route: the less of it, the more is
/// left for how it is flown beside steep ground, and the more waypoints there are.
constexpr double kDrawn[] = {0.6, 0.3, 0.1};
/// Of an aeroplane the rest is for how it lags behind where it climbs: so many seconds of the
/// climb, by ArduPilot's defaults. The gentler it climbs, the less can it follow the ground.
struct WingTry {
  double drawn;
  bool is_gentle;
};
constexpr WingTry kWingTries[] = {{0.5, true},  {0.7, true},  {0.3, true},
                                  {0.5, false}, {0.7, false}, {0.3, false}};
constexpr double kWingLag = 5.4;
constexpr const char* kScale = "scale";  ///< the rule that photos break

/// The part of a pass that is photographed: without the leads of an aeroplane's row, its first and
/// its last leg where they lie beyond the areas.
Polyline photographed(Polyline pass, const host::FirstRoute& first) {
  const auto leads = [&](const Vec3& end) {
    return first.beyond_m() > 0 && pass.size() > 2 &&
           std::none_of(first.areas().begin(), first.areas().end(),
                        [&](const formats::Polygon& area) {
                          return host::ring_holds(area.outline, end.head<2>());
                        });
  };
  if (leads(pass.front())) {
    pass.erase(pass.begin());
  }
  if (leads(pass.back())) {
    pass.pop_back();
  }
  return pass;
}

/// Cuts the accepted route, along which the judge has found the passes, where they take off.
std::vector<Flight> flights_of(const host::RunResult& result, const host::FirstRoute& first) {
  const Route& route = result.steps[*result.accepted].route;
  std::vector<Flight> flights(1);
  std::size_t at = 0;
  std::size_t begun = 0;
  for (const Pass& pass : result.task->passes) {
    const Polyline& points = pass.points;
    while (!std::equal(
        points.begin(), points.end(), route.begin() + std::ptrdiff_t(at),
        [](const Vec3& p, const Vec3& q) { return (p - q).norm() <= kLengthTolerance; })) {
      ++at;
    }
    if (pass.takes_off && at > begun) {
      flights.back().route = route.part(begun, at);
      flights.emplace_back();
      begun = at;
    }
    if (points.size() > 1) {
      flights.back().lines.push_back(photographed(points, first));
    }
    at += points.size() - 1;
  }
  flights.back().route = route.part(begun, route.size() - 1);
  return flights;
}

/// Writes each flight with its photos, and sees what these show; false where one cannot be written.
bool write_plans(const fs::path& folder, const SurveyArguments& arguments,
                 const host::FirstRoute& first, Surveyed& surveyed) {
  RouteExport route;
  route.result = folder / "result.json";
  route.overrides = arguments.overrides;
  route.options.format = &host::format_named("qgc-plan");
  const bool is_wing = arguments.wish.turn_radius_m.has_value();
  route.options.takeoff = route.options.land = !is_wing;
  route.options.circles_at_end = is_wing;
  finish_options(route);
  std::optional<LoadedRoute> source = loaded(route, std::nullopt);
  std::vector<Flight> flights = flights_of(surveyed.result, first);
  const host::SurveyLines& lines = first.lines();
  if (source && !is_wing) {  // which flies at its own speed
    route.options.commanded_mps = source->mission.request.vehicle.speed_mps;
  }
  for (std::size_t i = 0; source && i < flights.size(); ++i) {
    Flight& flight = flights[i];
    flight.file = flights.size() == 1 ? "route.plan" : "route-" + std::to_string(i + 1) + ".plan";
    source->source.route = flight.route;
    source->mission.request.start.position = flight.route.front();
    source->mission.request.goal.position = flight.route.back();
    const std::optional<host::Exported> written = exported(*source, route);
    if (!written) {
      return false;
    }
    host::CameraLines camera{flight.lines, lines.trigger_m};
    if (is_wing) {
      constexpr double kTurnsWithin = 15;
      camera.within_m = kTurnsWithin;
    }
    const std::string plan = host::plan_text(host::plan_of(written->mission, camera));
    host::write_file(
        folder / flight.file,
        first.areas().empty() ? plan : with_survey(plan, first, source->mission.truth.frame()));
  }
  surveyed.flights = std::move(flights);
  surveyed.shown =
      host::share_shown(first.areas(), photo_lines(first, surveyed.lines()), source->mission.truth);
  return true;
}

/// Heights above ground on the ways between items, of an aeroplane on those that it photographs,
/// where the scale is one more limit of its report.
void find_heights(Flight& flight, const host::FirstRoute& first, bool is_wing) {
  host::PlanReport& report = flight.report;
  std::set<std::string> photographed;
  bool is_on = false;
  for (std::size_t n = 0; n < report.commands.size(); ++n) {
    const formats::MissionCommand& command = report.commands[n];
    if (command.number == host::Command::kCameraTrigger) {
      is_on = command.params[0] > 0;
    } else if (is_on && command.has_position()) {
      photographed.insert(report.name_of(n));
    }
  }
  std::set<std::string> unknown = photographed;
  for (const host::ReportedPart& part : report.parts) {
    const bool is_way = part.what.empty() && part.items.size() > 1;
    if (is_way && (!is_wing || photographed.count(part.items.back()) > 0)) {
      flight.heights.lowest = std::min(flight.heights.lowest, part.heights.lowest);
      flight.heights.highest = std::max(flight.heights.highest, part.heights.highest);
      unknown.erase(part.items.back());
    }
  }
  const host::SurveyLines& lines = first.lines();
  const double low = lines.above_ground_m - lines.off_m;
  const double high = lines.above_ground_m + lines.off_m;
  host::Finding finding;
  finding.violation.constraint = kScale;
  if (is_wing && !unknown.empty()) {
    finding.items = {*unknown.begin()};
    finding.violation.message = "the scale of photos on the way to it is not judged";
    finding.is_unjudged = true;
    report.findings.push_back(std::move(finding));
  } else if (is_wing && !(flight.heights.lowest >= low && flight.heights.highest <= high)) {
    finding.items = {"the survey"};
    finding.violation.message = "photos are taken from " + fixed(flight.heights.lowest, 1) +
                                " to " + fixed(flight.heights.highest, 1) +
                                " m above ground, not within " + fixed(low, 1) + " to " +
                                fixed(high, 1) + " m";
    report.findings.push_back(std::move(finding));
  }
}

/// True where a route that is nearer to the height of the photos may pass.
bool may_be_nearer(const Surveyed& surveyed) {
  bool is_off = false;
  for (const Flight& flight : surveyed.flights) {
    for (const host::Finding& finding : flight.report.findings) {
      const std::string& broken = finding.violation.constraint;
      if (broken == kScale || broken == "altitude" || broken == "ground_clearance") {
        is_off = true;
      } else if (broken != "energy") {
        return false;
      }
    }
  }
  return is_off;
}

/// What a flight may take, seconds.
double longest_flight(const SurveyArguments& arguments) {
  return arguments.flight_minutes ? 60 * *arguments.flight_minutes : kInfinity;
}

std::optional<host::Battery> battery_of(const SurveyArguments& arguments) {
  const host::RouteWish& wish = arguments.wish;
  return wish.battery_wh ? std::optional(host::Battery{*wish.battery_wh, wish.reserve,
                                                       *wish.power_w, *wish.power_w})
                         : std::nullopt;
}

/// The share of what it may that a flight takes of time or energy.
double use_of(const SurveyArguments& arguments, const host::PlanReport& report) {
  const double energy =
      report.energy ? report.energy->max_wh / report.energy->battery.usable_wh() : 0;
  return std::max(report.time.max_s / longest_flight(arguments), energy);
}

/// Seconds of level flight, as the task counts them, after which the flights that took too much
/// would have to be back; none did: infinite.
double affordable(const SurveyArguments& arguments, const Surveyed& surveyed) {
  constexpr double kShorter = 0.98;  // take-off and landing take as long in a shorter flight
  double seconds = kInfinity;
  for (const Flight& flight : surveyed.flights) {
    const double use = use_of(arguments, flight.report);
    double level_m = 0;
    for (std::size_t i = 1; i < flight.route.size(); ++i) {
      level_m += (flight.route[i] - flight.route[i - 1]).head<2>().norm();
    }
    if (use > 1 && use < kInfinity) {
      seconds = std::min(seconds, kShorter * level_m / surveyed.result.vehicle.speed_mps / use);
    }
  }
  return seconds;
}

Surveyed fly(const SurveyArguments& arguments, const host::FirstRoute& first,
             const fs::path& folder, Interrupt& interrupt) {
  Surveyed surveyed;
  const host::FirstFiles files = first.files(0, folder);
  surveyed.choices = files.choices;
  surveyed.zone_layers = files.zone_layers;
  surveyed.result = run_in(folder, files, arguments.overrides, interrupt);
  if (!surveyed.result.accepted || interrupt.happened()) {
    return surveyed;
  }
  const Polyline& route = surveyed.result.steps[*surveyed.result.accepted].route.waypoints();
  surveyed.voids = first.over_voids(route);
  if (!write_plans(folder, arguments, first, surveyed)) {
    return surveyed;
  }
  host::GateOptions gate = arguments.gate;
  gate.battery = battery_of(arguments);
  for (Flight& flight : surveyed.flights) {
    flight.report = judged(folder / flight.file, first, arguments.overrides, gate);
    find_heights(flight, first, arguments.wish.turn_radius_m.has_value());
    const double minutes = flight.report.time.max_s / 60;
    if (minutes * 60 > longest_flight(arguments)) {
      surveyed.too_long = flight.file + ": takes up to " + fixed(minutes, 1) +
                          " min, more than --flight-minutes, " +
                          host::with_digits(*arguments.flight_minutes, 4);
    }
  }
  return surveyed;
}

/// One try.
Surveyed tried(const SurveyArguments& arguments, const host::RouteWish& wish,
               const fs::path& folder, std::optional<host::FirstRoute>& first,
               Interrupt& interrupt) {
  first.emplace(wish, arguments.overrides.plugin_path);
  for (const auto& entry : fs::directory_iterator(folder)) {  // plans of the try before
    if (entry.path().extension() == ".plan") {
      fs::remove(entry.path());
    }
  }
  return fly(arguments, *first, folder, interrupt);
}

/// With climbs as gentle as the lag asks for, then with any that the aeroplane can fly.
Surveyed wing_survey_in(const fs::path& folder, const SurveyArguments& arguments,
                        host::RouteWish wish, std::optional<host::FirstRoute>& first,
                        Interrupt& interrupt) {
  const double off_m = host::lines_of(*wish.survey).off_m;
  Surveyed surveyed;
  for (const auto& [drawn, is_gentle] : kWingTries) {
    wish.survey->drawn = drawn;
    wish.climb_mps = arguments.wish.climb_mps;
    if (is_gentle) {
      wish.climb_mps = std::min(wish.climb_mps.value_or(kInfinity), (1 - drawn) * off_m / kWingLag);
    }
    surveyed = tried(arguments, wish, folder, first, interrupt);
    if (interrupt.happened() || (!surveyed.flights.empty() && surveyed.passed())) {
      break;
    }
  }
  return surveyed;
}
}  // namespace

Surveyed survey_in(const fs::path& folder, const SurveyArguments& arguments, host::RouteWish wish,
                   std::optional<host::FirstRoute>& first, Interrupt& interrupt) {
  if (wish.turn_radius_m) {
    return wing_survey_in(folder, arguments, std::move(wish), first, interrupt);
  }
  constexpr int kTries = 8;
  std::optional<double>& flight_s = wish.survey->flight_s;
  const std::optional<host::Battery> battery = battery_of(arguments);
  double longest = longest_flight(arguments);
  if (battery) {
    longest = std::min(longest, 3600 * battery->usable_wh() / battery->power_w);
  }
  if (longest < kInfinity && wish.survey->line.empty()) {
    flight_s = longest;
  }
  std::size_t nearer = 0;
  for (int i = 1;; ++i) {
    wish.survey->drawn = kDrawn[nearer];
    Surveyed surveyed = tried(arguments, wish, folder, first, interrupt);
    const double seconds = affordable(arguments, surveyed);
    const bool may_be_shorter = flight_s && seconds < kInfinity;
    if (interrupt.happened() || i == kTries) {
      return surveyed;
    }
    if (may_be_nearer(surveyed) && nearer + 1 < std::size(kDrawn)) {
      ++nearer;
    } else if (!may_be_shorter) {
      return surveyed;
    }
    if (may_be_shorter) {
      flight_s = std::min(*flight_s, seconds);
    }
  }
}
}  // namespace altiplan::cli
