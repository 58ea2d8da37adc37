// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/kit/sampling/leg_rules.hpp"
#include "altiplan/kit/sampling/leg_tree.hpp"
#include "altiplan/kit/sampling/point_grid.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "altiplan/plan_result.hpp"

namespace altiplan::rrt_connect {

using Node = kit::LegTree::Node;

/// One tree, its points under the same indices in both of its search structures.
struct Tree {
  kit::LegTree legs;
  kit::PointGrid points;
  std::vector<double> metres;  ///< distance from the root, one entry per node

  void clear() {
    legs.clear();
    points.clear();
    metres.clear();
  }
};

/// The trees of one search: from the start, and from the goal.
struct Memory {
  std::array<Tree, 2> trees;
};

struct Settings {
  double range = 0;  ///< longest leg by which a tree grows
  std::uint64_t max_iterations = 0;
};

/// One search. A leg of the goal's tree is flown from child to parent: it is checked in flight
/// direction, with the turn at its end; the turn at its beginning is checked when the next leg
/// joins it.
class TwoTrees {
 public:
  TwoTrees(const Request& request, const Settings& settings, Memory& memory)
      : request_(request),
        settings_(settings),
        trees_(memory.trees),
        rules_(request),
        watch_(request.budget),
        before_start_(request.before_start()),
        box_(kit::sampled_box(request)),
        random_(request.random.sub("sample")) {
    for (Tree& tree : trees_) {
      tree.clear();
    }
    add(kStart, request.start.position, kit::LegTree::kNone);
    add(kGoal, request.goal.position, kit::LegTree::kNone);
  }

  /// RRT_CONNECT_PLANNER; the first sample is the other root, and the smaller tree grows next.
  PlanResult run() {
    int a = kStart;
    if (may_go_on() && connect(a, 0) != Growth::reached) {
      while (!is_done() && may_go_on()) {
        const Vec3 q_rand = sample();
        const Node near = Node(tree(a).points.nearest(q_rand));
        if (extend(a, near, q_rand) != Growth::trapped && !is_done()) {
          connect(1 - a, newest(a));
        }
        a = tree(kStart).legs.size() <= tree(kGoal).legs.size() ? kStart : kGoal;
      }
    }
    return result();
  }

 private:
  enum class Growth { trapped, advanced, reached };
  static constexpr int kStart = 0;
  static constexpr int kGoal = 1;
  static constexpr int kDraws = 4;

  Tree& tree(int side) { return trees_[std::size_t(side)]; }
  const Vec3& point(int side, Node node) { return tree(side).legs.point(node); }
  Node newest(int side) { return Node(tree(side).legs.size()) - 1; }
  bool is_done() const { return !route_.empty(); }

  /// RANDOM_CONFIG: the first free one of a few samples.
  Vec3 sample() {
    Vec3 q_rand = random_.in(box_);
    for (int tries = 1; tries < kDraws && !rules_.point_ok(q_rand); ++tries) {
      q_rand = random_.in(box_);
    }
    return q_rand;
  }

  /// Checked before each extension.
  bool may_go_on() {
    ended_ = ended_ || watch_.spent(expanded_) || expanded_ >= settings_.max_iterations;
    return !ended_;
  }

  /// Approach to the node by a leg from it, if a constraint requires it: in the start's tree as the
  /// vehicle flies, in the goal's as if flying back from the goal.
  std::optional<Approach> behind(int side, Node node) {
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
      const Vec3& at = point(kGoal, node);
      if (!rules_.follows(*before, at, point(kGoal, next))) {
        return false;
      }
      if (has_heading(point(kGoal, next) - at)) {
        break;
      }
      before = onward(before, at);
    }
    return true;
  }

  /// EXTEND: a leg from the node toward q.
  Growth extend(int side, Node near, const Vec3& q) {
    ++expanded_;
    const Vec3& q_near = point(side, near);
    const std::optional<Approach> before = behind(side, near);
    const Vec3 q_new = kit::steer(before, q_near, q, settings_.range, request_.limits);
    if (q_new == q_near || !may_add(side, near, q_new) || !leg_kept(side, before, near, q_new)) {
      return Growth::trapped;
    }
    add(side, q_new, near);
    if (side == kStart && request_.goal.reached_at(q_new) &&
        tree(kStart).metres.back() <= request_.limits.max_route_length) {
      route_ = tree(kStart).legs.way_to(newest(kStart));
    }
    return q_new == q ? Growth::reached : Growth::advanced;
  }

  /// CONNECT: extends this side's tree as far as possible toward a node of the other.
  Growth connect(int side, Node target) {
    const Vec3 q = point(1 - side, target);
    Node tip = Node(tree(side).points.nearest(q));
    double left = (q - point(side, tip)).norm();
    for (;;) {
      if (left <= settings_.range) {
        return left > 0 && join(side, tip, target) ? Growth::reached : Growth::trapped;
      }
      if (!may_go_on() ||
          extend(side, tip, even_part(point(side, tip), q, left)) == Growth::trapped) {
        return Growth::trapped;
      }
      tip = newest(side);
      const double now = (q - point(side, tip)).norm();
      if (is_done() || now >= left) {  // a bent leg may lead away
        return is_done() ? Growth::reached : Growth::trapped;
      }
      left = now;
    }
  }

  /// End of the first of equal legs to q: leaves no rest shorter than the minimum leg.
  Vec3 even_part(const Vec3& from, const Vec3& q, double left) const {
    const double legs = std::ceil(left / settings_.range);
    return legs <= 1 ? q : Vec3(from + (q - from) / legs);
  }

  /// Adds the leg between a node of this side and one of the other, which completes a route.
  bool join(int side, Node node, Node other) {
    ++joins_tried_;
    const Node from = side == kStart ? node : other;
    const Node to = side == kStart ? other : node;
    const Vec3& a = point(kStart, from);
    const Vec3& b = point(kGoal, to);
    const double metres = (b - a).norm();
    const double total =
        tree(kStart).metres[std::size_t(from)] + metres + tree(kGoal).metres[std::size_t(to)];
    const std::optional<Approach> before = behind(kStart, from);
    if (total > request_.limits.max_route_length || !rules_.ok(before, a, b) ||
        !goes_on(onward(before, a), to)) {
      return false;
    }
    route_ = tree(kStart).legs.way_to(from);
    const Polyline rest = tree(kGoal).legs.way_to(to);
    route_.insert(route_.end(), rest.rbegin(), rest.rend());
    return true;
  }

  /// True if a route through such a new node may be short enough.
  bool may_add(int side, Node parent, const Vec3& p) {
    if (request_.limits.max_route_length == kInfinity) {
      return true;
    }
    const double tolerance = side == kStart ? request_.goal.tolerance_m : 0;
    const double least = tree(side).metres[std::size_t(parent)] + (p - point(side, parent)).norm() +
                         (point(1 - side, 0) - p).norm() - tolerance;
    too_long_ += least > request_.limits.max_route_length;
    return least <= request_.limits.max_route_length;
  }

  bool leg_kept(int side, const std::optional<Approach>& before, Node near, const Vec3& q_new) {
    const Vec3& q_near = point(side, near);
    return side == kStart ? rules_.ok(before, q_near, q_new)
                          : rules_.ok(std::nullopt, q_new, q_near) && goes_on(q_new, near);
  }

  void add(int side, const Vec3& p, Node parent) {
    Tree& grown = tree(side);
    const Node node = grown.legs.add(p, parent);
    grown.points.insert(p);
    const bool is_root = parent == kit::LegTree::kNone;
    grown.metres.push_back(
        is_root ? 0 : grown.metres[std::size_t(parent)] + (p - point(side, parent)).norm());
    if (request_.trace != nullptr) {
      request_.trace->add({TraceEvent::Kind::added, 2 * node + side,
                           is_root ? -1 : 2 * parent + side, p, grown.metres.back()});
    }
  }

  PlanResult result() {
    PlanResult result;
    const auto nodes = std::int64_t(tree(kStart).legs.size() + tree(kGoal).legs.size());
    result.counters = {{"expanded", std::int64_t(expanded_)},
                       {"nodes", nodes},
                       {"legs_checked", rules_.checked()},
                       {"joins_tried", joins_tried_}};
    if (is_done()) {
      result.status = PlanStatus::solved;
      result.route = std::move(route_);
      result.message = "joined";
      return result;
    }
    const bool own_limit = expanded_ >= settings_.max_iterations && !watch_.cancelled();
    result.status = own_limit            ? PlanStatus::no_route
                    : watch_.cancelled() ? PlanStatus::cancelled
                                         : PlanStatus::timed_out;
    result.budget_hit = result.status == PlanStatus::timed_out;
    result.message = reason(nodes);
    return result;
  }

  /// Reports how near the start's tree came, and what was in the way.
  std::string reason(std::int64_t nodes) {
    const Vec3& goal = request_.goal.position;
    const Node nearest = Node(tree(kStart).points.nearest(goal));
    char near[32];
    std::snprintf(near, sizeof near, "%.0f", (point(kStart, nearest) - goal).norm());
    std::string text = "the two trees, " + std::to_string(nodes) +
                       " nodes in all, did not meet; the start's came to " + near +
                       " m of the goal";
    const std::string refusals = rules_.refusals();
    if (!refusals.empty()) {
      text += "; the last legs were refused by " + refusals;
    }
    if (too_long_ > 0) {
      text += "; " + std::to_string(too_long_) + " legs led too far for route_length";
    }
    return text;
  }

  const Request& request_;
  const Settings& settings_;
  std::array<Tree, 2>& trees_;
  kit::LegRules rules_;
  BudgetWatch watch_;
  std::optional<Approach> before_start_;
  Box box_;
  RandomStream random_;
  Polyline route_;
  bool ended_ = false;
  std::uint64_t expanded_ = 0;
  std::int64_t joins_tried_ = 0;
  std::int64_t too_long_ = 0;
};
}  // namespace altiplan::rrt_connect
