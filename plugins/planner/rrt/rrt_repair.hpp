// SPDX-License-Identifier: Apache-2.0
// Repair of the tree of `rrt`: from a threat to the rest of its old route.
#pragma once

#include <algorithm>
#include <vector>

#include "altiplan/check.hpp"
#include "rrt_growth.hpp"

namespace altiplan::rrt {

/// A path with few corners and unconstrained turns past the damage: trees from both sides that grow
/// toward each other (J. J. Kuffner, S. M. LaValle: RRT-Connect. ICRA 2000,
/// doi:10.1109/ROBOT.2000.844730), with legs of any length.
class Detour {
 public:
  struct Way {
    Node from = kNone;
    Node to = kNone;
    Polyline line;  ///< empty if none was found
  };

  /// From one of the nodes `from` to one of `to`, by random points in the box.
  Detour(const Request& request, const Tree& tree, const std::vector<Node>& from,
         const std::vector<Node>& to, const Box& box)
      : request_(request), box_(box), sides_{Side(tree, from), Side(tree, to)} {}

  Way find(Growth& growth, RandomStream& random) {
    for (std::size_t i = 0; i < kDraws && growth.next_iteration(); ++i) {
      const Vec3 p = random.in(box_);
      Side& here = sides_[i % 2];
      Side& there = sides_[1 - i % 2];
      const Node near = here.nearest(p);
      if (!is_free(here.legs.point(near), p)) {
        continue;
      }
      const Node added = here.add(p, near);
      const Node other = there.nearest(p);
      if (is_free(p, there.legs.point(other))) {
        return i % 2 == 0 ? joined(added, other) : joined(other, added);
      }
    }
    return {};
  }

 private:
  static constexpr std::size_t kDraws = 300;

  /// A separate tree whose roots are nodes of the growing tree.
  struct Side {
    Side(const Tree& tree, const std::vector<Node>& from) : roots(from) {
      for (const Node node : roots) {
        add(tree.point(node), kNone);
      }
    }
    Node add(const Vec3& p, Node parent) {
      points.insert(p);  // under the same index
      return legs.add(p, parent);
    }
    Node nearest(const Vec3& p) const { return Node(points.nearest(p)); }
    Node root_of(Node node) const {
      while (legs.parent(node) != kNone) {
        node = legs.parent(node);
      }
      return roots[std::size_t(node)];
    }
    std::vector<Node> roots;
    kit::LegTree legs;
    kit::KdTree points;
  };

  bool is_free(const Vec3& a, const Vec3& b) const { return leg_ok(std::nullopt, a, b, request_); }

  Way joined(Node a, Node b) const {
    Polyline line = sides_[0].legs.way_to(a);
    const Polyline rest = sides_[1].legs.way_to(b);
    line.insert(line.end(), rest.rbegin(), rest.rend());
    return {sides_[0].root_of(a), sides_[1].root_of(b), without_idle_corners(line)};
  }

  Polyline without_idle_corners(const Polyline& line) const {
    Polyline shorter = {line.front()};
    for (std::size_t i = 0; i + 1 < line.size();) {
      std::size_t next = line.size() - 1;
      while (next > i + 1 && !is_free(line[i], line[next])) {
        --next;
      }
      shorter.push_back(line[next]);
      i = next;
    }
    return shorter;
  }

  const Request& request_;
  Box box_;
  Side sides_[2];
};

/// Grows along detours until the tail of the old route is attached to the tree again.
class Repair {
 public:
  Repair(const Request& request, Growth& growth, Tree& tree)
      : request_(request), growth_(growth), tree_(tree) {}

  void run(const Damage& damage, RandomStream& random) {
    if (damage.tail.empty() || damage.box.is_empty()) {
      return;
    }
    std::vector<Node> starts;
    tree_.within(damage.box, starts);
    std::erase_if(starts, [&](Node node) { return !tree_.is_rooted(node); });
    if (starts.empty()) {
      starts.push_back(growth_.root());
    }
    Request long_legs = request_;
    long_legs.limits.max_leg = kInfinity;  // steps along them are short
    for (int i = 0; i < kDetours && !growth_.is_done(); ++i) {
      Detour detour(long_legs, tree_, starts, damage.tail, damage.box);
      Detour::Way way = detour.find(growth_, random);
      if (way.line.empty()) {
        continue;
      }
      add_rest_of_tail(way.to, way.line);
      // If the turn at its beginning is too sharp, tries a few nodes before that.
      for (int back = 0; back < kBack && way.from != kNone && !growth_.is_done(); ++back) {
        follow(way.line, way.from);
        way.from = tree_.parent(way.from);
      }
    }
  }

 private:
  static constexpr int kDetours = 5;
  static constexpr int kBack = 5;

  /// Appends the old route from a node of its tail on.
  void add_rest_of_tail(Node node, Polyline& line) const {
    const std::size_t first = line.size();
    for (Node n = growth_.end(); n != kNone && n != node; n = tree_.parent(n)) {
      line.push_back(tree_.point(n));
    }
    std::reverse(line.begin() + std::ptrdiff_t(first), line.end());
  }

  /// Grows step by step along the line, as far as turns allow; the tail attaches itself when it is
  /// near.
  void follow(const Polyline& line, Node node) {
    std::size_t next = 1;
    double left = 0;  // metres, to prevent circling
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      left += 1.5 * (line[i + 1] - line[i]).norm();
    }
    while (node != kNone && left > 0 && !growth_.is_done()) {
      const Vec3& p = tree_.point(node);
      while (next < line.size() && is_past(line, next, p)) {
        ++next;
      }
      if (next == line.size() || !growth_.next_iteration()) {
        return;
      }
      node = growth_.steer(node, line[next]);
      left -= growth_.step();
    }
  }

  bool is_past(const Polyline& line, std::size_t corner, const Vec3& p) const {
    const Vec3 to = line[corner] - p;
    return to.norm() < growth_.step() || to.dot(line[corner] - line[corner - 1]) <= 0;
  }

  const Request& request_;
  Growth& growth_;
  Tree& tree_;
};
}  // namespace altiplan::rrt
