// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "altiplan/kit/sampling/leg_rules.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "trees.hpp"

namespace altiplan::rrt_connect {

/// Nodes are points, edges straight legs. A leg of the goal's tree is flown from child to parent:
/// it is checked in flight direction, with the turn at its end; the turn at its beginning is
/// checked when the next leg joins it.
class StraightEdges {
 public:
  using State = Vec3;
  static constexpr bool kShoots = false;  ///< an edge may have any length

  StraightEdges(const Request& request, const Settings& settings, Memory& trees)
      : request_(request),
        settings_(settings),
        trees_(trees),
        rules_(request),
        before_start_(request.before_start()) {}

  static const Vec3& place(const State& state) { return state; }
  static const State& sampled(const Vec3& p, RandomStream&) { return p; }
  std::vector<State> roots(int side) const {
    return {side == kStart ? request_.start.position : request_.goal.position};
  }
  const State& state(int side, Node node) const { return tree(side).legs.point(node); }
  void added(int, Node, const State&) {}

  Node nearest(int side, const State& q) const { return Node(tree(side).points.nearest(q)); }
  double metres(int side, Node node, const State& q) const {
    return (q - state(side, node)).norm();
  }
  /// The end of the first of equal legs to q: leaves no rest shorter than the minimum leg.
  State part(int side, Node node, const State& q, double left) const {
    const Vec3& from = state(side, node);
    const double legs = std::ceil(left / settings_.range);
    return legs <= 1 ? q : Vec3(from + (q - from) / legs);
  }

  /// The end of an edge from the node toward q; none if it leads nowhere.
  std::optional<State> steer(int side, Node near, const State& q) {
    const Vec3& from = state(side, near);
    before_ = behind(side, near);
    const Vec3 q_new = kit::steer(before_, from, q, settings_.range, request_.limits);
    return q_new == from ? std::nullopt : std::optional(q_new);
  }
  static bool same(const State& a, const State& b) { return a == b; }

  /// True if the edge that was steered satisfies every constraint.
  bool is_kept(int side, Node near, const State& q_new) {
    const Vec3& q_near = state(side, near);
    return side == kStart ? rules_.ok(before_, q_near, q_new)
                          : rules_.ok(std::nullopt, q_new, q_near) && goes_on(q_new, near);
  }

  /// True if the edge from a node of the start's tree to one of the goal's does, and the turns at
  /// both of its ends.
  bool joins(Node from, Node to) {
    const Vec3& a = state(kStart, from);
    const std::optional<Approach> before = behind(kStart, from);
    return rules_.ok(before, a, state(kGoal, to)) && goes_on(onward(before, a), to);
  }

  bool ends_at(const State& q) const { return request_.goal.reached_at(q); }
  Route route(Node from, std::optional<Node> to) const {
    Polyline route = tree(kStart).legs.way_to(from);
    if (to) {
      const Polyline rest = tree(kGoal).legs.way_to(*to);
      route.insert(route.end(), rest.rbegin(), rest.rend());
    }
    return route;
  }
  /// Lower bound of the metres from q to the other tree's root.
  double metres_left(int side, const State& q) const { return (state(1 - side, 0) - q).norm(); }
  bool is_short_enough(double metres) const { return metres <= request_.limits.max_route_length; }
  const kit::LegRules& rules() const { return rules_; }

 private:
  const Tree& tree(int side) const { return trees_[std::size_t(side)]; }

  /// Approach to the node by a leg from it, if a constraint requires it: in the start's tree as the
  /// vehicle flies, in the goal's as if flying back from the goal.
  std::optional<Approach> behind(int side, Node node) const {
    return rules_.looks_back()
               ? tree(side).legs.approach(node, 0, side == kStart ? before_start_ : std::nullopt)
               : std::nullopt;
  }

  /// True if a vehicle that comes to a node of the goal's tree by `before` may turn into the leg
  /// from it, and past a leg without a heading into the following legs.
  bool goes_on(std::optional<Approach> before, Node node) {
    for (Node next = tree(kGoal).legs.parent(node);
         rules_.looks_back() && next != kit::LegTree::kNone;
         node = next, next = tree(kGoal).legs.parent(node)) {
      const Vec3& at = state(kGoal, node);
      if (!rules_.follows(*before, at, state(kGoal, next))) {
        return false;
      }
      if (has_heading(state(kGoal, next) - at)) {
        break;
      }
      before = onward(before, at);
    }
    return true;
  }

  const Request& request_;
  const Settings& settings_;
  Memory& trees_;
  kit::LegRules rules_;
  std::optional<Approach> before_start_;
  std::optional<Approach> before_;  ///< of the edge that was steered last
};
}  // namespace altiplan::rrt_connect
