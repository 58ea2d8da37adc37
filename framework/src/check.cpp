// SPDX-License-Identifier: Apache-2.0
#include "altiplan/check.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "altiplan/measures.hpp"

namespace altiplan {
namespace {

std::string fixed(double value, int digits = 2) {
  char buffer[64];
  const int n = std::snprintf(buffer, sizeof buffer, "%.*f", digits, value);
  for (int i = 0; i < n; ++i) {
    if (buffer[i] == ',') {
      buffer[i] = '.';  // a locale with a decimal comma
    }
  }
  return {buffer, static_cast<std::size_t>(n)};
}

std::string place(const Vec3& p) {
  return "(" + fixed(p.x()) + ", " + fixed(p.y()) + ", " + fixed(p.z()) + ")";
}

/// A quantity beyond its limit, with the sentence that says so.
Violation beyond(const char* rule, std::size_t at, double value, double limit, const char* unit,
                 const std::string& what, bool too_small) {
  return {rule, at, value, limit,
          what + " is " + fixed(value) + unit + ", " + (too_small ? "below" : "above") +
              " the limit of " + fixed(limit) + unit};
}

/// Where a leg with no ground below part of it comes to the first such part.
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

/// The worst that the leg does against every rule, one call of `report` a broken rule; stops at the
/// first when report returns false. The cheap rules come first.
template <class Report>
void judge_leg(const std::optional<Vec3>& before, const Vec3& a, const Vec3& b,
               const Request& request, std::size_t at, const Report& report) {
  const Limits& limits = request.limits;
  const Vec3 leg = b - a;
  if (!is_finite(a) || !is_finite(b)) {
    report([&] { return Violation{"finite", at, 0, 0, "a coordinate is not finite"}; });
    return;
  }
  for (const auto& [p, index] : {std::pair(&a, at), std::pair(&b, at + 1)}) {
    if (!request.volume.contains(*p, kLengthTolerance)) {
      const double outside =
          std::max((request.volume.min - *p).maxCoeff(), (*p - request.volume.max).maxCoeff());
      if (!report([&, i = index, q = *p] {
            return Violation{"volume", i, outside, 0,
                             place(q) + " lies " + fixed(outside) + " m outside the volume"};
          })) {
        return;
      }
    }
    if (request.level_m && std::abs(p->z() - *request.level_m) > kLengthTolerance) {
      if (!report([&, i = index, q = *p] {
            return Violation{
                "level_flight", i, q.z(), *request.level_m,
                place(q) + " is not on the level of " + fixed(*request.level_m) + " m"};
          })) {
        return;
      }
    }
  }
  const double run = leg.norm();
  if (run < limits.min_leg - kLengthTolerance && !report([&] {
        return beyond("leg_length", at, run, limits.min_leg, " m", "the leg's length", true);
      })) {
    return;
  }
  if (run > limits.max_leg + kLengthTolerance && !report([&] {
        return beyond("leg_length", at, run, limits.max_leg, " m", "the leg's length", false);
      })) {
    return;
  }
  const double climb = climb_angle(leg);
  if (climb > limits.max_climb + kAngleTolerance && !report([&] {
        return beyond("climb_angle", at, degrees(climb), degrees(limits.max_climb), " degrees",
                      "the climb angle", false);
      })) {
    return;
  }
  if (before) {
    const Vec3 incoming = a - *before;
    const std::pair<double, double> turns[] = {
        {turn_angle_horizontal(incoming, leg), limits.max_turn_horizontal},
        {turn_angle_in_space(incoming, leg), limits.max_turn_space}};
    for (const auto& [turn, limit] : turns) {
      if (turn > limit + kAngleTolerance && !report([&, t = turn, l = limit] {
            return beyond("turn_angle", at, degrees(t), degrees(l), " degrees", "the turn angle",
                          false);
          })) {
        return;
      }
    }
    if (limits.min_turn_radius > 0) {
      const double radius = radius_through(*before, a, b);
      if (radius < limits.min_turn_radius - kLengthTolerance && !report([&] {
            return beyond("turn_radius", at, radius, limits.min_turn_radius, " m",
                          "the turn radius", true);
          })) {
        return;
      }
    }
  }
  const bool over_ground = request.world->ground_below(a, b);
  if (!over_ground && !report([&] {
        return Violation{"ground", at, 0, 0,
                         "there is no ground of known height below " +
                             place(ground_ends(*request.world, a, b)) + ", a place of the leg"};
      })) {
    return;
  }
  const double low = std::min(a.z(), b.z());
  const double high = std::max(a.z(), b.z());
  for (const AltitudeBand& band : limits.altitude) {
    const bool over_sea = band.datum == AltitudeBand::Datum::sea;
    if (!over_sea && !over_ground) {
      continue;
    }
    const double least = over_sea ? low : request.world->ground_gap(a, b, band.min);
    if (least < band.min - kLengthTolerance && !report([&, l = least, m = band.min] {
          return beyond("altitude", at, l, m, " m", "the altitude", true);
        })) {
      return;
    }
    if (band.max == kInfinity) {
      continue;
    }
    const double most = over_sea ? high : request.world->ground_gap_max(a, b);
    if (most > band.max + kLengthTolerance && !report([&, m = most, l = band.max] {
          return beyond("altitude", at, m, l, " m", "the altitude", false);
        })) {
      return;
    }
  }
  if (limits.min_ground_clearance && over_ground) {
    const double least = *limits.min_ground_clearance;
    const double gap = request.world->ground_gap(a, b, least);
    if (gap < least - kLengthTolerance && !report([&] {
          return beyond("ground_clearance", at, gap, least, " m", "the height above ground", true);
        })) {
      return;
    }
  }
  for (const NamedConstraint& named : request.constraints) {
    if (!named.constraint->admits({before, a, b}) && !report([&] {
          return Violation{named.name, at, 0, 0, "the constraint does not admit this leg"};
        })) {
      return;
    }
  }
  const double needed = required_clearance(request);
  if (const Layer* layer = request.world->blocked_by(a, b, needed)) {
    report([&] {
      const double clearance = leg_clearance(*layer->environment, a, b);
      return Violation{"clearance", at, clearance, needed,
                       "comes to " + fixed(clearance) + " m of '" + layer->id + "', where " +
                           fixed(needed) + " m are needed"};
    });
  }
}
}  // namespace

bool leg_ok(const std::optional<Vec3>& before, const Vec3& a, const Vec3& b,
            const Request& request) {
  bool ok = true;
  judge_leg(before, a, b, request, 0, [&](const auto&) { return ok = false; });
  return ok;
}

std::vector<Violation> leg_violations(const std::optional<Vec3>& before, const Vec3& a,
                                      const Vec3& b, const Request& request, std::size_t index) {
  std::vector<Violation> all;
  judge_leg(before, a, b, request, index, [&](const auto& violation) {
    all.push_back(violation());
    return true;
  });
  return all;
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
        {"start", 0, off, 0, "the route begins " + fixed(off, 6) + " m from the start"});
  }
  if (!request.goal.reached_at(route.back())) {
    const double off = (route.back() - request.goal.position).norm();
    found.push_back({"goal", route.size() - 1, off, request.goal.tolerance_m,
                     "the route ends " + fixed(off) + " m from the goal, whose tolerance is " +
                         fixed(request.goal.tolerance_m) + " m"});
  }
  std::optional<Vec3> before = request.before_start();
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    for (Violation& violation : leg_violations(before, route[i], route[i + 1], request, i)) {
      found.push_back(std::move(violation));
    }
    before = route[i];
  }
  const double total = length(route);
  if (total > request.limits.max_route_length + kLengthTolerance) {
    found.push_back(beyond("route_length", 0, total, request.limits.max_route_length, " m",
                           "the route's length", false));
  }
  for (const NamedConstraint& named : request.constraints) {
    for (Violation& violation : named.constraint->violations(route, request)) {
      violation.constraint = named.name;
      found.push_back(std::move(violation));
    }
  }
  return result;
}

std::string point_problem(const Vec3& p, const Request& request) {
  const std::vector<Violation> found = [&] {
    Request alone = request;  // a point has no leg: what a leg of no length cannot keep is left out
    alone.limits.min_leg = 0;
    alone.constraints.clear();
    return leg_violations(std::nullopt, p, p, alone, 0);
  }();
  return found.empty() ? "" : place(p) + " cannot be flown: " + found.front().message;
}

void apply_constraints(Request& request, std::vector<NamedConstraint> constraints, AppliesTo to) {
  request.limits = Limits{};
  request.limits.min_clearance = request.vehicle.radius_m;
  request.constraints.clear();
  for (NamedConstraint& named : constraints) {
    const AppliesTo applies = named.constraint->applies_to();
    if (applies == AppliesTo::both || applies == to) {
      named.constraint->tighten(request.limits, request);
      request.constraints.push_back(std::move(named));
    }
  }
}
}  // namespace altiplan
