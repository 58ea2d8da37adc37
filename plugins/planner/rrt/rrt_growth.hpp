// SPDX-License-Identifier: Apache-2.0
// Growth of the tree of `rrt` to the goal.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "altiplan/kit/sampling/tree_time.hpp"
#include "altiplan/plan_result.hpp"
#include "altiplan/request.hpp"
#include "rrt_tree.hpp"

namespace altiplan::rrt {

struct Settings {
  double step = 0;
  double w_random = 1;
  double w_goal = 1;
  double goal_bias = 0;
  double random_share = 0.5;
  bool goal_once = true;
  int max_failures = 50;
  std::uint64_t max_iterations = 0;
};

/// Eq. (5): true if the node grows toward the goal, which is then noted.
inline bool grows_to_goal(const Settings& settings, Tree& tree, Node near, RandomStream& random) {
  if (random.uniform() < settings.random_share ||
      (settings.goal_once && tree.has_grown_to_goal(near))) {
    return false;
  }
  tree.set_grown_to_goal(near);
  return true;
}

/// Region to sample and nodes to grow to, after a change has cut the tree.
struct Damage {
  Box box = Box::empty();  ///< empty: there is none
  std::vector<Node> tail;  ///< loose nodes at the end of the old route
};

/// Grows the tree of a request; start and goal may change between two calls of start().
class Growth {
 public:
  Growth(const Settings& settings, const Request& request, Tree& tree)
      : settings_(settings),
        request_(request),
        sampled_(kit::sampled_box(request)),
        in_time_(avoids_moving(request)),
        tree_(tree) {}

  Node root() const { return root_; }
  void set_root(Node root) { root_ = root; }
  /// End of the route, loose or not; kNone while there is none.
  Node end() const { return end_; }
  bool is_done() const { return end_ != kNone && tree_.is_rooted(end_); }
  double step() const { return settings_.step; }

  /// Starts a new budget.
  void start() {
    watch_.emplace(request_.budget);
    iterations_ = 0;
    stopped_.reset();
    refused_.clear();
    if (tree_.count(Tree::Place::growing) == 0) {
      tree_.wake();  // remaining nodes had rested
    }
    if (is_done() && !keeps_route_rules(tree_.way_to(end_))) {
      drop_end();  // on the way to the new goal
    }
    reach_out(root_);
  }

  /// Counts an iteration; false if none is left.
  bool next_iteration() {
    if (watch_->spent(iterations_, tree_.size()) ||
        tree_.size() * Tree::kBytesPerNode > request_.budget.max_memory_bytes) {
      stopped_ = watch_->cancelled() ? PlanStatus::cancelled : PlanStatus::timed_out;
    } else if (iterations_ == settings_.max_iterations) {
      stopped_ = PlanStatus::no_route;
    } else {
      ++iterations_;
    }
    return !stopped_;
  }

  /// The paper's loop: sample, choose, extend.
  PlanResult run(const Damage& damage, RandomStream& random) {
    while (!is_done() && !stopped_ && next_iteration()) {
      const Vec3 goal = aim(damage, random);
      const Vec3 sample = draw(damage, random);
      const Node near = tree_.choose(sample, settings_.w_random, goal, settings_.w_goal);
      const Vec3 toward = grows_to_goal(settings_, tree_, near, random) ? goal : sample;
      tree_.has_woken() ? steer(near, toward) : extend(near, toward - tree_.point(near));
    }
    return is_done() ? with_route() : without_route(*stopped_);
  }

  /// Adds a node one step from `near`, as straight toward a position as turns and climbs allow;
  /// kNone if a constraint forbids the leg.
  Node steer(Node near, const Vec3& toward) {
    const Vec3& from = tree_.point(near);
    return extend(near,
                  kit::bent(before(near), from, toward - from, settings_.step, request_.limits));
  }

  /// Attaches a branch to a node if the leg between them and the following legs satisfy the
  /// constraints. Sub-branches that cannot follow there are cut off and added to `cut`.
  bool hang(Node branch, Node under, std::vector<Node>& cut) {
    const Vec3& from = tree_.point(under);
    const Vec3& at = tree_.point(branch);
    // A leg of zero length would hide the turn into the next one.
    const std::optional<Approach> to_under = before(under);
    if (at == from || !leg_ok(to_under, from, at, request_)) {
      return false;
    }
    const Approach to_branch = onward(to_under, from);
    const std::vector<Node> children = tree_.children(branch);
    std::vector<Node> failing;
    for (const Node child : children) {
      if (!follows(to_branch, branch, child)) {
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

  /// Discards the end of the route.
  void drop_end() {
    if (end_ != kNone && end_is_goal_ && tree_.place(end_) != Tree::Place::removed) {
      tree_.move(end_, kNone);
      tree_.put(end_, Tree::Place::removed);
    }
    end_ = kNone;
  }

  /// After the goal has moved: ends at a node from which it is already within reach.
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

 private:
  /// q_goal.
  Vec3 aim(const Damage& damage, RandomStream& random) const {
    if (damage.tail.empty() || random.uniform() < 0.5) {
      return request_.goal.position;
    }
    const auto last = std::int64_t(damage.tail.size()) - 1;
    return tree_.point(damage.tail[std::size_t(random.integer(0, last))]);
  }

  /// q_rand.
  Vec3 draw(const Damage& damage, RandomStream& random) const {
    if (settings_.goal_bias > 0 && random.uniform() < settings_.goal_bias) {
      return request_.goal.position;
    }
    const bool near_damage = !damage.box.is_empty() && random.uniform() < 0.5;
    return random.in(near_damage ? damage.box : sampled_);
  }

  std::optional<Approach> before(Node node) const {
    return tree_.approach(node, root_, request_.before_start());
  }

  /// True if the leg to a child may be flown by a vehicle that comes to its parent by `to_node`,
  /// and past a leg without a heading the following legs.
  bool follows(const Approach& to_node, Node node, Node child) const {
    const Vec3& at = tree_.point(node);
    if (!leg_ok(to_node, at, tree_.point(child), request_)) {
      return false;
    }
    if (has_heading(tree_.point(child) - at)) {
      return true;
    }
    const std::vector<Node> next = tree_.children(child);
    return std::all_of(next.begin(), next.end(),
                       [&](Node below) { return follows(onward(to_node, at), child, below); });
  }

  /// True if the leg from a node satisfies every constraint and meets no moving obstacle.
  bool may_fly(Node node, const Vec3& to) const {
    return leg_ok(before(node), tree_.point(node), to, request_) &&
           (!in_time_ || kit::leg_in_time(tree_.legs(), node, to, request_));
  }

  /// Adds a node one step from `near` in a direction; kNone if a constraint forbids the leg.
  Node extend(Node near, const Vec3& way) {
    const Vec3& from = tree_.point(near);
    const double length = way.norm();
    const Vec3 p = from + settings_.step / length * way;
    if (length > 0 && may_fly(near, p)) {
      const Node added = tree_.add(p, near);
      reach_out(added);
      return added;
    }
    if (settings_.max_failures > 0) {
      tree_.count_failure(near, settings_.max_failures);
    }
    return kNone;
  }

  /// Ends at the goal, or reconnects loose branches, where a leg of up to two steps suffices.
  void reach_out(Node node) {
    if (tree_.count(Tree::Place::loose) > 0) {
      tree_.loose_within(tree_.point(node), 2 * settings_.step, near_);
      cut_.clear();
      for (const Node branch : near_) {
        if (!tree_.is_rooted(branch)) {
          hang(branch, node, cut_);
        }
      }
      if (is_done() && !keeps_route_rules(tree_.way_to(end_))) {
        drop_end();
      }
    }
    if (!is_done()) {
      close(node);
    }
  }

  void close(Node node) {
    const Vec3& p = tree_.point(node);
    const Vec3& goal = request_.goal.position;
    const bool is_there = request_.goal.reached_at(p);
    if (!is_there && ((goal - p).norm() > 2 * settings_.step || !may_fly(node, goal))) {
      return;
    }
    Polyline route = tree_.way_to(node);
    if (!is_there) {
      route.push_back(goal);
    }
    if (keeps_route_rules(route)) {
      drop_end();
      end_ = is_there ? node : tree_.add(goal, node, Tree::Place::end);
      end_is_goal_ = !is_there;
    } else if (refused_.empty()) {
      refused_ = check(route, request_).violations.front().message;
    }
  }

  /// Checks the constraints that single legs cannot decide.
  bool keeps_route_rules(const Polyline& route) const {
    const double maximum = request_.limits.max_route_length;
    return (maximum == kInfinity && request_.constraints.empty()) ||
           (length(route) <= maximum + kLengthTolerance && check(route, request_).ok());
  }

  PlanResult with_route() const {
    PlanResult result;
    result.status = PlanStatus::solved;
    result.route = tree_.way_to(end_);
    result.message = std::to_string(result.route.size() - 1) + " legs of a tree of " +
                     std::to_string(tree_.in_use()) + " nodes";
    count(result);
    return result;
  }

  PlanResult without_route(PlanStatus status) const {
    const Vec3& goal = request_.goal.position;
    const Node nearest = tree_.nearest(goal);
    const Vec3& p = tree_.point(nearest);
    const double away = (goal - p).norm();
    PlanResult result;
    result.status = status;
    result.budget_hit = status == PlanStatus::timed_out;
    if (status == PlanStatus::no_route) {
      result.message =
          "gave up after " + std::to_string(iterations_) + " extensions (max_iterations): ";
    }
    result.message += "the nearest of " + std::to_string(tree_.in_use()) + " nodes is " +
                      std::to_string(std::lround(away)) + " m from the goal";
    const Vec3 next = p + std::min(1.0, settings_.step / away) * (goal - p);
    const auto wrong = leg_violations(before(nearest), p, next, request_, 0);
    if (!refused_.empty()) {
      result.message += "; the first route to it was refused: " + refused_;
    } else if (!wrong.empty()) {
      result.message += "; on the next leg " + wrong.front().message;
    }
    count(result);
    return result;
  }

  void count(PlanResult& result) const {
    result.counters = {{"expanded", std::int64_t(iterations_)},
                       {"nodes", std::int64_t(tree_.in_use())}};
  }

  const Settings settings_;
  const Request& request_;
  const Box sampled_;
  const bool in_time_;  ///< among moving obstacles
  Tree& tree_;
  std::optional<BudgetWatch> watch_;
  std::uint64_t iterations_ = 0;
  std::optional<PlanStatus> stopped_;
  std::string refused_;  ///< why the first route to the goal was rejected
  Node root_ = kNone;
  Node end_ = kNone;
  bool end_is_goal_ = false;  ///< a node at the goal itself, not only within its tolerance
  std::vector<Node> near_;
  std::vector<Node> cut_;
};
}  // namespace altiplan::rrt
