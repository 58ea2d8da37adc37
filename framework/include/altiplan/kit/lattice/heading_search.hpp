// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "altiplan/kit/lattice/goal_search.hpp"
#include "altiplan/kit/lattice/tiles.hpp"

namespace altiplan::kit {

/// State of a cell in a search by cell and heading; all zero until it is reached.
struct HeadingCell {
  double g;         ///< of the cheapest arrival that is or was open
  StepMask taken;   ///< steps out of the cell that need no further arrival
  std::uint8_t in;  ///< step of that arrival
  bool is_reached;
  bool is_open;  ///< steps that no arrival may take are included in `taken`
};

/// A node of the search: a cell reached by a step.
struct Arrival {
  std::uint32_t cell;  ///< as a TileIndex numbers it
  std::uint32_t from;  ///< the previous arrival
  std::uint8_t in;     ///< the step into the cell; kHere: linked to the start
};

struct HeadingMemory {
  TiledArray<HeadingCell> cells;
  OpenList open;
  std::vector<Arrival> arrivals;
  std::vector<double> lengths;  ///< path lengths, where costs differ from them
};

/// A* over (cell, step into it): complete where constraints depend on two legs, and optimal under
/// them.
///
/// The steps that may follow a step depend on that step alone. So the cheapest arrival at a cell
/// that may take a step takes it for good, and later arrivals, none of them cheaper, take the rest:
/// each step is checked, and each node opened, at most once. An arrival that has no step left to
/// take, or none that a cheaper one at the cell could not take, is dropped.
class HeadingSearch : GoalSearch {
 public:
  HeadingSearch(const Request& request, const SearchSettings& settings, const Lattice& lattice,
                double best_cost, HeadingMemory& memory)
      : GoalSearch(request, settings, lattice, best_cost, memory.open),
        tiles_(TileIndex::of(lattice)),
        cells_(memory.cells),
        arrivals_(memory.arrivals),
        lengths_(memory.lengths) {}

  SearchResult run() {
    begin();
    PlanStatus status = PlanStatus::no_route;
    while (!open_.empty()) {
      const auto [f, g, index] = open_.pop();
      if (index == kGoal) {
        return with(route_to(goal_parent_, true), goal_g_, true, false);
      }
      HeadingCell& cell = cells_.at(arrivals_[index].cell);
      if (nothing_left(cell, arrivals_[index])) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_.size()) || memory_full()) {
        status = ended();
        break;
      }
      expand(index, g, cell);
    }
    if (fallback_ != kNone) {
      return with(route_to(fallback_, false), fallback_g_, false, status != PlanStatus::no_route);
    }
    progress_.memory_full = memory_full();
    SearchResult none = without(status, lengths_prove());
    none.result.message += "; searched by cell and heading";
    return none;
  }

 private:
  void begin() {
    cells_.reset(tiles_.tiles());
    open_.clear(quantum());
    arrivals_.clear();
    lengths_.clear();
    for (const Lattice::Link& link : lattice_.links(start_)) {
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
      const std::uint32_t number = tiles_.number(link.cell);
      reached(number);
      push({number, kNone, kHere}, link.cell, there, g, link.length);
    }
  }

  HeadingCell& reached(std::uint32_t number) {
    HeadingCell& cell = cells_.at(number);
    if (!cell.is_reached) {
      cell = {kInfinity, 0, kHere, true, false};
    }
    return cell;
  }

  void push(const Arrival& arrival, const Cell& c, const Vec3& at, double g, double length) {
    ++progress_.generated;
    open_.push(evaluation(g, c, at), g, std::uint32_t(arrivals_.size()));
    arrivals_.push_back(arrival);
    if (keeps_lengths()) {
      lengths_.push_back(length);
    }
  }

  bool nothing_left(const HeadingCell& cell, const Arrival& arrival) const {
    return (rules_.after(arrival.in) & ~cell.taken) == 0 && cell.is_open &&
           to_goal_.link_of(tiles_.cell(arrival.cell)) == nullptr;
  }

  /// True if another arrival at the cell can take every step that this one can, at no higher cost.
  bool is_needless(HeadingCell& cell, const Cell& c, int step, double g) const {
    const StepMask left = rules_.after(step) & ~cell.taken;
    const bool by_other = cell.g <= g && (left & ~rules_.after(cell.in)) == 0 &&
                          !rules_.is_first(cell.in) && !rules_.looks_beyond_turns();
    if ((left == 0 || by_other) && to_goal_.link_of(c) == nullptr) {
      return true;
    }
    if (g < cell.g) {
      cell.g = g;
      cell.in = std::uint8_t(step);
    }
    return false;
  }

  void expand(std::uint32_t index, double g_here, HeadingCell& cell) {
    const Arrival arrival = arrivals_[index];  // a push may relocate it
    const Cell c = tiles_.cell(arrival.cell);
    const Vec3 here = arrival.in == kHere && at_start_ ? start_ : lattice_.position(c);
    const std::optional<Approach> from = before(arrival.in, here);
    const double length_here = keeps_lengths() ? lengths_[index] : g_here;
    ++progress_.expanded;
    remember_nearest(here);
    if (request_.trace != nullptr) {
      request_.trace->add({TraceEvent::Kind::expanded, index,
                           arrival.from == kNone ? -1 : std::int64_t(arrival.from), here,
                           evaluation(g_here, c, here)});
    }
    try_goal(index, g_here, length_here, c, here, from);
    if (!cell.is_open) {
      cell.is_open = true;
      cell.taken = ~steps_in(rules_.places_free(c, rules_.out_of(c)));
    }
    // The first step after a heading or a link is no pair of lattice steps: it is checked as a
    // whole.
    const bool judged_whole = rules_.is_first(arrival.in) && from;
    const StepMask left = ~cell.taken;
    rules_.count_turns(left, rules_.after(arrival.in));
    for (StepMask open = left & rules_.after(arrival.in); open != 0; open &= open - 1) {
      const int step = std::countr_zero(open);
      const int d = direction_of(step);
      const Cell o = offset(d);
      const Cell to = {c[0] + o[0], c[1] + o[1], c[2] + o[2]};
      const Vec3 there = lattice_.position(to);
      const double g = g_here + step_cost(c, d, here, there);
      const double length = length_here + lattice_.step_length(d);
      if (too_long(length, there) || exceeds_incumbent(g, there)) {
        continue;
      }
      const std::uint32_t next = tiles_.number(to);
      HeadingCell& successor = reached(next);
      if (!rules_.admits(from, here, there) ||
          (judged_whole && !rules_.any_leg_ok(from, here, there))) {
        continue;  // another arrival may take it
      }
      cell.taken |= StepMask{1} << step;
      if (!is_needless(successor, to, step, g)) {
        push({next, index, std::uint8_t(step)}, to, there, g, length);
      }
    }
  }

  /// Memory of this search, not the capacity that the pool has grown to.
  bool memory_full() const {
    return cells_.bytes() + arrivals_.size() * sizeof(Arrival) +
               open_.size() * sizeof(OpenList::Entry) + rules_.bytes() + means_bytes() >
           settings_.max_bytes;
  }

  Polyline route_to(std::uint32_t last, bool at_goal) const {
    return route_along(arrivals_, last, at_goal,
                       [&](std::uint32_t cell) { return tiles_.cell(cell); });
  }

  TileIndex tiles_;
  TiledArray<HeadingCell>& cells_;
  std::vector<Arrival>& arrivals_;
  std::vector<double>& lengths_;
};
}  // namespace altiplan::kit
