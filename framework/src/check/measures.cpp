// SPDX-License-Identifier: Apache-2.0
#include "altiplan/measures.hpp"

#include <algorithm>
#include <cmath>

#include "altiplan/energy.hpp"
#include "altiplan/flown_route.hpp"
#include "altiplan/ground.hpp"
#include "altiplan/nearest_place.hpp"
#include "deepest_place.hpp"
#include "uniform_motion.hpp"

namespace altiplan {
namespace {

/// Relative error bound of greatest_free_radius.
constexpr double kFine = 1e-9;

/// The largest r for which the leg is not blocked, so that it agrees with the judge.
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
  // One query may save the search: a leg that is free slightly above `enough` has at least that.
  const double above = enough > 0 ? enough * (1 + 4 * kFine) + 2 * kLengthTolerance : 0;
  if (std::isfinite(enough) && !environment.blocked(a, b, above)) {
    return enough;
  }
  return greatest_free_radius(environment, a, b);
}

double leg_duration(const World& world, const Vehicle& vehicle, const Vec3& a, const Vec3& b) {
  double time = 0;
  at_its_speeds(world, vehicle, a, b, [&](double, double, double seconds) { time += seconds; });
  return time;
}

double leg_duration(const Leg& leg, const Request& request) {
  return leg_duration(leg, request.start.time_s, request);
}

double leg_duration(const Leg& leg, double time_s, const Request& request) {
  if (leg.waits()) {
    return leg.hold_s;
  }
  if (leg.turns()) {
    return std::max(leg.air_length() / request.air_speed(),
                    request.vehicle.climb_time(leg.to.z() - leg.from.z()));
  }
  // No time is known after a leg that is not flown.
  const double from_s = request.wind.changes.empty() || !std::isfinite(time_s) ? 0 : time_s;
  double end_s = from_s;
  in_uniform_motion(leg, from_s, request, [&](const Vec3&, double, const Vec3&, double until_s) {
    end_s = until_s;
    return true;
  });
  return end_s - from_s;
}

namespace {

/// Climb angle of a leg over the ground, signed.
double slope_of(const Leg& leg) {
  const Vec3 way = leg.to - leg.from;
  return leg.turns() ? std::asin(std::clamp(way.z() / leg.length(), -1.0, 1.0))
                     : std::atan2(way.z(), std::hypot(way.x(), way.y()));
}

void measure_legs(const Route& route, const Request& request, Measures& m) {
  double climb = 0;
  double duration = 0;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    climb = std::max(climb, std::abs(slope_of(leg)));
    duration += leg_duration(leg, request.start.time_s + duration, request);
  }
  m.max_climb_deg = degrees(climb);
  m.duration_s = duration;
  m.time_s = flown_time(route, request);
  if (request.vehicle.energy != nullptr) {
    m.energy_wh = flown_energy(route, request, *request.vehicle.energy->power);
  }
}

/// Corners between legs, and turns.
void measure_turns(const Route& route, const Request& request, Measures& m) {
  double turn = 0;
  double radius = kInfinity;
  double smoothness = 0;
  const bool on_the_spot = request.vehicle.turns_on_the_spot;
  std::optional<Approach> before;
  for (std::size_t i = 0; i < route.leg_count(); ++i) {
    const Leg leg = route.leg(i);
    if (leg.waits()) {
      continue;
    }
    if (before) {
      const Vec3 onto = leg.from + leg.track(0);
      const double angle = horizontal_turn(*before, leg.from, onto, on_the_spot);
      turn = std::max(turn, angle);
      smoothness += angle + std::abs(slope_of(leg) - slope_of(route.leg(i - 1)));
      if (!leg.turns() && !before->turning) {
        radius = std::min(radius, corner_radius(*before, leg.from, leg.to, on_the_spot));
      }
    }
    if (leg.turns()) {
      radius = std::min(radius, leg.radius);
      smoothness += std::abs(leg.turn);
    }
    before = onward(before, leg);
  }
  m.max_turn_deg = degrees(turn);
  m.smoothness_rad = smoothness;
  if (std::isfinite(radius)) {
    m.min_radius_m = radius;
  }
}
/// A layer lies at least so far from the route, by their boxes.
double box_distance(const Environment& layer, const Route& route) {
  const Box box = layer.bounds();
  if (layer.over_approximation() > 0 || !box.is_bounded()) {
    return 0;
  }
  double distance = kInfinity;
  for (std::size_t i = 0; i < std::max<std::size_t>(route.leg_count(), 1); ++i) {
    const Box leg = route.leg_count() > 0 ? route.leg(i).box() : leg_box(route[0], route[0]);
    const Vec3 between = (leg.min - box.max).cwiseMax(box.min - leg.max).cwiseMax(0.0);
    distance = std::min(distance, between.norm());
  }
  return distance;
}

/// The layers by their minimum clearance from a waypoint: where a near one is measured first, one
/// query a leg shows that the others are further away.
std::vector<std::pair<double, const Environment*>> nearest_first(const World& world,
                                                                 const Route& route) {
  std::vector<std::pair<double, const Environment*>> layers;
  for (const Layer& layer : world.layers()) {
    double min_clearance = kInfinity;
    for (std::size_t i = 0; i < route.size(); ++i) {
      min_clearance = std::min(min_clearance, layer.environment->clearance(route[i]));
    }
    layers.emplace_back(min_clearance, layer.environment.get());
  }
  std::stable_sort(layers.begin(), layers.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return layers;
}
}  // namespace

Measures measure(const Route& route, const Request& request) {
  Measures m;
  m.waypoints = route.size();
  m.length_m = length(route);
  if (route.empty()) {
    return m;
  }
  const World& world = *request.world;
  const Route legs = without_repeats(route);
  if (legs.leg_count() > 0) {
    measure_legs(legs, request, m);
  }
  if (legs.leg_count() > 1 || !legs.is_straight()) {
    measure_turns(legs, request, m);
  }
  constexpr double kFineChords = 1e-4;  // metres
  Polyline points = legs.chords(kFineChords);
  if (points.size() == 1) {
    points.push_back(points.front());
  }
  double clearance = kInfinity;
  for (const auto& [min_clearance, layer] : nearest_first(world, legs)) {
    // Inside of one layer another may still be deeper.
    if (box_distance(*layer, legs) > std::max(clearance, 0.0)) {
      continue;
    }
    if (const auto nearest = nearest_leg(*layer, points, clearance)) {
      clearance = nearest->distance;
    }
  }
  if (std::isfinite(clearance)) {
    m.min_clearance_m = clearance;
  }
  if (const auto lowest = lowest_leg(world, points)) {
    m.min_ground_clearance_m = lowest->distance;
  }
  return m;
}
}  // namespace altiplan
