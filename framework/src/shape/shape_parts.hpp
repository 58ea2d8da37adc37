// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "altiplan/shape.hpp"

#include "edge_tree.hpp"

namespace altiplan {
class SweptVolume;
}

/// Common parts of the shape sources: visiting, height intervals, and the plan view of a prism.
namespace altiplan::shape_parts {

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

inline double interval_distance(double floor, double ceiling, double z) {
  return std::max(floor - z, z - ceiling);
}

inline double interval_gap(double low, double high, double other_low, double other_high) {
  return std::max({0.0, low - other_high, other_low - high});
}

inline Vec3 clamped(const Box& box, const Vec3& p) { return p.cwiseMax(box.min).cwiseMin(box.max); }

template <class Visit>
void for_each_edge(const Prism& prism, const Visit& visit) {
  const auto ring = [&](const std::vector<Point2>& points) {
    for (std::size_t n = 1; n < points.size(); ++n) {
      visit(points[n - 1], points[n]);
    }
    if (!points.empty()) {
      visit(points.back(), points.front());
    }
  };
  ring(prism.outline);
  for (const std::vector<Point2>& hole : prism.holes) {
    ring(hole);
  }
}

// True if a ray from (x, y) to the east crosses the edge; branch-free, as the outcome is
// unpredictable.
inline bool crosses(const Point2& e, const Point2& f, double x, double y) {
  const double side = (f[0] - e[0]) * (y - e[1]) - (x - e[0]) * (f[1] - e[1]);
  const bool spans = (e[1] > y) != (f[1] > y);
  const bool is_east = (side > 0) == (f[1] > e[1]);
  return spans & is_east;
}

inline Point2 nearest_on_edge(const Point2& e, const Point2& f, double x, double y) {
  const double dx = f[0] - e[0];
  const double dy = f[1] - e[1];
  const double length2 = dx * dx + dy * dy;
  const double share =
      length2 > 0 ? std::clamp(((x - e[0]) * dx + (y - e[1]) * dy) / length2, 0.0, 1.0) : 0.0;
  return share < 1 ? Point2{e[0] + share * dx, e[1] + share * dy} : f;
}

inline double distance_to_edge(const Point2& e, const Point2& f, double x, double y) {
  const Point2 q = nearest_on_edge(e, f, x, y);
  return std::hypot(x - q[0], y - q[1]);
}

/// A shape, and the tree over its edges where it is a prism that has one.
struct Indexed {
  const Shape& shape;
  const EdgeTree* tree;
};

/// The outline seen from a point: its nearest point, and whether it contains the point.
struct Plan {
  Point2 nearest{kInfinity, kInfinity};
  bool is_inside = false;
};

/// The edges of a prism, tested one by one.
class PlainEdges {
 public:
  explicit PlainEdges(const Prism& prism) : prism_(prism) {}

  /// True if (x, y) lies in the polygon: the ray crosses its edges an odd number of times.
  bool covers(double x, double y) const {
    bool inside = false;
    for_each_edge(prism_, [&](const Point2& e, const Point2& f) { inside ^= crosses(e, f, x, y); });
    return inside;
  }
  Plan plan_at(double x, double y) const {
    Plan plan;
    double min_squared = kInfinity;
    for_each_edge(prism_, [&](const Point2& e, const Point2& f) {
      const Point2 q = nearest_on_edge(e, f, x, y);
      const double distance2 = (x - q[0]) * (x - q[0]) + (y - q[1]) * (y - q[1]);
      if (distance2 < min_squared) {
        min_squared = distance2;
        plan.nearest = q;
      }
      plan.is_inside ^= crosses(e, f, x, y);
    });
    return plan;
  }
  EdgeTree::Edge nearest(double x, double y) const {
    EdgeTree::Edge nearest{};
    double min_distance = kInfinity;
    for_each_edge(prism_, [&](const Point2& e, const Point2& f) {
      if (const double distance = distance_to_edge(e, f, x, y); distance < min_distance) {
        min_distance = distance;
        nearest = {e, f};
      }
    });
    return nearest;
  }
  double extent() const {
    double max_coordinate = 0;
    for_each_edge(prism_, [&](const Point2& e, const Point2&) {
      max_coordinate = std::max({max_coordinate, std::abs(e[0]), std::abs(e[1])});
    });
    return max_coordinate;
  }
  /// Calls visit(from, to) for the edges that may be as near as limit(), and possibly for others.
  template <class Gap, class Limit, class Visit>
  void visit(const Gap&, const Limit&, const Visit& visit) const {
    for_each_edge(prism_, visit);
  }

 private:
  const Prism& prism_;
};

/// The same answers, from a tree.
class TreeEdges {
 public:
  explicit TreeEdges(const EdgeTree& tree) : tree_(tree) {}

  bool covers(double x, double y) const { return tree_.covers(x, y); }
  Plan plan_at(double x, double y) const {
    const EdgeTree::Edge edge = nearest(x, y);
    return {nearest_on_edge(edge.from, edge.to, x, y), covers(x, y)};
  }
  EdgeTree::Edge nearest(double x, double y) const {
    double min_squared = kInfinity;
    std::size_t nearest = 0;
    tree_.visit(
        [&](const EdgeTree::Rectangle& box) {
          const double gap_x = std::max({0.0, box.min[0] - x, x - box.max[0]});
          const double gap_y = std::max({0.0, box.min[1] - y, y - box.max[1]});
          return gap_x * gap_x + gap_y * gap_y;
        },
        [&] { return min_squared; },
        [&](std::size_t index, const EdgeTree::Edge& edge) {
          const Point2 q = nearest_on_edge(edge.from, edge.to, x, y);
          const double distance2 = (x - q[0]) * (x - q[0]) + (y - q[1]) * (y - q[1]);
          // Among edges at the same distance the first, as in a plain loop.
          if (distance2 < min_squared || (distance2 == min_squared && index < nearest)) {
            min_squared = distance2;
            nearest = index;
          }
        });
    return tree_.edges()[nearest];
  }
  double extent() const { return tree_.extent(); }
  template <class Gap, class Limit, class Visit>
  void visit(const Gap& gap, const Limit& limit, const Visit& visit) const {
    tree_.visit(gap, limit,
                [&](std::size_t, const EdgeTree::Edge& edge) { visit(edge.from, edge.to); });
  }

 private:
  const EdgeTree& tree_;
};

/// Calls work(edges) with the edges of the prism, by its tree where there is one.
template <class Work>
auto with_edges(const Prism& prism, const EdgeTree* tree, const Work& work) {
  return tree != nullptr ? work(TreeEdges(*tree)) : work(PlainEdges(prism));
}

// The functions of altiplan/shape.hpp, with the same results; exported for the kit.
ALTIPLAN_API double signed_distance(const Indexed& solid, const Vec3& p);
ALTIPLAN_API double leg_distance(const Indexed& solid, const Vec3& a, const Vec3& b);
ALTIPLAN_API bool comes_within(const Indexed& solid, const Vec3& a, const Vec3& b, double limit);
ALTIPLAN_API double leg_depth(const Indexed& solid, const Vec3& a, const Vec3& b);
ALTIPLAN_API Vec3 nearest_surface_point(const Indexed& solid, const Vec3& p);
ALTIPLAN_API bool overlaps(const Indexed& solid, const Box& box, double by);
/// True if the volume shares a point with the solid.
ALTIPLAN_API bool meets(const Indexed& solid, const SweptVolume& volume);
}  // namespace altiplan::shape_parts
