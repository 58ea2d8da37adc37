// SPDX-License-Identifier: Apache-2.0
// Text of the refusals of MoveRules.
#include <algorithm>
#include <cstdio>

#include "altiplan/check.hpp"
#include "altiplan/kit/lattice/move_rules.hpp"

namespace altiplan::kit {

double max_turn_radius(const Lattice& lattice, DirectionMask steps) {
  steps &= ~(DirectionMask{1} << kHere);
  double radius = 0;
  for (int in = 0; in < kDirections; ++in) {
    for (int out = 0; out < kDirections; ++out) {
      const bool taken = (steps >> in & steps >> out & 1) != 0;
      const Cell a = offset(in);
      const Cell b = offset(out);
      if (taken && (a[0] != b[0] || a[1] != b[1])) {
        radius = std::max(radius, fillet_radius(lattice.step(in), lattice.step(out)));
      }
    }
  }
  return radius;
}

std::string MoveRules::sharp_turns() const {
  const double required = request_.limits.min_turn_radius;
  const double widest = required > 0 ? max_turn_radius(lattice_, steps_) : kInfinity;
  if (widest >= required - kLengthTolerance) {
    return "";
  }
  const Vec3& cell = lattice_.spec().cell;
  const auto metres = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.5g", value);
    return std::string(text);
  };
  return "; turns of cells of " + metres(cell.x()) +
         (cell.x() == cell.y() ? "" : " x " + metres(cell.y())) + " m have a radius of at most " +
         metres(widest) + " m, below the required " + metres(required) +
         " m: use larger cells, or hybrid_astar, whose legs curve";
}

std::string MoveRules::climb_rule() const {
  return in_wind_ ? "wind or climb_angle" : "climb_angle";
}

std::string MoveRules::link_refused_by() const {
  if (refused_[by_link] == 0) {
    return "";
  }
  const auto& [before, a, b] = refused_link_;
  const auto found = leg_violations(before, a, b, request_, 0);
  return found.empty() ? "" : found.front().constraint;
}

std::string MoveRules::refusals() const {
  std::array<std::int64_t, rule_count> refused = refused_;
  std::string layer = refused_layer_;
  if (ground_steps_) {
    const Rule low = rule_of(ground_.too_low());
    refused[by_no_ground] += ground_steps_->refused().no_ground;
    refused[low] += ground_steps_->refused().too_low;
    refused[by_altitude] += ground_steps_->refused().too_high;
    if (low == by_clearance && layer.empty()) {
      layer = ground_.bare_ground().layers().front().id;
    }
  }
  const std::string names[rule_count] = {
      "blocked cells",
      "leg_length",
      climb_rule(),
      request_.limits.min_turn_radius > 0 ? "turn limits" : "turn_angle",
      "clearance to '" + layer + "'",
      "no ground below",
      "ground_clearance",
      "altitude",
      refused_constraint_,
      "the vehicle's body",
      link_refused_by() + " on legs that are no step of the lattice"};
  std::vector<int> order;
  for (int rule = 0; rule < rule_count; ++rule) {
    if (refused[std::size_t(rule)] > 0) {
      order.push_back(rule);
    }
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return refused[std::size_t(a)] > refused[std::size_t(b)]; });
  std::string text;
  for (const int rule : order) {
    text += (text.empty() ? "" : ", ") + names[rule] + " (" +
            std::to_string(refused[std::size_t(rule)]) + ")";
  }
  return text.empty() || steps_refused_by_.empty() ? text + steps_refused_by_
                                                   : text + "; " + steps_refused_by_;
}

std::string MoveRules::lower_cells(int ruled_out) const {
  int vertical = 0;
  for (int d = 0; d < kDirections; ++d) {
    vertical += (lattice_.steps() >> d & 1) != 0 && !has_heading(lattice_.step(d));
  }
  if (ruled_out <= vertical || in_wind_) {
    return "";
  }
  const Vec3& cell = lattice_.spec().cell;
  const double height = std::min(cell.x(), cell.y()) * std::tan(request_.limits.max_slope());
  char text[64];
  std::snprintf(text, sizeof text, " (with cells at most %.3g m high %d)",
                std::floor(height * 100) / 100, vertical);
  return text;
}
}  // namespace altiplan::kit
