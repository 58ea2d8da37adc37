// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/request.hpp"

namespace altiplan::reference {

/// A sphere in straight flight, as a sensor shows it: where it is at time 0, had it always flown
/// so.
struct Mover {
  Vec3 at_0{0, 0, 0};
  Vec3 velocity{0, 0, 0};
  double radius = 0;
};

/// What is known at one time: layers that stand still, and movers.
///
/// A way is a row of straight legs between times. The vehicle may turn at once and fly slower than
/// its speed: turning to and fro it keeps to any slower mean speed, and the turn limit of the
/// pilots yields to safety. So a leg is flyable where its mean speed is the vehicle's at most, and
/// its mean rate of climb that of the steepest climb allowed.
struct KnownScene {
  World world;
  std::vector<Mover> movers;
  Box volume;
  std::optional<double> level_m;
  double radius = 0;  ///< that the vehicle keeps off: its own, or the least clearance asked for
  double ground_m = -kInfinity;
  double speed = 0;
  double climb_speed = 0;

  KnownScene(World layers, const Request& request)
      : world(std::move(layers)),
        volume(request.volume),
        level_m(request.level_m),
        radius(std::max(request.vehicle.radius_m, request.limits.min_clearance)),
        ground_m(request.limits.min_ground_clearance.value_or(-kInfinity)),
        speed(request.vehicle.speed_mps),
        climb_speed(speed * std::sin(std::min(request.limits.max_climb, kPi / 2))) {}

  /// Least time that the vehicle takes from a to b.
  double min_time(const Vec3& a, const Vec3& b) const {
    const double climb = std::abs(b.z() - a.z());
    return std::max((b - a).norm() / speed, climb == 0 ? 0 : climb / climb_speed);
  }
  bool is_free(const Vec3& a, double t0, const Vec3& b, double t1) const {
    for (const Mover& mover : movers) {
      const double limit = mover.radius + radius - kLengthTolerance;
      if (relative_distance_squared(mover, a, t0, b, t1) < limit * limit) {
        return false;
      }
    }
    return volume.contains(a, kLengthTolerance) && volume.contains(b, kLengthTolerance) &&
           world.ground_below(a, b) && !world.blocked(a, b, radius) &&
           (ground_m == -kInfinity || world.ground_gap(a, b, ground_m) >= ground_m - 1e-6);
  }
  /// Seconds that a straight flight takes to a place where no mover comes any more; infinite where
  /// it leads to none. What it meets on the way there is not looked at.
  double clear_after(const Vec3& from, double time_s, const Vec3& velocity) const {
    double after = 0;
    for (std::size_t i = 0; i < movers.size() && after < kInfinity;) {
      const auto [begins, ends] = threat(movers[i], from, time_s, velocity);
      const bool threatened = begins <= after && after < ends;
      after = threatened ? ends : after;
      i = threatened ? 0 : i + 1;
    }
    return after;
  }

 private:
  /// When, in seconds of that flight, the vehicle is where the mover will come later.
  std::pair<double, double> threat(const Mover& mover, const Vec3& from, double time_s,
                                   const Vec3& velocity) const {
    constexpr std::pair<double, double> kNever{kInfinity, kInfinity};
    const double pace = mover.velocity.norm();
    if (pace == 0) {
      return kNever;
    }
    const Vec3 onward = mover.velocity / pace;
    const Vec3 r = from - mover.at_0 - mover.velocity * time_s;
    // Within the tube that it sweeps ...
    const Vec3 off = r - onward * r.dot(onward);
    const Vec3 aside = velocity - onward * velocity.dot(onward);
    const double limit = mover.radius + radius;
    const double a = aside.squaredNorm();
    const double b = off.dot(aside);
    const double c = off.squaredNorm() - limit * limit;
    const double root = b * b - a * c;
    const bool along = a < 1e-12 * speed * speed;
    if (along ? c >= 0 : root <= 0) {
      return kNever;
    }
    double begins = along ? -kInfinity : (-b - std::sqrt(root)) / a;
    double ends = along ? kInfinity : (-b + std::sqrt(root)) / a;
    // ... and before it.
    const double ahead = r.dot(onward);
    const double gains = velocity.dot(onward) - pace;
    if (gains == 0) {
      return ahead > 0 ? std::pair(begins, ends) : kNever;
    }
    (gains > 0 ? begins : ends) =
        gains > 0 ? std::max(begins, -ahead / gains) : std::min(ends, -ahead / gains);
    return begins < ends ? std::pair(begins, ends) : kNever;
  }

  /// The mover seen from the vehicle flies a straight leg.
  static double relative_distance_squared(const Mover& mover, const Vec3& a, double t0,
                                          const Vec3& b, double t1) {
    const Vec3 from = a - mover.at_0 - mover.velocity * t0;
    const Vec3 way = b - a - mover.velocity * (t1 - t0);
    const double run = way.squaredNorm();
    const double share = run > 0 ? std::clamp(-from.dot(way) / run, 0.0, 1.0) : 0;
    return (from + share * way).squaredNorm();
  }
};
}  // namespace altiplan::reference
