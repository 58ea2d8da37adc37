// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "altiplan/geometry.hpp"
#include "altiplan/kit/sampling/leg_tree.hpp"
#include "altiplan/random.hpp"

namespace altiplan::kit {

/// Draws points near the inner points of the best route.
class BesideRoute {
 public:
  /// The route in the tree to that node.
  void learn(const LegTree& legs, LegTree::Node end) {
    points_.clear();
    for (end = legs.parent(end); end != LegTree::kNone && legs.parent(end) != LegTree::kNone;
         end = legs.parent(end)) {
      points_.push_back(legs.point(end));
    }
  }
  /// True if there is no route yet, or none with inner points.
  bool empty() const { return points_.empty(); }

  /// A point in the cube around one of them; on the faces of `box` if the cube reaches beyond, as
  /// routes often run along them.
  Vec3 draw(RandomStream& random, double radius, const Box& box) const {
    constexpr double kRadii = 1.5;
    const Vec3& at = points_[std::size_t(random.integer(0, std::int64_t(points_.size()) - 1))];
    const Vec3 edge = Vec3::Constant(kRadii * radius);
    return random.in({at - edge, at + edge}).cwiseMax(box.min).cwiseMin(box.max);
  }

 private:
  std::vector<Vec3> points_;
};
}  // namespace altiplan::kit
