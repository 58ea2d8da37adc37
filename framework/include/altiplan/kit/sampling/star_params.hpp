// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/dubins/steering_params.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "altiplan/kit/sampling/star_search.hpp"
#include "altiplan/params.hpp"

namespace altiplan::kit {

/// Common parameters of rrt_star and informed_rrt_star.
struct StarParams : SteeringParams {
  AutoNumber range_m;
  double goal_bias = 0.05;
  double route_bias = 0.25;
  double radius_scale = 1.1;
  int max_iterations = 20'000;

  void describe(Fields& f) {
    f("range_m", range_m)
        .unit("m")
        .greater_than(0)
        .doc(
            "maximum length of the tree's edges; auto: a tenth of the volume's diagonal, with "
            "turns "
            "at least a circle");
    f("goal_bias", goal_bias)
        .range(0, 1)
        .was("goal_share")
        .doc("probability of sampling the goal, until it is in the tree");
    f("route_bias", route_bias)
        .range(0, 0.9)
        .doc("probability of sampling near a point of the best route, once there is one");
    f("radius_scale", radius_scale)
        .range(1, 10)
        .doc("neighbour radius relative to the smallest one with which the length converges");
    f("max_iterations", max_iterations)
        .at_least(1)
        .doc("number of samples; all are used if the budget allows");
    SteeringParams::describe(f);
  }

  StarSettings settings(const Request& request) const {
    StarSettings settings;
    settings.turn_radius = turn_radius(request);
    settings.range = range(range_of(range_m.value, request), !range_m.value, settings.turn_radius);
    settings.goal_bias = goal_bias;
    settings.route_bias = route_bias;
    settings.radius_scale = radius_scale;
    settings.max_iterations = std::uint64_t(max_iterations);
    return settings;
  }
  Traits traits() const {
    Traits traits;
    traits.loiters = loiters();
    traits.anytime = true;
    traits.objectives = true;
    return traits;
  }
};
}  // namespace altiplan::kit
