// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "legs.hpp"

namespace altiplan::dstar_lite {

/// A link to or from the lattice: a node and the cost of the leg.
struct Link {
  std::uint32_t node;
  std::uint32_t cost;
};

/// A few links among many nodes.
class Links {
 public:
  void clear() {
    all_.clear();
    first_ = kNever;
    span_ = 0;
  }
  void add(std::uint32_t node, std::uint32_t cost) {
    const std::uint32_t last = all_.empty() ? node : std::max(first_ + span_, node);
    first_ = std::min(first_, node);
    span_ = last - first_;
    all_.push_back({node, cost});
  }
  const std::vector<Link>& all() const { return all_; }
  bool may_hold(std::uint32_t node) const { return node - first_ <= span_; }
  /// Cost of the node's link, kNever if it has none.
  std::uint32_t cost(std::uint32_t node) const {
    std::uint32_t minimum = kNever;
    if (may_hold(node)) {
      for (const Link& link : all_) {
        minimum = link.node == node ? std::min(minimum, link.cost) : minimum;
      }
    }
    return minimum;
  }

 private:
  std::vector<Link> all_;
  std::uint32_t first_ = kNever;
  std::uint32_t span_ = 0;
};

/// Calls visit(link) for the cells from which the goal may be one leg away; `within`: for those
/// within its tolerance, where routes may end.
template <class Visit>
void for_each_goal_link(const Problem& problem, Legs& legs, bool within, const Visit& visit) {
  const kit::Lattice& lattice = problem.lattice;
  const Goal& goal = problem.request.goal;
  if (!within) {
    for (const kit::Lattice::Link& link : lattice.links(goal.position)) {
      if (!legs.rules().cell_blocked(link.cell)) {
        visit(link);
      }
    }
    return;
  }
  const Vec3 reach = Vec3::Constant(goal.tolerance_m);
  const Box box{goal.position - reach, goal.position + reach};
  cells_in(box, lattice).for_each([&](const Cell& c) {
    if (goal.reached_at(lattice.position(c)) && !legs.rules().cell_blocked(c)) {
      visit(kit::Lattice::Link{c, 0});
    }
  });
}

/// Calls visit(link) for the links that the vehicle may fly from its current position.
template <class Visit>
void for_each_start_link(const Problem& problem, Legs& legs,
                         const std::vector<kit::Lattice::Link>& links, const Visit& visit) {
  const Request& request = problem.request;
  for (const kit::Lattice::Link& link : links) {
    if (!legs.rules().cell_blocked(link.cell) &&
        (link.length == 0 || legs.rules().any_leg_ok(request.before_start(), request.start.position,
                                                     problem.lattice.position(link.cell)))) {
      visit(link);
    }
  }
}

/// The graph whose vertices are cells.
class CellGraph {
 public:
  static constexpr std::uint32_t kPerCell = 1;

  CellGraph(const Problem& problem, Legs& legs, const ToStart& to_start)
      : problem_(problem), lattice_(problem.lattice), legs_(legs), to_start_(to_start) {
    for (int d = 0; d < kit::kDirections; ++d) {
      const Cell o = kit::offset(d);
      moves_[std::size_t(d)] = {std::uint32_t(lattice_.stride(d)), problem.costs[d], o[0], o[1],
                                o[2]};
    }
  }

  Cell cell(std::uint32_t node) const { return lattice_.cell(node); }
  /// h(start, node).
  std::uint32_t estimate(const Cell& c) const { return to_start_(c); }

  /// Calls visit(s, c(s, u), cell of s) for the vertices from which a leg leads to u, at cell c,
  /// except in the directions `without`.
  template <class Visit>
  void predecessors(std::uint32_t u, const Cell& c, kit::DirectionMask without,
                    const Visit& visit) {
    const kit::DirectionMask free = legs_.into(u, c) & ~without;
    // Among equals the last one is taken first: the step along most axes.
    for (const kit::DirectionMask along : kit::kAlongAxes) {
      for (kit::DirectionMask open = free & along; open != 0; open &= open - 1) {
        const Move& move = moves_[std::size_t(std::countr_zero(open))];
        visit(u + move.stride, move.cost, Cell{c[0] + move.x, c[1] + move.y, c[2] + move.z});
      }
    }
  }
  /// Calls visit(n, c(s, n), is_free) for the vertices to which a leg from s may lead; is_free()
  /// checks the leg. The vertex in direction `likely` comes first; stops when a visit returns
  /// false.
  template <class Visit>
  void successors(std::uint32_t s, int likely, const Visit& visit) {
    const Cell c = lattice_.cell(s);
    const bool judges = legs_.judges();
    kit::DirectionMask open = legs_.out_of(c);
    while (open != 0) {
      const int d = take_direction(open, likely);
      const Move& move = moves_[std::size_t(d)];
      if (!visit(s + move.stride, move.cost, [&, d] { return !judges || legs_.leads(s, c, d); })) {
        return;
      }
    }
  }
  /// Direction of the leg from s to its successor n.
  int direction(std::uint32_t s, std::uint32_t n) const {
    int d = 0;
    while (moves_[std::size_t(d)].stride != n - s) {
      ++d;
    }
    return d;
  }
  /// Cost of the leg from a vertex to the goal, kNever if there is none.
  std::uint32_t goal_cost(std::uint32_t s) const { return goal_.cost(s); }
  /// The vertices to which the vehicle may fly from its current position.
  const Links& start() const { return start_; }
  /// Calls visit(s) for the vertices that are, or may have been, one leg from the goal.
  template <class Visit>
  void for_each_at_goal(const Visit& visit) {
    for (const kit::Lattice::Link& link : lattice_.links(problem_.request.goal.position)) {
      visit(lattice_.index(link.cell));
    }
    for (const Link& link : goal_.all()) {
      visit(link.node);
    }
  }
  /// Calls visit(s) for the vertices of a cell.
  template <class Visit>
  void for_each_at(const Cell& c, const Visit& visit) const {
    visit(lattice_.index(c));
  }

  void find_goal(bool within) {
    goal_.clear();
    for_each_goal_link(problem_, legs_, within, [&](const kit::Lattice::Link& link) {
      const bool is_free =
          link.length == 0 || legs_.rules().any_leg_ok(std::nullopt, lattice_.position(link.cell),
                                                       problem_.request.goal.position);
      if (is_free) {
        goal_.add(lattice_.index(link.cell), problem_.costs.of_link(link.length));
      }
    });
  }
  void find_start(const std::vector<kit::Lattice::Link>& links) {
    start_.clear();
    for_each_start_link(problem_, legs_, links, [&](const kit::Lattice::Link& link) {
      start_.add(lattice_.index(link.cell), problem_.costs.of_link(link.length));
    });
  }

 private:
  struct Move {
    std::uint32_t stride;  ///< index difference, modulo 2^32
    std::uint32_t cost;
    int x, y, z;
  };

  const Problem& problem_;
  const kit::Lattice& lattice_;
  Legs& legs_;
  const ToStart& to_start_;
  std::array<Move, kit::kDirections> moves_{};
  Links goal_;
  Links start_;
};
}  // namespace altiplan::dstar_lite
