// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "altiplan/leg.hpp"

namespace altiplan::bench {

/// A disc that blocks, with the vehicle's clearance.
struct Disc {
  double x;
  double y;
  double radius;
};

/// A problem in a square around the origin.
struct DiscProblem {
  double half_edge;
  double turn_radius;
  std::vector<Disc> discs;
  Pose start;
  Pose goal;
};

struct OmplStarResult {
  bool solved = false;
  double length = 0;
  std::size_t nodes = 0;
};

/// OMPL's RRT* in its DubinsStateSpace, in a process of its own: at some pairs of states assertions
/// of DubinsStateSpace fail, which end the process. Then it is tried again; `nodes` is 0 where no
/// try succeeds.
OmplStarResult ompl_dubins_star(const DiscProblem& problem, double range, double goal_bias,
                                double seconds);
}  // namespace altiplan::bench
