// SPDX-License-Identifier: Apache-2.0
// Text of the refusals of MoveRules.
#include <algorithm>

#include "altiplan/kit/lattice/move_rules.hpp"

namespace altiplan::kit {

std::string MoveRules::refusals() const {
  const std::string names[rule_count] = {
      "blocked cells",
      "leg_length",
      "climb_angle",
      request_.limits.min_turn_radius > 0 ? "turn limits" : "turn_angle",
      "clearance to '" + refused_layer_ + "'",
      "no ground below",
      "ground_clearance",
      "altitude",
      refused_constraint_,
      refused_link_ + " where start or goal join the lattice"};
  std::vector<int> order;
  for (int rule = 0; rule < rule_count; ++rule) {
    if (refused_[std::size_t(rule)] > 0) {
      order.push_back(rule);
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return refused_[std::size_t(a)] > refused_[std::size_t(b)];
  });
  std::string text;
  for (const int rule : order) {
    text += (text.empty() ? "" : ", ") + names[rule] + " (" +
            std::to_string(refused_[std::size_t(rule)]) + ")";
  }
  return text.empty() || steps_refused_by_.empty() ? text + steps_refused_by_
                                                   : text + "; " + steps_refused_by_;
}
}  // namespace altiplan::kit
