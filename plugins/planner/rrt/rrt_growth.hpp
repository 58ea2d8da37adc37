// SPDX-License-Identifier: Apache-2.0
// How the tree of `rrt` grows to the goal.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"
#include "rrt_tree.hpp"

namespace altiplan::rrt {

struct Settings {
  double step = 0;
  double w_random = 1;
  double w_goal = 1;
  double goal_share = 0;
  double random_share = 0.5;
  bool goal_once = true;
  int max_failures = 50;
  std::uint64_t max_iterations = 0;
};

/// Grows a tree of the request, which may change between two runs.
class Growth {
 public:
  Growth(const Settings& settings, const Request& request, Tree& tree)
      : settings_(settings),
        request_(request),
        tree_(tree),
        random_(request.random.sub("growth")) {}

  Node root() const { return root_; }
  /// Where the route ends; kNone while there is none. It may be loose.
  Node end() const { return end_; }
  void set_root(Node root) { root_ = root; }
  /// Forgets where the route ends.
  void drop_end() {
    if (end_ != kNone && end_is_goal_) {
      tree_.move(end_, kNone);
      tree_.put(end_, Tree::Place::removed);
    }
    end_ = kNone;
  }
  /// For the next run: loose nodes to grow to instead of the goal, and where half of the random
  /// places are drawn.
  void aim_at(std::vector<Node> tail, const Box& damage) {
    tail_ = std::move(tail);
    damage_ = damage;
  }

  /// Hangs a branch under a node, if the leg between them and the turn of at least one leg after it
  /// keep the rules. Branches that cannot follow are cut off there, and added to `cut`.
  bool hang(Node branch, Node under, std::vector<Node>& cut) {
    const Vec3& from = tree_.point(under);
    const Vec3& at = tree_.point(branch);
    if (!leg_ok(before(under), from, at, request_)) {
      return false;
    }
    std::vector<Node> failing;
    const std::vector<Node> children = tree_.children(branch);
    for (const Node child : children) {
      if (!leg_ok(from, at, tree_.point(child), request_)) {
        failing.push_back(child);
      }
    }
    if (failing.size() == children.size() && branch != end_) {
      return false;
    }
    for (const Node child : failing) {
      tree_.move(child, kNone);
      cut.push_back(child);
    }
    tree_.move(branch, under);
    for (const Node node : tree_.below(branch)) {
      if (tree_.place(node) == Tree::Place::loose) {
        tree_.put(node, node == end_ && end_is_goal_ ? Tree::Place::end : Tree::Place::growing);
      }
    }
    return true;
  }

  /// After the goal has moved: ends at a node that has it in reach already.
  void close_near_goal() {
    const Vec3& goal = request_.goal.position;
    const Vec3 reach = Vec3::Constant(2 * settings_.step + request_.goal.tolerance_m);
    tree_.within({goal - reach, goal + reach}, near_);
    for (const Node node : near_) {
      if (tree_.is_rooted(node) && !is_done()) {
        close(node);
      }
    }
  }

  PlanResult run() {
    BudgetWatch watch(request_.budget);
    expanded_ = 0;
    reach_out(root_);
    while (!is_done()) {
      if (watch.spent(expanded_) ||
          tree_.size() * Tree::kBytesPerNode > request_.budget.max_memory_bytes) {
        return without_route(watch.cancelled() ? Status::cancelled : Status::timed_out);
      }
      if (expanded_ == settings_.max_iterations) {
        return without_route(Status::no_route);
      }
      ++expanded_;
      const Vec3 goal = aim();
      const Vec3 random = draw();
      const Node near = tree_.choose(random, settings_.w_random, goal, settings_.w_goal);
      const Node added = extend(near, grows_to_goal(near) ? goal : random);
      if (added != kNone) {
        reach_out(added);
      }
    }
    return with_route();
  }

 private:
  bool is_done() const { return end_ != kNone && tree_.is_rooted(end_); }

  /// q_goal.
  Vec3 aim() {
    if (tail_.empty()) {
      return request_.goal.position;
    }
    return tree_.point(tail_[std::size_t(random_.integer(0, std::int64_t(tail_.size()) - 1))]);
  }

  /// q_rand.
  Vec3 draw() {
    if (settings_.goal_share > 0 && random_.uniform() < settings_.goal_share) {
      return request_.goal.position;
    }
    const bool near_damage = !damage_.is_empty() && random_.uniform() < 0.5;
    Vec3 p = random_.in(near_damage ? damage_ : request_.volume);
    if (request_.level_m) {
      p.z() = *request_.level_m;
    }
    return p;
  }

  /// Eq. (5).
  bool grows_to_goal(Node near) {
    if (random_.uniform() < settings_.random_share ||
        (settings_.goal_once && tree_.has_grown_to_goal(near))) {
      return false;
    }
    tree_.set_grown_to_goal(near);
    return true;
  }

  std::optional<Vec3> before(Node node) const {
    return node == root_ ? request_.before_start() : tree_.before(node);
  }

  /// A new node one step from `near`, or kNone where a rule forbids the leg.
  Node extend(Node near, const Vec3& toward) {
    const Vec3& from = tree_.point(near);
    const Vec3 way = toward - from;
    const double distance = way.norm();
    if (distance > 0) {
      const Vec3 p = from + settings_.step / distance * way;
      if (leg_ok(before(near), from, p, request_)) {
        return tree_.add(p, near);
      }
    }
    if (settings_.max_failures > 0) {
      tree_.count_failure(near, settings_.max_failures);
    }
    return kNone;
  }

  /// Ends at the goal, or takes loose branches back, where one or two steps do.
  void reach_out(Node node) {
    if (tree_.count(Tree::Place::loose) > 0) {
      graft_at(node);
    }
    if (!is_done()) {
      close(node);
    }
  }

  void close(Node node) {
    const Vec3& p = tree_.point(node);
    const Vec3& goal = request_.goal.position;
    if (request_.goal.reached_at(p)) {
      if (keeps_route_rules(tree_.way_to(node))) {
        drop_end();
        end_ = node;
        end_is_goal_ = false;
      }
    } else if ((goal - p).norm() <= 2 * settings_.step && leg_ok(before(node), p, goal, request_)) {
      Route route = tree_.way_to(node);
      route.push_back(goal);
      if (keeps_route_rules(route)) {
        drop_end();
        end_ = tree_.add(goal, node, Tree::Place::end);
        end_is_goal_ = true;
      }
    }
  }

  /// The rules that legs cannot tell.
  bool keeps_route_rules(const Route& route) const {
    return (request_.limits.max_route_length == kInfinity && request_.constraints.empty()) ||
           check(route, request_).ok();
  }

  /// Takes back the loose branches that a leg of up to two steps joins to the node.
  void graft_at(Node node) {
    tree_.loose_within(tree_.point(node), 2 * settings_.step, near_);
    for (const Node branch : near_) {
      if (!tree_.is_rooted(branch)) {
        hang(branch, node, cut_);
      }
    }
    if (is_done() && !keeps_route_rules(tree_.way_to(end_))) {
      drop_end();
    }
  }

  PlanResult with_route() {
    PlanResult result;
    result.status = Status::solved;
    result.route = tree_.way_to(end_);
    result.message = "a route of " + std::to_string(result.route.size() - 1) +
                     " legs in a tree of " + std::to_string(tree_.in_use()) + " nodes";
    count(result);
    return result;
  }

  PlanResult without_route(Status status) {
    const Vec3& goal = request_.goal.position;
    const Node nearest = tree_.nearest(goal);
    const Vec3& p = tree_.point(nearest);
    PlanResult result;
    result.status = status;
    result.budget_hit = status == Status::timed_out;
    result.message = "the nearest of " + std::to_string(tree_.in_use()) + " nodes is " +
                     std::to_string(std::lround((goal - p).norm())) + " m from the goal";
    const double ahead = std::min(1.0, settings_.step / (goal - p).norm());
    const auto wrong = leg_violations(before(nearest), p, p + ahead * (goal - p), request_, 0);
    if (!wrong.empty()) {
      result.message += "; on the next leg to it " + wrong.front().message;
    }
    count(result);
    return result;
  }

  void count(PlanResult& result) const {
    result.counters = {{"expanded", std::int64_t(expanded_)},
                       {"nodes", std::int64_t(tree_.in_use())}};
  }

  const Settings settings_;
  const Request& request_;
  Tree& tree_;
  RandomStream random_;
  Node root_ = kNone;
  Node end_ = kNone;
  bool end_is_goal_ = false;  ///< a node of its own at the goal, not one within its tolerance
  std::uint64_t expanded_ = 0;
  std::vector<Node> tail_;
  Box damage_ = Box::empty();
  std::vector<Node> near_;
  std::vector<Node> cut_;
};
}  // namespace altiplan::rrt
