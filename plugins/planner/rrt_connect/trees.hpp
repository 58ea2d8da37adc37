// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "altiplan/kit/sampling/leg_tree.hpp"
#include "altiplan/kit/sampling/point_grid.hpp"

namespace altiplan::rrt_connect {

using Node = kit::LegTree::Node;

/// One tree, its points under the same indices in both of its search structures.
struct Tree {
  kit::LegTree legs;
  kit::PointGrid points;
  std::vector<double> metres;  ///< distance from the root, one entry per node
  /// One entry per node where nodes are poses.
  std::vector<double> headings;                     ///< through the air
  std::vector<std::optional<Approach>> approaches;  ///< to the nodes, in the start's tree

  void clear() {
    legs.clear();
    points.clear();
    metres.clear();
    headings.clear();
    approaches.clear();
  }
};

/// The trees of one search: from the start, and from the goal.
using Memory = std::array<Tree, 2>;
inline constexpr int kStart = 0;
inline constexpr int kGoal = 1;

struct Settings {
  double range = 0;  ///< longest edge by which a tree grows
  std::uint64_t max_iterations = 0;
  double turn_radius = 0;  ///< metres; 0: nodes are points joined by straight legs, else poses
                           ///< joined by Dubins paths
};
}  // namespace altiplan::rrt_connect
