// SPDX-License-Identifier: Apache-2.0
#include "host/gate/plan_report.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "host/base/words.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {
namespace {

using kit::MissionItem;
using kit::MissionPoint;
using Kind = MissionItem::Kind;

/// Height of the ground there, else of home, else of the point.
double foot_of(const Vec3& top, const std::optional<MissionPoint>& home, const World& world) {
  const std::optional<double> ground = world.ground(top.x(), top.y());
  return std::min(top.z(), ground ? *ground : home ? home->altitude_m : top.z());
}

/// The mission without the parts of its flight that are no legs, which go to `passages`.
kit::MissionFile route_part(kit::MissionFile plan, const World& world,
                            std::vector<Passage>& passages) {
  const auto place = [&](const MissionItem& item) {
    try {
      return to_local(item.at, plan.home, world);
    } catch (const Error& error) {
      throw Error(item.place + ": " + error.what());
    }
  };
  const auto add = [&](const MissionItem& item, const Vec3& foot_place, const Vec3& top) {
    const double z = foot_of({foot_place.x(), foot_place.y(), top.z()}, plan.home, world);
    passages.push_back(
        {item.place, item.kind == Kind::takeoff, {foot_place.x(), foot_place.y(), z}, top});
  };
  if (plan.items.empty()) {
    return plan;
  }
  if (plan.items.front().kind == Kind::takeoff) {
    const Vec3 top = place(plan.items.front());
    add(plan.items.front(), top, top);
  }
  if (plan.items.size() > 1 && plan.items.back().kind == Kind::land) {
    MissionItem& landing = plan.items.back();
    const Vec3 before = place(plan.items[plan.items.size() - 2]);
    Vec3 over = before;
    const auto [x, y] = world.frame().to_local(landing.at.lon, landing.at.lat);
    const bool is_elsewhere = std::hypot(x - before.x(), y - before.y()) > kRoundingReach;
    if (is_elsewhere && !plan.is_wing) {
      over = {x, y, before.z()};
    }
    add(landing, {x, y, 0}, over);
    if (over == before) {
      plan.items.pop_back();
    } else {
      landing.kind = Kind::waypoint;
      landing.at = {landing.at.lon, landing.at.lat, before.z(), kit::AltitudeFrame::sea};
    }
  }
  return plan;
}

/// Heights above a home that the elevation model has elsewhere would be misread.
void note_home(const std::optional<MissionPoint>& home, const World& world,
               std::vector<std::string>& notes) {
  constexpr double kWorthNoting = 5;
  if (!home || !world.frame().has_position()) {
    return;
  }
  const auto [x, y] = world.frame().to_local(home->lon, home->lat);
  const double above = home->altitude_m - world.ground(x, y).value_or(home->altitude_m);
  if (std::abs(above) > kWorthNoting) {
    notes.push_back("home is " + with_digits(std::round(std::abs(above)), 6) + " m " +
                    (above > 0 ? "above" : "below") + " the ground of the world");
  }
}

/// The layer, but not the ground, that the vehicle comes too near to; null if none.
const Layer* layer_in_the_way(const Passage& passage, const Request& request) {
  for (const Layer& layer : request.world->layers()) {
    if (layer.environment->ground() == nullptr &&
        layer.environment->blocked(passage.foot, passage.top, request.vehicle.reach_m())) {
      return &layer;
    }
  }
  return nullptr;
}

/// A place on the leg within a metre of which it is violated: of its halves, the first that is.
Vec3 violated_place(Vec3 a, Vec3 b, const Request& request) {
  constexpr double kNear = 1;
  while ((b - a).norm() > kNear) {
    const Vec3 middle = (a + b) / 2;
    if (!leg_ok(std::nullopt, a, middle, request)) {
      b = middle;
    } else if (!leg_ok(std::nullopt, middle, b, request)) {
      a = middle;
    } else {
      break;  // by its whole, or by what precedes it
    }
  }
  return (a + b) / 2;
}

Finding finding_of(const Violation& violation, const PlanReport& report, const Request& request) {
  const Route& route = report.imported.route;
  Finding finding{violation, {report.name_of(violation.at)}, {}, cure(route, violation, request)};
  if (violation.at < route.leg_count()) {
    const Leg leg = route.leg(violation.at);
    finding.items.push_back(report.name_of(violation.at + 1));
    finding.at = violated_place(leg.from, leg.to, request);
  } else {
    finding.at = route.back();
  }
  return finding;
}

void add_passages(PlanReport& report, const Request& request) {
  for (const Passage& passage : report.passages) {
    if (const Layer* layer = layer_in_the_way(passage, request)) {
      Violation violation;
      violation.at = passage.is_climb ? 0 : report.imported.route.size() - 1;
      violation.constraint = passage.is_climb ? "climb" : "descent";
      violation.message = "the " + violation.constraint +
                          (passage.is_climb ? " after take-off" : " to land") +
                          " passes too close to '" + layer->id + "'";
      report.findings.push_back({violation, {passage.item}, passage.top, std::nullopt});
    }
  }
}
}  // namespace

std::string PlanReport::name_of(std::size_t waypoint) const {
  return waypoint < imported.places.size() ? imported.places[waypoint]
                                           : "waypoint " + std::to_string(waypoint);
}

PlanReport judge_plan(const std::string& file, const kit::MissionFile& plan, const Mission& world,
                      bool own_ends) {
  PlanReport report;
  report.file = file;
  Request request = world.request;
  request.world = std::make_shared<const World>(world.truth);
  kit::MissionFile flown;
  try {
    flown = route_part(plan, world.truth, report.passages);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  report.imported = route_in(flown, world.truth, request, file);
  const Route& route = report.imported.route;
  if (own_ends) {
    request.start.position = route.front();
    request.goal = {route.back()};
  }
  report.notes = report.imported.notes;
  note_home(plan.home, world.truth, report.notes);
  const CheckResult verdict = judge(route, request, own_ends ? std::vector<Goal>{} : world.via);
  for (const Violation& violation : verdict.violations) {
    report.findings.push_back(finding_of(violation, report, request));
  }
  add_passages(report, request);
  report.measures = measure(route, request);
  return report;
}

double flight_time(const kit::MissionFile& plan, double speed_mps) {
  constexpr double kVertical = 1;  // m/s
  constexpr double kMetresPerDegree = 111195;
  const double home = plan.home ? plan.home->altitude_m : 0;
  const auto height = [&](const MissionItem& item) {
    return item.kind == Kind::land                    ? 0
           : item.at.frame == kit::AltitudeFrame::sea ? item.at.altitude_m - home
                                                      : item.at.altitude_m;
  };
  double seconds = 0;
  if (!plan.items.empty() && plan.items.front().kind == Kind::takeoff) {
    seconds += std::abs(height(plan.items.front())) / kVertical;
  }
  for (std::size_t n = 0; n < plan.items.size(); ++n) {
    const MissionItem& item = plan.items[n];
    const MissionItem& before = plan.items[n == 0 ? 0 : n - 1];
    const double own = item.speed_mps > 0 ? item.speed_mps : plan.speed_mps;
    const double speed = own > 0 ? own : speed_mps;
    const double north = (item.at.lat - before.at.lat) * kMetresPerDegree;
    const double east = std::remainder(item.at.lon - before.at.lon, 360) * kMetresPerDegree *
                        std::cos(radians((item.at.lat + before.at.lat) / 2));
    seconds += std::hypot(north, east) / speed +
               std::abs(height(item) - height(before)) / kVertical + item.hold_s;
    if (item.circle) {
      if (item.circle->until == kit::MissionCircle::Until::forever) {
        return kInfinity;
      }
      seconds += 2 * kPi * item.circle->radius_m * (item.circle->turns + 1) / speed;
    }
  }
  return seconds;
}
}  // namespace altiplan::host
