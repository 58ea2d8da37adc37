// SPDX-License-Identifier: Apache-2.0
// How the tree of `rrt` gets past a threat to what is left of its old route.
#pragma once

#include <algorithm>
#include <limits>
#include <vector>

#include "altiplan/check.hpp"
#include "rrt_growth.hpp"

namespace altiplan::rrt {

/// A way with few corners and free turns past the damage: trees from both sides that reach for each
/// other (J. J. Kuffner, S. M. LaValle: RRT-Connect. ICRA 2000, doi:10.1109/ROBOT.2000.844730),
/// with legs as long as they come.
class Detour {
 public:
  struct Place {
    Vec3 point{0, 0, 0};
    Node node = kNone;  ///< of the tree, where it is one
    std::size_t parent = kRoot;
  };

  /// From one of the nodes `from` to one of `to`, by places drawn in the box.
  Detour(const Request& request, const Tree& tree, const std::vector<Node>& from,
         const std::vector<Node>& to, const Box& box)
      : request_(request), box_(box) {
    for (const Node node : from) {
      sides_[0].push_back({tree.point(node), node});
    }
    for (const Node node : to) {
      sides_[1].push_back({tree.point(node), node});
    }
  }

  /// The way, its first and last place nodes of the tree; empty where none was found.
  std::vector<Place> find(Growth& growth, RandomStream& random) {
    for (std::size_t i = 0; i < kDraws && growth.next_iteration(); ++i) {
      const Vec3 p = random.in(box_);
      std::vector<Place>& here = sides_[i % 2];
      std::vector<Place>& there = sides_[1 - i % 2];
      const std::size_t near = nearest(here, p);
      if (!is_free(here[near].point, p)) {
        continue;
      }
      here.push_back({p, kNone, near});
      const std::size_t other = nearest(there, p);
      if (is_free(p, there[other].point)) {
        std::vector<Place> way = way_back(here, here.size() - 1);
        std::reverse(way.begin(), way.end());
        const std::vector<Place> rest = way_back(there, other);
        way.insert(way.end(), rest.begin(), rest.end());
        if (i % 2 == 1) {
          std::reverse(way.begin(), way.end());
        }
        return without_idle_corners(way);
      }
    }
    return {};
  }

 private:
  static constexpr std::size_t kRoot = std::numeric_limits<std::size_t>::max();
  static constexpr std::size_t kDraws = 300;

  bool is_free(const Vec3& a, const Vec3& b) const { return leg_ok(std::nullopt, a, b, request_); }

  static std::size_t nearest(const std::vector<Place>& places, const Vec3& p) {
    std::size_t best = 0;
    double least = kInfinity;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double square = (places[i].point - p).squaredNorm();
      if (square < least) {
        least = square;
        best = i;
      }
    }
    return best;
  }

  static std::vector<Place> way_back(const std::vector<Place>& places, std::size_t last) {
    std::vector<Place> way;
    for (; last != kRoot; last = places[last].parent) {
      way.push_back(places[last]);
    }
    return way;
  }

  std::vector<Place> without_idle_corners(const std::vector<Place>& way) const {
    std::vector<Place> shorter = {way.front()};
    for (std::size_t i = 0; i + 1 < way.size();) {
      std::size_t next = way.size() - 1;
      while (next > i + 1 && !is_free(way[i].point, way[next].point)) {
        --next;
      }
      shorter.push_back(way[next]);
      i = next;
    }
    return shorter;
  }

  const Request& request_;
  Box box_;
  std::vector<Place> sides_[2];
};

/// Grows along detours until the tail of the old route hangs on the tree again.
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
      const std::vector<Detour::Place> way = detour.find(growth_, random);
      if (way.empty()) {
        continue;
      }
      Route line;
      for (const Detour::Place& place : way) {
        line.push_back(place.point);
      }
      add_rest_of_tail(way.back().node, line);
      // Where the turn at its beginning is too sharp, some nodes before that.
      Node from = way.front().node;
      for (int back = 0; back < kBack && from != kNone && !growth_.is_done(); ++back) {
        follow(line, from);
        from = tree_.parent(from);
      }
    }
  }

 private:
  static constexpr int kDetours = 5;
  static constexpr int kBack = 5;

  /// The old route from a node of its tail on.
  void add_rest_of_tail(Node node, Route& line) const {
    const std::size_t first = line.size();
    for (Node n = growth_.end(); n != kNone && n != node; n = tree_.parent(n)) {
      line.push_back(tree_.point(n));
    }
    std::reverse(line.begin() + std::ptrdiff_t(first), line.end());
  }

  /// One step after another along the line, as far as turns allow; the tail hangs itself on where
  /// it is near.
  void follow(const Route& line, Node node) {
    std::size_t next = 1;
    double left = 0;  // metres, so that it does not circle
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

  bool is_past(const Route& line, std::size_t corner, const Vec3& p) const {
    const Vec3 to = line[corner] - p;
    return to.norm() < growth_.step() || to.dot(line[corner] - line[corner - 1]) <= 0;
  }

  const Request& request_;
  Growth& growth_;
  Tree& tree_;
};
}  // namespace altiplan::rrt
