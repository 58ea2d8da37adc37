// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <optional>
#include <vector>

#include "cell_graph.hpp"

namespace altiplan::dstar_lite {

/// The graph whose vertices are cells with the step that led there, for constraints on two
/// consecutive legs; kHere: the vehicle has come there from its current position. Vertical steps
/// without a heading exist only for the vehicle's first steps: in the columns of the cells to which
/// it is linked.
class HeadingGraph {
 public:
  static constexpr std::uint32_t kPerCell = kit::kSteps;

  HeadingGraph(const Problem& problem, Legs& legs, const ToStart& to_start)
      : problem_(problem), lattice_(problem.lattice), legs_(legs), to_start_(to_start) {}

  Cell cell(std::uint32_t node) const { return lattice_.cell(node / kPerCell); }
  std::uint32_t estimate(const Cell& c) const { return to_start_(c); }

  template <class Visit>
  void predecessors(std::uint32_t u, const Cell& c, kit::DirectionMask, const Visit& visit) {
    const int in = step_of(u);
    const int d = kit::direction_of(in);
    if (in != kit::kHere && (legs_.into(u / kPerCell, c) >> kit::opposite(d) & 1) != 0) {
      visit_before(c, in, [&](std::uint32_t s, const Cell& from, int before) {
        if (follows(from, before, d)) {
          visit(s, problem_.costs[d], from);
        }
      });
    }
  }
  template <class Visit>
  void successors(std::uint32_t s, int likely, const Visit& visit) {
    const int in = step_of(s);
    const Cell c = cell(s);
    kit::DirectionMask open = legs_.out_of(c) & kit::directions_of(legs_.rules().after(in));
    while (open != 0) {
      const int d = take_direction(open, likely);
      const auto is_free = [&, d] {
        return (!legs_.judges() || legs_.leads(s / kPerCell, c, d)) && follows(c, in, d);
      };
      const auto next = std::uint32_t(s / kPerCell + lattice_.stride(d));
      if (!visit(node(next, legs_.rules().step_after(in, d)), problem_.costs[d], is_free)) {
        return;
      }
    }
  }

  static int direction(std::uint32_t, std::uint32_t n) { return kit::direction_of(step_of(n)); }

  std::uint32_t goal_cost(std::uint32_t s) const {
    const std::uint32_t cost = goal_.cost(s / kPerCell);
    if (cost == kNever || cost == 0) {
      return cost;
    }
    const Cell c = cell(s);
    return legs_.rules().any_leg_ok(before(c, step_of(s)), lattice_.position(c),
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
    for (kit::StepMask all = kit::steps_in(legs_.steps()); all != 0; all &= all - 1) {
      visit_step(c, std::countr_zero(all), visit);
    }
    visit_step(c, kit::kHere, visit);
  }
  /// Calls visit(s) for the vertices whose legs depend on the vehicle's position.
  template <class Visit>
  void for_each_first(const Visit& visit) const {
    for (const Link& link : start_.all()) {
      visit(link.node);
    }
    if (legs_.rules().headings_last()) {
      for (const Link& link : start_.all()) {
        Cell c = cell(link.node);
        for (c[2] = 0; c[2] < lattice_.spec().counts[2]; ++c[2]) {
          visit_step(c, kit::kDown, visit);
          visit_step(c, kit::kUp, visit);
        }
      }
    }
  }

  void find_goal(bool within) {
    goal_.clear();
    for_each_goal_link(problem_, legs_, within, [&](const kit::Lattice::Link& link) {
      goal_.add(lattice_.index(link.cell), problem_.costs.of_link(link.length));
    });
  }
  void find_start(const std::vector<kit::Lattice::Link>& links) {
    start_.clear();
    for_each_start_link(problem_, legs_, links, [&](const kit::Lattice::Link& link) {
      start_.add(node(lattice_.index(link.cell), kit::kHere), problem_.costs.of_link(link.length));
    });
  }

 private:
  static int step_of(std::uint32_t node) { return int(node % kPerCell); }
  static std::uint32_t node(std::uint32_t cell, int step) {
    return cell * kPerCell + std::uint32_t(step);
  }

  /// Calls visit(s) for the vertex of a cell and step, if there is one.
  template <class Visit>
  void visit_step(const Cell& c, int step, const Visit& visit) const {
    const std::uint32_t s = node(lattice_.index(c), step);
    const bool is_vertex = step == kit::kHere             ? start_.cost(s) != kNever
                           : legs_.rules().is_first(step) ? is_in_start_column(c)
                                                          : true;
    if (is_vertex) {
      visit(s);
    }
  }
  bool is_in_start_column(const Cell& c) const {
    return std::any_of(start_.all().begin(), start_.all().end(), [&](const Link& link) {
      const Cell linked = cell(link.node);
      return linked[0] == c[0] && linked[1] == c[1];
    });
  }

  /// Calls visit(s, cell, step) for the vertices from which a step `in` to the cell satisfies the
  /// turn limits.
  template <class Visit>
  void visit_before(const Cell& c, int in, const Visit& visit) {
    const Cell o = kit::offset(kit::direction_of(in));
    const Cell from = {c[0] - o[0], c[1] - o[1], c[2] - o[2]};
    const kit::StepMask steps = kit::steps_in(legs_.steps()) | kit::StepMask{1} << kit::kHere;
    for (kit::StepMask all = legs_.rules().before(in) & steps; all != 0; all &= all - 1) {
      const int before = std::countr_zero(all);
      visit_step(from, before, [&](std::uint32_t s) { visit(s, from, before); });
    }
  }
  /// Approach of the vehicle to a cell by a step.
  std::optional<Approach> before(const Cell& c, int in) const {
    const bool at_start = lattice_.nearest(problem_.request.start.position).length == 0;
    return legs_.rules().approach(in, lattice_.position(c), at_start);
  }
  /// True if the step `out` satisfies the constraints that depend on the preceding leg, except turn
  /// limits if that leg was a step.
  bool follows(const Cell& c, int in, int out) {
    if (!legs_.rules().is_first(in) && !legs_.rules().looks_beyond_turns()) {
      return true;
    }
    const Cell o = kit::offset(out);
    const Vec3 here = lattice_.position(c);
    const Vec3 there = lattice_.position({c[0] + o[0], c[1] + o[1], c[2] + o[2]});
    return legs_.rules().is_first(in) ? legs_.rules().any_leg_ok(before(c, in), here, there)
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
