// SPDX-License-Identifier: Apache-2.0
#include "host/first_route/runway_choice.hpp"

#include <algorithm>
#include <cmath>

#include "host/base/words.hpp"
#include "host/import_export/plan.hpp"
#include "host/judge/judge.hpp"
#include "host/mission/runways.hpp"

namespace altiplan::host {
namespace {

constexpr int kCourses = 36;
constexpr double kGlide = 5;        // degrees: the steepest landing of PX4's defaults
constexpr double kShallowest = 4;   // degrees: an aeroplane of ArduPilot's may climb so little
constexpr double kHeightStep = 10;  // metres between slopes that are tried,
constexpr double kMaxHigher = 100;  // up to so much above the lowest,
constexpr double kCircleHigher = 300;
constexpr double kSettles = 20;     // seconds from a turn until it flies along its line, level
constexpr double kTurnsBefore = 5;  // seconds before a corner at which it turns, at most
constexpr double kOnward = 600;     // metres flown on straight after a climb, and to a circle
constexpr double kCalm = 0.5;       // m/s
constexpr double kVertical = 90;    // degrees
constexpr const char* kCircle = "its circle";

Vec3 along(double course_deg) { return unit_heading(radians(90 - course_deg)); }

double compass(const Eigen::Vector2d& way) {
  return std::fmod(360 + 90 - degrees(std::atan2(way.y(), way.x())), 360);
}
}  // namespace

std::vector<double> RunwayChoice::courses(const Eigen::Vector2d& way,
                                          std::optional<double> runway_deg) const {
  if (runway_deg) {
    return {*runway_deg};
  }
  const bool is_windy = !is_vtol() && wish_.wind && wish_.wind->speed_mps > kCalm;
  const double best = std::round(is_windy ? wish_.wind->from_deg : compass(way));
  std::vector<double> all;
  for (int n = 0; n < kCourses; ++n) {  // to the one side and to the other by turns
    const int steps = (n + 1) / 2;
    const double off = 360.0 / kCourses * (n % 2 == 0 ? steps : -steps);
    all.push_back(std::fmod(best + off + 360, 360));
  }
  return all;
}

std::vector<double> RunwayChoice::heights_above(const WishedPoint& point, double higher) const {
  const double lowest = point.above_ground_m.value_or(first_.heights().ends_m);
  std::vector<double> all;
  for (double more = 0; more <= higher; more += kHeightStep) {
    all.push_back(std::ceil(lowest + more));
  }
  return all;
}

LandingEntry RunwayChoice::landing_on(double course_deg, double height_m) const {
  const double fastest = speed_mps_ + (wish_.wind ? wish_.wind->speed_mps : 0);
  const double sinks = wish_.climb_mps ? degrees(std::atan(*wish_.climb_mps / fastest)) : kGlide;
  const double level = std::max(2 * *wish_.turn_radius_m, kSettles * fastest);
  if (is_vtol()) {
    return {course_deg, height_m, kVertical, 10 * std::ceil(level / 10)};
  }
  return {course_deg, height_m, std::min(kGlide, std::floor(10 * sinks) / 10),
          10 * std::ceil(level / 10)};
}

TakeOffEntry RunwayChoice::takeoff_on(double course_deg, double height_m) const {
  const double wind = wish_.wind ? wish_.wind->speed_mps : 0;
  if (is_vtol()) {
    return {course_deg, height_m, kVertical, 10 * std::ceil(kSettles * (speed_mps_ + wind) / 10)};
  }
  const double longest =
      height_m / std::tan(radians(kShallowest)) * (speed_mps_ + wind) / speed_mps_;
  const double climb =
      degrees(std::atan(height_m / (longest + kTurnsBefore * (speed_mps_ + wind))));
  return {course_deg, height_m, std::floor(100 * climb) / 100};
}

bool RunwayChoice::may_pass(const Polyline& line, const Runways& runways) const {
  Request request = world_.request;
  auto& minimum = request.limits.min_ground_clearance;
  minimum = minimum.value_or(0) + first_.flown_margin();
  request.limits.min_clearance = std::max(request.limits.min_clearance, first_.clearance_m());
  request.start = {0, line.front(), Vec3::Zero(), std::nullopt};
  request.goal = {line.back()};
  return judge(Route(line), request, {}, runways).ok();
}

PlanReport RunwayChoice::judged(const Polyline& items, int first, int last, const Vec3& home,
                                const GateOptions& gate) const {
  constexpr int kAeroplane = 1;
  constexpr int kVtol = 20;
  constexpr double kPitch = 10;  // degrees, of a take-off
  Plan plan;
  plan.autopilot = wish_.autopilot.is_px4() ? Plan::kPx4 : Plan::kArduPilot;
  plan.vehicle = is_vtol() ? kVtol : kAeroplane;
  plan.speed_mps = speed_mps_;
  const auto lonlat = [&](const Vec3& p) { return world_.truth.frame().to_lonlat(p.x(), p.y()); };
  const auto [home_lon, home_lat] = lonlat(home);
  plan.home = {home_lon, home_lat, home.z(), formats::AltitudeFrame::sea};
  for (const Vec3& p : items) {
    const auto [lon, lat] = lonlat(p);
    plan.items.push_back({Command::kWaypoint, 0, {0, 0, 0, std::nan(""), lat, lon, p.z()}});
  }
  plan.items.front().command = first;
  plan.items.front().params[0] = first == Command::kTakeoff ? kPitch : 0;
  if (first == Command::kVtolTakeoff) {  // by the number, whatever its frame
    constexpr int kOfHome = 3;
    plan.items.front().frame = kOfHome;
    plan.items.front().params[6] -= home.z();
  }
  plan.items.back().command = last;
  plan.items.back().params[3] = last == Command::kLoiterForever ? 0 : std::nan("");
  const char* name = "runway.plan";
  GateOptions part = gate;  // of a mission that has a landing
  if (wish_.autopilot.is_px4()) {
    part.flight.parameters["MIS_TKO_LAND_REQ"] = 0;
  }
  return judge_plan(name, formats::read_mission(name, plan_text(plan)), world_, part);
}

/// With a turn before it, to the left or to the right, or straight ahead.
PlanReport RunwayChoice::judged(const LandingEntry& landing, const Vec3& touch,
                                double turn_deg) const {
  const LandingLine line = line_of(landing, touch);
  const double room = std::max(*wish_.turn_radius_m, kTurnsBefore * speed_mps_);
  // It sinks until then, unless an upper limit may be in the way.
  const double slope =
      first_.heights().max_m ? 0 : std::tan(radians(std::min(kGlide, landing.glide_deg)));
  const Vec3 up(0, 0, slope);
  const Vec3 corner = line.entry - room * (along(landing.course_deg) - up);
  const Vec3 begin = corner - 3 * room * (along(landing.course_deg + turn_deg) - up);
  Vec3 below = begin;
  below.z() = world_.truth.ground(begin.x(), begin.y()).value_or(touch.z());
  if (is_vtol()) {
    return judged({begin, corner, line.entry, touch}, Command::kWaypoint, Command::kVtolLand, below,
                  gate_);
  }
  return judged({begin, corner, line.entry, line.fix, touch}, Command::kWaypoint, Command::kLand,
                below, gate_);
}

bool RunwayChoice::passes(const LandingEntry& landing, const Vec3& touch) const {
  constexpr int kFix = 4;  // its item; the landing's comes last, a VTOL's in its place
  bool has_way = false;
  for (const double turn : {0.0, 90.0, -90.0}) {
    const PlanReport report = judged(landing, touch, turn);
    has_way = has_way || report.verdict() == Verdict::pass;
    if (std::any_of(report.findings.begin(), report.findings.end(),
                    [](const Finding& finding) { return finding.item >= kFix; })) {
      return false;
    }
  }
  return has_way;
}

PlanReport RunwayChoice::judged(const TakeOffEntry& takeoff, const Vec3& start) const {
  const Vec3 end = end_of(takeoff, start);
  const Vec3 middle((start.x() + end.x()) / 2, (start.y() + end.y()) / 2, end.z());
  GateOptions gate = gate_;
  gate.flight.runway_deg = takeoff.course_deg;
  return judged({middle, end, end + kOnward * along(takeoff.course_deg)},
                is_vtol() ? Command::kVtolTakeoff : Command::kTakeoff, Command::kLoiterForever,
                start, gate);
}

void RunwayChoice::refuse(const char* what, const std::vector<double>& courses,
                          const PlanReport& report) {
  const std::string course = with_digits(courses.front(), 4) + " degrees";
  refusal_ = courses.size() == 1
                 ? "--runway: " + std::string(what) + " on " + course + " "
                 : std::string("no ") + what + " on any of " + std::to_string(courses.size()) +
                       " courses; the best one, " + course + ", ";
  refusal_ += report.verdict() == Verdict::not_judged ? "is not judged" : "does not pass";
  if (!report.findings.empty()) {
    const auto slope = std::find_if(report.findings.begin(), report.findings.end(),
                                    [](const Finding& each) { return !each.what.empty(); });
    const Finding& finding = slope != report.findings.end() ? *slope : report.findings.front();
    refusal_ += ": " + finding.violation.message +
                (finding.zone.empty() ? "" : " (zone '" + finding.zone + "')") +
                (finding.at ? ", at " + world_.request.place_text(*finding.at) : "");
  }
}

std::optional<Vec3> RunwayChoice::on_ground(const char* what, const Eigen::Vector2d& at) {
  const std::optional<double> ground = world_.truth.ground(at.x(), at.y());
  if (!ground) {
    refusal_ = std::string("no ") + what + ": no ground is known there";
    return std::nullopt;
  }
  return Vec3(at.x(), at.y(), *ground);
}

std::optional<LandingEntry> RunwayChoice::landing(const Eigen::Vector2d& at,
                                                  const Eigen::Vector2d& from,
                                                  std::optional<double> runway_deg) {
  const std::optional<Vec3> touch = on_ground("landing", at);
  if (!touch) {
    return std::nullopt;
  }
  const std::vector<double> all = courses(at - from, runway_deg);
  const std::vector<double> heights = heights_above(wish_.points.back(), kMaxHigher);
  for (const double course : all) {
    for (const double height : heights) {
      const LandingEntry entry = landing_on(course, height);
      const LandingLine line = line_of(entry, *touch);
      Polyline drawn{line.entry, line.fix};
      if (!is_vtol()) {
        drawn.push_back(*touch);
      }
      if (may_pass(drawn, {std::nullopt, line.fix}) && passes(entry, *touch)) {
        return entry;
      }
    }
  }
  refuse("landing", all, judged(landing_on(all.front(), heights.front()), *touch, 0));
  return std::nullopt;
}

std::optional<TakeOffEntry> RunwayChoice::takeoff(const Eigen::Vector2d& at,
                                                  const Eigen::Vector2d& toward,
                                                  std::optional<double> runway_deg) {
  const std::optional<Vec3> start = on_ground("take-off", at);
  if (!start) {
    return std::nullopt;
  }
  const std::vector<double> all = courses(toward - at, runway_deg);
  const std::vector<double> heights = heights_above(wish_.points.front(), kMaxHigher);
  for (const double course : all) {
    for (const double height : heights) {
      const TakeOffEntry entry = takeoff_on(course, height);
      const Vec3 end = end_of(entry, *start);
      Polyline drawn{*start, end};
      if (is_vtol()) {
        drawn.front().z() = end.z();
      } else {
        drawn.push_back(end + kOnward * along(course));
      }
      if (may_pass(drawn, {end, std::nullopt}) && climbs(judged(entry, *start))) {
        return entry;
      }
    }
  }
  refuse("take-off", all, judged(takeoff_on(all.front(), heights.front()), *start));
  return std::nullopt;
}

bool RunwayChoice::climbs(const PlanReport& report) const {
  constexpr int kOnwardItem = 3;  // where a VTOL need not fly
  return is_vtol() ? std::none_of(report.findings.begin(), report.findings.end(),
                                  [](const Finding& finding) { return finding.item < kOnwardItem; })
                   : report.verdict() == Verdict::pass;
}

std::optional<double> RunwayChoice::circle(const Eigen::Vector2d& at, const Eigen::Vector2d& from) {
  const std::optional<Vec3> ground = on_ground("circle", at);
  if (!ground) {
    return std::nullopt;
  }
  const Eigen::Vector2d way = (at - from).normalized() * kOnward;
  const double lower = first_.flown_margin();  // as it may arrive
  for (const double height : heights_above(wish_.points.back(), kCircleHigher)) {
    const Vec3 goal = *ground + Vec3(0, 0, height - lower);
    const Vec3 begin = goal - Vec3(way.x(), way.y(), 0);
    const PlanReport report =
        judged({begin, goal}, Command::kWaypoint, Command::kLoiterForever, *ground, gate_);
    const auto found = std::find_if(report.findings.begin(), report.findings.end(),
                                    [](const Finding& finding) { return finding.what == kCircle; });
    if (found == report.findings.end()) {
      return height;
    }
    if (refusal_.empty()) {
      refusal_ = "no circle around the goal passes, up to " + with_digits(kCircleHigher, 3) +
                 " m higher; at its own height " + found->violation.message +
                 ": give another goal, or --land";
    }
  }
  return std::nullopt;
}
}  // namespace altiplan::host
