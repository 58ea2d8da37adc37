// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>

#include "reference/random_problem.hpp"

// The judge a second time, by plain formulas and dense samples.
namespace altiplan::reference {

/// How far a rule is broken (positive) or kept (negative) at a leg, and how much finer sampling
/// could still add.
struct Excess {
  double most = -kInfinity;
  double unsure = 1e-6;

  void add(double value) { most = std::max(most, value); }
};
using Excesses = std::map<std::pair<std::string, std::size_t>, Excess>;

/// Angle between two directions, by the law of cosines on unit vectors' difference; stable for all.
inline double angle_between(const Vec3& u, const Vec3& v) {
  if (u.norm() == 0 || v.norm() == 0) {
    return 0;
  }
  return 2 * std::asin(std::min(1.0, (u / u.norm() - v / v.norm()).norm() / 2));
}
inline Vec3 flat(const Vec3& v) { return {v.x(), v.y(), 0}; }

/// Least signed distance of a leg to the scene by `samples` + 1 points of it.
inline double sampled_clearance(const Scene& scene, const Vec3& a, const Vec3& b, int samples) {
  double least = kInfinity;
  for (int n = 0; n <= samples; ++n) {
    const Vec3 p = a + (b - a) * n / samples;
    for (const oracle::Solid& solid : scene.solids) {
      least = std::min(least, oracle::signed_distance(solid, p));
    }
    if (scene.ground) {
      least = std::min(least, scene.ground->above(p) / scene.ground->steepness());
    }
  }
  return least;
}

constexpr int kSamples = 400;

inline void judge_leg(const Scene& scene, const Request& request, const Vec3& a, const Vec3& b,
                      std::size_t at, Excesses& found) {
  const Limits& limits = request.limits;
  const Vec3 leg = b - a;
  found[{"leg_length", at}].add(limits.min_leg - leg.norm());
  found[{"leg_length", at}].add(leg.norm() - limits.max_leg);
  found[{"climb_angle", at}] = {angle_between(leg, flat(leg)) - limits.max_climb, 1e-7};
  if (flat(leg).norm() == 0) {
    found[{"climb_angle", at}].most = (leg.z() != 0 ? kPi / 2 : 0) - limits.max_climb;
  }
  for (const AltitudeBand& band : limits.altitude) {
    const bool sea = band.datum == AltitudeBand::Datum::sea;
    for (const Vec3& p : {a, b}) {  // both grounds are planes: the ends are the extremes
      const double height = sea ? p.z() : scene.ground->above(p);
      found[{"altitude", at}].add(band.min - height);
      found[{"altitude", at}].add(height - band.max);
    }
  }
  if (scene.ground && limits.min_ground_clearance) {
    const double gap = std::min(scene.ground->above(a), scene.ground->above(b));
    found[{"ground_clearance", at}].add(*limits.min_ground_clearance - gap);
  }
  const double needed = std::max(limits.min_clearance, request.vehicle.radius_m);
  found[{"clearance", at}] = {needed - sampled_clearance(scene, a, b, kSamples),
                              leg.norm() / (2 * kSamples) + 1e-6};
}

/// A corner: the directions of its legs, and the heading with which the first one ends.
struct Corner {
  Vec3 in{0, 0, 0}, out{0, 0, 0}, heading{0, 0, 0};

  /// The turn as seen from above; an upright leg turns nowhere.
  double level_turn() const {
    return flat(out).norm() < 1e-6 ? 0 : angle_between(flat(heading), flat(out));
  }
  /// Of the circle that touches both legs at the middle of the shorter one.
  double radius() const {
    const double tangent = std::tan(angle_between(in, out) / 2);
    const bool on_the_spot = flat(in).norm() < 1e-6 && level_turn() > 1e-8;
    return on_the_spot ? 0 : std::min(in.norm(), out.norm()) / 2 / tangent;
  }
};

/// The corner at each waypoint from the second leg on; at the first where the start has a velocity.
inline std::vector<std::pair<std::size_t, Corner>> corners(const Route& route,
                                                           const Request& request) {
  std::vector<std::pair<std::size_t, Corner>> all;
  Vec3 in = request.start.velocity;
  Vec3 heading = in;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    const Vec3 out = route[i + 1] - route[i];
    if (in.norm() > 0) {
      all.push_back({i, {in, out, request.vehicle.turns_on_the_spot ? in : heading}});
      if (request.vehicle.turns_on_the_spot && flat(in).norm() < 1e-6) {
        all.back().second.heading = {0, 0, 0};
      }
    }
    if (out.norm() > 0) {
      in = out;
      heading = flat(out).norm() < 1e-6 ? heading : out;
    }
  }
  return all;
}

inline void judge_bend(const Request& request, const Corner& corner, std::size_t at,
                       Excesses& found) {
  const Limits& limits = request.limits;
  Excess& turn = found[{"turn_angle", at}];
  turn.unsure = 1e-7;
  turn.add(corner.level_turn() - limits.max_turn_horizontal);
  turn.add(angle_between(corner.in, corner.out) - limits.max_turn_space);
  Excess& radius = found[{"turn_radius", at}];
  radius.unsure = 1e-5 * std::max(1.0, limits.min_turn_radius);
  if (limits.min_turn_radius > 0) {
    radius.add(limits.min_turn_radius - corner.radius());
  }
}

/// Every rule at every leg, and of the whole route at 0.
inline Excesses sampled_judge(const Route& route, const Scene& scene, const Request& request) {
  Excesses found;
  double total = 0;
  for (std::size_t i = 0; i + 1 < route.size(); ++i) {
    judge_leg(scene, request, route[i], route[i + 1], i, found);
    total += (route[i + 1] - route[i]).norm();
  }
  for (const auto& [i, corner] : corners(route, request)) {
    judge_bend(request, corner, i, found);
  }
  for (std::size_t i = 0; i < route.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      found[{"volume", i}].add(request.volume.min[axis] - route[i][axis]);
      found[{"volume", i}].add(route[i][axis] - request.volume.max[axis]);
    }
    if (request.level_m) {
      found[{"level_flight", i}].add(std::abs(route[i].z() - *request.level_m));
    }
  }
  found[{"route_length", 0}].add(total - request.limits.max_route_length);
  found[{"start", 0}].add((route.front() - request.start.position).norm());
  found[{"goal", route.size() - 1}].add((route.back() - request.goal.position).norm() -
                                        request.goal.tolerance_m);
  return found;
}
}  // namespace altiplan::reference
