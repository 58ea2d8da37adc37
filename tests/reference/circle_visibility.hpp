// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <map>

#include "framework/shape_oracle.hpp"
#include "reference/visibility_graph.hpp"

// The exact shortest route of a point among discs and polygons in the plane: straight legs that
// touch discs, or end at corners, and arcs of rims between them (the visibility graph of convex
// curves, a corner being a disc of radius 0). Zones may be touched and may overlap. Every common
// tangent of every pair is looked at, O((discs + corners)³).
namespace altiplan::reference {

using oracle::Point2;

struct Circle {
  Point2 centre;
  double radius;
};

class CircleVisibility {
 public:
  explicit CircleVisibility(std::vector<Circle> circles, std::vector<Polygon> polygons = {})
      : circles_(std::move(circles)), polygons_(std::move(polygons)) {}

  bool is_inside_one(const Point2& p) const {
    if (polygons_.is_inside_one(p)) {
      return true;
    }
    for (const Circle& circle : circles_) {
      if (std::hypot(p[0] - circle.centre[0], p[1] - circle.centre[1]) <
          circle.radius - kTiny * (1 + circle.radius)) {
        return true;
      }
    }
    return false;
  }

  /// Whether the leg enters no disc and no polygon.
  bool sees(const Point2& a, const Point2& b) const {
    const Point2 ab = {b[0] - a[0], b[1] - a[1]};
    const double square = ab[0] * ab[0] + ab[1] * ab[1];
    for (const Circle& circle : circles_) {
      const Point2 ac = {circle.centre[0] - a[0], circle.centre[1] - a[1]};
      double t = square > 0 ? (ac[0] * ab[0] + ac[1] * ab[1]) / square : 0;
      t = std::clamp(t, 0.0, 1.0);
      if (std::hypot(ac[0] - t * ab[0], ac[1] - t * ab[1]) <
          circle.radius - kTiny * (1 + circle.radius)) {
        return false;
      }
    }
    return polygons_.sees(a, b);
  }

  /// Length of the shortest route; infinite where there is none.
  double shortest(const Point2& start, const Point2& goal) const {
    if (is_inside_one(start) || is_inside_one(goal)) {
      return kInfinity;
    }
    std::vector<Circle> all = circles_;
    Graph graph;
    const auto add_point = [&](const Point2& p) {
      all.push_back({p, 0});
      graph.add({p[0], p[1], 0});
    };
    add_point(start);
    add_point(goal);
    for (const Polygon& polygon : polygons_.polygons()) {
      std::for_each(polygon.begin(), polygon.end(), add_point);
    }
    Rims rims(all.size());
    for (std::size_t b = 0; b < all.size(); ++b) {
      for (std::size_t a = 0; a < b; ++a) {
        join_tangents(all, a, b, graph, rims);
        note_crossings(all, a, b, graph, rims);
      }
    }
    for (std::size_t n = 0; n < circles_.size(); ++n) {
      note_edges(n, graph, rims);
      join_arcs(circles_[n], rims[n], graph);
    }
    return dijkstra(graph, 0)[1];
  }

 private:
  static constexpr double kTiny = 1e-10;
  /// The nodes on each rim, by their angles.
  using Rims = std::vector<std::multimap<double, std::size_t>>;

  std::size_t node(const std::vector<Circle>& all, std::size_t n, double angle, Graph& graph,
                   Rims& rims) const {
    if (n >= circles_.size()) {
      return n - circles_.size();
    }
    const std::size_t added = graph.add({all[n].centre[0] + all[n].radius * std::cos(angle),
                                         all[n].centre[1] + all[n].radius * std::sin(angle), 0});
    rims[n].emplace(std::remainder(angle, 2 * kPi), added);
    return added;
  }

  /// Both radii that end at a tangent are normal to it: they point the same way on an outer one and
  /// opposite ways on an inner one, at an angle to the line of centres known by its cosine.
  void join_tangents(const std::vector<Circle>& all, std::size_t a, std::size_t b, Graph& graph,
                     Rims& rims) const {
    const double x = all[b].centre[0] - all[a].centre[0];
    const double y = all[b].centre[1] - all[a].centre[1];
    const double distance = std::hypot(x, y);
    for (const int kind : {+1, -1}) {
      const double apart = all[a].radius - kind * all[b].radius;
      if (distance < std::abs(apart) * (1 - kTiny) || distance == 0 ||
          (kind < 0 && all[b].radius == 0)) {
        continue;
      }
      for (const int side : {+1, -1}) {
        if (side < 0 && all[a].radius == 0 && all[b].radius == 0) {
          continue;
        }
        const double angle =
            std::atan2(y, x) + side * std::acos(std::clamp(apart / distance, -1.0, 1.0));
        const Point2 from = on(all[a], angle);
        const double other = kind > 0 ? angle : angle + kPi;
        if (sees(from, on(all[b], other))) {
          const std::size_t p = node(all, a, angle, graph, rims);
          const std::size_t q = node(all, b, other, graph, rims);
          graph.join(p, q);
          graph.join(q, p);
        }
      }
    }
  }

  /// Where two rims cross, an arc may end.
  void note_crossings(const std::vector<Circle>& all, std::size_t a, std::size_t b, Graph& graph,
                      Rims& rims) const {
    const double x = all[b].centre[0] - all[a].centre[0];
    const double y = all[b].centre[1] - all[a].centre[1];
    const double distance = std::hypot(x, y);
    const double ra = all[a].radius;
    const double rb = all[b].radius;
    if (distance >= ra + rb || distance <= std::abs(ra - rb)) {
      return;
    }
    const double at_a = std::acos((ra * ra + distance * distance - rb * rb) / (2 * ra * distance));
    const double at_b = std::acos((rb * rb + distance * distance - ra * ra) / (2 * rb * distance));
    for (const int side : {+1, -1}) {
      node(all, a, std::atan2(y, x) + side * at_a, graph, rims);
      node(all, b, std::atan2(-y, -x) + side * at_b, graph, rims);
    }
  }

  /// The same where an edge of a polygon crosses a rim.
  void note_edges(std::size_t n, Graph& graph, Rims& rims) const {
    const Circle& circle = circles_[n];
    for (const Polygon& polygon : polygons_.polygons()) {
      for (std::size_t e = 0; e < polygon.size(); ++e) {
        const Point2& c = polygon[e];
        const Point2& d = polygon[(e + 1) % polygon.size()];
        const double length = std::hypot(d[0] - c[0], d[1] - c[1]);
        const double x = (d[0] - c[0]) / length;
        const double y = (d[1] - c[1]) / length;
        const double along = x * (circle.centre[0] - c[0]) + y * (circle.centre[1] - c[1]);
        const double beside = x * (circle.centre[1] - c[1]) - y * (circle.centre[0] - c[0]);
        if (std::abs(beside) >= circle.radius) {
          continue;
        }
        const double half = std::sqrt(circle.radius * circle.radius - beside * beside);
        for (const double at : {along - half, along + half}) {
          if (at >= 0 && at <= length) {
            node(circles_, n,
                 std::atan2(c[1] + at * y - circle.centre[1], c[0] + at * x - circle.centre[0]),
                 graph, rims);
          }
        }
      }
    }
  }

  /// Between two nodes that follow each other all of an arc is inside a zone or none of it, so its
  /// middle decides.
  void join_arcs(const Circle& circle, const std::multimap<double, std::size_t>& rim,
                 Graph& graph) const {
    for (auto node = rim.begin(); node != rim.end(); ++node) {
      const auto next = std::next(node) == rim.end() ? rim.begin() : std::next(node);
      double angle = next->first - node->first;
      angle = next == rim.begin() ? angle + 2 * kPi : angle;
      if (!is_inside_one(on(circle, node->first + angle / 2))) {
        graph.from[node->second].push_back({next->second, circle.radius * angle});
        graph.from[next->second].push_back({node->second, circle.radius * angle});
      }
    }
  }

  static Point2 on(const Circle& circle, double angle) {
    return {circle.centre[0] + circle.radius * std::cos(angle),
            circle.centre[1] + circle.radius * std::sin(angle)};
  }

  std::vector<Circle> circles_;
  VisibilityGraph polygons_;
};
}  // namespace altiplan::reference
