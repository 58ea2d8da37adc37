// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "altiplan/kit/sampling/star_search.hpp"
#include "altiplan/params.hpp"

namespace altiplan::kit {

/// The parameters of rrt_star and informed_rrt_star.
struct StarParams {
  AutoNumber range_m;
  double goal_bias = 0.05;
  double radius_scale = 1.1;
  int max_iterations = 20'000;

  void describe(Fields& f) {
    f("range_m", range_m)
        .unit("m")
        .greater_than(0)
        .doc("longest leg that the tree grows by; auto: a tenth of the volume's diagonal");
    f("goal_bias", goal_bias)
        .range(0, 1)
        .doc("share of the samples that are the goal, until it is in the tree");
    f("radius_scale", radius_scale)
        .range(1, 10)
        .doc("radius of the neighbours over the least one that makes the length converge");
    f("max_iterations", max_iterations)
        .at_least(1)
        .doc("samples; all of them are used if the budget allows");
  }

  StarSettings settings(const Request& request) const {
    StarSettings settings;
    settings.range = range_of(range_m.value, request);
    settings.goal_bias = goal_bias;
    settings.radius_scale = radius_scale;
    settings.max_iterations = std::uint64_t(max_iterations);
    return settings;
  }
  static Traits traits() {
    Traits traits;
    traits.anytime = true;
    return traits;
  }
};
}  // namespace altiplan::kit
