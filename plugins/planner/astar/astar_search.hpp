// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "altiplan/kit/lattice/goal_search.hpp"
#include "altiplan/kit/scratch.hpp"

namespace altiplan::astar {

/// State of a cell in the search.
struct Node {
  double g;  ///< cost-to-come from the start
  std::uint16_t stamp;
  std::uint8_t in;  ///< the step that led here; kHere: linked to the start
  bool closed;
};
inline constexpr Node kFresh = {kInfinity, 0, 0, false};

struct Memory {
  kit::NodeStore<Node> nodes;
  kit::OpenList open;
  std::vector<double> lengths;  ///< lengths of the paths, where costs are not lengths
};

/// One A* search from request.start to request.goal over the cells of a lattice.
///
/// Straight links (Lattice::links) join start and goal to the lattice, so neither has to be the
/// centre of a cell. A closed cell is never reopened: under turn limits its parent then never
/// changes under its successors, and without them a consistent heuristic never requires it.
class Search : kit::GoalSearch {
 public:
  Search(const Request& request, const kit::SearchSettings& settings, const kit::Lattice& lattice,
         double best_cost, Memory& memory)
      : GoalSearch(request, settings, lattice, best_cost, memory.open),
        nodes_(memory.nodes),
        lengths_(memory.lengths) {}

  kit::SearchResult run() {
    begin();
    PlanStatus status = PlanStatus::no_route;
    while (!open_.empty()) {
      const auto [f, g, index] = open_.pop();
      if (index == kGoal) {
        return with(route_to(goal_parent_, true), goal_g_, true, false);
      }
      Node& node = nodes_[index];
      if (!open_.empty()) {
        nodes_.prefetch(open_.top().node);
      }
      if (node.closed) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_.size()) || memory_full()) {
        status = ended();
        break;
      }
      node.closed = true;
      expand(index, node);
    }
    if (fallback_ != kNone) {
      return with(route_to(fallback_, false), fallback_g_, false, status != PlanStatus::no_route);
    }
    progress_.memory_full = memory_full();
    // Otherwise a cell may have been closed by a parent, or at a length, that was not the best.
    return without(status, !rules_.parent_mattered() && lengths_prove());
  }

 private:
  void begin() {
    nodes_.reset(lattice_.size());
    open_.clear(quantum());
    if (keeps_lengths()) {
      lengths_.resize(lattice_.size());
    }
    for (const kit::Lattice::Link& link : lattice_.links(start_)) {
      const Vec3 there = lattice_.position(link.cell);
      if (rules_.cell_blocked(link.cell) ||
          (link.length > 0 && !rules_.any_leg_ok(request_.before_start(), start_, there))) {
        continue;
      }
      const double g = link_cost(start_, there, link.length);
      if (g == kInfinity) {
        continue;
      }
      at_start_ = link.length == 0;
      const std::uint32_t index = lattice_.index(link.cell);
      reach(index, g, link.length, kit::kHere);
      push(index, link.cell, there);
    }
  }

  /// Begins to fetch the cell's nodes and those around it, which a search over many cells finds in
  /// none of the processor's caches.
  void prefetch_around(std::uint32_t index) const {
    constexpr kit::DirectionMask kAcross =
        kit::directions_where([](const Cell& o) { return o[0] == 0; });
    for (kit::DirectionMask left = kAcross; left != 0; left &= left - 1) {
      nodes_.prefetch(std::size_t(index + lattice_.stride(__builtin_ctz(left))));
    }
  }

  void reach(std::uint32_t index, double g, double length, int in) {
    Node& node = nodes_.at(index, kFresh);
    node.g = g;
    node.in = std::uint8_t(in);
    if (keeps_lengths()) {
      lengths_[index] = length;
    }
  }

  void push(std::uint32_t index, const Cell& c, const Vec3& at) {
    ++progress_.generated;
    const double g = nodes_[index].g;
    open_.push(evaluation(g, c, at), g, index);
  }

  double length_to(std::uint32_t index, const Node& node) const {
    return keeps_lengths() ? lengths_[index] : node.g;
  }

  void expand(std::uint32_t index, Node& node) {
    prefetch_around(index);
    const Cell c = lattice_.cell(index);
    const Vec3 here = node.in == kit::kHere && at_start_ ? start_ : lattice_.position(c);
    const std::optional<Approach> from = before(node.in, here);
    const double length_here = length_to(index, node);
    ++progress_.expanded;
    remember_nearest(here);
    if (request_.trace != nullptr) {
      add_to_trace(index, node, c, here);
    }
    try_goal(index, node.g, length_here, c, here, from);
    // A first step after a heading, or after a link, forms no pair of steps: it is checked as a
    // whole.
    const bool judged_whole = rules_.is_first(node.in) && from;
    const auto cell_at = [&](int d) {
      const Cell o = kit::offset(d);
      return Cell{c[0] + o[0], c[1] + o[1], c[2] + o[2]};
    };
    kit::DirectionMask better = 0;
    std::array<double, kit::kDirections> g_to;  // of the better ones
    for (kit::DirectionMask open = rules_.candidates(c, node.in); open != 0; open &= open - 1) {
      const int d = __builtin_ctz(open);
      const Node& successor = nodes_.at(std::uint32_t(index + lattice_.stride(d)), kFresh);
      if (successor.closed || successor.g <= node.g) {
        continue;
      }
      const Vec3 there = lattice_.position(cell_at(d));
      const double g = g_to[std::size_t(d)] = node.g + step_cost(c, d, here, there);
      const bool is_better = g < successor.g &&
                             !too_long(length_here + lattice_.step_length(d), there) &&
                             !exceeds_incumbent(g, there);
      better |= kit::DirectionMask(is_better) << d;
    }
    better = better == 0 ? 0 : rules_.legs_free(from, c, here, better);
    for (; better != 0; better &= better - 1) {
      const int d = __builtin_ctz(better);
      const Cell to = cell_at(d);
      const Vec3 there = lattice_.position(to);
      if (judged_whole && !rules_.any_leg_ok(from, here, there)) {
        continue;
      }
      const auto next = std::uint32_t(index + lattice_.stride(d));
      reach(next, g_to[std::size_t(d)], length_here + lattice_.step_length(d),
            rules_.step_after(node.in, d));
      push(next, to, there);
    }
  }

  /// Memory of this search, not the size to which the pool has grown.
  bool memory_full() const {
    return lattice_.size() * sizeof(Node) + open_.size() * sizeof(kit::OpenList::Entry) +
               means_bytes() >
           settings_.max_bytes;
  }

  Polyline route_to(std::uint32_t last, bool at_goal) const {
    Polyline route = kit::route_to(
        last, request_, lattice_,
        [&](std::uint32_t index, int) { return kit::direction_of(nodes_[index].in); },
        [&](std::uint32_t) { return at_start_; });
    if (at_goal) {
      kit::end_at_goal(route, goal_, to_goal_.link_of(lattice_.cell(last))->length == 0);
    }
    return route;
  }

  void add_to_trace(std::uint32_t index, const Node& node, const Cell& c, const Vec3& here) const {
    const std::int64_t parent =
        node.in == kit::kHere ? -1
                              : std::int64_t(index) - lattice_.stride(kit::direction_of(node.in));
    request_.trace->add({TraceEvent::Kind::expanded, std::int64_t(index), parent, here,
                         evaluation(node.g, c, here)});
  }

  kit::NodeStore<Node>& nodes_;
  std::vector<double>& lengths_;
};
}  // namespace altiplan::astar
