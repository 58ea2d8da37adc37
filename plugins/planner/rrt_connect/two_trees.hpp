// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/kit/sampling/sampling.hpp"
#include "altiplan/plan_result.hpp"
#include "bridges.hpp"
#include "trees.hpp"

namespace altiplan::rrt_connect {

/// One search. `Edges` knows what a node is and how two are joined.
template <class Edges>
class TwoTrees {
 public:
  TwoTrees(const Request& request, const Settings& settings, Memory& memory)
      : request_(request),
        settings_(settings),
        trees_(memory),
        edges_(request, settings, memory),
        watch_(request.budget),
        box_(kit::sampled_box(request)),
        random_(request.random.sub("sample")) {
    for (Tree& tree : trees_) {
      tree.clear();
    }
    for (const int side : {kStart, kGoal}) {
      for (const State& root : edges_.roots(side)) {
        add(side, root, kit::LegTree::kNone);
      }
    }
  }

  /// RRT_CONNECT_PLANNER; the first sample is the other root, and the smaller tree grows next.
  PlanResult run() {
    int a = kStart;
    if (may_go_on() && !join_roots() && connect(a, 0) != Growth::reached) {
      while (!is_done() && may_go_on()) {
        grow(a);
        a = tree(kStart).legs.size() <= tree(kGoal).legs.size() ? kStart : kGoal;
      }
    }
    return result();
  }

 private:
  using State = typename Edges::State;
  enum class Growth { trapped, advanced, reached };
  static constexpr int kDraws = 4;
  static constexpr std::uint64_t kHardAfter = 1000;  ///< edges tried; open worlds take a tenth
  static constexpr int kOnward = 8;                  ///< edges tried from a passage

  Tree& tree(int side) { return trees_[std::size_t(side)]; }
  const Vec3& point(int side, Node node) { return tree(side).legs.point(node); }
  static const Vec3& place(const State& state) { return Edges::place(state); }
  Node newest(int side) { return Node(tree(side).legs.size()) - 1; }
  bool is_done() const { return !route_.empty(); }

  /// EXTEND, then CONNECT; where these alone do not suffice, every other time through a passage.
  void grow(int side) {
    find_passages();
    if (expanded_ >= kHardAfter) {
      is_turn_of_passage_ = !is_turn_of_passage_;
      if (is_turn_of_passage_ && !passages_[std::size_t(side)].empty()) {
        grow_into_passage(side);
        return;
      }
    }
    const State q_rand = sample();
    if (extend(side, edges_.nearest(side, q_rand), q_rand) != Growth::trapped && !is_done()) {
      connect(1 - side, newest(side));
    }
  }

  /// Among walls takes about as long as the edges since the last time; in clutter looks once.
  void find_passages() {
    constexpr int kTries = 50'000;
    if (expanded_ >= passages_after_) {
      passages_after_ = expanded_ + kHardAfter;
      const auto found = find_bridges(box_, settings_.range, kTries, edges_.rules(),
                                      request_.random.sub("bridges", expanded_));
      if (!found) {
        passages_after_ = ~std::uint64_t{0};
        return;
      }
      for (Passages& passages : passages_) {
        passages.add(*found);
      }
    }
  }

  /// Reaches a passage that this tree has not reached, from any node within the range (the nearest
  /// one is often behind a wall, every time), and goes on from there: the nodes that it came from
  /// are nearer to what lies behind.
  void grow_into_passage(int side) {
    Passages& passages = passages_[std::size_t(side)];
    const State q = Edges::sampled(passages.sample(random_), random_);
    near_.clear();
    tree(side).points.within(place(q), settings_.range, near_);
    const Node near =
        near_.empty() ? edges_.nearest(side, q) : Node(near_[Passages::any(near_.size(), random_)]);
    const Growth growth = extend(side, near, q);
    if (growth == Growth::reached) {
      passages.remove();
    }
    if (growth == Growth::trapped || is_done()) {
      return;
    }
    const Node reached = newest(side);
    connect(1 - side, reached);
    for (int n = 0; n < kOnward && !is_done() && may_go_on(); ++n) {
      extend(side, reached, sample());
    }
  }

  /// RANDOM_CONFIG: the first free one of a few samples.
  State sample() {
    Vec3 q_rand = random_.in(box_);
    for (int tries = 1; tries < kDraws && !edges_.rules().point_ok(q_rand); ++tries) {
      q_rand = random_.in(box_);
    }
    return Edges::sampled(q_rand, random_);
  }

  /// Checked before each extension.
  bool may_go_on() {
    const std::size_t nodes = tree(kStart).legs.size() + tree(kGoal).legs.size();
    ended_ = ended_ || watch_.spent(expanded_, nodes) || expanded_ >= settings_.max_iterations;
    return !ended_;
  }

  /// Joins start and goal at once where either has several poses or an edge may have any length.
  bool join_roots() {
    if constexpr (!Edges::kShoots) {
      return false;
    } else {
      std::vector<std::pair<double, std::pair<Node, Node>>> pairs;
      for (Node from = 0; from < Node(tree(kStart).legs.size()); ++from) {
        for (Node to = 0; to < Node(tree(kGoal).legs.size()); ++to) {
          pairs.push_back({edges_.metres(kStart, from, edges_.state(kGoal, to)), {from, to}});
        }
      }
      constexpr std::size_t kMaxShots = 64;
      const auto end = pairs.begin() + std::ptrdiff_t(std::min(pairs.size(), kMaxShots));
      std::partial_sort(pairs.begin(), end, pairs.end());
      return std::any_of(pairs.begin(), end, [&](const auto& pair) {
        return join(kStart, pair.second.first, pair.second.second);
      });
    }
  }

  /// EXTEND: an edge from the node toward q.
  Growth extend(int side, Node near, const State& q) {
    ++expanded_;
    const std::optional<State> q_new = edges_.steer(side, near, q);
    if (!q_new || !may_add(side, near, *q_new) || !edges_.is_kept(side, near, *q_new)) {
      return Growth::trapped;
    }
    add(side, *q_new, near);
    if (side == kStart && edges_.ends_at(*q_new) &&
        tree(kStart).metres.back() <= request_.limits.max_route_length) {
      route_ = edges_.route(newest(kStart), std::nullopt);
    }
    return Edges::same(*q_new, q) ? Growth::reached : Growth::advanced;
  }

  /// CONNECT: extends this side's tree as far as possible toward a node of the other.
  Growth connect(int side, Node target) {
    const State q = edges_.state(1 - side, target);
    Node tip = edges_.nearest(side, q);
    double left = edges_.metres(side, tip, q);
    for (;;) {
      if (left <= settings_.range) {
        return left > 0 && join(side, tip, target) ? Growth::reached : Growth::trapped;
      }
      if (!may_go_on() || extend(side, tip, edges_.part(side, tip, q, left)) == Growth::trapped) {
        return Growth::trapped;
      }
      tip = newest(side);
      const double now = edges_.metres(side, tip, q);
      if (is_done() || now >= left) {  // a bent leg may lead away
        return is_done() ? Growth::reached : Growth::trapped;
      }
      left = now;
    }
  }

  /// Adds the edge between a node of this side and one of the other, which completes a route.
  bool join(int side, Node node, Node other) {
    ++joins_tried_;
    const Node from = side == kStart ? node : other;
    const Node to = side == kStart ? other : node;
    const double metres = edges_.metres(kStart, from, edges_.state(kGoal, to));
    const double total =
        tree(kStart).metres[std::size_t(from)] + metres + tree(kGoal).metres[std::size_t(to)];
    if (!edges_.is_short_enough(total) || !edges_.joins(from, to)) {
      return false;
    }
    Route route = edges_.route(from, to);
    const double maximum = request_.limits.max_route_length;
    if (maximum < kInfinity && length(route) > maximum + kLengthTolerance) {
      return false;
    }
    route_ = std::move(route);
    return true;
  }

  /// True if a route through such a new node may be short enough.
  bool may_add(int side, Node parent, const State& q) {
    if (request_.limits.max_route_length == kInfinity) {
      return true;
    }
    const double tolerance = side == kStart ? request_.goal.tolerance_m : 0;
    const double minimum = tree(side).metres[std::size_t(parent)] + edges_.metres(side, parent, q) +
                           edges_.metres_left(side, q) - tolerance;
    const bool is_short_enough = edges_.is_short_enough(minimum);
    too_long_ += !is_short_enough;
    return is_short_enough;
  }

  void add(int side, const State& q, Node parent) {
    Tree& grown = tree(side);
    const Node node = grown.legs.add(place(q), parent);
    grown.points.insert(place(q));
    const bool is_root = parent == kit::LegTree::kNone;
    grown.metres.push_back(
        is_root ? 0 : grown.metres[std::size_t(parent)] + edges_.metres(side, parent, q));
    edges_.added(side, node, q);
    if (request_.trace != nullptr) {
      request_.trace->add({TraceEvent::Kind::added, 2 * node + side,
                           is_root ? -1 : 2 * parent + side, place(q), grown.metres.back()});
    }
  }

  PlanResult result() {
    PlanResult result;
    const auto nodes = std::int64_t(tree(kStart).legs.size() + tree(kGoal).legs.size());
    result.counters = {{"expanded", std::int64_t(expanded_)},
                       {"nodes", nodes},
                       {"legs_checked", edges_.rules().checked()},
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
    const std::string refusals = edges_.rules().refusals();
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
  Memory& trees_;
  Edges edges_;
  BudgetWatch watch_;
  Box box_;
  RandomStream random_;
  std::array<Passages, 2> passages_;           ///< by tree
  std::uint64_t passages_after_ = kHardAfter;  ///< edges tried before looking for more
  bool is_turn_of_passage_ = false;
  std::vector<std::uint32_t> near_;
  Route route_;
  bool ended_ = false;
  std::uint64_t expanded_ = 0;
  std::int64_t joins_tried_ = 0;
  std::int64_t too_long_ = 0;
};
}  // namespace altiplan::rrt_connect
