// SPDX-License-Identifier: Apache-2.0
// Growth of a tree of poses, joined by Dubins paths, to the goal.
#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/sampling/path_rules.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "rrt_growth.hpp"

namespace altiplan::rrt {

class PoseGrowth {
 public:
  PoseGrowth(const Settings& settings, double turn_radius, const Request& request, Tree& tree)
      : settings_(settings),
        request_(request),
        sampled_(kit::sampled_box(request)),
        tree_(tree),
        paths_(request, turn_radius),
        goals_(paths_.goals()),
        reach_(std::max(2 * settings.step, 2 * kPi * turn_radius)),
        watch_(request.budget) {
    for (const Pose& start : paths_.starts()) {
      add(start, kNone, request.before_start(start.position));
    }
  }

  /// The paper's loop: sample, choose, extend.
  PlanResult run(RandomStream& random) {
    const auto roots = Node(tree_.size());
    for (Node root = 0; root < roots && next_iteration(); ++root) {
      close(root);
    }
    while (tree_.size() > 0 && !goals_.empty() && route_.empty() && next_iteration()) {
      const Pose& goal = any_goal(random);
      const bool is_goal = settings_.goal_bias > 0 && random.uniform() < settings_.goal_bias;
      const Pose sample = is_goal ? goal : Pose{random.in(sampled_), random.uniform(-kPi, kPi)};
      const Node near =
          tree_.choose(sample.position, settings_.w_random, goal.position, settings_.w_goal);
      extend(near, grows_to_goal(settings_, tree_, near, random) ? goal : sample);
    }
    return result();
  }

 private:
  bool next_iteration() {
    if (!route_.empty() || watch_.spent(iterations_, tree_.size()) ||
        tree_.size() * kBytesPerNode > request_.budget.max_memory_bytes) {
      is_spent_ = route_.empty();
      return false;
    }
    if (iterations_ == settings_.max_iterations) {
      return false;
    }
    ++iterations_;
    return true;
  }

  const Pose& any_goal(RandomStream& random) const {
    return goals_[std::size_t(random.integer(0, std::int64_t(goals_.size()) - 1))];
  }

  Pose pose(Node node) const { return {tree_.point(node), arrivals_[std::size_t(node)].first}; }

  /// Adds the pose one step along the path from `near` if every constraint allows it.
  void extend(Node near, const Pose& toward) {
    const Pose from = pose(near);
    if (const auto path = paths_.steering().path(from, toward); path && path->length > 0) {
      const Pose next = path->length <= settings_.step
                            ? toward
                            : paths_.steering().pose_at(from, *path, settings_.step);
      if (const auto arrival = paths_.arrival(arrivals_[std::size_t(near)].second, from, next)) {
        close(add(next, near, arrival->approach));
        return;
      }
    }
    if (settings_.max_failures > 0) {
      tree_.count_failure(near, settings_.max_failures);
    }
  }

  Node add(const Pose& pose, Node parent, const std::optional<Approach>& approach) {
    arrivals_.emplace_back(pose.heading, approach);
    return tree_.add(pose.position, parent);
  }

  /// Ends within the goal's tolerance, or by a path of a few steps to the goal: from a start, of
  /// any length.
  void close(Node node) {
    const Goal& goal = request_.goal;
    const Pose from = pose(node);
    if (goal.tolerance_m > 0 && !goal.heading && !goal.loiter && goal.reached_at(from.position)) {
      take(node, {});
      return;
    }
    const double reach = tree_.parent(node) == kNone ? kInfinity : reach_;
    std::vector<std::pair<double, std::size_t>> shots;
    for (std::size_t g = 0; g < goals_.size(); ++g) {
      if (paths_.steering().min_length(from, goals_[g]) <= reach) {
        if (const double length = paths_.steering().length(from, goals_[g], reach);
            length <= reach) {
          shots.emplace_back(length, g);
        }
      }
    }
    std::sort(shots.begin(), shots.end());
    for (const auto& [length, g] : shots) {
      if (paths_.arrival(arrivals_[std::size_t(node)].second, from, goals_[g])) {
        take(node, goals_[g]);
        return;
      }
    }
  }

  /// Takes the route to the node, and on to a goal, if it satisfies the constraints on routes.
  void take(Node node, const std::optional<Pose>& goal) {
    std::vector<Pose> poses;
    for (; node != kNone; node = tree_.parent(node)) {
      poses.push_back(pose(node));
    }
    std::reverse(poses.begin(), poses.end());
    if (goal) {
      poses.push_back(*goal);
    }
    Route route = paths_.route_through(poses);
    const CheckResult judged = check(route, request_);
    if (judged.ok()) {
      route_ = std::move(route);
    } else if (refused_.empty()) {
      refused_ = judged.violations.front().message;
    }
  }

  PlanResult result() {
    PlanResult result;
    result.counters = {{"expanded", std::int64_t(iterations_)},
                       {"nodes", std::int64_t(tree_.in_use())}};
    if (!route_.empty()) {
      result.status = PlanStatus::solved;
      result.route = std::move(route_);
      result.message = std::to_string(result.route.leg_count()) + " legs of a tree of " +
                       std::to_string(tree_.in_use()) + " nodes";
      return result;
    }
    result.status = !is_spent_           ? PlanStatus::no_route
                    : watch_.cancelled() ? PlanStatus::cancelled
                                         : PlanStatus::timed_out;
    result.budget_hit = result.status == PlanStatus::timed_out;
    const std::string refusals = paths_.legs().refusals();
    result.message = "gave up after " + std::to_string(iterations_) + " extensions with " +
                     std::to_string(tree_.in_use()) + " nodes" +
                     (!refused_.empty()   ? "; the first route to the goal was refused: " + refused_
                      : !refusals.empty() ? "; the last legs were refused by " + refusals
                                          : "");
    return result;
  }

  static constexpr std::size_t kBytesPerNode = Tree::kBytesPerNode + 72;

  const Settings& settings_;
  const Request& request_;
  const Box sampled_;
  Tree& tree_;
  kit::PathRules paths_;
  std::vector<Pose> goals_;
  double reach_;  ///< maximum length of the path to the goal, metres through the air
  BudgetWatch watch_;
  std::vector<std::pair<double, std::optional<Approach>>> arrivals_;  ///< headings, approaches
  std::uint64_t iterations_ = 0;
  bool is_spent_ = false;
  Route route_;
  std::string refused_;  ///< why the first route to the goal was rejected
};
}  // namespace altiplan::rrt
