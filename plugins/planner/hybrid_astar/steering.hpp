// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "altiplan/kit/dubins/wind.hpp"
#include "altiplan/request.hpp"

namespace altiplan::hybrid_astar {

/// The motion of an aeroplane in a request: its limits, the air, and what it flies in one piece.
class Steering {
 public:
  Steering(const Request& request, double radius)
      : speed_(request.air_speed()), wind_(request.wind), goal_(request.goal) {
    limits_.radius = radius;
    // A vertical climb has no heading.
    constexpr double kSteepest = radians(75);
    const Limits& limits = request.limits;
    limits_.climb = request.level_m ? 0 : std::min(limits.max_climb, kSteepest);
    limits_.sink = request.level_m ? 0 : std::min(limits.max_descent(), kSteepest);
    for (const Wind::Layer& layer : wind_.layers) {
      strongest_ = std::max(strongest_, layer.velocity.norm());
    }
  }

  const kit::AirplaneLimits& limits() const { return limits_; }
  /// True if the wind can hold the aeroplane in one place.
  bool is_too_windy() const { return strongest_ >= speed_; }

  /// A piece of a given length through the air: with a turn (radians, 0: straight) and a gradient.
  Leg piece(const Pose& from, double length, double turn, double gradient) const {
    const Vec3 drift = length / speed_ * wind_.at(from.position.z());
    const double climb = gradient * length;
    if (turn != 0) {
      return Leg::turning(from, turn, length / std::abs(turn), climb, drift);
    }
    return Leg::straight(from.position, from.position + length * unit_heading(from.heading) +
                                            drift + Vec3(0, 0, climb));
  }

  /// The shortest path through the air to a pose without obstacles; none if there is none.
  std::optional<std::vector<Leg>> path(const Pose& from, const Pose& to, double& length) const {
    const Vec3 wind = wind_.at((from.position.z() + to.position.z()) / 2);
    if (wind.isZero(0)) {
      const auto path = kit::airplane_path(from, to, limits_);
      length = path ? path->length() : kInfinity;
      return path ? std::optional(path->legs(from, to.position)) : std::nullopt;
    }
    const auto path = kit::wind_path(from, to, limits_, {speed_, wind});
    length = path ? path->through_air.length() : kInfinity;
    return path ? std::optional(path->legs(from, to.position)) : std::nullopt;
  }

  /// A lower bound on the length through the air to the goal without obstacles, of which the ground
  /// covered takes at least `over_ground`.
  double least_length(const Pose& from, double over_ground) const {
    if (goal_.tolerance_m > 0) {
      return std::max(0.0, over_ground - goal_.tolerance_m);
    }
    const double rise = goal_.position.z() - from.position.z();
    const double length = std::max(over_ground, limits_.least_length(rise));
    return strongest_ == 0 && goal_.heading
               ? std::max(length,
                          kit::airplane_length(from, {goal_.position, *goal_.heading}, limits_))
               : length;
  }

 private:
  kit::AirplaneLimits limits_;
  double speed_;
  double strongest_ = 0;  ///< wind, m/s
  const Wind& wind_;
  const Goal& goal_;
};
}  // namespace altiplan::hybrid_astar
