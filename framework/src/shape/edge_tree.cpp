// SPDX-License-Identifier: Apache-2.0
#include "edge_tree.hpp"

#include "shape_parts.hpp"

namespace altiplan {

EdgeTree::EdgeTree(const std::vector<const std::vector<Point2>*>& rings) {
  std::vector<Run> runs;
  for (const std::vector<Point2>* ring : rings) {
    if (ring->empty()) {
      continue;
    }
    Run run{static_cast<std::int32_t>(edges_.size()), static_cast<std::int32_t>(ring->size()), {}};
    Point2 low = ring->front();
    Point2 high = low;
    for (std::size_t n = 0; n < ring->size(); ++n) {
      const Point2& p = (*ring)[n];
      edges_.push_back({p, (*ring)[n + 1 < ring->size() ? n + 1 : 0]});
      for (std::size_t axis = 0; axis < 2; ++axis) {
        low[axis] = std::min(low[axis], p[axis]);
        high[axis] = std::max(high[axis], p[axis]);
        extent_ = std::max(extent_, std::abs(p[axis]));
      }
    }
    run.middle = {low[0] + high[0], low[1] + high[1]};
    runs.push_back(run);
  }
  if (!runs.empty()) {
    nodes_.reserve(edges_.size());
    add_rings(runs, 0, runs.size());
  }
}

void EdgeTree::add_rings(std::vector<Run>& rings, std::size_t first, std::size_t end) {
  if (end - first == 1) {
    add_edges(rings[first].first, rings[first].count);
    return;
  }
  const auto at = [&](std::size_t n) { return rings.begin() + std::ptrdiff_t(n); };
  const auto spread = [&](std::size_t axis) {
    const auto [low, high] = std::minmax_element(at(first), at(end), [&](auto& one, auto& other) {
      return one.middle[axis] < other.middle[axis];
    });
    return high->middle[axis] - low->middle[axis];
  };
  const std::size_t axis = spread(1) > spread(0) ? 1 : 0;
  const std::size_t half = first + (end - first) / 2;
  std::nth_element(at(first), at(half), at(end), [&](const Run& one, const Run& other) {
    return one.middle[axis] < other.middle[axis];
  });
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  add_rings(rings, first, half);
  const std::size_t other = nodes_.size();
  add_rings(rings, half, end);
  unite(node, other);
}

void EdgeTree::add_edges(std::int32_t first, std::int32_t count) {
  const std::size_t node = nodes_.size();
  nodes_.emplace_back();
  if (count > kLeafEdges) {
    add_edges(first, count / 2);
    const std::size_t other = nodes_.size();
    add_edges(first + count / 2, count - count / 2);
    unite(node, other);
  } else {
    constexpr double kGrowth = 1e-12;
    Rectangle box;
    for (std::int32_t n = first; n < first + count; ++n) {
      const Edge& edge = edges_[std::size_t(n)];
      for (std::size_t axis = 0; axis < 2; ++axis) {
        const auto [low, high] = std::minmax(edge.from[axis], edge.to[axis]);
        box.min[axis] = std::min(box.min[axis], low - kGrowth * extent_);
        box.max[axis] = std::max(box.max[axis], high + kGrowth * extent_);
      }
    }
    nodes_[node].box = box;
    nodes_[node].first = first;
    nodes_[node].count = count;
  }
  nodes_[node].from_y = edges_[std::size_t(first)].from[1];
  nodes_[node].to_y = edges_[std::size_t(first + count - 1)].to[1];
}

void EdgeTree::unite(std::size_t node, std::size_t other) {
  const Rectangle& one = nodes_[node + 1].box;
  const Rectangle& two = nodes_[other].box;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    nodes_[node].box.min[axis] = std::min(one.min[axis], two.min[axis]);
    nodes_[node].box.max[axis] = std::max(one.max[axis], two.max[axis]);
  }
  nodes_[node].other = static_cast<std::int32_t>(other);
}

bool EdgeTree::covers(double x, double y) const {
  bool inside = false;
  std::array<std::int32_t, kMaxLevels> open{0};
  std::size_t waiting = empty() ? 0 : 1;
  while (waiting > 0) {
    const std::int32_t index = open[--waiting];
    const Node& node = nodes_[std::size_t(index)];
    const Rectangle& box = node.box;
    if (box.max[0] < x || box.min[1] > y || box.max[1] < y) {
      continue;
    }
    if (box.min[0] > x) {  // each edge that spans y is crossed
      inside ^= (node.from_y > y) != (node.to_y > y);
    } else if (node.is_leaf()) {
      for (std::int32_t n = node.first; n < node.first + node.count; ++n) {
        const Edge& edge = edges_[std::size_t(n)];
        inside ^= shape_parts::crosses(edge.from, edge.to, x, y);
      }
    } else {
      open[waiting++] = node.other;
      open[waiting++] = index + 1;
    }
  }
  return inside;
}
}  // namespace altiplan
