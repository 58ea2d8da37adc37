// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "framework/shape_oracle.hpp"
#include "reference/graph.hpp"

// The exact shortest route of a point among polygons in the plane: it bends only at their corners,
// so it is a shortest way in the graph of corners that see each other (Lozano-Pérez and Wesley,
// 1979). Obstacles are closed sets that may be touched: legs may run along edges and through
// corners, not through an inside. Polygons are simple and may overlap; O(corners² · edges).
namespace altiplan::reference {

using oracle::Point2;
using Polygon = std::vector<Point2>;

/// The four corners of an upright rectangle.
inline Polygon rectangle(double x0, double y0, double x1, double y1) {
  return {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
}

class VisibilityGraph {
 public:
  explicit VisibilityGraph(std::vector<Polygon> polygons) : polygons_(std::move(polygons)) {}

  /// Length of the shortest route; infinite where there is none.
  double shortest(const Point2& start, const Point2& goal) const {
    Graph graph;
    graph.add({start[0], start[1], 0});
    graph.add({goal[0], goal[1], 0});
    for (const Polygon& polygon : polygons_) {
      for (const Point2& corner : polygon) {
        graph.add({corner[0], corner[1], 0});
      }
    }
    for (std::size_t a = 0; a < graph.at.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (sees(point(graph.at[a]), point(graph.at[b]))) {
          graph.join(a, b);
          graph.join(b, a);
        }
      }
    }
    return dijkstra(graph, 0)[1];
  }

  /// Whether the leg meets no inside: it is cut wherever it meets an edge, and between two cuts all
  /// of it is inside a polygon or none of it, so the middles decide.
  bool sees(const Point2& a, const Point2& b) const {
    std::vector<double> cuts = {0, 1};
    for (const Polygon& polygon : polygons_) {
      for (std::size_t n = 0; n < polygon.size(); ++n) {
        cut(a, b, polygon[n], polygon[(n + 1) % polygon.size()], cuts);
      }
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t n = 0; n + 1 < cuts.size(); ++n) {
      if (cuts[n + 1] - cuts[n] < kTiny) {
        continue;
      }
      const double t = (cuts[n] + cuts[n + 1]) / 2;
      if (is_inside_one({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])})) {
        return false;
      }
    }
    return true;
  }

  bool is_inside_one(const Point2& p) const {
    return std::any_of(polygons_.begin(), polygons_.end(),
                       [&](const Polygon& polygon) { return strictly_inside(polygon, p); });
  }

  const std::vector<Polygon>& polygons() const { return polygons_; }

 private:
  static constexpr double kTiny = 1e-9;

  static Point2 point(const Vec3& p) { return {p.x(), p.y()}; }

  /// Shares of a–b at which it meets the edge c–d, and at which it passes the ends of one along it.
  static void cut(const Point2& a, const Point2& b, const Point2& c, const Point2& d,
                  std::vector<double>& cuts) {
    const double square = (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
    if (square == 0) {
      return;
    }
    const auto add = [&](double t) {
      if (t > 0 && t < 1) {
        cuts.push_back(t);
      }
    };
    for (const Point2& end : {c, d}) {
      add(((end[0] - a[0]) * (b[0] - a[0]) + (end[1] - a[1]) * (b[1] - a[1])) / square);
    }
    const double from = oracle::cross(c, d, a);
    const double to = oracle::cross(c, d, b);
    if (from != to) {
      add(from / (from - to));
    }
  }

  static bool strictly_inside(const Polygon& polygon, const Point2& p) {
    bool inside = false;
    for (std::size_t n = 0; n < polygon.size(); ++n) {
      const Point2& c = polygon[n];
      const Point2& d = polygon[(n + 1) % polygon.size()];
      if (oracle::to_edge(c, d, p[0], p[1]) < kTiny) {
        return false;
      }
      if ((c[1] > p[1]) != (d[1] > p[1])) {
        const double x = c[0] + (p[1] - c[1]) / (d[1] - c[1]) * (d[0] - c[0]);
        inside = inside != (p[0] < x);
      }
    }
    return inside;
  }

  std::vector<Polygon> polygons_;
};
}  // namespace altiplan::reference
