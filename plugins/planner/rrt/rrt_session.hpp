// SPDX-License-Identifier: Apache-2.0
// The persistent tree of `rrt`: legs broken by a change of the world are cut off, the tree is
// rooted at the vehicle, and grows on.
#pragma once

#include <cmath>
#include <memory>
#include <utility>

#include "altiplan/kit/sampling/leg_rules.hpp"
#include "altiplan/planner.hpp"
#include "rrt_repair.hpp"

namespace altiplan::rrt {

/// Treatment of nodes that a change cuts off.
enum class CutOff {
  drop,       ///< they are removed
  reconnect,  ///< they stay, and are reconnected when the tree grows near them
  afresh,     ///< all nodes are removed: for comparison
};

class TreeSession final : public Session {
 public:
  TreeSession(const Settings& settings, CutOff cut_off, const Request& request)
      : cut_off_(cut_off),
        request_(request),
        growth_(settings, request_, tree_),
        random_(stream()) {
    tree_.clear(request_.trace);
    growth_.set_root(tree_.add(request_.start.position, kNone));
    growth_.start();
    result_ = growth_.run({}, random_);
    route_ = nodes_of_route();
  }

 private:
  using Place = Tree::Place;

  const PlanResult& do_result() const override { return result_; }

  const PlanResult& do_update(const State& state, const Goal& goal,
                              std::shared_ptr<const World> world, std::span<const Change> changes,
                              const Budget& budget) override {
    const bool goal_moved =
        goal.position != request_.goal.position || goal.tolerance_m != request_.goal.tolerance_m;
    const bool moved =
        state.position != request_.start.position || state.velocity != request_.start.velocity;
    const std::size_t nodes_before = tree_.in_use();
    const Node first_new = Node(tree_.size());
    request_.world = std::move(world);
    request_.start = state;
    request_.goal = goal;
    request_.budget = budget;
    if (goal_moved || cut_off_ == CutOff::afresh) {
      growth_.drop_end();
    }
    cut_.clear();
    if (goal_moved || result_.status == PlanStatus::solved) {
      damage_ = Box::empty();  // otherwise it still awaits repair
    }
    forget_waiting();
    prune(changes);
    const std::size_t next = next_of_route();
    const bool is_rerooted =
        moved || cut_off_ == CutOff::afresh || !tree_.is_rooted(growth_.root());
    if (is_rerooted) {
      take_root(next);
    }
    cut_off();
    std::size_t kept = tree_.in_use() - (is_rerooted ? 1 : 0);
    const Node old_end = growth_.end();
    const bool had_end = old_end != kNone && tree_.place(old_end) != Place::removed;
    result_ = solve(goal_moved);
    if (had_end && tree_.place(old_end) == Place::removed) {
      --kept;  // for the new end
    }
    result_.counters.push_back({"nodes_kept", std::int64_t(kept)});
    result_.counters.push_back({"nodes_pruned", std::int64_t(nodes_before - kept)});
    result_.counters.push_back({"nodes_added", std::int64_t(tree_.in_use() - kept)});
    keep_route(first_new, next);
    return result_;
  }

  RandomStream stream() const { return request_.random.sub("growth"); }

  /// The result if start or goal is impossible, else the path between them.
  PlanResult solve(bool goal_moved) {
    if (auto impossible = impossible_ends(request_)) {
      impossible->counters = {{"expanded", 0}, {"nodes", std::int64_t(tree_.in_use())}};
      return *std::move(impossible);
    }
    growth_.start();
    if (goal_moved) {
      growth_.close_near_goal();
    }
    const Box around = damage_around();
    const Damage damage{around, tail(around)};
    Repair(request_, growth_, tree_).run(damage, random_);
    return growth_.run(damage, random_);
  }

  /// If more nodes are loose than the tree has, removes them, so that they do not accumulate on a
  /// long flight. Keeps the branch with the old route's end.
  void forget_waiting() {
    const std::size_t waiting = tree_.count(Place::loose);
    if (waiting > std::max(kMaxWaiting, tree_.in_use() - waiting)) {
      Node top = growth_.end();
      while (top != kNone && tree_.parent(top) != kNone) {
        top = tree_.parent(top);
      }
      tree_.remove_loose(top);
    }
  }

  /// Cuts the legs that the changes block, and removes the nodes at forbidden positions.
  void prune(std::span<const Change> changes) {
    const kit::LegRules rules(request_);
    std::vector<Node> near;
    for (const Change& change : changes) {
      const Layer* layer = request_.world->find(change.layer);
      if (change.kind == Change::Kind::remove || layer == nullptr) {
        continue;
      }
      tree_.within(reach_of(change.box, layer->environment->ground() != nullptr), near);
      if (growth_.end() != kNone) {
        near.push_back(growth_.end());
      }
      for (const Node node : near) {
        if (tree_.parent(node) != kNone && !keeps_leg(node)) {
          cut(node);
          damage_ = damage_.with(change.box.min).with(change.box.max);
        }
      }
      for (const Node node : near) {
        if (tree_.parent(node) == kNone && !rules.point_ok(tree_.point(node))) {
          for (const Node child : tree_.children(node)) {
            cut(child);
          }
          tree_.put(node, Place::removed);
        }
      }
    }
  }

  /// Region of the nodes whose legs the box touches; ground affects everything above it.
  Box reach_of(const Box& box, bool ground) const {
    const double reach =
        tree_.longest_leg() + std::max(request_.limits.min_clearance, request_.vehicle.reach_m());
    Box wide{box.min - Vec3::Constant(reach), box.max + Vec3::Constant(reach)};
    if (ground) {
      wide.min.z() = -kInfinity;
      wide.max.z() = kInfinity;
    }
    return wide;
  }

  bool keeps_leg(Node node) const {
    const Node above = tree_.parent(node);
    return leg_ok(tree_.approach(above, growth_.root(), std::nullopt), tree_.point(above),
                  tree_.point(node), request_);
  }

  void cut(Node node) {
    tree_.move(node, kNone);
    cut_.push_back(node);
  }

  /// Makes the vehicle the root: the old route continues from the first of its next nodes that the
  /// vehicle can reach.
  void take_root(std::size_t next) {
    cut_.push_back(growth_.root());
    const Node root = tree_.add(request_.start.position, kNone);
    growth_.set_root(root);
    if (cut_off_ == CutOff::afresh) {
      random_ = stream();
      return;
    }
    const std::size_t last = std::min(next + kMaxSkipped, route_.size());
    for (std::size_t i = next; i < last; ++i) {
      if (tree_.place(route_[i]) < Place::loose && growth_.hang(route_[i], root, cut_)) {
        return;
      }
    }
    if (damage_.is_empty()) {  // the gap is the path back to the old route
      damage_ = damage_.with(request_.start.position);
      for (std::size_t i = next; i < last; ++i) {
        damage_ = damage_.with(tree_.point(route_[i]));
      }
    }
  }

  /// Index, in the old route, of the end of the leg nearest to the vehicle.
  std::size_t next_of_route() const {
    const Vec3& p = request_.start.position;
    std::size_t next = 1;
    double minimum = kInfinity;
    for (std::size_t i = 1; i < route_.size(); ++i) {
      const Vec3& a = tree_.point(route_[i - 1]);
      const Vec3 leg = tree_.point(route_[i]) - a;
      const double along = std::clamp((p - a).dot(leg) / leg.squaredNorm(), 0.0, 1.0);
      const double distance = (a + along * leg - p).squaredNorm();
      if (distance <= minimum) {
        minimum = distance;
        next = i;
      }
    }
    return next;
  }

  /// Cuts off everything that is no longer attached to the root.
  void cut_off() {
    const Place place = cut_off_ == CutOff::reconnect ? Place::loose : Place::removed;
    for (const Node top : cut_) {
      if (tree_.parent(top) != kNone || top == growth_.root()) {
        continue;  // attached again
      }
      for (const Node node : tree_.below(top)) {
        if (tree_.place(node) != Place::removed) {
          tree_.put(node, place);
        }
      }
    }
  }

  /// The rest of the old route that the tree does not reach: its nodes in the box, or at least the
  /// first.
  std::vector<Node> tail(const Box& box) const {
    std::vector<Node> tail;
    Node first = kNone;
    if (growth_.end() != kNone) {
      for (Node node = growth_.end(); node != kNone && tree_.place(node) == Place::loose;
           node = tree_.parent(node)) {
        first = node;
        if (box.contains(tree_.point(node))) {
          tail.push_back(node);
        }
      }
    }
    if (tail.empty() && first != kNone) {
      tail.push_back(first);
    }
    return tail;
  }

  Box damage_around() const {
    if (cut_off_ != CutOff::reconnect || damage_.is_empty()) {
      return Box::empty();
    }
    const double room =
        2 * growth_.step() + std::max(request_.limits.min_clearance, request_.vehicle.reach_m());
    const Vec3 half = ((damage_.max - damage_.min) / 2).cwiseMax(room);
    return Box{damage_.min - half, damage_.max + half}.intersected(kit::sampled_box(request_));
  }

  /// Records the route, and the fraction of the last route ahead of the vehicle that it contains.
  void keep_route(Node first_new, std::size_t next) {
    const auto leg = [&](Node a, Node b) { return (tree_.point(b) - tree_.point(a)).norm(); };
    double ahead = 0;
    for (std::size_t i = next; i + 1 < route_.size(); ++i) {
      ahead += leg(route_[i], route_[i + 1]);
    }
    if (result_.status == PlanStatus::solved) {
      route_ = nodes_of_route();
    }
    double kept = 0;
    for (std::size_t i = 0; i + 1 < route_.size() && result_.status == PlanStatus::solved; ++i) {
      if (std::max(route_[i], route_[i + 1]) < first_new) {
        kept += leg(route_[i], route_[i + 1]);
      }
    }
    result_.counters.push_back(
        {"route_kept_percent", ahead > 0 ? std::lround(100 * std::min(1.0, kept / ahead)) : 0});
  }

  std::vector<Node> nodes_of_route() const {
    std::vector<Node> nodes;
    if (result_.status == PlanStatus::solved) {
      for (Node node = growth_.end(); node != kNone; node = tree_.parent(node)) {
        nodes.push_back(node);
      }
    }
    return {nodes.rbegin(), nodes.rend()};
  }

  static constexpr std::size_t kMaxWaiting = 1000;
  static constexpr std::size_t kMaxSkipped = 5;  ///< nodes of the old route, to reach the rest

  CutOff cut_off_;
  Request request_;
  Tree tree_;
  Growth growth_;
  RandomStream random_;
  PlanResult result_;
  std::vector<Node> route_;  ///< from the root to the end, at the last solution
  std::vector<Node> cut_;    ///< roots of what this update may have cut off
  Box damage_ = Box::empty();
};
}  // namespace altiplan::rrt
