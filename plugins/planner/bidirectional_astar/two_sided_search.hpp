// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <vector>

#include "altiplan/kit/lattice/lattice_search.hpp"
#include "nodes.hpp"

namespace altiplan::bidirectional {

/// A* from both ends at once, by W. Pijls, H. Post: Yet Another Bidirectional Algorithm for Finding
/// the Shortest Path (NBA*), Erasmus University Rotterdam, EI 2009-10.
///
/// The sides take turns, each until its minimum f rises. At most one of them expands a node; a node
/// is pruned if no better route can pass through it, by its own side's estimate or by the other
/// side's progress. The search ends when the minimum f of a side is no better than the best
/// meeting.
///
/// `by_heading`: nodes are cells with a direction, so that what lies beyond a node depends on the
/// node alone, for constraints on two consecutive legs; else only the cheapest arrival at a cell is
/// kept.
class TwoSidedSearch : kit::LatticeSearch {
 public:
  TwoSidedSearch(const Request& request, const kit::SearchSettings& settings,
                 const kit::Lattice& lattice, double best_cost, bool by_heading, Memory& memory)
      : LatticeSearch(request, settings, lattice, best_cost),
        to_start_(request, settings, lattice, request.start.position, 0, costs_.min_per_metre(),
                  true),
        by_heading_(by_heading),
        quantum_(quantum()),
        nodes_(memory.nodes),
        open_(memory.open),
        arrivals_(memory.arrivals) {}

  kit::SearchResult run() {
    begin();
    PlanStatus status = PlanStatus::no_route;
    while (const std::optional<Side> side = next_side()) {
      const kit::OpenList::Entry entry = open_[*side].pop();
      if (is_settled(*side, entry.node) || leads_nowhere(*side, entry.node)) {
        continue;
      }
      if (watch_.spent(progress_.expanded, open_[forward].size() + open_[backward].size()) ||
          memory_full()) {
        status = ended();
        break;
      }
      expand(*side, entry.node);
    }
    const bool cut_short = status != PlanStatus::no_route;
    if (meeting_[forward] != kNone) {
      return with(route(meeting_[forward], meeting_[backward]), best_cost_, true, cut_short);
    }
    if (fallback_ != kNone) {
      return with(route(fallback_, kNone), arrivals_[forward][fallback_].g, false, cut_short);
    }
    progress_.memory_full = memory_full();
    kit::SearchResult none =
        without(status, (by_heading_ || !rules_.parent_mattered()) && lengths_prove());
    none.result.message += by_heading_ ? "; searched by cell and heading" : "";
    return none;
  }

 private:
  enum Side : std::size_t { forward, backward };
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr Reached kUnreached = {kInfinity, 0, kNone, kit::kHere, false};
  static constexpr Node kFresh = {{kUnreached, kUnreached}, 0};
  static Side other(Side side) { return side == forward ? backward : forward; }

  void begin();

  /// Estimate of the path that a side still has to cover.
  const kit::Estimate& estimate(Side side) const { return side == forward ? to_goal_ : to_start_; }
  /// Steps that may follow an arrival.
  kit::StepMask steps_on(Side side, int along) const {
    return side == forward ? rules_.after(along) : rules_.before(along);
  }

  /// The side to continue with; empty once no better meeting is possible.
  std::optional<Side> next_side() {
    if (open_[forward].empty()) {
      return std::nullopt;
    }
    if (open_[backward].empty()) {
      // Only a cell within the goal's tolerance remains to be found.
      const bool may_fall_back = meeting_[forward] == kNone && request_.goal.tolerance_m > 0;
      return may_fall_back ? std::optional(forward) : std::nullopt;
    }
    for (const Side side : {forward, backward}) {
      const Vec3& end = side == forward ? goal_ : start_;
      if (!is_better(minimum(side) - settings_.weight_g * costs_.at(end))) {
        return std::nullopt;
      }
    }
    // A side continues while its f stays the same: in open air one of them gets there alone.
    if (open_[side_].top().f > level_) {
      side_ = open_[forward].size() <= open_[backward].size() ? forward : backward;
    }
    level_ = open_[side_].top().f;
    return side_;
  }
  /// True if a route of cost f is better than the best one by more than the rounding of summed
  /// costs.
  bool is_better(double f) const {
    return best_cost_ == kInfinity || f < settings_.weight_g * best_cost_ - 2 * quantum_;
  }
  /// Minimum f on a side's open list.
  double minimum(Side side) const { return open_[side].top().f * quantum_; }

  double evaluation_of(Side side, double g, const Cell& c, const Vec3& at) const {
    return settings_.weight_g * (g + costs_.at(at)) + settings_.weight_h * estimate(side)(c);
  }

  void push(Side side, const Cell& c, const Vec3& at, Arrival arrival) {
    ++progress_.generated;
    const auto index = std::uint32_t(arrivals_[side].size());
    Reached& reached = nodes_[arrival.cell].by[side];
    arrival.beside = reached.newest;
    reached.newest = index;
    if (arrival.g < reached.g) {
      reached.g = arrival.g;
      reached.along = arrival.along;
    }
    open_[side].push(evaluation_of(side, arrival.g, c, at), arrival.g, index);
    arrivals_[side].push_back(arrival);
    meet(side, index, at);
  }

  /// Joins the arrival to those of the other side at its cell.
  void meet(Side side, std::uint32_t index, const Vec3& here) {
    const Arrival& arrival = arrivals_[side][index];
    const std::vector<Arrival>& others = arrivals_[other(side)];
    for (std::uint32_t at = nodes_[arrival.cell].by[other(side)].newest; at != kNone;
         at = others[at].beside) {
      const double cost = arrival.g + others[at].g;
      if (cost >= best_cost_) {
        continue;
      }
      if (arrival.length + others[at].length > longest_) {
        progress_.too_long = true;
        continue;
      }
      const Arrival& to = side == forward ? arrival : others[at];
      const Arrival& away = side == forward ? others[at] : arrival;
      if (join(to, away, here)) {
        best_cost_ = cost;
        request_.budget.show_best(cost);
        meeting_ = {side == forward ? index : at, side == forward ? at : index};
      }
    }
  }

  /// True if the vehicle can continue from an arrival of the forward side along one of the backward
  /// side.
  bool join(const Arrival& to, const Arrival& away, const Vec3& here) {
    if (away.along == kit::kHere && centred_[backward]) {
      return true;
    }
    const std::optional<Approach> from = before(to, here);
    if (rules_.is_first(to.along) || away.along == kit::kHere) {
      return (rules_.after(to.along) >> away.along & 1) != 0 && first_legs_ok(from, away, here);
    }
    const kit::StepMask next = kit::StepMask{1} << away.along;
    rules_.count_turns(next, next & rules_.after(to.along));
    return (rules_.after(to.along) & next) != 0 &&
           rules_.admits(from, here, here + lattice_.step(kit::direction_of(away.along)));
  }

  /// True if a vehicle that arrives so may fly the leg of a backward arrival and, while its steps
  /// give it no heading, the following legs up to the first that has one.
  bool first_legs_ok(std::optional<Approach> from, Arrival away, Vec3 here);

  /// Approach of the vehicle to an arrival of the forward side.
  std::optional<Approach> before(const Arrival& arrival, const Vec3& here) const {
    return rules_.approach(arrival.along, here, centred_[forward]);
  }

  /// True if the arrival has no step left to take, or the other side has expanded its node.
  bool is_settled(Side side, std::uint32_t index) const {
    const Arrival& arrival = arrivals_[side][index];
    const Node& node = nodes_[arrival.cell];
    const Reached& own = node.by[side];
    const Reached& there = node.by[other(side)];
    if (own.is_open && (steps_on(side, arrival.along) & ~own.taken) == 0) {
      return true;
    }
    // This arrival has met what the other side has expanded, in a route that may be too long.
    if (!there.is_open || arrival.along == kit::kHere || meeting_[forward] == kNone) {
      return false;
    }
    const kit::StepMask opened = by_heading_ ? there.taken : steps_on(other(side), there.along);
    return (opened >> arrival.along & 1) != 0;
  }

  /// True if no route through the arrival is better than the best meeting.
  bool leads_nowhere(Side side, std::uint32_t index) const {
    if (best_cost_ == kInfinity || open_[other(side)].empty()) {
      return false;
    }
    const Arrival& arrival = arrivals_[side][index];
    const Cell c = lattice_.cell(arrival.cell);
    const double at = costs_.at(lattice_.position(c));
    // Lower bound of the other side's cost to nodes that it has not expanded.
    const double beyond = minimum(other(side)) - settings_.weight_h * estimate(other(side))(c) -
                          settings_.weight_g * at;
    return !is_better(settings_.weight_g * arrival.g + beyond);
  }

  void expand(Side side, std::uint32_t index) {
    const Arrival arrival = arrivals_[side][index];  // copied: pushes move it
    Node& node = nodes_[arrival.cell];
    Reached& own = node.by[side];
    const Cell c = lattice_.cell(arrival.cell);
    const Vec3 here = lattice_.position(c);
    ++progress_.expanded;
    if (side == forward) {
      remember_nearest(here);
      try_fallback(index, arrival, here);
    }
    if (request_.trace != nullptr) {
      add_to_trace(side, index, arrival, c, here);
    }
    if (!own.is_open) {
      own.is_open = true;
      own.taken = ~kit::steps_in(side == forward ? rules_.out_of(c) : rules_.into(c));
    }
    const kit::StepMask left = ~own.taken;
    rules_.count_turns(left, steps_on(side, arrival.along));
    for (kit::StepMask open = left & steps_on(side, arrival.along); open != 0; open &= open - 1) {
      take(side, index, arrival, node, c, here, std::countr_zero(open));
    }
    if (!by_heading_) {
      own.taken = ~kit::StepMask{0};
      own.along = arrival.along;
    }
  }

  /// Extends an arrival by a step, which the backward side reverses.
  void take(Side side, std::uint32_t index, const Arrival& arrival, Node& node, const Cell& c,
            const Vec3& here, int step) {
    const int sign = side == forward ? 1 : -1;
    const int d = kit::direction_of(step);
    const Cell o = kit::offset(d);
    const Cell to = {c[0] + sign * o[0], c[1] + sign * o[1], c[2] + sign * o[2]};
    const Vec3 there = lattice_.position(to);
    const bool reversed = side == backward && request_.objective;
    Arrival next = {
        arrival.g + (reversed ? step_cost(to, d, there, here) : step_cost(c, d, here, there)),
        arrival.length + lattice_.step_length(d),
        std::uint32_t(std::int64_t(arrival.cell) + sign * lattice_.stride(d)),
        index,
        kNone,
        std::uint8_t(step)};
    if (next.g == kInfinity || is_too_long(side, next.length, there) ||
        !is_better(settings_.weight_g * (next.g + estimate(side).at_least(there)))) {
      return;
    }
    Node& neighbour = nodes_.at(next.cell, kFresh);
    const bool is_free = side == forward ? rules_.place_free(c, d) : rules_.place_free(to, d);
    if (is_free && !admits(side, arrival, here, there, step)) {
      return;  // another arrival may take it
    }
    node.by[side].taken |= kit::StepMask{1} << step;
    if (is_free && !is_needless(side, neighbour.by[side], next)) {
      push(side, to, there, next);
    }
  }

  bool is_too_long(Side side, double length, const Vec3& at) {
    if (side == forward) {
      return too_long(length, at);
    }
    const bool beyond = length + (at - start_).norm() > longest_;
    progress_.too_long = progress_.too_long || beyond;
    return beyond;
  }

  /// Constraints on two consecutive legs other than the turn: forward, the leg to `there` follows
  /// the arrival; backward, the leg of the arrival follows the one from `there`.
  bool admits(Side side, const Arrival& arrival, const Vec3& here, const Vec3& there, int step) {
    if (side == forward) {
      const std::optional<Approach> from = before(arrival, here);
      return rules_.admits(from, here, there) &&
             (!rules_.is_first(arrival.along) || !from || rules_.any_leg_ok(from, here, there));
    }
    if (arrival.along == kit::kHere) {
      // Without a heading given by its steps, the vehicle is checked where the sides meet.
      return centred_[backward] || rules_.is_first(step) ||
             rules_.any_leg_ok(rules_.approach(step, here, false), here, goal_);
    }
    return rules_.admits(there, here, here + lattice_.step(kit::direction_of(arrival.along)));
  }

  /// True if another arrival at the cell offers every step that this one does, as cheaply.
  bool is_needless(Side side, const Reached& reached, const Arrival& arrival) const {
    if (!by_heading_) {
      return reached.g <= arrival.g || reached.is_open;
    }
    const kit::StepMask left = steps_on(side, arrival.along) & ~reached.taken;
    return left == 0 ||
           (reached.g <= arrival.g && !rules_.is_first(reached.along) &&
            !rules_.looks_beyond_turns() && (left & ~steps_on(side, reached.along)) == 0);
  }

  void try_fallback(std::uint32_t index, const Arrival& arrival, const Vec3& here) {
    if (request_.goal.reached_at(here) && arrival.length <= longest_ &&
        (fallback_ == kNone || arrival.g < arrivals_[forward][fallback_].g)) {
      fallback_ = index;
    }
  }

  /// Memory of this search, not the size to which the pool has grown.
  bool memory_full() const {
    std::size_t bytes = lattice_.size() * sizeof(Node);
    for (const Side side : {forward, backward}) {
      bytes += arrivals_[side].size() * sizeof(Arrival) +
               open_[side].size() * sizeof(kit::OpenList::Entry);
    }
    return bytes > settings_.max_bytes;
  }

  Polyline route(std::uint32_t to, std::uint32_t away) const;

  void add_to_trace(Side side, std::uint32_t index, const Arrival& arrival, const Cell& c,
                    const Vec3& here) const {
    const auto id = [&](std::uint32_t at) {
      return at == kNone ? std::int64_t{-1} : 2 * std::int64_t{at} + (side == backward);
    };
    request_.trace->add({TraceEvent::Kind::expanded, id(index), id(arrival.from), here,
                         evaluation_of(side, arrival.g, c, here)});
  }

  kit::Estimate to_start_;
  bool by_heading_;
  double quantum_;  ///< quantum of f
  kit::NodeStore<Node>& nodes_;
  std::array<kit::OpenList, 2>& open_;
  std::array<std::vector<Arrival>, 2>& arrivals_;
  Side side_ = forward;
  double level_ = 0;               ///< f of that side, in quanta
  std::array<bool, 2> centred_{};  ///< the side's end is the centre of its cell
  std::array<std::uint32_t, 2> meeting_ = {kNone, kNone};  ///< arrivals that the best route joins
  std::uint32_t fallback_ = kNone;  ///< ends within the tolerance, if the goal is out of reach
};
}  // namespace altiplan::bidirectional
