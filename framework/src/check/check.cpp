// SPDX-License-Identifier: Apache-2.0
#include "altiplan/check.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "altiplan/attributed.hpp"
#include "altiplan/measures.hpp"
#include "altiplan/what_blocks.hpp"

namespace altiplan {
namespace {

/// A number for a message; absurdly large ones are abbreviated.
std::string fixed(double value, int digits = 2) {
  char buffer[64];
  const bool spelled = std::abs(value) < 1e15;
  const int n = spelled ? std::snprintf(buffer, sizeof buffer, "%.*f", digits, value)
                        : std::snprintf(buffer, sizeof buffer, "%g", value);
  std::string text(buffer, static_cast<std::size_t>(n));
  std::replace(text.begin(), text.end(), ',', '.');  // a locale with a decimal comma
  return text;
}

/// A distance, with enough digits for any magnitude.
std::string distance_text(double value) {
  if (value >= 1e-3) {
    return fixed(value, 6);
  }
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.3g", value);
  std::string text(buffer);
  std::replace(text.begin(), text.end(), ',', '.');
  return text;
}

std::string place(const Vec3& p) {
  return "(" + fixed(p.x()) + ", " + fixed(p.y()) + ", " + fixed(p.z()) + ")";
}

/// A violation for a quantity beyond its limit, with its message.
Violation beyond(const char* rule, std::size_t at, double value, double limit, const char* unit,
                 const std::string& what, bool too_small) {
  int digits = 2;  // as many as distinguish the two
  while (digits < 9 && fixed(value, digits) == fixed(limit, digits)) {
    ++digits;
  }
  return {rule, at, value, limit,
          what + " is " + fixed(value, digits) + unit + ", " + (too_small ? "below" : "above") +
              " the limit of " + fixed(limit, digits) + unit};
}

/// Start of the first part of a leg that has no ground below it.
Vec3 ground_ends(const World& world, const Vec3& a, const Vec3& b) {
  if (!world.ground_below(a, a)) {
    return a;
  }
  double known = 0;
  double unknown = 1;
  for (int i = 0; i < 50; ++i) {
    const double t = (known + unknown) / 2;
    (world.ground_below(a, a + t * (b - a)) ? known : unknown) = t;
  }
  return a + unknown * (b - a);
}

double required_clearance(const Request& request) {
  return std::max(request.limits.min_clearance, request.vehicle.radius_m);
}

/// Checks one leg against every constraint, the cheap ones first: one call of `report` (with a
/// function that makes the violation) per violated constraint, until report returns false.
template <class Report>
class LegJudge {
 public:
  LegJudge(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
           const Request& request, std::size_t at, const Report& report)
      : before_(before),
        a_(a),
        b_(b),
        leg_(b - a),
        request_(request),
        limits_(request.limits),
        at_(at),
        report_(report) {}

  void judge() const {
    if (!is_finite(a_) || !is_finite(b_)) {
      report_([&] { return Violation{"finite", at_, 0, 0, "a coordinate is not finite"}; });
      return;
    }
    // Each returns whether to continue.
    (void)(keeps_place(a_, at_) && keeps_place(b_, at_ + 1) && keeps_size() && keeps_bend() &&
           keeps_heights() && keeps_constraints() && keeps_off());
  }
  void judge_bend() const { (void)keeps_bend(); }

 private:
  // Quantities and their limits; `scale` converts both to the unit of the message.
  bool at_least(double value, double limit, double tolerance, const char* rule, const char* what,
                const char* unit, double scale = 1) const {
    return value >= limit - tolerance || report_([&] {
             return beyond(rule, at_, value * scale, limit * scale, unit, what, true);
           });
  }
  bool at_most(double value, double limit, double tolerance, const char* rule, const char* what,
               const char* unit, double scale = 1) const {
    return value <= limit + tolerance || report_([&] {
             return beyond(rule, at_, value * scale, limit * scale, unit, what, false);
           });
  }
  /// `angle` is evaluated only if the limit is below `widest`, the maximum of any angle.
  template <class Angle>
  bool at_most_angle(const Angle& angle, double limit, double widest, const char* rule,
                     const char* what) const {
    return limit >= widest ||
           at_most(angle(), limit, kAngleTolerance, rule, what, " degrees", degrees(1));
  }

  bool keeps_place(const Vec3& p, std::size_t index) const {
    if (!request_.volume.contains(p, kLengthTolerance) && !report_([&] {
          const double outside =
              std::max((request_.volume.min - p).maxCoeff(), (p - request_.volume.max).maxCoeff());
          return Violation{"volume", index, outside, 0,
                           place(p) + " lies " + fixed(outside) + " m outside the volume"};
        })) {
      return false;
    }
    return !request_.level_m || std::abs(p.z() - *request_.level_m) <= kLengthTolerance ||
           report_([&] {
             return Violation{
                 "level_flight", index, p.z(), *request_.level_m,
                 place(p) + " is not on the level of " + fixed(*request_.level_m) + " m"};
           });
  }

  bool keeps_size() const {
    const double run = leg_.norm();
    return at_least(run, limits_.min_leg, kLengthTolerance, "leg_length", "the leg's length",
                    " m") &&
           at_most(run, limits_.max_leg, kLengthTolerance, "leg_length", "the leg's length",
                   " m") &&
           at_most_angle([&] { return climb_angle(leg_); }, limits_.max_climb, kPi / 2,
                         "climb_angle", "the climb angle");
  }

  bool keeps_bend() const {
    if (!before_) {
      return true;
    }
    const bool on_the_spot = request_.vehicle.turns_on_the_spot;
    return at_most_angle([&] { return horizontal_turn(*before_, a_, b_, on_the_spot); },
                         limits_.max_turn_horizontal, kPi, "turn_angle", "the turn angle") &&
           at_most_angle([&] { return turn_angle_in_space(a_ - before_->from, leg_); },
                         limits_.max_turn_space, kPi, "turn_angle", "the turn angle") &&
           (limits_.min_turn_radius == 0 ||
            at_least(corner_radius(*before_, a_, b_, on_the_spot), limits_.min_turn_radius,
                     kLengthTolerance, "turn_radius", "the turn radius", " m"));
  }

  bool keeps_heights() const {
    const World& world = *request_.world;
    const bool over_ground = world.ground_below(a_, b_);
    if (!over_ground && !report_([&] {
          return Violation{"ground", at_, 0, 0,
                           "there is no ground of known height below " +
                               place(ground_ends(world, a_, b_)) + ", a point of the leg"};
        })) {
      return false;
    }
    for (const AltitudeBand& band : limits_.altitude) {
      if ((over_ground || band.datum == AltitudeBand::Datum::sea) && !keeps_band(band)) {
        return false;
      }
    }
    return !limits_.min_ground_clearance || !over_ground ||
           at_least(world.ground_gap(a_, b_, *limits_.min_ground_clearance),
                    *limits_.min_ground_clearance, kLengthTolerance, "ground_clearance",
                    "the height above ground", " m");
  }

  bool keeps_band(const AltitudeBand& band) const {
    const bool over_sea = band.datum == AltitudeBand::Datum::sea;
    const double least =
        over_sea ? std::min(a_.z(), b_.z()) : request_.world->ground_gap(a_, b_, band.min);
    if (!at_least(least, band.min, kLengthTolerance, "altitude", "the altitude", " m")) {
      return false;
    }
    return band.max == kInfinity ||
           at_most(over_sea ? std::max(a_.z(), b_.z()) : request_.world->ground_gap_max(a_, b_),
                   band.max, kLengthTolerance, "altitude", "the altitude", " m");
  }

  bool keeps_constraints() const {
    return std::all_of(
        request_.constraints.begin(), request_.constraints.end(),
        [&](const NamedConstraint& named) {
          return named.admits({before_ ? std::optional(before_->from) : std::nullopt, a_, b_}) ||
                 report_([&] {
                   return Violation{named.name, at_, 0, 0,
                                    "the constraint does not admit the leg from " + place(a_) +
                                        " to " + place(b_)};
                 });
        });
  }

  bool keeps_off() const {
    const double needed = required_clearance(request_);
    const Layer* layer = request_.world->blocked_by(a_, b_, needed);
    return layer == nullptr || report_([&] {
             double clearance = leg_clearance(*layer->environment, a_, b_);
             // Among all blocking layers, the one nearest to the leg.
             for (const Layer& other : request_.world->layers()) {
               const double its = leg_clearance(*other.environment, a_, b_);
               if (its < clearance && other.environment->blocked(a_, b_, needed)) {
                 clearance = its;
                 layer = &other;
               }
             }
             // The layer may block from around: outside a keep-in zone.
             std::string where = clearance < 0
                                     ? "lies up to " + fixed(-clearance) + " m inside what '" +
                                           layer->id + "' blocks"
                                     : "comes to " + fixed(clearance) + " m of '" + layer->id + "'";
             if (const auto* says = dynamic_cast<const WhatBlocks*>(layer->environment.get())) {
               const std::string what = says->what_blocks(a_, b_, clearance);
               where += what.empty() ? "" : " (" + what + ")";
             }
             return Violation{"clearance", at_, clearance, needed,
                              where + ", where " + fixed(needed) + " m of clearance are needed"};
           });
  }

  const std::optional<Approach>& before_;
  const Vec3& a_;
  const Vec3& b_;
  const Vec3 leg_;
  const Request& request_;
  const Limits& limits_;
  std::size_t at_;
  const Report& report_;
};
}  // namespace

bool leg_ok(const std::optional<Approach>& before, const Vec3& a, const Vec3& b,
            const Request& request) {
  bool ok = true;
  const auto note = [&](const auto&) { return ok = false; };
  LegJudge(before, a, b, request, 0, note).judge();
  return ok;
}

bool turn_ok(const Approach& before, const Vec3& a, const Vec3& b, const Request& request) {
  bool ok = true;
  const auto note = [&](const auto&) { return ok = false; };
  const std::optional<Approach> approach = before;
  LegJudge(approach, a, b, request, 0, note).judge_bend();
  return ok;
}

std::vector<Violation> leg_violations(const std::optional<Approach>& before, const Vec3& a,
                                      const Vec3& b, const Request& request, std::size_t index) {
  std::vector<Violation> all;
  const auto add = [&](const auto& violation) {
    all.push_back(violation());
    return true;
  };
  LegJudge(before, a, b, request, index, add).judge();
  return all;
}

namespace {
/// Result of a constraint's function; exceptions are attributed to the constraint.
template <class Ask>
auto answer_of(const NamedConstraint& named, const Ask& ask) {
  return attributed([&] { return "the constraint '" + named.name + "'"; },
                    [&] { return ask(*named.constraint); });
}
}  // namespace

bool NamedConstraint::admits(const Leg& leg) const {
  return answer_of(*this, [&](const Constraint& asked) { return asked.admits(leg); });
}

CheckResult check(const Route& route, const Request& request) {
  CheckResult result;
  std::vector<Violation>& found = result.violations;
  if (route.empty()) {
    found.push_back({"route", 0, 0, 0, "there is no route"});
    return result;
  }
  if (route.front() != request.start.position) {
    const double off = (route.front() - request.start.position).norm();
    found.push_back(
        {"start", 0, off, 0, "the route begins " + distance_text(off) + " m from the start"});
  }
  if (!request.goal.reached_at(route.back())) {
    const double off = (route.back() - request.goal.position).norm();
    found.push_back({"goal", route.size() - 1, off, request.goal.tolerance_m,
                     "the route ends " + fixed(off) + " m from the goal, whose tolerance is " +
                         fixed(request.goal.tolerance_m) + " m"});
  }
  std::optional<Approach> before = request.before_start();
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    for (Violation& violation : leg_violations(before, route[i], route[i + 1], request, i)) {
      found.push_back(std::move(violation));
    }
    if (route[i + 1] != route[i]) {  // a repeated point hides no turn
      before = onward(before, route[i]);
    }
  }
  const double total = length(route);
  if (total > request.limits.max_route_length + kLengthTolerance) {
    found.push_back(beyond("route_length", 0, total, request.limits.max_route_length, " m",
                           "the route's length", false));
  }
  for (const NamedConstraint& named : request.constraints) {
    for (Violation& violation : answer_of(
             named, [&](const Constraint& asked) { return asked.violations(route, request); })) {
      if (violation.at >= route.size()) {
        throw PluginError("the constraint '" + named.name +
                          "' violated the contract of its interface: it names waypoint " +
                          std::to_string(violation.at) + " of " + std::to_string(route.size()));
      }
      violation.constraint = named.name;
      found.push_back(std::move(violation));
    }
  }
  return result;
}

std::string point_problem(const Vec3& p, const Request& request) {
  // A point has no leg: violations that only a leg of zero length has are left out.
  const std::vector<Violation> found = [&] {
    if (request.limits.min_leg <= 0 && request.constraints.empty()) {
      return leg_violations(std::nullopt, p, p, request, 0);
    }
    Request alone = request;
    alone.limits.min_leg = 0;
    alone.constraints.clear();
    return leg_violations(std::nullopt, p, p, alone, 0);
  }();
  return found.empty() ? "" : place(p) + " cannot be flown: " + found.front().message;
}

namespace {
/// True if every limit is at least as tight as it was; false if one is not a number.
bool no_looser(const Limits& now, const Limits& was) {
  const auto ground = [](const Limits& limits) {
    return limits.min_ground_clearance.value_or(-kInfinity);
  };
  return now.min_clearance >= was.min_clearance && ground(now) >= ground(was) &&
         now.altitude.size() >= was.altitude.size() && now.min_leg >= was.min_leg &&
         now.max_leg <= was.max_leg && now.max_turn_horizontal <= was.max_turn_horizontal &&
         now.max_turn_space <= was.max_turn_space && now.min_turn_radius >= was.min_turn_radius &&
         now.max_climb <= was.max_climb && now.max_route_length <= was.max_route_length &&
         std::equal(was.altitude.begin(), was.altitude.end(), now.altitude.begin(),
                    [](const AltitudeBand& a, const AltitudeBand& b) {
                      return a.datum == b.datum && b.min >= a.min && b.max <= a.max;
                    }) &&
         std::none_of(now.altitude.begin(), now.altitude.end(), [](const AltitudeBand& band) {
           return std::isnan(band.min) || std::isnan(band.max);
         });
}
}  // namespace

void apply_constraints(Request& request, std::vector<NamedConstraint> constraints, AppliesTo to) {
  request.limits = Limits{};
  request.limits.min_clearance = request.vehicle.radius_m;
  request.constraints.clear();
  for (NamedConstraint& named : constraints) {
    const AppliesTo applies = named.constraint->applies_to();
    if (applies == AppliesTo::both || applies == to) {
      const Limits before = request.limits;
      answer_of(named, [&](const Constraint& asked) { asked.tighten(request.limits, request); });
      if (!no_looser(request.limits, before)) {
        throw PluginError(
            "the constraint '" + named.name +
            "' violated the contract of its interface: it loosened a limit, or made it no number");
      }
      request.constraints.push_back(std::move(named));
    }
  }
}
}  // namespace altiplan
