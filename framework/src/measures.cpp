// SPDX-License-Identifier: Apache-2.0
#include "altiplan/measures.hpp"

#include <algorithm>

namespace altiplan {
namespace {

/// Least signed clearance along a leg that goes into the layer, by branch and bound on the
/// 1-Lipschitz clearance, within a ten-thousandth of the leg's length.
double deepest(const std::function<double(const Vec3&)>& clearance, const Vec3& a, const Vec3& b) {
  const double total = (b - a).norm();
  const double tolerance = std::max(1e-3, total * 1e-4);
  double least = std::min(clearance(a), clearance(b));
  std::vector<std::pair<double, double>> open{{0, 1}};
  while (!open.empty()) {
    const auto [t0, t1] = open.back();
    open.pop_back();
    const double middle = (t0 + t1) / 2;
    const double here = clearance(a + middle * (b - a));
    least = std::min(least, here);
    if (here - (t1 - t0) / 2 * total < least - tolerance) {
      open.emplace_back(t0, middle);
      open.emplace_back(middle, t1);
    }
  }
  return least;
}

/// Bounds the error of greatest_free_radius, as a share of what it finds.
constexpr double kFine = 1e-9;

/// The greatest r for which the leg is not blocked, so that it agrees with the judge.
double greatest_free_radius(const Environment& solid, const Vec3& a, const Vec3& b) {
  constexpr double kFar = 1e7;
  if (solid.blocked(a, b, 0)) {
    return std::min(0.0, deepest([&](const Vec3& p) { return solid.clearance(p); }, a, b));
  }
  double free = 0;
  double met = 1;
  while (!solid.blocked(a, b, met)) {
    free = met;
    met *= 2;
    if (met > kFar) {
      return kInfinity;
    }
  }
  while (met - free > kFine * std::max(1.0, met)) {
    const double middle = (free + met) / 2;
    (solid.blocked(a, b, middle) ? met : free) = middle;
  }
  return std::max(0.0, free - kLengthTolerance);  // touching within the tolerance counts as free
}
/// Least clearance of the route's legs. Those that come nearest by the clearance of their middles
/// are measured first, and the others only where they may be nearer still.
double least_clearance(const Environment& environment, const Route& route, double enough) {
  struct Candidate {
    double at_least;
    std::size_t leg;
  };
  std::vector<Candidate> legs;
  const double spare = environment.slack() + 2 * kLengthTolerance;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const double clearance = environment.clearance((route[i] + route[i + 1]) / 2);
    const double at_least = clearance - (route[i + 1] - route[i]).norm() / 2 - spare;
    legs.push_back({std::isnan(at_least) ? -kInfinity : at_least, i});
  }
  std::sort(legs.begin(), legs.end(),
            [](const Candidate& x, const Candidate& y) { return x.at_least < y.at_least; });
  double least = enough;
  for (const Candidate& candidate : legs) {
    if (candidate.at_least >= least) {
      break;
    }
    const std::size_t i = candidate.leg;
    least = std::min(least, leg_clearance(environment, route[i], route[i + 1], least));
  }
  return least;
}
}  // namespace

double leg_clearance(const Environment& environment, const Vec3& a, const Vec3& b, double enough) {
  // One question spares the search: a leg that is free a little above `enough` has at least that.
  const double above = enough > 0 ? enough * (1 + 4 * kFine) + 2 * kLengthTolerance : 0;
  if (std::isfinite(enough) && !environment.blocked(a, b, above)) {
    return enough;
  }
  return greatest_free_radius(environment, a, b);
}

double leg_duration(const World& world, const Vehicle& vehicle, const Vec3& a, const Vec3& b) {
  const double total = (b - a).norm();
  if (vehicle.speed_near.empty()) {
    return total / vehicle.speed_mps;
  }
  // Clearance changes by at most a metre a metre: the speed holds until a threshold can be met.
  constexpr double kLeastStep = 1;
  double time = 0;
  double along = 0;
  while (along < total) {
    const double clearance = world.clearance(a + along / total * (b - a));
    double step = kInfinity;
    for (const SpeedNear& near : vehicle.speed_near) {
      step = std::min(step, std::abs(clearance - near.within_m));
    }
    step = std::min(std::max(step, kLeastStep), total - along);
    time += step / vehicle.speed_at(clearance);
    along += step;
  }
  return time;
}

Measures measure(const Route& route, const Request& request) {
  Measures m;
  m.waypoints = route.size();
  m.length_m = length(route);
  if (route.empty()) {
    return m;
  }
  const World& world = *request.world;
  const Route bends = without_repeats(route);
  if (bends.size() >= 2) {
    double climb = 0;
    double duration = 0;
    for (std::size_t i = 0; i + 1 < bends.size(); ++i) {
      climb = std::max(climb, climb_angle(bends[i + 1] - bends[i]));
      duration += leg_duration(world, request.vehicle, bends[i], bends[i + 1]);
    }
    m.max_climb_deg = degrees(climb);
    m.duration_s = duration;
  }
  if (bends.size() >= 3) {
    double turn = 0;
    double radius = kInfinity;
    double smoothness = 0;
    for (std::size_t i = 1; i + 1 < bends.size(); ++i) {
      const Vec3 in = bends[i] - bends[i - 1];
      const Vec3 out = bends[i + 1] - bends[i];
      const double angle = turn_angle_horizontal(in, out);
      const auto climb = [](const Vec3& leg) {
        return std::atan2(leg.z(), std::hypot(leg.x(), leg.y()));
      };
      turn = std::max(turn, angle);
      radius = std::min(radius, radius_through(bends[i - 1], bends[i], bends[i + 1]));
      smoothness += angle + std::abs(climb(out) - climb(in));
    }
    m.max_turn_deg = degrees(turn);
    m.smoothness_rad = smoothness;
    if (std::isfinite(radius)) {
      m.min_radius_m = radius;
    }
  }
  const Route legs = bends.size() > 1 ? bends : Route{bends.front(), bends.front()};
  double clearance = kInfinity;
  for (const Layer& layer : world.layers()) {
    clearance = least_clearance(*layer.environment, legs, clearance);
  }
  double ground = kInfinity;
  for (std::size_t i = 0; i + 1 < legs.size(); ++i) {
    ground = std::min(ground, world.ground_gap(legs[i], legs[i + 1], ground));
  }
  if (std::isfinite(clearance)) {
    m.min_clearance_m = clearance;
  }
  if (std::isfinite(ground)) {
    m.min_ground_clearance_m = ground;
  }
  return m;
}
}  // namespace altiplan
