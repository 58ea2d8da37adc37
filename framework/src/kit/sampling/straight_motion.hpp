// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/sampling/leg_rules.hpp"
#include "altiplan/kit/sampling/sampling.hpp"
#include "altiplan/kit/sampling/star_search.hpp"
#include "altiplan/kit/sampling/tree_time.hpp"
#include "altiplan/kit/totals.hpp"

namespace altiplan::kit {

/// Measure of the unit ball.
inline double unit_ball(int axes) { return axes == 3 ? 4 * kPi / 3 : axes == 2 ? kPi : 2.0; }

/// The nodes of a tree are points joined by straight legs. Under turn limits, a parent is chosen or
/// changed only if the turns into all of a node's children remain valid.
class StraightMotion {
 public:
  using State = Vec3;
  using Node = LegTree::Node;
  static constexpr bool kExact = true;  ///< `minimum` is the length of an edge
  static constexpr std::size_t kBytesPerNode = 160;

  StraightMotion(const Request& request, const StarSettings& settings, StarMemory& memory)
      : request_(request),
        settings_(settings),
        memory_(memory),
        rules_(request),
        resources_(resources_of(request)),
        before_start_(request.before_start()),
        objective_(request.objective.get()),
        is_point_(request.goal.tolerance_m == 0),
        in_time_(avoids_moving(request)),
        axes_(std::max(1, free_axes(sampled_box(request)))) {}

  static const Vec3& place(const State& state) { return state; }
  const State& state(Node node) const { return memory_.legs.point(node); }
  static bool same(const State& a, const State& b) { return a == b; }
  static const State& sampled(const Vec3& p, RandomStream&) { return p; }
  static void aim(State&, Node, RandomStream&) {}
  std::vector<State> starts() const { return {request_.start.position}; }
  std::vector<State> goals() const { return {request_.goal.position}; }
  bool is_end(const State& p) const { return request_.goal.reached_at(p); }

  double minimum(Node from, const State& to) const {
    return (memory_.points.point(std::size_t(from)) - to).norm();
  }
  double metres(Node from, const State& to, double = 0) const { return (to - state(from)).norm(); }
  /// Cost of an edge of that length.
  double edge(Node from, const State& to, double metres) const {
    return objective_ == nullptr ? metres
                                 : objective_->cost(Leg::straight(state(from), to), 0, request_);
  }
  double edge_to(Node node) const {
    const Node from = memory_.legs.parent(node);
    return edge(from, state(node), (state(node) - state(from)).norm());
  }
  double to_go(const State& p) const {
    if (objective_ != nullptr) {
      return is_point_ ? objective_->bound(p, request_.goal.position, request_) : 0;
    }
    return std::max(0.0, (p - request_.goal.position).norm() - request_.goal.tolerance_m);
  }
  double min_route() const {
    if (objective_ != nullptr) {
      return to_go(request_.start.position);
    }
    return std::max(
        0.0, (request_.goal.position - request_.start.position).norm() - request_.goal.tolerance_m);
  }
  double max_cost(double best) const {
    return objective_ == nullptr ? request_.limits.max_route_length
           : settings_.bounded   ? best
                                 : kInfinity;
  }
  /// Length of an edge of at most that cost.
  double max_metres(double cost) const { return objective_ == nullptr ? cost : kInfinity; }
  bool is_short_enough(Node node, double cost) const {
    if (!resources_.empty()) {
      return keeps(resources_, Route(memory_.legs.way_to(node)), request_);
    }
    return objective_ != nullptr || cost <= request_.limits.max_route_length;
  }
  /// Distance over the ground from the foci of the informed set; under an objective the set is all
  /// of space, and bounds tell what may improve.
  double reach(double cost) const {
    return objective_ == nullptr ? cost + request_.goal.tolerance_m : kInfinity;
  }
  /// True if a route through p may cost less than `best`.
  bool may_improve(const Vec3& p, double best) const {
    return objective_ == nullptr || !settings_.bounded || best == kInfinity ||
           objective_->bound(request_.start.position, p, request_) + to_go(p) < best;
  }

  /// min(gamma (log n / n)^(1/d), eta).
  double near_radius(double n, double measure) const {
    const double d = axes_;
    return std::min(
        settings_.range,
        settings_.radius_scale *
            std::pow(2 * (1 + 1 / d) * measure / unit_ball(axes_) * std::log(n) / n, 1 / d));
  }

  /// The state to which the node's path toward another leads; none if it leads nowhere new.
  std::optional<State> steer(Node& from, const State& toward) const {
    const Vec3& at = state(from);
    const Vec3 x_new =
        altiplan::kit::steer(behind(from), at, toward, settings_.range, request_.limits);
    return x_new == toward || x_new == at ? std::nullopt : std::optional(x_new);
  }

  bool joins(Node from, const State& to) {
    return rules_.ok(behind(from), state(from), to) &&
           (!in_time_ || leg_in_time(memory_.legs, from, to, request_)) &&
           may_keep_totals(from, to);
  }
  void added(Node) {}

  /// True if the leg, the turns at both of its ends and the turns that follow satisfy every
  /// constraint, and no moving obstacle is met below the node at its new times.
  bool may_move(Node node, Node parent) {
    const auto before = behind(parent);
    return rules_.ok(before, state(parent), state(node)) &&
           turns_follow(onward(before, state(parent)), node) && takes_no_more(node, parent) &&
           (!in_time_ || branch_in_time(memory_.legs, node, parent, request_));
  }
  void moved(Node) {}

  const LegRules& rules() const { return rules_; }
  /// Of the last legs by the rules, and of all by limits on totals.
  std::string refusals() const {
    std::string text = rules_.refusals();
    for (const auto& [name, count] : used_up_) {
      text += (text.empty() ? "" : ", ") + name + " (" + std::to_string(count) + " in all)";
    }
    return text;
  }
  Route route_to(Node node) const { return memory_.legs.way_to(node); }

 private:
  bool may_keep_totals(Node from, const State& to) {
    if (resources_.empty()) {
      return true;
    }
    Polyline path = memory_.legs.way_to(from);
    path.push_back(to);
    const Resource* limit = used_up(resources_, path, request_);
    if (limit != nullptr) {
      ++used_up_[limit->name];
    }
    return limit == nullptr;
  }
  /// True if below another parent nothing that is limited is more than it was, here and so in all
  /// of the branch.
  bool takes_no_more(Node node, Node parent) const {
    const auto taken = [&](const Resource& resource, Node from) {
      const Polyline way = memory_.legs.way_to(from);
      double sum = resource.of(way.back(), state(node), request_);
      for (std::size_t i = 1; i < way.size(); ++i) {
        sum += resource.of(way[i - 1], way[i], request_);
      }
      return sum;
    };
    return std::all_of(resources_.begin(), resources_.end(), [&](const Resource& resource) {
      return taken(resource, parent) <= taken(resource, memory_.legs.parent(node));
    });
  }

  /// The approach to the node, if a constraint depends on it.
  std::optional<Approach> behind(Node node) const {
    return rules_.looks_back() ? memory_.legs.approach(node, 0, before_start_) : std::nullopt;
  }

  /// True if the turns into the legs below a node are valid for a vehicle that reaches it by
  /// `before`; beyond a leg without a heading, the turns that follow too.
  bool turns_follow(const Approach& before, Node node) {
    const LegTree& legs = memory_.legs;
    const Vec3& at = legs.point(node);
    for (Node child = legs.first_child(node); child != LegTree::kNone;
         child = legs.sibling(child)) {
      if (!rules_.follows(before, at, legs.point(child)) ||
          (!has_heading(legs.point(child) - at) && !turns_follow(onward(before, at), child))) {
        return false;
      }
    }
    return true;
  }

  const Request& request_;
  const StarSettings& settings_;
  StarMemory& memory_;
  LegRules rules_;
  std::vector<Resource> resources_;
  std::map<std::string, std::int64_t> used_up_;  ///< legs by the limit that they do not keep
  std::optional<Approach> before_start_;
  const Objective* objective_;  ///< null: length
  bool is_point_;               ///< the goal has no tolerance
  bool in_time_;                ///< among moving obstacles
  int axes_;
};
}  // namespace altiplan::kit
