// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "altiplan/api.hpp"
#include "altiplan/geometry.hpp"

namespace altiplan {

using Point2 = std::array<double, 2>;

/// Minimum number of edges of a polygon for which a tree pays off.
inline constexpr std::size_t kManyEdges = 48;

/// A tree of boxes over the edges of rings. A node holds consecutive edges, or whole rings, so that
/// its ends alone determine the parity of the crossings of a ray that passes through its box from
/// side to side. Exported for the kit and the formats; no part of the interface.
class EdgeTree {
 public:
  struct Edge {
    Point2 from;
    Point2 to;
  };
  /// Grown by more than the rounding of values computed from an edge's ends.
  struct Rectangle {
    Point2 min{kInfinity, kInfinity};
    Point2 max{-kInfinity, -kInfinity};
  };

  EdgeTree() = default;
  /// Edges are numbered from 0, ring after ring.
  ALTIPLAN_API explicit EdgeTree(const std::vector<const std::vector<Point2>*>& rings);

  bool empty() const { return nodes_.empty(); }
  const std::vector<Edge>& edges() const { return edges_; }
  /// Largest absolute coordinate.
  double extent() const { return extent_; }

  /// True if a ray from (x, y) to the east crosses the edges an odd number of times.
  ALTIPLAN_API bool covers(double x, double y) const;

  /// Calls visit(index, edge) for the edges of the nodes with gap(rectangle) <= limit(), nearer
  /// nodes first. The gap of a box must not exceed that of its content.
  template <class Gap, class Limit, class Visit>
  void visit(const Gap& gap, const Limit& limit, const Visit& visit) const;

 private:
  static constexpr std::int32_t kLeafEdges = 6;
  static constexpr std::size_t kMaxLevels = 64;

  struct Node {
    Rectangle box;
    double from_y;  // start of the first edge and end of the last one; equal for whole rings
    double to_y;
    std::int32_t first;  // of a leaf: its edges
    std::int32_t count;
    std::int32_t other;  // of an inner node: the child that does not directly follow it

    bool is_leaf() const { return count > 0; }
  };
  struct Run {
    std::int32_t first;
    std::int32_t count;
    Point2 middle;
  };

  void add_rings(std::vector<Run>& rings, std::size_t first, std::size_t end);
  void add_edges(std::int32_t first, std::int32_t count);
  void unite(std::size_t node, std::size_t other);

  std::vector<Edge> edges_;
  std::vector<Node> nodes_;
  double extent_ = 0;
};

template <class Gap, class Limit, class Visit>
void EdgeTree::visit(const Gap& gap, const Limit& limit, const Visit& visit) const {
  struct Open {
    std::int32_t node;
    double gap;
  };
  std::array<Open, kMaxLevels> open;
  std::size_t waiting = 0;
  if (!empty()) {
    open[waiting++] = {0, gap(nodes_[0].box)};
  }
  while (waiting > 0) {
    const Open here = open[--waiting];
    if (here.gap > limit()) {
      continue;
    }
    const Node& node = nodes_[std::size_t(here.node)];
    if (node.is_leaf()) {
      for (std::int32_t n = node.first; n < node.first + node.count; ++n) {
        visit(std::size_t(n), edges_[std::size_t(n)]);
      }
      continue;
    }
    Open near{here.node + 1, gap(nodes_[std::size_t(here.node) + 1].box)};
    Open far{node.other, gap(nodes_[std::size_t(node.other)].box)};
    if (far.gap < near.gap) {
      std::swap(near, far);
    }
    open[waiting++] = far;
    open[waiting++] = near;
  }
}
}  // namespace altiplan
