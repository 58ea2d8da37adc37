// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/kit/open_list.hpp"
#include "altiplan/kit/scratch.hpp"
#include "search_parts.hpp"

namespace altiplan::astar {

/// What a search knows of a cell.
struct Node {
  double g;         ///< metres from the start
  float clearance;  ///< lower bound at the centre; NaN: not asked for yet
  std::uint16_t stamp;
  std::uint8_t in;  ///< direction of the step that led here; kHere: linked to the start
  bool closed;
};
inline constexpr Node kFresh = {kInfinity, std::numeric_limits<float>::quiet_NaN(), 0, 0, false};

struct Memory {
  kit::NodeStore<Node> nodes;
  kit::OpenList open;
};

/// One A* search from request.start to request.goal over the cells of a lattice.
///
/// Start and goal join the lattice by straight links (Lattice::links), so neither has to be the
/// centre of a cell. A closed cell stays closed: with limits on turns its parent then never changes
/// under its successors, and without them a consistent heuristic never asks for it.
class Search {
 public:
  Search(const Request& request, const Settings& settings, const kit::Lattice& lattice,
         Memory& memory)
      : request_(request),
        settings_(settings),
        lattice_(lattice),
        rules_(request, lattice, settings.moves, settings.corner),
        nodes_(memory.nodes),
        open_(memory.open),
        watch_(request.budget),
        goal_node_(std::uint32_t(lattice.size())),
        longest_(request.limits.max_route_length + kLengthTolerance),
        limited_length_(longest_ < kInfinity),
        start_(request.start.position),
        goal_(request.goal.position) {}

  PlanResult run() {
    begin();
    PlanResult result;
    while (true) {
      if (open_.empty()) {
        result.status = Status::no_route;
        break;
      }
      const auto [f, g, index] = open_.pop();
      if (index == goal_node_) {
        return found(goal_parent_, true);
      }
      Node& node = nodes_[index];
      if (node.closed) {
        continue;
      }
      if (watch_.spent(progress_.expanded) || memory_full()) {
        result.budget_hit = true;
        result.status = watch_.cancelled() ? Status::cancelled : Status::timed_out;
        break;
      }
      node.closed = true;
      expand(index, node);
    }
    if (fallback_ != kNone) {
      const bool budget_hit = result.budget_hit;
      result = found(fallback_, false);
      result.budget_hit = budget_hit;
      return result;
    }
    progress_.memory_full = memory_full();
    result.message = explanation(result.status, progress_, request_, lattice_, rules_);
    // Beyond this a cell may have been closed by a parent, or at a length, that was not the best.
    result.proved = result.status == Status::no_route && !rules_.parent_mattered() &&
                    (!progress_.too_long || settings_.consistent());
    result.counters = counters(progress_, lattice_, rules_);
    return result;
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  void begin() {
    nodes_.reset(lattice_.size());
    // Far below a metre's share of any route, far above the rounding of its sum.
    open_.clear(std::max((goal_ - start_).norm(), 1.0) * 1e-12 *
                std::max(settings_.weight_g, settings_.weight_h));
    link_goal();
    for (const kit::Lattice::Link& link : lattice_.links(start_)) {
      if (rules_.cell_blocked(link.cell) ||
          (link.length > 0 &&
           !rules_.any_leg_ok(request_.before_start(), start_, lattice_.position(link.cell)))) {
        continue;
      }
      Node& node = reach(lattice_.index(link.cell), link.length, kit::kHere);
      push(lattice_.index(link.cell), link.cell, node.g);
    }
  }

  /// Cells from which the goal is one leg away. For the heuristic a link counts only where no other
  /// is on a way from it to the goal that is as short.
  void link_goal() {
    goal_links_ = lattice_.links(goal_);
    for (const kit::Lattice::Link& link : goal_links_) {
      bool needed = true;
      for (const kit::Lattice::Link& other : ends_) {
        needed = needed && link.length < lattice_.distance(link.cell, other.cell) + other.length;
      }
      if (needed) {
        ends_.push_back(link);
      }
    }
  }

  /// Lower bound of the way from the cell to the goal (but for `manhattan`).
  double heuristic(const Cell& c) const {
    switch (settings_.heuristic) {
      case Heuristic::octile: {
        if (ends_.empty()) {  // only the goal's tolerance is on the lattice
          return std::max(0.0, (lattice_.position(c) - goal_).norm() - request_.goal.tolerance_m);
        }
        double least = kInfinity;
        for (const kit::Lattice::Link& end : ends_) {
          least = std::min(least, lattice_.distance(c, end.cell) + end.length);
        }
        return least;
      }
      case Heuristic::euclidean:
        return (lattice_.position(c) - goal_).norm();
      case Heuristic::manhattan:
        return (lattice_.position(c) - goal_).lpNorm<1>();
      case Heuristic::zero:
        break;
    }
    return 0;
  }

  Node& reach(std::uint32_t index, double g, int in) {
    Node& node = nodes_.at(index, kFresh);
    node.g = g;
    node.in = std::uint8_t(in);
    return node;
  }

  void push(std::uint32_t index, const Cell& c, double g) {
    ++progress_.generated;
    open_.push(settings_.weight_g * g + settings_.weight_h * heuristic(c), g, index);
  }

  /// Where the vehicle comes from at a closed cell; nothing when it starts there without heading.
  std::optional<Vec3> before(const Node& node, const Vec3& here) const {
    if (node.in != kit::kHere) {
      return Vec3(here - lattice_.step(node.in));
    }
    return node.g > 0 ? std::optional<Vec3>(start_) : request_.before_start();
  }

  void expand(std::uint32_t index, Node& node) {
    const Cell c = lattice_.cell(index);
    const bool at_start = node.in == kit::kHere && node.g == 0;
    const Vec3 here = at_start ? start_ : lattice_.position(c);
    const std::optional<Vec3> from = before(node, here);
    ++progress_.expanded;
    remember_nearest(here);
    if (request_.trace != nullptr) {
      add_to_trace(index, node, c, here);
    }
    try_goal(index, node, c, here, from);
    // A first step after a heading, or after a link, is no pair of steps: it is judged whole.
    const bool judged_whole = node.in == kit::kHere && from;
    for (kit::DirectionMask open = rules_.candidates(c, node.in); open != 0; open &= open - 1) {
      const int d = __builtin_ctz(open);
      const auto next = std::uint32_t(std::int64_t(index) + lattice_.stride(d));
      Node& successor = nodes_.at(next, kFresh);
      const double length = lattice_.step_length(d);
      const double g = node.g + length;
      if (successor.closed || !(g < successor.g)) {
        continue;
      }
      const Cell o = kit::offset(d);
      const Cell to = {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
      const Vec3 there = lattice_.position(to);
      if (limited_length_ && g + (goal_ - there).norm() - request_.goal.tolerance_m > longest_) {
        progress_.too_long = true;
        continue;
      }
      if (!rules_.leg_free(from, here, there, length, clearance(node, here),
                           clearance(successor, there)) ||
          (judged_whole && !rules_.any_leg_ok(from, here, there))) {
        continue;
      }
      successor.g = g;
      successor.in = std::uint8_t(d);
      push(next, to, g);
    }
  }

  /// Asked for once a cell, where the rules can use it.
  double clearance(Node& node, const Vec3& at) const {
    if (!rules_.wants_clearance()) {
      return -kInfinity;
    }
    if (std::isnan(node.clearance)) {
      // Rounded toward the obstacle.
      node.clearance = std::nextafterf(float(request_.world->clearance(at)),
                                       -std::numeric_limits<float>::infinity());
    }
    return node.clearance;
  }

  /// Reaches the goal from a cell that has a link to it.
  void try_goal(std::uint32_t index, const Node& node, const Cell& c, const Vec3& here,
                const std::optional<Vec3>& from) {
    for (const kit::Lattice::Link& link : goal_links_) {
      if (link.cell != c) {
        continue;
      }
      const double g = node.g + link.length;
      if (g <= longest_ && (link.length == 0 || rules_.any_leg_ok(from, here, goal_))) {
        if (g < goal_g_) {
          goal_g_ = g;
          goal_parent_ = index;
          open_.push(settings_.weight_g * g, g, goal_node_);
        }
        return;
      }
    }
    if (node.g < fallback_g_ && node.g <= longest_ && request_.goal.reached_at(here)) {
      fallback_g_ = node.g;
      fallback_ = index;
    }
  }

  /// Of this search, not of what the pool's memory has grown to.
  bool memory_full() const {
    return lattice_.size() * sizeof(Node) + open_.size() * sizeof(kit::OpenList::Entry) >
           settings_.max_bytes;
  }

  PlanResult found(std::uint32_t last, bool at_goal) const {
    Route route = route_to(
        last, request_, lattice_, [&](std::uint32_t index, int) { return int(nodes_[index].in); },
        [&](std::uint32_t index) { return nodes_[index].g == 0; });
    if (at_goal) {
      end_at_goal(route, goal_, nodes_[last].g == goal_g_);
    }
    return solved(std::move(route), progress_, lattice_, rules_);
  }

  void remember_nearest(const Vec3& here) {
    const double distance = (here - goal_).squaredNorm();
    if (distance < nearest_) {
      nearest_ = distance;
      progress_.nearest = here;
    }
  }

  void add_to_trace(std::uint32_t index, const Node& node, const Cell& c, const Vec3& here) const {
    const std::int64_t parent =
        node.in == kit::kHere ? -1 : std::int64_t(index) - lattice_.stride(node.in);
    request_.trace->add({TraceEvent::Kind::expanded, std::int64_t(index), parent, here,
                         settings_.weight_g * node.g + settings_.weight_h * heuristic(c)});
  }

  const Request& request_;
  const Settings& settings_;
  const kit::Lattice& lattice_;
  kit::MoveRules rules_;
  kit::NodeStore<Node>& nodes_;
  kit::OpenList& open_;
  BudgetWatch watch_;
  std::uint32_t goal_node_;
  double longest_;  ///< metres that a route may have
  bool limited_length_;
  Vec3 start_;
  Vec3 goal_;
  std::vector<kit::Lattice::Link> goal_links_;
  std::vector<kit::Lattice::Link> ends_;
  double goal_g_ = kInfinity;
  std::uint32_t goal_parent_ = kNone;
  double fallback_g_ = kInfinity;
  std::uint32_t fallback_ = kNone;  ///< ends within the tolerance, where the goal has no link
  double nearest_ = kInfinity;
  Progress progress_;
};
}  // namespace altiplan::astar
