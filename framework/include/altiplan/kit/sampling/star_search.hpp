// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "altiplan/kit/sampling/leg_tree.hpp"
#include "altiplan/kit/sampling/point_grid.hpp"
#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"

namespace altiplan::kit {

struct StarSettings {
  double range = 0;         ///< metres; maximum length of the tree's edges (eta)
  double goal_bias = 0;     ///< fraction of samples that are the goal, until it is in the tree
  double route_bias = 0;    ///< fraction of samples near the best route's inner points
  double radius_scale = 1;  ///< in units of the smallest radius that converges
  std::uint64_t max_iterations = 0;
  bool bounded = false;    ///< once a route is known, restrict the tree to points on shorter ones
  bool informed = false;   ///< and sample only there
  double turn_radius = 0;  ///< metres; 0: nodes are points joined by straight legs, else poses
                           ///< joined by Dubins paths
};

/// Memory that the next search reuses.
struct StarMemory {
  /// What a node has where nodes are poses.
  struct Arrival {
    double heading = 0;                ///< through the air
    double metres = 0;                 ///< of the edge from its parent
    std::optional<Approach> approach;  ///< to the node
  };

  LegTree legs;
  PointGrid points;                ///< with the numbers of `legs`
  std::vector<double> cost;        ///< from the start, one entry per node
  std::vector<std::uint8_t> ends;  ///< 1 if a route may end at the node
  std::vector<Arrival> arrivals;   ///< one entry per node, or empty
  std::vector<std::uint32_t> near;
  std::vector<LegTree::Node> moved;

  void clear() {
    legs.clear();
    points.clear();
    cost.clear();
    ends.clear();
    arrivals.clear();
  }
};

/// RRT* and Informed RRT* (see planners rrt_star and informed_rrt_star): one search, which samples
/// the whole volume or the informed set, and steers with straight legs or with Dubins paths.
ALTIPLAN_API PlanResult star_search(const Request& request, const StarSettings& settings,
                                    StarMemory& memory);
}  // namespace altiplan::kit
