// SPDX-License-Identifier: Apache-2.0
#include "two_sided_search.hpp"

#include <algorithm>

namespace altiplan::bidirectional {

void TwoSidedSearch::begin() {
  nodes_.reset(lattice_.size());
  for (const Side side : {forward, backward}) {
    open_[side].clear(quantum_);
    arrivals_[side].clear();
    const Vec3& end = side == forward ? start_ : goal_;
    for (const kit::Lattice::Link& link : estimate(other(side)).links()) {
      const Vec3 there = lattice_.position(link.cell);
      if (rules_.cell_blocked(link.cell) ||
          (link.length > 0 &&
           !(side == forward ? rules_.any_leg_ok(request_.before_start(), end, there)
                             : rules_.any_leg_ok(std::nullopt, there, end)))) {
        continue;
      }
      const bool reversed = side == backward && request_.objective;
      const double g =
          reversed ? link_cost(there, end, link.length) : link_cost(end, there, link.length);
      if (g == kInfinity) {
        continue;
      }
      centred_[side] = link.length == 0;
      nodes_.at(lattice_.index(link.cell), kFresh);
      push(side, link.cell, there,
           {g, link.length, lattice_.index(link.cell), kNone, kNone, kit::kHere});
    }
  }
}

bool TwoSidedSearch::first_legs_ok(std::optional<Approach> from, Arrival away, Vec3 here) {
  while (true) {
    const bool to_goal = away.along == kit::kHere;
    if (to_goal && centred_[backward]) {
      return true;
    }
    const Vec3 next = to_goal ? goal_ : Vec3(here + lattice_.step(kit::direction_of(away.along)));
    if (!rules_.any_leg_ok(from, here, next)) {
      return false;
    }
    if (to_goal || !rules_.is_first(away.along)) {
      return true;
    }
    from = onward(from, here);
    here = next;
    away = arrivals_[backward][away.from];
  }
}

Polyline TwoSidedSearch::route(std::uint32_t to, std::uint32_t away) const {
  Polyline route;
  const auto add = [&](const Arrival& arrival) {
    route.push_back(lattice_.position(lattice_.cell(arrival.cell)));
  };
  for (std::uint32_t at = to; at != kNone; at = arrivals_[forward][at].from) {
    add(arrivals_[forward][at]);
  }
  if (centred_[forward]) {
    route.pop_back();
  }
  route.push_back(start_);
  std::reverse(route.begin(), route.end());
  if (away != kNone) {
    for (std::uint32_t at = arrivals_[backward][away].from; at != kNone;
         at = arrivals_[backward][at].from) {
      add(arrivals_[backward][at]);
    }
    kit::end_at_goal(route, goal_, centred_[backward]);
  }
  return route;
}
}  // namespace altiplan::bidirectional
