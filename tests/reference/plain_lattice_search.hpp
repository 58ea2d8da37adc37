// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <queue>
#include <vector>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/lattice.hpp"

namespace altiplan::reference {

/// The length of the shortest route over the cells of a lattice, by Dijkstra's algorithm over
/// (cell, step into it) with real numbers; every leg is judged by leg_ok, and nothing is
/// remembered of legs. Infinite where there is no route. Cells at most `edges` away on each axis
/// are joined to the goal.
class PlainLatticeSearch {
 public:
  PlainLatticeSearch(const Request& request, const kit::Lattice& lattice, int edges = 1)
      : request_(request),
        lattice_(lattice),
        by_step_(request.limits.turns()),
        goal_links_(lattice.links(request.goal.position, edges)) {}

  double length() {
    const std::size_t states = lattice_.size() * (by_step_ ? kit::kDirections : 1);
    best_.assign(states, kInfinity);
    for (const kit::Lattice::Link& link : lattice_.links(request_.start.position)) {
      const Vec3 there = lattice_.position(link.cell);
      if (link.length == 0 || leg_ok(std::nullopt, request_.start.position, there, request_)) {
        reach(link.cell, kit::kHere, link.length);
      }
    }
    while (!open_.empty()) {
      const Entry entry = open_.top();
      open_.pop();
      if (entry.is_goal) {
        return entry.g;
      }
      if (entry.g == best_[state(entry.cell, entry.in)]) {
        expand(entry);
      }
    }
    return kInfinity;
  }

 private:
  struct Entry {
    double g = 0;
    Cell cell{};
    int in = kit::kHere;
    bool is_goal = false;
    bool operator<(const Entry& other) const { return g > other.g; }
  };

  std::size_t state(const Cell& c, int in) const {
    return by_step_ ? lattice_.index(c) * kit::kDirections + std::size_t(in) : lattice_.index(c);
  }
  void reach(const Cell& c, int in, double g) {
    double& best = best_[state(c, in)];
    if (g < best) {
      best = g;
      open_.push({g, c, in, false});
    }
  }

  void expand(const Entry& entry) {
    const Vec3 here = lattice_.position(entry.cell);
    std::optional<Approach> before;
    if (entry.in != kit::kHere) {
      before = Approach(here - lattice_.step(entry.in));
    }
    for (const kit::Lattice::Link& link : goal_links_) {
      if (link.cell == entry.cell &&
          (link.length == 0 || leg_ok(before, here, request_.goal.position, request_))) {
        open_.push({entry.g + link.length, entry.cell, entry.in, true});
      }
    }
    const kit::DirectionMask inside = lattice_.inside(entry.cell) & lattice_.steps();
    for (kit::DirectionMask left = inside; left != 0; left &= left - 1) {
      const int d = __builtin_ctz(left);
      const Cell o = kit::offset(d);
      const Cell to = {entry.cell[0] + o[0], entry.cell[1] + o[1], entry.cell[2] + o[2]};
      if (leg_ok(before, here, lattice_.position(to), request_)) {
        reach(to, d, entry.g + lattice_.step_length(d));
      }
    }
  }

  const Request& request_;
  const kit::Lattice& lattice_;
  bool by_step_;  ///< a cell's arrivals differ in what they may do next
  std::vector<kit::Lattice::Link> goal_links_;
  std::vector<double> best_;
  std::priority_queue<Entry> open_;
};
}  // namespace altiplan::reference
