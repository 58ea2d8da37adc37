// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "altiplan/world.hpp"

namespace altiplan {

/// Finds the layers of a world near a query by a tree of their bounding boxes, so that thousands of
/// solids may be entries of their own. Layers whose bounds say too little (with ground, that
/// over-approximate, unbounded) are always found.
class LayerIndex {
 public:
  explicit LayerIndex(const std::vector<Layer>& layers);

  /// Indices of the layers that may lie within `reach` of the leg a–b, in order.
  std::vector<int> within(const Vec3& a, const Vec3& b, double reach) const;
  /// Minimum over all layers of `clearance_of` an index, at p.
  template <class Clearance>
  double min_clearance(const Vec3& p, const Clearance& clearance_of) const;

 private:
  struct Node {
    Box box;
    int first;  ///< child, with the other behind it; of a leaf: its first entry of `sorted_`
    int count;  ///< entries of a leaf; 0 for an inner node
  };
  void split(int node, int begin, int end, const std::vector<Box>& boxes);

  std::vector<int> always_;
  std::vector<int> sorted_;
  std::vector<Node> nodes_;  ///< the root first
};

/// Metres between a point and a box, 0 inside.
inline double distance_to(const Box& box, const Vec3& p) {
  return (p - p.cwiseMax(box.min).cwiseMin(box.max)).norm();
}

template <class Clearance>
double LayerIndex::min_clearance(const Vec3& p, const Clearance& clearance_of) const {
  constexpr double kRounding = 1e-6;
  double minimum = kInfinity;
  for (const int layer : always_) {
    minimum = std::min(minimum, clearance_of(layer));
  }
  std::vector<int> open(nodes_.empty() ? 0 : 1, 0);
  while (!open.empty()) {
    const Node& node = nodes_[std::size_t(open.back())];
    open.pop_back();
    // Inside of one layer another may still be deeper.
    if (distance_to(node.box, p) > std::max(minimum, 0.0) + kRounding) {
      continue;
    }
    for (int n = 0; n < node.count; ++n) {
      minimum = std::min(minimum, clearance_of(sorted_[std::size_t(node.first + n)]));
    }
    if (node.count == 0) {
      const int nearer = distance_to(nodes_[std::size_t(node.first)].box, p) <=
                                 distance_to(nodes_[std::size_t(node.first + 1)].box, p)
                             ? node.first
                             : node.first + 1;
      open.push_back(2 * node.first + 1 - nearer);
      open.push_back(nearer);
    }
  }
  return minimum;
}
}  // namespace altiplan
