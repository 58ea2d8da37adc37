// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "support/support.hpp"

namespace altiplan::testing {

/// Ground z = 100 + x / 10 west of a ridge, closed form: a tilted plane.
class Slope final : public Environment, public Ground {
  static constexpr double kRise = 0.1;
  static double ground_at(double x) { return 100 + kRise * x; }
  Box do_bounds() const override { return {}; }
  double do_clearance(const Vec3& p) const override {
    return (p.z() - ground_at(p.x())) / std::sqrt(1 + kRise * kRise);
  }
  double do_over_approximation() const override { return 0; }
  bool do_blocked(const Vec3& a, const Vec3& b, double r) const override {
    return std::min(do_clearance(a), do_clearance(b)) < r - kLengthTolerance;
  }
  const Ground* do_ground() const override { return this; }
  std::optional<double> do_height(double x, double) const override { return ground_at(x); }
  double do_gap(const Vec3& a, const Vec3& b, double) const override {
    return std::min(a.z() - ground_at(a.x()), b.z() - ground_at(b.x()));
  }
};

/// 30 km square, flown at 30 m/s.
inline Request problem(World world, const Vec3& start, const Vec3& goal) {
  Request request = request_in(std::move(world), start, goal, {{0, 0, 0}, {30e3, 30e3, 4000}});
  request.vehicle.speed_mps = 30;
  request.vehicle.radius_m = 2;
  request.limits.min_clearance = 2;
  request.limits.max_climb = radians(15);
  return request;
}
}  // namespace altiplan::testing
