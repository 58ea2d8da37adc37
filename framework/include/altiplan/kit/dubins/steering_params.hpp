// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "altiplan/params.hpp"
#include "altiplan/request.hpp"

namespace altiplan::kit {

/// Common parameters of planners that steer with straight legs or with Dubins paths.
struct SteeringParams {
  enum class Kind { automatic, straight, dubins };
  Kind steering = Kind::automatic;
  AutoNumber radius_m;

  void describe(Fields& f) {
    f("steering", steering,
      {{"auto", Kind::automatic}, {"straight", Kind::straight}, {"dubins", Kind::dubins}})
        .doc(
            "how nodes are joined: by straight legs, or as poses by Dubins paths, which takes a "
            "turn radius; auto: dubins for a vehicle with a wing");
    f("radius_m", radius_m)
        .unit("m")
        .greater_than(0)
        .doc("radius of turns; auto: the smallest that vehicle and constraints allow");
  }

  /// The turn radius to steer with, metres; 0: straight legs.
  double turn_radius(const Request& request) const {
    const bool turns = steering == Kind::dubins ||
                       (steering == Kind::automatic && request.vehicle.wing.has_value());
    return turns ? std::max(request.limits.min_turn_radius, radius_m.value.value_or(0)) : 0;
  }
  /// The trait `loiters`.
  bool loiters() const { return steering != Kind::straight; }
  /// Maximum length of an edge: by default that of straight legs, or a whole turn if that is more.
  static double range(double straight_range, bool is_auto, double turn_radius) {
    return is_auto ? std::max(straight_range, 2 * kPi * turn_radius) : straight_range;
  }
};
}  // namespace altiplan::kit
