// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/kit/sampling/path_rules.hpp"
#include "trees.hpp"

namespace altiplan::rrt_connect {

/// Nodes are poses, edges Dubins paths, which are flown from child to parent in the goal's tree.
/// They meet tangentially.
class PoseEdges {
 public:
  using State = Pose;
  static constexpr bool kShoots = true;  ///< an edge may have any length

  PoseEdges(const Request& request, const Settings& settings, Memory& trees)
      : request_(request),
        settings_(settings),
        trees_(trees),
        paths_(request, settings.turn_radius) {}

  static const Vec3& place(const State& state) { return state.position; }
  static State sampled(const Vec3& p, RandomStream& random) {
    return {p, random.uniform(-kPi, kPi)};
  }
  std::vector<State> roots(int side) const {
    return side == kStart ? paths_.starts() : paths_.goals();
  }
  State state(int side, Node node) const {
    return {tree(side).legs.point(node), tree(side).headings[std::size_t(node)]};
  }
  void added(int side, Node node, const State& state) {
    const bool is_root = tree(side).legs.parent(node) == kit::LegTree::kNone;
    trees_[std::size_t(side)].headings.push_back(state.heading);
    trees_[std::size_t(side)].approaches.push_back(is_root ? request_.before_start(state.position)
                                                           : arrival_);
  }

  /// Of the nodes about as near as the nearest one, that with the shortest path.
  Node nearest(int side, const State& q) {
    const kit::PointGrid& points = tree(side).points;
    const std::size_t first = points.nearest(q.position);
    const double away = (points.point(first) - q.position).norm();
    points.within(q.position, away + settings_.turn_radius, near_);
    Node best = Node(first);
    double shortest = metres(side, best, q);
    for (const std::uint32_t number : near_) {
      const State at = state(side, Node(number));
      if ((side == kStart ? steering().min_length(at, q) : steering().min_length(q, at)) <
          shortest) {
        if (const double its = metres(side, Node(number), q, shortest); its < shortest) {
          shortest = its;
          best = Node(number);
        }
      }
    }
    return best;
  }
  double metres(int side, Node node, const State& q, double at_most = kInfinity) const {
    const State at = state(side, node);
    return side == kStart ? steering().length(at, q, at_most) : steering().length(q, at, at_most);
  }
  static const State& part(int, Node, const State& q, double) { return q; }

  std::optional<State> steer(int side, Node near, const State& q) const {
    const State at = state(side, near);
    const auto path = side == kStart ? steering().path(at, q) : steering().path(q, at);
    if (!path || path->legs.empty()) {
      return std::nullopt;
    }
    if (path->length <= settings_.range) {
      return q;
    }
    return side == kStart ? steering().pose_at(at, *path, settings_.range)
                          : steering().pose_at(q, *path, path->length - settings_.range);
  }
  static bool same(const State& a, const State& b) { return kit::are_same(a, b); }

  bool is_kept(int side, Node near, const State& q_new) {
    const State at = state(side, near);
    if (side == kStart) {
      return is_free(tree(kStart).approaches[std::size_t(near)], at, q_new);
    }
    return is_free(std::nullopt, q_new, at) && goes_on(near);
  }
  bool joins(Node from, Node to) {
    return is_free(tree(kStart).approaches[std::size_t(from)], state(kStart, from),
                   state(kGoal, to)) &&
           goes_on(to);
  }

  bool ends_at(const State& q) const {
    return request_.goal.tolerance_m > 0 && !request_.goal.heading && !request_.goal.loiter &&
           request_.goal.reached_at(q.position);
  }
  Route route(Node from, std::optional<Node> to) const {
    std::vector<State> poses;
    for (Node node = from; node != kit::LegTree::kNone; node = tree(kStart).legs.parent(node)) {
      poses.push_back(state(kStart, node));
    }
    std::reverse(poses.begin(), poses.end());
    for (Node node = to.value_or(kit::LegTree::kNone); node != kit::LegTree::kNone;
         node = tree(kGoal).legs.parent(node)) {
      poses.push_back(state(kGoal, node));
    }
    return paths_.route_through(poses);
  }
  double metres_left(int side, const State& q) const {
    const double ground = (tree(1 - side).legs.point(0) - q.position).norm();
    // Its first root may lie beyond another one.
    const std::optional<Loiter>& loiter =
        side == kStart ? request_.goal.loiter : request_.start.loiter;
    return (ground - (loiter ? 2 * loiter->radius : 0)) / steering().ground_per_air();
  }
  /// Of lengths through the air, which bound those over the ground in calm alone.
  bool is_short_enough(double metres) const {
    return !steering().is_calm() || metres <= request_.limits.max_route_length;
  }
  const kit::LegRules& rules() const { return paths_.legs(); }

 private:
  const Tree& tree(int side) const { return trees_[std::size_t(side)]; }
  const kit::Steering& steering() const { return paths_.steering(); }

  bool is_free(const std::optional<Approach>& before, const State& a, const State& b) {
    const auto arrival = paths_.arrival(before, a, b);
    if (arrival) {
      arrival_ = arrival->approach;
    }
    return arrival.has_value();
  }

  /// True if the edge from a node of the goal's tree may follow the path that was free last.
  bool goes_on(Node node) {
    const Node next = tree(kGoal).legs.parent(node);
    return next == kit::LegTree::kNone ||
           paths_.follows(arrival_, state(kGoal, node), state(kGoal, next));
  }

  const Request& request_;
  const Settings& settings_;
  Memory& trees_;
  kit::PathRules paths_;
  std::optional<Approach> arrival_;  ///< by the path that was free last
  std::vector<std::uint32_t> near_;
};
}  // namespace altiplan::rrt_connect
