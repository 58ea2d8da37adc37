// SPDX-License-Identifier: Apache-2.0
#include "host/gate/plan_report.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/kit/layers/hours.hpp"
#include "host/base/words.hpp"
#include "host/gate/places.hpp"
#include "host/gate/plan_cures.hpp"
#include "host/gate/task_verdict.hpp"
#include "host/gate/violated_zone.hpp"
#include "host/judge/judge.hpp"
#include "host/result/stored_result.hpp"

namespace altiplan::host {
namespace {

using formats::Autopilot;
using formats::MissionCommand;
using formats::MissionItem;
using formats::Task;

/// A file without commands as one that has them: its points are flown to.
formats::MissionFile with_commands(formats::MissionFile plan) {
  if (plan.commands.empty()) {
    for (const MissionItem& item : plan.items) {
      using formats::AltitudeFrame;
      MissionCommand command;
      command.number = 16;
      command.frame = item.at.frame == AltitudeFrame::sea    ? 0
                      : item.at.frame == AltitudeFrame::home ? 3
                                                             : 10;
      command.lon = item.at.lon;
      command.lat = item.at.lat;
      command.altitude_m = item.at.altitude_m;
      command.place = item.place;
      plan.commands.push_back(std::move(command));
    }
  }
  return plan;
}

constexpr double kDrawnSpeed = 5;  // m/s, where none is given

/// The drawn lines as a flight.
FlownMission as_drawn(const formats::MissionFile& plan, const World& world, double speed_mps) {
  using formats::AltitudeFrame;
  FlownMission drawn;
  std::optional<Vec3> before;
  for (std::size_t n = 0; n < plan.commands.size(); ++n) {
    const MissionCommand& command = plan.commands[n];
    // Without ground, for an estimate of time, its heights do not count.
    const AltitudeFrame frame = command.frame == 3                          ? AltitudeFrame::home
                                : command.frame == 0 || !world.has_ground() ? AltitudeFrame::sea
                                                                            : AltitudeFrame::ground;
    Vec3 here;
    try {
      here = to_local({command.lon, command.lat, command.altitude_m, frame}, plan.home, world);
    } catch (const Error& error) {
      throw Error(command.place + ": " + error.what());
    }
    if (before || plan.commands.size() == 1) {
      const Vec3 from = before.value_or(here);
      FlownPart part;
      part.command = n;
      part.before = n > 0 ? n - 1 : 0;
      part.what = before ? "" : "the only position";
      if (!before) {
        drawn.remarks.push_back({Remark::Weight::not_judged, "not_judged", n,
                                 "one position is no route: how it is flown to is not judged"});
      }
      part.strips.push_back({from, here, from.z(), here.z(), 0});
      part.begin_s = drawn.time.min_s;
      const double seconds = (here - from).norm() / speed_mps;
      drawn.time += {seconds, seconds};
      part.time = drawn.time;
      part.speed_mps = speed_mps;
      drawn.parts.push_back(std::move(part));
    }
    before = here;
  }
  return drawn;
}

std::vector<std::string> items_of(const FlownPart& part, const PlanReport& report) {
  if (part.what.empty() && part.before != part.command) {
    return {report.name_of(part.before), report.name_of(part.command)};
  }
  return {report.name_of(part.command)};
}

Request judged_in(const Mission& world) {
  Request request = world.request;
  request.world = std::make_shared<const World>(world.truth);
  return request;
}

/// What may fly a mission, and what judges it.
class Gate {
 public:
  Gate(const formats::MissionFile& plan, const Mission& world, const GateOptions& options)
      : plan_(with_commands(plan)),
        mission_(world),
        world_(world.truth),
        request_(world.request),
        options_(options),
        judge_(judged_in(world)),
        names_(world_),
        is_drawn_(plan.commands.empty() && !options.firmware && !options.airframe) {
    request_.world = std::make_shared<const World>(world.truth);
    if (!is_drawn_) {
      autopilots_ =
          possible_autopilots(plan, options.firmware, options.airframe, options.flight.parameters);
    }
  }

  void judge(PlanReport& report) {
    report.commands = plan_.commands;
    report.autopilots = autopilots_;
    const std::vector<FlownMission> all = flights();
    for (const FlownMission& flown : all) {
      add_parts(report, flown);
      add_remarks(report, flown);
      report.parameters.insert(report.parameters.end(), flown.parameters.begin(),
                               flown.parameters.end());
    }
    if (mission_.task && !options_.own_ends) {
      add_task(report, all);
    }
    report.line = flown_line(all.front());
    report.time = time_of(all);
    add_times(report, all);
    if (!height_of_home(plan_, world_)) {  // else all else comes of that
      cures().add_to(report, ways_, all);
    }
    note_autopilots(report);
    note_fence(report);
  }

  std::vector<FlownMission> flights() const { return flights(plan_); }

  std::optional<formats::MissionFile> cured() { return cures().cured(); }

 private:
  std::vector<FlownMission> flights(const formats::MissionFile& plan) const {
    if (is_drawn_) {
      return {as_drawn(plan, world_, options_.drawn_mps.value_or(kDrawnSpeed))};
    }
    std::vector<FlownMission> all;
    for (const Autopilot autopilot : autopilots_) {
      all.push_back(fly_mission(plan, autopilot, world_, options_.flight));
    }
    return all;
  }

  PlanCures cures() const {
    return {plan_,           world_,
            options_.flight, autopilots_,
            judge_,          [this](const formats::MissionFile& plan) { return flights(plan); }};
  }

  /// "ArduPilot plane: " where several may fly it.
  std::string prefix(const FlownMission& flown) const {
    return autopilots_.size() > 1 ? flown.autopilot.name() + ": " : "";
  }

  int number_of(std::size_t command) const { return plan_.commands[command].item; }

  /// In the world of all hours of the flight, and if it is violated there in that of its own.
  std::vector<BandJudge::Found> violations_of(const FlownPart& part) const {
    std::vector<BandJudge::Found> found = judge_.violations(part);
    const bool depends = std::any_of(found.begin(), found.end(), [&](const BandJudge::Found& one) {
      return !one.violation.layer.empty() && !is_ground_layer(one.violation.layer, world_);
    });
    if (options_.world_during && depends) {
      const Mission world =
          options_.world_during(part.begin_s, std::max(part.time.max_s, part.until_s));
      found = BandJudge(judged_in(world)).violations(part);
    }
    return found;
  }

  void add_parts(PlanReport& report, const FlownMission& flown) {
    const bool is_first = report.parts.empty();
    for (const FlownPart& part : flown.parts) {
      const std::vector<BandJudge::Found> found = violations_of(part);
      ReportedPart reported{
          items_of(part, report), part.what, {}, 0, judge_.heights(part), part.time,
          !found.empty()};
      for (const Strip& strip : part.strips) {
        reported.length_m = std::max(reported.length_m, (strip.to - strip.from).norm());
        reported.end = strip.to;
      }
      if (part.ground == FlownPart::Ground::kept_off) {
        report.lowest_m = std::min(report.lowest_m, reported.heights.lowest);
      }
      for (const BandJudge::Found& one : found) {
        add_violation(report, flown, part, one);
      }
      if (is_first) {
        report.parts.push_back(std::move(reported));
      }
    }
  }

  /// Of each drawn point: from the earliest to the latest of the flights, when its command is done
  /// for the first time, and its circle begun; and the greatest speed on the way to it.
  void add_times(PlanReport& report, const std::vector<FlownMission>& all) const {
    const std::vector<MissionItem>& items = report.imported.items;
    for (std::size_t n = 0; n < items.size(); ++n) {
      const bool begins_circle = n + 1 < items.size() && items[n + 1].place == items[n].place;
      const bool ends_circle = n > 0 && items[n - 1].place == items[n].place;
      TimeSpan left{kInfinity, 0};
      double speed_mps = 0;
      for (const FlownMission& flown : all) {
        const auto is_of = [&](const FlownPart& part) {
          return plan_.commands[part.command].place == items[n].place;
        };
        const auto first = std::find_if(flown.parts.begin(), flown.parts.end(), is_of);
        const auto last = std::find_if_not(first, flown.parts.end(), is_of);
        const auto circle = std::find_if(
            first, last, [](const FlownPart& part) { return part.what == "its circle"; });
        const auto end = begins_circle && circle != first ? circle : last;
        const TimeSpan time = first == end ? TimeSpan{} : std::prev(end)->time;
        left = {std::min(left.min_s, time.min_s), std::max(left.max_s, time.max_s)};
        for (auto part = ends_circle ? circle : first; part != end; ++part) {
          speed_mps = std::max(speed_mps, part->speed_mps);
        }
      }
      report.times.push_back(left);
      report.speeds_mps.push_back(speed_mps);
    }
  }

  void add_violation(PlanReport& report, const FlownMission& flown, const FlownPart& part,
                     const BandJudge::Found& found) {
    Finding finding;
    finding.violation = found.violation;
    finding.violation.at = part.before;
    finding.items = items_of(part, report);
    finding.what = part.what;
    finding.item = number_of(part.command);
    finding.at = found.at;
    finding.is_own_way = !part.is_return;
    names_.add_to(finding);
    name_void(finding, world_);
    if (!part.what.empty()) {
      finding.violation.message = part.what + ": " + finding.violation.message;
    }
    finding.violation.message = prefix(flown) + finding.violation.message;
    for (Finding& other : report.findings) {
      const bool is_same = other.items == finding.items && other.what == finding.what &&
                           other.violation.constraint == finding.violation.constraint &&
                           other.violation.layer == finding.violation.layer;
      if (is_same) {
        const auto badness = [](const Violation& v) { return std::abs(v.value - v.limit); };
        if (badness(finding.violation) > badness(other.violation)) {
          other = std::move(finding);
        }
        return;
      }
      // A way into the ground is said once.
      if (other.items == finding.items && other.what == finding.what &&
          other.violation.constraint == "ground_clearance" && other.violation.value < 0 &&
          is_ground_layer(finding.violation.layer, world_)) {
        return;
      }
    }
    report.findings.push_back(std::move(finding));
    ways_.resize(report.findings.size());
    ways_.back() = PlanCures::Way{part.before, part.command, part.is_return};
  }

  void add_remarks(PlanReport& report, const FlownMission& flown) {
    for (const Remark& remark : flown.remarks) {
      const std::string name = report.name_of(remark.command);
      if (remark.weight == Remark::Weight::note) {
        const std::string note = prefix(flown) + name + ": " + remark.message;
        if (std::find(report.notes.begin(), report.notes.end(), note) == report.notes.end()) {
          report.notes.push_back(note);
        }
        continue;
      }
      Finding finding;
      finding.violation.constraint = remark.rule;
      finding.violation.value = remark.value;
      finding.violation.limit = remark.limit;
      finding.violation.message = prefix(flown) + remark.message;
      finding.items = {name};
      finding.item = number_of(remark.command);
      finding.is_unjudged = remark.weight == Remark::Weight::not_judged;
      report.findings.push_back(std::move(finding));
    }
    ways_.resize(report.findings.size());
  }

  void add_task(PlanReport& report, const std::vector<FlownMission>& all) {
    if (auto finding = undone(mission_, plan_, all)) {
      report.findings.push_back(std::move(*finding));
      ways_.resize(report.findings.size());
    } else {
      report.notes.emplace_back(
          "the task is judged by places, lines and stops, not by photos (check --survey)");
    }
  }

  /// A fence is judged, but it protects nobody where it is not in force.
  void note_fence(PlanReport& report) const {
    if (plan_.zones.empty() || is_drawn_) {
      return;
    }
    for (const Autopilot autopilot : autopilots_) {
      if (!autopilot.is_px4() &&
          Parameters(autopilot, options_.flight.parameters)("FENCE_ENABLE") == 0) {
        report.notes.emplace_back(
            "the mission's fence is not in force in flight (FENCE_ENABLE 0): it is judged all the "
            "same");
        return;
      }
    }
  }

  void note_autopilots(PlanReport& report) const {
    if (is_drawn_) {
      report.notes.emplace_back(
          "judged as drawn: the file holds no commands, and no autopilot is named (--autopilot, "
          "--vehicle)");
    } else if (autopilots_.size() > 1) {
      std::string names;
      for (const Autopilot autopilot : autopilots_) {
        names += (names.empty() ? "" : ", ") + autopilot.name();
      }
      report.notes.push_back("judged as each of these may fly it: " + names +
                             ": the file does not say which (--autopilot, --vehicle)");
    }
  }

  formats::MissionFile plan_;
  const Mission& mission_;
  const World& world_;
  Request request_;
  const GateOptions& options_;
  BandJudge judge_;
  ZoneNames names_;
  bool is_drawn_;
  std::vector<Autopilot> autopilots_;
  std::vector<std::optional<PlanCures::Way>> ways_;  ///< of each finding, if it is of one
};

/// The mission as it is drawn: without a landing, which is flown to at the height of the item
/// before; for a scenario's task without those on the way, either.
formats::MissionFile without_landing(formats::MissionFile plan, bool on_the_way) {
  plan.route_problem.clear();  // the commands are judged
  auto& items = plan.items;
  while (items.size() > 1 && items.back().kind == MissionItem::Kind::land) {
    items.pop_back();
  }
  if (on_the_way) {
    std::erase_if(items,
                  [](const MissionItem& item) { return item.kind == MissionItem::Kind::land; });
  }
  return plan;
}

/// Metres along the route, of which the frame makes more or less.
double length_on_ground(const Route& route, const Frame& frame) {
  double length = 0;
  for (std::size_t n = 0; n < route.leg_count(); ++n) {
    const Leg leg = route.leg(n);
    const Vec3 across = leg.to - leg.from;
    const double flat = across.head<2>().norm();
    double scale = 1;
    if (frame.has_position() && flat > 1) {
      scale = geodesic_course(frame.to_lonlat(leg.from.x(), leg.from.y()),
                              frame.to_lonlat(leg.to.x(), leg.to.y()))
                  .metres /
              flat;
    }
    length += leg.turns() ? leg.length() * scale : std::hypot(flat * scale, across.z());
  }
  return length;
}

/// What a scenario demands of the whole route: its ends, its turns, its length.
void add_route_violations(PlanReport& report, const Mission& world, const Request& request) {
  const Route& route = report.imported.route;
  ZoneNames names(*request.world);
  for (const Violation& violation : judge(route, request, world.via, world.runways).violations) {
    const bool is_known = std::any_of(
        report.findings.begin(), report.findings.end(),
        [&](const Finding& other) { return other.violation.constraint == violation.constraint; });
    if (is_known) {
      continue;
    }
    Finding finding;
    finding.violation = violation;
    finding.items = {report.name_of_point(violation.at)};
    finding.at = violation.at < route.size() ? std::optional(route[violation.at]) : std::nullopt;
    finding.is_own_way = true;
    if (violation.at < route.leg_count()) {
      finding.items.push_back(report.name_of_point(violation.at + 1));
    }
    names.add_to(finding);
    report.findings.push_back(std::move(finding));
  }
}

/// When the slowest flight ends, or has come to a circle at home that nothing ends: what follows is
/// the pilot's.
double flown_until_s(const PlanReport& report) {
  double until_s = 0;
  for (const ReportedPart& part : report.parts) {
    const bool circles = part.what == "the circle at home" && !std::isfinite(part.time.max_s);
    until_s = std::max(until_s, circles ? 0 : part.time.max_s);
  }
  const bool is_known = report.autopilots.size() == 1 && !report.parts.empty();
  return is_known ? std::min(until_s, report.time.max_s) : report.time.max_s;
}

void add_energy(PlanReport& report, const formats::MissionFile& plan, const World& world,
                const Battery& battery) {
  constexpr double kSecondsPerHour = 3600;
  EnergyUse use;
  use.battery = battery;
  use.min_wh = report.time.min_s * battery.least_w / kSecondsPerHour;
  const double until_s = flown_until_s(report);
  use.max_wh = until_s * battery.power_w / kSecondsPerHour;
  use.circles_at_home = until_s < report.time.max_s;
  Vec3 home = report.line.empty() ? Vec3::Zero() : report.line.front();
  if (plan.home && world.frame().has_position()) {
    const auto [x, y] = world.frame().to_local(plan.home->lon, plan.home->lat);
    home = {x, y, 0};
  }
  for (const Vec3& p : report.line) {
    use.farthest_m = std::max(use.farthest_m, (p - home).head<2>().norm());
  }
  if (!(use.max_wh <= battery.usable_wh())) {
    Finding finding;
    finding.violation.constraint = "energy";
    finding.violation.value = use.max_wh;
    finding.violation.limit = battery.usable_wh();
    finding.violation.unit = "Wh";
    finding.violation.message = "the mission takes " + use.in_words();
    finding.items = {"the mission"};
    report.findings.push_back(std::move(finding));
  }
  report.energy = use;
}

Finding mission_not_judged(const char* rule, std::string message) {
  Finding finding;
  finding.violation.constraint = rule;
  finding.violation.message = std::move(message);
  finding.items = {"the mission"};
  finding.is_unjudged = true;
  return finding;
}

/// Where lengths in the world's frame are off about the mission by more than that of a frame which
/// a model defines about it (plugins/environment/terrain/place.cpp): it is another region's.
void expect_to_scale(PlanReport& report, const Frame& frame) {
  constexpr double kMaxError = 0.005;
  constexpr double kMargin = 1000;  // metres that a mission may leave its positions
  Box area = Box::empty();
  for (const Vec3& point : report.imported.route) {
    area = area.with(point);
  }
  const double error = frame.has_position() ? frame.scale_error(area.grown(kMargin)) : 0;
  if (error > kMaxError) {
    Finding finding;
    finding.violation.constraint = "frame";
    finding.violation.value = error;
    finding.violation.limit = kMaxError;
    finding.violation.message =
        "lengths are off by up to " + with_decimals(100 * error, 1) +
        " % where the mission flies: the world's frame is one about another region";
    finding.items = {"the mission"};
    finding.is_unjudged = true;
    report.findings.push_back(std::move(finding));
  }
}
}  // namespace

TimeSpan time_of(const std::vector<FlownMission>& flights) {
  TimeSpan time{kInfinity, 0};
  for (const FlownMission& flown : flights) {
    time.min_s = std::min(time.min_s, flown.time.min_s);
    time.max_s = std::max(time.max_s, flown.time.max_s);
  }
  return time;
}

std::vector<FlownMission> flights_of(const formats::MissionFile& plan, const Mission* world,
                                     const GateOptions& options) {
  if (world != nullptr) {
    return Gate(plan, *world, options).flights();
  }
  const formats::MissionPoint& first = plan.items.front().at;
  Mission level;
  level.truth = World().with_frame(Frame::local({first.lon, first.lat}));
  return Gate(plan, level, options).flights();
}

PlanReport judge_plan(const std::string& file, const formats::MissionFile& plan,
                      const Mission& world, const GateOptions& options) {
  PlanReport report;
  report.file = file;
  Request request = judged_in(world);
  try {
    expect_on_ground(plan, world.truth);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  report.imported =
      route_in(without_landing(plan, world.task && !options.own_ends), world.truth, request, file);
  report.notes = report.imported.notes;
  try {
    Gate(plan, world, options).judge(report);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  expect_to_scale(report, world.truth.frame());
  if (avoids_moving(request)) {  // the times at which a mission is flown are a band
    report.findings.push_back(mission_not_judged(
        "moving", "how near it comes to the scenario's moving obstacles is not judged"));
    request.world = std::make_shared<const World>(world.truth.with_moving({}));
  }
  if (flown_until_s(report) > options.zones_known_s) {
    report.findings.push_back(
        mission_not_judged("zones", "not judged are " + std::string(kZonesUnknown)));
  }
  if (kit::has_hours(*request.world)) {  // when the mission is flown is not known to the second
    request.world =
        std::make_shared<const World>(kit::between(*request.world, -kInfinity, kInfinity));
  }
  const Route& route = report.imported.route;
  if (options.own_ends) {
    request.start.position = route.front();
    request.goal = {route.back()};
  } else {
    take_open_ends(world, route, request);
    add_route_violations(report, world, request);
  }
  add_rally(report, plan, request);
  add_home(report, plan, world.truth);
  report.measures = measure(route, request);
  report.measures.length_m = length_on_ground(route, world.truth.frame());
  report.measures.duration_s.reset();  // along drawn lines: nobody flies it so
  report.measures.time_s.reset();
  report.measures.energy_wh.reset();
  if (options.battery) {
    add_energy(report, plan, world.truth, *options.battery);
  }
  if (!options.battery_problem.empty()) {
    report.notes.push_back("not judged: " + options.battery_problem);
  }
  if (const auto height = height_of_home(plan, world.truth)) {
    const std::size_t left =
        judge_plan(file, with_home_at(plan, *height), world, options).findings.size();
    report.findings.front().cure =
        "set home's altitude to " + rounded_text(*height, 1) + " m: then " +
        (left == 0 ? "the mission passes"
                   : std::to_string(left) + " of " + counted(report.findings.size(), "violation") +
                         " are left");
  }
  return report;
}

std::optional<formats::MissionFile> cured_plan(const formats::MissionFile& plan,
                                               const Mission& world, const GateOptions& options) {
  formats::MissionFile begun = plan;
  if (const auto height = height_of_home(plan, world.truth)) {
    begun = with_home_at(std::move(begun), *height);
  }
  return Gate(with_rally_raised(std::move(begun), judged_in(world)), world, options).cured();
}
}  // namespace altiplan::host
