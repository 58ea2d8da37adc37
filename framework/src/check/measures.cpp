// SPDX-License-Identifier: Apache-2.0
#include "altiplan/measures.hpp"

#include <algorithm>

#include "altiplan/ground.hpp"
#include "altiplan/nearest_place.hpp"
#include "deepest_place.hpp"

namespace altiplan {
namespace {

/// Bounds the error of greatest_free_radius, as a share of what it finds.
constexpr double kFine = 1e-9;

/// The greatest r for which the leg is not blocked, so that it agrees with the judge.
double greatest_free_radius(const Environment& solid, const Vec3& a, const Vec3& b) {
  constexpr double kFar = 1e7;
  if (solid.blocked(a, b, 0)) {
    return std::min(0.0, deepest_place(solid, a, b).clearance);
  }
  if (const Ground* ground = solid.ground(); ground != nullptr && ground->is_all()) {
    if (const auto distance = ground->distance(a, b)) {
      return *distance;
    }
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
  constexpr double kMinStep = 1;
  double time = 0;
  double along = 0;
  while (along < total) {
    const double clearance = world.clearance(a + along / total * (b - a));
    double step = kInfinity;
    for (const SpeedNear& near : vehicle.speed_near) {
      step = std::min(step, std::abs(clearance - near.within_m));
    }
    step = std::min(std::max(step, kMinStep), total - along);
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
    const bool on_the_spot = request.vehicle.turns_on_the_spot;
    std::optional<Approach> before;
    for (std::size_t i = 1; i + 1 < bends.size(); ++i) {
      before = onward(before, bends[i - 1]);
      const Vec3 in = bends[i] - bends[i - 1];
      const Vec3 out = bends[i + 1] - bends[i];
      const double angle = horizontal_turn(*before, bends[i], bends[i + 1], on_the_spot);
      const auto climb = [](const Vec3& leg) {
        return std::atan2(leg.z(), std::hypot(leg.x(), leg.y()));
      };
      turn = std::max(turn, angle);
      radius = std::min(radius, corner_radius(*before, bends[i], bends[i + 1], on_the_spot));
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
    if (const auto nearest = nearest_leg(*layer.environment, legs, clearance)) {
      clearance = nearest->distance;
    }
  }
  if (std::isfinite(clearance)) {
    m.min_clearance_m = clearance;
  }
  if (const auto lowest = lowest_leg(world, legs)) {
    m.min_ground_clearance_m = lowest->distance;
  }
  return m;
}
}  // namespace altiplan
