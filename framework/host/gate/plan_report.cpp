// SPDX-License-Identifier: Apache-2.0
#include "host/gate/plan_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "altiplan/error.hpp"
#include "altiplan/ground.hpp"
#include "host/base/words.hpp"
#include "host/judge/judge.hpp"

namespace altiplan::host {
namespace {

using formats::MissionItem;
using formats::MissionPoint;
using Kind = MissionItem::Kind;

/// True if the violation is of a layer with ground.
bool is_ground(const Violation& violation, const Request& request) {
  const Layer* layer = request.world->find(violation.layer);
  return layer != nullptr && layer->environment->ground() != nullptr;
}

/// True if an aeroplane's climb or descent goes through the ground, or beyond what is known of it.
bool meets_ground(const Passage& passage, const World& world) {
  constexpr double kTouch = 1;  // metres: where it ends
  return !passage.is_vertical && world.has_ground() &&
         !(world.ground_gap(passage.foot, passage.top) >= -kTouch);
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

/// The same rule's violation of a part of a leg, if it is violated there.
std::optional<Violation> same_of_part(const Vec3& a, const Vec3& b, const Violation& whole,
                                      const Request& request) {
  for (const Violation& found : leg_violations(std::nullopt, a, b, request, whole.at)) {
    if (found.constraint == whole.constraint) {
      return found;
    }
  }
  return std::nullopt;
}

/// The place, within a metre, at which the violation is as bad as on the whole leg: of two halves
/// the one whose value is nearer to the leg's. The middle of the leg where no part violates it.
Vec3 worst_place(Vec3 a, Vec3 b, const Violation& whole, const Request& request) {
  constexpr double kNear = 1;
  while ((b - a).norm() > kNear) {
    const Vec3 middle = (a + b) / 2;
    const auto first = same_of_part(a, middle, whole, request);
    const auto second = same_of_part(middle, b, whole, request);
    if (!first && !second) {
      break;  // by its whole, or by what precedes it
    }
    const auto off = [&](const std::optional<Violation>& part) {
      return part ? std::abs(part->value - whole.value) : kInfinity;
    };
    (off(first) <= off(second) ? b : a) = middle;
  }
  return (a + b) / 2;
}

/// The name of the layer's part that holds the place or is nearest to it, if it has names. Of
/// keep-in zones one of which must hold the place it is the one that the place is deepest in, as
/// far as its border; where all must, the one whose border is nearest, or that it is farthest out
/// of.
std::string part_at(const Layer& layer, const Vec3& p) {
  const std::optional<Drawing> drawing = layer.environment->drawing();
  const Drawn* in_the_way = nullptr;
  const Drawn* around = nullptr;
  double nearest = kInfinity;
  double from_border = kInfinity;  // of `around`; negative outside of it
  if (!drawing) {
    return "";
  }
  for (const Drawn& drawn : drawing->shapes) {
    const double distance = signed_distance(drawn.shape, p);
    if (drawn.role != Drawn::Role::keep_in) {
      in_the_way = distance < nearest ? &drawn : in_the_way;
      nearest = std::min(nearest, distance);
    } else if (around == nullptr ||
               (drawing->keeps_in_all ? -distance < from_border : -distance > from_border)) {
      around = &drawn;
      from_border = -distance;
    }
  }
  const Drawn* part = nearest <= from_border ? in_the_way : around;
  return part == nullptr ? "" : part->name;
}

/// Says which zone of the layer is violated: the only place that does.
void name_zone(Finding& finding, const Request& request) {
  const Layer* layer = request.world->find(finding.violation.layer);
  if (layer != nullptr && finding.at) {
    finding.zone = part_at(*layer, *finding.at);
    if (!finding.zone.empty()) {
      finding.violation.message += ": '" + finding.zone + "' of '" + layer->id + "'";
    }
  }
}

/// Tells a void of the elevation model from ground.
void name_void(Finding& finding, const Request& request) {
  const World& world = *request.world;
  const std::optional<double> ground =
      finding.at ? world.ground(finding.at->x(), finding.at->y()) : std::nullopt;
  const std::string& rule = finding.violation.constraint;
  const bool is_of_ground = rule == "ground_clearance" || rule == "altitude" ||
                            rule == "ground_distance" || is_ground(finding.violation, request);
  if (is_of_ground && ground && *ground >= kUnknownGround) {
    finding.is_over_void = true;
    finding.violation.message =
        "passes over a void of the elevation model, where the ground is unknown (--fill-voids)";
  }
}

/// The place of a turn where it is lowest above ground, else its middle.
Vec3 lowest_place(const Leg& leg, const World& world) {
  Vec3 lowest = leg.at(0.5);
  double min_height = kInfinity;
  for (const Vec3& p : leg.chords(kChordTolerance)) {
    const std::optional<double> ground = world.ground(p.x(), p.y());
    if (ground && p.z() - *ground < min_height) {
      min_height = p.z() - *ground;
      lowest = p;
    }
  }
  return lowest;
}

Finding finding_of(const Violation& violation, const PlanReport& report, const Request& request) {
  const Route& route = report.imported.route;
  Finding finding{violation, {report.name_of(violation.at)}, {}, {}};
  if (violation.at < route.leg_count()) {
    const Leg leg = route.leg(violation.at);
    finding.items.push_back(report.name_of(violation.at + 1));
    finding.at = worst_place(leg.from, leg.to, violation, request);
  } else {
    finding.at = route.back();
  }
  name_zone(finding, request);
  name_void(finding, request);
  return finding;
}

/// True if a leg into the ground has been reported already.
bool is_reported(const PlanReport& report, const Violation& violation, const Request& request) {
  return violation.constraint == "clearance" &&
         std::any_of(report.findings.begin(), report.findings.end(), [&](const Finding& other) {
           return other.violation.at == violation.at &&
                  other.violation.constraint == "ground_clearance" && other.violation.value < 0 &&
                  is_ground(violation, request);
         });
}

/// One finding a leg and rule, the first legs with a cure.
void add_violations(PlanReport& report, const CheckResult& verdict, const Request& request) {
  constexpr std::size_t kMaxCures = 50;              // each may judge thousands of legs
  std::map<std::size_t, std::optional<Cure>> cures;  // of legs
  const Bonds bonds = report.bonds();
  for (const Violation& violation : verdict.violations) {
    if (is_reported(report, violation, request)) {
      continue;
    }
    Finding finding = finding_of(violation, report, request);
    if (cures.size() < kMaxCures && !cures.contains(violation.at)) {
      cures[violation.at] = cure(report.imported.route, violation, request, bonds);
    }
    if (const auto found = cures.find(violation.at); found != cures.end()) {
      finding.cure = found->second;
    }
    report.findings.push_back(std::move(finding));
  }
  if (cures.size() == kMaxCures && cures.rbegin()->first < verdict.violations.back().at) {
    report.notes.push_back("cures are searched for the first " + std::to_string(kMaxCures) +
                           " legs that are violated");
  }
}

void add_passages(PlanReport& report, const Request& request) {
  for (const Passage& passage : report.passages) {
    const Layer* layer = layer_in_the_way(passage, request);
    const bool is_in_ground = meets_ground(passage, *request.world);
    if (layer == nullptr && !is_in_ground) {
      continue;
    }
    Violation violation;
    violation.at = passage.is_climb ? 0 : report.imported.route.size() - 1;
    violation.constraint = passage.is_climb ? "climb" : "descent";
    violation.message = "the " + violation.constraint +
                        (passage.is_climb ? " after take-off" : " to land") +
                        (is_in_ground ? " goes through the ground, or beyond what is known of it"
                                      : " passes too close to '" + layer->id + "'");
    violation.layer = is_in_ground ? "" : layer->id;
    Finding finding{violation, {passage.item}, (passage.foot + passage.top) / 2, {}};
    name_zone(finding, request);
    report.findings.push_back(std::move(finding));
  }
}

void add_ways(PlanReport& report, const Request& request) {
  for (const Way& way : report.ways) {
    for (Violation violation : leg_violations(std::nullopt, way.leg, request, 0)) {
      violation.message = way.what + ": " + violation.message;
      Finding finding{violation, {way.item}, lowest_place(way.leg, *request.world), {}};
      if (way.leg.kind() == Leg::Kind::straight) {
        finding.at = worst_place(way.leg.from, way.leg.to, violation, request);
      }
      name_zone(finding, request);
      name_void(finding, request);
      report.findings.push_back(std::move(finding));
    }
  }
}

/// A vehicle may be sent to a rally point from anywhere: the place alone is judged, not a way
/// there.
void add_rally(PlanReport& report, const formats::MissionFile& plan, const Request& request) {
  Request alone = request;
  alone.limits.min_leg = 0;  // a place has no length
  for (const MissionPoint& point : plan.rally) {
    const std::string name = "rally point " + std::to_string(report.rally.size() + 1);
    report.rally.push_back(name);
    const auto add = [&](Finding finding) {
      finding.violation.constraint = "rally";
      report.findings.push_back(std::move(finding));
    };
    try {
      const Vec3 p = to_local(point, plan.home, *request.world);
      for (const Violation& violation :
           leg_violations(std::nullopt, Leg::straight(p, p), alone, 0)) {
        Finding finding{violation, {name}, p, {}};
        name_zone(finding, request);
        name_void(finding, request);
        add(std::move(finding));
      }
    } catch (const Error& error) {  // where it is cannot be told
      Violation violation;
      violation.message = error.what();
      add({violation, {name}, {}, {}});
    }
  }
}

void add_moves(PlanReport& report, const formats::MissionFile& plan) {
  for (const formats::MissionMove& move : plan.moves) {
    Violation violation;
    violation.constraint = "not_judged";
    violation.message = "where this flies is not judged: replace it by waypoints";
    report.findings.push_back({violation, {name_of_move(move)}, {}, {}});
  }
}

/// What is judged by what the mission says, though the vehicle may do otherwise.
void note_unknown(const formats::MissionFile& plan, std::vector<std::string>& notes) {
  if (!plan.items.empty() && plan.items.front().kind != Kind::takeoff) {
    notes.emplace_back("the mission has no take-off: the way from home is not judged");
  }
  for (const MissionItem& item : plan.items) {
    if (item.kind == Kind::loiter && item.loiter_m == 0) {
      notes.push_back(name_of_item(item) + ": judged as a point: it gives no radius");
    }
  }
}

void add_home(PlanReport& report, const formats::MissionFile& plan, const World& world) {
  const auto relative =
      std::count_if(plan.items.begin(), plan.items.end(), [](const MissionItem& item) {
        return item.at.frame == formats::AltitudeFrame::home && item.kind != Kind::land;
      });
  if (!plan.home || !world.frame().has_position()) {
    return;
  }
  const auto [x, y] = world.frame().to_local(plan.home->lon, plan.home->lat);
  const std::optional<double> ground = world.ground(x, y);
  if (!ground || std::abs(plan.home->altitude_m - *ground) <= kHomeTolerance) {
    return;
  }
  Violation violation;
  violation.constraint = "home";
  violation.value = plan.home->altitude_m;
  violation.limit = *ground;
  violation.unit = "m";
  violation.message =
      "home is at " + with_digits(std::round(plan.home->altitude_m), 6) +
      " m in the mission, where the ground is at " + with_digits(std::round(*ground), 6) + " m: " +
      (relative == 0 ? "no height is"
                     : "the heights of " + counted(std::size_t(relative), "item") + " are") +
      " relative to it";
  if (relative > 0) {
    report.findings.insert(report.findings.begin(), {violation, {"home"}, Vec3(x, y, *ground), {}});
  } else {
    report.notes.push_back(violation.message);
  }
}

/// Throws Error if no position of the mission has ground below it.
void expect_on_ground(const formats::MissionFile& plan, const World& world) {
  const auto has_ground = [&](double lon, double lat) {
    const auto [x, y] = world.frame().to_local(lon, lat);
    return world.ground(x, y).has_value();
  };
  const auto& items = plan.items;
  if (!world.has_ground() || !world.frame().has_position() || items.empty() ||
      std::any_of(items.begin(), items.end(),
                  [&](const MissionItem& item) { return has_ground(item.at.lon, item.at.lat); })) {
    return;
  }
  const bool is_swapped = std::all_of(items.begin(), items.end(), [&](const MissionItem& item) {
    return std::abs(item.at.lon) <= 90 && has_ground(item.at.lat, item.at.lon);
  });
  const MissionItem& first = items.front();
  throw Error("no position of the mission is within the elevation model: " + name_of_item(first) +
              " is at latitude " + with_digits(first.at.lat, 8) + ", longitude " +
              with_digits(first.at.lon, 9) +
              (is_swapped ? ", which are swapped: exchanged, all are within" : ""));
}
}  // namespace

std::string PlanReport::name_of(std::size_t waypoint) const {
  return waypoint < imported.items.size() ? name_of_item(imported.items[waypoint])
                                          : "waypoint " + std::to_string(waypoint);
}

std::string PlanReport::height_in_words() const {
  const bool is_unknown = std::any_of(findings.begin(), findings.end(),
                                      [](const Finding& finding) { return finding.is_over_void; });
  char text[48];
  std::snprintf(text, sizeof text, "at least %.1f m above ground",
                measures.min_ground_clearance_m.value_or(0));
  return is_unknown                        ? "over unknown ground"
         : measures.min_ground_clearance_m ? text
                                           : "height above ground unknown";
}

Bonds PlanReport::bonds() const {
  const std::vector<MissionItem>& items = imported.items;
  Bonds bonds;
  for (const MissionItem& item : items) {
    bonds.follows_ground.push_back(item.at.frame == formats::AltitudeFrame::ground);
  }
  bonds.last_is_led = items.size() > 1 && items.back().kind == Kind::land;
  return bonds;
}

void expect_route(const std::string& file, const formats::MissionFile& plan) {
  if (!plan.route_problem.empty()) {
    throw Error(file + ": " + plan.route_problem);
  }
  if (plan.items.empty()) {
    throw Error(file + ": it contains no route" +
                (plan.moves.empty()
                     ? !plan.zones.empty()   ? ": it contains only zones"
                       : !plan.rally.empty() ? ": it contains only rally points"
                                             : ""
                     : ", and where " + name_of_move(plan.moves.front()) + " flies is not judged"));
  }
}

PlanReport judge_plan(const std::string& file, const formats::MissionFile& plan,
                      const Mission& world, bool own_ends) {
  PlanReport report;
  report.file = file;
  Request request = world.request;
  request.world = std::make_shared<const World>(world.truth);
  FlownParts parts;
  try {
    expect_on_ground(plan, world.truth);
    parts = flown_parts(plan, world.truth);
  } catch (const Error& error) {
    throw Error(file + ": " + error.what());
  }
  report.passages = std::move(parts.passages);
  report.ways = std::move(parts.ways);
  const formats::MissionFile& flown = parts.route;
  report.imported = route_in(flown, world.truth, request, file);
  const Route& route = report.imported.route;
  if (own_ends) {
    request.start.position = route.front();
    request.goal = {route.back()};
  }
  report.notes = report.imported.notes;
  add_violations(report, judge(route, request, own_ends ? std::vector<Goal>{} : world.via),
                 request);
  add_ways(report, request);
  add_rally(report, plan, request);
  add_passages(report, request);
  add_moves(report, flown);
  add_home(report, plan, world.truth);
  note_unknown(plan, report.notes);
  report.measures = measure(route, request);
  return report;
}
}  // namespace altiplan::host
