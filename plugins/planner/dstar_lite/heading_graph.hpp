// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "cell_graph.hpp"

namespace altiplan::dstar_lite {

/// The graph whose vertices are cells with the direction of the step that led there, for rules that
/// look at two legs; kHere: the vehicle has come there from where it is now.
class HeadingGraph {
 public:
  static constexpr std::uint32_t kPerCell = kit::kDirections;

  HeadingGraph(const Problem& problem, Legs& legs, const ToStart& to_start)
      : problem_(problem), lattice_(problem.lattice), legs_(legs), to_start_(to_start) {}

  Cell cell(std::uint32_t node) const { return lattice_.cell(node / kPerCell); }
  std::uint32_t estimate(const Cell& c) const { return to_start_(c); }

  template <class Visit>
  void predecessors(std::uint32_t u, const Cell& c, kit::DirectionMask, const Visit& visit) {
    const int in = heading(u);
    if (in != kit::kHere && (legs_.into(u / kPerCell, c) >> kit::opposite(in) & 1) != 0) {
      visit_before(c, in, [&](std::uint32_t s, const Cell& from, int d) {
        if (follows(from, d, in)) {
          visit(s, problem_.costs[in], from);
        }
      });
    }
  }
  template <class Visit>
  void successors(std::uint32_t s, int likely, const Visit& visit) {
    const int in = heading(s);
    const Cell c = cell(s);
    kit::DirectionMask open = legs_.steps() & legs_.rules().after(in) & lattice_.inside(c);
    open &= legs_.judges() ? ~kit::DirectionMask{0} : legs_.into(s / kPerCell, c);
    while (open != 0) {
      const int d = take_direction(open, likely);
      const auto is_free = [&, d] {
        return (!legs_.judges() || legs_.leads(s / kPerCell, c, d)) && follows(c, in, d);
      };
      const auto next = std::uint32_t(s / kPerCell + lattice_.stride(d));
      if (!visit(node(next, d), problem_.costs[d], is_free)) {
        return;
      }
    }
  }

  static int direction(std::uint32_t, std::uint32_t n) { return heading(n); }

  std::uint32_t goal_cost(std::uint32_t s) const {
    const std::uint32_t cost = goal_.cost(s / kPerCell);
    if (cost == kNever || cost == 0) {
      return cost;
    }
    const Cell c = cell(s);
    return legs_.rules().any_leg_ok(before(c, heading(s)), lattice_.position(c),
                                    problem_.request.goal.position)
               ? cost
               : kNever;
  }
  const Links& start() const { return start_; }
  template <class Visit>
  void for_each_at_goal(const Visit& visit) {
    const auto at = [&](const Cell& c) { for_each_at(c, visit); };
    for (const kit::Lattice::Link& link : lattice_.links(problem_.request.goal.position)) {
      at(link.cell);
    }
    for (const Link& link : goal_.all()) {
      at(lattice_.cell(link.node));
    }
  }
  template <class Visit>
  void for_each_at(const Cell& c, const Visit& visit) const {
    for (kit::DirectionMask all = legs_.steps(); all != 0; all &= all - 1) {
      visit(node(lattice_.index(c), std::countr_zero(all)));
    }
    if (const std::uint32_t s = node(lattice_.index(c), kit::kHere); start_.cost(s) != kNever) {
      visit(s);
    }
  }

  void find_goal(bool within) {
    goal_.clear();
    for_each_goal_link(problem_, legs_, within, [&](const kit::Lattice::Link& link) {
      goal_.add(lattice_.index(link.cell), problem_.link_cost(link));
    });
  }
  void find_start(const std::vector<kit::Lattice::Link>& links) {
    start_.clear();
    for_each_start_link(problem_, legs_, links, [&](const kit::Lattice::Link& link) {
      start_.add(node(lattice_.index(link.cell), kit::kHere), problem_.link_cost(link));
    });
  }

 private:
  static std::uint32_t node(std::uint32_t cell, int heading) {
    return cell * kPerCell + std::uint32_t(heading);
  }
  static int heading(std::uint32_t node) { return int(node % kPerCell); }

  /// Calls visit(s, cell, heading) for the vertices from which a step `in` to the cell keeps the
  /// limits on turns.
  template <class Visit>
  void visit_before(const Cell& c, int in, const Visit& visit) {
    const Cell o = kit::offset(in);
    const Cell from = {c[0] - o[0], c[1] - o[1], c[2] - o[2]};
    const std::uint32_t index = lattice_.index(from);
    for (kit::DirectionMask all = legs_.rules().before(in) & legs_.steps(); all != 0;
         all &= all - 1) {
      const int d = std::countr_zero(all);
      visit(node(index, d), from, d);
    }
    if (const std::uint32_t s = node(index, kit::kHere); start_.cost(s) != kNever) {
      visit(s, from, kit::kHere);
    }
  }
  /// What led to a place at the cell.
  std::optional<Vec3> before(const Cell& c, int in) const {
    const Request& request = problem_.request;
    if (in != kit::kHere) {
      return Vec3(lattice_.position(c) - lattice_.step(in));
    }
    return lattice_.nearest(request.start.position).length == 0
               ? request.before_start()
               : std::optional<Vec3>(request.start.position);
  }
  /// Whether the step `out` keeps what depends on the leg before, beside limits on turns where that
  /// was a step.
  bool follows(const Cell& c, int in, int out) {
    if (in != kit::kHere && !legs_.rules().looks_beyond_turns()) {
      return true;
    }
    const Cell o = kit::offset(out);
    const Vec3 here = lattice_.position(c);
    const Vec3 there = lattice_.position({c[0] + o[0], c[1] + o[1], c[2] + o[2]});
    return in == kit::kHere ? legs_.rules().any_leg_ok(before(c, in), here, there)
                            : legs_.rules().admits(before(c, in), here, there);
  }

  const Problem& problem_;
  const kit::Lattice& lattice_;
  Legs& legs_;
  const ToStart& to_start_;
  Links goal_;  ///< by cell
  Links start_;
};
}  // namespace altiplan::dstar_lite
