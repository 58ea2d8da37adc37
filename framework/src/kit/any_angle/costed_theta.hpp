// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "altiplan/kit/any_angle/any_angle.hpp"
#include "altiplan/kit/lattice/goal_search.hpp"
#include "altiplan/kit/totals.hpp"

namespace altiplan::kit {

/// Theta* and Lazy Theta* by an objective, or with limits on totals (the planners theta_star and
/// lazy_theta_star say of whom): a cell keeps the path that costs least of those that keep the
/// limits, so that it may miss one that goes on within them. Where costs differ from place to place
/// a straight leg from the parent may cost more than the step: a cell takes the cheaper of the two
/// that is valid. Costs are real numbers; closed cells are never reopened.
class CostedTheta : GoalSearch {
 public:
  /// Memory of a search, by cell.
  struct Node {
    double g = kInfinity;
    std::uint32_t parent = kNone;  ///< kNone: the start
    bool closed = false;
    bool unseen = false;  ///< the leg from the parent is not checked yet
  };

  CostedTheta(const Request& request, const SearchSettings& settings, const Lattice& lattice,
              Sight sight, OpenList& open)
      : GoalSearch(request, settings, lattice, kInfinity, open),
        lazy_(sight == Sight::lazy),
        looks_back_(request.limits.turns() || request.judges_pairs()),
        resources_(resources_of(request)),
        nodes_(lattice.size()) {}

  SearchResult run() {
    begin();
    PlanStatus status = PlanStatus::no_route;
    while (!open_.empty()) {
      const std::uint32_t index = open_.pop().node;
      if (index == kGoal) {
        return with(route_to(goal_parent_, true), goal_g_, true, false);
      }
      if (nodes_[index].closed) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_.size()) || memory_full()) {
        status = ended();
        break;
      }
      if (!nodes_[index].unseen || set_vertex(index)) {
        expand(index);
      }
    }
    if (fallback_ != kNone) {
      return with(route_to(fallback_, false), fallback_g_, false, status != PlanStatus::no_route);
    }
    progress_.memory_full = memory_full();
    return without(status, false);
  }

 private:
  Vec3 position(std::uint32_t n) const {
    return n == kNone ? start_ : lattice_.position(lattice_.cell(n));
  }
  double g(std::uint32_t n) const { return n == kNone ? 0 : nodes_[n].g; }
  double cost(std::uint32_t a, const Vec3& b) const {
    const Vec3 from = position(a);
    return costs_.leg(from, b, (b - from).norm());
  }

  double min_cost(const Vec3& a, const Vec3& b) const {
    return request_.objective ? request_.objective->bound(a, b, request_)
                              : costs_.min_per_metre() * (b - a).norm();
  }

  /// The approach to a node by the legs that lead there.
  std::optional<Approach> before_node(std::uint32_t n) const {
    Polyline points{position(n)};
    while (n != kNone) {
      n = nodes_[n].parent;
      points.push_back(position(n));
    }
    std::reverse(points.begin(), points.end());
    return altiplan::approach(points, points.size() - 1, request_.before_start());
  }
  /// True as well if limits on totals may be kept by the path over a.
  bool sees(std::uint32_t a, const Vec3& b) {
    return may_keep_totals(a, b) &&
           rules_.any_leg_ok(looks_back_ ? before_node(a) : std::nullopt, position(a), b);
  }

  bool may_keep_totals(std::uint32_t n, const Vec3& to) {
    if (resources_.empty()) {
      return true;
    }
    Polyline path = route_to(n, false);
    path.push_back(to);
    const Resource* used = used_up(resources_, path, request_);
    if (used != nullptr) {
      progress_.pruned_by = used->name;
    }
    return used == nullptr;
  }

  void begin() {
    open_.clear(quantum());
    for (const Lattice::Link& link : lattice_.links(start_)) {
      const Vec3 there = lattice_.position(link.cell);
      if (!rules_.cell_blocked(link.cell) && (link.length == 0 || sees(kNone, there))) {
        take(lattice_.index(link.cell), kNone, link_cost(start_, there, link.length), false);
      }
    }
  }

  void take(std::uint32_t n, std::uint32_t parent, double g, bool unseen) {
    if (g >= nodes_[n].g) {
      return;
    }
    nodes_[n] = {g, parent, false, unseen};
    ++progress_.generated;
    const Cell c = lattice_.cell(n);
    open_.push(evaluation(g, c, lattice_.position(c)), g, n);
  }

  void expand(std::uint32_t s) {
    nodes_[s].closed = true;
    ++progress_.expanded;
    const Cell c = lattice_.cell(s);
    const Vec3 here = lattice_.position(c);
    remember_nearest(here);
    if (request_.trace != nullptr) {
      const std::uint32_t parent = nodes_[s].parent;
      request_.trace->add({TraceEvent::Kind::expanded, std::int64_t(s),
                           parent == kNone ? -1 : std::int64_t(parent), here,
                           evaluation(nodes_[s].g, c, here)});
    }
    if (const Lattice::Link* link = to_goal_.link_of(c)) {
      reach_goal(s, link->length == 0);
    } else if (nodes_[s].g < fallback_g_ && request_.goal.reached_at(here) &&
               is_short_enough(s, here)) {
      fallback_g_ = nodes_[s].g;
      fallback_ = s;
    }
    for (DirectionMask open = rules_.candidates(c, kHere); open != 0; open &= open - 1) {
      const Cell o = offset(std::countr_zero(open));
      update_vertex(s, lattice_.index({c[0] + o[0], c[1] + o[1], c[2] + o[2]}));
    }
  }

  /// Reaches v from the parent of s or from s, whichever costs less and is valid. The parent's leg
  /// is long: its cost is asked for only if its bound leaves a chance.
  void update_vertex(std::uint32_t s, std::uint32_t v) {
    if (nodes_[v].closed) {
      return;
    }
    const Vec3 there = position(v);
    const std::uint32_t p = nodes_[s].parent;
    const double known = nodes_[v].g;
    const double by_step = g(s) + priced(cost(s, there), there);
    const double at_least = g(p) + min_cost(position(p), there);
    double by_parent = kInfinity;
    if (at_least < known && at_least <= by_step) {
      by_parent = g(p) + cost(p, there);
      if (by_parent <= by_step && by_parent < known && (lazy_ || sees(p, there))) {
        return take(v, p, by_parent, lazy_);
      }
    }
    if (by_step < known && sees(s, there)) {
      return take(v, s, by_step, false);
    }
    if (by_parent < known && by_parent > by_step && sees(p, there)) {
      take(v, p, by_parent, false);
    }
  }

  /// Checks the leg to s. If it is refused, s is reached from the best of its closed neighbours and
  /// waits again, or is unreached.
  bool set_vertex(std::uint32_t s) {
    const Vec3 here = position(s);
    nodes_[s].unseen = false;
    if (sees(nodes_[s].parent, here)) {
      return true;
    }
    const Cell c = lattice_.cell(s);
    double best_g = kInfinity;
    std::uint32_t best = kNone;
    for (DirectionMask around = lattice_.steps() & lattice_.inside(c); around != 0;
         around &= around - 1) {
      const Cell o = offset(std::countr_zero(around));
      const std::uint32_t n = lattice_.index({c[0] + o[0], c[1] + o[1], c[2] + o[2]});
      const double by_step = nodes_[n].closed ? nodes_[n].g + cost(n, here) : kInfinity;
      if (by_step < best_g && sees(n, here)) {
        best_g = by_step;
        best = n;
      }
    }
    nodes_[s] = {};
    if (best != kNone) {
      take(s, best, best_g, false);
    }
    return false;
  }

  void reach_goal(std::uint32_t s, bool is_at_goal) {
    const std::uint32_t p = nodes_[s].parent;
    if (is_at_goal) {
      return offer_goal(s, s, nodes_[s].g);
    }
    offer_goal(p, p, g(p) + cost(p, goal_));
    offer_goal(s, s, g(s) + cost(s, goal_));
  }
  void offer_goal(std::uint32_t from, std::uint32_t parent, double at_goal) {
    const bool is_there = from != kNone && to_goal_.link_of(lattice_.cell(from)) != nullptr &&
                          to_goal_.link_of(lattice_.cell(from))->length == 0;
    if (at_goal < goal_g_ && is_short_enough(parent, goal_) &&
        (is_there ? may_keep_totals(parent, goal_) : sees(from, goal_))) {
      goal_g_ = at_goal;
      goal_parent_ = parent;
      request_.budget.show_best(at_goal);
      open_.push(settings_.weight_g * at_goal, at_goal, kGoal);
    }
  }

  /// True if a route over the node to a place keeps the limit on its length.
  bool is_short_enough(std::uint32_t n, const Vec3& to) {
    Polyline points = route_to(n, false);
    points.push_back(to);
    const bool is_ok = longest_ == kInfinity || length(points) <= longest_;
    progress_.too_long = progress_.too_long || !is_ok;
    return is_ok;
  }

  Polyline route_to(std::uint32_t last, bool at_goal) const {
    Polyline route;
    for (std::uint32_t n = last; n != kNone; n = nodes_[n].parent) {
      route.push_back(position(n));
    }
    if (route.empty() || (route.back() - start_).norm() > kLengthTolerance) {
      route.push_back(start_);
    } else {
      route.back() = start_;
    }
    std::reverse(route.begin(), route.end());
    if (at_goal) {
      const bool is_there = (route.back() - goal_).norm() <= kLengthTolerance && route.size() > 1;
      end_at_goal(route, goal_, is_there);
    }
    return route;
  }

  bool memory_full() const {
    return nodes_.size() * sizeof(Node) + open_.size() * sizeof(OpenList::Entry) >
           settings_.max_bytes;
  }

  bool lazy_;
  bool looks_back_;  ///< a constraint may depend on the leg before
  std::vector<Resource> resources_;
  std::vector<Node> nodes_;
};
}  // namespace altiplan::kit
