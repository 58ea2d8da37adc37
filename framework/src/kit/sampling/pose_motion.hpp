// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "altiplan/kit/sampling/path_rules.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "altiplan/kit/sampling/star_search.hpp"
#include "straight_motion.hpp"

namespace altiplan::kit {

/// The nodes of a tree are poses joined by Dubins paths. These meet tangentially, so that a node's
/// parent may change whatever follows the node, unless constraints look at slopes or at more.
///
/// A path costs its length; in wind, the time by the airspeed. A cheap lower bound of that decides
/// most questions.
class PoseMotion {
 public:
  using State = Pose;
  using Node = LegTree::Node;
  static constexpr bool kExact = false;
  static constexpr std::size_t kBytesPerNode = 260;

  PoseMotion(const Request& request, const StarSettings& settings, StarMemory& memory)
      : request_(request),
        settings_(settings),
        memory_(memory),
        paths_(request, settings.turn_radius),
        axes_(std::max(1, free_axes(sampled_box(request)))),
        starts_(paths_.starts()),
        goals_(paths_.goals()) {}

  static const Vec3& place(const State& state) { return state.position; }
  State state(Node node) const {
    return {memory_.legs.point(node), memory_.arrivals[std::size_t(node)].heading};
  }
  static bool same(const State& a, const State& b) { return are_same(a, b); }
  static State sampled(const Vec3& p, RandomStream& random) {
    return {p, random.uniform(-kPi, kPi)};
  }
  /// Half of the samples point away from the node before the nearest one: straight on from there.
  void aim(State& sample, Node nearest, RandomStream& random) const {
    const Node parent = memory_.legs.parent(nearest);
    const Vec3 course =
        sample.position - memory_.legs.point(parent == LegTree::kNone ? nearest : parent);
    if (random.uniform() < 0.5 && !is_goal(sample)) {
      sample.heading = std::atan2(course.y(), course.x());
    }
  }
  const std::vector<State>& starts() const { return starts_; }
  const std::vector<State>& goals() const { return goals_; }
  bool is_end(const State& state) const {
    return is_goal(state) || (ends_anywhere() && request_.goal.reached_at(state.position));
  }

  double minimum(const State& from, const State& to) const {
    return cost_of(steering().min_length(from, to), from, to);
  }
  double minimum(Node from, const State& to) const { return minimum(state(from), to); }
  /// Infinite if it is more than `at_most`.
  double metres(const State& from, const State& to, double at_most = kInfinity) const {
    // The length of the horizontal path is at most that.
    return cost_of(steering().length(from, to, at_most), from, to);
  }
  double metres(Node from, const State& to, double at_most = kInfinity) const {
    return metres(state(from), to, at_most);
  }
  static double edge(Node, const State&, double metres) { return metres; }
  static double max_metres(double cost) { return cost; }
  static bool may_improve(const Vec3&, double) { return true; }
  double edge_to(Node node) const { return memory_.arrivals[std::size_t(node)].metres; }
  double to_go(const State& from) const {
    if (ends_anywhere()) {
      const double ground = (request_.goal.position - from.position).head<2>().norm();
      return std::max(0.0, ground - request_.goal.tolerance_m) / steering().ground_per_air();
    }
    if (request_.goal.loiter) {
      const double ground = (request_.goal.position - from.position).head<2>().norm();
      return std::abs(ground - request_.goal.loiter->radius) / steering().ground_per_air();
    }
    double min_of_all = kInfinity;
    for (const State& goal : goals_) {
      min_of_all = std::min(min_of_all, minimum(from, goal));
    }
    return min_of_all;
  }
  static double min_route() { return 0; }
  /// True if no route is shorter than the shortest path from any start to any goal.
  bool ends_are_poses() const { return !ends_anywhere() && !steering().is_layered(); }
  /// Beyond this, a node is of no use while the best route costs `best`.
  double max_cost(double best) const {
    const double maximum = steering().is_calm() ? request_.limits.max_route_length : kInfinity;
    return settings_.bounded ? std::min(maximum, best) : maximum;
  }
  bool is_short_enough(Node node, double cost) const {
    const double maximum = request_.limits.max_route_length;
    return maximum == kInfinity ||
           (steering().is_calm() ? cost : length(route_to(node))) <= maximum;
  }
  double reach(double cost) const {
    const double slope = std::tan(std::max(steering().limits().climb, steering().limits().sink));
    const double ground =
        steering().is_calm() ? cost : cost * std::hypot(steering().ground_per_air(), slope);
    return ground + request_.goal.tolerance_m + farthest(starts_, request_.start.position) +
           farthest(goals_, request_.goal.position);
  }

  /// Far apart, any two poses are joined by nearly straight paths: the radius of straight legs. In
  /// a turn radius of a pose, only those count that lie ahead with nearly its heading: of a share
  /// of the ball that falls with the square of the radius (S. Karaman, E. Frazzoli: Sampling-based
  /// Optimal Motion Planning for Non-holonomic Dynamical Systems. ICRA 2013).
  double near_radius(double n, double measure) const {
    const double d = axes_;
    const double turn = settings_.turn_radius;
    const double share =
        2 * (1 + 1 / d) * measure / std::pow(turn, d) / unit_ball(axes_) * std::log(n) / n;
    return std::min(settings_.range,
                    settings_.radius_scale * turn *
                        std::max(std::pow(share, 1 / d), std::pow(share, 1 / (d + 2))));
  }

  /// From the node near `toward` whose path there is shortest, the part within range.
  std::optional<State> steer(Node& from, const State& toward) const {
    double shortest = kInfinity;
    for (const std::uint32_t number : memory_.near) {
      if (minimum(Node(number), toward) < shortest) {
        if (const double its = metres(Node(number), toward, shortest); its < shortest) {
          shortest = its;
          from = Node(number);
        }
      }
    }
    const auto path =
        shortest > settings_.range ? steering().path(state(from), toward) : std::nullopt;
    return path ? std::optional(steering().pose_at(state(from), *path, settings_.range))
                : std::nullopt;
  }

  bool joins(Node from, const State& to) {
    const State& at = state(from);
    const auto arrival = paths_.arrival(memory_.arrivals[std::size_t(from)].approach, at, to);
    if (arrival) {
      arrival_ = {to.heading, cost_of(arrival->length, at, to), arrival->approach};
    }
    return arrival.has_value();
  }
  /// Stores what the last call of `joins` found out, or a start's approach.
  void added(Node node) {
    if (memory_.legs.parent(node) == LegTree::kNone) {
      const State& start = starts_[std::size_t(node)];
      arrival_ = {start.heading, 0, request_.before_start(start.position)};
    }
    memory_.arrivals.push_back(arrival_);
  }

  bool may_move(Node node, Node parent) {
    if (!joins(parent, state(node))) {
      return false;
    }
    const LegTree& legs = memory_.legs;
    for (Node child = paths_.looks_back() ? legs.first_child(node) : LegTree::kNone;
         child != LegTree::kNone; child = legs.sibling(child)) {
      if (!paths_.follows(arrival_.approach, state(node), state(child))) {
        return false;
      }
    }
    return true;
  }
  void moved(Node node) { memory_.arrivals[std::size_t(node)] = arrival_; }

  const LegRules& rules() const { return paths_.legs(); }
  std::string refusals() const { return rules().refusals(); }
  Route route_to(Node node) const {
    std::vector<State> poses;
    for (; node != LegTree::kNone; node = memory_.legs.parent(node)) {
      poses.push_back(state(node));
    }
    return paths_.route_through({poses.rbegin(), poses.rend()});
  }

 private:
  const Steering& steering() const { return paths_.steering(); }
  double cost_of(double length, const State& from, const State& to) const {
    return steering().is_calm() ? std::hypot(length, to.position.z() - from.position.z()) : length;
  }
  static double farthest(const std::vector<State>& states, const Vec3& from) {
    double maximum = 0;
    for (const State& state : states) {
      maximum = std::max(maximum, (state.position - from).norm());
    }
    return maximum;
  }
  bool is_goal(const State& state) const {
    return std::any_of(goals_.begin(), goals_.end(),
                       [&](const State& goal) { return same(state, goal); });
  }
  bool ends_anywhere() const {
    return request_.goal.tolerance_m > 0 && !request_.goal.heading && !request_.goal.loiter;
  }

  const Request& request_;
  const StarSettings& settings_;
  StarMemory& memory_;
  PathRules paths_;
  int axes_;
  std::vector<State> starts_;
  std::vector<State> goals_;
  StarMemory::Arrival arrival_;
};
}  // namespace altiplan::kit
